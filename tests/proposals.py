"""Arms from tables with a proposed inverse, compared with plain numbers and Newton's method."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arms import OK, SINGULAR, link, misses, newton
from chains import arm, printed, solved

from closedform.proof.prove import prove
from closedform.scaffold.chains.propose import propose


def names(rows: list) -> str:
    """Names of joints for the rows of a table; a slide has a fourth entry, its angle."""
    return " ".join(f"{'d' if len(row) == 4 else 't'}{k}" for k, row in enumerate(rows, 1))


def forward(rows: list, q: np.ndarray) -> np.ndarray:
    """The product of the motions of a table, in plain numbers."""
    T = np.eye(4)
    for k, (a, alpha, d, *theta) in enumerate(rows):
        turn = float(theta[0]) * np.ones(len(q)) if theta else q[:, k]
        motion = link(float(a), float(alpha), 0.0, turn)
        motion[..., 2, 3] = q[:, k] if theta else float(d)
        T = T @ motion
    return T


class Proposals:
    """The arms of a test: rows, the structure that is recognised, and its branches, by name."""

    def __init__(self, arms: Mapping[str, tuple[list, str, int]]) -> None:
        self.arms = arms
        self.made = cache(self._made)

    def _made(self, name: str, folder: Path) -> Any:
        """The printed module of an arm whose proposed inverse is proved."""
        rows, structure, branches = self.arms[name]
        d, serial = arm(rows, names(rows))
        found = propose(serial)
        assert found.structure == structure
        solved(d, serial, found.source)
        assert prove(d).inverses[0].branches == found.branches == branches
        serial.export(d)
        return printed(d, folder)

    def pose(self, name: str, q: np.ndarray) -> np.ndarray:
        return forward(self.arms[name][0], q)

    def gaps(self, name: str, answers: np.ndarray, q: np.ndarray) -> np.ndarray:
        """How far answers are from joints, in the joint that is farthest."""
        turns = np.array([len(row) == 3 for row in self.arms[name][0]])
        off = np.where(turns, np.angle(np.exp(1j * (answers - q))), answers - q)
        return np.abs(off).max(axis=-1)

    def postures(self, name: str, rng: np.random.Generator) -> np.ndarray:
        """500 random ones, and 2500 with joints near and at multiples of a quarter or a sixth turn.

        Among them are some of a crane whose turret and link are both at their limits.
        """
        q = rng.uniform(-3, 3, (3000, len(self.arms[name][0])))
        near = rng.choice([0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3], q.shape)
        special = rng.integers(-6, 7, q.shape) * np.pi / rng.choice([2, 6], q.shape) + near
        return np.where((rng.random(q.shape) < 0.5) & (np.arange(3000) > 500)[:, None], special, q)

    def tests(self) -> tuple[Callable[[str, Path], None], Callable[[str, Path], None]]:
        """Those that every arm passes: it reaches each pose, and no posture is left out."""
        each = pytest.mark.parametrize("name", self.arms)

        @each
        def every_pose(name: str, folder: Path) -> None:
            self.reach_every_pose(name, folder)

        @each
        def no_other(name: str, folder: Path) -> None:
            self.are_all(name, folder)

        return every_pose, no_other

    def reach_every_pose(self, name: str, folder: Path) -> None:
        q = self.postures(name, np.random.default_rng(1))
        T = self.pose(name, q)
        answers, status = self.made(name, folder).ik(T)
        reached = self.pose(name, answers.reshape(-1, q.shape[1])).reshape(*answers.shape[:2], 4, 4)
        assert max(misses(reached, T, status)) < 4e-12
        assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
        assert np.nanmin(self.gaps(name, answers, q[:, None])[:500], axis=1).max() < 1e-8

    def are_all(self, name: str, folder: Path) -> None:
        """Newton's method finds no other posture, and those that are printed."""
        rng = np.random.default_rng(2)
        for T in self.pose(name, rng.uniform(-1, 1, (4, len(self.arms[name][0])))):
            answers, status = self.made(name, folder).ik(T[None])
            there = answers[0][np.isin(status[0], (OK, SINGULAR))]
            starts = rng.uniform(-np.pi, np.pi, (200, there.shape[1]))
            found = newton(lambda q: self.pose(name, q), T, starts)
            assert len(found) > 10
            away = self.gaps(name, found[:, None], there[None])
            assert away.min(axis=1).max() < 1e-6 and away.min(axis=0).max() < 1e-6


__all__ = ["Proposals", "forward", "names"]
