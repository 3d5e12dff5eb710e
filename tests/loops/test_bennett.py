"""A Bennett linkage against turns about its four axes."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from closedform.derivations.figures import figures as figures_of
from loop_files import derived, newton, script_of, unbroken
from places import TESTS
from sympy import Rational, sqrt

from closedform import Derivation, Hinge, Paper, bennett, real
from closedform.algebra.shapes import ShapeError
from closedform.plot.catalogue import fits
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "bennett.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def linkage(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("bennett")
    return derived("bennett", script_of("bennett", TEXT, folder), folder, crosscheck=True)


def turn(x: float, twist: float, angle: float) -> np.ndarray:
    """A turn about an axis at right angles to the x axis."""
    u = np.array([0, -np.sin(twist), np.cos(twist)])
    K, p = np.cross(np.eye(3), u), np.array([x, 0, 0])
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    T[:3, 3] = p - T[:3, :3] @ p
    return T


def chain(v, theta: float, rest: np.ndarray) -> np.ndarray:
    b = v.a * np.sin(v.beta) / np.sin(v.alpha)
    places = zip((0, v.a, v.a + b, b), (0, v.alpha, v.alpha + v.beta, v.beta), strict=True)
    T = np.eye(4)
    for (x, twist), angle in zip(places, [theta, *rest[:2], -rest[2]], strict=True):
        T = T @ turn(x, twist, angle)
    return T


def test_newton_finds_no_other_posture(linkage: ModuleType) -> None:
    rng, found = np.random.default_rng(1), 0
    for v in (linkage.Parameters(), linkage.Parameters(a=2, alpha=-0.7, beta=2.6)):
        for theta in rng.uniform(-3, 3, 12):
            [[psi]], [status] = linkage.fk([theta], v)
            closed = chain(v, theta, np.array([psi, -theta, psi]))
            assert status == OK and np.allclose(closed, np.eye(4), atol=1e-12)
            for start in rng.uniform(-3, 3, (8, 3)):
                u = newton(lambda u: (chain(v, theta, u) - np.eye(4))[:3].ravel(), start)  # noqa: B023
                if u is not None:
                    found += 1
                    assert abs(np.exp(1j * u[2]) - np.exp(1j * psi)) < 1e-6
    assert found > 80


def test_the_inverse_and_the_rate(linkage: ModuleType) -> None:
    for theta in np.linspace(-3.1, 3.1, 20):
        psi = linkage.fk([theta]).p[0]
        assert np.allclose(linkage.ik(psi).q, theta)
        moved = linkage.fk([theta + 1e-6]).p[0] - psi
        assert np.allclose(moved / 1e-6, linkage.jacobian([theta])[0], rtol=1e-4)


def test_what_depends_on_the_posture_has_an_axis_for_its_mode(linkage: ModuleType) -> None:
    """No figure could be drawn."""
    assert linkage.jacobian([0.3]).shape == (1, 1, 1)
    assert linkage.skeleton([0.3]).shape == (1, len(linkage.SKELETON.points), 3)
    names = [f.name for f in figures_of("bennett") if fits(linkage, f.name)]
    assert names == ["mechanism", "motion"]
    for name in names:
        next(f for f in figures_of("bennett") if f.name == name).draw(linkage)


def test_equal_bodies_turn_about_one_axis(linkage: ModuleType) -> None:
    v = linkage.Parameters(alpha=1, beta=1)
    assert np.isclose(abs(linkage.fk([0.5], v).p.item()), np.pi)  # the coupler is on the ground
    assert linkage.fk([0], v).status.item() == SINGULAR
    assert linkage.fk([0.5]).status.item() == OK


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('B = ["a", 0, 0]', 'B = ["a", "a", 0]'),
        ('coupler = {length = "a*sin(beta)/sin(alpha)"}', 'coupler = {length = "a"}'),
        ('D = ["a*sin(beta)/sin(alpha)", 0, 0]', 'D = ["a", 0, 0]'),
        ('"-sin(alpha + beta)", "cos(alpha + beta)"', '"-sin(alpha)", "cos(alpha)"'),
        ('axis = [0, "-sin(beta)", "cos(beta)"]', 'axis = ["sin(beta)", 0, "cos(beta)"]'),
        ('crank = {B = ["a", 0, 0]}', "crank = {}"),
    ],
)
def test_other_loops_of_four_axes_are_refused(old: str, new: str, tmp_path: Path) -> None:
    assert old in TEXT
    with pytest.raises(TableError, match=r"a\*sin\(beta\) = b\*sin\(alpha\)"):
        script_of("bennett", TEXT.replace(old, new), tmp_path)


def test_axes_may_point_either_way_and_bodies_have_points(tmp_path: Path) -> None:
    b = "a*sin(beta)/sin(alpha)"
    text = TEXT.replace(f'{{length = "{b}"}}', f'{{B = [0, 0, 0], C = [0, "{b}", 0]}}')
    text = text.replace('"-sin(alpha)", "cos(alpha)"', '"sin(alpha)", "-cos(alpha)"')
    script = unbroken(script_of("bennett", text, tmp_path))
    assert script.count("Hinge(") == 4 and "bennett(d, psi, [" in script


def test_hinges_that_do_not_fit_are_refused() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Axes.", task=["psi"])
    d.joint("theta")
    half = Rational(1, 2)
    axes = [(0, 0, 1), (0, half, sqrt(3) / 2), (0, 0, 1), (0, half, sqrt(3) / 2)]
    hinges = [Hinge((x, 0, 0), axis) for x, axis in zip((0, 1, 3, 2), axes, strict=True)]
    with pytest.raises(ShapeError, match="the sines of both angles are as the lengths"):
        bennett(d, real("psi"), hinges)
    with pytest.raises(ShapeError, match="four hinges and one motor"):
        bennett(d, real("psi"), hinges[:3])
