"""Dimensions and postures that may break generated code: unlike lengths, zeros, singular sets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .robots import Robot

Array = NDArray[np.float64]

NEAR = (0.0, 5e-324, 1e-160, 1e-17, 1e-16, 1e-15, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3, 0.1)
GRID = 33
HALVINGS = 60


def draw_lengths(rng: np.random.Generator, robot: Robot, n: int) -> Array:
    """Parameters for ``n`` postures: the example, alike, unlike, some equal, some zero."""
    example = np.array(robot.defaults)
    m = len(example)
    kind = rng.integers(0, 5, (n, 1))
    unlike = 10.0 ** rng.uniform(-4, 4, (n, m))
    alike = rng.uniform(0.1, 3.0, (n, m))
    lengths = np.choose(kind, [np.broadcast_to(example, (n, m)), alike, unlike, unlike, alike])
    if m:
        # one length equal to another, or zero, in the last two kinds
        rows = np.arange(n)
        equal = (kind[:, 0] >= 3) & (rng.random(n) < 0.6)
        source, target = rng.integers(0, m, (2, n))
        lengths[rows[equal], target[equal]] = lengths[rows[equal], source[equal]]
        vanishing = (kind >= 3) & (rng.random((n, m)) < 0.25) & ~np.array(robot.needed)
        lengths = np.where(vanishing, 0.0, lengths)
        signs = np.where(robot.signed, rng.choice((-1.0, 1.0), (n, m)), 1.0)
        lengths = np.where(kind == 0, lengths, lengths * signs)
    return np.asarray(lengths)


def draw_postures(rng: np.random.Generator, robot: Robot, lengths: Array) -> tuple[Array, Array]:
    """Joints, random or on and near the singular set, and which of them are singular."""
    n, m = len(lengths), len(robot.joints)
    q = rng.uniform(-np.pi, np.pi, (n, m))
    near = rng.choice(NEAR, (n, m)) * rng.choice((-1.0, 1.0), (n, m))
    corners = rng.choice((-np.pi, -np.pi / 2, 0.0, np.pi / 2, np.pi), (n, m)) + near
    kind = rng.integers(0, 5, n)
    some = (kind == 1)[:, None] & (rng.random((n, m)) < 0.5)
    q = np.where(some | (kind == 2)[:, None], corners, q)
    q = _slides(rng, robot, q, lengths)
    for own, other in enumerate(robot.twin_of):
        if other >= 0:
            fraction = rng.choice((8.0, 32.0, 512.0), n)
            apart = np.where(rng.random(n) < 0.3, near[:, own] / 8, q[:, own] / fraction)
            q[:, own] = q[:, other] + apart
    solved = kind == 3
    q[solved] = on_singular_set(rng, robot, q[solved], lengths[solved])
    return q, (kind > 0) & (kind < 4)


def _slides(rng: np.random.Generator, robot: Robot, q: Array, lengths: Array) -> Array:
    """Slides are as long as the arm, or much shorter or longer, or zero."""
    size = robot.lengths_of(lengths).sum(axis=1)
    size = np.where(size > 0, size, 1.0)
    for k in np.flatnonzero(robot.slides):
        factor = np.where(rng.random(len(q)) < 0.5, 1.0, 10.0 ** rng.uniform(-9, 4, len(q)))
        value = rng.uniform(-1.5, 1.5, len(q)) * factor * size
        value[rng.random(len(q)) < 0.05] = 0.0
        q[:, k] = np.abs(value) if robot.positive[k] else value
    return q


def on_singular_set(rng: np.random.Generator, robot: Robot, q: Array, lengths: Array) -> Array:
    """Move one joint of each posture to where a factor of the singular set changes its sign."""
    if not len(q):
        return q
    rows = np.arange(len(q))
    module = robot.module("c")
    params = tuple(lengths.T)
    probe = np.asarray(module.singularities(q, params)).reshape(len(q), -1)
    factor = rng.integers(0, probe.shape[1], len(q))
    joint = rng.integers(0, q.shape[1], len(q))

    def value(place: Array) -> Array:
        moved = q.copy()
        moved[rows, joint] = place
        return np.asarray(module.singularities(moved, params)).reshape(len(q), -1)[rows, factor]

    reach = np.where(np.array(robot.slides)[joint], 1.5 * np.abs(lengths).sum(axis=1), np.pi)
    low = np.where(np.array(robot.positive)[joint], 0.0, -reach)
    places = low[:, None] + (reach - low)[:, None] * np.linspace(0, 1, GRID)
    places = places + rng.uniform(0, 0.1, (len(q), 1))
    values = np.stack([value(places[:, k]) for k in range(GRID)], axis=1)
    with np.errstate(invalid="ignore"):
        change = np.sign(values[:, 1:]) * np.sign(values[:, :-1]) < 0
    found = change.any(axis=1)
    first = np.argmax(change, axis=1)
    a, b = places[rows, first], places[rows, first + 1]
    sign = np.sign(values[rows, first])
    for _ in range(HALVINGS):
        middle = (a + b) / 2
        same = np.sign(value(middle)) == sign
        a, b = np.where(same, middle, a), np.where(same, b, middle)
    q = q.copy()
    offset = rng.choice(NEAR, len(q)) * rng.choice((-1.0, 1.0), len(q))
    q[rows, joint] = np.where(found, a + offset * np.maximum(reach, 1e-3), q[rows, joint])
    return q
