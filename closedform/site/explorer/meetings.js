/** Where branches meet, and where a singularity is crossed, while the hand moves. */

import { OK, reaches } from "./mechanism.js";

const BISECTIONS = 30;
const MEETS = 0.03; // rad, or of the size
const KEPT = 8;

export class Meetings {
    /** @param {import("./mechanism.js").Mechanism} mechanism */
    constructor(mechanism) {
        this.mechanism = mechanism;
        this.clear();
    }

    clear() {
        /** The places of the hand, and what is said of them; the last is the newest. */
        this.found = [];
    }

    /** What is said of the last one. */
    get last() {
        return this.found.at(-1)?.said;
    }

    /** Mark where, from one posture to the next, the branch meets another or passes a singularity. */
    between(before, mode, postures, branch) {
        const m = this.mechanism;
        const own = postures[branch];
        const [f, g] = [m.factors(before, mode), m.factors(own.q, own.mode)];
        const crossed = f.findIndex((v, k) => v * g[k] < 0);
        const other = postures.find((p) => p !== own && p.status === OK && m.apart(p.q, own.q) < MEETS);
        if (!other && crossed < 0) return;
        const near = g.map((v, k) => Math.abs(v) / m.scales[k]);
        const factor = crossed >= 0 ? crossed : near.indexOf(Math.min(...near));
        const where = `singular: ${m.robot.SINGULARITIES[factor]}`;
        const said = other ? `${m.spoken(own.name)} meets ${m.spoken(other.name)}, ${where}` : `Crossed, ${where}`;
        if (said === this.last) return;
        this.found.push({ at: m.drawn(own.q)[own.mode][m.hand], said });
        if (this.found.length > KEPT) this.found.shift();
    }

    /** Mark the last place on the way to a target out of reach, where branches meet. */
    atBorder(inside, outside, mode, branch) {
        const m = this.mechanism;
        const between = (share) => inside.map((v, k) => v + share * (outside[k] - v));
        let [low, high] = [0, 1];
        for (let k = 0; k < BISECTIONS; k++) {
            const middle = (low + high) / 2;
            if (reaches(m.postures(between(middle))[branch].status)) low = middle;
            else high = middle;
        }
        const postures = m.postures(between(low));
        this.between(postures[branch].q, mode, postures, branch);
    }
}
