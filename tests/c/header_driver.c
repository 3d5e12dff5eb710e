/* The header's functions over arrays, for tests/test_c_header.py to call through ctypes. */
#include "closedform.h"

size_t real_size(void);
void sincos_block(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_eights(size_t n, const real_t *x, real_t *s, real_t *c);
void sincos_plain(size_t n, const real_t *x, real_t *s, real_t *c);
void atan2_all(size_t n, const real_t *y, const real_t *x, real_t *angle);
void wrap_all(size_t n, const real_t *angle, real_t *wrapped);
void is_finite_all(size_t n, const real_t *x, real_t *yes);
void max_min_all(size_t n, const real_t *a, const real_t *b, real_t *larger, real_t *smaller);
void constants(real_t *out);

size_t real_size(void) { return sizeof(real_t); }

CLOSEDFORM_DISPATCHED void sincos_block(size_t n, const real_t *x, real_t *s, real_t *c)
{
    cf_sincos_block(n, x, s, c);
}

void sincos_eights(size_t n, const real_t *x, real_t *s, real_t *c)
{
    for (size_t i = 0; i + 8 <= n; i += 8) cf_sincos_block(8, x + i, s + i, c + i);
}

CLOSEDFORM_DISPATCHED void sincos_plain(size_t n, const real_t *CF_RESTRICT x, real_t *CF_RESTRICT s,
                                   real_t *CF_RESTRICT c)
{
    for (size_t i = 0; i < n; ++i) cf_sincos(x[i], &s[i], &c[i]);
}

CLOSEDFORM_DISPATCHED void atan2_all(size_t n, const real_t *CF_RESTRICT y, const real_t *CF_RESTRICT x,
                                real_t *CF_RESTRICT angle)
{
    for (size_t i = 0; i < n; ++i) angle[i] = cf_atan2(y[i], x[i]);
}

CLOSEDFORM_DISPATCHED void wrap_all(size_t n, const real_t *CF_RESTRICT angle,
                               real_t *CF_RESTRICT wrapped)
{
    for (size_t i = 0; i < n; ++i) wrapped[i] = cf_wrap(angle[i]);
}

CLOSEDFORM_DISPATCHED void is_finite_all(size_t n, const real_t *CF_RESTRICT x,
                                    real_t *CF_RESTRICT yes)
{
    for (size_t i = 0; i < n; ++i) yes[i] = cf_is_finite(x[i]) ? CLOSEDFORM_C(1) : CLOSEDFORM_C(0);
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
