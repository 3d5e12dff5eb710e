"""How an inverse is told: its stages, the algorithm, and what was proved of it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from closedform.algebra.formulas import PRINTED, formula
from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.cases import Cases
from closedform.emit.backends.latex.formulas import FITS, measure
from closedform.emit.backends.latex.listing import lines_kept, whole
from closedform.emit.backends.latex.prose import escape, symbols_declared, upright
from closedform.emit.backends.latex.sheet import Sheet, block, blocks
from closedform.emit.backends.latex.sources import explained_as_a_whole, of_the_loop
from closedform.emit.backends.latex.stages import Stages
from closedform.emit.backends.latex.wide import Equation
from closedform.model.functions import (
    Array,
    Bound,
    Function,
    Let,
    Match,
    Vanishes,
    real,
)
from closedform.model.inverse import Combination, Degenerate, Inverse
from closedform.model.names import listed
from closedform.proof.inverse import InverseResult

MANY = 16
"""The most branches of which each tells its signs in a line of its own."""


class Told:
    """The text of one function that has a status for each branch."""

    def __init__(self, page: Sheet, function: Function, algorithm: Algorithm, after: str):
        self.page, self.whole = page, function
        self.subject = algorithm.subject
        self.function, self.inverse = self.subject.function, self.subject.inverse
        self.algorithm, self.after = algorithm, after
        self.stages = Stages(page, algorithm)
        self.parameters = {p.symbol for p in page.derivation.parameters}

    def context(self) -> dict[str, Any]:
        page = self.page
        lines, cases = self.algorithm.lines(), Cases(self.algorithm)
        inverse = self.inverse
        return {
            "given": self.given(),
            "after": self.after,
            "stages": self.stages.context(),
            "order": self.order(),
            "reasons": explained_as_a_whole(
                page, self.function, [u for s in self.stages.solvings for u in s.unknowns]
            ),
            "each": self.subject.each,
            "several": sum(len(self.stages.sought(s)) for s in self.stages.solvings) > 1,
            "joints": blocks(self.joints()),
            "lines": lines,
            "lines_kept": lines_kept(lines),
            "cases": cases.told(),
            "roundings": cases.roundings(),
            **self.branches(),
            "reached": self.reached(),
            "continua": [self.continuum(inverse, c) for c in inverse.degenerate if c.free]
            if inverse
            else [],
        }

    def branches(self) -> dict[str, Any]:
        """The branches with their signs, which stand in columns if there are many."""
        cases = [(escape(label), signs) for label, signs in self.whole.cases() if signs]
        math = self.page.math
        return {
            "signs": [math(s) for s in cases[0][1]] if cases else [],
            "branches": [
                (label, ",\\ ".join(f"{math(s)} = {v:+d}" for s, v in given.items()))
                for label, given in cases
            ],
            "columns": [(label, [f"{v:+d}" for v in given.values()]) for label, given in cases]
            if len(cases) > MANY
            else [],
        }

    def reached(self) -> str:
        """What is said of an inverse that always answers, whose workspace has no boundary."""
        if self.whole.name != "ik" or any(isinstance(s, Bound | Match) for s in self.whole.body):
            return ""
        shapes = {array.shape for array in self.whole.inputs}
        target = "pose" if (4, 4) in shapes else "orientation" if (3, 3) in shapes else "target"
        by = " in every branch" if len([*self.whole.cases()]) > 1 else ""
        return f"Every {target} is reached{by}: the workspace has no boundary."

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
                if array.name in joints:
                    texts.append(f"the joint ${page.math(joints[array.name])}$")
                    continue
                text = f"${page.math(array.entries[0])}$"
                texts.append(f"the {escape(array.name.replace('_', ' '))} {text}")
            else:
                texts += whole(self.argument(array))
        return ", and ".join(texts)

    def argument(self, array: Array) -> list[Equation]:
        """An argument and its entries; in the font of the code if it is called as a coordinate."""
        page = self.page
        coordinates = {page.written(name) for name in page.derivation.task}
        if page.written(array.name) in {*map(page.math, array.entries), *coordinates}:
            return page.equations(rf"\mathtt{{{array.name}}}", list(array.entries))
        return page.assigned(array, {})

    def order(self) -> str:
        """The unknowns, in the order in which they are solved for."""
        groups = []
        for step in self.stages.steps:
            if self.stages.are_twins(step) and (twins := self.algorithm.twins):
                with self.algorithm.as_one():
                    names = self.stages.sought(step[0])
                groups.append(f"({', '.join(names)}) for {twins.each}")
                continue
            names = [u for s in step for u in self.stages.sought(s)]
            together = len(step) == 1 and len(names) > 1
            groups.append(f"({', '.join(names)})" if together else listed(names))
        return ", then ".join(groups)

    def joints(self) -> list[tuple[str, str]]:
        """The joints in the unknowns of the steps, where these are others."""
        glue = self.inverse.glue if self.inverse else None
        if not isinstance(glue, Combination):
            return []
        found = [(u, self.algorithm.full(e)) for u, e in glue.joints.items()]
        return [r for u, e in found if u != e for r in self.page.equations(u, e)]

    # What was proved

    def continuum(self, inverse: Inverse, case: Degenerate) -> dict[str, Any]:
        """The set on which a joint is free, the returned value, and what all solutions share."""
        page, function = self.page, self.function
        rows = [r for a in function.inputs for r in self.located(a, case.locus)]
        others = self.parameters & set(case.locus)
        rows += [r for s in sorted(others, key=str) for r in page.equations(s, case.locus[s])]
        _, signs = next(function.cases())
        values = function.at(signs, dict.fromkeys(case.flags, True), case.locus)
        convention = without_turns(dict(zip(inverse.unknowns, values, strict=True))[case.free])
        narrow = all(measure(a + b) < FITS / 2 and r"\begin" not in b for a, b in rows)
        return {
            "free": page.math(case.free),
            "flag": page.prose(self.algorithm.flags[case.flags[0]].meaning),
            "locus": ", ".join(whole(rows)) if narrow else "",
            "blocks": [] if narrow else blocks(rows),
            "any": listed([f"${page.math(s)}$" for s in self.varied(case)]),
            "convention": f"{page.math(case.free)} = {page.math(convention)}",
            "shared": "satisfy" if "=" in case.relation else "share",
            "relation": upright(case.relation),
        }

    def varied(self, case: Degenerate) -> list[sp.Symbol]:
        """The symbols that parametrise a locus, and stand for nothing else."""
        there = {s for e in case.locus.values() for s in sp.sympify(e, strict=True).free_symbols}
        known = {*self.function.symbols, *self.parameters, *symbols_declared(self.page.derivation)}
        return sorted(there - known, key=str)

    def located(self, array: Array, locus: Mapping[sp.Symbol, Any]) -> list[tuple[str, str]]:
        """The part of an argument that the locus fixes; a rotation is a matrix."""
        page = self.page
        rotation = block(array) if array.shape in ((3, 3), (4, 4)) else []
        if rotation and all(e in locus for e in rotation):
            rows = page.equations("R", sp.Matrix(3, 3, [locus[e] for e in rotation]))
            rest = [e for e in array.entries if e in locus and e not in rotation]
            return rows + [r for e in rest for r in page.equations(e, locus[e])]
        if array.shape == (4, 4) or len(array.shape) == 1:
            return [r for e in array.entries if e in locus for r in page.equations(e, locus[e])]
        return page.assigned(array, locus)

    def proved(self, result: InverseResult) -> dict[str, Any]:
        page = self.page
        symbols = {str(s): s for s in self.algorithm.values}
        symbols |= {s.name: s for f in page.derivation.functions for s in f.symbols}
        symbols |= {p.name: p.symbol for p in page.derivation.parameters}
        named = self.named_bounds(result.assumptions)
        held = {
            a: self.algorithm.bound(named[a]) if a in named else self.assumption(a, symbols)
            for a in result.assumptions
        }
        # a lemma of unit vectors is proved for all of them, in symbols that stand nowhere else
        told = [e for e in held.values() if {str(s) for s in e.free_symbols} <= symbols.keys()]
        assumed = self.algorithm.inequalities(told)
        if len(told) < len(held):
            assumed.append("the roots of the lemmas are real")
        how = {
            "generic": "by a Groebner basis over the field of parameters and targets",
            "specialised": "by Groebner bases, with the same result at several rational points",
        }
        loop = page.derivation.loop is not None
        return {
            "solved": f"the equations of the loop{of_the_loop(page)}" if loop else "",
            "where": f", where {', '.join(assumed)}" if assumed else "",
            "count": f"{result.solutions} solution{'s' * (result.solutions != 1)}",
            "how": how.get(result.method, escape(result.method)),
            "lemmas": result.lemmas,
            "continua": result.continua,
        }

    def assumption(self, text: str, symbols: Mapping[str, sp.Symbol]) -> sp.Expr:
        value: sp.Expr = formula(text, lambda n: symbols.get(n, real(n)), PRINTED)
        return self.algorithm.full(value)

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


def without_turns(value: sp.Expr) -> sp.Expr:
    """A value without the angles of vectors along the first axis, which are zero."""

    def is_along(e: sp.Expr) -> bool:
        if not isinstance(e, sp.atan2) or e.args[0] != 0:
            return False
        powers = [f.as_base_exp()[1] for f in sp.Mul.make_args(e.args[1])]
        return all(p == sp.S.Half for p in powers)  # a root is not negative

    return value.replace(is_along, lambda _: sp.S.Zero)


__all__ = ["Told"]
