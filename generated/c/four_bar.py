"""Planar four-bar linkage: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.four_bar import (
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
    "determinant",
    "singularities",
    "ik",
    "workspace_contains",
]

fk = _native.function("four_bar.fk", Positions)
skeleton = _native.function("four_bar.skeleton")
jacobian_parallel = _native.function("four_bar.jacobian_parallel")
jacobian_serial = _native.function("four_bar.jacobian_serial")
jacobian = _native.function("four_bar.jacobian")
determinant = _native.function("four_bar.determinant")
singularities = _native.function("four_bar.singularities")
ik = _native.function("four_bar.ik", Solutions)
workspace_contains = _native.function("four_bar.workspace_contains")
_nearest = _native.function("four_bar.nearest")
