"""Seven-joint arm with an offset elbow and hand (Franka): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.franka_arm import (
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

pose = _native.function("franka_arm.pose")
skeleton = _native.function("franka_arm.skeleton")
fk = _native.function("franka_arm.fk")
jacobian = _native.function("franka_arm.jacobian")
determinant = _native.function("franka_arm.determinant")
singularities = _native.function("franka_arm.singularities")
jacobian_space = _native.function("franka_arm.jacobian_space")
jacobian_body = _native.function("franka_arm.jacobian_body")
ik = _native.function("franka_arm.ik", Solutions)
_nearest = _native.function("franka_arm.nearest")
