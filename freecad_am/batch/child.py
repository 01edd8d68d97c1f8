# SPDX-License-Identifier: LGPL-2.1-or-later
"""Child processes for commands that read shapes and for batch rows, by multiprocessing.

FreeCAD may crash in a child; the parent reports the crash. A child reports the folders of its
unfinished outputs, which the parent removes after a crash. A child ends with its parent.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable
from typing import Any

from ..core.issues import AmError, InputError

SIGNALS = (signal.SIGINT, signal.SIGTERM)
INTERRUPTED = 130
GRACE_S = 0.7  # s; time for a child to handle a signal, which the geometry kernel may delay
POLL_S = 0.1
DONE, STOPPING, OUTPUTS = "done", "stopping", "outputs"  # message kinds of a child

# a forked child has all modules of its parent and starts within a millisecond
_CONTEXT: Any = multiprocessing.get_context("fork" if sys.platform.startswith("linux") else "spawn")


class Child(_CONTEXT.Process):  # type: ignore[misc]
    """A process that runs `work(*arguments)`.

    receiver: connection for messages of the child. result: return value of `work`, once `is_done`.
    is_stopping: whether the child has acknowledged the request to stop.
    """

    def __init__(self, work: Callable[..., Any], *arguments: Any) -> None:
        super().__init__()
        self.receiver, self._sender = _CONTEXT.Pipe(duplex=False)
        self._work, self._arguments = work, arguments
        self._outputs: list[tuple[str, list[str]]] = []
        self.result: Any = None
        self.is_done = self.is_stopping = False
        self.start()
        self._sender.close()

    def run(self) -> None:
        """In the child: run the work and report its result."""
        parent = multiprocessing.parent_process()
        assert parent is not None and parent.pid is not None
        _end_with_parent(parent.pid)
        self.report(DONE, self._work(*self._arguments))
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)  # skip FreeCAD's clean-up

    def report(self, kind: str, value: Any = None) -> None:
        """In the child: send a message."""
        with contextlib.suppress(OSError):
            self._sender.send((kind, value))

    def poll(self, timeout: float) -> bool:
        """Wait at most `timeout` s for a message; return whether the child has ended."""
        if not self.receiver.poll(timeout):
            return False
        try:
            kind, value = self.receiver.recv()
        except (EOFError, OSError):
            self.join()
            self._clean_up()
            return True
        if kind == DONE:
            self.result, self.is_done = value, True
        elif kind == STOPPING:
            self.is_stopping = True
        else:
            self._outputs.append(value)
        return False

    def interrupt(self, number: int = signal.SIGINT) -> None:
        """Send a signal without waiting."""
        if self.is_alive() and self.pid is not None:
            os.kill(self.pid, number)

    def stop(self) -> None:
        """Stop the child; `result` is set if the child had finished."""
        self.interrupt()
        deadline = time.monotonic() + GRACE_S
        while not self.poll(POLL_S):
            if time.monotonic() > deadline:
                self.kill()

    def _clean_up(self) -> None:
        """Finish or remove unfinished outputs: a crash or a signal may come before the child does."""
        from . import staging

        for folder, made_folders in self._outputs:
            with contextlib.suppress(OSError):
                staging.clear(folder)
                for path in reversed(made_folders):
                    os.rmdir(path)


def run_in_child(work: Callable[[], int], where: str, say: Callable[[str], None]) -> int:
    """Run `work` in a child and return its status.

    `say` receives a message about a crash, which names `where`. Signals are passed on to the child;
    a child that does not react is killed.
    """
    if not sys.platform.startswith("linux"):
        return work()
    received: list[int] = []
    old_handlers = {
        number: signal.signal(number, lambda number, _: received.append(number))
        for number in SIGNALS
    }
    sys.stdout.flush()
    sys.stderr.flush()
    try:
        child = Child(_run_interruptible, work, received)
        passed_on, deadline = 0, float("inf")
        while not child.poll(POLL_S):
            if len(received) > passed_on:
                passed_on, deadline = len(received), time.monotonic() + GRACE_S
                child.interrupt(received[-1])
            if time.monotonic() > deadline and not (child.is_stopping or child.is_done):
                child.kill()
    finally:
        for number, handler in old_handlers.items():
            signal.signal(number, handler)
    if child.is_done:
        return int(child.result)
    if received:
        say("interrupted: nothing was written")
        return INTERRUPTED
    error = crash(where, child.exitcode)
    say(error.line())
    return error.exit_status


def report_stopping() -> None:
    """In a child: acknowledge the request to stop to the parent."""
    process = multiprocessing.current_process()
    if isinstance(process, Child):
        process.report(STOPPING)


def report_outputs(folder: str, made_folders: list[str]) -> None:
    """In a child: report the folders of unfinished outputs, and new folders, to the parent."""
    process = multiprocessing.current_process()
    if isinstance(process, Child):
        process.report(OUTPUTS, (folder, made_folders))


def crash(where: str, status: int | None) -> AmError:
    """Return the error for a process that ended without a result. status: as in Popen."""
    if status == -signal.SIGKILL:
        message = "the system stopped the command, probably for lack of memory; free memory, or plan fewer rows at the same time"
        return AmError("ENDED", where, message)
    names = {-number.value: number.name for number in signal.Signals}
    return InputError(
        "CRASHED",
        where,
        "FreeCAD crashed ({}): the shape is damaged or too complex for the geometry kernel; "
        "check the part in FreeCAD (Part > Check geometry), and repair it or export it again",
        names.get(status or 0, f"status {status}"),
    )


def _run_interruptible(work: Callable[[], int], received: list[int]) -> int:
    """In the child of a command: run the work and return its status.

    received: signals that arrived before the start.
    """
    for number in SIGNALS:
        signal.signal(number, _interrupt)
    try:
        return INTERRUPTED if received else work()
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception:
        import traceback

        traceback.print_exc()
        return 1
    finally:
        for number in SIGNALS:  # ignore signals after the work
            signal.signal(number, signal.SIG_IGN)


def _interrupt(*_: Any) -> None:
    """Raise KeyboardInterrupt once, because a terminal sends Ctrl-C to the child and its parent."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    report_stopping()
    raise KeyboardInterrupt


def _end_with_parent(parent: int) -> None:
    """Make Linux kill this process when the process `parent` ends for any reason."""
    import ctypes

    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:
        os._exit(1)
