"""How an inverse is told: each lemma with the equation that it solves, then the algorithm.

The derivation is read off the records of the inverse: the links of its chain, or the equations that
were solved, with their lemmas.  It says which part of the target an equation comes from, which
unknowns are left in it, what the lemma gives, and where the answer is not determined.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.formulas import PRINTED, formula
from closedform.emit.backends.latex.algorithm import Algorithm, whole
from closedform.emit.backends.latex.equations import canonical
from closedform.emit.backends.latex.formulas import FITS, measure
from closedform.emit.backends.latex.lemmas import label, titled
from closedform.emit.backends.latex.listing import lines_kept
from closedform.emit.backends.latex.names import MATRIX_ENTRY
from closedform.emit.backends.latex.prose import escape, loosen, mixed, upright
from closedform.emit.backends.latex.sheet import Sheet, blocks
from closedform.model.derivation import Solved
from closedform.model.functions import (
    Array,
    Bound,
    Function,
    Let,
    Vanishes,
    free_symbols,
    real,
    substitute,
)
from closedform.model.inverse import Combination, Degenerate, Inverse, Link, Rank
from closedform.model.lemma import Lemma
from closedform.proof.inverse import InverseResult

FEW = 4
"""More parts of the target than that are not listed."""
NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight")


@dataclass(frozen=True)
class Solving:
    """A lemma applied: its equations, its unknowns, and what it handed on."""

    lemma: Lemma
    equations: tuple[sp.Expr, ...]
    unknowns: tuple[sp.Symbol, ...]
    link: Link | None = None


def solvings(inverse: Inverse, solved: Sequence[Solved]) -> list[Solving]:
    """The lemmas of an inverse, in their order."""
    if isinstance(inverse.glue, Rank) or not solved:
        return [
            Solving(link.lemma, link.lemma.equations, tuple(link.lemma.solution), link)
            for link in inverse.links
            if link.lemma
        ]
    found = []
    for s in solved:
        others = {o.unknown for o in solved if o is not s}
        joints = [u for u in s.lemma.solution if u in inverse.unknowns and u not in others]
        unknowns = tuple(dict.fromkeys((s.unknown, *joints)))
        equations = s.lemma.equations if len(unknowns) > 1 else (s.equation,)
        found.append(Solving(s.lemma, equations, unknowns))
    return found


class Told:
    """The text of one function that has a status for each branch."""

    def __init__(self, page: Sheet, function: Function, algorithm: Algorithm, after: str):
        self.page, self.whole = page, function
        self.subject = algorithm.subject
        self.function, self.inverse = self.subject.function, self.subject.inverse
        self.solvings = solvings(self.inverse, self.subject.solved) if self.inverse else []
        self.algorithm, self.after = algorithm, after
        self.told: set[sp.Symbol] = set()
        """Names that a step has defined."""
        self.parameters = {p.symbol for p in page.derivation.parameters}

    def context(self) -> dict[str, Any]:
        page = self.page
        lines, cases = self.algorithm.lines(), self.algorithm.cases()
        inverse = self.inverse
        return {
            "given": self.given(),
            "after": self.after,
            "stages": [self.stage(k, s) for k, s in enumerate(self.solvings, 1)],
            "order": self.order(),
            "each": self.subject.each,
            "several": sum(len(s.unknowns) for s in self.solvings) > 1,
            "joints": blocks(self.joints()),
            "lines": lines,
            "lines_kept": lines_kept(lines),
            "cases": cases,
            "roundings": self.algorithm.roundings(),
            "branches": [
                (escape(label), ",\\ ".join(f"{page.math(s)} = {v:+d}" for s, v in signs.items()))
                for label, signs in self.whole.cases()
                if signs
            ],
            "continua": [self.continuum(inverse, c) for c in inverse.degenerate if c.free]
            if inverse
            else [],
        }

    # The derivation

    def given(self) -> str:
        page, joints = self.page, {s.name: s for s in self.page.derivation.actuated}
        texts = []
        for array in self.function.inputs:
            if array.shape == (4, 4):
                texts.append(
                    r"the pose $T = \begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}$ with the "
                    r"rotation $R = (R_{ij})$ and the position $p = (p_x, p_y, p_z)$"
                )
            elif array.shape == ():
                text = f"${page.math(array.entries[0])}$"
                if array.name in joints:
                    text = f"the value {text} of ${page.math(joints[array.name])}$"
                else:
                    text = f"the {escape(array.name.replace('_', ' '))} {text}"
                texts.append(text)
            else:
                texts += whole(page.assigned(array, {}))
        return ", and ".join(texts)

    def order(self) -> str:
        """The unknowns, in the order in which they are solved for."""
        groups = []
        for s in self.solvings:
            names = self.sought(s)
            groups.append(f"({', '.join(names)})" if len(names) > 1 else names[0])
        return ", then ".join(groups)

    def sought(self, solving: Solving) -> list[str]:
        """The unknowns of a step; the matrix, where they are its entries."""
        if solving.lemma.matrix:
            return [f"${solving.lemma.matrix}$"]
        return [f"${self.page.math(u)}$" for u in solving.unknowns]

    def joints(self) -> list[tuple[str, str]]:
        """The joints in the unknowns of the steps, where these are others."""
        glue = self.inverse.glue if self.inverse else None
        if not isinstance(glue, Combination):
            return []
        found = [(u, self.named(e)) for u, e in glue.joints.items()]
        return [r for u, e in found if u != e for r in self.page.equations(u, e)]

    def stage(self, number: int, solving: Solving) -> dict[str, Any]:
        """One lemma: from which equations, what it gives, where it degenerates."""
        page = self.page
        page.lines.clear()
        before = self.solvings[: number - 1]
        earlier = [s for s in before if s.lemma.name == solving.lemma.name]
        shown = self.system(solving)
        held = {s for e in shown for s in e.free_symbols}
        rows = [r for e in shown for r in self.equation(e, solving)]
        rows += self.definitions(held, solving)
        return {
            "number": number,
            "several": len(shown) > 1,
            "unknowns": enumeration(self.sought(solving)),
            "from": self.origin(shown, solving),
            "blocks": blocks(rows),
            "lemma": titled(solving.lemma.name),
            "label": label(solving.lemma.name),
            "matrix": self.matrix(shown),
            "statement": [] if earlier else statement(solving.lemma),
            **self.roles(solving),
            "count": self.count(solving),
            "vectors": mixed(solving.lemma.vectors),
            "solution": [] if solving.lemma.vectors else blocks(self.solution(solving)),
            "exists": self.exists(solving),
            "degenerate": self.degenerate(solving),
        }

    def system(self, solving: Solving) -> list[sp.Expr]:
        """The equations that determine the unknowns: of many, the shortest for each of them."""
        left, width = list(solving.equations), self.page.lines.width
        if len(left) <= 2:
            return left
        unknowns, known, chosen = list(solving.unknowns), set[sp.Symbol](), list[sp.Expr]()
        while unknowns:
            options = {
                u: [e for e in left if e.has(u) and not e.free_symbols & (set(unknowns) - {u})]
                for u in unknowns
            }
            unknown = next((u for u in unknowns if options[u]), None)
            if unknown is None:
                return chosen or left
            found = sorted(options[unknown], key=lambda e: (width(e), str(e)))[:2]
            chosen += found
            left = [e for e in left if e not in found]
            unknowns.remove(unknown)
            known.add(unknown)
        return chosen

    def equation(self, equation: sp.Expr, solving: Solving) -> list[tuple[str, str]]:
        """An equation with the unknowns on its left side."""
        terms = sp.Add.make_args(self.without_detours(self.named(equation)))
        held = set(solving.unknowns)
        unknown = [t for t in terms if t.free_symbols & held]
        rest = [-t for t in terms if not t.free_symbols & held]
        if unknown and all(t.as_coeff_Mul()[0].is_negative for t in unknown):
            unknown, rest = [-t for t in unknown], [-t for t in rest]
        left = self.page.lines.tidy(sp.Add(*unknown))
        text = self.page.math(left)
        if measure(text) > FITS * 0.6:
            return self.page.equations("0", self.named(equation))
        return self.page.equations(text, self.page.lines.tidy(sp.Add(*rest)))

    def without_detours(self, value: sp.Expr) -> sp.Expr:
        """The same without a name, such as that of a difference, where it is shorter."""
        for name in sorted(value.free_symbols & self.algorithm.values.keys(), key=str):
            other = value.xreplace({name: self.algorithm.value(name)})
            if self.page.lines.width(other) < self.page.lines.width(value):
                value = other
        return value

    def named(self, value: sp.Expr) -> sp.Expr:
        """An expression in the names that the algorithm prints."""
        return self.algorithm.full(value)

    def definitions(self, held: set[sp.Basic], solving: Solving) -> list[tuple[str, str]]:
        """What the names in an equation stand for, in what was solved before."""
        assert self.inverse
        shown = {s for v in held for s in self.named(v).free_symbols}
        defined = [
            s for s in self.algorithm.values if s in shown and s in self.inverse.rank.meaning
        ]
        meanings = [(s, self.inverse.rank.meaning[s]) for s in defined]
        rows = [
            row
            for s, meaning in meanings
            if not isinstance(meaning, sp.sin | sp.cos)
            for row in self.page.equations(s, self.page.lines.tidy(meaning))
        ]
        angles = sorted(self.inverse.rank.defined.keys() & set(solving.unknowns), key=str)
        return rows + [
            r for a in angles for r in self.page.equations(a, self.inverse.rank.defined[a])
        ]

    def matrix(self, equations: Sequence[sp.Expr]) -> str:
        """The matrix of the program whose entries the equations hold."""
        held = {str(s) for e in equations for s in e.free_symbols}
        found = sorted({m[1] + m[2] for n in held if (m := MATRIX_ENTRY.fullmatch(n))})
        return enumeration([f"${n[0]}^{{({n[1]})}}$" for n in found])

    def origin(self, equations: Sequence[sp.Expr], solving: Solving) -> str:
        """Which parts of the target the equations hold, and why they decouple."""
        assert self.inverse
        page = self.page
        explicit = [self.explicit(e) for e in equations]
        held = free_symbols(explicit)
        parts = [s for s in self.function.symbols if s in held]
        rank = self.inverse.rank
        solvable = {*self.inverse.unknowns, *rank.defined, *rank.lengths}
        solvable |= {u for s in self.solvings for u in s.unknowns}
        joints = [s for s in solvable if s in held and s not in solving.unknowns]
        later = self.found_later(joints, solving)
        joints = [s for s in joints if s not in later]
        order = [u for s in self.solvings for u in s.unknowns] + list(self.inverse.unknowns)
        before = [f"${page.math(j)}$" for j in sorted(joints, key=order.index)]
        where = self.parts(parts)
        several = len(equations) > 1
        source = f"From {where} of the forward map" if where else "From the forward map"
        if page.derivation.assembly_modes:
            source = "From the equations of the loop"
        verb = "follow equations" if several else "follows an equation"
        unknowns = enumeration(self.sought(solving) + [f"${page.math(u)}$" for u in later])
        found = [f"step {k} finds ${page.math(u)}$" for u, k in later.items()]
        told = f"{source} {verb} in {unknowns}"
        if later:
            told += f", of which {enumeration(found)}"
        if before:
            known = "is" if len(before) == 1 else "are"
            return f"{told}, where {enumeration(before)} {known} known:"
        return f"{told}:" if later else f"{told} alone:"

    def found_later(self, joints: Sequence[sp.Symbol], solving: Solving) -> dict[sp.Symbol, int]:
        """The joints that a later step finds, and its number: the lemma takes a sum with them."""
        after = [s is solving for s in self.solvings].index(True) + 1
        return {
            u: number
            for number, s in enumerate(self.solvings[after:], after + 1)
            for u in s.unknowns
            if u in joints
        }

    def explicit(self, value: sp.Expr) -> sp.Expr:
        """An expression in the target and the joints."""
        assert self.inverse
        meaning = self.inverse.rank.meaning
        for _ in range(len(self.algorithm.values) + 1):
            names = free_symbols([value]) & {*self.algorithm.values, *meaning}
            if not names:
                break
            value = substitute(
                value,
                {s: meaning[s] if s in meaning else self.algorithm.values[s] for s in names},
            )
        return value

    def parts(self, symbols: Sequence[sp.Symbol]) -> str:
        """The parts of the target, by name; a rotation as a whole."""
        rotation = [
            e for a in self.function.inputs if a.shape in ((3, 3), (4, 4)) for e in block(a)
        ]
        names = [f"${self.page.math(s)}$" for s in symbols if s not in rotation]
        turned = [s for s in symbols if s in rotation]
        if turned:
            names.append(
                "the rotation $R$"
                if len(turned) > FEW
                else enumeration([f"${self.page.math(s)}$" for s in turned])
            )
        return enumeration(names)

    def count(self, solving: Solving) -> str:
        """How many solutions there are, and the signs that tell them apart."""
        n, lemma = solving.lemma.branches, solving.lemma
        number = NUMBERS[n] if n < len(NUMBERS) else str(n)
        before = self.solvings[: self.solvings.index(solving)]
        used = {s for other in before for s in self.own_symbols(other)}
        own = (self.own_symbols(solving) | set(lemma.signs)) - used
        signs = [s for s in self.algorithm.signs if s in own]
        told = enumeration([rf"${self.page.math(s)} = \pm 1$" for s in signs])
        text = f"There {'are' if n != 1 else 'is'} {number} solution{'s' * (n != 1)}"
        if told and n > 1:
            text += f", for {told}"
        if lemma.excluded:
            text += " with the sign that is required"
        return text

    def own_symbols(self, solving: Solving) -> set[sp.Basic]:
        """The symbols of a solution and of the names that the lemma made for it."""
        made_by = solving.link.body if solving.link else solving.lemma.body
        body = {
            s.symbol: s.value for s in made_by or self.function.body if isinstance(s, Let | Bound)
        }
        used = {s for e in solving.lemma.solution.values() for s in e.free_symbols}
        used |= {s for e in solving.lemma.means for s in e.free_symbols}
        for symbol in reversed(list(body)):
            if symbol in used:
                used |= body[symbol].free_symbols
        return used

    def roles(self, solving: Solving) -> dict[str, Any]:
        """What the letters of the lemma stand for here; what is wide, on lines of its own."""
        page, inline, rows = self.page, list[str](), list[tuple[str, str]]()
        values: list[sp.Expr] = []
        for letter, value in solving.lemma.roles:
            if isinstance(value, str):
                text = value
            elif isinstance(value, sp.MatrixBase):
                entries = [self.named(e) for e in value]
                values += entries
                text = f"({', '.join(map(page.math, entries))})"
            else:
                values.append(self.named(sp.sympify(value, strict=True)))
                text = page.math(values[-1])
            if canonical(text) == canonical(letter):
                continue
            if measure(letter + text) <= FITS / 3 and r"\frac" not in text:
                inline.append(f"${letter} = {text}$")
            else:
                rows.append((letter, text))
        return {
            "roles": enumeration(inline) if inline else "",
            "role_blocks": blocks([*rows, *self.made_before(values)]),
        }

    def solution(self, solving: Solving) -> list[tuple[str, str]]:
        """What the lemma gives: angles, or their sines and cosines."""
        page, algorithm = self.page, self.algorithm
        rows: list[tuple[str, str]] = []
        values: list[sp.Expr] = []
        means = solving.link.means if solving.link else solving.lemma.means
        for unknown in solving.unknowns:
            pair = [s for s in means if isinstance(means[s], sp.sin | sp.cos)]
            pair = [s for s in pair if means[s].args[0] == unknown and s in algorithm.needed]
            if pair:
                self.told |= set(pair)
                found = [algorithm.value(s) for s in pair]
                values += found
                if angle := same_angle([means[s] for s in pair], found):
                    rows += page.equations(unknown, angle)
                    continue
                for s in pair:
                    rows += page.equations(means[s], algorithm.value(s))
                continue
            value = solving.lemma.solution.get(unknown)
            if value is None:
                continue
            rows += page.equations(unknown, self.named(value))
            values.append(self.named(value))
        return self.made_before(values) + rows

    def made_before(self, values: Sequence[sp.Expr]) -> list[tuple[str, str]]:
        """The quantities in values that no step has defined yet; entries of matrices are left."""
        algorithm = self.algorithm
        shown = {algorithm.known.get(s, s): s for s in algorithm.values if s in algorithm.needed}
        pending = [s for v in values for s in self.atoms(v) if s in shown]
        found: set[sp.Symbol] = set()
        while pending:
            symbol = shown[pending.pop()]
            if symbol not in found and symbol not in self.told:
                found.add(symbol)
                value = algorithm.value(symbol)
                pending += [s for s in self.atoms(value) if s in shown]
        self.told |= found
        return [
            row
            for s in algorithm.values
            if s in found and not MATRIX_ENTRY.fullmatch(str(s.name))
            if algorithm.known.get(s) != algorithm.value(s)
            for row in self.page.equations(algorithm.known.get(s, s), algorithm.value(s))
            if row[0] != row[1]
        ]

    def atoms(self, value: sp.Expr) -> list[sp.Expr]:
        """The symbols of an expression, and its sines and cosines of auxiliary angles."""
        return sorted(value.atoms(sp.Symbol, sp.sin, sp.cos), key=str)

    def exists(self, solving: Solving) -> str:
        """The conditions under which the lemma has solutions."""
        before = self.solvings[: self.solvings.index(solving)]
        own = self.own_symbols(solving) - {s for o in before for s in self.own_symbols(o)}
        bounds = [s for s in self.function.body if isinstance(s, Bound) and s.symbol in own]
        if solving.link:
            bounds += [s for s in solving.link.body if isinstance(s, Bound) and s not in bounds]
        return ", ".join(self.algorithm.conditions([b.symbol for b in bounds]))

    def degenerate(self, solving: Solving) -> str:
        """Where an unknown of the lemma is free."""
        flags = [
            s
            for s in (solving.link.body if solving.link else self.function.body)
            if isinstance(s, Vanishes) and (solving.link or set(s.free) & set(solving.unknowns))
        ]
        texts = []
        for flag in flags:
            if not flag.free:
                continue
            free = enumeration([f"${self.page.math(s)}$" for s in flag.free])
            value = self.named(flag.value)
            where = self.algorithm.vanishing(self.algorithm.quantities.get(value, value))
            texts.append(
                f"{self.page.prose(flag.meaning)} ({where}): "
                f"{free} {'are' if len(flag.free) > 1 else 'is'} free"
            )
        return "; ".join(texts)

    # What was proved

    def continuum(self, inverse: Inverse, case: Degenerate) -> dict[str, Any]:
        """The set on which a joint is free, the returned value, and what all solutions share."""
        page, function = self.page, self.function
        rows = [r for a in function.inputs for r in self.located(a, case.locus)]
        others = self.parameters & set(case.locus)
        rows += [r for s in sorted(others, key=str) for r in page.equations(s, case.locus[s])]
        _, signs = next(function.cases())
        values = function.at(signs, dict.fromkeys(case.flags, True), case.locus)
        convention = dict(zip(inverse.unknowns, values, strict=True))[case.free]
        narrow = all(measure(a + b) < FITS / 2 and r"\begin" not in b for a, b in rows)
        return {
            "free": page.math(case.free),
            "flag": page.prose(self.algorithm.flags[case.flags[0]].meaning),
            "locus": ", ".join(whole(rows)) if narrow else "",
            "blocks": [] if narrow else blocks(rows),
            "convention": f"{page.math(case.free)} = {page.math(convention)}",
            "relation": upright(case.relation),
        }

    def located(self, array: Array, locus: Mapping[sp.Symbol, Any]) -> list[tuple[str, str]]:
        """The part of an argument that the locus fixes; a rotation is a matrix."""
        page = self.page
        rotation = block(array) if array.shape in ((3, 3), (4, 4)) else []
        if rotation and all(e in locus for e in rotation):
            rows = page.equations("R", sp.Matrix(3, 3, [locus[e] for e in rotation]))
            rest = [e for e in array.entries if e in locus and e not in rotation]
            return rows + [r for e in rest for r in page.equations(e, locus[e])]
        if array.shape == (4, 4):
            return [r for e in array.entries if e in locus for r in page.equations(e, locus[e])]
        return page.assigned(array, locus)

    def proved(self, result: InverseResult) -> dict[str, Any]:
        page = self.page
        symbols = {s.name: s for f in page.derivation.functions for s in f.symbols}
        symbols |= {p.name: p.symbol for p in page.derivation.parameters}
        named = self.named_bounds(result.assumptions)
        assumed = self.algorithm.inequalities(
            [
                self.algorithm.bound(named[a]) if a in named else self.assumption(a, symbols)
                for a in result.assumptions
            ]
        )
        how = {
            "generic": "by a Groebner basis over the field of parameters and targets",
            "specialised": "by Groebner bases, with the same result at several rational points",
        }
        return {
            "where": f", where {', '.join(assumed)}" if assumed else "",
            "count": f"{result.solutions} solution{'s' * (result.solutions != 1)}",
            "how": how.get(result.method, escape(result.method)),
            "lemmas": result.lemmas,
            "continua": result.continua,
        }

    def assumption(self, text: str, symbols: Mapping[str, sp.Symbol]) -> sp.Expr:
        names = {str(s): s for s in self.algorithm.values}
        value: sp.Expr = formula(text, lambda n: symbols.get(n, names.get(n, real(n))), PRINTED)
        return self.named(value)

    def named_bounds(self, assumed: Sequence[str]) -> dict[str, sp.Symbol]:
        """The name of each bound by its explicit form, for all branches.

        Only bounds with the symbols of an assumption are included: the others cannot be an
        assumption, and may be very long.
        """
        function = self.function
        held = [set(re.findall(r"\w+", text)) for text in assumed]
        rests: dict[sp.Basic, set[str]] = {}
        names = []
        for statement in function.body:
            if isinstance(statement, Let | Bound):
                free = statement.value.free_symbols
                rests[statement.symbol] = {n for s in free for n in rests.get(s, {str(s)})}
                if isinstance(statement, Bound):
                    names.append(statement.symbol)
        signs = {str(s) for _, chosen in function.cases() for s in chosen}
        flags = {str(s.symbol) for s in function.body if isinstance(s, Vanishes)}
        names = [n for n in names if any(rests[n] - signs - flags <= h for h in held)]
        return {
            str(function.explicit([name], chosen)[1][-1]): name
            for _, chosen in function.cases()
            for name in names
        }


def same_angle(pair: Sequence[sp.Expr], values: Sequence[sp.Expr]) -> sp.Expr | None:
    """The angle whose sine and cosine are the values, if a whole pair is that of another angle."""
    angles = {v.args[0] for v in values if isinstance(v, sp.sin | sp.cos)}
    alike = all(a.func == b.func for a, b in zip(pair, values, strict=True))
    return angles.pop() if len(pair) == 2 and alike and len(angles) == 1 else None


def statement(lemma: Lemma) -> list[str]:
    """The statement of a lemma: what it solves, and the solution on a line of its own."""
    problem, arrow, solution = loosen(lemma.statement).partition(r"\;\Rightarrow\;")
    if not arrow:
        return packed("", clauses(problem))
    return [problem.strip(), *packed(r"\Rightarrow\quad ", clauses(solution))]


def clauses(text: str) -> list[str]:
    """The formulas of a list, each with the sign behind it; a space in TeX separates them."""
    parts, depth, start = list[str](), 0, 0
    for found in re.finditer(r"[({[]|[])}]|([,;:]?)\\(?:quad|(?<=,\\) )", text):
        if found[0] in "({[":
            depth += 1
        elif found[0] in "])}":
            depth -= 1
        elif depth == 0:
            parts.append(text[start : found.start()].strip() + found[1])
            start = found.end()
    return [*parts, text[start:].strip()]


def packed(lead: str, texts: Sequence[str]) -> list[str]:
    """Formulas beside each other as far as they fit; later lines start below the first formula."""
    rows = [lead]
    for text in texts:
        if rows[-1] not in (lead, "") and measure(rf"{rows[-1]} {text}") > FITS:
            rows.append(rf"\phantom{{{lead.strip()}}}" if lead else "")
        rows[-1] += text if rows[-1] in (lead, "") else rf"\quad {text}"
    return rows


def block(array: Array) -> list[sp.Expr]:
    """The entries of the rotation in a matrix or a pose."""
    columns = array.shape[1]
    return [array.entries[columns * i + j] for i in range(3) for j in range(3)]


def enumeration(texts: Sequence[str]) -> str:
    """``a, b and c``."""
    *first, last = texts or [""]
    return f"{', '.join(first)} and {last}" if first else last


__all__ = ["Told", "enumeration"]
