/** The space of two joints: a plot that a visitor can drag in. */

import { COLOURS, WARNING, colourOf } from "./colours.js";
import { choice, element } from "./controls.js";
import { contours, picture } from "./grid.js";
import { OK } from "./mechanism.js";

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
export class JointPlot {
    /** @param {import("./explorer.js").Explorer} explorer */
    constructor(explorer) {
        this.explorer = explorer;
        const m = explorer.mechanism;
        this.plane = new JointPlane(m);
        this.canvas = element("canvas", { class: "joint-space", tabindex: 0, role: "img" });
        const names = m.joints.map((_, k) => m.label(k));
        this.picks = ["across", "up"].map((way, k) =>
            choice(way, names, explorer.pair[k], (joint) => {
                explorer.pair[k] = joint;
                explorer.changed();
            }),
        );
        this.element = element("div", {}, this.canvas, ...this.picks.map((p) => p.row));
        this.canvas.addEventListener("pointerdown", (event) => {
            this.canvas.setPointerCapture(event.pointerId);
            this.take(event);
        });
        this.canvas.addEventListener("pointermove", (event) => this.take(event));
    }

    /** Move the two joints to where the pointer is. */
    take(event) {
        if (!event.buttons) return;
        const box = this.canvas.getBoundingClientRect();
        const share = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
        const q = [...this.explorer.q];
        this.explorer.pair.forEach((joint, k) => {
            const [low, high] = this.plane.range(joint);
            q[joint] = low + share[k] * (high - low);
        });
        this.explorer.takeJoints(q);
    }

    show() {
        const { layers, pair, mechanism: m } = this.explorer;
        this.picks.forEach((p, k) => (p.select.selectedIndex = pair[k]));
        this.element.hidden = !layers.joints;
        if (!layers.joints) return;
        this.compute();
        this.draw();
        const [across, up] = pair.map((k) => m.label(k));
        this.canvas.setAttribute("aria-label", `Joint space: ${across} across, ${up} up; singular curves in red.`);
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

    draw() {
        const { canvas, plane, explorer } = this;
        const ratio = window.devicePixelRatio || 1;
        const side = Math.round((canvas.clientWidth || 240) * ratio);
        if (canvas.width !== side) canvas.width = canvas.height = side;
        const c = canvas.getContext("2d");
        c.setTransform(1, 0, 0, 1, 0, 0);
        c.fillStyle = colourOf(explorer.place, "paper");
        c.fillRect(0, 0, side, side);
        const scale = side / plane.image.width;
        c.save();
        c.translate(0, side);
        c.scale(scale, -scale);
        c.imageSmoothingEnabled = false;
        c.drawImage(plane.image, 0, 0);
        c.restore();
        c.strokeStyle = WARNING;
        c.lineWidth = 1.5 * ratio;
        c.beginPath();
        for (const [x, y, u, v] of plane.curves) {
            c.moveTo(x * scale, side - y * scale);
            c.lineTo(u * scale, side - v * scale);
        }
        c.stroke();
        for (const p of explorer.found) {
            if (p.status === OK) this.mark(p.q, COLOURS[p.index % COLOURS.length], 3 * ratio);
        }
        this.mark(explorer.q, COLOURS[explorer.branch % COLOURS.length], 6 * ratio);
    }

    mark(q, colour, radius) {
        const { canvas, plane, explorer } = this;
        const [x, y] = explorer.pair.map((joint) => {
            const [low, high] = plane.range(joint);
            return (q[joint] - low) / (high - low);
        });
        const c = canvas.getContext("2d");
        c.beginPath();
        c.arc(x * canvas.width, (1 - y) * canvas.height, radius, 0, 2 * Math.PI);
        c.fillStyle = colour;
        c.fill();
    }
}
