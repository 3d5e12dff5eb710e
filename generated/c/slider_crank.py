"""Slider-crank: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.slider_crank import (
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

fk = _native.function("slider_crank.fk", Positions)
skeleton = _native.function("slider_crank.skeleton")
jacobian_parallel = _native.function("slider_crank.jacobian_parallel")
jacobian_serial = _native.function("slider_crank.jacobian_serial")
jacobian = _native.function("slider_crank.jacobian")
determinant = _native.function("slider_crank.determinant")
singularities = _native.function("slider_crank.singularities")
ik = _native.function("slider_crank.ik", Solutions)
workspace_contains = _native.function("slider_crank.workspace_contains")
_nearest = _native.function("slider_crank.nearest")
