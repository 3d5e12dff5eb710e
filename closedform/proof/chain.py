"""The proof of an inverse that is a chain of lemmas.

Soundness and completeness follow from four computed facts:

1. every lemma, with its coefficients as free symbols, satisfies its equations in every branch and
   in its degenerate cases, and its equations have no other solutions;
2. the equations of every lemma hold at every posture if the target is its image, so each posture
   is among the branches;
3. no lemma is applied to an equation whose coefficients vanish at every posture;
4. the equations of all lemmas determine the target from the joints.  By 2 the image of the joints
   is a solution, so it is the only one: the forward map takes each answer to the target.

Fact 4 is computed as ranks of matrices at random exact postures.  The equations that are linear in
the target (and in auxiliary lengths) determine some coordinates; those that are linear in the rest
once these are known determine others.  Full rank at one posture means full rank at almost all, and
the answers are continuous in the target where they exist.

The coefficients of a lemma may depend on each other, as two vectors of equal length.  That they do
is a sum of earlier equations, each times a factor.  They need not if the other equations, with what
the program compares with the target, determine it alone.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import sympy as sp

from closedform.algebra import certificates
from closedform.algebra.balls import Evaluator
from closedform.algebra.solutions import InfinitelyManyError, SolutionCount, count_solutions
from closedform.model.derivation import Continuum, Derivation, Inverse, Link
from closedform.model.functions import Bound, Function, Let, Match, Vanishes, substitute
from closedform.proof.determined import random_posture, undetermined
from closedform.proof.require import ProofError, require

Expr = Any


def prove_chain(derivation: Derivation, inverse: Inverse) -> tuple[int, tuple[Expr, ...], int]:
    """The number of solutions, the assumptions, and the number of proved degenerate cases."""
    function = derivation[inverse.function]
    where = f"{derivation.name}.{function.name}"
    assumptions: dict[Expr, None] = {}
    count, cases = 1, 0
    counts = []
    for link in inverse.chain:
        assumptions |= dict.fromkeys(_lemma_sound(link, where))
        counted = _lemma_complete(link, where)
        counts.append((counted.certificate, link.lemma.excluded))
        count *= link.lemma.branches
        cases += len(link.degenerate)
    graph = Graph(derivation, inverse, function)
    for link in inverse.chain:
        _follows(link, graph, where)
        _not_degenerate(link, graph, where)
    matches = [s.value for s in function.body if isinstance(s, Match)]
    _matches_follow(matches, graph, where)
    for continuum in inverse.continua:
        _flag_holds(continuum, function, graph, where)
    _free_choices_are_units(inverse, where)
    certain = [e for link in inverse.chain if not link.relations for e in link.lemma.equations]
    if not matches or undetermined(inverse, graph, [*certain, *matches]):
        _relations_hold(inverse, graph, where)
        _determines_target(inverse, graph, matches, where)
    branches = len(function.branches) if function.branches else 1
    certificates.add_inverse(function.name, branches, counts)
    return count, tuple(assumptions), cases


def _signs(link: Link) -> list[dict[Expr, int]]:
    """The branches of a lemma; the signs in its coefficients stay symbols."""
    made = {s.symbol for s in link.body if isinstance(s, (Let, Bound))}
    used = {s for st in link.body if isinstance(st, (Let, Bound)) for s in st.value.free_symbols}
    used |= {s for e in link.lemma.solution.values() for s in e.free_symbols}
    signs = sorted((s for s in used - made if s.name.startswith("sigma_")), key=str)
    return [dict(zip(signs, values, strict=True)) for values in product((1, -1), repeat=len(signs))]


def _values(
    link: Link, exprs: Sequence[Expr], known: Mapping[Expr, Expr]
) -> tuple[list[Expr], list[Expr]]:
    """Expressions in terms of the coefficients of a link, and the bounds they depend on."""
    held: dict[Expr, Expr] = dict(known)
    flags = {s.symbol: sp.false for s in link.body if isinstance(s, Vanishes)}
    flags |= {s: v for s, v in known.items() if s in flags}
    statements = {
        s.symbol: substitute(s.value, flags) for s in link.body if isinstance(s, (Let, Bound))
    }
    exprs = [substitute(e, flags) for e in exprs]
    needed, pending = set(), {s for e in exprs for s in e.free_symbols}
    while pending:
        symbol = pending.pop()
        if symbol in statements and symbol not in needed and symbol not in held:
            needed.add(symbol)
            pending |= statements[symbol].free_symbols
    bounds = []
    for statement in link.body:
        if isinstance(statement, (Let, Bound)) and statement.symbol in needed:
            held[statement.symbol] = substitute(statements[statement.symbol], held)
            if isinstance(statement, Bound):
                bounds.append(held[statement.symbol])
    return [substitute(e, held) for e in exprs], bounds


def _lemma_sound(link: Link, where: str) -> list[Expr]:
    """Prove that a lemma satisfies its equations in every branch and every degenerate case."""
    lemma, found = link.lemma, list[Expr]()
    settings: list[tuple[dict[Expr, Expr], Mapping[Expr, Expr], str]] = [
        (
            {},
            link.given,
            f"{where}: what the lemma {lemma.name!r} gives for {_names(lemma.solution)} does not "
            f"satisfy its equations",
        )
    ]
    for case in link.degenerate:
        flags = dict.fromkeys(case.flags, sp.true)
        settings.append((flags, case.locus, f"{settings[0][2]} in a case: {case.meaning[:-1]}"))
    for signs in _signs(link):
        for flags, locus, place in settings:
            known = {**signs, **flags, **(locus if flags else {})}
            values, bounds = _values(link, [*lemma.solution.values(), *link.means], known)
            n = len(lemma.solution)
            solution = dict(zip(lemma.solution, values[:n], strict=True))
            residues = [substitute(e, solution) for e in lemma.equations]
            residues += [
                value - substitute(meaning, solution)
                for value, meaning in zip(values[n:], link.means.values(), strict=True)
            ]
            vanishing = sp.Matrix([substitute(e, locus) for e in residues])
            guards = tuple(substitute(b, locus) for b in bounds)
            found += require(vanishing, guards, place).assumptions
    return found


def _free_choices_are_units(inverse: Inverse, where: str) -> None:
    """Prove that a freely chosen sine and cosine in a degenerate case are those of an angle."""
    body = tuple(statement for link in inverse.chain for statement in link.body)
    whole = Link(inverse.chain[0].lemma, body, {}, {})
    for s, c, free in inverse.units:
        held = {e: e for e in free if e.is_Symbol}
        (sine, cosine), _ = _values(whole, [s, c], held)
        for side in (1, -1):
            square = (sine**2 + cosine**2 - 1).xreplace(
                {e: sp.Integer(side) for e in free if e.is_Symbol and not e.is_nonnegative}
            )
            require(square, (), f"{where}: ({c}, {s}) is not a unit vector")


def _names(solution: Mapping[Expr, Expr]) -> str:
    return ", ".join(map(str, solution))


_counted: dict[Any, SolutionCount] = {}


def forget_counts() -> None:
    """Count everything anew, so that the certificates of a mechanism are complete."""
    _counted.clear()


def _lemma_complete(link: Link, where: str) -> SolutionCount:
    lemma = link.lemma
    key = (lemma.equations, tuple(lemma.solution), tuple(link.given.items()))
    try:
        if key not in _counted:
            given = {s: e for s, e in link.given.items() if any(q.has(s) for q in lemma.equations)}
            _counted[key] = count_solutions(
                lemma.equations, tuple(lemma.solution), target_substitution=given
            )
    except InfinitelyManyError as error:
        raise ProofError(f"{where}: the lemma {lemma.name!r}: {error}") from error
    counted = _counted[key]
    if counted.count != lemma.branches + lemma.excluded:
        raise ProofError(
            f"{where}: the equations of the lemma {lemma.name!r} for {_names(lemma.solution)} have "
            f"{counted.count} solutions, but {lemma.branches} branches are given; it is applied to "
            f"equations of another shape"
        )
    return counted


class Graph:
    """The values of all names of the program at a posture whose image is the target."""

    def __init__(self, derivation: Derivation, inverse: Inverse, function: Function):
        self.inverse = inverse
        self.unknowns = inverse.unknowns
        self.parameters = [p.symbol for p in derivation.parameters]
        self.sums: dict[Expr, Expr] = {}
        taken: set[Expr] = set()
        for symbol, value in inverse.defined.items():
            # a sum replaces its newest joint, so that only single angles remain
            joint = next(
                (j for j in reversed(self.unknowns) if value.has(j) and j not in taken), None
            )
            if joint is not None:
                taken.add(joint)
                (self.sums[joint],) = sp.solve(value - symbol, joint)
        self.names: dict[Expr, Expr] = {}
        self.meaning = inverse.meaning
        self.made = {s.symbol: s.value for s in function.body if isinstance(s, (Let, Bound))}
        self.targets = {
            x: self.in_sums(f) for x, f in zip(inverse.targets, inverse.forward, strict=True)
        }
        self.lengths = {s: self.in_sums(e) for s, e in inverse.lengths.items()}

    def in_sums(self, e: Expr) -> Expr:
        for _ in self.sums:
            e = substitute(e, self.sums)
        return e

    def named(self, e: Expr) -> Expr:
        """An expression in terms of the unknowns and the target only."""
        return self.in_sums(self._written_out(e))

    def _written_out(self, e: Expr) -> Expr:
        for s in e.free_symbols:
            if s not in self.names and (s in self.meaning or s in self.made):
                self.names[s] = self._written_out(self.meaning.get(s, self.made.get(s)))
        return substitute(e, self.names)

    def __call__(self, e: Expr) -> Expr:
        """The value of an expression at a posture, with its image as the target."""
        return substitute(substitute(self.named(e), self.lengths), self.targets)


def _follows(link: Link, graph: Graph, where: str) -> None:
    lemma = link.lemma
    place = (
        f"{where}: the equation solved for {_names(lemma.solution)} by the lemma {lemma.name!r} "
        f"does not follow from the forward map"
    )
    require(sp.Matrix([graph(e) for e in lemma.equations]), (), place)


def _not_degenerate(link: Link, graph: Graph, where: str) -> None:
    """Prove that the flags of a lemma are false at some posture."""
    draw = random.Random(1)
    for statement in link.body:
        if not (isinstance(statement, Vanishes) and statement.free):
            continue
        value = _without_signs(graph(statement.value))
        point = random_posture(draw, list(value.free_symbols))
        certificates.regular([[value**2]], point, "quantities that differ from zero at a posture")
        (ball,) = Evaluator(list(point), [value])(list(point.values()))
        if ball.contains(0):
            raise ProofError(
                f"{where}: the lemma {link.lemma.name!r} for {_names(link.lemma.solution)} is "
                f"applied to an equation that is degenerate at every posture: "
                f"{statement.meaning}; take an equation whose coefficients do not all vanish"
            )


def _flag_holds(continuum: Continuum, function: Function, graph: Graph, where: str) -> None:
    """On the locus of a continuum; what then is returned is proved of the lemma's own case."""
    (value,) = (
        s.value for s in function.body if isinstance(s, Vanishes) and s.symbol == continuum.flag
    )
    place = f"{where}: on the continuum of {continuum.free} the flag {continuum.flag} is not true"
    locus = {s: graph.in_sums(e) for s, e in continuum.locus.items()}
    require(substitute(graph.named(value) ** 2, locus), (), place)


def _without_signs(e: Expr) -> Expr:
    return e.xreplace({s: sp.S.One for s in e.free_symbols if s.name.startswith("sigma_")})


def _matches_follow(matches: Sequence[Expr], graph: Graph, where: str) -> None:
    """Prove that no posture is refused because its image does not match."""
    place = f"{where}: what the target is compared with differs from the forward map"
    require(sp.Matrix([graph(e) for e in matches]), (), place)


def _relations_hold(inverse: Inverse, graph: Graph, where: str) -> None:
    """Prove that the coefficients of each lemma satisfy what it requires of them."""
    first: dict[Expr, Expr] = {}
    for link in inverse.chain:
        for relation in link.relations:
            place = f"{where}: {relation.meaning}, which the lemma {link.lemma.name!r} requires"
            unknown = [u for u, _ in relation.terms if u not in first]
            if unknown or not relation.terms:
                missing = f": no earlier lemma solves for {unknown[0]}" if unknown else ""
                raise ProofError(
                    f"{place}, does not follow from earlier equations{missing}; say with because= "
                    f"from which"
                )
            total = sum(factor * first[u] for u, factor in relation.terms)
            require(graph.named(relation.value - total), (), f"{place}, does not follow so")
        first[next(iter(link.lemma.solution))] = link.lemma.equations[0]


def _determines_target(inverse: Inverse, graph: Graph, matches: Sequence[Expr], where: str) -> None:
    """Prove that the equations have no other solution for the target than the image."""
    lemmas = [e for link in inverse.chain for e in link.lemma.equations]
    if missing := undetermined(inverse, graph, [*lemmas, *matches]):
        count = len(inverse.targets) + len(inverse.angles) + len(inverse.lengths)
        raise ProofError(
            f"{where}: the lemmas leave {len(missing)} of the {count} coordinates of the target "
            f"undetermined: no equation that is linear in the target holds {', '.join(missing)}"
        )


__all__ = ["Graph", "prove_chain"]
