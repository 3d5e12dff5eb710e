// Sets formulas as MathML and graphs as SVG: a line of JSON with a request in, a line with the answer out.
import { createInterface } from "node:readline";
import { instance } from "@viz-js/viz";
import temml from "temml";

const viz = await instance();

// Temml 0.13 loses the delimiter of \bigl after a plain parenthesis, but not in a group of its own.
const grouped = (text) =>
    text
        .replaceAll(/\\bigl([([])/g, "\\mathopen{\\big$1}")
        .replaceAll(/\\bigr([)\]])/g, "\\mathclose{\\big$1}");

const answers = {
    formula: ({ text, display, wrap }) => {
        const options = { displayMode: display, wrap: wrap ? "tex" : "none", throwOnError: true };
        try {
            return temml.renderToString(text, options);
        } catch {
            return temml.renderToString(grouped(text), options);
        }
    },
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
