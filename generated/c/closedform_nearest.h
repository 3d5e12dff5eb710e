/* closedform_nearest.h: of all branches and turns of an inverse, the posture that is nearest to a seed.
 *
 * The functions for one robot are in its own header, such as ur_arm_nearest.h. C99 (and C++), header
 * only, no state, no allocation.
 */
#ifndef CLOSEDFORM_NEAREST_H
#define CLOSEDFORM_NEAREST_H

#include "closedform.h"

#define CF_MOST_JOINTS 8
#define CF_MOST_BRANCHES 32
#define CF_MOST_ROWS 7
#define CF_MOST_NUMBERS 256 /* of the targets or the Jacobians of all assembly modes */

#ifdef CLOSEDFORM_FLOAT
#define CF_REACHED CLOSEDFORM_C(1e-5)  /* the error of an answer, relative to the size */
#define CF_STRAIGHT CLOSEDFORM_C(1e-4) /* ... of a posture on the way to it */
#define CF_FREE CLOSEDFORM_C(1e-3)     /* the target does not move */
#define CF_DAMPING CLOSEDFORM_C(1e-6)
#define CF_NEARLY CLOSEDFORM_C(1e-5) /* a determinant that only rounding keeps from zero */
#define CF_SLACK CLOSEDFORM_C(1e-5)
#define CF_DIFFERENCE CLOSEDFORM_C(1e-2) /* the step of differences of fourth order */
#define CF_BESIDE CLOSEDFORM_C(1e-5)
#else
#define CF_REACHED CLOSEDFORM_C(1e-12)
#define CF_STRAIGHT CLOSEDFORM_C(1e-9)
#define CF_FREE CLOSEDFORM_C(1e-6)
#define CF_DAMPING CLOSEDFORM_C(1e-13)
#define CF_NEARLY CLOSEDFORM_C(1e-12)
#define CF_SLACK CLOSEDFORM_C(1e-9) /* how far a joint may pass a limit, in rad */
#define CF_DIFFERENCE CLOSEDFORM_C(1e-3)
#define CF_BESIDE CLOSEDFORM_C(1e-10) /* a number that changes much over so little is undefined */
#endif
#define CF_INFINITE CLOSEDFORM_C(HUGE_VAL)
#define CF_TURN CLOSEDFORM_C(6.283185307179586)
#define CF_SHARE CLOSEDFORM_C(1e-3)
#define CF_LONGEST CLOSEDFORM_C(0.5) /* rad; a step along a self-motion */
#define CF_STEPS 24
#define CF_BOWED CLOSEDFORM_C(1e-3) /* a line whose direction rounding spoils; what is left is corrected */

/* The functions and the sizes of one robot. task: 16 for a pose, 17 for a pose and a number that is
 * given besides it (the last of x, and of the rows of J), 9 for a rotation, or the number of
 * coordinates; angles and revolute have a bit for each coordinate and each joint. held: the joint that
 * is given, or the number of joints. lengths: the power of a length in the determinant, which is NULL
 * if there is none. */
typedef struct {
    size_t joints, branches, held, task, modes, rows, jacobian_rows, fields, lengths;
    unsigned revolute, angles;
    void (*ik)(const void *params, const real_t *x, real_t *q, uint8_t *status);
    void (*fk)(const void *params, const real_t *q, real_t *x);
    void (*jacobian)(const void *params, const real_t *q, real_t *J);
    void (*determinant)(const void *params, const real_t *q, real_t *det);
} cf_robot;

typedef struct {
    const cf_robot *robot;
    const void *params;
    const real_t *x;
    real_t size;
    size_t rows; /* of the error; the number besides the pose does not count where it is undefined */
} cf_task;

static inline int cf_is_pose(const cf_robot *robot)
{
    return robot->task == 16 || robot->task == 17;
}

static inline real_t cf_less_turns(real_t angle)
{
    return angle - CF_TURN * CF_LIBM(rint)(angle / CF_TURN);
}

static inline int cf_turns(const cf_robot *robot, size_t joint)
{
    return (int)((robot->revolute >> joint) & 1u);
}

/* The axis times the angle of a rotation. */
static inline void cf_rotation_vector(const real_t R[9], real_t v[3])
{
    v[0] = (R[7] - R[5]) / 2;
    v[1] = (R[2] - R[6]) / 2;
    v[2] = (R[3] - R[1]) / 2;
    const real_t sine = CF_LIBM(sqrt)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const real_t angle = CF_LIBM(atan2)(sine, (R[0] + R[4] + R[8] - 1) / 2);
    if (sine > CLOSEDFORM_C(1e-8)) {
        for (size_t i = 0; i < 3; ++i) v[i] *= angle / sine;
    } else if (angle > 1) {
        v[0] = CF_TURN / 2; /* half a turn, about some axis */
    }
}

/* a b^T of 3x3 blocks of matrices with rows of the given lengths. */
static inline void cf_times_transposed(
    const real_t *a, size_t a_row, const real_t *b, size_t b_row, real_t c[9])
{
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            c[3 * i + j] = a[a_row * i] * b[b_row * j] + a[a_row * i + 1] * b[b_row * j + 1] +
                           a[a_row * i + 2] * b[b_row * j + 2];
}

static inline real_t cf_gap(const cf_task *t, size_t i, real_t at)
{
    const real_t gap = t->x[i] - at;
    return ((t->robot->angles >> i) & 1u) ? cf_less_turns(gap) : gap / t->size;
}

/* The assembly mode that is nearest to the target. */
static inline size_t cf_mode(const cf_task *t, const real_t *at)
{
    size_t best = 0;
    real_t least = CF_INFINITE;
    for (size_t m = 0; m < t->robot->modes; ++m) {
        real_t worst = 0;
        for (size_t i = 0; i < t->robot->task; ++i) {
            const real_t gap = CF_LIBM(fabs)(cf_gap(t, i, at[m * t->robot->task + i]));
            worst = gap <= worst ? worst : gap;
        }
        if (worst < least) {
            least = worst;
            best = m;
        }
    }
    return best;
}

/* What leads from a posture to the target: a twist or a change of coordinates, without units. Returns
 * its largest entry. */
static inline real_t cf_error(const cf_task *t, const real_t *q, real_t e[CF_MOST_ROWS])
{
    real_t at[CF_MOST_NUMBERS], R[9], largest = 0;
    t->robot->fk(t->params, q, at);
    if (cf_is_pose(t->robot)) {
        cf_times_transposed(t->x, 4, at, 4, R);
        cf_rotation_vector(R, e + 3);
        for (size_t i = 0; i < 3; ++i)
            e[i] = (t->x[4 * i + 3] - R[3 * i] * at[3] - R[3 * i + 1] * at[7] - R[3 * i + 2] * at[11]) /
                   t->size;
        if (t->rows == 7) e[6] = cf_gap(t, 16, at[16]);
    } else if (t->robot->task == 9) {
        cf_times_transposed(t->x, 3, at, 3, R);
        cf_rotation_vector(R, e);
    } else {
        const real_t *found = at + cf_mode(t, at) * t->robot->task;
        for (size_t i = 0; i < t->robot->task; ++i) e[i] = cf_gap(t, i, found[i]);
    }
    for (size_t i = 0; i < t->rows; ++i) {
        if (!(CF_LIBM(fabs)(e[i]) <= largest)) largest = CF_LIBM(fabs)(e[i]);
        if (!(e[i] - e[i] == 0)) return CF_INFINITE;
    }
    return largest;
}

/* The Jacobian of the error, rows x joints. Returns whether it is finite. */
static inline int cf_task_jacobian(const cf_task *t, const real_t *q, real_t *J)
{
    const size_t n = t->robot->joints, rows = t->rows;
    real_t every[CF_MOST_NUMBERS], at[CF_MOST_NUMBERS];
    size_t mode = 0;
    t->robot->jacobian(t->params, q, every);
    if (t->robot->modes > 1) {
        t->robot->fk(t->params, q, at);
        mode = cf_mode(t, at);
    }
    for (size_t i = 0; i < rows; ++i) {
        const size_t place = cf_is_pose(t->robot) ? i + 10 : i; /* in x, of the number besides a pose */
        const int length = cf_is_pose(t->robot) && i < 6 ? i < 3
                           : t->robot->task == 9          ? 0
                                                          : !((t->robot->angles >> place) & 1u);
        for (size_t j = 0; j < n; ++j) {
            const real_t entry = every[(mode * t->robot->jacobian_rows + i) * n + j];
            if (!(entry - entry == 0)) return 0;
            J[i * n + j] = length ? entry / t->size : entry;
        }
    }
    return 1;
}

/* The shortest d with the least |J d - e|, where the joint `kept` does not move (none if it is n). */
static inline void cf_least_squares(
    size_t rows, size_t n, const real_t *J, size_t kept, const real_t *e, real_t *d)
{
    real_t A[CF_MOST_JOINTS][CF_MOST_JOINTS], trace = 0;
    for (size_t j = 0; j < n; ++j) {
        d[j] = 0;
        for (size_t i = 0; i < rows; ++i) d[j] += J[i * n + j] * e[i];
        for (size_t k = 0; k <= j; ++k) {
            A[j][k] = 0;
            for (size_t i = 0; i < rows; ++i) A[j][k] += J[i * n + j] * J[i * n + k];
            if (j == kept || k == kept) A[j][k] = 0;
        }
        trace += A[j][j];
    }
    if (kept < n) d[kept] = 0;
    for (size_t j = 0; j < n; ++j) { /* Cholesky */
        A[j][j] += j == kept || !(trace > 0) ? CLOSEDFORM_C(1) : CF_DAMPING * trace;
        for (size_t k = 0; k <= j; ++k) {
            for (size_t i = 0; i < k; ++i) A[j][k] -= A[j][i] * A[k][i];
            A[j][k] = k < j ? A[j][k] / A[k][k]
                            : CF_LIBM(sqrt)(cf_max(A[j][j], CF_DAMPING * CF_DAMPING * trace));
        }
    }
    for (size_t j = 0; j < n; ++j) {
        for (size_t i = 0; i < j; ++i) d[j] -= A[j][i] * d[i];
        d[j] /= A[j][j];
    }
    for (size_t j = n; j-- > 0;) {
        for (size_t i = j + 1; i < n; ++i) d[j] -= A[i][j] * d[i];
        d[j] /= A[j][j];
    }
}

/* Newton's method with a joint kept; a step that does not help is not taken. Returns the error. */
static inline real_t cf_polish(const cf_task *t, size_t kept, int times, real_t *q)
{
    const size_t n = t->robot->joints;
    real_t e[CF_MOST_ROWS], J[CF_MOST_ROWS * CF_MOST_JOINTS], d[CF_MOST_JOINTS], better[CF_MOST_JOINTS];
    real_t error = cf_error(t, q, e);
    for (int k = 0; k < times && error < CF_INFINITE && cf_task_jacobian(t, q, J); ++k) {
        real_t turn = 0, next;
        cf_least_squares(t->rows, n, J, kept, e, d);
        for (size_t j = 0; j < n; ++j)
            if (cf_turns(t->robot, j)) turn = cf_max(turn, CF_LIBM(fabs)(d[j]));
        for (size_t j = 0; j < n; ++j) better[j] = q[j] + d[j] / cf_max(1, turn / CF_LONGEST);
        next = cf_error(t, better, e);
        if (!(next < error)) break;
        error = next;
        memcpy(q, better, n * sizeof *q);
    }
    return error;
}

/* The shortest joint rates with which a joint moves by 1 and the target stays. Returns their square,
 * or 0 if there are none. */
static inline real_t cf_tangent(const cf_task *t, const real_t *J, size_t joint, real_t *rates)
{
    const size_t n = t->robot->joints, rows = t->rows;
    real_t column[CF_MOST_ROWS] = { 0 }, square = 0, largest = 0, left = 0;
    for (size_t i = 0; i < rows; ++i) {
        column[i] = -J[i * n + joint];
        for (size_t j = 0; j < n; ++j) largest = cf_max(largest, CF_LIBM(fabs)(J[i * n + j]));
    }
    cf_least_squares(rows, n, J, joint, column, rates);
    rates[joint] = 1;
    for (size_t i = 0; i < rows; ++i) {
        real_t moved = 0;
        for (size_t j = 0; j < n; ++j) moved += J[i * n + j] * rates[j];
        left = cf_max(left, CF_LIBM(fabs)(moved));
    }
    for (size_t j = 0; j < n; ++j) square += rates[j] * rates[j];
    return left <= CF_FREE * cf_max(largest, CF_FREE) * CF_LIBM(sqrt)(square) ? square : 0;
}

/* The joint that is free: the first that is zero by convention, or else the one that moves most. */
static inline size_t cf_free_joint(
    const cf_task *t, const real_t *q, const real_t *J, int by_convention, int *conventional)
{
    const size_t n = t->robot->joints;
    real_t rates[CF_MOST_JOINTS], least = 1 / CF_SHARE;
    size_t found = n;
    *conventional = 0;
    for (size_t j = 0; j < n; ++j) {
        const real_t square = cf_tangent(t, J, j, rates);
        if (!(square > 0 && square < 1 / CF_SHARE)) continue;
        if (by_convention && CF_LIBM(fabs)(q[j]) <= CF_REACHED) {
            *conventional = 1;
            return j;
        }
        if (square < least * (1 - CF_FREE)) {
            least = square;
            found = j;
        }
    }
    return found;
}

/* Whether the determinant of an assembly mode is zero but for rounding. */
static inline int cf_nearly_singular(const cf_task *t, const real_t *q)
{
    real_t found[CF_MOST_ROWS], least = CF_NEARLY;
    if (t->robot->determinant == NULL) return 0;
    for (size_t k = 0; k < t->robot->lengths; ++k) least *= t->size;
    t->robot->determinant(t->params, q, found);
    for (size_t mode = 0; mode < t->robot->modes; ++mode)
        if (CF_LIBM(fabs)(found[mode]) <= least) return 1;
    return 0;
}

/* The derivatives of a function of the joints, which may be an angle. */
static inline void cf_gradient(size_t n, void (*value)(const void *params, const real_t *q, real_t *found),
    const void *params, const real_t *q, real_t *row)
{
    real_t at[CF_MOST_JOINTS], above, below, central[2];
    memcpy(at, q, n * sizeof *q);
    for (size_t j = 0; j < n; ++j) {
        for (int k = 0; k < 2; ++k) {
            const real_t step = (real_t)(k + 1) * CF_DIFFERENCE;
            at[j] = q[j] + step;
            value(params, at, &above);
            at[j] = q[j] - step;
            value(params, at, &below);
            central[k] = cf_less_turns(above - below) / (2 * step);
        }
        row[j] = (4 * central[0] - central[1]) / 3;
        at[j] = q[j];
    }
}

/* The same task, but the number besides the pose counts only if a posture of the inverse has it, and
 * postures to both sides of that one: where it is undefined it may have any value. */
static inline cf_task cf_keeping(const cf_task *t, const real_t *q)
{
    cf_task own = *t;
    real_t at[CF_MOST_NUMBERS], beside[CF_MOST_JOINTS];
    if (t->robot->task != 17) return own;
    for (int side = -1; side <= 1; ++side) {
        for (size_t j = 0; j < t->robot->joints; ++j)
            beside[j] = q[j] + (real_t)side * CF_BESIDE * CF_LIBM(cos)((real_t)(j + 1));
        t->robot->fk(t->params, beside, at);
        const real_t gap = CF_LIBM(fabs)(cf_gap(t, 16, at[16]));
        if (!(gap <= (side == 0 ? CF_STRAIGHT : CF_BOWED))) own.rows = 6;
    }
    return own;
}

/* Move a singular posture along its self-motion until the free joint has the value of the seed, or
 * only if that is a straight line. Returns whether another side of the curve may be nearer. */
static inline int cf_release(const cf_task *task, const real_t *seed, int only_straight, real_t *q)
{
    const cf_task own = cf_keeping(task, q), *const t = &own;
    const size_t n = t->robot->joints;
    real_t e[CF_MOST_ROWS], J[CF_MOST_ROWS * CF_MOST_JOINTS], rates[CF_MOST_JOINTS], at[CF_MOST_JOINTS];
    real_t going[CF_MOST_JOINTS], moved, error;
    int conventional, straight, reached = 1;
    if (!cf_task_jacobian(t, q, J)) return 0;
    const size_t joint = cf_free_joint(t, q, J, 1, &conventional);
    if (joint == n) return 0;
    moved = seed[joint] - q[joint];
    if (cf_turns(t->robot, joint)) moved = cf_less_turns(moved);
    cf_tangent(t, J, joint, rates);
    for (size_t j = 0; j < n; ++j) at[j] = q[j] + moved * rates[j];
    straight = cf_error(t, at, e) <= CF_STRAIGHT;
    if (only_straight) straight = cf_error(t, at, e) <= CF_BOWED;
    if (!straight && only_straight) return 0;
    if (!straight) {
        memcpy(at, q, n * sizeof *q);
        for (int k = 0; k < CF_STEPS && reached; ++k) {
            reached = cf_task_jacobian(t, at, J) && cf_tangent(t, J, joint, rates) > 0;
            for (size_t j = 0; j < n && reached; ++j) {
                const real_t step = moved / CF_STEPS * rates[j];
                reached = CF_LIBM(fabs)(step) <= CF_LONGEST;
                going[j] = at[j] + step;
            }
            reached = reached && cf_polish(t, joint, 3, going) <= CF_STRAIGHT;
            if (reached) memcpy(at, going, n * sizeof *q);
        }
    }
    error = cf_polish(t, joint, 3, at);
    if (!(error <= cf_max(CF_REACHED, 2 * cf_error(t, q, e)))) return !straight;
    if (reached) at[joint] = seed[joint];
    if (t->robot->held < n) at[t->robot->held] = q[t->robot->held];
    memcpy(q, at, n * sizeof *q);
    return !straight && !(conventional && reached);
}

/* A singular posture near the seed, and its branch; -1 if there is none. */
static inline int cf_near(const cf_task *t, const real_t *seed, real_t *q)
{
    const size_t n = t->robot->joints;
    real_t J[CF_MOST_ROWS * CF_MOST_JOINTS], kept[CF_MOST_JOINTS], x[CF_MOST_NUMBERS];
    real_t every[CF_MOST_BRANCHES * CF_MOST_JOINTS], least = CF_INFINITE;
    uint8_t statuses[CF_MOST_BRANCHES];
    int conventional, best = -1;
    if (t->robot->modes > 1) return -1;
    for (size_t j = 0; j < n; ++j) q[j] = cf_turns(t->robot, j) ? cf_less_turns(seed[j]) : seed[j];
    memcpy(kept, q, n * sizeof *q);
    if (!(cf_polish(t, n, 12, q) <= CF_STRAIGHT) || !cf_task_jacobian(t, q, J)) return -1;
    const size_t joint = cf_free_joint(t, q, J, 0, &conventional);
    if (joint == n) return -1;
    const real_t value = kept[joint];
    memcpy(kept, q, n * sizeof *q);
    kept[joint] = value;
    if (cf_polish(t, joint, 5, kept) <= CF_REACHED) memcpy(q, kept, n * sizeof *q);
    if (!(cf_polish(t, joint, 3, q) <= CF_REACHED)) return -1;
    if (t->robot->held < n) q[t->robot->held] = t->x[16];
    for (size_t j = 0; j < n; ++j)
        kept[j] = q[j] + CLOSEDFORM_C(1e-4) * CF_LIBM(cos)((real_t)(j + 1)); /* regular, close by */
    t->robot->fk(t->params, kept, x);
    t->robot->ik(t->params, x, every, statuses);
    for (size_t b = 0; b < t->robot->branches; ++b) {
        real_t gap = 0;
        if (statuses[b] == CLOSEDFORM_UNREACHABLE || statuses[b] == CLOSEDFORM_INVALID) continue;
        for (size_t j = 0; j < n; ++j) {
            const real_t off = every[b * n + j] - kept[j];
            gap += CF_LIBM(fabs)(cf_turns(t->robot, j) ? cf_less_turns(off) : off);
        }
        if (gap < least) {
            least = gap;
            best = (int)b;
        }
    }
    return best;
}

static inline real_t cf_squares(const cf_robot *robot, const real_t *q, const real_t *seed)
{
    real_t sum = 0;
    for (size_t j = 0; j < robot->joints; ++j) {
        const real_t off = q[j] - seed[j], gap = cf_turns(robot, j) ? cf_less_turns(off) : off;
        sum += CF_LIBM(fabs)(gap);
    }
    return sum;
}

/* The turn of a joint that is nearest to the seed within its limits; returns whether there is one. */
static inline int cf_turn_within(int revolute, real_t seed, real_t lower, real_t upper, real_t *q)
{
    const real_t bound = cf_max(CF_LIBM(fabs)(lower), CF_LIBM(fabs)(upper));
    const real_t slack = CF_SLACK * (bound < CF_INFINITE ? cf_max(bound, CLOSEDFORM_C(1e-3)) : 1);
    if (!revolute) return lower - slack <= *q && *q <= upper + slack;
    const real_t first = CF_LIBM(ceil)((lower - slack - *q) / CF_TURN);
    const real_t last = CF_LIBM(floor)((upper + slack - *q) / CF_TURN);
    real_t turns = CF_LIBM(ceil)((seed - *q) / CF_TURN - (CLOSEDFORM_C(0.5) + CLOSEDFORM_C(1e-9)));
    if (first > last) return 0;
    if (turns < first) turns = first;
    if (turns > last) turns = last;
    if (turns != 0) *q += CF_TURN * turns;
    return 1;
}

/* Turn the joints of all branches to where they are nearest to the seed. Returns the nearest branch
 * within the limits, or -1. */
static inline int cf_best(const cf_robot *robot, const real_t *q_seed, const real_t *limits,
    const real_t *weights, const uint8_t *statuses, real_t *every, uint32_t *outside)
{
    const size_t n = robot->joints;
    real_t least = CF_INFINITE;
    int best = -1;
    for (size_t b = 0; b < robot->branches; ++b) {
        uint32_t beyond = 0;
        real_t distance = 0;
        if (outside != NULL) outside[b] = 0;
        if (statuses[b] == CLOSEDFORM_UNREACHABLE || statuses[b] == CLOSEDFORM_INVALID) continue;
        for (size_t j = 0; j < n; ++j) {
            real_t *const value = every + b * n + j;
            const real_t lower = limits != NULL ? limits[j] : -CF_INFINITE;
            const real_t upper = limits != NULL ? limits[n + j] : CF_INFINITE;
            if (!cf_turn_within(cf_turns(robot, j), q_seed[j], lower, upper, value))
                beyond |= (uint32_t)1 << j;
            const real_t gap = *value - q_seed[j];
            distance += (weights != NULL ? weights[j] : 1) * gap * gap;
        }
        if (outside != NULL) outside[b] = beyond;
        distance = CF_LIBM(sqrt)(distance);
        /* A branch that is as near as an earlier one does not replace it. */
        if (beyond == 0 && (best < 0 || distance < least * (1 - CF_SLACK) - CF_SLACK * CF_SLACK)) {
            least = distance;
            best = (int)b;
        }
    }
    return best;
}

/* As described in the header of a robot. */
static inline int cf_nearest_posture(const cf_robot *robot, const void *params, const real_t *x,
    const real_t *q_seed, const real_t *limits, const real_t *weights, real_t *q, uint8_t *status,
    uint32_t *outside)
{
    const size_t n = robot->joints;
    real_t every[CF_MOST_BRANCHES * CF_MOST_JOINTS], wanted[CF_MOST_JOINTS], near[CF_MOST_JOINTS];
    uint8_t statuses[CF_MOST_BRANCHES];
    int best = -1, invalid = 1, other = 0, finite = 1;
    cf_task task = { robot, params, x, 0, robot->rows };
    robot->ik(params, x, every, statuses);
    for (size_t j = 0; j < n; ++j) {
        finite = finite && q_seed[j] - q_seed[j] == 0;
        wanted[j] = q_seed[j];
        if (limits != NULL && finite)
            wanted[j] = cf_min(cf_max(wanted[j], limits[j]), limits[n + j]);
    }
    for (size_t k = 0; k < robot->fields; ++k)
        task.size += CF_LIBM(fabs)(((const real_t *)params)[k]);
    if (!(task.size > 0)) task.size = 1;
    for (size_t b = 0; b < robot->branches; ++b) {
        invalid = invalid && statuses[b] == CLOSEDFORM_INVALID;
        if (!finite) statuses[b] = CLOSEDFORM_INVALID;
        if (statuses[b] == CLOSEDFORM_SINGULAR) other |= cf_release(&task, wanted, 0, every + b * n);
    }
    if (other) {
        const int b = cf_near(&task, wanted, near);
        if (b >= 0 && statuses[b] == CLOSEDFORM_SINGULAR &&
            cf_squares(robot, near, wanted) < cf_squares(robot, every + (size_t)b * n, wanted))
            memcpy(every + (size_t)b * n, near, n * sizeof *q);
    }
    for (size_t b = 0; b < robot->branches; ++b) /* Rounding of the target may hide that it is singular. */
        if (statuses[b] == CLOSEDFORM_OK && cf_nearly_singular(&task, every + b * n))
            cf_release(&task, wanted, 1, every + b * n);
    best = cf_best(robot, q_seed, limits, weights, statuses, every, outside);
    for (size_t j = 0; j < n; ++j) q[j] = best < 0 ? CLOSEDFORM_NAN : every[(size_t)best * n + j];
    *status = best >= 0 ? statuses[best]
              : invalid || !finite ? (uint8_t)CLOSEDFORM_INVALID
                                   : (uint8_t)CLOSEDFORM_UNREACHABLE;
    return best;
}

#endif
