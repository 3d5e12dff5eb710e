// What a module exports, and where a call for one posture and a batch differ, as JSON.
//
//   node forms.mjs MODULE SIZES
//
// SIZES gives the sizes of the inputs of every function, -1 for a number that stands for itself.

import { pathToFileURL } from "node:url";

const module = await import(pathToFileURL(process.argv[2]).href);
const sizes = JSON.parse(process.argv[3]);
const SPECIAL = [0, -0, Math.PI, -Math.PI, Math.PI / 2, 1e-9, 1, 3, 1e7, 1e300, 5e-324, NaN, Infinity];
const N = 60;
let state = 1;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const number = () => (random() < 0.3 ? SPECIAL[Math.floor(random() * SPECIAL.length)] : 6 * random() - 3);
const lengths = (factor) => Object.fromEntries(Object.entries(module.DEFAULTS).map(([k, v]) => [k, v * factor]));
const differences = [];

for (const [name, shape] of Object.entries(sizes)) {
    for (const parameters of [undefined, {}, lengths(3), lengths(1e-200), lengths(1e120), lengths(NaN)]) {
        const inputs = shape.map((size) => Float64Array.from({ length: Math.abs(size) * N }, number));
        const taken = module[`${name}_batch`](N, ...inputs, ...new Array(results(name)).fill(undefined), parameters);
        for (let i = 0; i < N; ++i) {
            const given = inputs.map((x, k) => (shape[k] < 0 ? x[i] : column(x, i)));
            const single = module[name](...given, parameters);
            const arrays = ArrayBuffer.isView(taken) ? [taken] : Object.values(taken);
            const alone = ArrayBuffer.isView(taken) ? [single] : Object.values(single);
            const same = arrays.every((a, k) => equal(column(a, i), [alone[k]].flat(2).map(Number)));
            if (!same) differences.push([name, given.map(String), String(single)]);
        }
    }
}

function results(name) {
    return module[`${name}_batch`].length - sizes[name].length - 2;
}

function column(planes, i) {
    return Array.from({ length: planes.length / N }, (_, k) => planes[k * N + i]);
}

function equal(a, b) {
    return a.length === b.length && a.every((x, k) => Object.is(x, b[k]));
}

const constants = Object.fromEntries(Object.entries(module).filter(([, value]) => typeof value !== "function"));
console.log(JSON.stringify({ names: Object.keys(module), constants, differences: differences.slice(0, 5) }));
