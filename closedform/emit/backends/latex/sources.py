"""Which equations of the derivation an inverse solves: those of the loop, or the forward map."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.equations import canonical, reference, skeleton
from closedform.emit.backends.latex.prose import upright
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.backends.latex.wide import Equation
from closedform.model.functions import Function
from closedform.model.inverse import Inverse
from closedform.model.names import listed
from closedform.model.step import Step


def of_the_loop(page: Sheet) -> str:
    """Where the equations of the loop stand: their numbers, or the section with their table."""
    step = page.derivation.loop
    if step is None:
        return ""
    if labels := _numbers(page, step):
        return f" {reference(labels)}"
    return f" ({_sections(page, [step])})"


def of_the_target(
    page: Sheet, function: Function, inverse: Inverse, symbols: Sequence[sp.Symbol]
) -> str:
    """The numbers of the equations of the forward map for some coordinates of the target."""
    image = dict(zip(inverse.targets, inverse.forward, strict=True))
    found = list[str]()
    for symbol in symbols:
        if step := page.derivation.given_by.get(str(symbol.name)):
            found += _numbers(page, step)
        elif symbol in image:
            found.append(_shown(page, image[symbol]) or _returned(page, function, symbol))
    labels = [label for label in found if label]
    return f" {reference(labels)}" if labels else ""


def _sections(page: Sheet, steps: Sequence[Step]) -> str:
    """The sections of steps: ``Sections 3.1 and 3.2``."""
    every = page.derivation.steps
    places = [rf"\ref{{step:{page.derivation.name}:{every.index(s) + 1}}}" for s in steps]
    if len(places) < 2:
        return "".join(f"Section~{place}" for place in places)
    return f"Sections~{listed(places)}"


def explained(page: Sheet, function: Function, unknowns: Iterable[sp.Symbol]) -> str:
    """The sections of the derivation that explain how some unknowns are found."""
    steps = [s for s, found in _reasons(page, function) if found & {*unknowns}]
    return f" (see {_sections(page, steps)})" if steps else ""


def explained_as_a_whole(page: Sheet, function: Function, unknowns: Iterable[sp.Symbol]) -> str:
    """The sections that give reasons for an inverse, but for none of its unknowns."""
    steps = [s for s, found in _reasons(page, function) if not found & {*unknowns}]
    if not steps:
        return ""
    return f"{_sections(page, steps)} {'give' if len(steps) > 1 else 'gives'} the reasons."


def _reasons(page: Sheet, function: Function) -> list[tuple[Step, frozenset[sp.Symbol]]]:
    """The steps that give reasons for an inverse, and the unknowns that they explain."""
    return [
        (step, frozenset(unknowns))
        for step in page.derivation.steps
        for name, unknowns in step.solves
        if name == function.name
    ]


def _numbers(page: Sheet, step: Step) -> list[str]:
    """The numbers of the equations of a step."""
    return [label for left, _ in step.shown if (label := page.numbers.of(upright(left)))]


class Stated:
    """What the steps of a derivation define: an inverse that needs it refers to their numbers."""

    def __init__(self, page: Sheet):
        self.numbers = page.numbers
        self.entries: dict[sp.Expr, list[tuple[str, str]]] = {}
        """The names of vectors and matrices with an entry, and the numbers of their equations."""
        for (left, shown), label in _labelled(page):
            for value in shown if label and isinstance(shown, sp.MatrixBase) else ():
                if not value.is_Atom:
                    known = self.entries.setdefault(sp.expand(value), [])
                    known.append((skeleton(canonical(left)), label))

    def of(self, equation: Sequence[Equation], value: sp.Expr) -> str:
        """The number of the equation that defines a name with this value; the name is on the left.

        The name may be that of an entry: ``w_x`` of ``w``.
        """
        left, right = equation[0]
        if label := self.numbers.is_shown(equation):
            return label
        label = self.numbers.defined.get(canonical(left), "")
        if label and self.numbers.with_right(right) == label:
            return label
        name = skeleton(canonical(left))
        known = self.entries.get(sp.expand(value), [])
        return next((label for base, label in known if name.startswith(base) and name != base), "")


def _returned(page: Sheet, target: Function, symbol: sp.Symbol) -> str:
    """The number of the equation of the function that returns an argument of an inverse."""
    for function in page.derivation.functions:
        returned = {(a.name, a.shape) for a in function.outputs}
        asked = (a for a in target.inputs if symbol in a.entries)
        if function.equation and any((a.name, a.shape) in returned for a in asked):
            return page.numbers.of(function.equation)
    return ""


def _labelled(page: Sheet) -> Iterable[tuple[tuple[str, Any], str]]:
    """What the steps show, and the number of each; a name may be defined anew."""
    times = Counter[str]()
    for step in page.derivation.steps:
        for left, shown in step.shown:
            labels = page.numbers.lefts.get(canonical(upright(left)), [""])
            yield (left, shown), labels[min(times[left], len(labels) - 1)]
            times[left] += 1


def _shown(page: Sheet, value: sp.Expr) -> str:
    """The number of the first equation whose right side is a value or has it as an entry."""
    return next((label for (_, v), label in _labelled(page) if label and value in _entries(v)), "")


def _entries(value: Any) -> Iterable[Any]:
    return value if isinstance(value, sp.MatrixBase | list | tuple) else [value]


__all__ = ["Stated", "explained", "explained_as_a_whole", "of_the_loop", "of_the_target"]
