"""What the drawing of a mechanism names, and that its labels can be told apart."""

from itertools import combinations
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import numpy as np
import pytest
from matplotlib import pyplot as plt

import closedform
from closedform import plot
from closedform.cli.plot import catalogue
from closedform.plot.labels import place
from closedform.plot.robot import Robot
from closedform.plot.style import GROUND
from closedform.plot.symbols import directions, distances, lengths


def labels(ax: Any) -> dict[str, Any]:
    """The labels of axes by their texts, placed."""
    ax.figure.draw_without_rendering()
    place(ax.figure)
    return {label.text.get_text(): label for label in ax._closedform_labels}


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("three_prs", ("b", "l", "a", "P", "A_{1}")),
        (
            "spherical_five_bar",
            (r"\alpha_{1}", r"\alpha_{2}", r"\beta_{1}", r"\beta_{2}", r"\gamma", "r", "P"),
        ),
        ("linear_delta", ("f", "l", "e", "P")),
        ("slider_crank", ("e", "r", "l", "x")),
        ("four_bar", ("L_{1}", "L_{2}", "L_{3}", "L_{4}", r"\psi")),
        ("delta", ("f", "L", "l", "e", r"\alpha_{2}", r"\alpha_{3}", "P")),
    ],
)
def test_the_drawing_names_what_the_text_names(name: str, wanted: tuple[str, ...]) -> None:
    figure = next(f for f in catalogue(name) if f.name == "mechanism")
    general = figure.draw(getattr(closedform, name)).figure.axes[1]
    found = labels(general)
    plt.close("all")
    assert not {f"${w}$" for w in wanted} - {*found}


@pytest.mark.parametrize("name", ["spherical_wrist", "scara", "ur_arm"])
def test_labels_do_not_cover_each_other(name: str) -> None:
    """Those of the wrist, the SCARA arm and the UR arm were crowded."""
    figure = next(f for f in catalogue(name) if f.name == "mechanism")
    axes = figure.draw(getattr(closedform, name)).figure.axes
    boxes = [[label.box for label in labels(ax).values()] for ax in axes]
    plt.close("all")
    for panel in boxes:
        for a, b in combinations(panel, 2):
            sides = [min(a[1][k], b[1][k]) - max(a[0][k], b[0][k]) for k in (0, 1)]
            assert min(sides) <= 0


def test_a_length_without_a_link_leads_from_the_origin_to_a_fixed_point() -> None:
    r = Robot.of(closedform.linear_delta)
    q, mode = r.posture(), 0
    assert "f" not in lengths(r, q, mode)
    spans = distances(r, q, mode)["f"]
    assert [len(spans), *spans[0][0]] == [3, 0, 0, 0]


def test_a_fixed_point_has_its_angle_about_the_origin() -> None:
    """That of the first leg of the Delta robot is zero, which has no arc."""
    r = Robot.of(closedform.delta)
    found = directions(r, r.posture(), 0)
    assert {*found} == {"alpha2", "alpha3"}
    start, axis, point = found["alpha3"][0]
    assert [*start, *axis] == [1, 0, 0, 0, 0, 1]
    assert np.arctan2(point[1], point[0]) % (2 * np.pi) == pytest.approx(r.params.alpha3)


def test_a_drawing_in_the_plane_shows_all_its_lines() -> None:
    """A line where an angle starts reached into the next panel, to a label there."""
    ax = plot.mechanism(closedform.rpr_planar, (0.8, 0.8))
    ends = np.vstack([line.get_xydata() for line in ax.lines])
    low, high = np.transpose([ax.get_xlim(), ax.get_ylim()])
    plt.close("all")
    assert (low <= ends.min(0)).all() and (ends.max(0) <= high).all()


def test_a_slider_that_is_the_task_is_on_a_rail() -> None:
    """The slider of a crank was a point without a line that leads it."""
    ax = plot.mechanism(closedform.slider_crank, (0.9,), mode=1, labels=False)
    fixed = [max(line.get_xdata()) for line in ax.lines if line.get_color() == GROUND]
    slider = next(line for line in ax.lines if line.get_marker() == "D")
    plt.close("all")
    assert max(fixed) > np.ravel(slider.get_xdata())[0] > 3


def test_slides_to_one_point_have_arrows_of_the_usual_size() -> None:
    """The frame of two slides that lead to one point was as large as that of a wrist."""
    ax = plot.mechanism(closedform.rpr_planar, (0.9, 0.6))
    lengths_of_frame = [abs(line.get_xdata()[1] - line.get_xdata()[0]) for line in ax.lines[-4:]]
    plt.close("all")
    assert max(lengths_of_frame) < 0.25
