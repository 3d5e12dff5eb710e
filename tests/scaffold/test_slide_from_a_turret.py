"""A slide normal to the axis of a turret, before a joint about any other axis."""

import numpy as np
import sympy as sp
from arms import OK, SINGULAR
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 30, 20, 11))
WRIST = "spherical wrist, a turret, a slide and a joint"
ARMS = {
    "spherical wrist": (
        [(A, pi / 2, C), (A, pi / 4, None, pi / 6), (A, pi / 2, A), (0, pi / 2, B),
         (0, pi / 2, 0), (0, 0, D)],
        WRIST, 8,
    ),
    "oblique wrist": (
        [(0, pi / 2, C), (A, pi / 4, None, pi / 6), (A, pi / 2, 0), (0, pi / 2, B),
         (0, pi / 3, 0), (0, 0, D)],
        WRIST, 8,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


def test_no_posture_is_lost_where_both_joints_are_tangent(folder) -> None:
    """The third joint is where the height is largest, and the slide where the wrist is nearest."""
    name, rng = "spherical wrist", np.random.default_rng(0)
    q = rng.uniform(-3, 3, (5000, 6))
    near = rng.choice([0, 1e-15, 1e-12, 1e-9, 1e-6], (2, 5000))

    def centre(third: np.ndarray, slide: np.ndarray) -> np.ndarray:
        at = np.zeros((third.size, 6))
        at[:, 2], at[:, 1] = third, slide
        pose = PROPOSALS.pose(name, at)
        return pose[:, :3, 3] - float(D) * pose[:, :3, 2]

    quarter = np.array([0, np.pi / 2, np.pi])
    zero, side, back = centre(quarter, np.zeros(3))[:, 2]
    highest = np.arctan2(2 * side - zero - back, zero - back)
    q[:, 2] = highest + rng.choice([0, np.pi], 5000) + near[0]
    at, still = centre(q[:, 2], np.zeros(5000))[:, :2], np.zeros(5000)
    along = centre(q[:, 2], still + 1)[:, :2] - at
    q[:, 1] = -(at * along).sum(axis=1) / (along**2).sum(axis=1) + near[1]
    _, status = PROPOSALS.made(name, folder).ik(PROPOSALS.pose(name, q))
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
