"""Writes the chain of an arm whose slides come first: gantries and machine tools.

The joints that turn follow from the orientation alone, wherever their axes are.  What they then
leave of the position is linear in the slides.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, Singles, parallel
from closedform.scaffold.chains.maker import Z, times
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.source import source

NAMES = {1: "a slide", 2: "two slides", 3: "gantry"}


class DecoupledMaker(SubproblemMaker):
    """Writes the lines for up to three slides and up to three joints that turn after them."""

    def decoupled(self, arm: Singles) -> str:
        count = sum(j.slides for j in arm.joints)
        slides, turning = arm.joints[:count], arm.joints[count:]
        self.require(
            0 < count <= 3 and 0 < len(turning) <= 3 and not any(j.slides for j in turning),
            "its slides do not all come before or after the joints that turn",
            "Up to three slides and up to three joints that turn are solved one after another.",
        )
        self.require(
            count == 3 or len(turning) < 3,
            "it has fewer than three slides and three joints that turn",
            "Where its wrist is singular the slides must reach any position.",
        )
        self.require(
            not any(map(parallel, turning[:-1])),
            "two neighbours that turn are parallel",
            "The joints that turn must follow from the orientation of the tool.",
        )
        R = self.centre(arm)
        helper = Slides(self, slides, self.unknown)
        G = sp.prod((j.end for j in helper.joints), start=sp.eye(3)).applyfunc(sp.simplify)
        M = self.without_tool(arm.tool[:3, :3], times(G.T * arm.lead[:3, :3].T, R))
        self.add(f"M = ik.matrix('M', {M})")
        self.orientation(turning, "M")
        to_wrist = self._to_wrist(turning)
        if to_wrist:
            self.vector("p", f"p - {times(G, f'({to_wrist})')}", "p3")
        directions, c, before = [], sp.zeros(3, 1), sp.eye(3)
        for joint in helper.joints:
            directions.append((joint, (before * Z).applyfunc(sp.simplify)))
            c, before = c + before * joint.shift, before * joint.end
        helper.linear("p", c.applyfunc(sp.simplify), directions)
        if len(self.arm.joints) < 6:
            self.add("ik.reached()")
        turns = f"{len(turning)} joints that turn" if len(turning) > 1 else "1 joint that turns"
        return f"{NAMES[count]}, and {turns} the tool, apart from each other"

    def _to_wrist(self, turning: Sequence[Single]) -> str:
        """Where the joints that turn carry the last axis, in ``M`` and the pair of the first.

        The shift from the second of three axes to the third is taken along both and across them,
        because only the directions of the axes are known, not the turn of the second joint.
        """
        first, *others = turning
        if not others:
            return ""
        pair = self.lifted if len(turning) == 3 else f"pair{first.number}"
        shift, across = first.shift, ""
        if len(turning) == 3:
            middle, _ = others
            w = middle.end * Z
            basis = sp.Matrix.hstack(Z, w, Z.cross(w))
            along, onto, aside = (basis.inv() * middle.shift).applyfunc(sp.simplify)
            shift = (shift + along * (first.end * Z)).applyfunc(sp.simplify)
            if (onto, aside) != (0, 0):
                axis = source(first.end * Z)
                self.vector("axis", f"turned({pair}) * {axis}", "axis2")
                across = f"{source(onto)}*M[:, 2] + {source(aside)}*axis.cross(M[:, 2])"
        parts = [] if shift.is_zero_matrix else [f"turned({pair}) * {source(shift)}"]
        return " + ".join([*parts, *([across] if across else [])])


__all__ = ["DecoupledMaker"]
