/* A table of hand-written kernels with every form that a generated one can take. */
#include <math.h>
#include <stdint.h>

#include "closedform_module.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* polar(q, params=(r0, r1)) -> x: the shape of a forward kinematics. */

static void
polar(const double *params, const double *const *in, void *const *out)
{
    double *x = out[0];
    x[0] = params[0] * cos(in[0][0]) + params[1] * in[0][1];
    x[1] = params[0] * sin(in[0][0]) - params[1] * in[0][1];
}

static void
polar_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
            void *const *out, const size_t *out_stride)
{
    const double *q0 = in[0], *q1 = in[0] + in_stride[0];
    double *x0 = out[0], *x1 = x0 + out_stride[0];
    for (size_t i = 0; i < n; i++) {
        x0[i] = params[0] * cos(q0[i]) + params[1] * q1[i];
        x1[i] = params[0] * sin(q0[i]) - params[1] * q1[i];
    }
}

/* two(q, u) -> (v, status): several inputs and outputs, a matrix among each, no parameters. Writes
 * an output before it has read all inputs, so that an overlap would show. */

static void
two(const double *params, const double *const *in, void *const *out)
{
    const double *q = in[0], *u = in[1];
    double *v = out[0];
    uint8_t *status = out[1];
    (void)params;
    for (size_t r = 0; r < 2; r++) {
        for (size_t c = 0; c < 3; c++) {
            v[3 * r + c] = q[r] * u[3 * r + c] + u[6 + c];
        }
        status[r] = q[r] < 0.0 ? 1 : q[r] == 0.0 ? 2 : 0;
    }
}

static void
two_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
          void *const *out, const size_t *out_stride)
{
    (void)params;
    for (size_t r = 0; r < 2; r++) {
        const double *q = in[0] + r * in_stride[0];
        for (size_t c = 0; c < 3; c++) {
            const double *a = in[1] + (3 * r + c) * in_stride[1];
            const double *b = in[1] + (6 + c) * in_stride[1];
            double *v = (double *)out[0] + (3 * r + c) * out_stride[0];
            for (size_t i = 0; i < n; i++) {
                v[i] = q[i] * a[i] + b[i];
            }
        }
        uint8_t *status = (uint8_t *)out[1] + r * out_stride[1];
        for (size_t i = 0; i < n; i++) {
            status[i] = q[i] < 0.0 ? 1 : q[i] == 0.0 ? 2 : 0;
        }
    }
}

/* scalar(a, b, params=(k,)) -> y: cores without axes. */

static void
scalar(const double *params, const double *const *in, void *const *out)
{
    *(double *)out[0] = params[0] * in[0][0] - in[1][0];
}

static void
scalar_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
             void *const *out, const size_t *out_stride)
{
    (void)in_stride;
    (void)out_stride;
    for (size_t i = 0; i < n; i++) {
        ((double *)out[0])[i] = params[0] * in[0][i] - in[1][i];
    }
}

/* inside(p, params=(r,)) -> bool. */

static void
inside(const double *params, const double *const *in, void *const *out)
{
    *(uint8_t *)out[0] = hypot(in[0][0], in[0][1]) <= params[0];
}

static void
inside_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
             void *const *out, const size_t *out_stride)
{
    const double *x = in[0], *y = in[0] + in_stride[0];
    (void)out_stride;
    for (size_t i = 0; i < n; i++) {
        ((uint8_t *)out[0])[i] = hypot(x[i], y[i]) <= params[0];
    }
}

/* volume(params=(a, b)) -> v: no inputs, all leading axes from the parameters. */

static void
volume(const double *params, const double *const *in, void *const *out)
{
    (void)in;
    *(double *)out[0] = params[0] * params[0] * params[1];
}

static void
volume_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
             void *const *out, const size_t *out_stride)
{
    (void)in;
    (void)in_stride;
    (void)out_stride;
    for (size_t i = 0; i < n; i++) {
        ((double *)out[0])[i] = params[0] * params[0] * params[1];
    }
}

/* mixed(a, params=(k,)) -> (y, flag, w): outputs with and without axes, one of three. */

static void
mixed(const double *params, const double *const *in, void *const *out)
{
    *(double *)out[0] = in[0][0] + params[0];
    *(uint8_t *)out[1] = in[0][0] > 0.0;
    for (size_t j = 0; j < 12; j++) {
        ((double *)out[2])[j] = (double)j * in[0][0];
    }
}

static void
mixed_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
            void *const *out, const size_t *out_stride)
{
    (void)in_stride;
    for (size_t i = 0; i < n; i++) {
        ((double *)out[0])[i] = in[0][i] + params[0];
        ((uint8_t *)out[1])[i] = in[0][i] > 0.0;
    }
    for (size_t j = 0; j < 12; j++) {
        for (size_t i = 0; i < n; i++) {
            ((double *)out[2])[j * out_stride[2] + i] = (double)j * in[0][i];
        }
    }
}

/* chain(q) -> x: as many planes as a pose of a six-axis arm, cheap enough to time the runtime. */

static void
chain(const double *params, const double *const *in, void *const *out)
{
    (void)params;
    for (size_t j = 0; j < 12; j++) {
        ((double *)out[0])[j] = in[0][j % 6] + in[0][(j + 1) % 6];
    }
}

static void
chain_batch(size_t n, const double *params, const double *const *in, const size_t *in_stride,
            void *const *out, const size_t *out_stride)
{
    (void)params;
    for (size_t j = 0; j < 12; j++) {
        const double *a = in[0] + j % 6 * in_stride[0];
        const double *b = in[0] + (j + 1) % 6 * in_stride[0];
        double *x = (double *)out[0] + j * out_stride[0];
        for (size_t i = 0; i < n; i++) {
            x[i] = a[i] + b[i];
        }
    }
}

static const cf_array q2 = {"q", 1, {2}, 2, CF_REAL};
static const cf_array q6 = {"q", 1, {6}, 6, CF_REAL};
static const cf_array p2 = {"p", 1, {2}, 2, CF_REAL};
static const cf_array a0 = {"a", 0, {0}, 1, CF_REAL};
static const cf_array x2[] = {{"x", 1, {2}, 2, CF_REAL}};
static const cf_array x34[] = {{"x", 2, {3, 4}, 12, CF_REAL}};
static const cf_array y0[] = {{"y", 0, {0}, 1, CF_REAL}};
static const cf_array inside0[] = {{"inside", 0, {0}, 1, CF_BOOL}};
static const cf_array two_in[] = {{"q", 1, {2}, 2, CF_REAL}, {"u", 2, {3, 3}, 9, CF_REAL}};
static const cf_array two_out[] = {{"v", 2, {2, 3}, 6, CF_REAL}, {"status", 1, {2}, 2, CF_STATUS}};
static const cf_array scalar_in[] = {{"a", 0, {0}, 1, CF_REAL}, {"b", 0, {0}, 1, CF_REAL}};
static const cf_array mixed_out[] = {{"y", 0, {0}, 1, CF_REAL},
                                     {"flag", 0, {0}, 1, CF_BOOL},
                                     {"w", 3, {2, 3, 2}, 12, CF_REAL}};

static const double polar_defaults[] = {1.0, 0.5};
static const char *const polar_names[] = {"r0", "r1"};
static const double k_default[] = {-2.0};
static const char *const k_name[] = {"k"};
static const double r_default[] = {1.0};
static const char *const r_name[] = {"r"};

#define PARAMS(defaults, names) COUNT(defaults), defaults, names
#define NO_PARAMS 0, NULL, NULL

const cf_function cf_functions[] = {
    {"toy.polar", "A point from an angle and a length.", PARAMS(polar_defaults, polar_names),
     1, &q2, COUNT(x2), x2, polar, polar_batch},
    {"toy.two", "Two outputs.", NO_PARAMS,
     COUNT(two_in), two_in, COUNT(two_out), two_out, two, two_batch},
    {"toy.scalar", "A scalar.", PARAMS(k_default, k_name),
     COUNT(scalar_in), scalar_in, COUNT(y0), y0, scalar, scalar_batch},
    {"toy.inside", "A truth value.", PARAMS(r_default, r_name),
     1, &p2, COUNT(inside0), inside0, inside, inside_batch},
    {"toy.volume", "No inputs.", PARAMS(polar_defaults, polar_names),
     0, NULL, COUNT(y0), y0, volume, volume_batch},
    {"toy.mixed", "Three outputs.", PARAMS(k_default, k_name),
     1, &a0, COUNT(mixed_out), mixed_out, mixed, mixed_batch},
    {"toy.chain", "Many planes.", NO_PARAMS,
     1, &q6, COUNT(x34), x34, chain, chain_batch},
};
const size_t cf_function_count = COUNT(cf_functions);
