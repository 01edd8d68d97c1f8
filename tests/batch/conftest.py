# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small part and its job in a folder of their own, and the launcher to run them."""

import atexit
import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
import Part
import pytest

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
SERVER = Path(__file__).with_name("command_server.py")
# seconds of computing, or of not even waiting for the processor, before a command counts as hanging
TIMEOUT_S = 300


def used_by(process: int) -> tuple[float, bool]:
    """Return the processor time in s that a process and its children have used, including ended
    ones, and whether any of them computes or waits for the processor or a disk."""
    ticks, wants = 0, False
    waiting = [str(process)]
    while waiting:
        folder = Path("/proc", waiting.pop())
        with contextlib.suppress(OSError):  # the process has just ended
            stat_fields = (
                (folder / "stat")
                .read_text(encoding="utf-8", errors="replace")
                .rpartition(")")[2]
                .split()
            )
            ticks += sum(map(int, stat_fields[11:15]))
            wants = wants or stat_fields[0] in "RD"
            for thread in (folder / "task").iterdir():
                waiting += (thread / "children").read_text(encoding="ascii").split()
    return ticks / os.sysconf("SC_CLK_TCK"), wants


def wait_for_end(process: subprocess.Popen, patience: float = TIMEOUT_S) -> int:
    """Return the exit status of a process. Raise TimeoutError if it does not end after `patience`
    seconds of computing, or of not even waiting for the processor."""
    idle = 0
    while True:
        with contextlib.suppress(subprocess.TimeoutExpired):
            return process.wait(timeout=1.0)
        used, wants = used_by(process.pid)
        idle += not wants
        if max(idle, used) > patience:
            raise TimeoutError(f"{process.args} did not end in {patience} s")


@dataclass
class Ended:
    """The end of a command, with processor seconds and the MB of its largest process if the server
    ran it."""

    status: int
    out: str
    err: str
    seconds: float = 0.0
    memory: float = 0.0


class Commands:
    """The process of command_server.py. It starts when first needed, and again after a command that
    took too long."""

    def __init__(self) -> None:
        self.process: subprocess.Popen | None = None
        self.copy = 0  # the number of the running copy

    def run(
        self,
        folder: Path,
        words: list[str],
        most_seconds: int = 0,
        most_bytes: int = 0,
        patience: int = TIMEOUT_S,
    ) -> Ended:
        """Run a command; a limit of 0 means no limit. Raise TimeoutError if the command does not
        end after `patience` seconds in which it did not even wait for the processor, or computed
        without a limit. Waiting for a busy machine does not count."""
        with tempfile.TemporaryDirectory() as folder_:
            out, err = Path(folder_) / "out", Path(folder_) / "err"
            self._ask(folder, out, err, words, most_seconds, most_bytes)
            status, seconds, memory = self._answered(
                " ".join(words), patience, computes=not most_seconds
            )
            texts = (stream.read_text(encoding="utf-8") for stream in (out, err))
            return Ended(status, *texts, seconds, memory)

    def start(self, folder: Path, words: list[str]) -> int:
        """Start a command without waiting for it, and return the number of its copy, the leader of
        a group; `waited` returns how it ended."""
        self._ask(folder, Path(os.devnull), Path(os.devnull), words, 0, 0, apart=True)
        return self.copy

    def at_work(self) -> bool:
        return not select.select([self.answer], [], [], 0.0)[0]

    def waited(self) -> tuple[int, float]:
        """Return the exit status (negative for a signal) and the processor seconds of the started
        copy."""
        status, seconds, _ = self._answered("a command", TIMEOUT_S, computes=True)
        return status, seconds

    def _answered(self, what: str, patience: int, computes: bool) -> tuple[int, float, float]:
        """Return status, s and MB of the running copy after its end; with `computes`, it may
        compute for at most `patience`."""
        idle, began = 0, used_by(self.process.pid)[0]
        while not select.select([self.answer], [], [], 1.0)[0]:
            used, wants = used_by(self.process.pid)
            idle += not wants
            if idle > patience or (used - began > patience and computes):
                self._kill()
                raise TimeoutError(f"{what} did not end in {patience} s")
        status, seconds, memory = self.answer.readline().split()
        return int(status), float(seconds), float(memory)

    def _ask(
        self,
        folder: Path,
        out: Path,
        err: Path,
        words: list[str],
        *limits: int,
        apart: bool = False,
    ) -> None:
        if self.process is None:
            self._start()
        environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
        request = json.dumps([str(folder), environment, str(out), str(err), words, *limits, apart])
        self.process.stdin.write(f"{request}\n".encode())
        self.process.stdin.flush()
        self.copy = int(self.answer.readline())

    def _start(self, script: Path = SERVER) -> None:
        ours, theirs = os.pipe()
        self.process = subprocess.Popen(
            [sys.executable, str(script), str(theirs)],
            stdin=subprocess.PIPE,
            pass_fds=[theirs],
            start_new_session=True,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        )
        os.close(theirs)
        self.answer = os.fdopen(ours, "rb", buffering=0)

    def _kill(self) -> None:
        assert self.process is not None
        with contextlib.suppress(ProcessLookupError):  # its own group, if it leads one
            if self.copy and os.getpgid(self.copy) == self.copy:
                os.killpg(self.copy, signal.SIGKILL)
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.process = None

    def end(self) -> None:
        """End the server and wait for it, so that its time counts as time of the tests."""
        if self.process is not None:
            self.process.stdin.close()
            self.process.wait()


COMMANDS = Commands()
atexit.register(COMMANDS.end)


@dataclass
class Workshop:
    """A folder with a part and a job, in which commands run."""

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
        """Run a command as users do, with the launcher."""
        process = subprocess.run(
            [str(self.launcher), *map(str, words)],
            cwd=self.folder,
            env=self.environment(),
            capture_output=True,
            text=True,
            encoding="utf-8",
            timeout=TIMEOUT_S,
            check=False,
            stdin=subprocess.DEVNULL,
        )
        return Ended(process.returncode, process.stdout, process.stderr)

    def run(self, *words: object) -> Ended:
        """Run a command in a copy of a process that has already loaded FreeCAD and the modules,
        which saves a second. All such commands share FreeCAD's user folder, the modules and the
        order of sets; tests about these use `launch`."""
        return COMMANDS.run(self.folder, list(map(str, words)))

    def files(self, folder: str = "out/cup") -> dict[str, bytes]:
        """Return every file below a folder by its relative name, including hidden files."""
        top = self.folder / folder
        return {
            str(path.relative_to(top)): path.read_bytes()
            for path in sorted(top.rglob("*"))
            if path.is_file()
        }


def make_cup(folder: Path) -> None:
    """Write a hemisphere of 40 mm radius as STEP."""
    Part.makeSphere(40.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 0, 90, 360).exportStep(
        str(folder / "cup.step")
    )


@pytest.fixture
def workshop(tmp_path, root):
    """Return a workshop with a hemisphere as STEP and its job."""
    make_cup(tmp_path)
    shop = Workshop(tmp_path, root / "freecad-am")
    shop.write_job()
    return shop
