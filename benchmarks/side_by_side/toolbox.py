"""The tasks with the Robotics Toolbox for Python."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from .tasks import (
    ALPHA,
    HOME,
    LIMITS,
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
    urdf,
)

NAME = "Robotics Toolbox"


def ways() -> Ways:
    """Its analytic solver, which it derives once for a table, in some seconds."""
    import roboticstoolbox as rtb
    from spatialmath import SE3

    def robot(limits: np.ndarray, tool: np.ndarray | None = None) -> Any:
        links = [
            rtb.RevoluteDH(a=a, d=d, alpha=alpha, qlim=qlim)
            for a, d, alpha, qlim in zip(A, D, ALPHA, limits.T, strict=True)
        ]
        return rtb.DHRobot(links, name="ur5e", tool=None if tool is None else SE3(tool))

    arm = robot(LIMITS)
    solver = arm.analytic_ik()
    narrow = robot(NARROW).analytic_ik()
    with_tool = robot(LIMITS, TOOL).analytic_ik()
    tips = TARGETS @ TOOL

    def one_by_one(solver: Any, targets: np.ndarray) -> list[np.ndarray]:
        return [solver.ikine(T, q0=q).q for T, q in zip(targets, SEEDS, strict=True)]

    return {
        "nearest": Way(
            "`arm.analytic_ik().ikine(T, q0=seed)`", partial(one_by_one, solver, TARGETS)
        ),
        "limits": Way(
            "`arm.analytic_ik().solve(T)`, with `qlim` of the links; drops what is outside",
            lambda: [narrow.solve(T).q for T in TARGETS],
        ),
        "tracking": Way("`ikine(Ts, q0=home)`", lambda: solver.ikine(PATH, q0=HOME).q, len(PATH)),
        "batch": Way(
            "`solve(T, joint_limits=False)` in a loop",
            lambda: [solver.solve(T, joint_limits=False).q for T in TARGETS],
        ),
        "gradient": Way("`arm.jacob0(q)`", lambda: [arm.jacob0(q) for q in POSTURES]),
        "tool": Way(
            "`DHRobot(links, tool=tool)`, then `ikine`", partial(one_by_one, with_tool, tips)
        ),
        "drawing": Way(
            '`arm.plot(q, backend="pyplot")`; Swift draws meshes in a browser',
            lambda: drawn(arm),
            1,
            read=lambda _: arm.fkine_all(HOME).t,
        ),
        "URDF": Way(
            "`URDF_file(path)`; the analytic solver takes tables only, the numeric ones any arm",
            from_urdf,
            1,
            read=lambda arm: [arm.fkine(q).A for q in POSTURES],
        ),
    }


def drawn(arm: Any) -> None:
    from matplotlib import pyplot

    arm.plot(HOME, backend="pyplot", block=False)
    pyplot.gcf().canvas.draw()
    pyplot.close("all")


def from_urdf() -> Any:
    import roboticstoolbox as rtb
    from roboticstoolbox.models.URDF.URDFRobot import URDF_file

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "ur5e.urdf")
        path.write_text(urdf(), "utf-8")
        links, name, _ = URDF_file(path)
    return rtb.Robot(links, name=name)
