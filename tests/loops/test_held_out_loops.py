"""Closed loops from the literature that are not among the mechanisms of the project.

Each is described in a short file, proved and tried: Newton's method on the lengths of the rods,
which are written here from the drawings, finds no posture that the closed form lacks.
"""

import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, read_script, script_of
from places import TESTS

from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
OK, UNREACHABLE, SINGULAR = range(3)
STARTS, LINES = 30, 40


def norm(*v: float) -> float:
    return float(np.linalg.norm(v))


def prrrp(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    left = norm(p[0] + v.w, p[1] - q[0]) - v.l1
    return [left, norm(p[0] - v.w, p[1] - q[1]) - v.l2]


def rssr(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    A = np.array([v.a * np.cos(q[0]), v.a * np.sin(q[0]), v.s])
    axis, arm = np.array([0, -np.sqrt(0.75), 0.5]), np.array([v.c, 0, 0])  # Rodrigues' formula
    B = [v.f, 0, 0] + arm * np.cos(p[0]) + np.cross(axis, arm) * np.sin(p[0])
    return [norm(*(A - B)) - v.b]


def rrss(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The hinge turns the body on the crank, and the crank turns both."""
    axis, arm = np.array([0, -0.8, 0.6]), np.array([v.b, 0, 0])
    x, y, z = [v.a, 0, 0] + arm * np.cos(p[0]) + np.cross(axis, arm) * np.sin(p[0])
    ball = np.exp(1j * q[0]) * complex(x, y)
    return [norm(ball.real - v.g, ball.imag, z - v.h) - v.l]


def three_slides(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    starts = np.array([[q[0], v.g, 0], [q[1], -v.g, 0], [q[2], 0, v.h]])
    ends = p + np.array([[0, v.e, 0], [0, -v.e, 0], [0, 0, v.e]])
    return [norm(*row) - v.l for row in starts - ends]


def coaxial_five_bar(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The leg of a Minitaur."""
    return [norm(p[0] - v.l1 * np.cos(a), p[1] - v.l1 * np.sin(a)) - v.l2 for a in q]


def oblique_rails(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    s = q / np.sqrt(2)
    left = norm(p[0] + v.a - s[0], p[1] - s[0]) - v.l
    return [left, norm(p[0] - v.a + s[1], p[1] - s[1]) - v.l]


def scott_russell(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    return [norm(q[0], p[0]) - 2 * v.l]


def cylinder(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    return [norm(-v.l * np.sin(p[0]) - v.f, v.l * np.cos(p[0])) - q[0]]


def diamond(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The first crank points to the left at zero, and turns as the other one does."""
    ends = [-v.w - v.l * np.cos(q[0]), v.w + v.l * np.cos(q[1])], v.l * np.sin(q) * [-1, 1]
    return [norm(p[0] + c - x, p[1] - y) - v.r for c, x, y in zip((-v.e, v.e), *ends, strict=True)]


def spherical_four_bar(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The cosine of the arc of the coupler, from the two arcs at a point of the sphere."""
    B = [np.sin(v.alpha) * np.cos(q[0]), np.sin(v.alpha) * np.sin(q[0]), np.cos(v.alpha)]
    axis = np.array([np.sin(v.delta), 0, np.cos(v.delta)])
    C = np.array([np.sin(v.delta + v.gamma), 0, np.cos(v.delta + v.gamma)])
    across = np.cross(axis, C)
    C = axis * (axis @ C) + np.cos(p[0]) * (C - axis * (axis @ C)) + np.sin(p[0]) * across
    return [float(C @ B) - np.cos(v.beta)]


def minitaur(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    ends = v.l1 * np.array([(np.cos(a), np.sin(a)) for a in q])
    knee = p + (ends[0] - p) * v.t / (v.l2 + v.t)
    return [norm(*(p - ends[0])) - v.l2 - v.t, norm(*(knee - ends[1])) - v.l2]


def loader(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    pin = v.l * np.array([np.cos(q[0]), np.sin(q[0])])
    ahead = (p - pin) / v.r
    pushed = pin - v.a * ahead + v.h * np.array([-ahead[1], ahead[0]])
    return [norm(*(p - pin)) - v.r, norm(pushed[0], pushed[1] + v.b) - q[1]]


def parallel_leg(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The lower rod of the parallelogram ends behind the knee."""
    knee, crank = v.l * np.array([np.cos(q[0]), np.sin(q[0])]), -v.a * np.exp(1j * q[1])
    ear = knee - (p - knee) * v.a / v.m
    return [norm(*(p - knee)) - v.m, norm(ear[0] - crank.real, ear[1] - crank.imag) - v.l]


def quick_return(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    pin = v.r * np.exp(1j * q[0]) + 1j * v.g
    return [float((pin * np.exp(-1j * p[0])).imag)]  # across the lever, as seen from it


def slotted_crank(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The same with an offset, and the lever drives the crank."""
    return [quick_return(v, p, q)[0] - v.e]


def scotch_yoke(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """The pin is on a line of slope 2."""
    return [v.r * (2 * np.cos(p[0]) - np.sin(p[0])) - 2 * q[0]]


def around(distance: float) -> np.ndarray:
    """Three points around the z axis."""
    angles = 2 * np.pi / 3 * np.arange(3)
    return distance * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)


def tsai(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    return list(np.linalg.norm(p + around(v.c) - around(v.b), axis=1) - q)


def puu(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    ends = around(v.b) + np.outer(q, [0, 0, 1]) / np.sqrt(2) - q[:, None] * around(1 / np.sqrt(2))
    return list(np.linalg.norm(p + around(v.c) - ends, axis=1) - v.r)


def y_star(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    ends = around(1) * q[:, None]
    return list(np.linalg.norm(p + around(v.c) - ends, axis=1) - v.r)


def gantry_tau(v, q: np.ndarray, p: np.ndarray) -> list[float]:
    """Of each slider, one rod; the others are parallel to it."""
    starts = np.array([[q[0], 0.6, 0.5], [q[1], 0.6, -0.45], [q[2], -0.6, 0]])
    ends = p + np.array([[0, 0.05, 0.1], [0, 0.05, -0.05], [0, -0.05, -0.05]])
    return list(np.linalg.norm(starts - ends, axis=1) - [v.l, v.l, v.m])


MISSES: dict[str, tuple[Callable, int]] = {
    "coaxial_five_bar": (coaxial_five_bar, 4),
    "cylinder": (cylinder, 1),
    "diamond": (diamond, 4),
    "gantry_tau": (gantry_tau, 8),
    "loader": (loader, 2),
    "minitaur": (minitaur, 4),
    "oblique_rails": (oblique_rails, 4),
    "parallel_leg": (parallel_leg, 4),
    "prrrp": (prrrp, 4),
    "puu": (puu, 8),
    "quick_return": (quick_return, 2),
    "rrss": (rrss, 2),
    "rssr": (rssr, 2),
    "scotch_yoke": (scotch_yoke, 1),
    "scott_russell": (scott_russell, 2),
    "slotted_crank": (slotted_crank, 2),
    "spherical_four_bar": (spherical_four_bar, 2),
    "three_slides": (three_slides, 8),
    "tsai": (tsai, 1),
    "y_star": (y_star, 8),
}
TRAVEL = {"cylinder": 0.8, "loader": 2.0, "scotch_yoke": 0.1, "slotted_crank": 3.0}
"""How far joints are tried, if it is not half a metre or half a radian."""
AT_EDGE = ("minitaur", "parallel_leg")
"""Those with a few postures near a parallel singularity, where all answers are SINGULAR."""


@pytest.fixture(scope="module", params=MISSES)
def loop(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = (FOLDER / f"{request.param}.toml").read_text("utf-8")
    assert len(text.splitlines()) < LINES
    folder = tmp_path_factory.mktemp("loops")
    name = f"{request.param}_held_out"
    return derived(name, script_of(name, text, folder), folder, crosscheck=True)


def name_of(loop: ModuleType) -> str:
    return loop.__name__.split(".")[-1].removesuffix("_held_out")


def test_newton_finds_no_posture_that_the_closed_form_lacks(loop: ModuleType) -> None:
    misses, modes = MISSES[name_of(loop)]
    v, rng = loop.Parameters(), np.random.default_rng(3)
    turns = [loop.SKELETON.joints[name].kind == "revolute" for name in loop.JOINTS]
    assert len(loop.BRANCHES) == modes
    found = {"fk": 0, "ik": 0}
    for q in rng.uniform(0, 1, (20, len(turns))) * np.where(
        turns, 6, TRAVEL.get(name_of(loop), 0.5)
    ):
        forward = loop.fk(q)
        for start in rng.uniform(-1, 1, (STARTS, forward.p.shape[-1])):
            p = newton(lambda p: np.array(misses(v, q, p)), start)  # noqa: B023
            if p is None:
                continue
            found["fk"] += 1
            assert (
                np.nanmin(apart(forward.p, p, [loop.TASK in (("phi",), ("psi",), ("theta",))]))
                < 1e-6
            )
            joints = newton(lambda q: np.array(misses(v, q, p)), q + rng.normal(0, 1, len(q)))  # noqa: B023
            if joints is not None:
                found["ik"] += 1
                assert np.nanmin(apart(loop.ik(p).q, joints, turns)) < 1e-5
    assert min(found.values()) > 50


def test_all_postures_close_the_loop(loop: ModuleType) -> None:
    misses, _ = MISSES[name_of(loop)]
    v, rng = loop.Parameters(), np.random.default_rng(4)
    q = rng.uniform(0, TRAVEL.get(name_of(loop), 0.5), (200, len(loop.JOINTS)))
    p, status = loop.fk(q)
    assert (status == OK).any()
    singular = 0
    targets = p[status == OK]
    for target in targets:
        answers = loop.ik(target)
        if not (answers.status == OK).any():
            assert (answers.status == SINGULAR).any()
            singular += 1
        for joints in answers.q[answers.status == OK]:
            assert np.abs(misses(v, joints, target)).max() < 1e-12
    assert singular <= (len(targets) / 50 if name_of(loop) in AT_EDGE else 0)


def test_the_words_for_a_single_loop_name_no_hand(tmp_path: Path) -> None:
    script = script_of("rssr", (FOLDER / "rssr.toml").read_text("utf-8"), tmp_path)
    assert "Joint theta turns a crank of length a, which" in script
    assert script.count("joins to the other leg") == 2


def test_a_loop_with_its_task_on_a_crank_says_how_it_is_seen(tmp_path: Path) -> None:
    text = (FOLDER / "rrss.toml").read_text("utf-8")
    told = read_script(script_of("rrss", text, tmp_path)).mechanism
    assert told.startswith("The loop is seen from crank")  # or the legs would be misread
    assert "So the crank of theta is the ground." in told
    bare = text.replace("crank = {O = [0, 0, 0], A", "crank = {A")
    assert script_of("rrss", bare, tmp_path) == script_of("rrss", text, tmp_path)
    point = text.replace('hand = "phi"', 'hand = "P"').replace("C = [", "P = [0, 0, 1], C = [")
    with pytest.raises(TableError, match=r'With hand = "phi" .* P follows from theta and phi'):
        script_of("rrss", point, tmp_path)


def in_numbers(name: str, second: str, folder: Path) -> ModuleType:
    """The coaxial five-bar with numbers for lengths; the second rod has its own."""
    text = (FOLDER / "coaxial_five_bar.toml").read_text("utf-8")
    bodies = text[text.index("[bodies]") :].replace('"l1"', "0.1")
    bodies = bodies.replace('"l2"', "0.2", 1).replace('"l2"', second)
    return derived(name, script_of(name, f'hand = "P"\n{bodies}', folder), folder)


def test_lengths_in_numbers_reach_as_far_as_parameters(tmp_path: Path) -> None:
    loop, rng = in_numbers("same_rods", "0.2", tmp_path), np.random.default_rng(5)
    stretched = 0.3 * np.array([(np.cos(a), np.sin(a)) for a in rng.uniform(-3, 3, 500)])
    assert (loop.ik(stretched).status != UNREACHABLE).all()


def test_rods_whose_lengths_are_different_numbers_are_proved(tmp_path: Path) -> None:
    loop = in_numbers("other_rods", "0.25", tmp_path)
    p, status = loop.fk([0.3, 2])
    ends = 0.1 * np.array([(np.cos(a), np.sin(a)) for a in (0.3, 2)])
    assert not status.any()
    assert np.allclose(np.linalg.norm(p[:, None] - ends, axis=-1), [0.2, 0.25])


@pytest.mark.parametrize(
    ("mechanism", "length", "letter"),
    [("tilted_tripteron", "b", "b"), ("tricept", "e", "v"), ("parallel_leg", "l1", "c")],
)
def test_a_length_may_have_the_letter_of_a_vector(
    mechanism: str, length: str, letter: str, tmp_path: Path
) -> None:
    """The article then has another letter for the vector."""
    text = (FOLDER / f"{mechanism}.toml").read_text("utf-8")
    text = re.sub(rf'(?<=")(-?){length}(?=")', rf"\1{letter}", text)
    text = re.sub(rf"^{length} = ", f"{letter} = ", text, flags=re.MULTILINE)
    script = tmp_path / "lettered.py"
    script.write_text(script_of("lettered", text, tmp_path), "utf-8")
    assert main(["derive", str(script), "-o", str(tmp_path / "out"), "--backend", "latex"]) == 0
