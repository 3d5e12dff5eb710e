"""The tasks with pinocchio, whose inverse is the loop of the example in its documentation."""

from __future__ import annotations

from typing import Any

import numpy as np

from .tasks import HOME, PATH, POSTURES, SEEDS, TARGETS, TOOL, Way, Ways, urdf

NAME = "pinocchio"
EPS, MOST, DAMPING = 1e-9, 200, 1e-12


def ways() -> Ways:
    """With full steps; those of the example are a tenth, which takes some hundred iterations."""
    import pinocchio

    model = pinocchio.buildModelFromXML(urdf())
    flange = model.getFrameId("flange")
    joint, place = model.getJointId("theta6"), model.frames[flange].placement
    tcp = model.addFrame(
        pinocchio.Frame("tcp", joint, place * pinocchio.SE3(TOOL), pinocchio.FrameType.OP_FRAME)
    )
    data = model.createData()
    world = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def solved(T: np.ndarray, q: np.ndarray, frame: int = flange) -> np.ndarray:
        wanted = pinocchio.SE3(T)
        for _ in range(MOST):
            pinocchio.framesForwardKinematics(model, data, q)
            gap = data.oMf[frame].actInv(wanted)
            error = pinocchio.log(gap).vector
            if np.linalg.norm(error) < EPS:
                return q
            J = pinocchio.computeFrameJacobian(model, data, q, frame)
            J = -np.dot(pinocchio.Jlog6(gap.inverse()), J)
            v = -J.T.dot(np.linalg.solve(J.dot(J.T) + DAMPING * np.eye(6), error))
            q = pinocchio.integrate(model, q, v)
        return np.full(6, np.nan)

    def tracked() -> list[np.ndarray]:
        q = [HOME]
        for T in PATH:
            q.append(solved(T, q[-1]))
        return q[1:]

    def jacobians() -> list[np.ndarray]:
        return [pinocchio.computeFrameJacobian(model, data, q, flange, world) for q in POSTURES]

    return {
        "nearest": Way(
            "no; the loop of its example (CLIK), from the seed",
            lambda: [solved(T, q) for T, q in zip(TARGETS, SEEDS, strict=True)],
            numeric=True,
        ),
        "limits": Way("the model has them; the loop ignores them"),
        "tracking": Way("the loop, from the last posture", tracked, len(PATH), numeric=True),
        "batch": Way(
            "the loop; one posture for each target",
            lambda: [[solved(T, q)] for T, q in zip(TARGETS, SEEDS, strict=True)],
            numeric=True,
        ),
        "gradient": Way(
            "`computeFrameJacobian(model, data, q, frame, LOCAL_WORLD_ALIGNED)`", jacobians
        ),
        "tool": Way(
            "`model.addFrame(Frame(...))`, then the loop",
            lambda: [solved(T, q, tcp) for T, q in zip(TARGETS @ TOOL, SEEDS, strict=True)],
            numeric=True,
        ),
        "drawing": Way("viewers in the browser (MeshCat, Viser), for URDFs with shapes"),
        "URDF": Way(
            "`buildModelFromXML(text)`",
            lambda: pinocchio.buildModelFromXML(urdf()),
            1,
            read=lambda model: poses(pinocchio, model),
        ),
    }


def poses(pinocchio: Any, model: Any) -> list[np.ndarray]:
    data, flange, found = model.createData(), model.getFrameId("flange"), []
    for q in POSTURES:
        pinocchio.framesForwardKinematics(model, data, q)
        found.append(data.oMf[flange].homogeneous.copy())
    return found
