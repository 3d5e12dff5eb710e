"""A correction of all joints at once, for arms that do not reach every pose.

Each lemma uses a part of the target.  Near a singularity of the joints that it solves for, a
rounding error turns them far.  With fewer than six joints, the other joints cannot compensate for
it: the rest of the target is missed, although it determines the joints well.  Then all joints are
moved together by one Gauss-Newton step of least squares.  In exact arithmetic nothing is missed by
a target within reach; if more is missed than such a step can mend, the target is out of reach.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp
from sympy import atan2

from closedform.model.functions import Program, choose
from closedform.model.pair import Pair
from closedform.model.tolerances import HALF_DIGITS

LOOSE = HALF_DIGITS**2 / 4
"""How much of the target may be missed before it counts as more than rounding of the answer.

It is well below what a target may miss, in single precision too, where rounding is not.
"""
FAR = 64 * HALF_DIGITS
"""The largest step.  The error that remains is of the order of its square, and is compared.

Where rounding turns a joint far, it does so by the root of a rounding error.
"""
DAMPING = sp.Rational(1, 2**50)
"""Added to the squares of least squares, of the order of their rounding in double precision.

A rounding error of the lemmas is of the order of the root of it, so that the square of what is
missed serves in single precision.
"""


@dataclass(frozen=True)
class Corrected:
    """The error of the target after the correction, and how far each joint was moved."""

    loose: sp.Symbol
    missed: tuple[sp.Expr, ...]
    moved: Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Correction:
    """Joints that have to bring ``images`` to ``targets``, whose natural sizes are ``scales``.

    ``pairs`` holds the pair of every angle in the images, ``slides`` the value of every slide.
    """

    program: Program
    joints: Sequence[sp.Symbol]
    targets: Sequence[sp.Expr]
    images: Sequence[sp.Expr]
    scales: Sequence[sp.Expr]
    pairs: Mapping[sp.Expr, Pair]
    slides: Mapping[sp.Symbol, sp.Expr]
    size: sp.Expr

    def applied(self) -> Corrected:
        """The correction, which is computed only where more than rounding is missed."""
        let = self.program.let
        missed = [
            let(f"missed_{k}", e) for k, e in enumerate(self._missed(self.pairs, self.slides))
        ]
        relative = [
            let(f"relative_{k}", e / c)
            for k, (e, c) in enumerate(zip(missed, self.scales, strict=True))
        ]
        most = let("most_missed", sp.Max(*map(sp.Abs, relative)))
        meaning = (
            "the joints are moved together to reach the part of the target that the lemmas miss"
        )
        within = sp.Max(LOOSE - most, most - self._farthest())
        loose = self.program.vanishes("loose", within, sp.S.One, meaning)
        step = self._step(relative, let("damping", most**2 + DAMPING))
        pairs = {
            total: pair + _turned(sum(total.diff(j) * step[j] for j in self.joints))
            for total, pair in self.pairs.items()
        }
        named = {
            total: pair.known_as(self.program, f"_moved_{k}")
            for k, (total, pair) in enumerate(pairs.items())
        }
        slides = {j: value + step[j] for j, value in self.slides.items()}
        remaining = [let(f"remaining_{k}", e) for k, e in enumerate(self._missed(named, slides))]
        after = sp.Max(*(sp.Abs(e / c) for e, c in zip(remaining, self.scales, strict=True)))
        nearer = let("most_remaining", after) < most
        left = tuple(
            choose(loose, sp.Piecewise((after, nearer), (before, True)), before)
            for after, before in zip(remaining, missed, strict=True)
        )
        step = {j: sp.Piecewise((e, nearer), (0, True)) for j, e in step.items()}
        turns = {j: atan2(e * (1 + e**2 / 3), sp.S.One) for j, e in step.items() if j not in slides}
        return Corrected(loose, left, {**step, **turns})

    def _farthest(self) -> sp.Expr:
        """More than the largest steps of all joints together can correct."""
        levers = 1 + sp.Add(*map(sp.Abs, self.slides.values())) / self.size
        return FAR * (len(self.joints) + 1) * levers

    def _known(
        self, pairs: Mapping[sp.Expr, Pair], slides: Mapping[sp.Symbol, sp.Expr]
    ) -> dict[sp.Basic, sp.Expr]:
        known: dict[sp.Basic, sp.Expr] = dict(slides)
        for total, pair in pairs.items():
            known |= {sp.sin(total): pair.s, sp.cos(total): pair.c}
        return known

    def _missed(
        self, pairs: Mapping[sp.Expr, Pair], slides: Mapping[sp.Symbol, sp.Expr]
    ) -> list[sp.Expr]:
        known = self._known(pairs, slides)
        return [
            target - image.xreplace(known)
            for target, image in zip(self.targets, self.images, strict=True)
        ]

    def _step(self, missed: Sequence[sp.Symbol], damping: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
        """How far each joint moves: a step of damped least squares, or none if the step is long."""
        let, known = self.program.let, self._known(self.pairs, self.slides)
        units = {j: self.size if j in self.slides else sp.S.One for j in self.joints}
        columns = []
        for j, unit in units.items():
            rates = [
                image.diff(j).xreplace(known) * unit / scale
                for image, scale in zip(self.images, self.scales, strict=True)
            ]
            columns.append(
                [e if e.is_number else let(f"moves_{k}_by_{j}", e) for k, e in enumerate(rates)]
            )
        squares = [[sp.Add(*map(sp.Mul, a, b)) for b in columns] for a in columns]
        right = [sp.Add(*map(sp.Mul, a, missed)) for a in columns]
        by = self._solved(squares, right, damping)
        most = let("farthest", sp.Max(*map(sp.Abs, by)))
        return {
            j: let(f"moved_{j}", sp.Piecewise((b * unit, most <= FAR), (0, True)))
            for (j, unit), b in zip(units.items(), by, strict=True)
        }

    def _solved(
        self, squares: list[list[sp.Expr]], right: list[sp.Expr], damping: sp.Symbol
    ) -> list[sp.Symbol]:
        """The solution of the damped normal equations, without a search for pivots.

        A joint that moves like those before it, up to rounding, stays where it is.
        """
        let, n = self.program.let, len(right)
        factors: dict[tuple[int, int], sp.Symbol] = {}
        pivots: list[sp.Symbol] = []
        inverses: list[sp.Symbol] = []
        for i in range(n):
            for k in range(i):
                left = [factors[i, m] * factors[k, m] * pivots[m] for m in range(k)]
                value = (squares[i][k] - sp.Add(*left)) * inverses[k]
                factors[i, k] = let(f"factor_{i}{k}", value)
            left = [factors[i, m] ** 2 * pivots[m] for m in range(i)]
            pivot = sp.Max(damping, squares[i][i] + damping - sp.Add(*left))
            pivots.append(let(f"pivot_{i}", pivot, positive=True))
            moves = pivots[i] > 4 * damping
            inverses.append(let(f"inverse_{i}", sp.Piecewise((1 / pivots[i], moves), (0, True))))
        forward: list[sp.Symbol] = []
        for i in range(n):
            left = [factors[i, m] * forward[m] for m in range(i)]
            forward.append(let(f"forward_{i}", right[i] - sp.Add(*left)))
        back: dict[int, sp.Symbol] = {}
        for i in reversed(range(n)):
            left = [factors[m, i] * back[m] for m in range(i + 1, n)]
            back[i] = let(f"back_{i}", forward[i] * inverses[i] - sp.Add(*left))
        return [back[i] for i in range(n)]


def _turned(angle: sp.Expr) -> Pair:
    """The pair of a small angle: the next terms are below 1e-17."""
    return Pair(angle * (1 - angle**2 / 6), 1 - angle**2 / 2 + angle**4 / 24)
