/* Samples cf_sincos_block and cf_atan2 against a wider libm and prints the worst arguments.
 *
 *   accuracy FUNCTION SAMPLES SEED KEEP
 *
 * FUNCTION is sincos, atan2, or all for sincos of every bit pattern of a float; it prints a line
 * `output build ulps x y got` for each of the KEEP worst, the bit patterns in hexadecimal. One
 * reference serves two builds of the header, so this file is compiled three times: twice with
 * EVALUATE, the name of a build, for what is tested, and once without for the rest.
 */
#include "closedform.h"

#define JOIN2(a, b) a##b
#define JOIN(a, b) JOIN2(a, b)
#define BLOCK 64

#ifdef EVALUATE

void JOIN(sincos_, EVALUATE)(const real_t *x, real_t *s, real_t *c);
void JOIN(atan2_, EVALUATE)(const real_t *y, const real_t *x, real_t *angle);

void JOIN(sincos_, EVALUATE)(const real_t *x, real_t *s, real_t *c)
{
    cf_sincos_block(BLOCK, x, s, c);
}

void JOIN(atan2_, EVALUATE)(const real_t *y, const real_t *x, real_t *angle)
{
    for (size_t i = 0; i < BLOCK; ++i) angle[i] = cf_atan2(y[i], x[i]);
}

#else

#include <float.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

void sincos_fused(const real_t *x, real_t *s, real_t *c);
void sincos_separate(const real_t *x, real_t *s, real_t *c);
void atan2_fused(const real_t *y, const real_t *x, real_t *angle);
void atan2_separate(const real_t *y, const real_t *x, real_t *angle);

#ifdef CLOSEDFORM_FLOAT
typedef double wide_t;
#define WIDE(name) name
#define MANTISSA 23
#define EXPONENTS 255
#define LOWEST (-126)
#define LOCAL (-16) /* from here to the limit of the reduction sine and cosine are no constants */
#define LOCAL_EXPONENTS 25
#define SPREAD 28 /* further apart than 2^SPREAD, the angle of two numbers is y/x or a right one */
#else
#if LDBL_MANT_DIG < 64
#error "long double is no wider than double here: only the float build has a reference"
#endif
typedef long double wide_t;
#define WIDE(name) name##l
#define MANTISSA 52
#define EXPONENTS 2047
#define LOWEST (-1022)
#define LOCAL (-30)
#define LOCAL_EXPONENTS 50
#define SPREAD 60
#endif
#define BIAS (1 - LOWEST)

typedef struct {
    double ulps;
    real_t x, y, got;
} Sample;

typedef struct {
    const char *output, *build;
    Sample *worst;
    int lowest; /* index of the least of the worst */
} Record;

static int keep;

static Record record(const char *output, const char *build)
{
    Record r = { output, build, calloc((size_t)keep, sizeof(Sample)), 0 };
    if (!r.worst) exit(1);
    return r;
}

static void print(const Record *r)
{
    for (int i = 0; i < keep; ++i) {
        const Sample *w = &r->worst[i];
        if (w->ulps > 0)
            printf("%s %s %.6f %" PRIx64 " %" PRIx64 " %" PRIx64 "\n", r->output, r->build, w->ulps,
                   (uint64_t)cf_to_word(w->x), (uint64_t)cf_to_word(w->y),
                   (uint64_t)cf_to_word(w->got));
    }
}

/* An ulp is the spacing of real_t in the binade of the exact value, as in the tests. A NaN counts
 * as infinitely wrong. */
static void measure(Record *r, real_t x, real_t y, real_t got, wide_t exact)
{
    int e;
    (void)WIDE(frexp)(exact, &e);
    e = e - 1 < LOWEST ? LOWEST : e - 1;
    const double error = (double)WIDE(ldexp)(WIDE(fabs)((wide_t)got - exact), MANTISSA - e);
    if (error <= r->worst[r->lowest].ulps) return;
    r->worst[r->lowest] = (Sample){ error == error ? error : HUGE_VAL, x, y, got };
    for (int i = 0; i < keep; ++i)
        if (r->worst[i].ulps < r->worst[r->lowest].ulps) r->lowest = i;
}

static uint64_t state;

static uint64_t splitmix(void)
{
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static uint32_t below(uint32_t n) { return (uint32_t)(((splitmix() >> 32) * n) >> 32); }

/* A number with this exponent field, of either sign. */
static real_t pattern(int field)
{
    const uint64_t bits = splitmix();
    const cf_word mantissa = (cf_word)(bits >> 8) & (((cf_word)1 << MANTISSA) - 1);
    return cf_from_word(((cf_word)(bits & 1) << CF_TOP_BIT) | ((cf_word)field << MANTISSA) |
                        mantissa);
}

static Record fused[2], separate[2];

static void test_sincos(const real_t *x, int symmetric)
{
    real_t s[2][BLOCK], c[2][BLOCK], minus[BLOCK], s_minus[BLOCK], c_minus[BLOCK];
    sincos_fused(x, s[0], c[0]);
    sincos_separate(x, s[1], c[1]);
    for (int i = 0; i < BLOCK; ++i) {
        const wide_t exact_s = WIDE(sin)((wide_t)x[i]), exact_c = WIDE(cos)((wide_t)x[i]);
        measure(&fused[0], x[i], 0, s[0][i], exact_s);
        measure(&separate[0], x[i], 0, s[1][i], exact_s);
        measure(&fused[1], x[i], 0, c[0][i], exact_c);
        measure(&separate[1], x[i], 0, c[1][i], exact_c);
        minus[i] = -x[i];
    }
    /* The other half of all patterns needs no reference: bit for bit the mirror image. */
    for (int k = 0; symmetric && k < 2; ++k) {
        (k ? sincos_separate : sincos_fused)(minus, s_minus, c_minus);
        for (int i = 0; i < BLOCK; ++i)
            if (cf_to_word(s_minus[i]) != (cf_to_word(s[k][i]) ^ CF_SIGN) ||
                cf_to_word(c_minus[i]) != cf_to_word(c[k][i]))
                measure(&(k ? separate : fused)[0], minus[i], 0, CLOSEDFORM_NAN, 0);
    }
}

static void test_atan2(const real_t *y, const real_t *x)
{
    real_t a[2][BLOCK];
    atan2_fused(y, x, a[0]);
    atan2_separate(y, x, a[1]);
    for (int i = 0; i < BLOCK; ++i) {
        const wide_t exact = WIDE(atan2)((wide_t)y[i], (wide_t)x[i]);
        measure(&fused[0], x[i], y[i], a[0][i], exact);
        measure(&separate[0], x[i], y[i], a[1][i], exact);
    }
}

/* Half of the samples have any exponent, half one where the answer is neither x nor a constant. */
static void sample_sincos(void)
{
    real_t x[BLOCK];
    for (int i = 0; i < BLOCK; ++i)
        x[i] = pattern(i % 2 ? (int)below(EXPONENTS) : BIAS + LOCAL + (int)below(LOCAL_EXPONENTS));
    test_sincos(x, 0);
}

static void sample_atan2(void)
{
    real_t x[BLOCK], y[BLOCK];
    for (int i = 0; i < BLOCK; ++i) {
        const int field = (int)below(EXPONENTS);
        const int near = field + (int)below(2 * SPREAD + 1) - SPREAD;
        const int other = i % 2 || near < 0 || near >= EXPONENTS ? (int)below(EXPONENTS) : near;
        x[i] = pattern(field);
        y[i] = pattern(other);
    }
    test_atan2(y, x);
}

int main(int argc, char **argv)
{
    if (argc != 5) return 2;
    const char *function = argv[1];
    uint64_t samples = strtoull(argv[2], NULL, 10);
    const int angles = !strcmp(function, "atan2"), all = !strcmp(function, "all");
    state = strtoull(argv[3], NULL, 10);
    keep = atoi(argv[4]);
    if (keep < 1) return 2;
    for (int k = 0; k < 2; ++k) {
        const char *output = angles ? "atan2" : k ? "cos" : "sin";
        fused[k] = record(output, "fused");
        separate[k] = record(output, "separate");
    }
    if (all) {
        samples = (uint64_t)EXPONENTS << MANTISSA;
        for (uint64_t w = 0; w < samples; w += BLOCK) {
            real_t x[BLOCK];
            for (int i = 0; i < BLOCK; ++i)
                x[i] = cf_from_word((cf_word)(w + (uint64_t)i));
            test_sincos(x, 1);
        }
    } else {
        for (uint64_t i = 0; i < samples; i += BLOCK) {
            if (angles)
                sample_atan2();
            else
                sample_sincos();
        }
    }
    for (int k = 0; k < (angles ? 1 : 2); ++k) {
        print(&fused[k]);
        print(&separate[k]);
    }
    return 0;
}

#endif
