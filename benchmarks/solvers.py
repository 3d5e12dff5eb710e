"""Analytic solvers of the Puma 560: ours and the peers, each used as its authors intend.

Each solver gets its own description of the arm, checked against the forward kinematics of one
Denavit-Hartenberg table, and poses in its own type, prepared in advance. A library is imported only
when its solver is made.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from closedform.generated.c import puma560 as compiled
from closedform.generated.numpy import puma560 as vectors

from . import batches, native
from .cases import Case

# The standard table of derivations/puma560.py.
A = np.array([0, 0.4318, 0.0203, 0, 0, 0])
D = np.array([0, 0, 0.15005, 0.4318, 0, 0])
ALPHA = np.array([1, 0, -1, 1, -1, 0]) * np.pi / 2
CASE = Case("6R inverse", "puma560", "ik")

Answers = tuple[np.ndarray, np.ndarray]  # joints (k, 6), and whether each is said to be exact (k,)


class InvalidPoseError(Exception):
    """All statuses are INVALID."""


@dataclass(frozen=True)
class Solver:
    """A solver to examine and to time.

    ``many`` maps poses (n, 4, 4) to joints (n, k, 6), padded with NaN, and to flags (n, k) for
    those that it says are exact.  ``timed`` maps poses to a function that solves them all.
    """

    many: Callable[[np.ndarray], Answers]
    timed: Callable[[np.ndarray], Callable[[], object]]
    poses: int = 2000
    batch: bool = False


def pose(q: np.ndarray) -> np.ndarray:
    """The product of the table for joints (..., 6): an independent route to the pose."""
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))
    for i in range(6):
        c, s, u, v = np.cos(q[..., i]), np.sin(q[..., i]), np.cos(ALPHA[i]), np.sin(ALPHA[i])
        zero, one = np.zeros_like(c), np.ones_like(c)
        entries = [
            [c, -s * u, s * v, A[i] * c],
            [s, c * u, -c * v, A[i] * s],
            [zero, v * one, u * one, D[i] * one],
            [zero, zero, zero, one],
        ]
        T = T @ np.stack([np.stack(row, axis=-1) for row in entries], axis=-2)
    return T


def agrees(forward: Callable[[np.ndarray], Any]) -> None:
    q = np.random.default_rng(3).uniform(-3, 3, (10, 6))
    gap = max(float(abs(np.asarray(forward(x)) - pose(x)).max()) for x in q)
    if not gap < 1e-12:
        raise ValueError(f"not the same arm: its forward kinematics differ by {gap:.1g}")


def looped(
    solve: Callable[[Any], Any],
    answers: Callable[[Any], tuple[Any, Any]],
    prepare: Callable[[np.ndarray], Any] = np.ascontiguousarray,
    poses: int = 2000,
) -> Solver:
    """A solver that takes one pose per call."""

    def one(T: np.ndarray, alone: bool) -> Answers:
        try:
            q, exact = answers(solve(prepare(T)))
        except Exception:
            if alone:
                raise
            q, exact = [], []  # among many poses, an exception counts as no solution
        return np.asarray(q, float).reshape(-1, 6), np.asarray(exact, bool)

    def many(T: np.ndarray) -> Answers:
        found = [one(t, len(T) == 1) for t in T]
        most = max(1, *(len(q) for q, _ in found))
        joints = np.full((len(T), most, 6), np.nan)
        said = np.zeros((len(T), most), bool)
        for i, (q, exact) in enumerate(found):
            joints[i, : len(q)], said[i, : len(q)] = q, exact
        return joints, said

    def timed(T: np.ndarray) -> Callable[[], object]:
        prepared = [prepare(t) for t in T]

        def run() -> None:
            for t in prepared:
                solve(t)

        return run

    return Solver(many, timed, poses)


def statuses(result: Any) -> Answers:
    """Our solutions; SINGULAR ones, with a free joint, are exact too."""
    q, status = result
    if (status == compiled.Status.INVALID).all():
        raise InvalidPoseError
    # A copy of the joints: with ``out=`` the next pose would overwrite them.
    return q.copy(), (status == compiled.Status.OK) | (status == compiled.Status.SINGULAR)


def ours_single() -> Solver:
    out = compiled.ik(np.eye(4))
    return looped(lambda T: compiled.ik(T, out=out), statuses, poses=100_000)


def ours_batch(module: Any, backend: str, layout: str) -> Solver:
    def timed(T: np.ndarray) -> Callable[[], object]:
        call, _ = batches.ours(backend, CASE, layout, T.reshape(len(T), 16))
        return partial(call.timeit, 1)

    return Solver(lambda T: statuses(module.ik(T)), timed, 100_000, batch=True)


@cache
def toolbox() -> Any:
    import roboticstoolbox as rtb

    links = [rtb.RevoluteDH(a=a, d=d, alpha=al) for a, d, al in zip(A, D, ALPHA, strict=True)]
    robot = rtb.DHRobot(links, name="puma560")
    agrees(lambda q: robot.fkine(q).A)
    return robot.analytic_ik()


def toolbox_python() -> Solver:
    def answers(result: Any) -> tuple[Any, Any]:
        return result.q, np.ones(len(result.q), bool)

    return looped(partial(toolbox().solve, joint_limits=False), answers, poses=1000)


MOST = 64  # IKINE_MAX_SOLUTIONS of its C
TOOLBOX_CALL = """
__attribute__((noinline)) void evaluate(const double *in, double *out)
{
    int count = 0;
    ikine(in, 1e-6, (double (*)[IKINE_DOF])out, &count);
    out[IKINE_MAX_SOLUTIONS * IKINE_DOF] = count;
}
"""


def toolbox_run(target: str) -> Callable[..., float]:
    """The timing loop of ``native`` over the C that the toolbox writes, with its tolerance."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources = {"toolbox.c": toolbox().generate("c") + TOOLBOX_CALL, "loop.c": native.LOOP}
        for file, text in sources.items():
            (folder / file).write_text(text)
        command = [
            "gcc",
            "-std=gnu99",
            *native.FLAGS,
            *native.LIBRARY,
            f"-march={target}",
            "-o",
            "toolbox.so",
        ]
        done = subprocess.run(
            [*command, *sources, "-lm"], cwd=folder, capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise RuntimeError(done.stderr.strip().splitlines()[0])
        run = ctypes.CDLL(str(folder / "toolbox.so")).run
    run.restype = ctypes.c_double
    pointer = np.ctypeslib.ndpointer(np.float64, flags="C")
    run.argtypes = [pointer, pointer, *[ctypes.c_int] * 4]
    return run


def toolbox_c() -> Solver:
    run = toolbox_run(native.TARGETS["AVX2"])

    def many(T: np.ndarray) -> Answers:
        out = np.full((len(T), MOST * 6 + 1), np.nan)
        run(np.ascontiguousarray(T.reshape(len(T), 16)), out, 16, out.shape[1], len(T), 1)
        found = np.arange(MOST) < out[:, -1:]
        return np.where(found[..., None], out[:, :-1].reshape(-1, MOST, 6), np.nan), found

    return Solver(many, lambda T: lambda: many(T), 20_000)


def prebuilt_ssik() -> Solver:
    """The module that ssik ships for this arm; its joint limits would drop angles of pi."""
    from ssik.prebuilt import puma560_ik

    agrees(puma560_ik.fk)

    def answers(found: Any) -> tuple[Any, Any]:
        return [s.q for s in found], [True] * len(found)

    return looped(partial(puma560_ik.solve, respect_limits=False), answers)


def eaik_robot() -> Any:
    from eaik.IK_DH import DhRobot

    robot = DhRobot(ALPHA, A, D)
    agrees(robot.fwdKin)
    return robot


def eaik_answers(found: Any) -> tuple[Any, Any]:
    return found.Q, ~np.asarray(found.is_LS, bool)


def eaik_single() -> Solver:
    return looped(eaik_robot().IK, eaik_answers)


def eaik_batch() -> Solver:
    robot = eaik_robot()
    single = looped(lambda found: found, eaik_answers, prepare=lambda found: found)

    def many(T: np.ndarray) -> Answers:
        return single.many(robot.IK_batched(list(T), 1))

    return Solver(many, lambda T: partial(robot.IK_batched, list(T), 1), batch=True)


def ik_geo_single() -> Solver:
    """The solver of ik-geo: rotations by columns; the axes of the wrist meet without offsets."""

    import ik_geo

    axes = np.array([[0, 0, 1], [0, -1, 0], [0, -1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1.0]])
    steps = np.zeros((7, 3))
    steps[1, 1], steps[2, 0], steps[3, 0], steps[3, 2] = -D[2], A[1], A[2], D[3]
    robot = ik_geo.Robot.spherical_two_parallel(axes, steps)

    def forward(q: np.ndarray) -> np.ndarray:
        columns, p = robot.forward_kinematics(q)
        return np.vstack([np.c_[np.transpose(columns), p], [0, 0, 0, 1]])

    agrees(forward)

    def prepare(T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.ascontiguousarray(T[:3, :3].T), np.ascontiguousarray(T[:3, 3])

    def answers(found: Any) -> tuple[Any, Any]:
        return [q for q, _ in found], [not least_squares for _, least_squares in found]

    return looped(lambda t: robot.get_ik(*t), answers, prepare)


def opw_robot() -> Any:
    import py_opw_kinematics as opw

    model = opw.KinematicModel(
        a2=A[2],
        b=-D[2],
        c2=A[1],
        c3=D[3],
        offsets=(0, -np.pi / 2, np.pi / 2, 0, 0, 0),
        flip_axes=(False, True, True, False, True, False),
    )
    robot = opw.Robot(model, degrees=False)
    agrees(lambda q: robot.forward(tuple(q)).as_matrix())
    return robot


def opw_single() -> Solver:
    from scipy.spatial.transform import RigidTransform

    def answers(found: Any) -> tuple[Any, Any]:
        return found, [True] * len(found)

    return looped(opw_robot().inverse, answers, RigidTransform.from_matrix)


def opw_batch() -> Solver:
    from scipy.spatial.transform import RigidTransform

    robot = opw_robot()

    def many(T: np.ndarray) -> Answers:
        q = robot.reach(RigidTransform.from_matrix(T)).joints
        return q, np.isfinite(q).all(axis=-1)

    def timed(T: np.ndarray) -> Callable[[], object]:
        return partial(robot.reach, RigidTransform.from_matrix(T))

    return Solver(many, timed, batch=True)


OURS: dict[str, Callable[[], Solver]] = {
    "closedform C": ours_single,
    "closedform C, structure of arrays": partial(ours_batch, compiled, "c", "planes"),
    "closedform C, `(N, 4, 4)`": partial(ours_batch, compiled, "c", "rows"),
    "closedform NumPy, structure of arrays": partial(ours_batch, vectors, "numpy", "planes"),
    "closedform NumPy, `(N, 4, 4)`": partial(ours_batch, vectors, "numpy", "rows"),
}
TOOLBOX_C = "roboticstoolbox-python, its C"
PEERS: dict[str, Callable[[], Solver]] = {
    "roboticstoolbox-python": toolbox_python,
    TOOLBOX_C: toolbox_c,
    "ssik": prebuilt_ssik,
    "EAIK": eaik_single,
    "EAIK, `IK_batched`": eaik_batch,
    "ik-geo": ik_geo_single,
    "py-opw-kinematics": opw_single,
    "py-opw-kinematics, `reach`": opw_batch,
}
SOLVERS = {**OURS, **PEERS}
