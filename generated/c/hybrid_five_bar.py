"""Five-bar linkage on a revolute: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.hybrid_five_bar import (
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
    "workspace_contains",
    "workspace_volume",
]

fk = _native.function("hybrid_five_bar.fk", Positions)
passive_angles = _native.function("hybrid_five_bar.passive_angles")
skeleton = _native.function("hybrid_five_bar.skeleton")
jacobian_parallel = _native.function("hybrid_five_bar.jacobian_parallel")
jacobian_serial = _native.function("hybrid_five_bar.jacobian_serial")
jacobian = _native.function("hybrid_five_bar.jacobian")
determinant = _native.function("hybrid_five_bar.determinant")
singularities = _native.function("hybrid_five_bar.singularities")
condition_number = _native.function("hybrid_five_bar.condition_number")
ik = _native.function("hybrid_five_bar.ik", Solutions)
workspace_contains = _native.function("hybrid_five_bar.workspace_contains")
workspace_volume = _native.function("hybrid_five_bar.workspace_volume")
_nearest = _native.function("hybrid_five_bar.nearest")
