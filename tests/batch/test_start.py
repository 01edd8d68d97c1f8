# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a process that plans asks of the system: what it has freed it takes again, and what it does not need it leaves."""

import json
import os
import pickle
import platform
import subprocess
import sys
import types
from pathlib import Path

import FreeCAD
import pytest

from freecad_am.batch import run
from freecad_am.batch.job.job import read_job
from freecad_am.objects.checks import preflight

QUIET = types.SimpleNamespace(check=lambda: None, issues=lambda *_: None, progress=lambda *_: None)
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


@pytest.mark.skipif(
    platform.libc_ver()[0] != "glibc", reason="other libraries ask in ways of their own"
)
def test_freed_memory_is_taken_again():
    def faults(*asked):
        return int(
            subprocess.run(
                [sys.executable, "-c", FAULTS, *asked],
                capture_output=True,
                text=True,
                check=True,
                cwd=ROOT,
            ).stdout
        )

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
        [sys.executable, "-c", LOADED, str(job), "-o", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    assert ran.stdout.split("\n")[-2] == "0"


MEANWHILE = """
import os, sys, threading
from freecad_am.batch import host, paths
host.find_freecad()
paths.load_meanwhile()
import freecad_am.batch.job.job, freecad_am.batch.run
early = "FreeCAD" in sys.modules  # then it would have been waited for
for thread in threading.enumerate():
    if thread is not threading.main_thread():
        thread.join()
with open("/proc/self/maps", encoding="utf-8") as stream:
    loaded = "MeshPart" in stream.read()
import FreeCAD, Part, MeshPart
found = MeshPart.meshFromShape(Shape=Part.makeBox(1, 1, 1), LinearDeflection=0.1).CountFacets
print(early, loaded, found, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="elsewhere FreeCAD is loaded when it is imported"
)
def test_freecad_is_loaded_while_our_modules_are_imported_which_do_not_wait_for_it():
    if "freecad" in Path(sys.executable).name.lower():
        pytest.skip("FreeCAD's own interpreter has it loaded")
    ran = subprocess.run(
        [sys.executable, "-c", MEANWHILE], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert ran.stdout.split() == ["False", "True", "12"]


@pytest.mark.skipif(
    not hasattr(os, "sched_setaffinity") or len(os.sched_getaffinity(0)) < 2, reason="one processor"
)
def test_the_outputs_are_the_same_on_one_processor(tmp_path):
    """On two a copy of the process looks for what takes long of the preflight."""
    job = tmp_path / "job.yaml"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    one = min(os.sched_getaffinity(0))
    outputs = []
    for how in ({one}, os.sched_getaffinity(0)):
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


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere no process is copied")
def test_what_takes_long_of_the_preflight_comes_from_a_copy(doc, tmp_path, monkeypatch):
    """It gives what the same survey gives here, array for array."""
    if FreeCAD.GuiUp:
        pytest.skip("beside a window nothing is copied")
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})
    job = tmp_path / "job.yaml"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    stages = run.plan(read_job(str(job)), doc, QUIET)
    here = preflight.survey_of(stages.toolpath, stages.joint_path, stages.job.program)()
    monkeypatch.setattr(stages.survey, "_work", lambda: pytest.fail("it is done here"))
    there = stages.survey()
    assert pickle.dumps(there) == pickle.dumps(
        pickle.loads(pickle.dumps(here))
    )  # what is one there is one here
    assert (
        there.rapids.places > 100
        and len(there.distances) > 3
        and there.arm.link.size
        and there.looked.count > 100
    )


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_streams_that_a_shell_has_closed_are_missed_by_nobody(tmp_path, closed):
    job, out = tmp_path / "job.yaml", tmp_path / "out"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    command = f'"{ROOT}/freecad-am" plan "{job}" -o "{out}" --no-page {closed}'
    ended = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert ended.returncode == 0 and (out / "report.json").exists(), ended.stderr
    assert "rror" not in ended.stderr
