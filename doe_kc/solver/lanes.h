/* Arithmetic of generated code: one design (LANES 1), or one a lane of a vector of the compiler. */
#include <math.h>

#if LANES == 1

typedef double real;
#define CONSTANT(value) (value)
#define UNARY(name, function) static inline real name(real a) { return function(a); }
#define BINARY(name, function) static inline real name(real a, real b) { return function(a, b); }
static inline real less(real a, real b) { return a < b; }
static inline real at_most(real a, real b) { return a <= b; }
static inline real equal(real a, real b) { return a == b; }
static inline real unequal(real a, real b) { return a != b; }
static inline real both(real a, real b) { return a && b; }
static inline real either(real a, real b) { return a || b; }
static inline real negation(real a) { return !a; }
static inline real where(real a, real b) { return a ? b : 0.0; }

#else

typedef double real __attribute__((vector_size(8 * LANES)));
typedef long long lanes_mask __attribute__((vector_size(8 * LANES)));
#define CONSTANT(value) ((real){0} + (value))
#define TRUTH(mask) ((real)((mask) & (lanes_mask)CONSTANT(1.0)))
#define UNARY(name, function) \
    static inline real name(real a) { for (int i = 0; i < LANES; i++) a[i] = function(a[i]); return a; }
#define BINARY(name, function) \
    static inline real name(real a, real b) { for (int i = 0; i < LANES; i++) a[i] = function(a[i], b[i]); return a; }
static inline real less(real a, real b) { return TRUTH(a < b); }
static inline real at_most(real a, real b) { return TRUTH(a <= b); }
static inline real equal(real a, real b) { return TRUTH(a == b); }
static inline real unequal(real a, real b) { return TRUTH(a != b); }
static inline real both(real a, real b) { return TRUTH((a != 0.0) & (b != 0.0)); }
static inline real either(real a, real b) { return TRUTH((a != 0.0) | (b != 0.0)); }
static inline real negation(real a) { return TRUTH(a == 0.0); }
static inline real where(real a, real b) { return (real)((a != 0.0) & (lanes_mask)b); }

#endif

static inline double sign_of(double a) { return a < 0.0 ? -1.0 : a > 0.0 ? 1.0 : a; }
UNARY(square_root, sqrt)
UNARY(exponential, exp)
UNARY(logarithm, log)
UNARY(sine, sin)
UNARY(cosine, cos)
UNARY(tangent, tan)
UNARY(arcsine, asin)
UNARY(arccosine, acos)
UNARY(arctangent, atan)
UNARY(hyperbolic_sine, sinh)
UNARY(hyperbolic_cosine, cosh)
UNARY(hyperbolic_tangent, tanh)
UNARY(magnitude, fabs)
UNARY(sign, sign_of)
UNARY(round_down, floor)
UNARY(round_up, ceil)
UNARY(error_function, erf)
BINARY(power, pow)
BINARY(arctangent_2, atan2)
BINARY(smaller, fmin)
BINARY(larger, fmax)
BINARY(with_sign, copysign)
BINARY(remainder_of, fmod)
