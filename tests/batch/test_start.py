# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a process that plans asks of the system: what it has freed it takes again, and what it does not need it leaves."""

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


LOADED = """
import os, sys
from freecad_am.batch import cli, host
host.find_freecad()
status = cli._main(["plan", *sys.argv[1:], "--no-page"])
slow = {"matplotlib", "shapely", "scipy.interpolate", "scipy.optimize", "freecad_am.gui", "freecad_am.plots"}
print(status, *sorted(slow & set(sys.modules)), flush=True)
os._exit(0)
"""
JOB = """version: 1
name: small
part: {{file: {part}}}
strategy: {{kind: revolution, layer_height: 5 mm, chord_error: 0.1 mm}}
cell: {{machine: fanuc-arcmate120ic, limits: paper, deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0],
       platform: 5 mm, branch: [front, up, flip]}}
process: {{travel_speed: 6 mm/s}}
program: {{post: fanuc}}
"""


def test_a_part_of_revolution_loads_nothing_slow_that_others_need(tmp_path):
    job = tmp_path / "job.yaml"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    ran = subprocess.run(
        [sys.executable, "-c", LOADED, str(job), "-o", str(tmp_path / "out")], capture_output=True, text=True, check=True,
        cwd=ROOT,
    )
    assert ran.stdout.split("\n")[-2] == "0"
