"""Claims of Rao and Raju about the H6AR: abstract, introduction, description and mobility."""

from functools import partial
from typing import Any

import sympy as sp
from closedform.derivations.claims import h6ar_forward, h6ar_inverse, h6ar_wrist
from closedform.derivations.claims.h6ar_robot import Robot, notation
from closedform.derivations.h6ar_mechanism import Dimensions, Joints, product
from sympy import cos, pi, sin

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Equal,
    Every,
    Gravity,
    Identity,
    Notation,
    Reading,
    Relation,
    Undecidable,
    Under,
    denavit_hartenberg,
    equal,
    real,
    rotation,
)

INTRODUCTION = "1 Introduction"
VALUE = "no computation can decide a judgement of value"
DESCRIPTION = "2 Description of the H6AR"


def state(d: Derivation, m: Dimensions, q: Joints) -> None:
    """Transcribe the claims, in the order of the paper."""
    r = Robot(m, q, {p.symbol: p.value for p in d.parameters})
    printed = notation(r)
    # the errata, the gravest first
    h6ar_inverse.errors(d)
    h6ar_forward.wrong_frames(d, r)
    h6ar_wrist.error(d, r)
    h6ar_forward.wrong_averages(d, r)
    overview(d, r, printed)
    description(d, r, printed)
    mobility(d, printed)
    tips(d, r, printed)
    h6ar_forward.state(d, r, printed)
    h6ar_wrist.state(d, r, printed)
    h6ar_inverse.state(d, r, printed)


def driven(r: Robot, angles: tuple[str, ...], joints: tuple[sp.Symbol, ...]) -> Check:
    """Some of yaw, roll and pitch depend on exactly these joints."""
    of = r.tangents | {"pitch": r.q.theta}
    return Enumeration(
        ", ".join(j.name for j in r.q if j in joints),
        lambda: ", ".join(j.name for j in r.q if any(not equal(of[a].diff(j), 0) for a in angles)),
        f"the joints on which {' and '.join(angles)} depend{'s' * (len(angles) == 1)}",
    )


def overview(d: Derivation, r: Robot, printed: Notation) -> None:
    """Abstract, introduction and conclusions."""
    claim = partial(d.claim, where="Abstract", notation=printed)
    q, normal = r.q, r.lateral
    arms = r.arm_joints

    def task_rank() -> int:
        # the length of the wrist does not change there: its derivative by the yaw is zero
        state = (q.theta1, r.A2, r.A3, r.psi, r.phi, q.theta)
        averages = (q.theta2R + q.theta2L) / 2, (q.theta3R + q.theta3L) / 2
        outer = r.derivative([*r.tip, *state[3:]], state)
        inner = r.derivative([q.theta1, *averages, *r.tangents.values(), q.theta], q)
        return int((outer * inner).rank())

    claim(
        "6-DOF",
        "“a hybrid {6-DOF} robotic manipulator”",
        lambda n: Enumeration(n, task_rank, "the rank of the Jacobian of tip, yaw, roll and pitch"),
        phrases=[{"6-DOF": 6, "5-DOF": 5}],
    )
    planes = {"vertical plane": (normal, 0), "horizontal plane": (sp.Matrix([0, 0, 1]), 1)}
    claim(
        "twin arms",
        "“The H6AR consists of twin {2-DOF} anthropomorphic arms that can move in the {vertical "
        "plane}.”",
        lambda n, plane: Every(
            {
                "each arm has this many freedoms": Enumeration(
                    n, lambda: r.rank(list(r.right), arms[:2]), "the rank of the right arm"
                ),
                "the tip stays in the plane": Identity(
                    [plane[0].dot(r.right.diff(s)) for s in arms[:2]], [sp.S.Zero] * 2
                ),
                "the plane is as stated": Identity(plane[0][2], sp.Integer(plane[1])),
            }
        ),
        phrases=[{"2-DOF": 2, "3-DOF": 3}, planes],
    )
    claim(
        "waist",
        "“These arms are connected, at one end, to a {1-DOF} waist and constrained, at the other "
        "end, by a novel wrist assembly.”",
        lambda n: Enumeration(
            n,
            lambda: len(r.right.free_symbols & r.left.free_symbols & set(q)),
            "joints that move both arms",
        ),
        phrases=[{"1-DOF": 1, "2-DOF": 2}],
    )
    own = {"pitching": ("pitch",), "yawing": ("yaw",)}
    movers = {"only the twin arms": arms, "only the waist": (q.theta1,)}
    claim(
        "actuator of the wrist",
        "“The wrist contains an actuator {only} for the {pitching} motion and due to its unique "
        "design, by moving {only the twin arms}, the yaw and roll motions are generated.”",
        lambda angle, joints: Every(
            {
                "the actuator of the wrist moves this angle alone": driven(r, angle, (q.theta,)),
                "these joints move yaw and roll": driven(r, ("yaw", "roll"), joints),
            }
        ),
        phrases=[own, movers],
        opposites={"only": "not only"},
    )
    claim = partial(d.claim, where=INTRODUCTION, notation=printed)
    claim(
        "workspace and payload",
        "“The H6AR offers the attractive properties of large achievable workspaces and higher "
        "payload carrying capacities that are possessed by conventional serial and parallel "
        "manipulators, respectively.”",
        lambda: Undecidable("a judgement of value: the paper gives no workspace and no payload"),
        fixed=VALUE,
    )
    claim(
        "fixed distance of the arms",
        "“The H6AR consists of a waist to which twin anthropomorphic arms that are separated by a "
        "{fixed} distance are connected.”",
        lambda same: Identity(
            [normal.dot(r.right - r.left).diff(s) for s in q], [sp.Integer(same)] * 6
        ),
        phrases=[{"fixed": 0, "varying": 1}],
    )
    claim(
        "single actuator",
        "“These arms are passively connected to a unique compact wrist assembly that contains a "
        "{single} actuator used to generate the {pitching} motion.”",
        lambda n, angle: Every(
            {
                "this many actuators are not in the arms": Enumeration(
                    n, lambda: len(q) - r.rank([*r.right, *r.left], q), "actuators"
                ),
                "it moves this angle alone": driven(r, angle, (q.theta,)),
            }
        ),
        phrases=[{"single": 1, "second": 2}, own],
    )
    claim(
        "yaw and roll without actuators",
        "“The yaw and roll motions are generated by {only} moving {the twin arms} and [...] "
        "hence, the actuators for these {2} DOFs are completely eliminated.”",
        lambda joints, n: Every(
            {
                "these joints move yaw and roll": driven(r, ("yaw", "roll"), joints),
                "they have this many freedoms": Enumeration(
                    n, lambda: r.rank([*r.tangents.values()], arms), "of yaw and roll by the arms"
                ),
            }
        ),
        phrases=[{"the twin arms": arms, "the waist": (q.theta1,)}, {"2": 2, "3": 3}],
        opposites={"only": "not only"},
    )
    claim(
        "four actuators",
        "“The {4} actuators that drive the joints of the twin arms are located close to the "
        "waist.”",
        lambda n: Enumeration(
            n, lambda: r.rank([*r.right, *r.left], arms), "the rank of the tips by the arms' joints"
        ),
        phrases=[{"4": 4, "3": 3}],
    )
    d.claim(
        "computationally inexpensive",
        "“As shown in this paper, the closed-form forward and inverse kinematic relations are "
        "computationally inexpensive, which in turn implies that the H6AR can be easily "
        "controlled.”",
        lambda: Undecidable("a judgement of value: the paper counts no operations"),
        fixed=VALUE,
        where="5 Conclusions",
    )
    d.claim(
        "combination of properties",
        "“The unique design of the H6AR mechanism offers the robot a combination of the desirable "
        "properties of serial and parallel manipulators.”",
        lambda: Undecidable("a judgement of value"),
        fixed=VALUE,
        where="5 Conclusions",
    )


def description(d: Derivation, r: Robot, printed: Notation) -> None:
    """Section 2 up to the names of the parameters."""
    claim = partial(d.claim, where=DESCRIPTION, notation=printed)
    m, q, normal = r.m, r.q, r.lateral
    up = sp.Matrix([0, 0, 1])
    claim(
        "plane of the waist",
        "“The waist of the robot, which rotates in the {horizontal} plane, is mounted at the "
        "centre of the base.”",
        lambda axis: Identity(axis.dot(r.right.diff(q.theta1)), sp.S.Zero),
        phrases=[{"horizontal": up, "vertical": sp.Matrix([1, 0, 0])}],
    )
    claim(
        "mid-plane offset",
        "“Also, the twin anthropomorphic arms, which rotate in the {vertical} plane, are connected "
        "to the waist at a {fixed} distance, termed as the mid-plane offset, from the waist "
        "centre.”",
        lambda axis, same: Every(
            {
                "each arm stays in its plane": Identity(
                    [axis.dot(r.right.diff(s)) for s in r.arm_joints[:2]], [sp.S.Zero] * 2
                ),
                "the planes are at this distance from the middle": Identity(
                    [normal.dot(r.right), -normal.dot(r.left)], [(1 + same) * m.d] * 2
                ),
            }
        ),
        phrases=[{"vertical": normal, "horizontal": up}, {"fixed": 0, "varying": q.theta2R}],
    )
    claim(
        "links of an arm",
        "“Each of these arms is comprised of {two} links, denoted as the upper-arm and the "
        "fore-arm.”",
        lambda n: Enumeration(
            n,
            lambda: len(r.right.free_symbols & set(r.arm_joints)),
            "bodies of the right arm, each with a joint",
        ),
    )
    claim(
        "yaw and roll by shoulders and elbows",
        "“With such a design, yaw and roll motions are generated by moving {only the shoulder and "
        "elbow joints}.”",
        lambda joints: driven(r, ("yaw", "roll"), joints),
        phrases=[
            {
                "only the shoulder and elbow joints": r.arm_joints,
                "only the elbow joints": r.arm_joints[1::2],
            }
        ],
    )
    turn, one = real("t"), sp.Matrix([1, 0])
    plane_turn = rotation("z", turn)[:2, :2]
    mirrors = {"symmetric": sp.diag(-1, 1), "asymmetric": sp.eye(2)}
    claim(
        "symmetric wrist",
        "“The gearset also ensures that the wrist assembly remains {symmetric} during the yaw and "
        "roll motions.”",
        # equal gears turn by opposite angles
        lambda mirror: Identity(
            m.gs * one + m.al * plane_turn * one, mirror * (-m.gs * one - m.al * plane_turn.T * one)
        ),
        phrases=[mirrors],
    )
    together = {q.theta2L: q.theta2R, q.theta3L: q.theta3R}
    claim(
        "invariant point",
        "“motions are generated by moving the tips of the fore-arms {reflective-symmetrically} "
        "about a point that lies in the {mid-plane} of the two arms and on a line {normal} to this "
        "plane and connecting the tips of the fore-arms when the roll and yaw angles are zero.”",
        lambda side, place, direction: Every(
            {
                "on opposite sides": Identity(r.right - r.middle, side * (r.left - r.middle)),
                "the point is in the mid-plane": Identity(normal.dot(r.middle), place),
                "the line of the tips has this direction": Identity(
                    (r.right - r.left).subs(together).cross(direction), sp.zeros(3, 1)
                ),
            }
        ),
        phrases=[
            {"reflective-symmetrically": -1, "in parallel": 1},
            {"mid-plane": sp.S.Zero, "plane of an arm": m.d},
            {"normal": normal, "parallel": up},
        ],
    )
    freedoms = {"2-DOF": 2, "1-DOF": 1}
    claim(
        "passive joints",
        "“Further, these arms are connected through passive {2-DOF} joints, denoted by J_1 and "
        "J_2 , to the wrist assembly.”",
        lambda n: Enumeration(2 * n, lambda: counted()[J], "the freedoms of both in Table 1"),
        phrases=[freedoms],
    )


J = "Joints J_1 and J_2"
TABLE: dict[str, tuple[tuple[str, str, int], ...]] = {
    "Waist": (("base", "waist", 1),),
    "Twin shoulders": (("waist", "right upper arm", 1), ("waist", "left upper arm", 1)),
    "Twin elbows": (
        ("right upper arm", "right fore-arm", 1),
        ("left upper arm", "left fore-arm", 1),
    ),
    J: (("right fore-arm", "right wrist link", 2), ("left fore-arm", "left wrist link", 2)),
    "Wrist joints (gearset)": (
        ("right wrist link", "gear case", 1),
        ("left wrist link", "gear case", 1),
    ),
    "Pitch": (("gear case", "tool", 1),),
}
"""The joints of Table 1: the two bodies that each connects, and its freedoms."""


def counted() -> dict[str, int]:
    """The freedoms of each row of Table 1."""
    return {row: sum(f for *_, f in joints) for row, joints in TABLE.items()}


def loops() -> int:
    """The number of independent loops: joints minus bodies plus one, as all are connected."""
    joints = [joint for row in TABLE.values() for joint in row]
    return len(joints) - len({body for a, b, _ in joints for body in (a, b)}) + 1


def kutzbach(coupled: int = 0) -> int:
    """Six freedoms for each moving body, less what each joint of one freedom takes.

    A joint of two freedoms counts as two joints with a body between them.  Each of the ``coupled``
    relations between joints takes one freedom more.
    """
    joints = [joint for row in TABLE.values() for joint in row]
    bodies = len({body for a, b, _ in joints for body in (a, b)})
    bodies += sum(f - 1 for *_, f in joints)
    return 6 * (bodies - 1) - 5 * sum(f for *_, f in joints) - coupled


COUNTED_AS_FREE = (
    "both joints of the gear set are counted as free, although the gears couple them; this is "
    "right only if one of the seven conditions follows from the others"
)


def mobility(d: Derivation, printed: Notation) -> None:
    """Table 1, and the formulas of Grübler and Kutzbach."""
    claim = partial(d.claim, where=DESCRIPTION, notation=printed)
    p, n, loop_count, total = real("p"), real("n"), real("l"), real("F")
    names = {r"\sum_{i=1}^{p} f_i": total, "l": loop_count, "M": real("M")}
    by_bodies = {"M": 6 * (n - 1) - (6 * p - total), "l": p - n + 1}
    claim(
        "Grübler's formula",
        "“Grübler's formula applicable for mechanisms with loops [6], given by the general "
        r"expression $M = \sum_{i=1}^{p} f_i - 6l$, where l is the number of independent "
        "kinematic loops, is used.”",
        # n bodies, each with six freedoms, of which a joint takes 6 - f
        means=names | by_bodies,
    )

    def table(*rows: Relation) -> Check:
        (*lines, last) = rows
        found = counted()
        return Every(
            {
                "each kind of joint has these freedoms": Enumeration(
                    [int(line.left) for line in lines], lambda: list(found.values()), "freedoms"
                ),
                "the total is their sum": Identity(
                    last.left.subs(total, sum(found.values())), last.right
                ),
            }
        )

    claim(
        "Table 1",
        "“Waist $1$ Twin shoulders $2$ Twin elbows $2$ Joints J_1 and J_2 $4$ Wrist joints "
        r"(gearset) $2$ Pitch $1$ Total $\sum_{i=1}^{p} f_i = 12$”",
        table,
        means=names,
    )
    d.erratum(
        "gear-pair",
        "The mobility counts the two joints of the gear set as free, although the gears couple "
        "them",
        Gravity.OMISSION,
        why="Meshed gears turn by opposite angles, which is one more condition.  With it the "
        "formula gives $M = 5$.  The H6AR can have 6 freedoms only if one of the conditions "
        "of its loop follows from the others, and the paper does not say which.",
        use="No equation of the paper uses the count.  A reader who repeats it for another wrist "
        "with gears may find one freedom too many.",
    )

    def count(coupled: int, *printed_values: Any) -> Check:
        words, loop, result = printed_values
        mobility = sum(counted().values()) - coupled - 6 * loop.right
        return Every(
            {
                "there are this many loops": Enumeration(words, loops, "independent loops"),
                "the printed l is their number": Identity(
                    loop.left.subs(loop_count, loops()), loop.right
                ),
                "the formula gives this M": Identity(
                    result.right, result.left.subs(real("M"), mobility)
                ),
            }
        )

    claim(
        "six freedoms by Grübler",
        "“The H6AR mechanism contains {one} independent kinematic loop, hence $l = 1$ and from the "
        "joints' names and their DOFs, listed in Table 1, it can be seen that $M = 6$.”",
        means=names,
        erratum="gear-pair",
        readings=[
            Reading(
                "the two joints of the gear set are counted as in Table 1",
                lambda *v: Under(count(0, *v), COUNTED_AS_FREE),
            ),
            Reading("the gears couple their two joints", partial(count, 1)),
        ],
    )
    claim(
        "six freedoms by Kutzbach",
        "“By representing the wrist mechanism in terms of links connected only by single DOF "
        "revolute joints, it can be shown that, by applying Kutzbach's criterion, $M = 6$.”",
        means=names,
        erratum="gear-pair",
        readings=[
            Reading(
                "the two joints of the gear set are free",
                lambda r: Under(Equal(r), COUNTED_AS_FREE),
                {"M": sp.Integer(kutzbach())},
            ),
            Reading(
                "the gears couple their two joints", means={"M": sp.Integer(kutzbach(coupled=1))}
            ),
        ],
    )
    claim(
        "the same result",
        "“Note that the {same} result can be derived by the use of Kutzbach's criterion for "
        "spatial mechanisms.”",
        lambda apart: Enumeration(
            sum(counted().values()) - 6 * loops() + apart, kutzbach, "the mobility by Kutzbach"
        ),
        phrases=[{"same": 0, "different": 1}],
    )


def tips(d: Derivation, r: Robot, printed: Notation) -> None:
    """Section 3.1: the frames, and eqs. (1) and (2)."""
    claim = partial(d.claim, where="3.1 Tips of the fore-arms", notation=printed)
    m, q = r.m, r.q
    a_1, d2, d3 = real("a_1"), real("d_2"), real("d_3")

    def end(a1: sp.Expr, second: sp.Expr, third: sp.Expr) -> sp.Matrix:
        frames = [
            denavit_hartenberg(a1, pi / 2, m.d1, q.theta1),
            denavit_hartenberg(m.L1, 0, second, q.theta2R),
            denavit_hartenberg(m.a3, pi / 2, third, q.theta3R),
        ]
        return sp.Matrix((product(frames) * sp.Matrix([0, 0, m.L2, 1]))[:3])

    ahead = sp.Matrix([cos(q.theta1), sin(q.theta1), 0])
    claim(
        "parameter a_1",
        "“The parameter a_1 is set to {zero}.”",
        lambda n: Identity(
            ahead.dot(end(a_1 if n is None else sp.Integer(n), m.d, sp.S.Zero)),
            m.L1 * cos(q.theta2R)
            + m.L2 * sin(q.theta2R + q.theta3R)
            + m.a3 * cos(q.theta2R + q.theta3R),
        ),
    )
    claim(
        "offsets d_2 and d_3",
        "“The mid-plane offset, d, is related to these parameters by the equation $d = d_2 + "
        "d_3$.”",
        means={"d": r.lateral.dot(end(sp.S.Zero, d2, d3)), "d_2": d2, "d_3": d3},
    )
    x_axis, y_axis = sp.Matrix([1, 0, 0]), sp.Matrix([0, 1, 0])
    turned = rotation("z", q.theta1) * x_axis
    claim(
        "counter-clockwise",
        "“{All} counter-clockwise rotations are considered to be {positive}.”",
        phrases=[{"positive": 1, "negative": -1}],
        opposites={"All": "Not all"},
        readings=[
            Reading(
                "as seen from the tip of the axis of the joint, by the Denavit-Hartenberg "
                "convention",
                lambda side: Identity(turned.diff(q.theta1).subs(q.theta1, 0), side * y_axis),
            ),
            Reading(
                "also the roll of (3) about the level fore-arm, which lifts the right tip",
                lambda side: Identity(
                    r.half_line[2].subs({r.A23: pi / 2, r.psi: 0}), side * m.d * sp.tan(r.phi)
                ),
            ),
        ],
    )
    for label, text in (
        (
            "eq. (1a)",
            r"x_R = s_1 d + c_1 \left(L_1 c_2^R + L_2 s_{23}^R + a_3 c_{23}^R \right)",
        ),
        (
            "eq. (1b)",
            r"y_R = -c_1 d + s_1 \left(L_1 c_2^R + L_2 s_{23}^R + a_3 c_{23}^R \right)",
        ),
        ("eq. (1c)", r"z_R = d_1 + L_1 s_2^R - L_2 c_{23}^R + a_3 s_{23}^R"),
        (
            "eq. (2a)",
            r"x_L = -s_1 d + c_1 \left(L_1 c_2^L + L_2 s_{23}^L + a_3 c_{23}^L \right)",
        ),
        (
            "eq. (2b)",
            r"y_L = c_1 d + s_1 \left(L_1 c_2^L + L_2 s_{23}^L + a_3 c_{23}^L \right)",
        ),
        ("eq. (2c)", r"z_L = d_1 + L_1 s_2^L - L_2 c_{23}^L + a_3 s_{23}^L"),
    ):
        claim(label, f"${text}$")
