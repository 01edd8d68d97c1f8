# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work that a copy of this process does meanwhile: where it is done, what comes back, and what is left of the copy."""

import gc
import os
import signal
import sys
import time

import numpy as np
import pytest

from freecad_am.core import copies

HERE = os.getpid()

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="there are copies on Linux alone"
)


@pytest.fixture(autouse=True)
def two_processors(monkeypatch):
    """Also on a machine with one."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})


def is_there(pid):
    """Whether a process is there, be it one that has ended and that nobody waited for."""
    return os.path.exists(f"/proc/{pid}")


def test_the_work_is_done_by_another_process_while_this_one_goes_on(tmp_path):
    gate, passed = str(tmp_path / "gate"), str(tmp_path / "passed")
    os.mkfifo(gate)

    def work():
        if os.getpid() == HERE:
            pytest.fail("nothing would write")
        with open(
            gate, encoding="utf-8"
        ) as stream:  # until this process, which has gone on, writes
            return os.getpid(), stream.read()

    done = copies.meanwhile(work)
    with open(gate, "w", encoding="utf-8") as stream:
        stream.write(passed)
    pid, text = done()
    assert pid != HERE and text == passed


@pytest.mark.parametrize("numbers", [1, 100, 3_000_000])  # one that a pipe cannot hold too
def test_results_come_back_whole(numbers):
    found = copies.meanwhile(
        lambda: {"seed 7": np.random.default_rng(7).normal(size=numbers), "pid": os.getpid()}
    )()
    assert found["pid"] != HERE
    assert np.array_equal(found["seed 7"], np.random.default_rng(7).normal(size=numbers))


def test_an_error_is_raised_where_the_result_is_asked_for():
    def refused():
        raise ValueError(f"in {os.getpid()}")

    made = copies.meanwhile(refused)
    with pytest.raises(ValueError, match=f"in {HERE}$"):
        made()


def test_what_does_not_pickle_is_made_here():
    found = copies.meanwhile(lambda: lambda: os.getpid())()
    assert found() == HERE


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSEGV, signal.SIGTERM])
def test_work_of_a_copy_that_is_killed_is_done_here(number):
    def killed():
        if os.getpid() != HERE:
            os.kill(os.getpid(), number)
        return os.getpid()

    assert copies.meanwhile(killed)() == HERE


def test_nothing_is_left_of_a_copy(tmp_path):
    """Neither of one whose result is known nor of one at work that nobody asks any more."""
    note = tmp_path / "pid"

    def work(seconds):
        note.write_text(str(os.getpid()))
        time.sleep(seconds)
        return seconds

    before = os.listdir("/proc/self/fd")
    for seconds, asked in ((0.0, True), (600.0, False)):
        made = copies.meanwhile(lambda seconds=seconds: work(seconds))
        if asked:
            assert made() == seconds
        else:
            while not note.exists() or not note.read_text():
                time.sleep(0.01)
        pid = int(note.read_text())
        note.unlink()
        del made
        gc.collect()
        assert pid != HERE and not is_there(pid)
    assert os.listdir("/proc/self/fd") == before


def test_a_copy_ends_with_the_process_that_has_made_it(tmp_path):
    note = tmp_path / "pid"

    def sleeps():
        note.write_text(str(os.getpid()))
        time.sleep(600.0)

    pid = os.fork()
    if not pid:
        try:
            made = copies.meanwhile(sleeps)
            while not note.exists() or not note.read_text():
                time.sleep(0.01)
            os._exit(0 if made else 1)
        finally:
            os._exit(2)
    assert os.waitpid(pid, 0)[1] == 0
    last, until = int(note.read_text()), time.monotonic() + 10.0
    while is_there(last) and "\nState:\tZ" not in _status(last) and time.monotonic() < until:
        time.sleep(0.01)
    assert not is_there(last) or "\nState:\tZ" in _status(
        last
    )  # where nobody waits for processes without parents


def _status(pid):
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as stream:
            return stream.read()
    except OSError:
        return ""


@pytest.mark.parametrize("lacking", ["fork", "pipe"])
def test_without_a_process_or_a_pipe_to_be_had_the_work_is_done_here(monkeypatch, lacking):
    def refused():
        raise BlockingIOError(11, "Resource temporarily unavailable")

    before = os.listdir("/proc/self/fd")
    monkeypatch.setattr(os, lacking, refused)
    assert copies.meanwhile(os.getpid)() == HERE
    monkeypatch.undo()
    assert os.listdir("/proc/self/fd") == before


def test_asked_again_it_gives_the_same():
    made = copies.meanwhile(lambda: "as before")
    assert made() == made() == "as before"


def test_signals_are_for_this_process_as_before():
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    copies.meanwhile(os.getpid)()
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == before


def test_with_one_processor_nothing_is_copied(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    monkeypatch.setattr(os, "fork", lambda: pytest.fail("copied"))
    assert copies.meanwhile(os.getpid)() == HERE
