/* Moves the postures of an operand into the planes of a block, and out of them. A batch kernel
 * needs planes; the postures of an (N, n) array are rows. */
#ifndef CLOSEDFORM_ROWS_H
#define CLOSEDFORM_ROWS_H

#include <stdbool.h>
#include <string.h>

#include "closedform_sweep.h"

/* An operand as a kernel gets it. */
typedef struct {
    const cf_array *spec;
    const cf_view *view;
    size_t itemsize;
    bool in_place;     /* the kernel works on the view itself */
    bool adjacent;     /* the coordinates of a posture are adjacent in memory */
    size_t plane;      /* elements from one coordinate to the next, as the kernel sees them */
    ptrdiff_t *offset; /* bytes from a posture to each of its coordinates, unless in_place */
    char *scratch;     /* planes of one block, unless in_place */
} cf_operand;

/* Moves `count` postures from or to the scratch planes. The first one is at `memory`, each of the
 * others `step` bytes after the one before. `at` is the first index in the scratch planes. */
typedef void cf_mover(const cf_operand *o, char *memory, ptrdiff_t step, size_t at, size_t count);

CF_INTERNAL cf_mover cf_gather;
CF_INTERNAL cf_mover cf_scatter;

/* The same for a block of one posture: there a function call would take longer than the copy. */
static inline void
cf_gather_one(const cf_operand *o, const char *memory)
{
    const ptrdiff_t *const offset = o->offset;
    const size_t n = o->spec->size;
    char *scratch = o->scratch;
    for (size_t j = 0; j < n; j++, scratch += sizeof(double)) {
        memcpy(scratch, memory + offset[j], sizeof(double));
    }
}

static inline void
cf_scatter_one(const cf_operand *o, char *memory)
{
    const ptrdiff_t *const offset = o->offset;
    const size_t n = o->spec->size;
    const char *scratch = o->scratch;
    if (o->spec->kind == CF_REAL) {
        for (size_t j = 0; j < n; j++, scratch += sizeof(double)) {
            memcpy(memory + offset[j], scratch, sizeof(double));
        }
    } else {
        for (size_t j = 0; j < n; j++) {
            memory[offset[j]] = scratch[j];
        }
    }
}

#endif
