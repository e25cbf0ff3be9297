/* The vector vocabulary, operation by operation and lane by lane, against C on one number. -DSH_EXPECT_SIMD=N fails unless SH_SIMD
 * is N. Private names of sh.h are tested here and nowhere else. */
#include <float.h>

#include "sh.h"
#include "test.h"

/* NEON on 32-bit ARM takes subnormal numbers for zero, and gives zero for them. */
#if SH_SIMD == SH_SIMD_NEON && !defined(__aarch64__) && !defined(_M_ARM64)
enum { FLUSHES = 1 };
#else
enum { FLUSHES = 0 };
#endif

static uint32_t bits_of(float a) {
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

static float from_bits(uint32_t bits) {
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* a, or a zero of its sign where a is subnormal and the backend flushes. */
static float flushed(float a) {
    const uint32_t bits = bits_of(a);
    return FLUSHES && (bits & 0x7f800000u) == 0 ? from_bits(bits & 0x80000000u) : a;
}

/* The same bits; all NaN are one, as which of two operands' NaN a sum takes is nobody's choice. */
static int same(float a, float b) {
    return (a != a && b != b) || bits_of(a) == bits_of(b);
}

/* The same bits, where nothing may change them. Arithmetic of the x87 makes loaded NaN quiet. */
static int same_bits(uint32_t a, uint32_t b) {
    const uint32_t infinity = 0x7f800000u;
    const int quieted = FLT_EVAL_METHOD == 2 && (a & b & infinity) == infinity && ((a ^ b) & ~0x00400000u) == 0;
    return a == b || quieted;
}

/* ---- Operands: all pairs of special numbers, then a mixture of special ones, any bits, and numbers near 1 ---- */

enum { OPERANDS = 4096 };

static float a_in[OPERANDS], b_in[OPERANDS], c_in[OPERANDS];

static const uint32_t special[] = {
    0x00000000, 0x80000000, 0x3f800000, 0xbf800000,             /* 0, 1 */
    0x00000001, 0x80000001, 0x007fffff, 0x807fffff, 0x00012345, /* subnormal */
    0x00800000, 0x80800000, 0x00800001,                         /* the smallest normal */
    0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000,             /* the largest, infinity */
    0x7fc00000, 0xffc00000, 0x7fc12345,                         /* NaN */
    0x5d5e0b6b, 0xdd5e0b6b, 0x219392ef, 0x3f7fffff, 0x3f800001, /* 1e18, 1e-18, next to 1 */
};
enum { SPECIALS = sizeof special / sizeof special[0] };

static float any_operand(void) {
    const int kind = test_below(4);
    if (kind == 0)
        return from_bits(special[test_below(SPECIALS)]);
    if (kind == 1) { /* any bits but a signalling NaN's, which arithmetic and copies treat differently */
        const float any = from_bits((uint32_t)test_bits());
        return any != any ? from_bits(0x7fc00000u) : any;
    }
    return (float)test_uniform(-3.0, 3.0);
}

static void fill_operands(void) {
    for (int i = 0; i < OPERANDS; i++) {
        const int pair = i < SPECIALS * SPECIALS;
        a_in[i] = pair ? from_bits(special[i / SPECIALS]) : any_operand();
        b_in[i] = pair ? from_bits(special[i % SPECIALS]) : any_operand();
        c_in[i] = any_operand();
    }
}

/* ---- Arithmetic: every operation as a function of three vectors, and of three numbers ---- */

typedef struct operation {
    const char *name;
    shi_v (*vector)(shi_v a, shi_v b, shi_v c);
    float (*scalar)(float a, float b, float c);
    float (*or_scalar)(float a, float b, float c); /* another right answer, or NULL */
} operation;

static shi_v v_add(shi_v a, shi_v b, shi_v c) { return (void)c, shi_add(a, b); }
static shi_v v_sub(shi_v a, shi_v b, shi_v c) { return (void)c, shi_sub(a, b); }
static shi_v v_mul(shi_v a, shi_v b, shi_v c) { return (void)c, shi_mul(a, b); }
static shi_v v_div(shi_v a, shi_v b, shi_v c) { return (void)c, shi_div(a, b); }
static shi_v v_min(shi_v a, shi_v b, shi_v c) { return (void)c, shi_min(a, b); }
static shi_v v_max(shi_v a, shi_v b, shi_v c) { return (void)c, shi_max(a, b); }
static shi_v v_sqrt(shi_v a, shi_v b, shi_v c) { return (void)b, (void)c, shi_sqrt(a); }
static shi_v v_abs(shi_v a, shi_v b, shi_v c) { return (void)b, (void)c, shi_abs(a); }
static shi_v v_or(shi_v a, shi_v b, shi_v c) { return (void)c, shi_or(a, b); }
static shi_v v_madd(shi_v a, shi_v b, shi_v c) { return shi_madd(a, b, c); }
static shi_v v_less(shi_v a, shi_v b, shi_v c) { return (void)c, shi_select(shi_less(a, b), shi_splat(1.0f), shi_splat(0.0f)); }
static shi_v v_select(shi_v a, shi_v b, shi_v c) { return shi_select(shi_less(a, b), c, a); }

static float s_add(float a, float b, float c) { return (void)c, a + b; }
static float s_sub(float a, float b, float c) { return (void)c, a - b; }
static float s_mul(float a, float b, float c) { return (void)c, a * b; }
static float s_div(float a, float b, float c) { return (void)c, a / b; }
static float s_min(float a, float b, float c) { return (void)c, a < b ? a : b; }
static float s_max(float a, float b, float c) { return (void)c, a > b ? a : b; }
static float s_sqrt(float a, float b, float c) { return (void)b, (void)c, sqrtf(a); }
static float s_abs(float a, float b, float c) { return (void)b, (void)c, from_bits(bits_of(a) & 0x7fffffffu); }
static float s_or(float a, float b, float c) { return (void)c, from_bits(bits_of(a) | bits_of(b)); }
static float s_fused(float a, float b, float c) { return fmaf(a, b, c); }
static float s_rounded(float a, float b, float c) {
    const volatile float product = a * b; /* volatile: no compiler may fuse it */
    return flushed(product) + c;
}
static float s_less(float a, float b, float c) { return (void)c, a < b ? 1.0f : 0.0f; }
static float s_select(float a, float b, float c) { return a < b ? c : a; }

static const operation operations[] = {
    { "add", v_add, s_add, NULL },          { "sub", v_sub, s_sub, NULL },    { "mul", v_mul, s_mul, NULL },
    { "div", v_div, s_div, NULL },          { "min", v_min, s_min, NULL },    { "max", v_max, s_max, NULL },
    { "sqrt", v_sqrt, s_sqrt, NULL },       { "abs", v_abs, s_abs, NULL },    { "or", v_or, s_or, NULL },
    { "madd", v_madd, s_fused, s_rounded }, { "less", v_less, s_less, NULL }, { "select", v_select, s_select, NULL },
};

/* Whether the scalar function gives this result, of the operands as they are or flushed. */
static int agrees(float result, float (*scalar)(float a, float b, float c), float a, float b, float c) {
    const volatile float plain = scalar(a, b, c), flat = scalar(flushed(a), flushed(b), flushed(c)); /* volatile: rounded to float */
    const int rounds_up = fabsf(flat) == FLT_MIN && result == 0.0f; /* flushed before it is rounded */
    return same(result, plain) || (FLUSHES && (same(flushed(result), flushed(flat)) || rounds_up));
}

static void check_operation(const operation *op) {
    for (int i = 0; i < OPERANDS; i += SHI_LANES) {
        float out[SHI_LANES];
        shi_store(out, op->vector(shi_load(a_in + i), shi_load(b_in + i), shi_load(c_in + i)));
        for (int j = 0; j < SHI_LANES; j++) {
            const float a = a_in[i + j], b = b_in[i + j], c = c_in[i + j];
            const int good = agrees(out[j], op->scalar, a, b, c) || (op->or_scalar && agrees(out[j], op->or_scalar, a, b, c));
            if (!good)
                test_section("%s of %08x %08x %08x in lane %d: %08x", op->name, (unsigned)bits_of(a), (unsigned)bits_of(b),
                             (unsigned)bits_of(c), j, (unsigned)bits_of(out[j]));
            CHECK(good);
        }
    }
}

/* ---- Memory ---- */

/* Any bytes but floats that are signalling NaN. */
static void random_floats(unsigned char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const float any = any_operand();
        memcpy(bytes + i * sizeof any, &any, sizeof any);
    }
}

static void check_words(const unsigned char *actual, const unsigned char *expected, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t a, b;
        memcpy(&a, actual + 4 * i, sizeof a);
        memcpy(&b, expected + 4 * i, sizeof b);
        CHECK(same_bits(a, b));
    }
}

/* At every address modulo 8, and in memory of exactly a vector's size. */
static void loads_and_stores(void) {
    enum { SIZE = SHI_LANES * 4 };
    for (size_t offset = 0; offset < 8; offset++) {
        unsigned char *from = (unsigned char *)test_allocate(offset + SIZE), *to = (unsigned char *)test_allocate(offset + SIZE + 1);
        test_section("load and store at offset %d", (int)offset);
        memset(from, 0, offset + SIZE);
        random_floats(from + offset, SHI_LANES);
        memset(to, 0xa5, offset + SIZE + 1);
        shi_prefetch(from + offset);
        shi_store(to + offset, shi_load(from + offset));
        check_words(to + offset, from + offset, SHI_LANES);
        for (size_t i = 0; i < offset; i++)
            EQUAL(to[i], 0xa5);
        EQUAL(to[offset + SIZE], 0xa5);
        free(from);
        free(to);
    }
    for (int i = 0; i < SPECIALS; i++) {
        float out[SHI_LANES];
        test_section("splat of %08x", (unsigned)special[i]);
        shi_store(out, shi_splat(from_bits(special[i])));
        for (int j = 0; j < SHI_LANES; j++)
            CHECK(same_bits(bits_of(out[j]), special[i]));
    }
}

/* Memory of exactly eight lanes, or of a vector where it has fewer. */
static void eights(void) {
    enum { LANES = SHI_LANES < 8 ? SHI_LANES : 8, SIZE = LANES * 4 };
    unsigned char *from = (unsigned char *)test_allocate(SIZE), *to = (unsigned char *)test_allocate(SIZE);
    unsigned char all[SHI_LANES * 4], zero[SHI_LANES * 4] = { 0 };
    test_section("load8 and store8");
    random_floats(from, LANES);
    shi_store8(to, shi_load8(from));
    check_words(to, from, LANES);
    shi_store(all, shi_load8(from));
    check_words(all, from, LANES);
    SAME_BITS(all + SIZE, zero, sizeof all - SIZE);
    free(from);
    free(to);
}

/* Lane i is item i, `stride` bytes further; items may overlap, and have any address. */
static void load_fours(void) {
    static const size_t strides[] = { 4, 8, 12, 13, 16, 17, 20, 36, 63, 256 };
    for (size_t s = 0; s < sizeof strides / sizeof strides[0]; s++)
        for (size_t offset = 0; offset < 4; offset++) {
            const size_t stride = strides[s], size = (SHI_LANES - 1) * stride + 16;
            unsigned char *memory = (unsigned char *)test_allocate(offset + size);
            shi_v v[4];
            test_section("load4, stride %d, offset %d", (int)stride, (int)offset);
            for (size_t i = 0; i < offset + size; i++)
                memory[i] = (unsigned char)(test_bits() & 0x7eu); /* no word of them is a NaN */
            shi_load4(memory + offset, stride, v);
            for (size_t j = 0; j < 4; j++) {
                unsigned char out[SHI_LANES * 4];
                shi_store(out, v[j]);
                for (size_t i = 0; i < SHI_LANES; i++)
                    SAME_BITS(out + 4 * i, memory + offset + i * stride + 4 * j, 4);
            }
            free(memory);
        }
}

/* Three floats of each item are written, and not a byte beside them. */
static void store_threes(void) {
    static const size_t gaps[] = { 0, 1, 3, 4, 16, 100 };
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++)
        for (size_t offset = 0; offset < 4; offset++) {
            const size_t item = 4 * 3, stride = item + gaps[g], size = offset + (SHI_LANES - 1) * stride + item;
            unsigned char *actual = (unsigned char *)test_allocate(size), *expected = (unsigned char *)test_allocate(size);
            float in[3][SHI_LANES];
            test_section("store3, stride %d, offset %d", (int)stride, (int)offset);
            memset(actual, 0xa5, size);
            memset(expected, 0xa5, size);
            for (size_t j = 0; j < 3; j++) {
                test_fill(in[j], SHI_LANES, -1.0, 1.0);
                for (size_t i = 0; i < SHI_LANES; i++)
                    memcpy(expected + offset + i * stride + 4 * j, &in[j][i], 4);
            }
            shi_store3(actual + offset, stride, shi_load(in[0]), shi_load(in[1]), shi_load(in[2]));
            SAME_BITS(actual, expected, size);
            free(actual);
            free(expected);
        }
}

/* What only steers the compiler or the cache changes no value. */
static void hints(void) {
    float in[4 * SHI_LANES], out[SHI_LANES];
    test_section("keep, hide, prefetch");
    test_fill(in, SHI_LANES, -1.0, 1.0);
    shi_store(out, shi_keep(shi_load(in)));
    SAME_BITS(out, in, sizeof out);
    CHECK(shi_hide(12345) == 12345);
    shi_prefetch((const unsigned char *)in);
}

/* ---- Integers ---- */

/* The bits of a vector of integers. */
static void store_words(shi_i a, uint32_t out[SHI_LANES]) {
    shi_store(out, shi_as_float(a));
}

static void check_integers(shi_i actual, const uint32_t expected[SHI_LANES], const char *name, int operand) {
    uint32_t out[SHI_LANES];
    store_words(actual, out);
    for (int j = 0; j < SHI_LANES; j++) {
        const int good = same_bits(out[j], expected[j]);
        if (!good)
            test_section("%s by %d in lane %d: %08x, not %08x", name, operand, j, (unsigned)out[j], (unsigned)expected[j]);
        CHECK(good);
    }
}

/* 16-bit words, 32-bit words and bytes at any address, in memory of exactly their size. */
static void integer_loads(void) {
    for (int repeat = 0; repeat < 64; repeat++) {
        const size_t offset = (size_t)(repeat % 4);
        unsigned char *halves = (unsigned char *)test_allocate(offset + SHI_LANES * 2);
        unsigned char *words = (unsigned char *)test_allocate(offset + SHI_LANES * 4);
        uint32_t half[SHI_LANES], word[SHI_LANES], packed[SHI_LANES];
        for (size_t i = 0; i < SHI_LANES; i++) {
            const uint64_t bits = test_bits();
            const uint16_t low = (uint16_t)bits;
            half[i] = low & 0x8000 ? low | 0xffff0000u : low;
            word[i] = (uint32_t)(bits >> 16);
            memcpy(halves + offset + 2 * i, &low, sizeof low);
            memcpy(words + offset + 4 * i, &word[i], sizeof word[i]);
            const unsigned char *byte = words + offset + 4 * i;
            packed[i] = (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 | (uint32_t)byte[3] << 24;
        }
        check_integers(shi_iload16(halves + offset), half, "iload16", repeat);
        check_integers(shi_iload32(words + offset), word, "iload32", repeat);
        check_integers(shi_iload_bytes(words + offset), packed, "iload_bytes", repeat);
        free(halves);
        free(words);
    }
}

/* Every lane, ends of the ranges and a subnormal; all halves are in the test of texels. */
static void half_loads(void) {
#if defined(SHI_HAS_HALF)
    static const uint16_t half[] = { 0x3c00, 0xc000, 0x0001, 0x7bff, 0x8400, 0x03ff, 0x0000 };
    static const float value[] = { 1.0f, -2.0f, 1.0f / 16777216, 65504.0f, -1.0f / 16384, 1023.0f / 16777216, 0.0f };
    test_section("load_half");
    for (size_t first = 0; first < 7; first++) {
        uint16_t in[SHI_LANES];
        float out[SHI_LANES];
        for (size_t i = 0; i < SHI_LANES; i++)
            in[i] = half[(first + i) % 7];
        shi_store(out, shi_load_half(in));
        for (size_t i = 0; i < SHI_LANES; i++)
            SAME_BITS(&out[i], &value[(first + i) % 7], sizeof out[i]);
    }
#endif
}

static void integer_arithmetic(void) {
    static const uint32_t ends[] = { 0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x80000001, 0x01000001, 0x02000003 };
    for (int repeat = 0; repeat < 256; repeat++) {
        uint32_t in[SHI_LANES], and_b[SHI_LANES], add_b[SHI_LANES], shl_n[SHI_LANES], shr_n[SHI_LANES];
        float converted[SHI_LANES];
        const int n = repeat % 32, b = (int)(int32_t)(repeat < 8 ? ends[repeat] : (uint32_t)test_bits());
        for (int j = 0; j < SHI_LANES; j++) {
            in[j] = test_below(3) == 0 ? ends[test_below(8)] : (uint32_t)test_bits() >> test_below(32);
            and_b[j] = in[j] & (uint32_t)b;
            add_b[j] = in[j] + (uint32_t)b;
            shl_n[j] = in[j] << n;
            shr_n[j] = in[j] >> n;
        }
        const shi_i a = shi_iload32(in);
        check_integers(shi_iand(a, b), and_b, "iand", b);
        check_integers(shi_iadd(a, b), add_b, "iadd", b);
        check_integers(shi_shl(a, n), shl_n, "shl", n);
        check_integers(shi_shr(a, n), shr_n, "shr", n);
        shi_store(converted, shi_to_float(a));
        for (int j = 0; j < SHI_LANES; j++) {
            int32_t number;
            memcpy(&number, &in[j], sizeof number);
            test_section("to_float of %ld", (long)number);
            NEAR(converted[j], (float)number, 0);
        }
    }
}

/* ---- Lanes ---- */

static void repeat_three(void) {
    float in[SHI_LANES], out[3 * SHI_LANES];
    test_section("repeat3");
    test_fill(in, SHI_LANES, -1.0, 1.0);
    for (int part = 0; part < 3; part++)
        shi_store(out + part * SHI_LANES, shi_repeat3(shi_load(in), part));
    for (int i = 0; i < 3 * SHI_LANES; i++)
        NEAR(out[i], in[i / 3], 0);
}

/* One lane has no groups of four. */
static void transpose_four(void) {
#if SHI_LANES > 1
    float in[4][SHI_LANES], out[SHI_LANES];
    shi_v v[4];
    test_section("transpose4");
    for (int j = 0; j < 4; j++) {
        test_fill(in[j], SHI_LANES, -1.0, 1.0);
        v[j] = shi_load(in[j]);
    }
    shi_transpose4(v);
    for (int j = 0; j < 4; j++) {
        shi_store(out, v[j]);
        for (int i = 0; i < SHI_LANES; i++)
            NEAR(out[i], in[i % 4][i / 4 * 4 + j], 0);
    }
#endif
}

static void run_tests(void) {
    printf("backend %s lanes %d\n", SH_SIMD_NAME, SHI_LANES);
#ifdef SH_EXPECT_SIMD
    EQUAL(SH_SIMD, SH_EXPECT_SIMD);
#endif
    fill_operands();
    for (size_t i = 0; i < sizeof operations / sizeof operations[0]; i++)
        check_operation(&operations[i]);
    loads_and_stores();
    eights();
    load_fours();
    store_threes();
    hints();
    integer_loads();
    half_loads();
    integer_arithmetic();
    repeat_three();
    transpose_four();
}
