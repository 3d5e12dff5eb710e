"""Numbered equations, and references to them.

Every displayed equation of a derivation gets a label, in the order in which it is printed.  LaTeX
counts them: an article has (7) where the book has (3.7).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from closedform.model.names import listed

COORDINATE = re.compile(r"([a-z])_\{(\d),[xyz]\}")
"""A coordinate of a vector that has a number, such as ``b_{1,x}``."""

GREEK_OR_LETTER = r"\\(?!text|mathrm|left|right|[bB]ig|quad|frac|sqrt)[A-Za-z]+|[A-Za-z]"
SCRIPT = r"[_^](?:\{(?:[^{}]|\{[^{}]*\})*\}|\\[A-Za-z]+|\w)|'"
NAME = re.compile(
    rf"\\(?:mathrm|mathit|mathbf|overrightarrow|dot|hat)(?:\{{[A-Za-z\\]+\}}| ?\w)(?:{SCRIPT})*"
    rf"|(?:{GREEK_OR_LETTER})(?:{SCRIPT})*"
)
"""A symbol in a formula, with what stands below and above it."""
POWER = re.compile(r"\^(?:\{-?\d+\}|\d|\{?T\}?|\{-1\})$")
COMMANDS = frozenset(
    [
        r"\det",
        r"\partial",
        r"\times",
        r"\cdot",
        r"\sin",
        r"\cos",
        r"\tan",
        r"\pi",
        r"\le",
        r"\ge",
        r"\ll",
        r"\to",
        r"\in",
        r"\operatorname",
    ]
)


Line = tuple[str, str]
"""What stands left and right of the sign; nothing on the left goes on from the line before."""


@dataclass(frozen=True)
class Numbered:
    """One line of a display, with the label of its equation if it is the last line of one."""

    left: str
    right: str
    label: str = ""
    numbered: bool = False

    @property
    def called(self) -> bool:
        """Whether the left side is what the formula is called: ``psi = 0:``."""
        return self.left.endswith(":")

    @property
    def text(self) -> str:
        sign = r"\quad" if self.called else "="
        return f"{self.left} {sign} {self.right}" if self.left else self.right


def runs(lines: Iterable[Line]) -> list[list[Line]]:
    """The lines of each equation."""
    found: list[list[Line]] = []
    for left, right in lines:
        if left or not found:
            found.append([])
        found[-1].append((left, right))
    return found


def parts_first(lines: Iterable[Line]) -> list[Line]:
    """The same equations, each after those that define what it contains.

    The entries of a matrix follow it, and so does what is defined by the equation itself.
    """
    found = runs(lines)
    names = [run[0][0].partition("=")[0].strip() for run in found]
    texts = [" ".join([r[0][0].partition("=")[2], *(right for _, right in r)]) for r in found]
    parts = {name: k for k, name in enumerate(names) if name and names.count(name) == 1}
    done: dict[int, None] = {}

    def add(k: int, above: frozenset[int]) -> None:
        if k in done or k in above:
            return
        for part, place in parts.items():
            is_part = _uses(part, texts[k]) and not (names[k] and _uses(names[k], texts[place]))
            if is_part and not _is_entry(part, names[k]):
                add(place, above | {k})
        done[k] = None

    for k in range(len(found)):
        add(k, frozenset())
    return [line for k in done for line in found[k]]


def _uses(name: str, text: str) -> bool:
    """Whether a name of a quantity stands in a formula, and not as a part of a longer name."""
    before = r"(?<!_)(?<!_\{)" + ("" if name.startswith("\\") else r"(?<![A-Za-z0-9\\])")
    return re.search(rf"{before}{re.escape(name)}(?![A-Za-z_{{'])", text) is not None


def _is_entry(name: str, matrix: str) -> bool:
    """Whether a name is that of an entry: ``v_{1}`` of ``v``, ``J_{b,12}`` of ``J_{b}``."""
    entry, whole = (re.sub("[{}]", "", n) for n in (name, matrix))
    return re.fullmatch(re.escape(whole) + r"[_,][1-9]\d*", entry) is not None


@dataclass
class Numbers:
    """The labels of the equations of one mechanism, and where each name is defined."""

    robot: str
    count: int = 0
    defined: dict[str, str] = field(default_factory=dict)
    """The label of the equation that defines a name, by the canonical form of the name."""
    values: dict[tuple[str, str], str] = field(default_factory=dict)
    lefts: dict[str, list[str]] = field(default_factory=dict)
    """The labels of the equations with a left-hand side, in canonical form."""
    right: dict[str, str] = field(default_factory=dict)
    """The label of the first equation with a right-hand side, in its canonical form."""

    def number(
        self, equations: Iterable[Sequence[Line]], *, defining: bool = True
    ) -> list[Numbered]:
        """Label equations, each at its last line; their left sides are what they define, or not."""
        return [line for run in equations for line in self._labelled(run, defining)]

    def is_shown(self, run: Sequence[Line]) -> str:
        """The label of this very equation if it stands in the document, or nothing."""
        return self.values.get(self._content(run), "")

    def with_right(self, right: str) -> str:
        """The label of the first equation with a right-hand side, or nothing."""
        return self.right.get(canonical(right), "")

    def of(self, left: str) -> str:
        """The label of the equation that defines a name, or has this left-hand side, or nothing."""
        name = canonical(left)
        return (self.defined.get(name) or self.lefts.get(name, [""])[0]) if name else ""

    def _content(self, run: Sequence[Line]) -> tuple[str, str]:
        return canonical(run[0][0]), canonical(" ".join(right for _, right in run))

    def _labelled(self, run: Sequence[Line], defining: bool) -> Iterator[Numbered]:
        self.count += 1
        label = f"eq:{self.robot}:{self.count}"
        content = self._content(run)
        self.values.setdefault(content, label)
        self.lefts.setdefault(content[0], []).append(label)
        left = run[0][0]
        if defining:
            self.right.setdefault(content[1], label)
        for part in left.split("=") if defining and not left.endswith(":") else []:
            if is_name(part.strip()):
                self.defined.setdefault(without_power(canonical(part)), label)
        for k, (left, right) in enumerate(run, 1):
            yield Numbered(left, right, label if k == len(run) else "", True)


def canonical(text: str) -> str:
    """A formula with braces around every script and no spaces: ``R_1`` is ``R_{1}``."""
    text = re.sub(r"(?<=[_^])(\\[A-Za-z]+|\w)", r"{\1}", text.strip())
    return re.sub(r"(\\(?:math[a-z]+|dot|hat)) (\w)", r"\1{\2}", text).replace(" ", "")


def without_power(name: str) -> str:
    """``r`` for ``r^2``."""
    return POWER.sub("", name)


def is_name(text: str) -> bool:
    """Whether a text is one symbol, or a power of one."""
    return NAME.fullmatch(text) is not None and text not in COMMANDS


def names_in(text: str) -> list[str]:
    """The symbols of a formula, in canonical form and without their powers."""
    plain = re.sub(r"(?<=\))_\{\\text\{[^{}]*\}\}", " ", text)  # the index of a whole expression
    plain = re.sub(r"(?<![,{])\\(?:text|operatorname)\{[^{}]*\}|\\(?:begin|end)\{\w+\}", " ", plain)
    found = (m[0] for m in NAME.finditer(plain))
    return [without_power(canonical(n)) for n in found if n not in COMMANDS]


def skeleton(name: str) -> str:
    """What remains of a name without its fonts and the heights of its parts."""
    return re.sub(r"\\(?:mathrm|mathit|mathbf)|[{}_^, ]", "", name)


def reference(labels: Iterable[str]) -> str:
    """``(3)``, ``(3) and (4)``, or ``(3)--(6) and (9)``: three or more neighbours are a range."""
    groups: list[list[str]] = []
    for label in sorted({*labels}, key=_place):
        if groups and _place(label) == _place(groups[-1][-1]) + 1:
            groups[-1].append(label)
        else:
            groups.append([label])
    marks = [[rf"\eqref{{{label}}}" for label in group] for group in groups]
    told = [[f"{m[0]}--{m[-1]}"] if len(m) > 2 else m for m in marks]
    return listed([text for texts in told for text in texts])


def defined_in(names: Sequence[str], labels: Iterable[str]) -> str:
    """Where symbols are defined: ``$a$ is that of (3)``, ``$a$ and $b$ are those of (3)``."""
    told, one = listed([f"${name}$" for name in names]), len(names) == 1
    found = [m for name in names if (m := COORDINATE.fullmatch(name))]
    if len(found) == len(names):
        vectors = dict.fromkeys(rf"$\mathbf {m[1]}_{m[2]}$" for m in found)
        what = "is a coordinate" if one else "are coordinates"
        return f"{told} {what} of {listed([*vectors])}, see {reference(labels)}"
    return f"{told} {'is that' if one else 'are those'} of {reference(labels)}"


def by_equation(labels: Mapping[str, str]) -> list[str]:
    """Names in the order of the equations that define them."""
    return sorted(labels, key=lambda name: _place(labels[name]))


def _place(label: str) -> int:
    """The number of an equation in its document."""
    return int(label.rpartition(":")[2])
