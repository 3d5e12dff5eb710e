/*
 * Industrial six-axis arm (OPW): the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_OPW_ARM_NEAREST_H
#define CLOSEDFORM_OPW_ARM_NEAREST_H

#include "closedform_nearest.h"
#include "opw_arm.h"

#define OPW_ARM_JOINTS 6
#define OPW_ARM_BRANCHES 8

static inline void opw_arm_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    opw_arm_ik((const opw_arm_params *)params, x, q, status);
}

static inline void opw_arm_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    opw_arm_fk((const opw_arm_params *)params, q, x);
}

static inline void opw_arm_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    opw_arm_jacobian_space((const opw_arm_params *)params, q, J);
}

static inline void opw_arm_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    opw_arm_determinant((const opw_arm_params *)params, q, det);
}

/*
 * Of all branches of opw_arm_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, theta3, theta4, theta5, theta6), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int opw_arm_nearest(const opw_arm_params *params, const real_t T[16],
    const real_t q_seed[6], const real_t *limits, const real_t *weights, real_t q[6], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 6, 8, 6, 16, 1, 6, 6, 7, 3, 0x3fu,
        0x0u, opw_arm_nearest_ik, opw_arm_nearest_fk, opw_arm_nearest_jacobian, opw_arm_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, T, q_seed, limits, weights, q, status, outside);
}

#endif
