# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of a file from outside, which may be no file at all or larger than memory."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from ..issues import InputError

MB = 1_000_000


def content(path: str | Path, largest: int, code: str, where: str) -> bytes:
    """All bytes of a file. `largest`: MB of what is read. InputError `code` at `where` for devices, pipes and folders, which
    could be read without end, and for larger files; OSError and ValueError where it cannot be opened."""
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))  # a pipe would wait
    with open(descriptor, "rb") as stream:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise InputError(code, where, "this is not a file but a device, a pipe or a folder; name a file")
        data = stream.read(largest * MB + 1)
    if len(data) > largest * MB:
        raise InputError(code, where, f"the file is larger than {largest} MB, the most that is read; is it the right one?")
    return data
