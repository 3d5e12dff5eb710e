/* A controller's view of the library: where is the hand, and which angles bring it there? */
#include "planar_2r.h"
#include <stdio.h>

int main(void)
{
    const planar_2r_params arm = PLANAR_2R_DEFAULTS;
    const real_t q[2] = { CLOSEDFORM_C(0.3), CLOSEDFORM_C(-1.1) };
    real_t x[2], found[4];
    uint8_t status[2];

    planar_2r_fk(&arm, q, x);
    planar_2r_ik(&arm, x, found, status);
    printf("real_t has %zu bytes\n", sizeof(real_t));
    printf("hand %.6f %.6f\n", (double)x[0], (double)x[1]);
    for (int i = 0; i < 2; ++i)
        printf("branch %d status %d angles %.6f %.6f\n", i, status[i], (double)found[2 * i],
            (double)found[2 * i + 1]);
    return status[0] != CLOSEDFORM_OK || status[1] != CLOSEDFORM_OK;
}
