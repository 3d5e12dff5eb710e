"""What an inverse takes beside its target: a joint of an arm of seven, or its arm angle."""

import inspect
from types import ModuleType
from typing import Any

import numpy as np


def names(module: ModuleType) -> list[str]:
    """The inputs of the inverse besides the target."""
    inputs = list(inspect.signature(module.ik).parameters)
    return inputs[1 : inputs.index("params")]


def beside(module: ModuleType, q: Any, *params: Any) -> tuple[Any, ...]:
    """The values of these inputs at joints."""
    joints = list(module.JOINTS)
    return tuple(
        np.asarray(q)[..., joints.index(n)] if n in joints else getattr(module, n)(q, *params)
        for n in names(module)
    )


def like(module: ModuleType, x: Any) -> tuple[Any, ...]:
    """Other values of these inputs for any targets: the same for all, away from zero."""
    return tuple(np.full(len(x), 0.3) for _ in names(module))
