/* A sweep divides the leading axes into outer axes, along which parameters vary, and inner axes,
 * along which they do not. For each outer index the batch kernel computes the inner postures in
 * blocks. Operands that are already in planes are passed unchanged; the others are gathered into
 * scratch planes and scattered from them. If too few postures share their parameters, all axes are
 * outer, a block is one posture, and the single kernel is called. */
#if !defined(_WIN32)
#define CF_THREADS 1
#define _POSIX_C_SOURCE 200809L /* for pthread.h in strict C99 */
#endif

#include "closedform_sweep.h"
#include "closedform_rows.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#ifdef CF_THREADS
#include <pthread.h>
#endif

enum {
    BATCH_MIN = 4,          /* fewer postures than this are cheaper one at a time */
    BLOCK_MIN = 32,         /* long enough to amortise a kernel call */
    BLOCK_MAX = 512,        /* a few planes of this length fit into the first-level cache */
    SCRATCH_BYTES = 131072, /* target for all planes of a block: they fit into the second-level
                               cache, and many planes in memory need long runs */
    SHORT_RUN = 64,         /* an innermost axis below this is exchanged for the longest one */
    LINE = 64,              /* bytes in a cache line */
    ALIAS = 4096,           /* planes at a multiple of this distance use the same cache lines */
    ALIAS_WAYS = 4,         /* this many of such planes do no harm */
    THREADS_MAX = 256,      /* a limit to the memory of a call */
    CROWD = 16              /* more planes than this, written together, miss the address cache */
};

typedef struct {
    cf_sweep *sweep;
    size_t n_outer; /* this many of the first axes of the sweep are outer */
    size_t n_inner; /* postures along the inner axes */
    size_t block;   /* postures in a kernel call */
    size_t scratch; /* bytes in scratch planes for each posture */
    bool single;
    cf_operand in[CF_MAX_IN];
    cf_operand out[CF_MAX_OUT];
    void *memory;
} plan;

static size_t
product(const size_t *length, size_t n)
{
    size_t result = 1;
    for (size_t a = 0; a < n; a++) {
        result *= length[a];
    }
    return result;
}

static ptrdiff_t
position(const ptrdiff_t *step, const size_t *index, size_t n)
{
    ptrdiff_t result = 0;
    for (size_t a = 0; a < n; a++) {
        result += step[a] * (ptrdiff_t)index[a];
    }
    return result;
}

/* Moves a row-major index forward by `by`; after the end it starts again. */
static void
advance(size_t *index, const size_t *length, size_t n, size_t by)
{
    for (size_t a = n; a-- > 0 && by > 0;) {
        by += index[a];
        if (by < length[a]) {
            index[a] = by;
            return;
        }
        index[a] = by % length[a];
        by /= length[a];
    }
}

/* The k-th view of a sweep, in the order parameters, inputs, outputs. */
static cf_view *
view_at(cf_sweep *sweep, size_t k)
{
    const cf_function *f = sweep->function;
    if (k < f->n_params) {
        return &sweep->param[k];
    }
    k -= f->n_params;
    return k < f->n_in ? &sweep->in[k] : &sweep->out[k - f->n_in];
}

static size_t
view_count(const cf_sweep *sweep)
{
    const cf_function *f = sweep->function;
    return f->n_params + f->n_in + f->n_out;
}

static void
swap_axes(cf_sweep *sweep, size_t a, size_t b)
{
    size_t length = sweep->length[a];
    sweep->length[a] = sweep->length[b];
    sweep->length[b] = length;
    for (size_t k = 0; k < view_count(sweep); k++) {
        ptrdiff_t *lead = view_at(sweep, k)->lead;
        ptrdiff_t step = lead[a];
        lead[a] = lead[b];
        lead[b] = step;
    }
}

static void
copy_axis(cf_sweep *sweep, size_t to, size_t from)
{
    sweep->length[to] = sweep->length[from];
    for (size_t k = 0; k < view_count(sweep); k++) {
        ptrdiff_t *lead = view_at(sweep, k)->lead;
        lead[to] = lead[from];
    }
}

static void
drop_unit_axes(cf_sweep *sweep)
{
    size_t kept = 0;
    for (size_t a = 0; a < sweep->n_axes; a++) {
        if (sweep->length[a] != 1) {
            copy_axis(sweep, kept++, a);
        }
    }
    sweep->n_axes = kept;
}

static bool
params_vary(const cf_sweep *sweep, size_t axis)
{
    for (size_t k = 0; k < sweep->function->n_params; k++) {
        if (sweep->param[k].lead[axis] != 0) {
            return true;
        }
    }
    return false;
}

/* Moves the axes along which parameters vary to the front; keeps the order within each kind. */
static size_t
outer_axes_first(cf_sweep *sweep)
{
    size_t n_outer = 0;
    for (size_t a = 0; a < sweep->n_axes; a++) {
        if (params_vary(sweep, a)) {
            for (size_t b = a; b > n_outer; b--) {
                swap_axes(sweep, b, b - 1);
            }
            n_outer++;
        }
    }
    return n_outer;
}

static bool
axes_join(cf_sweep *sweep, size_t a)
{
    ptrdiff_t length = (ptrdiff_t)sweep->length[a + 1];
    for (size_t k = 0; k < view_count(sweep); k++) {
        const ptrdiff_t *lead = view_at(sweep, k)->lead;
        if (lead[a] != lead[a + 1] * length) {
            return false;
        }
    }
    return true;
}

/* Joins neighbouring inner axes that have a common step in every operand. */
static void
join_inner_axes(cf_sweep *sweep, size_t n_outer)
{
    for (size_t a = sweep->n_axes; a-- > n_outer + 1;) {
        if (axes_join(sweep, a - 1)) {
            size_t length = sweep->length[a - 1] * sweep->length[a];
            for (size_t b = a - 1; b + 1 < sweep->n_axes; b++) {
                copy_axis(sweep, b, b + 1);
            }
            sweep->length[a - 1] = length;
            sweep->n_axes--;
        }
    }
}

/* Data is moved in runs along the last axis, so a short one is exchanged for the longest. */
static void
long_axis_last(cf_sweep *sweep, size_t n_outer)
{
    size_t last = sweep->n_axes - 1;
    if (sweep->n_axes < n_outer + 2 || sweep->length[last] >= SHORT_RUN) {
        return;
    }
    size_t longest = last;
    for (size_t a = n_outer; a < last; a++) {
        if (sweep->length[a] > sweep->length[longest]) {
            longest = a;
        }
    }
    swap_axes(sweep, longest, last);
}

static bool
aligned(const cf_operand *o, size_t n_axes)
{
    size_t bits = (uintptr_t)o->view->data;
    for (size_t a = 0; a < n_axes; a++) {
        bits |= (size_t)o->view->lead[a];
    }
    for (int a = 0; a < o->spec->ndim; a++) {
        bits |= (size_t)o->view->core[a];
    }
    return bits % o->itemsize == 0;
}

/* The one step that visits all coordinates in row-major order, or -1 if there is none. */
static ptrdiff_t
core_step(const cf_operand *o)
{
    ptrdiff_t step = 0, extent = 0;
    for (int a = o->spec->ndim; a-- > 0;) {
        if (o->spec->shape[a] == 1) {
            continue;
        }
        if (extent == 0) {
            step = o->view->core[a];
            extent = 1;
        } else if (o->view->core[a] != step * extent) {
            return -1;
        }
        extent *= (ptrdiff_t)o->spec->shape[a];
    }
    return step;
}

/* Modulo ALIAS, the planes start at ALIAS / power different places only. */
static bool
planes_contend(size_t n, size_t step)
{
    size_t power = step & (~step + 1);
    return n * (power < ALIAS ? power : ALIAS) > (size_t)ALIAS_WAYS * ALIAS;
}

/* A batch kernel needs planes with adjacent postures, a single kernel a contiguous core. */
static bool
usable_in_place(const plan *p, const cf_operand *o)
{
    const cf_sweep *sweep = p->sweep;
    size_t last = sweep->n_axes - 1;
    ptrdiff_t itemsize = (ptrdiff_t)o->itemsize;
    ptrdiff_t step = core_step(o);
    if (step < 0 || !aligned(o, sweep->n_axes)) {
        return false;
    }
    if (p->single) {
        return o->spec->size == 1 || step == itemsize;
    }
    if (sweep->n_axes != p->n_outer + 1 || o->view->lead[last] != itemsize) {
        return false;
    }
    const bool crowded = o->spec->size > CROWD && p->n_inner > BLOCK_MAX;
    return !crowded && !planes_contend(o->spec->size, (size_t)step);
}

static void
describe(const plan *p, cf_operand *o, const cf_array *spec, const cf_view *view)
{
    o->spec = spec;
    o->view = view;
    o->itemsize = spec->kind == CF_REAL ? sizeof(double) : sizeof(uint8_t);
    o->in_place = usable_in_place(p, o);
    o->adjacent = core_step(o) == (ptrdiff_t)o->itemsize;
    o->plane = o->in_place && !p->single ? (size_t)core_step(o) / o->itemsize : 1;
    o->offset = NULL;
    o->scratch = NULL;
}

static void
fill_offsets(cf_operand *o)
{
    size_t index[CF_MAX_CORE] = {0};
    size_t n_axes = (size_t)o->spec->ndim;
    for (size_t j = 0; j < o->spec->size; j++) {
        o->offset[j] = position(o->view->core, index, n_axes);
        advance(index, o->spec->shape, n_axes, 1);
    }
}

/* The k-th operand, in the order inputs, outputs. */
static cf_operand *
operand_at(plan *p, size_t k)
{
    size_t n_in = p->sweep->function->n_in;
    return k < n_in ? &p->in[k] : &p->out[k - n_in];
}

static size_t
operand_count(const plan *p)
{
    return p->sweep->function->n_in + p->sweep->function->n_out;
}

static size_t
whole_lines(size_t bytes)
{
    return (bytes + LINE - 1) / LINE * LINE;
}

static size_t
block_length(const plan *p, size_t scratch_per_posture)
{
    if (p->single) {
        return 1;
    }
    if (scratch_per_posture == 0) {
        /* One block a thread, of whole cache lines, so that vectors are divided as in one block. */
        size_t share = whole_lines(p->n_inner / p->sweep->threads + 1);
        return share < p->n_inner && p->sweep->threads > 1 ? share : p->n_inner;
    }
    size_t block = SCRATCH_BYTES / scratch_per_posture / 8 * 8;
    block = block < BLOCK_MIN ? BLOCK_MIN : block > BLOCK_MAX ? BLOCK_MAX : block;
    return block < p->n_inner ? block : p->n_inner;
}

/* An odd number of cache lines, so that planes spread over the whole cache. */
static size_t
scratch_plane(const plan *p)
{
    size_t line = LINE / sizeof(double);
    return p->single ? 1 : ((p->block + line - 1) / line | 1) * line;
}

/* Divides one allocation into the scratch planes. */
static int
allocate(plan *p)
{
    size_t plane = scratch_plane(p);

    size_t bytes = LINE;
    for (size_t k = 0; k < operand_count(p); k++) {
        const cf_operand *o = operand_at(p, k);
        bytes += whole_lines(o->itemsize * o->spec->size * plane);
        bytes += whole_lines(sizeof(ptrdiff_t) * o->spec->size);
    }
    p->memory = NULL;
    if (p->scratch == 0) {
        return 0;
    }
    p->memory = malloc(bytes);
    if (p->memory == NULL) {
        return -1;
    }
    char *next = (char *)p->memory + (LINE - (uintptr_t)p->memory % LINE);
    for (size_t k = 0; k < operand_count(p); k++) {
        cf_operand *o = operand_at(p, k);
        if (!o->in_place) {
            o->plane = plane;
            o->scratch = next;
            next += whole_lines(o->itemsize * o->spec->size * plane);
            o->offset = (ptrdiff_t *)(void *)next;
            next += whole_lines(sizeof(ptrdiff_t) * o->spec->size);
            fill_offsets(o);
        }
    }
    return 0;
}

static void
make_plan(plan *p, cf_sweep *sweep)
{
    const cf_function *f = sweep->function;
    p->sweep = sweep;
    drop_unit_axes(sweep);
    p->n_outer = outer_axes_first(sweep);
    join_inner_axes(sweep, p->n_outer);
    long_axis_last(sweep, p->n_outer);
    p->n_inner = product(sweep->length + p->n_outer, sweep->n_axes - p->n_outer);
    p->single = p->n_inner < BATCH_MIN;
    if (p->single) {
        p->n_outer = sweep->n_axes;
        p->n_inner = 1;
    }
    for (size_t k = 0; k < f->n_in; k++) {
        describe(p, &p->in[k], &f->in[k], &sweep->in[k]);
    }
    for (size_t k = 0; k < f->n_out; k++) {
        describe(p, &p->out[k], &f->out[k], &sweep->out[k]);
    }
    p->scratch = 0;
    for (size_t k = 0; k < operand_count(p); k++) {
        cf_operand *o = operand_at(p, k);
        p->scratch += o->in_place ? 0 : o->itemsize * o->spec->size;
    }
    p->block = block_length(p, p->scratch);
}

/* Moves `count` postures, starting at inner index `start`, run by run along the last axis. */
static inline void
move(const plan *p, const cf_operand *o, char *base, const size_t *start, size_t count,
     cf_mover *run)
{
    size_t n = p->sweep->n_axes - p->n_outer;
    const size_t *length = p->sweep->length + p->n_outer;
    const ptrdiff_t *lead = o->view->lead + p->n_outer;
    size_t index[CF_MAX_AXES];
    memcpy(index, start, n * sizeof index[0]);
    for (size_t done = 0; done < count;) {
        size_t left = length[n - 1] - index[n - 1];
        size_t some = left < count - done ? left : count - done;
        run(o, base + position(lead, index, n), lead[n - 1], done, some);
        advance(index, length, n, some);
        done += some;
    }
}

static void
run_block(const plan *p, const double *params, char *const *base, const size_t *start,
          size_t first, size_t count)
{
    const cf_function *f = p->sweep->function;
    const double *in[CF_MAX_IN];
    void *out[CF_MAX_OUT];
    size_t in_plane[CF_MAX_IN], out_plane[CF_MAX_OUT];

    for (size_t k = 0; k < f->n_in; k++) {
        const cf_operand *o = &p->in[k];
        if (!o->in_place && p->single) {
            cf_gather_one(o, base[k]);
        } else if (!o->in_place) {
            move(p, o, base[k], start, count, cf_gather);
        }
        in[k] = (const double *)(void *)(o->in_place ? base[k] + first * o->itemsize : o->scratch);
        in_plane[k] = o->plane;
    }
    for (size_t k = 0; k < f->n_out; k++) {
        const cf_operand *o = &p->out[k];
        out[k] = o->in_place ? base[f->n_in + k] + first * o->itemsize : o->scratch;
        out_plane[k] = o->plane;
    }
    if (p->single) {
        f->single(params, in, out);
    } else {
        f->batch(count, params, in, in_plane, out, out_plane);
    }
    for (size_t k = 0; k < f->n_out; k++) {
        const cf_operand *o = &p->out[k];
        if (!o->in_place && p->single) {
            cf_scatter_one(o, base[f->n_in + k]);
        } else if (!o->in_place) {
            move(p, o, base[f->n_in + k], start, count, cf_scatter);
        }
    }
}

/* Computes the inner postures from `first`, which starts a block, to before `end`. */
static void
run_inner(const plan *p, const double *params, char *const *base, size_t first, size_t end)
{
    size_t n = p->sweep->n_axes - p->n_outer;
    const size_t *length = p->sweep->length + p->n_outer;
    size_t start[CF_MAX_AXES];
    memset(start, 0, n * sizeof start[0]);
    advance(start, length, n, first);
    while (first < end) {
        size_t count = end - first < p->block ? end - first : p->block;
        run_block(p, params, base, start, first, count);
        advance(start, length, n, count);
        first += count;
    }
}

static size_t
blocks_inside(const plan *p)
{
    return (p->n_inner + p->block - 1) / p->block;
}

/* Computes the blocks `first` to before `end`, counted through all outer indices. */
static void
run_blocks(const plan *p, size_t first, size_t end)
{
    const cf_sweep *sweep = p->sweep;
    const cf_function *f = sweep->function;
    size_t inside = blocks_inside(p);
    size_t index[CF_MAX_AXES];
    double params[CF_MAX_PARAMS];
    char *base[CF_MAX_IN + CF_MAX_OUT];
    memset(index, 0, p->n_outer * sizeof index[0]);
    advance(index, sweep->length, p->n_outer, first / inside);
    while (first < end) {
        for (size_t k = 0; k < f->n_params; k++) {
            const cf_view *view = &sweep->param[k];
            const char *from = view->data + position(view->lead, index, p->n_outer);
            memcpy(&params[k], from, sizeof params[k]);
        }
        for (size_t k = 0; k < operand_count(p); k++) {
            const cf_view *view = k < f->n_in ? p->in[k].view : p->out[k - f->n_in].view;
            base[k] = view->data + position(view->lead, index, p->n_outer);
        }
        size_t own = first % inside;
        size_t some = inside - own < end - first ? inside - own : end - first;
        size_t last = (own + some) * p->block;
        run_inner(p, params, base, own * p->block, last < p->n_inner ? last : p->n_inner);
        advance(index, sweep->length, p->n_outer, 1);
        first += some;
    }
}

#ifdef CF_THREADS

/* A share of the blocks, with scratch planes of its own. */
typedef struct {
    plan plan;
    size_t first, end;
    pthread_t thread;
    bool started;
} share;

static void *
run_share(void *argument)
{
    const share *s = argument;
    run_blocks(&s->plan, s->first, s->end);
    return NULL;
}

/* The calling thread takes the first share, and every share for which no thread can be had. */
static void
run_shares(share *shares, size_t n)
{
    for (size_t i = 1; i < n; i++) {
        shares[i].started = pthread_create(&shares[i].thread, NULL, run_share, &shares[i]) == 0;
    }
    run_share(&shares[0]);
    for (size_t i = 1; i < n; i++) {
        if (shares[i].started) {
            pthread_join(shares[i].thread, NULL);
        } else {
            run_share(&shares[i]);
        }
    }
}

static int
run_side_by_side(const plan *p, size_t blocks, size_t n)
{
    share *shares = calloc(n, sizeof *shares);
    if (shares == NULL) {
        return -1;
    }
    int status = 0;
    for (size_t i = 0; i < n && status == 0; i++) {
        shares[i].plan = *p;
        shares[i].first = blocks / n * i + (i < blocks % n ? i : blocks % n);
        shares[i].end = shares[i].first + blocks / n + (i < blocks % n);
        status = allocate(&shares[i].plan);
    }
    if (status == 0) {
        run_shares(shares, n);
    }
    for (size_t i = 0; i < n; i++) {
        free(shares[i].plan.memory);
    }
    free(shares);
    return status;
}

#endif

int
cf_sweep_run(cf_sweep *sweep)
{
    plan p;
    if (product(sweep->length, sweep->n_axes) == 0) {
        return 0;
    }
    make_plan(&p, sweep);
    size_t blocks = product(sweep->length, p.n_outer) * blocks_inside(&p);
#ifdef CF_THREADS
    size_t n = sweep->threads < blocks ? sweep->threads : blocks;
    if (n > 1) {
        return run_side_by_side(&p, blocks, n < THREADS_MAX ? n : THREADS_MAX);
    }
#endif
    if (allocate(&p) < 0) {
        return -1;
    }
    run_blocks(&p, 0, blocks);
    free(p.memory);
    return 0;
}
