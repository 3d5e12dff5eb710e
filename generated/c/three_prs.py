"""3-PRS mechanism: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.three_prs import (
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
    "hand_pose",
    "jacobian_parallel",
    "jacobian_serial",
    "jacobian_inverse",
    "jacobian",
    "determinant",
    "singularities",
    "skeleton",
    "ik",
    "workspace_contains",
]

hand_pose = _native.function("three_prs.hand_pose")
jacobian_parallel = _native.function("three_prs.jacobian_parallel")
jacobian_serial = _native.function("three_prs.jacobian_serial")
jacobian_inverse = _native.function("three_prs.jacobian_inverse")
jacobian = _native.function("three_prs.jacobian")
determinant = _native.function("three_prs.determinant")
singularities = _native.function("three_prs.singularities")
skeleton = _native.function("three_prs.skeleton")
ik = _native.function("three_prs.ik", Solutions)
workspace_contains = _native.function("three_prs.workspace_contains")
