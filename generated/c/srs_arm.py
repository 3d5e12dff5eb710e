"""Seven-joint arm with a spherical shoulder and wrist (SRS): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.srs_arm import (
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
    "jacobian_space",
    "jacobian_body",
    "self_motion",
    "determinant",
    "singularities",
    "arm_angle",
    "ik",
]

pose = _native.function("srs_arm.pose")
skeleton = _native.function("srs_arm.skeleton")
fk = _native.function("srs_arm.fk")
jacobian = _native.function("srs_arm.jacobian")
jacobian_space = _native.function("srs_arm.jacobian_space")
jacobian_body = _native.function("srs_arm.jacobian_body")
self_motion = _native.function("srs_arm.self_motion")
determinant = _native.function("srs_arm.determinant")
singularities = _native.function("srs_arm.singularities")
arm_angle = _native.function("srs_arm.arm_angle")
ik = _native.function("srs_arm.ik", Solutions)
_nearest = _native.function("srs_arm.nearest")
