"""How many solutions the inverse of an arm has over the complex numbers, and what solves them.

The solutions for a target are followed while the target moves along closed loops.  They return in
another order, and a single one leads to all of them: the joints form an irreducible variety, which
the forward map takes to the targets.  Loops generate the Galois group of the inverse over the
coordinates of the target.  Its blocks are the steps in which the solutions can be found, and the
size of the largest primitive step is the degree of the equation that no smaller one replaces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import sympy as sp
from sympy.combinatorics import Permutation, PermutationGroup

from closedform.scaffold.chainlinks import Singles

SEED = 20
LOOPS, IDLE = 30, 4
"""How many loops are tried at most, and how many that find nothing new end the search."""
WORK = 600_000
"""Newton's corrections, of one solution each, after which the search is given up."""
CLOSE, MET = 1e-6, 1e-4
"""The correction that ends Newton's method, whose error is its square; and what is one solution."""
SHORTEST = 1e-7
"""The smallest step along a loop of length 1."""
SMALL, CONTRACTS = 0.2, 0.1
"""The largest step of a joint, and by how much the second correction must be smaller."""


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
        joints = {s.joint for s in arm.joints}
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
        senses = [s.sense if s.slides else int(s.turn.diff(s.joint)) for s in arm.joints]
        slides = np.array([s.slides for s in arm.joints])
        return cls(numbers(arm.lead), motions, np.array(senses), slides)

    def pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The poses of the tool, and the twists (v; omega) of the joints in the base frame."""
        moves = np.zeros((*q.shape, 4, 4), complex)
        moves[:] = np.eye(4)
        turns, slides = ~self.slides, self.slides
        c, s = np.cos(q[:, turns]), self.senses[turns] * np.sin(q[:, turns])
        moves[:, turns, 0, 0], moves[:, turns, 0, 1] = c, -s
        moves[:, turns, 1, 0], moves[:, turns, 1, 1] = s, c
        moves[:, slides, 2, 3] = (self.senses * q)[:, slides]
        frames = [np.broadcast_to(self.lead, (len(q), 4, 4))]
        for move in np.moveaxis(moves @ self.motions, 1, 0):
            frames.append(frames[-1] @ move)
        before = np.stack(frames[:-1], axis=1)
        axes, points = self.senses[:, None] * before[..., :3, 2], before[..., :3, 3]
        ahead, behind = np.roll(axes, -1, axis=-1), np.roll(points, -1, axis=-1)
        moments = np.roll(points * ahead - behind * axes, -1, axis=-1)  # np.cross takes longer
        is_slide = slides[:, None]
        twists = [np.where(is_slide, axes, moments), np.where(is_slide, 0, axes)]
        return frames[-1], np.concatenate(twists, axis=-1).swapaxes(1, 2)

    @cached_property
    def reach(self) -> float:
        return float(np.abs(self.motions[:, :3, 3]).sum())


def target(x: np.ndarray) -> np.ndarray:
    """The pose at coordinates: those of a rotation by Cayley, and a position."""
    a, b, c = x[:3]
    S, X = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]]), np.eye(4, dtype=complex)
    X[:3, :3], X[:3, 3] = np.linalg.solve(np.eye(3) - S, np.eye(3) + S), x[3:]
    return X


def coordinates(T: np.ndarray) -> np.ndarray:
    S = np.linalg.solve((T[:3, :3] + np.eye(3)).T, (T[:3, :3] - np.eye(3)).T).T
    return np.array([S[2, 1], S[0, 2], S[1, 0], *T[:3, 3]])


@dataclass
class Fibre:
    """The solutions for a target that are known, and the loops that take them to each other."""

    arm: Numeric
    rng: np.random.Generator
    base: np.ndarray
    found: np.ndarray
    images: list[list[int]] = field(default_factory=list)
    work: int = WORK

    def correction(self, q: np.ndarray, x: np.ndarray) -> np.ndarray:
        """A step of Newton's method to the target."""
        self.work -= len(q)
        T, twists = self.arm.pose(q)
        X = target(x)
        away = X @ np.linalg.inv(T) - np.eye(4)
        error = [away[:, i, j] - away[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))]
        step = np.stack([*away[:, :3, 3].T, *(e / 2 for e in error)], axis=1)
        found: np.ndarray = np.linalg.solve(twists, step[..., None])[..., 0]
        return found

    def corrected(self, q: np.ndarray, x: np.ndarray) -> np.ndarray | None:
        """The solutions nearest to the given ones; None if they may be those of another path."""
        sizes: list[np.ndarray] = []
        for _ in range(7):
            try:
                step = self.correction(q, x)
            except np.linalg.LinAlgError:  # a singular posture
                return None
            q, size = q + step, np.abs(step).max(axis=1)
            if not np.isfinite(size).all() or size.max() > SMALL:
                return None
            if len(sizes) == 1 and (size > CONTRACTS * sizes[0] + CLOSE).any():
                return None
            if size.max() < CLOSE:
                return q
            sizes.append(size)
        return None

    def followed(self, q: np.ndarray, loop: Sequence[np.ndarray]) -> np.ndarray | None:
        """Where the solutions are after a loop; None if they were lost."""
        for start, end in zip([self.base, *loop], [*loop, self.base], strict=True):
            at, step = 0.0, 1 / 32
            while at < 1:
                step = min(step, 1 - at)
                there = self.corrected(q, start + (at + step) * (end - start))
                if there is None:
                    step /= 2
                    if step < SHORTEST or self.work < 0:
                        return None
                    continue
                q, at, step = there, at + step, 1.5 * step
        return q

    def place(self, q: np.ndarray) -> int | None:
        """Which of the known solutions this is."""
        away = np.where(self.arm.slides, self.found - q, np.exp(1j * (self.found - q)) - 1)
        sizes = np.abs(away).max(axis=1)
        return int(sizes.argmin()) if sizes.min() < MET else None

    def go_around(self, loop: list[np.ndarray]) -> bool:
        """Whether all solutions could be followed along a loop, also those that it finds."""
        images: list[int] = []
        while len(images) < len(self.found):
            ends = self.followed(self.found[len(images) :], loop)
            if ends is None:
                return False
            for q in ends:
                k = self.place(q)
                if k is None:
                    k, self.found = len(self.found), np.vstack([self.found, q])
                images.append(k)
        if sorted(images) != list(range(len(images))):
            return False
        self.images.append(images)
        return True

    @property
    def group(self) -> PermutationGroup:
        """What the loops generate that all known solutions were followed along."""
        n = len(self.found)
        known = [Permutation(p) for p in self.images if len(p) == n]
        return PermutationGroup([Permutation(n - 1), *known])

    def closed(self) -> bool:
        """Whether loops that find nothing new have ended the search."""
        idle = 0
        for _ in range(LOOPS):
            before = len(self.found)
            followed = self.go_around([self.random() for _ in range(2)])
            idle = 0 if len(self.found) > before else idle + followed
            if idle >= IDLE and self.group.is_transitive():
                return True
            if self.work < 0:
                return False
        return False

    def random(self) -> np.ndarray:
        """A target at random."""
        x: np.ndarray = self.rng.normal(size=6) + 1j * self.rng.normal(size=6)
        x[3:] *= self.arm.reach / 2
        return x


def solutions(arm: Singles) -> Solutions | None:
    """The solutions for a pose at random, counted; None if they could not be followed."""
    rng = np.random.default_rng(SEED)
    numeric = Numeric.of(arm, rng)
    q = rng.normal(size=(1, 6)) + 0.5j * rng.normal(size=(1, 6))
    T, _ = numeric.pose(q)
    fibre = Fibre(numeric, rng, coordinates(T[0]), q)
    if not fibre.closed():
        return None
    return Solutions(len(fibre.found), steps(fibre.group), fibre.group.is_solvable)


def steps(group: PermutationGroup) -> tuple[int, ...]:
    """The sizes of the blocks of a transitive group, from the smallest blocks to those of them."""
    n = group.degree
    if n == 1:
        return (1,)
    systems = [group.minimal_block([0, k]) for k in range(1, n)]
    blocks = max(systems, key=lambda s: len(set(s)))
    names = sorted(set(blocks))
    if len(names) == 1:
        return (n,)
    onto = [
        Permutation([names.index(blocks[g(blocks.index(name))]) for name in names])
        for g in group.generators
    ]
    return (n // len(names), *steps(PermutationGroup(onto)))


__all__ = ["Solutions", "solutions", "steps"]
