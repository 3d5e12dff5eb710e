"""The cross-check compiles C with -O0, which gives the values of the recommended -O3."""

import importlib
from pathlib import Path

import numpy as np
import pytest
from places import ROOT

from closedform.check import clibrary
from closedform.check.failures import UnavailableError


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("robot", ["scara", "stanford_arm"])
def test_optimisation_changes_no_value(
    robot: str, single: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    try:
        clibrary.compiler()
    except UnavailableError as error:
        pytest.skip(str(error))
    d = importlib.import_module(f"closedform.derivations.{robot}").d
    params = importlib.import_module(f"closedform.generated.numpy.{robot}").Parameters()
    q = np.random.default_rng(1).uniform(-3, 3, (20_000, len(d.actuated)))
    found = []
    for level in ("-O0", "-O3"):
        flags = [level if flag.startswith("-O") else flag for flag in clibrary.FLAGS]
        monkeypatch.setattr(clibrary, "FLAGS", flags)
        (tmp_path / level).mkdir()
        library = clibrary.CLibrary(d, ROOT / "generated/c", tmp_path / level, single=single)
        x = library.function("fk")(q, params)
        joints, status = library.function("ik")(x, params)
        found.append([x, joints, status, library.function("jacobian_space")(q, params)])
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
