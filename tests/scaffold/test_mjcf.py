"""MJCF files: the same poses as MuJoCo computes, the choices of a chain, and what is refused."""

import sys
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from test_urdf import arm_of

from closedform.cli.commands import main
from closedform.scaffold.inputs.mjcf import read_mjcf
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.new import new

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")

SCARA = """
<mujoco>
  <compiler angle="degree" eulerseq="XYZ"/>
  <default>
    <joint axis="0 0 2"/>
    <default class="quill"><joint type="slide" axis="0 0 -1" range="0 0.2"/></default>
  </default>
  <asset><mesh name="shell" file="not_there.stl"/></asset>
  <worldbody>
    <body name="base" pos="0 0 0.4" euler="0 0 90">
      <geom type="mesh" mesh="shell"/>
      <frame pos="0.1 0 0" euler="180 0 0">
        <body name="upper" pos="0.15 0 0">
          <joint name="shoulder" pos="-0.15 0 0" range="-120 120"/>
          <body name="fore" pos="0.3000004 0 0.02" quat="0.70710678 0 0 -0.70710678">
            <joint name="elbow" ref="30"/>
            <body name="hand" pos="0 0.2 0">
              <joint name="quill" class="quill"/>
              <joint name="roll" pos="0.01 0 0"/>
              <site name="tip" pos="0 0.05 -0.1" euler="0 90 30"/>
            </body>
          </body>
        </body>
      </frame>
    </body>
  </worldbody>
  <actuator><motor joint="elbow"/></actuator>
  <keyframe><key qpos="0 0 0 0"/></keyframe>
</mujoco>
"""
BODIES = '<mujoco><worldbody><body name="a">{}</body></worldbody></mujoco>'


@pytest.fixture
def scara(tmp_path: Path) -> Path:
    path = tmp_path / "scara.xml"
    path.write_text(SCARA, "utf-8")
    return path


def simulated(text: str, q: np.ndarray, body: str, site: str = "") -> np.ndarray:
    """The pose in the simulator, from its own forward kinematics."""
    text = text.replace('<geom type="mesh" mesh="shell"/>', "").replace("file=", "name2=")
    text = text.replace('<asset><mesh name="shell" name2="not_there.stl"/></asset>', "")
    text = text.replace("<joint name=", '<geom size="0.01"/><joint name=')
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0 + q
    mujoco.mj_forward(model, data)
    at = data.site(site) if site else data.body(body)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = at.xmat.reshape(3, 3), at.xpos
    return pose


@pytest.mark.parametrize(("tool", "site"), [("", ""), ("hand", ""), ("tip", "tip")])
def test_the_poses_are_those_of_the_simulator(scara: Path, tool: str, site: str) -> None:
    exact = SCARA.replace("0.3000004", "0.3")
    scara.write_text(exact, "utf-8")
    arm = arm_of(scara, read_mjcf, Choice(tool=tool))
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    for q in np.random.default_rng(3).uniform(-1, 1, (10, 4)):
        np.testing.assert_allclose(pose(*q), simulated(exact, q, "hand", site), atol=1e-12)


@pytest.mark.parametrize("euler", ["90 0 0", "0 90 0", "0 -90 45", "30 90 60"])
def test_orientations(tmp_path: Path, euler: str) -> None:
    text = f"""<mujoco><worldbody><body name="a" euler="{euler}" pos="0.1 0.2 0.3">
    <joint name="q1" axis="0.6 0 0.8"/><body name="b" pos="0 0 1"/></body></worldbody></mujoco>"""
    (tmp_path / "m.xml").write_text(text, "utf-8")
    arm = arm_of(tmp_path / "m.xml", read_mjcf)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    found, expected = pose(0.7), simulated(text, np.array([0.7]), "b")
    np.testing.assert_allclose(np.array(found, float), expected, atol=1e-9)


def test_limits_and_what_is_said(scara: Path) -> None:
    script = new("scara", "mjcf", scara)
    notes = "\n".join(script.notes)
    assert "joint elbow: it is 0 in the pose of the file, not at the value of ref" in notes
    assert "the chain leads from world to hand" in notes
    assert "pos 0.3000004 is taken for 0.3" in notes
    assert "moves the tool, with its slides at 0, by at most 4.1e-07" in notes
    assert 'quill = d.joint("quill", "prismatic", limits=(Rational("0.0")' in script.text
    assert '"shoulder", limits=(Rational("-2.09439510239319' in script.text
    assert 'elbow = d.joint("elbow")' in script.text
    assert "an inverse with 2 branches is proposed" in script.inverse


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<mujoco><worldbody>", "is not a model that MuJoCo reads"),
        ("<robot/>", "is not MJCF, which begins with <mujoco>"),
        (BODIES.format('<body name="b"/>'), "no joint turns about an axis or slides along one"),
        (BODIES.format('<joint type="ball" name="b"/><body><joint/></body>'), "a ball joint"),
        (BODIES.format('<freejoint/><body name="b"><joint name="q"/></body>'), "a floating joint"),
        (
            BODIES.format('<joint/><body name="l"><joint/></body><body name="r"><joint/></body>'),
            "several ends; choose one with --tool: l, r",
        ),
    ],
)
def test_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "m.xml"
    path.write_text(text, "utf-8")
    with pytest.raises(TableError, match=message):
        read_mjcf(path)


def test_without_mujoco(scara: Path, monkeypatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert main(["new", "scara", "--from", "mjcf", str(scara)]) == 1
    assert "pip install 'closedform[mjcf]'" in capsys.readouterr().err
