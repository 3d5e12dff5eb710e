/* A control loop: every cycle it moves the target and takes the posture nearest to the last one.
 *
 *   cc -O3 -fno-math-errno -fno-trapping-math control_loop.c ur_arm.c -lm
 */
#include <stdio.h>

#include "ur_arm_nearest.h"

#define CYCLES 500

int main(void)
{
    const ur_arm_params arm = UR_ARM_DEFAULTS;
    const real_t turn = CLOSEDFORM_C(6.283185307179586);
    real_t limits[2 * UR_ARM_JOINTS]; /* lower, then upper */
    real_t q[UR_ARM_JOINTS] = { 0, CLOSEDFORM_C(-1.5), CLOSEDFORM_C(1.6), CLOSEDFORM_C(-1.7), CLOSEDFORM_C(-1.6), 0 };
    real_t T[16], next[UR_ARM_JOINTS], largest = 0;
    uint8_t status;
    int branch = -1;

    for (int j = 0; j < UR_ARM_JOINTS; ++j) {
        limits[j] = -turn;
        limits[UR_ARM_JOINTS + j] = turn;
    }
    ur_arm_fk(&arm, q, T);
    for (int cycle = 0; cycle < CYCLES; ++cycle) {
        T[7] += CLOSEDFORM_C(0.0004); /* 0.4 mm along y */
        branch = ur_arm_nearest(&arm, T, q, limits, NULL, next, &status, NULL);
        if (branch < 0) {
            printf("stopped in cycle %d: status %d\n", cycle, status);
            return 1;
        }
        for (int j = 0; j < UR_ARM_JOINTS; ++j) {
            const real_t step = next[j] > q[j] ? next[j] - q[j] : q[j] - next[j];
            largest = step > largest ? step : largest;
            q[j] = next[j];
        }
        /* here the joints are sent to the drives */
    }
    printf("%d cycles on branch %d, largest step %.4f rad\n", CYCLES, branch, (double)largest);
    return 0;
}
