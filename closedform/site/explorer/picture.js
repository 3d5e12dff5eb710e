/** The picture: all postures, the map below them, and what is marked. */

import { WARNING, branchColour, colourOf } from "./colours.js";
import { distance, reaches } from "./mechanism.js";
import { drawPosture } from "./view.js";

const NAME = [7, 14]; // pixels: the width of a letter of a name, and its height
const HAND = 0.13; // the length of the axes of the hand, as a share of the picture

/**
 * Draw what an explorer shows.
 *
 * @param {import("./explorer.js").Explorer} explorer
 */
export function drawPicture(explorer) {
    const { view, mechanism: m, layers } = explorer;
    const [paper, ink, ground] = ["paper", "ink", "ground"].map((name) => colourOf(explorer.place, name));
    const common = { ground, paper };
    view.clear(paper);
    view.drawBase(ground);
    explorer.section?.draw(view, layers, { border: ground, curve: WARNING });
    if (layers.trail && explorer.trail.length > 1) {
        view.line(explorer.trail, { colour: ground, width: 1.5, alpha: 0.7 });
    }
    drawSphere(explorer, ground);
    drawBranches(explorer, common);
    const own = drawModes(explorer, common);
    const axes = own && m.handAxes(explorer.x);
    if (axes) drawHand(view, own[m.hand], axes, ground);
    if (own && layers.names) drawNames(explorer, own, ink);
    explorer.published?.draw(view, { ...common, colour: WARNING });
    for (const { at } of explorer.meetings.found) {
        view.dot(at, { colour: WARNING, fill: "transparent", radius: 8, width: 2 });
    }
    if (!explorer.reached && m.places.length > 1) view.cross(m.position(explorer.x), WARNING);
}

/** The outline of the sphere of a spherical mechanism. */
function drawSphere({ view, mechanism: m, q, mode }, colour) {
    const points = m.drawn(q)[mode];
    const centre = points?.[m.names.indexOf(m.info.about)];
    if (centre) view.sphere(centre, Math.max(...points.map((p) => distance(p, centre))), colour);
}

/** The other branches, as thin lines. */
function drawBranches({ view, mechanism: m, found, branch }, common) {
    for (const p of found ?? []) {
        if (p.index === branch || !reaches(p.status)) continue;
        const points = m.drawn(p.q)[p.mode];
        const style = { ...common, colour: branchColour(p.index), width: 2, alpha: 0.45, bare: true };
        if (points) drawPosture(view, m, points, style);
    }
}

/** The own posture, and dotted the other assembly modes; the points of the own one. */
function drawModes({ view, mechanism: m, q, mode, branch }, common) {
    const modes = m.drawn(q);
    const other = { ...common, colour: common.ground, width: 2, alpha: 0.5, dash: [3, 5], bare: true };
    modes.forEach((points, k) => {
        if (points && k !== mode) drawPosture(view, m, points, other);
    });
    const own = modes[mode];
    if (own) drawPosture(view, m, own, { ...common, colour: branchColour(branch) });
    return own;
}

/** The axes of the hand, which show how it is turned. */
function drawHand(view, at, axes, colour) {
    axes.forEach((axis, k) => {
        const along = (share) => at.map((v, i) => v + share * HAND * view.radius * axis[i]);
        view.line([at, along(1)], { colour, width: 1.4 });
        const [x, y] = view.project(along(1.25));
        view.name("xyz"[k], [x - 3, y + 4], colour);
    });
}

/** Whether two boxes have a common part: left, top, right and bottom. */
const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

/** The names of the points, where they do not cover each other. */
function drawNames({ view, mechanism: m }, points, colour) {
    const taken = [];
    m.names.forEach((name, k) => {
        const [x, y] = view.project(points[k]);
        const width = NAME[0] * name.length;
        const places = [[8, -8], [8, 16], [-8 - width, -8], [-8 - width, 16], [8, -22], [8, 30]];
        const boxes = places.map(([dx, dy]) => [x + dx, y + dy, x + dx + width, y + dy + NAME[1]]);
        const free = boxes.find((box) => !taken.some((other) => overlap(box, other))) ?? boxes[0];
        taken.push(free);
        view.name(name, free, colour);
    });
}
