"""Arms whose first two axes meet at an oblique angle, then an elbow and a spherical wrist.

Seven joints are those of an exoskeleton, with the third one given: where its upper arm is along the
second axis, the elbow may be straight and the wrist on that axis at once.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from arms import INVALID, OK, UNREACHABLE
from chains import printed
from proposals import Proposals
from sympy import pi

from closedform.pipeline import scripts
from closedform.scaffold.new import new

A, B, C, D = (sp.Rational(n, 100) for n in (8, 25, 30, 5))
WRIST = [(0, -pi / 2, B), (0, pi / 2, 0), (0, 0, A)]
FIRST, LAST = (f"spherical wrist, axes {k} and {k + 1} meet" for k in (1, 2))
ARMS = {
    "along the second axis": ([(0, pi / 3, D), (0, pi / 2, C), (0, pi / 2, 0), *WRIST], LAST, 8),
    "equal links": ([(0, pi / 4, D), (0, pi / 2, B), (0, pi / 2, 0), *WRIST], LAST, 8),
    "at an angle": ([(0, 2 * pi / 3, D), (A, pi / 2, C), (D, pi / 2, 0), *WRIST], FIRST, 8),
    "oblique elbow": ([(0, pi / 3, D), (A, pi / 3, C), (D, pi / 2, 0), *WRIST], FIRST, 8),
}
PROPOSALS = Proposals(ARMS)
X, Y, Z = np.eye(3)
EXOSKELETON = [  # axes, and places relative to the joint before
    (np.array([0.5, 0, np.sqrt(0.75)]), (0, 0.2, 0.3)), (X, (0, 0, 0)), (Y, (0, 0, 0)),
    (Y, (0, 0, -0.3)), (X, (0.25, 0, 0)), (Y, (0, 0, 0)), (Z, (0, 0, 0)),
]  # fmt: skip
TOOL = (0.08, 0, 0)


@pytest.fixture(scope="module")
def exoskeleton(folder: Path) -> ModuleType:
    links, joints = ['<link name="l0"/>'], []
    for k, (axis, place) in enumerate([*EXOSKELETON, (None, TOOL)], 1):
        links.append(f'<link name="l{k}"/>')
        kind = "fixed" if axis is None else "continuous"
        joints.append(
            f'<joint name="j{k}" type="{kind}"><parent link="l{k - 1}"/><child link="l{k}"/>'
            f'<origin xyz="{" ".join(map(str, place))}"/>'
            + ("" if axis is None else f'<axis xyz="{" ".join(map(repr, map(float, axis)))}"/>')
            + "</joint>"
        )
    path, script = folder / "exo.urdf", folder / "exo.py"
    path.write_text(f'<robot name="exo">{"".join(links + joints)}</robot>', "utf-8")
    script.write_text(new("exo", "urdf", path).text, "utf-8")
    assert "given = ik.given(j3)" in script.read_text("utf-8")
    return printed(scripts.load(scripts.find([str(script)])[0]), folder)


def turned(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Rodrigues' formula."""
    K = np.cross(np.eye(3), axis)
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.eye(3) + s * K + (1 - c) * (K @ K)


def pose(q: np.ndarray) -> np.ndarray:
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4)).copy()
    for k, (axis, place) in enumerate(EXOSKELETON):
        T[..., :3, 3] += T[..., :3, :3] @ np.array(place)
        T[..., :3, :3] = T[..., :3, :3] @ turned(axis, q[..., k])
    T[..., :3, 3] += T[..., :3, :3] @ np.array(TOOL)
    return T


test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


def test_what_is_ok_reaches_and_nothing_is_lost(exoskeleton: ModuleType) -> None:
    """Twenty of these poses had answers that were OK and missed by up to 5e-7."""
    rng = np.random.default_rng(0)
    q = rng.uniform(-3, 3, (20000, 7))
    near = rng.choice([0, 1e-15, 1e-9, 1e-6], q.shape)
    special = rng.integers(-4, 5, q.shape) * np.pi / 4 + near
    q = np.where((rng.random(q.shape) < 0.5) & (np.arange(20000) > 8000)[:, None], special, q)
    T = pose(q)
    answers, status = exoskeleton.ik(T, q[:, 2])
    missed = np.abs(pose(np.nan_to_num(answers)) - T[:, None]).max(axis=(-1, -2))
    assert missed[status == OK].max() < 1e-12
    assert not np.isin(status, (UNREACHABLE, INVALID)).all(axis=-1).any()
