"""How names are written in a figure, and which segment of a drawing has which length."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np

from closedform.plot.robot import Array, Robot

GREEK = ("alpha", "beta", "gamma", "theta", "rho", "phi", "psi", "sigma")
FUNCTIONS = ("sin", "cos", "tan", "sqrt")
INDICES = {"al": "a_{l}", "gs": "g_{s}", "lp": "l_{p}", "w": "w"}
"""Lengths with a letter below."""
LENGTH = re.compile(r"c(\d)")
"""A length that papers call c; in the texts a c with a number is a cosine."""
WORD = re.compile(r"([A-Za-z]{2,})_(\w+)")
"""A word with an index, such as ``tilt_x``."""
ARM = re.compile(r"(.*\d)([RL])")
"""A joint of the right or the left arm."""


def symbol(name: str) -> str:
    """A name such as ``theta2R`` or ``l3`` as a formula, as the texts write it."""
    return f"${_formula(name)}$"


def _formula(name: str) -> str:
    if name in INDICES:
        return INDICES[name]
    if found := LENGTH.fullmatch(name):
        return rf"\ell_{{{found[1]}}}"
    if found := ARM.fullmatch(name):
        return f"{_formula(found[1])}^{{{found[2]}}}"
    if (found := WORD.fullmatch(name)) and found[1] not in GREEK:
        return rf"\mathrm{{{found[1]}}}_{{{found[2]}}}"
    letter = next((g for g in GREEK if name.startswith(g)), name[0])
    rest = name[len(letter) :].removeprefix("_")
    written = rf"\{letter}" if letter in GREEK else letter
    if not rest:
        return written
    below = re.sub(r"([A-Za-z]{2,})", r"\\mathrm{\1}", rest)
    return f"{written}_{{{below}}}"


def equation(text: str) -> str:
    """The name of a singular set; ``sin(theta2) = 0`` is a formula, and ``elbow`` a word."""
    if "=" not in text:
        return text
    text = re.sub(rf"({'|'.join(FUNCTIONS)})\((\w+)\)", r"\1 \2", text)
    words = re.sub(
        r"[A-Za-z]\w*",
        lambda m: rf"\{m[0]}\," if m[0] in FUNCTIONS else _formula(m[0]),
        text,
    )
    return f"${words.replace('*', ' ')}$"


def lengths(r: Robot, q: Array, mode: int) -> dict[str, list[tuple[str, str]]]:
    """For each parameter, the segments of links that are as long as it, for any dimensions.

    A parameter that is zero has no segment to show.
    """
    names = r.module.SKELETON.points
    segments = [pair for link in r.module.SKELETON.links.values() for pair in pairwise(link)]
    rng = np.random.default_rng(5)
    base = np.array([float(v) for v in r.params])
    possible = {(k, pair) for k in range(len(base)) for pair in segments}
    for _ in range(2):
        changed = base * rng.uniform(0.97, 1.03, len(base))
        points = replace(r, params=r.module.Parameters(*changed)).points(q)[mode]
        place = dict(zip(names, points, strict=True))
        possible = {
            (k, pair)
            for k, pair in possible
            if abs(np.linalg.norm(place[pair[1]] - place[pair[0]]) - abs(changed[k]))
            < 1e-9 * r.size
        }
    fields = enumerate(r.module.Parameters._fields)
    found = {field: [p for p in segments if (k, p) in possible] for k, field in fields if base[k]}
    return {field: pairs for field, pairs in found.items() if pairs}
