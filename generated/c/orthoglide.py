"""Orthoglide: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.orthoglide import (
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
    "condition_number",
    "constraint",
    "ik",
    "workspace_contains",
]

fk = _native.function("orthoglide.fk", Positions)
skeleton = _native.function("orthoglide.skeleton")
jacobian_parallel = _native.function("orthoglide.jacobian_parallel")
jacobian_serial = _native.function("orthoglide.jacobian_serial")
jacobian = _native.function("orthoglide.jacobian")
determinant = _native.function("orthoglide.determinant")
singularities = _native.function("orthoglide.singularities")
condition_number = _native.function("orthoglide.condition_number")
constraint = _native.function("orthoglide.constraint")
ik = _native.function("orthoglide.ik", Solutions)
workspace_contains = _native.function("orthoglide.workspace_contains")
_nearest = _native.function("orthoglide.nearest")
