"""Delta robot with rotary drives: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.delta import (
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

fk = _native.function("delta.fk", Positions)
skeleton = _native.function("delta.skeleton")
jacobian_parallel = _native.function("delta.jacobian_parallel")
jacobian_serial = _native.function("delta.jacobian_serial")
jacobian = _native.function("delta.jacobian")
determinant = _native.function("delta.determinant")
singularities = _native.function("delta.singularities")
condition_number = _native.function("delta.condition_number")
constraint = _native.function("delta.constraint")
ik = _native.function("delta.ik", Solutions)
workspace_contains = _native.function("delta.workspace_contains")
_nearest = _native.function("delta.nearest")
