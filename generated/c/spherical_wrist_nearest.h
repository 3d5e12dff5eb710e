/*
 * Spherical wrist: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SPHERICAL_WRIST_NEAREST_H
#define CLOSEDFORM_SPHERICAL_WRIST_NEAREST_H

#include "closedform_nearest.h"
#include "spherical_wrist.h"

#define SPHERICAL_WRIST_JOINTS 3
#define SPHERICAL_WRIST_BRANCHES 2

static inline void spherical_wrist_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    spherical_wrist_ik((const spherical_wrist_params *)params, x, q, status);
}

static inline void spherical_wrist_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    spherical_wrist_fk((const spherical_wrist_params *)params, q, x);
}

static inline void spherical_wrist_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    spherical_wrist_jacobian_space((const spherical_wrist_params *)params, q, J);
}

static inline void spherical_wrist_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    spherical_wrist_determinant((const spherical_wrist_params *)params, q, det);
}

/*
 * Of all branches of spherical_wrist_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta4, theta5, theta6), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int spherical_wrist_nearest(const spherical_wrist_params *params, const real_t R[9],
    const real_t q_seed[3], const real_t *limits, const real_t *weights, real_t q[3], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 3, 2, 3, 9, 1, 3, 3, 1, 0, 0x7u,
        0x0u, spherical_wrist_nearest_ik, spherical_wrist_nearest_fk, spherical_wrist_nearest_jacobian, spherical_wrist_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, R, q_seed, limits, weights, q, status, outside);
}

#endif
