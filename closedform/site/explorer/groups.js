/**
 * The groups of controls: each makes its element once, and `show` brings it up to the explorer.
 *
 * @typedef {{ element: HTMLElement, show(): void }} Group
 * @typedef {import("./explorer.js").Explorer} Explorer
 */

import { branchColour } from "./colours.js";
import { button, checkbox, choice, element, group, slider } from "./controls.js";
import { JointPlot } from "./joint-space.js";
import { UNREACHABLE } from "./mechanism.js";
import { TransferPlot } from "./transfer.js";
import { lines, numbers, status } from "./words.js";

const MEASURES = { conditioning: "conditioning (1/κ)", determinant: "determinant of the Jacobian" };

/** @param {Explorer} explorer @returns {Group} */
export function branches(explorer) {
    const m = explorer.mechanism;
    const legend = m.branches.map((name, k) => {
        const note = element("small");
        const swatch = element("span", { class: "swatch" });
        swatch.style.background = branchColour(k);
        const choose = button("", () => explorer.choose(k), { class: "branch" });
        choose.append(swatch, m.spoken(name), " ", note);
        return { choose, note };
    });
    const free = slider({
        label: "free joint",
        min: -Math.PI,
        max: Math.PI,
        changed: (value) => explorer.moveFree(value),
    });
    const made = group("Branches", true, ...legend.map((e) => e.choose), free.row);
    const names = m.modes > 1 && m.robot.ASSEMBLY_MODES.map((name) => m.spoken(name));
    const mode = names && choice("assembly mode", names, explorer.mode, (k) => explorer.chooseMode(k));
    if (mode) made.append(mode.row);
    const show = () => {
        if (mode) mode.select.selectedIndex = explorer.mode;
        free.row.hidden = explorer.free < 0;
        const name = explorer.free < 0 ? "" : m.label(explorer.free);
        if (name) {
            free.call({ ...m.written(explorer.free), note: ", free" });
            free.show(explorer.q[explorer.free]);
        }
        legend.forEach(({ choose, note }, k) => {
            const p = explorer.found?.[k];
            note.textContent = p ? status(p, k === explorer.branch ? name : "") : "";
            choose.setAttribute("aria-pressed", String(k === explorer.branch));
            choose.classList.toggle("lost", p?.status === UNREACHABLE);
        });
    };
    return { element: made, show };
}

/** @param {Explorer} explorer @returns {Group} */
export function joints(explorer) {
    const m = explorer.mechanism;
    const sliders = m.joints.map((name, k) => {
        return slider({
            ...m.written(k),
            title: name,
            ...rangeOf(m, k),
            changed: (value) => explorer.takeJoints(explorer.q.with(k, value)),
        });
    });
    const home = button("home", () => explorer.takeJoints(m.info.home));
    const general = button("general", () => explorer.takeJoints(m.info.general));
    const playing = button("play", () => explorer.play());
    const buttons = element("div", { class: "buttons" }, home, general, playing);
    const show = () => {
        sliders.forEach((s, k) => s.show(explorer.q[k]));
        playing.textContent = explorer.running ? "stop" : "play";
    };
    return { element: group("Joints", true, ...sliders.map((s) => s.row), buttons), show };
}

/** @param {Explorer} explorer @returns {Group} */
export function target(explorer) {
    const { mechanism: m, view } = explorer;
    const take = (x) => {
        const [there, here] = [x, explorer.x].map((v) => m.position(v));
        if (m.onSurface) explorer.moveHand(there.map((v, k) => v - here[k]));
        else explorer.takeTarget(x);
    };
    const position = m.places.map((place, k) => ({
        label: "xyz"[m.axes[k]],
        formula: `<math><mi>${"xyz"[m.axes[k]]}</mi></math>`,
        unit: m.unit,
        min: view.middle[m.axes[k]] - view.radius,
        max: view.middle[m.axes[k]] + view.radius,
        get: (x) => x[place],
        set: (x, v) => x.with(place, v),
    }));
    const rest = m.others.map((o) => ({ ...o, min: -Math.PI, max: Math.PI, unit: "rad" }));
    const sliders = [...position, ...rest].map(({ get, set, ...written }) => {
        const changed = (value) => take(set(explorer.x, value));
        return { get, ...slider({ ...written, changed }) };
    });
    if (m.robot.GIVEN !== undefined) sliders.unshift({ get: () => m.given, ...given(explorer) });
    const show = () => {
        if (explorer.x) sliders.forEach((s) => s.show(s.get(explorer.x)));
    };
    const open = m.robot.GIVEN !== undefined;
    return { element: group("Target", open, ...sliders.map((s) => s.row)), show };
}

/** What the inverse takes besides the target: it moves the mechanism while the hand stands still. */
function given(explorer) {
    const { joints, robot, info } = explorer.mechanism;
    const joint = joints.indexOf(robot.GIVEN);
    return slider({
        ...info.given,
        title: `${robot.GIVEN}: the hand stands still`,
        ...rangeOf(explorer.mechanism, joint),
        changed: (value) => explorer.give(value),
    });
}

/** The range of a joint, or of another angle, and its unit. */
function rangeOf(m, joint) {
    if (!m.slides[joint]) return { unit: "rad", min: -Math.PI, max: Math.PI };
    const most = 2.5 * Math.max(Math.abs(m.info.general[joint]), Math.abs(m.info.home[joint]), 0.2);
    return { unit: m.unit, min: 0, max: most };
}

/** @param {Explorer} explorer @returns {Group} */
export function dimensions(explorer) {
    const m = explorer.mechanism;
    const sliders = Object.keys(m.parameters).map((name) => {
        const told = m.info.parameters?.[name] ?? {};
        const value = m.robot.DEFAULTS[name];
        const most = value ? 2 * Math.abs(value) : m.size / 4;
        return slider({
            label: told.label ?? name,
            formula: told.formula,
            title: told.meaning,
            unit: told.unit,
            min: value < 0 ? -most : 0,
            max: most,
            changed: (v) => explorer.resizeTo({ [name]: v }),
        });
    });
    const reset = button("reset", () => explorer.resizeTo(m.robot.DEFAULTS));
    const buttons = element("div", { class: "buttons" }, reset);
    const show = () => sliders.forEach((s, k) => s.show(Object.values(m.parameters)[k]));
    return { element: group("Dimensions", false, ...sliders.map((s) => s.row), buttons), show };
}

/** @param {Explorer} explorer @returns {Group & { plot: import("./plot.js").Plot }} */
export function layers(explorer) {
    const { section, mechanism: m } = explorer;
    const boxes = new Map();
    const box = (key, label) => {
        const made = checkbox(label, explorer.layers[key], (on) => {
            explorer.layers[key] = on;
            explorer.changed();
        });
        boxes.set(key, made.box);
        return made.row;
    };
    const rows = [];
    if (section) {
        rows.push(box("workspace", "workspace and singular curves"));
        if (section.measure) rows.push(box("map", `map: ${MEASURES[section.measure]}`));
    } else rows.push(element("p", { class: "note" }, withoutSection(m)));
    const plot = explorer.pair ? new JointPlot(explorer) : new TransferPlot(explorer);
    const shown = explorer.pair ? "joint space" : `${m.coordinate(0)} over ${m.label(0)}`;
    rows.push(box("joints", shown), plot.element);
    rows.push(box("trail", "path of the hand"), box("names", "names of the points"));
    const note = element("p", { class: "note" });
    const show = () => {
        for (const [key, made] of boxes) made.checked = explorer.layers[key];
        plot.show();
        const on = section && (explorer.layers.workspace || explorer.layers.map);
        note.textContent = on ? ofSection(explorer) : "";
    };
    return { element: group("Layers", false, ...rows, note), show, plot };
}

/** Why there is no section of the workspace, and where else to look. */
function withoutSection(m) {
    const because = "There is no section of the workspace, because a target is";
    const instead = "The joint space shows where the mechanism is singular.";
    if (m.onSurface) return `${because} a place on a surface. ${instead}`;
    if (m.robot.TASK.length === 9) return `${because} an orientation and not a place. ${instead}`;
    return `${because} one number (${m.coordinate(0)}) and not a place. It is drawn over ${m.label(0)} instead.`;
}

function ofSection({ section, plane, layers: { map } }) {
    const { size, milliseconds, done } = section;
    const colours = map ? " Map: dark is near a singularity, bright is far from it." : "";
    const text = `Section through the hand: ${plane.join(" and ")}. Curves in red: singular; grey: the border.${colours}`;
    return done ? `${text} ${size}×${size} postures in ${Math.round(milliseconds)} ms.` : text;
}

/** @param {Explorer} explorer @returns {Group} */
export function copies(explorer) {
    const m = explorer.mechanism;
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
    const languages = ["Python", "C", "JavaScript"].map((language) =>
        button(language, copy(() => lines(language, m, explorer.x, explorer.q))),
    );
    const first = button("numbers", copy(() => numbers(explorer)));
    const buttons = element("div", { class: "buttons" }, first, ...languages, said);
    return { element: group("Copy", false, buttons, shown), show: () => {} };
}
