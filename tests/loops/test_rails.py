"""PPR legs: a slider with a rail, along which the hand slides, beside each other kind of leg."""

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS
from sympy import Rational, Symbol, sqrt

from closedform import (
    Crank,
    Derivation,
    Paper,
    Rail,
    Slide,
    Stretch,
    parallel,
    platform,
    plot,
    prove,
    real,
)
from closedform.algebra.shapes import ShapeError
from closedform.check.crosscheck import crosscheck
from closedform.check.finding import module_backend
from closedform.scaffold.inputs.tables import TableError

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
L, H = 2.0, 1.0
WAY = np.array([0.6, 0.8])
START = np.array([0.2, -0.1])
KINDS = ("slide", "crank", "stretch", "rail")

GANTRY = """
hand = "P"
[parameters]
h = {value = "0.4", meaning = "height of the second slider"}
l = {value = "0.5", meaning = "rod"}
[bodies]
ground = {O = [0, 0], A = [0, "h"]}
carriage = {O = [0, 0]}
post = {P = [0, 0]}
slider = {S = [0, "h"]}
rod = {length = "l"}
[joints]
q1 = {between = ["ground", "carriage"], at = "O", kind = "prismatic", axis = [1, 0], driven = true}
s1 = {between = ["carriage", "post"], at = "O", kind = "prismatic", axis = [0, 1]}
q2 = {between = ["ground", "slider"], at = "A", kind = "prismatic", axis = [1, 0], driven = true}
b2 = {between = ["slider", "rod"], at = "S"}
p = {between = ["rod", "post"], at = "P"}
"""


def derivation(kind: str, *, last: bool = False) -> Derivation:
    """A rail and another leg; the rail is the ``last`` one if asked for."""
    d = Derivation("gantry", "Gantry", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    d.task = ["x", "y"]
    l, h = (d.parameter(n, value=v, unit="m", meaning=n) for n, v in (("L", 2), ("h", 1)))
    slides = ["q1", "q2"] if kind != "crank" else ["q2"] if last else ["q1"]
    q = [d.joint(n, "prismatic" if n in slides else "revolute") for n in ("q1", "q2")]
    s = d.joint("s", "prismatic", passive=True)
    a, b = q[::-1] if last else q
    start = (Rational("0.2"), Rational("-0.1"))
    rail = Rail(a, s, start, (1, 0), (Rational(3, 5), Rational(4, 5)))
    if kind == "rail":
        other = Rail(b, d.joint("t", "prismatic", passive=True), (h, 0), (0, 1), (1, 0))
    elif kind == "slide":
        other = Slide(b, l, (0, h), (0, 1))
    elif kind == "crank":
        other = Crank(b, h, l, pivot=(l, 0), along=(1, 0), across=(0, 1))
    else:
        other = Stretch(b, (l, h))
    parallel(d, (real("x"), real("y")), [other, rail] if last else [rail, other])
    return d


@pytest.fixture(scope="module")
def robots(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ModuleType]:
    folder = tmp_path_factory.mktemp("rails")
    (folder / "rails_script.py").write_text(Path(__file__).read_text("utf-8"), "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        return {
            kind: derived(
                f"gantry_{kind}",
                f"from rails_script import derivation\nd = derivation({kind!r})\n"
                f"d.name = 'gantry_{kind}'\n",
                folder,
            )
            for kind in KINDS
        }


def drawn(kind: str, rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Random hands, and joints that belong to them, both found from the drawing."""
    if kind == "crank":
        q = np.stack([rng.uniform(-3, 3, n), rng.uniform(-np.pi, np.pi, n)], 1)
        near = np.array([L, 0]) + H * np.stack([np.cos(q[:, 1]), np.sin(q[:, 1])], 1)
        turn = rng.uniform(-np.pi, np.pi, n)
        p = near + L * np.stack([np.cos(turn), np.sin(turn)], 1)
    else:
        p = rng.uniform(-3, 3, (n, 2))
        q = np.zeros((n, 2))
        if kind == "slide":
            p[:, 0] = rng.uniform(-L, L, n)
            q[:, 1] = p[:, 1] - H + rng.choice([-1, 1], n) * np.sqrt(L**2 - p[:, 0] ** 2)
        elif kind == "stretch":
            q[:, 1] = np.linalg.norm(p - [L, H], axis=1)
        else:
            q[:, 1] = p[:, 1]
    # the rail leads from (q1, 0) + START to the hand
    q[:, 0] = p[:, 0] - START[0] - (p[:, 1] - START[1]) * WAY[0] / WAY[1]
    return p, q


@pytest.mark.parametrize("kind", KINDS)
def test_no_posture_is_lost(robots: dict[str, ModuleType], kind: str) -> None:
    robot = robots[kind]
    p, q = drawn(kind, np.random.default_rng(1), 100_000)
    answers = robot.ik(p)
    turns = np.array([robot.SKELETON.joints[n].kind == "revolute" for n in robot.JOINTS])
    gap = answers.q - q[:, None]
    gap = np.abs(np.where(turns, np.angle(np.exp(1j * gap)), gap)).max(-1)
    assert np.nanmin(gap, axis=1).max() < 1e-6
    hands = robot.fk(q)
    assert np.nanmin(np.abs(hands.p - p[:, None]).max(-1), axis=1).max() < 1e-6
    back = robot.fk(answers.q)
    missed = np.nanmin(np.abs(back.p - p[:, None, None]).max(-1), axis=-1)
    assert missed[answers.status == OK].max() < 1e-12 * (L + H + np.abs(q).max())
    assert (answers.status == OK).mean() > 0.9
    # joints at random: what the hand is, is on the rail and keeps the rod
    q = np.random.default_rng(2).uniform(-4, 4, (20_000, 2))
    hands = robot.fk(q)
    reached = hands.status == OK
    off = hands.p - START - np.stack([q[:, :1], 0 * q[:, :1]], -1)
    assert np.abs((off @ [-WAY[1], WAY[0]])[reached]).max() < 1e-13


@pytest.mark.parametrize("kind", KINDS)
def test_the_jacobian_is_the_derivative(robots: dict[str, ModuleType], kind: str) -> None:
    robot, h = robots[kind], 1e-6
    _, q = drawn(kind, np.random.default_rng(3), 500)
    J = robot.jacobian(q)
    rates = [(robot.fk(q + s).p - robot.fk(q - s).p) / (2 * h) for s in h * np.eye(2)]
    off = np.abs(np.stack(rates, -1) - J)
    far = np.abs(robot.singularities(q)[..., -1]) > 0.05
    assert far.mean() > 0.5
    assert np.nanmax(off[far]) < 1e-5
    A, B = robot.jacobian_parallel(q), robot.jacobian_serial(q)
    assert np.allclose((A @ J)[far], (B[..., None] * np.eye(2))[far], atol=1e-12)


@pytest.mark.parametrize("last", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_modes_are_proved_in_either_order(kind: str, last: bool) -> None:
    modes = {"slide": (2, 2), "crank": (2, 2), "stretch": (2, 1), "rail": (1, 1)}[kind]
    proof = prove(derivation(kind, last=last))
    assert tuple(i.solutions for i in proof.inverses) == modes


def test_the_sign_of_the_mode_is_that_of_the_determinant(robots: dict[str, ModuleType]) -> None:
    for kind in ("slide", "crank", "stretch"):
        _, q = drawn(kind, np.random.default_rng(4), 300)
        value = np.linalg.det(robots[kind].jacobian_parallel(q))
        assert (np.sign(value) * [1, -1] > 0).mean() > 0.99
        assert robots[kind].ASSEMBLY_MODES == ("plus", "minus")


def test_the_crosscheck_of_a_file(tmp_path: Path) -> None:
    script = script_of("my_gantry", GANTRY, tmp_path)
    robot = derived("my_gantry", script, tmp_path)
    found = crosscheck(read_script(script), module_backend("numpy", robot))
    assert not [failure for f in found for failure in f.failures]
    q, status = robot.ik([0.1, 0.2])
    assert (status == OK).all()
    assert np.allclose(q, [[0.1, 0.1 - s * np.sqrt(0.5**2 - 0.2**2)] for s in (1, -1)])
    assert plot.branches(robot).figure is not None


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("axis = [0, 1]", "axis = [1, 0]", "q1 and s1 slide in the same direction"),
        (', axis = [0, 1]}', "}", "s1 slides; say in which direction"),
        ('["carriage", "post"]', '["carriage", "slider"]', "s1 does not lead to the hand P"),
        ("axis = [0, 1]}", "axis = [0, 1], driven = true}", "passive slide"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        script_of("gantry", GANTRY.replace(old, other), tmp_path)


SLANTED = (Rational(3, 5), Rational(4, 5))


def three_rails(joints: Sequence[Symbol]) -> list[Rail]:
    ways = [((0, 1), (1, 0), (1, 2)), ((1, 0), (0, 1), (2, 0)), (SLANTED, (1, 0), (0, 3))]
    return [
        Rail(q, real("s"), (0, 0), other, way, on_hand=place)
        for q, (way, other, place) in zip(joints, ways, strict=True)
    ]


STAGE = (TESTS / "held_out_loops" / "rail_stage.toml").read_text("utf-8")


def test_newton_finds_no_joints_of_a_stage_on_a_rail_that_the_inverse_lacks(tmp_path: Path) -> None:
    """A 2-RPR + PPR stage, against its drawing."""
    script = script_of("stage_on_a_rail", STAGE, tmp_path)
    stage = derived("stage_on_a_rail", script, tmp_path, crosscheck=True)
    v, rng = stage.Parameters(), np.random.default_rng(1)

    def missed(x: np.ndarray, q: np.ndarray) -> np.ndarray:
        turned = np.array([[np.cos(x[2]), -np.sin(x[2])], [np.sin(x[2]), np.cos(x[2])]])
        C1, C2, C3 = x[:2] + np.array([[-v.a, 0], [v.a, 0], [0, v.a]]) @ turned.T
        rod = np.hypot(*(C1 - [-v.b, 0])) - q[0]
        return np.array([rod, np.hypot(*(C2 - [v.b, 0])) - q[1], C3[0] - q[2]])

    for x in rng.uniform((-0.1, -0.2, -0.5), (0.1, 0.2, 0.5), (10, 3)):
        [q], [status] = stage.ik(x)
        assert status == 0 and len(q) == 3
        for start in rng.uniform(0.1, 1, (5, 3)):
            found = newton(lambda q: missed(x, q), start)  # noqa: B023
            assert found is None or found[0] < 0 or q[0] == pytest.approx(found[0])
        assert np.abs(missed(x, q)).max() < 1e-12
        step = np.array([1e-6, -1e-6, 2e-6])
        K = stage.jacobian_inverse(x, q)
        assert np.allclose(stage.ik(x + step).q[0] - q, K @ step, atol=1e-10)
        assert np.allclose(stage.jacobian(x, q) @ K, np.eye(3))
        assert np.isclose(stage.determinant(x, q), 1 / np.linalg.det(K))


def test_the_degree_of_a_hand_that_turns_on_a_rail() -> None:
    """It has no fk, but its inverse; such legs were refused."""
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    joints = [d.joint(f"q{k}", "prismatic") for k in range(3)]
    rods = [
        Slide(joints[0], 3, (0, 0), (1, 0), on_hand=(1, 2)),
        Slide(joints[1], 4, (5, 1), (0, 1), on_hand=(2, 0)),
    ]
    platform(d, [*rods, three_rails(joints)[2]])
    assert "Forward: an equation of degree 6" in [s.title for s in d.steps]
    assert {i.function: i.solutions for i in prove(d).inverses} == {"ik": 4}


def test_a_rail_may_have_a_direction_with_roots() -> None:
    d = Derivation("gantry", "Gantry", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    d.task = ["x", "y"]
    joints = [d.joint(f"q{k}", "prismatic") for k in (1, 2)]
    ways = [((1, 0), (Rational(1, 2), sqrt(3) / 2)), ((0, 1), (sqrt(2) / 2, -sqrt(2) / 2))]
    legs = [
        Rail(q, d.joint(f"s{q}", "prismatic", passive=True), (k, 0), direction, along)
        for k, (q, (direction, along)) in enumerate(zip(joints, ways, strict=True))
    ]
    parallel(d, (real("x"), real("y")), legs)
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 1, "ik": 1}


def test_rails_that_cannot_be_say_why() -> None:
    q, s = real("q"), real("s")
    with pytest.raises(ShapeError, match="must differ"):
        Rail(q, s, (0, 0), (1, 0), (1, 0))
    with pytest.raises(ShapeError, match="must differ, and both must be numbers"):
        Rail(q, s, (0, 0), (1, 0), (real("a"), real("b")))
    with pytest.raises(ShapeError, match="in a plane"):
        Rail(q, s, (0, 0, 0), (1, 0, 0), (0, 1, 0))
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    d.task = ["x", "y"]
    pair = [d.joint(f"q{k}", "prismatic") for k in (1, 2)]
    with pytest.raises(ShapeError, match="are parallel"):
        parallel(
            d,
            (real("x"), real("y")),
            [Rail(q, s, (0, k), (1, 0), (0, 1)) for k, q in enumerate(pair)],
        )
