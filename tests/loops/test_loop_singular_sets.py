"""Closed loops on their singular sets, as near as numbers get; and single loops by Newton."""

import numpy as np
import pytest
from loop_files import newton
from test_loops import HANDS, OK, SINGLE, SINGULAR, UNREACHABLE, apart, robot

SERIAL = ("five_bar", "delta", "linear_delta", "orthoglide", "spherical_five_bar", *SINGLE)
PAIRS = 4000


def between(inside, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """The last postures from ``low`` towards ``high`` that are ``inside``, by bisection."""
    for _ in range(80):
        middle = (low + high) / 2
        there = inside(middle)[:, None]
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    return low


def pairs(module, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Random postures and others near them; sliders go beyond where the legs reach."""
    rng, size = np.random.default_rng(seed), max(map(abs, module.Parameters()))
    slides = [module.SKELETON.joints[name].kind == "prismatic" for name in module.JOINTS]
    low = -2 * size if module.TASK != ("x", "y") else 0  # a leg has a length
    ends = np.where(slides, low, -np.pi), np.where(slides, 2 * size, np.pi)
    q, other = rng.uniform(*ends, (2, PAIRS, len(slides)))
    return q, q + 0.2 * (other - q)


def compare(module, q: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Find each posture among the branches of its hand, and return the status of that branch."""
    turns = np.array([module.SKELETON.joints[j].kind == "revolute" for j in module.JOINTS])
    size = np.sum(np.abs(module.Parameters())) + (0 if turns.all() else np.abs(q).max())
    answers = module.ik(p)
    gap = np.where(np.isnan(answers.q).any(axis=-1), np.inf, apart(answers.q, q[:, None], turns))
    nearest = gap.argmin(axis=-1)
    assert gap.min(axis=-1).max() < 1e-5 * size
    there = module.fk(answers.q)
    miss = apart(there.p, p[:, None, None], np.array([module.TASK == ("psi",)]))
    miss = np.where(there.status == OK, miss, np.inf).min(axis=-1)
    good = answers.status == OK
    assert not good.any() or miss[good].max() < 1e-12 * size
    return answers.status[np.arange(len(q)), nearest]


@pytest.mark.parametrize("name", SERIAL)
def test_on_every_serial_set(name: str) -> None:
    """Where a joint moves and the hand stands still, no posture is lost."""
    module = robot(name)
    low, high = pairs(module, 21)
    for leg in range(len(module.JOINTS)):
        first, last = (module.jacobian_serial(q)[:, 0, leg] for q in (low, high))
        crossed = (first > 0) & (last < 0)
        assert crossed.sum() > 10
        q = between(
            lambda q: module.jacobian_serial(q)[:, 0, leg] > 0,  # noqa: B023
            low[crossed],
            high[crossed],
        )
        p, status = module.fk(q)
        kept = status[:, 0] == OK
        sizes = np.abs(module.jacobian_serial(q)[kept, 0, leg])
        q, p = q[kept][sizes < 1e-9], p[kept, 0][sizes < 1e-9]
        assert len(q) > 10
        assert (compare(module, q, p) != UNREACHABLE).all()


@pytest.mark.parametrize("name", HANDS)
def test_on_the_parallel_set(name: str) -> None:
    """Where both assembly modes meet, the posture is found, and the status is SINGULAR."""
    module = robot(name)
    low, high = pairs(module, 23)
    there = [module.fk(q).status[:, 0] == OK for q in (low, high)]
    leaves = there[0] & ~there[1]
    assert leaves.sum() > 10
    q = between(lambda q: module.fk(q).status[:, 0] == OK, low[leaves], high[leaves])
    p = module.fk(q).p[:, 0]
    size = np.sum(np.abs(module.Parameters())) + np.abs(q).max()
    assert np.abs(module.fk(q).p[:, 1] - p).max() < 1e-5 * size
    assert (compare(module, q, p) == SINGULAR).all()


def gap(name: str, q: float, x: float) -> float:
    """By how much the rod of a single loop is too long, from its drawing."""
    values = robot(name).Parameters()
    if name == "four_bar":
        L1, L2, L3, L4 = values
        crank = np.array([L2 * np.cos(q), L2 * np.sin(q)])
        return float(np.linalg.norm(crank - (L1 + L4 * np.cos(x), L4 * np.sin(x))) - L3)
    r, l, *offset = values
    crank = np.array([r * np.cos(q), r * np.sin(q)])
    return float(np.linalg.norm(crank - (x, *(offset or [0]))) - l)


@pytest.mark.parametrize("name", SINGLE)
def test_newton_finds_no_posture_of_a_single_loop_that_is_lacking(name: str) -> None:
    module, rng = robot(name), np.random.default_rng(25)
    forward, inverse = set(), set()
    angle = np.array([name == "four_bar"])
    for q in rng.uniform(-np.pi, np.pi, 8):
        found = module.fk([q])
        for start in rng.uniform(-np.pi, np.pi, 20):
            x = newton(lambda x: np.array([gap(name, q, x[0])]), np.array([start]))  # noqa: B023
            if x is not None:
                near = apart(found.p, x, angle)
                forward.add(int(np.nanargmin(near)))
                assert np.nanmin(near) < 1e-6
        target = found.p[0]
        answers = module.ik(target)
        for start in rng.uniform(-np.pi, np.pi, 20):
            posture = newton(
                lambda q: np.array([gap(name, q[0], target[0])]),  # noqa: B023
                np.array([start]),
            )
            if posture is not None:
                near = apart(answers.q, posture, np.array([True]))
                inverse.add(int(np.nanargmin(near)))
                assert np.nanmin(near) < 1e-5
    assert forward == inverse == {0, 1}
