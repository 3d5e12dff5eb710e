/** What the paper says: postures by its formulas or of its model, beside the right ones. */

import { choice, element, group } from "./controls.js";
import { OK, distance } from "./mechanism.js";
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
        if (chosen) this.link.href = `#erratum-${explorer.mechanism.info.name}-${chosen.erratum}`;
        if (found?.q) {
            const { of, q, mode } = found;
            drawPosture(view, of, of.drawn(q)[mode], { ...style, dash: [7, 5], width: 3 });
        }
    }

    /** The posture by wrong formulas whose hand is nearest to the target. */
    ofFormulas(chosen) {
        const { mechanism: m, q, x, mode } = this.explorer;
        const here = m.points(q)[mode];
        const misses = chosen.postures(q, x, m.parameters).map((found) => {
            const hand = m.points(found)[mode]?.[m.hand];
            return { q: hand && found, miss: hand && here ? distance(hand, here[m.hand]) : Infinity };
        });
        const best = misses.reduce((a, b) => (b.miss < a.miss ? b : a));
        const said = Number.isFinite(best.miss) ? this.from(best.miss) : "The formula has no real value here.";
        return { of: m, q: best.q, mode, said: `${said} Verdict: ${chosen.verdict}.` };
    }

    /** The posture of the mechanism as it is published. */
    ofModel() {
        const { model } = this;
        const { mechanism: m, q, x } = this.explorer;
        const other = model.postures(x).find((p) => p.status === OK);
        const [points, here] = [other && model.points(other.q)[0], m.points(q)[0]];
        if (!points) return { said: "It does not reach the target." };
        const miss = here ? distance(points[model.hand], here[m.hand]) : NaN;
        return { of: model, q: other.q, mode: 0, said: this.from(miss) };
    }

    /** How far the hand is from the target, in words. */
    from(miss) {
        return `The hand is ${short(miss)} ${this.explorer.mechanism.unit} from the target.`;
    }
}
