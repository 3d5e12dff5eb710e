"""Prints a derivation as a LaTeX article, as a notebook cell, and the papers' errata as Markdown.

Python prepares the formulas and the sentences; the templates lay them out.  A formula that fits is
aligned; a longer one is set in a paragraph, where TeX itself breaks it at operators.  For that the
printer writes no ``\\left(``, between which TeX never breaks.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import sympy as sp
from sympy.core.alphabets import greeks
from sympy.printing.latex import LatexPrinter

from closedform.claims import VERDICTS, Check, Every, Refuted
from closedform.derivation import Derivation, Inverse, Solved, Step
from closedform.emit.text import citation
from closedform.functions import Array, Bound, Function, Let, Match, Require, Statement, Vanishes
from closedform.prove import ClaimResult, InverseResult, Proof

GREEK = {*greeks, *(g.capitalize() for g in greeks), "lambda", "varphi"}
SYMBOL_NAMES = {
    "lamda": r"\lambda",
    "det": r"\det",
    "loff": r"l_{\mathrm{off}}",
    "Rx": r"R_{x}",
}
"""Symbols that the rule of :func:`symbol_name` would misread."""

FITS = 78.0
"""Widest formula, in average letters of 10 pt, that is set on one line."""

SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    **{c: "\\" + c for c in "&%$#_{}"},
    **{c: f"${c}$" for c in "<>|"},
    '"': "''",
}
UNICODE = {
    "°": r"^\circ", "²": "^2", "³": "^3", "±": r"\pm", "×": r"\times", "·": r"\cdot", "≤": r"\le",
    "≥": r"\ge", "≠": r"\ne", "≈": r"\approx", "√": r"\surd", "∞": r"\infty", "−": "-", "ℓ": r"\ell",
    "ϕ": r"\phi", "∈": r"\in", "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta",
    "Δ": r"\Delta", "ε": r"\epsilon", "η": r"\eta", "θ": r"\theta", "κ": r"\kappa",
    "λ": r"\lambda", "μ": r"\mu", "µ": r"\mu", "ξ": r"\xi", "π": r"\pi", "ρ": r"\rho",
    "σ": r"\sigma", "τ": r"\tau", "φ": r"\varphi", "ψ": r"\psi", "ω": r"\omega", "Ω": r"\Omega",
}  # fmt: skip
DASHES = {"–": "--", "—": "---", "‘": "`", "’": "'", "“": "``", "”": "''", "…": r"\dots{}"}
