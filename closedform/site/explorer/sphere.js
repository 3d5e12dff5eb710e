/** A spherical mechanism is drawn on one sphere, with links that are arcs of great circles. */

const PARTS = 18; // of an arc, for each radian
const TINY = 1e-6; // rad: the arc between such points, or nearly opposite ones, is a line

const length = (v) => Math.hypot(...v);

/** The points moved along their radii to one sphere about a centre. */
export function onSphere(points, centre) {
    const ways = points.map((p) => p.map((v, k) => v - centre[k]));
    const radius = Math.max(...ways.map(length));
    return ways.map((way) => {
        const share = radius / (length(way) || 1);
        return way.map((v, k) => centre[k] + share * v);
    });
}

/** The line through points that follows the great circles about a centre. */
export function arcs(points, centre) {
    const found = [points[0]];
    for (let i = 1; i < points.length; i++) {
        const [u, v] = [points[i - 1], points[i]].map((p) => p.map((value, k) => value - centre[k]));
        const cosine = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / (length(u) * length(v) || 1);
        const angle = Math.acos(Math.min(Math.max(cosine, -1), 1));
        const isLine = !length(u) || !length(v) || angle < TINY || angle > Math.PI - TINY;
        const parts = isLine ? 1 : Math.max(2, Math.floor(PARTS * angle));
        for (let part = 1; part < parts; part++) {
            const [a, b] = [1 - part / parts, part / parts].map((s) => Math.sin(s * angle) / Math.sin(angle));
            found.push(centre.map((value, k) => value + a * u[k] + b * v[k]));
        }
        found.push(points[i]);
    }
    return found;
}
