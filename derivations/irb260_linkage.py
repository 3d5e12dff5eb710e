"""The double parallelogram of the IRB 260, which is behind its virtual joint, and its motors."""

import sympy as sp
from sympy import cos, pi, sin

from closedform import Derivation, Lemma, parallelogram, real


def double_parallelogram(
    d: Derivation, l3: sp.Symbol, l4: sp.Symbol, theta2: sp.Symbol, theta3: sp.Symbol
) -> tuple[Lemma, Lemma, sp.Matrix]:
    """Derive theta4 from the loops; the lower and the upper loop, and the map of the motors."""
    sigma = real("sigma")
    m1, m2, m3, m5 = motors = [real(f"m{i}") for i in (1, 2, 3, 5)]
    a1, a2, a3 = (real(f"a{i}", positive=True) for i in (1, 2, 3))
    gamma1, gamma2, gamma3 = (real(f"gamma{i}") for i in (1, 2, 3))
    phi1, phi2, phi3 = (real(f"phi{i}") for i in (1, 2, 3))
    beta1, beta2, beta3 = (real(f"beta{i}") for i in (1, 2, 3))
    forearm = theta2 + theta3 + pi / 2
    lower = parallelogram(l3, a1, theta2, gamma1, phi1, beta1, sigma)
    upper = parallelogram(l4, a2, forearm - phi1, gamma2, phi2, beta2, sigma)
    drive = parallelogram(l3, a3, theta2, gamma3 + m3, phi3, beta3, sigma)
    closed = [
        sp.Matrix(loop.equations).subs(loop.solution).subs(sigma, sign)
        for loop in (lower, upper, drive)
        for sign in (1, -1)
    ]
    crossed = lower[phi1].subs(sigma, -1)
    meet = assemblies_meet(l3, a1, theta2 - gamma1)
    folded = {a1: l3, theta2: gamma1, beta1: gamma1 + phi1}
    d.step(
        "The lower loop and its assemblies",
        "In the plane of the arm, with angles from the vertical: the lower arm and a rod of the "
        "same length join the turret to a plate at the elbow, over a distance a1 in the direction "
        "gamma1 on both.  The loop equations have two solutions for the turn phi1 of the plate and "
        "the angle beta1 of the rod.  In the parallelogram the plate does not turn, whatever a1 "
        "and gamma1; crossed, as an antiparallelogram, it does.  The assemblies meet where "
        "phi1 = 0 in both: exactly where the loop is flat, sin(theta2 - gamma1) = 0.  Only if "
        "a1 = l3 and the links lie on one another, theta2 = gamma1, is the plate free to turn.",
        {
            "0": sp.Matrix(lower.equations),
            r"(\phi_1, \beta_1)_{\text{parallelogram}}": (sp.Integer(0), theta2),
            r"\phi_{1,\text{crossed}}": crossed,
            r"\beta_{1,\text{crossed}}": 2 * gamma1 + phi1 - theta2,
            r"1 - \cos\phi_{1,\text{crossed}}": meet,
        },
        equal=[
            *((rest, sp.zeros(2, 1)) for rest in closed),
            (1 - cos(crossed), meet),
            (lower[beta1].subs(sigma, -1), 2 * gamma1 + crossed - theta2),
            (sp.Matrix(lower.equations).subs(folded), sp.zeros(2, 1)),
        ],
    )
    bracket = (lower[phi1] + upper[phi2]).subs(sigma, 1)
    crossed = upper[phi2].subs(sigma, -1).subs(phi1, 0)
    meet = assemblies_meet(l4, a2, forearm - gamma2)
    d.step(
        "The upper loop and the virtual joint",
        "The upper arm and a second rod join the plate to the wrist bracket, over a distance a2. "
        "The bracket turns by phi1 + phi2 against the turret; joint 4 is what it turns against the "
        "upper arm.  In two parallelograms phi1 = phi2 = 0: the distances a1, a2 drop out, and the "
        "bracket stays level.  This is the virtual joint.  With a loop crossed, the bracket turns "
        "as the arm moves.  The assemblies of the upper loop meet where this loop is flat, too.",
        {
            "0": sp.Matrix(upper.equations),
            r"\theta_4 = \phi_1 + \phi_2 - \theta_2 - \theta_3": bracket - theta2 - theta3,
            r"1 - \cos\phi_{2,\text{crossed}}": meet,
        },
        equal=[
            (bracket - theta2 - theta3, d.couple(real("theta4"))),
            (1 - cos(crossed), meet),
        ],
    )
    upper_arm = drive[phi3].subs(sigma, 1) + m3  # theta2 + theta3, by the third parallelogram
    M = sp.Matrix([m1, m2, upper_arm - m2, m5]).jacobian(motors)
    d.step(
        "Motors",
        "Motor 3 sits on the turret as motor 2 does.  Its crank of length a3 drives the upper arm "
        "through a rod as long as the lower arm: a third parallelogram, whose fixed link is the "
        "crank.  The upper arm does not turn against the crank, phi3 = 0, so theta2 + theta3 is "
        "the angle of the motor.  The paper is silent about this, and its theta3 is the angle "
        "against the lower arm.",
        {
            "0": sp.Matrix(drive.equations),
            r"\theta_2 + \theta_3 - m_3 = \phi_3": upper_arm - m3,
            r"M = \partial(\theta_1, \theta_2, \theta_3, \theta_5) / \partial m": M,
            r"M^{-1}": M.inv(),
        },
        equal=[(M * sp.Matrix(motors), sp.Matrix([m1, m2, m3 - m2, m5]))],
    )
    return lower, upper, M


def assemblies_meet(link: sp.Expr, coupler: sp.Expr, bend: sp.Expr) -> sp.Expr:
    """``1 - cos(turn)`` of the crossed assembly: zero exactly where both assemblies are one."""
    stretch = link**2 + coupler**2 - 2 * link * coupler * cos(bend)
    return 2 * link**2 * sin(bend) ** 2 / stretch
