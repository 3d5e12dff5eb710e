"""The ready robots: their tables, and poses by the tables that their makers publish."""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from places import ROOT

from closedform import irb260, robots
from closedform.cli.commands import main

ARMS = ROOT / "benchmarks" / "arms"


def dh(rows: list[tuple[float, float, float, float]]) -> np.ndarray:
    """The pose of a chain with rows (a, alpha, d, theta), standard convention."""
    T = np.eye(4)
    for a, alpha, d, theta in rows:
        (c, s), (ca, sa) = (math.cos(theta), math.sin(theta)), (math.cos(alpha), math.sin(alpha))
        T = T @ [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
    return T


@pytest.mark.parametrize("name", robots.names())
def test_every_robot_has_sources_and_reaches_its_own_poses(name: str) -> None:
    entry = robots.entries()[name]
    parts = [entry, *(entry[k] for k in ("limits", "zero", "base", "tool") if k in entry)]
    assert all(len(part["source"]) > 20 for part in parts)
    assert set(entry) <= {
        "title", "family", "source", "parameters", "limits", "zero", "base", "tool"
    }  # fmt: skip
    arm = robots.load(name)
    assert set(entry["parameters"]) == set(arm.module.Parameters._fields)
    lower = np.where(np.isfinite(arm.limits.lower), arm.limits.lower, -3.0)
    upper = np.where(np.isfinite(arm.limits.upper), arm.limits.upper, 3.0)
    q = lower + (upper - lower) * np.random.default_rng(0).random((20, len(lower)))
    found = arm.nearest(arm.fk(q), q)
    assert np.abs(found.q - q).max() < 1e-6
    assert repr(arm).startswith(f"<Robot {name}")


@pytest.mark.parametrize("name", ["ur3", "ur5", "ur10", "ur5e", "ur10e"])
def test_a_universal_robot_is_that_of_the_makers_table(name: str) -> None:
    with (ARMS / f"{name}.csv").open() as file:
        lines = [line for line in file if not line.startswith("#")]
    turns = {"0": 0.0, "pi/2": math.pi / 2, "-pi/2": -math.pi / 2}
    q = [0.3, -1.2, 1.5, 0.4, -0.7, 2.1]
    rows = [
        (float(row["a"]), turns[row["alpha"].strip()], float(row["d"]), angle)
        for row, angle in zip(csv.DictReader(lines, skipinitialspace=True), q, strict=True)
    ]
    assert np.abs(robots.load(name).fk(q) - dh(rows)).max() < 1e-12


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def numbers(joint: ElementTree.Element, part: str, key: str) -> np.ndarray:
    found = joint.find(part)
    assert found is not None
    return np.array([float(value) for value in found.get(key, "0 0 0").split()])


X, Y, Z = np.eye(3)


def walked(chain: Iterable[tuple[Any, np.ndarray, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and position at the end of steps, each a shift and then a turn about an axis."""
    R, p = np.eye(3), np.zeros(3)
    for shift, axis, angle in chain:
        p, R = p + R @ shift, R @ turn(axis, angle)
    return R, p


@pytest.mark.parametrize("path", sorted(ARMS.glob("ur*.urdf")), ids=lambda path: path.stem)
def test_a_universal_robot_is_that_of_its_urdf(path: Path) -> None:
    q = [0.3, -1.2, 1.5, 0.4, -0.7, 2.1]
    chain: list[tuple[Any, np.ndarray, float]] = [(0 * X, Z, math.pi)]  # x is the other way
    angles = iter(q)
    for joint in ElementTree.parse(path).getroot().iter("joint"):
        roll, pitch, yaw = numbers(joint, "origin", "rpy")
        chain += [(numbers(joint, "origin", "xyz"), Z, yaw), (0 * X, Y, pitch), (0 * X, X, roll)]
        if joint.get("type") == "revolute":
            chain.append((0 * X, numbers(joint, "axis", "xyz"), next(angles)))
    R, p = walked(chain)
    T = robots.load(path.stem).fk(q)
    assert np.abs(T[:3, 3] - p).max() < 1e-12
    assert np.abs(T[:3, 2] - R[:, 2]).max() < 1e-7  # the axis of the tool; angles have nine digits


def test_the_motors_of_the_irb_2400_move_the_chain_of_its_urdf() -> None:
    m = [0.3, -0.4, 0.5, 0.6, -0.7, 0.8]
    R, p = walked(
        [
            ((0, 0, 0), Z, m[0]),
            ((0.1, 0, 0.615), Y, m[1]),
            ((0, 0, 0.705), Y, m[2] - m[1]),
            ((0.258, 0, 0.135), X, m[3]),
            ((0.497, 0, 0), Y, m[4]),
            ((0.085, 0, 0), X, m[5]),
        ]
    )
    T = robots.load("irb2400").fk(m)
    assert np.abs(T[:3, 3] - p).max() < 1e-12
    assert np.abs(T[:3, 2] - R[:, 0]).max() < 1e-12  # the tool points along x of that model


def test_the_robots_of_the_robotics_toolbox_have_its_poses() -> None:
    q1, q2, q3, q4, q5, q6 = q = [0.3, -0.5, 0.6, 0.4, -0.7, 2.1]
    right = math.pi / 2
    puma = [
        (0, right, 0.672, q1),
        (0.4318, 0, 0, q2),
        (0.0203, -right, 0.15005, q3),
        (0, right, 0.4318, q4),
        (0, -right, 0, q5),
        (0, 0, 0, q6),
    ]
    stanford = [
        (0, -right, 0.412, q1),
        (0, right, 0.154, q2),
        (0, 0, q3, -right),
        (0, -right, 0, q4),
        (0, right, 0, q5),
        (0, 0, 0.263, q6),
    ]
    assert np.abs(robots.load("puma560").fk(q) - dh(puma)).max() < 1e-12
    assert np.abs(robots.load("stanford_arm").fk(q) - dh(stanford)).max() < 1e-12
    cobra = dh([(0.325, 0, 0.387, q1), (0.275, math.pi, 0, q2), (0, 0, 0.1, 0), (0, 0, 0, q4)])
    assert np.abs(robots.load("cobra600").pose([q1, q2, 0.1, q4]) - cobra).max() < 1e-12


def test_the_irb_260_is_driven_by_its_motors() -> None:
    arm = robots.load("irb260")
    motors = np.array([0.3, 0.4, -0.2, 1.0])
    expected = irb260.fk(irb260.joints_from_motors(motors))
    assert np.abs(arm.fk(motors) - expected).max() < 1e-15
    found = arm.ik(expected)
    assert np.nanmin(np.abs(found.q - motors).max(-1)) < 1e-12
    assert arm.nearest(expected, motors + np.array([0, 0, 6.0, -6.0])).q == pytest.approx(
        motors + np.array([0, 0, 2, -2]) * math.pi
    )
    assert np.abs(arm.jacobian(motors) - irb260.jacobian_motors(
        irb260.joints_from_motors(motors)
    )).max() < 1e-15  # fmt: skip


def test_a_robot_is_loaded_with_changes() -> None:
    fast = robots.load("ur5e", tool=[0, 0, 0.1])
    q = [0.3, -1.2, 1.5, 0.4, -0.7, 2.1]
    plain = robots.load("ur5e", compiled=False)
    assert np.allclose(fast.fk(q)[:3, 3], plain.fk(q)[:3, 3] + 0.1 * plain.fk(q)[:3, 2])
    other = plain.replace(tool=[0, 0, 0.1])
    assert np.allclose(other.fk(q), fast.fk(q)) and other.limits == plain.limits
    with pytest.raises(ValueError, match="no robot 'UR5E'; did you mean ur5e"):
        robots.load("UR5E")


def test_a_robot_takes_the_compiled_module_where_there_is_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    compiled, plain = (f"closedform.generated.{language}.ur_arm" for language in ("c", "numpy"))
    assert robots.load("ur5e").module.__name__ == compiled
    assert robots.load("ur5e", compiled=False).module.__name__ == plain
    monkeypatch.setitem(sys.modules, compiled, None)  # as where no C was compiled
    assert robots.load("ur5e").module.__name__ == plain
    with pytest.raises(ImportError):
        robots.load("ur5e", compiled=True)


def test_the_command_lists_the_robots(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--robots"]) == 0
    listed = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in listed] == robots.names()
    families = [robots.entries()[line.split()[0]]["family"] for line in listed]
    columns = {line.index(f" {family} ") for line, family in zip(listed, families, strict=True)}
    assert len(columns) == 1
    assert main(["list", "--robots", "--sources"]) == 0
    assert capsys.readouterr().out.count("    parameters: ") == len(listed)
