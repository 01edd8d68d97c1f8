# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole of a job: the hemisphere in 71 layers from its STEP file to program files and FCStd, and a bracket in
plane layers.

Peer: a bare FreeCAD process that starts, imports the same file and saves it. Both as processes of their own, in turns, and
by how long one waits for them. The time of the processor that both take is named too. The bracket is judged by its time of
the processor, which other work changes little.
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
import time
from pathlib import Path
from statistics import median
from typing import NamedTuple

from pace import Watch
from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
BRACKET, SECONDS, FEWER = EXAMPLE.parent / "bracket.yaml", 10.0, choose(3, 1)
ROUNDS = choose(9, 1)
WARMING = choose(1, 0)  # rounds that fill caches and do not count
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
                [_took(plan, folder).used for _ in range(FEWER + 1)][1:]
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
            [_took(command, folder) for command in commands] for _ in range(WARMING + ROUNDS)
        ][WARMING:]
        ours, *bare = zip(*rounds)
        used = f"{median(one.used for one in ours):.3f} s of the processor"
        for peer in bare:
            used += f" against {median(one.used for one in peer):.3f}"
        name = f"71 layers, STEP to programs and FCStd; FreeCAD starting, importing and saving that file ({used})"
        waited = median(one.waited for one in bare[0]) if bare else None
        return Row(name, median(one.waited for one in ours), waited, "s", 1.0 / 10.0)


class Took(NamedTuple):
    """Seconds that a command was waited for, and of the processor that it and what it started used."""

    waited: float
    used: float


def _took(command: list[str], folder: str) -> Took:
    """What a command takes; compiled modules are kept in `folder`."""
    left = ("BENCH_INSIDE", "VIRTUAL_ENV", "PYTHONDONTWRITEBYTECODE")
    environment = {key: value for key, value in os.environ.items() if key not in left}
    environment["PYTHONPYCACHEPREFIX"] = folder
    before = resource.getrusage(
        resource.RUSAGE_CHILDREN
    )  # os.times counts in hundredths of a second
    started = time.perf_counter()
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        env=environment,
    )
    waited = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        raise AssertionError(f"{command[0]} ended with {done.returncode}")
    return Took(waited, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
