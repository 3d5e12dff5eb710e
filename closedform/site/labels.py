"""Names of joints and parameters in Unicode, for controls and graphs: theta2R is θ₂R."""

from __future__ import annotations

import re

GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "theta": "θ",
    "rho": "ρ",
    "phi": "φ",
    "psi": "ψ",
    "sigma": "σ",
}
DIGITS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def label(name: str) -> str:
    """A name as people write it."""
    letter = next((g for g in GREEK if name.startswith(g)), "")
    rest = re.sub(r"\d+", lambda m: m[0].translate(DIGITS), name[len(letter) :])
    return f"{GREEK.get(letter, '')}{rest}"
