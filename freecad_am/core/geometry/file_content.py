# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of a file from outside, which may be no file at all or larger than memory."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from ..issues import InputError
from .located import located

MB = 1_000_000


def content(path: str | Path, largest: int, code: str, where: str) -> bytes:
    """All bytes of a file. `largest`: MB of what is read. InputError `code` at `where` for devices, pipes and folders, which
    could be read without end, and for larger files; OSError and ValueError where it cannot be opened."""
    return b"".join(_pieces(path, largest, code, where))


def digest(path: str | Path, largest: int, code: str, where: str) -> str:
    """SHA-256 of all bytes of a file, in hexadecimal, without having them all at once. Arguments and errors as `content`."""
    found = hashlib.sha256()
    for piece in _pieces(path, largest, code, where):
        found.update(piece)
    return found.hexdigest()


def _pieces(path: str | Path, largest: int, code: str, where: str) -> Iterator[bytes]:
    waits_not = getattr(os, "O_NONBLOCK", 0)  # as for a pipe
    descriptor = os.open(located(path), os.O_RDONLY | waits_not | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as stream:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise InputError(
                code, where, "this is not a file but a device, a pipe or a folder; name a file"
            )
        size = status.st_size  # of files of the kernel 0, whatever is in them
        while size <= largest * MB and (piece := stream.read(MB)):
            yield piece
            size = max(size, stream.tell())
    if size > largest * MB:
        raise InputError(
            code,
            where,
            "the file is larger than {} MB, the most that is read; check that it is the right one",
            largest,
        )
