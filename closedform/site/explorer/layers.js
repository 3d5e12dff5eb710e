/** Maps that are computed by batches: a section of the workspace, and the space of two joints. */

import { OK, SINGULAR } from "./mechanism.js";

/** A scale of colours that is even to the eye, from dark (singular) to bright. */
const SCALE = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 74, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [110, 206, 88],
    [181, 222, 43],
    [253, 231, 37],
];

export function shade(value) {
    const at = Math.min(Math.max(value, 0), 1) * (SCALE.length - 1);
    const k = Math.min(Math.floor(at), SCALE.length - 2);
    return SCALE[k].map((v, i) => Math.round(v + (at - k) * (SCALE[k + 1][i] - v)));
}

/**
 * Where values on a square grid change their sign: lines in units of the grid.
 *
 * @param {(cell: number) => number} value NaN where there is none
 */
function contours(size, value) {
    const found = [];
    const corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
    for (let row = 0; row + 1 < size; row++) {
        for (let column = 0; column + 1 < size; column++) {
            const cell = row * size + column;
            const around = [value(cell), value(cell + 1), value(cell + size + 1), value(cell + size)];
            const crossed = [];
            for (let k = 0; k < 4; k++) {
                const [f, g] = [around[k], around[(k + 1) % 4]];
                if (!(f * g < 0)) continue;
                const share = f / (f - g);
                const [a, b] = [corners[k], corners[(k + 1) % 4]];
                crossed.push(column + 0.5 + a[0] + share * (b[0] - a[0]), row + 0.5 + a[1] + share * (b[1] - a[1]));
            }
            if (crossed.length === 4) found.push(crossed);
        }
    }
    return found;
}

function picture(size) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = size;
    return canvas;
}

/**
 * A section of the workspace through the hand, for one branch: where it has a posture, where a factor
 * of the singular set changes its sign, and how far the postures are from singular.
 */
export class Section {
    /** @param {import("./mechanism.js").Mechanism} mechanism */
    constructor(mechanism, { middle, radius }, plane) {
        this.mechanism = mechanism;
        const { TASK } = mechanism.robot;
        const axis = (name) => (TASK.length === 16 ? { x: 3, y: 7, z: 11 }[name] : TASK.indexOf(name));
        this.axes = plane.map(axis);
        this.directions = plane.map((name) => "xyz".indexOf(name));
        this.low = this.directions.map((k) => middle[k] - 1.05 * radius);
        this.width = 2.1 * radius;
        this.image = picture(1);
        this.done = true;
        this.milliseconds = 0;
        const { robot } = mechanism;
        this.measure = robot.condition_number_batch ? "conditioning" : robot.determinant_batch ? "determinant" : "";
    }

    /** Begin a map of so many rows for a target and a branch: of what is to be seen. */
    start(x, branch, size, { map, workspace }) {
        const cells = size * size;
        Object.assign(this, { x: [...x], branch, size, map, workspace, row: 0, done: false, milliseconds: 0 });
        const { robot } = this.mechanism;
        this.factors = robot.SINGULARITIES.length;
        this.value = new Float32Array(cells).fill(NaN);
        this.factor = new Float32Array(cells * this.factors).fill(NaN);
    }

    /** Compute rows for so many milliseconds; true once the picture is new. */
    step(budget) {
        if (this.done) return false;
        const begin = performance.now();
        while (this.row < this.size && performance.now() - begin < budget) {
            this.rows(Math.max(1, Math.min(this.size - this.row, Math.ceil(4000 / this.size))));
        }
        this.milliseconds += performance.now() - begin;
        if (this.row < this.size) return false;
        this.paint();
        this.done = true;
        return true;
    }

    rows(count) {
        const { robot, parameters, joints, modes } = this.mechanism;
        const n = count * this.size;
        const x = new Float64Array(n * this.x.length);
        this.x.forEach((value, k) => x.fill(value, k * n, (k + 1) * n));
        const step = this.width / this.size;
        for (let i = 0; i < n; i++) {
            const [column, row] = [i % this.size, this.row + Math.floor(i / this.size)];
            x[this.axes[0] * n + i] = this.low[0] + (column + 0.5) * step;
            x[this.axes[1] * n + i] = this.low[1] + (row + 0.5) * step;
        }
        const found = robot.ik_batch(n, x, undefined, undefined, parameters);
        const width = joints.length * n;
        const q = found.q.slice(this.branch * width, (this.branch + 1) * width);
        const status = found.status.subarray(this.branch * n, (this.branch + 1) * n);
        const mode = modes > 1 ? this.modesOf(n, q, x) : null;
        const own = (planes, k, count, i) => planes[((mode ? mode[i] : 0) * count + k) * n + i];
        const factors = this.workspace && robot.singularities_batch(n, q, undefined, parameters);
        const name = this.measure === "conditioning" ? "condition_number_batch" : "determinant_batch";
        const measured = this.map && robot[name]?.(n, q, undefined, parameters);
        for (let i = 0; i < n; i++) {
            if (status[i] !== OK && status[i] !== SINGULAR) continue;
            const cell = this.row * this.size + i;
            const value = measured ? Math.abs(own(measured, 0, 1, i)) : 0;
            this.value[cell] = this.measure === "conditioning" ? 1 / value : value;
            for (let k = 0; factors && k < this.factors; k++) {
                this.factor[k * this.size ** 2 + cell] = own(factors, k, this.factors, i);
            }
        }
        this.row += count;
    }

    /** For each posture the assembly mode that reaches its target. */
    modesOf(n, q, x) {
        const { robot, parameters, modes, places } = this.mechanism;
        const { p } = robot.fk_batch(n, q, undefined, undefined, parameters);
        const best = new Uint8Array(n);
        const least = new Float64Array(n).fill(Infinity);
        for (let mode = 0; mode < modes; mode++) {
            for (let i = 0; i < n; i++) {
                let gap = 0;
                for (const k of places) {
                    gap += (p[(mode * this.x.length + k) * n + i] - x[k * n + i]) ** 2;
                }
                if (gap < least[i]) [least[i], best[i]] = [gap, mode];
            }
        }
        return best;
    }

    /** The picture: transparent where the branch has no posture; the border, and the singular curves. */
    paint() {
        const { size, value, factor } = this;
        let most = this.measure === "conditioning" ? 1 : 0;
        if (!most) for (const v of value) if (v > most) most = v;
        this.image = picture(size);
        const context = this.image.getContext("2d");
        const data = context.createImageData(size, size);
        for (let cell = 0; cell < size * size; cell++) {
            if (Number.isNaN(value[cell])) continue;
            data.data.set([...shade(most ? value[cell] / most : 0), 255], 4 * cell);
        }
        context.putImageData(data, 0, 0);
        this.cells = size;
        this.border = contours(size, (cell) => (Number.isNaN(value[cell]) ? -1 : 1));
        this.curves = [];
        for (let k = 0; this.workspace && k < this.factors; k++) {
            this.curves.push(...contours(size, (cell) => factor[k * size * size + cell]));
        }
    }

    /** Draw the map and the curves where they lie. */
    draw(view, { map, workspace }, colours) {
        if (this.image.width === 1) return;
        const corner = [0, 0, 0];
        const position = this.mechanism.places.map((k) => this.x[k]);
        position.forEach((v, k) => (corner[k] = v));
        this.directions.forEach((k, i) => (corner[k] = this.low[i]));
        const sides = this.directions.map((k) => [0, 1, 2].map((i) => (i === k ? this.width : 0)));
        if (map) {
            view.context.globalAlpha = 0.85;
            view.plane(this.image, corner, sides[0], sides[1], true);
            view.context.globalAlpha = 1;
        }
        if (!workspace) return;
        const at = (u, v) => corner.map((c, i) => c + (u * sides[0][i] + v * sides[1][i]) / this.cells);
        const seen = (parts) => parts.map(([a, b, c, d]) => [at(a, b), at(c, d)]);
        view.segments(seen(this.border), { colour: colours.border, width: 1.2 });
        view.segments(seen(this.curves), { colour: colours.curve, width: 1.8 });
    }
}

/** Two joints as a plane: where the mechanism can be assembled, and its singular curves. */
export class JointPlane {
    /** @param {import("./mechanism.js").Mechanism} mechanism */
    constructor(mechanism) {
        this.mechanism = mechanism;
        this.image = picture(1);
    }

    /** The range of a joint in the picture. */
    range(k) {
        const { slides, info } = this.mechanism;
        return slides[k] ? [0, 2 * Math.max(info.general[k], info.home[k], 0.2)] : [-Math.PI, Math.PI];
    }

    compute(q, mode, [a, b], size = 120) {
        const { robot, parameters, joints, modes } = this.mechanism;
        const n = size * size;
        const planes = new Float64Array(n * joints.length);
        joints.forEach((_, k) => planes.fill(q[k], k * n, (k + 1) * n));
        const [ra, rb] = [this.range(a), this.range(b)];
        for (let i = 0; i < n; i++) {
            planes[a * n + i] = ra[0] + (((i % size) + 0.5) / size) * (ra[1] - ra[0]);
            planes[b * n + i] = rb[0] + ((Math.floor(i / size) + 0.5) / size) * (rb[1] - rb[0]);
        }
        const count = robot.SINGULARITIES.length;
        const factors = robot.singularities_batch(n, planes, undefined, parameters);
        const offset = modes > 1 ? mode * count * n : 0;
        this.size = size;
        this.image = picture(size);
        const context = this.image.getContext("2d");
        const data = context.createImageData(size, size);
        for (let i = 0; i < n; i++) {
            if (Number.isNaN(factors[offset + i])) data.data.set([128, 128, 128, 70], 4 * i);
        }
        context.putImageData(data, 0, 0);
        this.curves = [];
        for (let k = 0; k < count; k++) {
            this.curves.push(...contours(size, (cell) => factors[offset + k * n + cell]));
        }
    }
}
