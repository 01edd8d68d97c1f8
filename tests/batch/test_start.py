# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a command starts: the modules it loads, the processors it uses, and its streams."""

import json
import os
import subprocess
import sys
import types
from pathlib import Path

import pytest

QUIET = types.SimpleNamespace(check=lambda: None, issues=lambda *_: None, progress=lambda *_: None)
ROOT = Path(__file__).resolve().parent.parent.parent

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
        [sys.executable, "-c", LOADED, str(job), "-o", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    assert ran.stdout.split("\n")[-2] == "0"


@pytest.mark.skipif(
    not hasattr(os, "sched_setaffinity") or len(os.sched_getaffinity(0)) < 2, reason="one processor"
)
def test_the_outputs_are_the_same_on_one_processor(tmp_path):
    job = tmp_path / "job.yaml"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    processor = min(os.sched_getaffinity(0))
    outputs = []
    for how in ({processor}, os.sched_getaffinity(0)):
        out = tmp_path / str(len(how))
        subprocess.run(
            [str(ROOT / "freecad-am"), "plan", str(job), "-o", str(out), "--no-page"],
            check=True,
            capture_output=True,
            preexec_fn=lambda how=how: os.sched_setaffinity(0, how),
        )
        report = json.loads((out / "report.json").read_text())
        del report["timing_s"], report["joints"]["planning_time_s"]
        files = {
            path.name: path.read_bytes()
            for path in sorted(out.rglob("*"))
            if path.is_file() and path.suffix not in (".json", ".FCStd")
        }
        outputs.append((report, files))
    assert outputs[0] == outputs[1]
    preflight = {entry["promise"]: entry for entry in outputs[0][0]["preflight"]}
    assert len(preflight) > 10 and all(entry["how"] for entry in preflight.values())


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_streams_that_a_shell_has_closed_are_missed_by_nobody(tmp_path, closed):
    job, out = tmp_path / "job.yaml", tmp_path / "out"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    command = f'"{ROOT}/freecad-am" plan "{job}" -o "{out}" --no-page {closed}'
    process = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert process.returncode == 0 and (out / "report.json").exists(), process.stderr
    assert "rror" not in process.stderr
