"""A function of a derivation as an algorithm: what a reader computes, line by line.

The statements of a program serve its proof and its rounding as well.  The algorithm is the same
function without them: each special case stands in a table of its own, names that are words give way
to what they stand for or to a letter, and what the branches share is computed before they part.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from typing import Any

import sympy as sp

from closedform.algebra.operations import operations
from closedform.emit.backends.latex.formulas import FITS, measure
from closedform.emit.backends.latex.inequalities import equality, inequalities
from closedform.emit.backends.latex.listing import Line, merged, parts_first, unless, whole
from closedform.emit.backends.latex.names import is_word, program_name
from closedform.emit.backends.latex.plain import (
    angle_of,
    divides_by_root,
    sums_of_angles,
    without_common_factors,
)
from closedform.emit.backends.latex.rotations import is_turned
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.backends.latex.subject import Subject
from closedform.emit.backends.latex.twins import twins
from closedform.emit.backends.latex.vectors import InVectors, is_vector, simplest_first
from closedform.emit.backends.latex.wide import Equation
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Let, Match, Require, Statement, Vanishes, real
from closedform.model.inverse import Rank
from closedform.model.lemma import label

INLINE = 10.0
"""The widest value that stands in place of a name that is a word."""
ONCE = 36.0
"""The same, for a name that occurs once."""
TWICE = 2
"""The root of a name that occurs no more often has none of its own."""
OFTEN = 5
"""A root that occurs more often has a name."""
INDENTED = 10.0
"""How much narrower the lines of an algorithm are than a page."""
LONGEST = 150
"""A value with more operations is written with names that the algorithm does not print."""
STATED = 3
"""A condition with more equations than that is given in words."""
FACTORS = "factors"
"""The result of ``singularities``."""
LETTERS = "kwgvjm"
"""Letters for quantities whose name is a word, the first that is free; q is all joints."""


Part = tuple[str, Any, str]
"""The kind of a line, its text and a remark."""


@dataclass
class Algorithm:
    """The algorithm of a function; ``means`` are names that are sines, cosines or lengths.

    ``model`` is the algorithm of an earlier function that starts with the same statements.
    """

    page: Sheet
    subject: Subject
    means: Mapping[sp.Symbol, sp.Expr]
    model: Algorithm | None = None
    letters: Mapping[sp.Symbol, str] = field(default_factory=dict)
    """Names that are written as the lemma that made them writes them."""
    replaced: Mapping[sp.Basic, sp.Basic] = field(default_factory=dict)
    """What stands in the function for other names of its program."""
    chosen: Mapping[sp.Symbol, Sequence[sp.Symbol]] = field(default_factory=dict)
    """For flags, the angles that are chosen there by other formulas, which are not printed."""
    product: str = ""
    """A product of rotations that stands for the names that are its entries."""
    vectors: InVectors | None = None
    """The vectors that stand for coordinates."""
    known: dict[sp.Basic, sp.Basic] = field(default_factory=dict)
    """What is printed in place of a name."""
    names: dict[sp.Symbol, str] = field(default_factory=dict)
    printed: set[sp.Symbol] = field(default_factory=set)
    quantities: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    """Values of printed names, which later formulas do not repeat."""
    pairs: dict[sp.Expr, sp.Expr] = field(default_factory=dict)
    """Values that are the sine or the cosine of an angle."""
    found: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    borrowed: set[str] = field(default_factory=set)
    """Names that steps of the derivation define, and no line."""

    def __post_init__(self) -> None:
        self.function, self.inverse = self.subject.function, self.subject.inverse
        body = self.function.body
        self.flags = {s.symbol: s for s in body if isinstance(s, Vanishes)}
        flags: dict[sp.Basic, Any] = dict.fromkeys(self.flags, sp.false)
        self.usual = {**flags, **{n: substitute(e, flags) for n, e in self.replaced.items()}}
        self.values = {s.symbol: self._generic(s.value) for s in body if isinstance(s, Let | Bound)}
        links = self.inverse.links if self.inverse else ()
        self.unknowns = {u for link in links for u in link.unknowns}
        self.unknowns |= {u for lemma in self.subject.lemmas for u in lemma.solution}
        outputs = (self._generic(e) for a in self.function.outputs for e in a.entries)
        self.outputs = [without_common_factors(e) if e.has(sp.atan2) else e for e in outputs]
        self.signs = tuple(dict.fromkeys(s for _, c in self.function.cases() for s in c))
        self.needed = self._needed()
        lemmas = [k.lemma for k in links if k.lemma]
        self.twins = twins(lemmas, self.values, self.flags) if not self.subject.each else None
        self.letters = {**self.letters, **(self.twins.letters if self.twins else {})}
        if self.vectors:
            self.names |= self.vectors.letters
        self.uses = self._uses()
        if self.model:
            self.known |= self.model.known
            self.known |= {n: e for n, e in self.model.replaced.items() if n in self.values}
            self.names |= self.model.names
            self.printed |= self.model.printed
        unneeded = self.letters.keys() & self.values.keys() - self.needed
        self.names |= {s: self.letters[s] for s in unneeded}
        self.page.printer.rename(self.names)
        self.means = {**self.means, **self._pairs()}
        for symbol in self.values:
            if symbol in self.needed and symbol not in self.printed and symbol not in self.known:
                self._name(symbol)
        self.page.printer.rename(self.names)
        if self.twins:
            names = {*self.values, *self.page.symbols} - self.twins.symbols.keys()
            self.twins = self.twins.beside(map(self.page.math, names))

    # What is needed, and its names

    def _generic(self, value: sp.Expr) -> sp.Expr:
        result: sp.Expr = substitute(value, self.usual)
        return result

    def _needed(self) -> set[sp.Symbol]:
        """The names that the answers and the conditions of existence depend on."""
        needed: set[Any] = {s for e in self.outputs for s in e.free_symbols}
        needed |= self.vectors.values.keys() if self.vectors else set()
        told = self.model.replaced if self.model else {}
        for statement in reversed(self.function.body):
            if isinstance(statement, Match):
                needed |= self._generic(statement.value).free_symbols
            elif isinstance(statement, Bound) or (
                isinstance(statement, Let) and statement.symbol in needed
            ):
                needed |= told.get(statement.symbol, self.values[statement.symbol]).free_symbols
        return needed

    def _uses(self) -> dict[sp.Basic, int]:
        bounds = {s.symbol for s in self.function.body if isinstance(s, Bound)}
        held = [self.values[s] for s in self.values if s in self.needed | bounds] + self.outputs
        uses = Counter[sp.Basic]()
        for value in held:
            uses.update(s for s in sp.preorder_traversal(value) if s.is_Symbol)
        return uses

    def _pairs(self) -> dict[sp.Symbol, sp.Expr]:
        """Names that lemmas of a chain gave to a sine and a cosine, see ``Pair.known_as``."""
        inverse = self.inverse
        if inverse is None or not isinstance(inverse.glue, Rank):
            return {}
        names = {str(s.name): s for s in self.values if s in self.needed}
        joints = {label(j): j for j in inverse.unknowns}
        letters = iter([g for g in self.page.free_angles if real(g) not in self.values])
        found: dict[sp.Symbol, sp.Expr] = {}
        for name, sine in names.items():
            cosine = names.get(f"c{name[1:]}")
            known = isinstance(self.means.get(sine), sp.sin | sp.cos)
            if name[0] != "s" or cosine is None or known:
                continue
            angle = joints.get(name[1:]) or real(next(letters))
            found |= {sine: sp.sin(angle), cosine: sp.cos(angle)}
        return found

    def _name(self, symbol: sp.Symbol) -> None:
        """Decide what is printed for a name: its meaning, its value, or a letter."""
        if symbol in self.unknowns or is_vector(symbol):
            return
        meaning = self.means.get(symbol)
        value = self.value(symbol)
        if isinstance(meaning, sp.sin | sp.cos):
            self.known[symbol] = meaning
            self.pairs[self.values[symbol]] = meaning
            return
        if isinstance(meaning, sp.Symbol):  # an entry of the matrix that the lemma finds
            self.names[symbol] = self.page.math(meaning)
            self.page.printer.rename(self.names)
            return
        bare = value.as_coeff_Mul()[1]
        name = str(symbol.name)
        joints = {label(j.symbol) for j in self.page.derivation.joints}
        # an italic s_1 or c_1 beside the sine and the cosine of the joint would be read as these
        letter = self._free_letter(symbol)
        word = is_word(name) or (name[0] in "sc" and name[1:] in joints)
        own = name in self.page.derivation.written and self.uses.get(symbol, 0) > 1
        word = word and not letter and not own
        width = self.page.lines.width(value)
        once = self.uses.get(symbol, 0) <= 1 and width <= ONCE
        is_root = bare.is_Pow and bare.exp == sp.S.Half
        uses = self.uses.get(symbol, 0)
        often = is_root and uses > OFTEN
        inline = word and not often and (width <= INLINE or once) and not value.has(sp.Piecewise)
        if (
            (bare.is_Atom and not is_vector(bare))
            or inline
            or (is_root and bare.base.is_Symbol and uses <= TWICE)
        ):
            self.known[symbol] = value
            return
        if value.is_Add or value.is_Pow:
            self.quantities[value] = symbol
        if value.is_Pow and value.exp == sp.S.Half:
            self.quantities[1 / value] = 1 / symbol
        if letter:
            self.names[symbol] = letter
        elif word:
            self.names[symbol] = f"{self._letter}_{{{self._count() + 1}}}"
        elif shown := program_name(symbol, value) or self._shortened(symbol):
            self.names[symbol] = shown
        self.page.printer.rename(self.names)

    def _free_letter(self, symbol: sp.Symbol) -> str:
        """What a step calls it, or the letter of the lemma unless something else is written so."""
        known = {**self.page.quantities.narrow, **self.page.quantities.known}.items()
        if stated := next((n for n, (e, _) in known if e == self.value(symbol)), ""):
            return stated
        letter = self.letters.get(symbol, "")
        other = self.page.symbols - {symbol}
        base = letter.partition("_{")[0]
        if sum(n.partition("_{")[0] == base for n in self.letters.values()) == 1:
            letter = base  # one leg needs no index
        return "" if letter in {*self.names.values(), *map(self.page.math, other)} else letter

    @cached_property
    def _letter(self) -> str:
        words = {str(s) for s in self.values}
        taken = {n[:1] for n in self.page.prose.names if not is_word(n) or n not in words}
        return next((c for c in LETTERS if c not in taken), LETTERS[0])

    def _count(self) -> int:
        return sum(n.startswith(f"{self._letter}_") for n in self.names.values())

    def _shortened(self, symbol: sp.Symbol) -> str | None:
        """A letter without its index, if the function has no other name with this letter."""
        base, _, index = str(symbol.name).partition("_")
        others = [str(s) for s in self.values if s != symbol and s in self.needed]
        others += [str(s) for s in self.page.symbols if s not in self.values]
        others = [n for n in others if not is_word(n)]
        if index and len(base) == 1 and not any(n[:1] == base for n in others):
            return base
        return None

    def value(self, symbol: sp.Symbol) -> sp.Expr:
        """The value of a name in what is printed before it."""
        if symbol not in self.found:
            self.found[symbol] = self.shown(self.values[symbol])
        return self.found[symbol]

    def shown(self, value: Any) -> Any:
        """An expression in the names that are printed."""
        value = self._generic(value)
        if not isinstance(value, sp.MatrixBase):
            value = value.xreplace(self.pairs)
        value = substitute(value, self.known)
        if not isinstance(value, sp.Expr):
            return value
        # a step may have named what sums of angles make of it
        named = self.in_names_of_steps(self.short(self.in_names_of_steps(value)))
        if not self.function.has_status:
            self.borrowed |= self.page.quantities.in_value(named)
        return named

    def in_names_of_steps(self, value: sp.Expr) -> sp.Expr:
        """A value of the joints in names that the steps of the derivation have defined."""
        if self.function.has_status:
            return value
        own = {str(s): s for s in value.free_symbols}
        named = self.page.quantities.of_a_function(value, (), own)
        if named.is_Symbol and value in self.values.values():
            return value  # which has a name in the algorithm
        return named

    def short(self, value: sp.Expr) -> sp.Expr:
        """The same with the names of quantities that occur in it; signs have the square 1."""
        powers = {p: p.base ** (p.exp % 2) for p in value.atoms(sp.Pow) if p.base in self.signs}
        value = value.xreplace({p: e for p, e in powers.items() if p.exp.is_Integer})
        value = self._without_detours(value.xreplace(sums_of_angles(value)))
        value = self.page.lines.tidy(value)
        value = value.xreplace({e: s for e, s in self.quantities.items() if e != value})
        return self._without_norms(value)

    def _without_norms(self, value: sp.Expr) -> sp.Expr:
        """The same without a length below both arguments of an arctangent."""
        roots = {s: e.base for e, s in self.quantities.items() if e.is_Pow and s.is_Symbol}
        squares = {
            total: root
            for total in value.atoms(sp.Add)
            for root in total.free_symbols & roots.keys()
            if total.free_symbols == {root, *roots[root].free_symbols}  # expanding takes long
            and sp.expand(total * root - roots[root]) == 0
        }
        value = value.xreplace(squares)
        found = {}
        for angle in value.atoms(sp.atan2):
            y, x = angle.args
            if isinstance(y, sp.sin) and isinstance(x, sp.cos) and y.args == x.args:
                found[angle] = y.args[0]
                continue
            sides = [sp.Mul.make_args(sp.together(side)) for side in angle.args]
            shared = [p for p in sides[0] if p in sides[1] and divides_by_root(p, roots)]
            if shared:
                found[angle] = sp.atan2(
                    *(sp.Mul(*s) / sp.Mul(*shared) for s in sides), evaluate=False
                )
        return value.xreplace(found)

    def _without_detours(self, value: sp.Expr) -> sp.Expr:
        """A sum without a name that stands beside the same terms with the other sign."""
        if not value.is_Add:
            return value
        for term in value.args:
            factor, name = term.as_coeff_Mul()
            other = value - term + factor * self.found.get(name, name)
            if other != 0 and len(sp.Add.make_args(other)) < len(value.args):
                value = other
        return value

    def full(self, value: Any) -> Any:
        """The same, with names that are not printed replaced by their values if they are short."""
        whole = value
        for _ in range(len(self.values)):
            whole = substitute(self._generic(whole), self.known)
            hidden = whole.free_symbols & self.values.keys() - self.needed - self.printed
            hidden -= self.unknowns
            if not hidden:
                break
            whole = substitute(whole, {s: self.values[s] for s in hidden})
            if operations(whole) > LONGEST:
                return self.shown(value)
        return self.short(whole) if isinstance(whole, sp.Expr) else whole

    # Lines

    def lines(self) -> list[Line]:
        """What is computed, with the conditions; first what all branches share."""
        self.page.lines.clear()
        self.page.lines.line_width = FITS - INDENTED
        branched: set[sp.Basic] = set(self.signs)
        common, each, once = list[Part](), list[Part](), list[Part]()
        none: frozenset[sp.Symbol] = frozenset()
        alike, second = (self.twins.alike, self.twins.second) if self.twins else (none, none)
        told = self.model.function.body if self.model else ()
        for statement in self.function.body:
            symbol = getattr(statement, "symbol", None)
            if symbol in second:  # told with those of the first part
                self.printed.add(symbol)
                if not second & self._made_after(statement):
                    each.append(("twins", once, ""))
                continue
            with self.as_one(symbol in alike):
                parts = list(self._statement(statement))
            if statement in told:  # with its conditions
                parts = [part for part in parts if part[0] == "let"]
            if not parts and symbol in self.values.keys() - self.needed:
                continue  # nothing that is printed depends on it
            used = {s for e in self._expressions(statement) for s in e.free_symbols}
            if isinstance(statement, Let | Bound) and used & branched:
                branched.add(statement.symbol)
                if self.is_pair(statement.symbol):  # the angle has the branches of its sine
                    branched |= self.means[statement.symbol].free_symbols
                if self.model and statement.symbol in self.model.replaced:
                    branched |= self.model.replaced[statement.symbol].free_symbols
            (once if symbol in alike else each if used & branched else common).extend(parts)
        kind = "return" if sp.true in self.outputs else "let"
        answer = [(kind, text, "") for text in self._answers()]
        self.page.lines.line_width = FITS
        if not self.subject.each:
            return self._over_branches(common, [*each, *answer], 0)
        last = answer if kind == "return" else []  # which is not that of a leg
        rest = [*each, *(part for part in answer if part not in last)]
        head = Line(rf"\textbf{{for}} {self.subject.each}:")
        return [head, *self._over_branches(common, rest, 1), *self.joined(last, 0)]

    def _over_branches(
        self, common: Sequence[Part], each: Sequence[Part], depth: int
    ) -> list[Line]:
        """Lines that all branches share, and those of each."""
        several = self.function.branches is not None and len(self.function.branches) > 1
        if not several or not each:
            return self.joined([*common, *each], depth)
        head = Line(rf"\textbf{{for each}} {self._choice()}:", depth)
        return [*self.joined(common, depth), head, *self.joined(each, depth + 1)]

    def _choice(self) -> str:
        names = [self.page.math(s) for s in self.signs]
        if len(names) == 1:
            return rf"${names[0]} = \pm 1$"
        listed = r",\ ".join(names)
        return rf"$({listed}) \in \{{-1, +1\}}^{{{len(names)}}}$"

    def _expressions(self, statement: Statement) -> Iterable[sp.Expr]:
        if isinstance(statement, Let | Bound):
            return [self.value(statement.symbol)]
        return statement.values if isinstance(statement, Require) else [self.shown(statement.value)]

    def _statement(self, statement: Statement) -> Iterable[tuple[str, str, str]]:
        """The kind of each line, its text and a remark."""
        if isinstance(statement, Let | Bound):
            symbol = statement.symbol
            if is_turned(symbol) or is_vector(symbol):
                yield from self._whole(symbol)
                return
            fresh = symbol in self.needed and symbol not in self.printed
            if fresh and (symbol not in self.known or self.is_pair(symbol)):
                self.printed.add(symbol)
                left, value = self._equation(symbol)
                if self.page.math(left) != self.page.math(value):
                    yield from (("let", text, "") for text in self.texts(left, value))
            if isinstance(statement, Bound):
                yield "bound", symbol, self.page.prose(statement.meaning)
        elif isinstance(statement, Match):
            value = self.full(statement.value)
            if value != 0:  # what is compared only in a special case
                meaning = self.page.prose(statement.meaning)
                yield "unless", equality(self.page, value), meaning
        elif isinstance(statement, Require):
            yield "invalid", self._requirement(statement), ""

    def _equation(self, symbol: sp.Symbol) -> tuple[sp.Basic, sp.Expr]:
        """Both sides for a name; a sine of an angle that the model leaves out has the angle."""
        angle, names = angle_of(symbol, self.model.replaced if self.model else {})
        if not self.model or angle not in self.model.values.keys() - self.printed:
            return self.known.get(symbol, symbol), self.value(symbol)
        self.printed |= {angle, *names}
        return angle, self.model.full(self.model.values[angle])

    def _vector(self, symbol: sp.Symbol, value: Any) -> str:
        """A vector in others, or in its coordinates."""
        self.printed.add(symbol)
        if isinstance(value, tuple):
            text = r",\ ".join(self.page.math(self.shown(e)) for e in value)
            text = f"({text})"
        else:
            terms = sorted(sp.Add.make_args(self.shown(value)), key=simplest_first)
            texts = [self.page.math(t) for t in terms]
            signed = [t if t.startswith("-") else f"+ {t}" for t in texts[1:]]
            text = " ".join([texts[0], *signed])
        return rf"$\displaystyle {self.page.math(symbol)} = {text}$"

    def _whole(self, symbol: sp.Symbol) -> Iterable[Part]:
        """A vector, or the product of rotations, which is stated at its first entry."""
        if self.vectors and is_vector(symbol):
            yield "let", self._vector(symbol, self.vectors.values[symbol]), ""
        elif not any(map(is_turned, self.printed)):
            yield "let", rf"$\displaystyle {self.product}$", ""
        self.printed.add(symbol)

    def _requirement(self, statement: Require) -> str:
        if len(statement.values) > STATED:
            return f"the input is {self.page.prose(statement.meaning)}"
        texts = []
        for value in statement.values:
            flag = value.args[0][1] if isinstance(value, sp.Piecewise) else None
            if flag in self.flags:
                texts.append(rf"${self.page.math(self.full(self.flags[flag].value))} \ne 0$")
            elif isinstance(value, sp.Piecewise) and value.args[0][0] == 0:
                texts.append(self.page.printer.condition(self._condition(value.args[0][1])))
            else:
                texts.append(f"${self.page.math(self.full(value))} = 0$")
        return f"{', '.join(texts)} ({self.page.prose(statement.meaning)})"

    def is_pair(self, symbol: sp.Symbol) -> bool:
        """Whether a name is the sine or the cosine of an angle."""
        return isinstance(self.means.get(symbol), sp.sin | sp.cos)

    def _condition(self, condition: Any) -> Any:
        if isinstance(condition, sp.core.relational.Rel):
            return condition.func(*map(self.full, condition.args), evaluate=False)
        return (
            condition.func(*map(self._condition, condition.args)) if condition.args else condition
        )

    def conditions(self, bounds: Sequence[sp.Symbol]) -> list[str]:
        """The conditions that bounds are not negative."""
        return self.inequalities([v for s in bounds for v in self.bounded(s)])

    def bounded(self, symbol: sp.Symbol) -> Sequence[sp.Expr]:
        """What must not be negative: of the least of several values, each of them."""
        value = self._generic(self.values[symbol])
        value = self._generic(self.values.get(value, value))
        if isinstance(value, sp.Min):
            return [self.bound(v) if v in self.values else self.full(v) for v in value.args]
        return [self.bound(symbol)]

    def inequalities(self, values: Sequence[sp.Expr]) -> list[str]:
        """The conditions that values are not negative, those about one name as a chain."""
        bounds = {s.symbol for s in self.function.body if isinstance(s, Bound)}
        open_ = [v for v in values if v in bounds or not v.is_nonnegative]
        return inequalities(self.page, {s: k for k, s in enumerate(self.values)}, open_)

    def bound(self, symbol: sp.Symbol) -> sp.Expr:
        """What must not be negative: a short value, or the name of a longer one."""
        value = self.full(self.values[symbol])
        short = self.page.lines.width(value) <= ONCE and not value.has(sp.Piecewise)
        if not short and symbol in self.printed and symbol not in self.known:
            return symbol
        return value

    def texts(self, left: Any, value: Any) -> list[str]:
        """Equations as formulas in the text, each in one piece."""
        return self.parts_first(self.page.equations(left, value))

    def parts_first(self, equations: Sequence[Equation]) -> list[str]:
        """Equations as formulas in the text, the parts of wide ones first."""
        names = [self.page.math(s) for s in self.page.lines.parts.values()]
        return parts_first(names, whole(equations))

    def _answers(self) -> list[str]:
        entries = iter(self.outputs)
        rows = []
        if self.vectors:
            return [self._vector(self.vectors.named, self.vectors.result)]
        for array in self.function.outputs:
            shown = [self.shown(next(entries)) for _ in range(array.size)]
            if shown == [sp.true]:
                rows.append(r"\textbf{return} true")
                continue
            if array.name == FACTORS:  # the section on the singular set lists them
                continue
            rows += self.parts_first(self.page.array(array, shown, self.function.entries))
        return rows

    def joined(self, lines: Sequence[Part], depth: int) -> list[Line]:
        """Lines of the page: short equations share one, and so do neighbouring conditions."""
        done: list[Line] = []
        stated: set[sp.Expr] = set()
        for bounds, group in groupby(merged(lines), lambda line: line[0] == "bound"):
            if bounds:
                found = list(group)
                values = dict.fromkeys(v for _, symbol, _ in found for v in self.bounded(symbol))
                text = ", ".join(self.inequalities([v for v in values if v not in stated]))
                stated |= values.keys()
                remarks = dict.fromkeys(remark for *_, remark in found)
                remark = "; ".join(remarks) if len(remarks) == 1 else ""
                if text:
                    done.append(Line(unless(text, self.otherwise("unreachable")), depth, remark))
                continue
            for kind, text, remark in group:
                if kind == "twins" and self.twins:
                    done.append(Line(rf"\textbf{{for each}} {self.twins.each}:", depth))
                    with self.as_one():
                        done += self.joined(text, depth + 1)
                    continue
                if kind == "return":
                    done.append(Line(text, depth))
                    continue
                wide = measure(done[-1].text + text) > FITS - 14 - 2 * depth if done else True
                wide |= bool(done) and done[-1].depth != depth
                if kind == "let" and done and done[-1].kind == "let" and not wide:
                    done[-1] = Line(rf"{done[-1].text},\quad {text}", depth, "", "let")
                elif kind == "let":
                    done.append(Line(text, depth, "", "let"))
                else:
                    done.append(Line(unless(text, self.otherwise(STATUS[kind])), depth, remark))
        return done

    def as_one(self, holds: bool = True) -> AbstractContextManager[None]:
        """Print what is told once of twins with the index of any of them."""
        return self.twins.as_one(self.page.printer) if self.twins and holds else nullcontext()

    def as_two(self, holds: bool = True) -> AbstractContextManager[None]:
        """Print what differs in twins with the index of each."""
        letters = self.twins.letters if self.twins and holds else {}
        names = {s: self.names[s] for s in letters if s in self.names}
        return self.page.printer.written_as(names) if names else nullcontext()

    def _made_after(self, statement: Statement) -> set[Any]:
        """The names that statements after this one define."""
        body = self.function.body
        return {getattr(s, "symbol", None) for s in body[body.index(statement) + 1 :]}

    def otherwise(self, status: str) -> str:
        """What a function answers where a condition fails: a status, no number, or no."""
        if self.function.has_status:
            return rf"\textsc{{{status}}}"
        return r"\textbf{return} false" if sp.true in self.outputs else "NaN"


STATUS = {"unless": "unreachable", "invalid": "invalid"}

__all__ = ["ONCE", "Algorithm"]
