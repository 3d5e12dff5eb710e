"""The slides of an RCCC linkage, whose axes turn as those of a spherical four-bar linkage do.

The rotations of a loop depend on the directions of its axes alone.  Once they are known, the slides
along three cylindrical joints are the solution of three linear equations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, vector
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import named, named_in
from closedform.loops.letters import letters
from closedform.loops.modes import export
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, real
from closedform.model.names import listed

SPACE = 3
NEEDED = (
    "slides need cranks in space whose axes meet in the origin and whose ends are at the distance "
    "1 from it, on the middle axes of the loop"
)


@dataclass(frozen=True)
class Screws:
    """The places of the axes of an RCCC linkage, in a posture in which all joints are zero.

    The linkage is closed in this posture.  ``driver`` is a point of the axis of the driven joint,
    and ``follower`` one of the axis of the joint that is the task; ``first`` and ``second`` are
    points of the middle axes, on the driver and on the follower.  ``names`` are those of the slides
    along the two middle axes and along the axis of the follower.
    """

    names: Sequence[str]
    driver: Sequence[Any]
    first: Sequence[Any]
    second: Sequence[Any]
    follower: Sequence[Any]


@dataclass(frozen=True)
class _Carried:
    """A vector that two directions carry along: its parts along them and across both."""

    parts: sp.Matrix

    @classmethod
    def of(cls, place: sp.Matrix, u: sp.Matrix, v: sp.Matrix) -> _Carried:
        basis = sp.Matrix.hstack(u, v, u.cross(v))
        return cls((basis.inv() * place).applyfunc(sp.simplify))

    def at(self, u: sp.Matrix, v: sp.Matrix) -> sp.Matrix:
        """The vector, where both directions have come to."""
        a, b, c = self.parts
        return a * u + b * v + c * u.cross(v)


def check_screws(d: Derivation, legs: Sequence[Any]) -> None:
    """Refuse legs whose ends are not unit vectors along the middle axes."""
    for leg in legs:
        fits = isinstance(leg, Crank) and len(leg.base) == SPACE
        if not fits or sp.simplify(square(leg.end()) - 1) != 0 or _across(leg).is_zero_matrix:
            raise ShapeError(f"{d.name}: {NEEDED}")


def _across(leg: Crank) -> sp.Matrix:
    """A vector that vanishes if the crank does not move its end."""
    return _axis(leg).cross(leg.end()).applyfunc(sp.simplify)


def _axis(leg: Crank) -> sp.Matrix:
    return vector(leg.along).cross(vector(leg.across)).applyfunc(sp.simplify)


def export_slides(
    d: Derivation,
    screws: Screws,
    legs: tuple[Crank, Crank],
    at: tuple[Program, Branches, sp.Matrix],
) -> None:
    """Export ``slides``, how far the linkage slides along its three cylindrical joints.

    Parameters
    ----------
    d
        the derivation of the spherical four-bar linkage, whose step on the loop is ``d.loop``
    screws
        the places of the axes
    legs
        both cranks, whose ends are on the middle axes
    at
        the program of ``fk`` with its modes, and the end of the follower in its names
    """
    driver, follower = legs
    program, modes, reached = at
    base, first, second, far = (
        vector(e) for e in (screws.driver, screws.first, screws.second, screws.follower)
    )
    zero = dict.fromkeys((driver.joint, follower.joint), sp.S.Zero)
    u, w = _axis(driver), _axis(follower)
    v_0, t_0 = (leg.end().subs(zero) for leg in legs)
    arms = (
        _Carried.of(first - base, u, v_0),
        _Carried.of(second - first, v_0, t_0),
        _Carried.of(second - far, w, t_0),
    )

    def gap(v: sp.Matrix, t: sp.Matrix) -> sp.Matrix:
        """What the slides have to close, for the directions of the middle axes."""
        return far + arms[2].at(w, t) - base - arms[0].at(u, v) - arms[1].at(v, t)

    def slid(v: sp.Matrix, t: sp.Matrix, c: sp.Matrix, volume: sp.Expr) -> list[sp.Expr]:
        return [
            c.dot(t.cross(w)) / volume,
            v.dot(c.cross(w)) / volume,
            -v.dot(t.cross(c)) / volume,
        ]

    _state(d, screws, legs, arms, gap)
    p = Program(list(program.body), program.taken)
    v, t = named(p, "v", driver.end()), named(p, "t", reached)
    c = named(p, "c", gap(v, t))
    volume = named_in(p, "D", v.dot(t.cross(w)))
    export(
        d,
        p,
        modes,
        [
            (
                "slides",
                f"The slides in the joints {listed(screws.names)}: along both middle axes and "
                "along that of the follower.",
                {"s": slid(v, t, c, volume)},
                ("Not finite at a parallel singularity.",),
            )
        ],
        {"s": "s_1"},
    )


def _state(
    d: Derivation,
    screws: Screws,
    legs: tuple[Crank, Crank],
    arms: tuple[_Carried, _Carried, _Carried],
    gap: Any,
) -> None:
    """The step on the slides."""
    driver, follower = legs
    u, w = _axis(driver), _axis(follower)
    v, t, c, n = (sp.Matrix([real(f"{e}_{i}") for i in "xyz"]) for e in "vtcw")
    volume = v.dot(t.cross(n))
    s = c.dot(t.cross(n)), v.dot(c.cross(n)), -v.dot(t.cross(c))
    zero = {driver.joint: 0, follower.joint: 0}
    turned = []
    for leg, axis, arm in ((driver, u, arms[0]), (follower, w, arms[2])):
        start = arm.at(axis, leg.end().subs(zero))
        q = leg.joint
        spun = sp.cos(q) * start + sp.sin(q) * axis.cross(start)
        spun += (1 - sp.cos(q)) * axis.dot(start) * axis
        turned.append((arm.at(axis, leg.end()), spun))
    ends = [rf"\mathbf {letters(d, 'b')[0]}_{k}" for k in (1, 2)]
    V, T, W, C = (rf"\mathbf {e}" for e in letters(d, "vtwc"))
    d.explain(
        {
            V: "direction of the middle axis on the driver",
            T: "direction of the middle axis on the follower",
            W: "direction of the axis of the follower",
            C: "what the slides close",
            **{f"s_{k}": f"slide in the joint {name}" for k, name in enumerate(screws.names, 1)},
        }
    )
    d.step(
        "Slides",
        f"The middle axes have the directions {V[-1]} and {T[-1]}, in which the ends of both "
        f"cranks are, and the axis of the follower has the direction {W[-1]}.  A vector that leads "
        f"from one axis of a body to the other one is fixed to both: it keeps its parts along both "
        f"axes and across them.  So it is known where each body would bring the point of the "
        f"middle axis on the follower if nothing slid.  The vector {C[-1]} leads from the place "
        f"by the driver and the coupler to the place by the follower, and the slides close it: "
        f"s_1*{V[-1]} + s_2*{T[-1]} - s_3*{W[-1]} = {C[-1]}.  These are three linear equations, "
        f"whose determinant vanishes where the three axes are in one plane (parallel).",
        {
            V: ends[0],
            T: ends[1],
            W: w,
            C: gap(v, t),
            "s_1": rf"\frac{{{C}\cdot({T}\times {W})}}{{{V}\cdot({T}\times {W})}}",
            "s_2": rf"\frac{{{V}\cdot({C}\times {W})}}{{{V}\cdot({T}\times {W})}}",
            "s_3": rf"-\frac{{{V}\cdot({T}\times {C})}}{{{V}\cdot({T}\times {W})}}",
        },
        proves="The slides solve the equations.  A point of a crank turns about its axis.",
        equal=[
            (s[0] * v + s[1] * t - s[2] * n, volume * c),
            *turned,
        ],
        uses=[d.loop] if d.loop else [],
    )


__all__ = ["Screws", "check_screws", "export_slides"]
