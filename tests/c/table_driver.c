/* Calls every function of the generated table with awkward numbers, single and in batches.
 * Built under the address and undefined-behaviour sanitizers, it only has to end normally.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "closedform_module.h"

enum { POSTURES = 300, STRIDE = POSTURES + 5 };

static double awkward(size_t k)
{
    static const double values[] = { 0.0, -0.0, 1.0, -1.0, 0.5, 3.141592653589793, 1e-300, -1e-12,
        5e-324, 1e22, -1e308, DBL_MAX, HUGE_VAL, -HUGE_VAL, NAN, 18.0, 2.0 };
    return values[(k * 7 + k / 17) % (sizeof values / sizeof values[0])];
}

/* Exactly as large as the kernel may touch, so that one step too far is caught. */
static void *planes(const cf_array *spec, size_t n)
{
    const size_t count = n == 1 ? spec->size : (spec->size - 1) * STRIDE + n;
    void *memory = calloc(count, spec->kind == CF_REAL ? sizeof(double) : 1);
    if (!memory)
        abort();
    if (spec->kind == CF_REAL)
        for (size_t k = 0; k < count; ++k)
            ((double *)memory)[k] = awkward(k);
    return memory;
}

static void run(const cf_function *f, size_t n)
{
    double *in[CF_MAX_IN];
    void *out[CF_MAX_OUT];
    size_t in_stride[CF_MAX_IN], out_stride[CF_MAX_OUT];
    for (size_t k = 0; k < f->n_in; ++k) {
        in[k] = planes(&f->in[k], n);
        in_stride[k] = STRIDE;
    }
    for (size_t k = 0; k < f->n_out; ++k) {
        out[k] = planes(&f->out[k], n);
        out_stride[k] = STRIDE;
    }
    if (n == 1)
        f->single(f->defaults, (const double *const *)in, out);
    else
        f->batch(n, f->defaults, (const double *const *)in, in_stride, out, out_stride);
    for (size_t k = 0; k < f->n_in; ++k)
        free(in[k]);
    for (size_t k = 0; k < f->n_out; ++k)
        free(out[k]);
}

int main(void)
{
    for (size_t k = 0; k < cf_function_count; ++k) {
        run(&cf_functions[k], 1);
        run(&cf_functions[k], POSTURES);
        run(&cf_functions[k], 2);
    }
    printf("%zu functions\n", cf_function_count);
    return 0;
}
