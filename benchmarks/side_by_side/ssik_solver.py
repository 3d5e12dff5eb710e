"""The tasks with ssik."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .tasks import HOME, NARROW, PATH, POSTURES, SEEDS, TARGETS, TOOL, Way, Ways, urdf

NAME = "ssik"
BASE = np.diag([-1.0, -1, 1, 1])
"""Its base of the arm, that of ROS, is turned by half a turn."""


def ways() -> Ways:
    import ssik
    from ssik import teleop

    arm = ssik.Manipulator.from_prebuilt("ur5e")
    narrow = built(NARROW)
    targets, path, tips = BASE @ TARGETS, BASE @ PATH, BASE @ TARGETS @ TOOL
    nearest = {"max_solutions": 1, "seed_metric": "wrap_l2"}

    def tracked() -> list[np.ndarray]:
        tracker = arm.tracker(HOME)
        return [tracker.update(T).q for T in path]

    return {
        "nearest": Way(
            '`arm.solve(T, q_seed=seed, max_solutions=1, seed_metric="wrap_l2")`',
            lambda: [
                arm.solve(T, q_seed=q, **nearest) for T, q in zip(targets, SEEDS, strict=True)
            ],
            read=first,
        ),
        "limits": Way(
            "`solve(T)` of a module by `ssik build`, with limits; drops what is outside",
            lambda: [narrow.solve(T) for T in TARGETS],
            read=postures,
        ),
        "tracking": Way("`arm.tracker(home).update(T)` in a loop", tracked, len(PATH)),
        "batch": Way(
            "`arm.solve(T, respect_limits=False)` in a loop",
            lambda: [arm.solve(T, respect_limits=False) for T in targets],
            read=postures,
        ),
        "gradient": Way("no Jacobian among its public functions"),
        "tool": Way(
            "`arm.solve(teleop.tcp_to_flange(T, tool), ...)`",
            lambda: [
                arm.solve(teleop.tcp_to_flange(T, TOOL), q_seed=q, **nearest)
                for T, q in zip(tips, SEEDS, strict=True)
            ],
            read=first,
        ),
        "drawing": Way("a viewer in the browser among its examples, `ssik[demo]`"),
        "URDF": Way(
            "`Manipulator.from_urdf(path, base=..., ee=...)`; `ssik build` writes a module",
            from_urdf,
            1,
            read=lambda arm: [arm.fk(q) for q in POSTURES],
        ),
    }


def postures(found: list[Any]) -> list[list[np.ndarray]]:
    return [[solution.q for solution in solutions] for solutions in found]


def first(found: list[Any]) -> list[np.ndarray]:
    return [solutions[0].q for solutions in found]


def built(limits: np.ndarray) -> Any:
    """The module that it writes for a URDF, which is what it recommends for use."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name, "arm.urdf")
        path.write_text(urdf(limits), "utf-8")
        command = [sys.executable, "-m", "ssik.cli", "build", "arm.urdf", "--base", "l0"]
        command += ["--ee", "flange", "--no-validate", "--out", "arm_ik.py"]
        subprocess.run(command, cwd=name, check=True, capture_output=True)
        spec = importlib.util.spec_from_file_location("arm_ik", Path(name, "arm_ik.py"))
        if spec is None or spec.loader is None:
            raise ImportError("ssik has not written a module")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return module


def from_urdf() -> Any:
    import ssik

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "ur5e.urdf")
        path.write_text(urdf(), "utf-8")
        return ssik.Manipulator.from_urdf(path, base="l0", ee="flange")
