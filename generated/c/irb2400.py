"""Six-axis arm on a parallelogram (IRB 2400): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.irb2400 import (
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
    "joints_from_motors",
    "motors_from_joints",
    "ik",
]

pose = _native.function("irb2400.pose")
skeleton = _native.function("irb2400.skeleton")
fk = _native.function("irb2400.fk")
jacobian = _native.function("irb2400.jacobian")
determinant = _native.function("irb2400.determinant")
singularities = _native.function("irb2400.singularities")
jacobian_space = _native.function("irb2400.jacobian_space")
jacobian_body = _native.function("irb2400.jacobian_body")
joints_from_motors = _native.function("irb2400.joints_from_motors")
motors_from_joints = _native.function("irb2400.motors_from_joints")
ik = _native.function("irb2400.ik", Solutions)
_nearest = _native.function("irb2400.nearest")
