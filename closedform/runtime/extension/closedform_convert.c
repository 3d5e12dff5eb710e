/* Converts the arguments of a caller to arrays of doubles; raises if they are not real numbers.
 * Looks at the memory of the arrays that results are written to. */
#define NO_IMPORT_ARRAY
#include "closedform_numpy.h"

void
cf_raise_type(const cf_function *f, const char *what, PyObject *object, const char *more)
{
    PyObject *type = PyType_GetName(Py_TYPE(object));
    if (type != NULL) {
        PyErr_Format(PyExc_TypeError, "%s: %s %U%s", f->name, what, type, more);
        Py_DECREF(type);
    }
}

int
cf_is_masked(PyObject *object)
{
    if (!PyArray_Check(object) || PyArray_CheckExact(object)) {
        return 0;
    }
    PyObject *name = PyUnicode_FromString("numpy.ma");
    PyObject *module = name ? PyImport_GetModule(name) : NULL;
    Py_XDECREF(name);
    if (module == NULL) {
        return PyErr_Occurred() ? -1 : 0;
    }
    PyObject *type = PyObject_GetAttrString(module, "MaskedArray");
    int masked = type ? PyObject_IsInstance(object, type) : -1;
    Py_XDECREF(type);
    Py_DECREF(module);
    return masked;
}

/* Whether an object is a real number; text is not, although float() would accept it. */
static int
is_real(PyObject *object)
{
    if (PyArray_IsScalar(object, Generic)) {
        PyArray_Descr *type = PyArray_DescrFromScalar(object);
        int known = type != NULL && strchr("biuf", type->kind) != NULL;
        Py_XDECREF(type);
        return known;
    }
    const PyNumberMethods *number = Py_TYPE(object)->tp_as_number;
    return number != NULL && (number->nb_float != NULL || number->nb_index != NULL) &&
           !PyComplex_Check(object);
}

static int
check_objects(const cf_function *f, const char *prefix, const char *name, PyArrayObject *array)
{
    PyObject *flat = PyArray_IterNew((PyObject *)array), *value;
    int status = flat ? 0 : -1;
    while (status == 0 && (value = PyIter_Next(flat)) != NULL) {
        if (!is_real(value)) {
            PyObject *what = PyUnicode_FromFormat("%s%s holds", prefix, name);
            const char *text = what ? PyUnicode_AsUTF8(what) : NULL;
            if (text != NULL) {
                cf_raise_type(f, text, value, ", expected real numbers");
            }
            Py_XDECREF(what);
            status = -1;
        }
        Py_DECREF(value);
    }
    Py_XDECREF(flat);
    return PyErr_Occurred() ? -1 : status;
}

/* Long doubles as doubles. NumPy's own conversion warns about values that are too large. */
static PyArrayObject *
narrow(PyArrayObject *array)
{
    PyArrayObject *wide = (PyArrayObject *)PyArray_FromArray(
        array, PyArray_DescrFromType(NPY_LONGDOUBLE), NPY_ARRAY_CARRAY_RO);
    if (wide == NULL) {
        return NULL;
    }
    PyArrayObject *real = (PyArrayObject *)PyArray_SimpleNew(PyArray_NDIM(wide),
                                                             PyArray_DIMS(wide), NPY_DOUBLE);
    const npy_longdouble *from = PyArray_DATA(wide);
    for (npy_intp k = 0; real != NULL && k < PyArray_SIZE(wide); k++) {
        ((double *)PyArray_DATA(real))[k] = (double)from[k];
    }
    Py_DECREF(wide);
    return real;
}

/* Complex numbers and text are refused, because NumPy would only warn about complex numbers and
 * would parse text. */
PyArrayObject *
cf_real_array(const cf_function *f, const char *prefix, const char *name, PyObject *object)
{
    int masked = cf_is_masked(object);
    if (masked != 0) {
        if (masked > 0) {
            PyErr_Format(PyExc_TypeError, "%s: %s%s is a masked array, expected real numbers",
                         f->name, prefix, name);
        }
        return NULL;
    }
    PyArrayObject *array = (PyArrayObject *)PyArray_FROM_O(object);
    if (array == NULL || cf_has_kind(array, CF_REAL)) {
        return array;
    }
    char kind = PyArray_DESCR(array)->kind;
    if (strchr("biufO", kind) == NULL) {
        PyErr_Format(PyExc_TypeError, "%s: %s%s has dtype %S, expected real numbers", f->name,
                     prefix, name, (PyObject *)PyArray_DESCR(array));
        Py_DECREF(array);
        return NULL;
    }
    if (kind == 'O' && check_objects(f, prefix, name, array) < 0) {
        Py_DECREF(array);
        return NULL;
    }
    if (kind == 'f' && PyArray_ITEMSIZE(array) > (npy_intp)sizeof(double)) {
        PyArrayObject *narrowed = narrow(array);
        Py_DECREF(array);
        return narrowed;
    }
    PyObject *real = PyArray_FromArray(array, PyArray_DescrFromType(NPY_DOUBLE),
                                       NPY_ARRAY_FORCECAST);
    Py_DECREF(array);
    return (PyArrayObject *)real;
}

/* Of the axes in the order of their strides, each must step over all that the shorter ones span;
 * slices, transposes and fields of an array do. */
int
cf_overlaps_itself(PyArrayObject *array)
{
    npy_intp span = PyArray_ITEMSIZE(array);
    npy_intp steps[NPY_MAXDIMS], reaches[NPY_MAXDIMS];
    int n = 0;
    for (int a = 0; a < PyArray_NDIM(array); a++) {
        npy_intp length = PyArray_DIM(array, a), stride = PyArray_STRIDE(array, a);
        if (length == 0) {
            return 0;
        }
        if (length > 1) {
            npy_intp step = stride < 0 ? -stride : stride;
            int b = n++;
            for (; b > 0 && steps[b - 1] > step; b--) {
                steps[b] = steps[b - 1];
                reaches[b] = reaches[b - 1];
            }
            steps[b] = step;
            reaches[b] = step * (length - 1);
        }
    }
    for (int b = 0; b < n; b++) {
        if (steps[b] < span) {
            return 1;
        }
        span += reaches[b];
    }
    return 0;
}
