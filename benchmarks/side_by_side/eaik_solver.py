"""The tasks with EAIK."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .tasks import (
    ALPHA,
    HOME,
    NARROW,
    PATH,
    POSTURES,
    SEEDS,
    TARGETS,
    TOOL,
    A,
    D,
    Way,
    Ways,
    nearest_of,
    urdf,
)

NAME = "EAIK"


def ways() -> Ways:
    from eaik.IK_DH import DhRobot

    arm = DhRobot(ALPHA, A, D)
    back = np.linalg.inv(TOOL)
    targets, tips = list(TARGETS), list(TARGETS @ TOOL)

    def tracked() -> list[np.ndarray]:
        q = [HOME]
        for T in PATH:
            q.append(nearest_of(exact(arm.IK(T)), q[-1]))
        return q[1:]

    def within() -> list[np.ndarray]:
        found = [exact(s) for s in arm.IK_batched(targets, 1)]
        return [q[((q >= NARROW[0]) & (q <= NARROW[1])).all(axis=1)] for q in found]

    return {
        "nearest": Way(
            "no; `arm.IK(T)` and a choice by hand",
            lambda: [nearest_of(exact(arm.IK(T)), q) for T, q in zip(targets, SEEDS, strict=True)],
        ),
        "limits": Way("no; `arm.IK_batched(Ts, 1)` and a comparison by hand", within),
        "tracking": Way("no; `arm.IK(T)` and a choice by hand, in a loop", tracked, len(PATH)),
        "batch": Way(
            "`arm.IK_batched(Ts, 1)`",
            lambda: arm.IK_batched(targets, 1),
            read=lambda found: [exact(s) for s in found],
        ),
        "gradient": Way("no Jacobian"),
        "tool": Way(
            "no; `arm.IK(T @ inv(tool))` and a choice by hand",
            lambda: [
                nearest_of(exact(arm.IK(T @ back)), q) for T, q in zip(tips, SEEDS, strict=True)
            ],
        ),
        "drawing": Way("no"),
        "URDF": Way(
            "`UrdfRobot(path)`, up to the frame of the last joint",
            from_urdf,
            1,
            read=to_flange,
        ),
    }


def exact(found: Any) -> np.ndarray:
    """The solutions without those of least squares, for branches out of reach."""
    return np.asarray(found.Q)[~np.asarray(found.is_LS, dtype=bool)]


def from_urdf() -> Any:
    from eaik.IK_URDF import UrdfRobot

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "ur5e.urdf")
        path.write_text(urdf(), "utf-8")
        return UrdfRobot(str(path))


def to_flange(arm: Any) -> list[np.ndarray]:
    """Its poses, with what it leaves out: the frame of the flange at home, from its last joint."""
    from .tasks import pose

    zero = np.zeros(6)
    last = np.linalg.inv(arm.fwdKin(zero)) @ pose(zero)
    return [arm.fwdKin(q) @ last for q in POSTURES]
