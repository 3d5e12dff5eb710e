/** What the explorer asks of a generated module, for one set of dimensions. */

import { onSphere } from "./sphere.js";

export const OK = 0;
export const UNREACHABLE = 1;
export const SINGULAR = 2;
export const INVALID = 3;

/** Whether a branch of this status has a posture. */
export const reaches = (status) => status === OK || status === SINGULAR;

const TRIALS = 240;
const STEP = 1e-6;

/** A number between 0 and 1, the same sequence on every visit. */
function random(seed) {
    let state = seed >>> 0;
    return () => {
        state = (state * 1664525 + 1013904223) >>> 0;
        return state / 2 ** 32;
    };
}

/** The distance of two points. */
export const distance = (a, b) => Math.hypot(...a.map((v, k) => v - b[k]));

export const wrapped = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));

export class Mechanism {
    /**
     * @param {any} robot a generated module
     * @param {Function} nearest of the generated package
     * @param {any} info what the page says of the mechanism
     */
    constructor(robot, nearest, info) {
        this.robot = robot;
        this.nearest = nearest;
        this.info = info;
        this.parameters = { ...robot.DEFAULTS };
        /** What the inverse takes besides the target, if it takes anything. */
        this.given = undefined;
        this.joints = robot.JOINTS;
        this.branches = robot.BRANCHES;
        this.modes = robot.ASSEMBLY_MODES.length || 1;
        this.skeleton = robot.SKELETON;
        this.names = robot.SKELETON.points;
        this.hand = this.names.indexOf(robot.SKELETON.hand);
        this.slides = this.joints.map((n) => robot.SKELETON.joints[n]?.kind === "prismatic");
        const position = positionIn(robot.TASK);
        this.places = position.map(([place]) => place);
        this.axes = position.map(([, axis]) => axis);
        this.others = others(robot.TASK.map((_, k) => this.writtenCoordinate(k)), this.places);
        this.flat = this.isFlat();
        this.scales = this.typicalFactors();
    }

    get size() {
        const lengths = Object.values(this.parameters).map(Math.abs);
        return lengths.reduce((a, b) => a + b, 0) || 1;
    }

    /** The unit of lengths, or nothing if the dimensions may have any. */
    get unit() {
        return this.info.unit ?? "";
    }

    /** A joint as people write it: a plain label, and perhaps a formula. */
    written(k) {
        const name = this.joints[k];
        return this.info.joints?.[name] ?? { label: name };
    }

    /** A joint in plain text. */
    label(k) {
        return this.written(k).label;
    }

    /** A coordinate of the task as people write it. */
    writtenCoordinate(k) {
        return this.info.task?.[k] ?? { label: this.robot.TASK[k] };
    }

    /** A coordinate of the task in plain text. */
    coordinate(k) {
        return this.writtenCoordinate(k).label;
    }

    /** A branch or an assembly mode in words: those that are joints are written as joints. */
    spoken(name) {
        return name
            .split("_")
            .map((word) => this.info.joints?.[word]?.label ?? word)
            .join(" ");
    }

    /** The position of a target in space; 0 along an axis that the task does not have. */
    position(x) {
        const p = [0, 0, 0];
        this.axes.forEach((axis, k) => (p[axis] = x[this.places[k]]));
        return p;
    }

    /** Where the hand is in the coordinates of the task, for each assembly mode; NaN if it is not. */
    fk(q) {
        const found = this.robot.fk(q, this.parameters);
        const all = found.p ?? [found];
        return all.map((x) => (typeof x === "number" ? [x] : Array.from(x)));
    }

    /** Whether fewer joints than coordinates move the hand, so that it stays on a surface. */
    get onSurface() {
        return this.places.length > this.joints.length;
    }

    /** Take what is given besides the target from a posture, if the inverse needs it. */
    takeGiven(q) {
        const { GIVEN } = this.robot;
        if (GIVEN === undefined) return;
        const joint = this.joints.indexOf(GIVEN);
        this.given = joint < 0 ? this.robot[GIVEN](q, this.parameters) : q[joint];
    }

    /** The inputs of the inverse besides the target and the dimensions. */
    get beside() {
        return this.given === undefined ? [] : [this.given];
    }

    /** All branches of the inverse: `mode` is the assembly mode that reaches the target. */
    postures(x) {
        const { q, status } = this.robot.ik(x, ...this.beside, this.parameters);
        return this.branches.map((name, index) => {
            const joints = Array.from(q[index]);
            const mode = reaches(status[index]) ? this.modeOf(joints, x) : 0;
            return { name, index, status: status[index], q: joints, mode };
        });
    }

    /** The assembly mode whose hand is nearest to a target. */
    modeOf(q, x) {
        if (this.modes === 1) return 0;
        const gaps = this.fk(q).map((y) => this.distance(x, y));
        const least = Math.min(...gaps.filter(Number.isFinite));
        return Math.max(gaps.indexOf(least), 0);
    }

    /** How far two targets are apart: in length, if the task has a position. */
    distance(x, y) {
        const places = this.places.length ? this.places : x.map((_, k) => k);
        return Math.hypot(...places.map((k) => x[k] - y[k]));
    }

    /** The points of the skeleton, for each assembly mode: null where there is none. */
    points(q) {
        const found = this.robot.skeleton(q, this.parameters);
        const all = this.robot.ASSEMBLY_MODES.length ? found : [found];
        return all.map((flat) => {
            const points = [];
            for (let k = 0; k < flat.length; k += 3) points.push([flat[k], flat[k + 1], flat[k + 2]]);
            return points.every((p) => p.every(Number.isFinite)) ? points : null;
        });
    }

    /** The points as they are drawn: those of a spherical mechanism are on one sphere. */
    drawn(q) {
        const centre = this.names.indexOf(this.info.about);
        return this.points(q).map((points) => (points && centre >= 0 ? onSphere(points, points[centre]) : points));
    }

    /** The directions of the axes of the hand, the columns of its rotation, or null if it has none. */
    handAxes(x) {
        const width = { 16: 4, 9: 3 }[x.length];
        return width ? [0, 1, 2].map((j) => [0, 1, 2].map((i) => x[i * width + j])) : null;
    }

    /** The factors that vanish where the mechanism is singular. */
    factors(q, mode) {
        const found = this.robot.singularities(q, this.parameters);
        const own = this.robot.ASSEMBLY_MODES.length ? found[mode] : found;
        return typeof own === "number" ? [own] : Array.from(own);
    }

    /** The size that each factor usually has, so that they can be compared. */
    typicalFactors() {
        const found = this.sample(40).map((q) => this.factors(q, 0).map(Math.abs));
        return this.robot.SINGULARITIES.map((_, k) => Math.max(...found.map((f) => f[k] || 0)) || 1);
    }

    /** The joint that is free at a singular target, or -1: the answer follows the seed in it. */
    freeJoint(x, q) {
        for (let k = 0; k < q.length; k++) {
            const found = this.moved(x, q, k, q[k] + 0.4);
            if (found && Math.abs(wrapped(found[k] - q[k] - 0.4)) < 1e-6) return k;
        }
        return -1;
    }

    /** The posture with a free joint at a value and the hand at the target, or null. */
    moved(x, q, joint, value) {
        const seed = [...q];
        seed[joint] = value;
        const found = this.nearest(this.robot, x, seed, { given: this.given }, this.parameters);
        return found.q.every(Number.isFinite) ? found.q : null;
    }

    /** The rates of a point of the drawing with each joint. */
    rates(q, mode, point) {
        const here = this.drawn(q)[mode];
        return q.map((_, k) => {
            const there = [...q];
            there[k] += STEP;
            const points = this.drawn(there)[mode];
            if (!here || !points) return [0, 0, 0];
            return points[point].map((v, i) => (v - here[point][i]) / STEP);
        });
    }

    /** The joint that moves a point and is nearest to it in the mechanism, or -1. */
    jointOf(q, mode, point) {
        const far = this.rates(q, mode, point).map((r) => Math.hypot(...r));
        const most = Math.max(...far);
        return far.findLastIndex((v) => v > 0.05 * most && v > 1e-6 * this.size);
    }

    /** The distance of two postures in the joints, angles across the turn. */
    apart(a, b) {
        const gaps = a.map((v, k) => (this.slides[k] ? (v - b[k]) / this.size : wrapped(v - b[k])));
        return Math.max(...gaps.map(Math.abs));
    }

    /** Postures at random around the one of the page, the same on every visit. */
    sample(count) {
        const next = random(7);
        const base = this.info.general;
        return Array.from({ length: count }, () =>
            base.map((v, k) => (this.slides[k] ? v * (0.4 + 1.2 * next()) : v + Math.PI * (2 * next() - 1))),
        );
    }

    /** The middle and the radius of what the mechanism sweeps. */
    extent() {
        const points = [];
        for (const q of [this.info.general, this.info.home, ...this.sample(TRIALS)]) {
            for (const found of this.drawn(q)) if (found) points.push(...found);
        }
        const middle = [0, 1, 2].map((k) => {
            const values = points.map((p) => p[k]).sort((a, b) => a - b);
            const [low, high] = [0.01, 0.99].map((f) => values[Math.floor(f * (values.length - 1))]);
            return (low + high) / 2;
        });
        const reach = points.map((p) => Math.hypot(...p.map((v, k) => v - middle[k])));
        reach.sort((a, b) => a - b);
        return { middle, radius: reach[Math.floor(0.985 * (reach.length - 1))] || 1 };
    }

    isFlat() {
        for (const q of [this.info.general, ...this.sample(8)]) {
            for (const points of this.points(q)) {
                if (points && points.some((p) => Math.abs(p[2]) > 1e-12 * this.size)) return false;
            }
        }
        return true;
    }
}

/** The coordinates of the task that are a position: the place of each, and its axis of space. */
function positionIn(task) {
    if (task.length === 16) return [[3, 0], [7, 1], [11, 2]];
    return ["x", "y", "z"].map((name, axis) => [task.indexOf(name), axis]).filter(([place]) => place >= 0);
}

/** The coordinates that are not a position: angles of their own, or those of a rotation. */
function others(task, places) {
    if (task.length === 16 || task.length === 9) {
        const width = task.length === 16 ? 4 : 3;
        return ["roll", "pitch", "yaw"].map((label, k) => ({
            label,
            get: (x) => angles(x, width)[k],
            set: (x, value) => turned(x, width, angles(x, width).with(k, value)),
        }));
    }
    const rest = task.map((_, k) => k).filter((k) => !places.includes(k));
    return rest.map((k) => ({ ...task[k], get: (x) => x[k], set: (x, v) => x.with(k, v) }));
}

/** Roll, pitch and yaw of the rotation in a flat array whose rows have so many numbers. */
function angles(x, width) {
    const at = (i, j) => x[i * width + j];
    const pitch = Math.atan2(-at(2, 0), Math.hypot(at(0, 0), at(1, 0)));
    if (Math.hypot(at(0, 0), at(1, 0)) < 1e-12) return [Math.atan2(-at(1, 2), at(1, 1)), pitch, 0];
    return [Math.atan2(at(2, 1), at(2, 2)), pitch, Math.atan2(at(1, 0), at(0, 0))];
}

function turned(x, width, [roll, pitch, yaw]) {
    const [a, b, c] = [roll, pitch, yaw].map(Math.cos);
    const [r, p, y] = [roll, pitch, yaw].map(Math.sin);
    const R = [
        [c * b, c * p * r - y * a, c * p * a + y * r],
        [y * b, y * p * r + c * a, y * p * a - c * r],
        [-p, b * r, b * a],
    ];
    const made = [...x];
    for (let i = 0; i < 3; i++) for (let j = 0; j < 3; j++) made[i * width + j] = R[i][j];
    return made;
}
