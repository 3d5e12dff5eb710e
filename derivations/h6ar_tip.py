"""The virtual arm of the H6AR: with the wrist in its fore-arm it ends beside the tip."""

import sympy as sp
from closedform.derivations.h6ar_jacobian import L_theta, l_H
from closedform.derivations.h6ar_mechanism import (
    L_2W,
    Dimensions,
    Joints,
    Posture,
    a_3W,
    arm_frames,
    extended,
    in_space,
    pair,
    phi,
    product,
    psi,
    reach,
    theta2A,
    theta23A,
    wrist_frames,
)
from sympy import cos, sin, sqrt

from closedform import Derivation, Step, real, rotation

MEANINGS = {
    r"L_\theta": "distance of the tip from the mid-plane",
    "f_W": "length of the virtual fore-arm with the wrist, from the elbow to its end",
    "T": "pose of the tip",
    "R_T": "rotation of the tip",
    "R_{03}": "rotation of the virtual fore-arm",
}


def tip_step(d: Derivation, m: Dimensions, q: Joints, wrist: sp.Symbol, base: sp.Expr) -> Step:
    """Add the step that gives the tip, and say that it gives x, y and z.

    ``wrist`` is the symbol for l_W, and ``base`` is half the base line.
    """
    d.explain(MEANINGS)
    d.write("l_H", "l_{H}", "distance of the hand along the wrist")
    end_of_arm = "of the end of the virtual arm with the wrist"
    d.write("r_W", "r_{W}", f"distance {end_of_arm} from the waist axis")
    d.write("h_W", "h_{W}", f"height {end_of_arm} above the shoulders")
    angles = (q.theta1, theta2A, theta23A, psi, phi, q.theta)
    whole = wrist + m.loff + m.lp * cos(q.theta)
    posture = Posture(*map(pair, angles), wrist, base)
    aside, along, across = (sp.sympify(e).subs(whole, l_H) for e in extended(m, posture))
    end = reach(m, posture.upper, posture.fore, L_2W, a_3W)
    place = in_space(m, posture.waist, sp.Matrix([real("r_W"), real("h_W")]), -L_theta)
    known = {real("r_W"): end[0], real("h_W"): end[1]}
    lengths = {L_theta: aside, L_2W: along, a_3W: across}
    T = place.subs(known).subs(lengths).subs(l_H, whole)
    virtual = arm_frames(m, q.theta1, theta2A, theta23A - theta2A, sp.S.Zero)
    serial = product([*virtual, *wrist_frames(m, wrist + m.loff, psi, phi, q.theta)])
    c1, s1, c23, s23 = (f(e) for e in (q.theta1, theta23A) for f in (cos, sin))
    forearm = sp.Matrix([[c1 * c23, s1, c1 * s23], [s1 * c23, -c1, s1 * s23], [s23, 0, -c23]])
    turned = forearm * rotation("z", phi) * rotation("x", psi) * rotation("y", q.theta)
    step = d.step(
        "Tip",
        "The wrist is a serial chain on the virtual fore-arm: roll about the fore-arm, yaw about "
        "the rolled x axis, the wrist, pitch about the y axis, and the last link.  So the tip is "
        "beside the end of a virtual arm with a longer fore-arm, which is L_2W along and a_3W "
        "across; its distance from the mid-plane is L_theta.  The rotation of the tip in (9) is "
        "that of the fore-arm, then phi about z, psi about x and theta about y.",
        {
            "l_H": whole,
            r"L_\theta": aside,
            "L_{2W}": along,
            "a_{3W}": across,
            "f_W": sqrt(L_2W**2 + a_3W**2),
            "r_W": end[0],
            "h_W": end[1],
            "(x, y, z)_T": place,
            "T": r"\begin{bmatrix} R_T & (x, y, z)_T \\ 0 & 1 \end{bmatrix}",
            "R_T": r"R_{03}\,R_z(\phi)\,R_x(\psi)\,R_y(\theta)",
            "R_{03}": forearm,
        },
        published=("(9)",),
        proves="Position and rotation of the tip are those of the serial chain with the virtual "
        "arm.",
        equal=[(serial[:3, 3], T), (serial[:3, :3], turned)],
        solves={"ik": [q.theta1]},
    )
    d.given_by |= dict.fromkeys(("x", "y", "z"), step)
    return step


def bent_step(d: Derivation, m: Dimensions, q: Joints, tips: tuple[sp.Matrix, sp.Matrix]) -> None:
    """Add the step that gives the reach of the virtual arm from those of the real ones."""
    right, left = tips
    middle, apart = (right + left) / 2, (right - left) / 2
    mean = (right.dot(right) + left.dot(left)) / 2
    fore = sqrt(m.L2**2 + m.a3**2)
    d.step(
        "Bend of the virtual arm",
        "The square of the reach R_I of the virtual arm is the mean of the squares for both arms, "
        "minus the square of half the distance of the tips.  So N = (L1 + f)^2 - R_I^2 of the "
        "virtual arm is a sum of terms that are not negative.  No digits cancel if the arms are "
        "straight.",
        {
            "f": fore,
            "R_I^2": r"\tfrac{1}{2} (r_R^2 + h_R^2 + r_L^2 + h_L^2) - \Delta_a^2 - \Delta_h^2",
        },
        proves="The square of the reach is the stated mean, and N of each real arm is the stated "
        "sum.",
        equal=[
            (middle.dot(middle), mean - apart.dot(apart)),
            *(
                (
                    (m.L1 + fore) ** 2 - tip.dot(tip),
                    2 * m.L1 * (fore - m.L2 * sin(elbow) - m.a3 * cos(elbow)),
                )
                for tip, elbow in ((right, q.theta3R), (left, q.theta3L))
            ),
        ],
    )


__all__ = ["bent_step", "tip_step"]
