"""A hand in a plane that slides on three driven pins: 3-PRP and 3-RRP, two assembly modes.

Seen from the hand it is a 3-PPR mechanism: its own lines stand still, and the pins move.  The
equations are linear in the position of the hand, as the hand sees it, which is eliminated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import (
    Crank,
    Leg,
    Slide,
    Solution,
    closing_weights,
    cross_in_plane,
    rotated,
    turned_left,
    vector,
)
from closedform.lemmas.lines import FAR, coordinate, slide_to_line
from closedform.lemmas.rails import named_number
from closedform.loops.hand import check_order, in_space, square
from closedform.loops.leg_by_leg import SIGN, Choice, LegByLeg, named_in, record, size_of
from closedform.loops.modes import NO_MODE, export_in_plane
from closedform.loops.slotted import turned_to_line
from closedform.loops.yaw import yaw_by_amplitude
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Combination, Inverse, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.step import Step

LEGS = 3
MEET = "the pins do not hold the hand: the normals of its lines in the pins pass through one point"


@dataclass(frozen=True)
class Sleeve:
    """A driven pin, at the end of a crank or on a slider, along which a line of the hand slides.

    The ``leg`` has no rod.  The line passes the point ``on_hand`` along a unit vector, both in the
    frame of the hand, seen from its point.  ``slide`` is the passive joint.
    """

    leg: Crank | Slide
    slide: sp.Symbol
    on_hand: Sequence[Any]
    along: Sequence[Any]

    @property
    def way(self) -> sp.Matrix:
        return vector(self.along)

    @property
    def normal(self) -> sp.Matrix:
        """The direction of the line, turned to the left, in the frame of the hand."""
        return turned_left(self.way)

    @property
    def aside(self) -> sp.Expr:
        """How far the line is from the point of the hand, along its normal."""
        return sp.simplify(self.normal.dot(vector(self.on_hand)))


@dataclass(frozen=True)
class _OnPins:
    """A hand on three pins."""

    d: Derivation
    legs: tuple[Sleeve, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != LEGS:
            raise ShapeError(f"{name}: a hand that slides on pins needs {LEGS}")
        check_order(self.d, [cast("Leg", sleeve.leg) for sleeve in self.legs])
        if any(sleeve.leg.rod != 0 for sleeve in self.legs):
            raise ShapeError(f"{name}: a pin on which the hand slides has no rod")
        if not all(w.is_number for w in self.weights):
            raise ShapeError(f"{name}: the directions of the lines of the hand must be numbers")
        if not any(self.weights):
            raise ShapeError(
                f"{name}: the three lines of the hand are parallel, so it slides along"
            )
        self.d.task = ["x", "y", "yaw"]

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return real("x"), real("y"), real("yaw")

    @property
    def hand(self) -> sp.Matrix:
        return sp.Matrix(self.target[:2])

    @property
    def seen(self) -> sp.Matrix:
        """The position of the hand in its own frame."""
        return sp.Matrix([real("u"), real("v")])

    @property
    def yaw(self) -> sp.Symbol:
        return self.target[2]

    @property
    def pair(self) -> Pair:
        return Pair(sp.sin(self.yaw), sp.cos(self.yaw))

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the lines add up to zero."""
        return closing_weights([sleeve.normal for sleeve in self.legs])

    @cached_property
    def order(self) -> tuple[int, int, int]:
        """The two lines that determine the position of the hand, and the other one."""
        last = next(k for k in (2, 0, 1) if self.weights[k] != 0)
        return (last + 1) % LEGS, (last + 2) % LEGS, last

    @cached_property
    def coefficients(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """a, b and c of the equation a sin(yaw) + b cos(yaw) = c, which has no position."""
        a = b = c = sp.S.Zero
        for weight, sleeve in zip(self.weights, self.legs, strict=True):
            pin = sleeve.leg.end()
            a += weight * cross_in_plane(sleeve.normal, pin)
            b += weight * sleeve.normal.dot(pin)
            c += weight * sleeve.aside
        a, b, c = (sp.factor_terms(sp.expand(e)) for e in (a, b, c))
        return a, b, c

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: the pins are on the lines of the hand."""
        return tuple(
            rotated(sleeve.normal, self.pair).dot(sleeve.leg.end() - self.hand) - sleeve.aside
            for sleeve in self.legs
        )


def on_pins(d: Derivation, legs: Sequence[Sleeve], modes: Choice = SIGN) -> None:
    """Derive and export a hand that slides on three driven pins, in a plane.

    Parameters
    ----------
    d
        the derivation, with its parameters, three driven joints and three passive slides; its task
        becomes ``x, y, yaw``
    legs
        the driven pins with the lines of the hand, in the order of the joints
    modes
        the names of the assembly modes, by the sign of the determinant of A
    """
    m = _OnPins(d, tuple(legs))
    d.singularities, d.poles = (*(f"leg {k}" for k in (1, 2, 3)), "all legs"), ("all legs",)
    loop = d.step(
        "The loop",
        "The joint of leg i moves the pin b, which is on a line of the hand.  In the frame of the "
        "hand this line passes the point e and has the normal n.  So R*n is at right angles to "
        "b - p - R*e.",
        {},
        rows=[
            ("i", "b", "n", "e"),
            *(
                (str(k), leg.leg.end().T, leg.normal.T, vector(leg.on_hand).T)
                for k, leg in enumerate(m.legs, 1)
            ),
        ],
    )
    d.loop = loop
    at = _forward(m, modes, loop)
    _draw(m, at)
    _velocity(m, at, loop)
    _inverse(m, loop)


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    hand: sp.Matrix
    pair: Pair
    volume: sp.Expr


def _turn(m: _OnPins, f: Program, size: sp.Expr, sigma: sp.Symbol) -> tuple[Link, Pair, sp.Expr]:
    """The yaw, its pair, and the determinant of A without its sign."""
    return yaw_by_amplitude(
        f,
        m.yaw,
        [named_in(f, n, e) for n, e in zip("abc", m.coefficients, strict=True)],
        sigma,
        size,
        missed=lambda _: size / 4,
        said="the pins do not hold the hand",
    )


def _forward(m: _OnPins, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma = m.d, m.d.program(), real("sigma_assembly")
    modes = branches((sigma, choice))
    d.assembly_modes = modes.labels
    legs = [sleeve.leg for sleeve in m.legs]
    sliders = [leg.joint for leg in legs if isinstance(leg, Slide)]
    size = f.let("size", size_of(d, legs, sliders))
    for q in sliders:
        least = FAR * size_of(d, legs)
        f.bound(f"near_{q}", least - sp.Abs(q), least / 2, "the sliders are near the mechanism")
    turn, pair, root = _turn(m, f, size, sigma)
    first, second, last = m.order
    back = Pair(-pair.s, pair.c)
    far, ways = [], []
    for k in (first, second):
        sleeve = m.legs[k]
        pin = rotated(sleeve.leg.end(), back)
        far.append(f.let(f"g{k + 1}", sleeve.normal.dot(pin) - sleeve.aside))
        numbers = zip("xy", sleeve.way, strict=True)
        ways.append(sp.Matrix([named_number(f, f"t{k + 1}_{i}", e) for i, e in numbers]))
    across = cross_in_plane(ways[0], ways[1])
    start = len(f.body)
    found = (far[0] * ways[1] - far[1] * ways[0]) / across
    seen = sp.Matrix([f.let(f"seen_{i}", e) for i, e in zip("xy", found, strict=True)])
    lemma = Lemma(
        "oblique coordinates",
        r"\mathbf w = \frac{g_s\,\mathbf t - g_t\,\mathbf s}{D},\quad g_s = s_1 w_2 - s_2 w_1,\ "
        r"g_t = t_1 w_2 - t_2 w_1",
        tuple(cross_in_plane(t, m.seen) - g for t, g in zip(ways, far, strict=True)),
        dict(zip(m.seen, seen, strict=True)),
        1,
        roles=((r"\mathbf w", m.seen), (r"\mathbf s", ways[0]), (r"\mathbf t", ways[1])),
    )
    means = dict(zip(seen, m.seen, strict=True))
    meet = Link(tuple(m.seen), lemma.equations, {}, lemma, tuple(f.body[start:]), means=means)
    hand = sp.Matrix([f.let(f"p_{i}", e) for i, e in zip("xy", rotated(seen, pair), strict=True)])
    links = [turn, meet, *(coordinate(x, e) for x, e in zip(m.hand, hand, strict=True))]
    a, b, c = m.coefficients
    d.step(
        "Forward: two assembly modes",
        "Seen from the hand its lines stand still.  The sum of their normals, each times a weight, "
        "is zero.  So the sum of the equations with these weights does not contain p.  It is "
        "a*sin(yaw) + b*cos(yaw) = c, and has two solutions: these are the assembly modes.  Then "
        "two of the equations are linear in the position, as the hand sees it.",
        dict(zip("abc", m.coefficients, strict=True)),
        proves="The weighted equations add up to that of the yaw.",
        equal=[
            (
                sp.Add(*(w * e for w, e in zip(m.weights, m.loop, strict=True))),
                a * m.pair.s + b * m.pair.c - c,
            )
        ],
        uses=[loop],
    )
    d.function(
        "fk",
        "Position and yaw of the hand in both assembly modes.",
        {"q": d.actuated},
        {"p": [*hand, turn.lemma[m.yaw] if turn.lemma else m.yaw]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the lines of the hand are too far from its point for these pins"
            + f", or a slider is farther away than {FAR} times the sum of all lengths"
            * bool(sliders)
            + ".",
            "SINGULAR: the hand turns freely, and yaw = 0 is returned.",
            "Ill-conditioned near the parallel singularities, where both modes meet.",
        ),
    )
    turned = Pair(-m.pair.s, m.pair.c)
    seen_loop = [
        sleeve.normal.dot(rotated(sleeve.leg.end(), turned) - m.seen) - sleeve.aside
        for sleeve in m.legs
    ]
    own = list(m.hand - rotated(m.seen, m.pair))
    w, combined = m.weights, sp.zeros(5)
    combined[first, 1] = combined[second, 2] = -1
    combined[last, :3] = sp.Matrix([[1, w[first], w[second]]]) / w[last]
    combined[3, 3] = combined[4, 4] = 1
    record(
        d,
        Inverse(
            "fk",
            m.target,
            (sp.S.Zero,) * 5,
            (*seen_loop, *own),
            links=tuple(links),
            passive=tuple(m.seen),
            glue=Combination(combined, {u: u for u in (*m.target, *m.seen)}),
        ),
    )
    return _Posture(Program(list(f.body), f.taken), modes, hand, pair, sigma * root)


def _points(m: _OnPins, hand: sp.Matrix, pair: Pair) -> dict[str, list[sp.Expr]]:
    points = {"P": in_space(hand)}
    for k, sleeve in enumerate(m.legs, 1):
        points |= {f"A{k}": in_space(sleeve.leg.base), f"B{k}": in_space(sleeve.leg.end())}
        if any(vector(sleeve.on_hand)):
            points[f"C{k}"] = in_space(hand + rotated(vector(sleeve.on_hand), pair))
    return points


def _draw(m: _OnPins, at: _Posture) -> None:
    ground = ("A1", "A2", "A3")
    links: dict[str, tuple[str, ...]] = {"ground": (*ground, "A1")}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for k, sleeve in enumerate(m.legs, 1):
        base, pin, far = f"A{k}", f"B{k}", f"C{k}" if any(vector(sleeve.on_hand)) else "P"
        if far != "P":
            links[f"hand{k}"] = ("P", far)
            lengths["P", far] = sp.sqrt(sp.factor(square(vector(sleeve.on_hand))))
        if isinstance(sleeve.leg, Slide):
            joints[sleeve.leg.joint] = (base, pin)
            lengths[base, pin] = sleeve.leg.joint
        else:
            joints[sleeve.leg.joint] = (base,)
            links[f"crank{k}"] = (base, pin)
            lengths[base, pin] = sp.sympify(sleeve.leg.length, strict=True)
        joints[sleeve.slide] = (far, pin)
    skeleton(
        m.d,
        _points(m, at.hand, at.pair),
        links=links,
        joints=joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=ground,
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[_points(m, m.hand, m.pair)],
    )


def _rows(m: _OnPins, hand: sp.Matrix, pair: Pair) -> tuple[list[list[sp.Expr]], list[sp.Expr]]:
    """A of A*dx = B*dq, and the diagonal of B."""
    rows, rates = [], []
    for sleeve in m.legs:
        normal, pin = rotated(sleeve.normal, pair), sleeve.leg.end()
        rows.append([*normal, cross_in_plane(pin - hand, normal)])
        rates.append(normal.dot(sleeve.leg.rate))
    return rows, rates


def _velocity(m: _OnPins, at: _Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    A, B = velocity_matrices([-e for e in m.loop], m.target, d.actuated)
    rows, rates = _rows(m, m.hand, m.pair)
    a, b, _ = m.coefficients
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations give A*dx = B*dq.  Row i of A is the normal of the "
        "line of the hand and its moment about the hand, in the pin.  B is diagonal.  Its entry is "
        "zero where the pin moves along the line of the hand (serial).  A is singular if "
        f"{MEET} (parallel), which is where both assembly modes meet.",
        {"A": sp.Matrix(rows), **{f"B_{{{k}{k}}}": e for k, e in enumerate(rates, 1)}},
        proves="A and B are the derivatives, and the determinant of A is b*sin(yaw) - a*cos(yaw).",
        equal=[
            (A, sp.Matrix(rows)),
            (B, sp.diag(*rates)),
            (sp.Matrix(rows).det(), b * m.pair.s - a * m.pair.c),
        ],
        uses=[loop],
    )
    rows, rates = _rows(m, at.hand, at.pair)
    export_in_plane(d, v, at.modes, (sp.Matrix(rows), rates), at.volume)


def _inverse(m: _OnPins, loop: Step) -> None:
    d, g = m.d, m.d.program()
    legs = [sleeve.leg for sleeve in m.legs]
    solved = LegByLeg(d, g, g.let("size", size_of(d, legs, m.target[:-1])))
    known: dict[sp.Basic, sp.Expr] = {}
    for k, sleeve in enumerate(m.legs, 1):
        names, leg = solved.naming(k), sleeve.leg
        n = sp.Matrix(
            [
                names.let(f"n_{i}", e)
                for i, e in zip("xy", rotated(sleeve.normal, m.pair), strict=True)
            ]
        )
        off = names.let("off", sleeve.aside + n.dot(m.hand - leg.base))
        if isinstance(leg, Slide):
            across = names.let("across", n.dot(leg.rate))
            link = slide_to_line(names, leg.joint, (across, off), size_of(d, legs))
            assert link.lemma is not None
            known[leg.joint] = link.lemma[leg.joint]
            solved.found.append(Solution(link, link.lemma[leg.joint], n))
            continue
        sigma = real(f"sigma_{k}")
        solved.choices.append((sigma, SIGN))
        length = sp.sympify(leg.length, strict=True)
        arms = (length * n.dot(vector(e)) for e in (leg.across, leg.along))
        turned = turned_to_line(names, leg.joint, (*arms, off), sigma, "a crank has no length")
        known |= turned.known
        solved.found.append(turned.found)
    a, b, _ = (e.xreplace(known) for e in m.coefficients)
    volume = g.let("Delta", b * m.pair.s - a * m.pair.c)
    moved = [sp.Abs(q) for q in known.values() if q.is_Symbol]
    reach = g.let("reached", solved.size + sp.Add(*moved)) if moved else solved.size
    g.determined(
        sp.Abs(volume), reach, MEET, name=r"|\det A|", missed=solved.missed, size=solved.size
    )
    d.step(
        "Inverse: leg by leg",
        "Each leg is solved alone: its pin has to be on its line of the hand.  Near a parallel "
        "singularity rounded joints do not determine the hand.  The status is SINGULAR if the "
        "determinant of A is less than 2^-10 of the sum of all lengths.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        {"x": m.target},
        {"x": m.target},
        "UNREACHABLE: a pin does not reach its line of the hand.",
        [f"SINGULAR: {MEET}."],
    )
    solved.certify(m.loop, "fk", angles=(m.yaw,))


__all__ = ["Sleeve", "on_pins"]
