/** The explorer of a mechanism: drag the hand or a joint, and all branches of the inverse follow. */

import { button, checkbox, choice, element, group, slider } from "./controls.js";
import { JointPlane, Section } from "./layers.js";
import { Mechanism, OK, SINGULAR, UNREACHABLE, wrapped } from "./mechanism.js";
import { read, write } from "./state.js";
import { View, drawPosture } from "./view.js";
import { lines, short, spoken, status } from "./words.js";

const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a63d2", "#7a7a00"];
const WARNING = "#cc3311";
const GRAB = 16; // pixels
const TRAIL = 400;
const BISECTIONS = 30;
const MEETS = 0.03; // rad, or of the size
const FRAME = 10; // milliseconds for a map in each frame
const [COARSE, FINE] = [90, 300];

/** Show the explorer in every element of a robot. */
export function mountAll(name, modules) {
    for (const place of document.querySelectorAll(`.explorer[data-robot="${name}"]`)) {
        const info = JSON.parse(place.querySelector(".explorer-info").textContent);
        place.explorer = new Explorer(place, info, modules);
    }
}

export class Explorer {
    /** @param {HTMLElement} place */
    constructor(place, info, { robot, nearest, maps, other = null, cases = [] }) {
        this.place = place;
        this.mechanism = new Mechanism(robot, nearest, info);
        this.cases = cases;
        this.compared = other && new Mechanism(other, nearest, info);
        this.maps = maps;
        this.layers = { workspace: false, map: false, joints: false, trail: true, names: false };
        this.case = -1;
        this.trail = [];
        this.meetings = [];
        this.times = [];
        this.q = [...info.general];
        this.mode = info.mode ?? 0;
        this.branch = 0;
        this.build();
        const saved = read(location.hash, info.name);
        if (saved) this.restore(saved);
        else this.takeJoints(this.q);
        window.addEventListener("hashchange", () => {
            const found = read(location.hash, info.name);
            if (found) this.restore(found);
        });
        new ResizeObserver(() => this.draw()).observe(this.canvas);
        new MutationObserver(() => this.draw()).observe(document.body, { attributes: true });
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    }

    // What is seen

    /** Take joints: the hand follows. */
    takeJoints(q) {
        const x = this.mechanism.fk(q)[this.mode];
        this.q = [...q];
        if (x?.every(Number.isFinite)) {
            this.x = x;
            this.found = this.mechanism.postures(x);
            const gaps = this.found.map((p) =>
                p.status === OK || p.status === SINGULAR ? this.mechanism.apart(p.q, q) : Infinity,
            );
            const least = Math.min(...gaps);
            if (least < Infinity) this.branch = gaps.indexOf(least);
            this.reached = true;
            this.follow();
        } else this.reached = false;
        this.changed();
    }

    /** Take a target: the current branch follows, or the hand stays where it was. */
    takeTarget(x) {
        const before = { x: this.x, q: this.q, reached: this.reached };
        this.x = [...x];
        this.found = this.mechanism.postures(x);
        const own = this.found[this.branch];
        this.reached = own.status === OK || own.status === SINGULAR;
        if (this.reached) {
            if (before.x && this.held) this.meet(before.q, this.found);
            this.q = this.keepFree(own, before.q);
            this.mode = own.mode;
            this.follow();
        } else if (before.reached && this.held) this.meetAtBorder(before.x, x);
        this.changed();
    }

    /** A free joint keeps its value, as long as the hand stays at the target. */
    keepFree(own, before) {
        if (own.status !== SINGULAR) return own.q;
        const joint = this.mechanism.freeJoint(this.x, own.q);
        return (joint >= 0 && this.mechanism.moved(this.x, own.q, joint, before[joint])) || own.q;
    }

    follow() {
        const points = this.mechanism.points(this.q)[this.mode];
        if (!points) return;
        this.trail.push(points[this.mechanism.hand]);
        if (this.trail.length > TRAIL) this.trail.shift();
    }

    /** Mark the last place on the way to a target out of reach, where branches meet. */
    meetAtBorder(inside, outside) {
        const m = this.mechanism;
        const between = (share) => inside.map((v, k) => v + share * (outside[k] - v));
        const reached = (x) => [OK, SINGULAR].includes(m.postures(x)[this.branch].status);
        let [low, high] = [0, 1];
        for (let k = 0; k < BISECTIONS; k++) {
            const middle = (low + high) / 2;
            if (reached(between(middle))) low = middle;
            else high = middle;
        }
        const found = m.postures(between(low));
        this.meet(found[this.branch].q, found);
    }

    /** Mark where, from one posture to the next, the branch meets another or passes a singularity. */
    meet(before, found) {
        const m = this.mechanism;
        const own = found[this.branch];
        const [f, g] = [m.factors(before, this.mode), m.factors(own.q, own.mode)];
        const crossed = f.findIndex((v, k) => v * g[k] < 0);
        const other = found.find(
            (p) => p !== own && p.status === OK && m.apart(p.q, own.q) < MEETS,
        );
        const near = g.map((v, k) => Math.abs(v) / m.scales[k]);
        const factor = crossed >= 0 ? crossed : near.indexOf(Math.min(...near));
        if (!other && crossed < 0) return;
        const where = `singular: ${m.robot.SINGULARITIES[factor]}`;
        const said = other ? `${spoken(own.name)} meets ${spoken(other.name)}, ${where}` : `Crossed, ${where}`;
        if (said === this.meetings.at(-1)?.said) return;
        const points = m.points(own.q)[own.mode];
        this.meetings.push({ at: points[m.hand], said });
        if (this.meetings.length > 8) this.meetings.shift();
    }

    // For tests

    /** All branches as they are drawn: name, status, joints and points. */
    postures() {
        return this.found.map((p) => ({ ...p, points: this.mechanism.points(p.q)[p.mode] }));
    }

    /** The median of the last frames in milliseconds. */
    frameTime() {
        const sorted = [...this.times].sort((a, b) => a - b);
        return sorted[Math.floor(sorted.length / 2)] ?? NaN;
    }

    // The page

    build() {
        const m = this.mechanism;
        this.canvas = element("canvas", {
            tabindex: 0,
            role: "application",
            "aria-label":
                `${m.info.title}. Arrow keys move the hand, with shift in small steps; page up and page down ` +
                "move it in depth; square brackets change the branch.",
        });
        this.say = element("p", { class: "said", role: "status" });
        this.view = new View(this.canvas, { ...m.extent(), flat: m.flat });
        this.picture = element("div", { class: "picture" }, this.canvas, this.say);
        const side = element("div", { class: "controls" });
        const notes = [...this.place.childNodes].filter((n) => n.nodeName === "SCRIPT");
        this.place.replaceChildren(...notes, this.picture, side);
        side.append(
            this.buildBranches(),
            this.buildJoints(),
            this.buildTarget(),
            this.buildDimensions(),
            this.buildLayers(),
            ...this.buildPublished(),
            this.buildCopy(),
        );
        this.listen();
    }

    buildBranches() {
        const m = this.mechanism;
        this.legend = m.branches.map((name, k) => {
            const note = element("small");
            const swatch = element("span", { class: "swatch" });
            swatch.style.background = COLOURS[k % COLOURS.length];
            const choose = button("", () => this.choose(k), { class: "branch" });
            choose.append(swatch, spoken(name), " ", note);
            return { choose, note };
        });
        const made = group("Branches", true, ...this.legend.map((e) => e.choose));
        this.free = slider({
            label: "free joint",
            min: -Math.PI,
            max: Math.PI,
            changed: (value) => this.moveFree(value),
        });
        this.free.row.hidden = true;
        made.append(this.free.row);
        if (m.modes > 1) {
            this.modeChoice = choice(
                "assembly mode",
                m.robot.ASSEMBLY_MODES.map(spoken),
                this.mode,
                (k) => {
                    this.mode = k;
                    this.takeJoints(this.q);
                },
            );
            made.append(this.modeChoice.row);
        }
        return made;
    }

    buildJoints() {
        const m = this.mechanism;
        this.jointSliders = m.joints.map((name, k) => {
            const told = m.info.joints?.[name] ?? {};
            const slide = m.slides[k];
            const most = 2.5 * Math.max(Math.abs(m.info.general[k]), Math.abs(m.info.home[k]), 0.2);
            return slider({
                label: told.label ?? name,
                title: name,
                unit: slide ? "" : "rad",
                min: slide ? 0 : -Math.PI,
                max: slide ? most : Math.PI,
                changed: (value) => this.takeJoints(this.q.with(k, value)),
            });
        });
        const home = button("home", () => this.takeJoints(m.info.home));
        const general = button("general", () => this.takeJoints(m.info.general));
        this.playing = button("play", () => this.play());
        const buttons = element("div", { class: "buttons" }, home, general, this.playing);
        return group("Joints", true, ...this.jointSliders.map((s) => s.row), buttons);
    }

    buildTarget() {
        const m = this.mechanism;
        const reach = this.view.radius;
        const named = m.places.map((place, k) => {
            const axis = m.robot.TASK.length === 16 ? k : "xyz".indexOf(m.robot.TASK[place]);
            return {
                name: "xyz"[axis],
                min: this.view.middle[axis] - reach,
                max: this.view.middle[axis] + reach,
                get: (x) => x[place],
                set: (x, v) => x.with(place, v),
            };
        });
        const rest = m.others.map((o) => ({ ...o, min: -Math.PI, max: Math.PI, unit: "rad" }));
        this.targetSliders = [...named, ...rest].map((coordinate) => ({
            ...coordinate,
            ...slider({
                label: coordinate.name,
                unit: coordinate.unit,
                min: coordinate.min,
                max: coordinate.max,
                changed: (value) => this.takeTarget(coordinate.set(this.x, value)),
            }),
        }));
        return group("Target", false, ...this.targetSliders.map((s) => s.row));
    }

    buildDimensions() {
        const m = this.mechanism;
        this.dimensionSliders = Object.keys(m.parameters).map((name) => {
            const told = m.info.parameters?.[name] ?? {};
            const value = m.robot.DEFAULTS[name];
            const most = value ? 2 * Math.abs(value) : m.size / 4;
            return slider({
                label: told.label ?? name,
                title: told.meaning,
                unit: told.unit,
                min: value < 0 ? -most : 0,
                max: most,
                changed: (v) => this.resizeTo({ [name]: v }),
            });
        });
        const reset = button("reset", () => this.resizeTo(m.robot.DEFAULTS));
        return group(
            "Dimensions",
            false,
            ...this.dimensionSliders.map((s) => s.row),
            element("div", { class: "buttons" }, reset),
        );
    }

    buildLayers() {
        const m = this.mechanism;
        const rows = [];
        this.boxes = {};
        const add = (key, label) => {
            const made = checkbox(label, this.layers[key], (on) => {
                this.layers[key] = on;
                this.changed();
            });
            this.boxes[key] = made.box;
            rows.push(made.row);
        };
        if (m.places.length > 1) {
            this.plane = m.info.view?.plane ?? (m.flat ? ["x", "y"] : ["x", "z"]);
            this.section = new Section(m, this.maps, this.view, this.plane);
            add("workspace", "workspace and singular curves");
            const measures = { conditioning: "conditioning (1/κ)", determinant: "determinant of the Jacobian" };
            if (this.section.measure) add("map", `map: ${measures[this.section.measure]}`);
        }
        if (m.joints.length > 1) {
            add("joints", "joint space");
            this.pair = [0, 1];
            this.jointPlane = new JointPlane(m);
            this.plot = element("canvas", { class: "joint-space", tabindex: 0, role: "img" });
            const names = m.joints.map((n) => m.info.joints?.[n]?.label ?? n);
            this.picks = [0, 1].map((k) =>
                choice(k ? "up" : "across", names, this.pair[k], (i) => {
                    this.pair[k] = i;
                    this.changed();
                }),
            );
            this.jointBox = element("div", {}, this.plot, ...this.picks.map((p) => p.row));
            rows.push(this.jointBox);
            this.listenToPlot();
        }
        add("trail", "path of the hand");
        add("names", "names of the points");
        this.mapNote = element("p", { class: "note" });
        return group("Layers", false, ...rows, this.mapNote);
    }

    buildPublished() {
        const labels = this.cases.map((c) => c.label);
        if (this.compared) labels.push("the mechanism as published");
        if (!labels.length) return [];
        const names = ["corrected", ...labels.map((label) => `published: ${label}`)];
        this.caseChoice = choice("show", names, 0, (k) => {
            this.case = k - 1;
            const chosen = this.cases[this.case];
            if (chosen?.at) this.takeJoints(chosen.at);
            else this.changed();
        });
        this.caseNote = element("p", { class: "note", role: "status" });
        this.caseLink = element("a", { hidden: true }, "What is wrong, and what follows");
        return [group("What the paper says", true, this.caseChoice.row, this.caseNote, this.caseLink)];
    }

    buildCopy() {
        const m = this.mechanism;
        const said = element("span", { role: "status" });
        const shown = element("pre", { tabindex: 0, hidden: true });
        const copy = (text) => async () => {
            shown.textContent = text();
            shown.hidden = false;
            try {
                await navigator.clipboard.writeText(text());
                said.textContent = "copied";
            } catch {
                said.textContent = "select the text to copy it";
            }
        };
        const numbers = () =>
            JSON.stringify(
                {
                    robot: m.info.name,
                    parameters: m.parameters,
                    target: this.x,
                    joints: this.q,
                    branches: this.found.map(({ name, status: s, q }) => ({ name, status: s, q })),
                },
                (_, v) => (Number.isNaN(v) ? null : v),
                1,
            );
        const languages = ["Python", "C", "JavaScript"].map((language) =>
            button(language, copy(() => lines(language, m, this.x, this.q))),
        );
        const buttons = element("div", { class: "buttons" }, button("numbers", copy(numbers)), ...languages, said);
        return group("Copy", false, buttons, shown);
    }

    /** Show all of the two postures of the page. */
    fit() {
        const { general, home } = this.mechanism.info;
        const found = [general, home].flatMap((q) => this.mechanism.points(q)).filter(Boolean);
        this.view.fit(found.flat());
    }

    // What a visitor does

    choose(k) {
        this.branch = k;
        this.meetings = [];
        this.takeTarget(this.x);
    }

    resizeTo(changes) {
        Object.assign(this.mechanism.parameters, changes);
        Object.assign(this.compared?.parameters ?? {}, changes);
        this.trail = [];
        this.meetings = [];
        this.takeJoints(this.q);
    }

    moveFree(value) {
        const found = this.mechanism.moved(this.x, this.q, this.freeIndex, value);
        if (!found) return;
        this.q = found;
        this.changed();
    }

    /** Move between the two postures of the page, until it is stopped. */
    play() {
        this.running = !this.running;
        this.playing.textContent = this.running ? "stop" : "play";
        const { home, general } = this.mechanism.info;
        const begin = performance.now();
        const step = (now) => {
            if (!this.running) return;
            const share = 0.5 - 0.5 * Math.cos((now - begin) / 1500);
            this.takeJoints(general.map((v, k) => v + 1.25 * share * (home[k] - v)));
            requestAnimationFrame(step);
        };
        if (this.running) requestAnimationFrame(step);
    }

    /** Move the hand by a step of space. */
    moveHand(step) {
        const m = this.mechanism;
        if (m.places.length > 1) {
            const x = [...(this.wanted ?? this.x)];
            m.places.forEach((place, k) => {
                const axis = m.robot.TASK.length === 16 ? k : "xyz".indexOf(m.robot.TASK[place]);
                x[place] += step[axis];
            });
            this.wanted = x;
            this.takeTarget(x);
        } else this.movePoint(m.hand, m.joints.map((_, k) => k), step);
    }

    /** Move a point of the mechanism by some joints, as far as they can. */
    movePoint(point, joints, step) {
        const m = this.mechanism;
        const rates = m.rates(this.q, this.mode, point);
        const length = (v) => v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        const total = joints.reduce((sum, k) => sum + length(rates[k]), 0) + 1e-9 * m.size ** 2;
        const q = [...this.q];
        for (const k of joints) {
            const pull = rates[k].reduce((sum, v, i) => sum + v * step[i], 0) / total;
            const most = m.slides[k] ? 0.2 * m.size : 0.35;
            q[k] += Math.min(Math.max(pull, -most), most);
            if (!m.slides[k]) q[k] = wrapped(q[k]);
        }
        if (m.fk(q)[this.mode]?.every(Number.isFinite)) this.takeJoints(q);
    }

    /** The joint that moves a point and is nearest to it in the mechanism, or -1. */
    jointOf(point) {
        const rates = this.mechanism.rates(this.q, this.mode, point);
        const far = rates.map((r) => Math.hypot(...r));
        const most = Math.max(...far);
        let found = -1;
        far.forEach((v, k) => {
            if (v > 0.05 * most && v > 1e-6 * this.mechanism.size) found = k;
        });
        return found;
    }

    listen() {
        const canvas = this.canvas;
        const fingers = new Map();
        let grabbed = null;
        const at = (event) => {
            const box = canvas.getBoundingClientRect();
            return [event.clientX - box.left, event.clientY - box.top];
        };
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            const place = at(event);
            fingers.set(event.pointerId, place);
            if (fingers.size === 1) grabbed = this.grab(place);
            this.held = grabbed?.hand;
            this.wanted = null;
            this.stop();
        });
        canvas.addEventListener("pointermove", (event) => {
            const place = at(event);
            const last = fingers.get(event.pointerId);
            if (!last) {
                const over = this.grab(place);
                canvas.style.cursor = over.hand || over.point >= 0 ? "grab" : this.view.flat ? "default" : "move";
                return;
            }
            fingers.set(event.pointerId, place);
            if (fingers.size === 2) {
                const [a, b] = [...fingers.values()];
                const [c] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
                const [now, then] = [Math.hypot(a[0] - b[0], a[1] - b[1]), Math.hypot(last[0] - c[0], last[1] - c[1])];
                this.view.zoom *= now / Math.max(then, 1);
                return this.changed();
            }
            this.drag(grabbed, place[0] - last[0], place[1] - last[1]);
        });
        const release = (event) => {
            fingers.delete(event.pointerId);
            if (fingers.size) return;
            this.held = false;
            this.wanted = null;
            if (!this.reached) this.takeJoints(this.q);
            this.changed();
        };
        canvas.addEventListener("pointerup", release);
        canvas.addEventListener("pointercancel", release);
        canvas.addEventListener("dblclick", () => {
            this.fit();
            this.changed();
        });
        canvas.addEventListener(
            "wheel",
            (event) => {
                if (!event.ctrlKey && document.activeElement !== canvas) return;
                event.preventDefault();
                this.view.zoom = Math.min(Math.max(this.view.zoom * Math.exp(-event.deltaY / 600), 0.2), 20);
                this.changed();
            },
            { passive: false },
        );
        canvas.addEventListener("keydown", (event) => this.key(event));
    }

    stop() {
        if (this.running) this.play();
    }

    key(event) {
        const { axes, radius } = this.view;
        const size = (event.shiftKey ? 0.002 : 0.02) * radius;
        const moves = {
            ArrowRight: [0, 1],
            ArrowLeft: [0, -1],
            ArrowUp: [1, 1],
            ArrowDown: [1, -1],
            PageUp: [2, -1],
            PageDown: [2, 1],
        };
        const count = this.mechanism.branches.length;
        if (event.key in moves) {
            const [axis, sign] = moves[event.key];
            this.held = true;
            this.moveHand(axes[axis].map((v) => sign * size * v));
            this.held = false;
            this.wanted = null;
            if (!this.reached) this.takeJoints(this.q);
        } else if (event.key === "[" || event.key === "]") {
            this.choose((this.branch + (event.key === "]" ? 1 : count - 1)) % count);
        } else return;
        event.preventDefault();
        event.stopPropagation();
    }

    /** What is below the pointer: the hand, another point, or nothing. */
    grab([px, py]) {
        const points = this.mechanism.points(this.q)[this.mode];
        if (!points) return { hand: false, point: -1 };
        const far = points.map((p) => {
            const [x, y] = this.view.project(p);
            return Math.hypot(x - px, y - py);
        });
        if (far[this.mechanism.hand] < 1.3 * GRAB) return { hand: true, point: this.mechanism.hand };
        const point = far.indexOf(Math.min(...far));
        if (far[point] > GRAB) return { hand: false, point: -1 };
        const joint = this.jointOf(point);
        return joint < 0 ? { hand: false, point: -1 } : { hand: false, point, joint };
    }

    drag(grabbed, dx, dy) {
        if (!grabbed) return;
        const step = this.view.unproject(dx, dy);
        if (grabbed.hand) this.moveHand(step);
        else if (grabbed.point >= 0) this.movePoint(grabbed.point, [grabbed.joint], step);
        else if (!this.view.flat) {
            this.view.azimuth -= 0.008 * dx;
            this.view.elevation = Math.min(Math.max(this.view.elevation + 0.008 * dy, -1.57), 1.57);
            this.changed();
        }
    }

    listenToPlot() {
        const take = (event) => {
            if (!event.buttons) return;
            const box = this.plot.getBoundingClientRect();
            const share = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
            const q = [...this.q];
            this.pair.forEach((joint, k) => {
                const [low, high] = this.jointPlane.range(joint);
                q[joint] = low + share[k] * (high - low);
            });
            this.takeJoints(q);
        };
        this.plot.addEventListener("pointerdown", (event) => {
            this.plot.setPointerCapture(event.pointerId);
            take(event);
        });
        this.plot.addEventListener("pointermove", take);
    }

    // The picture

    /** Something has changed: draw at the next frame. */
    changed() {
        if (this.pending) return;
        this.pending = requestAnimationFrame(() => {
            this.pending = 0;
            this.draw();
        });
    }

    draw() {
        const begin = performance.now();
        const { view, mechanism: m } = this;
        view.resize();
        if (!view.width) return;
        if (!view.zoom) this.fit();
        const style = getComputedStyle(this.place);
        const colour = (name) => style.getPropertyValue(name).trim();
        const [paper, ink, ground] = ["--explorer-paper", "--explorer-ink", "--explorer-ground"].map(colour);
        view.clear(paper);
        view.drawBase(ground);
        this.drawSection(view, ground);
        if (this.layers.trail && this.trail.length > 1) view.line(this.trail, { colour: ground, width: 1.5, alpha: 0.7 });
        const faint = m.info.faint ?? [];
        const common = { ground, paper, faint };
        for (const p of this.found ?? []) {
            if (p.index === this.branch || (p.status !== OK && p.status !== SINGULAR)) continue;
            const points = m.points(p.q)[p.mode];
            const tint = COLOURS[p.index % COLOURS.length];
            if (points) drawPosture(view, m.skeleton, points, { ...common, colour: tint, width: 2, alpha: 0.45, bare: true });
        }
        const modes = m.points(this.q);
        modes.forEach((points, k) => {
            if (points && k !== this.mode) {
                drawPosture(view, m.skeleton, points, { ...common, colour: ground, width: 2, alpha: 0.5, dash: [3, 5], bare: true });
            }
        });
        const own = modes[this.mode];
        if (own) {
            drawPosture(view, m.skeleton, own, { ...common, colour: COLOURS[this.branch % COLOURS.length] });
            if (this.layers.names) this.drawNames(view, own, ink);
        }
        this.drawPublished(view, { ...common, colour: WARNING });
        for (const { at } of this.meetings) view.dot(at, { colour: WARNING, fill: "transparent", radius: 8, width: 2 });
        if (!this.reached && m.places.length > 1) view.cross(this.position(this.x), WARNING);
        this.times.push(performance.now() - begin);
        if (this.times.length > 120) this.times.shift();
        this.show();
        if (this.section && !this.section.done) this.changed();
    }

    /** The position of a target in space. */
    position(x) {
        const { TASK } = this.mechanism.robot;
        const p = [0, 0, 0];
        this.mechanism.places.forEach((place, k) => (p[TASK.length === 16 ? k : "xyz".indexOf(TASK[place])] = x[place]));
        return p;
    }

    drawNames(view, points, colour) {
        const c = view.context;
        c.fillStyle = colour;
        c.font = "13px system-ui, sans-serif";
        this.mechanism.names.forEach((name, k) => {
            const [x, y] = view.project(points[k]);
            c.fillText(name, x + 8, y - 8);
        });
    }

    drawSection(view, ground) {
        const { section, layers } = this;
        if (!section || !(layers.workspace || layers.map)) return;
        const fixed = this.x.filter((_, k) => !section.axes.includes(k));
        const { map, workspace } = layers;
        const of = JSON.stringify([fixed, this.branch, this.mechanism.parameters, map, workspace]);
        if (of !== this.sectionOf) {
            this.sectionOf = of;
            section.start(this.x, this.branch, COARSE, layers);
        }
        section.step(FRAME);
        if (section.done && section.size === COARSE && !this.held) {
            section.start(this.x, this.branch, FINE, layers);
        }
        section.draw(view, layers, { border: ground, curve: WARNING });
    }

    drawPublished(view, style) {
        if (!this.caseNote) return;
        this.caseNote.textContent = "";
        this.caseLink.hidden = true;
        const m = this.mechanism;
        const chosen = this.cases[this.case];
        const show = (points, said) => {
            if (points) drawPosture(view, m.skeleton, points, { ...style, dash: [7, 5], width: 3 });
            this.caseNote.textContent = said;
        };
        if (chosen) {
            const found = chosen.postures(this.q, this.x, m.parameters);
            const misses = found.map((q) => {
                const points = m.points(q)[this.mode];
                const here = m.points(this.q)[this.mode];
                if (!points || !here) return { points, miss: Infinity };
                return { points, miss: Math.hypot(...points[m.hand].map((v, k) => v - here[m.hand][k])) };
            });
            const best = misses.reduce((a, b) => (b.miss < a.miss ? b : a));
            const unit = Object.values(m.info.parameters ?? {})[0]?.unit ?? "";
            const said = Number.isFinite(best.miss)
                ? `The hand is ${short(best.miss)} ${unit} from the target.`
                : "The formula has no real value here.";
            show(best.points, `${said} Verdict: ${chosen.verdict}.`);
            this.caseLink.hidden = false;
            this.caseLink.href = `#erratum-${m.info.name}-${chosen.erratum}`;
        } else if (this.case >= this.cases.length && this.compared) {
            const other = this.compared.postures(this.x).find((p) => p.status === OK);
            const points = other && m.points(other.q)[0];
            const here = m.points(this.q)[0];
            const miss = points && here && Math.hypot(...points[m.hand].map((v, k) => v - here[m.hand][k]));
            show(points, points ? `The hand is ${short(miss)} from the target.` : "It does not reach the target.");
        }
    }

    drawPlot() {
        if (!this.jointPlane) return;
        this.jointBox.hidden = !this.layers.joints;
        if (!this.layers.joints) return;
        const { plot, jointPlane, pair, mechanism: m } = this;
        const size = plot.clientWidth || 240;
        const ratio = window.devicePixelRatio || 1;
        if (plot.width !== Math.round(size * ratio)) plot.width = plot.height = Math.round(size * ratio);
        const rest = this.q.filter((_, k) => !pair.includes(k));
        const of = JSON.stringify([rest, this.mode, pair, m.parameters]);
        if (of !== this.plotOf) {
            this.plotOf = of;
            jointPlane.compute(this.q, this.mode, pair);
        }
        const c = plot.getContext("2d");
        const style = getComputedStyle(this.place);
        c.setTransform(1, 0, 0, 1, 0, 0);
        c.fillStyle = style.getPropertyValue("--explorer-paper").trim();
        c.fillRect(0, 0, plot.width, plot.height);
        c.save();
        c.translate(0, plot.height);
        c.scale(plot.width / jointPlane.image.width, -plot.height / jointPlane.image.height);
        c.imageSmoothingEnabled = false;
        c.drawImage(jointPlane.image, 0, 0);
        c.restore();
        const scale = plot.width / jointPlane.size;
        c.strokeStyle = WARNING;
        c.lineWidth = 1.5 * ratio;
        c.beginPath();
        for (const [x, y, u, v] of jointPlane.curves) {
            c.moveTo(x * scale, plot.height - y * scale);
            c.lineTo(u * scale, plot.height - v * scale);
        }
        c.stroke();
        const mark = (q, colour, radius) => {
            const [x, y] = pair.map((joint) => {
                const [low, high] = jointPlane.range(joint);
                return (q[joint] - low) / (high - low);
            });
            c.beginPath();
            c.arc(x * plot.width, (1 - y) * plot.height, radius * ratio, 0, 2 * Math.PI);
            c.fillStyle = colour;
            c.fill();
        };
        for (const p of this.found) {
            if (p.status === OK) mark(p.q, COLOURS[p.index % COLOURS.length], 3);
        }
        mark(this.q, COLOURS[this.branch % COLOURS.length], 6);
        const names = pair.map((k) => m.info.joints?.[m.joints[k]]?.label ?? m.joints[k]);
        plot.setAttribute("aria-label", `Joint space: ${names[0]} across, ${names[1]} up; singular curves in red.`);
    }

    /** Bring the controls and the words up to what is seen. */
    show() {
        const m = this.mechanism;
        this.jointSliders.forEach((s, k) => s.show(this.q[k]));
        if (this.x) this.targetSliders.forEach((s) => s.show(s.get(this.x)));
        this.dimensionSliders.forEach((s, k) => s.show(Object.values(m.parameters)[k]));
        if (this.modeChoice) this.modeChoice.select.selectedIndex = this.mode;
        const own = this.found?.[this.branch];
        const singular = own?.status === SINGULAR;
        this.freeIndex = singular ? m.freeJoint(this.x, own.q) : -1;
        this.free.row.hidden = this.freeIndex < 0;
        const free = this.freeIndex >= 0 ? (m.info.joints?.[m.joints[this.freeIndex]]?.label ?? m.joints[this.freeIndex]) : "";
        if (free) {
            this.free.row.querySelector("label").textContent = `${free}, free`;
            this.free.show(this.q[this.freeIndex]);
        }
        this.legend.forEach(({ choose, note }, k) => {
            const p = this.found?.[k];
            note.textContent = p ? status(p, k === this.branch ? free : "") : "";
            choose.setAttribute("aria-pressed", String(k === this.branch));
            choose.classList.toggle("lost", p?.status === UNREACHABLE);
        });
        this.tell(own, free);
        this.drawPlot();
        if (this.mapNote && this.section) {
            const on = this.layers.workspace || this.layers.map;
            const text = `Section through the hand: ${this.plane.join(" and ")}. Curves in red: singular; grey: the border.`;
            const { size, milliseconds, done } = this.section;
            const took = done ? ` ${size}×${size} postures in ${Math.round(milliseconds)} ms.` : "";
            this.mapNote.textContent = on ? text + took : "";
        }
        clearTimeout(this.saving);
        if (this.touched) this.saving = setTimeout(() => write(this), 300);
        this.touched = true;
    }

    /** Say in words what is seen, not at every frame. */
    tell(own, free) {
        const m = this.mechanism;
        const met = this.meetings.at(-1)?.said;
        const hand = m.places.map((k) => short(this.x?.[k])).join(", ");
        const where = m.places.length ? `Hand at (${hand}). ` : "";
        const invalid = this.found?.every((p) => p.status === 3);
        const text = invalid
            ? "These dimensions are impossible."
            : this.reached
              ? `${where}${own ? `${spoken(own.name)}: ${status(own, free)}.` : ""}${met ? ` ${met}.` : ""}`
              : `Out of reach.${met ? ` ${met}.` : ""}`;
        clearTimeout(this.telling);
        this.telling = setTimeout(() => {
            if (this.say.textContent !== text) this.say.textContent = text;
        }, 120);
    }

    restore(saved) {
        const m = this.mechanism;
        for (const [name, value] of Object.entries(saved.parameters)) {
            if (name in m.parameters) m.parameters[name] = value;
        }
        if (saved.q?.length !== m.joints.length) delete saved.q;
        this.mode = Math.min(saved.mode ?? this.mode, m.modes - 1);
        Object.assign(this.layers, saved.layers);
        for (const [key, box] of Object.entries(this.boxes)) box.checked = this.layers[key];
        if (saved.pair?.every((k) => k < m.joints.length) && this.pair) {
            this.pair = saved.pair;
            this.picks.forEach((p, k) => (p.select.selectedIndex = saved.pair[k]));
        }
        if (this.caseChoice && saved.case + 1 < this.caseChoice.select.length) {
            this.case = saved.case;
            this.caseChoice.select.selectedIndex = saved.case + 1;
        }
        if (saved.camera.zoom) Object.assign(this.view, saved.camera);
        this.takeJoints(saved.q ?? this.q);
        if (saved.branch !== undefined && saved.branch < m.branches.length && saved.branch !== this.branch) {
            this.choose(saved.branch);
        }
    }
}
