"""Files whose lengths were rounded one by one, so that they do not quite cancel."""

from collections.abc import Sequence
from pathlib import Path

import pytest
import sympy as sp

from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import Table
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import InverseSearch, Script, new, without_short

UNCOUNTED = InverseSearch(count=False)
ALICIA = [
    ("0 -0.0039812 0.09125", "0 0 1.5708", "0 0 1"),
    ("0.0039812 0 0.0425", "1.5708 0 -1.5708", "0 0 1"),
    ("-0.28184 0.040424 0", "0 0 0", "0 0 -1"),
    ("0.10092 0.028546 0.0036562", "-1.5708 0 -1.5708", "0 0 1"),
    ("0 0.0036562 0.1365", "1.5708 0 0", "0 0 1"),
    ("0 0.091 {last}", "-1.5708 0 0", "0 0 1"),
]
"""Synria's Alicia M 1.1: the last two offsets are both 0.00365625."""


LEG = [
    ("0 0.064452 -0.1027", "0 0 0", "0 1 0"),
    ("0 0.052 -0.030465", "0 -0.1749 0", "1 0 0"),
    ("0.025001 0 -0.12412", "0 0 0", "0 0 1"),
    ("-0.078273 0.0021489 -0.17734", "0 0.1749 0", "0 1 0"),
    ("0 -9.4445E-05 -0.30001", "0 0 0", "0 1 0"),
    ("0 0 -0.017558", "0 0 0", "1 0 0"),
]
"""Unitree's G1: the axes of its hip do not meet, by centimetres."""


def written(name: str, rows: Sequence[tuple[str, str, str]], folder: Path) -> Path:
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, rpy, axis) in enumerate(rows, 1)
    )
    path = folder / f"{name}.urdf"
    path.write_text(f'<robot name="{name}">{joints}</robot>', "utf-8")
    return path


def alicia(folder: Path, last: str) -> Path:
    rows = [(xyz.format(last=last), rpy, axis) for xyz, rpy, axis in ALICIA]
    return written("alicia", rows, folder)


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


def test_lengths_that_nearly_cancel_can_be_ignored(tmp_path: Path) -> None:
    """They are long themselves, so that no length of the file could be named or left out."""
    path = alicia(tmp_path, "0.0037562")
    refused = new("alicia", "urdf", path)
    assert "no inverse" in refused.inverse
    assert "y of the joints q4 and q6 differs by 0.0001; " in refused.advice
    script = new("alicia", "urdf", path, choice=Choice(ignore=0.0001))
    assert "with a spherical wrist" in script.inverse
    (note,) = (n for n in script.notes if "with all joints at zero" in n)
    assert note.endswith("0.0001 from it, because of --ignore")
    assert f"with --ignore 0.0001: then {script.inverse}." in refused.advice
    unsure = new("alicia", "urdf", path, search=InverseSearch(fault=lambda *_: "it is wrong"))
    assert "no inverse either; --ignore 0.0001, --ignore " in unsure.advice


def test_leaving_out_what_does_not_help_is_not_suggested(tmp_path: Path) -> None:
    """The leg of a Unitree G1: --ignore 0.0022 was suggested, and there is no inverse with it."""
    path = written("leg", LEG, tmp_path)
    advice = new("leg", "urdf", path).advice
    tried = "--ignore 9.5e-05, --ignore 0.0021 and --ignore 0.0022"
    assert advice.endswith(f"Without short lengths there is no inverse either; {tried} were tried.")
    for length in (9.5e-5, 0.0021, 0.0022):
        found = new("leg", "urdf", path, choice=Choice(ignore=length), search=UNCOUNTED)
        assert "no inverse" in found.inverse


def test_what_is_left_out_is_tried_within_the_limit(tmp_path: Path) -> None:
    """A trial that takes long is given up."""

    def without(*_: object) -> Script:
        while True:
            pass

    table = read_urdf(written("leg", LEG, tmp_path))
    said = without_short(table, InverseSearch(timeout=0.1), without)
    assert said.startswith("The limit of 0.1 s was reached while it was tried")
    assert said.endswith("; --ignore 9.5e-05 was the last.")


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


def test_a_numeric_inverse_is_advised_once(tmp_path: Path) -> None:
    """A shoulder and three axes that are normal to each other, as in the arm of pib."""
    rows = [("0 0 0", "1 0 0"), ("0 0 0", "0 0 1"), ("0 0 0", "-1 0 0"),
            ("0.21634 -0.0379 0.0213", "0 -1 0"), ("0.07644 0.0379 0.04674", "-1 0 -1"),
            ("0.1276 0.0149 0.0908", "1 0 -1")]  # fmt: skip
    joints = "".join(
        f'<joint name="q{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/></joint>'
        for k, (xyz, axis) in enumerate(rows)
    )
    path = tmp_path / "pib.urdf"
    path.write_text(f'<robot name="pib">{joints}</robot>', "utf-8")
    assert new("pib", "urdf", path).advice.count("ssik") == 1
    assert tuple(read_urdf(path).axes[4][1]) == (-sp.sqrt(2) / 2, 0, -sp.sqrt(2) / 2)
