"""What the NumPy modules share: the evaluation in blocks."""

import platform
import subprocess
import sys

import pytest

FAULTS = """
import resource
import numpy as np
from closedform.generated.numpy import _runtime, puma560
q = np.random.default_rng(0).uniform(-3, 3, (25 * _runtime.BLOCK, 6))
T = puma560.fk(q)
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
puma560.fk(q, out=T)
print((resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before) // 25)
"""


def new_pages() -> int:
    """How many pages a block takes from the system, in a process that has freed nothing before."""
    command = [sys.executable, "-c", FAULTS]
    return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library")
def test_blocks_reuse_memory() -> None:
    assert new_pages() < 20
