"""The tasks with PyRoki, whose inverse is the least-squares problem of its first example."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from .tasks import HOME, LIMITS, NARROW, PATH, POSTURES, SEEDS, TARGETS, TOOL, Way, Ways, urdf

NAME = "PyRoki"


TOLERANCE = 1e-3
"""It computes in single precision; its least squares do not run in double."""


def ways() -> Ways:
    import jax

    with jax.enable_x64(False):
        found = in_single_precision()

    def single(work: Callable[..., Any]) -> Callable[..., Any]:
        def run(*given: Any) -> Any:
            with jax.enable_x64(False):
                return work(*given)

        return run

    return {
        task: replace(
            way, run=way.run and single(way.run), read=single(way.read), tolerance=TOLERANCE
        )
        for task, way in found.items()
    }


def in_single_precision() -> Ways:
    import jax
    import jaxlie
    import jaxls
    import pyroki
    from loguru import logger

    logger.disable("jaxls")

    def solver(robot: Any, link: str) -> Any:
        index = jax.numpy.array(robot.links.names.index(link), jax.numpy.int32)

        def solve(T: Any, seed: Any) -> Any:
            variable = robot.joint_var_cls(0)
            costs = [
                pyroki.costs.pose_cost(
                    robot, variable, jaxlie.SE3.from_matrix(T), index, 50.0, 10.0
                ),
                pyroki.costs.limit_constraint(robot, variable),
            ]
            problem = jaxls.LeastSquaresProblem(costs, [variable]).analyze()
            found = problem.solve(
                initial_vals=jaxls.VarValues.make([variable.with_value(seed)]),
                verbose=False,
                linear_solver="dense_cholesky",
            )
            return found[variable]

        return jax.jit(solve)

    def looped(solve: Any, targets: np.ndarray) -> list[np.ndarray]:
        return [np.asarray(solve(T, q)) for T, q in zip(targets, SEEDS, strict=True)]

    arm = loaded()
    one = solver(arm, "flange")
    within = solver(loaded(NARROW), "flange")
    with_tool = solver(loaded(LIMITS, TOOL), "tcp")
    flange = arm.links.names.index("flange")

    def matrix(q: Any) -> Any:
        return jaxlie.SE3(arm.forward_kinematics(q)[flange]).as_matrix()

    poses, derivatives = jax.jit(jax.vmap(matrix)), jax.jit(jax.vmap(jax.jacfwd(matrix)))

    def tracked() -> list[np.ndarray]:
        q = [HOME]
        for T in PATH:
            q.append(one(T, q[-1]))
        return [np.asarray(x) for x in q[1:]]

    ready = jax.block_until_ready
    return {
        "nearest": Way(
            "no; least squares from the seed",
            lambda: looped(one, TARGETS),
            numeric=True,
        ),
        "limits": Way(
            "`limit_constraint(robot, variable)`",
            lambda: looped(within, TARGETS),
            numeric=True,
        ),
        "tracking": Way("least squares from the last posture", tracked, len(PATH), numeric=True),
        "batch": Way(
            "least squares; one posture for each target; `jax.vmap` on a GPU",
            lambda: looped(one, TARGETS),
            numeric=True,
        ),
        "gradient": Way(
            "`jax.jacfwd(robot.forward_kinematics)`",
            lambda: ready(derivatives(POSTURES)),
            read=lambda J: twists(np.asarray(J), np.asarray(poses(POSTURES))),
        ),
        "tool": Way(
            "a link of the URDF",
            lambda: looped(with_tool, TARGETS @ TOOL),
            numeric=True,
        ),
        "drawing": Way("a viewer in the browser (Viser)"),
        "URDF": Way(
            "`Robot.from_urdf(yourdfpy.URDF.load(path))`",
            loaded,
            1,
            read=lambda _: np.asarray(poses(POSTURES)),
        ),
    }


def loaded(limits: np.ndarray = LIMITS, tool: np.ndarray | None = None) -> Any:
    import pyroki
    import yourdfpy

    return pyroki.Robot.from_urdf(yourdfpy.URDF.load(io.StringIO(urdf(limits, tool))))


def twists(derivatives: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """The Jacobian (v; omega) of derivatives of poses, of shape (n, 4, 4, joints)."""
    turning = np.einsum("nabj,ncb->nacj", derivatives[:, :3, :3], poses[:, :3, :3])
    omega = turning[:, 2, 1], turning[:, 0, 2], turning[:, 1, 0]
    return np.concatenate([derivatives[:, :3, 3], np.stack(omega, axis=1)], axis=1)
