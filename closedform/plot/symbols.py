"""How names are written in a figure, and which segment of a drawing has which length."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from closedform.plot.robot import Array, Robot

K = TypeVar("K")
GREEK = ("alpha", "beta", "gamma", "theta", "rho", "phi", "psi", "sigma")
FUNCTIONS = ("sin", "cos", "tan", "sqrt")
INDICES = {"al": "a_{l}", "gs": "g_{s}", "lp": "l_{p}", "w": "w"}
"""Lengths with a letter below."""
LENGTH = re.compile(r"c(\d)")
"""A length that papers call c; in the texts a c with a number is a cosine."""
WORD = re.compile(r"([A-Za-z]{2,})_(\w+)")
"""A word with an index, such as ``yaw_x``."""
LETTERS = {"tilt": r"\tau"}
"""Words for which the texts write a letter."""
ARM = re.compile(r"(.*\d)([RL])")
"""A joint of the right or the left arm."""


LONG = 60
"""From how many letters on a legend calls a factor of the singular set by its number."""


def symbol(name: str, r: Robot | None = None) -> str:
    """A name such as ``theta2R`` or ``l3`` as a formula, as the texts write it.

    Joints of a robot ``r`` that are called by words have the letters of its article.
    """
    return f"${_formula(r.called(name) if r else name)}$"


def factor(r: Robot, k: int) -> str:
    """What a legend calls a factor of the singular set: its equation, if that is short."""
    name: str = r.module.SINGULARITIES[k]
    if "=" in name and len(name) > LONG:
        return f"factor {k + 1} of the singular set"
    return equation(re.sub(r"[A-Za-z]\w*", lambda found: r.called(found[0]), name))


def _formula(name: str) -> str:
    if name in INDICES:
        return INDICES[name]
    if found := LENGTH.fullmatch(name):
        return rf"\ell_{{{found[1]}}}"
    if found := ARM.fullmatch(name):
        return f"{_formula(found[1])}^{{{found[2]}}}"
    if (found := WORD.fullmatch(name)) and found[1] not in GREEK:
        word = LETTERS.get(found[1]) or rf"\mathrm{{{found[1]}}}"
        return f"{word}_{{{found[2]}}}"
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

    On a sphere, angles have segments too: arcs.  A parameter that is zero has no segment to show.
    """
    names = r.module.SKELETON.points
    links = r.module.SKELETON.links.values()
    segments = list(dict.fromkeys(pair for link in links for pair in pairwise(link)))

    def sizes(points: Array) -> dict[tuple[str, str], tuple[float, float]]:
        place = dict(zip(names, points, strict=True))
        centre = place[r.centre] if r.centre else None
        return {(a, b): _sizes(place[a], place[b], centre) for a, b in segments}

    return _parameters(r, q, mode, sizes)


def distances(r: Robot, q: Array, mode: int) -> dict[str, list[tuple[Array, Array]]]:
    """For each parameter, the segments that no link covers and that are as long as it.

    They lead from the origin to a fixed point, or else from a plane of the base to a point.
    """
    skeleton = r.module.SKELETON
    names = skeleton.points
    here = dict(zip(names, r.points(q)[mode], strict=True))
    found: dict[str, list[tuple[Array, Array]]] = {}
    for ways in (np.eye(3), *np.eye(3)[:, None]):
        chosen = skeleton.ground if len(ways) == 3 else (skeleton.hand,)

        def sizes(
            points: Array, ways: Array = ways, chosen: tuple[str, ...] = chosen
        ) -> dict[str, tuple[float, float]]:
            place = dict(zip(names, points, strict=True))
            return {p: _sizes(_foot(place[p], ways), place[p]) for p in chosen}

        for field, ends in _parameters(r, q, mode, sizes).items():
            found.setdefault(field, [(_foot(here[p], ways), here[p]) for p in ends])
    return found


def directions(r: Robot, q: Array, mode: int) -> dict[str, list[tuple[Array, Array, Array]]]:
    """For each angle among the parameters, the fixed points that are in its direction.

    Such a point comes after the axis of the base where the angle starts and the one about which it
    turns: the angle is that of the point, seen from the origin.
    """
    skeleton = r.module.SKELETON
    names = skeleton.points
    here = dict(zip(names, r.points(q)[mode], strict=True))
    found: dict[str, list[tuple[Array, Array, Array]]] = {}
    for k in (2, 0, 1):
        start, side, axis = np.roll(np.eye(3), -k - 1, axis=0)

        def sizes(
            points: Array, start: Array = start, side: Array = side
        ) -> dict[str, tuple[float, float]]:
            place = dict(zip(names, points, strict=True))
            turns = {p: np.arctan2(place[p] @ side, place[p] @ start) for p in skeleton.ground}
            return {p: (np.nan, float(turn % (2 * np.pi))) for p, turn in turns.items()}

        for field, ends in _parameters(r, q, mode, sizes).items():
            found.setdefault(field, [(start, axis, here[p]) for p in ends])
    return found


def _foot(point: Array, ways: Array) -> Array:
    """Where one comes to from a point along some directions, nearest to the origin."""
    return np.asarray(point - (ways @ point) @ ways)


def _sizes(a: Array, b: Array, centre: Array | None = None) -> tuple[float, float]:
    """How far two points are apart, and at which angle a centre sees them."""
    gap = float(np.linalg.norm(b - a))
    if centre is None:
        return gap, np.nan
    u, v = a - centre, b - centre
    return gap, float(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))


def _parameters(
    r: Robot, q: Array, mode: int, sizes: Callable[[Array], Mapping[K, tuple[float, float]]]
) -> dict[str, list[K]]:
    """For each parameter that is not zero, what is as large as it, for any dimensions."""
    fields = r.module.Parameters._fields
    angular = [r.is_angle(field) for field in fields]
    rng = np.random.default_rng(5)
    base = np.array([float(v) for v in r.params])
    possible: set[tuple[int, K]] | None = None
    order: list[K] = []
    for _ in range(2):
        changed = base * rng.uniform(0.97, 1.03, len(base))
        other = replace(r, params=r.module.Parameters(*changed))
        found = sizes(other.points(_same_branch(r, other, q))[mode])
        order = order or list(found)
        fitting = {
            (k, key)
            for key, size in found.items()
            for k, value in enumerate(changed)
            if value and abs(size[angular[k]] - abs(value)) < 1e-9 * r.size
        }
        possible = fitting if possible is None else possible & fitting
    named = {
        field: [key for key in order if possible and (k, key) in possible]
        for k, field in enumerate(fields)
    }
    return {field: keys for field, keys in named.items() if keys}


def _same_branch(r: Robot, other: Robot, q: Array) -> Array:
    """The joints of the same branch for other dimensions, where the hand is given."""
    if r.has_forward_map:
        return q
    before, _ = r.branches(r.target)
    after, _ = other.branches(other.target)
    gaps = np.abs(before - q).max(-1)
    return np.asarray(after[int(np.argmin(np.where(np.isfinite(gaps), gaps, np.inf)))])
