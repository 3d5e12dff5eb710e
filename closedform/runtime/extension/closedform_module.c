/* The extension module that makes generated C functions available in Python.
 *
 * The rows of the table of closedform_module.h become callables of one type. closedform_single.c
 * answers a call with a single posture in plain arrays or lists. All other calls go to
 * closedform_call.c, which broadcasts, and from there to closedform_sweep.c, which runs the kernels
 * and does not use Python.
 *
 * The only mutable state is the type of the module and NumPy's table of functions, which are set when
 * the module is imported and only read afterwards. NumPy exists once per process, so the module
 * declines subinterpreters with a GIL of their own. It needs no GIL: a list is locked while it is
 * read, or copied. As for NumPy itself, no thread may reshape or resize an array that another one
 * uses, and what a thread reads of an array that another one writes is undefined.
 */
#include "closedform_numpy.h"

#include <structmember.h>

#ifndef CF_MODULE_NAME
#define CF_MODULE_NAME _native
#endif
#define CF_TEXT_(name) #name
#define CF_TEXT(name) CF_TEXT_(name)
#define CF_JOIN_(a, b) a##b
#define CF_JOIN(a, b) CF_JOIN_(a, b)

typedef struct {
    PyObject_HEAD
    vectorcallfunc vectorcall;
    const cf_function *function;
    PyTypeObject *results;
    PyObject *names; /* of the arguments in order, interned; `out` and `threads` are the last */
    PyObject *dict;
    PyObject *weakrefs;
} Function;

/* Arguments */

static PyObject **
argument(cf_call *call, size_t k)
{
    const cf_function *f = call->function;
    if (k < f->n_in) {
        return &call->in[k];
    }
    k -= f->n_in;
    if (f->n_params > 0 && k-- == 0) {
        return &call->params;
    }
    return k == 0 ? &call->out : &call->threads;
}

/* The index of a keyword among the argument names, or their number if it is not one of them.
 * Keywords in a call are interned, so a comparison by identity is nearly always enough. */
static Py_ssize_t
find_name(PyObject *names, PyObject *keyword)
{
    Py_ssize_t n = PyTuple_GET_SIZE(names);
    for (Py_ssize_t k = 0; k < n; k++) {
        if (PyTuple_GET_ITEM(names, k) == keyword) {
            return k;
        }
    }
    for (Py_ssize_t k = 0; k < n; k++) {
        if (PyUnicode_Compare(PyTuple_GET_ITEM(names, k), keyword) == 0) {
            return k;
        }
    }
    return n;
}

static int
bind_keywords(const Function *self, cf_call *call, PyObject *const *values, PyObject *keywords)
{
    const char *name = call->function->name;
    for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(keywords); i++) {
        PyObject *keyword = PyTuple_GET_ITEM(keywords, i);
        Py_ssize_t k = find_name(self->names, keyword);
        if (k == PyTuple_GET_SIZE(self->names)) {
            PyErr_Format(PyExc_TypeError, "%s() got an unexpected keyword argument '%U'", name,
                         keyword);
            return -1;
        }
        PyObject **slot = argument(call, (size_t)k);
        if (*slot != NULL) {
            PyErr_Format(PyExc_TypeError, "%s() got multiple values for argument '%U'", name,
                         keyword);
            return -1;
        }
        *slot = values[i];
    }
    return 0;
}

static int
bind(const Function *self, cf_call *call, PyObject *const *args, size_t n_args,
     PyObject *keywords)
{
    const cf_function *f = call->function;
    size_t n_positional = f->n_in + (f->n_params > 0);
    if (n_args > n_positional) {
        PyErr_Format(PyExc_TypeError,
                     "%s() takes at most %zu positional arguments but %zu were given", f->name,
                     n_positional, n_args);
        return -1;
    }
    for (size_t k = 0; k < n_args; k++) {
        *argument(call, k) = args[k];
    }
    if (keywords != NULL && bind_keywords(self, call, args + n_args, keywords) < 0) {
        return -1;
    }
    for (size_t k = 0; k < f->n_in; k++) {
        if (call->in[k] == NULL) {
            PyErr_Format(PyExc_TypeError, "%s() missing required argument: '%s'", f->name,
                         f->in[k].name);
            return -1;
        }
    }
    if (call->out == Py_None) {
        call->out = NULL;
    }
    if (call->threads == Py_None) {
        call->threads = NULL;
    }
    return 0;
}

static PyObject *
function_call(PyObject *object, PyObject *const *args, size_t n_args, PyObject *keywords)
{
    const Function *self = (const Function *)object;
    cf_call call = {.function = self->function, .results = self->results};
    if (bind(self, &call, args, (size_t)PyVectorcall_NARGS(n_args), keywords) < 0) {
        return NULL;
    }
    PyObject *result;
    if (call.threads == NULL && cf_call_single(&call, &result)) {
        return result;
    }
    return cf_call_any(&call);
}

/* The type */

static int
function_traverse(PyObject *object, visitproc visit, void *arg)
{
    Function *self = (Function *)object;
    Py_VISIT(Py_TYPE(self));
    Py_VISIT(self->results);
    Py_VISIT(self->names);
    Py_VISIT(self->dict);
    return 0;
}

static int
function_clear(PyObject *object)
{
    Py_CLEAR(((Function *)object)->dict);
    return 0;
}

static void
function_dealloc(PyObject *object)
{
    Function *self = (Function *)object;
    PyTypeObject *type = Py_TYPE(self);
    PyObject_GC_UnTrack(self);
    PyObject_ClearWeakRefs(object);
    Py_XDECREF(self->results);
    Py_XDECREF(self->names);
    Py_XDECREF(self->dict);
    PyObject_GC_Del(self);
    Py_DECREF(type);
}

static PyObject *
function_repr(PyObject *object)
{
    return PyUnicode_FromFormat("<compiled function %s>", ((Function *)object)->function->name);
}

/* A function stored on a class does not become a method. With __get__, help() and inspect treat the
 * object as a routine and read __text_signature__. */
static PyObject *
function_get(PyObject *object, PyObject *Py_UNUSED(instance), PyObject *Py_UNUSED(owner))
{
    return Py_NewRef(object);
}

static PyObject *
function_reduce(PyObject *object, PyObject *Py_UNUSED(none))
{
    Function *self = (Function *)object;
    PyObject *module = PyType_GetModule(Py_TYPE(self));
    PyObject *maker = module ? PyObject_GetAttrString(module, "function") : NULL;
    if (maker == NULL) {
        return NULL;
    }
    return Py_BuildValue("N(sO)", maker, self->function->name, self->results);
}

static PyMethodDef function_methods[] = {
    {"__reduce__", function_reduce, METH_NOARGS, NULL},
    {NULL, NULL, 0, NULL},
};

static PyMemberDef function_members[] = {
    {"__vectorcalloffset__", T_PYSSIZET, offsetof(Function, vectorcall), READONLY, NULL},
    {"__dictoffset__", T_PYSSIZET, offsetof(Function, dict), READONLY, NULL},
    {"__weaklistoffset__", T_PYSSIZET, offsetof(Function, weakrefs), READONLY, NULL},
    {NULL, 0, 0, 0, NULL},
};

static PyGetSetDef function_getset[] = {
    {"__dict__", PyObject_GenericGetDict, PyObject_GenericSetDict, NULL, NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot function_slots[] = {
    {Py_tp_dealloc, function_dealloc},
    {Py_tp_traverse, function_traverse},
    {Py_tp_clear, function_clear},
    {Py_tp_repr, function_repr},
    {Py_tp_call, PyVectorcall_Call},
    {Py_tp_descr_get, function_get},
    {Py_tp_methods, function_methods},
    {Py_tp_members, function_members},
    {Py_tp_getset, function_getset},
    {0, NULL},
};

static PyType_Spec function_spec = {
    .name = "closedform.generated.c." CF_TEXT(CF_MODULE_NAME) ".Function",
    .basicsize = sizeof(Function),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_HAVE_VECTORCALL |
             Py_TPFLAGS_IMMUTABLETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION,
    .slots = function_slots,
};

/* Making functions */

static const char *
argument_name(const cf_function *f, size_t k)
{
    if (k < f->n_in) {
        return f->in[k].name;
    }
    k -= f->n_in;
    if (f->n_params > 0 && k-- == 0) {
        return "params";
    }
    return k == 0 ? "out" : "threads";
}

static const char *
output_name(const cf_function *f, size_t k)
{
    return f->out[k].name;
}

static const char *
row_name(const cf_function *f, size_t k)
{
    return f[k].name;
}

/* The tuple of name(f, 0), ..., name(f, n - 1). */
static PyObject *
names_tuple(const char *name(const cf_function *, size_t), const cf_function *f, size_t n)
{
    PyObject *names = PyTuple_New((Py_ssize_t)n);
    for (size_t k = 0; k < n && names != NULL; k++) {
        PyObject *text = PyUnicode_InternFromString(name(f, k));
        if (text == NULL) {
            Py_CLEAR(names);
        } else {
            PyTuple_SET_ITEM(names, (Py_ssize_t)k, text);
        }
    }
    return names;
}

/* "(q, params=(1.0, 0.5), *, out=None, threads=None)" */
static PyObject *
text_signature(const cf_function *f)
{
    PyObject *text = PyUnicode_FromString("(");
    for (size_t k = 0; k < f->n_in && text != NULL; k++) {
        Py_SETREF(text, PyUnicode_FromFormat("%U%s, ", text, f->in[k].name));
    }
    if (f->n_params > 0 && text != NULL) {
        PyObject *defaults = PyTuple_New((Py_ssize_t)f->n_params);
        for (size_t k = 0; k < f->n_params && defaults != NULL; k++) {
            PyObject *value = PyFloat_FromDouble(f->defaults[k]);
            if (value == NULL) {
                Py_CLEAR(defaults);
            } else {
                PyTuple_SET_ITEM(defaults, (Py_ssize_t)k, value);
            }
        }
        Py_SETREF(text, defaults ? PyUnicode_FromFormat("%Uparams=%R, ", text, defaults) : NULL);
        Py_XDECREF(defaults);
    }
    if (text != NULL) {
        Py_SETREF(text, PyUnicode_FromFormat("%U*, out=None, threads=None)", text));
    }
    return text;
}

/* The name of a module in the package of this one, such as "closedform.generated.c.planar_2r". */
static PyObject *
python_module(PyObject *module, const cf_function *f)
{
    const char *dot = strrchr(f->name, '.');
    PyObject *own = PyModule_GetNameObject(module);
    PyObject *robot = PyUnicode_FromStringAndSize(f->name, dot ? dot - f->name : 0);
    PyObject *name = NULL;
    if (own != NULL && robot != NULL) {
        Py_ssize_t n = PyUnicode_GET_LENGTH(own);
        Py_ssize_t end = PyUnicode_FindChar(own, '.', 0, n, -1);
        PyObject *package = PyUnicode_Substring(own, 0, end < 0 ? 0 : end + 1);
        name = package ? PyUnicode_Concat(package, robot) : NULL;
        Py_XDECREF(package);
    }
    Py_XDECREF(own);
    Py_XDECREF(robot);
    return name;
}

/* Steals `value`. */
static int
set_item(PyObject *dict, const char *key, PyObject *value)
{
    int status = value ? PyDict_SetItemString(dict, key, value) : -1;
    Py_XDECREF(value);
    return status;
}

static PyObject *
function_dict(PyObject *module, const cf_function *f)
{
    const char *dot = strrchr(f->name, '.');
    const char *last = dot ? dot + 1 : f->name;
    PyObject *dict = PyDict_New();
    if (dict == NULL || set_item(dict, "__name__", PyUnicode_FromString(last)) < 0 ||
        set_item(dict, "__qualname__", PyUnicode_FromString(last)) < 0 ||
        set_item(dict, "__module__", python_module(module, f)) < 0 ||
        set_item(dict, "__doc__", PyUnicode_FromString(f->doc ? f->doc : "")) < 0 ||
        set_item(dict, "__text_signature__", text_signature(f)) < 0) {
        Py_CLEAR(dict);
    }
    return dict;
}

/* The class must have the names of the outputs in the table, in the same order. */
static int
check_results(const cf_function *f, PyObject *results)
{
    if (!PyType_Check(results) || !PyType_IsSubtype((PyTypeObject *)results, &PyTuple_Type)) {
        PyErr_Format(PyExc_TypeError, "%s: results must be a subclass of tuple, not %R", f->name,
                     results);
        return -1;
    }
    if (results == (PyObject *)&PyTuple_Type) {
        return 0;
    }
    PyObject *fields = PyObject_GetAttrString(results, "_fields");
    PyObject *names = fields ? names_tuple(output_name, f, f->n_out) : NULL;
    int same = names ? PyObject_RichCompareBool(fields, names, Py_EQ) : -1;
    if (same == 0 || (same == 1 && f->n_out == 1)) {
        PyErr_Format(PyExc_ValueError, "%s: results has fields %R, but the outputs are %R",
                     f->name, fields, names);
        same = -1;
    }
    Py_XDECREF(fields);
    Py_XDECREF(names);
    return same < 0 ? -1 : 0;
}

static const cf_function *
find_function(const char *name)
{
    for (size_t k = 0; k < cf_function_count; k++) {
        if (strcmp(cf_functions[k].name, name) == 0) {
            return &cf_functions[k];
        }
    }
    PyErr_Format(PyExc_KeyError, "no compiled function is called %s; after a new derivation, run make",
        name);
    return NULL;
}

static PyTypeObject **
module_type(PyObject *module)
{
    return PyModule_GetState(module);
}

static PyObject *
module_function(PyObject *module, PyObject *args)
{
    const char *name;
    PyObject *results = (PyObject *)&PyTuple_Type;
    if (!PyArg_ParseTuple(args, "s|O:function", &name, &results)) {
        return NULL;
    }
    const cf_function *f = find_function(name);
    if (f == NULL || check_results(f, results) < 0) {
        return NULL;
    }
    Function *self = PyObject_GC_New(Function, *module_type(module));
    if (self == NULL) {
        return NULL;
    }
    self->vectorcall = function_call;
    self->function = f;
    self->results = (PyTypeObject *)Py_NewRef(results);
    self->weakrefs = NULL;
    self->names = names_tuple(argument_name, f, f->n_in + (f->n_params > 0) + 2);
    self->dict = function_dict(module, f);
    PyObject_GC_Track(self);
    if (self->names == NULL || self->dict == NULL) {
        Py_CLEAR(self);
    }
    return (PyObject *)self;
}

PyDoc_STRVAR(module_function_doc,
             "function(name, results=tuple, /)\n--\n\n"
             "The compiled function of that name, such as 'planar_2r.fk'.\n\n"
             "Several outputs are returned as `results`, a NamedTuple with the outputs as fields.");

static PyMethodDef module_methods[] = {
    {"function", module_function, METH_VARARGS, module_function_doc},
    {NULL, NULL, 0, NULL},
};

/* The module */

static int
array_is_sound(const cf_array *spec)
{
    size_t size = 1;
    if (spec->ndim < 0 || spec->ndim > CF_MAX_CORE) {
        return 0;
    }
    for (int a = 0; a < spec->ndim; a++) {
        size *= spec->shape[a];
    }
    return size >= 1 && size == spec->size;
}

static int
check_function(const cf_function *f)
{
    int sound = f->n_in <= CF_MAX_IN && f->n_params <= CF_MAX_PARAMS && f->n_out >= 1 &&
                f->n_out <= CF_MAX_OUT && f->single != NULL && f->batch != NULL;
    for (size_t k = 0; sound && k < f->n_in; k++) {
        sound = array_is_sound(&f->in[k]) && f->in[k].kind == CF_REAL;
    }
    for (size_t k = 0; sound && k < f->n_out; k++) {
        sound = array_is_sound(&f->out[k]);
    }
    if (!sound) {
        PyErr_Format(PyExc_ImportError, "%s: malformed row in the table of functions", f->name);
        return -1;
    }
    return 0;
}

static int
module_exec(PyObject *module)
{
#ifdef CLOSEDFORM_PROCESSOR
    if (!__builtin_cpu_supports(CLOSEDFORM_PROCESSOR)) {
        PyErr_SetString(PyExc_ImportError, "the compiled modules are for processors of the level "
                        CLOSEDFORM_PROCESSOR ", which this one is not: run make here, or build "
                        "them for all processors with CLOSEDFORM_DISPATCH=1");
        return -1;
    }
#endif
    import_array1(-1);
    for (size_t k = 0; k < cf_function_count; k++) {
        if (check_function(&cf_functions[k]) < 0) {
            return -1;
        }
    }
    PyObject *type = PyType_FromModuleAndSpec(module, &function_spec, NULL);
    if (type == NULL) {
        return -1;
    }
    *module_type(module) = (PyTypeObject *)type;
    return set_item(PyModule_GetDict(module), "names",
                    names_tuple(row_name, cf_functions, cf_function_count));
}

static int
module_traverse(PyObject *module, visitproc visit, void *arg)
{
    Py_VISIT(*module_type(module));
    return 0;
}

static int
module_clear(PyObject *module)
{
    Py_CLEAR(*module_type(module));
    return 0;
}

static PyModuleDef_Slot module_slots[] = {
    {Py_mod_exec, module_exec},
#if PY_VERSION_HEX >= 0x030D0000
    {Py_mod_gil, Py_MOD_GIL_NOT_USED},
#endif
    {0, NULL},
};

static struct PyModuleDef module_definition = {
    PyModuleDef_HEAD_INIT,
    .m_name = CF_TEXT(CF_MODULE_NAME),
    .m_doc = "Generated C kernels as Python functions.",
    .m_size = sizeof(PyTypeObject *),
    .m_methods = module_methods,
    .m_slots = module_slots,
    .m_traverse = module_traverse,
    .m_clear = module_clear,
};

PyMODINIT_FUNC
CF_JOIN(PyInit_, CF_MODULE_NAME)(void)
{
    return PyModuleDef_Init(&module_definition);
}
