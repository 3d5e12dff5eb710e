"""A hand in a plane with two legs that end in one of its points: four assembly modes, by circles.

The two legs place this point C, as those of a five-bar linkage do.  The end D of the third leg is
then on a circle about C, because both are points of the hand.  So two circles meet twice.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Slide, Stretch, cross_in_plane
from closedform.lemmas.lines import coordinate
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.sine_cosine import linear_pair
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import (
    SIGN,
    named,
    named_rod,
    record_lemma,
    size_of,
    solution_of,
)
from closedform.loops.modes import export
from closedform.loops.platform_legs import Platform, Posture, certify_forward, jacobians, matrices
from closedform.loops.points import NEAR
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Degenerate, Link
from closedform.model.pair import Pair
from closedform.model.step import Step

LEGS = 3
SIGMAS = (real("sigma_C"), real("sigma_D"))
C = sp.Matrix([real("C_x"), real("C_y")])
"""The point of the hand in which two legs end."""
D = sp.Matrix([real("D_x"), real("D_y")])
"""The end of the third leg."""
ON_HAND = "all legs end in one point of the hand"


@dataclass(frozen=True)
class Meet:
    """The numbers of the legs that end in one point, that of the other one, and its arm."""

    m: Platform
    pair: tuple[int, int]
    third: int

    @classmethod
    def of(cls, m: Platform) -> Meet | None:
        """The same of a hand, if it is of this kind."""
        groups = sorted(m.groups, key=len, reverse=True)
        if m.dimensions != 2 or m.rails or [*map(len, groups)] != [LEGS - 1, 1]:
            return None
        (first, second), (third,) = groups
        return cls(m, (first, second), third)

    @property
    def place(self) -> sp.Matrix:
        """The common point, in the frame of the hand."""
        return self.m.places[self.pair[0] - 1]

    @property
    def common(self) -> sp.Matrix:
        """The unknown coordinates of the common point, which may be the hand."""
        return self.m.position if self.place.is_zero_matrix else C

    @property
    def arm(self) -> sp.Matrix:
        """From there to the end of the third leg."""
        return self.m.places[self.third - 1] - self.place

    @property
    def sign(self) -> int:
        """The sign of the order of the legs with the third one last."""
        return 1 if (LEGS - self.third) % 2 == 0 else -1

    def forward(self, loop: Step) -> Posture:
        """Derive and export ``fk``."""
        return _forward(self, loop)

    def export_rates(self, at: Posture) -> None:
        """Export what depends on the joints and the assembly mode."""
        m, d = self.m, self.m.d
        v = Program(list(at.program.body), at.program.taken)
        A, driven = at.rates(v, *at.vectors(v))
        volume = v.let("Delta", at.sign * sp.Mul(*at.volumes))
        functions = [*matrices(m, A, driven, volume), *jacobians(m, v, A, driven, volume)]
        export(d, v, at.modes, functions)


def _forward(meet: Meet, loop: Step) -> Posture:
    m, arm = meet.m, meet.arm
    d, f, yaw = m.d, m.d.program(), m.pose[2]
    modes = branches(*((sigma, SIGN) for sigma in SIGMAS))
    d.assembly_modes = modes.labels
    slid = [leg.joint for leg in m.legs if isinstance(leg, Slide)]
    stretched = [sp.Abs(leg.joint) for leg in m.legs if isinstance(leg, Stretch)]
    size = f.let("size", size_of(d, m.whole, slid) + sp.Add(*stretched))
    share = MOVED if slid or stretched else SHARE
    near = {k: named(f, f"b_{k}", leg.end()) for k, leg in m.numbered}
    radii = {k: named_rod(f, k, leg) for k, leg in m.numbered}
    length = f.let("arm", sp.sqrt(sp.factor(sp.expand(square(arm)))), nonnegative=True)
    links: list[Link] = []

    def met(
        centres: tuple[sp.Matrix, ...], rods: list[sp.Expr], x: sp.Matrix
    ) -> tuple[sp.Matrix, sp.Expr]:
        """Where two circles meet, under a name, and the product of the vectors to there."""
        first = x != D
        found = two_circles(
            replace(f, suffix="_C" if first else "_D"),
            centres,
            rods,
            tuple(x),
            SIGMAS[not first],
            scale=size,
            share=share,
            free=tuple(m.pose) if first else (yaw,),
        )
        start = len(f.body)
        place = named(f, "C" if first else "D", sp.Matrix([found.lemma[e] for e in x]))
        means = dict(zip(place, x, strict=True))
        body = (*found.link.body, *f.body[start:])
        links.append(replace(found.link, body=body, means=means))
        return place, found.volume

    i, j = meet.pair
    at_c, first = met((near[i], near[j]), [radii[i], radii[j]], meet.common)
    at_d, second = met((at_c, near[meet.third]), [length, radii[meet.third]], D)
    between = at_d - at_c
    across, along = (
        f.let("across", cross_in_plane(arm, between)),
        f.let("along", arm.dot(between)),
    )
    start = len(f.body)
    h = f.let("h", sp.sqrt(across**2 + along**2), nonnegative=True)
    free = f.vanishes("turns", h, size**2, ON_HAND, (yaw,), squares=True)
    s = f.let("sine", choose(free, 0, across / h))
    c = f.let("cosine", choose(free, 1, along / h))
    turn = replace(linear_pair(yaw, across, along), solution={yaw: sp.atan2(s, c)})
    means = {s: sp.sin(yaw), c: sp.cos(yaw)}
    case = Degenerate((free,), dict.fromkeys((across, along), sp.S.Zero), yaw, ON_HAND)
    links.append(
        Link(
            unknowns=(yaw,),
            equations=turn.equations,
            lemma=turn,
            body=tuple(f.body[start:]),
            means=means,
            degenerate=(case,),
        )
    )
    R = _turned(Pair(s, c))
    position = named(f, "p", at_c - R * meet.place)
    if meet.common == C:
        links += [coordinate(x, e) for x, e in zip(m.pose[:2], position, strict=True)]
    _state(meet, loop)
    solved = solution_of(links)
    d.function(
        "fk",
        "Position and yaw of the hand in all assembly modes.",
        {"q": d.actuated},
        {"p": [solved[x] for x in m.pose]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the rods do not meet.",
            "SINGULAR: both circles of a point are the same, and it is free; one point is used.",
            f"SINGULAR: {ON_HAND}, and yaw = 0 is returned.",
            NEAR,
        ),
    )
    certify_forward(m, links, _equations(meet))
    for link in links:
        record_lemma(d, "fk", link)
    rods = {k: at_c - near[k] for k in meet.pair} | {meet.third: at_d - near[meet.third]}
    return Posture(
        m=m,
        program=Program(list(f.body), f.taken),
        modes=modes,
        position=position,
        rotation=R,
        rods=rods,
        spans=(between,),
        volumes=(first, second),
        sign=meet.sign,
    )


def _turned(pair: Pair) -> sp.Matrix:
    return sp.Matrix([[pair.c, -pair.s], [pair.s, pair.c]])


def _equations(meet: Meet) -> tuple[sp.Expr, ...]:
    """The equations of the loop, with the points C and D as further unknowns."""
    m, arm, (*_, yaw) = meet.m, meet.arm, meet.m.pose
    ends = dict.fromkeys(meet.pair, meet.common) | {meet.third: D}
    circles = [
        square(ends[k] - m.legs[k - 1].end()) - sp.sympify(m.legs[k - 1].rod, strict=True) ** 2
        for k in (*meet.pair, meet.third)
    ]
    between = D - meet.common
    placed = m.position - C + m.rotation * meet.place
    return (
        *circles[:2],
        square(between) - square(arm),
        circles[2],
        sp.sin(yaw) * arm.dot(between) - sp.cos(yaw) * cross_in_plane(arm, between),
        *(placed if meet.common == C else ()),
    )


def _state(meet: Meet, loop: Step) -> None:
    """The step on the assembly modes."""
    m, (i, j), k = meet.m, meet.pair, meet.third
    at = dict(zip([*C, *D], [*_end(m, i), *_end(m, k)], strict=True))
    zero = sp.S.Zero
    equations = _equations(meet)
    rest = [m.loop[i - 1], m.loop[j - 1], zero, m.loop[k - 1]]
    rest += [zero] * (len(equations) - len(rest))
    volume = meet.sign * cross_in_plane(m.rods[i - 1], m.rods[j - 1])
    m.d.step(
        "Forward: two circles, twice",
        f"Legs {i} and {j} end in the same point C of the hand.  It is where two circles meet "
        f"about the near ends of their rods.  The end D of leg {k} is where a circle about C, "
        f"whose radius is the distance of both points on the hand, meets that of its rod.  Each "
        f"time there are two points, so there are four assembly modes.  C and D give the yaw "
        f"and the position of the hand.  The first sign of a mode is that of the product of the "
        f"vectors along the rods {i} and {j}, and the second one that of the vector from C to D "
        f"and rod {k}.",
        {},
        proves="The ends of the legs satisfy these equations if and only if they satisfy those of "
        "the loop, and the determinant of A is the product of both.",
        equal=[
            *((e.xreplace(at), x) for e, x in zip(equations, rest, strict=True)),
            (
                sp.Matrix.vstack(*m.rows).det(),
                volume * cross_in_plane(m.rotation * meet.arm, m.rods[k - 1]),
            ),
        ],
        uses=[loop],
        solves={"fk": ()},
    )


def _end(m: Platform, k: int) -> sp.Matrix:
    """The end of a leg on the hand, at a pose."""
    return m.position + m.arms[k - 1]


__all__ = ["Meet"]
