"""Industrial six-axis arm (OPW): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.opw_arm import (
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

pose = _native.function("opw_arm.pose")
skeleton = _native.function("opw_arm.skeleton")
fk = _native.function("opw_arm.fk")
jacobian = _native.function("opw_arm.jacobian")
determinant = _native.function("opw_arm.determinant")
singularities = _native.function("opw_arm.singularities")
jacobian_space = _native.function("opw_arm.jacobian_space")
jacobian_body = _native.function("opw_arm.jacobian_body")
ik = _native.function("opw_arm.ik", Solutions)
_nearest = _native.function("opw_arm.nearest")
