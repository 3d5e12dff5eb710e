"""Arms whose tool is on the last axis, as where a file ends with the link of the last joint."""

from pathlib import Path

import pytest
from proposals import Proposals
from sympy import Rational, pi

from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.new import new

H = Rational(1, 2)
ARMS = Proposals(
    {
        "three joints": (
            [(0, pi / 2, 1), (1, 0, 0), (0, 0, 0)],
            "a turret and a joint, and 1 joint that turns the tool",
            1,
        ),
        "oblique": (
            [(H, pi / 3, 1), (1, pi / 4, H), (0, 0, 0)],
            "a turret and a joint, and 1 joint that turns the tool",
            2,
        ),
        "four joints": (
            [(0, pi / 2, 1), (1, 0, 0), (1, pi / 2, 0), (0, 0, 0)],
            "axes 2 and 3 parallel, which point the last, and 1 joint that turns the tool",
            2,
        ),
    }
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("printed")


@pytest.mark.parametrize("name", ARMS.arms)
def test_the_pose_is_their_task(name: str, folder: Path) -> None:
    """They were refused as singular, because the joints move the origin in two ways only."""
    ARMS.reach_every_pose(name, folder)
    ARMS.are_all(name, folder)


URDF = """<robot name="arm">{}</robot>"""
JOINT = (
    '<joint name="j{0}" type="continuous"><parent link="l{1}"/><child link="l{0}"/>'
    '<origin xyz="{2}"/><axis xyz="{3}"/></joint>'
)


def written(tmp_path: Path, *joints: tuple[str, str]) -> Path:
    path = tmp_path / "arm.urdf"
    rows = (JOINT.format(k, k - 1, xyz, axis) for k, (xyz, axis) in enumerate(joints, 1))
    path.write_text(URDF.format("".join(rows)), "utf-8")
    return path


ARM = (("0 0 0.1", "0 0 1"), ("0 0 0.1", "0 1 0"), ("0.3 0 0", "0 1 0"))


def test_a_note_says_that_a_tool_may_be_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, *ARM)
    assert main(["new", "short", "--from", "urdf", str(path), "-o", str(tmp_path)]) == 0
    assert "is on the axis of j3, which only turns the tool" in capsys.readouterr().err


@pytest.mark.parametrize(("base", "tool"), [("l3", ""), ("l1", "l1"), ("", "l0")])
def test_a_chain_without_joints_is_refused(base: str, tool: str, tmp_path: Path) -> None:
    """It was an IndexError."""
    path = written(tmp_path, *ARM)
    with pytest.raises(TableError, match=f"no joint leads from {base or tool} to the tool"):
        new("arm", "urdf", path, choice=Choice(base=base, tool=tool))


@pytest.mark.parametrize(
    ("xyz", "hint"),
    [
        ("0, 0, 0.1", "numbers are separated by spaces alone"),
        ("0 0 ${h}", "xacro, which expands them"),
        ("0 0 ${h - 1}", "xacro, which expands them"),
    ],
)
def test_what_is_no_number_in_a_file_is_explained(xyz: str, hint: str, tmp_path: Path) -> None:
    path = written(tmp_path, (xyz, "0 0 1"), *ARM[1:])
    with pytest.raises(TableError, match=hint):
        new("arm", "urdf", path)
