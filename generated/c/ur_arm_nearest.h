/*
 * UR-type arm (three parallel axes): the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_UR_ARM_NEAREST_H
#define CLOSEDFORM_UR_ARM_NEAREST_H

#include "closedform_nearest.h"
#include "ur_arm.h"

#define UR_ARM_JOINTS 6
#define UR_ARM_BRANCHES 8

static inline void ur_arm_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    ur_arm_ik((const ur_arm_params *)params, x, q, status);
}

static inline void ur_arm_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    ur_arm_fk((const ur_arm_params *)params, q, x);
}

static inline void ur_arm_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    ur_arm_jacobian_space((const ur_arm_params *)params, q, J);
}

static inline void ur_arm_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    ur_arm_determinant((const ur_arm_params *)params, q, det);
}

/*
 * Of all branches of ur_arm_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, theta3, theta4, theta5, theta6), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int ur_arm_nearest(const ur_arm_params *params, const real_t T[16],
    const real_t q_seed[6], const real_t *limits, const real_t *weights, real_t q[6], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 6, 8, 6, 16, 1, 6, 6, 6, 3, 0x3fu,
        0x0u, ur_arm_nearest_ik, ur_arm_nearest_fk, ur_arm_nearest_jacobian, ur_arm_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, T, q_seed, limits, weights, q, status, outside);
}

#endif
