"""Planar linkages that nobody had tried here, against rigid bodies that Newton's method assembles.

From random starts it finds no hand that ``fk`` lacks, and all those that ``fk`` has.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import apart, derived, script_of
from places import TESTS
from planar_bodies import Linkage

FOLDER = TESTS / "held_out_loops"
OK, STARTS, LINES = 0, 60, 40
FILES = {
    "atkinson": 0.7,
    "bike_suspension": 0.21,
    "chebyshev_lambda": 0.9,
    "coupled_finger": -0.3,
    "dump_hoist": 1.6,
    "exo_knee": 0.24,
    "hart": 0.7,
    "jib_crane": 1.1,
    "link_press": 0.6,
    "pushrod": 0.1,
    "rack_steering": 0.02,
    "stephenson_three": 0.8,
    "trailing_arm": 0.27,
    "umbrella": 0.35,
}
"""The value of the driven joint."""


@pytest.mark.parametrize(("name", "q"), FILES.items())
def test_bodies_that_newton_puts_together_are_those_of_fk(
    name: str, q: float, tmp_path: Path
) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    assert len(text.splitlines()) < LINES
    mechanism = derived(name, script_of(name, text, tmp_path), tmp_path)
    linkage, rng = Linkage(FOLDER / f"{name}.toml", q), np.random.default_rng(1)
    p, status = mechanism.fk([q])
    exist, met = p[status == OK], np.zeros(np.count_nonzero(status == OK), dtype=bool)
    assert len(exist)
    for hand in filter(lambda e: e is not None, (linkage.assembled(rng) for _ in range(STARTS))):
        near = apart(exist, hand, np.array([linkage.turns])) < 1e-6 * linkage.size
        assert near.any()
        met |= near
    assert met.all()
