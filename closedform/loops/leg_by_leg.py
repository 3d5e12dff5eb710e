"""The inverse of a hand on legs, each of which is solved alone, and what else all loops share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any, Protocol

import sympy as sp

from closedform.lemmas.axial import Across
from closedform.lemmas.legs import Crank, Leg, Naming, Slide, Solution, Stretch, sign_of_leg
from closedform.lemmas.named import named, named_in
from closedform.lemmas.planes import Flat
from closedform.lemmas.turret import OnTurret
from closedform.loops.reached import bounds_of_any, export_reach, signs_of
from closedform.mechanics.lengths import lengths_in_numbers
from closedform.model.derivation import Derivation, Solved
from closedform.model.functions import (
    SINGLE,
    Program,
    branches,
)
from closedform.model.inverse import Inverse, Link

Choice = Mapping[int, str]
SIGN = {+1: "plus", -1: "minus"}
MISSED = (
    "If the target is just outside of the workspace, the length by which the answer misses it "
    "counts as a rounding error too."
)


@dataclass
class LegByLeg:
    """The legs of a hand, as they are solved in a program; ``size`` is the sum of all lengths."""

    d: Derivation
    program: Program
    size: sp.Expr
    found: list[Solution] = field(default_factory=list)
    choices: list[tuple[sp.Symbol, Choice]] = field(default_factory=list)
    share: sp.Expr = sp.S.Half
    """The part of the size by which a rod may miss; more where accuracy is lost."""

    def naming(self, k: int) -> Naming:
        return Naming(self.program, self.size, f"_{k}", self.share)

    def solve(self, k: int, leg: Leg, w: sp.Matrix) -> None:
        """Solve leg ``k``, if ``w`` leads from its base to the far end of its rod."""
        sigma = sign_of_leg(k)
        if leg.signs == 2:
            self.choices.append((sigma, SIGN))
        seen = leg.turned_by(self.found[-1].link) if isinstance(leg, OnTurret) else leg
        self.found.append(seen.solve(self.naming(k), w, sigma))

    def lengths(self, legs: Sequence[Leg]) -> sp.Expr:
        """The product of the lengths of the rods, as they are in the answer."""
        return sp.Mul(*self.each_length(legs))

    def each_length(self, legs: Sequence[Leg]) -> list[sp.Expr]:
        """The lengths of the rods, as they are in the answer."""
        stretched = {s.link.unknowns[0]: s.value for s in self.found}
        return [
            stretched[leg.joint]
            if isinstance(leg.leg if isinstance(leg, OnTurret) else leg, Stretch | Across)
            else sp.sympify(leg.rod, strict=True)
            for leg in legs
        ]

    @property
    def missed(self) -> sp.Expr:
        """The length by which all rods together miss a target just outside of the workspace."""
        return sp.Add(*(s.missed for s in self.found))

    def rows(self, straight: Sequence[sp.Matrix], *, subtract: bool) -> list[sp.Matrix]:
        """Rows with the determinant of A: the ``straight`` ones and the rods of the solved legs.

        A determinant does not change if a row is subtracted from the others.  With ``subtract``
        this is done if it does not increase the number of values that the entries have over all
        branches: the hand may cancel, but a difference has two signs.
        """
        rows = [*straight, *(s.rod for s in self.found)]
        if not subtract:
            return rows
        first, *others = rows
        differences = [first, *(sp.expand(row - first) for row in others)]
        return min(differences, rows, key=self._values)

    def _values(self, rows: Sequence[sp.Matrix]) -> int:
        """How many values the entries have over all branches; a zero has none."""
        below = signs_of(self.program.body, [sigma for sigma, _ in self.choices])

        def values(entry: sp.Expr) -> int:
            return 1 << len(set().union(*(below.get(s, set()) for s in entry.free_symbols)))

        return sum(values(e) for row in rows for e in row if e != 0)

    @property
    def on_modes(self) -> str:
        """A sentence on the working modes; empty if there is only one."""
        said = "The signs of the two solutions of a leg are those of the diagonal of B.  "
        return said if self.choices else ""

    def export(
        self,
        target: Mapping[str, Any],
        contained: Mapping[str, Any],
        unreachable: str,
        notes: Sequence[str],
    ) -> None:
        """Export ``ik`` and, if the reach is limited, ``workspace_contains``.

        These are their inputs, the note on what is UNREACHABLE, and the further notes of ``ik``.
        """
        d = self.d
        inside = bounds_of_any(self.program, [sigma for sigma, _ in self.choices])
        working = branches(*self.choices) if self.choices else SINGLE
        d.branches = working.labels
        modes = "all working modes" if self.choices else "the only working mode"
        d.function(
            "ik",
            f"The driven joints of {modes}.",
            target,
            {"q": [s.value for s in self.found]},
            program=self.program,
            branches=working,
            result="Solutions",
            notes=(
                *([unreachable] if inside.body else []),
                *where_free(self.found),
                *notes,
            ),
        )
        export_reach(d, inside, contained)
        for s in self.found:
            record_lemma(d, "ik", s.link)

    def certify(
        self,
        equations: Sequence[sp.Expr],
        images: str = "",
        *,
        angles: Sequence[sp.Symbol] = (),
        before: Sequence[Link] = (),
    ) -> None:
        """Record the equations that the joints satisfy; see :class:`Inverse` for ``images``.

        ``angles`` are the coordinates of the target of which only the sine and cosine count.
        The links ``before`` those of the legs solve for joints that ``ik`` does not return.
        """
        for link in before:
            record_lemma(self.d, "ik", link)
        self.d.inverses.append(
            Inverse(
                "ik",
                self.d.actuated,
                (sp.S.Zero,) * len(equations),
                tuple(equations),
                angles=tuple(angles),
                images=images,
                links=(*before, *(s.link for s in self.found)),
                passive=tuple(e for link in before for e in link.unknowns),
            )
        )


def signs_of_modes(legs: Sequence[Leg]) -> tuple[str, ...]:
    """A note on the diagonal of B, if each leg has two working modes."""
    if all(leg.signs == 2 for leg in legs):
        return ("Its signs distinguish the working modes; BRANCHES lists them in the same order.",)
    return ()


def record(d: Derivation, inverse: Inverse) -> None:
    """Add an inverse, and record the lemmas of its links for the article."""
    d.inverses.append(inverse)
    for link in inverse.links:
        record_lemma(d, inverse.function, link)


def record_lemma(d: Derivation, function: str, link: Link) -> None:
    """Record the lemma of a link for the article."""
    assert link.lemma is not None
    d.solved.append(Solved(function, link.unknowns[0], link.lemma, link.lemma.equations[0]))


def solution_of(links: Iterable[Link]) -> dict[sp.Symbol, sp.Expr]:
    """What the lemmas of some links find, by unknown."""
    return {x: e for link in links if link.lemma for x, e in link.lemma.solution.items()}


def where_free(found: Iterable[Solution]) -> list[str]:
    """Notes on where the joint of a leg is free; what holds for several legs is said once."""
    free: dict[str, list[str]] = {}
    for case in (c for s in found for c in s.link.degenerate):
        free.setdefault(case.meaning, []).append(str(case.free))
    return [
        f"SINGULAR: {meaning}; {_either(names)} is free, 0 is returned."
        for meaning, names in free.items()
    ]


def _either(names: Sequence[str]) -> str:
    """``a, b or c``."""
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


class Sized(Protocol):
    """A part of a mechanism that has lengths, which may be numbers."""

    @property
    def rod(self) -> Any:
        """The length of its rod."""

    @property
    def base(self) -> sp.Matrix:
        """The point of the ground from which it is seen."""

    @property
    def on_hand(self) -> Sequence[Any]:
        """The point where it ends, as seen from the point that is the hand."""


def size_of(
    d: Derivation,
    legs: Sequence[Sized],
    moved: Sequence[sp.Expr] = (),
    *,
    among: Set[sp.Basic] | None = None,
) -> sp.Expr:
    """The sum of the lengths of a mechanism and of the travel of its slides.

    With ``among``, other parameters are left out.
    """
    lengths = [p for p in d.parameters if p.unit != "rad" and (among is None or p.symbol in among)]
    sized = [p.symbol if p.nonnegative else sp.Abs(p.symbol) for p in lengths]
    return sp.Add(*sized, *map(sp.Abs, moved), *map(_in_numbers, legs))


def _in_numbers(leg: Sized) -> sp.Expr:
    """The lengths of a leg that are numbers, not parameters."""
    rod = 0 if isinstance(leg, Flat) else leg.rod
    lengths = [rod, getattr(leg, "length", 0), *getattr(leg, "bars", ())]
    places = [[length] for length in lengths] + [leg.base, leg.on_hand]
    exact = ([sp.sympify(e, strict=True) for e in place] for place in places)
    return sp.Add(*(max((_number(e) for e in place), default=sp.S.Zero) for place in exact))


def _number(length: sp.Expr) -> sp.Expr:
    return lengths_in_numbers(length.replace(sp.Abs, lambda inside: inside))


def named_rod(p: Program, k: int, leg: Leg, size: sp.Expr | None = None) -> sp.Expr:
    """The length of the rod of leg ``k``; lemmas equate radii, so that numbers have names.

    With a ``size``, a leg that stretches is bounded to a positive length.
    """
    rod = sp.sympify(leg.rod, strict=True)
    if size is not None and isinstance(leg, Stretch):
        return p.bound(f"r_{k}", rod, size, "a leg has a positive length")
    return rod if rod.is_Symbol else p.let(f"r_{k}", rod, nonnegative=bool(rod.is_nonnegative))


__all__ = [
    "MISSED",
    "SIGN",
    "Choice",
    "LegByLeg",
    "named",
    "named_in",
    "named_rod",
    "record",
    "record_lemma",
    "signs_of_modes",
    "size_of",
    "solution_of",
    "where_free",
]


def known_sides(legs: Sequence[Leg]) -> str:
    """Sentences on the triangle in which the lemma of a crank or a slider finds the joint."""
    told = ""
    if cranks := [leg for leg in legs if isinstance(leg, Crank)]:
        told += "The target gives the far end of the rod of a crank"
        flat = all(len(leg.base) == 2 for leg in cranks)
        told += (
            ": the crank, the rod and the line from the pivot to this end are a triangle whose "
            "sides are known.  "
            if flat
            else ", and so how far this is from the plane of the crank.  In the plane the crank, "
            "the rest of the rod and the line from the pivot are a triangle whose sides are "
            "known.  "
        )
    if any(isinstance(leg, Slide) for leg in legs):
        told += (
            "The target gives the far end of the rod of a slider, and so how far this is from the "
            "line of the slider.  The rest of the rod is along the line, to either side.  "
        )
    return told
