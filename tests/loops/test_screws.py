"""An RCCC linkage, against screws about its four axes."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS
from sympy import Rational, sqrt

from closedform import Crank, Derivation, Paper, Screws, coupled, prove, real
from closedform.algebra.shapes import ShapeError
from closedform.emit.pages import pages
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "rccc.toml").read_text("utf-8")
AXES = np.array([[0, 0, 1], [0.6, 0, 0.8], [0, 0.6, 0.8], [0, -0.6, 0.8]])
PLACES = np.array([[0, 0, 0], [0, 0.1, 0.05], [0.3, 0.1, 0.05], [0.3, 0, 0]])
OK = 0


@pytest.fixture(scope="module")
def rccc(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("rccc")
    return derived("rccc", script_of("rccc", TEXT, folder), folder, crosscheck=True)


def screw(k: int, angle: float, slide: float) -> np.ndarray:
    """A turn about an axis and a slide along it."""
    K = np.cross(np.eye(3), AXES[k])
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    T[:3, 3] = PLACES[k] - T[:3, :3] @ PLACES[k] + slide * AXES[k]
    return T


def off(theta: float, u: np.ndarray) -> np.ndarray:
    """How far the loop is open, by the turns and slides of its three cylindrical joints."""
    ahead = screw(0, theta, 0) @ screw(1, u[0], u[1]) @ screw(2, u[2], u[3])
    return (ahead - screw(3, u[4], u[5]))[:3].ravel()


def test_newton_finds_no_other_posture(rccc: ModuleType) -> None:
    rng, found = np.random.default_rng(1), 0
    for theta in rng.uniform(-3, 3, 25):
        psi, slides = rccc.fk([theta]).p[:, 0], rccc.slides([theta])
        for start in rng.uniform(-3, 3, (8, 6)):
            u = newton(lambda u: off(theta, u), start)  # noqa: B023
            if u is not None:
                found += 1
                gaps = np.abs(np.exp(1j * psi) - np.exp(1j * u[4]))
                assert np.nanmin(gaps + np.abs(slides - u[1::2]).max(axis=1)) < 1e-6
    assert found > 80


def test_the_drawing_is_a_posture(rccc: ModuleType) -> None:
    assert np.abs(rccc.fk([0]).p).min() < 1e-15
    assert np.abs(rccc.slides([0])).max(axis=1).min() < 1e-15


def test_the_article_says_what_slides(tmp_path: Path) -> None:
    """Directions that no equation defined, and a slide with the name of an angle."""
    d = read_script(script_of("rccc", TEXT, tmp_path))
    assert d.mechanism.startswith("Joints s1, s2 and psi are cylindrical.  The axes turn as")
    (article,) = pages(d, prove(d), ["latex"]).files.values()
    assert r"\mathbf v &= \mathbf b_1" in article and r"\mathbf t &= \mathbf b_2" in article
    assert r"slide in the joint $\psi$" in article and "direction $w$" not in article


def test_the_unit_of_the_lengths_does_not_count(rccc: ModuleType) -> None:
    """Rotations were singular where lengths are in millimetres: only angles count for them."""
    far = rccc.Parameters(a=100, h=50, f=300)
    for psi in np.linspace(-3, 3, 40):
        assert [*rccc.ik([psi], far).status] == [*rccc.ik([psi]).status]
        assert rccc.workspace_contains([psi], far) == rccc.workspace_contains([psi])
    for theta in np.linspace(-3, 3, 40):
        assert np.allclose(rccc.slides([theta], far), 1000 * rccc.slides([theta]), equal_nan=True)


def test_slides_are_not_those_of_any_crank() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Axes.", task=["psi"])
    theta, half = d.joint("theta"), Rational(1, 2)
    long = Crank(theta, half, sqrt(2), (0, 0, 1), along=(1, 0, 0), across=(0, 1, 0))
    other = Crank(real("psi"), 1, sqrt(2), (0, 0, 0), along=(0, 1, 0), across=(0, 0, 1))
    screws = Screws(("a", "b", "c"), *[(0, 0, 0)] * 4)
    with pytest.raises(ShapeError, match="ends are at the distance 1 from it"):
        coupled(d, long, other, screws=screws)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('kind = "cylindrical", axis = [0, 0.6', 'kind = "spherical", axis = [0, 0.6', "four"),
        ('hand = "psi"', 'hand = "s2"', "of which that on the ground is the task"),
        (
            "[0, 0.6, 0.8]",
            "[-0.6, 0, -0.8]",
            "s1 and s2, the joints of coupler, have",
        ),
        ("[0.6, 0, 0.8]", "[0, 0, 1]", "theta and s1, the joints of crank, have parallel axes"),
        (", axis = [0.6, 0, 0.8]", "", "s1 needs its axis"),
        ('crank = {A = [0, "a", "h"]}', 'crank = {A = [0, "a", 0]}', "A, where s1 is, has to be"),
    ],
)
def test_other_loops_with_cylinders_are_refused(
    old: str, new: str, said: str, tmp_path: Path
) -> None:
    assert old in TEXT
    with pytest.raises(TableError, match=said):
        script_of("rccc", TEXT.replace(old, new), tmp_path)
