"""A Bennett linkage: four bodies in space, joined by four revolute joints.

Opposite bodies are alike, and the sines of the angles between the axes of a body are as the lengths
of the bodies.  There is a posture in which all joints are on one line, at right angles to all axes.
Counted from it, opposite joints turn by the same angle, and the tangents of half the angles of
neighbouring joints are proportional.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.normal_form import normal
from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import vector
from closedform.lemmas.links import polar_lemma
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import named, record_lemma
from closedform.mechanics.lengths import lengths_in_numbers
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, choose, real
from closedform.model.inverse import Degenerate, Inverse, Link
from closedform.model.pair import Pair
from closedform.model.step import Step

NAMES = "ABCD"
NEEDED = (
    "a Bennett linkage has four axes at right angles to a line that passes all four joints; "
    "opposite bodies have the same length and the same angle between their axes, and the sines of "
    "both angles are as the lengths"
)


@dataclass(frozen=True)
class Hinge:
    """A revolute joint: a point of its axis, and a unit vector along it."""

    place: Sequence[Any]
    axis: Sequence[Any]


def bennett(d: Derivation, follower: sp.Symbol, hinges: Sequence[Hinge]) -> None:
    """Derive and export a loop of four bodies in space, as found by G. T. Bennett.

    It exports ``fk``, which has a single assembly mode, ``ik``, ``jacobian`` and ``skeleton``.

    Parameters
    ----------
    d
        the derivation, with its parameters and the driven joint; the task has one coordinate
    follower
        the symbol of the task: the angle of the last hinge
    hinges
        the driven hinge on the ground, the next one on the driven body, the next one, and that of
        the follower on the ground, where all angles are zero and all four are on one line
    """
    m = _Bennett(d, follower, tuple(hinges))
    step = _state(m)
    (theta,) = d.actuated
    for name, given, found in (("fk", theta, follower), ("ik", follower, theta)):
        _solve(m, name, given, found, step)
    _rates(m)
    _draw(m)


@dataclass(frozen=True)
class _Bennett:
    """The linkage where all angles are zero."""

    d: Derivation
    follower: sp.Symbol
    hinges: tuple[Hinge, ...]

    def __post_init__(self) -> None:
        if len(self.hinges) != len(NAMES) or len(self.d.actuated) != 1:
            raise ShapeError(f"{self.d.name}: a Bennett linkage has four hinges and one motor")
        if not fits(self.places, self.given):
            raise ShapeError(f"{self.d.name}: {NEEDED}")

    @property
    def places(self) -> list[sp.Matrix]:
        return [vector(h.place) for h in self.hinges]

    @property
    def given(self) -> list[sp.Matrix]:
        return [vector(h.axis) for h in self.hinges]

    @cached_property
    def axes(self) -> list[sp.Matrix]:
        """The directions of the axes; both middle ones may point the other way."""
        return _oriented(self.places, self.given)

    @cached_property
    def ratio(self) -> tuple[sp.Expr, sp.Expr]:
        """What is as the tangents of half the angles of the follower and the driver."""
        return _ratio(self.places, self.axes)

    @property
    def size(self) -> sp.Expr:
        """The sum of all lengths."""
        lengths = [p for p in self.d.parameters if p.unit != "rad"]
        sized = [p.symbol if p.nonnegative else sp.Abs(p.symbol) for p in lengths]
        numbers = (lengths_in_numbers(e) for at in self.places for e in at)
        return sp.Add(*sized, max(numbers, default=sp.S.Zero))

    def pair(self, given: sp.Symbol, ratio: Sequence[sp.Expr]) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """A positive multiple of the cosine and the sine of the other angle, and this factor."""
        n, m = ratio
        near, far = m * sp.cos(given / 2), n * sp.sin(given / 2)
        return near**2 - far**2, 2 * near * far, near**2 + far**2

    def turned(self, k: int, angle: sp.Expr | Pair, v: sp.Matrix) -> sp.Matrix:
        """A vector that hinge ``k`` turns."""
        s, c = (angle.s, angle.c) if isinstance(angle, Pair) else (sp.sin(angle), sp.cos(angle))
        axis = self.axes[k]
        along = sp.simplify(axis.dot(v)) * axis
        return along + c * (v - along) + s * axis.cross(v).applyfunc(sp.simplify)


def _line(places: Sequence[sp.Matrix]) -> sp.Matrix | None:
    """A unit vector along the line through all places, if there is one."""
    spans = [place - places[0] for place in places[1:]]
    for span in spans:
        first = next((e for e in span if sp.simplify(e) != 0), None)
        if first is None:
            continue
        ratios = (span / first).applyfunc(sp.simplify)
        line = (ratios / sp.sqrt(square(ratios))).applyfunc(sp.simplify)
        if all(_zero(other.cross(line)) for other in spans):
            return line
    return None


def _zero(v: sp.Matrix | sp.Expr) -> bool:
    entries = list(v) if isinstance(v, sp.Matrix) else [v]
    return all(normal(e) == 0 for e in entries)


def _spans(places: Sequence[sp.Matrix], line: sp.Matrix) -> tuple[sp.Expr, sp.Expr]:
    """The lengths of the driven body and of the ground, along the line."""
    A, B, _, D = places
    return sp.simplify((B - A).dot(line)), sp.simplify((D - A).dot(line))


def _oriented(places: Sequence[sp.Matrix], axes: Sequence[sp.Matrix]) -> list[sp.Matrix]:
    """The axes, of which the middle ones may be turned round, such that the sines fit."""
    line = _line(places)
    assert line is not None
    (a, b), (A, B, C, D) = _spans(places, line), axes
    if not _zero(a * A.cross(D).dot(line) - b * A.cross(B).dot(line)):
        B = -B
    if not _zero(sp.Matrix([A.cross(B) - D.cross(C), [A.dot(B) - D.dot(C)]])):
        C = -C
    return [A, B, C, D]


def fits(places: Sequence[sp.Matrix], axes: Sequence[sp.Matrix]) -> bool:
    """Whether four hinges are those of a Bennett linkage whose joints are on one line."""
    line = _line(places)
    if line is None or not all(_zero(axis.dot(line)) for axis in axes):
        return False
    (a, b), (A, B, C, D) = _spans(places, line), _oriented(places, axes)
    return _zero(
        sp.Matrix(
            [
                *(places[1] - places[0] - places[2] + places[3]),
                *(A.cross(B) - D.cross(C)),
                A.dot(B) - D.dot(C),
                (a * A.cross(D) - b * A.cross(B)).dot(line),
                *(axis.dot(axis) - 1 for axis in axes),
            ]
        )
    )


def _ratio(places: Sequence[sp.Matrix], axes: Sequence[sp.Matrix]) -> tuple[sp.Expr, sp.Expr]:
    line = _line(places)
    assert line is not None
    (a, b), (A, B, _, D) = _spans(places, line), axes
    return sp.simplify(a + b), sp.simplify(a * A.dot(D) - b * A.dot(B))


def _state(m: _Bennett) -> Step:
    """The step on the loop, and why it closes."""
    d, (theta,) = m.d, m.d.actuated
    X, Y, rho = m.pair(theta, m.ratio)
    (A, B, C, D), psi = m.places, Pair(Y / rho, X / rho)
    ends = [
        (A + m.turned(0, theta, B - A), m.turned(0, theta, m.axes[1])),
        (D + m.turned(3, psi, C - D), m.turned(3, psi, m.axes[2])),
    ]
    (b, v), (c, w) = ends
    span, home = c - b, C - B
    angle = m.follower
    d.explain(
        {
            "N": "sum of both lengths",
            "M": "difference of both lengths, each times the cosine of the angle of the other",
        }
    )
    return d.step(
        "The loop",
        f"Where all angles are zero, all hinges are on one line, at right angles to their axes.  "
        f"The driven body and the follower have the length a, and the angle alpha between their "
        f"axes.  The coupler and the ground have the length b and the angle beta, and a*sin(beta) "
        f"is b*sin(alpha).  Then M*tan({angle}/2) = N*tan({theta}/2), where N is a + b and M is "
        f"a*cos(beta) - b*cos(alpha).  This gives the cosine and the sine of {angle}, up to a "
        f"common positive factor.  The coupler "
        f"keeps its length and the angle between its axes, and stays at right angles to both.",
        {"N": m.ratio[0], "M": m.ratio[1]},
        proves=f"At this {angle} the ends of the coupler have their distance, its axes have their "
        f"angle, and the line of both ends is at right angles to both axes.",
        equal=[
            (square(span), square(home)),
            (v.dot(w), m.axes[1].dot(m.axes[2])),
            (span.dot(v), sp.S.Zero),
            (span.dot(w), sp.S.Zero),
            (X**2 + Y**2, rho**2),
        ],
    )


def _solve(m: _Bennett, name: str, given: sp.Symbol, found: sp.Symbol, loop: Step) -> None:
    """One angle from the other."""
    d, p, forward = m.d, m.d.program(), name == "fk"
    ratio = m.ratio if forward else m.ratio[::-1]
    size = p.let("size", m.size)
    n, k = (p.let(e, x) for e, x in zip("NM", ratio, strict=True))
    X, Y, _ = m.pair(given, (n, k))
    x, y = p.let("x", X), p.let("y", Y)
    start = len(p.body)
    reach = p.let("reach", sp.sqrt(x**2 + y**2), nonnegative=True)
    meaning = "both bodies on the ground turn about the same axis"
    free = p.vanishes("free", reach, size**2, meaning, (found,), squares=True)
    pair = Pair(choose(free, 0, y / reach), choose(free, 1, x / reach))
    rho = real("rho")
    lemma = polar_lemma({found: pair.angle, rho: reach}, (x, y))
    case = Degenerate((free,), {x: 0, y: 0}, found, meaning)
    body = tuple(p.body[start:])
    link = Link((found, rho), lemma.equations, {}, lemma, body, degenerate=(case,))
    d.step(
        "Forward: the follower" if forward else "Inverse: the driver",
        f"The cosine and the sine of {found} are known up to a positive factor.",
        {},
        uses=[loop],
        solves={name: ()},
    )
    if forward:
        d.assembly_modes = SINGLE.labels
    else:
        d.branches = SINGLE.labels
    d.function(
        name,
        f"{found} in the only assembly mode." if forward else "The driven joint.",
        {"q": d.actuated} if forward else {"x": (given,)},
        {"p" if forward else "q": [pair.angle]},
        program=p,
        branches=SINGLE,
        result="Positions" if forward else "Solutions",
        notes=(f"SINGULAR: {meaning}; one angle is used.",),
    )
    record_lemma(d, name, link)
    X, Y, _ = m.pair(given, ratio)
    d.inverses.append(
        Inverse(
            name,
            (found,),
            (sp.S.Zero, sp.S.Zero),
            (rho * sp.cos(found) - X, rho * sp.sin(found) - Y),
            images="" if forward else "fk",
            links=(link,),
            passive=(rho,),
            angles=() if forward else (given,),
        )
    )


def _rates(m: _Bennett) -> None:
    """The rate of the follower per rate of the driver."""
    d, (theta,) = m.d, m.d.actuated
    (n, k), (X, Y, rho) = m.ratio, m.pair(theta, m.ratio)
    J = n * k / rho
    d.step(
        "Velocity",
        f"The derivative of M*tan({m.follower}/2) = N*tan({theta}/2) gives the rate of "
        f"{m.follower}.  Its sign is that of N*M, so the linkage has no singular posture.",
        {"J": J},
        proves=f"The angle of the cosine and the sine of {m.follower} has this rate.",
        equal=[((X * Y.diff(theta) - Y * X.diff(theta)), J * rho**2)],
    )
    d.function(
        "jacobian",
        "Derivative of the follower with respect to the driver.",
        {"q": d.actuated},
        {"J": [[J]]},
        branches=SINGLE,
        equation="J",
    )


def _draw(m: _Bennett) -> None:
    d, p, (theta,) = m.d, m.d.program(), m.d.actuated
    (A, B, C, D), ratio = m.places, m.ratio
    n, k = (p.let(e, x) for e, x in zip("NM", ratio, strict=True))
    X, Y, reach = m.pair(theta, (n, k))
    reach = p.let("reach", reach, nonnegative=True)
    psi = Pair(p.let("s_psi", Y / reach), p.let("c_psi", X / reach))
    ends = {"B": A + m.turned(0, theta, B - A), "C": D + m.turned(3, psi, C - D)}
    lengths = [sp.sqrt(sp.factor(square(e))) for e in (B - A, C - B)]
    skeleton(
        d,
        {"A": A, "D": D, "B": named(p, "b", ends["B"]), "C": named(p, "c", ends["C"])},
        links={
            "ground": ("A", "D"),
            "crank": ("A", "B"),
            "coupler": ("B", "C"),
            "follower": ("D", "C"),
        },
        joints={theta: ("A",), m.follower: ("D",)},
        hand="C",
        ground=("A", "D"),
        lengths={
            ("A", "B"): lengths[0],
            ("D", "C"): lengths[0],
            ("B", "C"): lengths[1],
            ("A", "D"): lengths[1],
        },
        program=p,
        branches=SINGLE,
    )


__all__ = ["Hinge", "bennett", "fits"]
