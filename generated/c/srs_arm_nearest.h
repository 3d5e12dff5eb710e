/*
 * Seven-joint arm with a spherical shoulder and wrist (SRS): the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SRS_ARM_NEAREST_H
#define CLOSEDFORM_SRS_ARM_NEAREST_H

#include "closedform_nearest.h"
#include "srs_arm.h"

#define SRS_ARM_JOINTS 7
#define SRS_ARM_BRANCHES 8

/* What is given besides the target, at a posture. */
static inline void srs_arm_nearest_given(const void *params, const real_t *q, real_t *arm_angle)
{
    srs_arm_arm_angle((const srs_arm_params *)params, q, arm_angle);
}

static inline void srs_arm_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    srs_arm_ik((const srs_arm_params *)params, x, x + 16, q, status);
}

static inline void srs_arm_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    srs_arm_fk((const srs_arm_params *)params, q, x);
    srs_arm_nearest_given(params, q, x + 16);
}

static inline void srs_arm_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    srs_arm_jacobian_space((const srs_arm_params *)params, q, J);
    cf_gradient(7, srs_arm_nearest_given, params, q, J + 42);
}

static inline void srs_arm_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    srs_arm_determinant((const srs_arm_params *)params, q, det);
}

/*
 * Of all branches of srs_arm_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * arm_angle: what the inverse takes besides the target; NULL: its value at the seed.
 * limits: the lower limits of all joints (theta1, theta2, theta3, theta4, theta5, theta6, theta7), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int srs_arm_nearest(const srs_arm_params *params, const real_t T[16],
    const real_t *arm_angle, const real_t q_seed[7], const real_t *limits, const real_t *weights, real_t q[7], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 7, 8, 7, 17, 1, 7, 7, 4, 3, 0x7fu,
        0x10000u, srs_arm_nearest_ik, srs_arm_nearest_fk, srs_arm_nearest_jacobian, srs_arm_nearest_determinant };
    real_t x[17];
    memcpy(x, T, 16 * sizeof *x);
    srs_arm_nearest_given(params, q_seed, x + 16);
    if (arm_angle != NULL) x[16] = *arm_angle;
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
