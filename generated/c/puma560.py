"""Puma 560: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.puma560 import (
    ASSEMBLY_MODES,
    BRANCHES,
    JOINTS,
    SINGULARITIES,
    TASK,
    Parameters,
    Positions,
    Solutions,
    Status,
)

from . import _native

__all__ = [
    "ASSEMBLY_MODES",
    "BRANCHES",
    "JOINTS",
    "SINGULARITIES",
    "TASK",
    "Parameters",
    "Positions",
    "Solutions",
    "Status",
    "fk",
    "pose",
    "jacobian",
    "jacobian_space",
    "jacobian_body",
    "determinant",
    "singularities",
    "ik",
]

fk = _native.function("puma560.fk")
pose = _native.function("puma560.pose")
jacobian = _native.function("puma560.jacobian")
jacobian_space = _native.function("puma560.jacobian_space")
jacobian_body = _native.function("puma560.jacobian_body")
determinant = _native.function("puma560.determinant")
singularities = _native.function("puma560.singularities")
ik = _native.function("puma560.ik", Solutions)
