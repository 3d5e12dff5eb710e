"""Files whose frames are turned by many angles, as exporters of CAD programs write them."""

import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from test_urdf import forward

from closedform.scaffold.inputs.exact import orthonormal, unit_vector
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import new

ICUB = [
    ("-0.12001599980926501 0.0928 0.0079692999", "0 -0.523598883792035 3.141592653589793",
     "-0.965925926173269 0 0.25881927552505174"),
    ("-0.007580465732273667 0 0.014210246363868029",
     "-0.2705976115829963 -0.252680154648383 -1.5015568003498745",
     "-0.258819 -2.0285226262510233e-17 -0.965926"),
    ("-0.025346071323150046 2.3275042730641626e-07 -0.0053876480645656255",
     "-0.2526895461750575 0.008518618321396994 0.06703988914196896",
     "0.9659258438815126 -2.220446049250313e-16 -0.2588189794466167"),
    ("-0.05089730176650909 0 0.029167029620599215", "0 -1.3089970069677397 0", ""),
    ("0 -0.0224999 0.07926", "0 1.3089970069677397 0", "2.22e-16 1.0000000000000002 0"),
    ("-0.0384624299026574 0.0224999 -0.0052231681940338075", "0 0 0",
     "0.9659258438815126 -2.220446049250313e-16 -0.2588189794466167"),
    ("-0.1035052088730253 7e-06 0.02519770299355497", "0 0 0",
     "0.2588189794466167 0 0.9659258438815124"),
    ("0.0006341064996442103 -0.0194999 0.002366518317509704", "0 0 0", "0 -1.0000000000000002 0"),
]  # fmt: skip
"""The right arm of iCub 2.7: three axes meet in the shoulder and two in the wrist."""


def icub(folder: Path, beside: str = "") -> Path:
    joints = "".join(
        f'<joint name="q{k}" type="{"revolute" if axis else "fixed"}"><parent link="l{k}"/>'
        f'<child link="l{k + 1}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
        f"{f'<axis xyz={axis!r}/>' if axis else ''}</joint>"
        for k, (xyz, rpy, axis) in enumerate(ICUB)
    )
    path = folder / "icub.urdf"
    path.write_text(f'<robot name="icub">{joints}{beside}</robot>', "utf-8")
    return path


def test_an_arm_whose_frames_have_many_angles_is_read(tmp_path: Path) -> None:
    """Products of the turns took minutes to expand, without any limit of time."""
    path = icub(tmp_path)
    script = new("icub", "urdf", path)
    assert "an inverse with 8 branches is proposed" in script.inverse
    assert "angle1" not in script.text
    (note,) = (n for n in script.notes if "other numbers" in n)
    moved, turned = (float(n) for n in re.findall(r"by at most ([\d.e-]+)", note))
    assert moved < 2e-5 and turned < 1e-5
    namespace: dict = {}
    exec(script.text.split("# The inverse")[0], namespace)
    arm = namespace["arm"]
    pose, away = sp.lambdify(arm.joints, arm.pose, "numpy"), 0.0
    for q in np.random.default_rng(1).uniform(-3, 3, (200, 7)):
        there, here = forward(path.read_text("utf-8"), q), np.array(pose(*q), dtype=float)
        away = max(away, float(np.linalg.norm(there[:3, 3] - here[:3, 3])))
    assert moved / 20 < away <= moved


def test_axes_that_nearly_meet_share_a_point(tmp_path: Path) -> None:
    table = read_urdf(icub(tmp_path))
    shoulder = [tuple(at) for _, _, at in table.axes[:3]]
    assert len(set(shoulder)) == 1
    assert all(orthonormal(sp.Matrix(w)) for _, w, _ in table.axes)
    assert [tuple(w) for _, w, _ in table.axes[:3]] == [(0, 0, 1), (1, 0, 0), (0, 1, 0)]


def test_what_is_beside_the_chain_is_not_read(tmp_path: Path) -> None:
    """A humanoid has 200 joints, of which an arm has nine: reading it took half a minute."""
    finger = (
        '<joint name="f" type="fixed"><parent link="l3"/><child link="f"/>'
        '<origin xyz="0 0 none"/></joint>'
    )
    table = read_urdf(icub(tmp_path, finger), choice=Choice(tool="l8"))
    assert len(table.axes) == 7


@pytest.mark.parametrize("roots", [True, False])
def test_a_direction_normal_to_two_others_is_written_out(roots: bool) -> None:
    tilted = [sp.Matrix([sp.cos(sp.pi / 12), 0, -sp.sin(sp.pi / 12)]),
              sp.Matrix([-sp.sin(sp.pi / 12), 0, -sp.cos(sp.pi / 12)])]  # fmt: skip
    assert unit_vector(
        sp.Matrix([0, sp.Rational("0.999999"), 0]), tilted, roots=roots
    ) == sp.Matrix([0, 1, 0])
    diagonal = sp.Matrix([sp.Rational("0.707107"), sp.Rational("0.707107"), 0])
    found = unit_vector(diagonal, roots=roots)
    assert found is not None and all(e.is_Rational for e in found) is not roots


def test_a_small_coordinate_with_nine_decimals_is_kept() -> None:
    """The mount of an arm of Romeo was turned by 4e-7 rad: 0.000000383 was taken for 0."""
    given = sp.Matrix([sp.Rational(text) for text in ("3.83e-7", "0.173635", "0.984810")])
    given[2] = sp.Rational(round((1 - 0.173635**2) ** 0.5 * 10**9), 10**9)
    found = unit_vector(given, roots=False)
    assert found is not None and found.dot(found) == 1
    assert max(abs(float(a - b)) for a, b in zip(found, given, strict=True)) < 1e-9


ROMEO = [
    "0.417025 0.895055 -0.15801", "0.0401398 0.155542 0.987013", "0.998889 0.0139984 0.044995",
    "-0.0449994 0 0.998987", "0.998987 0 0.0449994", "-0.0449994 0 0.998987", "0 1 0",
]  # fmt: skip
"""The axes of an arm of a Romeo, in frames that are not turned."""


def test_right_angles_that_need_long_numbers_are_left_out(tmp_path: Path) -> None:
    """The fifth axis had 64 digits, and a derivation did not end within 200 s."""
    joints = "".join(
        f'<joint name="q{k}" type="continuous"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{0.1 * (k > 1)} 0 0"/><axis xyz="{axis}"/></joint>'
        for k, axis in enumerate(ROMEO)
    )
    path = tmp_path / "romeo.urdf"
    path.write_text(f'<robot name="romeo">{joints}</robot>', "utf-8")
    found = [sp.Matrix(w) for _, w, _ in read_urdf(path).axes]
    for w, axis in zip(found, ROMEO, strict=True):
        assert w.dot(w) == 1 and all(int(e.q).bit_length() <= 62 for e in w)
        np.testing.assert_allclose(
            np.array(w, float).ravel(), [float(e) for e in axis.split()], atol=1e-6
        )
    assert found[3] == found[5] and found[3].dot(found[4]) == 0
