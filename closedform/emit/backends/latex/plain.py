"""A function as a reader computes it: the same results, without what serves their rounding.

A program carries sines and cosines from lemma to lemma, and takes a difference of nearly equal
numbers from another one that is known better.  A reader has the angle, and the difference.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, fields, replace
from itertools import combinations
from types import MappingProxyType
from typing import Any

import sympy as sp

from closedform.model.constant import Constant
from closedform.model.expressions import substitute
from closedform.model.functions import Array, Bound, Function, Let, Statement, Vanishes, real
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Plain:
    """A function, and what stands in it for names of the program that it does not have."""

    function: Function
    names: Mapping[sp.Basic, sp.Basic]


def plain(
    function: Function,
    lemmas: Sequence[Lemma],
    letters: Sequence[str] = (),
    *,
    known: Set[sp.Expr] = frozenset(),
    results: Sequence[sp.Symbol] = (),
    joints: Mapping[sp.Symbol, sp.Expr] = MappingProxyType({}),
) -> Plain:
    """The function in the angles that its lemmas give, without what differs within rounding.

    Parameters
    ----------
    function
        as its program computes it
    lemmas
        those of its inverse
    letters
        names for parts of sums of angles
    known
        the parts that have a name already
    results
        the symbols of the outputs
    joints
        some of the outputs, in the angles
    """
    body, same, numbers = _exact(function.body)
    body = _known_directly(body, lemmas)
    angles = _angles(body, lemmas)
    pairs = _pairs(body, lemmas, angles)
    names: dict[sp.Basic, sp.Basic] = {**same, **pairs}
    places = {s.symbol: k for k, s in enumerate(body) if isinstance(s, Let | Bound)}
    found = {
        max(places[n] for n, e in pairs.items() if e in (sp.sin(angle), sp.cos(angle))): [
            *(Let(part, e) for part, e in _angles_before(angle, lemmas).items()),
            Let(angle, value),
        ]
        for angle, value in angles.items()
    }
    usual = _usual(body)
    done: list[Statement] = []
    for place, statement in enumerate(body):
        if place in found:
            done += [_with_names(angle, names) for angle in found[place]]
        if isinstance(statement, Let | Bound) and statement.symbol in pairs:
            continue
        statement = _with_names(statement, names)
        if isinstance(statement, Let) and (ratio := _tangent(substitute(statement.value, usual))):
            names[statement.symbol] = ratio
            continue
        done.append(statement)
    solved = {function_value: angle for angle, function_value in _solutions(lemmas, angles).items()}
    for lemma in lemmas:
        alone = lemma.plainly.keys() & lemma.solution.keys() - angles.keys()
        solved |= {lemma.solution[a]: lemma.plainly[a] for a in alone}
        parts = angles_of_readers(lemma) if alone else []
        done += [_with_names(Let(part, lemma.plainly[part]), names) for part in parts]
    outputs = tuple(
        replace(a, entries=tuple(substitute(e.xreplace(solved), names) for e in a.entries))
        for a in function.outputs
    )
    exact = {j: substitute(substitute(e, numbers), usual) for j, e in joints.items()}
    outputs = _by_angles(outputs, results, exact, angles)
    told = replace(function, body=tuple(done), outputs=outputs)
    told, turned = _with_angles_of_results(told, results)
    names = {n: substitute(e, turned) for n, e in names.items()} | turned
    own = _own_names(told, results)
    told = _renamed(_with_half_sums(_without_pairs(told), letters, known), own)
    return Plain(told, {**{n: substitute(e, own) for n, e in names.items()}, **own})


def _by_angles(
    outputs: tuple[Array, ...],
    results: Sequence[sp.Symbol],
    joints: Mapping[sp.Symbol, sp.Expr],
    angles: Mapping[sp.Symbol, sp.Expr],
) -> tuple[Array, ...]:
    """The outputs, with the joints in the angles wherever these are known."""
    if sum(len(a.entries) for a in outputs) != len(results):
        return outputs
    known = {j: e for j, e in joints.items() if e != j and e.free_symbols <= angles.keys()}
    symbols = iter(results)
    return tuple(
        replace(a, entries=tuple(known.get(next(symbols), e) for e in a.entries)) for a in outputs
    )


def _with_angles_of_results(
    function: Function, results: Sequence[sp.Symbol]
) -> tuple[Function, dict[sp.Basic, sp.Basic]]:
    """The function with an angle that it returns in place of its sine and cosine."""
    usual = _usual(function.body)
    values = {s.symbol: substitute(s.value, usual) for s in function.body if isinstance(s, Let)}
    outputs = [e for a in function.outputs for e in a.entries]
    taken = {*values, *function.symbols}
    found: dict[sp.Basic, tuple[sp.Symbol, sp.Expr]] = {}
    names: dict[sp.Basic, sp.Basic] = {}
    for result, value in zip(results, outputs, strict=True) if len(results) == len(outputs) else ():
        if not isinstance(value, sp.atan2) or not {*value.args} <= values.keys():
            continue
        sides = [values[n] for n in value.args]
        common = _positive_factors(sides[0]) & _positive_factors(sides[1])
        if common and result not in taken:
            sides = [e / sp.Mul(*common) for e in sides]
            last = max(value.args, key=list(values).index)
            found[last] = result, sp.atan2(*sides, evaluate=False)
            names |= {value: result}
            names |= dict(zip(value.args, (sp.sin(result), sp.cos(result)), strict=True))
    body: list[Statement] = []
    for statement in function.body:
        symbol = getattr(statement, "symbol", None)
        if symbol in found:
            body.append(_with_names(Let(*found[symbol]), names))
        if symbol not in names:
            body.append(_with_names(statement, names))
    arrays = tuple(
        replace(a, entries=tuple(names.get(e, substitute(e, names)) for e in a.entries))
        for a in function.outputs
    )
    return replace(function, body=tuple(body), outputs=arrays), names


def _own_names(function: Function, results: Sequence[sp.Symbol]) -> dict[sp.Basic, sp.Symbol]:
    """The symbols of outputs that have another name in the program."""
    outputs = [e for a in function.outputs for e in a.entries]
    made = _made(function.body)
    if len(outputs) != len(results):
        return {}
    own = {e: r for e, r in zip(outputs, results, strict=True) if e in made and r not in made}
    return {e: r for e, r in own.items() if outputs.count(e) == 1}


def _renamed(function: Function, names: Mapping[sp.Basic, sp.Symbol]) -> Function:
    """The function with other names of its program."""
    body = [
        replace(s, symbol=names.get(s.symbol, s.symbol))
        if isinstance(s, Let | Bound | Vanishes)
        else s
        for s in function.body
    ]
    outputs = tuple(
        replace(a, entries=tuple(substitute(e, names) for e in a.entries)) for a in function.outputs
    )
    return replace(function, body=tuple(_with_names(s, names) for s in body), outputs=outputs)


def _tangent(value: sp.Expr) -> sp.Expr | None:
    """The tangent that a sine over a cosine is."""
    angles = {f.args[0] for f in value.atoms(sp.sin)}
    return next((sp.tan(a) for a in angles if value == sp.sin(a) / sp.cos(a)), None)


def _with_half_sums(function: Function, letters: Sequence[str], known: Set[sp.Expr]) -> Function:
    """The function with letters for halves of sums of angles that occur more than once."""
    usual, inputs = _usual(function.body), set(function.symbols)
    held = [substitute(s.value, usual) for s in function.body if isinstance(s, Let | Bound)]
    held += [substitute(e, usual) for a in function.outputs for e in a.entries]
    found = Counter(
        f.args[0]
        for e in held
        for f in sp.preorder_traversal(e)
        if isinstance(f, sp.sin | sp.cos) and f.args[0].is_Add
    )
    halves = [
        a
        for a, n in found.items()
        if n > 1 and not {a, -a} & known and a.free_symbols <= inputs and _has_part(a)
    ]
    if len(halves) > len(letters):
        return function
    names = {a: real(letter) for a, letter in zip(halves, letters, strict=False)}
    named = [Let(name, angle) for angle, name in names.items()]
    return _replaced(replace(function, body=(*named, *function.body)), names, skipped=len(named))


def _has_part(angle: sp.Expr) -> bool:
    """Whether a sum contains a half of an angle, or another part."""
    return any(t.as_coeff_Mul()[0].q != 1 for t in angle.args)


def _replaced(function: Function, parts: Mapping[Any, Any], skipped: int = 0) -> Function:
    """The function with other parts of its expressions; the first statements are left."""
    body = [
        replace(s, value=s.value.xreplace(parts))
        if isinstance(s, Let | Bound) and k >= skipped
        else s
        for k, s in enumerate(function.body)
    ]
    outputs = tuple(
        replace(a, entries=tuple(e.xreplace(parts) for e in a.entries)) for a in function.outputs
    )
    return replace(function, body=tuple(body), outputs=outputs)


def _without_pairs(function: Function) -> Function:
    """The function without names that serve as the arguments of an arctangent alone.

    What both have as a positive factor is left out.
    """
    usual = _usual(function.body)
    values = {
        s.symbol: substitute(s.value, usual) for s in function.body if isinstance(s, Let | Bound)
    }
    outputs = [substitute(e, usual) for a in function.outputs for e in a.entries]
    held = [*values.values(), *outputs]
    uses = Counter(s for e in held for s in sp.preorder_traversal(e) if s.is_Symbol)
    arguments = {f.args for e in held for f in e.atoms(sp.atan2)}
    inside = Counter(
        s for e in held for f in sp.preorder_traversal(e) if isinstance(f, sp.atan2) for s in f.args
    )
    short: dict[sp.Expr, sp.Expr] = {}
    for y, x in arguments:
        if isinstance(y, sp.sin) and isinstance(x, sp.cos) and y.args == x.args:
            short[sp.atan2(y, x)] = y.args[0]
            continue
        if common := _positive_factors(y) & _positive_factors(x):
            sides = [e / sp.Mul(*common) for e in (y, x)]
            short[sp.atan2(y, x)] = sp.atan2(*sides, evaluate=False)
            continue
        if not {y, x} <= values.keys() or any(uses[s] != inside[s] for s in (y, x)):
            continue
        if common := _positive_factors(values[y]) & _positive_factors(values[x]):
            sides = [values[s] / sp.Mul(*common) for s in (y, x)]
            short[sp.atan2(y, x)] = sp.atan2(*sides, evaluate=False)
    return _replaced(function, short) if short else function


def without_common_factors(value: sp.Expr) -> sp.Expr:
    """The same without a positive factor of both arguments of an arctangent."""
    found = {}
    for angle in value.atoms(sp.atan2):
        if common := _positive_factors(angle.args[0]) & _positive_factors(angle.args[1]):
            sides = [e / sp.Mul(*common) for e in angle.args]
            found[angle] = sp.atan2(*sides, evaluate=False)
    return value.xreplace(found)


def _positive_factors(value: sp.Expr) -> set[sp.Expr]:
    return {f for f in sp.Mul.make_args(value) if f.as_base_exp()[0].is_nonnegative}


def _absolute(value: sp.Expr) -> Any:
    """The same with absolute values where they are taken by cases."""

    def is_absolute(e: sp.Expr) -> bool:
        if not isinstance(e, sp.Piecewise) or len(e.args) != 2:
            return False
        (first, condition), (second, _) = e.args
        return bool(condition == (first >= 0) and second == -first)

    if not value.has(sp.Piecewise):
        return value
    value = value.replace(is_absolute, lambda e: sp.Abs(e.args[0][0], evaluate=False))
    return value.replace(sp.Mul, _times_its_sign)


def _times_its_sign(*factors: sp.Expr) -> sp.Expr:
    """A product, which is an absolute value if it is that of a number and its sign."""
    for factor in factors:
        if isinstance(factor, sp.Piecewise) and [e for e, _ in factor.args] == [1, -1]:
            rest, condition = sp.Mul(*(f for f in factors if f is not factor)), factor.args[0][1]
            for sign in (1, -1):
                if condition == (sign * rest >= 0):
                    return sign * sp.Abs(rest, evaluate=False)
    return sp.Mul(*factors)


def _with_names(statement: Any, names: Mapping[sp.Basic, sp.Basic]) -> Any:
    changed = {
        f.name: _absolute(substitute(value, names))
        for f in fields(statement)
        if f.name != "symbol" and isinstance(value := getattr(statement, f.name), sp.Basic)
    }
    return replace(statement, **changed)


def _usual(body: Sequence[Statement]) -> dict[sp.Basic, Any]:
    """The flags of special cases, which do not hold in a usual posture."""
    return {s.symbol: sp.false for s in body if isinstance(s, Vanishes)}


def _made(body: Sequence[Statement]) -> set[sp.Symbol]:
    """The names of values."""
    return {s.symbol for s in body if isinstance(s, Let | Bound)}


def followed(value: sp.Expr, names: Mapping[sp.Basic, sp.Basic]) -> sp.Expr:
    """A value without names that stand for others, however many of them follow one another."""
    while (other := substitute(value, names)) != value:
        value = other
    return value


def is_rounding(flag: Vanishes) -> bool:
    """Whether the flag compares with a tolerance or a tiny multiple, as no exact quantity does."""
    tiny = any(q.q >= 2**8 for q in flag.value.atoms(sp.Rational))
    return (tiny or flag.value.has(Constant)) and not flag.free


def _exact(
    body: Sequence[Statement],
) -> tuple[list[Statement], dict[sp.Basic, sp.Basic], dict[sp.Basic, Any]]:
    """The statements without names that differ from others within rounding, and those others.

    The later name is kept: lemmas speak of it.  The last are the names that are numbers, and the
    flags that only serve the rounding.
    """
    usual: dict[sp.Basic, Any] = {
        s.symbol: sp.false for s in body if isinstance(s, Vanishes) and is_rounding(s)
    }
    first: dict[sp.Basic, sp.Basic] = {}
    made: dict[sp.Basic, Let | Bound] = {}
    for s in body:
        if not isinstance(s, Let | Bound):
            continue
        value = substitute(s.value, usual)
        if value.is_number and value != s.value:
            usual[s.symbol] = value
        if value != s.value and value in first:
            first[s.symbol] = first[value]
            before = made[first[value]]
            made[first[value]] = (
                replace(before, symbol=s.symbol)
                if isinstance(before, Bound)
                else replace(s, value=before.value)
            )
        else:
            first[s.symbol] = s.symbol
            made[s.symbol] = s
    names: dict[sp.Basic, sp.Basic] = {
        n: made[start].symbol for n, start in first.items() if n != made[start].symbol
    }
    kept = [
        made[s.symbol] if isinstance(s, Let | Bound) else s
        for s in body
        if not isinstance(s, Let | Bound) or s.symbol in made
    ]
    return [_with_names(s, names) for s in kept], names, usual


def _known_directly(body: Sequence[Statement], lemmas: Sequence[Lemma]) -> list[Statement]:
    """The statements with the values that lemmas prove of their names."""
    known = {n: e for lemma in lemmas for n, e in {**lemma.premises, **lemma.plainly}.items()}
    names = _made(body)
    before: set[sp.Basic] = set()
    done: list[Statement] = []
    for s in body:
        if isinstance(s, Let | Bound):
            value = known.get(s.symbol, s.value)
            if value.free_symbols & names <= before:
                s = replace(s, value=value)
            before.add(s.symbol)
        done.append(s)
    return done


def _solutions(
    lemmas: Sequence[Lemma], angles: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    return {a: e for lemma in lemmas for a, e in lemma.solution.items() if a in angles}


def _angles(body: Sequence[Statement], lemmas: Sequence[Lemma]) -> dict[sp.Symbol, sp.Expr]:
    """The angles that lemmas give otherwise than by names for their sine and cosine."""
    made = _made(body)
    found: dict[sp.Symbol, sp.Expr] = {}
    for lemma in lemmas:
        for angle, value in lemma.solution.items():
            names = [n for n, e in lemma.means.items() if e in (sp.sin(angle), sp.cos(angle))]
            if len(names) == 2 and angle in lemma.plainly:
                found[angle] = lemma.plainly[angle]
                continue
            if len(names) == 2 and {*names} <= made and not value.free_symbols & {*names}:
                solved = {e: a for a, e in _solutions([lemma], found).items()}
                found[angle] = value.xreplace(solved)
    return found


def angles_of_readers(lemma: Lemma) -> list[sp.Symbol]:
    """The angles that no program has."""
    made = _made(lemma.body) | lemma.solution.keys() | lemma.letters.keys()
    return [n for n, e in lemma.plainly.items() if n not in made and e != 1]


def angle_of(
    name: sp.Symbol, names: Mapping[sp.Basic, sp.Basic]
) -> tuple[sp.Symbol | None, list[sp.Basic]]:
    """The angle whose sine or cosine a name stands for, and all names of both; or None."""
    meaning = names.get(name)
    angle = meaning.args[0] if isinstance(meaning, sp.sin | sp.cos) else None
    if not isinstance(angle, sp.Symbol):
        return None, []
    return angle, [n for n, e in names.items() if e in (sp.sin(angle), sp.cos(angle))]


def _angles_before(angle: sp.Symbol, lemmas: Sequence[Lemma]) -> dict[sp.Symbol, sp.Expr]:
    """The angles that no program has and that this angle is the first to need."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for lemma in lemmas:
        if angle in lemma.plainly:
            order = list(lemma.plainly)
            before = [lemma.plainly[n] for n in order[: order.index(angle)] if n in lemma.solution]
            for part in angles_of_readers(lemma):
                if lemma.plainly[angle].has(part) and not any(e.has(part) for e in before):
                    found[part] = lemma.plainly[part]
    return found


def _pairs(
    body: Sequence[Statement], lemmas: Sequence[Lemma], angles: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """The names of the sines and cosines of these angles, and of sums of them."""
    made = _made(body)
    return {
        name: meaning
        for lemma in lemmas
        for name, meaning in lemma.means.items()
        if name in made and isinstance(meaning.as_coeff_Mul()[1], sp.sin | sp.cos)
        if meaning.free_symbols <= angles.keys()
    }


def divides_by_root(factor: sp.Expr, roots: Mapping[sp.Symbol, sp.Expr]) -> bool:
    """Whether a factor divides by a root, or by the name of one."""
    base, power = factor.as_base_exp()
    return (power == -1 and base in roots) or (power == -sp.S.Half and base.is_Add)


def sums_of_angles(value: sp.Expr) -> dict[sp.Basic, sp.Expr]:
    """Sums that are the sine or the cosine of a sum of two angles."""
    angles = sorted({f.args[0] for f in value.atoms(sp.sin)}, key=str)
    found: dict[sp.Basic, sp.Expr] = {}
    for a, b in combinations(angles, 2):
        for sign in (1, -1):
            sine = sp.sin(a) * sp.cos(b) + sign * sp.cos(a) * sp.sin(b)
            cosine = sp.cos(a) * sp.cos(b) - sign * sp.sin(a) * sp.sin(b)
            total = a + sign * b
            found |= {sine: sp.sin(total), -sine: -sp.sin(total)}
            found |= {cosine: sp.cos(total), -cosine: -sp.cos(total)}
    return found


__all__ = [
    "Plain",
    "angle_of",
    "angles_of_readers",
    "divides_by_root",
    "is_rounding",
    "plain",
    "sums_of_angles",
    "without_common_factors",
]
