"""Claims of Brandstötter, Angerer and Hofbaur, as the formulas of opw_kinematics state them."""

from collections.abc import Sequence
from functools import partial

import sympy as sp
from sympy import atan2, cos, sin, sqrt

from closedform import Check, Derivation, Every, Identity, Notation, Relation, real

FORWARD = "opw_kinematics, forward"
INVERSE = "opw_kinematics, inverse"


def state(
    d: Derivation,
    lengths: Sequence[sp.Symbol],
    q: Sequence[sp.Symbol],
    pose: sp.Matrix,
    centre: sp.Matrix,
) -> None:
    """Transcribe the claims; ``centre`` is that of the wrist."""
    a1, a2, b, c1, c2, c3, _ = lengths
    theta1, _, theta3, _, theta5, _ = q
    in_plane = centre.subs(theta1, 0)
    names = Notation(
        dict(zip(("a_1", "a_2", "b", "c_1", "c_2", "c_3", "c_4"), lengths, strict=True))
        | {rf"\theta_{i}": angle for i, angle in enumerate(q, 1)}
        | {rf"e_{{{i + 1}{j + 1}}}": pose[i, j] for i in range(3) for j in range(3)}
        | {r"\psi_3": atan2(a2, c3), "k": sqrt(a2**2 + c3**2)}
        | dict(zip(("c_{x1}", "c_{y1}"), in_plane[:2], strict=True))
        | {"c_{z1}": in_plane[2] - c1}
        | dict(zip(("c_{x0}", "c_{y0}", "c_{z0}"), centre, strict=True))
        | dict(zip(("u_x", "u_y", "u_z"), pose[:3, 3], strict=True))
    )
    forward = partial(d.claim, where=FORWARD, notation=names, paraphrase=True)
    inverse = partial(d.claim, where=INVERSE, notation=names, paraphrase=True)
    forward(
        "centre of the wrist in the plane of the arm",
        r"$c_{x1} = c_2\sin\theta_2 + k\sin(\theta_2 + \theta_3 + \psi_3) + a_1$, $c_{y1} = b$, "
        r"$c_{z1} = c_2\cos\theta_2 + k\cos(\theta_2 + \theta_3 + \psi_3)$",
    )
    forward(
        "centre of the wrist",
        r"$c_{x0} = c_{x1}\cos\theta_1 - c_{y1}\sin\theta_1$, "
        r"$c_{y0} = c_{x1}\sin\theta_1 + c_{y1}\cos\theta_1$, $c_{z0} = c_{z1} + c_1$",
    )
    forward(
        "position of the tool",
        r"$u_x = c_{x0} + c_4 e_{13}$, $u_y = c_{y0} + c_4 e_{23}$, $u_z = c_{z0} + c_4 e_{33}$",
    )
    forward(
        "axis of the tool",
        r"$e_{13}\cos\theta_1 + e_{23}\sin\theta_1 = \cos(\theta_2 + \theta_3)\cos\theta_4"
        r"\sin\theta_5 + \sin(\theta_2 + \theta_3)\cos\theta_5$, "
        r"$e_{33} = -\sin(\theta_2 + \theta_3)\cos\theta_4\sin\theta_5 "
        r"+ \cos(\theta_2 + \theta_3)\cos\theta_5$",
    )

    x, y, root = real("c_x0"), real("c_y0"), real("n_x1")
    facing, backward = real("theta_1i"), real("theta_1ii")
    ahead = sqrt(x**2 + y**2 - b**2)

    def turret(*formulas: Relation) -> Check:
        """Both angles put the wrist b beside the first axis; the first faces it."""
        found = {}
        for name, f in zip(("the first", "the second"), formulas, strict=True):
            c, s = cos(f.right), sin(f.right)
            seen = sp.Matrix([x * c + y * s, y * c - x * s]).subs(root, ahead - a1)
            side = {facing: ahead, backward: -ahead}[f.left]
            found[name] = Identity(seen, sp.Matrix([side, b]))
        return Every(found)

    inverse(
        "θ_1",
        r"$\theta_{1;i} = \mathrm{atan2}(c_{y0}, c_{x0}) - \mathrm{atan2}(b, n_{x1} + a_1)$, "
        r"$\theta_{1;ii} = \mathrm{atan2}(c_{y0}, c_{x0}) + \mathrm{atan2}(b, n_{x1} + a_1) - \pi$",
        turret,
        means={
            r"\mathrm{atan2}": atan2,
            "c_{x0}": x,
            "c_{y0}": y,
            "n_{x1}": root,
            r"\theta_{1;i}": facing,
            r"\theta_{1;ii}": backward,
        },
    )
    inverse(
        "s_1 and θ_3",
        r"$s_1^2 = (c_{x1} - a_1)^2 + (c_{z0} - c_1)^2$, "
        r"$2c_2k\cos(\theta_3 + \psi_3) = s_1^2 - c_2^2 - k^2$",
        means={"s_1": sqrt(c2**2 + a2**2 + c3**2 + 2 * c2 * (c3 * cos(theta3) - a2 * sin(theta3)))},
    )
    inverse(
        "θ_5",
        r"$m = e_{13}\sin(\theta_2 + \theta_3)\cos\theta_1 + e_{23}\sin(\theta_2 + \theta_3)"
        r"\sin\theta_1 + e_{33}\cos(\theta_2 + \theta_3)$",
        means={"m": cos(theta5)},
    )

    def direction(f: Relation) -> Check:
        """The printed pair points the same way as the angle, where sin(theta5) is positive."""
        return Identity(f.right, sin(theta5) * sp.Matrix([sin(f.left), cos(f.left)]))

    inverse(
        "θ_4",
        r"$\theta_4 = \mathrm{atan2}(e_{23}\cos\theta_1 - e_{13}\sin\theta_1, "
        r"e_{13}\cos(\theta_2 + \theta_3)\cos\theta_1 + e_{23}\cos(\theta_2 + \theta_3)"
        r"\sin\theta_1 - e_{33}\sin(\theta_2 + \theta_3))$",
        direction,
        means={r"\mathrm{atan2}": lambda y, x: sp.Matrix([y, x])},
    )
    inverse(
        "θ_6",
        r"$\theta_6 = \mathrm{atan2}(e_{12}\sin(\theta_2 + \theta_3)\cos\theta_1 + "
        r"e_{22}\sin(\theta_2 + \theta_3)\sin\theta_1 + e_{32}\cos(\theta_2 + \theta_3), "
        r"-e_{11}\sin(\theta_2 + \theta_3)\cos\theta_1 - e_{21}\sin(\theta_2 + \theta_3)"
        r"\sin\theta_1 - e_{31}\cos(\theta_2 + \theta_3))$",
        direction,
        means={r"\mathrm{atan2}": lambda y, x: sp.Matrix([y, x])},
    )
