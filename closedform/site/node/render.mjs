// Sets formulas as MathML and graphs as SVG: a line of JSON with a request in, a line with the answer out.
import { createInterface } from "node:readline";
import { instance } from "@viz-js/viz";
import temml from "temml";

const viz = await instance();

const answers = {
    formula: ({ text, display, wrap }) =>
        temml.renderToString(text, {
            displayMode: display,
            wrap: wrap ? "tex" : "none",
            throwOnError: true,
        }),
    graph: ({ text }) => viz.renderString(text, { format: "svg" }),
};

for await (const line of createInterface({ input: process.stdin })) {
    const request = JSON.parse(line);
    let answer;
    try {
        answer = { text: answers[request.kind](request) };
    } catch (error) {
        answer = { error: error.message };
    }
    process.stdout.write(JSON.stringify(answer) + "\n");
}
