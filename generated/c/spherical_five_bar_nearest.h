/*
 * Spherical five-bar linkage: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SPHERICAL_FIVE_BAR_NEAREST_H
#define CLOSEDFORM_SPHERICAL_FIVE_BAR_NEAREST_H

#include "closedform_nearest.h"
#include "spherical_five_bar.h"

#define SPHERICAL_FIVE_BAR_JOINTS 2
#define SPHERICAL_FIVE_BAR_BRANCHES 4

static inline void spherical_five_bar_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    spherical_five_bar_ik((const spherical_five_bar_params *)params, x, q, status);
}

static inline void spherical_five_bar_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[2];
    spherical_five_bar_fk((const spherical_five_bar_params *)params, q, x, status);
}

static inline void spherical_five_bar_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    spherical_five_bar_jacobian((const spherical_five_bar_params *)params, q, J);
}

/*
 * Of all branches of spherical_five_bar_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int spherical_five_bar_nearest(const spherical_five_bar_params *params, const real_t x[3],
    const real_t q_seed[2], const real_t *limits, const real_t *weights, real_t q[2], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 2, 4, 2, 3, 2, 3, 3, 6, 3, 0x3u,
        0x0u, spherical_five_bar_nearest_ik, spherical_five_bar_nearest_fk, spherical_five_bar_nearest_jacobian, NULL };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
