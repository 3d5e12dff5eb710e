"""Where a loop nearly closes: fk accepts no hand that ik calls out of reach."""

import importlib
import itertools
from collections.abc import Iterator
from types import ModuleType

import numpy as np
import pytest

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
BACKENDS = ("numpy", "c")
TOLERANCE = 1e-12
RODS = {"five_bar": (3, 4), "delta": (3, 3, 3), "linear_delta": (2, 2, 2), "orthoglide": (0, 0, 0)}
"""Which parameters are the lengths of the rods."""
LOOPS = ("four_bar", "slider_crank", "hybrid_five_bar", "spherical_five_bar")
LOOPS += ("h6ar", "h6ar_loop_closed")


@pytest.fixture(params=BACKENDS)
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


def load(backend: str, robot: str) -> ModuleType:
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def accepted(module: ModuleType, q: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """Whether fk accepts a posture: by the status of the first mode, or because it is not NaN."""
    image = module.fk(q, lengths)
    return image.status[..., 0] == OK if hasattr(image, "status") else np.isfinite(image).all(-1)


def edges(module: ModuleType, seed: int) -> Iterator[tuple[tuple[float, ...], np.ndarray]]:
    """Lengths, and the last postures that fk accepts on the way to others that it does not."""
    rng, example = np.random.default_rng(seed), np.array(module.Parameters())
    slides = [module.SKELETON.joints[name].kind == "prismatic" for name in module.JOINTS]
    turned = [name.startswith("alpha") for name in module.Parameters._fields]
    for _ in range(20):
        lengths = np.where(turned, example, example * 10 ** rng.uniform(-1, 1, len(example)))
        reach = np.where(slides, 3 * np.abs(lengths).max(), np.pi)
        q = rng.uniform(-reach, reach, (2, 500, len(slides)))
        exists = accepted(module, q, lengths)
        near, beyond = (q[k][exists[0] & ~exists[1]] for k in (0, 1))
        for _ in range(80):
            middle = (near + beyond) / 2
            there = accepted(module, middle, lengths)[:, None]
            near, beyond = np.where(there, middle, near), np.where(there, beyond, middle)
        yield tuple(lengths), near


@pytest.mark.parametrize("robot", RODS)
def test_the_rods_reach_what_fk_accepts(backend: str, robot: str) -> None:
    """A leg tolerates half of 1e-12 of the lengths; what slides counts where the hand is."""
    module, tried = load(backend, robot), 0
    slides = all(module.SKELETON.joints[name].kind == "prismatic" for name in module.JOINTS)
    turned = [name.startswith("alpha") for name in module.Parameters._fields]
    for lengths, q in edges(module, 1):
        p = module.fk(q, lengths).p
        size = np.abs(np.where(turned, 0, lengths)).sum() + slides * np.abs(p).sum(axis=-1)
        rods = np.linalg.norm(module.jacobian_parallel(q, lengths), axis=-1)
        miss = np.abs(rods - np.take(lengths, RODS[robot])).max(axis=-1)
        assert (miss <= 0.5 * TOLERANCE * size).all()
        tried += miss.size
    assert tried > 300


@pytest.mark.parametrize(
    "robot",
    [*RODS, *LOOPS],
)
def test_functions_of_the_hand_see_the_modes_of_fk(backend: str, robot: str) -> None:
    """Each computes the hand once more, and rounds in another order, as the other language does."""
    both, tried = [load(name, robot) for name in BACKENDS], 0
    names = {"pose", "jacobian_parallel", "jacobian_serial", "singularities", "skeleton"}
    for lengths, q in edges(load(backend, robot), 2):
        for module, name in itertools.product(both, sorted(names & vars(both[0]).keys())):
            assert np.isfinite(getattr(module, name)(q, lengths)).all()
        tried += len(q)
    assert tried > 50


def test_all_bars_of_the_hybrid_five_bar_in_line(backend: str) -> None:
    """Both legs are straight, and C and D farther apart than the bars are long."""
    module, told = load(backend, "hybrid_five_bar"), set()
    for L1, L2 in ((8.0, 5.0), (0.3, 4.0), (4.0, 0.3), (1.0, 1.0)):
        for beyond in np.linspace(0, 1.2e-12, 25):
            lengths = (2 * (L1 + L2) * (1 + beyond), L1, L2)
            p, status = module.fk([0.4, 0.0, np.pi], lengths)
            told |= set(status.tolist())
            for hand in p[status == OK]:
                assert np.isin(module.ik(hand, lengths).status, (OK, SINGULAR)).any()
    assert told == {OK, UNREACHABLE}


def test_rods_in_line_and_a_leg_at_right_angles_to_its_rail(backend: str) -> None:
    """Two rods of the Orthoglide are in line and the third ends at the start of its slider."""
    module, told = load(backend, "orthoglide"), set()
    for turn in np.linspace(0.1, 1.5, 15):
        for beyond in np.linspace(0, 3e-12, 31):
            out = 2 * (1 + beyond)
            p, status = module.fk([0.0, out * np.cos(turn), out * np.sin(turn)], (1.0,))
            told |= set(status.tolist())
            for hand in p[status == OK]:
                assert np.isin(module.ik(hand, (1.0,)).status, (OK, SINGULAR)).any()
    assert told == {OK, UNREACHABLE}
