"""Arms of seven joints whose arm angle is an input: the proof, and postures that come back."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import sympy as sp
from chains import arm, printed, solved
from numpy.typing import NDArray
from sharing import shared
from sympy import pi

from closedform import robots
from closedform.check.finding import module_backend
from closedform.check.inverses import check_inverse
from closedform.check.runners.python import module
from closedform.check.truth import Solutions
from closedform.check.values import check_forward
from closedform.emit.backends.latex.article import document
from closedform.emit.render import render
from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.proof.prove import Proof, prove
from closedform.proof.require import ProofError
from closedform.scaffold.chains.propose import NoChainError, propose

R = sp.Rational
TWISTS = (-pi / 2, pi / 2, pi / 2, -pi / 2, -pi / 2, pi / 2, 0)


def table(d: list, a: dict[int, Any] | None = None) -> list:
    return [((a or {}).get(i, 0), alpha, d[i]) for i, alpha in enumerate(TWISTS)]


KUKA = table([R(36, 100), 0, R(42, 100), 0, R(4, 10), 0, R(126, 1000)])
EQUAL = table([0, 0, 1, 0, 1, 0, 0])
BESIDE = R(45, 1000)
BARRETT = [(0, -pi / 2, 0), (0, pi / 2, 0), (BESIDE, -pi / 2, R(55, 100)), (-BESIDE, pi / 2, 0),
           (0, -pi / 2, R(3, 10)), (0, pi / 2, 0), (0, 0, R(6, 100))]  # fmt: skip
"""Links beside the axis of the elbow."""
ARMS = {"kuka": KUKA, "equal_links": EQUAL, "barrett": BARRETT}


def made(rows: list, *, whole: bool = True, **changed: str) -> Derivation:
    """The derivation of an arm, with parts of its chain changed; if not whole, its inverse."""
    d, serial = arm(rows)
    lines = propose(serial, "arm_angle").source
    for part, other in changed.items():
        assert part in lines
        lines = lines.replace(part, other)
    solved(d, serial, lines)
    if whole:
        serial.export(d)
    return d


def code_of(name: str, factory: pytest.TempPathFactory) -> ModuleType:
    """The NumPy module of an arm that was proved, made once for all processes."""

    def make(folder: Path) -> None:
        d = made(ARMS[name])
        (inverse,) = prove(d).inverses
        assert inverse.branches == inverse.solutions == 8
        printed(d, folder)

    return module(shared(factory, f"by_arm_angle_{name}", make) / "numpy", "arm")


@pytest.fixture(scope="module", params=ARMS)
def code(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return code_of(request.param, tmp_path_factory)


@pytest.fixture(scope="module")
def kuka(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return code_of("kuka", tmp_path_factory)


def away(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    return abs((a - b + np.pi) % (2 * np.pi) - np.pi)


def checked(code: ModuleType, q: NDArray[Any], gap: float) -> NDArray[Any]:
    """Every posture is among the answers, and these reach the pose and keep the arm angle."""
    T, psi = code.fk(q), code.arm_angle(q)
    found = code.ik(T, psi)
    answered = np.isin(found.status, (code.Status.OK, code.Status.SINGULAR))
    assert answered.any(axis=1).all()
    answers = np.nan_to_num(found.q)
    missed = abs(code.fk(answers) - T[:, None]).max(axis=(2, 3))
    assert missed[answered].max() < 1e-13
    ok = found.status == code.Status.OK
    turned = away(code.arm_angle(answers), psi[:, None]) * aside(code, T)[:, None]
    assert turned[ok].max(initial=0) < 1e-13
    near = np.nan_to_num(away(found.q, q[:, None]).max(axis=-1), nan=9).min(axis=1)
    assert near[ok.all(axis=1)].max(initial=0) < gap
    return found.status


def aside(code: ModuleType, T: NDArray[Any]) -> NDArray[Any]:
    """How far the wrist is from the first axis; the tool is before it, where it is not turned."""
    tool = code.fk(np.zeros(7))[2, 3] - code.fk(np.array([0, 0, 0, 0, 0, np.pi / 2, 0]))[2, 3]
    return np.hypot(*(T[:, :2, 3] - tool * T[:, :2, 2]).T)


def test_no_posture_is_lost(code: ModuleType) -> None:
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (50000, 7))
    assert (checked(code, q, 1e-5) == code.Status.OK).all()


@pytest.mark.parametrize("near", [0, 1e-15, 1e-12, 1e-9, 1e-6])
def test_none_is_lost_where_a_joint_is_free(code: ModuleType, near: float) -> None:
    """The shoulder, the elbow and the wrist straight or folded, one, two or all of them."""
    rng = np.random.default_rng(2)
    for straight in ((1,), (3,), (5,), (1, 3), (3, 5), (1, 5), (1, 3, 5)):
        q = rng.uniform(-np.pi, np.pi, (1000, 7))
        for k in straight:
            q[:, k] = rng.choice([0, np.pi, -np.pi], 1000) + near * rng.standard_normal(1000)
        status = checked(code, q, 9)
        if near == 0 and 5 in straight:
            assert (status == code.Status.SINGULAR).any(axis=1).mean() > 0.8


def test_a_wrist_above_the_shoulder_is_singular(kuka: ModuleType) -> None:
    """There the arm angle has no plane to be counted from."""
    code = kuka
    rng = np.random.default_rng(3)
    q = rng.uniform(-np.pi, np.pi, (1000, 7))
    q[:, 2] = 0
    q[:, 1] = -np.arctan2(-0.4 * np.sin(q[:, 3]), 0.42 + 0.4 * np.cos(q[:, 3]))
    assert (checked(code, q, 9) == code.Status.SINGULAR).all(axis=1).mean() > 0.99
    q[:, 1] += 1e-3
    assert (checked(code, q, 1e-6) == code.Status.OK).all()


def test_it_is_the_arm_angle_of_the_ready_arms(kuka: ModuleType) -> None:
    """Those have lengths as parameters, and the same postures in the order of their names."""
    code = kuka
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (2000, 7))
    ready = robots.load("iiwa14")
    T, psi = code.fk(q), code.arm_angle(q)
    assert abs(T - ready.fk(q)).max() < 1e-14
    assert away(psi, ready.given_at(q)).max() < 1e-10
    ours, theirs = code.ik(T, psi).q, ready.ik(T, psi).q
    gap = away(ours[:, :, None], theirs[:, None]).max(axis=-1)
    assert gap.min(axis=2).max() < 1e-6 and gap.min(axis=1).max() < 1e-6


def test_lengths_may_be_parameters(tmp_path: Path) -> None:
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    upper, lower = (d.parameter(n, value=1, unit="m", meaning=n) for n in ("upper", "lower"))
    joints = [d.joint(f"t{k}") for k in range(1, 8)]
    rows = table([0, 0, upper, 0, lower, 0, R(1, 10)])
    serial = from_dh(d, [(*row, joint) for row, joint in zip(rows, joints, strict=True)])
    solved(d, serial, propose(serial, "arm_angle").source)
    serial.export(d)
    prove(d)
    code = printed(d, tmp_path)
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (1000, 7))
    for lengths in ((1.0, 1.0), (0.01, 3.0), (5.0, 1e-3)):
        found = code.ik(code.fk(q, lengths), code.arm_angle(q, lengths), lengths)
        assert np.nanmin(away(found.q, q[:, None]).max(axis=-1), axis=1).max() < 1e-6
    no_link = code.ik(code.fk(q, (1.0, 0.0)), code.arm_angle(q, (1.0, 0.0)), (1.0, 0.0))
    assert (no_link.status == code.Status.SINGULAR).all()


def test_it_agrees_with_its_source_in_balls(kuka: ModuleType) -> None:
    d = made(KUKA)
    backend = module_backend("numpy", kuka)
    assert check_forward(d, d["arm_angle"], backend).failures == []
    assert check_inverse(d, d["ik"], d.inverses[0], backend).failures == []


def test_near_the_vertical_the_arm_angle_counts_as_far_as_it_is_defined(kuka: ModuleType) -> None:
    """There rounding of the joints turns the plane that it is counted from."""
    d = made(KUKA)
    truth = Solutions(d, d["ik"], d.inverses[0])
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (50, 7))
    q[:, 2] = 0
    q[:, 1] = 1e-7 - np.arctan2(-0.4 * np.sin(q[:, 3]), 0.42 + 0.4 * np.cos(q[:, 3]))
    T, psi = kuka.fk(q), kuka.arm_angle(q)
    found = kuka.ik(T, psi)
    assert (found.status == kuka.Status.OK).all()
    missed = [truth.exact_miss(found.q[k, 0], np.append(T[k], psi[k]), ()) for k in range(len(q))]
    turned = away(kuka.arm_angle(found.q[:, 0]), psi)
    assert max(missed) < 1e-14 < 1e-11 < turned.max()


@pytest.mark.parametrize(
    ("part", "other", "why"),
    [
        ("to_wrist[:2, 0], p, because={t4: 1}", "to_wrist[:2, 0], p, because={t4: 2}",
         "equally long, which the lemma 'arm plane' requires, does not follow so"),
        ("to_wrist[:2, 0], p, because={t4: 1}, sense=-1", "to_wrist[:2, 0], p, because={t4: 1}",
         "by the lemma 'arm plane' does not follow from the forward map"),
        ("R_shoulder, to_wrist[:2, 0], sense", "R_shoulder, -to_wrist[:2, 0], sense",
         "by the lemma 'arm plane' does not follow from the forward map"),
        ("M * Matrix", "M.T * Matrix", "does not follow from the forward map"),
    ],
)  # fmt: skip
def test_a_wrong_line_is_noticed(part: str, other: str, why: str) -> None:
    with pytest.raises(ProofError, match=why):
        prove(made(KUKA, whole=False, **{part: other}))


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ([(1, -pi / 2, 0), *KUKA[1:]], "its first three axes, or its last three, do not meet"),
        ([*KUKA[:3], (0, -pi / 2, R(1, 10)), *KUKA[4:]], "is not normal to axis 4"),
        ([(0, -pi / 3, R(36, 100)), *KUKA[1:]], "axes 1, 2 and 3 are not at right angles"),
    ],
)
def test_what_has_no_arm_angle_is_told(rows: list, why: str) -> None:
    with pytest.raises(NoChainError, match=why):
        propose(arm(rows)[1], "arm_angle")


def test_only_seven_joints_have_one() -> None:
    with pytest.raises(NoChainError, match="arm_angle cannot be given"):
        propose(arm(KUKA[:6])[1], "arm_angle")


def test_the_article_says_which_step_finds_the_matrix_of_the_upper_arm() -> None:
    """No equation has it on its left side, so that no article was printed of such an arm."""
    d = made(KUKA)
    text = render("latex/robot.tex.jinja", document(d, Proof(d.name, d.paper.key, (), 0, ())))
    assert "From $M$ of step 2 follow equations in $" in text
