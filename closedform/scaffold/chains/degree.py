"""How many solutions the inverse of an arm has over the complex numbers, and what solves them.

The solutions for a target are followed while the target moves along closed loops.  They return in
another order, and a single one leads to all of them: the joints form an irreducible variety, which
the forward map takes to the targets.  Loops generate the Galois group of the inverse over the
coordinates of the target.  Its blocks are the steps in which the solutions can be found, and the
size of the largest primitive step is the degree of the equation that no smaller one replaces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
import sympy as sp
from sympy.combinatorics import Permutation, PermutationGroup

from closedform.scaffold.chains.chainlinks import Single, Singles, plain

SEEDS = (20, 21, 22)
LOOPS, ROUNDS, ENOUGH = 6, 6, 5
"""Loops that are followed at a time, how often, and how many must have found nothing new."""
WORK = 600_000
"""Newton's corrections, of one solution each, after which the search is given up."""
CLOSE, MET = 1e-5, 1e-4
"""The correction that ends Newton's method, whose error is its square; and what is one solution."""
SINGULAR = 1e9
"""The condition of the Jacobian of an arm that does not move its tool in six ways."""
VALUES, POSTURES, NEARLY = 720, 8, 0.01
"""How many values of a joint are tried, at how many postures, and the determinant counted as 0."""
SHORTEST = 1e-7
"""The smallest step along a loop of length 1."""
IMAGINARY = np.array([0.5, 0.5, 0.5, 1, 1, 1])
"""The sizes of the imaginary parts of the coordinates of targets."""
AFTER, BEFORE = [1, 2, 0], [2, 0, 1]
"""The coordinates of a cross product."""
SMALL, CONTRACTS = 0.2, 0.1
"""The largest step of a joint, and by how much the second correction must be smaller."""
EASY = 0.3
"""The share of these limits within which the step becomes larger."""


@dataclass(frozen=True)
class Solutions:
    """The number of solutions, and the degrees of the equations that give them one after another.

    They are ``solvable`` if roots of numbers in the coordinates of the target give them.
    """

    number: int
    steps: tuple[int, ...]
    solvable: bool

    @property
    def degree(self) -> int:
        """The degree of the largest equation."""
        return max(self.steps)


@dataclass(frozen=True)
class Numeric:
    """An arm of six joints in complex numbers; its parameters have values at random."""

    lead: np.ndarray
    motions: np.ndarray
    """The constant motion after each joint."""
    senses: np.ndarray
    slides: np.ndarray

    @classmethod
    def of(cls, arm: Singles, rng: np.random.Generator) -> Numeric:
        joints, senses = {s.joint for s in arm.joints}, [s.sense for s in arm.joints]
        arm = replace(arm, joints=tuple(map(plain, arm.joints)))
        held = {
            s
            for e in (arm.lead, *(m for j in arm.joints for m in (j.shift, j.end)))
            for s in e.free_symbols
        }
        values = {s: sp.Float(rng.uniform(0.3, 1.3)) for s in sorted(held - joints, key=str)}
        values |= dict.fromkeys(joints, sp.S.Zero)

        def numbers(m: sp.Matrix) -> np.ndarray:
            return np.array(m.subs(values).evalf().tolist(), dtype=complex)

        motions = np.zeros((len(arm.joints), 4, 4), complex)
        motions[:, 3, 3] = 1
        for k, joint in enumerate(arm.joints):
            motions[k, :3, :3] = numbers(joint.end)
            motions[k, :3, 3] = numbers(joint.shift)[:, 0]
        slides = np.array([s.slides for s in arm.joints])
        return cls(numbers(arm.lead), motions, np.array(senses), slides)

    def pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The poses of the tool, and the twists (v; omega) of the joints in the base frame."""
        # columns of poses come first and postures last, so that each operation runs along memory
        n = len(q)
        T = np.repeat(self.lead[:3].T[:, :, None], n, axis=2)
        twists = np.zeros((q.shape[1], 6, n), complex)
        turns = np.where(self.slides, 0, q).T  # a slide may be far away in complex numbers
        cosines, sines = np.cos(turns), self.senses[:, None] * np.sin(turns)
        for k, sense in enumerate(self.senses):
            x, y, w, p = T
            if self.slides[k]:
                twists[k, :3] = sense * w
                p += sense * q[:, k] * w
            else:
                twists[k, 3:] = sense * w
                twists[k, :3] = sense * (p[AFTER] * w[BEFORE] - p[BEFORE] * w[AFTER])
                c, s = cosines[k], sines[k]
                T[0], T[1] = c * x + s * y, c * y - s * x
            T = (self.motions[k].T @ T.reshape(4, -1)).reshape(T.shape)
        return T.transpose(2, 1, 0), twists.transpose(2, 1, 0)

    def with_more(self, count: int, rng: np.random.Generator) -> Numeric:
        """With joints after the last one, about axes at random; at zero they do not move."""
        motions = [*self.motions]
        for _ in range(count):
            c = rng.normal(size=3)
            place = np.eye(4, dtype=complex)
            place[:3] = targets(np.array([[*c, *rng.uniform(0.3, 1.3, 3)]]))[0]
            motions[-1] = motions[-1] @ place
            motions.append(np.linalg.inv(place))
        return replace(
            self,
            motions=np.array(motions),
            senses=np.append(self.senses, np.ones(count, int)),
            slides=np.append(self.slides, np.zeros(count, bool)),
        )

    @cached_property
    def reach(self) -> float:
        return float(np.abs(self.motions[:, :3, 3]).sum())


def targets(x: np.ndarray) -> np.ndarray:
    """The poses at coordinates: those of a rotation by Cayley, and a position."""
    c, X = x[:, :3], np.zeros((len(x), 3, 4), complex)
    square = (c * c).sum(axis=1)
    X[:, :, :3] = 2 * c[:, :, None] * c[:, None, :]
    for i, j, k in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        X[:, i, j] += 2 * c[:, k]
        X[:, j, i] -= 2 * c[:, k]
        X[:, k, k] += 1 - square
    X /= (1 + square)[:, None, None]
    X[:, :, 3] = x[:, 3:]
    return X


def coordinates(T: np.ndarray) -> np.ndarray:
    S = np.linalg.solve((T[:, :3] + np.eye(3)).T, (T[:, :3] - np.eye(3)).T).T
    return np.array([S[2, 1], S[0, 2], S[1, 0], *T[:, 3]])


@dataclass
class Fibre:
    """The solutions for a target that are known, and the loops that take them to each other."""

    arm: Numeric
    rng: np.random.Generator
    base: np.ndarray
    found: np.ndarray
    images: list[list[int]] = field(default_factory=list)
    work: int = WORK

    def correction(self, q: np.ndarray, X: np.ndarray) -> np.ndarray:
        """A step of Newton's method to target poses; not a number at a singular posture."""
        self.work -= len(q)
        T, twists = self.arm.pose(q)
        R = X[:, :, :3] @ T[:, :, :3].transpose(0, 2, 1)
        step = np.empty(q.shape, complex)
        step[:, :3] = X[:, :, 3] - (R @ T[:, :, 3:])[:, :, 0]
        step[:, 3:] = (R[:, BEFORE, AFTER] - R[:, AFTER, BEFORE]) / 2
        try:
            found: np.ndarray = np.linalg.solve(twists, step[..., None])[..., 0]
        except np.linalg.LinAlgError:
            twists[np.linalg.det(twists) == 0] = np.nan
            found = np.linalg.solve(twists, step[..., None])[..., 0]
        return found

    def corrected(self, q: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The solutions nearest to the given ones, which of them are not of another path, and which
        of these would not be with a larger step."""
        q, good, moving = q.copy(), np.zeros(len(q), bool), np.arange(len(q))
        first, easy, X = np.zeros(len(q)), np.ones(len(q), bool), targets(x)
        for k in range(7):
            step = self.correction(q[moving], X[moving])
            q[moving] += step
            size = np.abs(step).max(axis=1)
            if k == 0:
                first = size
            most = SMALL if k != 1 else np.minimum(SMALL, CONTRACTS * first[moving] + CLOSE)
            held = size <= most
            if k < 2:
                easy[moving] &= size <= EASY * most
            good[moving] = held & (size < CLOSE)
            moving = moving[held & (size >= CLOSE)]
            if not len(moving):
                break
        return q, good, easy

    def followed(self, q: np.ndarray, loops: np.ndarray) -> np.ndarray:
        """Where each solution is after its loop; not a number if it was lost."""
        corners = np.concatenate([loops, np.broadcast_to(self.base, (len(q), 1, 6))], axis=1)
        start = np.broadcast_to(self.base, (len(q), 6))
        for end in np.moveaxis(corners, 1, 0):
            q = self._along(q, start, end)
            start = end
        return q

    def _along(self, q: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """The solutions at the ends of straight lines between targets, each at its own pace.

        A parabola through the last three solutions leads to the next.
        """
        q, at, step = q.copy(), np.zeros(len(q)), np.full(len(q), 1 / 32)
        rate, bend, last = np.zeros_like(q), np.zeros_like(q), np.zeros(len(q))
        while len(moving := np.flatnonzero((at < 1) & np.isfinite(q[:, 0]))):
            if self.work < 0:
                q[moving] = np.nan
                break
            ahead = np.minimum(step[moving], 1 - at[moving])[:, None]
            x = start[moving] + (at[moving, None] + ahead) * (end - start)[moving]
            halves = (last[moving, None] + ahead) / 2
            guess = q[moving] + ahead * (rate[moving] + halves * bend[moving])
            there, good, easy = self.corrected(guess, x)
            done, slower = moving[good], moving[~good]
            new = ((there - q[moving]) / ahead)[good]
            bend[done] = np.where(last[done, None] > 0, (new - rate[done]) / halves[good], 0)
            rate[done], last[done] = new, ahead[good, 0]
            q[done], at[done] = there[good], at[done] + ahead[good, 0]
            at[done[at[done] > 1 - SHORTEST]] = 1
            step[moving[good & easy]] *= 1.5
            step[slower] /= 2
            q[slower[step[slower] < SHORTEST]] = np.nan
        return q

    def place(self, q: np.ndarray) -> int:
        """Which of the known solutions this is, or the new one that it is."""
        away = np.where(self.arm.slides, self.found - q, np.exp(1j * (self.found - q)) - 1)
        sizes = np.abs(away).max(axis=1)
        if sizes.min() < MET:
            return int(sizes.argmin())
        self.found = np.vstack([self.found, q])
        return len(self.found) - 1

    def go_around(self, loops: np.ndarray) -> None:
        """Follow all solutions along loops, also those that are found."""
        images: list[list[int]] = [[] for _ in loops]
        while (known := len(images[0])) < len(self.found) and self.work > 0:
            starts = self.found[known:]
            ends = self.followed(
                np.tile(starts, (len(loops), 1)), np.repeat(loops, len(starts), axis=0)
            )
            for k, q in enumerate(ends):
                images[k // len(starts)].append(self.place(q) if np.isfinite(q).all() else -1)
        self.images += [p for p in images if sorted(p) == list(range(len(self.found)))]

    @property
    def group(self) -> PermutationGroup:
        """What the loops generate that all known solutions were followed along."""
        n = len(self.found)
        known = [Permutation(p) for p in self.images if len(p) == n]
        return PermutationGroup([Permutation(n - 1), *known])

    def closed(self) -> bool:
        """Whether enough loops take the solutions to each other, and to no others."""
        for _ in range(ROUNDS):
            self.go_around(np.array([[self.random() for _ in range(2)] for _ in range(LOOPS)]))
            enough = sum(len(p) == len(self.found) for p in self.images) >= ENOUGH
            if enough and self.group.is_transitive():
                return True
            if self.work < 0:
                return False
        return False

    def random(self) -> np.ndarray:
        """A target at random; coordinates with small imaginary parts are those of a rotation."""
        x: np.ndarray = self.rng.normal(size=6) + 1j * self.rng.normal(size=6) * IMAGINARY
        x[3:] *= self.arm.reach / 2
        return x


Count = TypeVar("Count")


def solutions(arm: Singles) -> Solutions | None:
    """The solutions for a pose at random, as two counts find them; None if no two agree.

    A count follows the solutions along loops of its own, for another pose and other parameters, and
    may miss some.  What it finds is a lower bound, also of the group, which is not solvable if that
    of fewer loops is not.
    """
    return _agreed(lambda seed: counted_once(arm, seed))


def solutions_of_few(arm: Singles) -> int | None:
    """How many solutions a pose that fewer than six joints reach has, as :func:`solutions` counts.

    Joints about axes at random make six of them; of the solutions for such a pose those count at
    which the further joints are zero.
    """
    few = len(arm.joints)

    def once(seed: int) -> int | None:
        fibre = _explored(arm, seed)
        if fibre is None:
            return None
        still = np.abs(np.exp(1j * fibre.found[:, few:]) - 1).max(axis=1) < MET
        return int(still.sum())

    return _agreed(once)


def _agreed(once: Callable[[int], Count | None]) -> Count | None:
    """What two counts, each with a seed of its own, agree on."""
    counted: list[Count] = []
    for seed in SEEDS:
        found = once(seed)
        if found is not None and found in counted:
            return found
        counted += [found] if found is not None else []
    return None


def is_regular(arm: Singles) -> bool:
    """Whether six joints move the tool in six ways at some posture, with parameters at random."""
    return not free_joints(arm)


def free_joints(arm: Singles) -> list[Single]:
    """The joints that can move while the tool does not, at every posture; up to six are asked."""
    rng = np.random.default_rng(SEEDS[0])
    few = len(arm.joints)
    numeric = Numeric.of(arm, rng).with_more(6 - few, rng)
    _, twists = numeric.pose(rng.normal(size=(4, 6)) + 0j)
    if (np.linalg.cond(twists) <= SINGULAR).any():
        return []
    least = np.linalg.svd(twists[0])[2][-1][:few]
    return [j for j, e in zip(arm.joints, np.abs(least), strict=True) if e > 1e-6]


def free_ways(arm: Singles) -> tuple[int, list[Single]]:
    """In how many ways joints can move while the tool does not, at every posture; and which do."""
    rng = np.random.default_rng(SEEDS[0])
    _, twists = Numeric.of(arm, rng).pose(rng.normal(size=(4, len(arm.joints))) + 0j)
    ranks = [int(np.linalg.matrix_rank(J, 1e-9)) for J in twists]
    rank = max(ranks)
    still = np.linalg.svd(twists[ranks.index(rank)])[2][rank:]
    sizes = np.abs(still).max(axis=0, initial=0)
    return len(still), [j for j, e in zip(arm.joints, sizes, strict=True) if e > 1e-6]


def stays_regular(arm: Singles, single: Single) -> bool:
    """Whether the other six of seven joints are regular at every value of one that turns.

    Parameters and postures are at random; a value that is nearly singular at all of these counts
    as one that is singular.
    """
    rng = np.random.default_rng(SEEDS[0])
    k = arm.joints.index(single)
    values = np.linspace(-np.pi, np.pi, VALUES, endpoint=False)
    q = np.tile(rng.normal(size=(POSTURES, 1, len(arm.joints))) + 0j, (1, VALUES, 1))
    q[:, :, k] = values
    numeric = Numeric.of(arm, rng)
    _, twists = numeric.pose(q.reshape(-1, len(arm.joints)))
    twists[:, :3] /= numeric.reach or 1
    sizes = np.abs(np.linalg.det(np.delete(twists, k, axis=2))).reshape(POSTURES, VALUES)
    largest, usual = sizes.max(axis=0), sizes.mean()
    return bool(usual > 1 / SINGULAR and largest.min() > NEARLY * usual)


def counted_once(arm: Singles, seed: int) -> Solutions | None:
    """The solutions that loops find; None if they could not be followed."""
    fibre = _explored(arm, seed)
    if fibre is None:
        return None
    return Solutions(len(fibre.found), steps(fibre.group), solvable(fibre.group))


def _explored(arm: Singles, seed: int) -> Fibre | None:
    """All solutions for a pose of the arm, with further joints that are zero at a posture of it."""
    rng = np.random.default_rng(seed)
    few = len(arm.joints)
    numeric = Numeric.of(arm, rng).with_more(6 - few, rng)
    q = rng.normal(size=(1, 6)) + 0.3j * rng.normal(size=(1, 6))
    q[:, few:] = 0
    T, twists = numeric.pose(q)
    if np.linalg.cond(twists[0]) > SINGULAR:
        return None
    fibre = Fibre(numeric, rng, coordinates(T[0]), q)
    return fibre if fibre.closed() else None


def steps(group: PermutationGroup) -> tuple[int, ...]:
    """The sizes of the blocks of a transitive group, from the smallest blocks to those of them."""
    return tuple(size for size, _ in actions(group))


def actions(group: PermutationGroup) -> list[tuple[int, PermutationGroup]]:
    """The sizes of the blocks, each with the group that the blocks of this size are parts of."""
    n = group.degree
    if n == 1:
        return [(1, group)]
    systems = [group.minimal_block([0, k]) for k in range(1, n)]
    blocks = max(systems, key=lambda s: len(set(s)))
    names = sorted(set(blocks))
    if len(names) == 1:
        return [(n, group)]
    onto = [
        Permutation([names.index(blocks[g(blocks.index(name))]) for name in names])
        for g in group.generators
    ]
    return [(n // len(names), group), *actions(PermutationGroup(onto))]


def solvable(group: PermutationGroup) -> bool:
    """Whether a transitive group is solvable; groups of up to four elements always are."""
    (last, onto), *_ = reversed(levels := actions(group))
    if all(size <= 4 for size, _ in levels):
        return True
    return not (last > 4 and onto.is_alt_sym()) and bool(group.is_solvable)


__all__ = [
    "Solutions",
    "free_ways",
    "is_regular",
    "solutions",
    "solutions_of_few",
    "stays_regular",
    "steps",
]
