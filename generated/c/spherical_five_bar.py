"""Spherical five-bar linkage: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.spherical_five_bar import (
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
    "skeleton",
    "jacobian_parallel",
    "jacobian_serial",
    "jacobian",
    "singularities",
    "condition_number",
    "ik",
    "workspace_contains",
]

fk = _native.function("spherical_five_bar.fk", Positions)
skeleton = _native.function("spherical_five_bar.skeleton")
jacobian_parallel = _native.function("spherical_five_bar.jacobian_parallel")
jacobian_serial = _native.function("spherical_five_bar.jacobian_serial")
jacobian = _native.function("spherical_five_bar.jacobian")
singularities = _native.function("spherical_five_bar.singularities")
condition_number = _native.function("spherical_five_bar.condition_number")
ik = _native.function("spherical_five_bar.ik", Solutions)
workspace_contains = _native.function("spherical_five_bar.workspace_contains")
_nearest = _native.function("spherical_five_bar.nearest")
