"""The arms of industry among the ready robots, against their URDFs and tables."""

from __future__ import annotations

import csv
import math
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest
from arms import link
from places import ROOT

from closedform import robots

ARMS = ROOT / "benchmarks" / "arms"
FAMILY = [n for n in robots.names() if robots.entries()[n]["family"] == "opw_arm"]
FROM_URDF = [n for n in FAMILY if (ARMS / f"{n}.urdf").exists()]
TO_FLANGE = {"gp8": 0.08, "kr16_2": 0.158}
"""From the last joint of a URDF to the flange, if the file ends before it."""


class Read(NamedTuple):
    """The moving joints of a URDF: the shift before each and its axis; all frames are parallel."""

    shifts: list[np.ndarray]
    axes: list[np.ndarray]
    lower: list[float]
    upper: list[float]


# Joints of files that are not in benchmarks/arms: the shift before each, and after the last one.
ABB, FANUC, KUKA = ("z y y x y x", "z y -y -x -y -x", "-z y y -x y -x")
JOINTS = {
    "irb1200_5_90": (ABB, "0 0 0.3991, 0 0 0, 0 0 0.448, 0 0 0.042, 0.451 0 0, 0.082 0 0, 0 0 0"),
    "irb4600_60_205": (ABB, "0 0 0.495, 0.175 0 0, 0 0 0.9, 0 0 0.175, 0.96 0 0, 0.135 0 0, 0 0 0"),
    "lrmate200id7l": (
        FANUC,
        "0 0 0.330, 0.050 0 0, 0 0 0.440, 0 0 0.035, 0.420 0 0, 0.080 0 0, 0 0 0",
    ),
    "m10ia": (
        FANUC,
        "0 0 0, 0.15 -0.04 0.45, 0 -0.0225 0.6, 0.1805 0.0625 0.2, 0.4595 -0.0565 0, "
        "0.1 0.0565 0, 0 0 0",
    ),
    "m20ia": (FANUC, "0 0 0.525, 0.150 0 0, 0 0 0.790, 0 0 0.250, 0.835 0 0, 0.100 0 0, 0 0 0"),
    "kr10_r1100": (KUKA, "0 0 0.4, 0.025 0 0, 0.56 0 0, 0 0 0.035, 0.515 0 0, 0.08 0 0, 0 0 0"),
}


def read(name: str) -> Read:
    found = Read([], [], [], [])
    for joint in ElementTree.parse(ARMS / f"{name}.urdf").getroot().iter("joint"):
        if joint.get("type") != "revolute":
            continue
        origin, axis, limit = (joint.find(part) for part in ("origin", "axis", "limit"))
        assert origin is not None and axis is not None and limit is not None
        assert origin.get("rpy") is None
        found.shifts.append(np.array(origin.get("xyz", "").split(), float))
        found.axes.append(np.array(axis.get("xyz", "").split(), float))
        found.lower.append(float(limit.get("lower", "nan")))
        found.upper.append(float(limit.get("upper", "nan")))
    return found


def end(arm: Read, q: np.ndarray) -> np.ndarray:
    """The frame of the last link."""
    T = np.eye(4)
    for shift, (x, y, z), angle in zip(arm.shifts, arm.axes, q, strict=True):
        K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        step = np.eye(4)
        step[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
        step[:3, 3] = shift
        T = T @ step
    return T


def table(name: str, q: np.ndarray) -> np.ndarray:
    """The pose by the Denavit-Hartenberg table of a file."""
    turns = {"0": 0.0, "pi/2": math.pi / 2, "-pi/2": -math.pi / 2, "pi": math.pi}
    T = np.eye(4)
    with (ARMS / f"{name}.csv").open() as file:
        lines = [line for line in file if not line.startswith("#")]
    for row, angle in zip(csv.DictReader(lines, skipinitialspace=True), q, strict=True):
        T = T @ link(float(row["a"]), turns[row["alpha"].strip()], float(row["d"]), angle)
    return T


def same_hand(T: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The pose of one hand in the frame of the other, which has to be the same everywhere."""
    between = np.linalg.inv(T) @ other
    assert np.abs(between - between[0]).max() < 1e-12
    return between[0]


POSTURES = np.random.default_rng(7).uniform(-3, 3, (20, 6))


@pytest.mark.parametrize("name", FROM_URDF)
def test_an_arm_is_that_of_its_urdf(name: str) -> None:
    arm, source = robots.load(name), read(name)
    between = same_hand(arm.fk(POSTURES), np.array([end(source, q) for q in POSTURES]))
    assert np.abs(between[:3, 3] + [0, 0, TO_FLANGE.get(name, 0.0)]).max() < 1e-12
    axis = between[:3, :3] @ source.axes[-1]
    assert np.abs(np.abs(axis) - [0, 0, 1]).max() < 1e-12
    assert np.abs(arm.limits.lower - source.lower).max() < 1e-3
    assert np.abs(arm.limits.upper - source.upper).max() < 1e-3


@pytest.mark.parametrize("name", JOINTS)
def test_an_arm_has_the_joints_of_its_file(name: str) -> None:
    axes, shifts = JOINTS[name]
    units = dict(zip(("x", "y", "z"), np.eye(3), strict=True))
    units |= {f"-{axis}": -unit for axis, unit in units.items()}
    *before, after = (np.array(shift.split(), float) for shift in shifts.split(","))
    source = Read(before, [units[axis] for axis in axes.split()], [], [])
    between = same_hand(
        robots.load(name).fk(POSTURES), np.array([end(source, q) for q in POSTURES])
    )
    assert np.abs(between[:3, 3] + between[:3, :3] @ after).max() < 1e-12
    assert np.abs(np.abs(between[:3, :3] @ source.axes[-1]) - [0, 0, 1]).max() < 1e-12


def test_the_irb_140_is_that_of_its_table() -> None:
    there = np.array([table("irb140", q) for q in POSTURES])
    assert np.abs(robots.load("irb140").fk(POSTURES) - there).max() < 1e-12


def test_the_kr_5_is_that_of_its_table() -> None:
    """The table turns axis 1 upwards and counts A3 from the upper arm; its hand is the wrist."""
    turned = POSTURES * [-1, -1, 1, -1, 1, -1] + [0, 0, -math.pi / 2, 0, 0, 0]
    there = np.array([table("kr5", q) for q in turned])
    between = same_hand(robots.load("kr5").fk(POSTURES), there)
    assert np.abs(between[:3, 3] - [0, 0, -0.115]).max() < 1e-12


def test_the_kr_6_r700_is_that_of_its_source() -> None:
    """A pose by MoveIt, from the tests of opw_kinematics in single precision."""
    there = [
        [-0.5965795, 0.000371195, 0.8025539, 0.7341169],
        [-0.2724458, 0.9405218, -0.202958, -0.1520347],
        [-0.7548948, -0.3397331, -0.5609949, 0.182639],
        [0, 0, 0, 1],
    ]
    assert np.abs(robots.load("kr6_r700").fk([0.2] * 6) - there).max() < 1e-6


def test_all_urdfs_of_the_family_were_compared() -> None:
    others = {"irb140", "kr5", "kr6_r700", *JOINTS}
    assert len(FROM_URDF) == 14 and set(FAMILY) - set(FROM_URDF) == others
