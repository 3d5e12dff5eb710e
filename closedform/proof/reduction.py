"""Proof of an inverse whose system reduces to the equations of lemmas.

See :class:`closedform.model.derivation.Reduction`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import sympy as sp

from closedform.algebra import certificates
from closedform.algebra.normal_form import normal
from closedform.model.derivation import Derivation, Inverse, Reduction
from closedform.model.functions import Bound, Function, Let, Program, Vanishes, substitute
from closedform.proof.lemma import prove_lemma
from closedform.proof.require import ProofError, require


def prove_reduction(
    derivation: Derivation, function: Function, inverse: Inverse
) -> tuple[int, str, tuple[str, ...]]:
    """Prove that the lemmas are complete and that their equations are equivalent to the system.

    Returns the number of branches, the method in words and the names of the lemmas.
    """
    reduction = inverse.reduction
    assert reduction is not None
    where = f"{derivation.name}.{function.name}"
    known, equations, counts = _meanings(function, reduction), [], []
    for lemma in reduction.lemmas:
        counted = prove_lemma(lemma, Program(list(lemma.body)))
        counts.append((counted.certificate, lemma.excluded))
        for name, meaning in lemma.premises.items():
            stated = substitute(meaning, known)
            for missed in _cases(known[name] - stated):
                fault = f"{where}: {name} does not stand for what the lemma {lemma.name!r} says"
                require(missed, (), fault)
        equations += [substitute(e, known) for e in lemma.equations]
    graph = {joint: substitute(e, known) for joint, e in reduction.joints.items()}
    system = sp.Matrix([substitute(e, graph) for e in inverse.equations])
    combined = reduction.combination * sp.Matrix(equations)
    for difference in _cases(sp.ImmutableMatrix(system - combined)):
        require(difference, (), f"{where}: the lemmas' equations do not combine to the system")
    free = sorted(reduction.combination.free_symbols, key=str)
    point = {s: sp.Rational(k, 7) for k, s in enumerate(free, 8)}
    certificates.regular(
        reduction.combination.tolist(), point, "matrices that combine the equations of lemmas"
    )
    if not normal(reduction.combination.det()).is_nonzero:
        raise ProofError(f"{where}: the matrix that combines the lemmas' equations is singular")
    solution = {u: _generic(e) for lemma in reduction.lemmas for u, e in lemma.solution.items()}
    answers = [_generic(e) for a in function.outputs for e in a.entries]
    for joint, answer in zip(inverse.unknowns, answers, strict=True):
        difference = substitute(reduction.joints[joint], solution) - answer
        certificates.lack("answers composed of those of lemmas")
        if sp.expand(difference) != 0:
            raise ProofError(
                f"{where}: {joint} is not what the lemmas give; the difference is {difference}"
            )
    count = math.prod(lemma.branches for lemma in reduction.lemmas)
    branches = len(function.branches) if function.branches else 1
    if count != branches * reduction.solutions_per_branch:
        raise ProofError(f"{where}: the lemmas give {count} solutions, not {branches}")
    certificates.add_inverse(function.name, branches, counts, reduction.solutions_per_branch)
    names = tuple(dict.fromkeys(lemma.name for lemma in reduction.lemmas))
    method = "lemma by lemma" + (f"; {reduction.because}" if reduction.because else "")
    return branches, method, names


def _meanings(function: Function, reduction: Reduction) -> dict[sp.Basic, sp.Basic]:
    """The values of the names of a program in inputs, parameters and unknowns of the lemmas.

    Flags are false, as in every proof of the generic case.  Only the values that the equations of
    the lemmas depend on are written out, because those of other cases may be large.
    """
    known: dict[sp.Basic, sp.Basic] = {}
    inside: set[int] = set()
    roots: list[sp.Basic] = list(reduction.joints.values())
    for lemma in reduction.lemmas:
        known |= lemma.means
        inside |= {id(s) for s in lemma.body}
        roots += [*lemma.equations, *lemma.premises, *lemma.premises.values()]
    flags = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
    values = {
        s.symbol: substitute(s.value, flags)
        for s in function.body
        if isinstance(s, (Let, Bound)) and id(s) not in inside
    }
    needed = {s for e in roots for s in e.free_symbols}
    for symbol, value in reversed(values.items()):
        if symbol in needed:
            needed |= value.free_symbols - known.keys()
    known |= flags
    for symbol in [s for s in values if s in needed]:
        known[symbol] = substitute(values[symbol], known)
    return known


def _cases(expr: sp.Expr) -> Iterator[sp.Expr]:
    """The values of an expression for all outcomes of its choices between sides."""
    choices = [c for p in expr.atoms(sp.Piecewise) for _, c in p.args if c.is_Relational]
    if not choices:
        yield expr
        return
    for holds in (sp.true, sp.false):
        yield from _cases(expr.xreplace({choices[0]: holds}))


def _generic(expr: sp.Expr) -> sp.Expr:
    """The expression with the first case of choices between sides and the last of those by flag."""
    cases = {
        p: p.args[0 if p.args[0][1].is_Relational else -1][0] for p in expr.atoms(sp.Piecewise)
    }
    return _generic(expr.xreplace(cases)) if cases else expr
