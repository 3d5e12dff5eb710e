"""A hand that does not turn, and the legs that carry it."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.axial import Across, Along, Axial
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, Strut, sign_of_leg, vector
from closedform.lemmas.parallelogram import Parallelogram
from closedform.lemmas.planes import Flat, Plane
from closedform.lemmas.rails import Rail
from closedform.lemmas.turret import Around, OnTurret
from closedform.lemmas.universal import Universal
from closedform.model.alike import INDEX, Alike, alike, renamed
from closedform.model.derivation import Derivation
from closedform.model.step import Step

_Item = TypeVar("_Item")

DIGITS = 50
"""With which it is tried whether legs hold a hand."""


@dataclass(frozen=True)
class Hand:
    """A hand that does not turn, and its legs."""

    d: Derivation
    hand: sp.Matrix
    legs: tuple[Leg, ...]

    def __post_init__(self) -> None:
        n = len(self.hand)
        if n not in (2, 3) or len(self.legs) != n:
            raise ShapeError(
                f"{self.d.name}: {len(self.legs)} legs for {n} coordinates; a hand that does not "
                f"turn has two legs in a plane or three in space"
            )
        if any(isinstance(leg, Strut) for leg in self.legs[0 if n == 2 else 1 :]):
            raise ShapeError(
                f"{self.d.name}: a strut must be the first of three legs in space; then two driven "
                f"legs move the hand on a sphere"
            )
        if n == 3 and self.rails:
            raise ShapeError(f"{self.d.name}: a rail carries a hand in a plane only")
        if len(self.planes) not in (0, 3):
            raise ShapeError(
                f"{self.d.name}: a leg of two bars with parallel axes is one of three in space"
            )
        check_order(self.d, [leg for _, leg in self.driven])

    @cached_property
    def alike(self) -> Alike | None:
        """The symbols of the legs, if they differ in these alone."""
        declared = [j.symbol for j in self.d.joints] + [p.symbol for p in self.d.parameters]
        signs = [sign_of_leg(k) for k, _ in self.numbered]
        return alike("leg", self.legs, declared, signs)

    @property
    def joints(self) -> tuple[sp.Symbol, ...]:
        return self.d.actuated

    @cached_property
    def numbered(self) -> list[tuple[int, Leg]]:
        """The legs, driven ones from 1 on; a strut, which is the first, is 0."""
        return [*enumerate(self.legs, 0 if isinstance(self.legs[0], Strut) else 1)]

    @cached_property
    def driven(self) -> list[tuple[int, Leg]]:
        return [(k, leg) for k, leg in self.numbered if not isinstance(leg, Strut)]

    @property
    def rails(self) -> list[Rail]:
        return [leg for leg in self.legs if isinstance(leg, Rail)]

    @property
    def planes(self) -> list[Plane]:
        return [leg for leg in self.legs if isinstance(leg, Plane)]

    @property
    def flat(self) -> list[Flat]:
        """The legs that hold the hand on a line or in a plane, instead of by a rod."""
        return [*self.rails, *self.planes]

    @property
    def held(self) -> list[tuple[int, Leg]]:
        """The legs whose rods keep the hand from turning."""
        kinds = Parallelogram | Universal
        return [(k, leg) for k, leg in self.numbered if isinstance(leg.rod, kinds)]

    @property
    def _singular(self) -> tuple[str, str, str]:
        """A clause that says where A is singular; the rods or legs have some position."""
        if not self.flat:
            return "rods", "are", "in line" if len(self.hand) == 2 else "in one plane"
        if self.planes:
            return "planes", "are", "parallel to one line"
        if len(self.rails) == 2:
            return "rails", "are", "parallel"
        return "rod", "is", "at right angles to the rail"

    @property
    def pole(self) -> str:
        """The name of the factor that vanishes where A is singular."""
        legs, _, how = self._singular
        return f"{legs} {how}"

    @property
    def meet(self) -> str:
        """The same as a clause."""
        return f"the {' '.join(self._singular)}"

    def in_lemma(self, items: Sequence[_Item]) -> list[_Item]:
        """The values of the legs, in the order in which the lemma for the hand takes them.

        A strut is the longest of the three rods, and comes last.  A cyclic change of the order does
        not change the sign of the determinant of the rods.
        """
        turn = 1 if isinstance(self.legs[0], Strut) else 0
        return [*items[turn:], *items[:turn]]

    @property
    def count(self) -> str:
        return {2: "two", 3: "three"}[len(self.legs)]

    def place(self, leg: Leg) -> sp.Matrix:
        """Where the rod of a leg ends on the hand."""
        return vector(leg.on_hand or [0] * len(self.hand))

    def rates(self, rods: Sequence[sp.Matrix]) -> list[sp.Expr]:
        """The diagonal of B, from the vectors along all rods."""
        legs = zip(self.legs, rods, strict=True)
        return [rate_of(leg, rod) for leg, rod in legs if not isinstance(leg, Strut)]

    def onto_struts(self) -> sp.Matrix:
        """The hand, moved towards the near end of a strut or away from it to the strut's length."""
        hand = self.hand
        for leg in self.legs:
            if isinstance(leg, Strut):
                w = hand + self.place(leg) - leg.base
                rod = sp.sympify(leg.rod, strict=True)
                hand = rod / sp.sqrt(square(w)) * w - self.place(leg) + leg.base
        return hand

    @cached_property
    def centres(self) -> list[sp.Matrix]:
        """The near ends of the rods, minus the places of their far ends on the hand."""
        return [leg.end() - self.place(leg) for leg in self.legs]

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length, and the hand is on each rail."""
        ends = zip(self.legs, self.centres, strict=True)
        return tuple(
            leg.normal.dot(self.hand - c)
            if isinstance(leg, Flat)
            else square(self.hand - c) - sp.sympify(leg.rod, strict=True) ** 2
            for leg, c in ends
        )

    def rows(self, spans: Sequence[sp.Matrix]) -> list[sp.Matrix]:
        """The rows of A, from the vectors from the near ends of the legs to their far ends."""
        legs = zip(self.legs, spans, strict=True)
        return [leg.normal if isinstance(leg, Flat) else span for leg, span in legs]

    def check_holds(self) -> None:
        """Refuse rods that hold the hand in no posture, because A is singular everywhere."""
        rows = [(self.hand - c).T for c in self.centres]
        if self.flat or not singular_everywhere(sp.Matrix.vstack(*rows)):
            return
        first, *others = self.centres
        one = not any(sp.simplify(e) for c in others for e in c - first)
        raise ShapeError(
            f"{self.d.name}: the legs do not hold the hand; in every posture the near ends of the "
            f"rods, minus their places on the hand, are in one {'point' if one else 'line'}, so "
            f"the hand is free on a {'sphere' if one and len(others) == 2 else 'circle'}.  That is "
            f"so if the legs are as far apart on the hand as on the ground: give one of them "
            f"another place"
        )

    def as_shown(self, numbered: Sequence[tuple[int, _Item]]) -> list[tuple[int | str, _Item]]:
        """The formulas of the legs, by their numbers; of alike legs, only those of leg i."""
        if self.alike:
            first, value = numbered[0]
            return [(INDEX, renamed(value, self.alike.names(first - 1)))]
        return [*numbered]

    def coordinates(self, near: Sequence[sp.Matrix]) -> dict[sp.Symbol, str]:
        """How the names of the coordinates of the points b are written."""
        return {
            e: f"b_{{{k},{axis}}}"
            for (k, _), end in zip(self.in_lemma(self.numbered), near, strict=True)
            for axis, e in zip("xyz", end, strict=False)
            if e.is_Symbol and e.name == f"c{k}_{axis}"
        }

    def declare_alike(self) -> None:
        """Say in the derivation that the legs are alike, and what the symbols of leg i are."""
        self.d.alike = self.alike
        if self.alike:
            *own, sign = zip(self.alike.any_part, *self.alike.symbols, strict=True)
            for symbol, *some, last in own:
                named = f"{', '.join(map(str, some))} or {last}"
                self.d.write(symbol, meaning=f"{named}: that of leg {INDEX}")
            self.d.write(sign[0], rf"\sigma_{{\mathrm{{leg}}_{{{INDEX}}}}}", f"sign of leg {INDEX}")

    def state_loop(self) -> Step:
        self.declare_alike()
        numbers = [k for k, _ in self.numbered]
        near = self.as_shown([*zip(numbers, self.centres, strict=True)])
        shown: dict[str, Any] = {rf"\mathbf b_{k}": c for k, c in near}
        self.d.explain(dict.fromkeys(shown, "near end of the rod of a leg"))
        for k, leg in self.as_shown(self.numbered):
            if isinstance(leg, Flat):
                shown[rf"\mathbf n_{k}"] = leg.normal
            else:
                shown[rf"|\mathbf p - \mathbf b_{k}|"] = sp.sympify(leg.rod, strict=True)
        if self.planes:
            return self.d.step(
                "The loop",
                "The joint of each leg determines a point b, from which two bars lead to the hand "
                "p.  Their three axes have the direction n, so p - b is at right angles to n.",
                shown,
            )
        if self.rails:
            return self.d.step(
                "The loop",
                "The joint of each leg determines a point b.  A rod keeps its length from b to the "
                "hand p.  The rail of a leg passes through b, and n is its normal: the hand is on "
                "the rail if n is at right angles to p - b.",
                shown,
            )
        on_hand = any(leg.on_hand for leg in self.legs)
        still = "It does not turn, so the far end of a rod keeps its place as seen from p.  "
        less = ", minus this place," if on_hand else ""
        same = f"  The legs are alike: {INDEX} is any of 1 to {len(self.legs)}." * bool(self.alike)
        strut = "  One rod, the strut, has no joint: its near end stands still."
        strut *= len(self.driven) < len(self.legs)
        return self.d.step(
            "The loop",
            f"The hand p hangs on {self.count} rods.  {still * on_hand}The near end of rod "
            f"{INDEX}{less} is "
            f"b_{INDEX}, which the joint of its leg determines.  Its distance from the hand is "
            f"the length of the rod.{strut}{same}",
            shown,
        )


def rate_of(leg: Leg, rod: sp.Matrix, span: sp.Matrix | None = None) -> sp.Expr:
    """The entry of B of a leg, from the vector along its rod.

    That of a turret follows from the ``span`` from its pivot.
    """
    if isinstance(leg, Along):
        return sp.S.One
    if isinstance(leg, Around):
        assert span is not None
        return leg.away(span)
    moved = leg.leg if isinstance(leg, OnTurret) else leg
    return moved.joint if isinstance(moved, Stretch | Across) else rod.dot(leg.rate)


def singular_everywhere(A: sp.Matrix, at: Mapping[sp.Basic, sp.Expr] | None = None) -> bool:
    """Whether a matrix is singular at numbers that are drawn at random, beside those given."""
    draw = random.Random(A.rows)
    given = {s: sp.Rational(draw.randint(50, 999), 100) for s in sorted(A.free_symbols, key=str)}
    placed = A.subs(given | dict(at or {})).evalf(DIGITS)
    largest = sp.Mul(*(placed.row(i).norm() for i in range(A.rows)))
    return bool(abs(placed.det()) <= largest / 10 ** (DIGITS // 2))


def square(v: sp.Matrix) -> sp.Expr:
    return v.dot(v)


def in_space(place: sp.Matrix) -> list[sp.Expr]:
    return [*place, *[sp.S.Zero] * (3 - len(place))]


def check_order(d: Derivation, driven: Sequence[Leg], *, axial: bool = False) -> None:
    """Refuse legs that are not in the order of the joints, and such that only some hands have."""
    if not axial and any(isinstance(leg, Axial) for leg in driven):
        raise ShapeError(
            f"{d.name}: legs Along and Across an axis, or Around one and OnTurret, carry a hand "
            f"that turns in space, on three pairs of them, in platform"
        )
    joints = tuple(leg.joint for leg in driven)
    if joints != d.actuated:
        raise ShapeError(
            f"{d.name}: the legs are driven by {_listed(joints)}, but the joints of the "
            f"derivation are {_listed(d.actuated)}; give the legs in this order"
        )


def check_plain(d: Derivation, legs: Sequence[Leg | Crank | Slide | Stretch]) -> None:
    """Refuse rods that keep a hand from turning in a mechanism whose hand can turn."""
    for leg in legs:
        for part in (leg.rod, getattr(leg, "length", None)):
            if isinstance(part, Parallelogram | Universal):
                raise ShapeError(
                    f"{d.name}: a {type(part).__name__} keeps the hand from turning, which only "
                    "parallel supports; use plain rods here"
                )


def _listed(symbols: Sequence[sp.Symbol]) -> str:
    return ", ".join(map(str, symbols))
