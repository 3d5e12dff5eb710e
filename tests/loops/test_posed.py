"""Planar linkages whose hand three joints move and turn: an excavator, and a tool on a five-bar.

The other route is the drawing: lengths of cylinders and rods between points of rigid bodies.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from loop_files import apart, derived, read_script, script_of
from places import TESTS

from closedform import Body, Derivation, Paper, real
from closedform.loops.bar_errors import Bars, hand_error
from closedform.loops.linkage import Linkage
from closedform.model.functions import Program
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
OK, SINGULAR = 0, 2
TURNS = np.array([False, False, True])


def text(name: str) -> str:
    return (FOLDER / f"{name}.toml").read_text("utf-8")


def posed(name: str, factory: pytest.TempPathFactory) -> ModuleType:
    folder = factory.mktemp(name)
    return derived(f"{name}_posed", script_of(f"{name}_posed", text(name), folder), folder)


@pytest.fixture(scope="module")
def excavator(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return posed("excavator", tmp_path_factory)


@pytest.fixture(scope="module")
def tool(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return posed("turned_tool", tmp_path_factory)


def drawn(v, boom: np.ndarray, stick: np.ndarray, lever: np.ndarray) -> tuple:
    """The lengths of the cylinders, and the two poses of the bucket, as complex numbers."""
    turns = np.exp(1j * np.cumsum([boom, stick, lever], axis=0))
    E = v.b * turns[0]
    on_stick = {
        name: E + turns[1] * at
        for name, at in {
            "H": -0.8 + 0.3j, "K": 0.4 + 0.5j, "L": v.s - 0.45 + 0.05j, "B": v.s
        }.items()
    }  # fmt: skip
    M = on_stick["L"] + 0.6j * turns[2]
    q = [
        abs(turns[0] * (2.4 + 0.6j) - (0.5 - 0.6j)),
        abs(on_stick["H"] - turns[0] * (2.6 + 1j)),
        abs(M - on_stick["K"]),
    ]
    across = M - on_stick["B"]
    ear, gap = abs(0.45 + 0.1j), abs(across)
    with np.errstate(invalid="ignore"):
        bent = np.arccos((gap**2 + ear**2 - 0.6**2) / (2 * gap * ear))
    yaw = np.angle(across) + np.outer([1, -1], bent) - np.angle(0.45 + 0.1j)
    tip = on_stick["B"] - 1.5j * np.exp(1j * yaw)
    return np.stack(q, -1), np.stack([tip.real, tip.imag, yaw], -1)


def postures(v, count: int, seed: int) -> tuple:
    """Angles of an excavator at work; of those in which the bucket's rods reach."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform([-0.6, -2.6, -0.6], [0.9, -0.4, 1.2], (count, 3)).T
    q, poses = drawn(v, *angles)
    reached = np.isfinite(poses).all(axis=(0, 2))
    return q[reached], poses[:, reached]


def test_an_excavator_has_every_posture_of_its_drawing(excavator: ModuleType) -> None:
    q, poses = postures(excavator.Parameters(), 4000, 1)
    assert len(q) > 2000 and len(excavator.ASSEMBLY_MODES) == 16
    forward = excavator.fk(q).p
    for pose in poses:
        found, status = excavator.ik(pose)
        assert (apart(forward, pose[:, None], TURNS).min(axis=1) < 1e-9).all()
        near = np.abs(found - q[:, None]).max(axis=-1) < 1e-8
        assert (near & np.isin(status, (OK, SINGULAR))).any(axis=1).all()
        assert (near & (status == OK)).any(axis=1).mean() > 0.97


@pytest.mark.parametrize("name", ["excavator", "tool"])
def test_what_is_ok_has_the_target_among_its_images(
    name: str, request: pytest.FixtureRequest
) -> None:
    mechanism, rng = request.getfixturevalue(name), np.random.default_rng(2)
    q = rng.uniform(0.3, 4, (4000, 3)) if name == "excavator" else near_right_angles(rng, 4000)
    images, status = mechanism.fk(q)
    targets = images[status == OK]
    found, status = mechanism.ik(targets)
    assert len(targets) > 1000 and np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    for answers, said in zip(np.moveaxis(found, 1, 0), status.T, strict=True):
        back = mechanism.fk(answers[said == OK]).p
        missed = apart(back, targets[said == OK][:, None], TURNS)
        assert (np.nanmin(missed, axis=1) < 1e-12).all()


def near_right_angles(rng: np.random.Generator, count: int) -> np.ndarray:
    q = rng.uniform(-np.pi, np.pi, (count, 3))
    beside = rng.choice([-1, 0, 1], q.shape) * 10 ** rng.uniform(-14, -1, q.shape)
    return np.where(rng.random(q.shape) < 0.4, rng.integers(-2, 3, q.shape) * np.pi / 2 + beside, q)


def test_the_jacobian_is_the_derivative_of_the_pose(excavator: ModuleType) -> None:
    q, _ = postures(excavator.Parameters(), 300, 3)
    steps = 1e-6 * np.eye(3)
    rates = [(excavator.fk(q + s).p - excavator.fk(q - s).p) / 2e-6 for s in steps]
    J = excavator.jacobian(q)
    close = (
        np.abs(J - np.stack(rates, axis=-1))
        < 1e-6 * (1 + np.abs(J).max(axis=(2, 3)))[..., None, None]
    )
    away = np.abs(excavator.singularities(q)[..., 1:]).min(axis=-1) > 0.05
    assert away.sum() > 500 and close[away].all()
    np.testing.assert_allclose(excavator.determinant(q)[away], np.linalg.det(J[away]), rtol=1e-9)


def test_the_hand_stands_still_where_its_factor_vanishes(excavator: ModuleType) -> None:
    """The stick is stretched along the boom."""
    q, _ = drawn(excavator.Parameters(), *np.array([[0.4], [0.0], [0.3]]))
    still = np.abs(excavator.singularities(q)[0, :, 0]).min()
    assert excavator.SINGULARITIES[0] == "hand stands still" and still < 1e-12


def test_a_target_out_of_reach_is_told(excavator: ModuleType) -> None:
    v = excavator.Parameters()
    assert not excavator.workspace_contains([v.b + v.s + 1.6, 0, 0])
    assert excavator.workspace_contains([6, -1, 0])


def test_a_pin_of_two_bodies_is_refused_as_the_hand(tmp_path: Path) -> None:
    with pytest.raises(
        TableError, match="B and turn it, and it is a pin of stick and bucket; give"
    ):
        script_of("pin", text("excavator").replace('hand = "P"', 'hand = "B"'), tmp_path)


REDUNDANT = """hand = "P"
[bodies]
ground = {A = [0, 0], B = [0.3, 0]}
crank1 = {A = [0, 0], C = [0.4, 0]}
crank2 = {B = [0.3, 0], D = [0.5, 0]}
plate = {C = [0, 0], E = [0.35, 0.1], P = [0.1, 0.2]}
tube = {}
rod = {}
[joints]
t1 = {between = ["ground", "crank1"], at = "A", driven = true}
t2 = {between = ["ground", "crank2"], at = "B", driven = true}
c = {between = ["crank1", "plate"], at = "C"}
d = {between = ["crank2", "tube"], at = "D"}
q = {between = ["tube", "rod"], at = "D", kind = "prismatic", driven = true}
e = {between = ["rod", "plate"], at = "E"}
"""


def test_two_motors_that_do_the_same_leave_no_inverse(tmp_path: Path) -> None:
    d = read_script(script_of("redundant", REDUNDANT, tmp_path))
    assert d.without_inverse == "with the hand held, crank2 can still move"


def crossing(a: complex, b: complex, first: float, second: float) -> complex:
    """The point to the left of the line from ``a`` to ``b``, at these distances from them."""
    gap = abs(b - a)
    along = (gap**2 + first**2 - second**2) / (2 * gap)
    return a + (b - a) / gap * (along + 1j * np.sqrt(first**2 - along**2))


def test_the_error_of_the_hand_is_the_sum_over_the_bars() -> None:
    """Against differences of the lengths of the bars, one after the other."""
    D, E, F = 0.1 + 0.2j, 0.5 + 0.3j, 0.2 + 0.1j
    lengths = np.array([0.4, 0.35, 0.1, 0.45])

    def hand(sizes: np.ndarray) -> np.ndarray:
        Q = crossing(D, E, *sizes[:2])
        tip = crossing(Q, F, *sizes[2:])
        return np.array([Q.real, Q.imag, np.angle(tip - Q)])

    Q = crossing(D, E, *lengths[:2])
    G = crossing(Q, F, *lengths[2:])
    rates = [(hand(lengths + s) - hand(lengths - s)) / 2e-6 for s in 1e-6 * np.eye(4)]
    expected = np.abs(np.array(rates) * [1, 1, 7]).sum()
    places = {"D": D, "E": E, "F": F, "Q": Q, "G": G, "P": Q}
    points = {
        name: sp.Matrix([sp.Rational(at.real), sp.Rational(at.imag)]) for name, at in places.items()
    }
    m = Linkage(
        (d := derivation()),
        sp.Matrix([real("x"), real("y"), real("yaw")]),
        {
            "ground": Body({"A": (0, 0), "B": (1, 0), "C": (2, 0)}),
            "crank1": Body({"A": (0, 0), "D": (1, 0)}, d.actuated[0]),
            "crank2": Body({"B": (1, 0), "E": (2, 0)}, d.actuated[1]),
            "crank3": Body({"C": (2, 0), "F": (3, 0)}, d.actuated[2]),
            "rod1": Body({"D": (0, 0), "Q": (sp.Rational(2, 5), 0)}),
            "rod2": Body({"E": (0, 0), "Q": (sp.Rational(7, 20), 0)}),
            "rod3": Body({"F": (0, 0), "G": (sp.Rational(9, 20), 0)}),
            "tool": Body({"Q": (0, 0), "G": (sp.Rational(1, 10), 0), "P": (0, 0)}),
        },
        "P",
    )
    bars, volumes = [], []
    by_name = dict(zip(("rod1", "rod2", "tool", "rod3"), map(sp.Rational, lengths), strict=True))
    for step in m.dyads:
        a, b = (points[step.pin] - points[near] for near in step.near)
        volumes.append(a[0] * b[1] - a[1] * b[0])
        bars.append(Bars((a, b), tuple(by_name[body] for body in step.bodies), volumes[-1]))
    program = Program()
    found = program.explicit(hand_error(m, program, points, bars, sp.Integer(7)))
    assert float(found) / abs(float(np.prod(volumes))) == pytest.approx(expected, rel=1e-6)


def derivation() -> Derivation:
    d = Derivation("toy", "Toy", Paper("toy", "Toy", ("nobody",)), "A toy.")
    for name in ("q1", "q2", "q3"):
        d.joint(name)
    return d
