"""The experiment of section V on the IRB 260: a motion at constant rates."""

import sympy as sp
from sympy import pi

from closedform import Derivation, Table, real


def experiment(
    d: Derivation, position: sp.Matrix, velocity: sp.Matrix, rates: sp.Matrix, M: sp.Matrix
) -> None:
    """Add the velocity of the hand over time, for both readings of the rate of motor 3."""
    time = real("t")
    omega = sp.Matrix([-30, 10, 5, 0]) * pi / 180

    def moving(speeds: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Position and velocity over time at constant rates, from all angles 0."""
        along = dict(zip(d.actuated, speeds * time, strict=True))
        at_rates = dict(zip(rates, speeds, strict=True))
        return position.subs(along), velocity.subs(at_rates).subs(along)

    p_relative, v_relative = moving(omega)
    p_grounded, v_grounded = moving(M * omega)
    d.step(
        "The experiment of section V",
        "The motion starts at theta = 0 with the rates -30, 10, 5 and 0 degrees per second (t in "
        "seconds).  The velocity v is the time derivative of the position along the path.",
        {"v": v_relative},
        proves="The velocity is the time derivative of the position.",
        equal=[(v_relative, p_relative.diff(time))],
    )
    difference = v_relative - v_grounded
    start, first, second = (difference.diff(time, k).subs(time, 0) for k in range(3))
    d.step(
        "Angles relative or grounded",
        "If 5 degrees per second were the rate of a motor 3 on the turret, the joint would turn by "
        "theta3 = (5 - 10) t, and the velocity would be w.  All three components distinguish the "
        "two readings, but not equally early.  At t = 0 only the vertical component differs, by a "
        "factor of three.  The differences of the others grow from 0: that of y with t, that of x "
        "with t^2.",
        {
            "w": v_grounded,
            r"(v - w)_{t = 0}": start.T,
            r"\frac{d}{dt}(v - w)_{t = 0}": first.T,
            r"\frac{d^2}{dt^2}(v - w)_{t = 0}": second.T,
        },
        proves=(
            "The velocity w is the time derivative of its position; at the start the vertical "
            "component of v is three times that of w, and the others agree."
        ),
        equal=[
            (v_grounded, p_grounded.diff(time)),
            (v_relative[2].subs(time, 0), 3 * v_grounded[2].subs(time, 0)),
            (start[:2, 0], sp.zeros(2, 1)),
            (first[0], sp.S.Zero),
        ],
    )
    readings = (("", v_relative), (" if motor 3 is grounded", v_grounded))
    d.tables.append(
        Table(
            "irb260_section_v",
            "t [s]",
            time,
            tuple(sp.Rational(k, 10) for k in range(101)),
            {
                f"v{axis}{suffix} [m/s]": value
                for suffix, values in readings
                for axis, value in zip("xyz", values, strict=True)
            },
        )
    )
