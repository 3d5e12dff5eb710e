"""Arms whose frames are turned by angles without square roots, which may add up to right angles."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import misses
from chains import printed
from test_urdf import arm_of, forward

from closedform.model.functions import real
from closedform.pipeline import run as pipeline
from closedform.pipeline.trial import fault
from closedform.scaffold.new import Search, new
from closedform.scaffold.urdf import read_urdf

PANTHERA = Path(__file__).parents[1] / "benchmarks" / "arms" / "panthera.urdf"
BACK = "-0.306676319401685"
"""A turn that the file takes back: with the one before it makes pi."""


@pytest.mark.parametrize("back", [BACK, "-0.2"])
def test_the_printed_inverse_returns_to_every_posture(back: str, tmp_path: Path) -> None:
    text = PANTHERA.read_text("utf-8")
    assert BACK in text
    urdf = tmp_path / "turned.urdf"
    urdf.write_text(text.replace(BACK, back), "utf-8")
    script = new("turned", "urdf", urdf, search=Search(fault=fault))
    assert script.structure == "turret, three parallel joints and two more (UR)"
    path = tmp_path / "turned.py"
    path.write_text(script.text, "utf-8")
    (source,) = pipeline.find([str(path)])
    module = printed(pipeline.load(source), tmp_path / "printed")
    q = np.random.default_rng(4).uniform(-3, 3, (500, 6))
    T = np.array([forward(urdf.read_text("utf-8"), row) for row in q])
    np.testing.assert_allclose(module.pose(q), T, atol=2e-5)  # 1.5708 stands for pi/2
    T = module.pose(q)
    answers, status = module.ik(T)
    away, turned = misses(module.pose(answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-9


def test_angles_that_add_up_to_a_right_angle_are_taken_for_it(tmp_path: Path) -> None:
    turns = ("0", "2.7549", "0.3867")
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="0.1 0 0" rpy="0 {turn} 0"/><axis xyz="0 1 0"/></joint>'
        for k, turn in enumerate(turns)
    )
    path = tmp_path / "sums.urdf"
    path.write_text(f'<robot name="sums">{joints}</robot>', "utf-8")
    table = read_urdf(path)
    (note,) = (n for n in table.notes if "together with the turns before it" in n)
    assert note.endswith("the angle 3.1416000 is taken for pi")
    assert "joint q2" in note
    sums = arm_of(path).pose[:3, :3]
    assert sums == sp.Matrix(sums).xreplace({real("angle1"): sp.S.Zero})
