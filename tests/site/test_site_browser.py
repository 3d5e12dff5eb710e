"""The site in a browser: no fault in the console, no request elsewhere, and true explorers."""

import importlib
import json
import math
import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from browsing import POINT, STATE, STEPS, address, agrees, explorer
from libraries import FORWARD
from places import ROOT

NAMES = FORWARD
"""The mechanisms that have an explorer."""
HEAVIEST = 1_000_000
"""Bytes of a page with all that it loads, but the figures."""
WITHOUT_SECTION = (
    "agile_wrist",
    "four_bar",
    "slider_crank",
    "spherical_five_bar",
    "spherical_wrist",
)
"""Their hand does not follow the pointer through a plane or space."""
LAYERS = "document.querySelector('.explorer').explorer.layers"
CAMERA = """() => {
    const { view } = document.querySelector(".explorer").explorer;
    return [view.azimuth, view.elevation, view.zoom, ...view.pan];
}"""


def test_every_page_loads_without_a_fault(tab, site):
    for path in sorted(site.rglob("*.html")):
        tab.goto(path.as_uri())
        assert not tab.faults, path
    assert all(url.startswith(("file:", "data:", "blob:")) for url in tab.asked)


@pytest.mark.parametrize("name", NAMES)
def test_the_hand_can_be_dragged_through_a_singularity(tab, site, name):
    """Away from the base until it is out of reach, and back across the base."""
    explorer(tab, site, name)
    agrees(name, tab.evaluate(STATE))
    start = tab.evaluate(POINT)
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    ground = robot.SKELETON.ground
    base = tab.evaluate(POINT, ground[0]) if ground else start
    toward = [a + 0.15 * (b - a) for a, b in zip(start, base, strict=True)]
    away = [a + 1.5 * (a - b) for a, b in zip(start, base, strict=True)]
    across = [b - 0.5 * (a - b) for a, b in zip(start, base, strict=True)]
    tab.mouse.move(*start)
    tab.mouse.down()
    seen = set()
    for begin, end in pairwise((start, toward, away, across)):
        for k in range(1, STEPS + 1):
            pointer = [a + k / STEPS * (b - a) for a, b in zip(begin, end, strict=True)]
            tab.mouse.move(*pointer)
            state = tab.evaluate(STATE)
            seen.add(tuple(state["q"]))
            agrees(name, state)
            if state["reached"] and name not in WITHOUT_SECTION:
                np.testing.assert_allclose(tab.evaluate(POINT), pointer, atol=0.5)
    tab.mouse.up()
    assert len(seen) > 4
    assert not tab.faults


@pytest.mark.parametrize("name", ["planar_2r", "five_bar", "puma560"])
def test_a_link_holds_what_is_seen(tab, site, browser, name):
    explorer(tab, site, name)
    tab.locator(".explorer canvas").first.focus()
    for key in ("ArrowRight", "ArrowUp", "]"):
        tab.keyboard.press(key)
    tab.evaluate(
        """() => {
            const explorer = document.querySelector(".explorer").explorer;
            const [[name, value]] = Object.entries(explorer.mechanism.parameters);
            explorer.resizeTo({ [name]: 1.01 * value });
            explorer.layers.names = true;
            explorer.view.azimuth = 0.5;
            explorer.view.zoomAt(1.3, [40, 30]);
        }"""
    )
    tab.wait_for_function("location.hash.includes('names')")
    before, layers, camera = tab.evaluate(STATE), tab.evaluate(LAYERS), tab.evaluate(CAMERA)
    other = browser.new_page()
    explorer(other, site, name, tab.evaluate("location.hash"))
    after = other.evaluate(STATE)
    assert other.evaluate(LAYERS) == layers
    assert other.evaluate(CAMERA) == pytest.approx(camera, abs=1e-3)
    other.close()
    assert after["parameters"] == before["parameters"]
    np.testing.assert_allclose(after["q"], before["q"], rtol=0, atol=1e-12)
    assert (after["branch"], after["mode"]) == (before["branch"], before["mode"])


def test_a_link_holds_the_branch_where_two_meet(tab, site, browser):
    """The joints alone do not tell which branch it is."""
    explorer(tab, site, "planar_2r")
    tab.evaluate(
        """() => {
            const explorer = document.querySelector(".explorer").explorer;
            explorer.takeTarget([18, 0]);
            explorer.choose(1);
        }"""
    )
    tab.wait_for_function("location.hash.includes('branch=1')")
    other = browser.new_page()
    assert (
        explorer(other, site, "planar_2r", tab.evaluate("location.hash")).evaluate(STATE)["branch"]
        == 1
    )
    other.close()


@pytest.mark.parametrize(
    "mark",
    [
        "#explore=planar_2r&q=1",
        "#explore=planar_2r&q=a,b&branch=9&p=__proto__:1,l3:1,l1:x",
        "#%E0%A4%A",
    ],
)
def test_a_link_that_does_not_fit_is_ignored(tab, site, mark):
    state = explorer(tab, site, "planar_2r", mark).evaluate(STATE)
    assert state["parameters"] == {"l1": 10, "l2": 8}
    assert state["reached"]
    assert not tab.faults


def test_a_free_joint_moves_while_the_hand_stays(tab, site):
    explorer(tab, site, "planar_2r")
    tab.evaluate(
        """() => {
            const explorer = document.querySelector(".explorer").explorer;
            explorer.resizeTo({ l1: 8, l2: 8 });
            explorer.takeTarget([0, 0]);
        }"""
    )
    slider = tab.get_by_label("θ₁, free", exact=True)
    slider.wait_for()
    slider.fill("1.25")
    state = tab.evaluate(STATE)
    assert math.isclose(state["q"][0], 1.25, abs_tol=1e-9)
    hand = state["postures"][state["branch"]]["points"][2]
    assert np.linalg.norm(hand) < 1e-9
    assert "θ₁ is free" in tab.locator(".explorer").inner_text()


def test_where_a_branch_meets_another_is_said(tab, site):
    explorer(tab, site, "planar_2r")
    tab.evaluate(
        """() => {
            const explorer = document.querySelector(".explorer").explorer;
            explorer.takeJoints([0, 0.6]);
            explorer.held = true;
            for (const x of [17, 17.6, 19]) explorer.takeTarget([x, 0]);
        }"""
    )
    tab.get_by_text("elbow down meets elbow up, singular: elbow").wait_for()


def test_published_joints_stand_beside_the_right_ones(tab, site):
    """The arctangent of a quotient turns the arm of a target on the left by half a turn."""
    explorer(tab, site, "planar_2r")
    tab.evaluate("document.querySelector('.explorer').explorer.takeJoints([2.2, 1.1])")
    tab.get_by_label("show").select_option(label="published: use of eqs. (3) and (4)")
    hand = np.linalg.norm(
        [10 * math.cos(2.2) + 8 * math.cos(3.3), 10 * math.sin(2.2) + 8 * math.sin(3.3)]
    )
    tab.get_by_text(f"The hand is {2 * hand:.6g} cm from the target.").wait_for()


def test_the_published_waist_of_the_h6ar_turns_to_the_rear(tab, site):
    """It is right for the branches behind, and misses by about twice the reach in front."""
    explorer(tab, site, "h6ar")
    tab.get_by_label("show").select_option(label="published: waist angle")
    note = tab.locator(".explorer .note", has_text="Verdict: incomplete")
    note.wait_for()
    x, y, *_ = tab.evaluate(STATE)["x"]
    front = float(re.search(r"The hand is (\S+)", note.inner_text())[1])
    assert front == pytest.approx(2 * math.hypot(x, y), rel=0.02)
    tab.get_by_role("button", name="rear elbow up").click()
    tab.wait_for_timeout(100)
    assert float(re.search(r"The hand is (\S+)", note.inner_text())[1]) < 1e-9


LOOK = """() => {
    const { view, canvas } = document.querySelector(".explorer").explorer;
    const box = canvas.getBoundingClientRect();
    return {
        scrolled: scrollY,
        scale: view.scale,
        middle: [box.left + box.width / 2, box.top + box.height / 2],
        corner: [box.right - 12, box.bottom - 12],
    };
}"""


@pytest.mark.parametrize("name", ["five_bar", "puma560"])
def test_a_finger_drags_the_hand(phone, site, name):
    """Also up and down, where a finger beside the mechanism scrolls the page."""
    page = explorer(phone.page, site, name)
    before, scrolled = page.evaluate(POINT), page.evaluate(LOOK)["scrolled"]
    base = page.evaluate(
        POINT, importlib.import_module(f"closedform.generated.numpy.{name}").SKELETON.ground[0]
    )
    wanted = [a + math.copysign(d, b - a) for a, b, d in zip(before, base, (8, 40), strict=True)]
    phone.fingers((before, wanted))
    page.wait_for_timeout(100)
    np.testing.assert_allclose(page.evaluate(POINT), wanted, atol=0.5)
    assert page.evaluate(LOOK)["scrolled"] == scrolled
    agrees(name, page.evaluate(STATE))


@pytest.mark.parametrize("name", ["five_bar", "puma560"])
def test_two_fingers_zoom_and_move_the_picture(phone, site, name):
    page = explorer(phone.page, site, name)
    state, look, hand = page.evaluate(STATE), page.evaluate(LOOK), page.evaluate(POINT)
    x, y = look["middle"]
    first, second = [x - 30, y + 20], [x + 30, y + 20]
    phone.fingers((first, [x - 60, y + 50]), (second, [x + 60, y + 50]))
    page.wait_for_timeout(100)
    after = page.evaluate(LOOK)
    assert after["scale"] == pytest.approx(2 * look["scale"], rel=1e-3)
    middle, moved = np.array([x, y + 20]), np.array([x, y + 50])
    expected = moved + 2 * (np.array(hand) - middle)
    np.testing.assert_allclose(page.evaluate(POINT), expected, atol=0.5)
    assert page.evaluate(STATE)["x"] == state["x"]
    assert after["scrolled"] == look["scrolled"]


@pytest.mark.parametrize("name", ["five_bar", "puma560"])
def test_a_finger_beside_the_mechanism_scrolls_the_page(phone, site, name):
    page = explorer(phone.page, site, name)
    state, look = page.evaluate(STATE), page.evaluate(LOOK)
    x, y = look["corner"]
    phone.fingers(([x, y], [x, y - 200]))
    page.wait_for_function(f"scrollY > {look['scrolled'] + 100}")
    assert page.evaluate(STATE)["q"] == state["q"]


def test_maps_are_drawn(tab, site):
    explorer(tab, site, "five_bar")
    tab.locator("summary", has_text="Layers").click()
    for label in ("workspace and singular curves", "map: conditioning (1/κ)", "joint space"):
        tab.get_by_label(label).check()
    tab.get_by_text("300×300 postures in").wait_for()
    found = tab.evaluate(
        """() => {
            const { section } = document.querySelector(".explorer").explorer;
            const { low, width, size, value } = section;
            const at = (v, k) => Math.floor(((v - low[k]) / width) * size);
            const found = ([u, v]) => value[at(v, 1) * size + at(u, 0)];
            return [[3, 10], [3, 40], [1, 9]].map(found);
        }"""
    )
    assert np.isnan(found[1] if found[1] is not None else np.nan)
    robot = importlib.import_module("closedform.generated.numpy.five_bar")
    branch = tab.evaluate(STATE)["branch"]
    for value, x in ((found[0], [3, 10]), (found[2], [1, 9])):
        q = robot.ik(x).q[branch]
        mode = int(np.argmin(np.linalg.norm(robot.fk(q).p - x, axis=-1)))
        assert value == pytest.approx(1 / robot.condition_number(q)[mode], abs=0.03)


MAP = """([branch, map]) => {
    const { section, x } = document.querySelector(".explorer").explorer;
    section.start(x, branch, 24, { map, workspace: true });
    while (!section.done) section.step(1000);
    const { size, axes, low, width } = section;
    const plain = (values) => Array.from(values, (v) => (Number.isNaN(v) ? null : v));
    const [value, factor] = [plain(section.value), plain(section.factor)];
    const { beside } = document.querySelector(".explorer").explorer.mechanism;
    return { x, beside, size, axes, low, width, value, factor };
}"""


@pytest.mark.parametrize("name", [n for n in NAMES if n not in WITHOUT_SECTION])
def test_a_map_shows_what_the_module_computes(tab, site, name):
    """Where a branch has a posture, and in it the measure and the factors of the own mode."""
    explorer(tab, site, name)
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    for branch in {0, len(robot.BRANCHES) // 2, len(robot.BRANCHES) - 1}:
        found = tab.evaluate(MAP, [branch, True])
        n = found["size"]
        cells = (np.arange(n) + 0.5) / n * found["width"]
        x = np.tile(np.array(found["x"], dtype=float), (n, n, 1))
        x[..., found["axes"][0]] = found["low"][0] + cells
        x[..., found["axes"][1]] = (found["low"][1] + cells)[:, None]
        pose = x.reshape(n, n, 4, 4) if x.shape[-1] == 16 else x
        q, status = (a[:, :, branch] for a in robot.ik(pose, *found["beside"]))
        value = np.array(found["value"], dtype=float).reshape(n, n)
        factor = np.array(found["factor"], dtype=float).reshape(-1, n, n)
        reached = (status == 0) | (status == 2)
        np.testing.assert_array_equal(~np.isnan(value), reached)
        border = np.array(tab.evaluate(MAP, [branch, False])["value"], dtype=float)
        np.testing.assert_array_equal(~np.isnan(border), reached.ravel())
        assert reached.any()
        expected = (
            1 / robot.condition_number(q)
            if hasattr(robot, "condition_number")
            else np.abs(robot.determinant(q))
        )
        factors = robot.singularities(q)
        if robot.ASSEMBLY_MODES:
            hand = robot.fk(q).p
            mode = np.nanargmin(np.where(reached[..., None], gaps(hand, x), 0), axis=-1)
            expected = np.take_along_axis(expected, mode[..., None], -1)[..., 0]
            factors = np.take_along_axis(factors, mode[..., None, None], -2)[..., 0, :]
        largest = np.nanmax(np.abs(expected), initial=0)
        ours = reached & (status == 0)
        np.testing.assert_allclose(value[ours], expected[ours], rtol=1e-5, atol=1e-6 * largest)
        np.testing.assert_allclose(
            np.moveaxis(factor, 0, -1)[ours], factors[ours], rtol=1e-5, atol=1e-6
        )


def gaps(hand, x):
    return np.linalg.norm(hand - x[..., None, :], axis=-1)


@pytest.mark.parametrize("name", WITHOUT_SECTION)
def test_a_page_says_why_there_is_no_section(tab, site, name):
    explorer(tab, site, name)
    tab.locator("summary", has_text="Layers").click()
    tab.get_by_text("There is no section of the workspace, because a target is").wait_for()


@pytest.mark.parametrize("name", ["four_bar", "slider_crank"])
def test_a_crank_turns_in_the_plot_of_its_coordinate(tab, site, name):
    explorer(tab, site, name)
    tab.locator("summary", has_text="Layers").click()
    tab.get_by_label("over θ").check()
    plot = tab.locator(".explorer .joint-space")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    tab.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + 0.5 * box["height"])
    state = tab.evaluate(STATE)
    assert state["q"][0] == pytest.approx(math.pi / 2, abs=0.05)
    agrees(name, state)
    values = tab.evaluate(
        "document.querySelector('.explorer').explorer.panel.groups.find((g) => g.plot).plot.values"
    )
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    turn = np.linspace(-math.pi, math.pi, len(values[0]))[:, None]
    answer = robot.fk(turn)[0].reshape(len(turn), -1)
    expected = np.exp(1j * answer.T) if name == "four_bar" else answer.T
    found = np.array(values, dtype=float)
    found = np.exp(1j * found) if name == "four_bar" else found
    np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("name", ["five_bar", "puma560"])
def test_the_lines_that_are_copied_compute_what_is_seen(tab, site, name, tmp_path):
    explorer(tab, site, name)
    tab.evaluate(
        """() => {
            const explorer = document.querySelector(".explorer").explorer;
            const [[name, value]] = Object.entries(explorer.mechanism.parameters);
            explorer.resizeTo({ [name]: 1.01 * value });
        }"""
    )
    tab.locator("summary", has_text="Copy").click()
    state = tab.evaluate(STATE)
    expected = state["postures"][state["branch"]]["q"]

    def copied(language):
        tab.get_by_role("button", name=language, exact=True).click()
        return tab.locator(".explorer pre").inner_text()

    script = copied("Python") + "print('q', q.tolist())\n"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    found = json.loads(done.stdout.rpartition("q ")[2].replace("nan", "NaN"))
    np.testing.assert_allclose(found[state["branch"]], expected, atol=1e-9)
    if shutil.which("cc"):
        (tmp_path / "main.c").write_text(copied("C"))
        code = ROOT / "generated" / "c"
        command = ["cc", "-std=c99", f"-I{code}", tmp_path / "main.c", code / f"{name}.c"]
        subprocess.run([*command, "-lm", "-o", tmp_path / "main"], check=True)
        printed = subprocess.run([tmp_path / "main"], capture_output=True, text=True).stdout
        row = printed.splitlines()[state["branch"]].split()
        np.testing.assert_allclose([float(v) for v in row], expected, atol=1e-9)


@pytest.mark.parametrize(
    "path",
    ["index.html", "mechanisms/index.html", "mechanisms/planar_2r.html", "mechanisms/delta.html"],
)
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_a_page_can_be_used_by_everybody(browser, site, path, theme):
    axe = next(site.parent.glob("*work/node/node_modules/axe-core/axe.min.js"))
    page = browser.new_page(color_scheme=theme, viewport={"width": 1280, "height": 1000})
    page.goto(address(site, path))
    page.add_script_tag(path=axe)
    found = page.evaluate("axe.run({ exclude: [['math']] }, { resultTypes: ['violations'] })")[
        "violations"
    ]
    page.close()
    assert not [(v["id"], v["help"], [n["html"][:200] for n in v["nodes"][:3]]) for v in found]


@pytest.mark.parametrize("name", NAMES)
def test_a_page_is_light(tab, site, name):
    explorer(tab, site, name)
    loaded = {url.partition("?")[0] for url in tab.asked if url.startswith("file:")}
    files = [Path(url.removeprefix("file://")) for url in loaded]
    pictures = (".svg", ".png")
    assert sum(f.stat().st_size for f in files if f.suffix not in pictures) < HEAVIEST


def test_a_narrow_page_has_no_sideways_scroll(browser, site):
    page = browser.new_page(viewport={"width": 360, "height": 740})
    for path in ("index.html", "mechanisms/h6ar.html", "mechanisms/puma560.html", "lemmas.html"):
        page.goto(address(site, path))
        for part in ("html", ".content"):
            assert page.evaluate(f"document.querySelector('{part}').scrollWidth") <= 360, path
    page.close()
