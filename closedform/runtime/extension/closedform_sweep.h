/* Runs a kernel over all postures of arrays with arbitrary strides. Does not use Python. */
#ifndef CLOSEDFORM_SWEEP_H
#define CLOSEDFORM_SWEEP_H

#include "closedform_module.h"

enum { CF_MAX_AXES = 64 };

/* The memory of an operand; steps are in bytes, with any sign and alignment. */
typedef struct {
    char *data;
    ptrdiff_t lead[CF_MAX_AXES]; /* one for each leading axis, 0 if it is broadcast */
    ptrdiff_t core[CF_MAX_CORE];
} cf_view;

typedef struct {
    const cf_function *function;
    size_t threads; /* at least 1: how many may work on the sweep; the results do not depend on it */
    size_t n_axes;
    size_t length[CF_MAX_AXES];
    cf_view param[CF_MAX_PARAMS]; /* scalars: no core */
    cf_view in[CF_MAX_IN];
    cf_view out[CF_MAX_OUT];
} cf_sweep;

/* Evaluates all postures; may reorder the axes of `sweep`. An output must not overlap an input or a
 * parameter. Returns -1 if memory is exhausted; then nothing has been written. */
CF_INTERNAL int cf_sweep_run(cf_sweep *sweep);

#endif
