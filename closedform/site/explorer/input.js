/** What a visitor does in the picture: by the pointer, by fingers and by keys. */

const GRAB = 16; // pixels
const NOTHING = { hand: false, point: -1 };

/**
 * Let an explorer follow what happens on its canvas.
 *
 * @param {import("./explorer.js").Explorer} explorer
 */
export function listen(explorer) {
    const { canvas } = explorer;
    new Pointers(explorer);
    canvas.addEventListener("dblclick", () => {
        explorer.fit();
        explorer.changed();
    });
    const wheel = (event) => {
        if (!event.ctrlKey && document.activeElement !== canvas) return;
        event.preventDefault();
        explorer.view.zoomAt(Math.exp(-event.deltaY / 600), placeOn(canvas, event));
        explorer.changed();
    };
    canvas.addEventListener("wheel", wheel, { passive: false });
    canvas.addEventListener("keydown", (event) => press(explorer, event));
}

/** Where an event is on the canvas. */
function placeOn(canvas, event) {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
}

/**
 * The pointer, or the fingers, that are on the canvas.
 *
 * One finger moves what it touches. Beside the mechanism it turns the view, or scrolls the page if it
 * moves up or down first. Two fingers zoom and move the picture.
 */
class Pointers {
    constructor(explorer) {
        this.explorer = explorer;
        this.fingers = new Map();
        this.grabbed = null;
        const { canvas } = explorer;
        canvas.addEventListener("pointerdown", (event) => this.down(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", (event) => this.release(event));
        canvas.addEventListener("pointercancel", (event) => this.release(event));
        canvas.addEventListener("touchstart", (event) => this.touch(event), { passive: false });
    }

    at(event) {
        return placeOn(this.explorer.canvas, event);
    }

    /** The page must not scroll while something is moved. */
    touch(event) {
        const [first] = event.targetTouches;
        const held = grab(this.explorer, this.at(first)).point >= 0;
        if (held || event.targetTouches.length > 1) event.preventDefault();
    }

    down(event) {
        const { explorer, fingers } = this;
        explorer.canvas.setPointerCapture(event.pointerId);
        const place = this.at(event);
        fingers.set(event.pointerId, place);
        explorer.stop();
        if (fingers.size > 1) {
            this.grabbed = null;
            explorer.release();
            return;
        }
        this.grabbed = { ...grab(explorer, place), finger: event.pointerType === "touch" };
        explorer.held = this.grabbed.hand;
        explorer.wanted = null;
    }

    move(event) {
        const { explorer, fingers } = this;
        const { view, canvas } = explorer;
        const place = this.at(event);
        const last = fingers.get(event.pointerId);
        if (!last) {
            const over = grab(explorer, place);
            canvas.style.cursor = over.point >= 0 ? "grab" : "move";
            return;
        }
        fingers.set(event.pointerId, place);
        if (fingers.size === 2) {
            const [[, other]] = [...fingers].filter(([id]) => id !== event.pointerId);
            const apart = ([x, y]) => Math.max(Math.hypot(x - other[0], y - other[1]), 1);
            const middle = ([x, y]) => [(x + other[0]) / 2, (y + other[1]) / 2];
            view.zoomAt(apart(place) / apart(last), middle(last), middle(place));
            explorer.changed();
        } else if (this.grabbed) drag(explorer, this.grabbed, last, place);
    }

    release(event) {
        this.fingers.delete(event.pointerId);
        if (!this.fingers.size) this.explorer.release();
    }
}

/** What is below the pointer: the hand, another point with the joint that moves it, or nothing. */
function grab({ mechanism: m, view, q, mode }, [px, py]) {
    const points = m.drawn(q)[mode];
    if (!points) return NOTHING;
    const far = points.map((p) => {
        const [x, y] = view.project(p);
        return Math.hypot(x - px, y - py);
    });
    if (far[m.hand] < 1.3 * GRAB) return { hand: true, point: m.hand };
    const point = far.indexOf(Math.min(...far));
    if (far[point] > GRAB) return NOTHING;
    const joint = m.jointOf(q, mode, point);
    return joint < 0 ? NOTHING : { hand: false, point, joint };
}

/** Move what is grabbed; beside the mechanism, turn the view or, but for a finger, move a flat picture. */
function drag(explorer, grabbed, from, to) {
    const { view } = explorer;
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const step = view.unproject(dx, dy);
    if (grabbed.hand) explorer.moveHand(step);
    else if (grabbed.point >= 0) explorer.movePoint(grabbed.point, [grabbed.joint], step);
    else if (view.flat) {
        if (grabbed.finger) return;
        view.zoomAt(1, from, to);
        explorer.changed();
    } else {
        view.azimuth -= 0.008 * dx;
        view.elevation = Math.min(Math.max(view.elevation + 0.008 * dy, -1.57), 1.57);
        explorer.changed();
    }
}

/** The directions of the page in which keys move the hand, and the sign. */
const MOVES = {
    ArrowRight: [0, 1],
    ArrowLeft: [0, -1],
    ArrowUp: [1, 1],
    ArrowDown: [1, -1],
    PageUp: [2, -1],
    PageDown: [2, 1],
};

function press(explorer, event) {
    const { axes, radius } = explorer.view;
    const count = explorer.mechanism.branches.length;
    if (event.key in MOVES) {
        const [axis, sign] = MOVES[event.key];
        const size = sign * (event.shiftKey ? 0.002 : 0.02) * radius;
        explorer.held = true;
        explorer.moveHand(axes[axis].map((v) => size * v));
        explorer.release();
    } else if (event.key === "[" || event.key === "]") {
        explorer.choose((explorer.branch + (event.key === "]" ? 1 : count - 1)) % count);
    } else return;
    event.preventDefault();
    event.stopPropagation();
}
