"""NAME_nearest of the printed C: the answers of the Python robots, also at singular targets."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from places import ROOT, TESTS

import closedform
from closedform.robots import Robot

C = ROOT / "generated" / "c"
NAMES = ("hybrid_five_bar", "irb260", "planar_2r", "puma560", "spherical_wrist", "ur_arm")
SEVEN = ("franka_arm", "srs_arm")
"""Those whose inverse takes a number besides the target."""
WARNINGS = (
    *("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion"),
    *("-Wshadow", "-Werror"),
)
SINGULAR = 2
pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


def compiled(folder: Path, *options: str) -> Path:
    """A library with the function of every robot of this test."""
    arguments = (
        "const real_t *p, const real_t *x, const real_t *given, const real_t *seed, "
        "const real_t *l, const real_t *w, real_t *q, uint8_t *status, uint32_t *outside"
    )
    calls = "".join(
        f'#include "{name}_nearest.h"\n'
        f"int call_{name}({arguments});\n"
        f"int call_{name}({arguments})\n"
        f"{{ {name}_params params; memcpy(&params, p, sizeof params); (void)given;\n"
        f"  return {name}_nearest(&params, x, {'given, ' if name in SEVEN else ''}seed, l, w, q,\n"
        "    status, outside); }\n"
        for name in NAMES + SEVEN
    )
    (folder / "calls.c").write_text(calls, "utf-8")
    library = folder / "nearest.so"
    robots = [str(C / f"{name}.c") for name in NAMES + SEVEN]
    subprocess.run(
        ["cc", *WARNINGS, "-O0", "-fPIC", "-shared", f"-I{C}", *options, "-o", str(library),
         str(folder / "calls.c"), *robots, "-lm"],
        check=True,
    )  # fmt: skip
    return library


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return ctypes.CDLL(str(compiled(tmp_path_factory.mktemp("nearest"))))


def pointer(values: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(values.ctypes.data)


def nearest(
    library: ctypes.CDLL,
    arm: Robot,
    x: np.ndarray,
    seed: np.ndarray,
    w: np.ndarray,
    *,
    given: float | None = None,
    real: type = np.float64,
) -> tuple[int, np.ndarray, int, np.ndarray]:
    params = np.array(arm.parameters, dtype=float)
    limits = np.concatenate([arm.limits.lower, arm.limits.upper])
    q, status = np.empty(len(arm.joints), real), np.zeros(1, np.uint8)
    outside = np.zeros(len(arm.branches), np.uint32)
    beside = np.array([np.nan if given is None else given])
    arrays = [np.ascontiguousarray(a, dtype=real) for a in (params, x, beside, seed, limits, w)]
    pointers = [pointer(a) for a in arrays]
    if given is None:
        pointers[2] = ctypes.c_void_p(None)
    branch = getattr(library, f"call_{arm.name}")(
        *pointers, pointer(q), pointer(status), pointer(outside)
    )
    bits = (outside[:, None] >> np.arange(len(arm.joints)).astype(np.uint32)) & 1
    return branch, q, int(status[0]), bits.astype(bool)


def robot(name: str, parameters: object = None) -> Robot:
    module = getattr(closedform, name)
    n = len(module.JOINTS)
    return Robot(module, parameters, limits=(np.full(n, -4.0), np.full(n, 4.5)))


@pytest.mark.parametrize("beside", ["theirs", "of the seed"])
@pytest.mark.parametrize("name", NAMES + SEVEN)
def test_regular_targets(library: ctypes.CDLL, name: str, beside: str) -> None:
    arm = robot(name)
    seen = set()
    rng = np.random.default_rng(0)
    for _ in range(30):
        q = rng.uniform(-1, 1, len(arm.joints))
        x = arm.fk(q)
        x = x.p[0] if hasattr(x, "p") else x
        seed, weights = rng.uniform(-5, 5, len(q)), rng.uniform(0.5, 2, len(q))
        given = float(arm.given_at(q)) if arm.given and beside == "theirs" else None
        expected = arm.nearest(x, seed, weights=weights, given=given)
        branch, found, status, outside = nearest(library, arm, x, seed, weights, given=given)
        seen.add(status)
        assert branch == expected.branch and status == expected.status
        assert np.array_equal(outside, expected.outside)
        assert np.allclose(found, expected.q, rtol=0, atol=1e-8, equal_nan=True)
    assert 0 in seen


@pytest.mark.parametrize(
    ("name", "parameters", "q", "kept"),
    [
        ("puma560", None, [0.3, -0.5, 0.4, 0.6, 0.0, 0.8], 3),
        ("spherical_wrist", None, [0.6, 0.0, 0.8], 0),
        ("planar_2r", (1.0, 1.0), [0.4, np.pi], 0),
        ("planar_2r", (1.0, 0.0), [0.4, 1.0], 1),
        ("ur_arm", None, [0.3, -1.1, 0.9, 0.4, 0.0, 0.7], None),
        ("franka_arm", None, [0.3, 0.0, 0.4, -1.6, 0.7, 1.9, 0.8], 0),
        ("franka_arm", None, [0.3, 0.5, 0.4, 0.0, 0.7, 1.9, 0.8], None),
        ("srs_arm", None, [0.3, 0.0, 0.4, -1.2, 0.7, 0.9, 0.8], 0),
        ("srs_arm", None, [0.3, 0.7, 0.4, -1.2, 0.7, 0.0, 0.8], 4),
        ("srs_arm", None, [0.3, 0.0, 0.4, -1.2, 0.7, 0.0, 0.8], None),
        ("irb260", None, None, 0),
        ("hybrid_five_bar", None, None, 0),
    ],
)
def test_a_free_joint_keeps_the_value_of_the_seed(
    library: ctypes.CDLL, name: str, parameters: object, q: list[float] | None, kept: int | None
) -> None:
    arm = robot(name, parameters)
    given = float(arm.given_at(q)) if arm.given else None
    if q is not None:
        x = arm.fk(q)
        seeds = np.array(q) + np.random.default_rng(1).normal(0, 0.05, (5, len(q)))
    else:
        x = np.array([0.0, 0.0, 0.9, 0.4] if name == "irb260" else [0.0, 3.5, 0.0])
        seeds = np.random.default_rng(1).normal(0, 0.5, (5, len(arm.joints)))
    for seed in seeds:
        branch, found, status, _ = nearest(library, arm, x, seed, np.ones(len(seed)), given=given)
        assert status == SINGULAR and branch >= 0
        at = arm.fk(found)
        gap = np.nanmin(np.abs(at.p - x).max(-1)) if hasattr(at, "p") else np.abs(at - x).max()
        assert gap < 1e-11
        if given is not None:
            assert abs(arm.given_at(found) - given) < 1e-11
        if kept is not None:
            assert found[kept] == seed[kept]
        expected = arm.nearest(x, seed, given=given)
        assert np.linalg.norm(found - seed) <= expected.distance * 1.001 + 1e-9


def test_a_seed_that_reaches_a_singular_target_is_the_answer(library: ctypes.CDLL) -> None:
    arm = robot("ur_arm")
    for q in np.random.default_rng(2).uniform(-1, 1, (10, 6)):
        q[4] = 0.0
        branch, found, status, _ = nearest(library, arm, arm.fk(q), q, np.ones(6))
        assert status == SINGULAR and np.abs(found - q).max() < 1e-7
        # flip and noflip coincide; the elbow is that of the posture
        names = arm.branches[branch], arm.branches[arm.nearest(arm.fk(q), q).branch]
        assert names[0].endswith("up") == names[1].endswith("up")


@pytest.mark.parametrize(("name", "aligned"), [("puma560", 4), ("ur_arm", 4)])
def test_a_seed_close_by_does_not_hide_a_nearer_posture(
    library: ctypes.CDLL, name: str, aligned: int
) -> None:
    """Rounding of the target hides that the wrist is aligned, and the seed is near all the same."""
    arm, random = robot(name), np.random.default_rng(4)
    hidden = 0
    for q in random.uniform(-1.5, 1.5, (60, 6)):
        q[aligned] = 10 ** random.uniform(-15, -13)
        x, seed = arm.fk(q), q + random.uniform(-2e-3, 2e-3, 6)
        _, found, status, _ = nearest(library, arm, x, seed, np.ones(6))
        hidden += status == 0
        assert np.linalg.norm(found - seed) < arm.nearest(x, seed).distance + 1e-6
    assert hidden > 5


@pytest.mark.parametrize("given", [None, 0.0, 0.8])
def test_a_wrist_above_the_shoulder_has_no_arm_angle_but_a_posture(
    library: ctypes.CDLL, given: float | None
) -> None:
    arm = robot("srs_arm")
    q = np.array([0.5, np.arctan2(np.sin(1.4), 1 + np.cos(1.4)), 0.0, 1.4, 0.0, 0.9, 0.0])
    seed = q + 0.1 * np.eye(7)[0]  # the elbow can go round: theta1 is free
    branch, found, status, _ = nearest(library, arm, arm.fk(q), seed, np.ones(7), given=given)
    assert status == SINGULAR and branch >= 0
    assert found[0] == seed[0] and np.abs(arm.fk(found) - arm.fk(q)).max() < 1e-11
    assert np.abs(found - q).max() < 0.2


def test_single_precision_takes_what_is_given(tmp_path: Path) -> None:
    library = ctypes.CDLL(str(compiled(tmp_path, "-DCLOSEDFORM_FLOAT")))
    above = np.arctan2(np.sin(1.4), 1 + np.cos(1.4))  # the wrist is above the shoulder
    for name, q, status, kept in [
        ("srs_arm", [0.3, 0.7, 0.4, -1.2, 0.7, 0.9, 0.8], 0, None),
        ("srs_arm", [0.3, 0.0, 0.4, -1.2, 0.7, 0.9, 0.8], SINGULAR, 0),
        ("srs_arm", [0.5, above, 0.0, 1.4, 0.0, 0.9, 0.0], SINGULAR, 0),
        ("franka_arm", [0.3, 0.0, 0.4, -1.6, 0.7, 1.9, 0.8], SINGULAR, 0),
    ]:
        arm = robot(name)
        given = float(arm.given_at(q))
        seed = np.array(q) + 0.05 * np.eye(7)[0]
        found = nearest(library, arm, arm.fk(q), seed, np.ones(7), given=given, real=np.float32)
        assert found[2] == status and np.abs(arm.fk(found[1]) - arm.fk(q)).max() < 1e-5
        assert kept is None or found[1][kept] == np.float32(seed[kept])


def test_a_given_joint_out_of_its_limits_is_told(library: ctypes.CDLL) -> None:
    arm = robot("franka_arm")
    q = np.array([0.3, 0.4, 0.4, -1.6, 0.7, 1.9, 0.8])
    narrow = Robot(closedform.franka_arm, limits=([-4.0] * 7, [4.0] * 6 + [0.7]))
    assert nearest(library, arm, arm.fk(q), q, np.ones(7))[0] >= 0
    branch, _, status, outside = nearest(library, narrow, arm.fk(q), q, np.ones(7))
    assert (branch, status) == (-1, 1)
    assert outside[:, 6].any() and not outside[:, :6].any()


def test_what_is_not_a_target(library: ctypes.CDLL) -> None:
    arm = robot("puma560")
    good, nan = arm.fk(np.full(6, 0.4)), np.full(6, np.nan)
    far = good + 9.0 * np.eye(4, k=3)
    assert nearest(library, arm, far, np.zeros(6), np.ones(6))[::2] == (-1, 1)
    assert nearest(library, arm, good * np.nan, np.zeros(6), np.ones(6))[::2] == (-1, 3)
    branch, q, status, _ = nearest(library, arm, good, nan, np.ones(6))
    assert (branch, status) == (-1, 3) and np.isnan(q).all()


def test_it_compiles_without_warnings_in_single_precision(tmp_path: Path) -> None:
    compiled(tmp_path, "-DCLOSEDFORM_FLOAT", "-fsyntax-only")


def test_the_control_loop_runs(tmp_path: Path) -> None:
    program = tmp_path / "loop"
    source = TESTS / "c" / "control_loop.c"
    assert len(source.read_text("utf-8").splitlines()) <= 45
    subprocess.run(
        ["cc", *WARNINGS, "-O0", f"-I{C}", "-o", str(program), str(source), str(C / "ur_arm.c"),
         "-lm"],
        check=True,
    )  # fmt: skip
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "500 cycles on branch 0, largest step 0.0008 rad"


@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no C++ compiler")
def test_the_header_for_cpp_adds_no_call(tmp_path: Path) -> None:
    """Every header compiles, the loop runs, and an optimised wrapper only calls the C."""
    flags = ["-std=c++20", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", f"-I{C}"]
    every = tmp_path / "every.cpp"
    every.write_text("".join(f'#include "{p.name}"\n' for p in sorted(C.glob("*.hpp"))), "utf-8")
    subprocess.run(["c++", *flags, "-Wno-unused-function", "-fsyntax-only", str(every)], check=True)
    subprocess.run(
        ["cc", "-O0", "-c", f"-I{C}", "-o", str(tmp_path / "ur_arm.o"), str(C / "ur_arm.c")],
        check=True,
    )
    program, source = tmp_path / "loop", TESTS / "c" / "control_loop.cpp"
    subprocess.run(
        ["c++", *flags, "-O1", "-o", str(program), str(source), str(tmp_path / "ur_arm.o"), "-lm"],
        check=True,
    )
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "48 joint values, branch 0 is OK"
    both = tmp_path / "both.cpp"
    both.write_text(
        '#include "scara.hpp"\n'
        'extern "C" void by_c(const real_t *q, real_t *x)\n'
        "{ scara_fk(&closedform::scara::defaults, q, x); }\n"
        'extern "C" void by_cpp(const real_t *q, std::array<real_t, 4> *x)\n'
        "{ *x = closedform::scara::fk(std::span<const real_t, 4>(q, 4)); }\n",
        "utf-8",
    )
    told = subprocess.run(
        ["c++", *flags, "-Wno-unused-function", "-O2", "-S", "-o", "-", str(both)],
        check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    body = told[told.index("by_cpp:") :]
    calls = [line for line in body.splitlines() if "call" in line or "jmp" in line or "\tb" in line]
    assert sum("scara_fk" in line for line in calls) == 1
    assert not any("span" in line or "array" in line for line in calls)
