// Calls the batches of one module: reads requests from standard input, writes answers to standard
// output. A message is its length in four bytes, a header in JSON of this length, and numbers.

import { readSync, writeSync } from "node:fs";
import { pathToFileURL } from "node:url";

// node:process itself would make standard input one that does not wait.
const module = await import(pathToFileURL(process.argv[2]).href);

/** That many bytes, or null at the end of the input. */
function take(size) {
    const buffer = Buffer.alloc(size);
    for (let start = 0; start < size;) {
        const n = readSync(0, buffer, start, size - start, null);
        if (n === 0) return null;
        start += n;
    }
    return buffer;
}

function doubles(size) {
    const bytes = take(8 * size);
    return new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + 8 * size));
}

function give(buffer) {
    for (let start = 0; start < buffer.length;) start += writeSync(1, buffer, start);
}

function reply(header, arrays) {
    const text = Buffer.from(JSON.stringify(header));
    const length = Buffer.alloc(4);
    length.writeUInt32LE(text.length);
    give(Buffer.concat([length, text, ...arrays.map((a) => Buffer.from(a.buffer, a.byteOffset, a.byteLength))]));
}

for (let length = take(4); length !== null; length = take(4)) {
    const header = JSON.parse(take(length.readUInt32LE()).toString());
    const inputs = header.sizes.map((size) => doubles(size * header.n));
    const values = doubles(header.fields.length);
    const parameters = Object.fromEntries(header.fields.map((name, k) => [name, values[k]]));
    try {
        const batch = module[`${header.function}_batch`];
        const out = new Array(batch.length - inputs.length - 2).fill(undefined);
        const result = batch(header.n, ...inputs, ...out, parameters);
        const arrays = ArrayBuffer.isView(result) ? [result] : Object.values(result);
        reply({ arrays: arrays.map((a) => [a.constructor.name, a.byteLength]) }, arrays);
    } catch (error) {
        reply({ error: String(error) }, []);
    }
}
