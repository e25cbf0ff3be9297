/* What sh.h and its tests take from <math.h>, for clang in MSVC mode, where Microsoft's headers are not at hand. long double is
 * double there, and its functions are inline. */
#ifndef CI_MATH_H
#define CI_MATH_H

#define INFINITY __builtin_inff()
#define NAN __builtin_nanf("")
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define isfinite(x) __builtin_isfinite(x)
#define signbit(x) __builtin_signbit(x)

#define CI_MATH_1(name)                                                                                                            \
    double name(double);                                                                                                           \
    float name##f(float);                                                                                                          \
    static inline long double name##l(long double x) { return name((double)x); }
#define CI_MATH_2(name)                                                                                                            \
    double name(double, double);                                                                                                   \
    float name##f(float, float);                                                                                                   \
    static inline long double name##l(long double x, long double y) { return name((double)x, (double)y); }

CI_MATH_1(acos)
CI_MATH_1(asin)
CI_MATH_1(atan)
CI_MATH_1(cos)
CI_MATH_1(exp)
CI_MATH_1(expm1)
CI_MATH_1(fabs)
CI_MATH_1(floor)
CI_MATH_1(log)
CI_MATH_1(log1p)
CI_MATH_1(sin)
CI_MATH_1(sinh)
CI_MATH_1(sqrt)
CI_MATH_1(tan)
CI_MATH_1(tanh)
CI_MATH_2(atan2)
CI_MATH_2(copysign)
CI_MATH_2(fmax)
CI_MATH_2(fmin)
CI_MATH_2(fmod)
CI_MATH_2(nextafter)
CI_MATH_2(pow)

float fmaf(float, float, float);
float frexpf(float, int *);
double frexp(double, int *);
double ldexp(double, int);
float ldexpf(float, int);
static inline long double ldexpl(long double x, int e) { return ldexp((double)x, e); }

#endif
