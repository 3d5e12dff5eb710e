"""Joints whose origins turn them about their own axes, by angles without square roots."""

import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp
from arms import OK, by_screws, misses, turned_by
from chains import printed
from places import TESTS

from closedform.mechanics.arm import RowError, from_screws
from closedform.model.derivation import Derivation, Paper
from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import InverseSearch, new

ROMEO = TESTS / "urdf" / "romeo_left_arm.urdf"


def numbers(element: Any, key: str) -> np.ndarray:
    return np.array([float(x) for x in element.get(key).split()])


def in_the_file(q: np.ndarray, file: Path = ROMEO) -> np.ndarray:
    """The pose of the hand, read from a file as numbers."""
    T, values = np.eye(4), list(np.moveaxis(q, -1, 0))
    for joint in ElementTree.parse(file).getroot().iter("joint"):
        origin, axis = joint.find("origin"), joint.find("axis")
        step = np.eye(4)
        for k, angle in zip((2, 1, 0), numbers(origin, "rpy")[::-1], strict=True):
            step = step @ turned_by(np.eye(3)[k], angle)
        step[:3, 3] = numbers(origin, "xyz")
        T = T @ step
        if axis is not None:
            T = T @ turned_by(numbers(axis, "xyz"), values.pop(0))
    return T


def test_the_arm_of_romeo_is_solved(tmp_path: Path) -> None:
    """Its shoulder and its elbow have offsets of 0.43 and 0.17 rad; it ran into the limit."""
    start = time.process_time()
    found = new("romeo", "urdf", ROMEO, search=InverseSearch(fault=fault))
    assert time.process_time() - start < 30
    assert found.structure == "spherical wrist, axes 1 and 2 meet, with LElbowRoll given"
    path = tmp_path / "romeo.py"
    path.write_text(found.text, "utf-8")
    (source,) = scripts.find([str(path)])
    robot = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(3).uniform(-3, 3, (300, 7))
    T = in_the_file(q)
    np.testing.assert_allclose(robot.pose(q), T, atol=1e-8)  # -1.57079633 is taken for -pi/2
    T = robot.pose(q)
    answers, status = robot.ik(T, q[:, 2])
    away, turned = misses(robot.pose(answers), T, status)
    assert away < 1e-12 and turned < 1e-12 and (status == OK).any(axis=-1).all()
    off = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert (np.nanmin(off, axis=1) < 1e-6).all()


def test_its_axes_are_those_of_an_arm_without_offsets() -> None:
    table = read_urdf(ROMEO)
    entries = [e for _, w, p in table.axes for e in (*w, *p)] + list(table.home)
    assert not {s for e in entries for s in e.free_symbols}
    added = [{s.name for s in joint.free_symbols} - set(table.joints) for joint, _, _ in table.axes]
    values = [[table.parameters[name]["value"] for name in names] for names in added]
    assert values == [[], ["0.430457"], ["0.17452"], [], [], [], []]


def derivation() -> Derivation:
    return Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")


def test_axes_at_home_take_an_angle_that_is_added_to_a_joint() -> None:
    d = derivation()
    t1, t2 = d.joint("t1"), d.joint("t2")
    home = sp.Matrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    axes = [(t1 + sp.pi / 6, (0, 0, 1), (0, 0, 0)), (t2, (0, 0, -1), (2, 0, 0))]
    arm = from_screws(d, axes, home)
    q = np.random.default_rng(1).uniform(-3, 3, (20, 2))
    screws = [((0, 0, 1), (0, 0, 0)), ((0, 0, -1), (2, 0, 0))]
    expected = by_screws(screws, np.array(home, float), q + np.array([np.pi / 6, 0]))
    for pose in (arm.pose, sp.prod(arm.moves)):
        at = sp.lambdify(arm.joints, pose, "numpy")
        np.testing.assert_allclose([at(*row) for row in q], expected, atol=1e-14)


def test_a_slide_takes_no_offset() -> None:
    d = derivation()
    d1 = d.joint("d1", "prismatic")
    with pytest.raises(RowError, match="d1 slides; put 2 into the points after it"):
        from_screws(d, [(d1 + 2, (0, 0, 1), (0, 0, 0))], sp.eye(4))


OFFSETS = """# beta = 0.3 rad: offset of the shoulder
# gamma = 0.2 rad: offset of the wrist
theta,d,a,alpha
theta1,0.1,0,pi/2
theta2 + beta,0,-0.4,0
theta3,0,-0.39,0
theta4 + gamma,0.1,0,pi/2
theta5,0.1,0,-pi/2
theta6,0.08,0,0
"""


def test_offsets_of_parallel_joints_may_be_any_parameters(tmp_path: Path) -> None:
    """The last of the parallel joints is a sum, whose size is not known with an offset in it."""
    table = tmp_path / "offsets.csv"
    table.write_text(OFFSETS, "utf-8")
    script = new("offsets", "dh", table, search=InverseSearch(fault=fault))
    path = tmp_path / "offsets.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    module = printed(scripts.load(source), tmp_path / "printed")
    rng = np.random.default_rng(2)
    q, params = rng.uniform(-3, 3, (500, 6)), module.Parameters(*rng.uniform(-9, 9, (2, 500)))
    T = module.pose(q, params)
    answers, status = module.ik(T, params)
    away, turned = misses(module.pose(answers, params._replace(
        **{n: getattr(params, n)[:, None] for n in params._fields})), T, status)  # fmt: skip
    assert away < 1e-12 and turned < 1e-12 and (np.abs(answers[status == OK]) <= np.pi).all()
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-8


def test_a_tilt_that_a_joint_turns_back_is_its_offset(tmp_path: Path) -> None:
    """The shoulder of a Fourier GR-1: sines of the tilt stood in each axis and each length."""
    rows = [
        ("0 0.1 0.2", "0.43275 0 0", "0 1 0"),
        ("0 0.0951 0", "-0.43275 0 0", "1 0 0"),
        ("0 0.04 -0.0709", "0 0 0", "0 0 1"),
        ("0 0 -0.18", "0 0 0", "0 1 0"),
    ]
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(rows)
    )
    path = tmp_path / "gr1.urdf"
    path.write_text(f'<robot name="gr1">{joints}</robot>', "utf-8")
    table = read_urdf(path)
    assert [tuple(w) for _, w, _ in table.axes] == [(0, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0)]
    assert all(e.is_Rational for _, _, at in table.axes for e in at)
    assert [len(joint.free_symbols) for joint, *_ in table.axes] == [1, 2, 1, 1]


ICUB = [
    ("0.005 0.143 -0.11", "1.309 0 1.5708", "0 0 -1"),
    ("0 0 0", "1.5708 0 -1.5708", "0 0 -1"),
    ("0 0 -0.15228", "-1.5708 1.309 0", "0 0 -1"),
    ("0.015 0 0", "1.5708 0 0", "0 0 1"),
    ("0 -0.1373 0", "-1.5708 0 0", "0 0 1"),
]
"""The shoulder and the elbow of an arm of an iCub, whose third joint is 75 degrees from zero."""


def test_a_turn_with_roots_about_the_axis_of_a_joint_is_its_offset(tmp_path: Path) -> None:
    """Sums of roots of 2 and 6 stood in all axes after it, and a derivation took 25 s."""
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(ICUB)
    )
    path = tmp_path / "icub.urdf"
    path.write_text(f'<robot name="icub">{joints}</robot>', "utf-8")
    table = read_urdf(path)
    assert all(e in (-1, 0, 1) for _, w, _ in table.axes for e in w)
    assert all(e.is_Rational for _, _, at in table.axes for e in at)
    d = derivation()
    symbols = {name: d.joint(name) for name in table.joints}
    axes = [(q.xreplace({s: symbols[s.name] for s in q.free_symbols}), w, p)
            for q, w, p in table.axes]  # fmt: skip
    arm = from_screws(d, axes, table.home, base=table.base)
    at = sp.lambdify(arm.joints, arm.pose, "numpy")
    q = np.random.default_rng(5).uniform(-3, 3, (20, len(ICUB)))
    expected = np.eye(4)
    for k, row in enumerate(ICUB):
        xyz, rpy, axis = (np.array([float(x) for x in text.split()]) for text in row)
        step = np.eye(4)
        for i in (2, 1, 0):
            step = step @ turned_by(np.eye(3)[i], rpy[i])
        step[:3, 3] = xyz
        expected = expected @ step @ turned_by(axis, q[:, k])
    np.testing.assert_allclose([at(*row) for row in q], expected, atol=1e-4)


THUMB = """<robot name="thumb">
<link name="palm"/><link name="base"/><link name="pad"/><link name="end"/><link name="tip"/>
<joint name="yaw" type="continuous"><parent link="palm"/><child link="base"/>
<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="pitch" type="continuous"><parent link="base"/><child link="pad"/>
<origin xyz="0.03 -0.008 0" rpy="-1.5707963267949 0.0375 -0.228"/><axis xyz="0 0 1"/></joint>
<joint name="bend" type="continuous"><parent link="pad"/><child link="end"/>
<origin xyz="0.05 0.005 0" rpy="0 0 -0.124"/><axis xyz="0 0 1"/></joint>
<joint name="end" type="fixed"><parent link="end"/><child link="tip"/>
<origin xyz="0.035 0.001 0" rpy="0 0 0"/></joint>
</robot>"""
"""Of the hand of a Fourier GR-1: the links are oblique in frames that are turned as well."""


def test_a_sum_of_offsets_that_are_not_numbers_is_an_angle(tmp_path: Path) -> None:
    """Nothing was printed: "the range of ... is not known, so it cannot be moved"."""
    path = tmp_path / "thumb.urdf"
    path.write_text(THUMB, "utf-8")
    (tmp_path / "thumb.py").write_text(new("thumb", "urdf", path).text, "utf-8")
    (source,) = scripts.find([str(tmp_path / "thumb.py")])
    robot = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (300, 3))
    x = in_the_file(q, path)[:, :3, 3]
    answers, status = robot.ik(x)
    assert (np.abs(answers[status == OK]) <= np.pi).all()
    away = np.abs(np.exp(1j * (answers - q[:, None])) - 1).max(axis=-1)
    assert np.nanmin(away, axis=1).max() < 1e-7
    assert np.nanmax(np.abs(robot.fk(answers) - x[:, None])) < 1e-13
