"""Files whose lengths were rounded one by one, so that they do not quite cancel."""

from pathlib import Path

import pytest

from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import Table
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import new

ALICIA = [
    ("0 -0.0039812 0.09125", "0 0 1.5708", "0 0 1"),
    ("0.0039812 0 0.0425", "1.5708 0 -1.5708", "0 0 1"),
    ("-0.28184 0.040424 0", "0 0 0", "0 0 -1"),
    ("0.10092 0.028546 0.0036562", "-1.5708 0 -1.5708", "0 0 1"),
    ("0 0.0036562 0.1365", "1.5708 0 0", "0 0 1"),
    ("0 0.091 {last}", "-1.5708 0 0", "0 0 1"),
]
"""Synria's Alicia M 1.1: the last two offsets are both 0.00365625."""


def alicia(folder: Path, last: str) -> Path:
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz.format(last=last)}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(ALICIA, 1)
    )
    path = folder / "alicia.urdf"
    path.write_text(f'<robot name="alicia">{joints}</robot>', "utf-8")
    return path


def across(table: Table) -> set:
    """The coordinates of the axes of the wrist across the plane of the arm."""
    return {at[1] for _, _, at in table.axes[3:]} - {0}


@pytest.mark.parametrize("last", ["0.0036563", "0.0036622"])
def test_axes_that_rounding_parts_meet(tmp_path: Path, last: str) -> None:
    """The wrist was not spherical, by a tenth of a micrometre, and there was no inverse."""
    script = new("alicia", "urdf", alicia(tmp_path, last))
    assert "an inverse with 8 branches" in script.inverse
    assert "with a spherical wrist" in script.inverse
    (note,) = (n for n in script.notes if "with all joints at zero" in n)
    gap = "1e-07" if last.endswith("63") else "6e-06"
    assert note.endswith(f"its y is taken for that of joint q4, {gap} from it")
    assert len(across(read_urdf(alicia(tmp_path, last)))) == 1


def test_an_offset_of_a_hundredth_of_a_millimetre_is_kept(tmp_path: Path) -> None:
    assert len(across(read_urdf(alicia(tmp_path, "0.0036662")))) == 2


def test_lengths_forth_and_back_do_not_cancel_in_printed_code(tmp_path: Path) -> None:
    """The wrist of iCub: its Jacobian lost a digit, and `derive` called the code wrong."""
    axes = (("1 0 0", "0.2289 0 0"), ("0 -1 0", "-0.23935 0 0"), ("0 0 -1", "0 0 0"))
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/></joint>'
        for k, (axis, xyz) in enumerate(axes)
    )
    path = tmp_path / "wrist.urdf"
    path.write_text(f'<robot name="wrist">{joints}</robot>', "utf-8")
    (at,) = {tuple(at) for _, _, at in read_urdf(path).axes}
    assert [float(e) for e in at] == [-0.01045, 0, 0]
    made, printed = str(tmp_path), str(tmp_path / "printed")
    assert main(["new", "wrist", "--from", "urdf", str(path), "-o", made]) == 0
    script = str(tmp_path / "wrist.py")
    assert main(["derive", script, "-o", printed, "--backend", "numpy"]) == 0
