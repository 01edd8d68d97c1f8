# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command carried out in a copy of the process, so that somebody is left to tell where FreeCAD crashes.

The copy is made by fork before anything is loaded, which takes a millisecond. It is passed the signals on, ends with the
process that waits for it, and tells where its outputs are in the making, so that nothing is left of them.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable
from typing import Any

from freecad_am.core import copies
from freecad_am.core.issues import AmError, InputError

SIGNALS = (signal.SIGINT, signal.SIGTERM)
INTERRUPTED = 130
DONE = "done"  # told at the end by a copy that came to it
STOPPING = "stopping"  # told by a copy that has noticed a signal
GRACE = 0.7  # s that a copy has to notice one; the geometry kernel lets nothing through while it is at work

_channel = -1  # where a copy tells


def supervised(work: Callable[[], int], where: str, say: Callable[[str], None]) -> int:
    """The status of `work`, done in a copy of this process. `say` takes the line about a crash, which is about `where`."""
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

    before = {number: signal.signal(number, pass_on) for number in SIGNALS}
    before[signal.SIGALRM] = signal.signal(signal.SIGALRM, kill)
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
                    if messages[-1] in (STOPPING, DONE):
                        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        status = os.waitstatus_to_exitcode(os.waitpid(child[0], 0)[1])
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    if DONE in messages:
        return status
    for entry in messages:
        if entry != STOPPING:
            _tidied(*entry)
    if passed:
        say("interrupted: nothing was written")
        return INTERRUPTED
    error = crash(where, status)
    say(error.line())
    return error.exit_status


def tell_stopping() -> None:
    """From a copy: it has noticed that it is to stop, and does."""
    _tell(STOPPING)


def tell_outputs(folder: str, made: list[str]) -> None:
    """From a copy: outputs are in the making in this folder, for which these were made."""
    _tell([folder, made])


def crash(where: str, status: int) -> AmError:
    """The error of a process that ended without its result, with the status that Popen tells."""
    name = signal.Signals(-status).name if -status in set(signal.Signals) else f"status {status}"
    if status == -signal.SIGKILL:
        message = "the system ended the command, for lack of memory most likely; free some, or plan less at the same time"
        return AmError("ENDED", where, message)
    return InputError(
        "CRASHED",
        where,
        "FreeCAD crashed ({}): a shape is damaged, or more than its geometry kernel can do; check the "
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
        _tell(DONE)
        os._exit(status)


def _interrupted(*_: Any) -> None:
    """Once: the keys of a terminal reach the copy by itself and through the process that waits for it."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    tell_stopping()
    raise KeyboardInterrupt


def _tell(value: Any) -> None:
    if _channel >= 0:
        with contextlib.suppress(OSError):
            os.write(_channel, (json.dumps(value) + "\n").encode())


def _tidied(folder: str, made: list[str]) -> None:
    """Finish or remove what a crash has left in the making."""
    from .outputs import staging

    with contextlib.suppress(OSError):
        staging.clear(folder)
        for path in reversed(made):
            os.rmdir(path)
