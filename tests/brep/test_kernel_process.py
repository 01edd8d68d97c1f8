# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kernel calls in another process give the same numbers as in the window; the process may be ended,
crash or be missing."""

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


# ---- functions that the other process runs; it imports this file


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
    """Return or raise what a call in a thread other than the main one returns or raises."""
    outcome = []

    def run():
        try:
            outcome.append(function(*arguments))
        except BaseException as error:
            outcome.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(120)
    assert outcome, "it did not come back"
    if isinstance(outcome[0], BaseException):
        raise outcome[0]
    return outcome[0]


def flat(value):
    return [
        array
        for entry in value
        for array in (flat(entry) if isinstance(entry, (tuple, list)) else [entry])
    ]


class Ended(BaseException):
    """The request to end a thread, which may arrive between any two steps."""


def is_gone(pid):
    """Return whether a process that was started here ends soon."""
    patience = time.monotonic() + 20
    while time.monotonic() < patience:
        try:
            if os.waitpid(pid, os.WNOHANG)[0]:
                return True
        except ChildProcessError:  # its parent has already waited for it
            return True
        time.sleep(0.02)
    return False


@pytest.fixture(autouse=True)
def fresh():
    """Start without earlier processes and leave none."""
    assert not kernel_process.kernel_workers.unable
    yield
    kernel_process.kernel_workers.end()


@pytest.fixture
def slow_part(monkeypatch):
    """Return a part that is always sent, however fast its tessellation is."""
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    return Part.makeBox(1, 2, 3)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.always("walls/branched-tube.step", "thruster/spindle.step", "hemisphere.step")
def test_both_come_to_the_same_numbers(name, monkeypatch):
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    shape = part(name)
    for function, *arguments in (
        (tessellate.tessellated, 0.05),
        (sheet.tessellated_for, 2.0),
        (tessellate.triangles_of, 0.1),
        (tessellate._by_face, 0.1),
    ):
        local = flat(function(shape.copy(), *arguments))
        elsewhere = flat(
            in_thread(kernel_process.in_kernel_process, function, shape.copy(), *arguments)
        )
        assert len(local) == len(elsewhere)
        for local_value, remote_value in zip(local, elsewhere, strict=True):
            assert (
                np.array_equal(local_value, remote_value)
                and np.asarray(local_value).dtype == np.asarray(remote_value).dtype
            )
    assert len(kernel_process.kernel_workers.idle) == 1  # the process was used each time


def test_one_process_serves_one_call_after_the_other_and_none_the_main_thread(slow_part):
    first_pid = in_thread(kernel_process.in_kernel_process, pid_of, slow_part)
    assert (
        first_pid != os.getpid()
        and in_thread(kernel_process.in_kernel_process, pid_of, slow_part) == first_pid
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
        def __bool__(self):  # the process existed at the time of the check
            return True

    monkeypatch.setattr(kernel_process.kernel_workers, "idle", Taken())
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) != os.getpid()


def test_a_process_that_has_left_is_replaced(slow_part):
    first_pid = in_thread(kernel_process.in_kernel_process, pid_of, slow_part)
    (process,) = kernel_process.kernel_workers.idle
    process.popen.terminate()
    process.popen.wait(20)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) not in (
        first_pid,
        os.getpid(),
    )


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="a signal of POSIX")
def test_a_process_that_has_left_does_not_take_freecad_along():
    """FreeCAD 1.0's Python does not ignore the signal of a broken pipe; both the caller and the
    ender may receive it."""
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
    process = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (process.returncode, process.stdout.splitlines()[-1:]) == (
        0,
        ["still here True False"],
    ), process.stderr


def test_errors_come_back(slow_part):
    with pytest.raises(ValueError, match="no good"):
        in_thread(kernel_process.in_kernel_process, fail, slow_part, "value")
    # an exception that cannot be pickled keeps its text
    with pytest.raises(RuntimeError, match="where: what"):
        in_thread(kernel_process.in_kernel_process, fail, slow_part, "input")


def test_without_another_python_the_call_is_made_here(slow_part, monkeypatch):
    monkeypatch.setattr(kernel_process, "_pythons", lambda: ["/nowhere/python3"])
    monkeypatch.setattr(kernel_process.kernel_workers, "unable", False)
    assert in_thread(kernel_process.in_kernel_process, pid_of, slow_part) == os.getpid()
    assert kernel_process.kernel_workers.unable


def test_a_thread_that_is_ended_takes_its_process_with_it(slow_part, tmp_path):
    pid_file, ended_threads = tmp_path / "pid", []

    def run():
        try:
            kernel_process.in_kernel_process(linger, slow_part, str(pid_file))
        except Ended:
            ended_threads.append(True)

    thread = threading.Thread(target=run)
    thread.start()
    patience = time.monotonic() + 60
    while not (pid_file.exists() and pid_file.read_text(encoding="utf-8")):
        assert time.monotonic() < patience
        time.sleep(0.02)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(
        ctypes.c_ulong(thread.ident), ctypes.py_object(Ended)
    )
    thread.join(20)
    assert ended_threads and not thread.is_alive() and not kernel_process.kernel_workers.idle
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid_file.read_text(encoding="utf-8")), 0)


@pytest.mark.parametrize("when", ["before it is listened to", "once it is made", "as it is asked"])
def test_a_thread_that_is_ended_while_a_process_starts_leaves_none(slow_part, monkeypatch, when):
    pids, popen, worker_class, start = (
        [],
        subprocess.Popen,
        kernel_process.Worker,
        threading.Thread.start,
    )

    def start_process(*arguments, **options):
        process = popen(*arguments, **options)
        pids.append(process.pid)
        return process

    def listened(thread):
        if thread.name == "Kernel process":
            raise Ended
        start(thread)

    class Made(worker_class):
        def __init__(self, python):
            super().__init__(python)
            if when == "once it is made":
                raise Ended

        def ask(self, question):
            raise Ended

    monkeypatch.setattr(subprocess, "Popen", start_process)
    monkeypatch.setattr(kernel_process, "Worker", Made)
    if when == "before it is listened to":
        monkeypatch.setattr(threading.Thread, "start", listened)
    ended_threads = []

    def run():
        try:
            kernel_process.in_kernel_process(pid_of, slow_part)
        except Ended:
            ended_threads.append(True)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(20)
    assert ended_threads and len(pids) == 1 and is_gone(pids[0])
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
