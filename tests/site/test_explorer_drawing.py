"""The drawing of an explorer, and what stands next to it."""

import importlib
import re

import numpy as np
import pytest
from browsing import STATE, explorer

from closedform.plot.postures import on_sphere, way_through
from closedform.plot.robot import Robot


def test_a_posture_of_the_published_model_has_its_own_points(tab, site):
    """The models have different skeletons, so the hand is not the same point of both."""
    explorer(tab, site, "h6ar_loop_closed")
    tab.get_by_label("show").select_option(label="published: the mechanism as published")
    note = tab.locator(".explorer .note", has_text="from the target")
    note.wait_for()
    state = tab.evaluate(STATE)
    published = importlib.import_module("closedform.generated.numpy.h6ar")
    q, status = published.ik(np.array(state["x"]))
    hand = published.skeleton(q[status == 0][0])[published.SKELETON.points.index("hand")]
    miss = np.linalg.norm(hand - state["x"][:3])
    assert float(re.search(r"The hand is (\S+) m from", note.inner_text())[1]) == pytest.approx(
        miss, rel=1e-4, abs=1e-9
    )


LINES = """() => {
    const { view, draw } = document.querySelector(".explorer").explorer;
    const found = [];
    view.line = (points, { width }) => found.push([width, points]);
    document.querySelector(".explorer").explorer.draw();
    delete view.line;
    return found.filter(([width]) => width === 4).map(([, points]) => points);
}"""


@pytest.mark.parametrize("name", ["agile_wrist", "spherical_five_bar"])
def test_links_of_a_spherical_mechanism_are_arcs_as_in_the_figures(tab, site, name):
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    explorer(tab, site, name)
    state = tab.evaluate(STATE)
    drawn = tab.evaluate(LINES)
    r = Robot.of(robot)
    points = on_sphere(r, robot.skeleton(np.array(state["q"]))[state["mode"]])
    place = dict(zip(robot.SKELETON.points, points, strict=True))
    links = [robot.SKELETON.links[n] for n in ("crank1", "rod1", "crank2", "rod2")]
    for link in links:
        way = way_through(r, place, link)
        ends = [w for w in drawn if np.allclose([w[0], w[-1]], way[[0, -1]], atol=1e-9)]
        assert len(ends) == 1
        np.testing.assert_allclose(np.linalg.norm(ends[0], axis=1), 1, atol=1e-12)
        assert len(ends[0]) > 4
        middle = np.array(ends[0])[len(ends[0]) // 2]
        assert abs(np.cross(way[0], way[-1]) @ middle) < 1e-9


BLOCKS = """() => {
    const { view, draw } = document.querySelector(".explorer").explorer;
    const found = [];
    view.line = (points, { cap }) => cap === "butt" && found.push(points);
    document.querySelector(".explorer").explorer.draw();
    delete view.line;
    return found;
}"""


@pytest.mark.parametrize(("name", "sliders"), [("slider_crank", ("B2",)), ("rpr_planar", ())])
def test_what_slides_on_a_fixed_line_is_a_block(tab, site, name, sliders):
    """It was a sleeve about the middle of the line; the legs of rpr_planar still have one."""
    robot = importlib.import_module(f"closedform.generated.numpy.{name}")
    explorer(tab, site, name)
    state = tab.evaluate(STATE)
    points = robot.skeleton(np.array(state["q"]))[state["mode"]]
    places = [points[robot.SKELETON.points.index(p)] for p in sliders]
    middles = [np.mean(block, axis=0) for block in tab.evaluate(BLOCKS)]
    assert len(middles) == 2 * len(places)  # an outline is drawn by two lines
    for place in places:
        assert np.allclose(middles, place)


def test_controls_show_symbols_and_units(tab, site):
    explorer(tab, site, "srs_arm")
    tab.locator("summary", has_text="Dimensions").click()
    row = tab.locator(".explorer .row", has=tab.get_by_label("d_bs", exact=True))
    assert row.locator("msub").text_content() == "dbs"
    explorer(tab, site, "five_bar")
    assert "any unit" not in tab.locator(".explorer").inner_text()
