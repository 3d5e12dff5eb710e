"""Compares generated code with the symbolic source, evaluated in Arb balls.

A function of the joints is compared value by value; its error is counted in ulps of the natural
scale (see :func:`closedform.check.samples.Magnitudes`).  An inverse is compared in five ways.  Its
answers are put into the exact equations; those on and near the singular set also into the exact
forward map.  Its statuses are compared with the exact bounds.  Every posture whose image is the
target must be among the branches.  No branch may have the answer of another one.
"""

from __future__ import annotations

from closedform.check.finding import Backend, Finding
from closedform.check.inverses import check_inverse
from closedform.check.values import check_boolean, check_forward
from closedform.model.derivation import Derivation


def crosscheck(derivation: Derivation, backend: Backend) -> list[Finding]:
    """Check every function of a derivation in one backend."""
    inverses = {i.function: i for i in derivation.inverses}
    findings = []
    for function in derivation.functions:
        if function.name in inverses:
            findings.append(check_inverse(derivation, function, inverses[function.name], backend))
        elif function.boolean:
            findings.append(check_boolean(derivation, function, backend))
        else:
            findings.append(check_forward(derivation, function, backend))
    return findings


__all__ = ["crosscheck"]
