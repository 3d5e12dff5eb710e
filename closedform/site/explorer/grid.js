/** Square grids of values: the lines where they vanish, and pictures of them. */

/**
 * Where values on a square grid change their sign: lines in units of the grid.
 *
 * @param {(cell: number) => number} value NaN where there is none
 */
export function contours(size, value) {
    const found = [];
    const corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
    for (let row = 0; row + 1 < size; row++) {
        for (let column = 0; column + 1 < size; column++) {
            const cell = row * size + column;
            const around = [value(cell), value(cell + 1), value(cell + size + 1), value(cell + size)];
            const crossed = [];
            for (let k = 0; k < 4; k++) {
                const [f, g] = [around[k], around[(k + 1) % 4]];
                if (!(f * g < 0)) continue;
                const share = f / (f - g);
                const [a, b] = [corners[k], corners[(k + 1) % 4]];
                crossed.push(column + 0.5 + a[0] + share * (b[0] - a[0]), row + 0.5 + a[1] + share * (b[1] - a[1]));
            }
            if (crossed.length === 4) found.push(crossed);
        }
    }
    return found;
}

/** An empty picture with a pixel for each cell. */
export function picture(size) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = size;
    return canvas;
}
