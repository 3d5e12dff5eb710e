"""The program for the common case detects that something vanishes, and is exact otherwise."""

import importlib
import itertools
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from given import beside
from interpreter import run

from closedform.emit.backends.c.kernel import Emission
from closedform.lower import Lowered, lower
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import Program, choose, real, used_up
from closedform.pipeline import scripts

SINGULAR = 2
x, y, z = (real(n) for n in "xyz")


def chained() -> Lowered:
    """Flags that depend on values selected by other flags, and a flag that holds only if another
    does not, with much work for each."""
    p = Program()
    first = p.vanishes("first", sp.Abs(x), 1, "x is zero")
    u = p.let("u", choose(first, (y**2 + z) * (y - z**2) + 3 * y * z, z / x))
    second = p.vanishes("second", used_up(p.let("room", u - y)), 1, "no room")
    third = p.vanishes("third", sp.Abs(z), 1, "z is zero")
    w = p.let("w", choose(sp.And(second, sp.Not(third)), (u + z) * (y - u) + y**2 * z, y + u))
    v = p.let("v", choose(second, (u + 2 * z) * (y - 3 * u) * (x + w), w))
    d = Derivation("test", "", Paper("", "", ()), "")
    return lower(d.function("f", "", {"q": (x, y, z)}, {"p": [u, v, w]}, program=p), d)


def test_where_nothing_vanishes_it_is_the_whole_program() -> None:
    program = chained()
    assert program.common is not None
    assert program.common.length < 0.7 * program.length
    seen = []
    for values in itertools.product([0.0, 1e-18, 1e-8, 1.0, -2.0, 4.0], repeat=3):
        point = dict(zip("xyz", values, strict=True))
        *common, rare = run(program.common, point)
        seen.append(rare)
        if not rare:
            assert common == run(program, point)
    assert 20 < sum(seen) < len(seen) - 20


def bounded() -> Lowered:
    """A flag before a bound, and one after it that holds wherever the bound fails."""
    p = Program()
    first = p.vanishes("first", sp.Abs(y), 1, "y is zero")
    u = p.let("u", choose(first, (x**2 + z) * (x - z**2) + 3 * x * z, z / y))
    room = p.bound("room", x - 1, 1, "x is at least 1")
    second = p.vanishes("second", room, 1, "no room")
    v = p.let("v", choose(second, (u + 2 * z) * (y - 3 * u) * (x + z) + u**2 * z, u / room))
    d = Derivation("test", "", Paper("", "", ()), "")
    return lower(d.function("f", "", {"q": (x, y, z)}, {"p": [u, v]}, program=p), d)


@pytest.mark.parametrize(
    ("at", "rare"), [((0, 1), False), ((1, 1), True), ((2, 1), False), ((0, 0), True)]
)
def test_a_flag_after_a_bound_that_fails_does_not_count(at: tuple, rare: bool) -> None:
    program = bounded()
    assert program.common is not None
    point = {"x": float(at[0]), "y": float(at[1]), "z": 3.0}
    *common, raised = run(program.common, point)
    assert raised == rare
    if not rare:
        np.testing.assert_array_equal(common, run(program, point))


def kernels() -> list[tuple[str, str]]:
    """The robots and functions that have a common case."""
    found = []
    for source in scripts.sources():
        module = importlib.import_module(f"closedform.generated.numpy.{source.name}")
        found += [
            (source.name, name)
            for name in vars(module)
            if getattr(getattr(module, name), "common", None) is not None
        ]
    return found


def arguments_at(module: ModuleType, name: str, q: np.ndarray) -> list[np.ndarray]:
    """What a kernel takes at these postures: joints, or the targets with them."""
    argument, *others = getattr(module, name).inputs
    if argument.name == "q":
        return [q]
    image = module.pose(q) if argument.shape == (4, 4) else module.fk(q)
    return [image.p[:, 0] if hasattr(image, "p") else image, *(beside(module, q) if others else ())]


def planes(robot: str, name: str, q: np.ndarray) -> tuple[list[np.ndarray], object]:
    """The planes of the arguments at these postures, and of the parameters."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    kernel = getattr(module, name)
    x = np.concatenate([a.reshape(len(q), -1) for a in arguments_at(module, name, q)], axis=1)
    x = x[np.isfinite(x).all(axis=-1)]
    used = [np.float64(getattr(module.Parameters(), name)) for name in kernel.used]
    return [*x.T, *used], kernel


def at_the_end(module: ModuleType, q: np.ndarray) -> np.ndarray:
    """The last of these postures, on the way to far ones, in which the mechanism closes."""
    way = np.random.default_rng(4).normal(size=q.shape)
    near, far = np.zeros((len(q), 1)), np.full((len(q), 1), 4.0)
    for _ in range(60):
        middle = (near + far) / 2
        closes = np.isfinite(module.fk(q + middle * way).p[:, :1, 0])
        near, far = np.where(closes, middle, near), np.where(closes, far, middle)
    return q + near * way


def postures(robot: str, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Random postures, and some with most joints at right angles, or off by little."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    rng = np.random.default_rng(3)
    usual = rng.uniform(-3, 3, (n, len(module.JOINTS)))
    special = rng.choice([0, np.pi / 2, -np.pi / 2, np.pi, 0.3, -1.1], usual.shape)
    special = special + rng.choice([0, 0, 1e-17, 1e-12, 1e-6], usual.shape)
    if robot == "orthoglide":  # sliders about as far as its legs are long; two may meet at zero
        usual, special = 0.5 + usual / 12, rng.choice([0, 0, 0.3, 0.5], usual.shape)
    if robot == "delta":  # cranks that all rods reach
        usual = 0.45 + usual / 4
    if robot == "linear_delta":  # sliders that most rods reach
        usual = usual / 30
    if robot in ("delta", "linear_delta"):  # both modes meet where the workspace ends
        special = at_the_end(module, usual)
    if robot == "spherical_five_bar":  # both cranks, equally long, end at one place
        v = module.Parameters()
        meet = np.arccos(np.tan(v.gamma / 2) / np.tan(v.alpha1))
        special[::8] = rng.choice([1, -1], (len(special[::8]), 1)) * [meet, np.pi - meet]
    if robot.startswith("h6ar"):  # two arms that work together, straight with the bent fore-arm
        special[::2, 2] = np.arctan2(module.Parameters().L2, module.Parameters().a3)
        for q in (usual, special):
            q[:, 3:5] = q[:, 1:3] + rng.choice([0, 0.1, -0.03], (n, 2))
    return usual, special


@pytest.mark.parametrize(("robot", "name"), kernels())
def test_generated(robot: str, name: str) -> None:
    # the elbow of the Franka arm counts as nearly straight or folded more often
    usual = 0.06 if robot == "franka_arm" else 0.02
    for q, most in zip(postures(robot, 4000), (usual, 1), strict=True):
        arguments, kernel = planes(robot, name, q)
        with np.errstate(all="ignore"):
            whole = kernel.compute(*arguments)
            *common, rare = kernel.common(*arguments)
        left_out = robot == "agile_wrist"  # its forward map gives no orientation that is rare
        assert rare.mean() <= most and (most < 1 or rare.any() or left_out)
        whole, common = ([np.asarray(v) for v in values] for values in (whole, common))
        statuses = [v for v in whole if v.dtype == np.uint8]
        # of some loops, SINGULAR also where joints do not determine the posture
        if statuses and not robot.startswith(("h6ar", "agile_wrist")):
            assert rare[(np.array(statuses) == SINGULAR).any(axis=0)].all()
        for a, b in zip(common, whole, strict=True):
            kept = np.broadcast_to(a, rare.shape)[~rare]
            b = np.broadcast_to(b, rare.shape)
            if a.dtype == np.uint8:
                np.testing.assert_array_equal(kept, b[~rare])
            else:
                np.testing.assert_array_equal(np.isnan(kept), np.isnan(b[~rare]))
                apart = np.abs(kept - b[~rare])
                apart = np.abs(np.sin(apart / 2)) if name == "_IK" else apart / (1 + np.abs(kept))
                # at the boundary of the workspace
                assert np.nanmax(apart, initial=0) < 1e-6
                assert np.nanquantile(apart, 0.9) < 1e-13


@pytest.mark.parametrize(("robot", "name"), kernels())
def test_rare_postures_of_a_batch(robot: str, name: str) -> None:
    """Each posture and its neighbour have the answers of single calls; parameters broadcast."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    usual, q = postures(robot, 60)
    q[::2] = usual[::2]
    taken, function = arguments_at(module, name, q), getattr(module, name.lower()[1:])
    together = parts(function(*taken))
    single = [parts(function(*one)) for one in zip(*taken, strict=True)]
    few = 64 * np.finfo(float).eps
    for whole, ones in zip(together, zip(*single, strict=True), strict=True):
        exact = whole.dtype == np.uint8
        np.testing.assert_allclose(whole, ones, *((0, 0) if exact else (few, few)))
    larger = module.Parameters(*(np.array([[v], [v]]) for v in module.Parameters()))
    for whole, twice in zip(together, parts(function(*taken, larger)), strict=True):
        np.testing.assert_array_equal(twice[0], whole)
        np.testing.assert_array_equal(twice[1], whole)


def parts(result: object) -> tuple[np.ndarray, ...]:
    """The answer and the status, or the only result."""
    return tuple(result) if isinstance(result, tuple) else (result,)


@pytest.mark.parametrize("inverse", [False, True])
def test_in_c_a_quotient_does_not_wait_for_what_hardly_ever_holds(*, inverse: bool) -> None:
    """An inverse is different: jumps would part its branches, which are computed side by side."""
    p = Program()
    flag = p.vanishes("flag", sp.Abs(x), 1, "x is zero")
    divisor = p.let("divisor", choose(flag, 1, x))
    angle = sp.atan2(y, divisor) if inverse else y
    d = Derivation("test", "", Paper("", "", ()), "")
    f = d.function("f", "", {"q": (x, y, z)}, {"p": [z / divisor, angle]}, program=p)
    lines = Emission(d, f, lower(f, d), "f").emit().kernel_lines
    chosen = next(line for line in lines if "divisor =" in line)
    assert ("cf_rarely(single, " in chosen) is not inverse
    assert ("cf_select(" in chosen) is inverse
