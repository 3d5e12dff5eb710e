"""The joints along a path, on one branch for as long as it is possible."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.limits import nearest_turn
from closedform.robots.mechanism import TURN, Array
from closedform.robots.nearest import (
    INVALID,
    OK,
    UNREACHABLE,
    candidates,
    first_of_the_nearest,
)
from closedform.robots.search import Search
from closedform.robots.selfmotion import SINGULAR, at_seed, loose_branches

MAX_STEP = 0.5
"""The largest step of an angle from point to point that is not a jump, in rad."""
FIRST_PIECE = 256


class Path(NamedTuple):
    """The joints of a path, and what happens on the way.

    ``q`` is (points, joints), NaN where there is no solution within the limits; ``status`` and
    ``branch`` as of ``nearest``.  ``changed`` marks the points where the branch is another than
    before, ``jump`` those that a joint reaches by more than the largest step.  ``outside``, of
    shape (points, branches, joints), says which joint of which branch has no turn within its
    limits.
    """

    q: Array
    status: NDArray[np.uint8]
    branch: NDArray[np.intp]
    changed: NDArray[np.bool_]
    jump: NDArray[np.bool_]
    outside: NDArray[np.bool_]


def track(search: Search, xs: ArrayLike, q0: ArrayLike, max_step: ArrayLike | None = None) -> Path:
    """The joints along ``xs``, from the solution that is nearest to ``q0``."""
    mechanism = search.mechanism
    targets = np.asarray(xs, dtype=float)
    if targets.ndim != mechanism.task_axes + 1:
        raise ValueError(f"xs has shape {targets.shape}, expected targets along one axis")
    seed = mechanism.as_joints(q0, "q0")
    if seed.ndim != 1:
        raise ValueError(f"q0 has shape {seed.shape}, expected ({len(mechanism.joints)},)")
    if max_step is None:
        max_step = np.where(mechanism.revolute, MAX_STEP, np.inf)
    given = search.at_seed(seed).given
    if given is not None:
        given = np.broadcast_to(np.asarray(given, dtype=float), len(targets))
    steps = np.asarray(max_step, dtype=float)
    return _Tracker(replace(search, given=given), targets, steps).run(seed)


class _Tracker:
    """One path; loops over what happens on it, and computes the points between at once."""

    def __init__(self, search: Search, xs: Array, max_step: Array):
        self.search, self.xs, self.max_step = search, xs, max_step
        self.mechanism, self.limits = search.mechanism, search.limits
        found = self.mechanism.ik(xs, search.given)
        self.q, self.statuses = np.array(found.q), np.asarray(found.status)
        self.solved = (self.statuses == OK) | (self.statuses == SINGULAR)
        points, _, joints = self.q.shape
        self.outside = self._outside(0, points)
        self.q_path = np.full((points, joints), np.nan)
        self.branch = np.full(points, -1)
        invalid = (self.statuses == INVALID).all(-1)
        self.status = np.where(invalid, INVALID, UNREACHABLE).astype(np.uint8)

    def run(self, seed: Array) -> Path:
        points = len(self.xs)
        loose = loose_branches(self.mechanism, self.q, self.statuses, self.xs, self.search.given)
        singular = np.asarray(loose.any(-1))
        edges = np.flatnonzero(np.diff(singular)) + 1
        last, before = seed, -1
        for start, end in pairwise([0, *edges.tolist(), points] if points else []):
            if singular[start]:
                self._release(start, end, last)
            last, before = self._follow(start, end, last, before)
        held = np.concatenate([[seed], self.q_path])
        known = np.isfinite(held).all(-1)
        latest = np.maximum.accumulate(np.where(known, np.arange(points + 1), 0))
        step = np.abs(self.q_path - held[latest[:-1]])
        labels = np.concatenate([[-1], self.branch])
        earlier = labels[latest[:-1]]
        reached = self.branch >= 0
        return Path(
            q=self.q_path,
            status=self.status,
            branch=self.branch,
            changed=reached & (earlier >= 0) & (earlier != self.branch),
            jump=(step > self.max_step).any(-1),
            outside=self.outside,
        )

    def _outside(self, start: int, end: int) -> NDArray[np.bool_]:
        q = self.q[start:end]
        outside = nearest_turn(self.mechanism, q, q, self.limits.at(1))[1]
        return np.asarray(outside & self.solved[start:end, :, None])

    def _release(self, start: int, end: int, seed: Array) -> None:
        """Keep the free joint, at all these points, at its value before them."""
        given = None if self.search.given is None else np.asarray(self.search.given)[start:end]
        mechanism = self.mechanism.part((len(self.xs),), np.arange(start, end))
        part = replace(self.search, mechanism=mechanism, given=given)
        seeds = np.broadcast_to(seed, (end - start, len(seed)))
        q, status = self.q[start:end], self.statuses[start:end]
        self.q[start:end] = at_seed(part, q, status, self.xs[start:end], seeds)
        self.outside[start:end] = self._outside(start, end)

    def _follow(self, start: int, end: int, last: Array, before: int) -> tuple[Array, int]:
        """Write the points from ``start`` to ``end``; return the last joints and their branch."""
        usable = self.solved[start:end] & ~self.outside[start:end].any(-1)
        reached = np.flatnonzero(usable.any(-1)) + start
        size, i = FIRST_PIECE, start
        while True:
            k = int(np.searchsorted(reached, i))
            if k == len(reached):
                return last, before
            i = int(reached[k])
            branch, at = self._choose(i, last, before)
            stop = min(i + size, end)
            piece = self._lifted(branch, i, stop, at)
            step = np.abs(np.diff(piece, axis=0))
            with np.errstate(invalid="ignore"):
                fails = (step > self.max_step).any(-1) | self.limits.exceeded(piece[1:]).any(-1)
            fails |= ~usable[i + 1 - start : stop - start, branch]
            length = 1 + int(fails.argmax()) if fails.any() else len(piece)
            size = FIRST_PIECE if fails.any() else 2 * size
            self.q_path[i : i + length] = piece[:length]
            self.branch[i : i + length] = branch
            self.status[i : i + length] = self.statuses[i : i + length, branch]
            last, before = piece[length - 1], branch
            i += length

    def _choose(self, i: int, last: Array, before: int) -> tuple[int, Array]:
        """The branch before, if it goes on without a jump, or else the nearest one."""
        found = candidates(self.search, self.q[i], self.statuses[i], last)
        if before >= 0 and np.isfinite(found.distance[before]):
            own = found.q[before]
            if (np.abs(own - last) <= self.max_step).all():
                return before, own
        branch = int(first_of_the_nearest(found.distance))
        return branch, found.q[branch]

    def _lifted(self, branch: int, start: int, end: int, first: Array) -> Array:
        """A branch without jumps by whole turns, from its joints at the first point."""
        q = self.q[start:end, branch]
        with np.errstate(invalid="ignore"):
            turns = np.rint((q[:-1] - q[1:]) / TURN) * self.mechanism.revolute
        offset = np.rint((first - q[0]) / TURN) * self.mechanism.revolute
        whole = offset + np.concatenate([np.zeros_like(q[:1]), np.cumsum(turns, axis=0)])
        return np.asarray(q + TURN * whole)
