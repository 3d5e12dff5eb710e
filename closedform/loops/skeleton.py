"""The skeleton of a hand on legs: its points, links, joints and lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.lemmas.axial import Across, Along, Axial, FreeAlong
from closedform.lemmas.extended import Extended
from closedform.lemmas.legs import Crank, Leg, Naming, Slide, Stretch, Strut, vector
from closedform.lemmas.parallelogram import Parallelogram, Prism
from closedform.lemmas.planes import Plane
from closedform.lemmas.rails import Rail
from closedform.lemmas.turret import Around, OnTurret
from closedform.loops.hand import Hand, in_space, square
from closedform.loops.held import Bars, bars_of
from closedform.loops.leg_by_leg import size_of
from closedform.loops.modes import NO_MODE
from closedform.mechanics.skeleton import skeleton
from closedform.model.functions import Branches, Program, real

ANY = sp.Matrix([real(f"w_{i}") for i in "xyz"])
"""From the slider of a leg with two bars to the hand."""


@dataclass
class Drawing:
    """What the skeleton of legs consists of; names of points end in those of legs."""

    links: dict[str, tuple[str, ...]] = field(default_factory=dict)
    lengths: dict[tuple[str, str], sp.Expr] = field(default_factory=dict)
    closing: dict[tuple[str, str], sp.Expr] = field(default_factory=dict)
    joints: dict[sp.Symbol, tuple[str, ...]] = field(default_factory=dict)

    def add_leg(
        self, k: int, leg: Leg, far: str, equation: sp.Expr, place: sp.Matrix | None = None
    ) -> None:
        """A leg with its equation, whose rod ends at the point ``far``, which is at a place."""
        if isinstance(leg, FreeAlong) and leg.slide is not None and place is not None:
            rod: Any = leg.leg
            self.add_leg(k, rod, f"E{k}", equation)
            self.joints[leg.slide] = (f"E{k}", far)
            self.lengths[f"E{k}", far] = vector(leg.axis).dot(place - leg.base)
            return
        if isinstance(leg, Axial):
            self._add_axial(k, leg, far, equation)
            return
        self._add_rod(k, leg, far, equation)
        self._add_driven(k, leg)
        for pair in bars_of(k, leg, far):
            self._add_bars(k, pair, equation if pair.far == far else None)

    def add_extended(self, k: int, leg: Leg, far: str, equation: sp.Expr, span: sp.Matrix) -> None:
        """A leg with its equation, whose parallelogram is between two links."""
        self._add_driven(k, leg)
        extended: Extended = leg.rod
        _, across = extended.split(span)
        away, reach = sp.sqrt(across.dot(across)), extended.reach(span)
        closed = equation * (away - sum(extended.links) + extended.fore(span)) / (away + reach)
        ends = (f"B{k}", f"D{k}"), (f"E{k}", far)
        for name, pair, length in zip(("link", "last"), ends, extended.links, strict=True):
            self.links[f"{name}{k}"] = pair
            self.lengths[pair] = length
        self.lengths[f"D{k}", f"E{k}"] = sp.sympify(extended, strict=True)
        self.closing[f"D{k}", f"E{k}"] = closed
        for bars in bars_of(k, leg, far):
            self._add_bars(k, bars, closed)

    def add_rail(self, k: int, leg: Rail, far: str, slid: sp.Expr, equation: sp.Expr) -> None:
        """A slider with a rail, along which the end of the leg has slid."""
        base, end = f"A{k}", f"B{k}"
        self.joints |= {leg.joint: (base, end), leg.slide: (end, far)}
        self.lengths |= {(base, end): leg.joint, (end, far): slid}
        self.closing[end, far] = equation**2

    def _add_axial(self, k: int, leg: Axial, far: str, equation: sp.Expr) -> None:
        """A slider along an axis, or a leg that starts at a foot on an axis."""
        if isinstance(leg, FreeAlong):
            self.lengths[f"B{k}", far] = sp.sympify(leg.rod, strict=True)
            self.closing[f"B{k}", far] = equation
            self.links[f"rod{k}"] = (f"B{k}", far)
            self._add_driven(k, leg.leg)
            return
        if isinstance(leg, Around):
            self.joints[leg.joint] = (f"A{k}",)
            return
        if isinstance(leg, OnTurret):
            self._add_on_turret(k, leg, far, equation)
            return
        pair = (f"A{k}", f"B{k}") if isinstance(leg, Along) else (f"B{k}", far)
        self.joints[leg.joint] = pair
        self.lengths[pair] = leg.joint
        if isinstance(leg, Across):
            self.closing[pair] = equation

    def _add_on_turret(self, k: int, leg: OnTurret, far: str, equation: sp.Expr) -> None:
        """A turret, and the planar leg on it, which ends in its plane on the axes of the loop."""
        near = f"A{k}" if isinstance(leg.leg, Stretch) else f"B{k}"
        foot = leg.leg.base
        if any(foot):
            self.links[f"turret{k}"] = (f"A{k - 1}", f"A{k}")
            self.lengths[f"A{k - 1}", f"A{k}"] = sp.sqrt(sp.factor(square(foot)))
        self.lengths[near, far] = sp.sympify(leg.rod, strict=True)
        self.closing[near, far] = equation
        if isinstance(leg.leg, Stretch):
            self.joints[leg.joint] = (near, far)
        else:
            self.links[f"rod{k}"] = (near, far)
            self._add_driven(k, leg.leg)

    def _add_rod(self, k: int, leg: Leg, far: str, equation: sp.Expr) -> None:
        """The rod; of a leg that stretches it is the driven joint."""
        near = near_of(k, leg)
        self.lengths[near, far] = sp.sympify(leg.rod, strict=True)
        self.closing[near, far] = equation
        if isinstance(leg, Stretch):
            self.joints[leg.joint] = (near, far)
        elif not isinstance(leg.rod, Parallelogram):
            self.links[f"rod{k}"] = (near, far)

    def _add_driven(self, k: int, leg: Leg | Crank | Slide) -> None:
        """The crank or the slider."""
        base, end = f"A{k}", f"B{k}"
        if isinstance(leg, Crank):
            if not isinstance(leg.length, Parallelogram):
                self.links[f"crank{k}"] = (base, end)
            self.lengths[base, end] = sp.sympify(leg.length, strict=True)
            self.joints[leg.joint] = (base,)
        elif isinstance(leg, Slide):
            self.lengths[base, end] = leg.joint
            self.joints[leg.joint] = (base, end)

    def _add_bars(self, k: int, pair: Bars, equation: sp.Expr | None) -> None:
        """The bars of a parallelogram: a rod, which the equation closes, or a crank."""
        whole = "crank" if equation is None else "rod"
        for ends in zip(pair.ends(pair.near), pair.ends(pair.far), strict=True):
            self.links[f"{whole}{k}{ends[0][-1]}"] = ends
            self.lengths[ends] = sp.sympify(pair.given, strict=True)
            if equation is not None:
                self.closing[ends] = equation
        for middle in (pair.near, pair.far):
            first, second = pair.ends(middle)
            half = pair.given.half
            self.links[f"bar_{first}"] = (first, middle, second)
            self.lengths |= {(first, middle): half, (middle, second): half}
        if isinstance(pair.given, Prism):
            self._add_third(k, pair, pair.given, equation)

    def _add_third(self, k: int, pair: Bars, prism: Prism, equation: sp.Expr | None) -> None:
        """The third rod beside the two of a parallelogram, and how it is held."""
        ends = pair.third(pair.near), pair.third(pair.far)
        self.links[f"rod{k}e"] = ends
        self.lengths[ends] = sp.sympify(prism.length, strict=True)
        if equation is not None:
            self.closing[ends] = equation
        for middle in (pair.near, pair.far):
            self.links[f"bar_{pair.third(middle)}"] = (middle, pair.third(middle))
            self.lengths[middle, pair.third(middle)] = sp.sqrt(sp.factor(square(prism.aside)))

    def add_plane(self, k: int, leg: Plane, far: str) -> None:
        """The slider and both bars, which have their lengths if the hand is in the plane."""
        base, end, elbow = f"A{k}", f"B{k}", f"E{k}"
        self.joints[leg.joint] = (base, end)
        self.lengths[base, end] = leg.joint
        off = -leg.aside(ANY) * leg.normal.dot(ANY) ** 2
        for pair, length in zip(((end, elbow), (elbow, far)), leg.lengths, strict=True):
            self.lengths[pair], self.closing[pair] = length, off
        self.links |= {f"bar{k}": (end, elbow), f"rod{k}": (elbow, far)}


@dataclass
class _OnHand(Drawing):
    """The legs of a hand that does not turn, and the links of the hand that they hold."""

    def add(self, m: Hand, k: int, leg: Leg, equation: sp.Expr) -> None:
        place = m.place(leg)
        far = "P" if place.is_zero_matrix else f"C{k}"
        if far != "P":
            self.links[f"hand{k}"] = ("P", far)
            self.lengths["P", far] = sp.sqrt(sp.factor(sp.trigsimp(square(place))))
        if isinstance(leg, Rail):
            span = m.hand - m.centres[k - 1]
            self.add_rail(k, leg, far, leg.way.dot(span), equation)
        elif isinstance(leg, Plane):
            self.add_plane(k, leg, far)
        else:
            self.add_leg(k, leg, far, equation)


def near_of(k: int, leg: Leg) -> str:
    """The point at the near end of the rod of a leg."""
    return f"A{k}" if isinstance(leg, Stretch | Strut) else f"B{k}"


def draw(
    m: Hand, hand: sp.Matrix, program: Program, modes: Branches, passive: Sequence[sp.Symbol] = ()
) -> None:
    """Record the skeleton, with the hand in an assembly mode in the names of a program.

    ``passive`` are the angles of the rods, or of the first of them.
    """
    drawn = _OnHand()
    for (k, leg), equation in zip(m.numbered, m.loop, strict=True):
        drawn.add(m, k, leg, equation)
    for (k, leg), angle in zip(m.numbered, passive, strict=False):
        drawn.joints[angle] = (near_of(k, leg),)
    ground = tuple(f"A{k}" for k, _ in m.numbered)
    v = Program(list(program.body), program.taken)
    points = _points(m, hand)
    for k, leg in m.numbered:
        if isinstance(leg, Plane):
            names = Naming(v, size_of(m.d, m.legs, m.joints), f"_bars{k}")
            elbow = leg.end() + leg.named_elbow(names, hand + m.place(leg) - leg.end())
            points[f"E{k}"] = in_space(elbow)
    skeleton(
        m.d,
        points,
        links={"ground": ground if len(ground) == 2 else (*ground, ground[0]), **drawn.links},
        joints=drawn.joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=ground,
        lengths=drawn.lengths,
        program=v,
        branches=modes,
        notes=(NO_MODE, *["The width of a parallelogram matters here alone."] * bool(m.held)),
        at_posture=[_points(m, m.hand), *_bars(m)],
        closing=drawn.closing,
    )


def _bars(m: Hand) -> list[dict[str, Sequence[sp.Expr]]]:
    """For the proof, the bars of each leg; the hand is anywhere, as seen from the slider."""
    found: list[dict[str, Sequence[sp.Expr]]] = []
    for k, leg in m.numbered:
        if isinstance(leg, Plane):
            place = m.place(leg)
            far = m.hand + place
            at = {f"B{k}": far - ANY, f"E{k}": far - ANY + leg.elbow(ANY)}
            at["P" if place.is_zero_matrix else f"C{k}"] = far
            found.append({name: in_space(e) for name, e in at.items()})
    return found


def _points(m: Hand, hand: sp.Matrix) -> dict[str, Sequence[sp.Expr]]:
    """The points of the skeleton: those of each leg, and the hand P."""
    points: dict[str, Sequence[sp.Expr]] = {}
    for k, leg in m.numbered:
        place = m.place(leg)
        points |= points_of(k, leg, "P" if place.is_zero_matrix else f"C{k}", hand + place)
    return points | {"P": in_space(hand)}


def _near_ends(k: int, leg: Leg, place: sp.Matrix) -> dict[str, sp.Matrix]:
    """The base A and the near end B of a leg, whose far end is at a place."""
    at = {f"A{k}": leg.base}
    if isinstance(leg, FreeAlong):
        foot = leg.foot(place - leg.base)
        at |= {f"A{k}": leg.base + foot, f"B{k}": leg.end() + foot}
    elif isinstance(leg, Around):
        pass
    elif isinstance(leg, OnTurret):
        at[f"A{k}"] = leg.start()
        if not isinstance(leg.leg, Stretch):
            at[f"B{k}"] = leg.end()
    elif not isinstance(leg, Stretch | Strut):
        foot = leg.foot(place - leg.base) if isinstance(leg, Across) else sp.zeros(len(place), 1)
        at[f"B{k}"] = leg.end() + foot
    return at


def points_of(k: int, leg: Leg, far: str, place: sp.Matrix) -> dict[str, Sequence[sp.Expr]]:
    """The base A and the near end B of a leg, its far end, and the ends of its bars."""
    if isinstance(leg, FreeAlong) and leg.slide is not None:  # the hand slides, not the leg
        rod: Any = leg.leg
        end = place - leg.foot(place - leg.base)
        held = {} if far == "P" else {far: in_space(place)}
        return points_of(k, rod, f"E{k}", end) | held
    at = _near_ends(k, leg, place)
    if far != "P":
        at[far] = place
    if isinstance(leg.rod, Extended):
        _, across = leg.rod.split(place - at[f"B{k}"])
        along = across / sp.sqrt(across.dot(across))
        near, last = leg.rod.links
        at |= {f"D{k}": at[f"B{k}"] + near * along, f"E{k}": place - last * along}
    points: dict[str, Sequence[sp.Expr]] = {name: in_space(e) for name, e in at.items()}
    for pair in bars_of(k, leg, far):
        for middle in (pair.near, pair.far):
            ends = pair.around(middle, place if middle == far else at[middle])
            points |= {name: in_space(end) for name, end in ends.items()}
    return points


__all__ = ["Drawing", "draw", "points_of"]
