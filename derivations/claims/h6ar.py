"""Claims of Rao and Raju about the H6AR, checked on the mechanism with a closed loop."""

from functools import partial
from typing import Any, NamedTuple

import sympy as sp
from closedform.derivations.h6ar_mechanism import arm_frames, product
from sympy import asin, cos, sin, sqrt, tan

from closedform import (
    Count,
    Derivation,
    Enumeration,
    Every,
    Identity,
    Undecidable,
    Under,
    denavit_hartenberg,
    real,
)


class Robot(NamedTuple):
    """The results of the derivation; A (upper arm) and B (fore-arm) are angles of the mid-plane."""

    m: Any
    theta1: sp.Symbol
    A: sp.Symbol
    B: sp.Symbol
    alpha: sp.Symbol
    beta: sp.Symbol
    psi: sp.Symbol
    phi: sp.Symbol
    tips: list[sp.Matrix]
    frames: list[sp.Matrix]
    serial: sp.Matrix
    printed_tip: sp.Matrix
    extended: tuple[sp.Expr, sp.Expr, sp.Expr]
    arm: Any


def state(d: Derivation, r: Robot) -> None:
    """Transcribe the claims, in the order of the paper."""
    mobility(d)
    tips(d, r)
    invariant(d, r)
    wrist(d, r)
    inverse(d, r)


def mobility(d: Derivation) -> None:
    claim = partial(d.claim, where="2 Description of the H6AR")
    freedoms = (1, 2, 2, 4, 2, 1)
    claim(
        "Table 1",
        r"$\sum_{i=1}^{p} f_i = 12$",
        Enumeration(12, lambda: sum(freedoms), "the sum of the column"),
    )
    claim(
        "Grübler's formula",
        r"$M = \sum_{i=1}^{p} f_i - 6l$, “hence l = 1 and [...] M = 6”",
        Under(
            Enumeration(6, lambda: sum(freedoms) - 6, "the formula"),
            "both wrist joints are counted as free, although the gears couple them; with one "
            "freedom less the formula gives 5, unless one of the six loop conditions follows from "
            "the others",
        ),
    )
    claim(
        "Kutzbach's criterion",
        "“by applying Kutzbach's criterion, M = 6”",
        Undecidable("the paper does not list the links and joints that it counts"),
    )


def tips(d: Derivation, r: Robot) -> None:
    claim = partial(d.claim, where="3.1 Tips of the fore-arms")
    m, (d2, d3), (t1, t2, t3) = r.m, (real("d_2"), real("d_3")), (r.theta1, r.A, r.B - r.A)

    def ends(second: sp.Expr, third: sp.Expr) -> sp.Matrix:
        first = denavit_hartenberg(0, sp.pi / 2, m.d1, t1)
        upper = denavit_hartenberg(m.L1, 0, second, t2)
        return (first * upper * denavit_hartenberg(m.a3, sp.pi / 2, third, t3))[:3, 3]

    claim(
        "mid-plane offset",
        r"“The mid-plane offset, d, is related to these parameters by the equation $d = "
        r"d_2 + d_3$.”",
        Identity(ends(d2 + d3, sp.S.Zero), ends(d2, d3)),
    )
    names = (("(1a)", "x_R"), ("(1b)", "y_R"), ("(1c)", "z_R"))
    left = (("(2a)", "x_L"), ("(2b)", "y_L"), ("(2c)", "z_L"))
    forms = (
        r"{x} = {s}s_1 d + c_1 (L_1 c_2 + L_2 s_{{23}} + a_3 c_{{23}})",
        r"{x} = {t}c_1 d + s_1 (L_1 c_2 + L_2 s_{{23}} + a_3 c_{{23}})",
        r"{x} = d_1 + L_1 s_2 - L_2 c_{{23}} + a_3 s_{{23}}",
    )
    for side, (labels, s, t) in enumerate(((names, "", "-"), (left, "-", ""))):
        for k, (label, x) in enumerate(labels):
            printed = forms[k].format(x=x, s=s, t=t)
            claim(f"eq. {label}", f"${printed}$", Identity(r.tips[side][k], r.frames[side][k]))


def invariant(d: Derivation, r: Robot) -> None:
    m, psi, phi, theta1 = r.m, r.psi, r.phi, r.theta1
    c1, s1, cB, sB = cos(theta1), sin(theta1), cos(r.B), sin(r.B)
    # half the distances by which the right tip is ahead of the left one and above it (closed loop)
    ahead = m.d * (sB * tan(psi) / cos(phi) - cB * tan(phi))
    above = -m.d * (cB * tan(psi) / cos(phi) + sB * tan(phi))
    claim = partial(d.claim, where="3.2 Invariant point")
    claim(
        "eq. (3)",
        r"$z_I = z_R - d\tan\phi$",
        Identity(m.d * tan(phi), above),
    )
    claim(
        "eq. (3), level fore-arm",
        r"$z_I = z_R - d\tan\phi$ at home, where the fore-arm is horizontal",
        Identity(m.d * tan(phi), above.subs(r.B, sp.pi / 2)),
    )
    for label, printed, this, derived in (
        (
            "eq. (4a)",
            r"x_I = x_R - d (\tan\psi\cos\theta_1 + \sin\theta_1)",
            m.d * (tan(psi) * c1 + s1),
            c1 * ahead + s1 * m.d,
        ),
        (
            "eq. (4b)",
            r"y_I = y_R + d (\cos\theta_1 - \tan\psi\sin\theta_1)",
            -m.d * (c1 - tan(psi) * s1),
            s1 * ahead - c1 * m.d,
        ),
        (
            "eq. (5a)",
            r"x_I = x_L + d (\tan\psi\cos\theta_1 + \sin\theta_1)",
            -m.d * (tan(psi) * c1 + s1),
            -c1 * ahead - s1 * m.d,
        ),
        (
            "eq. (5b)",
            r"y_I = y_L - d (\cos\theta_1 - \tan\psi\sin\theta_1)",
            m.d * (c1 - tan(psi) * s1),
            c1 * m.d - s1 * ahead,
        ),
    ):
        claim(
            label,
            f"${printed}$",
            Every(
                {
                    "yaw alone, level fore-arm": Identity(
                        this, derived.subs({phi: 0, r.B: sp.pi / 2})
                    ),
                    "any posture": Identity(this, derived),
                }
            ),
        )
    moved = {"R": (r.A + r.alpha, r.B + r.beta), "L": (r.A - r.alpha, r.B - r.beta)}
    middle = (r.arm(*moved["R"]) + r.arm(*moved["L"])) / 2
    shift = sp.Matrix([ahead, above])
    point = sp.Matrix([real("r_I"), real("h_I")])
    claim(
        "eq. (6)",
        r"$x_I = \frac{x_R + x_L}{2},\ y_I = \frac{y_R + y_L}{2},\ z_I = \frac{z_R + z_L}{2}$",
        Identity(((point + shift) + (point - shift)) / 2, point),
    )
    small = real("epsilon")
    scaled = {r.alpha: small * r.alpha, r.beta: small * r.beta}
    for label, k, printed in (
        ("eqs. (7a) and (7b)", 0, r"c_1 x_I + s_1 y_I = L_1 c_2^A + L_2 s_{23}^A + a_3 c_{23}^A"),
        ("eq. (7c)", 1, r"z_I = d_1 + L_1 s_2^A - L_2 c_{23}^A + a_3 s_{23}^A"),
    ):
        claim(
            label,
            f"${printed}$",
            Identity(r.arm(r.A, r.B)[k], middle.subs(scaled, simultaneous=True)[k], small=small),
        )
    claim(
        "invariant",
        "“the fact that the point $(x, y, z)_I$ is invariant to the reflective-symmetric motions”, "
        "read as: if the averages do not change, the middle of the tips does not move",
        Identity(list(r.arm(r.A, r.B)), list(middle)),
    )

    claim(
        "virtual mechanism",
        "“the link lengths of this virtual mechanism are $L_1$ and $L_2$ and [...] its joint "
        "angles are the averages of the respective actual joint angles”",
        Identity(list(r.arm(r.A, r.B)), list(middle)),
        where="3.3 Equivalent serial mechanism",
    )
    gap = (r.arm(*moved["R"]) - r.arm(*moved["L"])) / 2
    claim(
        "unique angles",
        "“unique shoulders' and elbows' joint angles can be found that yield the given yaw and "
        "roll angles”, read as: for given averages there is one pair of half differences alpha, "
        "beta",
        Count(list(gap - point), (r.alpha, r.beta), 1),
    )
    claim(
        "roll and waist",
        "“the rolling motion is indepedent of the waist angle”",
        Identity(list(gap.diff(theta1)), [sp.S.Zero, sp.S.Zero]),
    )


def wrist(d: Derivation, r: Robot) -> None:
    m, psi, phi = r.m, r.psi, r.phi
    half, length = real("b"), real("l_W")
    right, left = sp.Matrix([m.gs - half, length]), sp.Matrix([half - m.gs, length])
    d.claim(
        "symmetric wrist",
        "“The gearset also ensures that the wrist assembly remains symmetric during the yaw and "
        "roll motions.”",
        Identity(right.dot(right), left.dot(left)),
        where="2 Description of the H6AR",
    )
    base = m.d / (cos(psi) * cos(phi))
    ratio = 1 - m.gs * cos(psi) / m.d
    closed, printed = (base - m.gs) ** 2, (ratio * m.d) ** 2 / cos(psi) ** 2
    d.claim(
        "eq. (8)",
        r"$l_W = \sqrt{(\alpha l)^2 - \frac{(\alpha d)^2}{\cos^2 \psi}},\ "
        r"\alpha = 1 - \frac{g_s \cos(\psi)}{d}$",
        Every(
            {
                "without roll, (alpha l)^2 - l_W^2": Identity(printed, closed.subs(phi, 0)),
                "with roll, (alpha l)^2 - l_W^2": Identity(printed, closed),
            }
        ),
        where="3.3 Equivalent serial mechanism",
    )
    claim = partial(d.claim, where="3.4 Wrist")

    def third(upper: sp.Expr, fore: sp.Expr) -> list[sp.Expr]:
        frame = product(arm_frames(m, r.theta1, upper, fore - upper, sp.S.Zero))
        return list(frame[:3, :3])

    virtual, right_arm = third(r.A, r.B), third(r.A + r.alpha, r.B + r.beta)
    claim(
        "frames of the virtual arm",
        "“the frames $(X, Y, Z)_{3V}$ and $(X, Y, Z)_{4V}$ have the same orientation as the frames "
        "$(X, Y, Z)_3$ and $(X, Y, Z)_4$”",
        Every(
            {
                "parallel fore-arms": Identity(virtual, [e.subs(r.beta, 0) for e in right_arm]),
                "any posture": Identity(virtual, right_arm),
            }
        ),
    )
    for k, (label, text) in enumerate(
        (
            (
                "eq. (9a)",
                r"x_T = c_1 (L_1 c_2^A + L_{2W} s_{23}^A + a_{3W} c_{23}^A) - s_1 L_\theta",
            ),
            (
                "eq. (9b)",
                r"y_T = s_1 (L_1 c_2^A + L_{2W} s_{23}^A + a_{3W} c_{23}^A) + c_1 L_\theta",
            ),
            ("eq. (9c)", r"z_T = d_1 + L_1 s_2^A - L_{2W} c_{23}^A + a_{3W} s_{23}^A"),
        )
    ):
        claim(label, f"${text}$", Identity(r.printed_tip[k], r.serial[k, 3]))
    c1, s1, cB, sB = cos(r.theta1), sin(r.theta1), cos(r.B), sin(r.B)
    forearm = sp.Matrix([[c1 * cB, s1, c1 * sB], [s1 * cB, -c1, s1 * sB], [sB, 0, -cB]])
    elbow = sp.Matrix([c1 * m.L1 * cos(r.A), s1 * m.L1 * cos(r.A), m.d1 + m.L1 * sin(r.A)])
    seen = forearm.T * (r.serial[:3, 3] - elbow)
    for printed, this, derived in (
        (r"L_\theta = (L_W + l_p c_\theta) c_\phi s_\psi - l_p s_\theta s_\phi", 0, -seen[1]),
        (r"L_{2W} = L_2 + (L_W + l_p c_\theta) c_\psi", 1, seen[2]),
        (r"a_{3W} = a_3 + (L_W + l_p c_\theta) s_\phi s_\psi + l_p s_\theta c_\phi", 2, seen[0]),
    ):
        name = printed.partition(" =")[0]
        claim(f"eq. (9), ${name}$", f"${printed}$", Identity(r.extended[this], derived))
    cos_beta = real("c_beta", positive=True)
    ten = (m.d - m.gs * cos(psi)) / (cos(psi) * cos_beta)
    needed = (base - m.gs) / cos_beta
    claim(
        "eq. (10)",
        r"$\alpha l \ge \frac{d - g_s \cos(\psi_{\max})}{\cos(\psi_{\max}) \cos(\beta_{\min})}$",
        Every(
            {
                "yaw alone": Identity(ten, needed.subs(phi, 0)),
                "yaw and roll": Identity(ten, needed),
            }
        ),
    )
    claim(
        "any roll",
        "“This result also holds for any roll angle $|\\phi| \\le \\phi_{\\max}$.”",
        Identity(ten, needed),
    )
    claim(
        "passive joints",
        "“no angular constraints are imposed on the passive joints J_1 and J_2”",
        Undecidable("a choice of design; the paper gives no ranges"),
    )


def inverse(d: Derivation, r: Robot) -> None:
    m, theta1, A, B = r.m, r.theta1, r.A, r.B
    c1, s1 = cos(theta1), sin(theta1)
    aside, along, across = (real(n) for n in ("L_theta", "L_2W", "a_3W"))
    out = m.L1 * cos(A) + along * sin(B) + across * cos(B)
    up = m.L1 * sin(A) - along * cos(B) + across * sin(B)
    x, y = c1 * out - s1 * aside, s1 * out + c1 * aside
    P, Q = c1 * x + s1 * y, up
    bend = B - A
    c3, s3 = cos(bend), sin(bend)
    claim = partial(d.claim, where="4 Inverse Kinematics")
    claim("eq. (11)", r"$-s_1 x_T + c_1 y_T = L_\theta$", Identity(-s1 * x + c1 * y, aside))
    k, rho, t = real("kappa", positive=True), real("rho"), real("x")
    h = sqrt(k**2 + rho**2)
    claim(
        "eq. (12)",
        r"$\frac{\kappa \sin x + \rho \cos x}{\sqrt{\kappa^2 + \rho^2}} = \sin(x + \gamma)$",
        Every(
            {
                "kappa > 0": Identity((k * sin(t) + rho * cos(t)) / h, sin(t + asin(rho / h))),
                "kappa < 0": Identity(
                    (-k * sin(t) + rho * cos(t)) / h, sin(t + sp.pi - asin(rho / h))
                ),
            }
        ),
    )
    px, py = real("x_T", positive=True), real("y_T")
    size = sqrt(px**2 + py**2)
    limit = (size - aside, size + aside)

    def waist(sign: int) -> Identity:
        gamma = asin(py / size) if sign < 0 else sp.pi - asin(py / size)
        turn = asin(aside / size) - gamma
        return Identity(-sin(turn) * sign * px + cos(turn) * py, aside, limit)

    claim(
        "waist angle",
        r"$\theta_1 = \sin^{-1} (L_\theta / \sqrt{x_T^2 + y_T^2}) - \gamma_1$",
        Every({"x_T < 0": waist(-1), "x_T > 0": waist(+1)}),
    )
    claim(
        "before eq. (13)",
        r"$2L_1 (L_{2W} s_3^A + a_{3W} c_3^A) = (c_1 x_T + s_1 y_T)^2 + (z_T - d_1)^2 - L_1^2 - "
        r"L_{2W}^2 - a_{3W}^2$",
        Identity(
            2 * m.L1 * (along * s3 + across * c3),
            P**2 + Q**2 - m.L1**2 - along**2 - across**2,
        ),
    )
    reach, positive = real("K"), real("L_2W", positive=True)
    fore = sqrt(positive**2 + across**2)
    elbow = asin(reach / fore) - asin(across / fore)
    claim(
        "eq. (13)",
        r"$\theta_3^A = \sin^{-1}(L_{3A} / (2L_1\sqrt{L_{2W}^2 + a_{3W}^2})) - "
        r"\sin^{-1}(a_{3W} / \sqrt{L_{2W}^2 + a_{3W}^2})$",
        Identity(positive * sin(elbow) + across * cos(elbow), reach, (fore - reach, fore + reach)),
    )
    claim(
        "one angle of the waist",
        "(11) gives one angle of the waist",
        Count([-s1 * real("x_T") + c1 * real("y_T") - aside], (theta1,), 1),
    )
    bend_A = real("theta_3^A")
    claim(
        "one angle of the elbow",
        "(13) gives one angle of the elbow",
        Count([along * sin(bend_A) + across * cos(bend_A) - reach], (bend_A,), 1),
    )
    own = sqrt(m.L2**2 + m.a3**2)
    elbow = asin(reach / own) - asin(m.a3 / own)
    claim(
        "right elbow",
        r"$\theta_3^R = \sin^{-1}(\ldots / (2L_1 \sqrt{L_2^2 + a_3^2})) - "
        r"\sin^{-1}(a_3 / \sqrt{L_2^2 + a_3^2})$",
        Identity(m.L2 * sin(elbow) + m.a3 * cos(elbow), reach, (own - reach, own + reach)),
    )
    claim(
        "first equation before (14)",
        r"$(c_1x_T + s_1y_T)c_{23}^A + (z_T - d_1)s_{23}^A = L_1c_3^A + a_{3W}$",
        Identity(P * cos(B) + Q * sin(B), m.L1 * c3 + across),
    )
    claim(
        "second equation before (14)",
        r"$(c_1x_T + s_1y_T)s_{23}^A - (z_T - d_1)c_{23}^A = L_1s_3^A - L_{2W}$",
        Identity(
            m.L1 * s3 - along,
            P * sin(B) - Q * cos(B),
            corrected=m.L1 * s3 + along,
        ),
    )
    e, f = m.L1 * c3 + across, m.L1 * s3 + along
    claim(
        "eq. (14)",
        r"$\theta_{23}^A = \tan^{-1} \frac{(z_T - d_1)(L_1 c_3^A + a_{3W}) + "
        r"(c_1 x_T + s_1 y_T)(L_1 s_3^A + L_{2W})}{(c_1 x_T + s_1 y_T)(L_1 c_3^A + a_{3W}) - "
        r"(z_T - d_1)(L_1 s_3^A + L_{2W})}$",
        Identity((Q * e + P * f) / (P * e - Q * f), tan(B)),
    )
    P, Q = r.arm(A, B)
    e, f = m.L1 * c3 + m.a3, m.L1 * s3 + m.L2
    claim(
        "right shoulder",
        r"$\theta_{23}^R = \tan^{-1} \frac{(z_R - d_1)(L_1 c_3^R + a_3) + (c_1 x_R + s_1 y_R)"
        r"(L_1 s_3^R + L_2)}{(c_1 x_R + s_1 y_R)(L_1 c_3^R + a_3) - (z_R - d_1)(L_1 s_3^R + L_2)}$",
        Identity((Q * e + P * f) / (P * e - Q * f), tan(B)),
    )
    right = r.arm(A + r.alpha, B + r.beta)
    mirrored = 2 * r.arm(A, B) - right
    by_average = r.arm(A - r.alpha, B - r.beta)
    gap = (right - by_average) / 2
    u = (-m.L1 * sin(A), m.L1 * cos(A))
    v = (m.L2 * cos(B) - m.a3 * sin(B), m.L2 * sin(B) + m.a3 * cos(B))
    area = u[0] * v[1] - u[1] * v[0]
    claim(
        "only one set of angles",
        "“Since the average of the twin shoulder and elbow angles [...] are known, it is "
        "sufficient to find only one set of angles”",
        # the left tip by the averages, and the left tip that (3) to (5) require
        Identity(by_average, mirrored),
    )
    claim(
        "no yaw, no roll",
        r"“if $\psi = \phi = 0$, then $\theta_2^R = \theta_2^L = \theta_2^A$ and "
        r"$\theta_3^R = \theta_3^L = \theta_3^A$”",
        Under(
            Every(
                {
                    "with half differences of zero, the tips": Identity(
                        list(right.subs({r.alpha: 0, r.beta: 0})), list(r.arm(A, B))
                    ),
                    "with yaw and roll of zero, the sines of the half differences": Identity(
                        [v[1] * gap[0] - v[0] * gap[1], u[0] * gap[1] - u[1] * gap[0]],
                        [area * sin(r.alpha), area * sin(r.beta)],
                    ),
                }
            ),
            "the gap of the tips is linear in the sines of the half differences, and its "
            "determinant vanishes only if the virtual arm is straight or folded; otherwise the "
            "sines are zero, and so are the half differences if the arms are less than half a turn "
            "apart",
        ),
    )
    claim(
        "computationally inexpensive",
        "“the closed-form forward and inverse kinematic relations are computationally inexpensive”",
        Undecidable("a judgement of value: the paper counts no operations"),
        where="5 Conclusions",
    )
