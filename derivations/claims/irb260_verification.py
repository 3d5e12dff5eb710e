"""Sections V and VI of Shi, Zhu and Li: the test and the conclusions."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.irb260_arm import (
    CONCLUSIONS,
    VERIFICATION,
    Palletiser,
    stated,
    vector,
)
from closedform.derivations.claims.irb260_equivalence import (
    EQUIVALENT,
    equivalent_readings,
    valid_readings,
)

from closedform import (
    Derivation,
    Every,
    Identity,
    Not,
    Reading,
    Undecidable,
    Under,
    homogeneous,
    inverse,
    real,
    rotation,
    twist_matrix,
    twist_of,
)


def verification(d: Derivation, arm: Palletiser) -> None:
    """Section V."""
    claim = partial(d.claim, where=VERIFICATION)
    offset, alpha = vector("h"), real("alpha")
    mounted = arm.pose * homogeneous(rotation("z", alpha), offset)
    theirs = sp.Matrix.hstack(*(twist_of(mounted.diff(q) * inverse(mounted)) for q in arm.actuated))
    at_home = dict.fromkeys(arm.actuated, 0)
    back = inverse(arm.pose)
    columns = [twist_matrix(arm.J_space[:, i]) for i in range(4)]
    claim(
        "checking the Jacobian",
        "“If we can check that the Jacobian matrix is {correct}, {all} the kinematics problems "
        "talked above can be verified.”",
        phrases=[{"correct": 1, "correct up to its sign": -1}],
        opposites={"all": "not all"},
        readings=[
            Reading(
                r"the initial configuration $g_{st}(0)$ is taken to be right: then $g^{-1} h$ is "
                r"constant for each pose $h$ that has the Jacobian of the pose $g$",
                check=lambda factor: Under(
                    Every(
                        {
                            f"with respect to joint {i}": Identity(
                                back.diff(q) + factor * back * column, sp.zeros(4)
                            )
                            for i, q, column in zip(
                                (1, 2, 3, 5), arm.actuated, columns, strict=True
                            )
                        }
                    ),
                    r"$g_{st}(0)$ is checked too",
                ),
            ),
            Reading(
                "the Jacobian alone: no hand that is mounted elsewhere has the same Jacobian and "
                "another pose",
                check=lambda factor: Not(
                    Every(
                        {
                            "the Jacobian is the same": Identity(theirs, factor * arm.J_space),
                            "the pose is another one": Not(
                                Identity(mounted.subs(at_home), arm.pose.subs(at_home))
                            ),
                            "the velocity of the test contains neither $l_2$ nor $l_5$": Identity(
                                [e.diff(s) for e in arm.velocity for s in arm.lengths[1::3]],
                                [0] * 6,
                            ),
                        }
                    )
                ),
            ),
        ],
        erratum="initial-configuration",
    )
    speeds = {rf"\omega_{i}": rate for i, rate in zip((1, 2, 3, 5), arm.rates, strict=True)}
    claim(
        "ω_5",
        r"“$\omega_5 = 0$ (because it has {no effect} on the $v_{q_5}^s$)”",
        lambda f, still, v: stated(still, Identity(v.left.subs(f.left, f.right), v.left)),
        means={**speeds, "v_{q_5}^s": (arm.V * arm.pose[:, 3])[:3, :]},
        phrases=[{"no effect": True, "an effect": False}],
        fixed="a rate that has no effect may have any value; the paper chooses 0",
    )
    for label, printed, reason in (
        (
            "Fig. 7",
            "“From this comparison it is obvious to see that two groups of curves are almost the "
            "same, Fig. 7.”",
            "curves in a figure, without dimensions, start or numbers; the calculated curves are "
            "derived as a table, for the dimensions of public models",
        ),
        (
            "Fig. 8",
            "“Fig. 8 shows the subtle difference in the corresponding directions.”",
            "a figure",
        ),
        (
            "source of the errors",
            "“These little errors are identified from the modeling or calculation approximation in "
            "ADAMS® and MATLAB®.”",
            "no number of either program is printed",
        ),
    ):
        claim(label, printed, partial(Undecidable, reason), fixed="figures without numbers")
    claim(
        "valid technique",
        "“Hence it is concluded that the new proposed technique is {valid} for the hybrid "
        "manipulator.”",
        phrases=[{"valid": True, "invalid": False}],
        readings=valid_readings(arm),
        erratum="assembly",
    )


def conclusions(d: Derivation, arm: Palletiser) -> None:
    """The last section."""
    claim = partial(d.claim, where=CONCLUSIONS)
    claim(
        "equivalent, conclusions",
        "“The system can be changed into an {equivalent} open-chain mechanism with these "
        "assumptions”",
        phrases=[EQUIVALENT],
        readings=equivalent_readings(arm),
        erratum="assembly",
    )
    for label, printed, reason in (
        (
            "simpler",
            "“and then everything becomes simpler to calculate.”",
            "a judgement of value",
        ),
        (
            "verified",
            "“The method is verified using MATLAB® and ADAMS®.”",
            "a report on programs that are not printed",
        ),
        (
            "other mechanisms",
            "“It can also be widely extended to other hybrid mechanisms, especially more-than-one "
            "four-bar linkage.”",
            "the paper names no other mechanism",
        ),
    ):
        claim(label, printed, partial(Undecidable, reason), fixed="no statement of mathematics")
