"""Generated code against the symbolic source in Arb, in every back end; and the check can fail."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from closedform.clibrary import CLibrary
from closedform.crosscheck import (
    Backend,
    Finding,
    check_forward,
    check_inverse,
    crosscheck,
    float_backend,
    module_backend,
)
from closedform.derivation import Derivation
from closedform.tolerances import DOUBLE

ROBOTS = (
    "hybrid_five_bar",
    "irb260",
    "planar_2r",
    "puma560",
    "rpr_planar",
    "scara",
    "spherical_wrist",
    "stanford_arm",
    "ur_arm",
)
GENERATED = Path(__file__).parent.parent / "generated"


def derivation(robot: str) -> Derivation:
    return importlib.import_module(f"closedform.derivations.{robot}").d


def backend(name: str, robot: str, scratch: Path) -> Backend:
    if name == "c float":
        library = CLibrary(derivation(robot), GENERATED / "c", scratch, single=True)
        return float_backend(library.function)
    return module_backend(name, importlib.import_module(f"closedform.generated.{name}.{robot}"))


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", ["numpy", "c", "c float"])
def test_against_the_symbolic_source(
    robot: str, name: str, tmp_path: Path, findings: list[Finding]
) -> None:
    found = crosscheck(derivation(robot), backend(name, robot, tmp_path))
    findings += found
    assert not [failure for f in found for failure in f.failures]
    assert all(f.compared for f in found)


def broken(robot: str, function: str, change) -> list[str]:
    """The failures that are reported when one function of the NumPy module is changed."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")

    def lookup(name: str):
        original = getattr(module, name)
        return (lambda *a: change(original(*a))) if name == function else original

    d, backend = derivation(robot), Backend("broken", lookup, np.float64, DOUBLE)
    inverse = next((i for i in d.inverses if i.function == function), None)
    if inverse:
        return check_inverse(d, d[function], inverse, backend).failures
    return check_forward(d, d[function], backend).failures


def swapped_sign(solutions):
    return solutions._replace(q=-solutions.q)


def first_branch_only(solutions):
    return solutions._replace(q=np.repeat(solutions.q[:, :1], solutions.q.shape[1], axis=1))


def never_reachable(solutions):
    nan = np.full_like(solutions.q, np.nan)
    return solutions._replace(q=nan, status=np.ones_like(solutions.status))


@pytest.mark.parametrize("robot", [r for r in ROBOTS if r != "ur_arm"])  # a minute each
@pytest.mark.parametrize("change", [swapped_sign, first_branch_only, never_reachable])
def test_a_wrong_inverse_is_found(robot: str, change) -> None:
    assert broken(robot, "ik", change)


@pytest.mark.parametrize("robot", ["planar_2r", "spherical_wrist"])
def test_a_wrong_value_is_found(robot: str) -> None:
    assert broken(robot, "fk", lambda x: x * (1 + 1e-14))
    assert broken(robot, "determinant", lambda x: x + 1e-13)
