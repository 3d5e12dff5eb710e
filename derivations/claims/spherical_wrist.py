"""Claims of Reddy and Babu about rotations and Euler angles."""

from collections.abc import Iterable
from functools import partial

import sympy as sp
from closedform.derivations.claims import spherical_wrist_convention
from closedform.derivations.claims.spherical_wrist_notation import (
    EULER,
    MIDDLE,
    ORIENTATION,
    Wrist,
    every_rotation,
    inverse_claim,
    middle_angle,
    notation,
)
from closedform.derivations.claims.spherical_wrist_rotations import (
    SEQUENCES,
    TURNS,
    about,
    as_zyz,
    degrees_of_freedom,
    euler,
    fixed,
    independent_sequences,
    moving,
    pairs_alike,
    representation,
)
from sympy import pi

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Every,
    Gravity,
    Identity,
    Not,
    Notation,
    denavit_hartenberg,
    real,
)

EQ12 = (
    r"R_{z\gamma z} = \begin{bmatrix} c\phi c\theta c\varphi - s\phi s\varphi & "
    r"-c\phi c\theta s\varphi - s\phi c\varphi & c\phi s\theta \\ "
    r"s\phi c\theta c\varphi + c\phi s\varphi & -s\phi c\theta s\varphi + c\phi c\varphi & "
    r"s\phi s\theta \\ -s\theta c\varphi & s\theta s\varphi & c\theta \end{bmatrix}"
)


def state(d: Derivation, wrist: Wrist) -> None:
    """Transcribe all claims, in the order of the paper."""
    known = notation(wrist)
    rotations(d, wrist)
    euler_angles(d, wrist, known)
    inverse_orientation(d, wrist, known)
    named = {r"R_{z\gamma z}": wrist.R}
    eq12 = known.extended(named).read(EQ12)[0].right
    spherical_wrist_convention.state(d, wrist, eq12)


def rotations(d: Derivation, wrist: Wrist) -> None:
    """Spherical joints, representations of rotation, and eq. (11)."""
    pose = wrist.pose
    claim = partial(d.claim, where=ORIENTATION)

    centre = {"one common point": sp.zeros(3, 1), "the hand": pose[:3, 3]}
    claim(
        "one common point, introduction",
        "“Spherical wrist robot arms are those having the axes of their hand joints intersecting "
        "at {one common point}.”",
        partial(meet, wrist),
        phrases=[centre],
        where="Introduction",
    )
    claim(
        "one common point",
        "“Spherical wrist is having the axes of their joints intersecting at {one common point}.”",
        partial(meet, wrist),
        phrases=[centre],
    )
    offset, theta = real("d_i"), real("theta_i")
    turn = denavit_hartenberg(real("a_i"), real("alpha_i"), offset, theta)[:3, :3]
    claim(
        "revolute joints",
        "“These joints {must} be of the {revolute} type.”",
        lambda moved: Not(
            Identity(
                turn.diff(moved),
                sp.zeros(3),
                names=(
                    "the derivative of the rotation",
                    "a rotation that the joint does not change",
                ),
            )
        ),
        phrases=[{"revolute": theta, "prismatic": offset}],
        opposites={"must": "need not"},
    )
    claim(
        "spherical joint",
        "“A spherical joint can be represented by {three} consecutive rotary joints with "
        "{intersecting} rotation axes.”",
        lambda n, axes: Every(
            {
                "their number is that of the freedoms of a rotation": Enumeration(
                    n, degrees_of_freedom, "freedoms"
                ),
                "they give every rotation": every_rotation(wrist, euler(axes, wrist.angles)),
            }
        ),
        phrases=[{"intersecting": "zyz", "parallel": "zzz"}],
    )
    claim(
        "representations of rotation",
        "“There are many ways to represent rotation, including the following: {Euler angles}, "
        "{Gibbs vector}, {Cayley-Klein parameters}, {Pauli spin matrices}, {axis and angle}, "
        "{orthonormal matrices}, and {Hamilton's quaternions}.”",
        lambda *kinds: Every({kind: representation(kind, TURNS) for kind in kinds}),
        phrases=[
            as_named("Euler angles", "two Euler angles"),
            as_named("Gibbs vector", "unit vector"),
            as_named("Cayley-Klein parameters", "real Cayley-Klein parameters"),
            as_named("Pauli spin matrices", "two Pauli spin matrices"),
            as_named("axis and angle", "axis"),
            as_named("orthonormal matrices", "symmetric matrices"),
            as_named("Hamilton's quaternions", "pure quaternions"),
        ],
    )
    claim(
        "Euler angles of a rotation",
        "“which can be used to obtain {Euler angles} or other representations.”",
        lambda axes: every_rotation(wrist, euler(axes, wrist.angles)),
        phrases=[{"Euler angles": "zyz", "angles about one axis": "zzz"}],
        where="Kinematic Analysis By Denavit – Hartenberg Convention",
    )
    frame = sp.Matrix(3, 3, lambda i, j: real(f"{'xyz'[i]}_{'uvw'[j]}"))  # columns i_u, j_v, k_w
    base = dict(zip(("i_x", "j_y", "k_z"), (sp.eye(3)[:, i] for i in range(3)), strict=True))
    turned = dict(zip(("i_u", "j_v", "k_w"), (frame[:, i] for i in range(3)), strict=True))
    point = sp.Matrix([real("p_u"), real("p_v"), real("p_w")])
    claim(
        "point, before eq. (11)",
        "“The 3x3 transformation matrix R that will transform the coordinates of [...] to the "
        "coordinate expressed with respect to the OXYZ coordinate system, after the OUVW "
        "coordinate system has been rotated. That is, $P_{xyz} = RP_{uvw}$”",
        notation=Notation(
            {
                "P_{xyz}": sum((p * e for p, e in zip(point, turned.values(), strict=True)),
                               sp.zeros(3, 1)),
                "R": sp.Matrix([[e.dot(f) for f in turned.values()] for e in base.values()]),
                "P_{uvw}": point,
            }
        ),
    )  # fmt: skip
    claim(
        "eq. (11)",
        "“The general rotation matrix is written as "
        r"$R = \begin{bmatrix} i_x \cdot i_u & i_x \cdot j_v & i_x \cdot k_w \\ "
        r"j_y \cdot i_u & j_y \cdot j_v & j_y \cdot k_w \\ "
        r"k_z \cdot i_u & k_z \cdot j_v & k_z \cdot k_w \end{bmatrix}$”",
        notation=Notation(base | turned | {"R": frame}),
    )


def as_named(*phrases: str) -> dict[str, str]:
    """Phrases that mean a representation by its name."""
    return {phrase: phrase for phrase in phrases}


def meet(wrist: Wrist, point: sp.Matrix) -> Check:
    """All axes of the wrist go through a point: it is on the line of each."""
    frames = [sp.eye(4)]
    for row in ((0, -pi / 2, 0, wrist.theta4), (0, pi / 2, 0, wrist.theta5)):
        frames.append(frames[-1] * denavit_hartenberg(*row))
    moments = [(point - T[:3, 3]).cross(T[:3, 2]) for T in frames]
    return Identity([e for m in moments for e in m], [sp.S.Zero] * 9)


def euler_angles(d: Derivation, wrist: Wrist, known: Notation) -> None:
    """The sequences of axes, and eq. (12)."""
    R = wrist.R
    claim = partial(d.claim, where=f"{ORIENTATION}, A. Euler Angles", notation=known)

    claim(
        "minimal representation",
        "“Euler angles are a {minimal} representation of relative orientation.”",
        lambda more: Enumeration(
            more, lambda: len(TURNS) - degrees_of_freedom(), "number of angles beyond the freedoms"
        ),
        phrases=[{"minimal": 0, "redundant": 1}],
    )
    claim(
        "moving axes",
        "“This set of {three} angles describes a sequence of rotations about the axes of a "
        "{moving} reference frame.”",
        lambda n, turned: Every(
            {
                "there are this many angles": Enumeration(
                    n, lambda: len(R.free_symbols), "their number"
                ),
                "the turns are about these axes": Identity(turned(wrist.angles), R),
            }
        ),
        phrases=[{"moving": moving, "fixed": fixed}],
    )
    claim(
        "twelve sequences",
        "“There are however many ({12}, to be exact) sets that describe the same orientation:”",
        lambda n: Every(
            {
                "there are this many sequences": Enumeration(
                    n,
                    lambda: len(independent_sequences()),
                    "sequences, of all 27, with independent rates",
                ),
                "each reaches the same rotations as ZYZ": as_zyz(),
                "ZYZ reaches every rotation": every_rotation(wrist, R),
            }
        ),
        phrases=[{"12": 12, "24": 24, "27": 27}],
    )
    claim(
        "different sequences",
        "“different combination of axes (e.g. {ZXZ}, {ZYZ}, and so on) lead to {different} Euler "
        "angles.”",
        lambda first, second, alike: Every(
            {
                "both examples are among them": Enumeration(
                    2,
                    lambda: len({first, second} & {*independent_sequences()}),
                    "different examples with independent rates",
                ),
                "this many pairs give one matrix": Enumeration(
                    alike, pairs_alike, "pairs that give one matrix"
                ),
            }
        ),
        phrases=[
            {"ZXZ": "zxz", "ZYZ": "zyz", "ZZX": "zzx"},
            {"different": 0, "the same": 66},
        ],
    )
    claim(
        "identical axes",
        "“Identical axes {should not} be in {consecutive places} (e.g. {ZZZ}).”",
        lambda excludes, example: Every(
            {
                "the sequences that remain": Enumeration(
                    listed(s for s in SEQUENCES if not excludes(s)),
                    lambda: listed(independent_sequences()),
                    "sequences with independent rates",
                ),
                "the example is excluded": Enumeration(
                    False, lambda: example in independent_sequences(), "it has independent rates"
                ),
            }
        ),
        opposites={"should not": "should"},
        phrases=[
            {
                "consecutive places": lambda s: s[0] == s[1] or s[1] == s[2],
                "any two places": lambda s: len(set(s)) < 3,
            },
            {"ZZZ": "zzz", "ZXZ": "zxz"},
        ],
    )
    claim(
        "ZYZ",
        "“In our study we consider {ZYZ} Euler angles”",
        lambda axes: Identity(euler(axes, wrist.angles), R),
        phrases=[{"ZYZ": "zyz", "ZXZ": "zxz"}],
    )
    z, y = sp.eye(3)[:, 2], sp.eye(3)[:, 1]
    claim(
        "product, before eq. (12)",
        "“The final form of orientation matrix of a spherical wrist is "
        r"$R_{z\gamma z} = R_{z,\phi} R_{y,\theta} R_{z,\varphi}$”",
        means={
            r"R_{z\gamma z}": moving(wrist.angles),
            r"R_{z,\phi}": about(z, wrist.theta4),
            r"R_{y,\theta}": about(y, wrist.theta5),
            r"R_{z,\varphi}": about(z, wrist.theta6),
        },
    )
    claim("eq. (12)", f"${EQ12}$", means={r"R_{z\gamma z}": R})


def listed(sequences: Iterable[str]) -> str:
    return ", ".join(s.upper() for s in sequences)


def inverse_orientation(d: Derivation, wrist: Wrist, known: Notation) -> None:
    """Eq. (13)."""
    claim = partial(d.claim, where=f"{ORIENTATION}, A. Euler Angles", notation=known)
    claim(
        "θ, before eq. (13)",
        "“The inverse orientation values (i.e., Euler angles) are obtained by solving the Eq. (12) "
        f"The obtained angles are ${MIDDLE % EULER[1]}$”",
        partial(middle_angle, wrist),
    )
    d.erratum(
        "aligned-axes",
        "The inverse of the wrist has no case for $\\sin\\theta = 0$",
        Gravity.OMISSION,
        why="If $\\sin\\theta = 0$, then $R_{13} = R_{23} = R_{31} = R_{32} = 0$, and eqs. (13) "
        "and (16) contain atan2(0, 0).  These rotations can be reached: the first and the "
        "last axis coincide, and only the sum or the difference of their angles is "
        "determined.  One of the two can be chosen freely.  Above eq. (16), $\\theta$ stands "
        "for $\\theta_5$.",
        use="The home position of the wrist, $\\theta_4 = \\theta_5 = \\theta_6 = 0$, is such a "
        "case.  A program that takes atan2(0, 0) as 0 gets 0 for both angles.  This is right for "
        "the identity and for a half turn about $y$; for every other such rotation the hand is "
        "turned about its axis by a wrong angle.  In floating point, $-R_{31}$ can be $-0$, and "
        "atan2(0, $-0$) is $180^\\circ$: then even the identity comes out wrong.",
    )
    outer = EULER[0], EULER[2]
    inverse_claim(claim, wrist, wrist.R, "eq. (13)", outer=outer, middle=EULER[1], free="φ")
