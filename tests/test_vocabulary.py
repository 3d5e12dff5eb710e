"""The vocabulary on mechanisms that it was not written for: prismatic, coupled, closed-loop.

Each small derivation goes the whole way: proved, printed, compiled, and compared with Arb.
"""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from sympy import cos, sin, sqrt

from closedform.check.clibrary import CLibrary
from closedform.check.crosscheck import Backend, crosscheck, float_backend, module_backend
from closedform.emit.pages import pages, shared_files
from closedform.lemmas.sine_cosine import linear_pair
from closedform.lemmas.triangle import Triangle
from closedform.mechanics.frames import (
    adjoint,
    chain,
    denavit_hartenberg,
    exponential,
    homogeneous,
    prismatic_twist,
    revolute_twist,
    vee,
)
from closedform.model.derivation import Derivation, Paper, Solved
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Inverse
from closedform.model.tolerances import DOUBLE
from closedform.proof.prove import prove
from closedform.proof.require import ProofError

PAPER = Paper("toy", "Mechanisms of the tests", ("The closedform authors",))
X, Y, Z = (sp.Matrix(v) for v in ([1, 0, 0], [0, 1, 0], [0, 0, 1]))


def polar_arm() -> Derivation:
    """A revolute and a prismatic joint, by exponentials and by Denavit-Hartenberg."""
    d = Derivation("polar", "Polar arm", PAPER, "RP.", task=["x", "y"])
    h = d.parameter("h", value=2, unit="m", meaning="reach at home")
    theta, s = d.joint("theta"), d.joint("s", "prismatic")
    exponentials = [
        exponential(revolute_twist(Z, sp.zeros(3, 1)), theta),
        exponential(prismatic_twist(X), s),
        homogeneous(sp.eye(3), (h, 0, 0)),
    ]
    pose = chain(exponentials)
    rows = [
        denavit_hartenberg(0, sp.pi / 2, 0, theta + sp.pi / 2),
        denavit_hartenberg(0, -sp.pi / 2, h + s, 0),
    ]
    d.step("Pose", "Two routes.", {"T": pose}, equal=[(pose[:3, 3], chain(rows)[:3, 3])])
    d.function("fk", "Position.", {"q": (theta, s)}, {"x": pose[:2, 3]})
    d.function("pose", "Pose.", {"q": (theta, s)}, {"T": pose})
    px, py, sigma = real("px"), real("py"), real("sigma_side")
    side = branches((sigma, {+1: "front", -1: "back"}))
    d.branches = side.labels
    p = Program()
    r = p.let("r", sqrt(px**2 + py**2), nonnegative=True)
    free = p.vanishes("on_axis", r, h, "the hand is on the axis", free=(theta,))
    bearing = linear_pair(theta, sigma * py, sigma * px)
    d.solved.append(Solved("ik", theta, bearing, py * cos(theta) - px * sin(theta)))
    values = [choose(free, 0, bearing[theta]), sigma * r - h]
    d.function(
        "ik", "Both.", {"x": (px, py)}, {"q": values}, program=p, branches=side, result="Solutions"
    )
    d.inverses.append(Inverse("ik", (theta, s), (px, py), tuple(pose[:2, 3])))
    return d


def levelled_arm() -> Derivation:
    """A planar arm whose last joint is coupled to keep the hand level, with both Jacobians."""
    d = Derivation("levelled", "Levelled arm", PAPER, "RRR with a coupling.", task=["x", "y"])
    a, b, c = (d.parameter(n, value=1, unit="m", meaning="a link") for n in "abc")
    t1, t2 = d.joint("theta1"), d.joint("theta2")
    t3 = d.joint("theta3", coupling=-(t1 + t2))
    free = chain(denavit_hartenberg(length, 0, 0, t) for length, t in ((a, t1), (b, t2), (c, t3)))
    pose = d.couple(free)
    d.step("Level", "The coupling.", {"T": pose}, equal=[(pose[:3, :3], sp.eye(3))])
    axes = [sp.zeros(3, 1), a * X, (a + b) * X]
    twists = [revolute_twist(Z, p) for p in axes]
    before = [exponential(t, q) for t, q in zip(twists, (t1, t2, t3), strict=True)]
    columns = [twists[0], adjoint(before[0]) * twists[1], adjoint(chain(before[:2])) * twists[2]]
    spatial = d.couple(
        sp.Matrix.hstack(columns[0] - columns[2], columns[1] - columns[2]).applyfunc(sp.expand)
    )
    velocity = [pose.diff(q) * pose.inv() for q in (t1, t2)]
    by_differentiation = sp.Matrix.hstack(
        *(sp.Matrix([*V[:3, 3], *vee(V[:3, :3])]) for V in velocity)
    )
    d.step("Rates", "Two routes.", {"J": spatial}, equal=[(spatial, by_differentiation)])
    d.function("fk", "Position.", {"q": d.actuated}, {"x": pose[:2, 3]})
    d.function("jacobian_space", "Twists.", {"q": d.actuated}, {"J": spatial})
    return d


def five_bar() -> Derivation:
    """A closed loop: two assembly modes from the loop equations, with passive angles."""
    d = Derivation("fivebar", "Five-bar", PAPER, "RRRRR.", task=["x", "y"])
    L0, L1, L2 = (
        d.parameter(n, value=v, unit="m", meaning="a bar")
        for n, v in (("L0", 2), ("L1", 2), ("L2", 3))
    )
    t1, t2 = d.joint("theta1"), d.joint("theta2")
    d.joint("theta3", passive=True)
    sigma = real("sigma_mode")
    modes = branches((sigma, {+1: "up", -1: "down"}))
    d.assembly_modes = modes.labels
    C = sp.Matrix([L1 * cos(t1), L1 * sin(t1)])
    D = sp.Matrix([L0 + L1 * cos(t2), L1 * sin(t2)])
    p = Program()
    cx, cy = p.let("cx", C[0]), p.let("cy", C[1])
    ux, uy = p.let("ux", (D[0] - cx) / 2), p.let("uy", (D[1] - cy) / 2)
    half = p.let("half", sqrt(ux**2 + uy**2), nonnegative=True)
    rest = p.bound("rest", L2 - half, L2, "the bars meet")
    height = p.let("height", sigma * sqrt(rest) * sqrt(L2 + half) / half)
    x, y = real("x"), real("y")
    solution = [cx + ux - height * uy, cy + uy + height * ux]
    loop = [(x - A[0]) ** 2 + (y - A[1]) ** 2 - L2**2 for A in (C, D)]
    d.function(
        "fk",
        "Both.",
        {"q": (t1, t2)},
        {"p": solution},
        program=p,
        branches=modes,
        result="Positions",
    )
    passive = [sp.atan2(solution[1] - cy, solution[0] - cx)]
    d.function(
        "passive_angles",
        "Both.",
        {"q": (t1, t2)},
        {"theta": passive},
        program=p,
        branches=modes,
    )
    A = sp.Matrix(
        [
            [solution[0] - cx, solution[1] - cy],
            [solution[0] - cx - 2 * ux, solution[1] - cy - 2 * uy],
        ]
    )
    d.function("jacobian_parallel", "A.", {"q": (t1, t2)}, {"A": A}, program=p, branches=modes)
    d.inverses.append(Inverse("fk", (x, y), (sp.S.Zero, sp.S.Zero), tuple(loop)))
    return d


TOYS = {f.__name__: f for f in (polar_arm, levelled_arm, five_bar)}


def printed(d: Derivation, folder: Path) -> tuple[ModuleType, CLibrary]:
    """The generated NumPy module and the C, from a folder outside the package."""
    package = folder / "toys"
    (package / "c").mkdir(parents=True)
    (package / "__init__.py").write_text("")
    own = pages(d, prove(d), ("numpy", "c"))
    common = shared_files([own.share], ("numpy", "c"))
    for path, text in {**own.files, **common}.items():
        (package / ("c" if path.parts[0] == "c" else ".") / path.name).write_text(text)
    name = f"toys_{d.name}"
    for module in (name, f"{name}._runtime"):
        sys.modules.pop(module, None)
    spec = importlib.util.spec_from_file_location(
        name, package / "__init__.py", submodule_search_locations=[str(package)]
    )
    assert spec and spec.loader
    sys.modules[name] = importlib.util.module_from_spec(spec)
    return importlib.import_module(f"{name}.{d.name}"), CLibrary(
        d, package / "c", folder, single=True
    )


@pytest.mark.parametrize("toy", TOYS)
def test_the_whole_way(toy: str, tmp_path: Path) -> None:
    d = TOYS[toy]()
    module, library = printed(d, tmp_path)
    backends: list[Backend] = [module_backend("numpy", module), float_backend(library.function)]
    for backend in backends:
        for finding in crosscheck(d, backend):
            assert not finding.failures, finding


def test_polar_arm_inverts(tmp_path: Path) -> None:
    module, _ = printed(polar_arm(), tmp_path)
    q = np.array([[0.3, 0.5], [2.0, -5.0], [-3.0, 1.0]])
    solutions = module.ik(module.fk(q))
    assert (solutions.status == 0).all()
    np.testing.assert_allclose(
        module.fk(solutions.q), module.fk(q)[:, None].repeat(2, 1), atol=1e-14
    )
    assert (module.ik([0.0, 0.0]).status == 2).all()


def test_five_bar_closes(tmp_path: Path) -> None:
    module, _ = printed(five_bar(), tmp_path)
    q = np.random.default_rng(0).uniform(-3, 3, (200, 2))
    p, status = module.fk(q)
    assert p.shape == (200, 2, 2) and status.shape == (200, 2)
    C = 2 * np.stack([np.cos(q[:, 0]), np.sin(q[:, 0])], axis=-1)
    D = 2 * np.stack([1 + np.cos(q[:, 1]), np.sin(q[:, 1])], axis=-1)
    for centre in (C, D):
        reach = np.linalg.norm(p - centre[:, None], axis=-1)
        np.testing.assert_allclose(reach[status == 0], 3, rtol=1e-12)
    apart = np.linalg.norm(C - D, axis=-1)
    np.testing.assert_array_equal(status == 1, np.repeat((apart > 6)[:, None], 2, 1))
    angle = module.passive_angles(q)[..., 0]
    to_p = p - C[:, None]
    np.testing.assert_allclose(np.cos(angle), to_p[..., 0] / 3, atol=1e-12)


def test_an_unsound_inverse_names_the_branch_and_a_posture() -> None:
    d = polar_arm()
    h = d.parameters[0].symbol
    ik = d["ik"]
    d.functions.remove(ik)
    px, py = ik.symbols
    p = Program(list(ik.body))
    wrong = [ik.outputs[0].entries[0], ik.outputs[0].entries[1] + h]
    d.function(
        "ik", "", {"x": (px, py)}, {"q": wrong}, program=p, branches=ik.branches, result="Solutions"
    )
    with pytest.raises(ProofError, match=r"polar\.ik, branch front.*difference"):
        prove(d)


def test_a_missing_branch_is_counted() -> None:
    d = polar_arm()
    ik = d["ik"]
    d.functions.remove(ik)
    sigma = real("sigma_side")
    d.function(
        "ik",
        "",
        {"x": ik.symbols},
        {"q": list(ik.outputs[0].entries)},
        program=Program(list(ik.body)),
        branches=branches((sigma, {+1: "front"})),
        result="Solutions",
    )
    with pytest.raises(ProofError, match=r"2 solutions \(.*\), but 1 branch is given"):
        prove(d)


def test_a_wrong_step_is_refuted() -> None:
    d = Derivation("wrong", "Wrong", PAPER, "")
    theta = d.joint("theta")
    d.step("Pythagoras", "", {}, equal=[(cos(theta) ** 2 - sin(theta) ** 2, sp.S.One)])
    with pytest.raises(ProofError, match=r"Pythagoras.*theta ="):
        prove(d)


def test_mistakes_in_a_script_are_named() -> None:
    d = polar_arm()
    theta = d.joints[0].symbol
    with pytest.raises(ValueError, match="theta is declared twice"):
        d.joint("theta")
    with pytest.raises(ValueError, match="the symbol stranger is neither"):
        d.function("f", "", {"q": (theta,)}, {"y": real("stranger")})
    with pytest.raises(TypeError, match="float"):
        d.function("f", "", {"q": (theta,)}, {"y": 0.5 * theta})
    with pytest.raises(ValueError, match="fk is defined twice"):
        d.function("fk", "", {"q": (theta,)}, {"y": theta})
    with pytest.raises(TypeError, match="exact rational"):
        d.parameter("k", value=0.1, unit="m", meaning="")
    with pytest.raises(ValueError, match="double is a word of C;"):
        d.parameter("double", value=1, unit="m", meaning="")
    with pytest.raises(ValueError, match=r"polar: k: 'a\\nb' must be one line of printable text"):
        d.parameter("k", value=1, unit="m", meaning="a\nb")
    with pytest.raises(ValueError, match="'my arm' is not a name of a module"):
        Derivation("my arm", "", PAPER, "")


def test_tolerances_are_honoured() -> None:
    """The inverse of the 2R arm just inside and just outside of each tolerance."""

    assert DOUBLE.feasibility < DOUBLE.round_trip
    d = Derivation("arm", "Arm", PAPER, "")
    p = Program()
    r, sigma = real("r", nonnegative=True), real("sigma")
    one = sp.Integer(1)
    Triangle.from_reach(p, (one, one), r, sigma)
    assert [s.scale for s in p.body if hasattr(s, "scale")] == [2, 2, 2]
    assert d.actuated == ()
