# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of a file from outside, which may be no file at all or larger than memory."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from ..issues import InputError
from .located import locate

MB = 1_000_000


def read_content(path: str | Path, largest: int, code: str, where: str) -> bytes:
    """Return all bytes of a file.

    largest: maximum size, MB. Raises InputError `code` at `where` for larger files and for
    devices, pipes and folders, which could be read without end; OSError and ValueError if the
    file cannot be opened.
    """
    return b"".join(_read_blocks(path, largest, code, where))


def digest(path: str | Path, largest: int, code: str, where: str) -> str:
    """Return the SHA-256 of a file, in hexadecimal, without holding all its bytes. Arguments and
    errors as `content`.
    """
    checksum = hashlib.sha256()
    for block in _read_blocks(path, largest, code, where):
        checksum.update(block)
    return checksum.hexdigest()


def _read_blocks(path: str | Path, largest: int, code: str, where: str) -> Iterator[bytes]:
    waits_not = getattr(os, "O_NONBLOCK", 0)  # as for a pipe
    descriptor = os.open(locate(path), os.O_RDONLY | waits_not | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as stream:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise InputError(
                code, where, "this is not a file but a device, a pipe or a folder; name a file"
            )
        size = status.st_size  # 0 for files of the kernel, whatever their content
        while size <= largest * MB and (block := stream.read(MB)):
            yield block
            size = max(size, stream.tell())
    if size > largest * MB:
        raise InputError(
            code,
            where,
            "the file is larger than {} MB, the maximum; check that it is the right one",
            largest,
        )
