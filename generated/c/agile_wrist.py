"""Agile wrist: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.agile_wrist import (
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
    "jacobian_parallel",
    "jacobian_serial",
    "jacobian_space",
    "determinant",
    "singularities",
    "condition_number",
    "passive_angles",
    "skeleton",
    "ik",
]

fk = _native.function("agile_wrist.fk", Positions)
jacobian_parallel = _native.function("agile_wrist.jacobian_parallel")
jacobian_serial = _native.function("agile_wrist.jacobian_serial")
jacobian_space = _native.function("agile_wrist.jacobian_space")
determinant = _native.function("agile_wrist.determinant")
singularities = _native.function("agile_wrist.singularities")
condition_number = _native.function("agile_wrist.condition_number")
passive_angles = _native.function("agile_wrist.passive_angles")
skeleton = _native.function("agile_wrist.skeleton")
ik = _native.function("agile_wrist.ik", Solutions)
_nearest = _native.function("agile_wrist.nearest")
