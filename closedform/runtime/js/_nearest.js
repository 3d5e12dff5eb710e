/**
 * For every mechanism: the posture nearest to a seed, of all branches of the inverse and all turns.
 *
 * @module
 */

const [OK, UNREACHABLE, SINGULAR, INVALID] = [0, 1, 2, 3];
const TURN = 2 * Math.PI;
const REACHED = 1e-12; // the error of an answer, relative to the size
const STRAIGHT = 1e-9; // ... of a posture on the way to it
const BOWED = 1e-3; // ... on a line whose direction rounding spoils
const FREE = 1e-6; // the target does not move
const SHARE = 1e-3;
const DAMPING = 1e-13;
const SLACK = 1e-9; // how far a joint may pass a limit, in rad
const DIFFERENCE = 1e-3; // the step of differences of fourth order
const BESIDE = 1e-10; // a number that changes much over so little is undefined
const NEARLY = 1e-12; // a determinant that only rounding keeps from zero
const LONGEST = 0.5; // rad; a step along a self-motion
const STEPS = 24;
const ANGLES = ["yaw", "pitch", "roll", "psi", "phi", "theta"];

/**
 * The posture that was found: `q` is NaN, `branch` -1 and `distance` infinite if there is none.
 * `outside[branch][joint]` says which joint of which branch has no turn within its limits.
 *
 * @typedef {object} Nearest
 * @property {number[]} q
 * @property {number} status
 * @property {number} branch
 * @property {number} distance
 * @property {boolean[][]} outside
 */

/**
 * @typedef {object} Options
 * @property {readonly [ArrayLike<number>, ArrayLike<number>]} [limits] the lower and the upper limits
 * @property {ArrayLike<number>} [weights] of the squares of the joints in the distance, 1 by default
 * @property {number} [given] what `robot.ik` takes besides the target, by default its value at the seed
 */

/**
 * Of all branches, and all turns of each joint within the limits, the posture nearest to a seed.
 *
 * Of equal distances the first branch and the lower turn win. Where a joint is free (SINGULAR), it
 * keeps the value of the seed, as far as its limits allow, and the others follow.
 *
 * @param {any} robot a module of this package, such as `ur_arm`
 * @param {ArrayLike<number>} x the target, as of `robot.ik`
 * @param {ArrayLike<number>} seed the joints to be near to
 * @param {Options} [options]
 * @param {Readonly<Record<string, number | undefined>>} [parameters] one that is missing has its default
 * @returns {Nearest}
 */
export function nearest(robot, x, seed, options = {}, parameters = {}) {
    const n = robot.JOINTS.length;
    const { limits, weights } = options;
    const lower = checked(limits?.[0], n, "limits[0]", -Infinity);
    const upper = checked(limits?.[1], n, "limits[1]", Infinity);
    const weight = checked(weights, n, "weights", 1);
    const q0 = checked(seed, n, "seed", 0);
    const given = givenBeside(robot, options.given, q0, parameters);
    const solutions = inverse(robot, x, given, parameters);
    const task = new Task(robot, Array.from(x), parameters, given);
    /** @type {number[][]} */
    const every = solutions.q.map((/** @type {ArrayLike<number>} */ q) => Array.from(q));
    const finite = q0.every(Number.isFinite);
    const wanted = q0.map((v, j) => Math.min(Math.max(v, lower[j]), upper[j]));
    if (finite && solutions.status.includes(SINGULAR)) release(task, wanted, every, solutions.status);
    const bounds = { lower, upper, weight };
    const statuses = solutions.status.map((/** @type {number} */ status) => (finite ? status : INVALID));
    statuses.forEach((/** @type {number} */ status, /** @type {number} */ b) => {
        // Rounding may hide that the target is singular.
        if (status === OK && nearlySingular(task, every[b])) every[b] = moveTo(task, wanted, every[b], true).q;
    });
    const found = best(task, every, statuses, q0, bounds);
    const invalid = !finite || solutions.status.every((/** @type {number} */ s) => s === INVALID);
    if (found.branch < 0 && invalid) found.status = INVALID;
    return found;
}

/**
 * What the inverse takes besides the target: a number, or undefined.
 *
 * @param {any} robot
 * @param {number | undefined} given
 * @param {readonly number[]} seed
 * @param {Readonly<Record<string, number | undefined>>} parameters
 * @returns {number | undefined}
 */
function givenBeside(robot, given, seed, parameters) {
    if (robot.GIVEN !== undefined) return given ?? givenAt(robot, seed, parameters);
    if (given !== undefined) throw new TypeError("nearest: the inverse takes the target only; leave out given");
    return undefined;
}

/**
 * All branches.
 *
 * @param {any} robot
 * @param {ArrayLike<number>} x
 * @param {number | undefined} given
 * @param {Readonly<Record<string, number | undefined>>} parameters
 */
function inverse(robot, x, given, parameters) {
    return robot.ik(x, ...(given === undefined ? [] : [given]), parameters);
}

/**
 * @param {any} robot
 * @param {readonly number[]} q
 * @param {Readonly<Record<string, number | undefined>>} parameters
 * @returns {number}
 */
function givenAt(robot, q, parameters) {
    const joint = robot.JOINTS.indexOf(robot.GIVEN);
    return joint < 0 ? robot[robot.GIVEN](Array.from(q), parameters) : q[joint];
}

/**
 * Turn the joints of all branches to where they are nearest to the seed; return the nearest branch.
 *
 * @param {Task} task
 * @param {number[][]} every
 * @param {readonly number[]} statuses
 * @param {readonly number[]} seed
 * @param {{ lower: number[], upper: number[], weight: number[] }} bounds
 * @returns {Nearest}
 */
function best(task, every, statuses, seed, { lower, upper, weight }) {
    const n = seed.length;
    /** @type {Nearest} */
    const found = { q: new Array(n).fill(NaN), status: UNREACHABLE, branch: -1, distance: Infinity, outside: [] };
    for (let b = 0; b < every.length; ++b) {
        const beyond = new Array(n).fill(false);
        found.outside.push(beyond);
        if (statuses[b] !== OK && statuses[b] !== SINGULAR) continue;
        let squares = 0;
        for (let j = 0; j < n; ++j) {
            const value = turnWithin(task.revolute[j], every[b][j], seed[j], lower[j], upper[j]);
            beyond[j] = value === undefined;
            if (value !== undefined) every[b][j] = value;
            squares += weight[j] * (every[b][j] - seed[j]) ** 2;
        }
        const distance = Math.sqrt(squares);
        if (beyond.includes(true) || !(distance < found.distance * (1 - 1e-9) - 1e-18 || found.branch < 0)) continue;
        Object.assign(found, { q: every[b].slice(), status: statuses[b], branch: b, distance });
    }
    return found;
}

/**
 * Whether the determinant of an assembly mode is zero but for rounding.
 *
 * @param {Task} task
 * @param {readonly number[]} q
 */
function nearlySingular(task, q) {
    const { robot } = task;
    if (robot.determinant === undefined) return false;
    const named = task.angles.filter((angle) => !angle).length;
    const lengths = { 16: 3, 9: 0 }[task.x.length] ?? named;
    const slides = task.revolute.filter((revolute) => !revolute).length - Number(task.slides);
    /** @type {number[]} */
    const found = [robot.determinant(Array.from(q), task.parameters)].flat();
    return found.some((value) => Math.abs(value) <= NEARLY * task.size ** (lengths - slides));
}

/**
 * @param {ArrayLike<number> | undefined} given
 * @param {number} n
 * @param {string} name
 * @param {number} missing
 * @returns {number[]}
 */
function checked(given, n, name, missing) {
    if (given === undefined) return new Array(n).fill(missing);
    if (given.length !== n) throw new RangeError(`nearest: ${name} has length ${given.length}, expected ${n}`);
    return Array.from(given, (value) => {
        if (typeof value !== "number") throw new TypeError(`nearest: ${name} must hold numbers`);
        return value;
    });
}

/** @param {number} angle */
function lessTurns(angle) {
    return angle - TURN * Math.round(angle / TURN);
}

/**
 * The turn of a joint that is nearest to the seed within its limits, or undefined.
 *
 * @param {boolean} revolute
 * @param {number} q
 * @param {number} seed
 * @param {number} lower
 * @param {number} upper
 */
function turnWithin(revolute, q, seed, lower, upper) {
    const bound = Math.max(Math.abs(lower), Math.abs(upper));
    const slack = SLACK * (Number.isFinite(bound) ? Math.max(bound, 1e-3) : 1);
    if (!revolute) return lower - slack <= q && q <= upper + slack ? q : undefined;
    const first = Math.ceil((lower - slack - q) / TURN);
    const last = Math.floor((upper + slack - q) / TURN);
    if (first > last) return undefined;
    const turns = Math.min(Math.max(Math.ceil((seed - q) / TURN - (0.5 + 1e-9)), first), last);
    return turns === 0 ? q : q + TURN * turns;
}

/** A target, the error of a posture and the Jacobian of the error, without units. */
class Task {
    /**
     * @param {any} robot
     * @param {number[]} x
     * @param {Readonly<Record<string, number | undefined>>} parameters
     * @param {number | undefined} given the number besides the target, if there is one
     */
    constructor(robot, x, parameters, given) {
        this.robot = robot;
        this.x = x;
        this.parameters = parameters;
        this.given = given;
        this.n = robot.JOINTS.length;
        /** @type {boolean[]} */
        this.revolute = robot.JOINTS.map((/** @type {string} */ name) => robot.SKELETON.joints[name].kind === "revolute");
        this.held = robot.JOINTS.indexOf(robot.GIVEN);
        this.slides = this.revolute[this.held] === false;
        this.angles = robot.TASK.map((/** @type {string} */ name) => ANGLES.includes(name));
        const lengths = Object.values({ ...robot.DEFAULTS, ...parameters });
        this.size = lengths.reduce((sum, length) => sum + Math.abs(length ?? 0), 0) || 1;
    }

    /**
     * The same task, but the number besides the target counts only if a posture of the inverse has it,
     * and postures to both sides of that one: where it is undefined it may have any value.
     *
     * @param {readonly number[]} q
     */
    keeping(q) {
        const kept = [-1, 0, 1].every((side) => {
            const [gap] = this.beside(q.map((v, j) => v + side * BESIDE * Math.cos(j + 1)));
            return Math.abs(gap) <= (side === 0 ? STRAIGHT : BOWED);
        });
        if (this.given === undefined || kept) return this;
        return new Task(this.robot, this.x, this.parameters, undefined);
    }

    /**
     * The error of the number besides the target at a posture; empty if there is no such number.
     *
     * @param {readonly number[]} q
     */
    beside(q) {
        if (this.given === undefined) return [];
        const gap = this.given - givenAt(this.robot, q, this.parameters);
        return [this.slides ? gap / this.size : lessTurns(gap)];
    }

    /**
     * The derivatives of the number besides the target with respect to the joints.
     *
     * @param {readonly number[]} q
     */
    gradient(q) {
        return q.map((_, j) => {
            const [near, far] = [DIFFERENCE, 2 * DIFFERENCE].map((step) => {
                const [above, below] = [step, -step].map((by) =>
                    givenAt(this.robot, q.map((v, i) => (i === j ? v + by : v)), this.parameters));
                return this.slides ? (above - below) / (2 * step * this.size) : lessTurns(above - below) / (2 * step);
            });
            return (4 * near - far) / 3;
        });
    }

    /** @param {readonly number[]} q */
    modes(q) {
        const at = this.robot.fk(Array.from(q), this.parameters);
        return Array.isArray(at.p) ? at.p : [at];
    }

    /** @param {readonly number[]} at */
    gaps(at) {
        return this.x.map((value, i) => (this.angles[i] ? lessTurns(value - at[i]) : (value - at[i]) / this.size));
    }

    /** @param {readonly number[]} q */
    error(q) {
        const modes = this.modes(q);
        if (this.x.length !== 16 && this.x.length !== 9) return this.gaps(modes[this.mode(modes)]);
        const row = this.x.length === 16 ? 4 : 3;
        const at = modes[0];
        const R = [0, 1, 2].map((i) => [0, 1, 2].map((j) => this.x[row * i] * at[row * j] +
            this.x[row * i + 1] * at[row * j + 1] + this.x[row * i + 2] * at[row * j + 2]));
        const omega = rotationVector(R);
        if (row === 3) return omega;
        const v = R.map((r, i) => (this.x[4 * i + 3] - r[0] * at[3] - r[1] * at[7] - r[2] * at[11]) / this.size);
        return [...v, ...omega, ...this.beside(q)];
    }

    /** @param {readonly (readonly number[])[]} modes */
    mode(modes) {
        if (modes.length === 1) return 0;
        const worst = modes.map((at) => Math.max(...this.gaps(at).map(Math.abs))).map((v) => (v >= 0 ? v : Infinity));
        return worst.indexOf(Math.min(...worst));
    }

    /**
     * The largest entry of the error; infinite where it is not a number.
     *
     * @param {readonly number[]} q
     */
    largest(q) {
        const error = Math.max(...this.error(q).map(Math.abs));
        return error >= 0 ? error : Infinity;
    }

    /**
     * The rows of the Jacobian of the error, or undefined if it is not finite.
     *
     * @param {readonly number[]} q
     * @returns {number[][] | undefined}
     */
    jacobian(q) {
        const twist = this.x.length === 16 || this.x.length === 9;
        let J = this.robot[twist ? "jacobian_space" : "jacobian"](Array.from(q), this.parameters);
        if (Array.isArray(J[0])) J = J[this.mode(this.modes(q))];
        const count = this.x.length === 16 ? 6 : this.x.length === 9 ? 3 : this.x.length;
        const rows = [];
        for (let i = 0; i < count; ++i) {
            const length = twist ? count === 6 && i < 3 : !this.angles[i];
            const row = Array.from(J.slice(i * this.n, (i + 1) * this.n), (v) => (length ? v / this.size : v));
            if (!row.every(Number.isFinite)) return undefined;
            rows.push(row);
        }
        if (this.given !== undefined) rows.push(this.gradient(q));
        return rows;
    }
}

/** @param {readonly (readonly number[])[]} R */
function rotationVector(R) {
    const v = [(R[2][1] - R[1][2]) / 2, (R[0][2] - R[2][0]) / 2, (R[1][0] - R[0][1]) / 2];
    const sine = Math.hypot(...v);
    const angle = Math.atan2(sine, (R[0][0] + R[1][1] + R[2][2] - 1) / 2);
    if (sine > 1e-8) return v.map((value) => (value * angle) / sine);
    return angle > 1 ? [Math.PI, 0, 0] : v;
}

/**
 * The shortest d with the least |J d - e|, where the joint `kept` does not move (none if it is n).
 *
 * @param {readonly (readonly number[])[]} J
 * @param {number} n
 * @param {number} kept
 * @param {readonly number[]} e
 */
function leastSquares(J, n, kept, e) {
    const d = new Array(n).fill(0);
    const A = d.map(() => new Array(n).fill(0));
    let trace = 0;
    for (let j = 0; j < n; ++j) {
        if (j === kept) continue;
        for (let i = 0; i < J.length; ++i) d[j] += J[i][j] * e[i];
        for (let k = 0; k <= j; ++k) {
            if (k === kept) continue;
            for (let i = 0; i < J.length; ++i) A[j][k] += J[i][j] * J[i][k];
        }
        trace += A[j][j];
    }
    for (let j = 0; j < n; ++j) { // Cholesky
        A[j][j] += j === kept || !(trace > 0) ? 1 : DAMPING * trace;
        for (let k = 0; k <= j; ++k) {
            for (let i = 0; i < k; ++i) A[j][k] -= A[j][i] * A[k][i];
            A[j][k] = k < j ? A[j][k] / A[k][k] : Math.sqrt(Math.max(A[j][j], DAMPING * DAMPING * trace));
        }
    }
    for (let j = 0; j < n; ++j) {
        for (let i = 0; i < j; ++i) d[j] -= A[j][i] * d[i];
        d[j] /= A[j][j];
    }
    for (let j = n - 1; j >= 0; --j) {
        for (let i = j + 1; i < n; ++i) d[j] -= A[i][j] * d[i];
        d[j] /= A[j][j];
    }
    return d;
}

/**
 * Newton's method with a joint kept; a step that does not help is not taken.
 *
 * @param {Task} task
 * @param {number} kept
 * @param {number} times
 * @param {number[]} start
 */
function polished(task, kept, times, start) {
    let q = start;
    let error = task.largest(q);
    for (let k = 0; k < times && error < Infinity; ++k) {
        const J = task.jacobian(q);
        if (J === undefined) break;
        const d = leastSquares(J, task.n, kept, task.error(q));
        const turn = Math.max(0, ...d.map((v, j) => (task.revolute[j] ? Math.abs(v) : 0)));
        const better = q.map((v, j) => v + d[j] / Math.max(1, turn / LONGEST));
        const next = task.largest(better);
        if (!(next < error)) break;
        [q, error] = [better, next];
    }
    return { q, error };
}

/**
 * The shortest joint rates with which a joint moves by 1 and the target stays; undefined if none do.
 *
 * @param {readonly (readonly number[])[]} J
 * @param {number} n
 * @param {number} joint
 */
function tangent(J, n, joint) {
    const rates = leastSquares(J, n, joint, J.map((row) => -row[joint]));
    rates[joint] = 1;
    const square = rates.reduce((sum, v) => sum + v * v, 0);
    const largest = Math.max(...J.map((row) => Math.max(...row.map(Math.abs))));
    const left = Math.max(...J.map((row) => Math.abs(row.reduce((sum, v, j) => sum + v * rates[j], 0))));
    return left <= FREE * Math.max(largest, FREE) * Math.sqrt(square) ? { rates, square } : undefined;
}

/**
 * The joint that is free: the first that is zero by convention, or else the one that moves most.
 *
 * @param {readonly number[]} q
 * @param {readonly (readonly number[])[]} J
 * @param {boolean} byConvention
 */
function freeJoint(q, J, byConvention) {
    let least = 1 / SHARE;
    let joint = -1;
    for (let j = 0; j < q.length; ++j) {
        const found = tangent(J, q.length, j);
        if (found === undefined || !(found.square < 1 / SHARE)) continue;
        if (byConvention && Math.abs(q[j]) <= REACHED) return { joint: j, conventional: true };
        if (found.square < least * (1 - FREE)) [least, joint] = [found.square, j];
    }
    return { joint, conventional: false };
}

/**
 * Move singular branches to where the free joint has the value of the seed.
 *
 * @param {Task} task
 * @param {readonly number[]} seed
 * @param {number[][]} every
 * @param {readonly number[]} statuses
 */
function release(task, seed, every, statuses) {
    let other = false;
    for (let b = 0; b < every.length; ++b) {
        if (statuses[b] !== SINGULAR) continue;
        const moved = moveTo(task, seed, every[b], false);
        every[b] = moved.q;
        other ||= moved.doubtful;
    }
    const near = other ? nearSeed(task, seed) : undefined;
    if (near === undefined || statuses[near.branch] !== SINGULAR) return;
    if (apart(task, near.q, seed) < apart(task, every[near.branch], seed)) every[near.branch] = near.q;
}

/**
 * Move one branch as above. Also returns whether another side of the curve may be nearer.
 *
 * @param {Task} whole
 * @param {readonly number[]} seed
 * @param {number[]} q
 * @param {boolean} onlyStraight
 */
function moveTo(whole, seed, q, onlyStraight) {
    const task = whole.keeping(q);
    const J = task.jacobian(q);
    const { joint, conventional } = J === undefined ? { joint: -1, conventional: false } : freeJoint(q, J, true);
    const first = J === undefined || joint < 0 ? undefined : tangent(J, task.n, joint);
    if (first === undefined) return { q, doubtful: false };
    const gap = seed[joint] - q[joint];
    const moved = task.revolute[joint] ? lessTurns(gap) : gap;
    let at = q.map((v, j) => v + moved * first.rates[j]);
    const straight = task.largest(at) <= (onlyStraight ? BOWED : STRAIGHT);
    let reached = true;
    if (!straight && onlyStraight) return { q, doubtful: false };
    if (!straight) {
        at = q;
        for (let k = 0; k < STEPS && reached; ++k) {
            const now = task.jacobian(at);
            const way = now === undefined ? undefined : tangent(now, task.n, joint);
            const step = way?.rates.map((v) => (v * moved) / STEPS);
            reached = step !== undefined && step.every((v) => Math.abs(v) <= LONGEST);
            if (step === undefined || !reached) break;
            const next = polished(task, joint, 3, at.map((v, j) => v + step[j]));
            reached = next.error <= STRAIGHT;
            if (reached) at = next.q;
        }
    }
    const end = polished(task, joint, 3, at);
    if (!(end.error <= Math.max(REACHED, 2 * task.largest(q)))) return { q, doubtful: !straight };
    const exact = end.q.map((v, j) => (j === task.held ? q[j] : reached && j === joint ? seed[j] : v));
    return { q: exact, doubtful: !straight && !(conventional && reached) };
}

/**
 * A singular posture near the seed and its branch, which is that of a regular one close by.
 *
 * @param {Task} task
 * @param {readonly number[]} seed
 */
function nearSeed(task, seed) {
    if (task.robot.ASSEMBLY_MODES.length > 0) return undefined;
    const start = seed.map((v, j) => (task.revolute[j] ? lessTurns(v) : v));
    const on = polished(task, task.n, 12, start);
    const J = on.error <= STRAIGHT ? task.jacobian(on.q) : undefined;
    if (J === undefined) return undefined;
    const { joint } = freeJoint(on.q, J, false);
    if (joint < 0) return undefined;
    const kept = polished(task, joint, 5, on.q.map((v, j) => (j === joint ? start[j] : v)));
    const { q, error } = polished(task, joint, 3, kept.error <= REACHED ? kept.q : on.q);
    if (!(error <= REACHED)) return undefined;
    if (task.held >= 0 && task.given !== undefined) q[task.held] = task.given;
    const close = q.map((v, j) => v + 1e-4 * Math.cos(j + 1));
    const given = task.given === undefined ? undefined : givenAt(task.robot, close, task.parameters);
    const solutions = inverse(task.robot, task.robot.fk(close, task.parameters), given, task.parameters);
    const gaps = solutions.q.map((/** @type {number[]} */ other) => apart(task, other, close));
    const known = gaps.map((/** @type {number} */ gap) => (gap >= 0 ? gap : Infinity));
    return { q, branch: known.indexOf(Math.min(...known)) };
}

/**
 * The distance between two postures; whole turns do not count.
 *
 * @param {Task} task
 * @param {readonly number[]} a
 * @param {readonly number[]} b
 */
function apart(task, a, b) {
    return a.reduce((sum, v, j) => sum + Math.abs(task.revolute[j] ? lessTurns(v - b[j]) : v - b[j]), 0);
}
