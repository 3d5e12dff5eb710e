/** What the paper says: postures by its formulas or of its model, beside the right ones. */

import { choice, element, group } from "./controls.js";
import { OK } from "./mechanism.js";
import { drawPosture } from "./view.js";
import { short } from "./words.js";

export class Published {
    /**
     * @param {import("./explorer.js").Explorer} explorer
     * @param {any[]} cases formulas of the paper that are wrong
     * @param {import("./mechanism.js").Mechanism | null} model the mechanism as the paper models it
     */
    constructor(explorer, cases, model) {
        Object.assign(this, { explorer, cases, model });
        const labels = [...cases.map((c) => c.label), ...(model ? ["the mechanism as published"] : [])];
        this.count = labels.length;
        const names = ["corrected", ...labels.map((label) => `published: ${label}`)];
        this.pick = choice("show", names, 0, (k) => this.choose(k - 1));
        this.note = element("p", { class: "note", role: "status" });
        this.link = element("a", { hidden: true }, "What is wrong, and what follows");
        this.element = group("What the paper says", true, this.pick.row, this.note, this.link);
    }

    choose(k) {
        this.explorer.case = k;
        const at = this.cases[k]?.at;
        if (at) this.explorer.takeJoints(at);
        else this.explorer.changed();
    }

    show() {
        this.pick.select.selectedIndex = this.explorer.case + 1;
    }

    /** Draw the chosen posture, and say how far it is from the target. */
    draw(view, style) {
        const { explorer, cases, model } = this;
        const chosen = cases[explorer.case];
        const found = chosen ? this.ofFormulas(chosen) : explorer.case >= cases.length && model ? this.ofModel() : null;
        this.note.textContent = found?.said ?? "";
        this.link.hidden = !chosen;
        const { skeleton, info } = explorer.mechanism;
        if (chosen) this.link.href = `#erratum-${info.name}-${chosen.erratum}`;
        if (found?.points) drawPosture(view, skeleton, found.points, { ...style, dash: [7, 5], width: 3 });
    }

    /** The posture by wrong formulas whose hand is nearest to the target. */
    ofFormulas(chosen) {
        const { mechanism: m, q, x, mode } = this.explorer;
        const here = m.points(q)[mode];
        const misses = chosen.postures(q, x, m.parameters).map((found) => {
            const points = m.points(found)[mode];
            return { points, miss: points && here ? m.between(points, here) : Infinity };
        });
        const best = misses.reduce((a, b) => (b.miss < a.miss ? b : a));
        const unit = Object.values(m.info.parameters ?? {})[0]?.unit ?? "";
        const said = Number.isFinite(best.miss)
            ? `The hand is ${short(best.miss)} ${unit} from the target.`
            : "The formula has no real value here.";
        return { points: best.points, said: `${said} Verdict: ${chosen.verdict}.` };
    }

    /** The posture of the mechanism as it is published. */
    ofModel() {
        const { mechanism: m, q, x } = this.explorer;
        const other = this.model.postures(x).find((p) => p.status === OK);
        const [points, here] = [other && m.points(other.q)[0], m.points(q)[0]];
        if (!points) return { points: null, said: "It does not reach the target." };
        return { points, said: `The hand is ${short(here ? m.between(points, here) : NaN)} from the target.` };
    }
}
