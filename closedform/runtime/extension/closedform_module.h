/* The table that makes generated C functions available in Python.
 *
 * A generator prints one file that includes this header and defines `cf_functions` and
 * `cf_function_count`. closedform_module.c and its companions turn every row into a Python
 * callable with the signature
 *
 *     f(in[0], ..., in[n_in - 1], params=defaults, *, out=None, threads=None)
 *
 * All leading axes of inputs and of parameter fields broadcast. This header does not need Python.h,
 * so the table can be compiled and tested without it.
 */
#ifndef CLOSEDFORM_MODULE_H
#define CLOSEDFORM_MODULE_H

#include <stddef.h>

/* Limits of a table; a row that exceeds one makes the import fail. */
enum { CF_MAX_IN = 8, CF_MAX_OUT = 8, CF_MAX_PARAMS = 32, CF_MAX_CORE = 3 };

/* The type of the elements of an output. Inputs are always CF_REAL. */
typedef enum {
    CF_REAL,   /* double,  numpy.float64 */
    CF_STATUS, /* uint8_t, numpy.uint8 */
    CF_BOOL    /* uint8_t that is 0 or 1, numpy.bool */
} cf_kind;

/* One input or output of a single posture. */
typedef struct {
    const char *name;
    int ndim;                  /* at most CF_MAX_CORE; 0 is a scalar */
    size_t shape[CF_MAX_CORE]; /* the first `ndim` are used */
    size_t size;               /* product of the shape, at least 1 */
    cf_kind kind;
} cf_array;

/* One posture. Arrays are contiguous and row-major, and no output overlaps an input. */
typedef void cf_single(const double *params, const double *const *in, void *const *out);

/* `n` postures as structures of arrays: coordinate j of posture i of input k is
 * in[k][j * in_stride[k] + i]. The same holds for outputs, in elements of their own type. No output
 * overlaps an input. Strides are not negative; the stride of an input may be 0. */
typedef void cf_batch(size_t n, const double *params, const double *const *in,
                      const size_t *in_stride, void *const *out, const size_t *out_stride);

/* Several threads may call both kernels at the same time with the same row, without the GIL. */
typedef struct {
    const char *name; /* "planar_2r.fk": the Python module, a dot, the function */
    const char *doc;  /* becomes __doc__; __text_signature__ is made from the row */
    size_t n_params;  /* 0: the function takes no `params` */
    const double *defaults;
    const char *const *param_names;
    size_t n_in;
    const cf_array *in;
    size_t n_out; /* at least 1 */
    const cf_array *out;
    cf_single *single;
    cf_batch *batch;
} cf_function;

/* Hidden, so that two extensions in one process do not share their tables. */
#if defined(__GNUC__)
#define CF_INTERNAL __attribute__((visibility("hidden")))
#else
#define CF_INTERNAL
#endif

CF_INTERNAL extern const cf_function cf_functions[];
CF_INTERNAL extern const size_t cf_function_count;

#endif
