/* The short path of a call: one posture in contiguous arrays or lists of numbers, with numbers as
 * parameters. Only the result is allocated. */
#define NO_IMPORT_ARRAY
#include "closedform_numpy.h"

/* Without a GIL another thread may change an object while this one reads it. */
#ifdef Py_GIL_DISABLED
#define CF_LOCK(object) Py_BEGIN_CRITICAL_SECTION(object)
#define CF_UNLOCK() Py_END_CRITICAL_SECTION()
#else
#define CF_LOCK(object) {
#define CF_UNLOCK() }
#endif

/* Space for the coordinates of all inputs together; a function with more takes the general path. */
enum { SPARE = 64 };

/* tuple.__new__(results, items), without its argument tuples if a tuple consists only of its items.
 * Since 3.14 a tuple also caches its hash, which only its own constructor resets. */
static PyObject *
new_tuple(PyTypeObject *results, Py_ssize_t n, PyObject **items)
{
#if PY_VERSION_HEX < 0x030E0000
    PyObject *tuple = results->tp_alloc(results, n);
    for (Py_ssize_t k = 0; k < n && tuple != NULL; k++) {
        PyTuple_SET_ITEM(tuple, k, Py_NewRef(items[k]));
    }
    return tuple;
#else
    PyObject *plain = PyTuple_New(n);
    for (Py_ssize_t k = 0; k < n && plain != NULL; k++) {
        PyTuple_SET_ITEM(plain, k, Py_NewRef(items[k]));
    }
    PyObject *args = plain ? PyTuple_Pack(1, plain) : NULL;
    PyObject *tuple = args ? PyTuple_Type.tp_new(results, args, NULL) : NULL;
    Py_XDECREF(args);
    Py_XDECREF(plain);
    return tuple;
#endif
}

PyObject *
cf_result(const cf_call *call, PyObject **items)
{
    size_t n = call->function->n_out;
    if (n == 1) {
        return items[0];
    }
    PyObject *result = NULL;
    size_t made = 0;
    while (made < n && items[made] != NULL) {
        made++;
    }
    if (made == n) {
        result = call->out != NULL && Py_IS_TYPE(call->out, call->results)
                     ? Py_NewRef(call->out)
                     : new_tuple(call->results, (Py_ssize_t)n, items);
    }
    for (size_t k = 0; k < n; k++) {
        Py_XDECREF(items[k]);
    }
    return result;
}

static int
is_core(PyArrayObject *array, const cf_array *spec, int flags)
{
    if (!cf_has_kind(array, spec->kind) || !PyArray_CHKFLAGS(array, flags) ||
        PyArray_NDIM(array) != spec->ndim) {
        return 0;
    }
    for (int a = 0; a < spec->ndim; a++) {
        if (PyArray_DIM(array, a) != (npy_intp)spec->shape[a]) {
            return 0;
        }
    }
    return 1;
}

/* A number that cannot be converted is left to the general path, which then raises. */
static int
plain_number(PyObject *object, double *value)
{
    int known = cf_number(object, value);
    if (known < 0) {
        PyErr_Clear();
    }
    return known == 1;
}

/* The numbers in a tuple or a list, which no other thread changes meanwhile. */
static int
plain_numbers(PyObject *sequence, size_t n, double *values)
{
    int known;
    CF_LOCK(sequence);
    known = PySequence_Fast_GET_SIZE(sequence) == (Py_ssize_t)n;
    PyObject **items = PySequence_Fast_ITEMS(sequence);
    for (size_t j = 0; j < n && known; j++) {
        known = plain_number(items[j], &values[j]);
    }
    CF_UNLOCK();
    return known;
}

/* The values of one posture's input, or NULL if the general path is needed. Python numbers are
 * written to `spare`, which has space for the input. */
static const double *
core_values(const cf_array *spec, PyObject *object, double *spare)
{
    if (PyArray_CheckExact(object)) {
        PyArrayObject *array = (PyArrayObject *)object;
        return is_core(array, spec, NPY_ARRAY_CARRAY_RO) ? PyArray_DATA(array) : NULL;
    }
    if (spec->ndim == 0) {
        return plain_number(object, spare) ? spare : NULL;
    }
    if (spec->ndim == 1 && (PyList_CheckExact(object) || PyTuple_CheckExact(object))) {
        return plain_numbers(object, spec->size, spare) ? spare : NULL;
    }
    return NULL;
}

static int
disjoint(const double *values, size_t n, PyArrayObject *array)
{
    npy_uintp low = (npy_uintp)values, start = (npy_uintp)PyArray_DATA(array);
    return low + n * sizeof *values <= start || start + (npy_uintp)PyArray_NBYTES(array) <= low;
}

/* Writes to the arrays of the caller; 0 if the general path is needed. Inputs that share memory
 * with an output are copied to `spare`. */
static int
single_into(const cf_call *call, const double *params, const double **in, double *spare)
{
    const cf_function *f = call->function;
    void *out[CF_MAX_OUT];
    if (f->n_out > 1 &&
        (!PyTuple_Check(call->out) || PyTuple_GET_SIZE(call->out) != (Py_ssize_t)f->n_out)) {
        return 0;
    }
    for (size_t k = 0; k < f->n_out; k++) {
        PyObject *object = f->n_out > 1 ? PyTuple_GET_ITEM(call->out, (Py_ssize_t)k) : call->out;
        PyArrayObject *array = (PyArrayObject *)object;
        if (!PyArray_CheckExact(object) || !is_core(array, &f->out[k], NPY_ARRAY_CARRAY)) {
            return 0;
        }
        out[k] = PyArray_DATA(array);
        double *room = spare;
        for (size_t i = 0; i < f->n_in; i++) {
            if (!disjoint(in[i], f->in[i].size, array)) {
                in[i] = memmove(room, in[i], f->in[i].size * sizeof *room);
            }
            room += f->in[i].size;
        }
    }
    f->single(params, in, out);
    return 1;
}

static PyObject *
given_result(const cf_call *call)
{
    size_t n = call->function->n_out;
    if (n == 1) {
        return Py_NewRef(call->out);
    }
    PyObject *items[CF_MAX_OUT];
    for (size_t k = 0; k < n; k++) {
        items[k] = Py_NewRef(PyTuple_GET_ITEM(call->out, (Py_ssize_t)k));
    }
    return cf_result(call, items);
}

static PyObject *
scalar(cf_kind kind, void *value)
{
    PyArray_Descr *type = PyArray_DescrFromType(cf_type_number(kind));
    PyObject *result = PyArray_Scalar(value, type, NULL);
    Py_DECREF(type);
    return result;
}

static PyObject *
single_new(const cf_call *call, const double *params, const double *const *in)
{
    const cf_function *f = call->function;
    PyObject *items[CF_MAX_OUT];
    void *out[CF_MAX_OUT];
    double cell[CF_MAX_OUT];
    for (size_t k = 0; k < f->n_out; k++) {
        const cf_array *spec = &f->out[k];
        npy_intp length[CF_MAX_CORE];
        if (spec->ndim == 0) {
            out[k] = &cell[k];
            continue;
        }
        for (int a = 0; a < spec->ndim; a++) {
            length[a] = (npy_intp)spec->shape[a];
        }
        PyArrayObject *array = cf_new_output(spec, spec->ndim, length);
        if (array == NULL) {
            while (k-- > 0) {
                if (f->out[k].ndim > 0) {
                    Py_DECREF(items[k]);
                }
            }
            return NULL;
        }
        out[k] = PyArray_DATA(array);
        items[k] = (PyObject *)array;
    }
    f->single(params, in, out);
    for (size_t k = 0; k < f->n_out; k++) {
        if (f->out[k].ndim == 0) {
            items[k] = scalar(f->out[k].kind, out[k]);
        }
    }
    return cf_result(call, items);
}

int
cf_call_single(const cf_call *call, PyObject **result)
{
    const cf_function *f = call->function;
    const double *in[CF_MAX_IN], *params = f->defaults;
    double spare[SPARE], numbers[CF_MAX_PARAMS];

    double *room = spare;
    for (size_t k = 0; k < f->n_in; k++) {
        if (f->in[k].size > (size_t)(spare + SPARE - room)) {
            return 0;
        }
        in[k] = core_values(&f->in[k], call->in[k], room);
        if (in[k] == NULL) {
            return 0;
        }
        room += f->in[k].size;
    }
    if (call->params != NULL) {
        if (!PyTuple_Check(call->params) || !plain_numbers(call->params, f->n_params, numbers)) {
            return 0;
        }
        params = numbers;
    }
    if (call->out == NULL) {
        *result = single_new(call, params, in);
    } else {
        if (!single_into(call, params, in, spare)) {
            return 0;
        }
        *result = given_result(call);
    }
    return 1;
}
