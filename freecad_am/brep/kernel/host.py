# SPDX-License-Identifier: LGPL-2.1-or-later
"""A process that has the geometry kernel to itself, run as a script by `kernel_process`, which tells the protocol.

It ends when it is asked nothing for a while, and when whoever started it is gone: at once where it waits to be asked, after
the call where it is at work.
"""

from __future__ import annotations

import importlib
import os
import pickle
import sys
import threading
from typing import Any, BinaryIO

IDLE = 300.0  # s


def serve(asked: BinaryIO, answers: BinaryIO) -> None:
    """Answer until nothing is asked any more."""
    for entry in _heard(asked):
        if entry not in sys.path:
            sys.path.append(entry)
    import FreeCAD
    import Part

    _tell(answers, tuple(FreeCAD.Version()[:3]))
    while True:
        module, function, path, rest = _heard(asked)
        try:
            given = ()
            if path:
                given = (Part.Shape(),)
                given[0].importBinary(path)
            answer = True, getattr(importlib.import_module(module), function)(*given, *rest)
        except Exception as error:
            answer = False, _portable(error)
        _tell(answers, answer)


def _heard(asked: BinaryIO) -> Any:
    """What is asked next; if that is nothing for long, this process ends."""
    leave = threading.Timer(IDLE, os._exit, (0,))
    leave.daemon = True
    leave.start()
    heard = pickle.load(asked)
    leave.cancel()
    return heard


def _tell(answers: BinaryIO, answer: Any) -> None:
    pickle.dump(answer, answers, protocol=pickle.HIGHEST_PROTOCOL)
    answers.flush()


def _portable(error: Exception) -> Exception:
    """The error, or its text where it cannot travel."""
    try:
        return (
            error
            if isinstance(pickle.loads(pickle.dumps(error)), type(error))
            else RuntimeError(str(error))
        )
    except Exception:
        return RuntimeError(str(error))


if __name__ == "__main__":
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what FreeCAD has to say is no answer
    try:
        serve(sys.stdin.buffer, answers)
    finally:
        os._exit(0)  # FreeCAD must not save preferences on its way out
