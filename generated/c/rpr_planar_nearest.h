/*
 * Planar parallel mechanism (two RPR legs): the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_RPR_PLANAR_NEAREST_H
#define CLOSEDFORM_RPR_PLANAR_NEAREST_H

#include "closedform_nearest.h"
#include "rpr_planar.h"

#define RPR_PLANAR_JOINTS 2
#define RPR_PLANAR_BRANCHES 1

static inline void rpr_planar_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    rpr_planar_ik((const rpr_planar_params *)params, x, q, status);
}

static inline void rpr_planar_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[2];
    rpr_planar_fk((const rpr_planar_params *)params, q, x, status);
}

static inline void rpr_planar_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    rpr_planar_jacobian((const rpr_planar_params *)params, q, J);
}

static inline void rpr_planar_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    rpr_planar_determinant((const rpr_planar_params *)params, q, det);
}

/*
 * Of all branches of rpr_planar_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (rho1, rho2), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int rpr_planar_nearest(const rpr_planar_params *params, const real_t x[2],
    const real_t q_seed[2], const real_t *limits, const real_t *weights, real_t q[2], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 2, 1, 2, 2, 2, 2, 2, 1, 0, 0x0u,
        0x0u, rpr_planar_nearest_ik, rpr_planar_nearest_fk, rpr_planar_nearest_jacobian, rpr_planar_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
