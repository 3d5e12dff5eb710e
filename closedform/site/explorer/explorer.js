/** The explorer of a mechanism: drag the hand or a joint, and all branches of the inverse follow. */

import { element } from "./controls.js";
import { listen } from "./input.js";
import { Meetings } from "./meetings.js";
import { Mechanism, SINGULAR, reaches, wrapped } from "./mechanism.js";
import { Panel } from "./panel.js";
import { drawPicture } from "./picture.js";
import { Published } from "./published.js";
import { Section } from "./section.js";
import { read, write } from "./state.js";
import { View } from "./view.js";

const TRAIL = 400;
const FRAME = 10; // milliseconds for a map in each frame
const [COARSE, FINE] = [90, 300];

/** Show the explorer in every element of a robot. */
export function mountAll(name, modules) {
    for (const place of document.querySelectorAll(`.explorer[data-robot="${name}"]`)) {
        const info = JSON.parse(place.querySelector(".explorer-info").textContent);
        place.explorer = new Explorer(place, info, modules);
    }
}

/** The state of an explorer, and what a visitor can do to it. */
export class Explorer {
    /**
     * @param {HTMLElement} place
     * @param {any} info what the page says of the mechanism
     * @param {any} modules the printed code
     */
    constructor(place, info, { robot, nearest, maps, other = null, cases = [] }) {
        this.place = place;
        const m = (this.mechanism = new Mechanism(robot, nearest, info));
        this.model = other && new Mechanism(other, nearest, info);
        this.layers = { workspace: false, map: false, joints: false, trail: true, names: false };
        this.meetings = new Meetings(m);
        this.case = -1;
        this.pair = m.joints.length > 1 ? [0, 1] : null;
        this.trail = [];
        this.times = [];
        this.q = [...info.general];
        this.mode = info.mode ?? 0;
        this.branch = 0;
        this.free = -1;
        this.build(maps, cases);
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

    /** Put the picture and the controls on the page. */
    build(maps, cases) {
        const m = this.mechanism;
        this.canvas = element("canvas", {
            tabindex: 0,
            role: "application",
            "aria-label":
                `${m.info.title}. Arrow keys move the hand, with shift in small steps; page up and page down ` +
                "move it in depth; square brackets change the branch.",
        });
        this.view = new View(this.canvas, m.extent(), m.flat);
        if (maps) {
            this.plane = m.info.plane ?? (m.flat ? ["x", "y"] : ["x", "z"]);
            this.section = new Section(m, maps, this.view, this.plane);
        }
        if (cases.length || this.model) this.published = new Published(this, cases, this.model);
        this.panel = new Panel(this);
        const notes = [...this.place.childNodes].filter((n) => n.nodeName === "SCRIPT");
        const turning = m.flat ? "" : ", or the background to turn the view";
        const hint = `Drag the hand or a joint${turning}. Keys: arrows move the hand, [ and ] change the branch.`;
        const help = element("p", { class: "hint" }, hint);
        const picture = element("div", { class: "picture" }, this.canvas, help, this.panel.say);
        this.place.replaceChildren(...notes, picture, this.panel.element);
        listen(this);
    }

    // What is seen

    /** Take joints: the hand follows. */
    takeJoints(q) {
        const x = this.mechanism.fk(q)[this.mode];
        this.q = [...q];
        this.reached = Boolean(x?.every(Number.isFinite));
        if (this.reached) {
            this.mechanism.takeGiven(q);
            this.aim(x);
            const gaps = this.found.map((p) => (reaches(p.status) ? this.mechanism.apart(p.q, q) : Infinity));
            const least = Math.min(...gaps);
            if (least < Infinity) this.branch = gaps.indexOf(least);
            this.findFree();
            this.follow();
        }
        this.changed();
    }

    /** Take a target: the current branch follows, or the hand stays where it was. */
    takeTarget(x) {
        const before = { x: this.x, q: this.q, mode: this.mode, reached: this.reached };
        this.aim(x);
        this.findFree();
        const own = this.found[this.branch];
        this.reached = reaches(own.status);
        if (this.reached) {
            if (before.x && this.held) this.meetings.between(before.q, before.mode, this.found, this.branch);
            this.q = this.keepFree(own, before.q);
            this.mode = own.mode;
            this.follow();
        } else if (before.reached && this.held) this.meetings.atBorder(before.x, x, before.mode, this.branch);
        this.changed();
    }

    /** Find all postures of a target. */
    aim(x) {
        this.x = [...x];
        this.found = this.mechanism.postures(x);
    }

    /** Find the joint that is free in the branch, or -1. */
    findFree() {
        const own = this.found[this.branch];
        this.free = own.status === SINGULAR ? this.mechanism.freeJoint(this.x, own.q) : -1;
    }

    /** A free joint keeps its value, as long as the hand stays at the target. */
    keepFree(own, before) {
        const kept = this.free >= 0 && this.mechanism.moved(this.x, own.q, this.free, before[this.free]);
        return kept || own.q;
    }

    follow() {
        const points = this.mechanism.drawn(this.q)[this.mode];
        if (!points) return;
        this.trail.push(points[this.mechanism.hand]);
        if (this.trail.length > TRAIL) this.trail.shift();
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

    // What a visitor does

    choose(branch) {
        this.branch = branch;
        this.meetings.clear();
        this.takeTarget(this.x);
    }

    chooseMode(mode) {
        this.mode = mode;
        this.takeJoints(this.q);
    }

    resizeTo(changes) {
        Object.assign(this.mechanism.parameters, changes);
        Object.assign(this.model?.parameters ?? {}, changes);
        this.trail = [];
        this.meetings.clear();
        this.takeJoints(this.q);
    }

    /** Give another value besides the target; the hand keeps its place. */
    give(value) {
        this.mechanism.given = value;
        this.meetings.clear();
        this.takeTarget(this.x);
    }

    moveFree(value) {
        const found = this.mechanism.moved(this.x, this.q, this.free, value);
        if (!found) return;
        this.q = found;
        this.changed();
    }

    /** Move between the two postures of the page, until it is stopped. */
    play() {
        this.running = !this.running;
        const { home, general } = this.mechanism.info;
        const begin = performance.now();
        const step = (now) => {
            if (!this.running) return;
            const share = 0.5 - 0.5 * Math.cos((now - begin) / 1500);
            this.takeJoints(general.map((v, k) => v + 1.25 * share * (home[k] - v)));
            requestAnimationFrame(step);
        };
        if (this.running) requestAnimationFrame(step);
        this.changed();
    }

    stop() {
        if (this.running) this.play();
    }

    /** Move the hand by a step of space. */
    moveHand(step) {
        const m = this.mechanism;
        if (this.section) {
            const x = [...(this.wanted ?? this.x)];
            m.places.forEach((place, k) => (x[place] += step[m.axes[k]]));
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

    /** The hand is let go: if the target is out of reach, it goes back to where the hand is. */
    release() {
        this.held = false;
        this.wanted = null;
        if (!this.reached) this.takeJoints(this.q);
        this.changed();
    }

    /** Show all of the two postures of the page. */
    fit() {
        const { general, home } = this.mechanism.info;
        const found = [general, home].flatMap((q) => this.mechanism.drawn(q)).filter(Boolean);
        this.view.fit(found.flat());
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
        this.view.resize();
        if (!this.view.width) return;
        if (!this.view.zoom) this.fit();
        this.computeSection();
        drawPicture(this);
        this.times.push(performance.now() - begin);
        if (this.times.length > 120) this.times.shift();
        this.panel.show();
        this.save();
        if (this.section && !this.section.done) this.changed();
    }

    /** Compute a part of the map: first a coarse one, and a fine one once the hand is let go. */
    computeSection() {
        const { section, layers } = this;
        if (!section || !(layers.workspace || layers.map)) return;
        const fixed = this.x.filter((_, k) => !section.axes.includes(k));
        const { map, workspace } = layers;
        const { parameters, given } = this.mechanism;
        const of = JSON.stringify([fixed, given, this.branch, parameters, map, workspace]);
        if (of !== this.sectionOf) {
            this.sectionOf = of;
            section.start(this.x, this.branch, COARSE, layers);
        }
        section.step(FRAME);
        if (section.done && section.size === COARSE && !this.held) {
            section.start(this.x, this.branch, FINE, layers);
        }
    }

    // The address of the page

    /** Write the state to the address, but not at every frame, and not before anything has changed. */
    save() {
        clearTimeout(this.saving);
        if (this.touched) this.saving = setTimeout(() => write(this), 300);
        this.touched = true;
    }

    restore(saved) {
        const m = this.mechanism;
        for (const [name, value] of Object.entries(saved.parameters)) {
            if (name in m.parameters) m.parameters[name] = value;
        }
        if (saved.q?.length !== m.joints.length) delete saved.q;
        this.mode = Math.min(saved.mode ?? this.mode, m.modes - 1);
        Object.assign(this.layers, saved.layers);
        if (this.pair && saved.pair?.every((k) => k < m.joints.length)) this.pair = saved.pair;
        if (saved.case >= 0 && saved.case < this.published?.count) this.case = saved.case;
        if (saved.camera.zoom) Object.assign(this.view, saved.camera);
        this.takeJoints(saved.q ?? this.q);
        if (saved.branch !== undefined && saved.branch < m.branches.length && saved.branch !== this.branch) {
            this.choose(saved.branch);
        }
    }
}
