"""Pages of the site in a browser: what their tests share."""

import importlib
import shutil

import numpy as np

CHROMIUM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
PATIENCE = 240_000
"""Milliseconds: a page may load slowly beside other tests, and that is not a fault."""
STEPS = 6
"""Of the pointer along each part of a path."""

STATE = """() => {
    const explorer = document.querySelector(".explorer").explorer;
    const { mechanism: m } = explorer;
    return {
        x: explorer.x,
        q: explorer.q,
        mode: explorer.mode,
        branch: explorer.branch,
        reached: explorer.reached,
        parameters: m.parameters,
        beside: m.beside,
        postures: explorer.postures(),
    };
}"""
POINT = """(name) => {
    const explorer = document.querySelector(".explorer").explorer;
    const { mechanism: m, view, canvas } = explorer;
    const points = m.drawn(explorer.q)[explorer.mode];
    const [x, y] = view.project(points[m.names.indexOf(name ?? m.skeleton.hand)]);
    const box = canvas.getBoundingClientRect();
    return [box.left + x, box.top + y];
}"""


class Phone:
    """A page on a touch screen, and fingers on it."""

    def __init__(self, context):
        self.page = context.new_page()
        self.session = context.new_cdp_session(self.page)

    def fingers(self, *paths):
        """Put fingers down one after another, move them together, and lift them."""
        down = [path[0] for path in paths]
        for k in range(1, len(down) + 1):
            self._send("touchStart", down[:k])
        for k in range(1, STEPS + 1):
            self._send(
                "touchMove",
                [[a + k / STEPS * (b - a) for a, b in zip(*path, strict=True)] for path in paths],
            )
        self._send("touchEnd", [])

    def _send(self, kind, places):
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(places)]
        self.session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


def address(site, path):
    return (site / path).as_uri()


def explorer(tab, site, name, mark=""):
    tab.goto(address(site, f"mechanisms/{name}.html") + mark)
    tab.wait_for_function("document.querySelector('.explorer')?.explorer?.found")
    tab.locator(".explorer canvas").first.scroll_into_view_if_needed()
    return tab


def agrees(name, state):
    """What the explorer has computed is what the NumPy module computes."""
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    params = robot.Parameters(**state["parameters"])
    size = sum(map(abs, params))
    x = np.array(state["x"], dtype=float)
    x = x.reshape({16: (4, 4), 9: (3, 3)}.get(len(x), (len(x),)))
    q, status = robot.ik(x, *state["beside"], params)
    assert [p["status"] for p in state["postures"]] == status.tolist()
    for k, posture in enumerate(state["postures"]):
        if status[k] not in (0, 2):
            continue
        np.testing.assert_allclose(
            np.exp(1j * np.array(posture["q"])), np.exp(1j * q[k]), atol=1e-12, rtol=0
        )
        points = robot.skeleton(np.array(posture["q"]), params)
        points = points[posture["mode"]] if robot.ASSEMBLY_MODES else points
        np.testing.assert_allclose(posture["points"], points, atol=1e-12 * size, rtol=0)
        if status[k] == 0:
            hand = points[robot.SKELETON.points.index(robot.SKELETON.hand)]
            drawn = np.array(posture["points"])[robot.SKELETON.points.index(robot.SKELETON.hand)]
            assert np.linalg.norm(hand - drawn) <= 1e-12 * size
    if state["reached"]:
        hand = robot.fk(np.array(state["q"]), params)
        hand = hand.p[state["mode"]] if robot.ASSEMBLY_MODES else hand
        gap = (hand - x).ravel()
        angles = [len(gap) < 9 and name not in ("x", "y", "z") for name in robot.TASK]
        gap[angles] = np.angle(np.exp(1j * gap[angles]))
        assert np.max(np.abs(gap)) <= 1e-9 * max(size, 1)
