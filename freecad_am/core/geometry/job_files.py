# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths and bytes of job files; a job of another machine uses copies of its files.

All code that opens a job file or checks its existence calls this module. Stored and reported names
are the names in the job, so planning gives the same result on every machine.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import stat
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import NamedTuple

from ..issues import InputError

# JSON of a Relocation; child processes inherit the variable
ENVIRONMENT_VARIABLE = "FREECAD_AM_FILES"

_recorded_names: ContextVar[set[str] | None] = ContextVar("recorded_names", default=None)


class Relocation(NamedTuple):
    """Locations of the files of a job of another machine. All paths are absolute.

    copies: folder with copies of the files, below their original paths. local: folders whose files
    keep their paths. home, machines: home folder of the job's user and folders with the user's
    machine files, on the other machine.
    """

    copies: str
    local: tuple[str, ...]
    home: str
    machines: tuple[str, ...]


def relocation() -> Relocation | None:
    """Return the file locations of a job of another machine; None for a job of this machine."""
    return _parse_relocation(os.environ.get(ENVIRONMENT_VARIABLE, ""))


def locate(path: str | os.PathLike[str]) -> Path:
    """Return the path on this machine of a job file, whether or not the file exists."""
    moved, names = relocation(), _recorded_names.get()
    if moved is None and names is None:
        return Path(path)
    name = os.path.abspath(os.path.expanduser(os.fspath(path)))
    if names is not None:
        names.add(name)
    if moved is None or any(
        name == folder or name.startswith(folder + os.sep)
        for folder in (*moved.local, moved.copies)
    ):
        return Path(path)
    return Path(moved.copies + name)


def is_there(path: str | os.PathLike[str]) -> bool:
    """Return whether a job file exists."""
    return os.path.isfile(locate(path))


def expanded(name: str) -> str:
    """Replace `~` in a name by the home folder of the job's user."""
    moved = relocation()
    if moved is not None and (name == "~" or name.startswith("~/")):
        return moved.home + name[1:]
    return os.path.expanduser(name)


@contextlib.contextmanager
def record_names() -> Iterator[set[str]]:
    """Collect the absolute names of the job files requested in this context, existing or not."""
    names: set[str] = set()
    token = _recorded_names.set(names)
    try:
        yield names
    finally:
        _recorded_names.reset(token)


@functools.lru_cache(maxsize=1)
def _parse_relocation(text: str) -> Relocation | None:
    if not text:
        return None
    values = json.loads(text)
    return Relocation(
        values["copies"], tuple(values["local"]), values["home"], tuple(values["machines"])
    )


# ---- Bytes of external files, which may be devices or pipes, or larger than memory

MB = 1_000_000


def read_content(path: str | Path, largest: int, code: str, where: str) -> bytes:
    """Return all bytes of a file.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    largest : int
        Maximum size, MB.
    code : str
        Code of the error for larger files.
    where : str
        Position of the error, for messages.

    Returns
    -------
    bytes
        The content.

    Raises
    ------
    InputError
        `code` for larger files, and for devices, pipes and folders, which may never end.
    OSError, ValueError
        If the file cannot be opened.
    """
    return b"".join(_read_blocks(path, largest, code, where))


def digest(path: str | Path, largest: int, code: str, where: str) -> str:
    """Return the SHA-256 of a file without loading the whole file.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    largest : int
        Maximum size, MB.
    code : str
        Code of the error for larger files.
    where : str
        Position of the error, for messages.

    Returns
    -------
    str
        The digest in hexadecimal.

    Raises
    ------
    InputError, OSError, ValueError
        As `read_content`.
    """
    checksum = hashlib.sha256()
    for block in _read_blocks(path, largest, code, where):
        checksum.update(block)
    return checksum.hexdigest()


def _read_blocks(path: str | Path, largest: int, code: str, where: str) -> Iterator[bytes]:
    waits_not = getattr(os, "O_NONBLOCK", 0)  # do not block on a pipe
    descriptor = os.open(locate(path), os.O_RDONLY | waits_not | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as stream:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise InputError(
                code, where, "the path is not a file but a device, a pipe or a folder; name a file"
            )
        size = status.st_size  # 0 for kernel files, regardless of their content
        while size <= largest * MB and (block := stream.read(MB)):
            yield block
            size = max(size, stream.tell())
    if size > largest * MB:
        raise InputError(
            code,
            where,
            "the file is larger than {} MB, the maximum; check that you chose the right file",
            largest,
        )
