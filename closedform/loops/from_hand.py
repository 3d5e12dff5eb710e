"""What the inverses of linkages share, which follow the bodies from the hand to the joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.links import polar_lemma
from closedform.loops.leg_by_leg import SIGN, named_in, record_lemma
from closedform.loops.reached import bounds_of_any, export_reach
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Program, branches, choose, real
from closedform.model.inverse import Degenerate, Inverse, Link


@dataclass(frozen=True)
class Turned:
    """The joint of a body that turns about the ground: ``length`` times its pair is ``end``."""

    link: Link
    angle: sp.Expr
    length: sp.Symbol
    end: tuple[sp.Expr, sp.Expr]


def turned(
    p: Program,
    joint: sp.Symbol,
    end: tuple[sp.Expr, sp.Expr],
    *,
    size: sp.Expr,
    free: Sequence[sp.Symbol],
    body: str,
    name: str,
) -> Turned:
    """The angle of a body from the coordinates of a point on it, seen from its pivot.

    Parameters
    ----------
    p
        the program that the names are added to
    joint
        the angle
    end
        the coordinates, along the body at the angle zero and across
    size
        the natural size of the coordinates
    free
        the joints that are free where both vanish
    body
        its name, for what is said of that case
    name
        what the names of the coordinates begin with
    """
    a, b = (named_in(p, f"{name}{i}_{joint}", e) for i, e in enumerate(end))
    start = len(p.body)
    r = p.let(f"reach_{joint}", sp.sqrt(a**2 + b**2), nonnegative=True)
    none = p.vanishes(f"none_{joint}", r, size, f"{body} has no length", tuple(free))
    s, c = (choose(none, e, f) for e, f in ((0, b), (1, a)))
    rho = real(f"rho_{joint}")
    lemma = polar_lemma({joint: sp.atan2(s, c), rho: r}, (a, b))
    case = Degenerate((none,), {a: 0, b: 0}, joint, f"{body} has no length")
    steps = tuple(p.body[start:])
    link = Link((joint, rho), lemma.equations, {}, lemma, steps, degenerate=(case,))
    return Turned(link, lemma[joint], rho, (a, b))


def undetermined(d: Derivation, hand: Sequence[sp.Symbol]) -> bool:
    """Whether more joints are driven than the hand has coordinates; then says so."""
    more = len(d.actuated) > len(hand)
    if more:
        d.no_inverse(
            f"{len(d.actuated)} joints are driven and the hand has "
            f"{'one coordinate' if len(hand) == 1 else f'{len(hand)} coordinates'}, so a target "
            f"does not determine them"
        )
    return more


def export_inverse(
    d: Derivation,
    g: Program,
    joints: Sequence[sp.Expr],
    *,
    hand: Sequence[sp.Symbol],
    name: str,
    signs: Sequence[sp.Symbol],
    notes: Sequence[str],
    links: Sequence[Link],
    equations: Sequence[sp.Expr],
    passive: Sequence[sp.Symbol],
    angles: Sequence[sp.Symbol],
    on_curve: bool,
    images: str = "fk",
) -> None:
    """Export ``ik``, what it claims, and the reach of a hand that is not on a curve.

    Parameters
    ----------
    d
        the derivation
    g
        the program of the inverse
    joints
        the values of the driven joints
    hand
        its coordinates, or the joint that is the task
    name
        what is in reach, in words
    signs
        those that choose a working mode
    notes
        what the statuses say
    links
        the lemmas of the inverse, in order
    equations, passive
        what the answers solve, for the joints and these unknowns
    angles
        the coordinates of the hand that are angles
    on_curve
        whether one joint moves the hand, so that it is on a curve
    images
        the function all of whose results have the joints as a solution; empty if there is none
    """
    chosen = [(sigma, SIGN) for sigma in signs]
    working = branches(*chosen) if chosen else SINGLE
    d.branches = working.labels
    d.function(
        "ik",
        "The driven joints of all working modes.",
        {"x": tuple(hand)},
        {"q": list(joints)},
        program=g,
        branches=working,
        result="Solutions",
        notes=tuple(notes),
    )
    if not on_curve:
        export_reach(d, bounds_of_any(g, signs), {"p": tuple(hand)}, name)
    for link in links:
        record_lemma(d, "ik", link)
    d.inverses.append(
        Inverse(
            "ik",
            d.actuated,
            (sp.S.Zero,) * len(equations),
            tuple(equations),
            images=images,
            links=tuple(links),
            passive=tuple(passive),
            angles=tuple(angles),
        )
    )


__all__ = ["Turned", "export_inverse", "turned", "undetermined"]
