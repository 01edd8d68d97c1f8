# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a process that plans has freed it takes again, and does not ask the system for."""

import platform
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

FAULTS = """
import resource, sys
from freecad_am.batch import allocation
if sys.argv[1:]:
    allocation.keep_freed()
block = b"x" * 100_000_000
del block
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
block = b"x" * 90_000_000
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other libraries ask in ways of their own")
def test_freed_memory_is_taken_again():
    def faults(*asked):
        return int(subprocess.run(
            [sys.executable, "-c", FAULTS, *asked], capture_output=True, text=True, check=True, cwd=ROOT
        ).stdout)

    assert faults("kept") < 1000 < faults()
