"""Figures of mechanisms of one's own: five joints called by words, and a linkage."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from chains import arm, printed, solved
from closedform.generated.numpy import scara
from loop_files import derived, script_of
from places import TESTS
from sympy import Rational, pi

from closedform import plot
from closedform.plot.catalogue import fits
from closedform.plot.robot import Robot
from closedform.plot.sections import unsectioned
from closedform.plot.symbols import factor, symbol
from closedform.scaffold.chains.propose import propose

ROWS = [
    (Rational(1, 30), pi / 2, Rational(1, 7)), (Rational(1, 6), 0, 0), (Rational(1, 7), 0, 0),
    (0, pi / 2, 0), (0, 0, Rational(1, 5)),
]  # fmt: skip
"""The lengths of a turret with two links, a bend and a roll."""


@pytest.fixture(scope="module")
def five(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    d, serial = arm(ROWS, " ".join(f"arm_joint_{k}" for k in range(1, 6)))
    solved(d, serial, propose(serial).source)
    serial.export(d)
    return printed(d, tmp_path_factory.mktemp("five"))


def test_a_hand_that_keeps_its_direction_in_a_plane_has_no_section(five: ModuleType) -> None:
    """Its workspace was an empty map: a plane meets the surface of such a hand in a line."""
    assert "in one direction stays on a surface" in unsectioned(five)
    assert not fits(five, "workspace")
    assert fits(five, "conditioning") and fits(five, "mechanism") and fits(five, "branches")


def test_joints_are_called_as_in_the_article(five: ModuleType) -> None:
    """The letter of a joint was followed by the rest of its word, as an index."""
    assert [symbol(j, Robot.of(five)) for j in five.JOINTS[:2]] == [
        r"$\theta_{1}$",
        r"$\theta_{2}$",
    ]
    figure = plot.mechanism(five, q=np.full(5, 0.4)).figure
    shown = {text.get_text() for text in figure.findobj(match=lambda a: hasattr(a, "get_text"))}
    assert {rf"$\theta_{{{k}}}$" for k in range(1, 6)} <= shown


def test_a_long_factor_has_its_number_in_a_legend(
    five: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    long = "2*sin(arm_joint_2) - " + " + ".join(f"{k}*cos(arm_joint_3)" for k in range(9)) + " = 0"
    monkeypatch.setattr(five, "SINGULARITIES", ("cos(arm_joint_3) = 0", "elbow", long))
    assert [factor(Robot.of(five), k) for k in range(3)] == [
        r"$\cos\, \theta_{3} = 0$", "elbow", "factor 3 of the singular set",
    ]  # fmt: skip


def test_a_map_needs_no_factors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Some arms of seven joints with one given have no determinant, and no singular set."""
    monkeypatch.setattr(scara, "SINGULARITIES", ())
    monkeypatch.setattr(scara, "__all__", [n for n in scara.__all__ if n != "singularities"])
    axes = plot.workspace(scara, ("x", "y"), resolution=60)
    assert [text.get_text() for text in axes.get_legend().get_texts()][-1] == "branches end"


def test_branches_are_those_of_a_mode_that_is_not_singular(tmp_path: Path) -> None:
    """In the first modes of a Peaucellier linkage the rhombus is folded, and no branch is OK."""
    text = (TESTS / "held_out_loops" / "peaucellier.toml").read_text("utf-8")
    linkage = derived("peaucellier", script_of("peaucellier", text, tmp_path), tmp_path)
    assert plot.branches(linkage).figure.axes
