"""What figures and articles call joints whose names are words: ``left_arm_joint3`` is theta_3."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

ALPHABET = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda",
    "mu", "nu", "xi", "omicron", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi",
    "omega",
]  # fmt: skip
GREEK = {*ALPHABET, *(g.capitalize() for g in ALPHABET), "varphi"}
LETTERS = "|".join(sorted(GREEK))
WORD = re.compile(rf"(?!(?:{LETTERS})(?![a-z]))[A-Za-z_]*[A-Za-z]{{3}}\w*")
"""The name of a joint that contains a word, and is no Greek letter."""
MORE = re.compile(r"[\d_]|[a-z][A-Z]")
"""What is in a name that is a word and a number, or more than a word."""


def by_number(joints: Mapping[str, str], taken: Collection[str]) -> dict[str, str]:
    """The letter and the number of each joint, whose kind is given; none if a name is short.

    A joint that turns is theta with its number in the chain, another one q with its number.  If
    such a name is taken, all joints keep theirs.
    """
    if not joints or not all(WORD.fullmatch(n) and MORE.search(n) for n in joints):
        return {}
    letters = {"revolute": "theta"}
    found = {n: f"{letters.get(kind, 'q')}{k}" for k, (n, kind) in enumerate(joints.items(), 1)}
    return {} if {*found.values()} & {*taken} else found
