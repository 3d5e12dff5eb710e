/** A square plot beside the picture, in which a visitor can drag. */

import { branchColour, colourOf } from "./colours.js";
import { element } from "./controls.js";
import { OK } from "./mechanism.js";

/** What all plots have in common: `take`, `placeOf`, `label` and `paint` are those of each. */
export class Plot {
    /** @param {import("./explorer.js").Explorer} explorer */
    constructor(explorer) {
        this.explorer = explorer;
        this.canvas = element("canvas", { class: "joint-space", tabindex: 0, role: "img" });
        this.caption = element("p", { class: "note" });
        this.element = element("div", {}, this.canvas, this.caption);
        const take = (event) => {
            if (!event.buttons) return;
            const box = this.canvas.getBoundingClientRect();
            this.take([(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height]);
        };
        this.canvas.addEventListener("pointerdown", (event) => {
            this.canvas.setPointerCapture(event.pointerId);
            take(event);
        });
        this.canvas.addEventListener("pointermove", take);
    }

    show() {
        this.element.hidden = !this.explorer.layers.joints;
        if (this.element.hidden) return;
        this.draw();
        const label = this.label();
        this.canvas.setAttribute("aria-label", label);
        if (this.caption.textContent !== label) this.caption.textContent = label;
    }

    draw() {
        const { canvas, explorer } = this;
        const { place, found, branch, q, x } = explorer;
        this.ratio = window.devicePixelRatio || 1;
        const side = Math.round((canvas.clientWidth || 240) * this.ratio);
        if (canvas.width !== side) canvas.width = canvas.height = side;
        const c = canvas.getContext("2d");
        c.setTransform(1, 0, 0, 1, 0, 0);
        c.fillStyle = colourOf(place, "paper");
        c.fillRect(0, 0, side, side);
        this.paint(c, side);
        for (const p of found) {
            if (p.status === OK) this.mark(this.placeOf(p.q, x), branchColour(p.index), 3);
        }
        this.mark(this.placeOf(q, x), branchColour(branch), 6);
    }

    /** A dot at a place, in shares of the sides. */
    mark([across, up], colour, radius) {
        const c = this.canvas.getContext("2d");
        const side = this.canvas.width;
        c.beginPath();
        c.arc(across * side, (1 - up) * side, radius * this.ratio, 0, 2 * Math.PI);
        c.fillStyle = colour;
        c.fill();
    }
}
