"""Stanford arm: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.stanford_arm import (
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

pose = _native.function("stanford_arm.pose")
skeleton = _native.function("stanford_arm.skeleton")
fk = _native.function("stanford_arm.fk")
jacobian = _native.function("stanford_arm.jacobian")
determinant = _native.function("stanford_arm.determinant")
singularities = _native.function("stanford_arm.singularities")
jacobian_space = _native.function("stanford_arm.jacobian_space")
jacobian_body = _native.function("stanford_arm.jacobian_body")
ik = _native.function("stanford_arm.ik", Solutions)
_nearest = _native.function("stanford_arm.nearest")
