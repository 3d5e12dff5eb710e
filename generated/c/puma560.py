"""Puma 560: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.puma560 import (
    ASSEMBLY_MODES,
    BRANCHES,
    JOINTS,
    SINGULARITIES,
    SKELETON,
    TASK,
    Parameters,
    Positions,
    Skeleton,
    SkeletonJoint,
    Solutions,
    Status,
)

from . import _native

__all__ = [
    "ASSEMBLY_MODES",
    "BRANCHES",
    "JOINTS",
    "SINGULARITIES",
    "SKELETON",
    "TASK",
    "Parameters",
    "Positions",
    "Skeleton",
    "SkeletonJoint",
    "Solutions",
    "Status",
    "pose",
    "skeleton",
    "fk",
    "jacobian",
    "determinant",
    "singularities",
    "jacobian_space",
    "jacobian_body",
    "ik",
]

pose = _native.function("puma560.pose")
skeleton = _native.function("puma560.skeleton")
fk = _native.function("puma560.fk")
jacobian = _native.function("puma560.jacobian")
determinant = _native.function("puma560.determinant")
singularities = _native.function("puma560.singularities")
jacobian_space = _native.function("puma560.jacobian_space")
jacobian_body = _native.function("puma560.jacobian_body")
ik = _native.function("puma560.ik", Solutions)
_nearest = _native.function("puma560.nearest")
