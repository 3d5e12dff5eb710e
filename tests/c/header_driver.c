/* The header's functions over arrays, for tests/emit/test_c_header.py to call through ctypes. */
#include "closedform.h"

size_t real_size(void);
void sincos_block(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_lanes(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_plain(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_block_rounded(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_lanes_rounded(size_t n, const real_t *x, real_t *s, real_t *c);
void atan2_all(size_t n, const real_t *y, const real_t *x, real_t *angle);
void lanes_all(size_t n, const real_t *y, const real_t *x, real_t *s, real_t *c, real_t *angle);
void wrap_all(size_t n, const real_t *angle, real_t *wrapped);
void wrap_cut_all(size_t n, const real_t *angle, real_t *wrapped);
void turned_lanes(size_t n, const real_t *x, real_t *s, real_t *c, real_t *turned);
void principal_all(size_t n, const real_t *angle, real_t *turned);
void nought_all(size_t n, const real_t *x, real_t *yes);
void max_min_all(size_t n, const real_t *a, const real_t *b, real_t *larger, real_t *smaller);
void constants(real_t *out);

size_t real_size(void) { return sizeof(real_t); }

CLOSEDFORM_DISPATCHED void sincos_block(size_t n, const real_t *x, real_t *s, real_t *c)
{
    cf_sincos_block(n, x, s, c);
}

void sincos_lanes(size_t n, const real_t *x, real_t *s, real_t *c)
{
    for (size_t i = 0; i + 8 <= n; i += 8) cf_sincos_lanes(8, x + i, s + i, c + i);
}

CLOSEDFORM_DISPATCHED void sincos_plain(size_t n, const real_t *CF_RESTRICT x, real_t *CF_RESTRICT s,
                                   real_t *CF_RESTRICT c)
{
    for (size_t i = 0; i < n; ++i) cf_sincos(x[i], &s[i], &c[i]);
}

CLOSEDFORM_DISPATCHED void sincos_block_rounded(size_t n, const real_t *x, real_t *s, real_t *c)
{
    cf_sincos_block_rounded(n, cf_one(), x, s, c);
}

void sincos_lanes_rounded(size_t n, const real_t *x, real_t *s, real_t *c)
{
    real_t turned[8];
    for (size_t i = 0; i + 12 <= n; i += 12) {
        cf_sincos_lanes_rounded(8, cf_one(), x + i, s + i, c + i);
        cf_turned_lanes_rounded(4, cf_one(), x + i + 8, s + i + 8, c + i + 8, turned);
    }
}

CLOSEDFORM_DISPATCHED void atan2_all(size_t n, const real_t *CF_RESTRICT y, const real_t *CF_RESTRICT x,
                                real_t *CF_RESTRICT angle)
{
    for (size_t i = 0; i < n; ++i) angle[i] = cf_atan2(y[i], x[i]);
}

void turned_lanes(size_t n, const real_t *x, real_t *s, real_t *c, real_t *turned)
{
    for (size_t i = 0; i + 10 <= n; i += 10) {
        cf_turned_lanes(8, x + i, s + i, c + i, turned + i);
        cf_turned_lanes(2, x + i + 8, s + i + 8, c + i + 8, turned + i + 8);
    }
}

/* Twenty-four numbers by lanes of 1, 1, 2, 4 and 16: sin y, cos y; from the third on atan2(y, x). */
void lanes_all(size_t n, const real_t *y, const real_t *x, real_t *s, real_t *c, real_t *angle)
{
    for (size_t i = 0; i + 24 <= n; i += 24) {
        cf_sincos_lanes(1, y + i, s + i, c + i);
        cf_sincos_lanes(1, y + i + 1, s + i + 1, c + i + 1);
        cf_sincos_lanes(2, y + i + 2, s + i + 2, c + i + 2);
        cf_sincos_lanes(4, y + i + 4, s + i + 4, c + i + 4);
        cf_sincos_lanes(16, y + i + 8, s + i + 8, c + i + 8);
        angle[i] = cf_atan2(y[i], x[i]);
        angle[i + 1] = cf_atan2(y[i + 1], x[i + 1]);
        cf_atan2_lanes(2, y + i + 2, x + i + 2, angle + i + 2);
        cf_atan2_lanes(4, y + i + 4, x + i + 4, angle + i + 4);
        cf_atan2_lanes(16, y + i + 8, x + i + 8, angle + i + 8);
    }
}

#define WRAP(name)                                                                             \
    CLOSEDFORM_DISPATCHED void name##_all(size_t n, const real_t *CF_RESTRICT angle,           \
                                          real_t *CF_RESTRICT wrapped)                         \
    {                                                                                          \
        for (size_t i = 0; i < n; ++i) wrapped[i] = cf_##name(angle[i]);                       \
    }

WRAP(wrap)
WRAP(wrap_cut)

CLOSEDFORM_DISPATCHED void principal_all(size_t n, const real_t *angle, real_t *turned)
{
    cf_principal_block(n, angle, turned);
}

CLOSEDFORM_DISPATCHED void nought_all(size_t n, const real_t *CF_RESTRICT x,
                                    real_t *CF_RESTRICT zero)
{
    for (size_t i = 0; i < n; ++i) zero[i] = cf_nought(x[i]);
}

CLOSEDFORM_DISPATCHED void max_min_all(size_t n, const real_t *CF_RESTRICT a,
                                  const real_t *CF_RESTRICT b, real_t *CF_RESTRICT larger,
                                  real_t *CF_RESTRICT smaller)
{
    for (size_t i = 0; i < n; ++i) {
        larger[i] = cf_max(a[i], b[i]);
        smaller[i] = cf_min(a[i], b[i]);
    }
}

void constants(real_t *out)
{
    out[0] = CF_TRIG_LIMIT;
    out[1] = CF_PI;
    out[2] = CLOSEDFORM_NAN;
    out[3] = cf_sqrt(CLOSEDFORM_C(2.0));
}
