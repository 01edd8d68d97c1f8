# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command carried out in a fork of the process, so that the parent can report a crash of FreeCAD.

The fork is made before anything is loaded, which takes a millisecond. It receives forwarded
signals, ends with its parent, and reports the folder of its unfinished outputs, so that the parent
can remove them.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable
from typing import Any

from ..core import copies
from ..core.issues import AmError, InputError

SIGNALS = (signal.SIGINT, signal.SIGTERM)
INTERRUPTED = 130
DONE_MESSAGE = "done"  # message at the regular end of the fork
STOPPING = "stopping"  # message of a fork that has noticed a signal
GRACE = (
    0.7  # s for the fork to notice a signal; the geometry kernel blocks signals while it is at work
)

_channel = -1  # file descriptor of the fork for messages


def supervised(work: Callable[[], int], where: str, say: Callable[[str], None]) -> int:
    """The status of `work`, done in a fork of the current process. `say` takes the line about a
    crash, which names `where`.
    """
    if not sys.platform.startswith("linux"):
        return work()
    ours, theirs = os.pipe()
    passed: list[int] = []
    child, parent = [0], os.getpid()

    def pass_on(number: int, _: Any) -> None:
        passed.append(number)
        with contextlib.suppress(ProcessLookupError):
            if child[0]:
                os.kill(child[0], number)
        signal.setitimer(signal.ITIMER_REAL, GRACE)

    def kill(*_: Any) -> None:
        if child[0] and passed:
            os.kill(child[0], signal.SIGKILL)

    old_handlers = {number: signal.signal(number, pass_on) for number in SIGNALS}
    old_handlers[signal.SIGALRM] = signal.signal(signal.SIGALRM, kill)
    sys.stdout.flush()
    sys.stderr.flush()
    child[0] = os.fork()
    if not child[0]:
        os.close(ours)
        _carry_out(work, theirs, passed, parent)
    os.close(theirs)
    try:
        for number in passed[:]:  # that came before there was a copy
            with contextlib.suppress(ProcessLookupError):
                os.kill(child[0], number)
        messages = []
        with open(ours, encoding="utf-8") as stream:
            for line in stream:
                if line.endswith("\n"):
                    messages.append(json.loads(line))
                    if messages[-1] in (STOPPING, DONE_MESSAGE):
                        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        status = os.waitstatus_to_exitcode(os.waitpid(child[0], 0)[1])
    finally:
        for number, handler in old_handlers.items():
            signal.signal(number, handler)
    if DONE_MESSAGE in messages:
        return status
    for entry in messages:
        if entry != STOPPING:
            _clean_up(*entry)
    if passed:
        say("interrupted: nothing was written")
        return INTERRUPTED
    error = crash(where, status)
    say(error.line())
    return error.exit_status


def tell_stopping() -> None:
    """From a copy: it has noticed that it is to stop, and does."""
    _send(STOPPING)


def tell_outputs(folder: str, made_folders: list[str]) -> None:
    """From a copy: outputs are in the making in this folder, for which these were made."""
    _send([folder, made_folders])


def crash(where: str, status: int) -> AmError:
    """The error of a process that ended without its result, with the status as Popen gives it."""
    name = signal.Signals(-status).name if -status in set(signal.Signals) else f"status {status}"
    if status == -signal.SIGKILL:
        message = "the system ended the command, for lack of memory most likely; free some, or plan less at the same time"
        return AmError("ENDED", where, message)
    return InputError(
        "CRASHED",
        where,
        "FreeCAD crashed ({}): the shape is damaged or exceeds its geometry kernel; check the "
        "part in FreeCAD (Part > Check geometry), repair it or export it again",
        name,
    )


def _carry_out(work: Callable[[], int], channel: int, passed: list[int], parent: int) -> None:
    """In the copy: do the work and end."""
    global _channel
    _channel = channel
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    os.set_inheritable(channel, False)
    status = 1
    try:
        for number in SIGNALS:
            signal.signal(number, _interrupted)
        copies.end_with(parent)
        status = INTERRUPTED if passed else work()
    except KeyboardInterrupt:
        status = INTERRUPTED
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        for number in SIGNALS:  # it is done
            signal.signal(number, signal.SIG_IGN)
        sys.stdout.flush()
        sys.stderr.flush()
        _send(DONE_MESSAGE)
        os._exit(status)


def _interrupted(*_: Any) -> None:
    """Once: the keys of a terminal reach the fork directly and through its parent."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    tell_stopping()
    raise KeyboardInterrupt


def _send(value: Any) -> None:
    if _channel >= 0:
        with contextlib.suppress(OSError):
            os.write(_channel, (json.dumps(value) + "\n").encode())


def _clean_up(folder: str, made_folders: list[str]) -> None:
    """Finish or remove what a crash has left in the making."""
    from .outputs import staging

    with contextlib.suppress(OSError):
        staging.clear(folder)
        for path in reversed(made_folders):
            os.rmdir(path)
