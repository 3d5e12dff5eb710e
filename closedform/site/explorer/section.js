/** A section of the workspace, computed by batches of postures. */

import { batch } from "closedform/_runtime.js";
import { contours, picture } from "./grid.js";
import { reaches } from "./mechanism.js";

const BATCH = 1500; // postures at once, so that their numbers stay in the cache
const MET = 1e-9; // of the size: so near to a target the hand is at it

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

/** Put the colour of a value into the pixels of a picture, from a place on. */
function shade(value, pixels, place) {
    const at = Math.min(Math.max(value, 0), 1) * (SCALE.length - 1);
    const k = Math.min(Math.floor(at), SCALE.length - 2);
    const [from, to] = [SCALE[k], SCALE[k + 1]];
    for (let i = 0; i < 3; i++) pixels[place + i] = Math.round(from[i] + (at - k) * (to[i] - from[i]));
    pixels[place + 3] = 255;
}

/** The planes of some postures out of those of n. */
function taken(planes, n, list) {
    const m = list.length;
    const found = new Float64Array((planes.length / n) * m);
    for (let start = 0, to = 0; start < planes.length; start += n) {
        for (let j = 0; j < m; j++) found[to++] = planes[start + list[j]];
    }
    return found;
}

/**
 * A section of the workspace through the hand, for one branch: where it has a posture, where a factor
 * of the singular set changes its sign, and how far the postures are from singular.
 */
export class Section {
    /** @param {import("./mechanism.js").Mechanism} mechanism */
    constructor(mechanism, maps, { middle, radius }, plane) {
        this.mechanism = mechanism;
        this.directions = plane.map((name) => "xyz".indexOf(name));
        this.axes = this.directions.map((k) => mechanism.places[mechanism.axes.indexOf(k)]);
        this.low = this.directions.map((k) => middle[k] - 1.05 * radius);
        this.width = 2.1 * radius;
        this.image = picture(1);
        this.done = true;
        this.milliseconds = 0;
        this.measure = maps.CONDITION_NUMBER.length ? "conditioning" : maps.DETERMINANT.length ? "determinant" : "";
        const measure = this.measure === "conditioning" ? maps.CONDITION_NUMBER : maps.DETERMINANT;
        this.kernels = { ik: maps.IK, fk: maps.FK, measure, factors: maps.SINGULARITIES };
        this.usual = 0;
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

    /** Compute rows for so many milliseconds. */
    step(budget) {
        if (this.done) return;
        const begin = performance.now();
        while (this.row < this.size && performance.now() - begin < budget) {
            this.rows(Math.max(1, Math.min(this.size - this.row, Math.ceil(BATCH / this.size))));
        }
        this.milliseconds += performance.now() - begin;
        if (this.row < this.size) return;
        this.paint();
        this.done = true;
    }

    rows(count) {
        const n = count * this.size;
        const found = this.oneBranch(n);
        const { reached, q } = found;
        this.row += count;
        if (!reached.length) return;
        const first = (this.row - count) * this.size;
        const { measure, factors } = this.kernels;
        for (const [mode, list] of this.byMode(found)) {
            const own = list ? taken(q, reached.length, list) : q;
            const m = list ? list.length : reached.length;
            const cell = (j) => first + reached[list ? list[j] : j];
            const values = this.map && measure.length ? this.run(measure[mode], m, [own]) : null;
            for (let j = 0; j < m; j++) {
                const value = values ? Math.abs(values[j]) : 0;
                this.value[cell(j)] = this.measure === "conditioning" ? 1 / value : value;
            }
            if (!this.workspace) continue;
            const planes = this.run(factors[mode], m, [own]);
            for (let k = 0; k < this.factors; k++) {
                const start = k * this.size ** 2;
                for (let j = 0; j < m; j++) this.factor[start + cell(j)] = planes[k * m + j];
            }
        }
    }

    /** The next n targets that the branch reaches: which they are, and the joints. */
    oneBranch(n) {
        const { x } = this;
        const width = x.length;
        if (this.targets?.length !== n * width) {
            this.targets = new Float64Array(n * width);
            x.forEach((value, k) => this.targets.fill(value, k * n, (k + 1) * n));
        }
        const step = this.width / this.size;
        const [across, up] = this.axes.map((k) => this.targets.subarray(k * n, (k + 1) * n));
        for (let i = 0; i < n; i++) {
            const row = Math.floor(i / this.size);
            across[i] = this.low[0] + (i - row * this.size + 0.5) * step;
            up[i] = this.low[1] + (this.row + row + 0.5) * step;
        }
        const { q, status } = this.run(this.kernels.ik[this.branch], n, [this.targets, ...this.beside(n)]);
        const reached = [];
        for (let i = 0; i < n; i++) if (reaches(status[i])) reached.push(i);
        return { reached, q: reached.length === n ? q : taken(q, n, reached), n };
    }

    /** What n targets take besides: the value that is seen. */
    beside(n) {
        return this.mechanism.beside.map((value) => new Float64Array(n).fill(value));
    }

    run(kernel, n, args) {
        return batch(kernel, n, args, kernel.outputs.map(() => undefined), this.mechanism.parameters);
    }

    /**
     * The postures by the assembly mode that reaches the target: a list for each mode, or all in one.
     *
     * A mode that reaches the target is that of the posture; the others are asked only where it does not.
     */
    *byMode({ reached, q, n }) {
        const { places, modes, size } = this.mechanism;
        if (modes === 1) return yield [0, null];
        const m = reached.length;
        const best = new Uint8Array(m);
        const least = new Float64Array(m).fill(Infinity);
        let open = null;
        for (let k = 0; k < modes; k++) {
            const mode = (this.usual + k) % modes;
            const own = open ? taken(q, m, open) : q;
            const count = open ? open.length : m;
            const { p } = this.run(this.kernels.fk[mode], count, [own]);
            const rest = [];
            for (let j = 0; j < count; j++) {
                const posture = open ? open[j] : j;
                let gap = 0;
                for (const place of places) {
                    gap += (p[place * count + j] - this.targets[place * n + reached[posture]]) ** 2;
                }
                if (gap < least[posture]) [least[posture], best[posture]] = [gap, mode];
                if (!(gap < (MET * size) ** 2)) rest.push(posture);
            }
            if (!rest.length && !open) return yield [mode, null];
            open = rest;
            if (!rest.length) break;
        }
        for (let mode = 0; mode < modes; mode++) {
            const list = [];
            for (let j = 0; j < m; j++) if (best[j] === mode) list.push(j);
            if (list.length > m / 2) this.usual = mode;
            if (list.length) yield [mode, list];
        }
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
            shade(most ? value[cell] / most : 0, data.data, 4 * cell);
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
        const corner = this.mechanism.position(this.x);
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
