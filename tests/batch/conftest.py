# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small part and job in a folder of their own, and the launcher to run them."""

import importlib
import os
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
import Part
import pytest

from freecad_am.batch import cli

JOB = """\
version: 1
name: cup
part: {file: cup.step}
strategy:
  layer_height: 4 mm
  chord_error: 0.1 mm
cell:
  limits: paper
  platform_diameter: 100 mm
process:
  travel_speed: 6 mm/s
program:
  post: fanuc
"""


PATIENCE = 120  # s for a command
NEEDED = ("Part", "Mesh", *(f"freecad_am.batch.{name}" for name in ("cli", "run", "rows", "export", "measured", "machines")))


def _as_command(streams: list[int], folder: Path, words: list[str]) -> None:
    """Be the process of a command, as freecad_am/batch/boot.py is."""
    status = 1
    try:
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
        sys.stdout, sys.stderr = (os.fdopen(number, "w", encoding="utf-8", closefd=False) for number in (1, 2))
        os.chdir(folder)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        status = cli.main(words)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


@dataclass
class Ended:
    """How a command ended."""

    status: int
    out: str
    err: str


@dataclass
class Workshop:
    """A folder with a part and a job, and the commands run in it."""

    folder: Path
    launcher: Path

    text = JOB

    @property
    def job(self) -> Path:
        return self.folder / "cup.yaml"

    def write_job(self, text: str = JOB) -> Path:
        self.job.write_text(text, encoding="utf-8")
        return self.job

    def change(self, old: str, new: str) -> Path:
        assert old in JOB
        return self.write_job(JOB.replace(old, new, 1))

    def environment(self) -> dict:
        return {**os.environ, "FREECAD_USER_HOME": str(self.folder), "PYTHONDONTWRITEBYTECODE": "1"}

    def launch(self, *words: object) -> Ended:
        """A command as its users give it, by the launcher."""
        done = subprocess.run(
            [str(self.launcher), *map(str, words)], cwd=self.folder, env=self.environment(), capture_output=True,
            text=True, encoding="utf-8", timeout=PATIENCE, check=False, stdin=subprocess.DEVNULL,
        )
        return Ended(done.returncode, done.stdout, done.stderr)

    def run(self, *words: object) -> Ended:
        """The same in a copy of this process, which has FreeCAD and what commands need already: half a second less. User
        folder of FreeCAD, modules and the order of sets are those of the tests: what is about these asks the launcher."""
        for name in NEEDED:
            importlib.import_module(name)
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, open(os.devnull, "rb") as nothing:
            process = os.fork()
            if not process:
                _as_command([nothing.fileno(), out.fileno(), err.fileno()], self.folder, list(map(str, words)))
            end, ended = time.monotonic() + PATIENCE, 0
            while not ended:
                ended, status = os.waitpid(process, os.WNOHANG)
                if not ended and time.monotonic() > end:
                    os.kill(process, signal.SIGKILL)
                    os.waitpid(process, 0)
                    pytest.fail(f"{' '.join(map(str, words))} took more than {PATIENCE} s")
                time.sleep(0.0 if ended else 0.005)
            out.seek(0)
            err.seek(0)
            return Ended(os.waitstatus_to_exitcode(status), out.read().decode("utf-8"), err.read().decode("utf-8"))

    def files(self, folder: str = "out/cup") -> dict[str, bytes]:
        """Every file below a folder, hidden ones too, by its name relative to it."""
        top = self.folder / folder
        return {str(path.relative_to(top)): path.read_bytes() for path in sorted(top.rglob("*")) if path.is_file()}


@pytest.fixture
def workshop(tmp_path, root):
    """A hemisphere of 40 mm radius as STEP, and its job."""
    shape = Part.makeSphere(40.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 0, 90, 360)
    shape.exportStep(str(tmp_path / "cup.step"))
    shop = Workshop(tmp_path, root / "freecad-am")
    shop.write_job()
    return shop
