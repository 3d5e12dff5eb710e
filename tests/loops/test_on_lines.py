"""A hand whose balls slide along three horizontal lines (CaPaMan), against rigid bodies."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS
from sympy import Rational, sqrt

from closedform import BallOnLine, Crank, Derivation, Paper, Slide, on_lines, plot, prove
from closedform.algebra.shapes import ShapeError
from closedform.emit.pages import pages
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "capaman.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
ASIDE = np.stack([-np.sin(ANGLES), np.cos(ANGLES), 0 * ANGLES], axis=1)
UP = np.array([0, 0, 1])
BASE, HEIGHT, CRANK, HAND = 0.1, 0.05, 0.08, 0.12


@pytest.fixture(scope="module")
def capaman(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("capaman")
    return derived("capaman", script_of("capaman", TEXT, folder), folder, crosscheck=True)


def rotated(w: np.ndarray) -> np.ndarray:
    """The rotation by a vector, whose length is its angle."""
    angle = np.linalg.norm(w)
    K = np.cross(np.eye(3), w / max(angle, 1e-300))
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def off(q: np.ndarray, p: np.ndarray, R: np.ndarray) -> np.ndarray:
    """How far the balls are from their lines, across and in height."""
    line = BASE * OUT + HEIGHT * UP + CRANK * (np.cos(q)[:, None] * ASIDE + np.outer(np.sin(q), UP))
    gap = p + HAND * OUT @ R.T - line
    return np.concatenate([gap[:, 2], (gap * ASIDE).sum(axis=1)])


def tilted(x: np.ndarray) -> np.ndarray:
    """The last row of the rotation at both tilts, which a twist about z keeps."""
    (_, a, b) = x
    return np.array([-np.sin(b), np.cos(b) * np.sin(a), np.cos(b) * np.cos(a)])


def test_all_poses_close_the_loop(capaman: ModuleType) -> None:
    q = np.random.default_rng(1).uniform(-3, 3, (3000, 3))
    (x, status), T = capaman.fk(q), capaman.hand_pose(q)
    assert 0.3 < (status == OK).mean() < 0.9
    for i, k in zip(*np.nonzero(status == OK), strict=True):
        R, p = T[i, k, :3, :3], T[i, k, :3, 3]
        assert np.abs(off(q[i], p, R)).max() < 1e-14
        assert np.allclose(R.T @ R, np.eye(3)) and np.isclose(np.linalg.det(R), 1)
        assert np.isclose(p[2], x[i, k, 0]) and np.allclose(R[2], tilted(x[i, k]))


def test_newton_finds_no_other_posture(capaman: ModuleType) -> None:
    """A hand that is nearly level has poses upside down for few joints; half of these have them."""
    rng, seen = np.random.default_rng(2), set()
    over = capaman.ik(rng.uniform(1.9, 2.4, (40, 3)) * (0.02, 1, 0.2))
    turned_over = over.q[over.status == OK][:12]
    for q in [*rng.uniform(0, 3, (12, 3)), *turned_over]:
        T, status = capaman.hand_pose(q), capaman.fk(q).status
        for start in rng.normal(0, 1, (12, 6)) * (0.1, 0.1, 0.1, 2, 2, 2):
            u = newton(lambda u: off(q, u[:3], rotated(u[3:])), start)  # noqa: B023
            if u is not None:
                gaps = np.abs(T[:, :3, :3] - rotated(u[3:])).max(axis=(1, 2))
                gaps += np.abs(T[:, :3, 3] - u[:3]).max(axis=1)
                mode = int(np.nanargmin(gaps))
                seen.add(mode)
                assert gaps[mode] < 1e-6 and status[mode] == OK
    assert seen == {0, 1, 2, 3}


def test_the_inverse_reaches_its_targets(capaman: ModuleType) -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(-1, 1, (20_000, 3)) * (0.1, 1, 1)
    q, status = capaman.ik(x)
    assert q.shape == (20_000, 8, 3) and not (status == SINGULAR).any()
    assert ((status == OK).any(axis=1) == capaman.workspace_contains(x)).all()
    i, k = np.nonzero(status == OK)
    assert len(i) > 10_000
    p, modes = capaman.fk(q[i, k])
    assert ((modes == OK) & (np.abs(p - x[i, None]).max(axis=-1) < 1e-12)).sum(axis=1).min() == 2
    for target in x[:300]:  # heights of the corners that no joint reaches, or no twist
        heights = target[0] + HAND * OUT @ tilted(target) - HEIGHT
        if (np.abs(heights) > CRANK).any():
            assert (capaman.ik(target).status == UNREACHABLE).all()
    assert (capaman.ik([0.05, 0, 2]).status == UNREACHABLE).all()
    assert (capaman.ik([0.05, np.pi / 2, 0]).status != OK).all()


def test_derivatives(capaman: ModuleType) -> None:
    q = np.random.default_rng(4).uniform(0, 3, (800, 3))
    steps = 1e-6 * np.eye(3)
    rates = np.stack([(capaman.fk(q + s).p - capaman.fk(q - s).p) / 2e-6 for s in steps], axis=-1)
    J, A, B = (getattr(capaman, f"jacobian{name}")(q) for name in ("", "_parallel", "_serial"))
    tame = (np.abs(J).max(axis=(-1, -2)) < 20) & np.isfinite(rates).all(axis=(-1, -2))
    assert tame.sum() > 500
    np.testing.assert_allclose(J[tame], rates[tame], atol=1e-6)
    np.testing.assert_allclose((A @ J)[tame], (B[..., None] * np.eye(3))[tame], atol=1e-12)
    np.testing.assert_allclose(capaman.determinant(q)[tame], np.linalg.det(J[tame]), rtol=1e-9)
    spin = capaman.singularities(q)[..., 4] * [1, -1, 1, -1]
    assert (spin[capaman.fk(q).status == OK] >= 0).all()


def test_the_article_has_no_names_of_the_program(tmp_path: Path) -> None:
    """The pose had the twist under names that no line of it defines, and letters meant two things.

    The letters b, c and h are those of parameters.
    """
    d = read_script(script_of("capaman", TEXT, tmp_path))
    (article,) = pages(d, prove(d), ["latex"]).files.values()
    assert r"\mathrm{twist} = \operatorname{atan2}" in article
    code = r"mathrm\{(root|reach|length|spin|edge)\}|(?<![a-z])[abch]_\{[0-3]\}"
    assert not re.search(code, article)
    assert r"\rho &= \rho" not in article and "B_{11} = B" not in article
    step = article.partition(r"\subsection{The loop}")[2].partition(r"\subsection")[0]
    assert "$r$" in step and "point $b$" not in step


def test_the_balls_are_drawn(capaman: ModuleType) -> None:
    ax = plot.mechanism(capaman, [0.5, 0.6, 0.4], labels=False, axes=False)
    circles = [len(line.get_xdata()) for line in ax.lines if line.get_marker() == "o"]
    assert sorted(circles) == [1, 1, 1, 3]  # three cranks, and the balls at the ends of the slides


def toy() -> Derivation:
    return Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Lines.")


def legs(d: Derivation, ways: list, corners: list, movers: list) -> list[BallOnLine]:
    slides = [d.joint(f"s{k}", "prismatic", passive=True) for k in range(3)]
    return [BallOnLine(*leg) for leg in zip(movers, slides, ways, corners, strict=True)]


def movers(d: Derivation) -> list:
    """A slider, a crank with an oblique plane, and an oblique slider."""
    q = [d.joint("q0", "prismatic"), d.joint("q1"), d.joint("q2", "prismatic")]
    slant = (0, Rational(3, 5), Rational(4, 5))
    return [
        Slide(q[0], 0, (1, 0, 0), (0, 0, 1)),
        Crank(q[1], Rational(1, 2), 0, (0, 1, 0), along=slant, across=(1, 0, 0)),
        Slide(q[2], 0, (0, -1, Rational(1, 3)), slant),
    ]


def test_lines_of_any_directions_are_proved() -> None:
    d, ways = toy(), [(1, 0), (0, 1), (Rational(3, 5), Rational(-4, 5))]
    on_lines(d, legs(d, ways, [(1, 0), (0, 2), (-1, -1)], movers(d)))
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 4, "ik": 2}


def test_two_lines_may_be_parallel() -> None:
    """They determine the twist, and the third one the place along them."""
    d = toy()
    on_lines(d, legs(d, [(1, 0), (1, 0), (0, 1)], [(1, 0), (0, 2), (-1, -1)], movers(d)))
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 4, "ik": 2}


def test_what_does_not_hold_the_hand_says_why() -> None:
    corners, ways = [(1, 0), (0, 1), (-1, 0)], [(1, 0), (0, 1), (sqrt(2) / 2, sqrt(2) / 2)]
    d = toy()
    with pytest.raises(ShapeError, match="three lines are parallel"):
        on_lines(d, legs(d, [(0, 1)] * 3, corners, movers(d)))
    d = toy()
    with pytest.raises(ShapeError, match="corners of the hand are in line"):
        on_lines(d, legs(d, ways, [(1, 0), (0, 0), (-1, 0)], movers(d)))
    d = toy()
    q, s = d.joint("q", "prismatic"), d.joint("s", "prismatic", passive=True)
    with pytest.raises(ShapeError, match="q: the slide has to move its line up or down"):
        BallOnLine(Slide(q, 0, (0, 0, 0), (1, 0, 0)), s, (0, 1), (1, 0))
    with pytest.raises(ShapeError, match="q: the direction of a line must be a unit vector"):
        BallOnLine(Slide(q, 0, (0, 0, 0), (0, 0, 1)), s, (1, 1), (1, 0))


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        (", parallelogram = [0, 0.08, 0]", "", "crank1"),
        ("copies = 3", "copies = 2", "lines needs 3 legs, and has 2"),
        ("copies = 3", "copies = 4", "lines needs 3 legs, and has 4"),
        ('C1 = ["c", 0, 0]', 'C1 = ["c", 0, "h"]', "C1 is above or below P"),
        ('"prismatic", axis = [1, 0, 0]', '"prismatic", axis = [1, 0, 1]', "degree eight"),
    ],
)
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    text = TEXT
    if "parallelogram" in old:
        text = text.replace('"A1", axis = [1, 0, 0]', '"A1", axis = [0, 1, 1]')
    assert old in text
    with pytest.raises(TableError, match=message):
        script_of("capaman", text.replace(old, other), tmp_path)


def test_a_plain_crank_with_the_axis_of_its_line(tmp_path: Path) -> None:
    plain = script_of("capaman", TEXT.replace(", parallelogram = [0, 0.08, 0]", ""), tmp_path)
    assert plain == script_of("capaman", TEXT, tmp_path)
