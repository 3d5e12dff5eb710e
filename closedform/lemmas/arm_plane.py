"""The rotation of a shoulder, from the centre of the wrist and the arm angle."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain
from closedform.lemmas.pairs import any_pair, direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.rotate import Because, terms
from closedform.model.inverse import Degenerate, Relation
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair

UPRIGHT = "the wrist is above or below the shoulder"
FOLDED = "the wrist is on the shoulder"
KEPT = (
    "OK answers have the given arm angle up to 1e-12 times the size of the arm, divided by the "
    "distance of the wrist from the vertical line through the shoulder."
)
UNDEFINED = f"{UPRIGHT}; the arm angle is measured from the plane of x and z."

theorem(
    "arm plane",
    statement=r"""Let $v = r\,(\cos\beta, \sin\beta, 0)$ with $r > 0$, let $|w| = r$, and let
$\rho = \sqrt{w_1^2 + w_2^2} > 0$.  Let
$$f_3 = \tfrac{1}{r}\,w,\qquad f_2 = \tfrac{1}{\rho}\,(-w_2,\ w_1,\ 0),\qquad f_1 = f_2 \times
f_3,$$ and let $\sigma = \pm 1$.  For every angle $\psi$ exactly one rotation $M$ has
$$M v = w,\qquad \sigma M e_3 = -\sin\psi\, f_1 + \cos\psi\, f_2.$$""",
    proof=r"""The vectors $f_1$, $f_2$ and $f_3$ are orthonormal and right-handed.  So $v/r$ and
$\sigma e_3$ are orthonormal, and so are $f_3 = w/r$ and $-\sin\psi\,f_1 + \cos\psi\,f_2$.  One
rotation takes the first two to the last two: it takes their cross product, $\sigma\,(\sin\beta,
-\cos\beta, 0)$, to $-\cos\psi\,f_1 - \sin\psi\,f_2$.""",
    exception=r"""If $\rho = 0$, the plane of $w$ and the third unit vector is undefined, and so is
$\psi$.  If $r = 0$, every rotation that takes $\sigma e_3$ to the vector on the right side is a
solution.""",
)


def arm_angle(chain: Chain, shoulder: sp.Matrix, v: Sequence[sp.Expr], *, sense: int = 1) -> Pair:
    """Take the arm angle as an input of the inverse, besides the pose; return its pair.

    ``shoulder`` is the rotation to a frame whose third axis is that of the elbow, and ``v`` is the
    line from the shoulder to the centre of the wrist in this frame; both depend on the joints, and
    v has no third component.  At the arm angle zero the axis of the elbow (with ``sense=-1``, its
    opposite) is horizontal, and the wrist is to its right, seen along the axis with z upwards.  The
    function ``arm_angle`` is exported.
    """
    d = chain.d
    up = shoulder[2, :]
    length = sp.sqrt(v[0] ** 2 + v[1] ** 2)
    sine, cosine = sense * length * up[2], sense * (up[0] * v[1] - up[1] * v[0])
    aside = sp.sqrt(sine**2 + cosine**2)
    symbol = chain.given_angle("arm_angle", sp.atan2(sine, cosine), aside / chain.sum_of_lengths())
    chain.notes.append(KEPT)
    d.write(symbol.name, r"\psi", "arm angle")
    p = d.program()
    y, x = p.let("sine", sine), p.let("cosine", cosine)
    size = p.let("aside", sp.sqrt(x**2 + y**2), nonnegative=True)
    none = p.vanishes("upright", size, chain.sum_of_lengths(), UPRIGHT)
    d.function(
        "arm_angle",
        "The arm angle: the turn of the plane of the arm about the line from the shoulder to the "
        "wrist.",
        {"q": list(chain.joints)},
        {"arm_angle": direction(y, x, size, none).angle},
        program=p,
        notes=(f"It is undefined, and 0, where {UPRIGHT}.",),
    )
    return Pair.of(symbol)


@chain_lemma("M v = w, at the arm angle", "the rotation M")
def arm_plane(
    chain: Chain,
    psi: Pair,
    shoulder: sp.Matrix,
    v: Sequence[sp.Expr],
    w: Sequence[sp.Expr],
    *,
    because: Because | None = None,
    sense: int = 1,
) -> Applied:
    """``M v = w`` for the rotation M of a shoulder, at the arm angle whose pair is ``psi``.

    If w is along z, the plane of x and z replaces the plane of w and z.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    psi
        the pair of the arm angle
    shoulder
        M at a posture
    v
        the line to the wrist, without a third component, see :func:`arm_angle`
    w
        what M turns it to
    because
        why both are equally long: for each unknown, the factor of its equation, as of ``rotate``
    sense
        that of the arm angle, 1 or -1
    """
    p, joint = chain.program, chain.joints[0]
    v, w = ([sp.sympify(e, strict=True) for e in vector] for vector in (v, w))
    v1, v2 = (chain.named(f"v{i}_plane", e) for i, e in enumerate(v, 1))
    w1, w2, w3 = (chain.named(f"w{i}_plane", e) for i, e in enumerate(w, 1))
    s, c = chain.named("s_plane", psi.s), chain.named("c_plane", psi.c)
    aside = chain.named("aside_plane", sp.sqrt(w1**2 + w2**2), nonnegative=True)
    far = chain.named("far_plane", sp.sqrt(aside**2 + w3**2), nonnegative=True)
    reach = p.let("reach_plane", sp.sqrt(v1**2 + v2**2), nonnegative=True)
    upright = p.vanishes("upright", aside, chain.size, UPRIGHT, free=(joint,))
    folded = p.vanishes("folded_plane", sp.Min(far, reach), chain.size, FOLDED, free=(joint,))
    azimuth = direction(w2, w1, aside, upright).known_as(p, "_azimuth")
    polar = direction(aside, w3, far, folded).known_as(p, "_polar")
    bearing = direction(v2, v1, reach, folded).known_as(p, "_bearing")
    f1 = sp.Matrix([azimuth.c * polar.c, azimuth.s * polar.c, -polar.s])
    f2 = sp.Matrix([-azimuth.s, azimuth.c, 0])
    f3 = sp.Matrix([azimuth.c * polar.s, azimuth.s * polar.s, polar.c])
    in_plane = chain.vector("x_plane", sense * (c * f1 + s * f2))
    normal = chain.vector("y_plane", sense * (c * f2 - s * f1))
    columns = (
        bearing.c * f3 - bearing.s * in_plane,
        bearing.s * f3 + bearing.c * in_plane,
        normal,
    )
    M = chain.matrix("shoulder", sp.Matrix.hstack(*columns))
    unknown = sp.Matrix(3, 3, lambda i, j: chain.length(f"M{i + 1}{j + 1}", shoulder[i, j]))
    up = sp.Matrix([w1 * w3, w2 * w3, -(aside**2)])
    level = far * sp.Matrix([-w2, w1, 0])
    equations = (
        *(unknown[:, :2] * sp.Matrix([v1, v2]) - sp.Matrix([w1, w2, w3])),
        *(aside * (v1 * unknown[:, 1] - v2 * unknown[:, 0]) - sense * (c * up + s * level)),
        *(aside * far * unknown[:, 2] - sense * (c * level - s * up)),
    )
    lemma = Lemma(
        "arm plane",
        r"M v = w,\ \sigma M e_3 = -\sin\psi\,f_1 + \cos\psi\,f_2",
        equations,
        dict(zip(unknown, M, strict=True)),
        1,
        roles=(
            ("v", sp.Matrix([v1, v2, 0])),
            ("w", sp.Matrix([w1, w2, w3])),
            (r"\sigma", sp.sympify(sense, strict=True)),
        ),
        vectors=(
            "The polar angles of $w$ give the vectors $f_i$, and "
            r"$t = \sigma(\cos\psi\,f_1 + \sin\psi\,f_2)$ is at right angles to $f_3$ in the plane "
            "of the arm.  With the angle of $v$ in its plane, the columns of $M$ are combinations "
            r"of $f_3$, $t$ and $\sigma M e_3$:"
        ),
        letters={e: f"t_{axis}" for axis, e in zip("xyz", in_plane, strict=True) if e.is_Symbol},
        matrix="M",
    )
    beta, phi, chi, angle = (any_pair(f"tau{k}") for k in range(1, 5))
    at = {v1: far * beta.c, v2: far * beta.s, c: angle.c, s: angle.s}
    given = at | {aside: far * chi.s, w3: far * chi.c}
    given |= {w1: given[aside] * phi.c, w2: given[aside] * phi.s}
    zero = dict.fromkeys((w1, w2, aside), sp.S.Zero)
    nothing = dict.fromkeys((far, v1, v2, w3), sp.S.Zero)
    cases = (
        *(Degenerate((upright,), at | zero | {w3: z * far}, joint, UNDEFINED) for z in (1, -1)),
        Degenerate((folded, upright), at | zero | nothing, joint, f"{FOLDED}."),
    )
    length = v[0] ** 2 + v[1] ** 2 - sum(e**2 for e in w)
    relations = (
        Relation(length, terms(because), "that both lines to the wrist are equally long"),
        Relation(aside**2 - w1**2 - w2**2, (), "that a distance is that of its coordinates"),
        Relation(far**2 - aside**2 - w3**2, (), "that a distance is that of its coordinates"),
        Relation(s**2 + c**2 - 1, (), "that the arm angle has a sine and a cosine"),
    )
    means = dict(zip(M, unknown, strict=True))
    return Applied(lemma, M, means, given, cases, relations=relations)


__all__ = ["arm_angle", "arm_plane"]
