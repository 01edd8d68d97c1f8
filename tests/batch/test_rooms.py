# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of architecture follows a job file through the house: the calls are followed, and go the same way."""

import os
import subprocess
import sys

from tests import rooms

JOB = """version: 1
name: way
part: {{file: {step}}}
strategy: {{kind: revolution, layer_height: 15 mm, chord_error: 0.5 mm}}
cell: {{machine: fanuc-arcmate120ic, limits: paper, deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0],
       platform: 5 mm}}
process: {{travel_speed: 1.5 mm/s}}
program: {{post: fanuc}}
"""
# in every process of the command, also those that it forks: what is called first is written down at once
FOLLOW = """
import os, sys
sys.path.insert(0, {root!r})
from tests.rooms import Trail
class Written(Trail):
    def first(self, call):
        with open({log!r}, "a") as log:
            print(*call, file=log)
Written().__enter__()
"""


def test_a_job_file_goes_the_way_that_the_page_tells(tmp_path, root):
    step = root / "resources" / "examples" / "hemisphere.step"
    (tmp_path / "way.yaml").write_text(JOB.format(step=step), encoding="utf-8")
    log = tmp_path / "calls"
    (tmp_path / "sitecustomize.py").write_text(FOLLOW.format(root=str(root), log=str(log)), encoding="utf-8")
    command = [sys.executable, str(root / "freecad_am" / "batch" / "boot.py"), "plan", "way.yaml", "-o", "out"]
    told = subprocess.run(
        command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, timeout=120,
    )
    assert told.returncode == 0, told.stderr
    calls = [tuple(line.split()) for line in log.read_text(encoding="utf-8").splitlines()]
    assert len(rooms.told("A job file")) > 25
    assert rooms.lost(dict.fromkeys(calls), "A job file") == []


def test_ways_that_are_not_gone_are_seen():
    told = rooms.told("A job file")
    assert rooms.lost(dict.fromkeys(told), "A job file") == []
    assert rooms.lost(dict.fromkeys([told[1], told[0], *told[2:]]), "A job file") == [told[1]]
    assert rooms.lost(dict.fromkeys(told[:-1]), "A job file") == [told[-1]]
