/** The state of the explorer in the address of the page, so that a link shows what is seen. */

const KEY = "explore";

/** The state in an address, or null; anything that does not fit is left out. */
export function read(hash, name) {
    const found = new URLSearchParams(hash.replace(/^#/, ""));
    if (found.get(KEY) !== name) return null;
    const numbers = (key) => found.get(key)?.split(",").map(Number).filter(Number.isFinite);
    const state = { parameters: {}, layers: {}, camera: {} };
    const q = numbers("q");
    if (q?.length) state.q = q;
    for (const key of ["branch", "mode"]) {
        const [value] = numbers(key) ?? [];
        if (Number.isInteger(value) && value >= 0) state[key] = value;
    }
    for (const part of found.get("p")?.split(",") ?? []) {
        const [key, value] = part.split(":");
        if (/^\w+$/.test(key) && Number.isFinite(Number(value))) state.parameters[key] = Number(value);
    }
    const pair = numbers("pair");
    if (pair?.length === 2 && pair.every((k) => Number.isInteger(k) && k >= 0)) state.pair = pair;
    const [chosen] = numbers("case") ?? [];
    if (Number.isInteger(chosen)) state.case = chosen;
    const shown = found.get("show")?.split(",");
    if (shown) {
        for (const key of ["workspace", "map", "joints", "trail", "names"]) {
            state.layers[key] = shown.includes(key);
        }
    }
    const camera = numbers("camera");
    if ((camera?.length === 3 || camera?.length === 5) && camera[2] > 0) {
        const [azimuth, elevation, zoom, across = 0, down = 0] = camera;
        state.camera = { azimuth, elevation, zoom, pan: [across, down] };
    }
    return state;
}

/** Write the state of an explorer to the address, without a step in the history. */
export function write(explorer) {
    const { mechanism: m, view, layers } = explorer;
    const state = new URLSearchParams([[KEY, m.info.name]]);
    state.set("q", explorer.q.join(","));
    state.set("branch", explorer.branch);
    if (m.modes > 1) state.set("mode", explorer.mode);
    const changed = Object.entries(m.parameters).filter(([k, v]) => v !== m.robot.DEFAULTS[k]);
    if (changed.length) state.set("p", changed.map((pair) => pair.join(":")).join(","));
    state.set("show", Object.keys(layers).filter((k) => layers[k]).join(","));
    if (explorer.pair) state.set("pair", explorer.pair.join(","));
    if (explorer.case >= 0) state.set("case", explorer.case);
    const camera = [view.azimuth, view.elevation, view.zoom, ...view.pan];
    state.set("camera", camera.map((v) => v.toFixed(3)).join(","));
    history.replaceState(null, "", `#${state.toString().replaceAll("%2C", ",").replaceAll("%3A", ":")}`);
}
