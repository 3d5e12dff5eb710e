/*
 * Planar 2R arm: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_PLANAR_2R_NEAREST_H
#define CLOSEDFORM_PLANAR_2R_NEAREST_H

#include "closedform_nearest.h"
#include "planar_2r.h"

#define PLANAR_2R_JOINTS 2
#define PLANAR_2R_BRANCHES 2

static inline void planar_2r_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    planar_2r_ik((const planar_2r_params *)params, x, q, status);
}

static inline void planar_2r_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    planar_2r_fk((const planar_2r_params *)params, q, x);
}

static inline void planar_2r_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    planar_2r_jacobian((const planar_2r_params *)params, q, J);
}

static inline void planar_2r_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    planar_2r_determinant((const planar_2r_params *)params, q, det);
}

/*
 * Of all branches of planar_2r_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta1, theta2), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int planar_2r_nearest(const planar_2r_params *params, const real_t x[2],
    const real_t q_seed[2], const real_t *limits, const real_t *weights, real_t q[2], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 2, 2, 2, 2, 1, 2, 3, 2, 2, 0x3u,
        0x0u, planar_2r_nearest_ik, planar_2r_nearest_fk, planar_2r_nearest_jacobian, planar_2r_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
