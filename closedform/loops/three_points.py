"""A hand whose six legs end in three of its points, 3, 2 and 1 of them: eight modes, by spheres.

Three legs place their common point C.  The point D of two legs is at known distances from C and
from the near ends of these legs, and the end E of the last leg at known distances from C, D and its
near end.  So three spheres meet, three times.  The three points give the pose.

Legs that stretch may start in three points of the ground instead.  Seen from the hand, this is the
same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import sympy as sp

from closedform.lemmas.legs import Slide, Stretch
from closedform.lemmas.lines import coordinate
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.spheres import three_spheres
from closedform.lemmas.two_vectors import two_vectors
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import SIGN, named, named_rod, record_lemma, size_of, solution_of
from closedform.loops.modes import export
from closedform.loops.platform_legs import Platform, Posture, certify_forward, matrices
from closedform.loops.points import (
    FREE_POINT,
    NEAR,
    named_point,
    require_triangle,
    side_length,
    with_roles,
)
from closedform.mechanics.frames import rotation
from closedform.model.functions import Program, branches, real
from closedform.model.inverse import Link
from closedform.model.names import listed
from closedform.model.step import Step

Sizes: TypeAlias = tuple[Sequence[sp.Expr], sp.Expr]
"""The lengths of the rods, and the sum of all lengths."""
SIZES = [3, 2, 1]
"""How many legs end in each of the points."""
NAMES = "CDE"
SIGMAS = tuple(real(f"sigma_{name}") for name in NAMES)
UNKNOWN = {name: sp.Matrix([real(f"{name}_{i}") for i in "xyz"]) for name in NAMES}


@dataclass(frozen=True)
class ThreePoints:
    """The numbers of the legs that end in C, D and E, in this order."""

    m: Platform
    order: tuple[int, ...]
    on_ground: bool = False
    """Whether these points are fixed to the ground, and not to the hand."""

    @classmethod
    def of(cls, m: Platform) -> ThreePoints | None:
        """The same of a hand, if it is of this kind."""
        stretch = all(isinstance(leg, Stretch) for leg in m.legs)
        for on_ground, groups in ((False, m.groups), (True, m.groups_on_ground)):
            groups = sorted(groups, key=len, reverse=True)
            if m.tilts and [*map(len, groups)] == SIZES and (stretch or not on_ground):
                return cls(m, tuple(k for group in groups for k in group), on_ground)
        return None

    @property
    def body(self) -> str:
        return "ground" if self.on_ground else "hand"

    @property
    def points(self) -> list[sp.Matrix]:
        """C, D and E, in the frame of the body to which they are fixed."""
        ends = [leg.end() for leg in self.m.legs] if self.on_ground else self.m.places
        return [ends[self.order[k] - 1] for k in (0, 3, 5)]

    @property
    def centres(self) -> dict[int, sp.Matrix]:
        """The other ends of the legs, in the frame of the other body."""
        return {k: self.m.places[k - 1] if self.on_ground else e.end() for k, e in self.m.numbered}

    @property
    def unknown(self) -> list[sp.Matrix]:
        """The coordinates of C, D and E in this frame; C may be the point of the hand."""
        known = not self.on_ground and self.points[0].is_zero_matrix
        return [self.m.position if known else UNKNOWN["C"], UNKNOWN["D"], UNKNOWN["E"]]

    @property
    def turn(self) -> sp.Matrix:
        """The rotation from the frame of the points to that of the centres."""
        return self.m.rotation.T if self.on_ground else self.m.rotation

    @property
    def spans(self) -> list[sp.Matrix]:
        """The vectors from C to D and E, in the frame of their body."""
        first, *others = self.points
        return [point - first for point in others]

    @property
    def in_line(self) -> str:
        """What is required of the points."""
        return f"the points of the {self.body} in which legs end are not in line"

    def position_from(self, first: sp.Matrix, R: sp.Matrix) -> sp.Matrix:
        """The position of the hand, from the coordinates of C and the rotation."""
        return self.points[0] - R * first if self.on_ground else first - R * self.points[0]

    @property
    def sign(self) -> int:
        """The sign of the order of the legs."""
        return int(sp.combinatorics.Permutation([k - 1 for k in self.order]).signature())

    def forward(self, loop: Step) -> Posture:
        """Derive and export ``fk``."""
        m = self.m
        d, f = m.d, m.d.program()
        modes = branches(*((sigma, SIGN) for sigma in SIGMAS))
        d.assembly_modes = modes.labels
        slid = [leg.joint for leg in m.legs if isinstance(leg, Slide)]
        stretched = [leg.joint for leg in m.legs if isinstance(leg, Stretch)]
        size = f.let("size", size_of(d, m.whole, slid) + sp.Add(*map(sp.Abs, stretched)))
        share = MOVED if slid or stretched else SHARE
        letter = "e" if self.on_ground else "b"
        near = {k: named(f, f"{letter}_{k}", e) for k, e in self.centres.items()}
        radii = {k: named_rod(f, k, self.m.legs[k - 1], size) for k in self.order}
        spans = [named(f, name, e) for name, e in zip("de", self.spans, strict=True)]
        sides = self._sides(f)
        apart = require_triangle(f, spans, size, self.in_line)
        links: list[Link] = []

        def met(
            which: int, centres: Sequence[sp.Matrix], lengths: Sequence[sp.Symbol]
        ) -> tuple[sp.Matrix, sp.Expr]:
            """A point where three spheres meet, under a name, and the determinant of the radii."""
            x = self.unknown[which]
            found = three_spheres(
                replace(f, suffix=f"_{NAMES[which]}"),
                centres,
                lengths,
                tuple(x),
                SIGMAS[which],
                scale=size,
                share=share,
                free=tuple(x),
            )
            place, link = named_point(f, found, x, self._roles(which))
            links.append(link)
            return place, found.volume

        *three, i, j, last = self.order
        C, first = met(0, [near[k] for k in three], [radii[k] for k in three])
        D, second = met(1, [C, near[i], near[j]], [sides[0], radii[i], radii[j]])
        E, third = met(2, [C, D, near[last]], [sides[1], sides[2], radii[last]])
        turned = [named(f, name, x - C) for name, x in zip("uv", (D, E), strict=True)]
        link, turn = two_vectors(f, spans, turned, self.turn, name="Q" if self.on_ground else "R")
        R = turn.T if self.on_ground else turn
        start = "p" if self.unknown[0] == m.position else "C"
        roles: list[tuple[str, Any]] = [("R", "R^T")] if self.on_ground else []
        roles += [(rf"\mathbf {x}", e) for x, e in zip("de", self.spans, strict=True)]
        roles += [(rf"\mathbf {x}", f"{e} - {start}") for x, e in zip("uv", "DE", strict=True)]
        links.append(with_roles(link, roles))
        position = named(f, "p", self.position_from(C, R))
        if self.unknown[0] != m.position:
            links += [coordinate(x, e) for x, e in zip(m.position, position, strict=True)]
        told = len(links)
        links += [coordinate(x, sp.Integer(k == 3)) for k, x in enumerate(m.pose[3, :])]
        self._state(loop)
        solved = solution_of(links)
        d.function(
            "fk",
            "Pose of the hand in all assembly modes.",
            {"q": d.actuated},
            {"p": m.pose.xreplace(solved)},
            program=f,
            branches=modes,
            result="Positions",
            notes=(
                "UNREACHABLE: the rods do not meet.",
                FREE_POINT,
                *apart,
                NEAR,
            ),
        )
        certify_forward(m, links, self._equations())
        for link in links[:told]:
            record_lemma(d, "fk", link)
        rods = {k: C - near[k] for k in three}
        rods |= {k: D - near[k] for k in (i, j)} | {last: E - near[last]}
        volumes = [first, second, third]
        if self.on_ground:  # the rods lead the other way, and their vectors are turned
            rods = {k: -R * rod for k, rod in rods.items()}
            volumes, turned = [-first, second, -third], spans
        return Posture(
            m=m,
            program=Program(list(f.body), f.taken),
            modes=modes,
            position=position,
            rotation=R,
            rods=rods,
            spans=turned,
            volumes=volumes,
            sign=self.sign,
        )

    def _roles(self, which: int) -> tuple[tuple[str, Any], ...]:
        """What the letters of the lemma stand for that gives a point."""
        (d, e), (*three, i, j, last) = self.spans, self.order
        C, D, E = ("p" if self.unknown[0] == self.m.position else "C"), *"DE"
        end = "e" if self.on_ground else "b"
        x, *centres = [
            (C, *(f"{end}_{k}" for k in three)),
            (D, C, f"{end}_{i}", f"{end}_{j}"),
            (E, C, D, f"{end}_{last}"),
        ][which]
        sides = [[], [d], [e, e - d]][which]
        lengths = [side_length(side) for side in sides]
        lengths += [
            sp.sympify(self.m.legs[k - 1].rod, strict=True) for k in [three, [i, j], [last]][which]
        ]
        letters = zip((r"\mathbf x", r"\mathbf a", r"\mathbf c_3"), (x, *centres[1:]), strict=True)
        return (
            *((letter, f"{point} - {centres[0]}") for letter, point in letters),
            *((f"r_{k}", length) for k, length in enumerate(lengths, 1)),
        )

    def _sides(self, p: Program) -> list[sp.Symbol]:
        """The distances of C from D, of C from E and of D from E on the hand."""
        d, e = self.spans
        return [
            p.let(name, side_length(side), nonnegative=True)
            for name, side in (("side_CD", d), ("side_CE", e), ("side_DE", e - d))
        ]

    def _equations(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop, with the points C, D and E as further unknowns."""
        m, (d, e), (C, D, E) = self.m, self.spans, self.unknown
        *three, i, j, last = self.order

        def rod(end: sp.Matrix, k: int) -> sp.Expr:
            rod = sp.sympify(m.legs[k - 1].rod, strict=True)
            return square(end - self.centres[k]) - rod**2

        u, v = D - C, E - C
        turned = (self.turn * d - u, self.turn * e - v, self.turn * d.cross(e) - u.cross(v))
        placed = m.position - self.position_from(C, m.rotation)
        return (
            *(rod(C, k) for k in three),
            square(u) - square(d),
            rod(D, i),
            rod(D, j),
            square(v) - square(e),
            square(E - D) - square(e - d),
            rod(E, last),
            *(entry for equation in turned for entry in equation),
            *(placed if m.position != C else ()),
            *(x - int(k == 3) for k, x in enumerate(m.pose[3, :])),
        )

    def _state(self, loop: Step) -> None:
        """The step on the assembly modes."""
        m, (*three, i, j, last) = self.m, self.order
        ends = [
            self.turn * (point - m.position) if self.on_ground else m.position + self.turn * point
            for point in self.points
        ]
        unknown, known = (sp.Matrix.vstack(*points) for points in (self.unknown, ends))
        at = dict(zip(unknown, known, strict=True))
        turned = rotation("z", real("alpha")) * rotation("y", real("beta"))
        turned *= rotation("x", real("gamma"))
        turning = dict(zip(m.rotation, turned, strict=True))
        turning |= dict(zip(m.pose[3, :], (0, 0, 0, 1), strict=True))
        zero = sp.S.Zero
        rods = [*(m.loop[k - 1] for k in three), zero, m.loop[i - 1], m.loop[j - 1]]
        rods += [zero, zero, m.loop[last - 1]]
        found = [e.xreplace(at) for e in self._equations()]
        rest = [zero] * (len(found) - len(rods))
        seen, end, other = "It is where", "end", "near"
        if self.on_ground:
            seen, end, other = (
                "Seen from the hand, whose points do not move, it is where",
                "start",
                "far",
            )
        m.d.step(
            "Forward: three spheres, three times",
            f"Legs {listed([*map(str, three)])} {end} in the same point C of the {self.body}.  "
            f"{seen} three spheres meet about the {other} ends of their rods.  Legs {i} and {j} "
            f"{end} in D, which is at known distances from C and from the {other} ends of both "
            f"rods.  The point E in which leg {last} {end}s is at known distances from C, from D "
            f"and from the {other} end of its rod.  Each time there are two points, so there are "
            f"eight assembly modes.  C, D and E give the rotation of the hand, and so its "
            f"position.  The signs of a mode are those of the determinants of the three vectors "
            f"from the centres of the spheres to C, D and E.",
            {},
            proves="The ends of the legs satisfy these equations if and only if they satisfy those "
            "of the loop.",
            equal=[
                (e.xreplace(turning), x.xreplace(turning))
                for e, x in zip(found, [*rods, *rest], strict=True)
            ],
            uses=[loop],
            solves={"fk": ()},
        )

    def _state_rates(self) -> None:
        """The step on the Jacobian and on the determinant of A."""
        m, three, last = self.m, self.order[:3], self.order[-1]
        u, v, p, r, s, t = (
            sp.Matrix([real(f"{letter}_{axis}") for axis in "xyz"]) for letter in "uvprst"
        )
        M = sp.Matrix(3, 3, lambda row, column: real(f"m{row + 1}{column + 1}"))
        volume = sp.Matrix.hstack(u, r, s).det()
        rows = sp.Matrix.hstack(u.cross(r), u.cross(s), v.cross(t)).T
        product = volume * sp.Matrix.hstack(u, v, t).det()
        at_c = "the hand where it passes C" if self.on_ground else "C"
        m.d.step(
            "Velocity: point by point",
            f"The rods of legs {listed([*map(str, three)])} give the velocity of {at_c}.  Let u "
            "and v be the vectors from C to D and to E.  The moment about C of a rod through D is "
            f"the product of u and the vector along it; for leg {last} v takes the place of u.  "
            "These three moments give the angular velocity, from what the joints add to the "
            "velocity of C along the rods.  So the Jacobian needs two matrices of three rows only, "
            "and the determinant of A is the product of their determinants.  That of the moments "
            "is a product again.  So the determinant of A has three factors: the determinants of "
            "the vectors from the centres of the spheres to C, D and E.",
            {},
            proves="A moment about C differs from that about p by the product of the vector from p "
            "to C and the force, so it does not change the determinant.  The determinant of three "
            "moments is the product of two.  The adjugate of a matrix gives its inverse.",
            equal=[
                ((p + u).cross(r) - p.cross(r), u.cross(r)),
                (u.cross(r).cross(u.cross(s)), volume * u),
                (rows.det(), product),
                (sp.Matrix.hstack(v, v - u, t).det(), sp.Matrix.hstack(u, v, t).det()),
                (M * M.adjugate(), M.det() * sp.eye(3)),
            ],
            uses=[m.d.loop] if m.d.loop else [],
        )

    def amplified(
        self, g: Program, arms: Sequence[sp.Matrix], rods: Sequence[sp.Matrix], sizes: Sizes
    ) -> tuple[sp.Expr, sp.Expr]:
        """The determinant of A, and that times what missed lengths of the rods do to the hand.

        This is the sum, over all rods, of the turn of the hand and of the velocity of C that one
        of them causes; the turn counts as a motion by the size of the mechanism.
        """
        *first, i, j, last = (k - 1 for k in self.order)
        ends = [leg.end() for leg in self.m.legs] if self.on_ground else arms
        u, v = (named(g, x, ends[k] - ends[first[0]]) for x, k in (("u", i), ("v", last)))
        one, two = (named(g, f"M_{k + 1}", u.cross(rods[k])) for k in (i, j))
        three = named(g, f"M_{last + 1}", v.cross(rods[last]))
        across = {
            k: named(g, f"V_{k + 1}", rods[first[n - 2]].cross(rods[first[n - 1]]))
            for n, k in enumerate(first)
        }
        at_c = g.let("Delta_C", rods[first[0]].dot(across[first[0]]))
        at_d = g.let("Delta_D", one.dot(rods[j]))
        at_e = g.let("Delta_E", three.dot(u))
        both = g.let("Delta_DE", at_d * at_e)
        turns = {
            i: named(g, f"W_{i + 1}", two.cross(three)),
            j: named(g, f"W_{j + 1}", three.cross(one)),
            last: named(g, f"W_{last + 1}", at_d * u),
        }
        turned = {k: _length_of(turn) * sp.Abs(at_c) for k, turn in turns.items()}
        moved = {}
        for k, V in across.items():
            by = sum((rods[e].dot(V) * turn for e, turn in turns.items()), sp.zeros(3, 1))
            turned[k] = _length_of(named(g, f"omega_{k + 1}", by))
            moved[k] = _length_of(V) * sp.Abs(both)
        lengths, size = sizes
        total = size * sp.Add(*(lengths[k] * e for k, e in sorted(turned.items())))
        total += sp.Add(*(lengths[k] * e for k, e in sorted(moved.items())))
        return at_c * both, total

    def export_rates(self, at: Posture) -> None:
        """Export what depends on the joints and the assembly mode."""
        self._state_rates()
        m, d = self.m, self.m.d
        v = Program(list(at.program.body), at.program.taken)
        arms, rods = at.vectors(v)
        A, driven = at.rates(v, arms, rods)
        named_volumes = zip(NAMES, at.volumes, strict=True)
        at = replace(at, volumes=[v.let(f"Delta_{name}", e) for name, e in named_volumes])
        volume = v.let("Delta", at.sign * sp.Mul(*at.volumes))
        pole = ("Not finite at a parallel singularity.",)
        functions = [
            *matrices(m, A, driven, volume),
            (
                "jacobian",
                "Velocity and angular velocity of the hand, in base axes, per joint rate: A^-1*B.",
                {"J": self._jacobian(v, at, arms, rods, driven)},
                pole,
            ),
            (
                "determinant",
                "Determinant of the Jacobian.",
                {"det": sp.Mul(*driven) / volume},
                pole,
            ),
        ]
        export(d, v, at.modes, functions)

    def _jacobian(
        self,
        v: Program,
        at: Posture,
        arms: Sequence[sp.Matrix],
        rods: Sequence[sp.Matrix],
        driven: Sequence[sp.Expr],
    ) -> sp.Matrix:
        """The velocity of C, and the angular velocity, for each joint."""
        (to_d, to_e), (at_c, at_d, at_e) = at.spans, at.volumes
        *first, i, j, last = (k - 1 for k in self.order)
        one, two, three = (
            named(v, f"M_{k + 1}", span.cross(rods[k]))
            for k, span in ((i, to_d), (j, to_d), (last, to_e))
        )
        both = v.let("Delta_DE", at_d * at_e)
        turns = {
            i: named(v, f"W_{i + 1}", two.cross(three) / both),
            j: named(v, f"W_{j + 1}", three.cross(one) / both),
            last: named(v, f"W_{last + 1}", to_d / at_e),
        }
        columns = {}
        for n, k in enumerate(first):
            across = rods[first[n - 2]].cross(rods[first[n - 1]])
            moved = named(v, f"V_{k + 1}", across * (driven[k] / at_c))
            against = {e: v.let(f"K_{k + 1}{e + 1}", rods[e].dot(moved)) for e in turns}
            turned = sum((-q * turns[e] for e, q in against.items()), sp.zeros(3, 1))
            columns[k] = moved, turned
        columns |= {k: (sp.zeros(3, 1), driven[k] * turn) for k, turn in turns.items()}
        to_c = arms[first[0]]
        if self.on_ground:
            to_c = named(v, "to_C", self.points[0] - at.position)
        found = []
        for k, (moved, turned) in sorted(columns.items()):
            omega = named(v, f"omega_{k + 1}", turned)
            found.append((moved + to_c.cross(omega)).col_join(omega))
        return sp.Matrix.hstack(*found)


def _length_of(v: sp.Matrix) -> sp.Expr:
    return sp.sqrt(square(v))


__all__ = ["ThreePoints"]
