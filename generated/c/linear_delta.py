"""Delta robot with linear drives: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.linear_delta import (
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

fk = _native.function("linear_delta.fk", Positions)
skeleton = _native.function("linear_delta.skeleton")
jacobian_parallel = _native.function("linear_delta.jacobian_parallel")
jacobian_serial = _native.function("linear_delta.jacobian_serial")
jacobian = _native.function("linear_delta.jacobian")
determinant = _native.function("linear_delta.determinant")
singularities = _native.function("linear_delta.singularities")
condition_number = _native.function("linear_delta.condition_number")
constraint = _native.function("linear_delta.constraint")
ik = _native.function("linear_delta.ik", Solutions)
workspace_contains = _native.function("linear_delta.workspace_contains")
_nearest = _native.function("linear_delta.nearest")
