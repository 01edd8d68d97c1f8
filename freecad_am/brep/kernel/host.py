# SPDX-License-Identifier: LGPL-2.1-or-later
"""A process with a geometry kernel of its own, run as a script by `kernel_process`, which documents
the protocol.

It ends after a while without questions, and when its parent is gone: at once while it waits, else
after the current call.
"""

from __future__ import annotations

import importlib
import os
import pickle
import sys
import threading
from typing import Any, BinaryIO

IDLE = 300.0  # s


def serve(questions: BinaryIO, answers: BinaryIO) -> None:
    """Answer questions until none comes any more."""
    for entry in _read_question(questions):
        if entry not in sys.path:
            sys.path.append(entry)
    import FreeCAD
    import Part

    _send(answers, tuple(FreeCAD.Version()[:3]))
    while True:
        module, function, path, arguments = _read_question(questions)
        try:
            shapes = ()
            if path:
                shapes = (Part.Shape(),)
                shapes[0].importBinary(path)
            answer = True, getattr(importlib.import_module(module), function)(*shapes, *arguments)
        except Exception as error:
            answer = False, _portable(error)
        _send(answers, answer)


def _read_question(questions: BinaryIO) -> Any:
    """The next question; without one for long, the process ends."""
    leave = threading.Timer(IDLE, os._exit, (0,))
    leave.daemon = True
    leave.start()
    question = pickle.load(questions)
    leave.cancel()
    return question


def _send(answers: BinaryIO, answer: Any) -> None:
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
