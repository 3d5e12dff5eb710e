/** The controls beside the picture, and the words below it. */

import { element } from "./controls.js";
import { branches, copies, dimensions, joints, layers, target } from "./groups.js";
import { sentence } from "./words.js";

const PAUSE = 120; // milliseconds without a change until it is told

export class Panel {
    /** @param {import("./explorer.js").Explorer} explorer */
    constructor(explorer) {
        this.explorer = explorer;
        this.groups = [branches, joints, target, dimensions, layers].map((make) => make(explorer));
        if (explorer.published) this.groups.push(explorer.published);
        this.groups.push(copies(explorer));
        this.element = element("div", { class: "controls" }, ...this.groups.map((g) => g.element));
        this.say = element("p", { class: "said", role: "status" });
    }

    /** Bring the controls and the words up to what is seen. */
    show() {
        for (const group of this.groups) group.show();
        this.tell(sentence(this.explorer));
    }

    /** Say it once nothing changes any more. */
    tell(text) {
        clearTimeout(this.telling);
        this.telling = setTimeout(() => {
            if (this.say.textContent !== text) this.say.textContent = text;
        }, PAUSE);
    }
}
