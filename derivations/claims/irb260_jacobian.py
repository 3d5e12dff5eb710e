"""Section IV B of Shi, Zhu and Li: velocities and the spatial Jacobian, eqs. (14) to (23)."""

from functools import partial
from typing import Any

import sympy as sp
from closedform.derivations.claims.irb260_arm import (
    FIVE,
    JACOBIAN,
    Palletiser,
    each,
    euler_angles,
    stated,
    vector,
)
from sympy import pi

from closedform import (
    Agree,
    Derivation,
    Enumeration,
    Equal,
    Every,
    Gravity,
    Identity,
    Indexed,
    Not,
    Notation,
    Reading,
    Relation,
    adjoint,
    exponential,
    homogeneous,
    inverse,
    real,
    simplest,
    twist_matrix,
    twist_of,
)

BEFORE = r"e^{\hat{\xi}_1 \theta_1} \dots e^{\hat{\xi}_{i-1} \theta_{i-1}}"
BACK = r"e^{-\hat{\xi}_{i-1} \theta_{i-1}} \dots e^{-\hat{\xi}_1 \theta_1}"
FROM_I = r"e^{\hat{\xi}_i \theta_i} \dots e^{\hat{\xi}_n \theta_n}"
PRIMED_BEFORE = r"e^{\hat{\xi}_1' \theta_1} \dots e^{\hat{\xi}_{i-1}' \theta_{i-1}}"
PRIMED_BACK = r"e^{-\hat{\xi}_{i-1}' \theta_{i-1}} \dots e^{-\hat{\xi}_1' \theta_1}"
PRIMED_FROM_I = r"e^{\hat{\xi}_i' \theta_i} \dots e^{\hat{\xi}_n' \theta_n}"
FIVE_TERMS = (
    r"\left(\frac{\partial g_{st}}{\partial \theta_1} g_{st}^{-1}(\theta) \right) \dot{\theta}_1 + "
    r"\left(\frac{\partial g_{st}}{\partial \theta_2} g_{st}^{-1}(\theta) \right) \dot{\theta}_2 + "
    r"\left(\frac{\partial g_{st}}{\partial \theta_3} g_{st}^{-1}(\theta) \right) \dot{\theta}_3 "
    r"\\ "
)


def jacobian(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (14) to (23)."""
    frames = [sp.prod([sp.eye(4), *arm.moves[:i]]) for i in range(5)]
    moved = [simplest(adjoint(T) * xi) for T, xi in zip(frames, arm.twists, strict=True)]
    actuated(d, arm, moved)
    velocities(d, arm)
    columns(d, arm, moved)
    moved_twists(d, arm, moved)
    adjoints(d, arm)
    point(d, arm, moved)


def actuated(d: Derivation, arm: Palletiser, moved: list[sp.Matrix]) -> None:
    """The sentence before eq. (14)."""
    screws = sp.Matrix.hstack(*moved)
    generic = dict(zip(arm.thetas, [pi / 6] * 5, strict=True))
    claim = partial(d.claim, where=JACOBIAN)
    slope = arm.rate(arm.pose)
    claim(
        "spatial Jacobian",
        "“Spatial Jacobian matrix represents the relationship between the velocity of the joint "
        "angles and the end-effector. The word spatial here means relative to the {inertial} "
        "coordinate frame.”",
        lambda velocity: Identity(arm.J_space * arm.rates, velocity),
        phrases=[
            {
                "inertial": twist_of(slope * inverse(arm.pose)),
                "body": twist_of(inverse(arm.pose) * slope),
            }
        ],
    )
    claim(
        "actuated joints",
        "“Although there are {five} joints in this model, {only} {four} of them, the joints "
        "{1, 2, 3, and 5}, are actuated.”",
        lambda five, four, joints: Every(
            {
                "the chain has this many joints": Enumeration(
                    five,
                    lambda: screws.subs(generic).rank(),
                    "independent twists of the open chain",
                ),
                "this many are actuated": Enumeration(
                    four, arm.freedoms, "freedoms of the closed linkage"
                ),
                "their rates determine the others": Enumeration(
                    [joints],
                    arm.driving_sets,
                    "sets of joints without joint 4 whose rates determine all rates",
                ),
            }
        ),
        phrases=[{"1, 2, 3, and 5": (1, 2, 3, 5), "1, 2, 3, and 4": (1, 2, 3, 4)}],
        opposites={"only": "not only"},
        readings=[
            Reading(
                "joint 4 has no motor, as section III says; the rates of the actuated joints "
                "determine all others, and their number is the number of freedoms"
            )
        ],
    )
    coupled = arm.couple(screws)
    claim(
        "transformation",
        "“Therefore, we {must} make some mathematic transformation on spatial Jacobian calculation "
        "of open-chain manipulators.”",
        lambda must: stated(
            must,
            Not(
                Every(
                    {
                        "the twists of the joints 1, 2, 3, 5 of the chain are the columns": (
                            Identity(coupled.extract(range(6), [0, 1, 2, 4]), arm.J_space)
                        )
                    }
                )
            ),
        ),
        phrases=[{"must": True, "need not": False}],
    )


def velocities(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (14) and (15)."""
    g = arm.couple(arm.chain)
    slope, back = arm.rate(g), inverse(g)
    meanings = {
        r"\hat{V}_{st}^s": arm.V,
        r"\dot{V}_{st}^s": arm.V,
        r"g_{st}(\theta)": g,
        r"\dot{g}_{st}(\theta)": slope,
        r"g_{st}^{-1}(\theta)": back,
        r"\dot{g}_{st}^{-1}(\theta)": arm.rate(back),
        **rate_names(arm),
    }
    accelerations = sp.Matrix([real(f"a_{i}") for i in FIVE[:4]])
    d.erratum(
        "dot-of-eq-14",
        "The dots of eq. (14) are on the wrong letters",
        Gravity.MISPRINT,
        why=r"The spatial velocity is $\dot{g} g^{-1}$. Eq. (14) differentiates the inverse "
        r"instead, and since $g \frac{d}{dt}(g^{-1}) = -\dot{g} g^{-1}$, its right side is the "
        r"velocity with the wrong sign; the inverse of $\dot{g}$, the other way to read it, does "
        r"not exist, because the last row of $\dot{g}$ is zero. The dot on the left side is the "
        r"hat of eqs. (15) and (23).",
        use="Eq. (15) goes on with the right form. Code that follows eq. (14) as printed gets "
        "every velocity with the wrong sign.",
    )
    claim = partial(d.claim, where=JACOBIAN)
    claim(
        "eq. (14)",
        r"“the instantaneous velocity of the end-effector is given by the twist as, "
        r"$\dot{V}_{st}^s = g_{st}(\theta) \dot{g}_{st}^{-1}(\theta)$”",
        means=meanings,
        readings=[
            Reading(
                r"$\dot{g}_{st}^{-1}$ is the time derivative of the inverse, and $\dot{V}_{st}^s$ "
                "the velocity, which eqs. (15) and (23) write with a hat"
            ),
            Reading(
                r"$\dot{g}_{st}^{-1}$ is the inverse of the time derivative; the statement judged "
                "is that this inverse exists",
                check=lambda _: Not(
                    Every({"the determinant of the derivative is zero": Identity(slope.det(), 0)})
                ),
            ),
            Reading(
                r"$\dot{V}_{st}^s$ is the time derivative of the velocity",
                means={
                    r"\dot{V}_{st}^s": arm.rate(arm.V) + twist_matrix(arm.J_space * accelerations)
                },
            ),
        ],
        corrected=r"“the instantaneous velocity of the end-effector is given by the twist as, "
        r"$\hat{V}_{st}^s = \dot{g}_{st}(\theta) g_{st}^{-1}(\theta)$”",
        erratum="dot-of-eq-14",
    )
    claim(
        "eq. (15)",
        r"$\begin{aligned} \hat{V}_{st}^s &= \sum_{i=1}^5 \left(\frac{\partial g_{st}}{\partial "
        r"\theta_i} \dot{\theta}_i \right) g_{st}^{-1}(\theta) = \sum_{i=1}^5 "
        r"\left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1}(\theta) \right) "
        rf"\dot{{\theta}}_i \\ &= {FIVE_TERMS} &\quad + "
        r"\left(\frac{\partial g_{st}}{\partial \theta_4} g_{st}^{-1}(\theta) \right) "
        r"\dot{\theta}_4 + \left(\frac{\partial g_{st}}{\partial \theta_5} g_{st}^{-1}(\theta) "
        r"\right) \dot{\theta}_5 \end{aligned}$",
        means={r"\hat{V}_{st}^s": velocity_along_a_path(arm), **partials(arm)},
    )


def columns(d: Derivation, arm: Palletiser, moved: list[sp.Matrix]) -> None:
    """Eqs. (16) to (18)."""
    claim = partial(d.claim, where=JACOBIAN)
    claim(
        "eq. (16)",
        r"$\left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1} \right)^v = \xi_i'$",
        means=partials(arm)
        | {
            r"\frac{\partial g_{st}}{\partial \theta_i}": each(
                arm.chain.diff(angle) for angle in arm.thetas
            ),
            r"\xi_i'": each(moved),
            r"\xi_i": each(arm.twists),
            "^v": coordinates,
        },
    )
    twists = {rf"\xi_{i}'": arm.couple(xi) for i, xi in enumerate(moved, 1)}
    hats = {rf"\hat{{\xi}}_{i}'": twist_matrix(xi) for i, xi in enumerate(moved, 1)}
    claim(
        "eq. (17)",
        rf"“Then applying the condition $\theta_4 = -(\theta_2 + \theta_3)$, the Equation (15) "
        rf"becomes, $\begin{{aligned}} &{FIVE_TERMS} &+ "
        r"\left(\frac{\partial g_{st}}{\partial \theta_4} g_{st}^{-1}(\theta) \right) "
        r"\dot{\theta}_4 + \left(\frac{\partial g_{st}}{\partial \theta_5} g_{st}^{-1}(\theta) "
        r"\right) \dot{\theta}_5 \\ &= \hat{\xi}_1' \dot{\theta}_1 + \hat{\xi}_2' \dot{\theta}_2 + "
        r"\hat{\xi}_3' \dot{\theta}_3 + \hat{\xi}_4' (-\dot{\theta}_2 - \dot{\theta}_3) + "
        r"\hat{\xi}_5' \dot{\theta}_5 \\ &= \hat{\xi}_1' \dot{\theta}_1 + (\hat{\xi}_2' - "
        r"\hat{\xi}_4') \dot{\theta}_2 + (\hat{\xi}_3' - \hat{\xi}_4') \dot{\theta}_3 + "
        r"\hat{\xi}_5' \dot{\theta}_5 \\ &= \begin{bmatrix} \hat{\xi}_1' & \hat{\xi}_2' - "
        r"\hat{\xi}_4' & \hat{\xi}_3' - \hat{\xi}_4' & \hat{\xi}_5' \end{bmatrix} \dot{\theta} "
        r"\end{aligned}$”",
        lambda condition, f: at_condition(condition, f, arm),
        means={
            **partials(arm),
            **hats,
            **{rf"\theta_{i}": angle for i, angle in enumerate(arm.thetas, 1)},
            r"\dot{\theta}": blocks_of(arm.rates),
        },
        readings=[
            Reading(
                "the last line is a row of four blocks, each of which is multiplied by one rate; "
                r"$\dot{\theta}$ has the rates of the joints 1, 2, 3 and 5"
            )
        ],
    )
    by_differentiation = sp.Matrix.hstack(
        *(twist_of(arm.pose.diff(angle) * inverse(arm.pose)) for angle in arm.actuated)
    )
    meanings = {
        "V_{st}^s": twist_of(arm.rate(arm.pose) * inverse(arm.pose)),
        r"J_{st}^s(\theta)": by_differentiation,
        r"\dot{\theta}": arm.rates,
        **twists,
    }
    claim("V, before eq. (18)", r"$V_{st}^s = J_{st}^s(\theta) \dot{\theta}$", means=meanings)
    claim(
        "eq. (18)",
        r"$J_{st}^s(\theta) = \begin{bmatrix} \xi_1' & \xi_2' - \xi_4' & \xi_3' - \xi_4' & \xi_5' "
        r"\end{bmatrix}$",
        means=meanings,
    )


def moved_twists(d: Derivation, arm: Palletiser, moved: list[sp.Matrix]) -> None:
    """Eqs. (19) and (20)."""
    g = arm.chain
    primed = [exponential(xi, angle) for xi, angle in zip(moved, arm.thetas, strict=True)]
    before, after, back = runs(arm.moves)
    primed_before, primed_after, primed_back = runs(primed)
    meanings: dict[str, Any] = {
        r"\frac{\partial g_{st}}{\partial \theta_i}": each(g.diff(q) for q in arm.thetas),
        "g_{st}^{-1}": inverse(g),
        "g_{st}(0)": g.subs(dict.fromkeys(arm.thetas, 0)),
        r"\dot{\theta}_i": each(arm.five_rates),
        **rate_names(arm),
        BEFORE: before,
        FROM_I: after,
        BACK: back,
        PRIMED_BEFORE: primed_before,
        PRIMED_FROM_I: primed_after,
        PRIMED_BACK: primed_back,
        r"\hat{\xi}_i": each(twist_matrix(xi) for xi in arm.twists),
        r"\hat{\xi}_i'": each(twist_matrix(xi) for xi in moved),
        r"\xi_i": each(arm.twists),
        r"\xi_i'": each(moved),
        rf"Ad_{{({BEFORE})}}": before.map(adjoint),
        rf"Ad_{{({PRIMED_BEFORE})}}": primed_before.map(adjoint),
        "^v": coordinates,
    }
    claim = partial(d.claim, where=JACOBIAN, notation=Notation(meanings))
    d.erratum(
        "moved-twice",
        "Eqs. (19) and (20) move the twists a second time: their primes must be dropped",
        Gravity.MOTION,
        why=r"By eq. (16) the primed twist $\xi_i'$ is the twist in the present posture, so the "
        "motions of the joints before it are already in it. Eqs. (19) and (20) exponentiate "
        r"and move primed twists again, so that $\xi_i'$ even appears on both sides of eq. "
        r"(20). What is moved is the twist $\xi_i$ at home, of eqs. (1) to (5) and (9).",
        use=r"Eq. (20) is the formula by which the paper computes the columns of the Jacobian. "
        r"With its primes each axis is turned twice: at $\theta_1 = 90^\circ$ the axis of joint 2 "
        r"points along $x$ instead of $-y$, and a velocity or a control law computed from it is "
        "wrong in direction.",
    )
    text = (
        r"$\begin{{aligned}} \left(\frac{{\partial g_{{st}}}}{{\partial \theta_i}} g_{{st}}^{{-1}} "
        r"\right) \dot{{\theta}}_i &= \left({before} {hat} {after} g_{{st}}(0) g_{{st}}^{{-1}} "
        r"\right) \dot{{\theta}}_i \\ &= \left({before} {hat} {back} \right) \dot{{\theta}}_i "
        r"\end{{aligned}}$"
    )
    claim(
        "eq. (19)",
        text.format(
            before=PRIMED_BEFORE, hat=r"\hat{\xi}_i'", after=PRIMED_FROM_I, back=PRIMED_BACK
        ),
        last_line_first,
        corrected=text.format(before=BEFORE, hat=r"\hat{\xi}_i", after=FROM_I, back=BACK),
        erratum="moved-twice",
    )
    text = (
        r"$\xi_i' = \left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1} \right)^v = Ad_{("
    )
    claim(
        "eq. (20)",
        rf"{text}{PRIMED_BEFORE})}} \hat{{\xi}}_i'$",
        means={r"\hat{\xi}_i'": each(moved)},
        readings=[
            Reading(
                "what Ad multiplies is meant to be the column of the six coordinates, without the "
                "hat"
            )
        ],
        corrected=rf"{text}{BEFORE})}} \xi_i$",
        erratum="moved-twice",
    )
    d.erratum(
        "hat-under-ad",
        "In eq. (20) Ad multiplies a 4x4 matrix",
        Gravity.MISPRINT,
        why=r"By eq. (21) $Ad_g$ is a 6x6 matrix, so it multiplies the six coordinates $\xi_i$ of "
        r"a twist. The hat in eq. (20) makes them the 4x4 matrix of eq. (8).",
        use="With the hat the product is not defined; without the hat it is.",
    )
    size = {
        rf"Ad_{{({PRIMED_BEFORE})}}": lambda factor: sp.Matrix(
            [adjoint(arm.moves[0]).cols, factor]
        ),
        rf"Ad_{{({BEFORE})}}": lambda factor: sp.Matrix([adjoint(arm.moves[0]).cols, factor]),
        r"\hat{\xi}_i'": sp.Integer(twist_matrix(arm.twists[0]).rows),
        r"\xi_i'": sp.Integer(arm.twists[0].rows),
        r"\xi_i": sp.Integer(arm.twists[0].rows),
    }
    claim(
        "hat in eq. (20)",
        rf"$Ad_{{({PRIMED_BEFORE})}} \hat{{\xi}}_i'$",
        lambda f: Agree(
            *f.left,
            names=("the number of columns of Ad by eq. (21)", "that of the rows it multiplies"),
        ),
        means=size,
        corrected=rf"$Ad_{{({BEFORE})}} \xi_i$",
        erratum="hat-under-ad",
    )


def adjoints(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (21) and (22)."""
    claim = partial(d.claim, where=JACOBIAN)
    R, p, x = euler_angles("alpha"), vector("p"), vector("x")
    xi = sp.Matrix([*vector("v"), *vector("w")])
    g = homogeneous(sp.eye(3), p) * homogeneous(R)
    conjugated = twist_of(g * twist_matrix(xi) * inverse(g))
    cross = sp.Matrix.hstack(*(p.cross(sp.eye(3)[:, k]) for k in range(3)))
    names = {"R": R, "p": p, r"\hat{p}": cross}
    claim(
        "eq. (21)",
        r"$Ad_g = \begin{bmatrix} R & \hat{p}R \\ 0 & R \end{bmatrix}$",
        means={"Ad_g": conjugated.jacobian(xi), **names},
    )
    claim(
        "eq. (22)",
        r"$g = \begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}$",
        lambda f: Every(
            {
                "the two sides are equal": Equal(f),
                "it moves points": Identity(
                    f.right * sp.Matrix([*x, 1]), sp.Matrix([*(R * x + p), 1])
                ),
            }
        ),
        means={"g": g, **names},
    )


def point(d: Derivation, arm: Palletiser, moved: list[sp.Matrix]) -> None:
    """Eq. (23), and the sentence before it."""
    claim = partial(d.claim, where=JACOBIAN)
    xi = [arm.couple(column) for column in moved]
    found = sp.Matrix.hstack(xi[0], xi[1] - xi[3], xi[2] - xi[3], xi[4])
    claim(
        "Jacobian solved",
        "“Therefore the spatial manipulator Jacobian for this manipulator {can} be solved.”",
        lambda solved: stated(
            solved, Identity(found * arm.rates, twist_of(arm.rate(arm.pose) * inverse(arm.pose)))
        ),
        phrases=[{"can": True, "can not": False}],
        readings=[Reading("by eqs. (18) and (20) to (22), where (20) moves the twists at home")],
    )
    position = arm.couple(arm.chain)[:, 3]
    at_home = position.subs(dict.fromkeys(arm.actuated, 0))
    meanings = {
        "v_{q_5}^s": arm.rate(position),
        r"\hat{V}_{st}^s": arm.V,
        "q_5^s": position,
        "q_5": at_home,
        **rate_names(arm),
    }
    claim(
        "eq. (23)",
        r"$v_{q_5}^s = \hat{V}_{st}^s q_5^s$",
        means=meanings,
        readings=[
            Reading(
                "$q_5^s$ has the homogeneous coordinates of the origin of the end-effector in the "
                "present posture, in the spatial frame; the index s says so"
            ),
            Reading("$q_5^s$ is the constant $q_5$ of eq. (5)", means={"q_5^s": at_home}),
        ],
    )
    d.erratum(
        "two-points-q5",
        "Two points have the name $q_5$: that of eq. (5) is fixed, that of eq. (23) moves",
        Gravity.INCONSISTENCY,
        why="In eq. (5) $q_5$ is a constant, the position of the origin of the end-effector at "
        "home. In eq. (23) $q_5$ is this origin itself, which moves with the arm: $q_5^s = "
        r"g_{st}(\theta) (0, 0, 0, 1)^T$, the last column of eq. (13). The two are equal only "
        "while the end-effector is at its home position.",
        use="With the point of eq. (5), eq. (23) gives the velocity of the point of the moving "
        r"body that is just at the home position of the end-effector. At $\theta_1 = "
        r"90^\circ$, with the turret turning, this velocity is along $x$ instead of $y$.",
    )
    claim(
        "q_5, before eq. (23)",
        "“The velocity of the origin of the end-effector $q_5$ relative to the spatial (inertial) "
        "frame is then given by”",
        lambda f: Agree(
            f.left,
            position,
            ("the point of the formula", "the origin of the end-effector"),
        ),
        means=meanings,
        corrected="“The velocity of the origin of the end-effector $q_5^s$ relative to the spatial "
        "(inertial) frame is then given by”",
        erratum="two-points-q5",
    )


def partials(arm: Palletiser) -> dict[str, Any]:
    """The names of eq. (15), with five independent joints."""
    g = arm.chain
    found: dict[str, Any] = {r"g_{st}^{-1}(\theta)": inverse(g), "g_{st}^{-1}": inverse(g)}
    found |= rate_names(arm)
    for i, angle in enumerate(arm.thetas, 1):
        found[rf"\frac{{\partial g_{{st}}}}{{\partial \theta_{i}}}"] = g.diff(angle)
    return found


def velocity_along_a_path(arm: Palletiser) -> sp.Matrix:
    """The spatial velocity, by differentiation with respect to time along straight paths."""
    time, g = real("t"), arm.chain
    pairs = zip(arm.thetas, arm.five_rates, strict=True)
    return g.xreplace({q: q + rate * time for q, rate in pairs}).diff(time).subs(time, 0) * inverse(
        g
    )


def runs(moves: list[sp.Matrix]) -> tuple[Indexed, Indexed, Indexed]:
    """For each joint the product of the motions before it, of the others, and of the way back."""
    before = Indexed(FIVE, lambda i: sp.prod([sp.eye(4), *moves[: i - 1]]))
    after = Indexed(FIVE, lambda i: sp.prod(moves[i - 1 :]))
    return before, after, before.map(inverse)


def coordinates(value: Any) -> Any:
    """The printed operator v: the six coordinates of a twist."""
    return value.map(twist_of) if isinstance(value, Indexed) else twist_of(value)


def blocks_of(rates: sp.Matrix) -> sp.Matrix:
    """A column of rates that multiplies a row of 4x4 blocks."""
    return sp.Matrix.vstack(*(rate * sp.eye(4) for rate in rates))


def at_condition(condition: Relation, f: Relation, arm: Palletiser) -> Equal:
    """The equation for rates that keep the printed condition."""
    q, rates = arm.thetas, arm.five_rates
    slope = sum((condition.right.diff(a) * r for a, r in zip(q, rates, strict=True)), sp.S.Zero)
    kept = dict(zip(q, rates, strict=True))[condition.left]
    return Equal(f, on={condition.left: condition.right, kept: slope})


def last_line_first(f: Relation) -> Equal:
    """The equations of a formula of two lines; a fault of the last line is easier to check."""
    last = Relation((f.left, f.right), ("=",), (f.texts[0], f.texts[-1]))
    return Equal((last, Relation(f.sides[:2], ("=",), f.texts[:2])))


def rate_names(arm: Palletiser) -> dict[str, sp.Symbol]:
    """The printed names of the rates, also for the evidence."""
    return {rf"\dot{{\theta}}_{i}": rate for i, rate in enumerate(arm.five_rates, 1)}
