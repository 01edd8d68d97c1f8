# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kernel calls beside a window: the same numbers from another process, which can be ended, may crash, and may be missing."""

import ctypes
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import FreeCAD  # noqa: F401  before Part
import numpy as np
import Part
import pytest

from freecad_am.brep.kernel import process as kernel_process
from freecad_am.brep.shapes import tessellate
from freecad_am.brep.walls import sheet
from freecad_am.core.issues import InputError

EXAMPLES = Path(__file__).resolve().parent.parent.parent / "resources" / "examples"
PARTS = (
    "thruster/spindle.step",
    "hemisphere.step",
    "walls/spatial-pipe.step",
    pytest.param("walls/branched-tube.step", marks=pytest.mark.any_version),
    "blade",
)


# what the process is asked for here; it imports this file


def pid_of(shape):
    return os.getpid()


def crash(shape):
    os.abort()


def be_killed(shape):
    os.kill(os.getpid(), signal.SIGKILL)


def fail(shape, error):
    raise {"input": InputError("SOME", "where", "what"), "value": ValueError("no good")}[error]


def linger(shape, path):
    Path(path).write_text(str(os.getpid()), encoding="utf-8")
    time.sleep(3600)


def part(name):
    if name == "blade":
        return part("thruster/blades.brep").Solids[5]
    shape = Part.Shape()
    shape.read(str(EXAMPLES / name))
    return shape


def in_thread(function, *arguments):
    """What a call beside the window returns or raises."""
    found = []

    def run():
        try:
            found.append(function(*arguments))
        except BaseException as error:
            found.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(120)
    assert found, "it did not come back"
    if isinstance(found[0], BaseException):
        raise found[0]
    return found[0]


def flat(value):
    return [
        array
        for entry in value
        for array in (flat(entry) if isinstance(entry, (tuple, list)) else [entry])
    ]


class Ended(BaseException):
    """The order to end, which may come between any two steps."""


def is_gone(pid):
    """Whether a process that was started here ends soon."""
    patience = time.monotonic() + 20
    while time.monotonic() < patience:
        try:
            if os.waitpid(pid, os.WNOHANG)[0]:
                return True
        except ChildProcessError:  # it has been waited for
            return True
        time.sleep(0.02)
    return False


@pytest.fixture(autouse=True)
def fresh():
    """No process from before, none left behind."""
    assert not kernel_process.kernel_workers.unable
    yield
    kernel_process.kernel_workers.end()


@pytest.fixture
def slow_part(monkeypatch):
    """A part that is always sent, however quickly it is divided."""
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    return Part.makeBox(1, 2, 3)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.always("walls/branched-tube.step", "thruster/spindle.step", "hemisphere.step")
def test_both_come_to_the_same_numbers(name, monkeypatch):
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    shape = part(name)
    for function, *rest in (
        (tessellate.tessellated, 0.05),
        (sheet.tessellated_for, 2.0),
        (tessellate.triangles_of, 0.1),
        (tessellate._by_face, 0.1),
    ):
        here = flat(function(shape.copy(), *rest))
        elsewhere = flat(in_thread(kernel_process.in_kernel_process, function, shape.copy(), *rest))
        assert len(here) == len(elsewhere)
        for one, other in zip(here, elsewhere, strict=True):
            assert np.array_equal(one, other) and np.asarray(one).dtype == np.asarray(other).dtype
    assert len(kernel_process.kernel_workers.idle) == 1  # it was asked each time


def test_one_process_serves_one_call_after_the_other_and_none_the_main_thread(slow_part):
    first = in_thread(kernel_process.in_kernel_process, pid_of, slow_part)
    assert (
        first != os.getpid()
        and in_thread(kernel_process.in_kernel_process, pid_of, slow_part) == first
    )
    assert kernel_process.in_kernel_process(pid_of, slow_part) == os.getpid()


def test_what_is_divided_quickly_is_not_sent():
    assert in_thread(kernel_process.in_kernel_process, pid_of, Part.makeBox(1, 1, 1)) == os.getpid()
    assert in_thread(kernel_process.in_kernel_process, pid_of, Part.makeSphere(1)) != os.getpid()


def test_a_crash_of_the_kernel_is_an_error_and_the_next_call_has_another_process(slow_part):
    with pytest.raises(RuntimeError, match="crashed"):
        in_thread(kernel_process.in_kernel_process, crash, slow_part)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) != os.getpid()


def test_a_process_that_the_system_ends_had_too_little_memory(slow_part):
    with pytest.raises(MemoryError):
        in_thread(kernel_process.in_kernel_process, be_killed, slow_part)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) != os.getpid()


def test_another_thread_may_take_the_process_that_was_free(slow_part, monkeypatch):
    class Taken(list):
        def __bool__(self):  # there was one when it was asked
            return True

    monkeypatch.setattr(kernel_process.kernel_workers, "idle", Taken())
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) != os.getpid()


def test_a_process_that_has_left_is_replaced(slow_part):
    first = in_thread(kernel_process.in_kernel_process, pid_of, slow_part)
    (process,) = kernel_process.kernel_workers.idle
    process.popen.terminate()
    process.popen.wait(20)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) not in (
        first,
        os.getpid(),
    )


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="a signal of POSIX")
def test_a_process_that_has_left_does_not_take_freecad_along():
    """As in FreeCAD 1.0, whose Python does not ignore the signal of a broken pipe; the one who asks and the one who ends."""
    script = "\n".join(
        (
            "import signal",
            "import FreeCAD, Part",
            "from freecad_am.brep.kernel import process as kernel_process",
            "from tests.brep.test_kernel_process import in_thread, pid_of",
            "kernel_process.MAX_FACES = 0",
            "signal.signal(signal.SIGPIPE, signal.SIG_DFL)",
            "box = Part.makeBox(1, 2, 3)",
            "first = in_thread(kernel_process.in_kernel_process, pid_of, box)",
            "(process,) = kernel_process.kernel_workers.idle",
            "process.popen.terminate()",
            "process.popen.wait(20)",
            "second = in_thread(kernel_process.in_kernel_process, pid_of, box)",
            "(process,) = kernel_process.kernel_workers.idle",
            "process.popen.terminate()",
            "process.popen.wait(20)",
            "process.end()",
            "print('still here', first != second, signal.SIGPIPE in signal.sigpending())",
        )
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stdout.splitlines()[-1:]) == (0, ["still here True False"]), (
        done.stderr
    )


def test_errors_come_back(slow_part):
    with pytest.raises(ValueError, match="no good"):
        in_thread(kernel_process.in_kernel_process, fail, slow_part, "value")
    with pytest.raises(RuntimeError, match="where: what"):  # one that cannot travel keeps its text
        in_thread(kernel_process.in_kernel_process, fail, slow_part, "input")


def test_without_another_python_the_call_is_made_here(slow_part, monkeypatch):
    monkeypatch.setattr(kernel_process, "_pythons", lambda: ["/nowhere/python3"])
    monkeypatch.setattr(kernel_process.kernel_workers, "unable", False)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) == os.getpid()
    assert kernel_process.kernel_workers.unable


def test_a_thread_that_is_ended_takes_its_process_with_it(slow_part, tmp_path):
    told, ended = tmp_path / "pid", []

    def run():
        try:
            kernel_process.in_kernel_process(linger, slow_part, str(told))
        except Ended:
            ended.append(True)

    thread = threading.Thread(target=run)
    thread.start()
    patience = time.monotonic() + 60
    while not (told.exists() and told.read_text(encoding="utf-8")):
        assert time.monotonic() < patience
        time.sleep(0.02)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(
        ctypes.c_ulong(thread.ident), ctypes.py_object(Ended)
    )
    thread.join(20)
    assert ended and not thread.is_alive() and not kernel_process.kernel_workers.idle
    with pytest.raises(ProcessLookupError):
        os.kill(int(told.read_text(encoding="utf-8")), 0)


@pytest.mark.parametrize("when", ["before it is listened to", "once it is made", "as it is asked"])
def test_a_thread_that_is_ended_while_a_process_starts_leaves_none(slow_part, monkeypatch, when):
    pids, popen, made, start = [], subprocess.Popen, kernel_process.Worker, threading.Thread.start

    def begun(*arguments, **options):
        process = popen(*arguments, **options)
        pids.append(process.pid)
        return process

    def listened(thread):
        if thread.name == "Kernel process":
            raise Ended
        start(thread)

    class Made(made):
        def __init__(self, python):
            super().__init__(python)
            if when == "once it is made":
                raise Ended

        def ask(self, question):
            raise Ended

    monkeypatch.setattr(subprocess, "Popen", begun)
    monkeypatch.setattr(kernel_process, "Worker", Made)
    if when == "before it is listened to":
        monkeypatch.setattr(threading.Thread, "start", listened)
    ended = []

    def run():
        try:
            kernel_process.in_kernel_process(pid_of, slow_part)
        except Ended:
            ended.append(True)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(20)
    assert ended and len(pids) == 1 and is_gone(pids[0])
    assert not kernel_process.kernel_workers.idle and not kernel_process.kernel_workers.unable


def test_a_process_that_nobody_holds_any_more_is_ended(slow_part):
    in_thread(kernel_process.in_kernel_process, pid_of, slow_part)
    pid = kernel_process.kernel_workers.idle.pop().popen.pid
    assert is_gone(pid)


def test_a_process_that_is_asked_nothing_leaves_from_the_beginning():
    host = (
        "import sys; from freecad_am.brep.kernel import host as kernel_host; kernel_host.IDLE = 0.2; "
        "kernel_host.serve(sys.stdin.buffer, sys.stdout.buffer)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", host], stdin=subprocess.PIPE, cwd=EXAMPLES.parent.parent
    ) as process:
        assert process.wait(20) == 0
