"""The joints that formulas of a paper give, as JavaScript, for comparison in the explorer.

A case is a claim that does not hold and gives joints: formulas for some of them, or all of them as
numbers.  The inputs of the formulas are taken from a correct posture, so that the results can be
compared with it at the same target.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.model.claims import FAULTS, Claim, Reading
from closedform.model.derivation import Derivation
from closedform.model.notation import SIGN, Relation
from closedform.proof.checks.solutions import Postures, Procedure, Solves
from closedform.proof.claims import ClaimResult, as_printed
from closedform.proof.prove import Proof

DIGITS = 17


@dataclass(frozen=True)
class Case:
    """A case that the explorer can show: a name, where it is explained, and the code."""

    label: str
    verdict: str
    erratum: str
    body: Sequence[str]
    at: Sequence[str] = ()
    """The correct joints, if the paper gives numbers for one target."""


def cases(derivation: Derivation, proof: Proof) -> list[Case]:
    """The claims of a derivation that give wrong joints, or lose some."""
    pairs = zip(derivation.claims, proof.claims, strict=True)
    return [case for claim, result in pairs for case in _cases(derivation, claim, result)]


def module(derivation: Derivation, found: Sequence[Case]) -> str:
    """The module that the explorer imports."""
    lines = [
        f"// Joints as {derivation.paper.title} gives them, each from the text of a claim.",
        "// postures(q, x, p): those that the formulas give where q is right for the target x.",
        "",
        "export const CASES = [",
    ]
    for case in found:
        fixed = f", at: [{', '.join(case.at)}]" if case.at else ""
        head = {"label": case.label, "verdict": case.verdict, "erratum": case.erratum}
        lines += [
            "    {",
            f"        ...{json.dumps(head, ensure_ascii=False)}{fixed},",
            "        postures(q, x, p) {",
            *(f"            {line}" for line in case.body),
            "        },",
            "    },",
        ]
    return "\n".join([*lines, "];", ""])


def _cases(derivation: Derivation, claim: Claim, result: ClaimResult) -> Iterator[Case]:
    readings: Sequence[Reading | None] = claim.readings or (None,)
    kinds = [r.kind for r in result.readings] or [result.kind]
    for reading, kind in zip(readings, kinds, strict=False):
        if kind not in FAULTS:
            continue
        check = claim.checked(claim.printed, reading, as_printed)
        if isinstance(check, Procedure | Solves) and check.postures is not None:
            body = _formulas(derivation, check.formulas, check.postures)
            if body:
                yield Case(claim.label, kind, claim.erratum, body)
                return
    numbers = _numbers(derivation, claim, claim.printed)
    right = _numbers(derivation, claim, claim.corrected)
    if result.kind in FAULTS and numbers and right:
        body = [f"return [[{', '.join(numbers)}]];"]
        yield Case(claim.label, result.kind, claim.erratum, body, right)


def _formulas(
    derivation: Derivation,
    formulas: Mapping[sp.Symbol, sp.Expr],
    postures: Postures,
) -> list[str]:
    """The lines that compute joints; nothing if the formulas give none, or need other names."""
    joints = {s: k for k, s in enumerate(derivation.actuated)}
    written: dict[sp.Symbol, sp.Symbol] = {
        s: sp.Symbol(f"q[{k}]", real=True) for s, k in joints.items()
    }
    for k, coordinate in enumerate(derivation.task):
        written.setdefault(sp.Symbol(coordinate, real=True), sp.Symbol(f"x[{k}]", real=True))
    for p in derivation.parameters:
        written[p.symbol] = sp.Symbol(f"p.{p.name}", real=True)
    lines: list[str] = []

    def name(symbol: sp.Symbol, value: sp.Expr) -> bool:
        if value.free_symbols - written.keys() - {SIGN}:
            return False
        local = sp.Symbol(f"v{len(lines)}", real=True)
        shown = value.xreplace(written | {SIGN: sp.Symbol("sign", real=True)})
        lines.append(f"const {local} = {sp.jscode(shown)};")
        written[symbol] = local
        return True

    inputs = {**postures.virtual, **postures.inputs}
    given = {s: e for s, e in inputs.items() if s not in formulas}
    if not (joints.keys() & formulas.keys() and all(name(s, e) for s, e in given.items())):
        return []
    before = len(lines)
    if not all(name(s, e) for s, e in formulas.items()):
        return []
    found = ", ".join(str(written[s]) if s in formulas else f"q[{k}]" for s, k in joints.items())
    signs = any(e.has(SIGN) for e in formulas.values())
    return [
        *lines[:before],
        f"return {'[1, -1]' if signs else '[1]'}.map((sign) => {{",
        *(f"    {line}" for line in lines[before:]),
        f"    return [{found}];",
        "});",
    ]


def _numbers(derivation: Derivation, claim: Claim, text: str) -> list[str]:
    """The joints that a text gives as numbers, if it gives all of them."""
    if not text or len(claim.readings) > 1:
        return []
    pieces = claim.pieces(text, claim.notation)
    relations = [r for p in pieces for r in (p if isinstance(p, tuple) else (p,))]
    two = [r for r in relations if isinstance(r, Relation) and len(r.sides) == 2]
    found = {r.left: r.right for r in two if isinstance(r.left, sp.Symbol)}
    values = [found.get(j) for j in derivation.actuated]
    if any(not isinstance(v, sp.Expr) or v.free_symbols for v in values):
        return []
    return [str(sp.N(v, DIGITS)) for v in values]
