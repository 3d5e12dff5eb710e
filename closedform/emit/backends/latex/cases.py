"""Where the lines of an algorithm do not apply, and what holds there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.emit.backends.latex.algorithm import ONCE, Algorithm
from closedform.emit.backends.latex.inequalities import equality
from closedform.emit.backends.latex.plain import is_rounding
from closedform.emit.backends.latex.sources import explained
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Determined, Let, Vanishes
from closedform.model.names import listed


@dataclass(frozen=True)
class Case:
    """A special case: where it occurs, what it means, and what is returned."""

    where: str
    meaning: str
    returned: str
    status: str = ""


def is_never(algorithm: Algorithm, flag: Vanishes) -> bool:
    """Whether the value of a flag is a number that is not zero, so that it never holds."""
    value = algorithm.full(flag.value)
    return bool(value.is_number and value != 0)


def are_free(names: Sequence[str]) -> str:
    """That joints are free, by what formulas call them."""
    return f"{listed(names)} {'are' if len(names) > 1 else 'is'} free"


class Cases:
    """The special cases of an algorithm."""

    def __init__(self, algorithm: Algorithm):
        self.algorithm, self.page = algorithm, algorithm.page

    def told(self) -> list[Case]:
        """Where the lines above do not apply, and what holds there that the model does not say."""
        found: dict[tuple[str, str, str], list[str]] = {}
        twins = self.algorithm.twins
        for flag in self.algorithm.flags.values():
            if (twins and flag.symbol in twins.second) or is_never(self.algorithm, flag):
                continue
            with self.algorithm.as_one(twins is not None and flag.symbol in twins.alike):
                told = self._told(flag)
                effect = [e for e in self._effect(flag) if told is None or e not in told]
                effect += self._chosen(flag)
                free = flag.free if told is None else ()
                if not is_rounding(flag) and (effect or free):
                    names = found.setdefault(self._where(flag, effect), [])
                    names += [f"${self.page.math(s)}$" for s in free]
        cases = [self._case(*where, names) for where, names in found.items()]
        for statement in self.algorithm.function.body:
            if isinstance(statement, Determined):
                cases.append(self._determined(statement))
        return list(dict.fromkeys(cases))

    def _told(self, flag: Vanishes) -> list[str] | None:
        """What the algorithms before this one say of a flag that they have."""
        if self.algorithm.model is None or flag not in self.algorithm.model.flags.values():
            return None
        model = Cases(self.algorithm.model)
        return [*(model._told(flag) or ()), *model._effect(flag)]

    @property
    def has_cases_of_model(self) -> bool:
        """Whether special cases of the algorithms before this one hold here too."""
        flags = [f for f in self.algorithm.flags.values() if not is_rounding(f)]
        return any((told := self._told(f)) is not None and (f.free or told) for f in flags)

    def roundings(self) -> list[str]:
        """What is said of the flags that only serve the rounding of a usual posture."""
        return list(
            dict.fromkeys(
                self.page.prose(f.meaning) for f in self.algorithm.flags.values() if is_rounding(f)
            )
        )

    def _effect(self, flag: Vanishes) -> list[str]:
        """What a flag puts in place of names and answers that are printed."""
        usual = {**self.algorithm.usual, flag.symbol: sp.true}
        changed: dict[sp.Basic, sp.Expr] = {}
        printed = [s for s in self.algorithm.values if s in self.algorithm.printed]
        function = self.algorithm.function
        values = {s.symbol: s.value for s in function.body if isinstance(s, Let | Bound)}
        whole = [(s, values[s]) for s in printed]
        joints = self.algorithm.inverse.unknowns if self.algorithm.inverse else ()
        if len(joints) == len(self.entries):  # the outputs stand for the joints
            whole += zip(joints, self.entries, strict=True)
        for name, value in whole:
            if value.has(flag.symbol):
                other = substitute(substitute(value, usual), self.algorithm.known).xreplace(changed)
                other = self.algorithm.short(other)
                # infinite: another name in it has another value here too, which is not printed
                if not other.has(sp.zoo, sp.nan) and self.page.lines.width(other) <= ONCE:
                    changed[self.algorithm.known.get(name, name)] = other
        made: dict[sp.Basic, sp.Expr] = {}
        for name, value in list(changed.items()):
            if (needs := self._made_for(value)) is None:
                del changed[name]
            else:
                made |= needs
        rows = [*made.items(), *changed.items()]
        return [f"${self.page.math(n)} = {self.page.math(e)}$" for n, e in rows]

    def _chosen(self, flag: Vanishes) -> list[str]:
        """The angles that are chosen where a flag holds, and the steps that say how."""
        angles = self.algorithm.chosen.get(flag.symbol, ())
        names = [f"${self.page.math(a)}$" for a in angles]
        if not names:
            return []
        where = explained(self.page, self.algorithm.function, angles)
        return [f"{listed(names)} {'are' if len(names) > 1 else 'is'} chosen{where}"]

    def _made_for(self, value: sp.Expr) -> dict[sp.Basic, sp.Expr] | None:
        """The names in a value that no line defines, with their values; None if they are long."""
        there = value.free_symbols
        defined = self.algorithm.needed | self.algorithm.printed
        hidden = [s for s in self.algorithm.values if s in there and s not in defined]
        made: dict[sp.Basic, sp.Expr] = {
            s: self.algorithm.shown(self.algorithm.values[s]) for s in hidden
        }
        rest = {s for e in made.values() for s in e.free_symbols & self.algorithm.values.keys()}
        is_long = any(self.page.lines.width(e) > ONCE for e in made.values())
        return None if is_long or rest - self.algorithm.needed - self.algorithm.printed else made

    @property
    def entries(self) -> list[sp.Expr]:
        return [e for a in self.algorithm.function.outputs for e in a.entries]

    def _where(self, flag: Vanishes, effect: Sequence[str]) -> tuple[str, str, str]:
        """The condition of a flag, what it means, and the values that it replaces."""
        value = self.algorithm.full(flag.value)
        value = self.algorithm.quantities.get(value, value)
        return self.vanishing(value), self.page.prose(flag.meaning), ", ".join(effect)

    @staticmethod
    def _case(where: str, meaning: str, effect: str, names: Sequence[str]) -> Case:
        """A case of one flag, or of several that are the same but for what is free."""
        freed = f"{are_free(names)}; {effect}".removesuffix("; ") if names else effect
        return Case(where, meaning, freed, "singular" if names else "")

    def vanishing(self, value: sp.Expr) -> str:
        """The condition that a nonnegative value is zero."""
        parts = sp.Add.make_args(value)
        sizes = any(isinstance(t, sp.Abs) for t in parts)
        if len(parts) > 1 and sizes and all(t.is_nonnegative for t in parts):
            inner = [t.args[0] if isinstance(t, sp.Abs) else t for t in parts]
            return ", ".join(equality(self.page, self.page.lines.tidy(t)) for t in inner)
        return equality(self.page, value)

    def _determined(self, statement: Determined) -> Case:
        """Where rounded joints do not determine the posture; in words where the formula is long."""
        meaning = self.page.prose(statement.meaning)
        answer = "rounded joints do not determine the posture"
        rest: list[str] = []
        first, scale = statement.name, self.algorithm.full(statement.scale)
        value = None if first else self.algorithm.full(statement.value)  # which can be long
        in_cases = any(e is not None and e.has(sp.Piecewise) for e in (value, scale))
        if scale in (0, value) or in_cases:  # all is in the flags, or too long
            return Case(f"within rounding of the case that {meaning}", "", answer, "singular")
        if value:
            rows = self.page.equations("", value)
            first, rest = rows[0][1], [f"${a} = {b}$" for a, b in rows[1:]]
        # TeX breaks no line between two factors by itself
        product = statement.scale_name or self.page.math(scale).replace(
            r" \bigl(", r" \allowbreak \bigl("
        )
        where = rf"${first} \ll {product}$"
        if rest:
            where += f", with {', '.join(rest)}"
        return Case(where, meaning, answer, "singular")


__all__ = ["Case", "Cases", "are_free", "is_never"]
