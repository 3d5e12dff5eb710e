"""Limits of joints in a URDF file: exported in every language, and the default of `Robot`."""

import shutil
import subprocess
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from closedform.check.runners.python import module
from closedform.emit.pages import pages, shared_files
from closedform.model.derivation import Derivation, Paper
from closedform.pipeline import run as pipeline
from closedform.pipeline import scripts
from closedform.proof.prove import Proof
from closedform.robots import Robot
from closedform.scaffold.new import new

LIMITS = ((-1.25, -np.inf), (2.0, np.inf))
LANGUAGES = ("numpy", "c", "js", "array")
URDF = """<robot name="arm">
<joint name="q1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="-1.25" upper="2"/></joint>
<joint name="q2" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/>
  <axis xyz="0 0 1"/></joint>
<joint name="tip" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0.5 0 0"/></joint>
</robot>"""
C_PROGRAM = """
#include <math.h>
#include <stdio.h>
#include "arm_nearest.h"
int main(void)
{
    const real_t limits[2 * ARM_JOINTS] = ARM_LIMITS;
    for (int k = 0; k < 2 * ARM_JOINTS; k++) printf("%g\\n", (double)limits[k]);
    return 0;
}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("limits")
    (folder / "arm.urdf").write_text(URDF, "utf-8")
    (folder / "arm.py").write_text(new("arm", "urdf", folder / "arm.urdf").text, "utf-8")
    d = scripts.load(scripts.find([str(folder / "arm.py")])[0])
    done = pages(d, Proof(d.name, "own", (), 0, ()), LANGUAGES)
    pipeline.write(folder, {**done.files, **shared_files([done.share], LANGUAGES)})
    return folder


@pytest.fixture(scope="module")
def arm(folder: Path) -> ModuleType:
    return module(folder / "numpy", "arm")


def test_python(folder: Path, arm: ModuleType) -> None:
    assert arm.LIMITS == LIMITS == module(folder / "array", "arm").LIMITS
    assert "LIMITS" in arm.__all__


def test_a_robot_has_the_limits_of_its_module(arm: ModuleType) -> None:
    np.testing.assert_array_equal(Robot(arm).limits, LIMITS)
    assert np.isinf(Robot(arm, limits=None).limits).all()
    turned = Robot(arm, signs=[-1, 1])  # these joints are not those of the module
    assert np.isinf(turned.limits).all()
    target = arm.fk([1.9, 0.8])
    found = Robot(arm).nearest(target, [2.5, -0.5])
    np.testing.assert_allclose(found.q, [1.9, 0.8], atol=1e-12)  # the other one has q1 beyond 2
    assert Robot(arm, limits=None).nearest(target, [2.5, -0.5]).q[0] > 2


@pytest.mark.parametrize("options", [(), ("-DCLOSEDFORM_FLOAT",)])
def test_c(folder: Path, tmp_path: Path, options: tuple[str, ...]) -> None:
    compiler = shutil.which("cc") or pytest.skip("there is no C compiler")
    (tmp_path / "main.c").write_text(C_PROGRAM, "utf-8")
    build = [compiler, "-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", *options]
    sources = [str(tmp_path / "main.c"), str(folder / "c" / "arm.c"), f"-I{folder / 'c'}", "-lm"]
    subprocess.run([*build, *sources, "-o", str(tmp_path / "main")], check=True)
    printed = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    assert tuple(map(float, printed.stdout.split())) == LIMITS[0] + LIMITS[1]


def test_javascript(folder: Path) -> None:
    node = shutil.which("node") or pytest.skip("Node is not installed")
    code = f"import {{ LIMITS }} from '{folder / 'js' / 'arm.js'}'; console.log(...LIMITS.flat())"
    run = [node, "--input-type=module", "-e", code]
    printed = subprocess.run(run, capture_output=True, text=True, check=True)
    assert printed.stdout.split() == ["-1.25", "-Infinity", "2", "Infinity"]


def test_a_mechanism_without_limits_exports_none() -> None:
    import closedform.generated.numpy.puma560 as puma560

    assert not hasattr(puma560, "LIMITS") and np.isinf(Robot(puma560).limits).all()


@pytest.mark.parametrize("limits", [(1, 0), (1,), ("low", "high"), (float("nan"), 1)])
def test_wrong_limits_are_refused(limits: tuple) -> None:
    d = Derivation("arm", "Arm", Paper("arm", "Arm", ("the maker",)), "One link.")
    with pytest.raises(ValueError, match="q1"):
        d.joint("q1", limits=limits)


def test_wrong_limits_of_a_file_are_left_out_and_said(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(URDF.replace('"2"', '"-2"'), "utf-8")
    script = new("arm", "urdf", tmp_path / "arm.urdf")
    assert "limits=" not in script.text
    assert any("its limits are left out: -1.25 is larger than -2" in n for n in script.notes)
