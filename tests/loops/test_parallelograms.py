"""Hands that parallelograms keep from turning, and joints that they drive; against their rods."""

import importlib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from loop_files import derived, newton, read_script, script_of, unbroken

from closedform import Derivation, Paper, Parallelogram, Slide, platform, prove, real
from closedform.algebra.shapes import ShapeError
from closedform.loops.held import LEFT_OUT
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.new import new

HANDS = ("delta", "linear_delta", "orthoglide")
WIDTH = 0.03
PLANAR = """
from sympy import Rational
from closedform import Crank, Derivation, Paper, Parallelogram, parallel, real

d = Derivation(
    "level", "Level", Paper("level", "Level", ("A. Nonymous",)), "Two legs.", task=["x", "y"]
)
L0, L1, L2, w = (
    d.parameter(name, value=Rational(value), unit="m", meaning=name, source="an example")
    for name, value in (("L0", "0.2"), ("L1", "0.3"), ("L2", "0.4"), ("w", "0.05"))
)
q1, q2 = d.joint("q1"), d.joint("q2")
arm, fore = Parallelogram(L1, (0, 1), w), Parallelogram(L2, (Rational(3, 5), Rational(4, 5)), w)
parallel(d, (real("x"), real("y")), [
    Crank(q1, arm, fore, (0, 0), (1, 0), (0, 1)),
    Crank(q2, L1, L2, (L0, 0), (1, 0), (0, 1), on_hand=(w, 0)),
])
"""


def generated(name: str) -> ModuleType:
    return importlib.import_module(f"closedform.generated.numpy.{name}")


@pytest.fixture(scope="module")
def level(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("level", PLANAR, tmp_path_factory.mktemp("level"))


def legs(name: str, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Near ends, corners of the hand, directions of the bars, and the length of the rods."""
    values = generated(name).Parameters()
    if name == "orthoglide":
        return np.diag(q), np.zeros((3, 3)), np.eye(3)[[1, 2, 0]], values.L
    alpha = 2 * np.pi / 3 * np.arange(3)
    out = np.stack([np.cos(alpha), np.sin(alpha), 0 * alpha], -1)
    bars = np.stack([-np.sin(alpha), np.cos(alpha), 0 * alpha], -1)
    up = np.array([0, 0, 1])
    if name == "delta":
        far, down = values.f + values.L * np.cos(q), values.L * np.sin(q)
        return far[:, None] * out - down[:, None] * up, values.e * out, bars, values.l
    return values.f * out + q[:, None] * up, values.e * out, bars, values.l


def turned(w: np.ndarray) -> np.ndarray:
    """The rotation by the angle |w| about w."""
    angle = np.linalg.norm(w)
    x, y, z = w
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    half = np.sinc(angle / 2 / np.pi)
    return np.eye(3) + np.sinc(angle / np.pi) * K + half**2 / 2 * K @ K


def misses(name: str, q: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """By how much the six rods are too long, for a hand at p that is turned."""
    near, corners, bars, length = legs(name, q)
    R, p = turned(pose[3:]), pose[:3]
    found = []
    for side in (WIDTH, -WIDTH):
        far = p + (corners + side * bars) @ R.T
        found += [*(np.linalg.norm(far - near - side * bars, axis=-1) - length)]
    return np.array(found)


def home(name: str) -> np.ndarray:
    return {"delta": np.full(3, 0.5), "linear_delta": np.full(3, 0.3), "orthoglide": np.ones(3)}[
        name
    ]


@pytest.mark.parametrize("name", HANDS)
def test_six_rods_hold_the_hand_as_three_do(name: str) -> None:
    """Solved with the orientation unknown: what is not turned is in fk, the rest is left out."""
    module, rng = generated(name), np.random.default_rng(1)
    size = max(map(abs, module.Parameters()[:4]))
    same = other = 0
    for q in home(name) + rng.uniform(-0.15, 0.15, (4, 3)):
        p = module.fk(q).p
        for _ in range(12):
            start = np.concatenate([rng.uniform(-size, size, 3), rng.uniform(-0.5, 0.5, 3)])
            pose = newton(lambda pose: misses(name, q, pose), start)  # noqa: B023
            if pose is None:
                continue
            if np.abs(turned(pose[3:]) - np.eye(3)).max() < 1e-6:
                same += 1
                assert np.abs(p - pose[:3]).max(axis=-1).min() < 1e-6
            else:
                other += 1
    assert same > 10
    assert other > 0  # a twisted parallelogram, which the documentation says is left out


@pytest.mark.parametrize("name", HANDS)
def test_the_constraint_is_how_the_rods_hold_the_rotation(name: str) -> None:
    """Its value is the determinant of the derivatives of the differences of the rods."""
    module, rng = generated(name), np.random.default_rng(2)
    for q in home(name) + rng.uniform(-0.2, 0.2, (10, 3)):
        *_, length = legs(name, q)
        for p, value in zip(module.fk(q).p, module.constraint(q)[:, 0], strict=True):
            step, rates = 1e-6, []
            for e in np.eye(3):
                ends = [misses(name, q, np.concatenate([p, s * step * e])) for s in (1, -1)]
                change = (ends[0] - ends[1]) / (2 * step)
                rates.append((change[:3] - change[3:]) * length / (2 * WIDTH))
            # a rod changes by its unit vector times the motion of its end: w x (+-h u) and the turn
            assert abs(np.linalg.det(rates) - value) < 1e-6 * length**3


@pytest.mark.parametrize("name", HANDS)
def test_both_rods_are_drawn(name: str) -> None:
    module = generated(name)
    at = dict(zip(module.SKELETON.points, module.skeleton(home(name))[0], strict=True))
    *_, length = legs(name, home(name))
    for k in "123":
        rods = [module.SKELETON.links[f"rod{k}{side}"] for side in "ab"]
        spans = np.array([at[far] - at[near] for near, far in rods])
        np.testing.assert_allclose(np.linalg.norm(spans, axis=-1), length, atol=1e-14)
        np.testing.assert_allclose(spans[0], spans[1], atol=1e-14)
        bars = at[rods[0][0]] - at[rods[1][0]], at[rods[0][1]] - at[rods[1][1]]
        np.testing.assert_allclose(*bars, atol=1e-14)
        assert np.linalg.norm(bars[0]) > 0.01


@pytest.mark.parametrize("name", HANDS)
def test_the_mode_that_is_left_out_is_named(name: str) -> None:
    module = generated(name)
    for function in (module.fk, module.ik):
        assert "antiparallelogram" in function.__doc__
    d = importlib.import_module(f"closedform.derivations.{name}").d
    assert all(LEFT_OUT in f.notes for f in d.functions if f.name in ("fk", "ik"))


def test_a_level_hand_in_a_plane(level: ModuleType) -> None:
    """With the angle of the hand unknown, small starts lead to 0, and a crossed one exists."""
    L0, L1, L2, w = level.Parameters()
    rng, bar, fore = np.random.default_rng(3), np.array([0, 1]), np.array([0.6, 0.8])
    found = {"same": 0, "other": 0}
    for q in rng.uniform(-1, 1, (8, 2)) + np.array([2, 1]):
        elbow, other = ([L1 * np.cos(a), L1 * np.sin(a)] for a in q)
        other[0] += L0

        def rods(x: np.ndarray) -> np.ndarray:
            """The plate at the elbow is turned by x[3], the hand by x[2]."""
            plate, hand = (np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
                           for a in (x[3], x[2]))  # fmt: skip
            near, p = np.array(elbow), x[:2]  # noqa: B023
            ends = [
                (near + plate @ bar * w - bar * w, L1),  # the second crank
                (p - near, L2),
                (p + hand @ fore * w - near - plate @ fore * w, L2),
                (p + hand @ (w, 0) - other, L2),  # noqa: B023
            ]
            return np.array([np.linalg.norm(v) - length for v, length in ends])

        expected = level.fk(q).p
        for start in rng.uniform(-1, 1, (20, 4)) * (0.6, 0.6, 2, 2):
            x = newton(rods, start)
            if x is None:
                continue
            level_hand = np.abs(np.sin(x[2:] / 2)).max() < 1e-6
            found["same" if level_hand else "other"] += 1
            if level_hand:
                assert np.abs(expected - x[:2]).max(axis=-1).min() < 1e-6
    assert min(found.values()) > 3


def test_the_constraint_in_a_plane_is_that_of_flat_linkages(level: ModuleType) -> None:
    q = np.random.default_rng(4).uniform(-3, 3, (100, 2))
    L1 = level.Parameters().L1
    p = level.fk(q).p
    elbow = L1 * np.stack([np.cos(q[:, 0]), np.sin(q[:, 0])], -1)
    rod = p - elbow[:, None]
    expected = (0.6 * rod[..., 1] - 0.8 * rod[..., 0]) * -elbow[:, None, 0]
    np.testing.assert_allclose(level.constraint(q)[..., 0], expected, atol=1e-14)
    assert {"crank1c", "crank1d", "rod1a", "rod1b", "rod2"} <= set(level.SKELETON.links)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Crank(q1, arm,", "Crank(q1, L1,", "the crank of q1 turns the bar on it; the crank has"),
        ("arm, fore, (0", "arm, L2, (0", "nothing keeps it from turning; one rod has to be"),
        ("(Rational(3, 5), ", "(Rational(3, 4), ", "a unit vector with 2 entries"),
        ("(L1, (0, 1), w)", "(L1, (0, 1, 0), w)", "a unit vector with 2 entries"),
    ],
)
def test_refusals_in_a_plane(old: str, new: str, said: str) -> None:
    assert old in PLANAR
    with pytest.raises(ShapeError, match=said):
        read_script(PLANAR.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("bar=(-sin(alpha), cos(alpha), 0)", "bar=out", "the bar has to be along its axis"),
        ("L, rod, pivot", "L, l, pivot", "all three rods have to be a Parallelogram"),
    ],
)
def test_refusals_in_space(old: str, new: str, said: str) -> None:
    script = Path(importlib.import_module("closedform.derivations.delta").__file__).read_text(
        "utf-8"
    )
    assert old in script
    with pytest.raises(ShapeError, match=said):
        read_script(script.replace(old, new))


def test_a_hand_that_turns_has_plain_rods() -> None:
    rod, joints = Parallelogram(2, (1, 0), 1), [real(f"q{k}") for k in range(3)]
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    for q in joints:
        d.joint(str(q), "prismatic")
    legs = [Slide(q, rod, (k, 0), (0, 1), on_hand=(k, 1)) for k, q in enumerate(joints)]
    with pytest.raises(
        ShapeError, match="keeps the hand from turning, which only parallel supports"
    ):
        platform(d, legs)


def test_a_parallelogram_stands_for_its_length() -> None:
    assert sp.sympify(Parallelogram(real("l"), (1, 0), 1), strict=True) == real("l")


DELTA = """
hand = "P"
[bodies]
ground = {A = ["f", 0, 0], O = [0, 0, 0]}
crank = {B = ["f + L", 0, 0]}
rod = {length = "l", parallelogram = [0, "w", 0]}
up = {S = [0, 0, 0]}
lead = {length = "l", parallelogram = [0, 0, "w"]}
side = {S = [0, "f", 0]}
last = {length = "l", parallelogram = ["w", 0, 0]}
hand = {P = [0, 0, 0], C1 = ["e", 0, 0], C2 = [0, 0, "e"], C3 = [0, "e", 0]}
[joints]
q1 = {between = ["ground", "crank"], at = "A", axis = [0, 1, 0], driven = true}
q2 = {between = ["ground", "up"], at = "O", kind = "prismatic", axis = [0, 0, 1], driven = true}
q3 = {between = ["ground", "side"], at = "O", kind = "prismatic", axis = [0, 1, 0], driven = true}
b1 = {between = ["crank", "rod"], at = "B"}
b2 = {between = ["up", "lead"], at = "S"}
b3 = {between = ["side", "last"], at = "S"}
c1 = {between = ["rod", "hand"], at = "C1"}
c2 = {between = ["lead", "hand"], at = "C2"}
c3 = {between = ["last", "hand"], at = "C3"}
"""


def test_parallelograms_from_a_file(tmp_path: Path) -> None:
    script = script_of("mixed", DELTA, tmp_path)
    assert "Crank(q1, L, Parallelogram(l, (0, 1, 0), w)," in unbroken(script)
    d = read_script(script)
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 2, "ik": 8}
    assert "constraint" in {f.name for f in d.functions}


FIVE_BAR = """
hand = "P"
[bodies]
ground = {A1 = [0, 0], A2 = [0.3, 0]}
crank1 = {B1 = [0.2, 0]}
crank2 = {B2 = [0.5, 0]}
rod1 = {length = 0.35, parallelogram = [0, 0.05]}
rod2 = {length = 0.35}
[joints]
t1 = {between = ["ground", "crank1"], at = "A1", driven = true}
t2 = {between = ["ground", "crank2"], at = "A2", driven = true}
b1 = {between = ["crank1", "rod1"], at = "B1"}
b2 = {between = ["crank2", "rod2"], at = "B2"}
p = {between = ["rod1", "rod2"], at = "P"}
"""


@pytest.mark.parametrize(
    ("text", "old", "new", "said"),
    [
        (FIVE_BAR, "", "", "t1 turns crank1 with .* rod1, .* if both rods end in the same point"),
        (DELTA, '[0, "w", 0]}\nup', '["w", 0, 0]}\nup', "a short side along the axis of q1"),
    ],
)
def test_a_file_whose_short_side_turns_is_refused(
    text: str, old: str, new: str, said: str, tmp_path: Path
) -> None:
    assert old in text
    with pytest.raises(TableError, match=said):
        script_of("turned", text.replace(old, new), tmp_path)


PALLETISER = """# L1 = 0.5 m: lower arm
# L2 = 0.4 m: upper arm
a, alpha, d, theta, motors
0, pi/2, 0.3, theta1,
L1, 0, 0, theta2, m2
L2, 0, 0, theta3, m3 - m2
"""


def test_a_parallelogram_in_a_table_of_joints(tmp_path: Path) -> None:
    path = tmp_path / "palletiser.csv"
    path.write_text(PALLETISER, "utf-8")
    script = new("palletiser", "dh", path).text
    assert "parallelogram_drive(d, {theta3: (theta2, L1)}" in script
    d = read_script(script)
    prove(d)
    assert any("antiparallelogram" in step.reason for step in d.steps)


CRANKS_AND_A_SLIDE = """
from closedform import Crank, Derivation, Paper, Parallelogram, Slide, parallel, real
d = Derivation("toy_cranks", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
d.task = ["x", "y", "z"]
L, l, f, e, w = (d.parameter(n, value=1, unit="m", meaning=n) for n in ("L", "l", "f", "e", "w"))
q1, q2, q3 = d.joint("q1"), d.joint("q2"), d.joint("q3", "prismatic")
x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
legs = [
    Crank(q1, L, Parallelogram(l, y, w), (f, 0, 0), x, z, (e, 0, 0)),
    Crank(q2, L, Parallelogram(l, x, w), (0, 0, f), z, y, (0, 0, e)),
    Slide(q3, Parallelogram(l, z, w), (0, 0, 0), y, (0, e, 0)),
]
parallel(d, [real(n) for n in "xyz"], legs)
"""


def test_legs_of_equal_lengths_pass_the_cross_check(tmp_path: Path) -> None:
    """A rod that ends close to the axis of its crank turns it by the last bits of two lengths."""
    robot = derived("toy_cranks", CRANKS_AND_A_SLIDE, tmp_path, crosscheck=True)
    assert len(robot.BRANCHES) == 8
