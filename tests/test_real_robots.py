"""The page of real robots: a row for each file, and rows that come out again."""

import shutil

import pytest

from benchmarks.robots import FOLDER, PAGE, Robot, row

ROBOTS = {
    path.stem: Robot.read(path)
    for path in sorted(FOLDER.iterdir())
    if path.suffix in (".csv", ".urdf")
}


def rows() -> dict[str, list[str]]:
    """The cells of the page beside the title."""
    found = {}
    for line in PAGE.read_text("utf-8").splitlines():
        if line.startswith("| ["):
            name, *cells = line.strip("| ").split(" | ")
            found[name[1:].partition("](")[0]] = cells
    return found


def test_every_file_has_a_row_and_a_source() -> None:
    assert sorted(rows()) == sorted(robot.title for robot in ROBOTS.values())
    assert all(robot.source.startswith("https://") for robot in ROBOTS.values())


@pytest.mark.parametrize("name", ["cobra600", "irb120", "crx10ia", "cr5"])
def test_a_row_comes_out_again(name: str) -> None:
    """All but the times: structure, number of proved branches and lemmas."""
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler")
    robot = ROBOTS[name]
    _, *cells = row(robot).strip("| ").split(" | ")
    assert cells[:3] == rows()[robot.title][:3]
