"""Stanford arm: the generated C, with the names and the meaning of the NumPy module."""

from closedform.generated.numpy.stanford_arm import (
    ASSEMBLY_MODES,
    BRANCHES,
    JOINTS,
    SINGULARITIES,
    TASK,
    Parameters,
    Positions,
    Solutions,
    Status,
)

from . import _native

__all__ = [
    "ASSEMBLY_MODES",
    "BRANCHES",
    "JOINTS",
    "SINGULARITIES",
    "TASK",
    "Parameters",
    "Positions",
    "Solutions",
    "Status",
    "fk",
    "pose",
    "jacobian",
    "jacobian_space",
    "jacobian_body",
    "determinant",
    "singularities",
    "ik",
]

fk = _native.function("stanford_arm.fk")
pose = _native.function("stanford_arm.pose")
jacobian = _native.function("stanford_arm.jacobian")
jacobian_space = _native.function("stanford_arm.jacobian_space")
jacobian_body = _native.function("stanford_arm.jacobian_body")
determinant = _native.function("stanford_arm.determinant")
singularities = _native.function("stanford_arm.singularities")
ik = _native.function("stanford_arm.ik", Solutions)
