"""A hand on a cross, whose two axes need not meet, against its drawing."""

from pathlib import Path
from types import ModuleType

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform import plot
from closedform.cli.commands import main
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

mpl.use("Agg")
TEXT = (TESTS / "held_out_loops" / "offset_ankle.toml").read_text("utf-8")
CRANKS = (
    TEXT.replace("tube", "crank")
    .replace("piston", "rod")
    .replace("crank1 = {}", 'crank1 = {B1 = ["-2*b", "w", "l"]}')
    .replace("crank2 = {}", 'crank2 = {B2 = ["-2*b", "-w", "l"]}')
    .replace("rod1 = {}", 'rod1 = {length = "l + h"}')
    .replace("rod2 = {}", 'rod2 = {length = "l + h"}')
    .replace('"A1", kind = "universal"', '"A1", axis = [0, 1, 0], driven = true')
    .replace('"A2", kind = "universal"', '"A2", axis = [0, 1, 0], driven = true')
    .replace('at = "A1", kind = "prismatic", driven = true', 'at = "B1", kind = "spherical"')
    .replace('at = "A2", kind = "prismatic", driven = true', 'at = "B2", kind = "spherical"')
)
OK = 0


@pytest.fixture(scope="module", params=["cylinders", "cranks"])
def ankle(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = TEXT if request.param == "cylinders" else CRANKS
    assert len(text.splitlines()) < 40
    folder, name = tmp_path_factory.mktemp("cross"), f"{request.param}_on_cross"
    return derived(name, script_of(name, text, folder), folder, crosscheck=True)


def about_y(a: float) -> np.ndarray:
    return np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])


def about_x(a: float) -> np.ndarray:
    return np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])


def ends(ankle: ModuleType, x: np.ndarray) -> np.ndarray:
    """Where the rods end on the foot, as the drawing has it."""
    v = ankle.Parameters()
    pitched, turned = about_y(x[0]), about_y(x[0]) @ about_x(x[1])
    hold = np.array([[-v.b, v.w, 0], [-v.b, -v.w, 0]])
    return np.array(pitched @ [0, 0, -v.h] + hold @ turned.T)


def missed(ankle: ModuleType, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    v = ankle.Parameters()
    near = np.array([[-v.b, v.w, v.l], [-v.b, -v.w, v.l]])
    if "cylinders" in ankle.__name__:
        return np.linalg.norm(ends(ankle, x) - near, axis=1) - q
    near[:, 0] -= v.b * np.cos(q)
    near[:, 2] += v.b * np.sin(q)
    return np.linalg.norm(ends(ankle, x) - near, axis=1) - v.l - v.h


def test_newton_finds_no_joints_that_the_closed_form_lacks(ankle: ModuleType) -> None:
    rng, seen = np.random.default_rng(1), 0
    cranks = "cranks" in ankle.__name__
    for x in rng.uniform(-0.5, 0.5, (20, 2)):
        answers = ankle.ik(x)
        for start in rng.uniform(-3, 3, (20, 2)):
            q = newton(lambda q: missed(ankle, x, q), start if cranks else abs(start))  # noqa: B023
            if q is not None:
                gaps = answers.q - q
                gaps = np.angle(np.exp(1j * gaps)) if cranks else gaps
                assert np.nanmin(np.abs(gaps).max(axis=-1)) < 1e-7
                seen += 1
        for row in answers.q[answers.status == OK]:
            assert np.abs(missed(ankle, x, row)).max() < 1e-14
    assert seen > 100


def test_the_jacobian_is_that_of_small_motions(ankle: ModuleType) -> None:
    rng, h, count = np.random.default_rng(2), 1e-6, 0
    for x in rng.uniform(-0.4, 0.4, (30, 2)):
        q, status = ankle.ik(x)
        for k in np.flatnonzero(status == OK):
            K, J = ankle.jacobian_inverse(x, q[k]), ankle.jacobian(x, q[k])
            if np.abs(K).max() > 20 or np.abs(J).max() > 20:
                continue
            steps = [(ankle.ik(x + s).q[k] - ankle.ik(x - s).q[k]) / (2 * h) for s in h * np.eye(2)]
            assert np.allclose(np.array(steps).T, K, rtol=1e-5, atol=1e-6)
            assert np.allclose(J @ K, np.eye(2), atol=1e-9)
            assert np.isclose(ankle.determinant(x, q[k]), np.linalg.det(J))
            count += 1
    assert count > 20


def test_the_pose_and_the_drawing_have_the_cross(ankle: ModuleType) -> None:
    x = np.array([0.3, -0.2])
    v, q = ankle.Parameters(), ankle.ik(x).q[0]
    T = ankle.hand_pose(x)
    assert np.allclose(T[:3, 3], about_y(x[0]) @ [0, 0, -v.h], atol=1e-15)
    assert np.allclose(T[:3, :3], about_y(x[0]) @ about_x(x[1]), atol=1e-15)
    at = dict(zip(ankle.SKELETON.points, ankle.skeleton(x, q), strict=True))
    assert np.allclose(at["O"], 0) and np.allclose(at["P"], T[:3, 3])
    assert np.allclose([at["C1"], at["C2"]], ends(ankle, x), atol=1e-15)
    assert plot.mechanism(ankle, q, x=x) is not None
    plt.close("all")
    assert np.allclose(Robot(ankle).nearest(x, q + 1e-3).q, q)


def test_axes_that_meet_are_those_of_a_universal_joint(tmp_path: Path) -> None:
    met = TEXT.replace('P = [0, 0, "-h"]', "P = [0, 0, 0]")
    assert "Gimbal((0, 0, 0), (0, 1, 0), (1, 0, 0))" in script_of("met", met, tmp_path)


def test_an_article_is_printed(tmp_path: Path) -> None:
    script = tmp_path / "ankle.py"
    script.write_text(script_of("ankle", TEXT, tmp_path), "utf-8")
    assert main(["derive", str(script), "-o", str(tmp_path / "out"), "--backend", "latex"]) == 0
    printed = (tmp_path / "out" / "latex" / "ankle.tex").read_text("utf-8")
    assert r"\mathbf f_i - \mathbf s" in printed


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("axis = [1, 0, 0]}", "axis = [1, 1, 0]}", "pitch and roll .* have to be at right angles"),
        (", axis = [1, 0, 0]}", "}", "pitch and roll .* give both their axis"),
        ("foot = {P", "foot = {Q = [0, 0, 0], P", ""),
        ('"foot"], at = "P"', '"foot"], at = "C1"', "roll has to be at P, a point of its axis"),
    ],
)
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in TEXT
    if not message:
        assert "Cross(" in script_of("t", TEXT.replace(old, other), tmp_path)
        return
    with pytest.raises(TableError, match=message):
        script_of("t", TEXT.replace(old, other), tmp_path)
