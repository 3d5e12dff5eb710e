"""Robots whose lengths coincide: the cross-check reported right code as wrong."""

from pathlib import Path

import pytest
from places import ROOT

from closedform.cli.commands import main


@pytest.mark.parametrize("name", ["ur18", "spark"])
def test_a_robot_is_derived_and_cross_checked(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """UR18: the links differ by the length behind them.  SPARK: two lengths nearly cancel."""
    urdf, script = ROOT / "benchmarks" / "arms" / f"{name}.urdf", tmp_path / f"{name}_arm.py"
    assert main(["new", script.stem, "--from", "urdf", str(urdf), "-o", str(tmp_path)]) == 0
    out = ["-o", str(tmp_path / "out"), "--backend", "numpy"]
    assert main(["derive", str(script), *out]) == 0
    assert "8 branches proved" in capsys.readouterr().out
