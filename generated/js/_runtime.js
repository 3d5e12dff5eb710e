/**
 * The code that all generated JavaScript modules share: statuses and the evaluation of kernels.
 *
 * A kernel reads one array with the numbers of all inputs and then of the parameters, and writes the
 * numbers of all results to another. No call depends on an earlier one.
 *
 * @module
 */

/** The status of one branch of an inverse. */
export const Status = Object.freeze({ OK: 0, UNREACHABLE: 1, SINGULAR: 2, INVALID: 3 });

export const FEASIBILITY = 1e-12;
export const VANISHING = 8.881784197001252e-16;
export const DETERMINED = 0.0009765625;
export const HALF_DIGITS = 2.384185791015625e-07;
export const ROUNDING = 5.684341886080802e-14;
export const ROTATION = 1e-06;

/**
 * An argument or a result: its name and shape, the number of branches (0 if it has no axis of
 * branches) and the kind of its numbers.
 *
 * @typedef {object} Spec
 * @property {string} name
 * @property {readonly number[]} shape without the axis of branches
 * @property {number} branches
 * @property {"real" | "status" | "bool"} kind
 */

/**
 * How numbers scale with the size of a mechanism, its largest length. `lengths` are the indices of
 * the arguments that are lengths. `degrees` are pairs: the index of a result and the power of the
 * size with which it scales. The powers of sizes from `least` to `most` stay in the range of a double.
 *
 * @typedef {object} Size
 * @property {readonly number[]} lengths
 * @property {readonly (readonly [number, number])[]} degrees
 * @property {number} least
 * @property {number} most
 */

/** @typedef {(v: readonly number[], o: Float64Array) => void} Compute */

/**
 * A function of a mechanism. `common`, if there is one, computes the same results, valid unless
 * something vanishes, and then a number that says whether something does.
 *
 * @typedef {object} Description
 * @property {string} name
 * @property {Compute} compute
 * @property {Compute | null} common
 * @property {readonly Spec[]} inputs
 * @property {readonly Spec[]} outputs
 * @property {readonly string[]} used the parameters that follow the inputs
 * @property {Readonly<Record<string, number>>} defaults of all parameters
 * @property {Size | null} size
 */

/**
 * A function that is ready to be called, with the number of entries of each argument and result and
 * of all arguments together (`given`), the array to read if all parameters are defaults (`blank`), and
 * the array to which results are written (`room`).
 *
 * @typedef {Description & { inputSizes: number[], outputSizes: number[], given: number, blank: number[],
 *     room: Float64Array }} Kernel
 */

/** @typedef {Readonly<Record<string, number | undefined>>} Given parameters; some may be missing */

/**
 * Make a function of a mechanism ready to be called.
 *
 * @param {Description} description
 * @returns {Kernel}
 */
export function kernel(description) {
    const inputSizes = description.inputs.map(count);
    const outputSizes = description.outputs.map(count);
    const given = inputSizes.reduce((a, b) => a + b, 0);
    const results = outputSizes.reduce((a, b) => a + b, 0);
    const blank = [...new Array(given).fill(NaN), ...description.used.map((name) => description.defaults[name])];
    const room = new Float64Array(results + (description.common === null ? 0 : 1));
    return { ...description, inputSizes, outputSizes, given, blank, room };
}

/** The sine and the cosine of the last call of `sincos`. */
export const found = new Float64Array(2);

/**
 * Sine and cosine, written to `found`, by the same operations in the same order as
 * `cf_sincos_rounded` in `closedform.h`. The results agree to the last bit on every machine, and so
 * does a status that depends on them.
 *
 * @param {number} angle
 */
export function sincos(angle) {
    const size = Math.abs(angle);
    if (!(size <= 400000.0)) {
        found[0] = Math.sin(angle);
        found[1] = Math.cos(angle);
        return;
    }
    // Adding 2^52 rounds to an integer.
    const n = (size * 0.6366197723675814 + 4503599627370496.0) - 4503599627370496.0;
    // pi/2 is split into three parts; the products with the first two are exact.
    const near = size - n * 1.5707963267923333;
    const part = n * 2.5633441515839558e-12;
    const r = near - part;
    const tail = ((near - r) - part) - n * 1.0562999066987428e-23;
    const z = r * r;
    const z2 = z * z;
    const s = (-0.1666666666666663 + z * 0.008333333333321842) +
        z2 * ((-0.00019841269829360994 + z * 2.7557313539658054e-06) +
            z2 * (-2.5050734577586117e-08 + z * 1.5895442710921173e-10));
    const c = (0.041666666666666595 + z * -0.0013888888888873342) +
        z2 * ((2.4801587289002127e-05 + z * -2.7557314217063467e-07) +
            z2 * (2.087570540007036e-09 + z * -1.1358749458908495e-11));
    const sine = r + ((r * z) * s + tail * (1 - 0.5 * z));
    const cosine = 1 + (z * (z * c - 0.5) - r * tail);
    const quadrant = n & 3;
    const first = quadrant & 1 ? cosine : sine;
    const second = quadrant & 1 ? sine : cosine;
    const negative = angle < 0 || (angle === 0 && 1 / angle < 0);
    found[0] = negative !== quadrant > 1 ? -first : first;
    found[1] = quadrant === 1 || quadrant === 2 ? -second : second;
}

/**
 * The nearest integer, of either sign; the even one of two that are equally near.
 *
 * @param {number} x
 */
function nearest(x) {
    return (x + 6755399441055744.0) - 6755399441055744.0;
}

/**
 * The angle moved to [-pi, pi], up to rounding; a large angle loses no accuracy.
 *
 * @param {number} angle
 */
export function principal(angle) {
    if (!(Math.abs(angle) <= 400000.0)) return Math.atan2(Math.sin(angle), Math.cos(angle));
    const turns = nearest(angle * 0.15915494309189535);
    return ((angle - turns * (4 * 1.5707963267923333)) - turns * (4 * 2.5633441515839558e-12)) -
        turns * (4 * 1.0562999066987428e-23);
}

/**
 * The sum of a few angles moved to (-pi, pi]; a sum that is already there does not change.
 *
 * @param {number} angle
 */
export function wrap(angle) {
    const turns = nearest(angle * 0.15915494309189535);
    const wrapped = (angle - turns * (2 * Math.PI)) - turns * 2.4492935982947064e-16;
    return Math.abs(wrapped) >= Math.PI ? Math.PI : wrapped;
}

/**
 * Evaluate a kernel for one posture.
 *
 * @param {Kernel} kernel
 * @param {readonly unknown[]} args
 * @param {Given | undefined} parameters
 * @returns {any} a number or an array; an object of these if there are several results
 */
export function single(kernel, args, parameters) {
    const v = kernel.blank.slice();
    let place = 0;
    for (let i = 0; i < args.length; ++i) {
        read(kernel, kernel.inputs[i], kernel.inputSizes[i], args[i], v, place);
        place += kernel.inputSizes[i];
    }
    if (parameters !== undefined) readParameters(kernel, parameters, v);
    // From here until the results are copied, no code of the caller runs.
    const values = evaluate(kernel, v);
    if (kernel.outputs.length === 1) return shaped(kernel.outputs[0], kernel.outputSizes[0], values, 0);
    /** @type {Record<string, unknown>} */
    const results = {};
    let start = 0;
    for (let i = 0; i < kernel.outputs.length; ++i) {
        const spec = kernel.outputs[i];
        results[spec.name] = shaped(spec, kernel.outputSizes[i], values, start);
        start += kernel.outputSizes[i];
    }
    return results;
}

/**
 * Evaluate a kernel for n postures; each array is a sequence of planes of n numbers.
 *
 * @param {Kernel} kernel
 * @param {number} n
 * @param {readonly unknown[]} args
 * @param {readonly unknown[]} out arrays for the results; one that is undefined is made
 * @param {Given | undefined} parameters
 * @returns {any} the array of the result; an object of arrays if there are several results
 */
export function batch(kernel, n, args, out, parameters) {
    if (typeof n !== "number") throw new TypeError(`${kernel.name}: n is ${typeName(n)}, expected a number`);
    if (!Number.isSafeInteger(n) || n < 0) {
        throw new RangeError(`${kernel.name}: n is ${n}, expected a number of postures`);
    }
    const inputs = kernel.inputs.map((spec, i) => planes(kernel, spec, n, args[i]));
    const outputs = kernel.outputs.map((spec, i) => out[i] === undefined
        ? new (arrayOf(spec))(n * count(spec))
        : planes(kernel, spec, n, out[i]));
    checkOverlap(kernel, inputs, outputs);
    const v = kernel.blank.slice();
    if (parameters !== undefined) readParameters(kernel, parameters, v);
    for (let i = 0; i < n; ++i) {
        let place = 0;
        for (const array of inputs) {
            for (let k = i; k < array.length; k += n) v[place++] = array[k];
        }
        const values = evaluate(kernel, v);
        place = 0;
        for (const array of outputs) {
            for (let k = i; k < array.length; k += n) array[k] = values[place++];
        }
    }
    if (outputs.length === 1) return outputs[0];
    return Object.fromEntries(kernel.outputs.map((spec, i) => [spec.name, outputs[i]]));
}

/**
 * The number of entries of an argument or a result.
 *
 * @param {Spec} spec
 */
function count(spec) {
    return spec.shape.reduce((a, b) => a * b, Math.max(1, spec.branches));
}

/**
 * Read the numbers of an argument.
 *
 * @param {Kernel} kernel
 * @param {Spec} spec
 * @param {number} size
 * @param {unknown} given
 * @param {number[]} v
 * @param {number} place
 */
function read(kernel, spec, size, given, v, place) {
    if (spec.shape.length === 0) {
        v[place] = number(kernel, spec.name, given);
        return;
    }
    if (!isArray(given)) {
        throw new TypeError(`${kernel.name}: ${spec.name} is ${typeName(given)}, expected an array of ${expected(spec)}`);
    }
    if (given.length !== size) {
        throw new RangeError(`${kernel.name}: ${spec.name} has length ${given.length}, expected ${expected(spec)}`);
    }
    for (let k = 0; k < size; ++k) {
        const value = given[k];
        v[place + k] = typeof value === "number" ? value : number(kernel, `${spec.name}[${k}]`, value);
    }
}

/**
 * Read the parameters that a kernel uses; one that is missing has its default.
 *
 * @param {Kernel} kernel
 * @param {Given} given
 * @param {number[]} v
 */
function readParameters(kernel, given, v) {
    const { defaults, used } = kernel;
    if (given === null || typeof given !== "object" || isArray(given)) {
        const type = isArray(given) ? "an array" : typeName(given);
        throw new TypeError(`${kernel.name}: parameters is ${type}, expected an object`);
    }
    for (const name of Object.keys(given)) {
        if (!Object.hasOwn(defaults, name)) {
            const known = Object.keys(defaults).join(", ") || "none";
            throw new TypeError(`${kernel.name}: there is no parameter ${name}; known: ${known}`);
        }
        if (given[name] !== undefined) number(kernel, `parameters.${name}`, given[name]);
    }
    for (let k = 0; k < used.length; ++k) v[kernel.given + k] = given[used[k]] ?? defaults[used[k]];
}

/**
 * @param {Kernel} kernel
 * @param {string} name
 * @param {unknown} value
 * @returns {number}
 */
function number(kernel, name, value) {
    if (typeof value === "number") return value;
    throw new TypeError(`${kernel.name}: ${name} is ${typeName(value)}, expected a number`);
}

/**
 * @param {unknown} value
 * @returns {value is ArrayLike<unknown>}
 */
function isArray(value) {
    return Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));
}

/** @param {unknown} value */
function typeName(value) {
    if (value === null || value === undefined) return String(value);
    if (isArray(value)) return "an array";
    return typeof value === "object" ? "an object" : `a ${typeof value}`;
}

/** @param {Spec} spec */
function expected(spec) {
    const size = count(spec);
    return spec.shape.length > 1 ? `${size} numbers (${spec.shape.join(" x ")} in row order)` : `${size} numbers`;
}

/** @param {Spec} spec */
function arrayOf(spec) {
    return spec.kind === "real" ? Float64Array : Uint8Array;
}

/**
 * The planes of an argument or a result of a batch.
 *
 * @param {Kernel} kernel
 * @param {Spec} spec
 * @param {number} n
 * @param {unknown} given
 * @returns {Float64Array | Uint8Array}
 */
function planes(kernel, spec, n, given) {
    const type = arrayOf(spec);
    if (!(given instanceof type)) {
        throw new TypeError(`${kernel.name}: ${spec.name} is ${typeName(given)}, expected a ${type.name}`);
    }
    if (given.length !== n * count(spec)) {
        throw new RangeError(
            `${kernel.name}: ${spec.name} has length ${given.length}, expected ${n * count(spec)} ` +
            `(${count(spec)} planes of ${n})`
        );
    }
    return given;
}

/**
 * Refuse results that share memory with each other or with an argument.
 *
 * @param {Kernel} kernel
 * @param {readonly (Float64Array | Uint8Array)[]} inputs
 * @param {readonly (Float64Array | Uint8Array)[]} outputs
 */
function checkOverlap(kernel, inputs, outputs) {
    outputs.forEach((a, i) => {
        for (const b of [...inputs, ...outputs.slice(0, i)]) {
            const apart = a.buffer !== b.buffer || a.byteOffset + a.byteLength <= b.byteOffset ||
                b.byteOffset + b.byteLength <= a.byteOffset;
            if (!apart) {
                throw new RangeError(`${kernel.name}: ${kernel.outputs[i].name} shares memory with another array`);
            }
        }
    });
}

/**
 * A result as a user sees it: an array for each branch, if there are branches.
 *
 * @param {Spec} spec
 * @param {number} size
 * @param {Float64Array} values
 * @param {number} start
 * @returns {unknown}
 */
function shaped(spec, size, values, start) {
    if (spec.branches === 0) return entry(spec, size, values, start);
    const each = size / spec.branches;
    const branches = [];
    for (let b = 0; b < spec.branches; ++b) branches.push(entry(spec, each, values, start + b * each));
    return branches;
}

/**
 * @param {Spec} spec
 * @param {number} size
 * @param {Float64Array} values
 * @param {number} start
 */
function entry(spec, size, values, start) {
    if (spec.shape.length === 0) return spec.kind === "bool" ? values[start] === 1 : values[start];
    const numbers = [];
    for (let k = 0; k < size; ++k) numbers.push(values[start + k]);
    return numbers;
}

/**
 * The results of a kernel, for a mechanism of any size.
 *
 * @param {Kernel} kernel
 * @param {number[]} v
 */
function evaluate(kernel, v) {
    const size = kernel.size;
    if (size === null) return evaluateInRange(kernel, v);
    let largest = 0;
    for (const k of size.lengths) largest = Math.max(largest, Math.abs(v[k]));
    if ((size.least <= largest && largest <= size.most) || largest === 0 || !Number.isFinite(largest)) {
        return evaluateInRange(kernel, v);
    }
    // A multiple of 4, so that roots of powers of lengths are also multiplied by powers of two.
    const exponent = 4 * Math.trunc(exponentOf(largest) / 4);
    const scaled = v.slice();
    for (const k of size.lengths) scaled[k] = timesPower(v[k], -exponent);
    const values = evaluateInRange(kernel, scaled);
    for (const [k, degree] of size.degrees) values[k] = timesPower(values[k], degree * exponent);
    return values;
}

/**
 * The results of a kernel; they are computed again if something vanishes.
 *
 * @param {Kernel} kernel
 * @param {number[]} v
 */
function evaluateInRange(kernel, v) {
    const { common, compute, room } = kernel;
    if (common === null) {
        compute(v, room);
    } else {
        common(v, room);
        if (room[room.length - 1] !== 0) compute(v, room);
    }
    return room;
}

const bits = new DataView(new ArrayBuffer(8));

/**
 * The exponent e of a positive number m 2^e with 1/2 <= m < 1.
 *
 * @param {number} x
 * @returns {number}
 */
function exponentOf(x) {
    bits.setFloat64(0, x);
    const biased = bits.getUint16(0) >> 4;
    return biased === 0 ? exponentOf(x * 18014398509481984.0) - 54 : biased - 1022;
}

/**
 * x 2^e, rounded once.
 *
 * @param {number} x
 * @param {number} e
 */
function timesPower(x, e) {
    for (; e > 1023; e -= 1023) x *= 8.98846567431158e+307;
    // 2^-1022 times 2^53: the product before the last one is not denormal.
    for (; e < -1022; e += 969) x *= 2.004168360008973e-292;
    bits.setUint32(4, 0);
    bits.setUint32(0, (e + 1023) << 20);
    return x * bits.getFloat64(0);
}
