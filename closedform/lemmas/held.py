"""What keeps a hand from turning: legs that are parallelograms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.hand import Hand, square
from closedform.lemmas.legs import Crank, Leg, cross_in_plane, vector
from closedform.lemmas.parallelogram import Parallelogram, parallelogram
from closedform.model.alike import INDEX
from closedform.model.functions import real
from closedform.model.step import Step

LEFT_OUT = (
    "Left out: postures with a crossed parallelogram (antiparallelogram) or a twisted one, in "
    "which the hand is turned."
)


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

    def around(self, middle: str, at: sp.Matrix) -> dict[str, sp.Matrix]:
        """The ends of the bar around a point, which is at a place."""
        reach = self.given.half * self.given.direction
        return dict(zip(self.ends(middle), (at + reach, at - reach), strict=True))


def bars_of(k: int, leg: Leg, far: str) -> list[Bars]:
    """The parallelograms of leg ``k``, whose far end is a point: of its crank, of its rod."""
    crank, rod = getattr(leg, "length", None), leg.rod
    found = []
    if isinstance(crank, Parallelogram):
        found.append(Bars(crank, f"A{k}", f"B{k}", "cd"))
    if isinstance(rod, Parallelogram):
        near = f"B{k}" if hasattr(leg, "joint") else f"A{k}"
        found.append(Bars(rod, near, far, "ab"))
    return found


def check_held(m: Hand) -> None:
    """Refuse a hand that could turn, and a parallelogram that would not keep it from turning."""
    name, n = m.d.name, len(m.hand)
    held = [leg for leg in m.legs if isinstance(leg.rod, Parallelogram)]
    for leg in m.legs:
        for bars in bars_of(1, leg, "P"):
            if len(bars.given.bar) != n or sp.simplify(square(bars.given.direction) - 1) != 0:
                raise ShapeError(
                    f"{name}: the bar of a parallelogram is a unit vector with {n} entries"
                )
    for leg in held:
        if not isinstance(leg, Crank) or isinstance(leg.length, Parallelogram):
            continue
        turned = [leg.rod.direction.dot(vector(v)) for v in (leg.along, leg.across)]
        if n == 2 or any(sp.simplify(e) != 0 for e in turned):
            raise ShapeError(
                f"{name}: the crank of {leg.joint} turns the bar on it; "
                f"{'' if n == 2 else 'the bar has to be along its axis, or '}"
                f"the crank has to be a Parallelogram too"
            )
    places = [m.place(leg) for leg in m.legs]
    if m.rails or all(place == places[0] for place in places):
        return
    if len(held) < (1 if n == 2 else 3):
        raise ShapeError(
            f"{name}: the legs end in different points of the hand, and nothing keeps it from "
            f"turning; {'one rod has' if n == 2 else 'all three rods have'} to be a Parallelogram, "
            f"or take platform, for a hand that turns"
        )


def state_held(m: Hand, loop: Step) -> None:
    """The step on what keeps the hand from turning, if there are parallelograms."""
    if m.held:
        (_in_plane if len(m.hand) == 2 else _in_space)(m, loop)


def constraint(m: Hand, rods: Sequence[sp.Matrix]) -> list[sp.Expr]:
    """What vanishes where the hand can turn, from the vectors along the rods."""
    spans = dict(zip((k for k, _ in m.numbered), rods, strict=True))
    if len(m.hand) == 3:
        normals = [leg.rod.direction.cross(spans[k]) for k, leg in m.held]
        return [sp.Matrix.hstack(*normals).det()] if len(normals) == 3 else []
    found = []
    for k, leg in m.held:
        factor = cross_in_plane(leg.rod.direction, spans[k])
        if isinstance(leg, Crank):
            factor *= cross_in_plane(leg.length.direction, leg.end() - leg.base)
        found.append(factor)
    return found


def _in_space(m: Hand, loop: Step) -> None:
    u, v, r, w = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in ("u", "v", "r", "omega"))
    h, difference = real("h"), v - u
    rods = r + h * difference, r - h * difference
    all_three = (
        "  Each parallelogram takes one freedom of turning from the hand: the rate omega with "
        "which it turns is at right angles to the normal n of the parallelogram.  So the hand "
        "cannot turn, unless the three normals are in one plane (constraint singularity)."
    )
    bars = m.as_shown([(k, leg.rod.direction) for k, leg in m.held])
    one = INDEX if m.alike else "k"
    m.d.explain({rf"\mathbf u_{k}": "direction of the bars of a leg" for k, _ in bars})
    m.d.explain({rf"\mathbf n_{one}": f"normal of the parallelogram of leg {one}"})
    m.d.step(
        "The parallelograms",
        "The rod of a leg is a parallelogram: two rods of length l between two bars of length "
        "2*h.  The bar at the near end has the direction u and does not turn.  The bar on the hand "
        "has the direction v, and r leads from the middle of the first to the middle of the "
        "second.  The two rods are r + h*(v - u) and r - h*(v - u), and both have to be as long as "
        "l.  In a parallelogram v = u, and r is as long as a rod, whatever the width.  The other "
        "solutions are left out: the crossed one (antiparallelogram) and twisted ones."
        f"{all_three * (len(m.held) == 3)}",
        {
            r"\mathbf r\cdot(\mathbf v - \mathbf u)": sp.S.Zero,
            r"|\mathbf r|^2 + h^2\,|\mathbf v - \mathbf u|^2": "l^2",
            **{rf"\mathbf u_{k}": u for k, u in bars},
            rf"\mathbf n_{one}": rf"\mathbf u_{one}\times\mathbf r_{one}",
            rf"\boldsymbol\omega\cdot\mathbf n_{one}": sp.S.Zero,
        },
        proves="The rods fit if and only if the first two equations hold.  At v = u, the "
        "derivative of the first equation gives the last one.  The bars are unit vectors, "
        "and that on a crank is along its axis.",
        equal=[
            (square(rods[0]) - square(rods[1]), 4 * h * r.dot(difference)),
            (square(rods[0]) + square(rods[1]), 2 * (square(r) + h**2 * square(difference))),
            (r.dot(w.cross(u)), w.dot(u.cross(r))),
            *((square(leg.rod.direction), sp.S.One) for _, leg in m.held),
            *(
                (leg.rod.direction.dot(vector(v)), sp.S.Zero)
                for _, leg in m.held
                if isinstance(leg, Crank) and not isinstance(leg.length, Parallelogram)
                for v in (leg.along, leg.across)
            ),
        ],
        uses=[loop],
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


__all__ = ["LEFT_OUT", "Bars", "bars_of", "check_held", "constraint", "state_held"]
