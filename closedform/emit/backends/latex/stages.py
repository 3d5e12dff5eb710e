"""How an inverse is derived, lemma by lemma.

Each stage says which part of the target its equations come from, which unknowns are left in them,
what the lemma gives, and where the answer is not determined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.angles import same_angle
from closedform.emit.backends.latex.cases import Cases, are_free, is_never
from closedform.emit.backends.latex.equations import (
    Numbered,
    defined_in,
    reference,
    runs,
)
from closedform.emit.backends.latex.formulas import FITS, flat, measure
from closedform.emit.backends.latex.lemmas import label, statement, titled
from closedform.emit.backends.latex.names import MATRIX_ENTRY
from closedform.emit.backends.latex.pairs import scaled
from closedform.emit.backends.latex.prose import mixed
from closedform.emit.backends.latex.roles import primed, roles
from closedform.emit.backends.latex.rotations import is_turned
from closedform.emit.backends.latex.sheet import Sheet, block, blocks
from closedform.emit.backends.latex.solving import Solving, solvings
from closedform.emit.backends.latex.sources import (
    Stated,
    explained,
    of_the_loop,
    of_the_target,
)
from closedform.emit.backends.latex.wide import Equation
from closedform.model.expressions import free_symbols, substitute
from closedform.model.functions import Bound, Let, Vanishes
from closedform.model.names import listed

FEW = 4
"""More parts of the target than that are not listed."""
WIDE = 0.8
"""The part of a line that the left side of an equation may take."""
NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight")


class Stages:
    """The lemmas of a function that has a status for each branch, in their order."""

    def __init__(self, page: Sheet, algorithm: Algorithm):
        self.page, self.algorithm = page, algorithm
        subject = algorithm.subject
        self.function, self.inverse = subject.function, subject.inverse
        self.solvings = solvings(self.inverse, subject.solved) if self.inverse else []
        self.steps = list[list[Solving]]()
        self.solvings = [self.explained(s) for s in self.solvings]
        for solving in self.solvings:
            if all(self.named(e) == 0 for e in solving.equations):
                continue  # a joint that is given
            twins = algorithm.twins
            is_second = twins is not None and solving.lemma is twins.lemmas[1]
            if self.steps and (is_second or self.is_like(solving, self.steps[-1])):
                self.steps[-1].append(solving)
            else:
                self.steps.append([solving])
        self.told: set[sp.Symbol] = set()
        """Names that a step has defined."""
        self.stated = Stated(page)
        self.seen = dict[str, str]()
        """The names in a step that the derivation defines, and the numbers of their equations."""

    def context(self) -> list[dict[str, Any]]:
        return [self.told_stage(k, step) for k, step in enumerate(self.steps, 1)]

    def explained(self, solving: Solving) -> Solving:
        """The same, where an equation gives an unknown at once, with what the unknown is equal to.

        The algorithm calls its value by the name of the unknown, so that the equation is empty.
        """
        equations = list(solving.equations)
        for i, e in enumerate(equations):
            found = [u for u in solving.unknowns if u in self.algorithm.values and e.has(u)]
            if len(found) == 1 and self.named(e) == 0:
                equations[i] = found[0] - self.algorithm.value(found[0])
        return replace(solving, equations=tuple(equations))

    def are_twins(self, step: Sequence[Solving]) -> bool:
        """Whether a step is told once of two parts that differ in names alone."""
        twins = self.algorithm.twins
        return twins is not None and [s.lemma for s in step] == [*twins.lemmas]

    def told_stage(self, number: int, step: Sequence[Solving]) -> dict[str, Any]:
        if not self.are_twins(step) or not (twins := self.algorithm.twins):
            return self.stage(number, step)
        with self.algorithm.as_one():
            told = self.stage(number, step[:1])
        told["unknowns"] += f" for {twins.each}"
        self.told |= twins.second
        return told

    def is_like(self, solving: Solving, step: Sequence[Solving]) -> bool:
        """Whether the lemma of a step solves another equation too, which needs none of its joints.

        Such as the equations of the legs of a platform.
        """
        first = step[0]
        found = {u for s in step for u in s.unknowns}
        alike = solving.lemma.name == first.lemma.name and not solving.lemma.vectors
        if not alike or len(solving.unknowns) > 1 or len(found) > len(step):
            return False
        needed = self.joints_in(self.all_of(solving), solving)
        return needed == self.joints_in(self.all_of(first), first) and not needed & found

    def sought(self, solving: Solving) -> list[str]:
        """The unknowns of a lemma; the matrix, where they are its entries."""
        if solving.lemma.matrix:
            return [f"${solving.lemma.matrix}$"]
        return [f"${self.page.math(u)}$" for u in solving.unknowns]

    def stage(self, number: int, step: Sequence[Solving]) -> dict[str, Any]:
        """One step: from which equations, what the lemma gives, where it degenerates."""
        page, lemma = self.page, step[0].lemma
        page.lines.clear(spend=True)
        self.seen.clear()
        earlier = [s for s in self.steps[: number - 1] if s[0].lemma.name == lemma.name]
        solved, shown = list[list[Equation]](), list[sp.Expr]()
        definitions = list[Equation]()
        for solving in step:
            system = self.system(solving)
            shown += system
            held = {s for e in system for s in e.free_symbols}
            solved += [self.equation(e, solving) for e in system]
            definitions += self.definitions(held, solving)
        origin = self.origin(shown, step)
        if self.algorithm.vectors or lemma.vectors:  # the lemma has the equations, in vectors
            solved, definitions = [], []
        else:
            definitions += self.made_before([e for s in step for e in self.given_in(s)])
        letters = roles([s.lemma for s in step], page, self.named)
        role_rows = [*letters.rows, *self.made_before(letters.values)]
        rows, labels = self.numbered(solved)
        end = ":" if rows or definitions else "."
        found = [u for s in step for u in s.unknowns]
        origin = f"{origin.removesuffix(':')}{explained(page, self.function, found)}{end}"
        if lemma.matrix:
            solution = self.matrix_of(step[0])
        else:
            solution = [] if lemma.vectors else [r for s in step for r in self.solution(s)]
        return {
            "number": number,
            "solves": "each of " * (len(step) > 1) + (reference(labels) or "them"),
            "unknowns": listed([u for s in step for u in self.sought(s)]),
            "from": origin,
            "blocks": blocks(rows),
            "definitions": blocks(definitions),
            "lemma": titled(lemma.name),
            "label": label(lemma.name),
            "matrix": self.matrix(shown, step),
            "statement": [] if earlier else [primed(t, letters.apart) for t in statement(lemma)],
            "roles": letters.sentence,
            "role_blocks": blocks(role_rows),
            "count": self.count(step),
            "vectors": mixed(lemma.vectors),
            "solution": blocks(solution),
            "seen": self.where_defined(bool(role_rows or solution)),
            "exists": ", ".join(dict.fromkeys(e for s in step if (e := self.exists(s)))),
            "degenerate": self.degenerate(step),
        }

    def where_defined(self, some_here: bool) -> str:
        """Where the symbols of a step are defined that it takes from the derivation."""
        if not self.seen:
            return ""
        if len(self.seen) <= FEW:
            return f"Here {defined_in([*self.seen], self.seen.values())}."
        which = "other symbols" if some_here else "symbols"
        return f"The {which} are those of {reference(self.seen.values())}."

    def numbered(self, solved: Sequence[list[Equation]]) -> tuple[list[Numbered], list[str]]:
        """The equations that a lemma solves, with numbers, and the numbers; names for parts follow.

        Of an equation that was displayed before, only the number is given.
        """
        rows, labels = list[Numbered](), list[str]()
        for equation in solved:
            main, *parts = runs(equation)
            label = self.page.numbers.is_shown(main)
            if not label:
                rows += self.page.numbers.number([main], defining=False)
                label = rows[-1].label
                rows += [Numbered(*line) for part in parts for line in part]
            labels.append(label)
        return rows, labels

    def system(self, solving: Solving) -> list[sp.Expr]:
        """The equations that determine the unknowns: of many, the shortest for each of them."""
        if solving.lemma.scaled:
            return scaled(solving.lemma, solving.equations, self.algorithm)
        left, width = list(solving.equations), self.page.lines.width
        if solving.lemma.matrix:  # that it is a rotation is said in words
            left = [e for e in left if self.named(e).free_symbols - {*solving.unknowns}]
        if len(left) <= 2:
            return left
        unknowns, known, chosen = list(solving.unknowns), set[sp.Symbol](), list[sp.Expr]()
        while unknowns:
            options = {
                u: [e for e in left if e.has(u) and not e.free_symbols & (set(unknowns) - {u})]
                for u in unknowns
            }
            unknown = next((u for u in unknowns if options[u]), None)
            if unknown is None:  # the rest determine the others together
                return chosen + [e for e in left if e.free_symbols & {*unknowns}]
            found = sorted(options[unknown], key=lambda e: (width(e), str(e)))[:2]
            chosen += found
            left = [e for e in left if e not in found]
            unknowns.remove(unknown)
            known.add(unknown)
        return chosen

    def all_of(self, solving: Solving) -> list[sp.Expr]:
        """The equations that are shown, and the one that those of a scaled pair follow from."""
        return self.system(solving) + (list(solving.equations) if solving.lemma.scaled else [])

    def equation(self, equation: sp.Expr, solving: Solving) -> list[tuple[str, str]]:
        """An equation with the unknowns on its left side."""
        terms = sp.Add.make_args(self.without_detours(self.named(equation)))
        held = set(solving.unknowns)
        unknown = [t for t in terms if t.free_symbols & held]
        rest = [-t for t in terms if not t.free_symbols & held]
        if unknown and all(t.as_coeff_Mul()[0].is_negative for t in unknown):
            unknown, rest = [-t for t in unknown], [-t for t in rest]
        negative = [t for t in unknown if t.as_coeff_Mul()[0].is_negative]
        if negative and not rest:  # what is subtracted stands on the other side
            unknown, rest = [t for t in unknown if t not in negative], [-t for t in negative]
        left, right = (self.page.lines.tidy(sp.Add(*terms)) for terms in (unknown, rest))
        text = self.page.math(left)
        if measure(text) > FITS * WIDE:  # its parts get names on the right
            return self.page.equations(self.page.math(right), left)
        return self.page.equations(text, right)

    def given_in(self, solving: Solving) -> list[sp.Expr]:
        """The atoms of the equations of a lemma that no step from here on finds."""
        later = {u for s in self.solvings[self.solvings.index(solving) :] for u in s.unknowns}
        return [
            atom
            for e in self.system(solving)
            for atom in self.atoms(self.without_detours(self.named(e)))
            if not atom.free_symbols & later
        ]

    def without_detours(self, value: sp.Expr) -> sp.Expr:
        """The same without a name, such as that of a difference, where it is shorter."""
        names = self.algorithm.values.keys() - self.algorithm.unknowns
        for name in sorted(value.free_symbols & names, key=str):
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
            if not isinstance(meaning, sp.sin | sp.cos) and not meaning.is_Symbol
            for row in self.page.equations(s, self.page.lines.tidy(meaning))
        ]
        angles = sorted(self.inverse.rank.defined.keys() & set(solving.unknowns), key=str)
        return rows + [
            r for a in angles for r in self.page.equations(a, self.inverse.rank.defined[a])
        ]

    def matrix(self, equations: Sequence[sp.Expr], step: Sequence[Solving]) -> str:
        """What is said of the matrix whose entries the equations hold."""
        if any(is_turned(s) for e in equations for s in self.named(e).free_symbols):
            return f"Here ${self.algorithm.product}$."
        held = {str(s) for e in equations for s in self.named(e).free_symbols}
        found = sorted({m[1] + m[2] for n in held if (m := MATRIX_ENTRY.fullmatch(n))})
        if letter := step[0].lemma.matrix:
            return f"Here ${letter}$ is a rotation."
        if not found:
            return ""
        names = listed([f"${n[0]}^{{({n[1]})}}$" for n in found])
        told = f"The entries of {names} follow from $R$ and the joints before"
        return f"{told}, as in the algorithm below."

    def joints_in(self, equations: Sequence[sp.Expr], solving: Solving) -> set[sp.Symbol]:
        """The joints and auxiliary unknowns in equations that their lemma does not find."""
        assert self.inverse
        held = free_symbols([self.explicit(e) for e in equations])
        rank = self.inverse.rank
        solvable = {*self.inverse.unknowns, *rank.defined, *rank.lengths}
        solvable |= {u for s in self.solvings for u in s.unknowns}
        return {s for s in solvable if s in held and s not in solving.unknowns}

    def origin(self, equations: Sequence[sp.Expr], step: Sequence[Solving]) -> str:
        """Which parts of the target the equations hold, and why they decouple."""
        assert self.inverse
        page, solving = self.page, step[0]
        held = free_symbols([self.explicit(e) for e in equations])
        parts = [s for s in self.function.symbols if s in held]
        joints = self.joints_in(self.all_of(solving), solving)
        later = self.found_later(sorted(joints, key=str), solving)
        order = [u for s in self.solvings for u in s.unknowns] + list(self.inverse.unknowns)
        known = sorted((s for s in joints if s not in later), key=order.index)
        letters = {u: s.lemma.matrix for s in self.solvings if s.lemma.matrix for u in s.unknowns}
        before = list(dict.fromkeys(f"${letters.get(j) or page.math(j)}$" for j in known))
        where = self.parts(parts)
        source = f"From {where} of the forward map" if where else "From the forward map"
        source += of_the_target(page, self.function, self.inverse, parts)
        if page.derivation.loop:
            source = f"From the equations of the loop{of_the_loop(page)}"
        verb = "follow equations" if len(equations) > 1 else "follows an equation"
        sought = [u for s in step for u in self.sought(s)]
        unknowns = listed(sought + [f"${page.math(u)}$" for u in later])
        found = [f"step {k} finds ${page.math(u)}$" for u, k in later.items()]
        told = f"{source} {verb} in {unknowns}"
        if len(step) > 1:
            told = f"{source} follows one equation in each of {unknowns}"
        if later:
            told += f", of which {listed(found)}"
        matrices = [j for j in before if j.strip("$") in letters.values()]
        alone = len(before) == 1 and matrices == before and not where
        place = self.where_found(before[0].strip("$")) if alone else ""
        if place:  # the target is in the matrix
            return f"{told.replace(source, f'From {before[0]} {place}', 1)} alone:"
        if before:
            verb = "is" if len(before) == 1 else "are"
            return f"{told}, where {listed(before)} {verb} known:"
        return f"{told}:" if later or len(step) > 1 else f"{told} alone:"

    def where_found(self, matrix: str) -> str:
        """Where the matrix of a lemma stands: its equation, or the step that finds it, if any."""
        if label := self.page.numbers.of(matrix):
            return f"in {reference([label])}"
        found = [k for k, step in enumerate(self.steps, 1) if step[0].lemma.matrix == matrix]
        return f"of step {found[0]}" if found else ""

    def found_later(self, joints: Sequence[sp.Symbol], solving: Solving) -> dict[sp.Symbol, int]:
        """The joints that a later step finds, and its number: the lemma takes a sum with them."""
        after = [solving in step for step in self.steps].index(True) + 1
        return {
            u: number
            for number, step in enumerate(self.steps[after:], after + 1)
            for s in step
            for u in s.unknowns
            if u in joints
        }

    def explicit(self, value: sp.Expr) -> sp.Expr:
        """An expression in the target and the joints."""
        assert self.inverse
        meaning = self.inverse.rank.meaning
        value = substitute(value, self.algorithm.usual)
        for _ in range(len(self.algorithm.values) + 1):
            names = free_symbols([value]) & {*self.algorithm.values, *meaning}
            names -= self.algorithm.unknowns
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
        if len(turned) > FEW:
            return listed([*names, "the rotation $R$"])
        return listed([*names, *(f"${self.page.math(s)}$" for s in turned)])

    def count(self, step: Sequence[Solving]) -> str:
        """How many solutions there are, and the signs that tell them apart."""
        n, several = step[0].lemma.branches, len(step) > 1
        number = NUMBERS[n] if n < len(NUMBERS) else str(n)
        before = self.solvings[: self.solvings.index(step[0])]
        used = {s for other in before for s in self.own_symbols(other)}
        chosen = {s for e in step for s in e.lemma.signs}
        chosen |= {
            s
            for c in chosen & self.algorithm.values.keys()
            for s in self.algorithm.values[c].free_symbols
        }
        own = {s for e in step for s in self.own_symbols(e)} | chosen
        own -= used
        signs = [s for s in self.algorithm.signs if s in own]
        told = listed([rf"${self.page.math(s)} = \pm 1$" for s in signs])
        start = "Each has" if several else f"There {'are' if n != 1 else 'is'}"
        text = f"{start} {number} solution{'s' * (n != 1)}"
        if told and n > 1:
            text += f", for {told}"
        if step[0].lemma.excluded and n == 1 and not step[0].lemma.scaled:
            text += " with the sign that is required"
        return text

    def own_symbols(self, solving: Solving) -> set[sp.Basic]:
        """The symbols of a solution and of the names that the lemma made for it."""
        made_by = solving.link.body if solving.link else solving.lemma.body
        usual = {s.symbol: sp.false for s in self.function.body if isinstance(s, Vanishes)}
        usual |= {s.symbol: sp.false for s in made_by if isinstance(s, Vanishes)}
        body = {
            s.symbol: substitute(s.value, usual)
            for s in made_by or self.function.body
            if isinstance(s, Let | Bound)
        }
        used = {s for e in solving.lemma.solution.values() for s in e.free_symbols}
        used |= {s for e in solving.lemma.means for s in e.free_symbols}
        used |= solving.lemma.plainly.keys()
        for symbol in reversed(list(body)):
            if symbol in used:
                used |= body[symbol].free_symbols
        return used

    def solution(self, solving: Solving) -> list[tuple[str, str]]:
        """What the lemma gives: angles, or their sines and cosines."""
        page, algorithm = self.page, self.algorithm
        rows: list[tuple[str, str]] = []
        values: list[sp.Expr] = []
        means = solving.link.means if solving.link else solving.lemma.means
        order = list(algorithm.values)
        for unknown in sorted(
            solving.unknowns, key=lambda u: order.index(u) if u in order else len(order)
        ):
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
            plain = {**solving.lemma.solution, **solving.lemma.plainly}
            value = self.algorithm.values.get(unknown, plain.get(unknown))
            if value is None:
                continue
            left, value = self.found_before(unknown, self.named(value), solving)
            rows += page.equations(left, value)
            values.append(value)
        for result in self.sums_with(solving):
            value = self.algorithm.value(result)
            rows += page.equations(result, value)
            values.append(value)
        values += [self.vanishing(flag) for flag in self.freeing(solving)]
        # an unknown may have the letter of the name that the program has for it
        return self.made_before(values) + [row for row in rows if row[0] != row[1]]

    def matrix_of(self, solving: Solving) -> list[Equation]:
        """The matrix that the lemma finds, and the quantities in it."""
        page, algorithm, lemma = self.page, self.algorithm, solving.lemma
        found = [self.named(lemma.solution[u]) for u in sorted(solving.unknowns, key=str)]
        self.told |= {e for e in found if e.is_Symbol}
        entries = [algorithm.value(e) if e in algorithm.values else e for e in found]
        rows = self.made_before(entries)
        return rows + page.equations(lemma.matrix, sp.Matrix(3, 3, entries))

    def sums_with(self, solving: Solving) -> list[sp.Symbol]:
        """The joints that are sums of angles which are all known with those of a lemma."""
        assert self.inverse
        values = self.algorithm.values
        done = self.solvings[: self.solvings.index(solving) + 1]
        known = {u for s in done for u in s.unknowns}
        sought = {u for s in self.solvings for u in s.unknowns}
        found = [
            r
            for r in self.inverse.unknowns
            if r in values and r not in sought | self.told
            if (held := values[r].free_symbols & sought) and held <= known
        ]
        self.told |= {*found}
        return found

    def found_before(
        self, unknown: sp.Symbol, value: sp.Expr, solving: Solving
    ) -> tuple[sp.Expr, sp.Expr]:
        """Both sides of a solution, with the joints that a later step finds on the left."""
        later = self.found_later(sorted(value.free_symbols, key=str), solving)
        ahead = sp.Add(*(t for t in sp.Add.make_args(value) if t.free_symbols & later.keys()))
        return unknown - ahead, value - ahead

    def made_before(self, values: Sequence[sp.Expr]) -> list[tuple[str, str]]:
        """The quantities in values that no step has defined yet; entries of matrices are left."""
        algorithm = self.algorithm
        unknowns = {u for s in self.solvings for u in s.unknowns}
        named = algorithm.needed - unknowns
        printed = [s for s in algorithm.values if s in named]
        shown = {e: s for s in printed if (e := algorithm.known.get(s)) is not None}
        shown |= {s: s for s in printed if s not in algorithm.known}  # also if another one is it
        pending = [s for v in values for s in self.atoms(v) if s in shown]
        found: set[sp.Symbol] = set()
        apart = algorithm.twins.apart if algorithm.twins else {}
        while pending:
            symbol = shown[pending.pop()]
            if symbol not in found and symbol not in self.told:
                found.add(symbol)
                value = algorithm.value(symbol)
                pending += [s for s in (*self.atoms(value), apart.get(symbol)) if s in shown]
        self.told |= found
        rows = list[Equation]()
        for s in algorithm.values:
            if s not in found or is_turned(s) or MATRIX_ENTRY.fullmatch(str(s.name)):
                continue
            value = algorithm.value(s)
            if algorithm.known.get(s) == value:
                continue
            with algorithm.as_two(s in apart or s in apart.values()):
                own = self.page.equations(algorithm.known.get(s, s), value)
            if label := self.stated.of(own, value):
                self.seen[self.page.math(algorithm.known.get(s, s))] = label
            else:
                rows += [row for row in own if row[0] != row[1]]
        return rows

    def atoms(self, value: sp.Expr) -> list[sp.Expr]:
        """The symbols of an expression, and its sines and cosines of auxiliary angles."""
        return sorted(value.atoms(sp.Symbol, sp.sin, sp.cos), key=str)

    def exists(self, solving: Solving) -> str:
        """The conditions under which the lemma has solutions."""
        before = self.solvings[: self.solvings.index(solving)]
        own = self.own_symbols(solving) - {s for o in before for s in self.own_symbols(o)}
        made = {s.symbol for s in self.function.body if isinstance(s, Let)}
        bounds = [
            s
            for s in self.function.body
            if isinstance(s, Bound)
            if s.symbol in own or ((held := s.value.free_symbols & made) and held <= own)
        ]
        if solving.link:
            bounds += [s for s in solving.link.body if isinstance(s, Bound) and s not in bounds]
        return flat(", ".join(self.algorithm.conditions([b.symbol for b in bounds])))

    def degenerate(self, step: Sequence[Solving]) -> str:
        """Where the unknowns of a step are free."""
        found: dict[str, list[str]] = {}
        for flag in dict.fromkeys(f for solving in step for f in self.freeing(solving)):
            where = Cases(self.algorithm).vanishing(self.vanishing(flag))
            names = found.setdefault(f"{self.page.prose(flag.meaning)} ({where})", [])
            names += [f"${self.page.math(s)}$" for s in flag.free]
        places: dict[str, list[str]] = {}
        for where, names in found.items():
            places.setdefault(are_free(names), []).append(where)
        return "; where ".join(f"{' or where '.join(w)}: {free}" for free, w in places.items())

    def vanishing(self, flag: Vanishes) -> sp.Expr:
        """What a flag compares with zero, by its name if it has one."""
        value = self.named(flag.value)
        return self.algorithm.quantities.get(value, value)

    def freeing(self, solving: Solving) -> list[Vanishes]:
        """The flags of the cases in which an unknown of the lemma is free."""
        return [
            s
            for s in (solving.link.body if solving.link else self.function.body)
            if isinstance(s, Vanishes) and s.free and not is_never(self.algorithm, s)
            if solving.link or set(s.free) & set(solving.unknowns)
        ]


__all__ = ["Solving", "Stages"]
