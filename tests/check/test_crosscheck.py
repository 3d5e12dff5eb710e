"""Generated code against the symbolic source in Arb, in every back end; the check can fail."""

import importlib
from collections.abc import Iterator

import libraries
import numpy as np
import pytest
import sympy as sp
from places import ROOT

from closedform.check import runners, values
from closedform.check.clibrary import CLibrary
from closedform.check.crosscheck import crosscheck
from closedform.check.failures import UnavailableError
from closedform.check.finding import Backend, Finding, float_backend, module_backend
from closedform.check.inverses import check_inverse
from closedform.check.samples import Sample
from closedform.check.truth import solutions_of
from closedform.check.values import check_boolean, check_forward
from closedform.emit.backends import load, names
from closedform.model.derivation import Derivation, Paper
from closedform.model.tolerances import DOUBLE, FLOAT
from closedform.pipeline.scripts import sources

ROBOTS = [source.name for source in sources()]
all_robots = pytest.mark.parametrize("robot", ROBOTS, scope="module")
"""Robot by robot: what is compared with is evaluated once."""
GENERATED = ROOT / "generated"
MODULES = ("numpy", "c")
OTHERS = tuple(name for name in names() if load(name).runner and name not in MODULES)
"""Languages whose code is run as after ``closedform derive``, and not imported."""


def derivation(robot: str) -> Derivation:
    return importlib.import_module(f"closedform.derivations.{robot}").d


def backends(name: str, robot: str, factory: pytest.TempPathFactory) -> Iterator[Backend]:
    if name == "c float":
        folder, built = factory.mktemp(robot), None
        if libraries.compiles() and libraries.runs():
            built, _ = libraries.library(factory, robot, single=True)
        library = CLibrary(derivation(robot), GENERATED / "c", folder, single=True, built=built)
        yield float_backend(library.function)
    elif name in MODULES:
        module = importlib.import_module(f"closedform.generated.{name}.{robot}")
        yield module_backend(name, module)
    else:
        run = runners.load(load(name).runner)
        try:
            yield from run(name, derivation(robot), GENERATED / name, factory.mktemp(robot))
        except UnavailableError as error:
            pytest.skip(f"{error}: {name} is not checked")


@pytest.mark.parametrize("name", [*MODULES, "c float", *OTHERS])
@all_robots
def test_against_the_symbolic_source(
    robot: str, name: str, tmp_path_factory: pytest.TempPathFactory, findings: list[Finding]
) -> None:
    for backend in backends(name, robot, tmp_path_factory):
        found = crosscheck(derivation(robot), backend)
        findings += found
        assert not [problem for f in found for problem in (*f.failures, *f.limits)]
        assert all(f.compared for f in found)


def test_a_call_that_is_wrong_where_a_batch_is_right_is_found(tmp_path) -> None:
    d = derivation("planar_2r")
    try:
        library = CLibrary(d, GENERATED / "c", tmp_path)
    except UnavailableError as error:
        pytest.skip(str(error))
    backend = Backend("c", library.function, np.float64, DOUBLE)
    assert not any(found.failures for found in crosscheck(d, backend))
    call = library.compiled.planar_2r_fk
    library.compiled.planar_2r_fk = lambda params, q, p: call(params, p, p)
    wrong = [found.function for found in crosscheck(d, backend) if found.failures]
    assert wrong == ["fk"]


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
    check = check_boolean if d[function].boolean else check_forward
    return check(d, d[function], backend).failures


def swapped_sign(solutions):
    return solutions._replace(q=-solutions.q)


def first_branch_only(solutions):
    answers = np.repeat(solutions[0][:, :1], solutions[0].shape[1], axis=1)
    return solutions._replace(**{solutions._fields[0]: answers})


def backwards(solutions):
    """The right answers, in another order than the names of the branches."""
    return type(solutions)(*(part[:, ::-1] for part in solutions))


def slightly_off(x):
    """Values wrong by ulps are found; in a closed loop, checked by round trips, by 1e-11."""
    return x._replace(p=x.p * (1 + 1e-11)) if isinstance(x, tuple) else x * (1 + 1e-14)


def never_reachable(solutions):
    nan = np.full_like(solutions.q, np.nan)
    return solutions._replace(q=nan, status=np.ones_like(solutions.status))


@pytest.mark.parametrize("change", [swapped_sign, never_reachable])
@all_robots
def test_a_wrong_inverse_is_found(robot: str, change) -> None:
    assert broken(robot, "ik", change)


def near_singular_ones_lost(solutions):
    near = abs(np.sin(solutions.q[:, 0, 1])) < 1e-3
    solutions.q[near], solutions.status[near] = np.nan, 1
    return solutions


@pytest.mark.parametrize(
    ("change", "wrong"), [(never_reachable, True), (near_singular_ones_lost, False)]
)
def test_single_precision_may_lose_a_few_solutions(change, wrong: bool) -> None:
    """This is told.  If it loses ordinary ones, it is a failure."""
    module = importlib.import_module("closedform.generated.numpy.planar_2r")
    d = derivation("planar_2r")
    backend = float_backend(lambda name: lambda *a: change(getattr(module, name)(*a)))
    finding = check_inverse(d, d["ik"], d.inverses[0], backend)
    assert bool(finding.failures) == wrong and finding.limits


def one_branch_for_all_of_unequal_lengths(solutions, params):
    sizes = [abs(p) for p in params if p]
    if max(sizes) < 100 * min(sizes):
        return solutions
    return first_branch_only(solutions)


@pytest.mark.parametrize("everywhere", [True, False])
def test_in_single_precision_branches_may_meet_if_lengths_are_unequal(everywhere: bool) -> None:
    """This is told: the digits do not tell the branches apart.  Elsewhere it is a failure."""
    module = importlib.import_module("closedform.generated.numpy.puma560")

    def call(name: str):
        def called(x, params):
            found = getattr(module, name)(x, params)
            if everywhere:
                return first_branch_only(found)
            return one_branch_for_all_of_unequal_lengths(found, params)

        return called

    d = derivation("puma560")
    finding = check_inverse(d, d["ik"], d.inverses[0], float_backend(call))
    told = [m for m in finding.limits if "has the answer of branch" in m]
    wrong = [m for m in finding.failures if "has the answer of branch" in m]
    assert bool(wrong) == everywhere and (told or everywhere)


@pytest.mark.parametrize("change", [first_branch_only, backwards])
@all_robots
def test_a_missing_or_misnamed_branch_is_found(robot: str, change) -> None:
    """Also an assembly mode, where the forward map of a loop has several."""
    d = derivation(robot)
    several = [i.function for i in d.inverses if len(list(d[i.function].cases())) > 1]
    assert several
    for function in several:
        assert broken(robot, function, change)


def never_singular(solutions):
    return solutions._replace(status=np.where(solutions.status == 2, 0, solutions.status))


@pytest.mark.parametrize(
    "robot", ["h6ar", "h6ar_loop_closed", "hybrid_five_bar", "rpr_planar"], scope="module"
)
def test_an_answer_that_joints_do_not_determine_is_found(robot: str) -> None:
    found = broken(robot, "ik", never_singular)
    assert any("is OK, but fk misses by" in failure for failure in found)


@all_robots
def test_a_wrong_value_is_found(robot: str) -> None:
    first = next(f.name for f in derivation(robot).functions if f.name in ("fk", "hand_pose"))
    assert broken(robot, first, slightly_off)
    square = any(f.name == "determinant" for f in derivation(robot).functions)
    name = "determinant" if square else "jacobian"
    assert broken(robot, name, lambda x: x + 1e-13 * (1 + np.abs(x)))


def test_a_wrong_truth_value_is_found() -> None:
    assert broken("hybrid_five_bar", "workspace_contains", np.logical_not)


@pytest.mark.parametrize(("factor", "wrong"), [(1.0, False), (1 + 1e-10, True)])
def test_lengths_that_cancel_in_names_lose_digits(factor: float, wrong: bool) -> None:
    """A name holds the larger length; its rounding is not an error of the difference."""
    d = Derivation("bar", "Bar", Paper("toy", "Toys", ("A.",)), "A bar.", task=["x"])
    q, p = d.joint("theta1"), d.program()
    x = p.let("x_1", sp.Rational(1569, 10000) * sp.cos(q))
    outputs = {"x": [x - sp.Rational(1568, 10000) * sp.cos(q)]}
    fk = d.function("fk", "Place of the end.", {"q": [q]}, outputs, program=p)

    def printed(q, parameters):
        return factor * (0.1569 * np.cos(q) - 0.1568 * np.cos(q))

    backend = Backend("numpy", lambda name: printed, np.float64, DOUBLE)
    assert bool(check_forward(d, fk, backend).failures) == wrong


@pytest.mark.parametrize(
    ("robot", "posture", "moves"),
    [
        ("puma560", [0.3, 0.5, -0.7, 0.2, 0.9, 1.1], False),
        ("puma560", [0.3, 0.5, -0.7, 0.2, 1e-13, 1.1], True),  # axes 4 and 6 are in line
        ("ur_arm", [0.3, 0.5, 1e-9, 0.2, 0.9, 1.1], False),  # a straight elbow
        ("ur_arm", [0.3, 0.5, 0.7, 0.2, 1e-13, 1.1], True),  # four axes are parallel
        ("ur_arm", [0.3, 0.5, 1e-9, 0.2, 1e-13, 1.1], True),
        ("five_bar", [1.364123590404401, 1.6115524275272999], False),  # a straight leg
    ],
)
def test_where_a_mechanism_moves_without_its_hand(
    robot: str, posture: list[float], moves: bool
) -> None:
    d = derivation(robot)
    (inverse,) = (i for i in d.inverses if i.function == "ik")
    truth = solutions_of(d, d["ik"], inverse)
    lengths = [float(p.value) for p in d.parameters]
    assert truth.continues(np.array(posture), lengths, 1e-12) == moves


def test_a_yaw_beside_the_cut_may_be_on_either_side(monkeypatch: pytest.MonkeyPatch) -> None:
    """Joints that add up to just less than -pi in single precision add up to just more."""
    joints = [-1.5697963237762451, -1.5707963705062866, 0.5, 0.0010000000474974513]
    d, lengths = derivation("scara"), (1.0,) * len(derivation("scara").parameters)
    sample = Sample("folded back", np.array([joints]), lengths)
    monkeypatch.setattr(values, "joint_samples", lambda *_: [sample])
    module = importlib.import_module("closedform.generated.numpy.scara")

    def fk(q: np.ndarray, *parameters: np.ndarray) -> np.ndarray:
        x = module.fk(q, *parameters)
        assert 3.1415925 < x[0, 3] < np.pi
        x[0, 3] = np.float32(joints[0]) + np.float32(joints[1]) - np.float32(joints[3])
        return x

    backend = Backend("single", lambda _: fk, np.float32, FLOAT)
    assert check_forward(d, d["fk"], backend).failures == []
