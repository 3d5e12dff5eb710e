"""Figures of loops that random joints, or random poses, hardly ever close."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, script_of
from places import TESTS

from closedform import plot
from closedform.plot.catalogue import View, fits, standard
from closedform.plot.robot import Robot

FOLDER = TESTS / "held_out_loops"
OK = 0
SERVOS = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = [30, 6, 0], A2 = [30, -6, 0]}
horn1 = {B1 = [30, 12, 0]}
horn2 = {B2 = [30, -12, 0]}
rod1 = {length = 45}
rod2 = {length = 45}
plate = {P = [0, 0, 0], C1 = [18, 15, 0], C2 = [18, -15, 0]}
[joints]
j1 = {between = ["ground", "horn1"], at = "A1", axis = [1, 0, 0], driven = true}
j2 = {between = ["ground", "horn2"], at = "A2", axis = [-1, 0, 0], driven = true}
b1 = {between = ["horn1", "rod1"], at = "B1", kind = "spherical"}
b2 = {between = ["horn2", "rod2"], at = "B2", kind = "spherical"}
c1 = {between = ["rod1", "plate"], at = "C1", kind = "spherical"}
c2 = {between = ["rod2", "plate"], at = "C2", kind = "spherical"}
"""


def held_out(name: str, folder: Path, unit: int = 1) -> ModuleType:
    """A mechanism of the literature, whose numbers may be in another unit."""
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    if unit != 1:
        bodies, joints = text.split("[joints]")
        text = re.sub(r"\d+\.\d+", lambda m: f"{unit * float(m[0]):.3f}", bodies)
        text += f"[joints]{joints}"
    called = f"{name}_{unit}"
    return derived(called, script_of(called, text, folder), folder)


@pytest.mark.parametrize(
    ("name", "unit"), [("bike_suspension", 1), ("bike_suspension", 1000), ("bonnet", 1)]
)
def test_a_cylinder_is_drawn_where_the_loop_closes(name: str, unit: int, tmp_path: Path) -> None:
    linkage = held_out(name, tmp_path, unit)
    q = plot.posture(linkage)
    assert (linkage.fk(q).status == OK).any()
    plot.mechanism(linkage)
    plot.branches(linkage)
    stroke = np.linspace(*Robot.of(linkage).reach(0), 500)[:, None]
    assert 0.3 < (linkage.fk(stroke).status == OK).any(axis=-1).mean() < 1


def test_the_size_of_a_drawing_does_not_depend_on_the_unit(tmp_path: Path) -> None:
    sizes = []
    for unit in (1, 1000):
        (folder := tmp_path / str(unit)).mkdir()
        sizes.append(Robot.of(held_out("bike_suspension", folder, unit)).size)
    assert 0.3 < sizes[0] < 1.5 and 300 < sizes[1] < 1500


def test_a_platform_of_servos_is_drawn_where_its_rods_reach(tmp_path: Path) -> None:
    servos = derived("servos", script_of("servos", SERVOS, tmp_path), tmp_path)
    assert Robot.of(servos).size > 30
    plot.mechanism(servos)
    assert plot.workspace(servos, resolution=40).collections


def test_a_map_is_over_the_joints_if_there_is_no_inverse(tmp_path: Path) -> None:
    leg = held_out("bird_leg", tmp_path)
    assert not hasattr(leg, "ik") and fits(leg, "conditioning")
    axes = plot.field(leg, "condition", resolution=40)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$q$", "$h$")


STAGE = """
hand = "P"
[bodies]
ground = {O = [0, 0]}
bx = {A = [0, 0]}
by = {B = [0, 0]}
table = {P = [0, 0]}
[joints]
x1 = {between = ["ground", "bx"], at = "O", kind = "prismatic", axis = [1, 0], driven = true}
y1 = {between = ["ground", "by"], at = "O", kind = "prismatic", axis = [0, 1], driven = true}
sx = {between = ["bx", "table"], at = "P", kind = "prismatic", axis = [0, 1]}
sy = {between = ["by", "table"], at = "P", kind = "prismatic", axis = [1, 0]}
"""


@pytest.mark.filterwarnings("error")
def test_a_stage_that_is_a_point_at_zero_is_drawn_elsewhere(tmp_path: Path) -> None:
    stage = derived("stage", script_of("stage", STAGE, tmp_path), tmp_path)
    [figure] = [f for f in standard(View()) if f.name == "mechanism"]
    low, high = figure.draw(stage).get_xlim()
    assert high - low > 0.3
