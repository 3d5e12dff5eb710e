/* The general path of a call: any array-like, any leading axes, any strides. */
#define NO_IMPORT_ARRAY
#include "closedform_numpy.h"
#include "closedform_sweep.h"

#if NPY_MAXDIMS > 64
#error "CF_MAX_AXES is too small for this NumPy"
#endif

#if defined(__linux__)
#include <sched.h>
#elif !defined(_WIN32)
#include <unistd.h>
#endif

enum {
    RELEASE_GIL_MIN = 64, /* releasing and taking the GIL takes about as long as these postures */
    THREADS_PAY = 131072  /* so many postures repay the start of threads */
};

typedef struct {
    const cf_call *call;
    PyArrayObject *in[CF_MAX_IN];
    PyArrayObject *field[CF_MAX_PARAMS]; /* NULL if the parameter is the number below */
    double number[CF_MAX_PARAMS];
    PyArrayObject *out[CF_MAX_OUT];
    int n_axes; /* leading axes after broadcasting */
    npy_intp length[NPY_MAXDIMS];
    size_t threads; /* 0: as many as pay */
} operands;

static PyObject *
shape_of(PyArrayObject *array)
{
    return PyArray_IntTupleFromIntp(PyArray_NDIM(array), PyArray_DIMS(array));
}

/* "(..., 2, 3)" */
static PyObject *
core_text(const cf_array *spec)
{
    PyObject *text = PyUnicode_FromString("(...");
    for (int a = 0; a < spec->ndim && text != NULL; a++) {
        Py_SETREF(text, PyUnicode_FromFormat("%U, %zu", text, spec->shape[a]));
    }
    if (text != NULL) {
        Py_SETREF(text, PyUnicode_FromFormat("%U)", text));
    }
    return text;
}

static int
core_matches(PyArrayObject *array, const cf_array *spec)
{
    int lead = PyArray_NDIM(array) - spec->ndim;
    if (lead < 0) {
        return 0;
    }
    for (int a = 0; a < spec->ndim; a++) {
        if (PyArray_DIM(array, lead + a) != (npy_intp)spec->shape[a]) {
            return 0;
        }
    }
    return 1;
}

static void
raise_core(const cf_function *f, const cf_array *spec, PyArrayObject *array)
{
    PyObject *shape = shape_of(array);
    PyObject *expected = core_text(spec);
    if (shape != NULL && expected != NULL) {
        PyErr_Format(PyExc_ValueError, "%s: %s has shape %R, expected %U", f->name, spec->name,
                     shape, expected);
    }
    Py_XDECREF(shape);
    Py_XDECREF(expected);
}

/* The number of cores on which this process may run. */
static size_t
available_cores(void)
{
    long n = 1;
#if defined(__linux__)
    cpu_set_t cores;
    if (sched_getaffinity(0, sizeof cores, &cores) == 0) {
        n = CPU_COUNT(&cores);
    }
#elif !defined(_WIN32)
    n = sysconf(_SC_NPROCESSORS_ONLN);
#endif
    return n > 1 ? (size_t)n : 1;
}

static int
take_threads(operands *o)
{
    const cf_function *f = o->call->function;
    PyObject *given = o->call->threads;
    if (given == NULL) {
        return 0;
    }
    if (PyBool_Check(given) || !PyIndex_Check(given)) {
        cf_raise_type(f, "threads must be an integer or None, not", given, "");
        return -1;
    }
    /* Clipped if it is too large: there are never more threads than blocks. */
    Py_ssize_t n = PyNumber_AsSsize_t(given, NULL);
    if (n == -1 && PyErr_Occurred()) {
        return -1;
    }
    if (n < 1) {
        PyErr_Format(PyExc_ValueError, "%s: threads is %R, expected at least 1", f->name, given);
        return -1;
    }
    o->threads = (size_t)n;
    return 0;
}

static int
take_inputs(operands *o)
{
    const cf_function *f = o->call->function;
    for (size_t k = 0; k < f->n_in; k++) {
        o->in[k] = cf_real_array(f, "", f->in[k].name, o->call->in[k]);
        if (o->in[k] == NULL) {
            return -1;
        }
    }
    return 0;
}

static int
take_field(operands *o, size_t k, PyObject *object)
{
    const cf_function *f = o->call->function;
    int known = cf_number(object, &o->number[k]);
    if (known != 0) {
        return known < 0 ? -1 : 0;
    }
    o->field[k] = cf_real_array(f, "params.", f->param_names[k], object);
    return o->field[k] == NULL ? -1 : 0;
}

static void
raise_param_count(const cf_function *f, Py_ssize_t given)
{
    PyObject *names = PyUnicode_FromString(f->param_names[0]);
    for (size_t k = 1; k < f->n_params && names != NULL; k++) {
        Py_SETREF(names, PyUnicode_FromFormat("%U, %s", names, f->param_names[k]));
    }
    if (names != NULL) {
        PyErr_Format(PyExc_ValueError, "%s: params has %zd fields, expected %zu (%U)", f->name,
                     given, f->n_params, names);
        Py_DECREF(names);
    }
}

static int
take_params(operands *o)
{
    const cf_function *f = o->call->function;
    if (o->call->params == NULL) {
        for (size_t k = 0; k < f->n_params; k++) {
            o->number[k] = f->defaults[k];
        }
        return 0;
    }
    PyObject *params = o->call->params;
    if (!PyTuple_Check(params) && !PyList_Check(params) &&
        !(PyArray_Check(params) && PyArray_NDIM((PyArrayObject *)params) > 0)) {
        PyObject *what = PyUnicode_FromFormat(
            "params must be Parameters or a sequence of its %zu fields, not", f->n_params);
        const char *text = what ? PyUnicode_AsUTF8(what) : NULL;
        if (text != NULL) {
            cf_raise_type(f, text, params,
                       PyDict_Check(params) ? "; write Parameters(**params)" : "");
        }
        Py_XDECREF(what);
        return -1;
    }
    /* A new tuple, because converting a field may run code that changes a list. */
    PyObject *fields = PySequence_Tuple(params);
    if (fields == NULL) {
        return -1;
    }
    int status = 0;
    if (PyTuple_GET_SIZE(fields) != (Py_ssize_t)f->n_params) {
        raise_param_count(f, PyTuple_GET_SIZE(fields));
        status = -1;
    }
    for (size_t k = 0; k < f->n_params && status == 0; k++) {
        status = take_field(o, k, PyTuple_GET_ITEM(fields, (Py_ssize_t)k));
    }
    Py_DECREF(fields);
    return status;
}

static int
check_kind(const cf_function *f, const char *prefix, const char *name, PyArrayObject *array)
{
    if (cf_has_kind(array, CF_REAL)) {
        return 0;
    }
    PyErr_Format(PyExc_ValueError, "%s: %s%s was changed while other arguments were converted",
                 f->name, prefix, name);
    return -1;
}

/* Checks the converted arrays after all conversions: converting an argument may run code of the
 * caller that changes the shape or dtype of an array that is already converted. From here to the
 * end of the sweep no such code runs, or its changes are not read any more. */
static int
check_arrays(const operands *o)
{
    const cf_function *f = o->call->function;
    for (size_t k = 0; k < f->n_in; k++) {
        if (check_kind(f, "", f->in[k].name, o->in[k]) < 0) {
            return -1;
        }
        if (!core_matches(o->in[k], &f->in[k])) {
            raise_core(f, &f->in[k], o->in[k]);
            return -1;
        }
    }
    for (size_t k = 0; k < f->n_params; k++) {
        if (o->field[k] != NULL &&
            check_kind(f, "params.", f->param_names[k], o->field[k]) < 0) {
            return -1;
        }
    }
    return 0;
}

/* Merges the leading axes of one array into those of the call; 0 if they do not broadcast. */
static int
broadcast(operands *o, PyArrayObject *array, int n_lead)
{
    const npy_intp *dims = PyArray_DIMS(array);
    if (n_lead > o->n_axes) {
        int more = n_lead - o->n_axes;
        memmove(o->length + more, o->length, (size_t)o->n_axes * sizeof o->length[0]);
        for (int a = 0; a < more; a++) {
            o->length[a] = 1;
        }
        o->n_axes = n_lead;
    }
    npy_intp *length = o->length + (o->n_axes - n_lead);
    for (int a = 0; a < n_lead; a++) {
        if (length[a] == 1) {
            length[a] = dims[a];
        } else if (dims[a] != 1 && dims[a] != length[a]) {
            return 0;
        }
    }
    return 1;
}

/* Appends a text such as "params.l1 (4,)" to `list` if there are leading axes. */
static int
append_lead(PyObject *list, const char *prefix, const char *name, PyArrayObject *array, int n_lead)
{
    if (n_lead == 0) {
        return 0;
    }
    PyObject *shape = PyArray_IntTupleFromIntp(n_lead, PyArray_DIMS(array));
    PyObject *text = shape ? PyUnicode_FromFormat("%s%s %R", prefix, name, shape) : NULL;
    int status = text ? PyList_Append(list, text) : -1;
    Py_XDECREF(shape);
    Py_XDECREF(text);
    return status;
}

static void
raise_broadcast(const operands *o)
{
    const cf_function *f = o->call->function;
    PyObject *list = PyList_New(0);
    int status = list ? 0 : -1;
    for (size_t k = 0; k < f->n_in && status == 0; k++) {
        int n_lead = PyArray_NDIM(o->in[k]) - f->in[k].ndim;
        status = append_lead(list, "", f->in[k].name, o->in[k], n_lead);
    }
    for (size_t k = 0; k < f->n_params && status == 0; k++) {
        if (o->field[k] != NULL) {
            status = append_lead(list, "params.", f->param_names[k], o->field[k],
                                 PyArray_NDIM(o->field[k]));
        }
    }
    PyObject *comma = status == 0 ? PyUnicode_FromString(", ") : NULL;
    PyObject *text = comma ? PyUnicode_Join(comma, list) : NULL;
    if (text != NULL) {
        PyErr_Format(PyExc_ValueError, "%s: leading axes do not broadcast: %U", f->name, text);
    }
    Py_XDECREF(text);
    Py_XDECREF(comma);
    Py_XDECREF(list);
}

static int
broadcast_all(operands *o)
{
    const cf_function *f = o->call->function;
    int fits = 1;
    for (size_t k = 0; k < f->n_in && fits; k++) {
        fits = broadcast(o, o->in[k], PyArray_NDIM(o->in[k]) - f->in[k].ndim);
    }
    for (size_t k = 0; k < f->n_params && fits; k++) {
        if (o->field[k] != NULL) {
            fits = broadcast(o, o->field[k], PyArray_NDIM(o->field[k]));
        }
    }
    if (!fits) {
        raise_broadcast(o);
        return -1;
    }
    return 0;
}

/* The array of the caller for output k, borrowed and not yet checked. */
static PyArrayObject *
given_output(const cf_call *call, size_t k)
{
    const cf_function *f = call->function;
    PyObject *array = call->out;
    if (f->n_out > 1) {
        if (!PyTuple_Check(call->out) || PyTuple_GET_SIZE(call->out) != (Py_ssize_t)f->n_out) {
            PyErr_Format(PyExc_TypeError, "%s: out must be a tuple of %zu arrays", f->name,
                         f->n_out);
            return NULL;
        }
        array = PyTuple_GET_ITEM(call->out, (Py_ssize_t)k);
    }
    int masked = cf_is_masked(array);
    if (!PyArray_Check(array) || masked != 0) {
        PyObject *what =
            masked < 0 ? NULL : PyUnicode_FromFormat("out for %s must be an array, not", f->out[k].name);
        const char *text = what ? PyUnicode_AsUTF8(what) : NULL;
        if (text != NULL) {
            cf_raise_type(f, text, array, "");
        }
        Py_XDECREF(what);
        return NULL;
    }
    return (PyArrayObject *)array;
}

static int
check_output(const cf_function *f, const cf_array *spec, PyArrayObject *array, int n_axes,
             const npy_intp *length)
{
    if (PyArray_NDIM(array) != n_axes ||
        !PyArray_CompareLists(PyArray_DIMS(array), length, n_axes)) {
        PyObject *shape = shape_of(array);
        PyObject *expected = PyArray_IntTupleFromIntp(n_axes, length);
        if (shape != NULL && expected != NULL) {
            PyErr_Format(PyExc_ValueError, "%s: out for %s has shape %R, expected %R", f->name,
                         spec->name, shape, expected);
        }
        Py_XDECREF(shape);
        Py_XDECREF(expected);
        return -1;
    }
    if (!cf_has_kind(array, spec->kind)) {
        static const char *const names[] = {"float64", "uint8", "bool"};
        PyErr_Format(PyExc_ValueError, "%s: out for %s has dtype %S, expected %s", f->name,
                     spec->name, (PyObject *)PyArray_DESCR(array), names[spec->kind]);
        return -1;
    }
    if (!PyArray_ISWRITEABLE(array)) {
        PyErr_Format(PyExc_ValueError, "%s: out for %s is read-only", f->name, spec->name);
        return -1;
    }
    if (cf_overlaps_itself(array)) {
        PyErr_Format(PyExc_ValueError, "%s: out for %s overlaps itself", f->name, spec->name);
        return -1;
    }
    return 0;
}

static int
take_output(operands *o, size_t k)
{
    const cf_function *f = o->call->function;
    const cf_array *spec = &f->out[k];
    npy_intp length[NPY_MAXDIMS + CF_MAX_CORE];
    int n_axes = o->n_axes + spec->ndim;
    memcpy(length, o->length, (size_t)o->n_axes * sizeof length[0]);
    for (int a = 0; a < spec->ndim; a++) {
        length[o->n_axes + a] = (npy_intp)spec->shape[a];
    }
    if (o->call->out == NULL) {
        o->out[k] = cf_new_output(spec, n_axes, length);
        return o->out[k] == NULL ? -1 : 0;
    }
    PyArrayObject *array = given_output(o->call, k);
    if (array == NULL || check_output(f, spec, array, n_axes, length) < 0) {
        return -1;
    }
    Py_INCREF(array);
    o->out[k] = array;
    return 0;
}

/* The half-open range of addresses that an array can touch. */
static void
extent(PyArrayObject *array, npy_uintp *low, npy_uintp *high)
{
    *low = (npy_uintp)PyArray_DATA(array);
    *high = *low + (npy_uintp)PyArray_ITEMSIZE(array);
    for (int a = 0; a < PyArray_NDIM(array); a++) {
        npy_intp reach = (PyArray_DIM(array, a) - 1) * PyArray_STRIDE(array, a);
        if (PyArray_DIM(array, a) == 0) {
            *high = *low;
            return;
        }
        if (reach < 0) {
            *low -= (npy_uintp)-reach;
        } else {
            *high += (npy_uintp)reach;
        }
    }
}

static int
overlap(PyArrayObject *a, PyArrayObject *b)
{
    npy_uintp a_low, a_high, b_low, b_high;
    extent(a, &a_low, &a_high);
    extent(b, &b_low, &b_high);
    return a_low < b_high && b_low < a_high;
}

static int
detach(const operands *o, PyArrayObject **array)
{
    for (size_t k = 0; k < o->call->function->n_out; k++) {
        if (overlap(*array, o->out[k])) {
            /* A plain array: a copy in the class of the caller would run its __array_finalize__. */
            PyObject *copy = PyArray_NewLikeArray(*array, NPY_KEEPORDER, NULL, 0);
            if (copy == NULL || PyArray_CopyInto((PyArrayObject *)copy, *array) < 0) {
                Py_XDECREF(copy);
                return -1;
            }
            Py_SETREF(*array, (PyArrayObject *)copy);
            return 0;
        }
    }
    return 0;
}

/* Copies arguments that an output of the caller might overwrite before they are read. */
static int
detach_all(operands *o)
{
    const cf_function *f = o->call->function;
    for (size_t k = 0; k < f->n_in; k++) {
        if (detach(o, &o->in[k]) < 0) {
            return -1;
        }
    }
    for (size_t k = 0; k < f->n_params; k++) {
        if (o->field[k] != NULL && detach(o, &o->field[k]) < 0) {
            return -1;
        }
    }
    return 0;
}

static void
view_array(const operands *o, PyArrayObject *array, int n_core, cf_view *view)
{
    int n_lead = PyArray_NDIM(array) - n_core;
    int missing = o->n_axes - n_lead;
    view->data = PyArray_BYTES(array);
    for (int a = 0; a < o->n_axes; a++) {
        int own = a - missing;
        view->lead[a] =
            own < 0 || PyArray_DIM(array, own) == 1 ? 0 : PyArray_STRIDE(array, own);
    }
    for (int a = 0; a < n_core; a++) {
        view->core[a] = PyArray_STRIDE(array, n_lead + a);
    }
}

static void
view_number(const operands *o, size_t k, cf_view *view)
{
    view->data = (char *)&o->number[k];
    memset(view->lead, 0, (size_t)o->n_axes * sizeof view->lead[0]);
}

static int
sweep(const operands *o)
{
    const cf_function *f = o->call->function;
    cf_sweep s;
    s.function = f;
    s.n_axes = (size_t)o->n_axes;
    for (int a = 0; a < o->n_axes; a++) {
        s.length[a] = (size_t)o->length[a];
    }
    for (size_t k = 0; k < f->n_params; k++) {
        if (o->field[k] != NULL) {
            view_array(o, o->field[k], 0, &s.param[k]);
        } else {
            view_number(o, k, &s.param[k]);
        }
    }
    for (size_t k = 0; k < f->n_in; k++) {
        view_array(o, o->in[k], f->in[k].ndim, &s.in[k]);
    }
    for (size_t k = 0; k < f->n_out; k++) {
        view_array(o, o->out[k], f->out[k].ndim, &s.out[k]);
    }

    npy_intp postures = PyArray_MultiplyList(o->length, o->n_axes);
    s.threads = o->threads > 0 ? o->threads : postures >= THREADS_PAY ? available_cores() : 1;
    PyThreadState *thread = NULL;
    if (postures >= RELEASE_GIL_MIN) {
        thread = PyEval_SaveThread();
    }
    int status = cf_sweep_run(&s);
    if (thread != NULL) {
        PyEval_RestoreThread(thread);
    }
    if (status < 0) {
        PyErr_NoMemory();
    }
    return status;
}

static int
evaluate(operands *o)
{
    const cf_function *f = o->call->function;
    if (take_threads(o) < 0 || take_inputs(o) < 0 || take_params(o) < 0 || check_arrays(o) < 0 || broadcast_all(o) < 0) {
        return -1;
    }
    for (size_t k = 0; k < f->n_out; k++) {
        if (take_output(o, k) < 0) {
            return -1;
        }
    }
    if (o->call->out != NULL && detach_all(o) < 0) {
        return -1;
    }
    return sweep(o);
}

/* Returns scalars as NumPy scalars, as a ufunc does, and arrays of the caller unchanged. */
static PyObject *
finish(operands *o)
{
    PyObject *items[CF_MAX_OUT];
    for (size_t k = 0; k < o->call->function->n_out; k++) {
        PyArrayObject *array = o->out[k];
        o->out[k] = NULL;
        items[k] = o->call->out == NULL ? PyArray_Return(array) : (PyObject *)array;
    }
    return cf_result(o->call, items);
}

PyObject *
cf_call_any(const cf_call *call)
{
    const cf_function *f = call->function;
    operands o = {.call = call};
    PyObject *result = evaluate(&o) < 0 ? NULL : finish(&o);
    for (size_t k = 0; k < f->n_in; k++) {
        Py_XDECREF(o.in[k]);
    }
    for (size_t k = 0; k < f->n_params; k++) {
        Py_XDECREF(o.field[k]);
    }
    for (size_t k = 0; k < f->n_out; k++) {
        Py_XDECREF(o.out[k]);
    }
    return result;
}
