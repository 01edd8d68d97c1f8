# SPDX-License-Identifier: LGPL-2.1-or-later
"""A whole job: the hemisphere in 71 layers from its STEP file to program files and FCStd, and a
bracket in planar layers. Peer: a bare FreeCAD process that starts, imports the same file and saves
it. Both run as separate processes in turns and are judged by waiting time; the row states their
processor times too. The bracket is judged by processor time, which other load changes little. Ours
omits report.html. Both find their modules compiled, as after a first run, even where
PYTHONDONTWRITEBYTECODE is set: compiling takes as long as the rest of the job."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import NamedTuple

from pace import Watch
from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
BRACKET, SECONDS, BRACKET_ROUNDS = EXAMPLE.parent / "bracket.yaml", 10.0, choose(3, 1)
ROUNDS = choose(9, 1)
WARMUP_ROUNDS = choose(1, 0)  # rounds that fill caches and are not counted
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
    """Compare the hemisphere with FreeCAD, and a bracket of 150 mm with the allowed time."""
    return [_hemisphere(), _bracket()]


def _bracket() -> Row:
    with tempfile.TemporaryDirectory() as folder:
        plan = [
            str(ROOT / "freecad-am"),
            "plan",
            str(BRACKET),
            "-o",
            str(Path(folder) / "out"),
            "--no-page",
        ]
        with Watch() as watch:
            took = median(
                [measure_command(plan, folder).used for _ in range(BRACKET_ROUNDS + 1)][1:]
            )  # the first round fills the caches
    used = f"{took:.2f} s used, the fixed piece of work in {watch.pace:.2f} ms"
    name = f"a bracket of 150 mm in layers of 2 mm, STEP to program and FCStd, against {SECONDS:g} s ({used})"
    return Row(name, watch.quiet(took), SECONDS, "s", 1.0)


def _hemisphere() -> Row:
    host = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    with tempfile.TemporaryDirectory() as folder:
        job, out = Path(folder) / "hemisphere.yaml", Path(folder) / "out"
        text = (
            (EXAMPLE.parent / "hemisphere.yaml")
            .read_text(encoding="utf-8")
            .replace("hemisphere.step", str(EXAMPLE))
        )
        job.write_text(
            "".join(line for line in text.splitlines(True) if "compare:" not in line),
            encoding="utf-8",
        )
        script = Path(folder) / "bare.py"
        script.write_text(
            BARE.format(step=str(EXAMPLE), saved=str(Path(folder) / "bare.FCStd")), encoding="utf-8"
        )
        plan = [str(ROOT / "freecad-am"), "plan", str(job), "-o", str(out), "--no-page"]
        commands = [plan, *([[host, str(script)]] if host else [])]
        rounds = [
            [measure_command(command, folder) for command in commands]
            for _ in range(WARMUP_ROUNDS + ROUNDS)
        ][WARMUP_ROUNDS:]
        ours, *bare = zip(*rounds)
        used = f"{median(run.used for run in ours):.3f} s of the processor"
        for peer in bare:
            used += f" against {median(run.used for run in peer):.3f}"
        name = f"71 layers, STEP to programs and FCStd; FreeCAD starting, importing and saving that file ({used})"
        waited = median(run.waited for run in bare[0]) if bare else None
        return Row(name, median(run.waited for run in ours), waited, "s", 1.0 / 10.0)


class CommandTimes(NamedTuple):
    """Seconds waited for a command, and seconds of processor time of the command and its
    children."""

    waited: float
    used: float


def measure_command(command: list[str], folder: str) -> CommandTimes:
    """Measure a command; compiled modules are kept in `folder`."""
    removed = ("BENCH_INSIDE", "VIRTUAL_ENV", "PYTHONDONTWRITEBYTECODE")
    environment = {key: value for key, value in os.environ.items() if key not in removed}
    environment["PYTHONPYCACHEPREFIX"] = folder
    usage_before = resource.getrusage(
        resource.RUSAGE_CHILDREN
    )  # os.times counts in hundredths of a second
    started = time.perf_counter()
    process = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        env=environment,
    )
    waited = time.perf_counter() - started
    usage_after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if process.returncode:
        print(process.stderr, file=sys.stderr)
        raise AssertionError(f"{command[0]} ended with {process.returncode}")
    return CommandTimes(
        waited,
        usage_after.ru_utime + usage_after.ru_stime - usage_before.ru_utime - usage_before.ru_stime,
    )
