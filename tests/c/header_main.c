/* Every helper on every pair of awkward values, to be run under the address and undefined-behaviour
 * sanitizers. Prints the number of calls. */
#include <float.h>
#include <stdio.h>

#include "closedform.h"

#ifdef CLOSEDFORM_FLOAT
#define LARGEST FLT_MAX
#else
#define LARGEST DBL_MAX
#endif

int main(void)
{
    const real_t values[] = {0,
                             1,
                             2,
                             CF_PI,
                             2 * CF_PI,
                             CF_TRIG_LIMIT,
                             2 * CF_TRIG_LIMIT,
                             CLOSEDFORM_C(1e9),
                             CLOSEDFORM_C(1e30),
                             LARGEST,
                             LARGEST * CLOSEDFORM_C(1e-76),
                             1 / LARGEST,
                             2 * LARGEST,
                             CLOSEDFORM_NAN};
    enum { COUNT = sizeof values / sizeof values[0] };
    real_t signed_values[2 * COUNT], s[2 * COUNT], c[2 * COUNT];
    volatile real_t sink = 0;
    int calls = 0;

    for (size_t i = 0; i < COUNT; ++i) {
        signed_values[2 * i] = values[i];
        signed_values[2 * i + 1] = -values[i];
    }
    for (size_t n = 0; n <= 2 * COUNT; ++n) cf_sincos_block(n, signed_values, s, c);
    for (size_t i = 0; i + 8 <= 2 * COUNT; ++i) {
        cf_sincos_lanes(1, signed_values + i, s + i, c + i);
        cf_sincos_lanes(2, signed_values + i, s + i, c + i);
        cf_sincos_lanes(4, signed_values + i, s + i, c + i);
        cf_sincos_lanes(8, signed_values + i, s + i, c + i);
        cf_atan2_lanes(2, signed_values + i, s + i, c + i);
        cf_atan2_lanes(4, signed_values + i, s + i, c + i);
    }
    cf_atan2_lanes(24, signed_values, s, c);
    for (size_t i = 0; i < 2 * COUNT; ++i) {
        const real_t a = signed_values[i];
        cf_sincos(a, &s[i], &c[i]);
        sink = sink + cf_sqrt(a) + cf_wrap(a) + (cf_nought(a) == 0 ? s[i] : c[i]);
        for (size_t j = 0; j < 2 * COUNT; ++j, ++calls) {
            const real_t b = signed_values[j];
            sink = sink + cf_atan2(a, b) + cf_max(a, b) + cf_min(a, b);
        }
    }
    printf("%d\n", calls);
    return 0;
}
