/*
 * H6AR, loop-closed model: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_H6AR_LOOP_CLOSED_NEAREST_H
#define CLOSEDFORM_H6AR_LOOP_CLOSED_NEAREST_H

#include "closedform_nearest.h"
#include "h6ar_loop_closed.h"

#define H6AR_LOOP_CLOSED_JOINTS 6
#define H6AR_LOOP_CLOSED_BRANCHES 8

static inline void h6ar_loop_closed_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    h6ar_loop_closed_ik((const h6ar_loop_closed_params *)params, x, q, status);
}

static inline void h6ar_loop_closed_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    h6ar_loop_closed_fk((const h6ar_loop_closed_params *)params, q, x);
}

static inline void h6ar_loop_closed_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    h6ar_loop_closed_jacobian((const h6ar_loop_closed_params *)params, q, J);
}

static inline void h6ar_loop_closed_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    h6ar_loop_closed_determinant((const h6ar_loop_closed_params *)params, q, det);
}

/*
 * Of all branches of h6ar_loop_closed_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2R, theta3R, theta2L, theta3L, theta), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int h6ar_loop_closed_nearest(const h6ar_loop_closed_params *params, const real_t x[6],
    const real_t q_seed[6], const real_t *limits, const real_t *weights, real_t q[6], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 6, 8, 6, 6, 1, 6, 6, 9, 3, 0x3fu,
        0x38u, h6ar_loop_closed_nearest_ik, h6ar_loop_closed_nearest_fk, h6ar_loop_closed_nearest_jacobian, h6ar_loop_closed_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
