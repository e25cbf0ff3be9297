/* bench_report.h - the results as a table and as JSON. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include "bench_measure.h"

#if defined(__APPLE__)
#include <sys/sysctl.h>
#endif

#ifndef SH_BENCH_FLAGS
#define SH_BENCH_FLAGS "unknown flags"
#endif

/* ---- The machine ------------------------------------------------------------------------------------------------------------- */

typedef struct bench_machine {
    char cpu[128], compiler[128];
    const char *flags, *simd;
    int lanes;
} bench_machine;

/* The value of the first line of /proc/cpuinfo that starts with `key`; 0 if there is none. */
static inline int bench_cpuinfo(const char *key, char *value, size_t size) {
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    int found = 0;
    while (file && !found && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (!colon || strncmp(line, key, strlen(key)) != 0)
            continue;
        snprintf(value, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
        value[strcspn(value, "\r\n")] = '\0';
        found = value[0] != '\0';
    }
    if (file)
        fclose(file);
    return found;
}

static inline void bench_cpu_name(char *name, size_t size) {
    snprintf(name, size, "unknown CPU");
#if defined(__APPLE__)
    if (sysctlbyname("machdep.cpu.brand_string", name, &size, NULL, 0) != 0)
        snprintf(name, size, "unknown CPU");
#elif defined(_WIN32)
    const char *identifier = getenv("PROCESSOR_IDENTIFIER");
    if (identifier)
        snprintf(name, size, "%s", identifier);
#else
    if (!bench_cpuinfo("model name", name, size) && !bench_cpuinfo("Model", name, size))
        bench_cpuinfo("cpu model", name, size);
#endif
}

static inline bench_machine bench_describe_machine(void) {
    bench_machine machine;
    bench_cpu_name(machine.cpu, sizeof machine.cpu);
#if defined(__clang__)
    snprintf(machine.compiler, sizeof machine.compiler, "clang %d.%d.%d", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
    snprintf(machine.compiler, sizeof machine.compiler, "gcc %d.%d.%d", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#elif defined(_MSC_VER)
    snprintf(machine.compiler, sizeof machine.compiler, "MSVC %d", _MSC_VER);
#else
    snprintf(machine.compiler, sizeof machine.compiler, "unknown compiler");
#endif
    machine.flags = SH_BENCH_FLAGS;
    machine.simd = SH_SIMD_NAME;
    machine.lanes = SHI_LANES;
    return machine;
}

/* ---- The table, 132 columns -------------------------------------------------------------------------------------------------- */

static inline void bench_print_heading(const bench_machine *machine) {
    printf("%s, %s %s, %s (%d float%s a vector), one thread\n\n", machine->cpu, machine->compiler, machine->flags, machine->simd,
           machine->lanes, machine->lanes == 1 ? "" : "s");
    printf("An item is a direction, a sample or a texel. ns/item: fastest turn, and median of all; spread: between their "
           "quartiles, of the median.\n"
           "error: the largest, of the mean radiance, against long double. The limit of a case is, per item, multiply-adds at the "
           "peak of this\n"
           "backend, or reading, writing or copying (read + written) bytes.\n\n");
    printf("%-40s %8s %8s %7s %9s   %-27s %s\n", "case", "ns/item", "median", "spread", "error", "times faster than baseline",
           "times the limit");
}

/* A family is the first two parts of a name that has at least four. */
static inline size_t bench_family_length(const char *name) {
    const char *first = strchr(name, '/'), *second = first ? strchr(first + 1, '/') : NULL;
    const char *third = second ? strchr(second + 1, '/') : NULL;
    return third ? (size_t)(second - name) : first ? (size_t)(first - name) : strlen(name);
}

static inline int bench_same_family(const char *a, const char *b) {
    const size_t length = bench_family_length(a);
    return bench_family_length(b) == length && strncmp(a, b, length) == 0;
}

/* Three significant digits. */
static inline void bench_print_ratio(double ratio) {
    printf(" %6.*f x ", ratio < 9.995 ? 2 : ratio < 99.95 ? 1 : 0, ratio);
}

static inline void bench_print_result(const bench_result *result, const bench_result *previous) {
    char limit[32];
    bench_limit_name(&result->test->limit, limit, sizeof limit);
    if (!previous || !bench_same_family(previous->test->name, result->test->name))
        printf("\n");
    printf("%-40s %8.3f %8.3f %6.1f%% ", result->test->name, result->ns, result->ns_median, 100.0 * result->spread);
    if (result->error == 0.0)
        printf("%9s", "exact");
    else
        printf("%9.1e", result->error);
    bench_print_ratio(result->baseline_ns / result->ns);
    printf("%-18s", result->test->baseline);
    bench_print_ratio(result->ns / result->limit_ns);
    printf("%s%s\n", limit, bench_failed(result) ? "  WRONG" : "");
    fflush(stdout);
}

/* ---- JSON -------------------------------------------------------------------------------------------------------------------- */

static inline void bench_json_string(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            fprintf(file, "\\%c", c);
        else if (c < 0x20 || c > 0x7e)
            fprintf(file, "\\u%04x", c);
        else
            fputc(c, file);
    }
    fputc('"', file);
}

/* The members of an object: the first has no comma before it. */
static inline void bench_json_key(FILE *file, int first, const char *key) {
    fputs(first ? "" : ", ", file);
    bench_json_string(file, key);
    fputs(": ", file);
}

/* JSON has no NaN and no infinity: they become null. */
static inline void bench_json_number(FILE *file, const char *key, double value) {
    bench_json_key(file, 0, key);
    if (value - value == 0.0)
        fprintf(file, "%.9g", value);
    else
        fputs("null", file);
}

static inline void bench_json_text(FILE *file, int first, const char *key, const char *value) {
    bench_json_key(file, first, key);
    bench_json_string(file, value);
}

static inline void bench_json_case(FILE *file, const bench_result *result) {
    char limit[32];
    bench_limit_name(&result->test->limit, limit, sizeof limit);
    fputs("    { ", file);
    bench_json_text(file, 1, "name", result->test->name);
    bench_json_number(file, "ns", result->ns);
    bench_json_number(file, "ns_median", result->ns_median);
    bench_json_number(file, "spread", result->spread);
    bench_json_number(file, "items", (double)result->test->items);
    bench_json_text(file, 0, "baseline", result->test->baseline);
    bench_json_number(file, "times_faster", result->baseline_ns / result->ns);
    bench_json_text(file, 0, "limit", limit);
    bench_json_number(file, "times_limit", result->ns / result->limit_ns);
    bench_json_number(file, "error", result->error);
    fputs(" }", file);
}

static inline void bench_write_json(FILE *file, const bench_machine *machine, const bench_result *results, int count) {
    fputs("{\n  \"machine\": { ", file);
    bench_json_text(file, 1, "cpu", machine->cpu);
    bench_json_text(file, 0, "compiler", machine->compiler);
    bench_json_text(file, 0, "flags", machine->flags);
    bench_json_text(file, 0, "simd", machine->simd);
    bench_json_number(file, "lanes", machine->lanes);
    fputs(" },\n  \"cases\": [\n", file);
    for (int i = 0; i < count; i++) {
        bench_json_case(file, &results[i]);
        fputs(i + 1 < count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
}

#endif /* BENCH_REPORT_H */
