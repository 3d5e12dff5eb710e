/*
 * Stanford arm: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_STANFORD_ARM_NEAREST_H
#define CLOSEDFORM_STANFORD_ARM_NEAREST_H

#include "closedform_nearest.h"
#include "stanford_arm.h"

#define STANFORD_ARM_JOINTS 6
#define STANFORD_ARM_BRANCHES 8

static inline void stanford_arm_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    stanford_arm_ik((const stanford_arm_params *)params, x, q, status);
}

static inline void stanford_arm_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    stanford_arm_fk((const stanford_arm_params *)params, q, x);
}

static inline void stanford_arm_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    stanford_arm_jacobian_space((const stanford_arm_params *)params, q, J);
}

static inline void stanford_arm_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    stanford_arm_determinant((const stanford_arm_params *)params, q, det);
}

/*
 * Of all branches of stanford_arm_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, d3, theta4, theta5, theta6), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int stanford_arm_nearest(const stanford_arm_params *params, const real_t T[16],
    const real_t q_seed[6], const real_t *limits, const real_t *weights, real_t q[6], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 6, 8, 6, 16, 1, 6, 6, 1, 2, 0x3bu,
        0x0u, stanford_arm_nearest_ik, stanford_arm_nearest_fk, stanford_arm_nearest_jacobian, stanford_arm_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, T, q_seed, limits, weights, q, status, outside);
}

#endif
