"""Mechanisms whose lengths are numbers cannot be scaled, so powers of a large target overflow."""

from pathlib import Path

import numpy as np
from loop_files import derived

STAGE = """
from closedform import Derivation, Paper, Stretch, platform

d = Derivation("three_legs", "3-RPR", Paper("three_legs", "Three legs", ("A. Nonymous",)), "Legs.")
legs = [((0, 0), (0, 0)), ((16, 0), (17, 0)), ((0, 10), (13, 16))]
platform(
    d,
    [
        Stretch(d.joint(f"q{k}", "prismatic"), foot, on_hand=end)
        for k, (foot, end) in enumerate(legs, 1)
    ],
)
"""


def test_a_leg_that_overflows_is_no_answer(tmp_path: Path) -> None:
    stage = derived("three_legs", STAGE, tmp_path, crosscheck=True)
    near, far = [3, 4, 0.5], [1e299, 1e299, 0.5]
    q, status = stage.ik([near, far])
    assert np.isclose(q[0, 0, 0], 5) and status.tolist() == [[0], [1]]
    assert np.isnan(q[1]).all()
    assert np.isclose(stage.ik([3e100, 4e100, 0.5]).q[0, 0], 5e100)
