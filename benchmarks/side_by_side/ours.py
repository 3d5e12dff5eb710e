"""The tasks with closedform."""

from __future__ import annotations

import importlib
import subprocess
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import numpy as np
from closedform.generated.c import ur_arm

from closedform import plot, robots

from .tasks import HOME, LIMITS, NARROW, PATH, POSTURES, SEEDS, TARGETS, TOOL, Way, Ways, urdf

NAME = "closedform"


def ways() -> Ways:
    arm = robots.load("ur5e", compiled=True, limits=LIMITS)
    with_tool = arm.replace(tool=TOOL)
    tips = TARGETS @ TOOL

    def limits() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        q, status = arm.ik(TARGETS)
        return q, status, arm.outside(q, limits=NARROW)

    return {
        "nearest": Way("`arm.nearest(Ts, q_seed=seeds)`", lambda: arm.nearest(TARGETS, SEEDS).q),
        "limits": Way(
            "`arm.outside(arm.ik(Ts).q, limits=narrow)` says which joint of which branch",
            limits,
            read=lambda found: [
                q[(status == 0) & ~outside.any(axis=-1)]
                for q, status, outside in zip(*found, strict=True)
            ],
        ),
        "tracking": Way("`arm.track(Ts, q0=home)`", lambda: arm.track(PATH, HOME).q, len(PATH)),
        "batch": Way(
            "`arm.ik(Ts)`",
            lambda: arm.ik(TARGETS),
            read=lambda found: [q[s == 0] for q, s in zip(*found, strict=True)],
        ),
        "gradient": Way(
            "`arm.jacobian(qs)`; the array modules also by `jax` and PyTorch",
            lambda: arm.jacobian(POSTURES),
        ),
        "tool": Way(
            "`arm.replace(tool=tool).nearest(Ts, q_seed=seeds)`",
            lambda: with_tool.nearest(tips, SEEDS).q,
        ),
        "drawing": Way(
            "`plot.mechanism(ur_arm, q, params=arm.parameters)`",
            lambda: drawn(arm),
            1,
            read=lambda _: arm.frames(HOME)[1:, :3, 3],
        ),
        "URDF": Way(
            "`closedform new ur5e --from urdf`, `closedform derive`: proved, in C and NumPy, once",
            from_urdf,
            1,
            read=lambda module: np.asarray(module.pose(POSTURES)),
        ),
    }


def one_by_one() -> Ways:
    """The same functions with one target a call, as in a loop of Python."""
    arm = robots.load("ur5e", compiled=True, limits=LIMITS)
    return {
        "nearest": Way(
            "`arm.nearest(T, q_seed=seed)` in a loop",
            lambda: [arm.nearest(T, q).q for T, q in zip(TARGETS, SEEDS, strict=True)],
        ),
        "batch": Way(
            "`arm.ik(T)` in a loop",
            lambda: [arm.ik(T) for T in TARGETS],
            read=lambda found: [q[status == 0] for q, status in found],
        ),
        "gradient": Way("`arm.jacobian(q)` in a loop", lambda: [arm.jacobian(q) for q in POSTURES]),
    }


def drawn(arm: robots.Robot) -> None:
    from matplotlib import pyplot

    axes = plot.mechanism(ur_arm, HOME, params=arm.parameters)
    axes.figure.canvas.draw()
    pyplot.close(axes.figure)


def from_urdf() -> ModuleType:
    """Write the derivation of the URDF, prove it, print NumPy and C, and import the NumPy."""
    command = [sys.executable, "-m", "closedform"]
    with tempfile.TemporaryDirectory() as name:
        Path(name, "arm.urdf").write_text(urdf(), "utf-8")
        for words in (
            "new ur5e_urdf --from urdf arm.urdf",
            "derive ur5e_urdf.py -o printed --no-crosscheck --fresh --backend numpy --backend c",
        ):
            subprocess.run([*command, *words.split()], cwd=name, check=True, capture_output=True)
        sys.path.insert(0, name)
        try:
            return importlib.import_module("printed.numpy.ur5e_urdf")
        finally:
            sys.path.remove(name)
            for loaded in [m for m in sys.modules if m.split(".")[0] == "printed"]:
                del sys.modules[loaded]
