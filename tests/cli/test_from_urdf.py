"""From a URDF file to figures, by the commands that ``closedform new`` ends with."""

import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from closedform.cli.commands import main

pytestmark = pytest.mark.usefixtures("compiled_quickly")

URDF = """<robot name="crane">
  <link name="mast"/><link name="boom"/><link name="jib"/><link name="hook"/>
  <joint name="slew" type="continuous">
    <parent link="mast"/><child link="boom"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="fold" type="continuous">
    <parent link="boom"/><child link="jib"/><origin xyz="0.4 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="end" type="fixed">
    <parent link="jib"/><child link="hook"/><origin xyz="0.3 0 0"/>
  </joint>
</robot>
"""


def test_the_three_commands_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("crane.urdf").write_text(URDF, "utf-8")
    assert main(["new", "crane", "--from", "urdf", "crane.urdf"]) == 0
    summary, *rest = capsys.readouterr().out.splitlines()[-3:]
    assert "branches" in summary
    told = [summary.partition("next: ")[2], *(line.removeprefix("then: ") for line in rest)]
    *commands, last = map(shlex.split, told)
    for program, *arguments in commands:
        assert program == "closedform"
        assert main(arguments) == 0
    assert sorted(p.stem for p in Path("out", "latex").glob("crane-*.pdf")) == [
        f"crane-{what}" for what in ("branches", "conditioning", "mechanism", "workspace")
    ]
    assert last[0] == "python"
    shown = subprocess.run(
        [sys.executable, *last[1:]], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert "status : ndarray of uint8" in shown.stdout
