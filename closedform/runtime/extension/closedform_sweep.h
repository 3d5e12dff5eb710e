/* Running a kernel over every posture of arrays with arbitrary strides. Knows nothing of Python. */
#ifndef CLOSEDFORM_SWEEP_H
#define CLOSEDFORM_SWEEP_H

#include "closedform_module.h"

enum { CF_MAX_AXES = 64 };

/* Where an operand lies; steps are in bytes, of any sign and alignment. */
typedef struct {
    char *data;
    ptrdiff_t lead[CF_MAX_AXES]; /* one for each leading axis, 0 where it is broadcast */
    ptrdiff_t core[CF_MAX_CORE];
} cf_view;

typedef struct {
    const cf_function *function;
    size_t n_axes;
    size_t length[CF_MAX_AXES];
    cf_view param[CF_MAX_PARAMS]; /* scalars: no core */
    cf_view in[CF_MAX_IN];
    cf_view out[CF_MAX_OUT];
} cf_sweep;

/* Evaluates all postures, reordering the axes of `sweep` as it likes. An output must not overlap
 * an input or a parameter. Returns -1 if memory is exhausted, and has then written nothing. */
CF_INTERNAL int cf_sweep_run(cf_sweep *sweep);

#endif
