"""The ready arms of seven joints, beside the tables and the URDF files of their sources."""

import csv
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from arms import OK
from places import ROOT

from closedform import robots

FOLDER = ROOT / "benchmarks" / "arms"
GUIDE = ROOT / "docs" / "using.md"
RANDOM = np.random.default_rng(5)
ANGLES = {"0": 0.0, "pi/2": math.pi / 2, "-pi/2": -math.pi / 2, "-pi/4": -math.pi / 4}
ARMS = ["iiwa7", "iiwa14", "lwr4", "xmatepro7", "panda", "fr3", "xarm7"]


def turn(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    K = np.cross(axis, np.eye(3)).T
    T = np.zeros((*np.shape(angle), 4, 4))
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    T[..., :3, :3], T[..., 3, 3] = np.eye(3) + s * K + (1 - c) * K @ K, 1
    return T


def shift(*by: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = by
    return T


@pytest.mark.parametrize("name", ["iiwa14", "lwr4", "panda"])
def test_an_arm_is_that_of_its_table(name: str) -> None:
    text = (FOLDER / f"{name}.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    q, T = RANDOM.uniform(-2, 2, (50, 7)), np.eye(4)
    for row in csv.DictReader(lines, skipinitialspace=True):
        theta = row["theta"].strip()
        moved = q[:, int(theta[5:]) - 1] if theta in robots.load(name).joints else ANGLES[theta]
        along_x = shift(float(row["a"]), 0, 0) @ turn(np.eye(3)[0], ANGLES[row["alpha"].strip()])
        along_z = turn(np.eye(3)[2], np.asarray(moved)) @ shift(0, 0, float(row["d"]))
        T = T @ along_x @ along_z if "convention: modified" in text else T @ along_z @ along_x
    assert np.abs(robots.load(name).fk(q) - T).max() < 1e-14


@pytest.mark.parametrize("name", ["iiwa7", "xmatepro7", "fr3", "xarm7"])
def test_an_arm_is_that_of_its_urdf(name: str) -> None:
    """Its axes are rounded; that of the iiwa ends with a fixed frame."""
    arm, q, T = robots.load(name), RANDOM.uniform(-2, 2, (50, 7)), np.eye(4)
    limits = []
    for joint in ElementTree.parse(FOLDER / f"{name}.urdf").getroot().iter("joint"):
        origin = joint.find("origin")
        T = T @ shift(*map(float, origin.get("xyz").split()))
        for axis, angle in zip(
            np.eye(3)[::-1], origin.get("rpy", "0 0 0").split()[::-1], strict=True
        ):
            T = T @ turn(axis, np.asarray(float(angle)))
        if joint.get("type") == "revolute":
            axis = np.array(joint.find("axis").get("xyz").split(), float)
            T = T @ turn(axis / np.linalg.norm(axis), q[:, len(limits)])
            bounds = joint.find("limit")
            limits.append([float(bounds.get("lower")), float(bounds.get("upper"))])
    assert np.abs(arm.fk(q) - T).max() < 4e-5
    assert np.abs(np.array(limits).T - arm.limits).max() < 1e-3


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("compiled", [False, True])
def test_nearest_and_track_keep_what_is_given(name: str, compiled: bool) -> None:
    arm = robots.load(name, compiled=compiled, base=[0, 0, 0.5], tool=[0.02, 0, 0.1])
    lower, upper = np.maximum(arm.limits.lower, -3), np.minimum(arm.limits.upper, 3)
    q = lower + (upper - lower) * (0.3 + 0.4 * RANDOM.random((200, 7)))
    T, given = arm.fk(q), arm.given_at(q)
    found = arm.nearest(T, q)
    assert np.abs(found.q - q).max() < 1e-6 and (found.status == OK).all()
    every = arm.ik(T, given)
    reached = arm.fk(every.q)[every.status == OK]
    wanted = np.broadcast_to(T[:, None], (*every.status.shape, 4, 4))[every.status == OK]
    assert np.abs(reached - wanted).max() < 1e-11
    xs = np.repeat(T[:1], 50, axis=0)
    xs[:, 2, 3] -= np.linspace(0, 0.01, 50)
    path = arm.track(xs, q[0])
    assert (path.status == OK).all() and not path.jump.any()
    assert np.ptp(np.unwrap(arm.given_at(path.q))) < 1e-9
    assert np.abs(arm.fk(path.q) - xs).max() < 1e-12
    rates = arm.joint_rates(q, [0.1, 0, 0, 0, 0.2, 0])
    assert np.abs(arm.twist(q, rates.qdot) - [0.1, 0, 0, 0, 0.2, 0]).max() < 1e-9
    assert np.abs(arm.frames(q)[:, -1] - T).max() < 1e-12


def test_the_example_of_the_guide_runs_as_printed() -> None:
    [code] = re.findall(r"^```python seven\n(.*?)^```", GUIDE.read_text("utf-8"), re.M | re.S)
    names: dict = {}
    exec(code, names)
    assert names["found"].q.shape == (73, 8, 7)
    assert 0 < names["inside"].sum() < names["inside"].size
