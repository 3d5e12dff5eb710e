"""What is claimed of an inverse: a list of links, and the glue that ties them to the forward map.

A :class:`Link` is some unknowns and the equations that are solved for them, mostly by a lemma.  The
glue says why the links together have the solutions of the forward map and no others.  There are
three kinds:

None
    the equations of the links are those of the inverse, once the names of the program that lemmas
    have as coefficients are replaced by their values;
:class:`Rank`
    they follow from the forward map and determine the target;
:class:`Combination`
    an invertible matrix combines them to those of the inverse.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import sympy as sp

from closedform.model.functions import Bound, Statement
from closedform.model.lemma import Lemma
from closedform.model.names import check_text


@dataclass(frozen=True)
class Degenerate:
    """A flagged case: on ``locus`` the ``flags`` are true, and the joint ``free`` may be chosen.

    ``meaning`` says so in words, for a docstring, and ``relation`` is LaTeX for what the other
    joints keep.  The case occurs in the named ``branches``, or in all if none is named.
    """

    flags: tuple[sp.Symbol, ...]
    locus: Mapping[sp.Symbol, sp.Expr]
    free: sp.Symbol | None
    meaning: str = ""
    relation: str = ""
    branches: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        flags = ", ".join(map(str, self.flags))
        check_text(f"degenerate case {flags}", self.meaning, self.relation)


@dataclass(frozen=True)
class Relation:
    """A relation that the coefficients of a lemma satisfy: ``value`` is zero.

    It is the sum of the equations of earlier links, each times a factor; a term gives the first
    unknown of the link, and the factors of its first equations.  ``meaning`` is for messages.
    Without terms, the value vanishes by the definitions of its names, or because ``root`` is
    defined as a root of it.
    """

    value: sp.Expr
    terms: tuple[tuple[sp.Symbol, tuple[sp.Expr, ...]], ...]
    meaning: str
    root: sp.Symbol | None = None


@dataclass(frozen=True)
class Link:
    """Some of the unknowns, and the equations that are solved for them.

    The equations may contain the unknowns of earlier links.  ``given`` writes their other symbols
    in free symbols or in earlier unknowns, such that every earlier equation whose unknowns occur
    here holds identically.

    A ``lemma`` gives the solutions.  ``body`` contains the statements that it added, ``means`` the
    names that it returned, with their values in the unknowns, and ``degenerate`` its own flagged
    cases. ``relations`` say why coefficients that ``given`` writes in free symbols depend on each
    other. Without a lemma, the solutions are those that the function returns.
    """

    unknowns: tuple[sp.Symbol, ...]
    equations: tuple[sp.Expr, ...]
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    lemma: Lemma | None = None
    body: tuple[Statement, ...] = ()
    means: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    degenerate: tuple[Degenerate, ...] = ()
    relations: tuple[Relation, ...] = ()

    @classmethod
    def of(cls, lemma: Lemma, given: Mapping[sp.Symbol, sp.Expr] | None = None) -> Link:
        """The link of a lemma with its own statements; its premises are proved with the inverse."""
        premises = (Bound(name, value, sp.S.One, "") for name, value in lemma.premises.items())
        return cls(
            tuple(lemma.solution),
            lemma.equations,
            given or {},
            lemma,
            (*premises, *lemma.body),
            lemma.means,
        )


@dataclass(frozen=True)
class Rank:
    """The equations of the links follow from the forward map, and determine the target.

    Those that are linear in the target and in auxiliary ``lengths``, given what other equations
    determine, have matrices of full rank.
    """

    meaning: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The values of names of the program at a posture, in the unknowns."""
    defined: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """Auxiliary angles: sums of the unknowns."""
    lengths: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """Auxiliary lengths, at a posture."""
    units: tuple[tuple[sp.Expr, sp.Expr, tuple[sp.Expr, ...]], ...] = ()
    """Pairs of angles that may be chosen freely, and the names that are free in them."""
    extra_coordinates: tuple[sp.Symbol, ...] = ()
    """Names of quantities that the target determines; they count as further coordinates of it."""


@dataclass(frozen=True)
class Combination:
    """The equations of the links, times an invertible ``matrix``, are those of the inverse.

    So both have the same solutions.  ``joints`` gives each unknown of the inverse in the unknowns
    of the links and names of the program.  If a side condition keeps only one of every
    ``solutions_per_branch`` solutions, ``because`` is the reason.
    """

    matrix: sp.Matrix
    joints: Mapping[sp.Symbol, sp.Expr]
    solutions_per_branch: int = 1
    because: str = ""


@dataclass(frozen=True)
class Inverse:
    """The equations of an inverse: ``forward``, in the ``unknowns``, equals the ``targets``.

    Targets that depend on each other (the entries of a rotation) have a ``parametrisation``: the
    same number of expressions in free symbols.  For targets in ``angles`` only the sine and the
    cosine count.

    A closed loop gives equations that contain both unknowns and inputs.  They are ``forward``, and
    the ``targets`` are zeros.  ``images`` names a function whose values, in each assembly mode, are
    inputs with a known solution.

    If the solved equations are not the forward map itself, the targets are expressions in the
    inputs (such as ``tan(psi)``), and ``forward`` may contain inputs.  Then the glue is a
    :class:`Combination`; a step shows that the map named by ``images`` satisfies the equations; the
    cross-check substitutes the answers into that map.

    Without ``links`` the whole system is one link.  The locus of a ``degenerate`` case is written
    in the target, the parameters and unknowns that were solved before.
    """

    function: str
    unknowns: tuple[sp.Symbol, ...]
    targets: tuple[Any, ...]
    forward: tuple[sp.Expr, ...]
    degenerate: tuple[Degenerate, ...] = ()
    parametrisation: tuple[sp.Expr, ...] = ()
    angles: tuple[sp.Symbol, ...] = ()
    images: str = ""
    links: tuple[Link, ...] = ()
    glue: Rank | Combination | None = None
    nonnegative: tuple[sp.Symbol, ...] = ()
    """Unknowns that are lengths: two solutions that differ only in their sign count as one."""
    passive: tuple[sp.Symbol, ...] = ()
    """Further unknowns that the links solve for, and that the function does not return."""
    weights: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The weight of the angle of a target, in the unknowns, if it is undefined somewhere."""
    condition: sp.Expr = sp.S.Zero
    """The factor by which the mechanism amplifies rounding, in its parameters; see ``promised``."""

    def posed(self, inputs: tuple[sp.Symbol, ...], image: tuple[sp.Expr, ...]) -> Inverse:
        """The same inverse with the forward map ``image`` as its equations."""
        return replace(self, targets=inputs, forward=image, images="", links=(), glue=None)

    @property
    def equations(self) -> tuple[sp.Expr, ...]:
        """The expressions that vanish at a solution."""
        return tuple(
            self.weights.get(x, sp.S.One) * equation
            for f, x in zip(self.forward, self.targets, strict=True)
            for equation in (
                (sp.cos(f) - sp.cos(x), sp.sin(f) - sp.sin(x)) if x in self.angles else (f - x,)
            )
        )

    @property
    def rank(self) -> Rank:
        """The glue if it is a rank; otherwise an empty one."""
        return self.glue if isinstance(self.glue, Rank) else Rank()

    @property
    def by_lemmas(self) -> bool:
        """Whether lemmas solve for the unknowns."""
        return any(link.lemma for link in self.links)

    @property
    def chained(self) -> tuple[Link, ...]:
        """The links, or the whole system as one."""
        if self.links:
            return self.links
        given = dict(zip(self.targets, self.parametrisation, strict=False))
        return (Link(self.unknowns, self.equations, given),)


__all__ = ["Combination", "Degenerate", "Inverse", "Link", "Rank", "Relation"]
