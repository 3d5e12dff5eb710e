/** The space of two joints: a plot that a visitor can drag in. */

import { WARNING } from "./colours.js";
import { choice } from "./controls.js";
import { contours, picture } from "./grid.js";
import { Plot } from "./plot.js";
import { between } from "./words.js";

const CELLS = 120; // along a side

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

    compute(q, mode, [a, b]) {
        const { robot, parameters, joints, modes } = this.mechanism;
        const size = CELLS;
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

/** The plot, and the choice of its two joints. */
export class JointPlot extends Plot {
    /** @param {import("./explorer.js").Explorer} explorer */
    constructor(explorer) {
        super(explorer);
        const m = explorer.mechanism;
        this.plane = new JointPlane(m);
        const names = m.joints.map((_, k) => m.label(k));
        this.picks = ["across", "up"].map((way, k) =>
            choice(way, names, explorer.pair[k], (joint) => {
                explorer.pair[k] = joint;
                explorer.changed();
            }),
        );
        this.element.append(...this.picks.map((p) => p.row));
    }

    /** Move the two joints. */
    take(shares) {
        const q = [...this.explorer.q];
        this.explorer.pair.forEach((joint, k) => {
            const [low, high] = this.plane.range(joint);
            q[joint] = low + shares[k] * (high - low);
        });
        this.explorer.takeJoints(q);
    }

    placeOf(q) {
        return this.explorer.pair.map((joint) => {
            const [low, high] = this.plane.range(joint);
            return (q[joint] - low) / (high - low);
        });
    }

    label() {
        const [across, up] = this.explorer.pair.map((k) => this.explorer.mechanism.label(k));
        const [a, b] = this.explorer.pair.map((k) => between(this.plane.range(k)));
        return `${across} across (${a}), ${up} up (${b}). Red: singular; grey: cannot be assembled.`;
    }

    show() {
        this.picks.forEach((p, k) => (p.select.selectedIndex = this.explorer.pair[k]));
        super.show();
    }

    /** Compute the curves anew if anything but the two joints has changed. */
    compute() {
        const { q, mode, pair, mechanism: m } = this.explorer;
        const rest = q.filter((_, k) => !pair.includes(k));
        const of = JSON.stringify([rest, mode, pair, m.parameters]);
        if (of === this.of) return;
        this.of = of;
        this.plane.compute(q, mode, pair);
    }

    paint(c, side) {
        this.compute();
        const { image, curves } = this.plane;
        const scale = side / image.width;
        c.save();
        c.translate(0, side);
        c.scale(scale, -scale);
        c.imageSmoothingEnabled = false;
        c.drawImage(image, 0, 0);
        c.restore();
        c.strokeStyle = WARNING;
        c.lineWidth = 1.5 * this.ratio;
        c.beginPath();
        for (const [x, y, u, v] of curves) {
            c.moveTo(x * scale, side - y * scale);
            c.lineTo(u * scale, side - v * scale);
        }
        c.stroke();
    }
}
