"""H6AR, published model: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.h6ar import (
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
    "arm_tips",
    "skeleton",
    "invariant_point",
    "jacobian",
    "determinant",
    "singularities",
    "ik",
    "wrist_length",
    "minimum_link_length",
    "largest_yaw",
    "largest_angle",
]

fk = _native.function("h6ar.fk")
pose = _native.function("h6ar.pose")
arm_tips = _native.function("h6ar.arm_tips")
skeleton = _native.function("h6ar.skeleton")
invariant_point = _native.function("h6ar.invariant_point")
jacobian = _native.function("h6ar.jacobian")
determinant = _native.function("h6ar.determinant")
singularities = _native.function("h6ar.singularities")
ik = _native.function("h6ar.ik", Solutions)
wrist_length = _native.function("h6ar.wrist_length")
minimum_link_length = _native.function("h6ar.minimum_link_length")
largest_yaw = _native.function("h6ar.largest_yaw")
largest_angle = _native.function("h6ar.largest_angle")
_nearest = _native.function("h6ar.nearest")
