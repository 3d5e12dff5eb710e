"""The posture at a singular target in which a free joint keeps the value of a seed.

At a singular target the inverse returns one of infinitely many postures, with a conventional value
of the free joint.  The others form a curve through it, on which the hand does not move.  Its
tangent is the null direction of the Jacobian.  Following it until the free joint has the value of
the seed leads to the wanted posture.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.mechanism import NAMES_OF_ANGLES, TURN, Array, Mechanism
from closedform.robots.search import Search

NULL = 1e-6
"""Singular values of a Jacobian without units below this share of the largest count as zero."""
MOVES = 1e-3
"""A joint takes part in a self-motion if the square of its share is larger."""
STEPS = 24
LONGEST = 0.5
"""A step on the curve that moves a joint further is not taken: the free joint turns back there."""
STRAIGHT = 1e-9
BOWED = 1e-3
"""The same where rounding spoils the direction of the line; what is left is corrected."""
CORRECTIONS, APPROACH = 3, 8
"""Steps of Newton's method from a posture on the curve, and from a seed."""
CLOSE_BY = 1e-4
BESIDE = 1e-10
"""What was given is undefined where it changes much over so small a motion."""
ROUNDING = 1e-14
DIFFERENCE = 1e-3
"""The step of differences of fourth order; their rounding is that of a posture over it."""
NEARLY = 1e-12
"""A determinant without units below this is nearly zero; rounding of a target leaves 1e-15."""
OK, SINGULAR = 0, 2
REACHED = 1e-12
"""The largest error of a posture that is returned, relative to the size of the mechanism."""


def at_seed(search: Search, q: Array, status: Array, x: Array, seed: Array) -> Array:
    """The branches of an inverse, with the free joint of a singular one at its value in the seed.

    ``q`` has the shape (..., branches, joints).  The joint that is free is the one that the inverse
    has set to zero; if there is none among those that take part, the one that moves most, and of
    several the first.  If it cannot have its value in the seed within the limits, it goes as far as
    the self-motion leads.  Where no joint is free, nothing moves; nor does a mechanism without a
    forward map, whose answers are those of the inverse.  What was given besides the target is kept,
    where it is defined.

    Rounding of a target may hide that it is singular: the branch is OK then, with any value of the
    joint that is nearly free.  It is moved too, where that is a motion in a straight line.
    """
    mechanism, limits, given = search.mechanism, search.limits, search.given
    loose = loose_branches(mechanism, q, status, x, given)
    if not loose.any():
        return q
    lead, (branches, n) = status.shape[:-1], q.shape[-2:]
    core = x.shape[x.ndim - mechanism.task_axes :]
    found = np.array(q).reshape(-1, branches, n)
    wanted = np.broadcast_to(np.clip(seed, limits.lower, limits.upper), (*lead, n)).reshape(-1, n)
    targets = np.broadcast_to(x, (*lead, *core)).reshape(-1, *core)
    at, branch = np.nonzero(loose.reshape(-1, branches))
    rounded = status.reshape(-1, branches)[at, branch] != SINGULAR
    whole = Task(mechanism, targets, _of_each(given, lead))
    task = whole.part(at, lead).keeping(found[at, branch])
    found[at, branch], doubtful = _released(task, found[at, branch], wanted[at], rounded)
    if not doubtful.any():
        return found.reshape(q.shape)
    near, branch, posture = _near(whole, lead, wanted, np.unique(at[doubtful]))
    singular = status.reshape(-1, branches)[near, branch] == SINGULAR
    near, branch, posture = near[singular], branch[singular], posture[singular]
    better = _distance(mechanism, posture, wanted[near]) < _distance(
        mechanism, found[near, branch], wanted[near]
    )
    found[near[better], branch[better]] = posture[better]
    return found.reshape(q.shape)


def loose_branches(
    mechanism: Mechanism, q: Array, status: Array, x: Array, given: ArrayLike | None = None
) -> NDArray[np.bool_]:
    """Which branches are singular, or so nearly that rounding decides; none if there is no fk.

    Targets and what was given have the leading axes of the branches, or none.
    """
    singular = np.asarray(status == SINGULAR)
    if not mechanism.has("fk"):
        return np.zeros_like(singular)
    if not mechanism.has("determinant") and given is None:
        return singular
    lead, (branches, n) = status.shape[:-1], q.shape[-2:]
    core = x.shape[x.ndim - mechanism.task_axes :]
    targets = np.broadcast_to(x, (*lead, *core)).reshape(-1, *core)
    size = np.broadcast_to(Task(mechanism, targets).size, len(targets))[:, None]
    if given is None:
        every = mechanism.of_branches(lead)
        found = np.abs(every.call("determinant", every.to_model(q.reshape(-1, branches, n))))
        if mechanism.module.ASSEMBLY_MODES:
            found = np.fmin.reduce(found, axis=-1)
        small = np.asarray(found <= NEARLY * size ** _lengths(mechanism))
    else:
        rows = np.repeat(np.arange(len(targets)), branches)
        task = Task(mechanism, targets, _of_each(given, lead)).part(rows, lead)
        J = task.jacobian(np.nan_to_num(q).reshape(-1, n))
        with np.errstate(invalid="ignore"):  # NaN for a target that is not finite
            small = np.abs(np.linalg.det(J)).reshape(-1, branches) <= NEARLY / DIFFERENCE
    return np.asarray(singular | small.reshape(status.shape) & (status == OK))


def _lengths(mechanism: Mechanism) -> int:
    """The power of a length in the determinant of the Jacobian."""
    named = sum(name not in NAMES_OF_ANGLES for name in mechanism.module.TASK)
    return {16: 3, 9: 0}.get(len(mechanism.module.TASK), named) - int((~mechanism.revolute).sum())


def _of_each(given: ArrayLike | None, lead: tuple[int, ...]) -> Array | None:
    return None if given is None else np.broadcast_to(np.asarray(given, float), lead).ravel()


def _distance(mechanism: Mechanism, q: Array, seed: Array) -> Array:
    """How far joints are from a seed, whatever their turn."""
    gap = np.abs(q - seed)
    return np.asarray(
        np.where(mechanism.revolute, np.abs(gap - TURN * np.rint(gap / TURN)), gap).sum(-1)
    )


def _near(
    whole: Task, lead: tuple[int, ...], wanted: Array, rows: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Singular postures near the seeds: for which target, on which branch, and the joints.

    A curve that turns back may reach the seed only on its other side.  Newton's method, from the
    seed, finds that side.  The branch is the one of a regular posture close by.
    """
    mechanism, task = whole.mechanism, whole.part(rows, lead)
    around = mechanism.revolute & (np.abs(wanted[rows]) > np.pi)
    start = np.where(around, wanted[rows] - TURN * np.rint(wanted[rows] / TURN), wanted[rows])
    q = _polished(task, start, None)
    free, shares = _largest(_null_projector(task.jacobian(q)))
    kept = q.copy()
    kept[np.arange(len(q)), free] = start[np.arange(len(q)), free]
    kept = _polished(task, kept, free)
    # If the free joint cannot have its value in the seed, the posture stays where it is.
    q = np.where((task.size_of_error(kept) <= REACHED)[:, None], kept, q)
    good = (task.size_of_error(q) <= REACHED) & (shares > MOVES)
    rows, q = rows[good], q[good]
    if task.given is not None:
        q = task.holding(q, np.broadcast_to(task.given[good, None], q.shape))
    nudge = CLOSE_BY * np.cos(np.arange(q.shape[-1]) + 1.0)
    regular = mechanism.part(lead, rows)
    moved = np.asarray(regular.fk(q + nudge)) if not mechanism.module.ASSEMBLY_MODES else None
    if moved is None or not len(rows):
        return rows[:0], rows[:0], q[:0]
    beside = None if mechanism.given is None else regular.given_at(q + nudge)
    found = regular.ik(moved, beside).q
    gap = _distance(mechanism, found, (q + nudge)[:, None])
    return rows, np.where(np.isfinite(gap), gap, np.inf).argmin(-1), q


def _largest(null: Array) -> tuple[NDArray[np.intp], Array]:
    """The joint that moves most, of several the first, and the square of its share."""
    shares = np.diagonal(null, axis1=-2, axis2=-1)
    largest = (shares >= shares.max(-1, keepdims=True) - NULL).argmax(-1)
    return largest, shares[np.arange(len(null)), largest]


def _released(
    task: Task, q: Array, wanted: Array, rounded: NDArray[np.bool_]
) -> tuple[Array, NDArray[np.bool_]]:
    """Singular postures ``q`` (n, joints) moved to where the free joint has its wanted value.

    Those that are ``rounded`` are moved only in a straight line.  Also returns for which of the
    others another side of the curve may be nearer: it is bent, and the joint that is free did not
    get its value, or is one of several.
    """
    revolute = task.mechanism.revolute
    null = _null_projector(task.jacobian(q))
    shares = np.diagonal(null, axis1=-2, axis2=-1)
    zero = np.abs(np.asarray(task.mechanism.to_model(q))) < REACHED
    conventional = (shares > MOVES) & zero
    free = np.where(conventional.any(-1), conventional.argmax(-1), _largest(null)[0])
    rows = np.arange(len(q))
    moved = wanted[rows, free] - q[rows, free]
    moved = np.where(revolute[free], moved - TURN * np.rint(moved / TURN), moved)
    moved = np.where((shares[rows, free] > MOVES) & np.isfinite(moved), moved, 0.0)
    # A straight curve, such as that of two axes in line, is followed in one step.
    found = q + moved[:, None] * _tangent(null, free)
    found[rows, free] = q[rows, free] + moved
    straight = task.size_of_error(found) <= STRAIGHT
    bowed = task.size_of_error(found) > BOWED
    found = np.where((rounded & bowed)[:, None], q, found)
    bent = np.flatnonzero(~straight & ~rounded & (moved != 0))
    if len(bent):
        found[bent] = _followed(task.part(bent), q[bent], free[bent], moved[bent])
    rough = np.flatnonzero(task.size_of_error(found) > ROUNDING)
    if len(rough):
        found[rough] = _polished(task.part(rough), found[rough], free[rough])
    good = task.size_of_error(found) <= np.maximum(REACHED, 2 * task.size_of_error(q))
    found = task.holding(np.where(good[:, None], found, q), q)
    off = found[rows, free] - wanted[rows, free]
    off = np.where(revolute[free], off - TURN * np.rint(off / TURN), off)
    exact = good & (moved != 0) & (np.abs(off) <= REACHED)
    found[rows, free] = np.where(exact, wanted[rows, free], found[rows, free])
    settled = conventional.any(-1) & exact
    return found, np.isin(rows, bent) & ~settled


def _followed(task: Task, q: Array, free: NDArray[np.intp], moved: Array) -> Array:
    """The curve followed in steps, for as long as the free joint can move on."""
    rows = np.arange(len(q))
    going = np.ones(len(q), bool)
    q = q.copy()
    for _ in range(STEPS):
        step = (moved / STEPS)[:, None] * _tangent(_null_projector(task.jacobian(q)), free)
        short = np.abs(step).max(-1) <= LONGEST
        going &= short
        tried = q + np.where(short[:, None], step, 0.0)
        tried[rows, free] = q[rows, free] + moved / STEPS
        tried = _polished(task, tried, free)
        going &= task.size_of_error(tried) <= STRAIGHT
        q = np.where(going[:, None], tried, q)
    return q


def _polished(task: Task, q: Array, free: NDArray[np.intp] | None) -> Array:
    """Newton's method on all joints but the free one; a step that does not help is not taken."""
    for _ in range(CORRECTIONS if free is not None else APPROACH):
        J = task.jacobian(q)
        if free is not None:
            J[np.arange(len(q)), :, free] = 0.0
        error = task.error(q)
        finite = np.asarray(np.isfinite(J).all((-1, -2)) & np.isfinite(error).all(-1))
        inverse = np.linalg.pinv(np.where(finite[:, None, None], J, 0.0), rcond=NULL)
        step = (inverse @ np.where(finite[:, None], error, 0.0)[..., None])[..., 0]
        turn = np.abs(np.where(task.mechanism.revolute, step, 0.0)).max(-1, keepdims=True)
        better = q + step / np.maximum(1.0, turn / LONGEST)
        q = np.where((task.size_of_error(better) < task.size_of_error(q))[:, None], better, q)
    return q


def _null_projector(J: Array) -> Array:
    """The projection of joint rates onto those that do not move the target."""
    J = np.where(np.isfinite(J).all((-1, -2), keepdims=True), J, 0.0)
    _, sizes, right = np.linalg.svd(J, full_matrices=True)
    n = J.shape[-1]
    padded = np.zeros((*sizes.shape[:-1], n))
    padded[..., : sizes.shape[-1]] = sizes
    free = padded <= NULL * padded.max(-1, keepdims=True)
    return np.asarray(np.swapaxes(right, -1, -2) @ (free[..., None] * right))


def _tangent(null: Array, free: NDArray[np.intp]) -> Array:
    """The shortest joint rates with which the free joint moves by 1."""
    column = null[np.arange(len(null)), :, free]
    share = column[np.arange(len(null)), free][:, None]
    with np.errstate(all="ignore"):
        return np.asarray(np.where(share > 0, column / share, 0.0))


@dataclass(frozen=True)
class Task:
    """Targets, how far postures are from them, and the Jacobian of that, without units."""

    mechanism: Mechanism
    x: Array
    given: Array | None = None
    """What the inverse was given besides the targets; NaN where it does not count."""

    def part(self, rows: NDArray[np.intp], lead: tuple[int, ...] | None = None) -> Task:
        """Some of the targets; dimensions have the axes ``lead``, or one for the targets."""
        given = None if self.given is None else self.given[rows]
        lead = (len(self.x),) if lead is None else lead
        return Task(self.mechanism.part(lead, rows), self.x[rows], given)

    def keeping(self, q: Array) -> Task:
        """The same, but what was given counts only where the answers ``q`` have it.

        Others are where it is undefined, as the arm angle of a wrist above the shoulder is.  There
        it may have any value, also the one that was given, but not to both sides.
        """
        if self.given is None:
            return self
        kept = np.abs(self._beside(q, self.given)) <= STRAIGHT
        step = BESIDE * np.cos(np.arange(q.shape[-1]) + 1.0)
        for other in (q - step, q + step):
            kept &= np.abs(self._beside(other, self.given)) <= BOWED
        return replace(self, given=np.where(kept, self.given, np.nan))

    def holding(self, q: Array, there: Array) -> Array:
        """The postures ``q`` with the joint that was given, if it is one, exactly as ``there``."""
        joints, held = self.mechanism.joints, self.mechanism.given
        if held not in joints:
            return q
        at = np.arange(len(joints)) == joints.index(held)
        return np.where(at, there, q)

    def _beside(self, q: Array, given: Array) -> Array:
        gap = given - self.mechanism.given_at(q)
        return np.where(np.isnan(gap), 0.0, self._without_units(gap))

    def _without_units(self, gap: Array) -> Array:
        """Differences of what was given: a slide in sizes, an angle less its turns."""
        joints = self.mechanism.joints
        slides = [
            name for name, turns in zip(joints, self.mechanism.revolute, strict=True) if not turns
        ]
        if self.mechanism.given in slides:
            return np.asarray((gap.T / self.size).T)
        return np.asarray(gap - TURN * np.rint(gap / TURN))

    def _beside_row(self, q: Array, given: Array) -> Array:
        """The derivatives of what was given, by central differences: (n, 1, joints)."""
        value = self.mechanism.given_at

        def central(times: int) -> Array:
            steps = times * DIFFERENCE * np.eye(q.shape[-1])
            gap = np.stack([value(q + step) - value(q - step) for step in steps], axis=-1)
            return self._without_units(gap) / (2 * times * DIFFERENCE)

        row = (4 * central(1) - central(2)) / 3
        return np.where(np.isnan(given)[:, None], 0.0, row)[:, None]

    @property
    def size(self) -> Array:
        """The sum of the lengths, an array if they differ from posture to posture."""
        total = sum(np.abs(np.asarray(p, dtype=float)) for p in self.mechanism.parameters)
        place = self.x[..., :3, 3] if self._is_pose else self.x
        reach = np.zeros(()) if self._is_rotation else np.abs(place).max(-1)
        return np.asarray(np.maximum(np.maximum(total, reach), np.finfo(float).tiny))

    @property
    def _is_pose(self) -> bool:
        return self.x.shape[1:] == (4, 4)

    @property
    def _is_rotation(self) -> bool:
        return self.x.shape[1:] == (3, 3)

    def error(self, q: Array) -> Array:
        """The twist, or the change of coordinates, that leads to the target, and what was given."""
        found = self._error(q)
        if self.given is None:
            return found
        return np.concatenate([found, self._beside(q, self.given)[:, None]], axis=-1)

    def _error(self, q: Array) -> Array:
        at = self.mechanism.fk(q)
        if self._is_rotation:
            return _rotation_vector(self.x @ np.swapaxes(at, -1, -2))
        if self._is_pose:
            R = self.x[:, :3, :3] @ np.swapaxes(at[:, :3, :3], -1, -2)
            omega = _rotation_vector(R)
            v = self.x[:, :3, 3] - (R @ at[:, :3, 3, None])[..., 0]
            return np.concatenate([v / self.size[..., None], omega], axis=-1)
        if hasattr(at, "p"):
            at = at.p[np.arange(len(q)), self._mode(at.p)]
        return self._scaled(self._gap(at))

    def size_of_error(self, q: Array) -> Array:
        """The largest entry of the error; infinite where it is not a number."""
        found = np.abs(self.error(q)).max(-1)
        return np.asarray(np.where(np.isfinite(found), found, np.inf))

    def jacobian(self, q: Array) -> Array:
        """The derivative of the way to the target, with the sign of the motion of the hand."""
        found = self._jacobian(q)
        if self.given is None:
            return found
        return np.concatenate([found, self._beside_row(q, self.given)], axis=-2)

    def _jacobian(self, q: Array) -> Array:
        if self._is_rotation:
            return self.mechanism.jacobian_space(q)
        if self._is_pose:
            J = self.mechanism.jacobian_space(q).copy()
            J[:, :3] /= self.size[..., None, None]
            return J
        J = self.mechanism.jacobian(q)
        if J.ndim == 4:
            J = J[np.arange(len(q)), self._mode(self.mechanism.fk(q).p)]
        J = J[:, : self.x.shape[-1]]
        return np.asarray(np.swapaxes(self._scaled(np.swapaxes(J, -1, -2)), -1, -2))

    def _gap(self, at: Array) -> Array:
        gap = (self.x if at.ndim == self.x.ndim else self.x[:, None]) - at
        return np.where(self._angles, gap - TURN * np.rint(gap / TURN), gap)

    def _mode(self, p: Array) -> NDArray[np.intp]:
        gap = np.abs(self._gap(p)).max(-1)
        return np.asarray(np.where(np.isfinite(gap), gap, np.inf).argmin(-1))

    @property
    def _angles(self) -> NDArray[np.bool_]:
        return np.array([name in NAMES_OF_ANGLES for name in self.mechanism.module.TASK])

    def _scaled(self, rows: Array) -> Array:
        """The last axis without units."""
        size = self.size.reshape((*self.size.shape, *[1] * (rows.ndim - 1))) if rows.ndim else 1.0
        return np.asarray(np.where(self._angles, rows, rows / size))


def _rotation_vector(R: Array) -> Array:
    """The axis times the angle of rotations, accurate for small angles too."""
    v = 0.5 * np.stack(
        [
            R[..., 2, 1] - R[..., 1, 2],
            R[..., 0, 2] - R[..., 2, 0],
            R[..., 1, 0] - R[..., 0, 1],
        ],
        axis=-1,
    )
    sine = np.linalg.norm(v, axis=-1)
    angle = np.arctan2(sine, 0.5 * (np.trace(R, axis1=-2, axis2=-1) - 1))
    with np.errstate(all="ignore"):
        factor = np.where(sine > 1e-8, angle / sine, 1.0)
    # Half a turn has the sine of none; about which axis does not matter to a size of error.
    half = (sine <= 1e-8) & (angle > 1)
    return np.where(half[..., None], np.pi, v * factor[..., None])
