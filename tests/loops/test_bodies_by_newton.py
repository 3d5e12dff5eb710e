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
FILES: dict[str, float | tuple[float, ...]] = {
    "atkinson": 0.7,
    "bike_suspension": 0.21,
    "bird_leg": (0.47, -1.2),
    "bonnet": 0.2,
    "chebyshev_lambda": 0.9,
    "coupled_finger": -0.3,
    "dump_hoist": 1.6,
    "exo_knee": 0.24,
    "hart": 0.7,
    "idler_steering": 0.1,
    "jib_crane": 1.1,
    "link_press": 0.6,
    "multi_link_engine": (0.4, -0.7),
    "pantograph_leg": (0.05, -0.1),
    "pushrod": 0.1,
    "rack_steering": 0.02,
    "roberts": 1.2,
    "side_stay": 0.3,
    "stephenson_three": 0.8,
    "tail_lift": 0.75,
    "take_up": 0.9,
    "trailing_arm": 0.27,
    "turned_tool": (2.2, 0.9, 0.2),
    "umbrella": 0.35,
    "wipers": 0.8,
}
"""The values of the driven joints."""


@pytest.mark.parametrize(("name", "q"), FILES.items())
def test_bodies_that_newton_puts_together_are_those_of_fk(
    name: str, q: float | tuple[float, ...], tmp_path: Path
) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    assert len(text.splitlines()) < LINES
    mechanism = derived(name, script_of(name, text, tmp_path), tmp_path)
    values = [*np.atleast_1d(q)]
    linkage, rng = Linkage(FOLDER / f"{name}.toml", *values), np.random.default_rng(1)
    p, status = mechanism.fk(values)
    exist, met = p[status == OK], np.zeros(np.count_nonzero(status == OK), dtype=bool)
    assert len(exist)
    for hand in filter(lambda e: e is not None, (linkage.assembled(rng) for _ in range(STARTS))):
        near = apart(exist, hand, np.array(linkage.turns)) < 1e-6 * linkage.size
        assert near.any()
        met |= near
    assert met.all()
