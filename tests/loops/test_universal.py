"""Universal joints that keep a hand from turning: a 3-UPU, against the chains of its joints."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of, unbroken
from places import TESTS

from closedform import (
    Crank,
    Derivation,
    Paper,
    Parallelogram,
    Slide,
    Stretch,
    Universal,
    parallel,
    platform,
    prove,
    real,
)
from closedform.algebra.shapes import ShapeError
from closedform.emit.pages import pages
from closedform.loops.letters import VECTORS
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
TSAI = (FOLDER / "tsai.toml").read_text("utf-8")
PUU = (FOLDER / "puu.toml").read_text("utf-8")
UNREACHABLE = 1
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
AXES = np.stack([-np.sin(ANGLES), np.cos(ANGLES), 0 * ANGLES], axis=1)


@pytest.fixture(scope="module")
def tsai(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("tsai")
    return derived("tsai", script_of("tsai", TSAI, folder), folder)


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """A rotation about a unit vector, by Rodrigues' formula."""
    x, y, z = axis
    W = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * W + (1 - np.cos(angle)) * W @ W


def chain(k: int, angles: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """The rod of a leg and the rotation of the hand, joint by joint."""
    rotation = turned(AXES[k], angles[0]) @ turned([0.0, 0.0, 1.0], angles[1])
    rod = length * rotation @ OUT[k]
    return rod, rotation @ turned([0.0, 0.0, 1.0], angles[2]) @ turned(AXES[k], angles[3])


def poses(tsai: ModuleType, q: np.ndarray, angles: np.ndarray) -> list[tuple]:
    """Where each chain of joints brings the hand, and how it turns it."""
    v, found = tsai.Parameters(), []
    for k in range(3):
        rod, rotation = chain(k, angles[4 * k : 4 * k + 4], q[k])
        found.append((v.b * OUT[k] + rod - rotation @ (v.c * OUT[k]), rotation))
    return found


def missed(tsai: ModuleType, q: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """By how much the chains miss a common pose."""
    (p, R), *others = poses(tsai, q, angles)
    rows = []
    for a, B in others:
        between = R.T @ B
        rows += [*(p - a), *(between - between.T)[[0, 0, 1], [1, 2, 2]]]
    return np.array(rows)


def passive(tsai: ModuleType, p: np.ndarray) -> np.ndarray:
    """The angles of the universal joints of a hand that is not turned, one leg after the other."""
    v, found = tsai.Parameters(), []
    for k in range(3):
        rod = p + (v.c - v.b) * OUT[k]
        tilt = np.arctan2(-rod[2], OUT[k] @ rod)
        swing = np.arctan2(AXES[k] @ rod, np.hypot(rod[2], OUT[k] @ rod))
        found += [tilt, swing, -swing, -tilt]
    return np.array(found)


def test_chains_of_joints_find_no_hand_that_the_closed_form_lacks(tsai: ModuleType) -> None:
    """Near a hand that is not turned there are no others, and those are all of them."""
    rng, found = np.random.default_rng(1), 0
    for q in rng.uniform(0.5, 1.0, (12, 3)):
        p, status = tsai.fk(q)
        if status.any():
            continue
        for mode, factor in zip(p, tsai.constraint(q)[:, 0], strict=True):
            assert abs(factor) > 1e-3
            exact = passive(tsai, mode)
            assert np.abs(missed(tsai, q, exact)).max() < 1e-12
            for far in (1e-3, 0.1, 0.1, 0.1):
                start = exact + rng.normal(0, far, 12)
                angles = newton(lambda a: missed(tsai, q, a), start)  # noqa: B023
                if angles is None:
                    continue
                (at, R), *_ = poses(tsai, q, angles)
                level = np.abs(R - np.eye(3)).max() < 1e-9
                assert level or far > 1e-3
                if level:
                    assert np.linalg.norm(p - at, axis=1).min() < 1e-9
                    found += 1
    assert found > 40


def test_the_constraint_is_that_of_the_chains(tsai: ModuleType) -> None:
    """Where it vanishes, the hand can begin to turn; elsewhere all joints stand still."""
    v, h = tsai.Parameters(), 1e-6
    for p in np.random.default_rng(2).uniform((-0.3, -0.3, 0.3), (0.3, 0.3, 0.9), (20, 3)):
        [q], _ = tsai.ik(p)
        angles = passive(tsai, p)
        rates = [
            (missed(tsai, q, angles + s) - missed(tsai, q, angles - s)) / (2 * h)
            for s in h * np.eye(12)
        ]
        mode = int(np.argmin(np.linalg.norm(tsai.fk(q).p - p, axis=1)))
        rods = p + (v.c - v.b) * OUT
        across = rods - np.sum(rods * AXES, 1)[:, None] * AXES
        assert np.isclose(tsai.constraint(q)[mode, 0], np.linalg.det(across), rtol=1e-9)
        loose = np.linalg.svd(np.array(rates), compute_uv=False)[-1]
        still = abs(np.linalg.det(across)) * abs(np.linalg.det(rods))
        assert loose > 1e-3 * still
    level = np.array([0.0, 0.0, 0.0])  # all rods in the plane of the base
    [q], _ = tsai.ik(level)
    assert abs(np.linalg.det(OUT - np.sum(OUT * AXES, 1)[:, None] * AXES)) < 1e-15
    assert np.nanmax(np.abs(tsai.constraint(q))) < 1e-9


def test_a_leg_has_a_positive_length(tsai: ModuleType) -> None:
    assert not tsai.fk([0.7, 0.8, 0.75]).status.any()
    assert (tsai.fk([0.7, 0.8, -0.75]).status == UNREACHABLE).all()


def test_the_docstrings_say_what_is_left_out(tsai: ModuleType) -> None:
    for function in (tsai.fk, tsai.ik):
        assert "postures in which the hand is turned" in " ".join(function.__doc__.split())
    assert "do not keep the hand from turning" in tsai.constraint.__doc__


def a_derivation(kind: str = "revolute") -> tuple[Derivation, list]:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    d.task = ["x", "y", "z"]
    return d, [d.joint(f"q{k + 1}", kind) for k in range(3)]


def test_legs_that_do_not_hold_say_why() -> None:
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    hand = tuple(map(real, "xyz"))
    ends = (1, 0, 0), (0, 1, 0), (-1, -1, 0)
    d, joints = a_derivation("prismatic")

    def slides(*rods: object) -> list[Slide]:
        legs = zip(joints, rods, ends, strict=True)
        return [Slide(q, rod, (0, 0, 0), z, on_hand=e) for q, rod, e in legs]

    with pytest.raises(
        ShapeError, match="the same direction, about which the hand can always turn"
    ):
        parallel(d, hand, slides(*[Universal(3, x)] * 3))
    with pytest.raises(
        ShapeError, match="the same direction, about which the hand can always turn"
    ):
        parallel(d, hand, slides(Universal(3, x), Parallelogram(3, x, 1), Universal(3, (-1, 0, 0))))
    with pytest.raises(
        ShapeError, match="nothing keeps it from turning; all three rods have to be"
    ):
        parallel(d, hand, slides(Universal(3, x), Universal(3, y), 3))
    with pytest.raises(ShapeError, match="unit vector in space"):
        parallel(d, hand, slides(Universal(3, (1, 1, 0)), Universal(3, y), Universal(3, x)))
    six = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    legs = [Stretch(six.joint(f"q{k}", "prismatic"), x, on_hand=y, axis=z) for k in range(6)]
    with pytest.raises(ShapeError, match="a Universal keeps the hand from turning"):
        platform(six, legs)
    d, joints = a_derivation()
    cranks = [
        Crank(q, 1, Universal(3, a), e, along=y, across=z, on_hand=e)
        for q, a, e in zip(joints, (x, x, y), ends, strict=True)
    ]
    with pytest.raises(ShapeError, match="q3 turns the axis on it; the axis has to be along"):
        parallel(d, hand, cranks)


def test_parallelograms_and_universal_joints_hold_together() -> None:
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    d, joints = a_derivation("prismatic")
    rods = Universal(3, x), Parallelogram(3, y, 1), Universal(3, z)
    legs = [
        Slide(q, rod, e, a, on_hand=e)
        for q, rod, e, a in zip(joints, rods, (x, y, z), (x, y, z), strict=True)
    ]
    parallel(d, tuple(map(real, "xyz")), legs)
    titles = [step.title for step in d.steps]
    assert {"The parallelograms", "The universal joints"} < {*titles}
    assert len(d["constraint"].outputs) == 1


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('kind = "universal", axis = [0, 1, 0]}\nq1', 'kind = "universal"}\nq1',
         "c1 has an axis; universal joints keep the hand from turning if a leg in space has them"),
        ('"C1", kind = "universal", axis = [0, 1, 0]', '"C1", kind = "universal", axis = [1, 0, 0]',
         "the axes of a1 and c1 have to be parallel, or the leg turns the hand"),
        ("axis = [0, 1, 0]", "axis = [0, 0, 1]", "of all 3 legs have the same axis, about which"),
        (', axis = [0, 1, 0]', "", "If it is universal joints that keep it from turning, give"),
        ('kind = "universal", axis', "axis", "c1, c2 and c3 would hold platform by an axis"),
        ("copies = 3", "copies = 6", "6 joints are driven, but a hand that does not turn needs 3"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in TSAI
    with pytest.raises(TableError, match=message):
        script_of("tsai", TSAI.replace(old, other), tmp_path)


def test_a_parallelogram_needs_no_axes(tmp_path: Path) -> None:
    text = PUU.replace('length = "r"', 'length = "r", parallelogram = [0, 0.1, 0]')
    with pytest.raises(TableError, match="rod1 is a parallelogram, so b1 and c1 need no axis"):
        script_of("puu", text, tmp_path)


def test_a_leg_with_a_hinge_at_one_end_does_not_hold_the_hand(tmp_path: Path) -> None:
    old = 'at = "B1", kind = "universal"'
    assert old in PUU
    with pytest.raises(TableError, match=r"b1 and c1 are a hinge and a universal .* no motion"):
        script_of("pru", PUU.replace(old, 'at = "B1"'), tmp_path)


def test_cranks_carry_universal_joints(tmp_path: Path) -> None:
    """A 3-RUU mechanism: the axes of the joints on a crank are along its own."""
    text = PUU.replace(
        'kind = "prismatic", axis = [-1, 0, 1], driven', "axis = [0, 1, 0], driven"
    ).replace('B1 = ["b"', 'B1 = ["b + 0.3"')
    script = script_of("ruu", text.replace("q1", "theta1"), tmp_path)
    assert "Crank(theta1, Rational(3, 10), Universal(r, (0, 1, 0))," in unbroken(script)
    assert len(read_script(script).branches) == 8


@pytest.mark.parametrize("letter", ["r", "u", "v", "m", "n"])
def test_lengths_may_have_the_letters_of_the_vectors(letter: str, tmp_path: Path) -> None:
    """The article takes another letter for the vector."""
    text = re.sub(r"\bc\b", letter, TSAI)
    d = read_script(script_of("tsai", text, tmp_path))
    (article,) = pages(d, prove(d), ["latex"]).files.values()
    step = article.partition(r"\subsection{The universal joints}")[2].partition(r"\subsection")[0]
    assert rf"\mathbf {letter}" not in step
    assert letter == "n" or rf"\mathbf {VECTORS[letter]}" in step


def test_legs_as_far_apart_on_the_hand_as_on_the_ground_hold_it_nowhere(tmp_path: Path) -> None:
    equal = TSAI.replace('C1 = ["c", 0, 0]', 'C1 = ["b", 0, 0]')
    equal = re.sub("c = {value.*\n", "", equal)
    with pytest.raises(ShapeError, match="in one point, so the hand is free on a sphere"):
        read_script(script_of("equal", equal, tmp_path))
    in_line = [(real("b") * k, 0, 0) for k in (0, 1, 3)]
    d = Derivation("winches", "Winches", Paper("winches", "Winches", ("A. Nonymous",)), "In line.")
    d.parameter("b", value=1, unit="m", meaning="distance", source="an example")
    legs = [Stretch(d.joint(f"q{k}", "prismatic"), at) for k, at in enumerate(in_line, 1)]
    with pytest.raises(ShapeError, match="in one line, so the hand is free on a circle"):
        parallel(d, (real("x"), real("y"), real("z")), legs)
