"""Targets just out of reach of a stretched or folded arm: an OK answer still reaches them."""

import numpy as np
import pytest
from fuzz.lengths import on_singular_set
from fuzz.robots import Robot, robot
from given import beside, names

OK = 0
PROMISED = 1e-12
ROWS = 40_000
ARMS = ("franka_arm", "opw_arm", "puma560", "srs_arm", "ur_arm")
Array = np.ndarray


def directions(subject: Robot, q: Array, size: float) -> tuple[Array, Array]:
    """A twist of each posture, without units, that the joints cannot give; and how nearly."""
    module = subject.module("c")
    given = [k for k, joint in enumerate(subject.joints) if joint in names(module)]
    J = np.delete(module.jacobian_space(q), given, axis=2)
    J[:, :3] /= size
    left, stretched, _ = np.linalg.svd(J)
    return left[:, :, -1], stretched[:, -1]


def moved(T: Array, twists: Array, size: float) -> Array:
    """Targets after small twists, whose angular part turns about the origin."""
    v, (x, y, z) = twists[:, :3] * size, twists[:, 3:].T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    moved = T.copy()
    moved[:, :3] += cross @ T[:, :3]
    moved[:, :3, 3] += v
    return moved


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("name", ARMS)
def test_what_is_ok_just_out_of_reach_misses_by_no_more_than_promised(
    name: str, backend: str
) -> None:
    """The first bound allows a part of the promise; no later joint may amplify what is missing."""
    subject, rng = robot(name), np.random.default_rng(3)
    module, size = subject.module(backend), float(np.abs(subject.defaults).sum())
    lengths = np.tile(subject.defaults, (ROWS, 1))
    q = rng.uniform(-np.pi, np.pi, (ROWS, len(subject.joints)))
    q = on_singular_set(rng, subject, q, lengths)
    ways, rank = directions(subject, q, size)
    q, ways = q[rank < 1e-9], ways[rank < 1e-9]
    far = 10.0 ** rng.uniform(-16, -10, len(q)) * rng.choice((-1, 1), len(q))
    targets = moved(np.array(module.fk(q)), ways * far[:, None], size)
    found = module.ik(targets, *beside(module, q, module.Parameters()))
    at, branch = np.nonzero(found.status == OK)
    assert len(np.unique(at)) > 300, "too few targets to tell"
    miss = np.abs(module.fk(found.q[at, branch]) - targets[at])
    miss[:, :3, 3] /= size
    worst = miss.reshape(len(at), -1).max(axis=1)
    assert worst.max() < PROMISED, f"{worst.max():.2e} at {q[at[worst.argmax()]].tolist()}"
