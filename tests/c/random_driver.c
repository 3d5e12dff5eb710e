/* Calls functions of the generated table with random numbers, single and in batches.
 *
 *     random_driver SEED CALLS [ONLY]
 *
 * draws CALLS calls, or makes call number ONLY alone. Each is drawn from SEED and its number, which
 * are printed before it is made: built under the sanitizers, the last line names the call that
 * failed. What an inverse says is checked too: statuses exist, and NaN goes with UNREACHABLE and
 * INVALID only.
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "closedform_module.h"

enum { LONGEST = 40, GAP = 9 };

static uint64_t state;

/* splitmix64 */
static uint64_t draw(void)
{
    uint64_t z = (state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

static double number(int wild)
{
    static const double awkward[] = { 0.0, -0.0, 1.0, -1.0, 0.5, 3.141592653589793,
        1.5707963267948966, 1e-300, -1e-12, 5e-324, 1e22, -1e308, DBL_MAX, HUGE_VAL, -HUGE_VAL, NAN,
        18.0, 2.0 };
    const uint64_t bits = draw();
    if (wild == 2 && bits % 3 == 0) {
        double value;
        const uint64_t raw = draw();
        memcpy(&value, &raw, sizeof value);
        return value;
    }
    if (wild && bits % 3 == 1)
        return awkward[draw() % (sizeof awkward / sizeof awkward[0])];
    return ((double)(draw() >> 11) / 9007199254740992.0 - 0.5) * 7.0;
}

/* Exactly as large as the kernel may touch, so that one step too far is caught. */
static void *planes(const cf_array *spec, size_t n, size_t stride)
{
    const size_t count = (spec->size - 1) * stride + n;
    void *memory = malloc(count * (spec->kind == CF_REAL ? sizeof(double) : 1));
    if (!memory)
        abort();
    return memory;
}

static void *drawn(const cf_array *spec, size_t n, size_t stride, int wild)
{
    double *memory = planes(spec, n, stride);
    for (size_t k = 0; k < (spec->size - 1) * stride + n; ++k)
        memory[k] = number(wild);
    return memory;
}

static void check(const cf_function *f, size_t n, void *const *out, const size_t *stride)
{
    if (f->n_out != 2 || f->out[1].kind != CF_STATUS)
        return;
    const double *q = out[0];
    const uint8_t *status = out[1];
    const size_t branches = f->out[1].size, joints = f->out[0].size / branches;
    for (size_t i = 0; i < n; ++i)
        for (size_t b = 0; b < branches; ++b) {
            const uint8_t told = status[b * stride[1] + i];
            int numbers = 1;
            for (size_t j = 0; j < joints; ++j)
                numbers &= !isnan(q[(b * joints + j) * stride[0] + i]);
            if (told > 3 || numbers != (told == 0 || told == 2)) {
                fprintf(stderr, "%s: status %d beside %s\n", f->name, told,
                    numbers ? "numbers" : "NaN");
                exit(1);
            }
        }
}

static void run(uint64_t seed, uint64_t call)
{
    state = seed * 0xD1342543DE82EF95u + call;
    const cf_function *f = &cf_functions[draw() % cf_function_count];
    const int wild = (int)(draw() % 3);
    const size_t n = draw() % 2 ? 1 : 1 + draw() % LONGEST;
    double params[CF_MAX_PARAMS];
    void *in[CF_MAX_IN], *out[CF_MAX_OUT];
    size_t in_stride[CF_MAX_IN], out_stride[CF_MAX_OUT];

    printf("%llu %llu %s\n", (unsigned long long)seed, (unsigned long long)call, f->name);
    fflush(stdout);
    for (size_t k = 0; k < f->n_params; ++k)
        params[k] = draw() % 2 ? f->defaults[k] : number(wild);
    const int single = n == 1 && draw() % 2;
    for (size_t k = 0; k < f->n_in; ++k) {
        in_stride[k] = single ? 1 : n + draw() % GAP;
        in[k] = drawn(&f->in[k], n, in_stride[k], wild);
    }
    for (size_t k = 0; k < f->n_out; ++k) {
        out_stride[k] = single ? 1 : n + draw() % GAP;
        out[k] = planes(&f->out[k], n, out_stride[k]);
    }
    if (single)
        f->single(params, (const double *const *)in, out);
    else
        f->batch(n, params, (const double *const *)in, in_stride, out, out_stride);
    check(f, n, out, out_stride);
    for (size_t k = 0; k < f->n_in; ++k)
        free(in[k]);
    for (size_t k = 0; k < f->n_out; ++k)
        free(out[k]);
}

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    const uint64_t seed = strtoull(argv[1], NULL, 10), calls = strtoull(argv[2], NULL, 10);
    if (argc > 3) {
        run(seed, strtoull(argv[3], NULL, 10));
        return 0;
    }
    for (uint64_t call = 0; call < calls; ++call)
        run(seed, call);
    return 0;
}
