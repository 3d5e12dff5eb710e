"""Spherical wrist: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.spherical_wrist import (
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
    "fk",
    "pose",
    "skeleton",
    "jacobian_space",
    "jacobian_body",
    "determinant",
    "singularities",
    "ik",
]

fk = _native.function("spherical_wrist.fk")
pose = _native.function("spherical_wrist.pose")
skeleton = _native.function("spherical_wrist.skeleton")
jacobian_space = _native.function("spherical_wrist.jacobian_space")
jacobian_body = _native.function("spherical_wrist.jacobian_body")
determinant = _native.function("spherical_wrist.determinant")
singularities = _native.function("spherical_wrist.singularities")
ik = _native.function("spherical_wrist.ik", Solutions)
_nearest = _native.function("spherical_wrist.nearest")
