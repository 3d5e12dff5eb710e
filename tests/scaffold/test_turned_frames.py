"""Arms whose frames are turned by angles without square roots, which may add up to right angles."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import misses
from chains import printed, solved
from places import ROOT
from test_urdf import arm_of, forward

from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real
from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.proof.prove import prove
from closedform.scaffold.chains.maker import heading
from closedform.scaffold.chains.propose import propose
from closedform.scaffold.chains.recognise import recognised
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import InverseSearch, new

PANTHERA = ROOT / "benchmarks" / "arms" / "panthera.urdf"
BACK = "-0.306676319401685"
"""A turn that the file takes back: with the one before it makes pi."""


@pytest.mark.parametrize("back", [BACK, "-0.2"])
def test_the_printed_inverse_returns_to_every_posture(back: str, tmp_path: Path) -> None:
    text = PANTHERA.read_text("utf-8")
    assert BACK in text
    urdf = tmp_path / "turned.urdf"
    urdf.write_text(text.replace(BACK, back), "utf-8")
    script = new("turned", "urdf", urdf, search=InverseSearch(fault=fault))
    assert script.structure == "turret, three parallel joints and two more (UR)"
    path = tmp_path / "turned.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    module = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(4).uniform(-3, 3, (500, 6))
    T = np.array([forward(urdf.read_text("utf-8"), row) for row in q])
    np.testing.assert_allclose(module.pose(q), T, atol=2e-5)  # 1.5708 stands for pi/2
    T = module.pose(q)
    answers, status = module.ik(T)
    away, turned = misses(module.pose(answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-9


BENT = (
    ("0 0 0.2", "0 0 0", "0 0 1"),
    ("0 0 0", "0 1.8 0", "0 1 0"),
    ("0.3 0 0.05", "0 0 0", "0 1 0"),
    ("0.25 0 -0.04", "0 1 0", "0 1 0"),
    ("0.1 0.05 0", "0 0 0", "1 0 0"),
    ("0 0 0.1", "0 0 0", "0 0 1"),
)
"""Links beside the lines between their joints, and turns whose cosines are parameters."""


def test_links_that_are_bent_by_an_angle_without_roots(tmp_path: Path) -> None:
    """What remained of such an angle in the last joint had no known size, and was not printed."""
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(BENT)
    )
    urdf = tmp_path / "bent.urdf"
    urdf.write_text(f'<robot name="bent">{joints}</robot>', "utf-8")
    script = new("bent", "urdf", urdf, search=InverseSearch(fault=fault))
    assert script.structure == "turret, three parallel joints and two more (UR)"
    path = tmp_path / "bent.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    module = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(5).uniform(-3, 3, (500, 6))
    T = np.array([forward(urdf.read_text("utf-8"), row) for row in q])
    np.testing.assert_allclose(module.pose(q), T, atol=1e-14)
    answers, status = module.ik(T)
    away, turned = misses(module.pose(answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-9


def test_the_tilt_of_the_diagonal_of_a_cube_is_exact(tmp_path: Path) -> None:
    """A leg of ARMAR-4, whose hip leans by 35.26 degrees: its inverse took 115 s to be found."""
    places = (
        ("0.124 0 -0.126", "0 -0.6154033 0", "0 0 1"),
        ("0 0 0", "0 -1.5707962 0.7853983", "0 0 1"),
        ("0 0 0", "-1.5707964 0 0", "0 0 1"),
        ("-0.303136 -0.197542 0.173784", "2.0943953 0.615403 2.3561942", "1 0 0"),
        ("0 0 -0.4085", "0 -1.5707963 0", "0 0 1"),
        ("0 0 0", "1.5707964 0 0", "0 0 1"),
    )
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(places)
    )
    path = tmp_path / "leg.urdf"
    path.write_text(f'<robot name="leg">{joints}</robot>', "utf-8")
    script = new("leg", "urdf", path)
    assert "an inverse with 8 branches is proposed" in script.inverse
    assert any("the angle 0.615403 is taken for atan(sqrt(2)/2)" in n for n in script.notes)
    assert "angle1" not in script.text and len(script.text) < 6000


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
    assert note.endswith("the angle 3.1416 is taken for pi")
    assert "joint q2" in note
    sums = arm_of(path).pose[:3, :3]
    assert sums == sp.Matrix(sums).xreplace({real("angle1"): sp.S.Zero})


@pytest.mark.parametrize(
    ("written", "meant"),
    [("0.26726 0.53452 0.80178", (1, 2, 3)), ("0.70710678 0 0.70710678", (1, 0, 1))],
)
def test_a_decimal_axis_behind_a_turned_frame_keeps_its_digits(
    written: str, meant: tuple, tmp_path: Path
) -> None:
    """The same axis twice is parallel to itself; the last digit is that written."""
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="0.1 0 0.2" rpy="0 {turn} 0"/><axis xyz="{axis}"/></joint>'
        for k, (turn, axis) in enumerate([("0", "0 1 0"), ("0.1359", written), ("0", written)])
    )
    path = tmp_path / "tilted.urdf"
    path.write_text(f'<robot name="tilted">{joints}</robot>', "utf-8")
    table = read_urdf(path)
    c, s = np.cos(0.1359), np.sin(0.1359)
    turned = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ meant / np.linalg.norm(meant)
    place = 10.0 ** -len(written.split()[0].partition(".")[2])
    for _, direction, _ in table.axes[1:]:
        found = [float(e.subs(real("angle1"), sp.Rational(1359, 10000))) for e in direction]
        np.testing.assert_allclose(found, turned, atol=1.5 * place)
    assert "axes 2 and 3 are parallel" in recognised(arm_of(path))


@pytest.mark.parametrize("part", range(-11, 13))
def test_directions_between_those_of_short_roots_are_parts_of_a_turn(part: int) -> None:
    """Without it a humanoid's shoulder, which is turned by 75 degrees, took two minutes."""
    angle = part * sp.pi / 12
    assert heading((sp.cos(angle), sp.sin(angle))) == angle


@pytest.mark.parametrize(("base", "tool"), [(0, "0.3"), (sp.pi, "0.3"), (sp.pi, "-2")])
def test_a_level_tool_may_be_turned_by_any_angle(base: sp.Expr, tool: str) -> None:
    """A SCARA that stands or hangs: the yaw at home was an arctangent that no lemma reads."""
    d = Derivation("scara", "Scara", Paper("toy", "Toys", ("A.",)), "A SCARA.")
    turned = d.parameter("a", value=sp.Rational(tool), unit="rad", meaning="a", nonnegative=False)
    t1, t2, t4 = map(d.joint, ("t1", "t2", "t4"))
    d3 = d.joint("d3", "prismatic")
    rows = [(0, base, 1, 0), (2, 0, 0, t1), (1, 0, 0, t2), (0, 0, d3, 0), (0, 0, 0, t4)]
    serial = from_dh(d, [*rows, (0, 0, 0, turned)])
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 2


def test_axes_that_meet_at_an_angle_without_roots(tmp_path: Path) -> None:
    """The point where they meet holds the tangent of this angle, which no code can compute."""
    rows = [
        ("0 0 0.05", "0 0 0", "0 0 1"),
        ("0.02 0 0.01", "0 0.174532925199433 0", "1 0 0"),
        ("0 0 0.05", "0 0 0", "1 0 0"),
        ("0 0 0.03", "0 0 0", "1 0 0"),
    ]
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(rows)
    )
    urdf = tmp_path / "bent_finger.urdf"
    urdf.write_text(f'<robot name="bent">{joints}</robot>', "utf-8")
    script = new("bent_finger", "urdf", urdf, search=InverseSearch(fault=fault))
    assert script.structure == "axes 2 and 3 parallel, and 1 joint that turns the tool"
    assert "sin(angle1)/cos(angle1)" in script.text
    assert "the parameter angle1 = 0.174532925199433 rad" in "".join(script.notes)
