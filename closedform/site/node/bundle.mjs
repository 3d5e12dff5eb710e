// One script for each mechanism: the explorer with the printed code that it runs.
// The argument is JSON: folders, and the mechanisms, each with the one that it is compared with.
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { build } from "esbuild";

const { explorer, printed, cases, maps, target, robots } = JSON.parse(process.argv[2]);
const path = (...parts) => JSON.stringify(resolve(join(...parts)));

/** The script of a mechanism, before it is bundled. */
function entry(name, other) {
    const optional = (folder, what) => {
        const file = join(folder, `${name}.js`);
        return existsSync(file) ? `import * as ${what} from ${path(file)};` : `const ${what} = null;`;
    };
    return [
        `import { mountAll } from ${path(explorer, "explorer.js")};`,
        `import { nearest } from ${path(printed, "_nearest.js")};`,
        `import * as robot from ${path(printed, `${name}.js`)};`,
        other ? `import * as other from ${path(printed, `${other}.js`)};` : "const other = null;",
        optional(cases, "published"),
        optional(maps, "maps"),
        `mountAll("${name}", { robot, nearest, maps, other, cases: published?.CASES });`,
    ].join("\n");
}

for (const [name, other] of Object.entries(robots)) {
    await build({
        stdin: { contents: entry(name, other), resolveDir: "/" },
        outfile: join(target, `${name}.js`),
        bundle: true,
        alias: { closedform: resolve(printed) },
        minify: true,
        format: "iife",
        target: "es2022",
        legalComments: "none",
        logLevel: "error",
    });
}
