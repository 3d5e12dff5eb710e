"""A crane of seven joints whose jib slides out between parallel joints, with the slide given."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, misses
from chains import printed
from test_urdf import arm_of, forward

from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.chains.chainlinks import singles
from closedform.scaffold.new import InverseSearch, new
from closedform.scaffold.source import GIVEN

JOINTS = (
    ("slew", "revolute", "0 0 1.6", "0 0 1"),
    ("boom", "revolute", "0.1 0 0.7", "0 1 0"),
    ("jib", "revolute", "3.1 0 0.15", "0 1 0"),
    ("reach", "prismatic", "1.7 0 0.1", "1 0 0"),
    ("swing", "revolute", "0.5 0 0", "{}"),
    ("sway", "revolute", "0 0 -0.2", "1 0 0"),
    ("rotator", "revolute", "0 0 -0.3", "0 0 1"),
)


def crane(axis: str) -> str:
    joints = "".join(
        f'<joint name="{name}" type="{kind}"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{along.format(axis)}"/></joint>'
        for k, (name, kind, xyz, along) in enumerate(JOINTS)
    )
    return f'<robot name="crane">{joints}</robot>'


@pytest.mark.parametrize("axis", ["0 1 0", "0 -1 0"])
def test_the_printed_inverse_returns_to_every_posture(axis: str, tmp_path: Path) -> None:
    """The direction of a link that a given joint makes longer, and an axis against the others."""
    urdf = tmp_path / "crane.urdf"
    urdf.write_text(crane(axis), "utf-8")
    script = new("crane", "urdf", urdf, search=InverseSearch(fault=fault))
    assert script.structure == "axes 2, 3 and 5 parallel, 6 and 7 meet, with reach given"
    path = tmp_path / "crane.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    module = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(4).uniform(-3, 3, (400, 7))
    q[:, 3] = np.random.default_rng(5).uniform(-4, 2, 400)  # also drawn in beyond the joint
    T = np.array([forward(urdf.read_text("utf-8"), row) for row in q])
    np.testing.assert_allclose(module.pose(q), T, atol=1e-14)
    answers, status = module.ik(T, q[:, 3])
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    away, turned = misses(module.pose(answers), T, status)
    assert away < 1e-12 * 6 and turned < 1e-12
    turns = np.arange(7) != 3
    same = np.abs(np.exp(1j * answers[..., turns]) - np.exp(1j * q[:, None, turns])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-9


@pytest.mark.parametrize("number", range(1, 8))
def test_an_arm_with_a_joint_given_has_the_pose_of_the_arm(number: int, tmp_path: Path) -> None:
    urdf = tmp_path / "crane.urdf"
    urdf.write_text(crane("0 -1 0"), "utf-8")
    serial = arm_of(urdf)
    values = dict(zip(serial.joints, map(sp.Rational, (1, 2, -1, 3, 2, -2, 1)), strict=True))
    given = {GIVEN: values[serial.joints[number - 1]]}
    left = singles(serial).with_given(number, GIVEN)
    missed = sp.N((left.pose() - serial.pose).xreplace(given | values))
    assert missed.norm() < 1e-12
