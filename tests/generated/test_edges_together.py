"""On two edges at once, a target just outside of the workspace: an OK answer still reaches it."""

import importlib
from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
PROMISED = 1e-12
ROWS = 20_000
Array = np.ndarray


@pytest.fixture(params=("numpy", "c"))
def backend(request: pytest.FixtureRequest) -> str:
    return request.param


def load(backend: str, robot: str) -> ModuleType:
    return importlib.import_module(f"closedform.generated.{backend}.{robot}")


def last(holds: Callable[[Array], Array], start: Array, end: Array) -> Array:
    """The last place of each row, on the way from its start to its end, where a condition holds."""
    for _ in range(80):
        middle = (start + end) / 2
        if np.all((middle == start) | (middle == end)):
            break  # neighbours in double precision
        there = holds(middle).reshape(-1, *[1] * (start.ndim - 1))
        start, end = np.where(there, middle, start), np.where(there, end, middle)
    return start


class Postures:
    """Postures of a loop with its lengths, one of each in a row."""

    def __init__(self, module: ModuleType, lengths: Array):
        self.module, self.lengths = module, lengths

    def accepted(self, q: Array) -> Array:
        return self.module.fk(q, tuple(self.lengths.T)).status[..., 0] == OK

    def straight(self, q: Array, leg: int) -> Array:
        """On which side the crank and the rod of a leg are of one line."""
        rates = self.module.jacobian_serial(q, tuple(self.lengths.T))
        return (rates[:, 0] if rates.ndim == 3 else rates)[:, leg] > 0

    def kept(self, rows: Array) -> "Postures":
        return Postures(self.module, self.lengths[rows])


def two_edges(module: ModuleType, leg: int, rng: np.random.Generator) -> tuple[Postures, Array]:
    """Postures on the edge of fk in which a leg is straight as well."""
    example = np.array(module.Parameters())
    turned = [name.startswith("alpha") for name in module.Parameters._fields]
    factors = 10 ** rng.uniform(-1, 1, (ROWS, len(example)))
    loop = Postures(module, np.where(turned, example, example * factors))
    near, beyond, aside = rng.uniform(-np.pi, np.pi, (3, ROWS, len(module.JOINTS)))
    rows = np.all([loop.accepted(near + k * aside) for k in (0, 1)], axis=0)
    rows &= ~np.any([loop.accepted(beyond + k * aside) for k in (0, 1)], axis=0)
    loop, near, beyond, aside = loop.kept(rows), near[rows], beyond[rows], aside[rows]

    def edge(share: Array) -> Array:
        moved = share[:, None] * aside
        return last(loop.accepted, near + moved, beyond + moved)

    none, whole = np.zeros(len(near)), np.ones(len(near))
    first = loop.straight(edge(none), leg)
    q = edge(last(lambda share: loop.straight(edge(share), leg) == first, none, whole))
    rows = (loop.straight(edge(whole), leg) != first) & loop.accepted(q)
    return loop.kept(rows), q[rows]


def misses(loop: Postures, q: Array) -> tuple[Array, Array]:
    """The statuses of ik at the image of postures, and how far its answers miss, by the lengths."""
    module, params = loop.module, tuple(loop.lengths.T)
    target = module.fk(q, params).p[:, 0]
    answers = module.ik(target, params)
    turned = [name.startswith("alpha") for name in module.Parameters._fields]
    size = np.abs(np.where(turned, 0, loop.lengths)).sum(axis=-1)
    if module.TASK == ("x",):
        size = size + np.abs(target)[:, 0]
    found = []
    for branch in range(answers.status.shape[1]):
        again = module.fk(answers.q[:, branch], params).p
        off = np.abs(again - target[:, None]).max(axis=-1)
        found.append(np.nan_to_num(off, nan=np.inf).min(axis=-1) / size)
    return answers.status, np.stack(found, axis=-1)


@pytest.mark.parametrize("robot", ["five_bar", "hybrid_five_bar", "delta"])
def test_rods_that_just_do_not_meet_and_a_straight_leg(backend: str, robot: str) -> None:
    module, rng, tried = load(backend, robot), np.random.default_rng(8), 0
    for leg in range(len(module.JOINTS)):
        loop, q = two_edges(module, leg, rng)
        status, off = misses(loop, q)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        assert off[status == OK].max() <= PROMISED
        tried += len(q)
    assert tried > 60


def test_a_short_rod_in_line_with_its_crank(backend: str) -> None:
    """The crank is at right angles to the way of the slider, and the rod just too short."""
    module, rng = load(backend, "slider_crank"), np.random.default_rng(5)
    r, l = 10 ** rng.uniform(-4, 4, (2, ROWS))
    e = (r + rng.choice((-1, 1), ROWS) * l) * (1 + rng.choice((0, 1e-12, -1e-12, 1e-9), ROWS))
    loop = Postures(module, np.stack([r, l, e], axis=-1))
    near = np.arcsin(np.clip(e / r, -1, 1))[:, None]
    beyond = rng.uniform(-np.pi, np.pi, (ROWS, 1))
    rows = loop.accepted(near) & ~loop.accepted(beyond)
    loop = loop.kept(rows)
    q = last(loop.accepted, near[rows], beyond[rows])
    status, off = misses(loop, q)
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    assert off[status == OK].max() <= PROMISED
    assert len(q) > 1000
