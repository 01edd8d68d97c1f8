# SPDX-License-Identifier: LGPL-2.1-or-later
"""A crash of a command is reported and leaves no outputs, and the command handles signals like a
single process."""

import functools
import itertools
import os
import re
import signal
import subprocess
import sys
import time

import pytest

from freecad_am.batch import child
from freecad_am.batch import output_folder as outputs
from tests.robust.test_kills import OLD, files, publish

SCRIPT = """
import os, signal, sys, time
sys.path.insert(0, {root!r})
from freecad_am.batch import child
def work():
    {work}
status = child.run_in_child(work, "part.step", lambda line: print(line, file=sys.stderr))
print("status", status)
"""


def run_supervised(root, work, *actions):
    """Return the reported status and stderr of supervised work, while actions (s, function of its
    process) run."""
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT.format(root=str(root), work=work)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    for seconds, act in actions:
        time.sleep(seconds)
        act(process)
    out, err = process.communicate(timeout=60)
    return out, err


@pytest.mark.parametrize(("work", "code", "status"), [
    ("os.kill(os.getpid(), signal.SIGSEGV)", "CRASHED", 2), ("os.abort()", "CRASHED", 2), ("os._exit(1)", "CRASHED", 2),
    ("os._exit(0)", "CRASHED", 2), ("os.kill(os.getpid(), signal.SIGKILL)", "ENDED", 1),
])  # fmt: skip
def test_a_crash_is_told(root, work, code, status):
    out, err = run_supervised(root, work)
    assert out == f"status {status}\n"
    assert re.fullmatch(rf"error\[{code}\] part\.step: [^\n]+\n", err), err


def test_a_status_is_passed_on(root):
    for status in (0, 1, 2, 3, 130):
        assert run_supervised(root, f"return {status}") == (f"status {status}\n", "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("group", [False, True])
def test_signals_are_passed_on(root, number, group):
    kill = (
        (lambda process: os.killpg(process.pid, number))
        if group
        else (lambda process: os.kill(process.pid, number))
    )
    out, err = run_supervised(root, "time.sleep(60)", (2.0, kill))
    assert out == "status 130\n" and "Traceback" not in err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_copy_that_lets_no_signal_through_is_ended(root, number):
    """During one long call of the geometry kernel, no signal handler of the copy runs."""
    signal_times = []

    def kill(process):
        signal_times.append(time.monotonic())
        os.kill(process.pid, number)

    work = "signal.pthread_sigmask(signal.SIG_BLOCK, {2, 15}); time.sleep(60)"
    out, err = run_supervised(root, work, (2.0, kill))
    assert out == "status 130\n" and err == "interrupted: nothing was written\n"
    assert time.monotonic() - signal_times[0] < 10.0  # of the minute that the call takes


def test_a_copy_that_tidies_up_is_waited_for(root, tmp_path):
    """After a copy has noticed the signal, it may take longer than the time allowed for
    noticing."""
    mark_file = tmp_path / "left"
    work = (
        "\n    try: time.sleep(60)"
        f"\n    finally: time.sleep(2.0); open({str(mark_file)!r}, 'w').write('tidied')"
    )
    out, _ = run_supervised(root, work, (2.0, lambda process: os.kill(process.pid, signal.SIGINT)))
    assert out == "status 130\n" and mark_file.read_text() == "tidied"


def test_a_copy_ends_with_the_process_that_waits_for_it(root, tmp_path):
    pid_file = tmp_path / "pid"
    work = f"open({str(pid_file)!r}, 'w').write(str(os.getpid())); time.sleep(60)"
    run_supervised(root, work.replace("; ", "\n    "), (2.0, lambda process: process.kill()))
    until = time.monotonic() + 10.0
    while os.path.exists(f"/proc/{pid_file.read_text()}/exe") and time.monotonic() < until:
        time.sleep(0.01)
    assert not os.path.exists(f"/proc/{pid_file.read_text()}/exe")


@pytest.mark.parametrize("before", [OLD, {}], ids=["over an earlier set", "first"])
def test_a_crash_leaves_the_outputs_as_they_were(tmp_path, before):
    out = tmp_path / "new" / "out"
    if before:
        publish(out, before)

    def work():
        with outputs.Outputs(str(out)) as folder_:
            folder_.write("report.json", b"half")
            signal.signal(signal.SIGSEGV, signal.SIG_DFL)  # otherwise pytest prints a long report
            os.kill(os.getpid(), signal.SIGSEGV)
        return 0

    lines = []
    assert child.run_in_child(work, "cup.yaml", lines.append) == 2
    assert len(lines) == 1 and lines[0].startswith("error[CRASHED] cup.yaml: ")
    assert files(tmp_path) == {f"new/out/{name}": data for name, data in before.items()}
    assert (tmp_path / "new").exists() == bool(before) and not list(
        out.glob(".*") if before else []
    )


def test_interrupted_at_any_line_nothing_is_left(tmp_path):
    """Ctrl-C in every line of the code that creates and removes output folders leaves nothing."""
    traced_files = {module.__file__ for module in (outputs, outputs.staging)}
    out = tmp_path / "new" / "out"

    def work(step):
        lines = itertools.count(1)

        def trace(frame, event, _):
            if frame.f_code.co_filename not in traced_files:
                return None
            if event == "line" and next(lines) == step:
                os.kill(os.getpid(), signal.SIGINT)
            return trace

        sys.settrace(trace)
        with outputs.Outputs(str(out)):
            pass
        sys.settrace(None)
        return 0

    for step in range(1, 400):
        status = child.run_in_child(functools.partial(work, step), "cup.yaml", lambda line: None)
        assert not (tmp_path / "new").exists(), step
        if status == 0:
            break
        assert status == child.INTERRUPTED
    assert status == 0 and step > 50
