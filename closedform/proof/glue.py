"""Proves that the links of an inverse have the solutions of its forward map, and no others.

Of a :class:`~closedform.model.inverse.Rank` three facts are computed:

1. the equations of every link hold at every posture if the target is its image, so each posture is
   among the branches;
2. no lemma is applied to an equation whose coefficients vanish at every posture;
3. the equations of all links determine the target from the joints.  By 1 the image of the joints
   is a solution, so it is the only one: the forward map takes each answer to the target.

Fact 3 is computed as ranks of matrices at random exact postures.  The equations that are linear in
the target (and in auxiliary lengths) determine some coordinates; those that are linear in the rest
once these are known determine others.  Full rank at one posture means full rank at almost all, and
the answers are continuous in the target where they exist.

The coefficients of a lemma may depend on each other, as two vectors of equal length do.  A relation
says why: it is a sum of earlier equations, each times a factor.  No reason is needed if the other
equations, with what the program compares with the target, determine it alone.

Of a :class:`~closedform.model.inverse.Combination`: the matrix is invertible, and the equations of
the links, times the matrix, are those of the inverse.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import sympy as sp
from flint import arb_mat, ctx

from closedform.algebra import certificates
from closedform.algebra.balls import Evaluator
from closedform.algebra.normal_form import is_zero
from closedform.algebra.resolvent import Resolvent
from closedform.model.expressions import substitute
from closedform.model.functions import Function, Let, Match, Vanishes, explicit
from closedform.model.inverse import Combination, Degenerate, Inverse, Link, Rank
from closedform.proof.determined import random_posture, undetermined
from closedform.proof.posture import Posture, generic, meanings, outcomes
from closedform.proof.require import ProofError, require

Expr = Any
ONES = (sp.S.One, sp.S.NegativeOne)


def prove_glue(function: Function, inverse: Inverse, where: str) -> None:
    """Prove what ties the links of an inverse to its forward map."""
    if isinstance(inverse.glue, Rank):
        _Chain(function, inverse, inverse.glue, where).prove()
    elif isinstance(inverse.glue, Combination):
        _Combined(function, inverse, inverse.glue, where).prove()
    elif inverse.by_lemmas:
        same = Combination(sp.eye(len(inverse.equations)), {u: u for u in inverse.unknowns})
        _Combined(function, inverse, same, where).prove()
    else:
        _require_own_equations(inverse, where)


def _require_own_equations(inverse: Inverse, where: str) -> None:
    used = sorted((e for link in inverse.chained for e in link.equations), key=str)
    solved = [u for link in inverse.chained for u in link.unknowns]
    if used != sorted(inverse.equations, key=str) or set(solved) != set(inverse.unknowns):
        raise ProofError(
            f"{where}: the links do not take every equation and every unknown exactly once"
        )


def _names(link: Link) -> str:
    return ", ".join(map(str, link.unknowns))


def _title(link: Link) -> str:
    return f"the lemma {link.lemma.name!r}" if link.lemma else "no lemma"


def require_root(root: Expr, value: Expr, made: Mapping[Expr, Expr], place: str) -> None:
    """Prove that a relation vanishes because its root is defined as a root of it."""
    defined = made[root]
    if not isinstance(defined, Resolvent):
        raise ProofError(f"{place}, does not follow: {root} is not defined as a root")
    require(value - defined.law(root), (), f"{place}, is not how it is defined")


class _Chain:
    """An inverse whose glue is a rank."""

    def __init__(self, function: Function, inverse: Inverse, glue: Rank, where: str):
        self.function, self.inverse, self.glue, self.where = function, inverse, glue, where
        self.posture = Posture(inverse, glue, function)
        self.signs = function.signs
        self.matches = [s.value for s in function.body if isinstance(s, Match)]

    def prove(self) -> None:
        for link in self.inverse.links:
            self._follows(link)
            self._not_degenerate(link)
        for case in self.inverse.degenerate:
            self._flags_hold(case)
        self._matches_follow()
        self._free_choices_are_units()
        if not self._compared_alone():
            self._relations_hold()
            self._determines_target()

    def _follows(self, link: Link) -> None:
        place = (
            f"{self.where}: the equation solved for {_names(link)} by {_title(link)} does not "
            f"follow from the forward map"
        )
        for missed in outcomes(sp.ImmutableMatrix([self.posture(e) for e in link.equations])):
            require(missed, (), place)

    def _not_degenerate(self, link: Link) -> None:
        """Prove that the flags of a lemma are false at some posture."""
        draw = random.Random(1)
        for statement in link.body:
            if not (isinstance(statement, Vanishes) and statement.free):
                continue
            value = self.posture(statement.value).xreplace(dict.fromkeys(self.signs, sp.S.One))
            point = random_posture(draw, list(value.free_symbols))
            certificates.point([[value**2]], point, "quantities that differ from zero at a posture")
            (ball,) = Evaluator(list(point), [value])(list(point.values()))
            if ball.contains(0):
                raise ProofError(
                    f"{self.where}: {_title(link)} for {_names(link)} is applied to an "
                    f"equation that is degenerate at every posture: {statement.meaning}; take an "
                    f"equation whose coefficients do not all vanish"
                )

    def _flags_hold(self, case: Degenerate) -> None:
        """Prove that the flags of a case hold on its locus.

        The answer there is proved with the lemma's own case.
        """
        for flag in case.flags:
            (value,) = (
                s.value for s in self.function.body if isinstance(s, Vanishes) and s.symbol == flag
            )
            place = f"{self.where}: where {case.free} is free the flag {flag} is not true"
            locus = {s: self.posture.in_sums(e) for s, e in case.locus.items()}
            require(substitute(self.posture.named(value) ** 2, locus), (), place)

    def _free_choices_are_units(self) -> None:
        """Prove that a freely chosen sine and cosine in a degenerate case are those of an angle."""
        body = tuple(statement for link in self.inverse.links for statement in link.body)
        for s, c, free in self.glue.units:
            held = {e: e for e in free if e.is_Symbol}
            (sine, cosine), _ = explicit(body, [s, c], held)
            for side in (1, -1):
                square = (sine**2 + cosine**2 - 1).xreplace(
                    {e: sp.Integer(side) for e in free if e.is_Symbol and not e.is_nonnegative}
                )
                require(square, (), f"{self.where}: ({c}, {s}) is not a unit vector")

    def _matches_follow(self) -> None:
        """Prove that no posture is rejected because its image does not match."""
        place = f"{self.where}: what the target is compared with differs from the forward map"
        if self.matches:
            require(sp.Matrix([self.posture(e) for e in self.matches]), (), place)

    def _compared_alone(self) -> bool:
        """Whether comparisons and lemmas without relations determine the target."""
        links = [link for link in self.inverse.links if not link.relations]
        return bool(self.matches) and not self._undetermined(links)

    def _relations_hold(self) -> None:
        """Prove that the coefficients of each lemma satisfy its relations."""
        solved: dict[Expr, tuple[Expr, ...]] = {}
        rotation = dict(zip(self.inverse.targets, self.inverse.parametrisation, strict=False))
        for link in self.inverse.links:
            for relation in link.relations:
                place = f"{self.where}: {relation.meaning}, which {_title(link)} requires"
                if relation.root is not None:
                    require_root(relation.root, relation.value, self.posture.made, place)
                    continue
                fault = "does not follow from earlier equations"
                unknown = [u for u, _ in relation.terms if u not in solved]
                if unknown:
                    raise ProofError(
                        f"{place}, {fault}: no earlier lemma solves for {unknown[0]}; say with "
                        f"because= from which"
                    )
                total = sum(
                    factor * equation
                    for u, factors in relation.terms
                    for factor, equation in zip(factors, solved[u], strict=False)
                )
                difference = self.posture.named(relation.value - total)
                why = "does not follow so" if relation.terms else f"{fault}; say with because="
                require(substitute(difference, rotation), (), f"{place}, {why}")
            solved[link.unknowns[0]] = link.equations

    def _determines_target(self) -> None:
        """Prove that the equations have no other solution for the target than the image."""
        if missing := self._undetermined(self.inverse.links):
            count = len(self.inverse.targets) + len(self.inverse.angles) + len(self.glue.lengths)
            raise ProofError(
                f"{self.where}: the lemmas leave {len(missing)} of the {count} coordinates of the "
                f"target undetermined: no equation that is linear in the target contains "
                f"{', '.join(missing)}"
            )

    def _undetermined(self, links: Sequence[Link]) -> list[str]:
        systems = [link.equations for link in links]
        return undetermined(self.inverse, self.posture, [*systems, self.matches])


class _Combined:
    """An inverse whose glue is an invertible matrix."""

    def __init__(self, function: Function, inverse: Inverse, glue: Combination, where: str):
        self.function, self.inverse, self.glue, self.where = function, inverse, glue, where
        self.known: Mapping[Expr, Expr] = meanings(function, inverse, glue)

    def prove(self) -> None:
        for link in self.inverse.links:
            self._premises_hold(link)
            self._relations_hold(link)
        self._combines()
        self._is_invertible()
        self._composes_answers()

    def _premises_hold(self, link: Link) -> None:
        """Prove the premises of a lemma about names that earlier statements have made."""
        lemma = link.lemma
        if lemma is None:
            return
        for name, meaning in lemma.premises.items():
            stated = substitute(meaning, self.known)
            for missed in outcomes(self.known[name] - stated):
                fault = f"{name} does not stand for what the lemma {lemma.name!r} says"
                require(missed, (), f"{self.where}: {fault}")
        for sign in lemma.signs:
            if sign in self.known:
                for missed in self._in_all_branches(self.known[sign] ** 2 - 1):
                    fault = f"{sign}, a sign of the lemma {lemma.name!r}, is not 1 or -1"
                    require(missed, (), f"{self.where}: {fault}")

    def _relations_hold(self, link: Link) -> None:
        """Prove that coefficients of a lemma depend on each other as its relations say."""
        made = {s.symbol: s.value for s in self.function.body if isinstance(s, Let)}
        for relation in link.relations:
            place = f"{self.where}: {relation.meaning}, which {_title(link)} requires"
            if relation.root is None:
                raise ProofError(f"{place}, is not how it is defined")
            require_root(relation.root, relation.value, made, place)

    def _in_all_branches(self, expr: Expr) -> list[Expr]:
        signs = [s for s in self.function.signs if expr.has(s)]
        settings = (dict(zip(signs, v, strict=True)) for v in product(ONES, repeat=len(signs)))
        return [outcome for chosen in settings for outcome in outcomes(expr.xreplace(chosen))]

    def _combines(self) -> None:
        equations = [
            substitute(e, self.known) for link in self.inverse.links for e in link.equations
        ]
        graph = {joint: substitute(e, self.known) for joint, e in self.glue.joints.items()}
        system = sp.Matrix([substitute(e, graph) for e in self.inverse.equations])
        for difference in outcomes(
            sp.ImmutableMatrix(system - self.glue.matrix * sp.Matrix(equations))
        ):
            fault = "the lemmas' equations do not combine to the system"
            require(difference, (), f"{self.where}: {fault}")

    def _is_invertible(self) -> None:
        matrix = self.glue.matrix
        point = {
            s: sp.Rational(k, 7) for k, s in enumerate(sorted(matrix.free_symbols, key=str), 8)
        }
        what = "matrices that combine the equations of lemmas"
        certificates.point(matrix.tolist(), point, what)
        balls = Evaluator(list(point), list(matrix))(list(point.values()))
        fault = f"{self.where}: the matrix that combines the lemmas' equations"
        with ctx.workprec(300):
            ball = arb_mat(matrix.rows, matrix.cols, balls).det()
        if ball.contains(0):
            raise ProofError(f"{fault} is singular")
        home = dict.fromkeys(self.inverse.unknowns, sp.S.Zero)
        if not matrix.has(*home):
            return
        det = sp.expand(matrix.det())
        if det.has(*home) and not is_zero(det - det.xreplace(home)):
            raise ProofError(
                f"{fault} depends on what is solved for, and so does its determinant, {det}, which "
                f"may vanish"
            )

    def _composes_answers(self) -> None:
        """Prove that the function returns what the lemmas give, put into the joints."""
        lemmas = [link.lemma for link in self.inverse.links if link.lemma]
        solution = {u: generic(e) for lemma in lemmas for u, e in lemma.solution.items()}
        answers = [generic(e) for a in self.function.outputs for e in a.entries]
        for joint, answer in zip(self.inverse.unknowns, answers, strict=True):
            composed = substitute(self.glue.joints[joint], solution)
            if composed == answer:
                continue
            difference = composed - answer
            certificates.lack("answers composed of those of lemmas")
            if sp.expand(difference) != 0:
                raise ProofError(
                    f"{self.where}: {joint} is not what the lemmas give; the difference is "
                    f"{difference}"
                )


__all__ = ["prove_glue"]
