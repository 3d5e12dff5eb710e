"""Planar parallel mechanism (two RPR legs): the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.rpr_planar import (
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
    "passive_angles",
    "skeleton",
    "jacobian_parallel",
    "jacobian_serial",
    "jacobian",
    "determinant",
    "singularities",
    "condition_number",
    "ik",
]

fk = _native.function("rpr_planar.fk", Positions)
passive_angles = _native.function("rpr_planar.passive_angles")
skeleton = _native.function("rpr_planar.skeleton")
jacobian_parallel = _native.function("rpr_planar.jacobian_parallel")
jacobian_serial = _native.function("rpr_planar.jacobian_serial")
jacobian = _native.function("rpr_planar.jacobian")
determinant = _native.function("rpr_planar.determinant")
singularities = _native.function("rpr_planar.singularities")
condition_number = _native.function("rpr_planar.condition_number")
ik = _native.function("rpr_planar.ik", Solutions)
_nearest = _native.function("rpr_planar.nearest")
