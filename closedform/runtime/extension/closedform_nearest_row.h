/* What the table says of the posture nearest to a seed, besides the posture and its status. */
#ifndef CLOSEDFORM_NEAREST_ROW_H
#define CLOSEDFORM_NEAREST_ROW_H

#include "closedform_module.h"
#include "closedform_nearest.h"

enum { CF_NEAREST_IN = 5, CF_NEAREST_OUT = 5, CF_MOST_TARGET = 16 };

/* in: target, seed, limits, weights, and what is given besides the target, if anything; out: q, status,
 * branch, distance, outside. */
static inline void
cf_nearest_told(size_t joints, size_t branches, int branch, const uint32_t *outside,
                const double *const *in, void *const *out)
{
    const double *q = out[0];
    uint8_t *flags = out[4];
    double sum = 0;
    for (size_t j = 0; j < joints; j++) {
        sum += in[3][j] * (q[j] - in[1][j]) * (q[j] - in[1][j]);
    }
    *(double *)out[2] = branch;
    *(double *)out[3] = branch < 0 ? HUGE_VAL : sqrt(sum);
    for (size_t k = 0; k < branches * joints; k++) {
        flags[k] = (uint8_t)(outside[k / joints] >> (k % joints) & 1u);
    }
}

/* One after the other; the table wants a batch of every function. */
static inline void
cf_nearest_each(size_t inputs, size_t task, size_t joints, size_t branches, cf_single *one, size_t n,
                const double *params, const double *const *in, const size_t *in_stride,
                void *const *out, const size_t *out_stride)
{
    const size_t sizes[CF_NEAREST_IN] = {task, joints, 2 * joints, joints, 1};
    double given[CF_NEAREST_IN][CF_MOST_TARGET], q[CF_MOST_JOINTS], branch, distance;
    uint8_t status, outside[CF_MOST_BRANCHES * CF_MOST_JOINTS];
    const double *const values[CF_NEAREST_IN] = {given[0], given[1], given[2], given[3],
                                                 given[4]};
    void *const found[CF_NEAREST_OUT] = {q, &status, &branch, &distance, outside};
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < inputs; k++) {
            for (size_t j = 0; j < sizes[k]; j++) {
                given[k][j] = in[k][j * in_stride[k] + i];
            }
        }
        one(params, values, found);
        for (size_t j = 0; j < joints; j++) {
            ((double *)out[0])[j * out_stride[0] + i] = q[j];
        }
        ((uint8_t *)out[1])[i] = status;
        ((double *)out[2])[i] = branch;
        ((double *)out[3])[i] = distance;
        for (size_t k = 0; k < branches * joints; k++) {
            ((uint8_t *)out[4])[k * out_stride[4] + i] = outside[k];
        }
    }
}

#endif
