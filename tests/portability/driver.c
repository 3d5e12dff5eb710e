/* Evaluates generated functions on numbers from stdin, for driver.py, which prints calls.h.
 *
 * A request is the number of a function, how many postures follow, the parameters, and the inputs of
 * one posture after the other. The answer has a line for each posture by itself and then one for
 * the batch: what floating-point exceptions were raised, real outputs, and bytes. Numbers have 17
 * digits, so that none is rounded on the way. %a would say the same, but C libraries for
 * microcontrollers do not know it, nor %zu.
 */
#if defined(__linux__)
#define _GNU_SOURCE
#endif
#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "closedform.h"

typedef struct {
    size_t n_params, n_in, n_real, n_byte;
    void (*one)(const real_t *params, const real_t *in, real_t *out, uint8_t *bytes);
    void (*many)(size_t n, const real_t *params, const real_t *in, real_t *out, uint8_t *bytes);
} call;

static void header_one(const real_t *params, const real_t *in, real_t *out, uint8_t *bytes)
{
    (void)params, (void)bytes;
    real_t angles[2] = { in[0], in[1] };
    cf_sincos_lanes(2, angles, out, out + 2);
    out[4] = cf_atan2(in[0], in[1]);
    out[5] = cf_wrap(in[0]);
    cf_principal_block(1, in + 1, out + 6);
}

static void header_many(size_t n, const real_t *params, const real_t *in, real_t *out,
                        uint8_t *bytes)
{
    (void)params, (void)bytes;
    cf_sincos_block(n, in, out, out + 2 * n);
    cf_sincos_block(n, in + n, out + n, out + 3 * n);
    for (size_t i = 0; i < n; ++i) out[4 * n + i] = cf_atan2(in[i], in[n + i]);
    for (size_t i = 0; i < n; ++i) out[5 * n + i] = cf_wrap(in[i]);
    cf_principal_block(n, in + n, out + 6 * n);
}

#define HEADER { 0, 2, 7, 0, header_one, header_many }
#include "calls.h"

static void *room(size_t n, size_t size)
{
    void *memory = calloc(n + 1, size);
    if (!memory) abort();
    return memory;
}

static int number(real_t *x)
{
    double value;
    const int found = scanf("%lf", &value) == 1;
    *x = (real_t)value;
    return found;
}

static void clear(void)
{
#ifdef FE_ALL_EXCEPT
    (void)feclearexcept(FE_ALL_EXCEPT);
#endif
}

static void raised(void)
{
    int found = 0;
#ifdef FE_INVALID
    found |= fetestexcept(FE_INVALID) ? 1 : 0;
#endif
#ifdef FE_DIVBYZERO
    found |= fetestexcept(FE_DIVBYZERO) ? 2 : 0;
#endif
#ifdef FE_OVERFLOW
    found |= fetestexcept(FE_OVERFLOW) ? 4 : 0;
#endif
    printf("%d", found);
}

static int answer(const call *f, size_t n)
{
    real_t *params = room(f->n_params, sizeof(real_t));
    real_t *rows = room(n * f->n_in, sizeof(real_t)), *planes = room(n * f->n_in, sizeof(real_t));
    real_t *out = room(n * f->n_real, sizeof(real_t));
    uint8_t *bytes = room(n * f->n_byte, 1);
    int complete = 1;
    for (size_t k = 0; k < f->n_params; ++k) complete &= number(&params[k]);
    for (size_t k = 0; k < n * f->n_in; ++k) {
        complete &= number(&rows[k]);
        planes[k % f->n_in * n + k / f->n_in] = rows[k];
    }
    for (size_t i = 0; complete && i < n; ++i) {
        clear();
        f->one(params, rows + i * f->n_in, out, bytes);
        raised();
        for (size_t k = 0; k < f->n_real; ++k) printf(" %.17g", (double)out[k]);
        for (size_t k = 0; k < f->n_byte; ++k) printf(" %d", bytes[k]);
        printf("\n");
    }
    clear();
    f->many(n, params, planes, out, bytes);
    raised();
    for (size_t i = 0; complete && i < n; ++i) {
        for (size_t k = 0; k < f->n_real; ++k) printf(" %.17g", (double)out[k * n + i]);
        for (size_t k = 0; k < f->n_byte; ++k) printf(" %d", bytes[k * n + i]);
    }
    printf("\n");
    free(params), free(rows), free(planes), free(out), free(bytes);
    return complete;
}

int main(int argc, char **argv)
{
#if defined(__GLIBC__)
    if (argc > 1 && strcmp(argv[1], "trap") == 0)
        (void)feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#endif
    (void)argc, (void)argv;
    unsigned long which, n;
    while (scanf("%lu %lu", &which, &n) == 2)
        if (which >= sizeof calls / sizeof calls[0] || !answer(&calls[which], n)) return 1;
    return 0;
}
