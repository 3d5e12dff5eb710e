"""One rotation that takes a vector to another (the first subproblem of Paden and Kahan)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain
from closedform.lemmas.links import degenerate, differs_from_zero, named, vanishing
from closedform.lemmas.pairs import any_pair, direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.zyz import Reaching, within_reach
from closedform.model.functions import choose
from closedform.model.inverse import Degenerate, Relation
from closedform.model.lemma import Lemma, label

Because = Mapping[sp.Symbol, sp.Expr | Sequence[sp.Expr]]
"""Why two vectors are equally long: unknowns, and the factors of their equations."""

theorem(
    "rotation of a vector",
    statement=r"""Let $w$ and $v$ be vectors of the plane with $|w| = |v| > 0$.  In $(-\pi, \pi]$
the equation $R(\theta)\,w = v$ has exactly one solution,
$$\theta = \operatorname{atan2}(w_1 v_2 - w_2 v_1,\ w_1 v_1 + w_2 v_2).$$""",
    proof=r"""In the complex plane the equation is $e^{i\theta}\,w = v$, so that $e^{i\theta} = v/w
= \bar w v/|w|^2$, a number of absolute value $|v|/|w| = 1$.  The real part of $\bar w v$ is
$w_1 v_1 + w_2 v_2$ and the imaginary part is $w_1 v_2 - w_2 v_1$.  For the angle of this number
$e^{i\theta}\,w = v$, and no other angle in $(-\pi, \pi]$ has the same sine and cosine.""",
    exception=r"""If $w = v = 0$, every $\theta$ is a solution: the joint is free.  If $|w| \ne
|v|$, there is no solution.""",
)


@chain_lemma("Rz(x) w = v", "the pair of x")
def rotate(
    chain: Chain,
    x: sp.Symbol,
    w: Sequence[sp.Expr],
    v: Sequence[sp.Expr],
    *,
    because: Because | None = None,
    scale: sp.Expr | None = None,
    reaching: Reaching | None = None,
    name: str = "",
) -> Applied:
    """``Rz(x) w = v`` for vectors of the plane of equal length: one solution.

    x is free where both vanish.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    w, v
        the vector before the turn and after it
    because
        why both are equally long: w.w - v.v is the sum of the equations that were solved for
        these unknowns, each times the factor given.  Where one of them was tangent, the target may
        be just out of its reach, and the lengths may differ by much more: they are compared there
    scale
        that of the vectors, by default the size of the arm
    reaching
        what the rest of the arm has to reach, if the turn decides on it
    name
        what the names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(x)
    size = chain.size if scale is None else scale
    w, v = ([sp.sympify(e, strict=True) for e in vector[:2]] for vector in (w, v))
    relation = w[0] ** 2 + w[1] ** 2 - v[0] ** 2 - v[1] ** 2
    w1, w2 = (chain.coefficient(f"w{i}_{tag}", e) for i, e in enumerate(w, 1))
    v1, v2 = (chain.named(f"v{i}_{tag}", e) for i, e in enumerate(v, 1))
    sine = p.let(f"cross_{tag}", w1 * v2 - w2 * v1)
    cosine = p.let(f"dot_{tag}", w1 * v1 + w2 * v2)
    length = p.let(f"square_{tag}", sp.sqrt(sine**2 + cosine**2), nonnegative=True)
    flag: Any = sp.false
    of_w, of_v = sp.sqrt(w1**2 + w2**2), sp.sqrt(v1**2 + v2**2)
    # with fewer than six joints the whole pose is corrected and compared after the last lemma
    partial = chain.is_pose and len(chain.joints) < 6
    tangent = sp.Or(*chain.tangent) if because and not partial else sp.false
    if tangent is not sp.false:
        # half: what is allowed here stays well within the round trip that is promised
        missed = choose(tangent, of_w - of_v, 0)
        p.match(missed, size / 2, f"{x.name} turns a vector to one of its length")
    shorter = sp.Min(of_w, of_v)
    if not any(differs_from_zero(chain, e, size) for e in (w1, w2)):
        flag = p.vanishes(
            f"on_axis_{tag}", shorter, size, f"the target is on the axis of {x.name}", free=(x,)
        )
    found, near = direction(sine, cosine, length, flag), ()
    unit: dict[sp.Expr, sp.Expr] = {}
    if reaching is not None:
        unit_vector = cosine / length, sine / length
        span = p.let(f"span_{tag}", shorter, nonnegative=True)
        found, near, unit = within_reach(reaching, unit_vector, span, x, flag)
    pair, means = named(chain, x, found)
    lemma = Lemma(
        "rotation of a vector",
        r"R(\theta)\,w = v,\ |w| = |v| \;\Rightarrow\; \theta = "
        r"\operatorname{atan2}(w \times v, w \cdot v)",
        (
            w1 * sp.cos(x) - w2 * sp.sin(x) - v1,
            w1 * sp.sin(x) + w2 * sp.cos(x) - v2,
        ),
        {x: pair.angle},
        1,
        roles=((r"\theta", x), ("w", sp.Matrix([w1, w2])), ("v", sp.Matrix([v1, v2]))),
    )
    turn = any_pair("tau")
    s, c = turn.s, turn.c
    given = {v1: w1 * c - w2 * s, v2: w1 * s + w2 * c}
    locus = vanishing(w1, w2, v1, v2)
    returned = "0 is returned." if reaching is None else "one within reach is returned."
    meaning = f"the target is on the axis of {x}; {x} is free, {returned}"
    cases = degenerate(flag, [locus and locus | unit], x, meaning)
    if near and locus is not None:
        cases += (Degenerate(near, locus | unit, None, meaning),)
    relations = (
        Relation(relation, terms(because), f"that {_shown(w)} and {_shown(v)} are equally long"),
    )
    return Applied(lemma, pair, means, given, cases, relations=relations)


def terms(because: Because | None) -> tuple[tuple[sp.Symbol, tuple[sp.Expr, ...]], ...]:
    """The terms of a relation: for each unknown the factors of its equations."""
    listed = {u: e if isinstance(e, tuple | list) else (e,) for u, e in (because or {}).items()}
    return tuple((u, tuple(map(sp.sympify, factors))) for u, factors in listed.items())


def _shown(vector: Sequence[sp.Expr]) -> str:
    return f"({vector[0]}, {vector[1]})"
