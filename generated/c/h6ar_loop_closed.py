"""H6AR, loop-closed model: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.h6ar_loop_closed import (
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
    "arm_tips",
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

fk = _native.function("h6ar_loop_closed.fk")
pose = _native.function("h6ar_loop_closed.pose")
skeleton = _native.function("h6ar_loop_closed.skeleton")
arm_tips = _native.function("h6ar_loop_closed.arm_tips")
invariant_point = _native.function("h6ar_loop_closed.invariant_point")
jacobian = _native.function("h6ar_loop_closed.jacobian")
determinant = _native.function("h6ar_loop_closed.determinant")
singularities = _native.function("h6ar_loop_closed.singularities")
ik = _native.function("h6ar_loop_closed.ik", Solutions)
wrist_length = _native.function("h6ar_loop_closed.wrist_length")
minimum_link_length = _native.function("h6ar_loop_closed.minimum_link_length")
largest_yaw = _native.function("h6ar_loop_closed.largest_yaw")
largest_angle = _native.function("h6ar_loop_closed.largest_angle")
_nearest = _native.function("h6ar_loop_closed.nearest")
