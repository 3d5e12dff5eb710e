"""What to write instead of what a formula cannot hold: degrees, units, and signs of typesetting."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from fractions import Fraction

import sympy as sp

from closedform.scaffold.source import source

LENGTHS = ("m", "cm", "mm", "in", "inch", "ft")
"""Units of lengths, which have to be the same in a table."""
PI = re.compile(r"(?i:pi)|M_PI")
"""A name that stands for pi; only ``pi`` itself does in a formula."""
SPELLINGS = tuple(
    (re.compile(pattern), instead)
    for pattern, instead in (
        (r"^\s*$", "the cell is empty; write 0, or the name of the joint"),
        (
            r"\d\s*deg|[°º]|deg2rad|radians|\bdeg\(|\d\s*rad\b",
            "angles are in radians, as multiples of pi; write pi/2 for 90 degrees",
        ),
        (r"π|\b(np|numpy|math|sp|sympy)\.pi\b", "write pi for the number"),
        (r"[\u2010-\u2015\u2212]", "write - for a minus"),
        (r"\^", "write ** for a power"),
        (r"[×·⋅]", "write * for a product"),
        (r"\d\s*(mm|cm|m|in)\b", "a cell has no unit; write all lengths in the same one"),
        (r"\d(?![eE][+-]?\d)[A-Za-z(]|\)\s*[\w(]", "write * for a product, as in 2*q2"),
        (r"[^\x00-\x7f]", "names have Latin letters, digits and _; write theta1 for a Greek one"),
        (r"#", "a comment has a line of its own"),
        (r"\*\s*$", "a joint is its name alone"),
    )
)


def instead(text: str) -> str:
    """A clause on how to write a text that is no formula; empty if nothing is known of it."""
    return next((what for pattern, what in SPELLINGS if pattern.search(text)), "")


def rounded(angle: sp.Expr, text: str) -> str:
    """What to write for an angle in degrees (a whole number) or a rounded one (1.5708 for pi/2)."""
    value = angle.as_coeff_Add()[0]
    if not value.is_Rational or value == 0:
        return ""
    turns = {sp.Rational(k, 12) * sp.pi for k in range(-24, 25)}
    near = [t for t in turns if abs(t - value) < sp.Rational(1, 500)]
    if value.is_Integer or abs(value) > 2 * sp.pi:
        near = [value * sp.pi / 180]
    if not near:
        return ""
    return (
        f"angles must be in radians and exact, as multiples of pi; write "
        f"{source(angle - value + near[0])} instead of {text}"
    )


def mistaken_units(parameters: Mapping[str, Mapping[str, str]]) -> str:
    """A sentence on units of parameters that do not go together; empty if they do."""
    of: dict[str, str] = {}
    for name, given in parameters.items():
        unit = given.get("unit", "").strip().lower()
        if unit.startswith("deg") or unit in ("°", "º"):
            radians = math.radians(float(Fraction(given.get("value") or "1")))
            return (
                f"{name} is in degrees, and angles are in radians; write {name} = {radians:.16g} "
                f"rad, or a multiple of pi in its place in the table"
            )
        if unit in LENGTHS:
            of.setdefault(unit, name)
    if len(of) > 1:
        (first, one), (second, other), *_ = of.items()
        return f"{one} is in {first} and {other} in {second}; write all lengths in the same unit"
    return ""


__all__ = ["PI", "instead", "mistaken_units", "rounded"]
