/*
 * Delta robot with rotary drives: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_DELTA_NEAREST_H
#define CLOSEDFORM_DELTA_NEAREST_H

#include "closedform_nearest.h"
#include "delta.h"

#define DELTA_JOINTS 3
#define DELTA_BRANCHES 8

static inline void delta_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    delta_ik((const delta_params *)params, x, q, status);
}

static inline void delta_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[2];
    delta_fk((const delta_params *)params, q, x, status);
}

static inline void delta_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    delta_jacobian((const delta_params *)params, q, J);
}

static inline void delta_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    delta_determinant((const delta_params *)params, q, det);
}

/*
 * Of all branches of delta_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, theta3), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int delta_nearest(const delta_params *params, const real_t x[3],
    const real_t q_seed[3], const real_t *limits, const real_t *weights, real_t q[3], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 3, 8, 3, 3, 2, 3, 3, 7, 3, 0x7u,
        0x0u, delta_nearest_ik, delta_nearest_fk, delta_nearest_jacobian, delta_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
