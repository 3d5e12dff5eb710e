"""What mechanisms share whose hand is found from three of its points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from closedform.lemmas.spheres import Meeting
from closedform.loops.hand import square
from closedform.model.functions import Program, choose
from closedform.model.inverse import Link

FREE_POINT = (
    "SINGULAR: the centres of three spheres are in line, and the point where they meet is free on "
    "a circle; one of its points is returned."
)
NEAR = "Ill-conditioned near the parallel singularities, where two modes meet."


def require_triangle(f: Program, spans: Sequence[sp.Matrix], size: sp.Expr, what: str) -> list[str]:
    """Refuse dimensions with which three points are in line; notes that say so.

    ``spans`` lead from one of the points to the others, and ``what`` says that they are not.
    """
    normal = spans[0].cross(spans[1])
    if (across := normal.dot(normal)).is_number:
        return []
    flat = f.vanishes("flat", across, size**4, what, squares=True)
    f.require([choose(flat, 1, 0)], 1, what)
    return [f"INVALID: also unless {what}."]


def named_point(
    f: Program, found: Meeting, x: sp.Matrix, roles: Iterable[tuple[str, Any]]
) -> tuple[sp.Matrix, Link]:
    """The point where spheres meet, under its own names, and the link that gives it.

    ``x`` has the unknown coordinates, and ``roles`` what the letters of the lemma stand for.
    """
    start = len(f.body)
    place = sp.Matrix([f.let(str(e), found.lemma[e]) for e in x])
    body, means = (*found.link.body, *f.body[start:]), dict(zip(place, x, strict=True))
    return place, with_roles(replace(found.link, body=body, means=means), roles)


def with_roles(link: Link, roles: Iterable[tuple[str, Any]]) -> Link:
    """The link, whose article says what the letters of its lemma stand for."""
    assert link.lemma is not None
    return replace(link, lemma=replace(link.lemma, roles=tuple(roles)))


def side_length(vector: sp.Matrix) -> sp.Expr:
    """The length of a vector, as the root of a product of factors."""
    return sp.sqrt(sp.factor(sp.expand(square(vector))))


__all__ = ["FREE_POINT", "NEAR", "named_point", "require_triangle", "side_length", "with_roles"]
