"""Derivatives of the modules for any array library, against the symbolic ones and differences.

They are taken with the small library of ``tape.py``, whose derivatives hide nothing, so these tests
need no other one; ``test_array_libraries.py`` has the others.
"""

from __future__ import annotations

import importlib
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import closedform.generated.array as generated
import numpy as np
import pytest
import tape
from closedform.generated.array import _runtime
from exact_derivatives import along as exact_along
from given import beside

from closedform.check.runners.python import module
from closedform.emit.backend import Mechanism
from closedform.emit.backends import array as backend
from closedform.lower.finite import finite_derivatives
from closedform.pipeline.run import write
from closedform.proof.prove import Proof

ROBOTS = sorted(path.stem for path in Path(generated.__path__[0]).glob("[a-z]*.py"))
every_robot = pytest.mark.parametrize("robot", ROBOTS)
with_jacobian = pytest.mark.parametrize(
    "robot", [robot for robot in ROBOTS if robot not in ("agile_wrist", "three_prs")]
)
"""Those with a forward map and its derivative by all joints among their functions."""
CONDITION = 1e4
"""Derivatives are compared where the Jacobian is better conditioned, or smaller, than this."""


def modules(robot: str) -> tuple[ModuleType, ModuleType]:
    """The module under test, and that of NumPy."""
    return (
        importlib.import_module(f"closedform.generated.array.{robot}"),
        importlib.import_module(f"closedform.generated.numpy.{robot}"),
    )


@cache
def postures(robot: str) -> np.ndarray:
    """Random joints at which loops close; then joints at right angles and near them."""
    _, numpy = modules(robot)
    random = np.random.default_rng(5)
    n = len(numpy.JOINTS)
    drawn = np.random.default_rng(5).uniform(-2, 2, (1000, n))
    if hasattr(numpy, "fk"):
        hands = np.asarray(numpy.fk(drawn).p if numpy.ASSEMBLY_MODES else numpy.fk(drawn))
        drawn = drawn[np.isfinite(hands).reshape(len(drawn), -1).all(-1)]
    corners = random.choice((0.0, np.pi / 2, np.pi, -np.pi / 2), (40, n))
    near = random.choice((0.0, 1e-15, 1e-9, 1e-4), (40, n))
    return np.concatenate([drawn[:20], corners + near, np.zeros((1, n))])


@cache
def targets(robot: str) -> np.ndarray:
    """What the postures reach; then targets out of reach, at the origin, and not finite."""
    _, numpy = modules(robot)
    if not hasattr(numpy, "fk"):
        tilts = np.random.default_rng(6).uniform(-0.2, 0.2, (30, len(numpy.TASK)))
        return np.concatenate([tilts, tilts[:4] * 1e3, tilts[:4] * np.nan])
    x = numpy.fk(postures(robot))
    if numpy.ASSEMBLY_MODES:
        x = np.nan_to_num(x.p[:, 0])
    far, lost = np.full_like(x[:2], np.inf), np.full_like(x[:2], np.nan)
    return np.concatenate([x, x[:4] * 1e3, x[:4] * 0, x[:4] * 1e-12, far, lost])


@cache
def given(robot: str) -> tuple[np.ndarray, ...]:
    """What the inverse takes beside these targets, by its value at the posture of each."""
    _, numpy = modules(robot)
    if not hasattr(numpy, "fk"):
        return ()
    values = beside(numpy, postures(robot))
    return tuple(np.concatenate([v, v[:4], v[:4], v[:4], v[:2], v[:2]]) for v in values)


def image(numpy: ModuleType, q: np.ndarray, *params: Any) -> np.ndarray:
    """The target of postures without assembly modes, and what is given beside it, in a row."""
    more = [value[..., None] for value in beside(numpy, q, *params)]
    return np.concatenate([numpy.fk(q, *params).reshape(*q.shape[:-1], -1), *more], axis=-1)


def beside_rates(numpy: ModuleType, q: np.ndarray) -> np.ndarray:
    """The derivatives of what is given besides a target, by joints, by differences: one a row."""
    steps = 1e-3 * np.eye(q.shape[-1])

    def central(times: int) -> np.ndarray:
        ends = [
            np.stack([*beside(numpy, q + s * times * step), 0 * q[..., 0]], axis=-1)
            for step in steps
            for s in (1, -1)
        ]
        gap = np.angle(np.exp(1j * (np.stack(ends[::2]) - np.stack(ends[1::2]))))
        return np.asarray(gap / (2e-3 * times))

    return np.asarray((4 * central(1) - central(2)) / 3)[..., :-1]


def symbolic(numpy: ModuleType, q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The derivative of the forward map by each joint, which stands first: from the Jacobians."""
    if x.shape[-1] == len(numpy.TASK) and hasattr(numpy, "jacobian"):
        found = numpy.jacobian(q)[..., : x.shape[-1], :]
        if numpy.ASSEMBLY_MODES:
            p = numpy.fk(q).p
            mode = np.nanargmin(np.where(np.isnan(p), np.inf, abs(p - x[..., None, :])).sum(-1), -1)
            found = np.take_along_axis(found, mode[..., None, None, None], -3)[..., 0, :, :]
        return np.moveaxis(found, -1, 0)
    columns = np.moveaxis(numpy.jacobian_space(q), -1, 0)
    rates, zero = columns[..., -3:], np.zeros(columns.shape[:-1])
    a, b, c = np.moveaxis(rates, -1, 0)
    turn = np.stack([zero, -c, b, c, zero, -a, -b, a, zero], -1).reshape(*zero.shape, 3, 3)
    if x.shape[-1] == 3:
        return turn @ x
    twist = np.zeros((*zero.shape, 4, 4))
    twist[..., :3, :3], twist[..., :3, 3] = turn, columns[..., :3]
    return twist @ x


@with_jacobian
def test_the_forward_map_has_the_symbolic_jacobian(robot: str) -> None:
    array, numpy = modules(robot)
    q = tape.asarray(postures(robot))
    result = array.fk(q)
    x = result.p if numpy.ASSEMBLY_MODES else result
    random = np.random.default_rng(1)
    weights = random.normal(size=x.shape)
    if not numpy.ASSEMBLY_MODES:
        (found,) = tape.gradients(x, weights, [q])
        expected = symbolic(numpy, q.value, x.value)
        axes = tuple(range(2, expected.ndim))
        contracted = (weights * expected).sum(axes).T
        defined = np.isfinite(contracted).all(-1)
        assert defined.sum() > 15
        np.testing.assert_allclose(found[defined], contracted[defined], rtol=1e-7, atol=1e-9)
        return
    moderate = np.nan_to_num(abs(numpy.jacobian(q.value)), nan=np.inf).max((-1, -2)) < CONDITION
    exists = (result.status.value == 0) & moderate
    weights = np.where(exists[..., None], weights, 0.0)
    (found,) = tape.gradients(x, weights, [q])
    jacobian = np.where(exists[..., None, None], numpy.jacobian(q.value), 0.0)
    expected = (weights[..., None] * jacobian).sum((1, 2))
    assert exists.sum() > 10
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6)


@with_jacobian
def test_an_inverse_has_the_inverse_of_the_symbolic_jacobian(robot: str) -> None:
    """Along the forward derivative by a joint, that joint changes by one, and no other."""
    array, numpy = modules(robot)
    x, more = targets(robot)[:20], [value[:20] for value in given(robot)]
    solved = numpy.ik(x, *more)
    branches, n = solved.q.shape[1:]
    along = np.stack([symbolic(numpy, solved.q[:, b], x) for b in range(branches)])
    rates = np.stack([beside_rates(numpy, solved.q[:, b]) for b in range(branches)])
    columns = np.concatenate([along.reshape(branches, n, len(x), -1), rates], axis=-1)
    usable = (solved.status.T == 0) & np.isfinite(columns).all((1, 3))
    conditions = np.linalg.cond(np.where(usable[..., None, None], np.moveaxis(columns, 1, 2), 1.0))
    usable &= conditions < CONDITION
    assert usable.any(axis=1).sum() > branches // 2
    tiled = [tape.asarray(np.broadcast_to(v, (branches, *v.shape))) for v in (x, *more)]
    weights = np.random.default_rng(2).normal(size=(branches, len(x), n)) * usable[..., None]
    own = np.zeros((branches, len(x), branches, n))
    own[np.arange(branches), :, np.arange(branches)] = weights
    found = tape.gradients(array.ik(*tiled).q, own, tiled)
    rows = np.concatenate([np.reshape(f, (branches, 1, len(x), -1)) for f in found], axis=-1)
    moved = np.where(usable[:, None], (rows * columns).sum(-1), 0.0)
    np.testing.assert_allclose(np.moveaxis(moved, 1, -1), weights, rtol=1e-6, atol=1e-7)


@with_jacobian
def test_derivatives_of_an_inverse_by_dimensions(robot: str) -> None:
    """If a dimension changes and the target does not, the joints move so that the hand stays.

    They cannot undo where the dimension moves the hand and no joint does, such as off a sphere.
    """
    array, numpy = modules(robot)
    x, more = targets(robot)[:20], [value[:20] for value in given(robot)]
    solved = numpy.ik(x, *more)
    along = np.moveaxis(symbolic(numpy, solved.q[:, 0], x), 0, 1).reshape(*solved.q[:, 0].shape, -1)
    if more:
        rates = np.moveaxis(beside_rates(numpy, solved.q[:, 0]), 0, 1)
        along = np.concatenate([along, rates], axis=-1)
    usable = (solved.status[:, 0] == 0) & np.isfinite(along).all((1, 2))
    x, q, along = x[usable], solved.q[usable, 0], along[usable]
    more = [value[usable] for value in more]
    count, n = q.shape
    dimensions = np.array([float(v) for v in numpy.Parameters()])
    # for each joint a copy of the targets, with dimensions of its own
    copies = [tape.asarray(np.broadcast_to(v, (n, *v.shape))) for v in (x, *more)]
    fields = [tape.asarray(np.full((n, count), v)) for v in dimensions]
    weights = np.zeros((n, count, *solved.q.shape[1:]))
    weights[np.arange(n), :, 0, np.arange(n)] = 1.0
    rates = tape.gradients(array.ik(*copies, fields).q, weights, fields)

    def reached(lengths: np.ndarray) -> np.ndarray:
        if not numpy.ASSEMBLY_MODES:
            return image(numpy, q, tuple(lengths))
        found = numpy.fk(q, tuple(lengths))
        mode = np.nanargmin(abs(numpy.fk(q).p - x[:, None]).sum(-1), -1)
        return found.p[np.arange(count), mode]

    for k, rate in enumerate(rates):
        step = np.zeros_like(dimensions)
        step[k] = 1e-6 * max(dimensions.max(), 1.0)
        by_dimension = (reached(dimensions + step) - reached(dimensions - step)) / (2 * step[k])
        by_joints = np.einsum("jp,pjx->px", rate, along)
        left = np.einsum("pjx,px->pj", along, by_joints + by_dimension)
        scale = 1 + abs(along).max((1, 2)) * (1 + abs(by_joints).max(1))
        assert count and (abs(left).max(1) / scale).max() < 1e-5


@every_robot
def test_derivatives_are_finite_wherever_the_status_is_ok(robot: str) -> None:
    """Also by dimensions that all targets share, those that are not OK among them."""
    array, numpy = modules(robot)
    inputs = [tape.asarray(v) for v in (targets(robot), *given(robot))]
    fields = [tape.asarray(float(v)) for v in numpy.Parameters()]
    solved = array.ik(*inputs, fields)
    ok = solved.status.value == 0
    expected = numpy.ik(*(v.value for v in inputs)).status
    np.testing.assert_array_equal(solved.status.value, expected)
    assert 0 < ok.sum() < ok.size
    for found in tape.gradients(solved.q, np.where(ok[..., None], 1.0, 0.0), [*inputs, *fields]):
        assert np.isfinite(found).all()


def kernels(array: ModuleType) -> dict[str, Any]:
    """The kernels with derivatives, by name: all but those that only decide."""
    found = {k.name: k for k in vars(array).values() if isinstance(k, _runtime.Kernel)}
    return {n: k for n, k in found.items() if any(spec.kind == "real" for spec in k.outputs)}


def arguments(robot: str, kernel: Any) -> list[np.ndarray]:
    """For each input six random values, four at corners, and some that move the hand there."""
    _, numpy = modules(robot)
    random = np.random.default_rng(8)
    chosen = np.r_[0:6, 20:24]
    values = []
    for spec in kernel.inputs:
        if spec.name == "q":
            values.append(postures(robot)[chosen])
        elif spec.name == "T" and spec.shape == (4, 4):
            values.append(numpy.pose(postures(robot)[chosen]))
        elif spec.name in ("x", "R", "p"):
            values.append(targets(robot)[chosen][..., : spec.shape[-1]])
        else:
            values.append(random.uniform(0.1, 0.8, (len(chosen), *spec.shape)))
    return values


def flat(values: list[np.ndarray], count: int) -> np.ndarray:
    """All numbers of each posture in a row."""
    return np.concatenate([np.reshape(v, (count, -1)) for v in values], axis=1)


class Compared(NamedTuple):
    """Derivatives of the results that are OK, and the exact ones, in rows of one posture each.

    The results are weighted and added.  ``found`` are those of the mechanism as it is, and, if its
    kernel works at any size, of very small and very large ones.  ``steepest`` is the largest exact
    derivative of a single result, and NaN if none is OK.
    """

    found: list[np.ndarray]
    exact: np.ndarray
    steepest: np.ndarray


def compared(robot: str, kernel: Any, by: str) -> Compared:
    """Derivatives of a kernel along a random direction of its inputs or of the dimensions."""
    _, numpy = modules(robot)
    random = np.random.default_rng(9)
    given = arguments(robot, kernel)
    count, shapes = len(given[0]) if given else 1, [v.shape for v in given]
    sizes = dict(zip(kernel.fields, numpy.Parameters(), strict=True))
    at = flat([*given, *(np.full(count, sizes[name]) for name in kernel.used)], count)
    own = at.shape[1] - len(kernel.used)
    moves = random.normal(size=at.shape)
    moves[:, slice(own, None) if by == "inputs" else slice(own)] = 0.0
    rates = np.array([exact_along(kernel, p, move) for p, move in zip(at, moves, strict=True)])
    shares = random.normal(size=rates.shape)
    degrees = np.zeros(rates.shape[1], int)
    if kernel.size:
        degrees[[k for k, _ in kernel.size.degrees]] = [degree for _, degree in kernel.size.degrees]

    def evaluated(exponent: int) -> tuple[np.ndarray, np.ndarray]:
        """The derivatives of the results of a mechanism 2**exponent as large, and which are OK."""
        grown = np.zeros(at.shape[1], int)
        if kernel.size:
            grown[list(kernel.size.lengths)] = exponent
        planes, steps = np.ldexp(at, grown), np.ldexp(moves, grown)
        columns = [tape.asarray(p) for p in planes.T]
        fields = {**sizes, **dict(zip(kernel.used, columns[own:], strict=True))}
        inputs, start = [], 0
        for shape in shapes:
            width = int(np.prod(shape[1:]))
            inputs.append(tape.asarray(planes[:, start : start + width].reshape(shape)))
            start += width
        results = _runtime.evaluate(kernel, inputs, list(fields.values()))
        results = results if isinstance(results, tuple) else (results,)
        by_kind = list(zip((s.kind for s in kernel.outputs), results, strict=True))
        total, every, start = np.zeros(count), [], 0
        for kind, result in by_kind:
            ok = np.isfinite(result.value)
            for status in (r.value for k, r in by_kind if k == "status"):
                ok &= (status == 0).reshape(*status.shape, *[1] * (ok.ndim - status.ndim))
            ok = flat([ok & (kind == "real")], count)
            places = slice(start, start := start + ok.shape[1])
            powers = -exponent * degrees[places]
            in_range = abs(powers) < 1000
            weights = np.where(ok & in_range, np.ldexp(shares[:, places], powers * in_range), 0.0)
            every.append(ok)
            if kind == "real":
                variables = [*inputs, *columns[own:]]
                found = tape.gradients(result, weights.reshape(result.shape), variables)
                total += (flat([*map(np.asarray, found)], count) * steps).sum(1)
        return total, np.concatenate(every, axis=1)

    found, ok = evaluated(0)
    others = [evaluated(exponent)[0] for exponent in (-150, 10, 150) if kernel.size]
    steepest = np.where(ok.any(1), np.where(ok, abs(rates), 0.0).max(1), np.nan)
    return Compared([found, *others], np.where(ok, shares * rates, 0.0).sum(1), steepest)


@every_robot
@pytest.mark.parametrize("by", ["inputs", "dimensions"])
def test_every_function_has_the_exact_derivative(robot: str, by: str) -> None:
    """Wherever the exact derivatives are not too large: by joints or targets, and by dimensions."""
    array, _ = modules(robot)
    for name, kernel in kernels(array).items():
        if not (kernel.inputs if by == "inputs" else kernel.used):
            continue
        rates = compared(robot, kernel, by)
        moderate = rates.steepest < CONDITION
        assert moderate.sum() >= min(3, len(moderate)), name
        for found in rates.found:
            wrong = abs(found - rates.exact) / (1e-3 + rates.steepest)
            assert wrong[moderate].max() < 1e-7, name


def test_without_safe_operands_derivatives_are_not_finite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What programs are changed for: with a link of no length, a quotient is 0 / 0."""
    d = importlib.import_module("closedform.derivations.planar_2r").d
    d = replace(d, functions=[d["ik"], d["ik_pose"]])
    finite = []
    for number, change in enumerate((finite_derivatives, lambda program: program)):
        monkeypatch.setattr(backend, "finite_derivatives", change)
        printed = backend.BACKEND.pages(Mechanism(d, Proof(d.name, "own", (), 0, ()))).files
        folder = tmp_path / str(number)
        write(folder, {**printed, **backend.BACKEND.shared([])})
        ik_pose = module(folder / "array", d.name).ik_pose
        l1 = tape.asarray(0.0)
        solved = ik_pose(tape.asarray(np.eye(4)), (l1, 0.0))
        (found,) = tape.gradients(solved.q, 1.0, [l1])
        finite.append(bool(np.isfinite(found)))
    assert finite == [True, False]


def test_derivatives_at_the_cut_of_an_angle_are_those_beside_it() -> None:
    """An angle of pi, and one that a turn is taken from."""
    array, _ = modules("planar_2r")
    for angles in ([np.pi, 0.0], [-np.pi, 0.0], [np.pi, np.pi], [3 * np.pi, -1.0], [1e9, 2.0]):
        q = tape.asarray(np.array(angles))
        (found,) = tape.gradients(array.orientation(q), 1.0, [q])
        np.testing.assert_allclose(found, [1.0, 1.0], rtol=1e-9)
    arm = [tape.asarray(2.0), tape.asarray(1.0)]
    x = tape.asarray(np.array([[-2.5, 0.0], [-2.5, -0.0]]))
    solved = array.ik(x, arm)
    assert solved.status.value.tolist() == [[0, 0], [0, 0]]
    beside = tape.asarray(np.array([[-2.5, 1e-9], [-2.5, 1e-9]]))
    for branch in range(2):
        weights = np.zeros((2, 2, 2))
        weights[:, branch, 0] = 1.0
        (at,) = tape.gradients(solved.q, weights, [x])
        (near,) = tape.gradients(array.ik(beside, arm).q, weights, [beside])
        np.testing.assert_allclose(at, near, atol=1e-6)


def test_roots_and_angles_at_zero_have_the_derivative_zero() -> None:
    ops = importlib.import_module("closedform.generated.array._runtime").Operations(
        tape, tape.float64, "tape"
    )
    for value in (0.0, -0.0):
        x, y = tape.asarray(value), tape.asarray(0.0)
        root, angle = ops.sqrt(x), ops.atan2(y, x)
        assert root.value == 0 and angle.value == 0
        assert [float(d) for d in tape.gradients(root, 1.0, [x])] == [0.0]
        assert [float(d) for d in tape.gradients(angle, 1.0, [x])] == [0.0]
        assert np.isfinite(tape.gradients(angle, 1.0, [y])[0])
