"""The mechanism of Rao and Raju from its frames, and what the names of the paper mean."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import sympy as sp
from closedform.derivations.h6ar_mechanism import (
    Dimensions,
    Joints,
    arm,
    arm_frames,
    in_space,
    pair,
    product,
    wrist_frames,
)
from sympy import cos, pi, sin

from closedform import Notation, real, rotation


class Robot:
    """The mechanism of the paper from its frames, in the names of the paper."""

    def __init__(self, m: Dimensions, q: Joints, example: dict[sp.Symbol, sp.Expr]):
        self.m, self.q, self.example = m, q, example
        self.psi, self.phi = real("psi"), real("phi")
        self.A2, self.A3, self.A23 = (real(f"theta_{n}^A") for n in ("2", "3", "23"))
        self.LW = real("L_W")
        self.lateral = sp.Matrix([sin(q.theta1), -cos(q.theta1), 0])
        """The normal of the mid-plane, to the right."""

    def arm_tip(self, second: sp.Expr, third: sp.Expr, side: sp.Expr) -> sp.Matrix:
        """The tip of a fore-arm by the frames of Fig. 2."""
        end = sp.Matrix([0, 0, self.m.L2, 1])
        frames = product(arm_frames(self.m, self.q.theta1, second, third, side))
        return sp.Matrix((frames * end)[:3])

    def planar_tip(self, upper: sp.Expr, fore: sp.Expr, side: sp.Expr) -> sp.Matrix:
        """The same from the angles of the links against the horizontal, without frames."""
        return in_space(self.m, pair(self.q.theta1), arm(self.m, upper, fore), side)

    @cached_property
    def right(self) -> sp.Matrix:
        return self.arm_tip(self.q.theta2R, self.q.theta3R, self.m.d)

    @cached_property
    def left(self) -> sp.Matrix:
        return self.arm_tip(self.q.theta2L, self.q.theta3L, -self.m.d)

    @cached_property
    def arm_joints(self) -> tuple[sp.Symbol, ...]:
        return (self.q.theta2R, self.q.theta3R, self.q.theta2L, self.q.theta3L)

    @cached_property
    def tip(self) -> sp.Matrix:
        """The tip by the frames of Figs. 2 and 4."""
        wrist = wrist_frames(self.m, self.LW, self.psi, self.phi, self.q.theta)
        arm = arm_frames(self.m, self.q.theta1, self.A2, self.A3, sp.S.Zero)
        return sp.Matrix(product([*arm, *wrist])[:3, 3])

    @cached_property
    def fore_arm(self) -> sp.Matrix:
        """The axes of the virtual fore-arm: upwards, to the right, along it."""
        frames = arm_frames(self.m, self.q.theta1, self.A2, self.A3, sp.S.Zero)
        return sp.Matrix(product(frames)[:3, :3])

    @cached_property
    def elbow(self) -> sp.Matrix:
        frames = arm_frames(self.m, self.q.theta1, self.A2, self.A3, sp.S.Zero)
        return sp.Matrix(product(frames[:2])[:3, 3])

    @cached_property
    def beyond_elbow(self) -> sp.Matrix:
        """The tip from the elbow, in the axes of the virtual fore-arm."""
        return sp.Matrix(self.fore_arm.T * (self.tip - self.elbow))

    @cached_property
    def half_line(self) -> sp.Matrix:
        """From the invariant point to the right tip, by the frames of the wrist in (9).

        The line between the tips is the y axis after roll and yaw; its part across the mid-plane
        is d.
        """
        turned = rotation("z", self.phi) * rotation("x", self.psi) * sp.Matrix([0, 1, 0])
        fore = product(arm_frames(self.m, self.q.theta1, sp.S.Zero, self.A23, sp.S.Zero))
        return sp.Matrix(fore[:3, :3] * turned * self.m.d / turned[1])

    @cached_property
    def half_base(self) -> sp.Expr:
        """Half the distance of the tips, by the frames of the wrist in (9)."""
        turned = rotation("z", self.phi) * rotation("x", self.psi) * sp.Matrix([0, 1, 0])
        return self.m.d / turned[1]

    @cached_property
    def tangents(self) -> dict[str, sp.Expr]:
        """Tangents of yaw and roll by (3) to (5): half differences of the tips, over d."""
        c1, s1 = cos(self.q.theta1), sin(self.q.theta1)
        apart = (self.right - self.left) / 2
        return {
            "yaw": (c1 * apart[0] + s1 * apart[1]) / self.m.d,
            "roll": apart[2] / self.m.d,
        }

    @cached_property
    def middle(self) -> sp.Matrix:
        return (self.right + self.left) / 2

    def derivative(self, functions: Sequence[sp.Expr], by: Sequence[sp.Symbol]) -> sp.Matrix:
        """A derivative at a posture of unit dimensions with level fore-arms and no yaw or roll."""
        q = self.q
        upper = dict.fromkeys((q.theta2R, q.theta2L, self.A2), pi / 3)
        elbow = dict.fromkeys((q.theta3R, q.theta3L, self.A3), pi / 6)
        at = dict.fromkeys((q.theta1, q.theta, self.psi, self.phi), sp.S.Zero) | upper | elbow
        at |= dict.fromkeys((*self.m, self.LW), sp.S.One)
        return sp.Matrix(functions).jacobian(by).subs(at)

    def rank(self, functions: Sequence[sp.Expr], by: Sequence[sp.Symbol]) -> int:
        """The rank of a derivative at that posture."""
        return int(self.derivative(functions, by).rank())


def notation(r: Robot) -> Notation:
    """What the paper's names mean."""
    m, q = r.m, r.q
    c1, s1 = cos(q.theta1), sin(q.theta1)
    names: dict[str, Any] = {
        r"\theta_1": q.theta1,
        "s_1": s1,
        "c_1": c1,
        "L_1": m.L1,
        "L_2": m.L2,
        "a_3": m.a3,
        "d_1": m.d1,
        "d": m.d,
        "g_s": m.gs,
        r"\alpha l": m.al,
        "l_{off}": m.loff,
        "l_p": m.lp,
        "l_n": m.lp,  # the scan has l_n for l_p in (9)
        "L_W": r.LW,
        r"\psi": r.psi,
        r"\phi": r.phi,
        r"\theta": q.theta,
        r"c_\theta": cos(q.theta),
        r"s_\theta": sin(q.theta),
        r"c_\phi": cos(r.phi),
        r"s_\phi": sin(r.phi),
        r"c_\psi": cos(r.psi),
        r"s_\psi": sin(r.psi),
    }
    arms = {"R": (q.theta2R, q.theta3R), "L": (q.theta2L, q.theta3L), "A": (r.A2, r.A3)}
    for name, (second, third) in arms.items():
        for index, angle in (("2", second), ("3", third), ("{23}", second + third)):
            names[rf"\theta_{index}^{name}"] = angle
            names[f"c_{index}^{name}"] = cos(angle)
            names[f"s_{index}^{name}"] = sin(angle)
    for side, point in (("R", r.right), ("L", r.left), ("T", r.tip)):
        names |= {f"{axis}_{side}": e for axis, e in zip("xyz", point, strict=True)}
    return Notation(names)
