/** The controls beside the picture: native inputs with labels. */

let count = 0;

/** An element with attributes, listeners and children. */
export function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value === true) made.setAttribute(name, "");
        else if (value !== false && value !== undefined) made.setAttribute(name, value);
    }
    made.append(...children);
    return made;
}

/** A group of controls that can be folded. */
export function group(title, open, ...children) {
    return element("details", { class: "group", open }, element("summary", {}, title), ...children);
}

/**
 * A slider with a number beside it; a formula is shown instead of its label.
 *
 * @returns {{row: HTMLElement, show(value: number): void, call(written: object): void}}
 */
export function slider({ label, formula, title, min, max, unit, changed }) {
    const id = `explorer-${++count}`;
    const step = "any";
    const range = element("input", { type: "range", id, min, max, step });
    const number = element("input", { type: "number", step });
    const name = element("label", { for: id });
    const call = (written) => {
        name.replaceChildren();
        if (written.formula) name.innerHTML = written.formula;
        else name.append(written.label);
        name.append(written.note ?? "", unit ? element("small", {}, ` ${unit}`) : "");
        const plain = written.label + (written.note ?? "");
        range.setAttribute("aria-label", plain);
        number.setAttribute("aria-label", `${plain}, number`);
    };
    call({ label, formula });
    const read = (source) => {
        const value = source.valueAsNumber;
        if (Number.isFinite(value)) changed(value);
    };
    range.addEventListener("input", () => read(range));
    number.addEventListener("change", () => read(number));
    const row = element(
        "div",
        { class: "row", title },
        name,
        range,
        number,
    );
    return {
        row,
        call,
        show(value) {
            range.value = String(value);
            if (document.activeElement !== number) number.value = String(Number(value.toPrecision(6)));
        },
    };
}

export function checkbox(label, checked, changed) {
    const id = `explorer-${++count}`;
    const box = element("input", { type: "checkbox", id });
    box.checked = checked;
    box.addEventListener("change", () => changed(box.checked));
    return { row: element("div", { class: "check" }, box, element("label", { for: id }, label)), box };
}

export function button(label, pressed, options = {}) {
    return element("button", { type: "button", onclick: pressed, ...options }, label);
}

export function choice(label, names, chosen, changed) {
    const id = `explorer-${++count}`;
    const select = element("select", { id });
    names.forEach((name, k) => select.append(element("option", { value: k, selected: k === chosen }, name)));
    select.addEventListener("change", () => changed(select.selectedIndex));
    return { row: element("div", { class: "row" }, element("label", { for: id }, label), select), select };
}
