"""Names of symbols, and sentences with formulas in them, as LaTeX."""

from __future__ import annotations

import re

import sympy as sp

from closedform.emit.backends.latex.called import GREEK, called
from closedform.emit.text import BOLD_LETTERS
from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Let
from closedform.model.step import Step
from closedform.spelling import MORE

SYMBOL_NAMES = {"det": r"\det", "lamda": r"\lambda", "loff": r"l_{\mathrm{off}}"}
"""Symbols that the rule of :func:`symbol_name` would misread."""

ESCAPES = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    **{c: "\\" + c for c in "&%$#_{}"},
    **{c: f"${c}$" for c in "<>|"},
    "–": "--",
    "«": r"$\ll$",
    "»": r"$\gg$",
    "—": "---",
    "‘": "`",
    "’": "'",
    "“": "``",
    "”": "''",
    "…": r"\dots{}",
}
UNICODE = {
    "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta", "ε": r"\epsilon", "η": r"\eta",
    "θ": r"\theta", "κ": r"\kappa", "λ": r"\lambda", "μ": r"\mu", "µ": r"\mu", "ξ": r"\xi",
    "π": r"\pi", "ρ": r"\rho", "σ": r"\sigma", "τ": r"\tau", "φ": r"\varphi", "ϕ": r"\phi",
    "ψ": r"\psi", "ω": r"\omega", "Δ": r"\Delta", "Ω": r"\Omega", "°": r"^\circ", "±": r"\pm",
    "×": r"\times", "·": r"\cdot", "≤": r"\le", "≥": r"\ge", "≠": r"\ne", "≈": r"\approx",
    "√": r"\surd", "∞": r"\infty", "∈": r"\in", "²": "^2", "³": "^3", "−": "-",
    **{bold: rf"\mathbf {letter}" for bold, letter in BOLD_LETTERS.items()},
}  # fmt: skip

IN_FORMULA = {
    "\\": r"\backslash{}",
    "~": r"\sim{}",
    "^": r"\hat{}",
    **{c: "\\" + c for c in "&%$#_{}"},
    **{c: rf"{formula}{{}}" for c, formula in UNICODE.items()},
}
"""Characters with a meaning in TeX, for formulas in sentences that are not translated."""

FUNCTIONS = r"(?:sqrt|sin|cos|tan|atan2|acos|asin|atan|det|max|min|Abs)"
PAREN = r"\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)"
NAME = r"(?:[A-Za-z][A-Za-z0-9_]*|[𝐀-𝐙])"
"""A symbol; a matrix that has the letter of a point is bold."""
NUMBER = r"\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![A-Za-z])"
POWER = rf"(?:\*\*|\^)(?:\{{[^}}]*\}}|-?\w+|{PAREN})"
BALL = r"\[[^]]*\+/-[^]]*\]"
ATOM = rf"[-+]?(?:{FUNCTIONS}{PAREN}|{NAME}|{NUMBER}|{PAREN}|\|[^|]+\||{BALL})(?:{POWER})?"
RELATION = r"(?:\s*(?:<=|>=|!=|=|[*/×])\s*|\s+[-+<>]\s+)"
PROSE = re.compile(rf"(?<![\w'’-])({ATOM}(?:{RELATION}{ATOM})*)(?!-?\w)")
TOKEN = re.compile(
    rf"({FUNCTIONS})({PAREN})|(?:\*\*|\^)({PAREN}|\{{[^}}]*\}}|-?\w+)|({NUMBER})|({NAME})"
    r"|(\+/-|<=|>=|!=|[*<>×])|(.)"
)
SIGNS = {"+/-": r"\pm ", "<=": r"\le ", ">=": r"\ge ", "!=": r"\ne ", "*": r"\,", "×": r"\times "}
ENGLISH = re.compile(rf"(?!(?:{'|'.join(sorted(GREEK))})$)[a-z]{{3,}}")
"""The name of a symbol that is a word of a sentence."""
GREEK_NAME = re.compile(rf"(?:{'|'.join(sorted(GREEK))})\d*(?:_\w+)?")
PRODUCT = re.compile(r"(?<=[^\s$])\$ \$(?=[^\s$])(?!\([^$]*=)")
"""Between two formulas that are factors, and not before a remark such as (h = 0)."""
WORD = r"\\mathrm\{[A-Za-z]{2,}\}(?:_\{(?:[^{}]|\{[^{}]*\})*\})?"
"""A symbol that is a word; as a factor it needs a space."""
ARTICLE = re.compile(r"\s+(?!(?:of|is|and|has|to|vanishes)\b)[a-z]")
"""What follows an article at the start of a sentence, and not the matrix A."""
LETTER = re.compile(r"\s+(?:of|is|are|and|or|at|has|to|for|turns|moves|vanishes)\b|[,.;:)]|$")
"""What follows the symbol a, and not the article."""
STATUS = re.compile(r"\b(?:OK|UNREACHABLE|SINGULAR|INVALID|BRANCHES)\b")
INDEXED = re.compile(
    r"(?<![A-Za-z0-9_\\])(\d?[A-Za-zα-ωϕ]|\([a-z](?:, [a-z])+\))_(\{\^?\w+\}|\d+|[a-z])"
    r"(?![A-Za-z0-9_])"
)
"""A letter with an index, or several in parentheses with one, in a quotation."""
RAISED = re.compile(r"(?<![A-Za-z0-9_\\])([A-Za-zα-ωϕ])\^(\w)(?!\w)")
"""A letter with an exponent, in a quotation."""
TUPLE = re.compile(r"(\([a-z](?:, [a-z])+\))_([A-Z])(?!\w)")
"""Coordinates with one index, as in ``(x, y, z)_R``."""
EMPHASIS = re.compile(r"(?<![\w*])\*(\w[\w ]*)\*(?![\w*])")
"""Words that a quotation sets in italics."""
CODE = re.compile(r"[a-z]{2,}(?:_[a-z]{2,})+")
"""A name of the code in a sentence."""
DIFFERENTIAL = re.compile("d([pqx])")
"""The rate of a target or of the joints."""
CROSS = r"\[\w\]_×"
CROSSED = r"[{}]_\times"
"""The matrix of the cross product with a vector."""
BOLD = re.compile(r"\\mathbf ?\{?([a-z])(?![A-Za-z])")
"""A vector in a formula."""
POINT = re.compile(r"\\mathbf ?\{?([A-Z])\}?_\{?(\d)\}?")
"""A point of a drawing, as in ``\\mathbf B_1``."""
INDEX_WORD = re.compile(r"_\{((?=[a-z]*[aeio])[a-z]{3,})\}")
"""An index that is a word, as in ``l_{off}``, and not several letters, as in ``P_{xyz}``."""
VARIABLE = r"\\(?:mathrm|mathit|sigma|theta|alpha|beta|psi|kappa|sqrt|frac|sin|cos)\b"


def symbol_name(name: str) -> str:
    """The LaTeX of a symbol: px is ``p_{x}``, theta2R ``\\theta_{2\\mathrm{R}}``."""
    if name in SYMBOL_NAMES:
        return SYMBOL_NAMES[name]
    if not re.fullmatch(r"[A-Za-z0-9]\w*", name.replace("dot", ""), re.ASCII):
        return rf"\text{{{escape(name)}}}"
    dotted, name = "dot" in name, name.replace("_dot", "").replace("dot", "")
    first, *subscripts = name.split("_")
    letters, rest = (re.match(r"([A-Za-z]+)(.*)", first) or re.match("(.)(.*)", first)).groups()  # type: ignore[union-attr]
    if letters in GREEK:
        base = r"\lambda" if letters == "lamda" else rf"\{letters}"
    elif len(letters) == 2 and letters.isupper():
        base = rf"\mathit{{{letters}}}"
    elif len(letters) <= 2:
        base, rest = letters[0], letters[1:] + rest
    else:
        base = rf"\mathrm{{{letters}}}"
    base = rf"\dot{{{base}}}" if dotted else base
    parts = [_subscript(s) for s in ([rest] if rest else []) + [s for s in subscripts if s]]
    return f"{base}_{{{','.join(parts)}}}" if parts else base


def written_name(derivation: Derivation, name: str) -> str:
    """The LaTeX of a symbol in a derivation, which may have said how to write it."""
    written = derivation.written.get(name)
    if written and written.latex:
        return written.latex
    return symbol_name(called(derivation)(name))


def _subscript(text: str) -> str:
    if re.fullmatch(r"\d*[a-z]?|[i-n]{1,2}\d", text):  # r_i1 is entry 1 of r_i
        return text
    if number := re.fullmatch(r"(\d+)([A-Za-z]+)", text):
        return rf"{number[1]}\mathrm{{{number[2]}}}"
    if (head := re.match("[A-Za-z]+", text)) and (head[0] in GREEK or re.search(r"\d", text)):
        return symbol_name(text)
    return rf"\mathrm{{{text}}}"


def escape(text: str) -> str:
    """Plain text; mathematical characters that are missing in LaTeX's fonts become formulas."""
    text = re.sub(r'"([^"]*)"', "“\\1”", text)
    text = re.sub(r"(?<![\w.])(\d)x(\d)(?!\w)", "\\1×\\2", text)
    parts = re.split(r"([α-ωϕ])(\d+)", text)
    for i, part in enumerate(parts):
        plain = (ESCAPES.get(c) or (f"${UNICODE[c]}$" if c in UNICODE else c) for c in part)
        parts[i] = (
            f"${UNICODE[part]}" if i % 3 == 1 else f"_{{{part}}}$" if i % 3 else "".join(plain)
        )
    return "".join(parts)


def mixed(text: str, *, led: bool = False) -> str:
    """Text with formulas between dollar signs; a matrix or a wide fraction shrinks to fit.

    Formulas of several lines start on a new one, also if words that are not here lead to them.
    """
    parts = text.split("$")
    for i, part in enumerate(parts):
        formula = "".join(f"{UNICODE.get(c, c)} " if c in UNICODE else c for c in part)
        stiff = _widest_fraction(part) > STIFF
        if part.count(r"\begin") == 1 and re.fullmatch(
            r"\\begin\{(\w*matrix)\}.*\\end\{\1\}", part
        ):
            stiff = True
        formula = INDEX_WORD.sub(r"_{\\mathrm{\1}}", formula)
        formula = ROWS.sub(_roomy, formula if stiff else loosen(formula))
        formula = formula if stiff else breakable(formula)
        formula = rf"$\displaystyle {formula}$"
        formula = rf"\fit{{{formula}}}" if stiff else formula
        if r"\begin{aligned}" in part and (led or parts[i - 1].strip()):
            formula = rf"\newline {formula}"
        parts[i] = formula if i % 2 else quoted(part)
    return "".join(parts)


PIECE = re.compile(
    r"(?P<group>\\begin\{\w+\}|\\left\W|\{)|(?P<end>\\end\{\w+\}|\\right\W|\})"
    r"|(?P<bracket>[(\[])|(?P<closed>[)\]])|(?P<comma>,\s?\\ )|(?P<sign>(?<= )[-+] )|\\.|.",
    re.DOTALL,
)
"""The parts of a formula that say where TeX may break it; it never breaks a group."""


SIGNED = ("+ ", "- ")
LONG = 60
"""Brackets with more characters may be broken."""


def breakable(formula: str) -> str:
    """A formula that TeX may break between its equations, but not in short brackets."""
    pieces = [(found.lastgroup, found[0]) for found in PIECE.finditer(formula)]
    groups, done = 0, list[str]()
    opened: list[int] = []
    for kind, piece in pieces:
        groups += (kind == "group") - (kind == "end")
        if kind == "bracket" and not groups:
            opened.append(len(done))
        elif kind == "closed" and not groups and opened:
            start = opened.pop()
            inside = done[start:]
            if len("".join(inside)) <= LONG:
                done[start:] = [p + r"\nobreak " if p in SIGNED else p for p in inside]
        elif kind == "comma" and not groups and not opened:
            piece = r",$ $\displaystyle "
        done.append(piece)
    return "".join(done)


def quoted(text: str) -> str:
    """Plain text in which ``theta_2``, a letter with an index, is a formula, and ``*a*`` italic."""
    parts = EMPHASIS.split(text)
    return "".join(
        rf"\emph{{{_indexed(part)}}}" if i % 2 else _indexed(part) for i, part in enumerate(parts)
    )


def _indexed(text: str) -> str:
    text = RAISED.sub(lambda m: f"{m[1]}_{{^{m[2]}}}", text)
    parts = INDEXED.split(TUPLE.sub(r"\1_{\2}", text))
    letters = [
        "".join(f"{UNICODE[c]} " if c in UNICODE else c for c in part.strip("{}")).strip()
        for part in parts
    ]
    return "".join(
        f"${_letter(letters[i], letters[i + 1])}$" if i % 3 else escape(part)
        for i, part in enumerate(parts)
        if i % 3 != 2
    )


def _letter(letter: str, index: str) -> str:
    """A letter with its index; ``0p`` has an index before it too, and ``^i`` is an exponent."""
    before = f"{{}}^{letter[0]}" if letter[0].isdigit() else ""
    letter = letter[1:] if before else letter
    return (
        f"{before}{letter}^{{{index[1:]}}}" if index[0] == "^" else f"{before}{letter}_{{{index}}}"
    )


ROWS = re.compile(r"\\begin\{(cases|aligned)\}.*?\\end\{\1\}", re.DOTALL)


def _roomy(found: re.Match[str]) -> str:
    """Rows of formulas, with some space between those that have fractions.

    The space of cases is measured from the base of a line, so that it contains the fraction.
    """
    rows, space = found[0], "15pt" if found[1] == "cases" else "6pt"
    return rows.replace(r"\\ ", rf"\\[{space}] ") if r"\frac" in rows else rows


STIFF = 36
"""The most letters of a fraction that fits into a column; TeX cannot break it."""


def _widest_fraction(formula: str) -> int:
    """The number of letters above or below the line of the widest fraction."""
    widest = 0
    for found in re.finditer(r"\\frac(?=\{)", formula):
        end = found.end()
        for _ in range(2):
            start, depth = end, 0
            while end < len(formula):
                depth += {"{": 1, "}": -1}.get(formula[end], 0)
                end += 1
                if depth == 0:
                    break
            inner = re.sub(r"\\(?:left|right|mathrm)|[\s{}^_]", "", formula[start:end])
            widest = max(widest, len(re.findall(r"\\[A-Za-z]+|.", inner)))
    return widest


class Prose:
    """The sentences of a derivation: ``theta1 = pi/6`` in the text becomes a formula."""

    def __init__(self, derivation: Derivation):
        functions = derivation.functions
        symbols = [p.symbol for p in derivation.parameters] + [j.symbol for j in derivation.joints]
        symbols += [s for f in functions for s in f.symbols]
        made = [s.symbol for f in functions for s in f.body if isinstance(s, (Let, Bound))]
        symbols += [s for s in made if not re.fullmatch("[a-z][a-w]", s.name)]  # "up" is a word
        symbols += [s for step in derivation.steps for s in symbols_of(step)]
        names = self.names = {str(s) for s in symbols} | set(derivation.task)
        self.derivation = derivation
        self.known = GREEK | set(SYMBOL_NAMES)
        # in a sentence, "elbow" and "wrist" are words, also where a symbol has this name
        self.known |= {n for n in derivation.written if not ENGLISH.fullmatch(n)}
        self.known |= {n for n in names - {"a", "A", "I"} if len(n) < 3 or MORE.search(n)}

        self.angles: dict[str, str] = {}
        """Angles of an inverse whose names are words, in LaTeX."""
        drawn = derivation.skeleton.points if derivation.skeleton else ()
        labels = [label for f in functions if f.branches for label in f.branches.labels]
        self.parts_of_branches = {part for label in labels for part in label.split("_")} - names
        """The words of the names of branches."""
        letters = {n for n in drawn if re.fullmatch("[A-Z]", n)}
        some = "".join(sorted(letters)) or "\0"  # a text has no NUL
        self.lines = re.compile(rf"[{some}]{{2,}}")
        """Lines and triangles through points that have letters: ``AC``, ``BDP``."""
        self.lettered = re.compile(rf"(?<![\w$\\{{^_-])[{some}]+(?![\w'}}])")
        """These and the points."""
        self.parts_of_branches -= {p for p in self.parts_of_branches if self.lines.fullmatch(p)}
        self.code = ({f.name for f in functions if f.has_status} | {"fk", "ik"}) - self.known
        shown = [left for step in derivation.steps for left, _ in step.shown]
        bold = set(BOLD.findall(" ".join(shown)))
        self.vectors = bold - names - {*shown}
        """The letters that are vectors wherever a sentence has them."""
        self.indexed = bold
        """The letters that are vectors where they have an index."""
        bold_too = any(POINT.fullmatch(left) for left in shown)
        self.points = {
            n: (rf"\mathbf{{{n[0]}}}" if bold_too else n[0]) + f"_{{{n[1:]}}}"
            for n in drawn
            if n not in names and re.fullmatch(r"[A-Z]\d[a-z]?", n)
        }
        """The points of the drawing, as the equations write them."""

    def __call__(self, text: str) -> str:
        words = "|".join(map(re.escape, self.angles))
        known = rf"(?<=the axis of )(?:{words})\b|{CROSS}" if words else CROSS
        if self.parts_of_branches:
            parts = "|".join(sorted(self.parts_of_branches))
            known += rf"|(?<![\w-])(?:{parts})(?=:| branches| \([A-Z] [<>]=)"
            known += rf"|(?<=\()(?:{parts})(?=[,)])"
            known += rf"|(?<=with )(?:{parts})\b"
        pieces = re.split(f"({known})", text)
        return "".join(
            self._known(piece) if i % 2 else self._sentences(piece)
            for i, piece in enumerate(pieces)
        )

    def with_points(self, text: str, *, first: bool = True) -> str:
        """Text with its points and lines as formulas between dollar signs.

        It begins a sentence if it is the ``first`` part of a text.
        """

        def written(found: re.Match[str]) -> str:
            before = text[: found.start()]
            begins = starts([before]) and bool(before or first)
            if found[0] == "A" and begins and ARTICLE.match(text[found.end() :]):
                return "A"
            return f"${found[0]}$" if len(found[0]) == 1 else rf"$\mathit{{{found[0]}}}$"

        return self.lettered.sub(written, text)

    def _known(self, piece: str) -> str:
        """An angle, the matrix of a cross product, or a part of the name of a branch."""
        if piece in self.parts_of_branches:
            return rf"\texttt{{{piece}}}"
        return f"${self.angles.get(piece) or CROSSED.format(piece[1])}$"

    def _sentences(self, text: str) -> str:
        parts = PROSE.split(text)
        for i, part in enumerate(parts):
            if i % 2 == 0:
                parts[i] = STATUS.sub(_status, escape(part))
            elif part == "A" and not (starts(parts[:i]) and ARTICLE.match("".join(parts[i + 1 :]))):
                parts[i] = "$A$"
            elif part == "a" and part in self.names and LETTER.match("".join(parts[i + 1 :])):
                parts[i] = "$a$"
            else:
                parts[i] = self._part(part)
        return PRODUCT.sub(r"\\,", "".join(parts))

    def _part(self, text: str) -> str:
        """A formula, or text; parentheses with words in them may contain formulas."""
        if text in self.points:
            return f"${self.points[text]}$"
        if self.lines.fullmatch(text):
            return rf"$\mathit{{{text}}}$"
        if not self._is_symbol(text) and (text in self.code or CODE.fullmatch(text)):
            return rf"\texttt{{{escape(text)}}}"
        if self._is_formula(text):
            return f"${self.formula(text)}$"
        if re.fullmatch(PAREN, text):
            return f"({self(text[1:-1])})"
        return STATUS.sub(_status, escape(text))

    def _is_symbol(self, name: str) -> bool:
        return name in self.known or bool(GREEK_NAME.fullmatch(name))

    def _is_formula(self, text: str) -> bool:
        if re.fullmatch(r"\d+(\.\d+)?e[+-]?\d+", text):
            return True
        names = re.findall(rf"(?<![\w.]){NAME}", text)
        words = [n for n in names if len(n) > 1 and n[1] != "_" and not self._is_symbol(n)]
        if re.fullmatch(PAREN, text) and any(not re.fullmatch(FUNCTIONS, n) for n in words):
            return False
        if re.search(rf"\b{FUNCTIONS}\(", text):
            return True
        related = bool(re.search(r"[=<>*^|]|\+/-| [-+] |\w/\w", text))
        if any(self._is_symbol(n) or re.fullmatch("[^aAI]|[A-Za-z]_.+", n) for n in names):
            return related or not text.startswith("(")
        return related and "=" in text if names else related or text[0] == "-"

    def formula(self, text: str) -> str:
        done = []
        for function, argument, power, number, name, sign, other in TOKEN.findall(text):
            if function:
                inner = self.formula(argument[1:-1])
                command = {"atan2": r"\operatorname{atan2}", "Abs": r"\operatorname{abs}"}
                head = command.get(function, "\\" + function)
                done.append(f"{head}{{{inner}}}" if function == "sqrt" else f"{head}({inner})")
            elif power:
                inner = self.formula(re.sub(r"^[({](.*)[)}]$", r"\1", power))
                done.append(f"^{{{inner}}}")
            elif number:
                power_of_ten = re.sub(r"e\+?(-?)0*(\d+)", r"\\cdot 10^{\1\2}", number)
                done.append(power_of_ten.removeprefix(r"1\cdot "))
            elif name:
                short = self._is_symbol(name) or len(name) == 1 or name[1] == "_"
                short = short or name in self.derivation.written
                rate = not short and DIFFERENTIAL.fullmatch(name)
                font = "mathit" if self.lines.fullmatch(name) else "mathrm"
                other = rf"\mathrm{{d}}{self._name(rate[1])}" if rate else rf"\{font}{{{name}}}"
                done.append(self._name(name) if short else other)
            else:
                done.append(SIGNS.get(sign, sign) or IN_FORMULA.get(other, other))
        return "".join(done)

    def _name(self, name: str) -> str:
        """A symbol; a vector is bold as in the formulas."""
        if name in BOLD_LETTERS:
            return UNICODE[name]
        spelled = {name, name.replace("_", "")}  # a parameter gs is also called g_s
        free = not spelled & self.names and name not in self.derivation.written
        if free and name in self.vectors:
            return rf"\mathbf {name}"
        if (
            free
            and name[0] in self.indexed
            and (index := re.fullmatch(r"(?:_(?=\w)|(?=\d))(\w)", name[1:]))
        ):
            return rf"\mathbf {name[0]}_{index[1]}"
        return written_name(self.derivation, name)


def starts(before: list[str]) -> bool:
    """Whether a sentence starts after what was written."""
    return re.search(r"(^|[.;?!]\s+)$", "".join(before)) is not None


def _status(found: re.Match[str]) -> str:
    word = found[0]
    return rf"\texttt{{{word}}}" if word == "BRANCHES" else rf"\textsc{{{word.lower()}}}"


def symbols_declared(derivation: Derivation) -> list[sp.Symbol]:
    """The parameters and the joints."""
    parameters = [p.symbol for p in derivation.parameters]
    return parameters + [j.symbol for j in derivation.joints]


def symbols_of(step: Step) -> set[sp.Symbol]:
    """The symbols in the formulas of a step."""
    shown = [value for _, value in step.shown]
    parts = [p for v in shown for p in (v if isinstance(v, list | tuple) else [v])]
    return {s for p in parts if isinstance(p, sp.Basic | sp.MatrixBase) for s in p.free_symbols}


def upright(text: str) -> str:
    """A formula with words in it, such as ``area`` or ``any``, set as words."""
    if r"\begin" in text or r"\text" in text or r"\mathrm" in text:
        return text
    spaced = re.sub(r"(?<=\S) +(?=[A-Za-z]{3})", r"\\ ", text)
    return re.sub(r"(?<![\\A-Za-z])[A-Za-z]{3,}", r"\\mathrm{\g<0>}", spaced)


CALLED = re.compile(
    r"\\(operatorname\{\w+\}|[a-z]*(sin|cos|tan)|min|max)(_\{\d\})?(\^\S+)? *\{? *$"
)
"""What the parentheses after it are the arguments of."""


def loosen(text: str) -> str:
    """Replace ``\\left( \\right)`` by parentheses of fixed size, unless a matrix is inside.

    A sum in parentheses that has others in it has brackets, and a sum with those parentheses.
    """
    opened: list[tuple[int, str]] = []
    heights = [0]
    """How many pairs are in each other, in what is open and around it."""
    parts = re.split(r"(\\left[(\[]|\\right[)\]]|\\left\S|\\right\S)", text)
    for i, part in enumerate(parts):
        if part.startswith(r"\left"):
            opened.append((i, part))
            heights.append(0)
        elif part.startswith(r"\right") and opened:
            j, left = opened.pop()
            inside = "".join(parts[j + 1 : i])
            round_pair = left[5:] == "(" and part[6:] == ")"
            height = heights.pop() + round_pair
            heights[-1] = max(heights[-1], height)
            if left[5:] in "([" and r"\begin" not in inside:
                large = "Big" if r"\frac" in inside else "big" if r"\sqrt" in inside else ""
                before = "".join(parts[:j])
                small = before.count("{") > before.count("}") or r"\begin" in before
                large = large.lower() if small else large
                ends = left[5:], part[6:]
                if round_pair and height % 2 == 0 and not CALLED.search(before):
                    ends = "[", "]"
                if round_pair and height > 1 and (ends[0] == "[" or height > 2):
                    large = large or "big"  # a bare bracket after \\ would be its argument
                size = (rf"\{large}l", rf"\{large}r") if large else ("", "")
                parts[j], parts[i] = size[0] + ends[0], size[1] + ends[1]
    return re.sub(r"(?<![\s\\]) (?=(?:\\[bB]igr)?[)\]])", "", "".join(parts))


def spaced(text: str) -> str:
    """Add thin spaces next to symbols that are words and factors."""
    return re.sub(rf"(?<=[\w}}]) (?={WORD})|({WORD}) (?=[A-Za-z]|{VARIABLE})", r"\1\\, ", text)
