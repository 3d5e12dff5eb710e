"""What to draw of the H6AR: both arms, the virtual arm, the wrist with its gears, and the tip."""

from collections.abc import Mapping

import sympy as sp
from closedform.derivations.h6ar_mechanism import (
    Dimensions,
    Joints,
    Pair,
    Posture,
    in_space,
    pair,
    reach,
)

from closedform import Derivation, Program, rotation, skeleton


def draw(
    d: Derivation,
    m: Dimensions,
    q: Joints,
    program: Program,
    here: Posture,
    *,
    posture: Posture,
    tip: sp.Matrix,
    arms: Mapping[str, tuple[sp.Expr, sp.Expr]],
    closed: bool,
    notes: tuple[str, ...],
) -> None:
    """Export the skeleton.

    Parameters
    ----------
    d, m, q
        the derivation, the dimensions and the joints
    program
        what computes the points
    here
        the posture in names of the program
    posture
        the posture in angles, for the proof
    tip
        the tip at that posture
    arms
        the upper arm and the fore-arm of each side at that posture
    closed
        whether the loop closes: the links of the wrist then start at the tips of the arms
    notes
        sentences for the documentation
    """
    real_arms = {
        side: (pair(second), pair(second + third))
        for side, second, third in (
            ("right", q.theta2R, q.theta3R),
            ("left", q.theta2L, q.theta3L),
        )
    }
    at_posture = {side: (pair(upper), pair(fore)) for side, (upper, fore) in arms.items()}
    foot = {"right": "tip_right", "left": "tip_left"} if closed else {
        "right": "foot_right", "left": "foot_left"
    }  # fmt: skip
    ends = wrist_links(m, posture)
    links = {"column": ("base", "column"), "waist": ("shoulder_left", "column", "shoulder_right")}
    for side in ("right", "left", "virtual"):
        shoulder = "column" if side == "virtual" else f"shoulder_{side}"
        links[f"upper_{side}"] = (shoulder, f"elbow_{side}")
        links[f"fore_{side}"] = (f"elbow_{side}", f"corner_{side}", f"tip_{side}")
    for side in ("right", "left"):
        links[f"wrist_{side}"] = (foot[side], f"gear_{side}")
    links["gears"] = ("gear_right", "gear_centre", "gear_left")
    links["wrist"] = ("gear_centre", "pitch")
    links["hand"] = ("pitch", "hand")
    skeleton(
        d,
        places(m, here, real_arms, closed=closed),
        links=links,
        joints={
            q.theta1: ("base", "column"),
            q.theta2R: ("shoulder_right",),
            q.theta3R: ("elbow_right",),
            q.theta2L: ("shoulder_left",),
            q.theta3L: ("elbow_left",),
            q.theta: ("pitch",),
        },
        hand="hand",
        hand_at=tip,
        ground=("base", "column"),
        lengths={(foot[side], f"gear_{side}"): m.al for side in ("right", "left")},
        program=program,
        notes=notes,
        at_posture=[places(m, posture, at_posture, closed=closed), *([ends] if closed else [])],
    )


def places(
    m: Dimensions, p: Posture, arms: Mapping[str, tuple[Pair, Pair]], *, closed: bool
) -> dict[str, sp.Matrix]:
    """The points of the mechanism at a posture."""
    found = {"base": sp.zeros(3, 1), "column": sp.Matrix([0, 0, m.d1])}
    offsets = {"right": m.d, "left": -m.d, "virtual": sp.S.Zero}
    for side, (upper, fore) in {**arms, "virtual": (p.upper, p.fore)}.items():
        elbow = m.L1 * upper.unit
        corner = elbow + m.a3 * fore.unit
        tip = reach(m, upper, fore, m.L2, m.a3)
        for name, planar in (
            ("shoulder", sp.zeros(2, 1)),
            ("elbow", elbow),
            ("corner", corner),
            ("tip", tip),
        ):
            if (name, side) != ("shoulder", "virtual"):
                found[f"{name}_{side}"] = in_space(m, p.waist, planar, offsets[side])
    across, along, forearm = wrist_axes(p)
    middle = found["tip_virtual"]
    if not closed:
        for side, sign in (("right", 1), ("left", -1)):
            found[f"foot_{side}"] = middle + sign * p.base * across
    centre = middle + p.wrist * along
    found["gear_right"], found["gear_left"] = centre + m.gs * across, centre - m.gs * across
    found["gear_centre"] = centre
    found["pitch"] = centre + m.loff * along
    rolled, yawed = turns(p)
    swung = sp.Matrix([m.lp * p.pitch.s, 0, m.lp * p.pitch.c])
    found["hand"] = found["pitch"] + forearm * (rolled * yawed * swung)
    return found


def wrist_links(m: Dimensions, p: Posture) -> dict[str, sp.Matrix]:
    """The ends of the links of the wrist from the middle of the tips, if the loop is closed."""
    across, along, _ = wrist_axes(p)
    return {
        f"{name}_{side}": sign * away * across + ahead * along
        for side, sign in (("right", 1), ("left", -1))
        for name, away, ahead in (("tip", p.base, sp.S.Zero), ("gear", m.gs, p.wrist))
    }


def wrist_axes(p: Posture) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
    """The base line of the wrist, to the right, its axis, and the axes of the fore-arm."""
    c1, s1, c23, s23 = p.waist.c, p.waist.s, p.fore.c, p.fore.s
    forearm = sp.Matrix([[c1 * c23, s1, c1 * s23], [s1 * c23, -c1, s1 * s23], [s23, 0, -c23]])
    rolled, yawed = turns(p)
    return forearm * (rolled * yawed[:, 1]), forearm * (rolled * yawed[:, 2]), forearm


def turns(p: Posture) -> tuple[sp.Matrix, sp.Matrix]:
    """The rotations by roll and yaw, from their sines and cosines."""
    angle = sp.Symbol("angle", real=True)
    rolled, yawed = (
        rotation(axis, angle).xreplace({sp.cos(angle): q.c, sp.sin(angle): q.s})
        for axis, q in (("z", p.roll), ("x", p.yaw))
    )
    return rolled, yawed
