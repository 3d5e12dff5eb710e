/* Rows are moved in runs of postures along one axis. The method depends on what is adjacent in
 * memory: neighbouring postures, the coordinates of a posture, or neither. The fields of an operand
 * are read before the loops, because the compiler must assume that the stores may change them. */
#include "closedform_rows.h"

#include <string.h>

enum { TILE = 16 }; /* postures moved at a time, so that both sides stay cached */

/* A memcpy of fixed size loads and stores unaligned memory in C; it compiles to one instruction. */
static inline void
gather_tile(const cf_operand *o, const char *from, ptrdiff_t step, size_t at, size_t count)
{
    double *plane = (double *)(void *)o->scratch + at;
    const ptrdiff_t *const offset = o->offset;
    const size_t n = o->spec->size, next = o->plane;
    for (size_t j = 0; j < n; j++, plane += next) {
        const char *source = from + offset[j];
        for (size_t i = 0; i < count; i++) {
            memcpy(&plane[i], source + step * (ptrdiff_t)i, sizeof(double));
        }
    }
}

static inline void
scatter_tile(const cf_operand *o, char *to, ptrdiff_t step, size_t at, size_t count)
{
    const double *plane = (const double *)(const void *)o->scratch + at;
    const ptrdiff_t *const offset = o->offset;
    const size_t n = o->spec->size, next = o->plane;
    for (size_t j = 0; j < n; j++, plane += next) {
        char *target = to + offset[j];
        for (size_t i = 0; i < count; i++) {
            memcpy(target + step * (ptrdiff_t)i, &plane[i], sizeof(double));
        }
    }
}

/* The transpose of two neighbours in each of two lines: two shuffles on any x86-64. */
static inline void
turn(char *to, ptrdiff_t to_step, const char *from, ptrdiff_t from_step)
{
    double a[2], b[2];
    memcpy(a, from, sizeof a);
    memcpy(b, from + from_step, sizeof b);
    const double c[2] = {a[0], b[0]}, d[2] = {a[1], b[1]};
    memcpy(to, c, sizeof c);
    memcpy(to + to_step, d, sizeof d);
}

static bool
in_pairs(const cf_operand *o, size_t count)
{
    return o->adjacent && o->spec->size >= 2 && count >= 2;
}

/* The k-th pair of n items; if n is odd, the last pair shares an item with the pair before. */
static inline size_t
pair(size_t k, size_t n)
{
    return k + 2 <= n ? k : n - 2;
}

/* Moves adjacent coordinates, as in an (N, n) array, in blocks of two coordinates of two postures,
 * so that memory is traversed from one end to the other. */
static void
gather_pairs(const cf_operand *o, const char *from, ptrdiff_t step, size_t at, size_t count)
{
    const ptrdiff_t coordinate = (ptrdiff_t)sizeof(double);
    const ptrdiff_t plane = (ptrdiff_t)o->plane * coordinate;
    const size_t n = o->spec->size;
    char *const scratch = o->scratch + coordinate * (ptrdiff_t)at;
    for (size_t k = 0; k < count; k += 2) {
        const ptrdiff_t i = (ptrdiff_t)pair(k, count);
        char *to = scratch + coordinate * i;
        for (size_t l = 0; l < n; l += 2) {
            const ptrdiff_t j = (ptrdiff_t)pair(l, n);
            turn(to + plane * j, plane, from + step * i + coordinate * j, step);
        }
    }
}

static void
scatter_pairs(const cf_operand *o, char *to, ptrdiff_t step, size_t at, size_t count)
{
    const ptrdiff_t coordinate = (ptrdiff_t)sizeof(double);
    const ptrdiff_t plane = (ptrdiff_t)o->plane * coordinate;
    const size_t n = o->spec->size;
    char *const scratch = o->scratch + coordinate * (ptrdiff_t)at;
    for (size_t k = 0; k < count; k += 2) {
        const ptrdiff_t i = (ptrdiff_t)pair(k, count);
        const char *from = scratch + coordinate * i;
        for (size_t l = 0; l < n; l += 2) {
            const ptrdiff_t j = (ptrdiff_t)pair(l, n);
            turn(to + step * i + coordinate * j, step, from + plane * j, plane);
        }
    }
}

/* These are fast because the compiler knows that a full tile has a fixed length, or that postures
 * are adjacent. */
void
cf_gather(const cf_operand *o, char *memory, ptrdiff_t step, size_t at, size_t count)
{
    if (step == (ptrdiff_t)sizeof(double)) {
        gather_tile(o, memory, sizeof(double), at, count);
        return;
    }
    if (in_pairs(o, count)) {
        gather_pairs(o, memory, step, at, count);
        return;
    }
    size_t i = 0;
    for (; i + TILE <= count; i += TILE) {
        gather_tile(o, memory + step * (ptrdiff_t)i, step, at + i, TILE);
    }
    gather_tile(o, memory + step * (ptrdiff_t)i, step, at + i, count - i);
}

static void
scatter_real(const cf_operand *o, char *to, ptrdiff_t step, size_t at, size_t count)
{
    if (step == (ptrdiff_t)sizeof(double)) {
        scatter_tile(o, to, sizeof(double), at, count);
        return;
    }
    if (in_pairs(o, count)) {
        scatter_pairs(o, to, step, at, count);
        return;
    }
    size_t i = 0;
    for (; i + TILE <= count; i += TILE) {
        scatter_tile(o, to + step * (ptrdiff_t)i, step, at + i, TILE);
    }
    scatter_tile(o, to + step * (ptrdiff_t)i, step, at + i, count - i);
}

static void
scatter_byte(const cf_operand *o, char *to, ptrdiff_t step, size_t at, size_t count)
{
    const char *plane = o->scratch + at;
    const ptrdiff_t *const offset = o->offset;
    const size_t n = o->spec->size, next = o->plane;
    for (size_t j = 0; j < n; j++, plane += next) {
        char *target = to + offset[j];
        for (size_t i = 0; i < count; i++) {
            target[step * (ptrdiff_t)i] = plane[i];
        }
    }
}

void
cf_scatter(const cf_operand *o, char *memory, ptrdiff_t step, size_t at, size_t count)
{
    if (o->spec->kind == CF_REAL) {
        scatter_real(o, memory, step, at, count);
    } else {
        scatter_byte(o, memory, step, at, count);
    }
}
