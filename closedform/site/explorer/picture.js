/** The picture: all postures, the map below them, and what is marked. */

import { WARNING, branchColour, colourOf } from "./colours.js";
import { reaches } from "./mechanism.js";
import { drawPosture } from "./view.js";

/**
 * Draw what an explorer shows.
 *
 * @param {import("./explorer.js").Explorer} explorer
 */
export function drawPicture(explorer) {
    const { view, mechanism: m, layers } = explorer;
    const [paper, ink, ground] = ["paper", "ink", "ground"].map((name) => colourOf(explorer.place, name));
    const common = { ground, paper, faint: m.info.faint ?? [] };
    view.clear(paper);
    view.drawBase(ground);
    explorer.section?.draw(view, layers, { border: ground, curve: WARNING });
    if (layers.trail && explorer.trail.length > 1) {
        view.line(explorer.trail, { colour: ground, width: 1.5, alpha: 0.7 });
    }
    drawBranches(explorer, common);
    const own = drawModes(explorer, common);
    if (own && layers.names) drawNames(explorer, own, ink);
    explorer.published?.draw(view, { ...common, colour: WARNING });
    for (const { at } of explorer.meetings.found) {
        view.dot(at, { colour: WARNING, fill: "transparent", radius: 8, width: 2 });
    }
    if (!explorer.reached && m.places.length > 1) view.cross(m.position(explorer.x), WARNING);
}

/** The other branches, as thin lines. */
function drawBranches({ view, mechanism: m, found, branch }, common) {
    for (const p of found ?? []) {
        if (p.index === branch || !reaches(p.status)) continue;
        const points = m.points(p.q)[p.mode];
        const style = { ...common, colour: branchColour(p.index), width: 2, alpha: 0.45, bare: true };
        if (points) drawPosture(view, m.skeleton, points, style);
    }
}

/** The own posture, and dotted the other assembly modes; the points of the own one. */
function drawModes({ view, mechanism: m, q, mode, branch }, common) {
    const modes = m.points(q);
    const other = { ...common, colour: common.ground, width: 2, alpha: 0.5, dash: [3, 5], bare: true };
    modes.forEach((points, k) => {
        if (points && k !== mode) drawPosture(view, m.skeleton, points, other);
    });
    const own = modes[mode];
    if (own) drawPosture(view, m.skeleton, own, { ...common, colour: branchColour(branch) });
    return own;
}

function drawNames({ view, mechanism: m }, points, colour) {
    const c = view.context;
    c.fillStyle = colour;
    c.font = "13px system-ui, sans-serif";
    m.names.forEach((name, k) => {
        const [x, y] = view.project(points[k]);
        c.fillText(name, x + 8, y - 8);
    });
}
