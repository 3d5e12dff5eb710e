"""The symbols of an article: its notation table, and the check that each has one meaning.

A symbol is a parameter, a joint, a coordinate of the task, a name that an equation defines, or one
that the derivation explains by ``d.write``.  Two symbols must not look alike, and one symbol must
not have two forms.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.equations import (
    Numbers,
    canonical,
    is_name,
    names_in,
    reference,
    skeleton,
    without_power,
)
from closedform.emit.backends.latex.names import coordinate_name
from closedform.emit.backends.latex.prose import (
    Prose,
    symbols_declared,
    symbols_of,
    upright,
    written_name,
)
from closedform.emit.backends.latex.sheet import UNPRINTED
from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Let

Printed = Callable[[sp.Symbol], str]
AUXILIARY = re.compile(r"u_\{\d+\}")
"""The name of a part of a long expression."""


@dataclass
class Forms:
    """How the symbols of a document are written: by what they look like, form and origin."""

    found: dict[str, dict[str, set[str]]] = field(default_factory=dict)

    def add(self, form: str, name: str) -> None:
        """A form in LaTeX, and the name of what it stands for; empty if only the form is known."""
        names = self.found.setdefault(skeleton(form), {}).setdefault(form, set())
        names |= {name} - {""}

    def clashes(self) -> Iterator[str]:
        for forms in self.found.values():
            if len(forms) > 1:
                yield f"one symbol is written in several ways: {', '.join(sorted(forms))}"
            for form, names in forms.items():
                if len(names) > 1:
                    yield f"{form} is written for {' and for '.join(sorted(names))}"


def forms_of(
    derivation: Derivation,
    math: Printed,
    legend: Iterable[tuple[str, str]],
    local: Container[sp.Symbol] = (),
) -> Forms:
    """Every symbol that the formulas of a derivation contain, as ``math`` prints it.

    An algorithm has ``local`` names of its own, which mean nothing beside it.
    """
    forms = Forms()
    joints = {j.symbol for j in derivation.joints}
    targets = {s for f in derivation.functions for s in f.symbols} - joints
    for short, _ in legend:
        forms.add(canonical(short), "")
    for step in derivation.steps:
        for left, _ in step.shown:
            for form in _forms_in(upright(left)):
                forms.add(form, "")
    for symbol in _symbols_in(derivation, local):
        form = canonical(math(symbol))
        # one coordinate may be part of the targets of two functions, under two names
        known = derivation.written.get(symbol.name)
        name = known.same if known and known.same else symbol.name
        forms.add(form, f"a target {form}" if symbol in targets else name)
    return forms


def _forms_in(left: str) -> Iterator[str]:
    """The names in the left side of an equation, and whole sides that are powers of a name."""
    yield from names_in(left)
    for part in map(canonical, left.split("=")):
        if is_name(part) and without_power(part) != part and not part.endswith("T}"):
            yield part


def _symbols_in(derivation: Derivation, local: Container[sp.Symbol]) -> Iterator[sp.Symbol]:
    """The symbols that are declared, those of the steps, and those that algorithms define."""
    yield from symbols_declared(derivation)
    for step in derivation.steps:
        yield from symbols_of(step)
    for function in derivation.functions:
        if function.name != UNPRINTED:
            for statement in function.body:
                if isinstance(statement, Let | Bound) and statement.symbol not in local:
                    yield statement.symbol


def clashes(
    derivation: Derivation,
    math: Printed,
    legend: Iterable[tuple[str, str]],
    local: Container[sp.Symbol] = (),
) -> list[str]:
    """What a reader would mistake: two symbols that look alike, one symbol in two forms."""
    return sorted(set(forms_of(derivation, math, legend, local).clashes()))


def require_distinct(
    derivation: Derivation,
    math: Printed,
    legend: Iterable[tuple[str, str]],
    local: Container[sp.Symbol] = (),
) -> None:
    """Raise ``ValueError`` if the symbols of an article can be mistaken for each other."""
    if found := clashes(derivation, math, legend, local):
        raise ValueError(
            f"the symbols of the article cannot be told apart: {'; '.join(found)}.  Write one of "
            f"them in another way, with d.write(name, latex)"
        )


def undefined(derivation: Derivation, numbers: Numbers, math: Printed) -> list[str]:
    """Symbols in the steps that neither an equation defines nor the derivation explains.

    ``math`` prints the sine and the cosine of a joint that was solved as such.
    """
    rows = table(derivation, numbers, Prose(derivation), math)
    known = set(numbers.defined) | {canonical(form) for form, _ in rows}
    known |= {_form(derivation, s.name) for s in symbols_declared(derivation)}
    known |= {_form(derivation, str(s)) for f in derivation.functions for s in f.symbols}
    used = {s for step in derivation.steps for s in symbols_of(step)}
    return sorted(
        s.name
        for s in used
        if _form(derivation, s.name) not in known and not re.match(r"\\mathrm\{[cs]\}_", math(s))
    )


def table(
    derivation: Derivation, numbers: Numbers, prose: Prose, math: Printed
) -> list[tuple[str, str]]:
    """Symbols other than parameters and joints, with their meaning; not the entries of a matrix."""
    declared = {s.name for s in symbols_declared(derivation)}
    rows: dict[str, list[str]] = {}
    for name, written in derivation.written.items():
        if name not in declared and written.meaning:
            rows.setdefault(_form(derivation, name), []).append(prose(written.meaning))
    for form, meaning in (*_inputs(derivation, math), *_signs(derivation)):
        if form not in rows:
            rows[form] = [meaning]
    taken = {_form(derivation, name) for name in declared}
    said = dict(_summaries(derivation))
    explained = derivation.explained.items()
    in_words = {without_power(canonical(upright(n))): m for n, m in explained}
    said |= in_words
    for form, label in numbers.defined.items():
        of_a_listed_matrix = form not in rows and matrix_of(form, numbers.defined)
        if form not in taken and not of_a_listed_matrix:
            if form not in said and AUXILIARY.fullmatch(form):
                said[form] = "abbreviation"
            told = rows.setdefault(form, [prose(said[form])] if form in said else [])
            told.append(f"see {reference([label])}")
    # such as a block of a matrix, of which an equation gives the determinant
    for form in in_words.keys() - rows.keys() - taken:
        if not matrix_of(form, numbers.defined):
            rows[form] = [prose(in_words[form])]
    cells = ((form, ", ".join(filter(None, texts))) for form, texts in rows.items())
    return sorted(((f, t) for f, t in cells if t), key=lambda row: (_place(row[0]), row))


def _place(form: str) -> str:
    """Where a symbol stands in the table: by its letter, then by its number."""
    return re.sub(r"\d+", lambda m: m[0].zfill(3), skeleton(form).lower())


def matrix_of(form: str, known: Container[str]) -> str:
    """``J_{s}`` of ``J_{s,12}`` and ``J`` or a bold J of ``J_{12}``, if it is ``known``."""
    entry = re.fullmatch(r"(.+)_\{(?:(.+),)?\d\d\}", form)
    if entry is None:
        return ""
    plain = f"{entry[1]}_{{{entry[2]}}}" if entry[2] else entry[1]
    return next((m for m in (plain, rf"\mathbf{{{plain}}}") if m in known), "")


def _form(derivation: Derivation, name: str) -> str:
    return without_power(canonical(written_name(derivation, name)))


def _inputs(derivation: Derivation, math: Printed) -> Iterator[tuple[str, str]]:
    """The coordinates of the task, and the entries of the targets."""
    matrices = [a for f in derivation.functions for a in f.inputs if len(a.shape) > 1]
    entries = {str(e) for a in matrices for e in a.entries}
    for name in derivation.task:
        if name not in entries:
            yield canonical(coordinate_name(derivation, name)), "task coordinate"
    for function in derivation.functions:
        joints = {j.symbol for j in derivation.joints}
        names = {j.name for j in derivation.joints}
        for array in function.inputs:
            if joints & set(array.entries) or array.name in names:
                continue
            whole = _form(derivation, array.name)
            if len(array.shape) > 1:
                yield _entry(whole)
                if array.shape == (4, 4) and math(array.entries[0]).startswith("R_"):
                    yield _entry("R")
                    yield from _parts_of_pose(derivation, whole)
                continue
            of = "the target" if function.has_status else f"${whole}$"
            for entry in array.entries:
                form = without_power(canonical(math(entry)))
                yield form, f"coordinate of {of}" if form != whole else "argument"


def _entry(whole: str) -> tuple[str, str]:
    return f"{whole}_{{ij}}", f"entry of ${whole}$ in row $i$, column $j$"


def _parts_of_pose(derivation: Derivation, whole: str) -> Iterator[tuple[str, str]]:
    """The rotation and the position in a pose, unless the derivation says what they are."""
    for name, what in (("R", "rotation"), ("p", "position")):
        if name not in derivation.explained:
            yield name, f"{what} in ${whole}$"


def _summaries(derivation: Derivation) -> Iterator[tuple[str, str]]:
    """What the functions say that evaluate a named equation."""
    for function in reversed(derivation.functions):
        for array in function.outputs:
            name = canonical(function.equation) or _form(derivation, array.name)
            sentence = re.split(r"\. |;(?![^(]*\))", function.summary)[0]
            yield name, _uncapital(sentence.rstrip("."))


def _uncapital(sentence: str) -> str:
    """The sentence as a part of another: a word that is not a name starts with a small letter."""
    word = re.match(r"[A-Z][a-z]+\b(?!['’])", sentence)
    is_word = word is not None and word[0] != "Jacobian"
    return sentence[0].lower() + sentence[1:] if is_word else sentence


def _signs(derivation: Derivation) -> Iterator[tuple[str, str]]:
    """The signs of the branches, with the number that tells them apart."""
    for function in derivation.functions:
        for _, signs in function.cases():
            for sign in signs:
                yield _form(derivation, str(sign)), r"branch sign, $+1$ or $-1$"


DEFINED = re.compile(r"(.*?)see (\\eqref\{[^{}]*\})")
"""A meaning with the number of the equation that defines the symbol."""
INDEXED = re.compile(r"(.+)_\{(\d+)\}('?)")
"""A symbol with a number."""
COORDINATE = re.compile(r"[xyz](_\{\w+\})?")
"""A coordinate of a point, with the index of the point."""
FEW = 3
"""So many names in a row are all written."""
WIDEST = 24
"""The letters of the symbols in one row; more are too wide for their column."""


def joined(rows: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Neighbours with one meaning in one row, and so those that follow each other by number."""
    done: list[tuple[list[str], str, list[str]]] = []
    for form, meaning in side_by_side([*rows]):
        label = DEFINED.fullmatch(meaning)
        stem = INDEXED.fullmatch(form)
        if done:
            forms, common, labels = done[-1]
            last = INDEXED.fullmatch(forms[-1])
            if not label and meaning == common and _letters([*forms, form]) <= WIDEST:
                forms.append(form)
                continue
            follows = (
                stem
                and last
                and stem.group(1, 3) == last.group(1, 3)
                and _follows(stem[2], last[2])
            )
            if label and labels and follows and common.startswith(f"{label[1]}see"):
                forms.append(form)
                labels.append(label[2])
                continue
        done.append(([form], meaning, [label[2]] if label else []))
    return [_joined(forms, meaning, labels) for forms, meaning, labels in done]


def side_by_side(rows: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """The rows, with those beside the first one that differ from it in their number alone.

    So are those of a point: x, y, z stand before x_T, y_T, z_T.
    """
    first: dict[Any, int] = {}

    def place(row: tuple[int, tuple[str, str]]) -> int:
        k, (form, meaning) = row
        stem, label = INDEXED.fullmatch(form), DEFINED.fullmatch(meaning)
        if (coordinate := COORDINATE.fullmatch(form)) and not label:
            return first.setdefault((coordinate[1], meaning), k)
        return first.setdefault((stem[1], stem[3], label[1]), k) if stem and label else k

    return [row for _, row in sorted(enumerate(rows), key=place)]


def _follows(number: str, last: str) -> bool:
    """Whether a number is the next one, or the next on the diagonal of a matrix: 22 after 11."""
    on_diagonal = len(number) == len(last) == 2 and number[0] == number[1] and last[0] == last[1]
    return int(number) - int(last) == (11 if on_diagonal else 1)


def _letters(forms: Iterable[str]) -> int:
    """The number of letters and digits that are seen; a Greek letter is one."""
    plain = (re.sub(r"\\(mathrm|mathbf|text|operatorname)\b", "", form) for form in forms)
    return sum(len(re.findall(r"\\[a-zA-Z]+|[a-zA-Z0-9]", form)) for form in plain)


def _joined(forms: list[str], meaning: str, labels: list[str]) -> tuple[str, str]:
    if len(forms) == 1:
        return forms[0], meaning
    if not labels:
        return r",\ ".join(forms), _plural(meaning)
    what = meaning.partition("see ")[0]
    named = forms if len(forms) <= FEW else [forms[0], r"\ldots", forms[-1]]
    where = " and ".join(labels) if len(labels) == 2 else f"{labels[0]}--{labels[-1]}"
    return r",\ ".join(named), f"{what}see {where}"


def _plural(meaning: str) -> str:
    """``branch signs``: what several symbols are, where one is a ``branch sign``."""
    return re.sub(r"^(task coordinate|branch sign|coordinate)\b", r"\1s", meaning)


__all__ = ["clashes", "joined", "matrix_of", "require_distinct", "table", "undefined"]
