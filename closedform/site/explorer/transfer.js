/** A mechanism with one joint and one coordinate: the coordinate over a turn of the joint. */

import { branchColour, colourOf } from "./colours.js";
import { Plot } from "./plot.js";
import { between } from "./words.js";

const STEPS = 720;
const MARGIN = 0.08; // of the range

export class TransferPlot extends Plot {
    take([across]) {
        this.explorer.takeJoints([Math.PI * (2 * across - 1)]);
    }

    /** The name of the coordinate, and how it is drawn in the plot. */
    label() {
        const { mechanism: m } = this.explorer;
        const up = `${m.coordinate(0)} up (${between(this.range)})`;
        return `${m.label(0)} across (${between([-Math.PI, Math.PI])}), ${up}, for each assembly mode.`;
    }

    placeOf([joint], [value]) {
        const [low, high] = this.range;
        return [joint / (2 * Math.PI) + 0.5, (value - low) / (high - low)];
    }

    /** For each assembly mode the coordinate at each step, NaN where it cannot be assembled. */
    compute() {
        const { mechanism: m } = this.explorer;
        const of = JSON.stringify(m.parameters);
        if (of === this.of) return;
        this.of = of;
        this.values = Array.from({ length: m.modes }, () => []);
        for (let k = 0; k <= STEPS; k++) {
            const found = m.fk([Math.PI * ((2 * k) / STEPS - 1)]);
            found.forEach(([value], mode) => this.values[mode].push(value));
        }
        const finite = this.values.flat().filter(Number.isFinite);
        const [low, high] = [Math.min(...finite), Math.max(...finite)];
        const margin = MARGIN * (high - low);
        this.range = m.places.length && finite.length ? [low - margin, high + margin] : [-Math.PI, Math.PI];
    }

    paint(c, side) {
        this.compute();
        const { place, mode, branch } = this.explorer;
        const ground = colourOf(place, "ground");
        this.axes(c, side, ground);
        this.values.forEach((values, k) => {
            c.strokeStyle = k === mode ? branchColour(branch) : ground;
            c.lineWidth = (k === mode ? 2.2 : 1.4) * this.ratio;
            c.beginPath();
            let last = NaN;
            values.forEach((value, step) => {
                const [across, up] = this.placeOf([Math.PI * ((2 * step) / STEPS - 1)], [value]);
                if (Math.abs(up - last) < 0.5) c.lineTo(across * side, (1 - up) * side);
                else c.moveTo(across * side, (1 - up) * side);
                last = up;
            });
            c.stroke();
        });
    }

    /** Lines where the joint and the coordinate are 0. */
    axes(c, side, colour) {
        const [across, up] = this.placeOf([0], [0]);
        c.strokeStyle = colour;
        c.lineWidth = 0.5 * this.ratio;
        c.beginPath();
        c.moveTo(across * side, 0);
        c.lineTo(across * side, side);
        c.moveTo(0, (1 - up) * side);
        c.lineTo(side, (1 - up) * side);
        c.stroke();
    }
}
