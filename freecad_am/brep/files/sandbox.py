# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads external files in a sandboxed worker with limits on time and memory.

FreeCAD and the geometry kernel crash on some damaged files and hang on others. If no worker can be
started, this process reads the file.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from typing import Any, TypeVar

from ...core.issues import InputError, Text, Word
from ..kernel import process, transfer

T = TypeVar("T")

SECONDS, SECONDS_PER_MB = 4.0, 10.0  # processor time, s, per file and per MB
SECONDS_TO_CUT = 20.0  # s more for a 3MF file, whose negative volumes are subtracted on reading
MEMORY, MEMORY_PER_MB = 600.0, 100.0  # MB, likewise, in addition to the memory of the worker
MAX_FILE_MB = 2000  # MB of a file
WALL_CLOCK_FACTOR = 10.0  # wall-clock limit as a multiple of the processor time
MB = 1e6
SOUND, REJECTED, INEXACT = "sound", "rejected", "inexact"  # kinds of answers


def read_in_sandbox(
    reader: Callable[..., T], path: str | os.PathLike[str], *arguments: Any, patience: float = 1.0
) -> T:
    """Return what `reader(path, *arguments)` returns: a shape, a mesh, or a picklable value.

    `reader` is a function of a module. patience: factor on the time limit. Raises the reader's
    InputError. Raises InputError BAD_FILE, which names the file, if reading crashes or takes more
    time or memory than a file of its size may take, and for a file larger than MAX_FILE_MB.
    """
    size = _size(path) / MB
    where = os.path.basename(os.fspath(path)) or os.fspath(path)
    if size > MAX_FILE_MB:
        message = Text(
            "the file is larger than {} MB, the maximum; check that you chose the right file",
            MAX_FILE_MB,
        )
        raise InputError("BAD_FILE", where, message)
    if process.in_sandbox():
        return reader(path, *arguments)
    limits = _limits(where, size, patience)
    with tempfile.TemporaryDirectory(prefix="reading_") as folder:
        outcome = process.run_limited(
            read_to_folder,
            (reader, folder, path, arguments),
            folder,
            limits,
            WALL_CLOCK_FACTOR * limits[0],
        )
        if outcome is None:  # no worker can be started
            return reader(path, *arguments)
        if outcome.status or not outcome.sound:
            raise _rejection(where, outcome, *limits)
        kind, content = transfer.load_value(outcome.value, folder)
        if kind == REJECTED:
            raise InputError(*content)
        if kind == SOUND:
            result: T = transfer.load_value(content, folder)
            return result
    return reader(path, *arguments)  # the file is sound: read it again, here


def read_to_folder(
    reader: Callable[..., Any], folder: str, path: Any, arguments: tuple[Any, ...]
) -> tuple[str, Any]:
    """In a worker: return the kind of the answer and its content."""
    try:
        return SOUND, transfer.dump_value(reader(path, *arguments), folder, exact=True)
    except transfer.InexactShape:
        return INEXACT, None
    except InputError as error:
        return REJECTED, (error.code, error.where, error.message)


def _limits(name: str, size: float, patience: float) -> tuple[float, float]:
    """Return the limits of CPU time, s, and memory, MB, for reading a file of `size` MB."""
    seconds = patience * (SECONDS + SECONDS_PER_MB * size)
    if name.lower().endswith(".3mf"):
        seconds += SECONDS_TO_CUT
    return seconds, patience**0.5 * (MEMORY + MEMORY_PER_MB * size)


def _size(path: str | os.PathLike[str]) -> float:
    try:
        return float(os.stat(path).st_size)
    except (OSError, ValueError):
        return 0.0


def _rejection(where: str, outcome: process.Outcome, seconds: float, memory: float) -> InputError:
    if outcome.status == process.ENDED_BY_LIMIT:
        why = Text(
            "reading it takes more than {:.0f} s of processor time, the limit for a file of its "
            "size",
            seconds,
        )
    elif outcome.memory > 0.8 * memory:
        why = Text(
            "reading it takes more than {:.0f} MB of memory, the limit for a file of its size",
            memory,
        )
    else:
        why = "FreeCAD crashes while reading it"
    return InputError("BAD_FILE", where, "the file is damaged: {}; export it again", Word(why))
