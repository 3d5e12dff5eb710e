"""What keeps a hand from turning: parallelograms, and universal joints with parallel axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.extended import Extended
from closedform.lemmas.legs import Crank, Leg, cross_in_plane, vector
from closedform.lemmas.parallelogram import Parallelogram, Prism, parallelogram
from closedform.lemmas.universal import Universal
from closedform.loops.hand import Hand, square
from closedform.loops.letters import letters
from closedform.loops.modes import Exported
from closedform.model.alike import INDEX
from closedform.model.derivation import Derivation
from closedform.model.functions import real
from closedform.model.step import Step

LEFT_OUT = (
    "Left out: postures with a crossed parallelogram (antiparallelogram) or a twisted one, in "
    "which the hand is turned."
)
TURNED = "Left out: postures in which the hand is turned and the universal joints fit all the same."


@dataclass(frozen=True)
class Bars:
    """A pair of bars of a leg: their parallelogram, and the points that they connect."""

    given: Parallelogram
    near: str
    far: str
    names: str
    """Two letters, which the ends of the bars have in their names."""

    def ends(self, middle: str) -> tuple[str, str]:
        """The names of the ends of the bar around a point."""
        at = middle if middle != "P" else f"C{self.near[1:]}"
        return f"{at}{self.names[0]}", f"{at}{self.names[1]}"

    def third(self, middle: str) -> str:
        """The name of the end of a third rod beside a point; empty if there is none."""
        return f"{self.ends(middle)[0][:-1]}e" if isinstance(self.given, Prism) else ""

    def around(self, middle: str, at: sp.Matrix) -> dict[str, sp.Matrix]:
        """The ends of the bar around a point, which is at a place, and that of a third rod."""
        reach = self.given.half * self.given.direction
        found = dict(zip(self.ends(middle), (at + reach, at - reach), strict=True))
        if isinstance(self.given, Prism):
            found[self.third(middle)] = at + self.given.aside
        return found


def bars_of(k: int, leg: Leg, far: str) -> list[Bars]:
    """The parallelograms of leg ``k``, whose far end is a point: of its crank, of its rod."""
    crank, rod = getattr(leg, "length", None), leg.rod
    found = []
    if isinstance(crank, Parallelogram):
        found.append(Bars(crank, f"A{k}", f"B{k}", "cd"))
    if isinstance(rod, Parallelogram):
        near = f"B{k}" if hasattr(leg, "joint") else f"A{k}"
        near, far = (f"D{k}", f"E{k}") if isinstance(rod, Extended) else (near, far)
        found.append(Bars(rod, near, far, "ab"))
    return found


def check_held(m: Hand) -> None:
    """Refuse a hand that could turn, and a rod that would not keep it from turning."""
    m.check_holds()
    name, n = m.d.name, len(m.hand)
    held = [leg for _, leg in m.held]
    check_directions(name, n, m.legs)
    prism = any(isinstance(leg.rod, Prism) for leg in held)
    if len(held) == 3 and not prism and not any(e for leg in held for e in _across(held[0], leg)):
        raise ShapeError(
            f"{name}: the bars or axes of all three legs have the same direction, about which the "
            f"hand can always turn"
        )
    places = [m.place(leg) for leg in m.legs]
    if m.flat or all(place == places[0] for place in places):
        return
    kept = sum(1 + isinstance(leg.rod, Prism) for leg in held)
    if kept > 3:
        raise ShapeError(
            f"{name}: the rods keep the hand from turning in {kept} ways, of which {kept - 3} "
            f"{'is' if kept == 4 else 'are'} redundant; a Prism takes two, and a Parallelogram one"
        )
    if kept < (1 if n == 2 else 3):
        rods = "one rod has" if n == 2 else "all three rods have"
        raise ShapeError(
            f"{name}: the legs end in different points of the hand, and nothing keeps it from "
            f"turning; {rods} to be a Parallelogram{' or Universal' * (n == 3)}, or take platform, "
            f"for a hand that turns"
        )


def check_directions(name: str, n: int, legs: Sequence[Leg]) -> None:
    """Refuse bars and axes that are not unit vectors, or that a crank turns."""
    if any(isinstance(leg.rod, Extended) for leg in legs):
        raise ShapeError(
            f"{name}: a parallelogram between two links holds a hand with ParallelAxes, in guided"
        )
    for bars in (bars for leg in legs for bars in bars_of(1, leg, "P")):
        if len(bars.given.bar) != n or sp.simplify(square(bars.given.direction) - 1) != 0:
            raise ShapeError(
                f"{name}: the bar of a parallelogram must be a unit vector with {n} entries"
            )
    for prism in (leg.rod for leg in legs if isinstance(leg.rod, Prism)):
        if n != 3 or len(prism.apex) != n or not any(_aside(prism)):
            raise ShapeError(
                f"{name}: the apex of a prism must be a vector in space that is not along its bar"
            )
    for axis in (leg.rod.direction for leg in legs if isinstance(leg.rod, Universal)):
        if not len(axis) == n == 3 or sp.simplify(square(axis) - 1) != 0:
            raise ShapeError(
                f"{name}: the axis of a rod with universal joints must be a unit vector in space"
            )
    for leg in legs:
        if isinstance(leg.rod, Parallelogram | Universal):
            _check_on_crank(name, n, leg)


def _check_on_crank(name: str, n: int, leg: Leg) -> None:
    """Refuse a bar or an axis that a crank turns."""
    if not isinstance(leg, Crank) or isinstance(leg.length, Parallelogram):
        return
    turned = [leg.rod.direction.dot(vector(v)) for v in (leg.along, leg.across)]
    if isinstance(leg.rod, Prism):
        raise ShapeError(
            f"{name}: the crank of {leg.joint} turns the triangle on it; the crank has to be a "
            f"Parallelogram too, or one of three rods has to go"
        )
    if n == 2 or any(sp.simplify(e) != 0 for e in turned):
        what = "axis" if isinstance(leg.rod, Universal) else "bar"
        along = "" if n == 2 else f"the {what} has to be along its axis, or "
        raise ShapeError(
            f"{name}: the crank of {leg.joint} turns the {what} on it; {along}"
            f"the crank has to be a Parallelogram too"
        )


def _across(one: Leg, other: Leg) -> sp.Matrix:
    """A vector that vanishes if the bars or axes of two legs are parallel."""
    return one.rod.direction.cross(other.rod.direction).applyfunc(sp.simplify)


def _aside(prism: Prism) -> sp.Matrix:
    """A vector that vanishes if the third rod is in the plane of the two others."""
    return prism.direction.cross(prism.aside).applyfunc(sp.simplify)


def _with(m: Hand, kind: type) -> list[tuple[int, Leg]]:
    """The legs whose rods are of a kind."""
    return [(k, leg) for k, leg in m.held if isinstance(leg.rod, kind)]


def state_held(m: Hand, loop: Step) -> None:
    """The steps on what keeps the hand from turning."""
    if _with(m, Parallelogram):
        (_in_plane if len(m.hand) == 2 else _in_space)(m, loop)
    if _with(m, Universal):
        _by_axes(m, loop)
    if m.planes:
        parallel_axes(m.d, [leg.normal for leg in m.planes], loop)


def left_out(m: Hand) -> tuple[str, ...]:
    """Notes on the postures that are left out, in which the hand is turned."""
    notes = (LEFT_OUT, Parallelogram), (TURNED, Universal)
    return tuple(note for note, kind in notes if _with(m, kind))


def constraint(m: Hand, rods: Sequence[sp.Matrix]) -> list[Exported]:
    """The function that vanishes where the hand can turn, from the vectors along the rods.

    There is none if the hand is a point, or if legs hold it in space and it is not known how.
    """
    factors = _constraint(m, rods)
    if not factors:
        return []
    crossed = "unit vector along the bars times the vector along the rods"
    if not _with(m, Universal):
        what, how = (
            "parallelograms",
            f"The determinant of the normals of the parallelograms (a {crossed})"
            + ", of a third rod also with the unit vector from their middle to it"
            * bool(_with(m, Prism))
            + ".",
        )
    else:
        what = "legs"
        how = (
            "The determinant of the directions about which the legs do not let the hand turn: the "
            "vector along a rod without its part along the axis"
            + f"; of a parallelogram, the {crossed}" * bool(_with(m, Parallelogram))
            + "."
        )
    if len(m.hand) == 2:
        how = "One factor for each leg with a parallelogram; the hand can turn if all vanish."
    summary = f"The factors that vanish where the {what} do not keep the hand from turning."
    return [("constraint", summary, {"factors": factors}, (how,))]


def _constraint(m: Hand, rods: Sequence[sp.Matrix]) -> list[sp.Expr]:
    spans = dict(zip((k for k, _ in m.numbered), rods, strict=True))
    if len(m.hand) == 3:
        couples = [e for k, leg in m.held for e in leg.rod.couples(spans[k])]
        return [sp.Matrix.hstack(*couples).det()] if len(couples) == 3 else []
    found = []
    for k, leg in m.held:
        factor = cross_in_plane(leg.rod.direction, spans[k])
        if isinstance(leg, Crank):
            factor *= cross_in_plane(leg.length.direction, leg.end() - leg.base)
        found.append(factor)
    return found


def _in_space(m: Hand, loop: Step) -> None:
    (normal,) = letters(m.d, "n")
    if _with(m, Prism):
        state_parallelograms(_with_prism(m, loop))
        return
    all_three = (
        "  Each parallelogram takes one freedom of turning from the hand: the rate omega with "
        f"which it turns is at right angles to the normal {normal} of the parallelogram.  So the "
        "hand cannot turn, unless the three normals are in one plane (constraint singularity)."
    )
    state_parallelograms(_held_by(m, loop, Parallelogram, normal, all_three))


@dataclass(frozen=True)
class Held:
    """Legs that keep a hand from turning, as a step tells of them."""

    d: Derivation
    legs: Sequence[tuple[int, Leg]]
    loop: Step
    """The step on the loop."""
    shown: Sequence[tuple[int | str, sp.Matrix]]
    """The directions of their bars or outer axes as they are shown."""
    then: str
    """What follows for the hand: a sentence."""
    one: str = "k"
    """How any of the legs is called."""
    vanishing: Mapping[str, Any] = field(default_factory=dict)
    """What vanishes where the hand can turn, as an equation."""


def _held_by(m: Hand, loop: Step, kind: type, letter: str, all_three: str) -> Held:
    """The legs of a hand with rods of a kind, and what three of them do."""
    held = _with(m, kind)
    shown = m.as_shown([(k, leg.rod.direction) for k, leg in held])
    return Held(
        d=m.d,
        legs=held,
        loop=loop,
        shown=shown,
        then=all_three * (len(held) == 3),
        one=INDEX if m.alike else "k",
        vanishing=_determinant(m, letter),
    )


def _with_prism(m: Hand, loop: Step) -> Held:
    """The same of legs of which one has three rods, and another one two."""
    normal, aside, along, couple = letters(m.d, "nsrm")
    held = _with(m, Parallelogram)
    prisms = [(k, leg.rod) for k, leg in held if isinstance(leg.rod, Prism)]
    columns = []
    for k, leg in held:
        columns.append(rf"\mathbf {normal}_{k}")
        columns += [rf"\mathbf {couple}_{k}"] * isinstance(leg.rod, Prism)
    legs = " and ".join(str(k) for k, _ in prisms)
    m.d.explain({rf"\mathbf {aside}_{k}": "from the middle to the third rod" for k, _ in prisms})
    m.d.explain({rf"\mathbf {couple}_k": "what a third rod keeps the hand from turning about"})
    m.d.explain({r"\Gamma": "vanishes where the hand can turn"})
    return Held(
        d=m.d,
        legs=held,
        loop=loop,
        shown=[(k, leg.rod.direction) for k, leg in held],
        then=f"  Leg {legs} has a third rod of this length, which is at {aside} from the middle on "
        f"both bodies.  While the hand turns with the rate omega, this rod keeps its length if "
        f"omega is at right angles to {couple} as well.  So the hand cannot turn, unless the "
        f"normals {normal} and {couple} are in one plane (constraint singularity).",
        vanishing={
            **{rf"\mathbf {aside}_{k}": prism.aside for k, prism in prisms},
            rf"\mathbf {couple}_k": rf"\mathbf {aside}_k\times\mathbf {along}_k",
            rf"\boldsymbol\omega\cdot\mathbf {couple}_k": sp.S.Zero,
            r"\Gamma": rf"\det\begin{{bmatrix}} {' & '.join(columns)} \end{{bmatrix}}",
        },
    )


def state_parallelograms(by: Held) -> None:
    """The step on parallelograms in space."""
    d, held, one = by.d, by.legs, by.one
    any_vectors = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in ("u", "v", "r", "omega"))
    first, second, along, rate = any_vectors
    half, difference = real("h"), second - first
    rods = along + half * difference, along - half * difference
    u, v, r, n, h, letter = letters(d, "uvrnhl")
    of_rods = {sp.sympify(leg.rod, strict=True) for _, leg in held}
    same = next(iter(of_rods)) if len(of_rods) == 1 else sp.S.Zero
    l, squared = (same, same**2) if same.is_Symbol else (letter, f"{letter}^2")
    d.explain({rf"\mathbf {u}_{k}": "direction of the bars of a leg" for k, _ in by.shown})
    d.explain({rf"\mathbf {n}_{one}": f"normal of the parallelogram of leg {one}"})
    d.step(
        "The parallelograms",
        f"The rod of a leg is a parallelogram: two rods of length {l} between two bars of length "
        f"2*{h}.  The bar at the near end has the direction {u} and does not turn.  The bar on the "
        f"hand has the direction {v}, and {r} leads from the middle of the first to the middle of "
        f"the second.  The two rods are {r} + {h}*({v} - {u}) and {r} - {h}*({v} - {u}), and both "
        f"must have this length.  In a parallelogram {v} = {u}, and {r} is as long as a rod, "
        f"whatever the width; that of leg {one} is {r}_{one}.  The other solutions are left "
        f"out: the crossed one (antiparallelogram) and twisted ones.{by.then}",
        {
            rf"\mathbf {r}\cdot(\mathbf {v} - \mathbf {u})": sp.S.Zero,
            rf"|\mathbf {r}|^2 + {h}^2\,|\mathbf {v} - \mathbf {u}|^2": squared,
            **{rf"\mathbf {u}_{k}": direction for k, direction in by.shown},
            rf"\mathbf {n}_{one}": rf"\mathbf {u}_{one}\times\mathbf {r}_{one}",
            rf"\boldsymbol\omega\cdot\mathbf {n}_{one}": sp.S.Zero,
            **by.vanishing,
        },
        proves=f"The rods fit if and only if the first two equations hold.  At {v} = {u}, the "
        "derivative of the first equation gives the last one.  The bars are unit vectors, "
        "and that on a crank is along its axis.",
        equal=[
            (square(rods[0]) - square(rods[1]), 4 * half * along.dot(difference)),
            (
                square(rods[0]) + square(rods[1]),
                2 * (square(along) + half**2 * square(difference)),
            ),
            (along.dot(rate.cross(first)), rate.dot(first.cross(along))),
            *_unit_and_still(held),
        ],
        uses=[by.loop],
    )


def _determinant(m: Hand, letter: str) -> dict[str, str]:
    """What vanishes where the hand can turn, if all legs keep it from turning in the same way."""
    kinds = {type(leg.rod) for _, leg in m.held}
    if len(m.held) != 3 or len(kinds) > 1:
        return {}
    m.d.explain({r"\Gamma": "vanishes where the hand can turn"})
    columns = " & ".join(rf"\mathbf {letter}_{k}" for k, _ in m.held)
    return {r"\Gamma": rf"\det\begin{{bmatrix}} {columns} \end{{bmatrix}}"}


def _unit_and_still(held: Sequence[tuple[int, Leg]]) -> list[tuple[sp.Expr, sp.Expr]]:
    """That bars or axes are unit vectors, and along the axis of a crank that carries them."""
    return [
        *((square(leg.rod.direction), sp.S.One) for _, leg in held),
        *(
            (leg.rod.direction.dot(vector(v)), sp.S.Zero)
            for _, leg in held
            if isinstance(leg, Crank) and not isinstance(leg.length, Parallelogram)
            for v in (leg.along, leg.across)
        ),
    ]


def parallel_axes(d: Derivation, normals: Sequence[sp.Matrix], loop: Step) -> None:
    """The step on legs each of which turns the hand about one direction alone."""
    a, b = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in "ab")
    across = a.cross(b)
    one, two = letters(d, "es")
    cross = rf"\mathbf {one}\times\mathbf {two}"
    d.explain({rf"\mathbf {one}": "direction of the axes of a leg", "R": "rotation of the hand"})
    d.explain({rf"\mathbf {two}": "direction of the axes of another leg"})
    d.step(
        "The axes",
        "All joints of a leg that turn have the same direction, so the leg turns the hand about it "
        f"alone: its rotation R keeps this direction.  It keeps those of two legs, {one} and "
        f"{two}, and so their cross product too.  The three vectors are a basis, because {one} and "
        f"{two} are not parallel.  So the hand does not turn at any posture.",
        {
            rf"R\,\mathbf {one}": rf"\mathbf {one}",
            rf"R\,\mathbf {two}": rf"\mathbf {two}",
            rf"R\,({cross})": cross,
            rf"\det[\mathbf {one}\ \ \mathbf {two}\ \ {cross}]": rf"|{cross}|^2",
        },
        proves="The determinant of the three vectors is the squared length of the cross product, "
        "and the directions of the axes are unit vectors.",
        equal=[
            (sp.Matrix.hstack(a, b, across).det(), square(across)),
            *((square(normal), sp.S.One) for normal in normals),
        ],
        uses=[loop],
    )


def _by_axes(m: Hand, loop: Step) -> None:
    """The step on universal joints with parallel axes."""
    (part,) = letters(m.d, "m")
    all_three = (
        "  Each leg takes one freedom of turning from the hand: the rate omega with which it turns "
        f"is at right angles to {part}, the part of the rod across the outer axes.  So the hand "
        f"cannot turn, unless the three vectors {part} are in one plane (constraint singularity)."
    )
    state_universals(_held_by(m, loop, Universal, part, all_three))


def state_universals(by: Held) -> None:
    """The step on universal joints with parallel axes."""
    d, held, one = by.d, by.legs, by.one
    first, along, rate = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in ("u", "r", "omega"))
    u, v, r, part = letters(d, "uvrm")
    d.explain({rf"\mathbf {u}_{k}": "direction of the outer axes of a leg" for k, _ in by.shown})
    d.explain({rf"\mathbf {part}_{one}": f"part of the rod of leg {one} across its outer axes"})
    d.step(
        "The universal joints",
        "A rod has universal joints at both ends.  The axis that is fixed to what moves the rod "
        f"has the direction {u} and does not turn; that on the hand has the direction {v}.  The "
        "two axes that are fixed to the rod are parallel, and at right angles to the rod, to "
        f"{u} and to {v}.  So {u}, {v} and the vector {r} along the rod are in one plane.  They "
        f"are if {v} = {u}, wherever the hand is.  The other solutions, in which the hand is "
        f"turned, are left out.{by.then}",
        {
            rf"(\mathbf {u}\times\mathbf {r})\cdot\mathbf {v}": sp.S.Zero,
            **{rf"\mathbf {u}_{k}": e for k, e in by.shown},
            rf"\mathbf {part}_{one}": rf"\mathbf {r}_{one} - "
            rf"(\mathbf {u}_{one}\cdot\mathbf {r}_{one})\,\mathbf {u}_{one}",
            rf"\boldsymbol\omega\cdot\mathbf {part}_{one}": sp.S.Zero,
            **by.vanishing,
        },
        proves=f"At {v} = {u} the first equation holds for any {r}, and its derivative, while the "
        "hand turns and moves in any way, is that of the last one.  The axes are unit vectors, and "
        "one on a crank is along the axis of the crank.",
        equal=[
            (first.cross(along).dot(first), sp.S.Zero),
            (
                first.cross(along).dot(rate.cross(first)),
                rate.dot(first.dot(along) * first - square(first) * along),
            ),
            *_unit_and_still(held),
        ],
        uses=[by.loop],
    )


def _in_plane(m: Hand, loop: Step) -> None:
    l, a = (real(n, positive=True) for n in ("l", "a"))
    theta, gamma, phi, beta, sigma = (real(n) for n in ("theta", "gamma", "phi", "beta", "sigma"))
    linkage = parallelogram((l, a), (theta, gamma), (phi, beta), sigma)
    closed = sp.Matrix(linkage.equations).subs(linkage.solution)
    for name, symbol, meaning in (
        ("a", "a", "length of the bars of a parallelogram"),
        ("gamma", r"\gamma", "angle of the bar that stands still"),
        ("phi", r"\varphi", "turn of the bar on the hand"),
        ("beta", r"\beta", "angle of the second rod of a parallelogram"),
        ("theta", r"\theta", "angle of the first rod of a parallelogram"),
    ):
        m.d.write(name, symbol, meaning)
    m.d.step(
        "The parallelograms",
        "The rod of a leg is a parallelogram: two rods of length l, at the angles theta and beta,"
        " between two bars of length a.  The bar at the near end, at the angle gamma, does not "
        "turn; if a crank carries it, the crank is a parallelogram too.  The bar on the hand is "
        "turned by phi.  The loop equations have two solutions.  In the parallelogram phi = 0, "
        "and the rods are parallel: the hand does not turn, whatever the width.  The crossed one,"
        " an antiparallelogram, is left out.  Both are the same where rods and bars are in line."
        "  The hand can turn only if that is so in each leg with a parallelogram, in its rod or "
        "in its crank (constraint singularity).",
        {
            "0": sp.Matrix(linkage.equations),
            r"(\varphi, \beta)_{\text{parallelogram}}": (sp.S.Zero, theta),
            r"\varphi_{\text{crossed}}": linkage[phi].subs(sigma, -1),
        },
        proves="Both solutions close the linkage, and the bars are unit vectors.",
        equal=[
            *((closed.subs(sigma, sign), sp.zeros(2, 1)) for sign in (1, -1)),
            (linkage[phi].subs(sigma, 1), sp.S.Zero),
            *((square(leg.rod.direction), sp.S.One) for _, leg in m.held),
        ],
        uses=[loop],
    )


__all__ = [
    "LEFT_OUT",
    "TURNED",
    "Bars",
    "Held",
    "bars_of",
    "check_directions",
    "check_held",
    "constraint",
    "left_out",
    "parallel_axes",
    "state_held",
    "state_parallelograms",
    "state_universals",
]
