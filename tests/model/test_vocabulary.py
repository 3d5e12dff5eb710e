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
from sympy import cos, sin
from toys import PAPER, TOYS, five_bar, polar_arm

from closedform.check.clibrary import CLibrary
from closedform.check.crosscheck import crosscheck
from closedform.check.finding import Backend, float_backend, module_backend
from closedform.emit.pages import pages, shared_files
from closedform.lemmas.triangle import Triangle
from closedform.lemmas.zyz import ALIGNED
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, branches, real
from closedform.model.tolerances import DOUBLE, FLOAT, Tolerances
from closedform.proof.prove import prove
from closedform.proof.require import ProofError


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
            assert not finding.failures and not finding.limits, finding


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


@pytest.mark.parametrize("tolerances", [DOUBLE, FLOAT])
def test_both_solutions_of_an_aligned_wrist_are_in_tolerance(
    tolerances: Tolerances,
) -> None:
    """In single precision they were not, and a surgical instrument failed its cross-check."""
    assert 2 * ALIGNED * tolerances.vanishing <= tolerances.round_trip


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
