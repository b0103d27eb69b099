/* Numbers of several designs side by side, one in each lane of the processor's vector registers. LANES is defined
   before; every function acts on each lane by itself. */
#include <math.h>
#if defined(__AVX__)
#include <immintrin.h>
#endif

typedef double lane __attribute__((vector_size(8 * LANES)));
typedef long long lane_mask __attribute__((vector_size(8 * LANES)));    /* all bits of a lane, or none */
#define LANE_FUNCTION static inline __attribute__((always_inline, unused))

LANE_FUNCTION lane lane_of(double v) { return v - (lane){0.0}; }
LANE_FUNCTION lane lane_where(lane_mask m, lane a) { return (lane)(m & (lane_mask)a); }
LANE_FUNCTION lane lane_truth(lane_mask m) { return lane_where(m, lane_of(1.0)); }
LANE_FUNCTION lane lane_select(lane_mask m, lane a, lane b) { return (lane)((m & (lane_mask)a) | (~m & (lane_mask)b)); }
LANE_FUNCTION lane lane_fmax(lane a, lane b) { return lane_select(a > b, a, b); }
LANE_FUNCTION lane lane_fmin(lane a, lane b) { return lane_select(a < b, a, b); }
LANE_FUNCTION lane lane_fabs(lane a) { return (lane)((lane_mask)a & 0x7fffffffffffffffLL); }

LANE_FUNCTION lane lane_sqrt(lane a) {
#if defined(__AVX512F__) && LANES == 8
    return (lane)_mm512_sqrt_pd((__m512d)a);
#elif defined(__AVX__) && LANES == 4
    return (lane)_mm256_sqrt_pd((__m256d)a);
#else
    for (int i = 0; i < LANES; i++) a[i] = sqrt(a[i]);
    return a;
#endif
}

LANE_FUNCTION lane lane_sign(lane a) {
    for (int i = 0; i < LANES; i++) a[i] = a[i] < 0.0 ? -1.0 : a[i] > 0.0 ? 1.0 : a[i];
    return a;
}

#define LANE_BY_LANE_1(f) \
    LANE_FUNCTION lane lane_##f(lane a) { \
        for (int i = 0; i < LANES; i++) a[i] = f(a[i]); \
        return a; \
    }
#define LANE_BY_LANE_2(f) \
    LANE_FUNCTION lane lane_##f(lane a, lane b) { \
        for (int i = 0; i < LANES; i++) a[i] = f(a[i], b[i]); \
        return a; \
    }
/* of the vector library of glibc from 2.35 on: within 4 units in the last place */
#if VECTOR_LIBRARY && LANES == 8
#define OF_LIBRARY_1(f) lane _ZGVeN8v_##f(lane); LANE_FUNCTION lane lane_##f(lane a) { return _ZGVeN8v_##f(a); }
#define OF_LIBRARY_2(f) lane _ZGVeN8vv_##f(lane, lane); LANE_FUNCTION lane lane_##f(lane a, lane b) { return _ZGVeN8vv_##f(a, b); }
#elif VECTOR_LIBRARY && LANES == 4
#define OF_LIBRARY_1(f) lane _ZGVdN4v_##f(lane); LANE_FUNCTION lane lane_##f(lane a) { return _ZGVdN4v_##f(a); }
#define OF_LIBRARY_2(f) lane _ZGVdN4vv_##f(lane, lane); LANE_FUNCTION lane lane_##f(lane a, lane b) { return _ZGVdN4vv_##f(a, b); }
#else
#define OF_LIBRARY_1 LANE_BY_LANE_1
#define OF_LIBRARY_2 LANE_BY_LANE_2
#endif

OF_LIBRARY_1(exp) OF_LIBRARY_1(log) OF_LIBRARY_1(sin) OF_LIBRARY_1(cos) OF_LIBRARY_1(tan)
OF_LIBRARY_1(asin) OF_LIBRARY_1(acos) OF_LIBRARY_1(atan) OF_LIBRARY_1(sinh) OF_LIBRARY_1(cosh) OF_LIBRARY_1(tanh)
OF_LIBRARY_1(asinh) OF_LIBRARY_1(acosh) OF_LIBRARY_1(atanh) OF_LIBRARY_1(log1p) OF_LIBRARY_1(expm1) OF_LIBRARY_1(erf)
OF_LIBRARY_2(pow) OF_LIBRARY_2(atan2) OF_LIBRARY_2(hypot)
LANE_BY_LANE_1(floor) LANE_BY_LANE_1(ceil)
LANE_BY_LANE_2(remainder) LANE_BY_LANE_2(copysign) LANE_BY_LANE_2(fmod)
