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
WORDS = re.compile(rf"(?=.*[\d_])(?!(?:{LETTERS})(?![a-z]))[A-Za-z_]*[A-Za-z]{{3}}\w*")
"""The name of a joint that is a word and a number, or more than a word, and no Greek letter."""


def by_number(joints: Mapping[str, str], taken: Collection[str]) -> dict[str, str]:
    """The letter and the number of each joint, whose kind is given; none if a name is short.

    A joint that turns is theta with its number in the chain, another one q with its number.  If
    such a name is taken, all joints keep theirs.
    """
    if not joints or not all(map(WORDS.fullmatch, joints)):
        return {}
    letters = {"revolute": "theta"}
    found = {n: f"{letters.get(kind, 'q')}{k}" for k, (n, kind) in enumerate(joints.items(), 1)}
    return {} if {*found.values()} & {*taken} else found
