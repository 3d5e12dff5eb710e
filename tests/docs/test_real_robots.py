"""The page of real robots: a row for each file, and rows that come out again."""

import shutil

import pytest

from benchmarks.robots import FOLDER, PAGE, Robot
from benchmarks.robots import rows as written

ROBOTS = {
    path.stem: Robot.read(path)
    for path in sorted(FOLDER.iterdir())
    if path.suffix in (".csv", ".urdf")
}


def rows() -> dict[str, list[list[str]]]:
    """The cells of the page beside the title, one list for each row of a robot."""
    found: dict[str, list[list[str]]] = {}
    for line in PAGE.read_text("utf-8").splitlines():
        if line.startswith("| ["):
            name, *cells = line.strip("| ").split(" | ")
            found.setdefault(name[1:].partition("](")[0], []).append(cells)
    return found


def test_every_file_has_a_row_and_a_source() -> None:
    assert sorted(rows()) == sorted(robot.title for robot in ROBOTS.values())
    assert all(robot.source.startswith("https://") for robot in ROBOTS.values())


@pytest.mark.parametrize("name", ["cobra600", "crx10ia", "cr5", "iiwa14", "x7s_right"])
def test_a_row_comes_out_again(name: str) -> None:
    """All but the times: structure, number of proved branches and lemmas; one row is timed."""
    robot, timed = ROBOTS[name], name == "cobra600" and shutil.which("gcc") is not None
    again = [line.strip("| ").split(" | ")[1:] for line in written(robot, timed=timed)]
    assert again[0][-1].isdigit() == timed
    assert [cells[:3] for cells in again] == [cells[:3] for cells in rows()[robot.title]]
