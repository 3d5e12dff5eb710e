/*
 * Orthoglide: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_ORTHOGLIDE_NEAREST_H
#define CLOSEDFORM_ORTHOGLIDE_NEAREST_H

#include "closedform_nearest.h"
#include "orthoglide.h"

#define ORTHOGLIDE_JOINTS 3
#define ORTHOGLIDE_BRANCHES 8

static inline void orthoglide_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    orthoglide_ik((const orthoglide_params *)params, x, q, status);
}

static inline void orthoglide_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[2];
    orthoglide_fk((const orthoglide_params *)params, q, x, status);
}

static inline void orthoglide_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    orthoglide_jacobian((const orthoglide_params *)params, q, J);
}

static inline void orthoglide_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    orthoglide_determinant((const orthoglide_params *)params, q, det);
}

/*
 * Of all branches of orthoglide_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (rho1, rho2, rho3), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int orthoglide_nearest(const orthoglide_params *params, const real_t x[3],
    const real_t q_seed[3], const real_t *limits, const real_t *weights, real_t q[3], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 3, 8, 3, 3, 2, 3, 3, 1, 0, 0x0u,
        0x0u, orthoglide_nearest_ik, orthoglide_nearest_fk, orthoglide_nearest_jacobian, orthoglide_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
