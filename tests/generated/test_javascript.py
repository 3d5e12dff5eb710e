"""The JavaScript modules: the contract, NumPy's statuses, both forms of a call, and the package."""

from places import TESTS
import importlib
import json
import os
import shutil
import subprocess
from collections import Counter
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from given import beside

from closedform.check.runners.node import Node
from closedform.pipeline.folders import generated
from closedform.robots.mechanism import given_of

MODULES = generated() / "js"
ROBOTS = sorted(path.stem for path in (generated() / "numpy").glob("[a-z]*.py"))
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
EXPECTED = {
    "agile_wrist": {OK, SINGULAR, INVALID},
    "rpr_planar": {OK, SINGULAR},
    "spherical_wrist": {OK, SINGULAR, INVALID},
}
"""The statuses that must be among those compared, where they are not these three."""
CONSTANTS = ("ASSEMBLY_MODES", "JOINTS", "TASK", "BRANCHES", "SINGULARITIES")

pytestmark = pytest.mark.skipif(
    shutil.which("node") is None, reason="Node is not installed: the JavaScript is not run"
)


def node(*arguments: str | Path, folder: Path | None = None) -> str:
    command = ["node", *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def numpy_module(robot: str) -> ModuleType:
    return importlib.import_module(f"closedform.generated.numpy.{robot}")


def functions(module: ModuleType) -> dict[str, Any]:
    """The kernel of each function of a NumPy module."""
    names = [n for n in module.__all__ if n.islower()]
    return {name: getattr(module, f"_{name.upper()}") for name in names}


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_contract_and_both_forms(robot: str) -> None:
    """The names and constants are those of NumPy; a call and a batch agree to the last bit."""
    module = numpy_module(robot)
    kernels = functions(module)
    sizes = {n: [a.size if a.shape else -1 for a in k.inputs] for n, k in kernels.items()}
    script = TESTS / "javascript" / "forms.mjs"
    found = json.loads(node(script, MODULES / f"{robot}.js", json.dumps(sizes)))
    batches = {f"{name}_batch" for name in kernels}
    own = {*CONSTANTS, "DEFAULTS", "SKELETON", "Status"}
    given = given_of(module)
    own |= {"GIVEN"} if given else set()
    assert set(found["names"]) == {*kernels, *batches, *own}
    for name in CONSTANTS:
        assert tuple(found["constants"][name]) == getattr(module, name)
    assert found["constants"].get("GIVEN") == given
    assert found["constants"]["DEFAULTS"] == module.Parameters()._asdict()
    skeleton = module.SKELETON._replace(
        joints={name: joint._asdict() for name, joint in module.SKELETON.joints.items()}
    )
    assert found["constants"]["SKELETON"] == json.loads(json.dumps(skeleton._asdict()))
    assert found["constants"]["Status"] == {s.name: s.value for s in module.Status}
    assert not found["differences"]


def postures(rng: np.random.Generator, n: int, rows: int = 400) -> np.ndarray:
    """Random ones, and those at and near right angles, where most of what is singular is."""
    corners = rng.choice([-np.pi, -np.pi / 2, 0.0, np.pi / 2, np.pi], (rows, n))
    near = corners + rng.choice([0.0, 1e-16, 1e-12, 1e-7], (rows, n))
    mixed = np.where(rng.random((rows, n)) < 0.5, near, rng.uniform(-np.pi, np.pi, (rows, n)))
    return np.concatenate([rng.uniform(-np.pi, np.pi, (rows, n)), near, mixed])


def possible(robot: str, q: np.ndarray, factor: float, longest: float) -> np.ndarray:
    """Postures of a robot from any numbers; those of slides are lengths."""
    if robot == "rpr_planar":
        return factor * (1 + np.abs(q))
    if robot in ("orthoglide", "linear_delta"):
        return factor * longest * (0.5 + np.tanh(q) / 4)
    return q


def planes(x: np.ndarray, size: int) -> np.ndarray:
    return np.ascontiguousarray(x.reshape(-1, size).T)


@pytest.mark.parametrize("robot", ROBOTS)
def test_statuses_are_those_of_numpy(robot: str) -> None:
    """At random and at singular postures, at targets off these, and for lengths of any size."""
    module, rng = numpy_module(robot), np.random.default_rng(5)
    statuses: Counter[int] = Counter()
    with Node(MODULES / f"{robot}.js") as js:

        def compare(name: str, parameters: Any, *inputs: np.ndarray) -> Any:
            sizes = [given.size for given in functions(module)[name].inputs]
            expected = getattr(module, name)(*inputs, parameters)
            taken = [planes(x, size) for x, size in zip(inputs, sizes, strict=True)]
            found = js.batch(name, taken, parameters._asdict())
            results = expected if isinstance(expected, tuple) else (expected,)
            for mine, theirs in zip(found, results, strict=True):
                shaped = mine.T.reshape(theirs.shape)
                if theirs.dtype == np.uint8:
                    np.testing.assert_array_equal(shaped, theirs, err_msg=f"{name} {parameters}")
                    statuses.update(theirs.ravel().tolist())
            np.testing.assert_array_equal(
                np.isnan(found[0].T.reshape(results[0].shape)), np.isnan(results[0])
            )
            return results[0]

        example = module.Parameters()
        for factor, lengths in product((1.0, 1e-170, 1e140), (example, [1.0] * len(example))):
            parameters = module.Parameters(*(factor * length for length in lengths))
            q = possible(robot, postures(rng, len(module.JOINTS)), factor, max(lengths))
            if "fk" in functions(module):
                targets = compare("fk", parameters, q)
            else:  # its task has as many coordinates as there are joints
                scales = [factor * max(lengths) if n in "xyz" else 1.0 for n in module.TASK]
                targets = np.tanh(q) / 2 * scales
            if "ik" not in functions(module):
                continue
            target, *_ = functions(module)["ik"].inputs
            more = beside(module, q, parameters)
            if len(module.TASK) != target.size:  # a pose, whatever coordinates fk gives
                targets = (module.fk if robot == "spherical_wrist" else module.pose)(q, parameters)
            targets = targets.reshape(-1, *target.shape)
            finite = np.isfinite(targets.reshape(len(targets), -1)).all(axis=1)
            targets, more = targets[finite], tuple(value[finite] for value in more)
            compare("ik", parameters, targets, *more)
            for step in (1e-15, 1e-9, 1e-2, 3.0):
                signs = rng.choice([-1.0, 1.0], targets.shape)
                compare("ik", parameters, targets * (1 + step * signs), *more)
            corners = rng.choice([0.0, 1e-17, np.pi / 2, np.pi], targets.shape)
            mixed = np.where(rng.random(targets.shape) < 0.4, corners, targets)
            compare("ik", parameters, mixed, *more)
    assert statuses.keys() >= EXPECTED.get(robot, {OK, UNREACHABLE, SINGULAR})


def error_of(robot: str, call: str) -> str:
    code = f"""
import * as m from {json.dumps((MODULES / f"{robot}.js").as_uri())};
try {{
    console.log(JSON.stringify({call}));
}} catch (error) {{
    console.log(`${{error.name}}: ${{error.message}}`);
}}
"""
    return node("--input-type=module", "--eval", code).strip()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("m.fk([1, 2, 3])", "RangeError: planar_2r.fk: q has length 3, expected 2 numbers"),
        ("m.fk()", "TypeError: planar_2r.fk: q is undefined, expected an array of 2 numbers"),
        ("m.fk([1, '2'])", "TypeError: planar_2r.fk: q[1] is a string, expected a number"),
        ("m.fk([1, , ])", "TypeError: planar_2r.fk: q[1] is undefined, expected a number"),
        (
            "m.ik_pose([[1, 0], [0, 1]])",
            "RangeError: planar_2r.ik_pose: T has length 2, expected 16 numbers "
            "(4 x 4 in row order)",
        ),
        (
            "m.fk([1, 2], { l3: 1 })",
            "TypeError: planar_2r.fk: there is no parameter l3; known: l1, l2",
        ),
        ("m.fk([1, 2], null)", "TypeError: planar_2r.fk: parameters is null, expected an object"),
        (
            "m.fk([1, 2], { l1: '1' })",
            "TypeError: planar_2r.fk: parameters.l1 is a string, expected a number",
        ),
        (
            "m.fk_batch(3, new Float64Array(5))",
            "RangeError: planar_2r.fk: q has length 5, expected 6 (2 planes of 3)",
        ),
        (
            "m.fk_batch(1, [1, 2])",
            "TypeError: planar_2r.fk: q is an array, expected a Float64Array",
        ),
        (
            "m.ik_batch(1, new Float64Array(2), undefined, new Float64Array(2))",
            "TypeError: planar_2r.ik: status is an array, expected a Uint8Array",
        ),
        (
            "(() => { const a = new Float64Array(2); return m.fk_batch(1, a, a); })()",
            "RangeError: planar_2r.fk: x shares memory with another array",
        ),
        (
            "m.fk_batch(-1, new Float64Array(0))",
            "RangeError: planar_2r.fk: n is -1, expected a number of postures",
        ),
        ("m.ik([NaN, 1]).status", "[3,3]"),
        ("m.ik([1, 1], { l1: -1 }).status", "[3,3]"),
        ("m.ik([1e9, 1])", '{"q":[[null,null],[null,null]],"status":[1,1]}'),
        ("m.fk(Float32Array.of(0, 0), { l2: undefined })", "[18,0]"),
        ("m.fk_batch(0, new Float64Array(0)).length", "0"),
    ],
)  # fmt: skip
def test_what_a_user_does_wrong_is_told(call: str, message: str) -> None:
    assert error_of("planar_2r", call) == message


def test_a_call_within_a_call_disturbs_neither() -> None:
    """An array may compute its elements, with the very function that reads them."""
    call = """(() => {
        const q = [0, -1.1];
        const get = () => { m.ik([3, 4], { l1: 5 }); m.fk([2, 2]); return 0.3; };
        Object.defineProperty(q, 0, { get });
        return [m.fk(q), m.fk([0.3, -1.1])].map(String);
    })()"""
    first, second = json.loads(error_of("planar_2r", call))
    assert first == second


@pytest.mark.skipif(shutil.which("npm") is None, reason="npm is not installed: nothing is packed")
def test_a_consumer_uses_the_package(tmp_path: Path) -> None:
    environment = {"npm_config_cache": str(tmp_path / "cache"), "npm_config_offline": "true"}
    packed = subprocess.run(
        ["npm", "pack", "--silent", "--pack-destination", tmp_path, MODULES],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()[-1]
    package = tmp_path / "node_modules" / "closedform"
    package.mkdir(parents=True)
    shutil.unpack_archive(tmp_path / packed, tmp_path / "unpacked")
    shutil.copytree(tmp_path / "unpacked" / "package", package, dirs_exist_ok=True)
    shutil.copy(TESTS / "consumer" / "main.mjs", tmp_path)
    lines = node("main.mjs", folder=tmp_path).splitlines()
    assert lines == [
        "links 10 and 8, hand 15.127019 -2.783647",
        "elbow_down status 0 angles -0.663965 1.100000",
        "elbow_up status 0 angles 0.300000 -1.100000",
        "statuses 1 0 1 1 0 1",
        "the Puma has 8 branches",
    ]
    listed = json.loads((package / "package.json").read_text())
    assert {f"./{robot}" for robot in ROBOTS} < listed["exports"].keys()
    assert not {"dependencies", "devDependencies"} & listed.keys()
