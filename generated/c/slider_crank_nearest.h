/*
 * Slider-crank: the posture nearest to a seed, printed by closedform.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SLIDER_CRANK_NEAREST_H
#define CLOSEDFORM_SLIDER_CRANK_NEAREST_H

#include "closedform_nearest.h"
#include "slider_crank.h"

#define SLIDER_CRANK_JOINTS 1
#define SLIDER_CRANK_BRANCHES 2

static inline void slider_crank_nearest_ik(const void *params, const real_t *x, real_t *q, uint8_t *status)
{
    slider_crank_ik((const slider_crank_params *)params, x, q, status);
}

static inline void slider_crank_nearest_fk(const void *params, const real_t *q, real_t *x)
{
    uint8_t status[2];
    slider_crank_fk((const slider_crank_params *)params, q, x, status);
}

static inline void slider_crank_nearest_jacobian(const void *params, const real_t *q, real_t *J)
{
    slider_crank_jacobian((const slider_crank_params *)params, q, J);
}

static inline void slider_crank_nearest_determinant(const void *params, const real_t *q, real_t *det)
{
    slider_crank_determinant((const slider_crank_params *)params, q, det);
}

/*
 * Of all branches of slider_crank_ik, and all turns of each joint, the posture that is nearest to a seed.
 *
 * limits: the lower limits of all joints (theta), then the upper ones; NULL: none.
 * weights: of the squares of the joints in the distance; NULL: all 1.
 * q, status: the posture and the status of its branch; NaN and CLOSEDFORM_UNREACHABLE or
 *     CLOSEDFORM_INVALID if there is none within the limits. Where a joint is free
 *     (CLOSEDFORM_SINGULAR), it keeps the value of the seed, and the others follow.
 * outside: for each branch, a bit for each joint that has no turn within its limits; may be NULL.
 * Returns the index of the branch, or -1. Of equal distances the first branch and the lower turn win.
 */
static inline int slider_crank_nearest(const slider_crank_params *params, const real_t x[1],
    const real_t q_seed[1], const real_t *limits, const real_t *weights, real_t q[1], uint8_t *status,
    uint32_t *outside)
{
    static const cf_robot robot = { 1, 2, 1, 1, 2, 1, 1, 3, 1, 0x1u,
        0x0u, slider_crank_nearest_ik, slider_crank_nearest_fk, slider_crank_nearest_jacobian, slider_crank_nearest_determinant };
    return cf_nearest_posture(
        &robot, params, x, q_seed, limits, weights, q, status, outside);
}

#endif
