/*
 * Agile wrist: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_AGILE_WRIST_NEAREST_H
#define CLOSEDFORM_AGILE_WRIST_NEAREST_H

#include "closedform_nearest.h"
#include "agile_wrist.h"

#define AGILE_WRIST_JOINTS 3
#define AGILE_WRIST_BRANCHES 8

static inline void agile_wrist_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    agile_wrist_ik((const agile_wrist_params *)params, x, q, status);
}

static inline void agile_wrist_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[4];
    agile_wrist_fk((const agile_wrist_params *)params, q, x, status);
}

static inline void agile_wrist_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    agile_wrist_jacobian_space((const agile_wrist_params *)params, q, J);
}

static inline void agile_wrist_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    agile_wrist_determinant((const agile_wrist_params *)params, q, det);
}

/*
 * Of all branches of agile_wrist_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, theta3), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int agile_wrist_nearest(const agile_wrist_params *params, const real_t R[9],
    const real_t q_seed[3], const real_t *limits, const real_t *weights, real_t q[3], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 3, 8, 3, 9, 4, 3, 3, 1, 0, 0x7u,
        0x0u, agile_wrist_nearest_ik, agile_wrist_nearest_fk, agile_wrist_nearest_jacobian, agile_wrist_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, R, q_seed, limits, weights, q, status, outside);
}

#endif
