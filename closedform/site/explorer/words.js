/** What the explorer says: postures in words, and the lines that compute them. */

import { INVALID, OK, SINGULAR, UNREACHABLE } from "./mechanism.js";

/** A number as people read it. */
export function short(value) {
    return Number.isFinite(value) ? String(Number(value.toPrecision(6))) : "none";
}

/** A range in words; whole turns in parts of pi. */
export function between([low, high]) {
    return high === Math.PI ? "−π to π" : `${short(low)} to ${short(high)}`;
}

/** The status of a branch in words. */
export function status(posture, free) {
    if (posture.status === OK) return "OK";
    if (posture.status === UNREACHABLE) return "out of reach";
    if (posture.status === SINGULAR) return free ? `singular: ${free} is free` : "singular: not determined";
    return "invalid input";
}

/** What is seen, in a sentence or two. */
export function sentence({ mechanism: m, x, found, branch, free, reached, meetings }) {
    const met = meetings.last ? ` ${meetings.last}.` : "";
    if (found?.every((p) => p.status === INVALID)) return "These dimensions are impossible.";
    if (!reached) return `Out of reach.${met}`;
    const hand = m.places.map((k) => short(x[k])).join(", ");
    const where = m.places.length ? `Hand at (${hand}). ` : "";
    const own = found[branch];
    return `${where}Branch ${m.spoken(own.name)}: ${status(own, free < 0 ? "" : m.label(free))}.${met}`;
}

/** All numbers of what is seen, as JSON. */
export function numbers({ mechanism: m, x, q, found }) {
    const branches = found.map((p) => ({ name: p.name, status: p.status, q: p.q }));
    const beside = m.given === undefined ? {} : { [m.robot.GIVEN]: m.given };
    const all = { robot: m.info.name, parameters: m.parameters, target: x, ...beside, joints: q, branches };
    return JSON.stringify(all, (_, v) => (Number.isNaN(v) ? null : v), 1);
}

/** Lines that compute what is seen, in one language. */
export function lines(language, mechanism, x, q) {
    const { robot, info, parameters, beside } = mechanism;
    const changed = Object.entries(parameters).filter(([name, v]) => v !== robot.DEFAULTS[name]);
    const list = (values) => Array.from(values).map(String).join(", ");
    const sizes = [x.length, q.length];
    return writers[language]({ ...info, robot, changed, x: list(x), beside, q: list(q), sizes });
}

const writers = {
    Python({ name, changed, x, beside, q, robot }) {
        const given = changed.map(([n, v]) => `${n}=${v}`).join(", ");
        const target = { 16: ".reshape(4, 4)", 9: ".reshape(3, 3)" }[robot.TASK.length] ?? "";
        return [
            "import numpy as np",
            `from closedform.generated.numpy import ${name}`,
            "",
            `params = ${name}.Parameters(${given})`,
            `x = np.array([${x}])${target}`,
            `q, status = ${name}.ik(${["x", ...beside, "params"].join(", ")})  # a row for each of ${name}.BRANCHES`,
            `print(${name}.fk([${q}], params))  # the posture that is seen`,
            "",
        ].join("\n");
    },
    C({ name, changed, x, beside, q, robot, sizes: [n, m] }) {
        const b = robot.BRANCHES.length;
        const given = beside.map((value) => `    const real_t ${robot.GIVEN}[1] = { ${value} };`);
        const inputs = ["&params", "x", ...beside.map(() => robot.GIVEN), "q", "status"].join(", ");
        return [
            `#include "${name}.h"`,
            "#include <stdio.h>",
            "",
            "int main(void)",
            "{",
            `    ${name}_params params = ${name.toUpperCase()}_DEFAULTS;`,
            `    const real_t x[${n}] = { ${x} };`,
            ...given,
            `    real_t q[${b * m}]; /* ${b} branches of ${m} joints; seen is ${q} */`,
            `    uint8_t status[${b}];`,
            "",
            ...changed.map(([p, v]) => `    params.${p} = ${v};`),
            `    ${name}_ik(${inputs});`,
            `    for (int i = 0; i < ${b * m}; ++i)`,
            `        printf("%.15g%c", q[i], i % ${m} == ${m - 1} ? '\\n' : ' ');`,
            "    return 0;",
            "}",
            "",
        ].join("\n");
    },
    JavaScript({ name, changed, x, beside, q }) {
        const given = changed.map(([n, v]) => `${n}: ${v}`).join(", ");
        return [
            `import * as ${name} from "closedform/${name}";`,
            "",
            `const parameters = {${given ? ` ${given} ` : ""}};`,
            `const { q, status } = ${name}.ik(${[`[${x}]`, ...beside, "parameters"].join(", ")}); // for each of BRANCHES`,
            `console.log(q, status, ${name}.fk([${q}], parameters)); // and the posture that is seen`,
            "",
        ].join("\n");
    },
};
