"""Planar 2R arm: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.planar_2r import (
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
    "orientation",
    "skeleton",
    "jacobian",
    "determinant",
    "manipulability",
    "singularities",
    "ik",
    "ik_pose",
    "workspace_radii",
]

fk = _native.function("planar_2r.fk")
pose = _native.function("planar_2r.pose")
orientation = _native.function("planar_2r.orientation")
skeleton = _native.function("planar_2r.skeleton")
jacobian = _native.function("planar_2r.jacobian")
determinant = _native.function("planar_2r.determinant")
manipulability = _native.function("planar_2r.manipulability")
singularities = _native.function("planar_2r.singularities")
ik = _native.function("planar_2r.ik", Solutions)
ik_pose = _native.function("planar_2r.ik_pose", Solutions)
workspace_radii = _native.function("planar_2r.workspace_radii")
_nearest = _native.function("planar_2r.nearest")
