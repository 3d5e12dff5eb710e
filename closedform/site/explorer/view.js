/** Draws postures on a canvas, in the plane or from a direction in space. */

import { arcs } from "./sphere.js";

const [LEAST, MOST] = [0.2, 20]; // of the zoom

export class View {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas, { middle, radius }, flat) {
        this.canvas = canvas;
        this.context = canvas.getContext("2d");
        this.flat = flat;
        this.middle = middle;
        this.radius = radius;
        /** How far the picture is moved on the page, in shares of its shorter side. */
        this.pan = [0, 0];
    }

    /** Fit the canvas to its element. */
    resize() {
        const ratio = window.devicePixelRatio || 1;
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (this.canvas.width !== Math.round(width * ratio) || this.height !== height) {
            this.canvas.width = Math.round(width * ratio);
            this.canvas.height = Math.round(height * ratio);
        }
        Object.assign(this, { ratio, width, height });
        if (this.zoom) this.aim();
    }

    /** Come as near as these points allow, and look from the first direction. */
    fit(points) {
        Object.assign(this, { azimuth: -1.0, elevation: 0.38, zoom: 1, pan: [0, 0] });
        this.aim();
        const shares = points.map((p) => {
            const [x, y] = this.project(p);
            return Math.max(Math.abs(x / this.width - 0.5), Math.abs(y / this.height - 0.5)) / 0.42;
        });
        this.zoom = Math.min(this.flat ? 1 : 1.7, 1 / Math.max(...shares));
        this.aim();
    }

    /** Zoom, and take what was under the first place of the canvas to the second. */
    zoomAt(factor, from, to = from) {
        const zoom = Math.min(Math.max(this.zoom * factor, LEAST), MOST);
        const share = zoom / this.zoom;
        const side = Math.min(this.width, this.height);
        this.zoom = zoom;
        this.pan = this.pan.map((v, k) => {
            const middle = (k ? this.height : this.width) / 2;
            return (to[k] - middle - share * (from[k] - middle - v * side)) / side;
        });
        this.aim();
    }

    /** The directions of the page: to the right, upwards, and towards the visitor. */
    aim() {
        const side = Math.min(this.width, this.height);
        this.scale = (0.47 * side * this.zoom) / this.radius;
        this.centre = [this.width / 2 + this.pan[0] * side, this.height / 2 + this.pan[1] * side];
        if (this.flat) {
            this.axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
            return;
        }
        const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
        const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
        this.axes = [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
    }

    /** A point of space on the canvas, with its depth towards the visitor. */
    project(p) {
        const d = p.map((v, k) => v - this.middle[k]);
        const [right, up, depth] = this.axes.map((a) => a[0] * d[0] + a[1] * d[1] + a[2] * d[2]);
        return [this.centre[0] + right * this.scale, this.centre[1] - up * this.scale, depth];
    }

    /** A step on the canvas as one in space, parallel to the canvas. */
    unproject(dx, dy) {
        const [right, up] = this.axes;
        return right.map((v, k) => (v * dx - up[k] * dy) / this.scale);
    }

    /** The floor of a mechanism in space, and the axes of the base frame. */
    drawBase(colour) {
        const step = 10 ** Math.floor(Math.log10(this.radius / 1.5));
        const size = step * Math.ceil(this.radius / step / (this.radius / step > 4 ? 2 : 1));
        const floor = this.flat ? [] : Array.from({ length: 9 }, (_, k) => ((k - 4) * size) / 4);
        for (const v of floor) {
            this.line([[v, -size, 0], [v, size, 0]], { colour, width: 0.7, alpha: 0.3 });
            this.line([[-size, v, 0], [size, v, 0]], { colour, width: 0.7, alpha: 0.3 });
        }
        const c = this.context;
        c.font = "12px system-ui, sans-serif";
        c.fillStyle = colour;
        for (const k of this.flat ? [0, 1] : [0, 1, 2]) {
            const end = [0, 0, 0].with(k, 0.16 * this.radius);
            this.line([[0, 0, 0], end], { colour, width: 1.4 });
            const [x, y] = this.project(end.map((v) => 1.25 * v));
            c.fillText("xyz"[k], x - 3, y + 4);
        }
    }

    clear(paper) {
        const c = this.context;
        c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
        c.fillStyle = paper;
        c.fillRect(0, 0, this.width, this.height);
        c.lineCap = "round";
        c.lineJoin = "round";
    }

    line(points, { colour, width = 2, dash = [], alpha = 1, cap = "round" }) {
        const c = this.context;
        c.lineCap = cap;
        c.strokeStyle = colour;
        c.lineWidth = width;
        c.globalAlpha = alpha;
        c.setLineDash(dash);
        c.beginPath();
        points.forEach((p, k) => {
            const [x, y] = this.project(p);
            if (k) c.lineTo(x, y);
            else c.moveTo(x, y);
        });
        c.stroke();
        c.lineCap = "round";
        c.setLineDash([]);
        c.globalAlpha = 1;
    }

    /** A rail from one point past another, and a block on it there. */
    block([a, b], { colour, ground, paper, width, alpha = 1 }) {
        const gap = b.map((v, k) => v - a[k]);
        const unit = this.radius / (Math.hypot(...gap) || 1);
        const at = (s) => b.map((v, k) => v + s * unit * gap[k]);
        this.line([a, at(0.15)], { colour: ground, width: 2.2 });
        for (const [half, wide, shade] of [[0.06, 4.6, colour], [0.05, 3.6, paper]]) {
            const style = { colour: shade, width: wide * width, alpha, cap: "butt" };
            this.line([at(-half), at(half)], style);
        }
    }

    /** Many short lines of one look. */
    segments(parts, { colour, width }) {
        const c = this.context;
        c.strokeStyle = colour;
        c.lineWidth = width;
        c.beginPath();
        for (const [a, b] of parts) {
            const [x, y] = this.project(a);
            const [u, v] = this.project(b);
            c.moveTo(x, y);
            c.lineTo(u, v);
        }
        c.stroke();
    }

    /** The outline of a sphere. */
    sphere(centre, radius, colour) {
        const c = this.context;
        const [x, y] = this.project(centre);
        c.strokeStyle = colour;
        c.lineWidth = 0.7;
        c.globalAlpha = 0.6;
        c.beginPath();
        c.arc(x, y, radius * this.scale, 0, 2 * Math.PI);
        c.stroke();
        c.globalAlpha = 1;
    }

    /** The name of a point: a letter with an index, such as A1, or words, such as joint3. */
    name(text, [x, y], colour) {
        const c = this.context;
        const { letter, index } = /^(?<letter>[A-Z])(?<index>\w+)$/.exec(text)?.groups ?? {};
        c.fillStyle = colour;
        c.font = "13px system-ui, sans-serif";
        c.fillText(letter ?? words(text), x, y);
        if (!letter) return;
        const width = c.measureText(letter).width;
        c.font = "10px system-ui, sans-serif";
        c.fillText(index, x + width, y + 3);
    }

    dot(p, { colour, fill, radius = 4, alpha = 1, width = 1.8 }) {
        const c = this.context;
        const [x, y] = this.project(p);
        c.globalAlpha = alpha;
        c.beginPath();
        c.arc(x, y, radius, 0, 2 * Math.PI);
        c.fillStyle = fill;
        c.fill();
        c.strokeStyle = colour;
        c.lineWidth = width;
        c.stroke();
        c.globalAlpha = 1;
    }

    cross(p, colour) {
        const c = this.context;
        const [x, y] = this.project(p);
        c.strokeStyle = colour;
        c.lineWidth = 2;
        c.beginPath();
        for (const s of [-1, 1]) {
            c.moveTo(x - 6, y - 6 * s);
            c.lineTo(x + 6, y + 6 * s);
        }
        c.stroke();
    }

    diamond(p, { colour, fill, radius = 7, alpha = 1 }) {
        const c = this.context;
        const [x, y] = this.project(p);
        c.globalAlpha = alpha;
        c.beginPath();
        c.moveTo(x, y - radius);
        c.lineTo(x + radius, y);
        c.lineTo(x, y + radius);
        c.lineTo(x - radius, y);
        c.closePath();
        c.fillStyle = fill;
        c.fill();
        c.strokeStyle = colour;
        c.lineWidth = 1.8;
        c.stroke();
        c.globalAlpha = 1;
    }

    /** A picture that lies in a plane: its corner, and its sides. */
    plane(image, corner, along, up, smooth) {
        const c = this.context;
        const [x0, y0] = this.project(corner);
        const [x1, y1] = this.project(corner.map((v, k) => v + along[k]));
        const [x2, y2] = this.project(corner.map((v, k) => v + up[k]));
        const [w, h] = [image.width, image.height];
        c.save();
        c.imageSmoothingEnabled = smooth;
        c.transform((x1 - x0) / w, (y1 - y0) / w, (x2 - x0) / h, (y2 - y0) / h, x0, y0);
        c.drawImage(image, 0, 0);
        c.restore();
    }
}

/** The name of a point in words: joint 3 for joint3. */
const words = (name) => name.replaceAll("_", " ").replace(/(?<=[a-z]{2})(?=\d)/, " ");

/**
 * A posture: ground, links, slides, joints and the hand.
 *
 * @param {View} view
 * @param {import("./mechanism.js").Mechanism} mechanism
 * @param {number[][]} points as the mechanism is drawn
 */
export function drawPosture(view, { skeleton, info }, points, style) {
    const { colour, ground, paper, width = 4, alpha = 1, dash = [], bare = false } = style;
    const [faint, rails] = [info.faint ?? [], info.rails ?? []];
    const place = (name) => points[skeleton.points.indexOf(name)];
    const links = Object.entries(skeleton.links).map(([name, path]) => {
        const own = info.about ? arcs(path.map(place), place(info.about)) : path.map(place);
        const depth = own.reduce((sum, p) => sum + view.project(p)[2], 0) / own.length;
        return { name, path, own, depth };
    });
    links.sort((a, b) => a.depth - b.depth);
    for (const name of bare ? [] : rails) {
        view.block(skeleton.joints[name].points.map(place), { colour, ground, paper, width, alpha });
    }
    for (const { name, path, own } of links) {
        if (name === "ground" || path.every((p) => skeleton.ground.includes(p))) {
            if (!bare) view.line(own, { colour: ground, width: 2.2 });
        } else if (faint.includes(name)) {
            view.line(own, { colour, width: width / 2, dash: [6, 4], alpha: 0.8 * alpha });
        } else view.line(own, { colour, width, alpha, dash });
    }
    for (const [name, joint] of Object.entries(skeleton.joints)) {
        const [a, b] = joint.points.map(place);
        if (rails.includes(name)) {
            if (!bare) view.dot(b, { colour, fill: paper, radius: width - 0.5, alpha });
        } else if (joint.kind === "prismatic" && b) {
            const at = (f) => a.map((v, k) => v + f * (b[k] - v));
            view.line([a, b], { colour, width: 0.7 * width, alpha, dash });
            if (bare) continue;
            view.line([at(0.12), at(0.5)], { colour, width: 2.6 * width, alpha });
            view.line([at(0.12), at(0.5)], { colour: paper, width: 1.6 * width, alpha });
        } else if (!bare) view.dot(a, { colour, fill: paper, radius: width + 0.6, alpha });
    }
    if (!bare) view.diamond(place(skeleton.hand), { colour, fill: colour, alpha });
}
