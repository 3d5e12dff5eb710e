// One script for each mechanism: the explorer with the printed code that it runs.
// Arguments: the folder of the explorer, of the printed modules, of the published cases, for the results.
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { build } from "esbuild";

const [explorer, printed, published, target, ...names] = process.argv.slice(2);
const path = (...parts) => JSON.stringify(resolve(join(...parts)));

/** The script of a mechanism, before it is bundled. */
function entry(name) {
    const cases = join(published, `${name}.js`);
    const other = name.endsWith("_loop_closed") ? name.replace("_loop_closed", "") : "";
    const imports = [
        `import { mountAll } from ${path(explorer, "explorer.js")};`,
        `import { nearest } from ${path(printed, "_nearest.js")};`,
        `import * as robot from ${path(printed, `${name}.js`)};`,
        existsSync(cases) ? `import { CASES as cases } from ${path(cases)};` : "const cases = [];",
        other ? `import * as other from ${path(printed, `${other}.js`)};` : "const other = null;",
    ];
    const compared = `other && { robot: other, says: "the mechanism as published" }`;
    return `${imports.join("\n")}\nmountAll("${name}", { robot, nearest, cases, compared: ${compared} });`;
}

for (const name of names) {
    await build({
        stdin: { contents: entry(name), resolveDir: "/" },
        outfile: join(target, `${name}.js`),
        bundle: true,
        minify: true,
        format: "iife",
        target: "es2022",
        legalComments: "none",
        logLevel: "error",
    });
}
