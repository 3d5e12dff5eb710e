"""The rotation that takes two vectors to two others."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.named import named, named_in
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma

theorem(
    "two vectors",
    statement=r"""Let $\mathbf d$ and $\mathbf e$ be vectors with $\mathbf m = \mathbf d \times
\mathbf e \ne \mathbf 0$, and let $\mathbf u$ and $\mathbf v$ be as long as these, with $\mathbf
u\cdot\mathbf v = \mathbf d\cdot\mathbf e$.  Exactly one rotation takes $\mathbf d$ to $\mathbf u$
and $\mathbf e$ to $\mathbf v$,
$$R = \frac{\mathbf u\,(\mathbf e \times \mathbf m)^T + \mathbf v\,(\mathbf m \times \mathbf d)^T +
(\mathbf u \times \mathbf v)\,\mathbf m^T}{\mathbf m\cdot\mathbf m}.$$
It is the same with $\mathbf e - k\,\mathbf d$ and $\mathbf v - k\,\mathbf u$ instead of $\mathbf e$
and $\mathbf v$, for any $k$.  With $k = \mathbf d\cdot\mathbf e / \mathbf d\cdot\mathbf d$ fewer
digits cancel where $\mathbf d$ and $\mathbf e$ are nearly parallel.""",
    proof=r"""A rotation with $R\,\mathbf d = \mathbf u$ and $R\,\mathbf e = \mathbf v$ has
$R\,\mathbf m = \mathbf u \times \mathbf v$.  The vectors $\mathbf d$, $\mathbf e$ and $\mathbf m$
are a basis, so these three equations determine $R$.  The rows $(\mathbf e \times \mathbf m)^T$,
$(\mathbf m \times \mathbf d)^T$ and $\mathbf m^T$ over $\mathbf m\cdot\mathbf m$ are the dual
basis, so the matrix above satisfies them.  It is a rotation, because both bases have the same
products: $|\mathbf m|^2 = |\mathbf d|^2 |\mathbf e|^2 - (\mathbf d\cdot\mathbf e)^2$, and the same
holds for $\mathbf u \times \mathbf v$.""",
    exception=r"""If $\mathbf m = \mathbf 0$, the rotation is free about the line of both
vectors.""",
)


def two_vectors(
    program: Program,
    given: Sequence[sp.Matrix],
    turned: Sequence[sp.Matrix],
    rotation: sp.Matrix,
    *,
    name: str = "R",
) -> tuple[Link, sp.Matrix]:
    """The rotation that takes two ``given`` vectors to the ``turned`` ones, with named entries.

    The vectors have their coordinates under names too.  The given ones are not parallel.
    """
    p, (d, e), (u, v) = program, given, turned
    start = len(p.body)
    along = named_in(p, "along_d", e.dot(d) / d.dot(d))
    across, turned_across = named(p, "e_across", e - along * d), named(p, "v_across", v - along * u)
    m = named(p, "m", d.cross(across))
    over = p.let("over_m", 1 / m.dot(m), nonnegative=True)
    rows = [named(p, name, x.cross(y) * over) for name, x, y in (("g", across, m), ("h", m, d))]
    rows.append(named(p, "k", m * over))
    w = named(p, "w", u.cross(turned_across))
    made = u * rows[0].T + turned_across * rows[1].T + w * rows[2].T
    value = sp.Matrix(3, 3, lambda i, j: p.let(f"{name}_{i + 1}{j + 1}", made[i, j]))
    equations = (rotation * d - u, rotation * e - v, rotation * d.cross(e) - u.cross(v))
    lemma = Lemma(
        "two vectors",
        r"R\,\mathbf d = \mathbf u,\ R\,\mathbf e = \mathbf v \;\Rightarrow\; R = \frac{\mathbf "
        r"u\,(\mathbf e \times \mathbf m)^T + \mathbf v\,(\mathbf m \times \mathbf d)^T + (\mathbf "
        r"u \times \mathbf v)\,\mathbf m^T}{\mathbf m\cdot\mathbf m}",
        tuple(entry for equation in equations for entry in equation),
        dict(zip(rotation, value, strict=True)),
        1,
        matrix="R",
    )
    body, means = tuple(p.body[start:]), dict(zip(value, rotation, strict=True))
    return Link(tuple(rotation), lemma.equations, lemma=lemma, body=body, means=means), value


__all__ = ["two_vectors"]
