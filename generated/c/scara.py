"""SCARA arm (RRPR): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.scara import (
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

pose = _native.function("scara.pose")
skeleton = _native.function("scara.skeleton")
fk = _native.function("scara.fk")
jacobian = _native.function("scara.jacobian")
determinant = _native.function("scara.determinant")
singularities = _native.function("scara.singularities")
jacobian_space = _native.function("scara.jacobian_space")
jacobian_body = _native.function("scara.jacobian_body")
ik = _native.function("scara.ik", Solutions)
_nearest = _native.function("scara.nearest")
