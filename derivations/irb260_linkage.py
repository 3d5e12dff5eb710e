"""The double parallelogram of the IRB 260, the source of its virtual joint."""

import sympy as sp
from sympy import cos, pi, sin

from closedform import Derivation, Lemma, parallelogram, real


def double_parallelogram(
    d: Derivation, l3: sp.Symbol, l4: sp.Symbol, theta2: sp.Symbol, theta3: sp.Symbol
) -> tuple[Lemma, Lemma]:
    """Derive theta4; return the lower and the upper loop."""
    sigma = real("sigma")
    a1, a2 = (real(f"a{i}", positive=True) for i in (1, 2))
    gamma1, gamma2, phi1, phi2, beta1, beta2 = (
        real(f"{name}{i}") for name in ("gamma", "phi", "beta") for i in (1, 2)
    )
    forearm = theta2 + theta3 + pi / 2
    lower = parallelogram((l3, a1), (theta2, gamma1), (phi1, beta1), sigma)
    upper = parallelogram((l4, a2), (forearm - phi1, gamma2), (phi2, beta2), sigma)
    closed = [
        sp.Matrix(loop.equations).subs(loop.solution).subs(sigma, sign)
        for loop in (lower, upper)
        for sign in (1, -1)
    ]
    crossed = lower[phi1].subs(sigma, -1)
    meet = assemblies_meet(l3, a1, theta2 - gamma1)
    folded = {a1: l3, theta2: gamma1, beta1: gamma1 + phi1}
    d.step(
        "The lower loop and its assemblies",
        "Angles are in the plane of the arm and measured from the vertical.  The lower arm and a "
        "rod of the same length join the turret to a plate at the elbow.  On the turret and on "
        "the plate their ends are at the distance a1 in the direction gamma1.  The loop equations "
        "have two solutions for the turn phi1 of the plate and the angle beta1 of the rod.  In "
        "the parallelogram the plate does not turn, for any a1 and gamma1.  In the crossed "
        "assembly, an antiparallelogram, it turns.  The assemblies meet if phi1 = 0 in both, that "
        "is, exactly if the loop is flat: sin(theta2 - gamma1) = 0.  The plate is free to turn "
        "only if a1 = l3 and the links coincide, theta2 = gamma1.",
        {
            "0": sp.Matrix(lower.equations),
            r"(\phi_1, \beta_1)_{\text{parallelogram}}": (sp.Integer(0), theta2),
            r"\phi_{1,\text{crossed}}": crossed,
            r"\beta_{1,\text{crossed}}": r"2 \gamma_1 + \phi_{1,\text{crossed}} - \theta_2",
            r"1 - \cos\phi_{1,\text{crossed}}": meet,
        },
        proves=(
            "Both assemblies close the loop, the crossed one has the stated turn and rod angle, "
            "and the turn is free where the links coincide."
        ),
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
        "The upper arm and a second rod join the plate to the wrist bracket, with the distance a2 "
        "between them.  The bracket turns by phi1 + phi2 against the turret; its turn against the "
        "upper arm is joint 4.  In two parallelograms phi1 = phi2 = 0: the distances a1, a2 drop "
        "out, and the bracket stays level.  This is the virtual joint.  If a loop is crossed, the "
        "bracket turns as the arm moves.  The assemblies of the upper loop also meet exactly if "
        "this loop is flat.",
        {
            "0": sp.Matrix(upper.equations),
            r"\theta_4 = \phi_1 + \phi_2 - \theta_2 - \theta_3": bracket - theta2 - theta3,
            r"1 - \cos\phi_{2,\text{crossed}}": meet,
        },
        proves=(
            "In two parallelograms joint 4 is -(theta2 + theta3), and the turn of the crossed "
            "loop is as stated."
        ),
        equal=[
            (bracket - theta2 - theta3, d.couple(real("theta4"))),
            (1 - cos(crossed), meet),
        ],
    )
    return lower, upper


def assemblies_meet(link: sp.Expr, coupler: sp.Expr, bend: sp.Expr) -> sp.Expr:
    """``1 - cos(turn)`` of the crossed assembly: zero exactly if both assemblies coincide."""
    stretch = link**2 + coupler**2 - 2 * link * coupler * cos(bend)
    return 2 * link**2 * sin(bend) ** 2 / stretch
