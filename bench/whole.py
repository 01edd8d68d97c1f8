# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole of a job: the hemisphere in 71 layers from its STEP file to program files and FCStd, and a bracket in
plane layers.

Peer: a bare FreeCAD process that starts, imports the same file and saves it. Both as processes of their own, in turns, and
by the time of the processor that they and what they start take, on which what else runs has little bearing.
Ours leaves report.html out. Both find their modules compiled, as they are after a first run, also where the environment asks
for none to be kept (PYTHONDONTWRITEBYTECODE): compiling them takes as long as all the rest.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from pace import Watch
from rows import Row

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
BRACKET, SECONDS, FEWER = EXAMPLE.parent / "bracket.yaml", 10.0, 3
ROUNDS = 9
BARE = """import os, sys
import FreeCAD, Import
document = FreeCAD.newDocument("Bare")
Import.insert({step!r}, document.Name)
document.recompute()
document.saveAs({saved!r})
sys.stdout.flush()
os._exit(0)
"""


def run() -> list[Row]:
    """The hemisphere against FreeCAD alone, and a bracket of 150 mm against the time asked for."""
    return [_hemisphere(), _bracket()]


def _bracket() -> Row:
    with tempfile.TemporaryDirectory() as folder:
        plan = [str(ROOT / "freecad-am"), "plan", str(BRACKET), "-o", str(Path(folder) / "out"), "--no-page"]
        with Watch() as watch:
            took = median([_took(plan, folder) for _ in range(FEWER + 1)][1:])  # the first round fills the caches
    used = f"{took:.2f} s used, the fixed piece of work in {watch.pace:.2f} ms"
    name = f"a bracket of 150 mm in layers of 2 mm, STEP to program and FCStd, against {SECONDS:g} s ({used})"
    return Row(name, watch.quiet(took), SECONDS, "s", 1.0)


def _hemisphere() -> Row:
    host = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    with tempfile.TemporaryDirectory() as folder:
        job, out = Path(folder) / "hemisphere.yaml", Path(folder) / "out"
        text = (EXAMPLE.parent / "hemisphere.yaml").read_text(encoding="utf-8").replace("hemisphere.step", str(EXAMPLE))
        job.write_text("".join(line for line in text.splitlines(True) if "compare:" not in line), encoding="utf-8")
        script = Path(folder) / "bare.py"
        script.write_text(BARE.format(step=str(EXAMPLE), saved=str(Path(folder) / "bare.FCStd")), encoding="utf-8")
        plan = [str(ROOT / "freecad-am"), "plan", str(job), "-o", str(out), "--no-page"]
        ours, bare = [], []
        for number in range(ROUNDS + 1):
            took = _took(plan, folder)
            other = _took([host, str(script)], folder) if host else None
            if number:  # the first round fills the caches
                ours.append(took)
                bare.append(other)
        name = "processor time of 71 layers, STEP to programs and FCStd; FreeCAD starting, importing and saving that file"
        return Row(name, median(ours), median(bare) if host else None, "s", 1.0 / 6.0)


def _took(command: list[str], folder: str) -> float:
    """Seconds of the processor that a command takes; compiled modules are kept in `folder`."""
    left = ("BENCH_INSIDE", "VIRTUAL_ENV", "PYTHONDONTWRITEBYTECODE")
    environment = {key: value for key, value in os.environ.items() if key not in left}
    environment["PYTHONPYCACHEPREFIX"] = folder
    before = resource.getrusage(resource.RUSAGE_CHILDREN)  # os.times counts in hundredths of a second
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        raise AssertionError(f"{command[0]} ended with {done.returncode}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
