"""Of all branches and turns of an inverse, the posture that is nearest to a seed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.limits import Limits, nearest_turn
from closedform.robots.mechanism import Array
from closedform.robots.search import Search
from closedform.robots.selfmotion import SINGULAR, at_seed

OK, UNREACHABLE, INVALID = 0, 1, 3
STATUSES = ("OK", "UNREACHABLE", "SINGULAR", "INVALID")
BLOCK = 1000
"""Targets that are compared at once: the arrays of all their branches then stay in the cache."""
TIE = 1e-9
"""Branches count as equally near if their distances differ by less than this share."""


class Nearest(NamedTuple):
    """The posture that was found for each target, and why there is none.

    ``q`` has the shape (..., joints) and is NaN if there is none.  ``status`` is that of the
    branch, or UNREACHABLE or INVALID.  ``branch`` is its index in ``branches``, or -1.
    ``distance`` is that from the seed, or infinite.  ``outside``, of shape (..., branches, joints),
    says which joint of which branch has no turn within its limits; such a branch is not taken.
    """

    q: Array
    status: NDArray[np.uint8]
    branch: NDArray[np.intp]
    distance: Array
    outside: NDArray[np.bool_]

    def __repr__(self) -> str:
        """A line for one target; the arrays of several."""
        if np.ndim(self.status):
            return f"Nearest({', '.join(f'{n}={v!r}' for n, v in self._asdict().items())})"
        told = f"{self.q.tolist()} {STATUSES[self.status]}"
        if self.branch >= 0:
            told += f", branch {self.branch}, distance {self.distance:.6g}"
        elif lost := np.count_nonzero(self.outside.any(-1)):
            told += f", branches outside the limits: {lost}"
        return f"Nearest({told})"


class Candidates(NamedTuple):
    """All branches for targets, each at the turns that are nearest to the seed."""

    q: Array
    status: NDArray[np.uint8]
    outside: NDArray[np.bool_]
    distance: Array


def nearest(search: Search, x: ArrayLike, q_seed: ArrayLike) -> Nearest:
    """The solution with the least weighted distance from ``q_seed`` within the limits."""
    seed = search.mechanism.as_joints(q_seed, "q_seed")
    search = search.at_seed(seed)
    found = _compiled(search, x, seed)
    if found is None:
        return _composed(search, x, seed)
    answer, undecided = found
    if not undecided.any():
        return answer
    if not undecided.ndim:
        return _composed(search, x, seed)
    lead, shape = undecided.shape, search.mechanism.task_shape
    if search.given is not None:
        search = replace(search, given=np.broadcast_to(search.given, lead)[undecided])
    targets = np.broadcast_to(np.asarray(x, float), (*lead, *shape))[undecided]
    rest = _composed(search, targets, _over(seed, lead, 1)[undecided])
    for whole, part in zip(map(np.asarray, answer), rest, strict=True):
        whole[undecided] = part
    return answer


def _composed(search: Search, x: ArrayLike, seed: Array) -> Nearest:
    """The same, from all branches of the inverse."""
    limits = search.limits
    found = search.mechanism.ik(x, search.given)
    lead = np.broadcast_shapes(
        found.q.shape[:-2], seed.shape[:-1], limits.lower.shape[:-1], limits.upper.shape[:-1]
    )
    branches, n = found.q.shape[-2:]
    q, status = _over(found.q, lead, 2), _over(found.status, lead, 1)
    seed = _over(seed, lead, 1)
    q = at_seed(search, q, status, np.asarray(x, float), seed).reshape(-1, branches, n)
    status, seed = status.reshape(-1, branches), seed.reshape(-1, n)
    lower, upper, weights = (_over(a, lead, 1).reshape(-1, n) for a in (*limits, search.weights))
    blocks = []
    for start in range(0, max(len(q), 1), BLOCK):
        rows = slice(start, start + BLOCK)
        within = replace(search, limits=Limits(lower[rows], upper[rows]), weights=weights[rows])
        blocks.append(_of_block(within, q[rows], status[rows], seed[rows]))
    every = blocks[0] if len(blocks) == 1 else map(np.concatenate, zip(*blocks, strict=True))
    return Nearest(*(a.reshape((*lead, *a.shape[1:]))[()] for a in every))


def _compiled(
    search: Search, x: ArrayLike, seed: Array
) -> tuple[Nearest, NDArray[np.bool_]] | None:
    """What the compiled module finds, and where there is more to decide; None if it cannot."""
    mechanism, limits = search.mechanism, search.limits
    call = getattr(mechanism.module, "_nearest", None)
    if call is None or mechanism.one_by_one is None:
        return None
    several = (limits.lower, limits.upper, search.weights)
    if any(a.ndim > 1 for a in several) or mechanism.dimensions_vary:
        return None
    target = mechanism.inside(x)
    if np.shape(target)[-mechanism.task_axes :] != mechanism.task_shape:
        return None
    signs, offsets = mechanism.one_by_one
    start, sides = seed, np.array(limits)
    if not mechanism.counts_as_model:
        start, sides = signs * seed + offsets, np.sort(signs * sides + offsets, axis=0)
    q, status, branch, distance, outside = call(
        target,
        start,
        sides,
        search.weights,
        *mechanism.to_give(search.given),
        params=mechanism.parameters,
    )
    known = (status == UNREACHABLE) | (status == OK) & (distance < np.inf)
    if not mechanism.counts_as_model:
        # of two turns the lower one is taken, which the opposite sign would exchange
        halfway = abs(abs(q - start) - np.pi) < TIE
        known &= ~halfway[..., signs < 0].any(-1)
        q = signs * (q - offsets)
    branch = np.array(branch, np.intp)[()]
    return Nearest(q, status, branch, distance, outside), np.asarray(~known)


def _over(a: NDArray[Any], lead: tuple[int, ...], core: int) -> NDArray[Any]:
    """An array with these leading axes, before its last ``core`` ones."""
    shape = (*lead, *a.shape[a.ndim - core :])
    return a if a.shape == shape else np.broadcast_to(a, shape)


def _of_block(search: Search, q: Array, status: NDArray[np.uint8], seed: Array) -> Nearest:
    all_of = candidates(search, q, status, seed)
    branch = first_of_the_nearest(all_of.distance)
    rows = np.arange(len(q))
    distance = all_of.distance[rows, branch]
    none = ~np.isfinite(distance)
    invalid = (status == INVALID).all(-1) | ~np.isfinite(seed).all(-1)
    told = np.where(none, np.where(invalid, INVALID, UNREACHABLE), status[rows, branch])
    return Nearest(
        np.where(none[:, None], np.nan, all_of.q[rows, branch]),
        told.astype(np.uint8),
        np.where(none, -1, branch),
        distance,
        all_of.outside,
    )


def candidates(search: Search, q: Array, status: NDArray[np.uint8], seed: Array) -> Candidates:
    """All branches at the turns nearest to the seed; the distance of one that fails is infinite."""
    q, outside = nearest_turn(search.mechanism, q, seed[..., None, :], search.limits.at(1))
    solved = (status == OK) | (status == SINGULAR)
    usable = solved & ~outside.any(-1)
    with np.errstate(invalid="ignore"):
        gap = (q - seed[..., None, :]) ** 2
        distance = np.sqrt((search.weights[..., None, :] * gap).sum(-1))
    known = usable & np.isfinite(distance)
    return Candidates(
        q, np.asarray(status), outside & solved[..., None], np.where(known, distance, np.inf)
    )


def first_of_the_nearest(distance: Array) -> NDArray[np.intp]:
    """The index of the least distance, and of several that are equal, the first."""
    least = distance.min(-1, keepdims=True)
    return np.asarray((distance <= least * (1 + TIE) + TIE**2).argmax(-1))
