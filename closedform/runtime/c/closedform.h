/* closedform.h: the code that all generated C modules share.
 *
 * C99 (and C++), header only, no state. real_t is double, or float if CLOSEDFORM_FLOAT is defined.
 * Compile with -O3 -fno-math-errno -fno-trapping-math -ffp-contract=fast. Without -fno-math-errno
 * and -fno-trapping-math a compiler may not vectorise the selects below. -ffp-contract=fast, which
 * gcc switches off under -std=c99, allows fused multiply-adds and makes the code a third faster. The
 * error bounds hold with and without it. Do not use -ffast-math: the argument reduction depends on
 * the order of its operations.
 *
 * For finite input (angles up to 1e11), a call for one posture does not raise the floating-point
 * exceptions invalid, division by zero and overflow if its answer is finite or a status reports the
 * failure. The same holds for a batch if CLOSEDFORM_TRAP_SAFE is defined. Rounding is to nearest.
 */
#ifndef CLOSEDFORM_H
#define CLOSEDFORM_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(_M_FP_FAST)
#error "closedform.h needs IEEE arithmetic: compile without -ffast-math, -ffinite-math-only, /fp:fast"
#endif
#if defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "closedform.h needs IEEE arithmetic: compile without -funsafe-math-optimizations and its parts"
#endif
#if FLT_EVAL_METHOD < 0 || FLT_EVAL_METHOD == 2 || \
    (FLT_EVAL_METHOD == 1 && defined(CLOSEDFORM_FLOAT))
#error "closedform.h needs arithmetic in the declared type: on x86 compile with -msse2 -mfpmath=sse"
#endif

/* Some compilers define no macro for these options. They are told to ignore the options from here to
 * the end of the source that includes this header. */
#if defined(__clang__)
#pragma clang fp reassociate(off)
#if __clang_major__ >= 18
#pragma clang fp reciprocal(off)
#endif
#elif defined(__GNUC__) && __GNUC__ < 12
#pragma GCC optimize("no-associative-math", "no-reciprocal-math", "signed-zeros")
#endif

#if defined(__GNUC__)
#define CF_INLINE static inline __attribute__((always_inline))
#define CF_RARE static __attribute__((cold, noinline, unused))
#define CF_OUT_OF_LINE static __attribute__((noinline))
#define CF_RESTRICT __restrict
#define CF_UNLIKELY(condition) __builtin_expect((condition), 0)
#else
#define CF_INLINE static inline
#define CF_RARE static inline
#define CF_OUT_OF_LINE static
#define CF_RESTRICT
#define CF_UNLIKELY(condition) (condition)
#endif

/* Before a loop over the postures of a batch: no iteration reads what another writes, because an
 * output does not overlap any other array. Without this hint a compiler first compares every plane
 * with every other at run time, and gcc gives up beyond ten comparisons. gcc uses `restrict` on
 * parameters only. */
#if defined(__clang__)
#define CF_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define CF_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CF_INDEPENDENT
#endif

/* Before the definition of a function: with CLOSEDFORM_DISPATCH, gcc builds it for AVX-512, AVX2 and
 * the baseline, and the loader picks one. Clang builds no clones; here it is told not to warn about a
 * CF_INDEPENDENT loop that its flags leave scalar. */
#if defined(__clang__)
#define CLOSEDFORM_DISPATCHED _Pragma("clang diagnostic ignored \"-Wpass-failed\"")
#elif defined(CLOSEDFORM_DISPATCH) && defined(__x86_64__) && defined(__GLIBC__) && \
    defined(__GNUC__) && __GNUC__ >= 12
#define CLOSEDFORM_DISPATCHED \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CLOSEDFORM_DISPATCHED
#endif

/* Postures per block of a batch loop: the scratch arrays of a block stay in the first-level cache. */
#define CLOSEDFORM_BLOCK 256

/* Status of one solution, stored as uint8_t. */
enum closedform_status {
    CLOSEDFORM_OK = 0,
    CLOSEDFORM_UNREACHABLE = 1, /* no solution; the joints are NaN */
    CLOSEDFORM_SINGULAR = 2,    /* a joint is free: it has the value of the convention, and
                                   fk(q) = x; or rounded joints do not determine the posture */
    CLOSEDFORM_INVALID = 3      /* non-finite input or impossible parameter; the joints are NaN */
};

#ifdef CLOSEDFORM_FLOAT
typedef float real_t;
typedef uint32_t cf_word; /* the bits of a real_t */
#define CF_LIBM(name) name##f
#else
typedef double real_t;
typedef uint64_t cf_word;
#define CF_LIBM(name) name
#endif

/* A decimal literal as real_t, without an implicit conversion. */
#define CLOSEDFORM_C(x) ((real_t)(x))
#define CLOSEDFORM_NAN CLOSEDFORM_C(NAN)
/* The fraction of a natural scale that counts as zero, and the sizes of a mechanism between which no
 * power up to the second, third ... leaves the range of the type. tolerances.py gives the reasons. */
#ifdef CLOSEDFORM_FLOAT
#define CLOSEDFORM_FEASIBILITY CLOSEDFORM_C(1e-06)
#define CLOSEDFORM_VANISHING CLOSEDFORM_C(4.76837158203125e-07)
#define CLOSEDFORM_DETERMINED CLOSEDFORM_C(0.015625)
#define CLOSEDFORM_HALF_DIGITS CLOSEDFORM_C(0.000244140625)
#define CLOSEDFORM_ROUNDING CLOSEDFORM_C(7.62939453125e-06)
#define CLOSEDFORM_ROTATION CLOSEDFORM_C(0.0001)
#define CF_SIZES_2 CLOSEDFORM_C(2.3283064365386963e-10), CLOSEDFORM_C(7.205759403792794e+16)
#define CF_SIZES_3 CLOSEDFORM_C(4.76837158203125e-07), CLOSEDFORM_C(137438953472.0)
#define CF_SIZES_4 CLOSEDFORM_C(1.52587890625e-05), CLOSEDFORM_C(268435456.0)
#define CF_SIZES_5 CLOSEDFORM_C(0.000244140625), CLOSEDFORM_C(4194304.0)
#define CF_SIZES_6 CLOSEDFORM_C(0.0009765625), CLOSEDFORM_C(262144.0)
#define CF_SIZES_7 CLOSEDFORM_C(0.001953125), CLOSEDFORM_C(65536.0)
#define CF_SIZES_8 CLOSEDFORM_C(0.00390625), CLOSEDFORM_C(16384.0)
#define CF_SIZES_9 CLOSEDFORM_C(0.0078125), CLOSEDFORM_C(4096.0)
#define CF_SIZES_10 CLOSEDFORM_C(0.015625), CLOSEDFORM_C(2048.0)
#define CF_SIZES_11 CLOSEDFORM_C(0.03125), CLOSEDFORM_C(1024.0)
#define CF_SIZES_12 CLOSEDFORM_C(0.03125), CLOSEDFORM_C(512.0)
#define CF_SIZES_13 CLOSEDFORM_C(0.0625), CLOSEDFORM_C(256.0)
#define CF_SIZES_14 CLOSEDFORM_C(0.0625), CLOSEDFORM_C(256.0)
#define CF_SIZES_15 CLOSEDFORM_C(0.0625), CLOSEDFORM_C(128.0)
#define CF_SIZES_16 CLOSEDFORM_C(0.0625), CLOSEDFORM_C(128.0)
#else
#define CLOSEDFORM_FEASIBILITY CLOSEDFORM_C(1e-12)
#define CLOSEDFORM_VANISHING CLOSEDFORM_C(8.881784197001252e-16)
#define CLOSEDFORM_DETERMINED CLOSEDFORM_C(0.0009765625)
#define CLOSEDFORM_HALF_DIGITS CLOSEDFORM_C(2.384185791015625e-07)
#define CLOSEDFORM_ROUNDING CLOSEDFORM_C(5.684341886080802e-14)
#define CLOSEDFORM_ROTATION CLOSEDFORM_C(1e-06)
#define CF_SIZES_2 CLOSEDFORM_C(8.636168555094445e-78), CLOSEDFORM_C(3.273390607896142e+150)
#define CF_SIZES_3 CLOSEDFORM_C(6.681911775230489e-52), CLOSEDFORM_C(1.7498005798264095e+100)
#define CF_SIZES_4 CLOSEDFORM_C(2.938735877055719e-39), CLOSEDFORM_C(1.8092513943330656e+75)
#define CF_SIZES_5 CLOSEDFORM_C(1.9721522630525295e-31), CLOSEDFORM_C(1.6069380442589903e+60)
#define CF_SIZES_6 CLOSEDFORM_C(2.5849394142282115e-26), CLOSEDFORM_C(9.353610478917779e+49)
#define CF_SIZES_7 CLOSEDFORM_C(1.0587911840678754e-22), CLOSEDFORM_C(5.575186299632656e+42)
#define CF_SIZES_8 CLOSEDFORM_C(5.421010862427522e-20), CLOSEDFORM_C(4.253529586511731e+37)
#define CF_SIZES_9 CLOSEDFORM_C(1.3877787807814457e-17), CLOSEDFORM_C(2.596148429267414e+33)
#define CF_SIZES_10 CLOSEDFORM_C(4.440892098500626e-16), CLOSEDFORM_C(1.2676506002282294e+30)
#define CF_SIZES_11 CLOSEDFORM_C(1.4210854715202004e-14), CLOSEDFORM_C(1.2379400392853803e+27)
#define CF_SIZES_12 CLOSEDFORM_C(2.2737367544323206e-13), CLOSEDFORM_C(9.671406556917033e+24)
#define CF_SIZES_13 CLOSEDFORM_C(1.8189894035458565e-12), CLOSEDFORM_C(7.555786372591432e+22)
#define CF_SIZES_14 CLOSEDFORM_C(1.4551915228366852e-11), CLOSEDFORM_C(2.3611832414348226e+21)
#define CF_SIZES_15 CLOSEDFORM_C(5.820766091346741e-11), CLOSEDFORM_C(7.378697629483821e+19)
#define CF_SIZES_16 CLOSEDFORM_C(2.3283064365386963e-10), CLOSEDFORM_C(4.611686018427388e+18)
#endif

/* The real_t nearest to pi: the largest angle returned. */
#define CF_PI CLOSEDFORM_C(3.141592653589793)

#define CF_TOP_BIT (8u * sizeof(cf_word) - 1u)
#define CF_SIGN ((cf_word)((cf_word)1 << CF_TOP_BIT))

CF_INLINE cf_word cf_to_word(real_t x)
{
    cf_word w;
    memcpy(&w, &x, sizeof w);
    return w;
}

CF_INLINE real_t cf_from_word(cf_word w)
{
    real_t x;
    memcpy(&x, &w, sizeof x);
    return x;
}

/* a if `condition` is 1, b if it is 0. It works on bits: gcc turns `?:` into jumps if several
 * selections share a condition, and then vectorises nothing. */
CF_INLINE real_t cf_select(int condition, real_t a, real_t b)
{
    const cf_word mask = (cf_word)0 - (cf_word)condition;
    return cf_from_word((cf_to_word(a) & mask) | (cf_to_word(b) & ~mask));
}

/* The same for a `condition` that is hardly ever 1 and an a that is expensive. A single call jumps
 * over the computation of a; a batch selects. If a is cheap, use cf_select: a jump costs more than it
 * saves, because code on both sides of it is not vectorised together. */
CF_INLINE real_t cf_rarely(int single, int condition, real_t a, real_t b)
{
    if (single) return CF_UNLIKELY(condition) ? a : b;
    return cf_select(condition, a, b);
}

/* The divisor, or 1 if `unused` is 1. Nothing uses the quotient then, and the divisor may be zero; 1
 * avoids a floating-point exception. In a batch the selection would take up to a fifteenth of the
 * time, so a batch makes it only if CLOSEDFORM_TRAP_SAFE is defined. */
CF_INLINE real_t cf_divisor(int single, int unused, real_t divisor)
{
#ifdef CLOSEDFORM_TRAP_SAFE
    (void)single;
    return cf_select(unused, CLOSEDFORM_C(1.0), divisor);
#else
    return single && CF_UNLIKELY(unused) ? CLOSEDFORM_C(1.0) : divisor;
#endif
}

CF_INLINE real_t cf_sqrt(real_t x) { return CF_LIBM(sqrt)(x); }
CF_INLINE real_t cf_abs(real_t x) { return CF_LIBM(fabs)(x); }
CF_INLINE real_t cf_copysign(real_t size, real_t sign) { return CF_LIBM(copysign)(size, sign); }

/* Whether floating-point exceptions are avoided: in single calls always, in batches on request. */
CF_INLINE int cf_careful(int single)
{
#ifdef CLOSEDFORM_TRAP_SAFE
    (void)single;
    return 1;
#else
    return single;
#endif
}

/* a / b; does not raise an exception if b is zero. */
CF_INLINE real_t cf_quotient(int single, real_t a, real_t b)
{
    if (!cf_careful(single)) return a / b;
    const int zero = b == 0;
    const real_t quotient = a / cf_divisor(single, zero, b);
    const real_t infinite = cf_copysign(CLOSEDFORM_C(INFINITY), cf_copysign(1, a) * cf_copysign(1, b));
    return cf_rarely(single, zero, a == 0 ? CLOSEDFORM_NAN : infinite, quotient);
}

/* The divisor, or NaN if it is zero: the quotient is then NaN and no exception is raised. */
CF_INLINE real_t cf_nonzero(int single, real_t divisor)
{
    if (!cf_careful(single)) return divisor;
    return cf_rarely(single, divisor == 0, CLOSEDFORM_NAN, divisor);
}

/* NaN if `failed`, else zero: added to an answer, it is one selection for all entries. A single call
 * jumps, so that nothing waits for the condition. */
CF_INLINE real_t cf_poison(int single, int failed)
{
    return cf_rarely(single, failed, CLOSEDFORM_NAN, CLOSEDFORM_C(0.0));
}

/* The status of a branch. INVALID takes precedence over UNREACHABLE, and that over SINGULAR. */
CF_INLINE real_t cf_status(int single, int invalid, int unreachable, int singular)
{
    if (single && !CF_UNLIKELY(invalid | unreachable | singular)) return CLOSEDFORM_C(0.0);
    const real_t reached = cf_select(singular, CLOSEDFORM_C(2.0), CLOSEDFORM_C(0.0));
    const real_t valid = cf_select(unreachable, CLOSEDFORM_C(1.0), reached);
    return cf_select(invalid, CLOSEDFORM_C(3.0), valid);
}

/* CF_HIDE, cf_one and cf_rounded keep a product that decides a status out of a fused multiply-add. The
 * status is then the same on every processor and in NumPy. A batch multiplies the product by cf_one,
 * which a compiler cannot know to be 1; the compiler fuses this second, exact product with the addition
 * instead. A single call puts an empty instruction between product and addition. In a batch that
 * instruction would prevent vectorisation. */
#if (defined(__x86_64__) || defined(__i386__)) && !defined(__FMA__) && !defined(__FMA4__) && \
    !defined(CLOSEDFORM_DISPATCH)
#define CF_HIDE(x) (void)(x) /* nothing is fused */
#elif defined(__GNUC__) && defined(__SSE2__)
#define CF_HIDE(x) __asm__("" : "+x"(x))
#elif defined(__GNUC__) && defined(__aarch64__)
#define CF_HIDE(x) __asm__("" : "+w"(x))
#endif

CF_INLINE real_t cf_one(void)
{
#ifdef CF_HIDE
    real_t one = CLOSEDFORM_C(1.0);
    CF_HIDE(one);
#else
    volatile real_t one = CLOSEDFORM_C(1.0);
#endif
    return one;
}

CF_INLINE real_t cf_rounded(int single, real_t one, real_t x)
{
#ifdef CF_HIDE
    if (single) {
        CF_HIDE(x);
        return x;
    }
#else
    (void)single;
#endif
    return x * one;
}


/* 1 or -1; 1 for either zero. */
CF_INLINE real_t cf_sign(real_t x) { return cf_copysign(CLOSEDFORM_C(1.0), x + CLOSEDFORM_C(0.0)); }

/* One instruction each, unlike fmax and fmin. If either argument is NaN, the result is b. */
CF_INLINE real_t cf_max(real_t a, real_t b) { return a > b ? a : b; }
CF_INLINE real_t cf_min(real_t a, real_t b) { return a < b ? a : b; }

/* The square root of x, which is negative only if the answer is rejected. A batch then takes NaN,
 * which raises an exception; a single call takes zero. */
CF_INLINE real_t cf_root(int single, real_t x)
{
    return cf_sqrt(cf_careful(single) ? cf_max(CLOSEDFORM_C(0.0), x) : x);
}

/* Zero, or NaN if x is not finite. A sum of these is zero only if all the numbers are finite. */
CF_INLINE real_t cf_nought(real_t x) { return CLOSEDFORM_C(0.0) * x; }

/* A word with its sign bit set unless least <= size <= most; a loop ORs the words of its postures. No
 * size is negative, so the words are in the order of the numbers. */
CF_INLINE cf_word cf_size_excess(real_t size, real_t least, real_t most)
{
    const cf_word w = cf_to_word(size);
    return (w - cf_to_word(least)) | (cf_to_word(most) - w);
}

/* The exponent of a power of two near the size; 0 for zero, infinity and NaN. It is a multiple of 4, so
 * that roots of powers of lengths are also multiplied by powers of two. */
CF_RARE int cf_exponent(real_t size)
{
    int exponent = 0;
    if (cf_to_word(size) < cf_to_word(CLOSEDFORM_C(INFINITY))) (void)CF_LIBM(frexp)(size, &exponent);
    return exponent - exponent % 4;
}

/* Multiplies every number by 2^(degree * exponent), with its own degree. */
CF_RARE void cf_rescale(size_t n, const signed char *degrees, int exponent, const real_t *x,
                        real_t *scaled)
{
    for (size_t k = 0; k < n; ++k)
        scaled[k] = CF_LIBM(ldexp)(x[k], degrees[k] * exponent);
}

#include "closedform_angles.h"

#endif
