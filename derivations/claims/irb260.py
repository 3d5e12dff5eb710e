"""Claims of Shi, Zhu and Li about the double parallelogram of the IRB 260 and its virtual joint."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.irb260_arm import (
    ABSTRACT,
    ASSEMBLY,
    BACKGROUND,
    MODELING,
    VERTICAL,
    Palletiser,
    euler_angles,
    stated,
    vector,
)
from closedform.derivations.claims.irb260_equivalence import (
    EQUIVALENT,
    equivalent_readings,
    same_pose,
    valid_readings,
)
from closedform.derivations.claims.irb260_forward import forward, names
from closedform.derivations.claims.irb260_jacobian import jacobian
from closedform.derivations.claims.irb260_verification import conclusions, verification
from sympy import cos, pi, sin

from closedform import (
    Agree,
    Count,
    Derivation,
    Enumeration,
    Every,
    Gravity,
    Identity,
    Not,
    Reading,
    Undecidable,
    Under,
    hat,
    homogeneous,
    inverse,
    real,
    rotation,
    twist_matrix,
    twist_of,
)

CAPTIONS = {
    4: "Simplified structure of IRB260",
    5: "A revolute joint",
    6: "Final simplified structure as an open-chain mechanism",
}


def state(d: Derivation, arm: Palletiser) -> None:
    """Transcribe all claims, in the order of the paper."""
    errata(d)
    introduction(d, arm)
    linkages(d, arm)
    modeling(d, arm)
    virtual_joint(d, arm)
    forward(d, arm)
    jacobian(d, arm)
    verification(d, arm)
    conclusions(d, arm)


def errata(d: Derivation) -> None:
    """What the paper leaves out about the mechanism and its test, and a wrong reference."""
    d.erratum(
        "assembly",
        "Where the parallelograms may become flat is not said",
        Gravity.OMISSION,
        why="Section II says that the links of a loop constitute a parallelogram, whose coupler "
        "does not turn no matter the angle of the input link. But where a parallelogram is flat, "
        "it can become an antiparallelogram, which has the same sides and whose coupler turns. The "
        r"virtual constraint $\theta_4 = -(\theta_2 + \theta_3)$ and all that follows hold for "
        "parallelograms only; the paper gives no ranges of the angles that keep the loops from "
        "becoming flat.",
        use="Nothing changes if stops keep the loops from becoming flat. A simulation, or a design "
        "with other ranges, has to check this itself: after a flat posture the hand may tilt.",
    )
    d.erratum(
        "initial-configuration",
        r"A correct Jacobian does not verify the pose: $g_{st}(0)$ has to be checked too",
        Gravity.OMISSION,
        why=r"The Jacobian determines $g_{st}(\theta)$ up to a constant factor on its right: "
        r"$g_{st}(\theta) C$ has the same spatial Jacobian for every motion $C$. So $g_{st}(0)$ "
        r"has to be checked by itself. The paper does not print it; eq. (13) at $\theta = 0$ shows "
        r"that it has no rotation and the translation $q_5$ of eq. (5). Moreover, the velocity of "
        r"the test does not contain $l_2$ and $l_5$.",
        use="Eq. (13) is right. A reader who tests code in the way of section V would not notice a "
        "wrong height or a wrong orientation of the tool.",
    )
    d.erratum(
        "figure-5",
        "The virtual motor is said to be in Fig. 5, which shows a revolute joint",
        Gravity.MISPRINT,
        why="The caption of Fig. 5 is “A revolute joint”. The robot without its linkage is in Fig. "
        "6, whose caption is “Final simplified structure as an open-chain mechanism”.",
        use="Look at Fig. 6.",
    )


def introduction(d: Derivation, arm: Palletiser) -> None:
    """The abstract and section I."""
    claim = partial(d.claim, where=ABSTRACT)
    claim(
        "two four-bar mechanisms",
        "“This manipulator includes two parallel four-bar mechanisms that make the kinematics and "
        "dynamic analysis complicated.”",
        lambda: Undecidable("the mechanisms are taken from the drawings of the paper; whether "
                            "they make the analysis complicated is a judgement of value"),
        fixed="a drawing and a judgement",
    )  # fmt: skip
    claim(
        "equivalent, abstract",
        "“This method has created the virtual open-chain manipulator that is {equivalent} to the "
        "hybrid manipulator.”",
        readings=equivalent_readings(arm),
        phrases=[EQUIVALENT],
        erratum="assembly",
    )
    claim(
        "correct kinematics",
        "“The simulation results show that this new method results in the {correct} kinematics of "
        "this hybrid manipulator.”",
        lambda holds: same_pose(arm, holds),
        readings=valid_readings(arm),
        phrases=[{"correct": True, "wrong": False}],
        erratum="assembly",
    )
    claim = partial(d.claim, where="I. INTRODUCTION")
    R, p = euler_angles("alpha"), vector("p")
    g, twist = homogeneous(R, p), sp.Matrix([*vector("v"), *vector("w")])
    angles = [real(f"alpha_{i}") for i in range(3)]
    rates = sp.Matrix.hstack(*(twist_of(g.diff(a) * inverse(g))[3:, :] for a in angles))
    w, full = vector("w"), {"w_x": 0, "w_y": 0, "w_z": 2 * pi}
    at_full_turn = {s: full[s.name] for s in w}
    size = sp.sqrt(w.dot(w))
    turn = sp.eye(3) + hat(w) * sin(size) / size + hat(w) ** 2 * (1 - cos(size)) / size**2
    claim(
        "avoid singularities",
        "“One is to {avoid} the singularities introduced by analysis.”",
        phrases=[{"avoid": True, "have": False}],
        readings=[
            Reading(
                "twists describe the velocity at every pose, whereas Euler angles have singular "
                "poses: the twist follows from the velocity of the pose",
                check=lambda avoid: Every(
                    {
                        "the twist follows from the velocity at every pose": stated(
                            avoid,
                            Identity(twist_of(twist_matrix(twist) * g * inverse(g)), twist),
                        ),
                        "the rates of Euler angles do not span the velocities if the middle angle "
                        "is zero": Identity(rates.det().subs(angles[1], 0), sp.S.Zero),
                    }
                ),
            ),
            Reading(
                "the exponential coordinates of a pose have no singularities: after a full turn, "
                "a change of the axis moves the body",
                check=lambda avoid: stated(
                    avoid,
                    Not(
                        Every(
                            {
                                "after a full turn the axis has no effect": Identity(
                                    turn.diff(w[0]).subs(at_full_turn), sp.zeros(3)
                                )
                            }
                        )
                    ),
                ),
            ),
        ],
    )


def linkages(d: Derivation, arm: Palletiser) -> None:
    """Section II."""
    claim = partial(d.claim, where=BACKGROUND)
    crank, coupler, rocker, ground = (real(name, positive=True) for name in "abcg")
    given, output, middle = real("theta"), real("phi"), real("psi")
    four_bar = [
        crank * f(given) + coupler * f(middle) - rocker * f(output) - ground * f(sp.S.Zero)
        for f in (cos, sin)
    ]
    claim(
        "four-bar linkage",
        "“The four-bar linkage is a mechanism such that the input link and output link satisfy "
        "{a given functional relationship}, therefore creating a type of mechanical computer”",
        lambda related: stated(related, Not(Count(four_bar, (output, middle), None))),
        phrases=[{"a given functional relationship": True, "no relationship": False}],
        readings=[
            Reading(
                "the angles of input and output satisfy an equation: for each input there is a "
                "finite number of outputs, one in each assembly"
            )
        ],
    )
    claim(
        "two mechanisms of the robot",
        "“In this robot, there are two parallel four-bar mechanisms forming a double four-bar "
        'mechanism. The coupler of the lower one is the "ground frame" of the upper one.”',
        lambda: Undecidable("taken from the drawing, Fig. 3; the derivation starts from it"),
        fixed="a drawing",
    )
    turn, _ = arm.lower.solution
    sigma, angle = real("sigma"), arm.thetas[1]
    claim(
        "planar translation",
        "“Since the four links constitutes {a parallelogram} and one link is fixed, the coupler "
        "can {only achieve the planar translation} {no matter} the angle that the input link "
        "rotates.”",
        lambda assembly, moving: Every(
            {
                "the loop is closed": Identity(
                    sp.Matrix(arm.lower.equations).subs(arm.lower.solution).subs(sigma, assembly),
                    sp.zeros(2, 1),
                ),
                "the coupler does not turn": Identity(
                    arm.lower[turn].subs(sigma, assembly).diff(angle), moving
                ),
            }
        ),
        phrases=[
            {"a parallelogram": 1, "an antiparallelogram": -1},
            {"only achieve the planar translation": 0, "only turn with the input link": 1},
        ],
        opposites={"no matter": "but not whatever"},
        readings=[
            Reading(
                "the links form a parallelogram, as the sentence says, in all postures; a planar "
                "translation is a motion in the plane without rotation"
            ),
            Reading(
                "for all assemblies of links whose opposite sides are equal",
                check=lambda assembly, moving: Identity(
                    arm.lower[turn].subs(sigma, -assembly).diff(angle), moving
                ),
            ),
        ],
    )
    theta1, *_, theta5 = arm.thetas
    bracket = arm.linkage(arm.bracket())
    claim(
        "parallel translation",
        "“Therefore the end-effector of the robot can {only obtain the parallel translation}.”",
        lambda translates: stated(
            translates, Identity(bracket[:3, :3].subs({theta1: 0, theta5: 0}), sp.eye(3))
        ),
        phrases=[{"only obtain the parallel translation": True, "also obtain a rotation": False}],
        readings=[
            Reading(
                "by the double four-bar mechanism, of which the paragraph speaks: the axes 1 and 5 "
                "are at rest, as the paper says later that they can be ignored temporarily"
            ),
            Reading(
                "by all axes",
                check=lambda translates: stated(translates, Identity(bracket[:3, :3], sp.eye(3))),
            ),
        ],
    )


def modeling(d: Derivation, arm: Palletiser) -> None:
    """Section III, up to the virtual motor."""
    claim = partial(d.claim, where=MODELING)
    plate, rod = arm.lower.solution
    second, other = arm.upper.solution
    free, reach, lift = vector("turn"), vector("a"), real("lift")
    scara = sp.prod(
        homogeneous(rotation("z", angle), rotation("z", angle) * sp.Matrix([length, 0, h]))
        for angle, length, h in zip(free, reach, (0, 0, lift), strict=True)
    )
    claim(
        "not an open chain",
        "“As the description above, this robot is {not} an open-chain system because a rotation of "
        "the end-effector is {confined}.”",
        lambda confined: stated(
            confined, Not(Count(loops_at_posture(arm), (plate, rod, second, other), None))
        ),
        phrases=[{"confined": True, "free": False}],
        opposites={"not": "indeed"},
        readings=[
            Reading(
                "by closed loops, as the section before describes: the equations of the two loops "
                "leave a finite number of turns of the end-effector about the axis X, and an open "
                "chain has no such equations"
            ),
            Reading(
                "a robot whose end-effector cannot turn about all axes is not an open chain: then "
                "a SCARA arm, which is an open chain, would tilt its hand",
                check=lambda confined: stated(
                    confined,
                    Not(Every({"its hand stays level": Identity(scara[:3, 2], VERTICAL)})),
                ),
            ),
        ],
    )
    claim(
        "challenging",
        "“However, solving these equations under the constraints is challenging for this double "
        "four-bar mechanism.”",
        lambda: Undecidable(
            "a judgement of difficulty; the derivation gives both assemblies of each loop in "
            "closed form"
        ),
        fixed="a judgement",
    )
    claim(
        "four motors",
        "“Note that there are {four} motor-driven joints in this robot.”",
        lambda n: Enumeration(n, arm.freedoms, "freedoms of the closed linkage"),
        readings=[Reading("one motor drives each freedom of the closed linkage")],
    )
    claim(
        "axes 1 and 5",
        "“Since {the axis 1 and 5} are {only} rotating along the {z} axis, so they can be ignored "
        "temporarily.”",
        lambda rotations, axis: Every(
            {
                f"{name} turns about it": Identity(
                    twist_of(arm.pose.diff(angle) * inverse(arm.pose))[3:, :], axis
                )
                for name, angle in rotations.items()
            }
        ),
        phrases=[
            {
                "the axis 1 and 5": {"axis 1": arm.thetas[0], "axis 5": arm.thetas[4]},
                "the axis 2 and 3": {"axis 2": arm.thetas[1], "axis 3": arm.thetas[2]},
            },
            {"z": VERTICAL, "x": sp.Matrix([1, 0, 0])},
        ],
        opposites={"only": "not only"},
    )
    turned = arm.linkage(arm.bracket())[:3, :3]
    claim(
        "rotation along X",
        "“Due to the existing double four-bar mechanism, the axis 2 and 3 can {not affect} the "
        "rotation of the end-effector along the X axis.”",
        lambda rests: stated(
            rests,
            Identity([*turned.diff(arm.thetas[1]), *turned.diff(arm.thetas[2])], [0] * 18),
        ),
        phrases=[{"not affect": True, "affect": False}],
    )
    theta4 = arm.thetas[3]
    claim(
        "joint 4",
        "“It is noticed that the join 4 is {not driven by any motor}. However, it can rotate "
        "{a special angle} to make the end-effector keep {horizontal} due to the parallel "
        "mechanism.”",
        lambda passive, n, normal: Every(
            {
                "it needs no motor": Enumeration(
                    passive,
                    lambda: bool(arm.driving_sets()),
                    "the rates of others determine its own",
                ),
                "its angle follows from the level hand": Count(
                    list(arm.free[:3, :3] * normal - VERTICAL), (theta4,), n
                ),
            }
        ),
        phrases=[
            {"not driven by any motor": True, "driven by a motor": False},
            {"a special angle": 1, "any angle": None},
            {"horizontal": VERTICAL, "upright": sp.Matrix([0, 1, 0])},
        ],
    )


def loops_at_posture(arm: Palletiser) -> list[sp.Expr]:
    """The equations of both loops at a posture and with unequal dimensions."""
    plate, rod = arm.lower.solution
    second, other = arm.upper.solution
    equations = [*arm.lower.equations, *arm.upper.equations]
    unknown = {plate, rod, second, other}
    known = sorted({s for e in equations for s in e.free_symbols} - unknown, key=str)
    angles = {s: 0 for s in known if not s.is_positive}
    angles |= {arm.thetas[1]: pi / 2, arm.thetas[2]: -pi / 2}
    sizes = {s: sp.Integer(2 + k) for k, s in enumerate(s for s in known if s.is_positive)}
    return [e.subs(angles | sizes) for e in equations]


def virtual_joint(d: Derivation, arm: Palletiser) -> None:
    """Section III, the virtual motor."""
    claim = partial(d.claim, where=MODELING)
    _, theta2, theta3, *_ = arm.thetas
    claim(
        "Fig. 5",
        "“Let us image that we delete the double four-bar system but add a virtual motor for "
        "actuating the join 4, as shown in Fig. {5}.”",
        lambda printed: Agree(
            sp.Integer(printed),
            sp.Integer(next(k for k, caption in CAPTIONS.items() if "open-chain" in caption)),
            ("the number of the figure", "the figure of the open chain, by its caption,"),
        ),
        phrases=[{str(k): k for k in CAPTIONS}],
        corrected="“Let us image that we delete the double four-bar system but add a virtual motor "
        "for actuating the join 4, as shown in Fig. {6}.”",
        erratum="figure-5",
    )
    claim(
        "virtual constraint",
        r"“It is assumed that this virtual motor {always} rotates the same amount of the angle as "
        r"the summation of rotation angles of the joint 2 and joint 3 but in an opposite "
        r"direction, i.e., $\theta_4 = -(\theta_2 + \theta_3)$.”",
        notation=names(arm),
        means={r"\theta_4": arm.bracket() - theta2 - theta3},
        opposites={"always": "not always"},
        readings=[
            Reading(
                "the two loops are parallelograms",
                check=lambda f: Under(Identity(f.left, f.right), ASSEMBLY),
            ),
            Reading(
                "the lower loop may be crossed",
                means={r"\theta_4": arm.bracket(lower=-1) - theta2 - theta3},
                check=lambda f: Identity([cos(f.left), sin(f.left)], [cos(f.right), sin(f.right)]),
            ),
        ],
        erratum="assembly",
    )
    spun = arm.moves[1] * arm.moves[2]
    across = sp.Matrix([1, 0, 0])
    claim(
        "axis X",
        "“This assumption is reasonable because in this case the virtual motor can {counteract} "
        "the rotation that [...] the motor 2 and motor 3 give along the axis {X} such that the "
        "motion of the end-effector can also keep horizontal.”",
        lambda sign, axis: Every(
            {
                "motors 2 and 3 turn about this axis": Identity(spun[:3, :3] * axis, axis),
                "the virtual motor cancels their rotation": Identity(
                    spun[:3, :3] * arm.couple(arm.moves[3])[:3, :3] ** sign, sp.eye(3)
                ),
            }
        ),
        phrases=[{"counteract": 1, "double": -1}, {"X": across, "Y": sp.Matrix([0, 1, 0])}],
        readings=[
            Reading(
                "the axis X of the turret; the paper ignores axis 1 at this place and draws the "
                "robot at home"
            ),
            Reading(
                "the axis X of the base, at all angles of the turret",
                check=lambda _, axis: Identity(
                    (arm.moves[0] * spun * inverse(arm.moves[0]))[:3, :3] * axis, axis
                ),
            ),
        ],
    )
    screws = sp.Matrix.hstack(*arm.twists)
    claim(
        "equivalent open chain",
        "“Instead the robot mechanism is transformed to an {equivalent} open-chain loop with "
        "{five} axes as shown in Fig. 4.”",
        phrases=[EQUIVALENT],
        readings=[
            Reading(
                reading.text,
                check=lambda holds, n, check=reading.check: Every(
                    {
                        "the pose is the same": check(holds),
                        "the axes of the chain are independent": Enumeration(
                            n, lambda: screws.rank(), "independent twists"
                        ),
                    }
                ),
            )
            for reading in equivalent_readings(arm)
        ],
        erratum="assembly",
    )
