"""The functions behind the maps of an explorer, printed for one branch or assembly mode at a time.

A map shows one branch, and the inverse of the JavaScript module computes all of them.
"""

from __future__ import annotations

from collections.abc import Iterator

from closedform.emit.backends.js.module import Kernel, kernel
from closedform.emit.render import render
from closedform.lower import lower_branch
from closedform.model.derivation import Derivation

MAPPED = ("ik", "fk", "condition_number", "determinant", "singularities")
POSE = 16
"""The numbers of a target that is a frame."""


def module(derivation: Derivation) -> str:
    """The module that the explorer imports: for each function a list of kernels."""
    groups = {name: tuple(_kernels(derivation, name)) for name in MAPPED}
    return render("site/maps.js.jinja", {"robot": derivation.name, "groups": groups})


def has_section(derivation: Derivation) -> bool:
    """Whether the hand moves in a part of a plane or of space, so that its workspace has a section.

    A hand with fewer joints than coordinates stays on a surface.
    """
    task = derivation.task
    return len(task) == POSE or 1 < sum(axis in task for axis in "xyz") <= len(derivation.actuated)


def _kernels(derivation: Derivation, name: str) -> Iterator[Kernel]:
    """The kernels of a function, for each branch or mode; nothing if there is no such function."""
    for function in derivation.functions:
        if function.name == name:
            for k, _ in enumerate(function.cases()):
                yield kernel(f"{name}_{k}", lower_branch(function, derivation, k))
