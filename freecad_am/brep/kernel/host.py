# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sandboxed worker: a Python with FreeCAD that `process` starts, which documents the protocol.

It ends after a while without questions, and when its parent is gone.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import pickle
import queue
import signal
import sys
import threading
from collections.abc import Iterator
from typing import Any, BinaryIO

if sys.platform != "win32":
    import resource

IDLE = 300.0  # s without a question after which the worker ends
BYTES_PER_MB = 1_000_000
FAULT_SIGNALS = ("SIGTERM", "SIGSEGV", "SIGABRT", "SIGFPE", "SIGXCPU")


def serve(questions: BinaryIO, answers: BinaryIO) -> None:
    """Answer questions until no more come."""
    incoming: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(questions, incoming), daemon=True).start()
    for entry in _next_question(incoming):
        if entry not in sys.path:
            sys.path.append(entry)
    import FreeCAD

    from freecad_am.brep.kernel import transfer

    reset_signals()
    _send(answers, tuple(FreeCAD.Version()[:3]))
    while True:
        module, function, folder, data, limits = _next_question(incoming)
        try:
            call = getattr(importlib.import_module(module), function)
            arguments = transfer.load_value(data, folder)
            with _resource_limits(limits):
                answer = True, transfer.dump_value(call(*arguments), folder)
        except Exception as error:
            answer = False, _portable(error)
        _send(answers, answer)


def reset_signals() -> None:
    """Let every fault end this process; FreeCAD and its kernel would continue with corrupt data.

    Ctrl-C is for the parent, which ends this process where necessary.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in FAULT_SIGNALS:
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_DFL)


def _listen(questions: BinaryIO, incoming: queue.SimpleQueue[Any]) -> None:
    """Pass questions on. When the parent is gone, end the process, even if it is busy."""
    try:
        while True:
            incoming.put(pickle.load(questions))
    except Exception:
        os._exit(0)


def _next_question(incoming: queue.SimpleQueue[Any]) -> Any:
    """Return the next question; end the process if none comes for long."""
    try:
        return incoming.get(timeout=IDLE)
    except queue.Empty:
        os._exit(0)


@contextlib.contextmanager
def _resource_limits(limits: tuple[float, float] | None) -> Iterator[None]:
    """Limit what this process takes from now on: processor time, s, and memory, MB."""
    if limits is None or sys.platform == "win32":
        yield
        return
    seconds, memory = limits
    usage = resource.getrusage(resource.RUSAGE_SELF)
    values = {
        resource.RLIMIT_CPU: round(usage.ru_utime + usage.ru_stime + seconds),
        resource.RLIMIT_CORE: 0,
    }
    if sys.platform.startswith("linux"):
        values[resource.RLIMIT_AS] = _address_space() + round(memory * BYTES_PER_MB)
    with contextlib.ExitStack() as cleanup:
        for kind, value in values.items():
            soft, hard = resource.getrlimit(kind)
            cleanup.callback(resource.setrlimit, kind, (soft, hard))
            allowed = value if hard == resource.RLIM_INFINITY else min(value, hard)
            resource.setrlimit(kind, (allowed, hard))
        yield


def _address_space() -> int:
    """Return the address space of this process, bytes."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[0]) * resource.getpagesize()


def _send(answers: BinaryIO, answer: Any) -> None:
    pickle.dump(answer, answers, protocol=pickle.HIGHEST_PROTOCOL)
    answers.flush()


def _portable(error: Exception) -> Exception:
    """Return the error, or its text as a RuntimeError if the error cannot be pickled."""
    try:
        copy = pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(str(error))
    return error if isinstance(copy, type(error)) else RuntimeError(str(error))


if __name__ == "__main__":
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # messages of FreeCAD are no answers
    try:
        serve(sys.stdin.buffer, answers)
    finally:
        os._exit(0)  # FreeCAD must not save preferences when it ends
