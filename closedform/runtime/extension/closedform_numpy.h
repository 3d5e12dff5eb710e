/* Python, NumPy and the common declarations of the files that use them. */
#ifndef CLOSEDFORM_NUMPY_H
#define CLOSEDFORM_NUMPY_H

#ifndef PY_SSIZE_T_CLEAN
#define PY_SSIZE_T_CLEAN
#endif
#include <Python.h>

#ifndef NPY_NO_DEPRECATED_API
#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#endif
#define PY_ARRAY_UNIQUE_SYMBOL closedform_array_api
#include <numpy/arrayobject.h>

#include "closedform_module.h"

/* A call with its arguments assigned; references are borrowed from the frame of the caller. */
typedef struct {
    const cf_function *function;
    PyTypeObject *results;   /* the class of several outputs: tuple or a NamedTuple */
    PyObject *in[CF_MAX_IN];
    PyObject *params;        /* NULL: the defaults */
    PyObject *out;           /* NULL: allocate */
    PyObject *threads;       /* NULL: as many as pay */
} cf_call;

/* Answers a call for one posture in plain form; *result is NULL if an exception is set.
 * Returns 0 if the call does not have that form; then nothing has been written. */
CF_INTERNAL int cf_call_single(const cf_call *call, PyObject **result);

/* Answers a call of any shape: converts, broadcasts, allocates and sweeps. */
CF_INTERNAL PyObject *cf_call_any(const cf_call *call);

/* The return value of a call for `items`, one for each output; steals them, also on failure. */
CF_INTERNAL PyObject *cf_result(const cf_call *call, PyObject **items);

/* Raises "toy.f: q holds str", with the name of the type of `object`. */
CF_INTERNAL void cf_raise_type(const cf_function *f, const char *what, PyObject *object,
                               const char *more);

/* Whether `object` is a masked array, whose mask a conversion would drop; -1 with an exception. */
CF_INTERNAL int cf_is_masked(PyObject *object);

/* An array of native doubles, of any strides and alignment. */
CF_INTERNAL PyArrayObject *cf_real_array(const cf_function *f, const char *prefix,
                                         const char *name, PyObject *object);

/* Whether two elements of an array may share memory. */
CF_INTERNAL int cf_overlaps_itself(PyArrayObject *array);

static inline int
cf_type_number(cf_kind kind)
{
    return kind == CF_REAL ? NPY_DOUBLE : kind == CF_STATUS ? NPY_UBYTE : NPY_BOOL;
}

/* A new array for one output; `n_axes` and `length` cover all axes, including the core. */
static inline PyArrayObject *
cf_new_output(const cf_array *spec, int n_axes, const npy_intp *length)
{
    return (PyArrayObject *)PyArray_NewFromDescr(
        &PyArray_Type, PyArray_DescrFromType(cf_type_number(spec->kind)), n_axes,
        (npy_intp *)length, NULL, NULL, 0, NULL);
}

/* Whether the elements of `array` are of that kind, in native byte order. */
static inline int
cf_has_kind(PyArrayObject *array, cf_kind kind)
{
    return PyArray_TYPE(array) == cf_type_number(kind) && PyArray_ISNOTSWAPPED(array);
}

/* Converts a Python number to a double without an array: 1 if it is one, 0 if not, -1 with an
 * exception. */
static inline int
cf_number(PyObject *object, double *value)
{
    if (PyFloat_Check(object)) {
        *value = PyFloat_AS_DOUBLE(object);
        return 1;
    }
    if (PyLong_CheckExact(object)) {
        *value = PyLong_AsDouble(object);
        return *value == -1.0 && PyErr_Occurred() ? -1 : 1;
    }
    return 0;
}

#endif
