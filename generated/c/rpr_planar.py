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
    "jacobian",
    "determinant",
    "singularities",
    "ik",
]

fk = _native.function("rpr_planar.fk", Positions)
passive_angles = _native.function("rpr_planar.passive_angles")
skeleton = _native.function("rpr_planar.skeleton")
jacobian = _native.function("rpr_planar.jacobian")
determinant = _native.function("rpr_planar.determinant")
singularities = _native.function("rpr_planar.singularities")
ik = _native.function("rpr_planar.ik", Solutions)
