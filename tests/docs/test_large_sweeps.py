"""The page on large sweeps: its programs survive the loss of a worker and of the whole run."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from closedform.generated.c import hybrid_five_bar as bar
from places import ROOT

psutil = pytest.importorskip("psutil", reason="distributed, which brings psutil, is missing")

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="kills processes as POSIX does"),
    pytest.mark.skipif(  # each worker of the tests would import them to collect this file
        not all(map(find_spec, ("distributed", "xarray", "zarr"))),
        reason="the extra closedform[sweep] is not installed",
    ),
]

PAGE = (ROOT / "docs" / "large-sweeps.md").read_text("utf-8")
SIZES = '{"base": 100, "crank": 25, "radius": 80, "height": 50}'
SMALLER = '{{"base": {}, "crank": 10, "radius": 40, "height": 26}}'
SCRIPTS = ["sweep.py", "sweep_xarray.py"]
Done = dict[Path, tuple[int, int]]


def write_scripts(folder: Path, blocks: int) -> None:
    """The programs of the page, with a smaller grid."""
    found = dict(re.findall(r"^```python ([\w.]+)\n(.*?)^```", PAGE, re.M | re.S))
    assert sorted(found) == SCRIPTS
    assert found["sweep.py"].count(SIZES) == 1
    for name, text in found.items():
        (folder / name).write_text(text.replace(SIZES, SMALLER.format(blocks)), "utf-8")


def start(folder: Path, script: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, script],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def end(run: subprocess.Popen[str]) -> str:
    out, err = run.communicate(timeout=300)
    assert run.returncode == 0, err
    return out


def done(folder: Path) -> Done:
    """The marks of the blocks that are done, each with what changes if it is written again."""
    return {
        path: (path.stat().st_mtime_ns, path.stat().st_ino)
        for path in (folder / "five-bar.zarr" / "done" / "c").glob("*")
        if path.suffix != ".partial"
    }


def workers(run: subprocess.Popen[str]) -> list[psutil.Process]:
    def works(process: psutil.Process) -> bool:
        try:
            return any("spawn_main" in word for word in process.cmdline())
        except psutil.NoSuchProcess:
            return False

    return [p for p in psutil.Process(run.pid).children(recursive=True) if works(p)]


def interrupted(
    folder: Path, script: str, kill: Callable[[subprocess.Popen[str]], bool]
) -> tuple[subprocess.Popen[str], int]:
    """A run from which something was killed in the middle, and the number of its blocks."""
    for blocks in (80, 320, 1280):  # on a busy machine a short run may end unobserved
        store = folder / "five-bar.zarr"
        if store.exists():
            store.rename(folder / f"over-before-{blocks}.zarr")
        write_scripts(folder, blocks)
        run = start(folder, script)
        while run.poll() is None and len(done(folder)) < 3:
            time.sleep(0.002)
        if run.poll() is None and kill(run) and 3 <= len(done(folder)) < blocks:
            return run, blocks
        run.communicate()
    pytest.fail("every run was over before it could be disturbed")


def kill_a_worker(run: subprocess.Popen[str]) -> bool:
    for victim in workers(run):
        with contextlib.suppress(psutil.NoSuchProcess):
            victim.kill()
            return True
    return False


def kill_all(run: subprocess.Popen[str]) -> bool:
    everyone = [psutil.Process(run.pid), *psutil.Process(run.pid).children(recursive=True)]
    os.killpg(run.pid, signal.SIGKILL)
    run.communicate()
    _, alive = psutil.wait_procs(everyone, timeout=60)
    return not alive


def check(folder: Path) -> None:
    """What is stored is what the module gives in one call, bit for bit."""
    import zarr

    stored = zarr.open_group(folder / "five-bar.zarr", mode="r")
    radius, height = np.meshgrid(stored["radius"][:], stored["height"][:], indexing="ij")
    p = np.stack([radius, height, np.zeros_like(radius)], axis=-1)
    base, crank = np.ix_(stored["base"][:], stored["crank"][:])
    lengths = bar.Parameters(*(n[:, :, None, None] for n in (base, crank, 2 - crank)))
    legs = bar.Parameters(*(n[..., None] for n in lengths))
    kappa = bar.condition_number(bar.ik(p, lengths).q, legs)
    conditioning = np.nan_to_num(1 / kappa).max(axis=(-2, -1))
    assert np.array_equal(stored["conditioning"][:], conditioning)
    assert np.array_equal(stored["inside"][:], bar.workspace_contains(p, lengths))
    assert stored["done"][:].all()
    assert 0.1 < stored["inside"][:].mean() < 0.9 and conditioning.max() > 0.9


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_worker_is_killed(tmp_path: Path, script: str) -> None:
    run, _ = interrupted(tmp_path, script, kill_a_worker)
    end(run)
    check(tmp_path)


@pytest.mark.parametrize("script", SCRIPTS)
def test_the_run_is_killed(tmp_path: Path, script: str) -> None:
    _, blocks = interrupted(tmp_path, script, kill_all)
    kept = done(tmp_path)
    said = end(start(tmp_path, script))
    if script == "sweep.py":
        assert said == f"computed {blocks - len(kept)} of {blocks} blocks\n"
        assert kept.items() <= done(tmp_path).items()
    check(tmp_path)


def test_one_program_ends_what_the_other_began_and_the_map_is_read(tmp_path: Path) -> None:
    interrupted(tmp_path, "sweep.py", kill_all)
    end(start(tmp_path, "sweep_xarray.py"))
    check(tmp_path)
    assert end(start(tmp_path, "sweep.py")).startswith("computed 0 of")
    [code] = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    told = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    assert told.returncode == 0, told.stderr
    found = re.fullmatch(
        r"best: pivots (\d\.\d\d), crank (\d\.\d\d)\n.* (\d+)% is well-conditioned\n", told.stdout
    )
    assert found and 0.3 < float(found[1]) < 0.9 and 0.8 < float(found[2]) < 1.2
