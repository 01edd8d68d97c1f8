# SPDX-License-Identifier: LGPL-2.1-or-later
"""A copy of this process: how it ends, and what it leaves as it was."""

import os
import signal
import sys
import time

import pytest

from freecad_am.core import copies

HERE = os.getpid()

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="there are copies on Linux alone"
)


def status_of(work):
    """The exit status of a copy, negative for the signal that ended it."""
    return os.waitstatus_to_exitcode(os.waitpid(copies.fork(work), 0)[1])


def test_a_copy_does_its_work_in_another_process(tmp_path):
    note = tmp_path / "pid"
    assert status_of(lambda: note.write_text(str(os.getpid()))) == 0
    assert int(note.read_text()) != HERE


def test_a_copy_whose_work_raises_ends_with_a_status():
    def fail():
        raise ValueError("no result")

    assert status_of(fail) == copies.FAILED


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGSEGV, signal.SIGKILL])
def test_a_signal_ends_a_copy(number):
    assert status_of(lambda: os.kill(os.getpid(), number)) == -number


def test_signals_of_this_process_stay_as_they_were():
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    handlers = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    status_of(lambda: None)
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == mask
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == handlers


def test_a_copy_ends_with_the_process_that_has_made_it(tmp_path):
    note = tmp_path / "pid"

    def sleep():
        note.write_text(str(os.getpid()))
        time.sleep(600.0)

    pid = os.fork()
    if not pid:
        try:
            copies.fork(sleep)
            while not note.exists() or not note.read_text():
                time.sleep(0.01)
        finally:
            os._exit(0)
    assert os.waitpid(pid, 0)[1] == 0
    last, until = int(note.read_text()), time.monotonic() + 10.0
    while _is_running(last) and time.monotonic() < until:
        time.sleep(0.01)
    assert not _is_running(last)


def _is_running(pid):
    """Whether a process runs; one that has ended and that nobody waited for does not."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as stream:
            return "\nState:\tZ" not in stream.read()
    except OSError:
        return False
