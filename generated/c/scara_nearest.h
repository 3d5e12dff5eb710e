/*
 * SCARA arm (RRPR): the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SCARA_NEAREST_H
#define CLOSEDFORM_SCARA_NEAREST_H

#include "closedform_nearest.h"
#include "scara.h"

#define SCARA_JOINTS 4
#define SCARA_BRANCHES 2

static inline void scara_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    scara_ik((const scara_params *)params, x, q, status);
}

static inline void scara_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    scara_fk((const scara_params *)params, q, x);
}

static inline void scara_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    scara_jacobian((const scara_params *)params, q, J);
}

static inline void scara_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    scara_determinant((const scara_params *)params, q, det);
}

/*
 * Of all branches of scara_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2, d3, theta4), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int scara_nearest(const scara_params *params, const real_t x[4],
    const real_t q_seed[4], const real_t *limits, const real_t *weights, real_t q[4], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 4, 2, 4, 4, 1, 4, 4, 3, 2, 0xbu,
        0x8u, scara_nearest_ik, scara_nearest_fk, scara_nearest_jacobian, scara_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
