"""ABB IRB 260 palletiser: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.irb260 import (
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
    "joint4",
    "joints_from_motors",
    "motors_from_joints",
    "fk",
    "pose",
    "skeleton",
    "jacobian",
    "jacobian_space",
    "jacobian_body",
    "jacobian_motors",
    "determinant",
    "singularities",
    "point_velocity",
    "ik",
    "workspace_section",
    "workspace_margin",
    "workspace_contains",
]

joint4 = _native.function("irb260.joint4")
joints_from_motors = _native.function("irb260.joints_from_motors")
motors_from_joints = _native.function("irb260.motors_from_joints")
fk = _native.function("irb260.fk")
pose = _native.function("irb260.pose")
skeleton = _native.function("irb260.skeleton")
jacobian = _native.function("irb260.jacobian")
jacobian_space = _native.function("irb260.jacobian_space")
jacobian_body = _native.function("irb260.jacobian_body")
jacobian_motors = _native.function("irb260.jacobian_motors")
determinant = _native.function("irb260.determinant")
singularities = _native.function("irb260.singularities")
point_velocity = _native.function("irb260.point_velocity")
ik = _native.function("irb260.ik", Solutions)
workspace_section = _native.function("irb260.workspace_section")
workspace_margin = _native.function("irb260.workspace_margin")
workspace_contains = _native.function("irb260.workspace_contains")
_nearest = _native.function("irb260.nearest")
