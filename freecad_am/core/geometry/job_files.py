# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths and bytes of the files of a job: the path is the stated one or, for a job of another
machine, that of a copy.

All code that opens a file of a job, or checks that it exists, asks here. Stored and reported names
are those of the job, so planning gives the same result on every machine.
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

# JSON of a Relocation; also the processes that this one starts find it there
ENVIRONMENT_VARIABLE = "FREECAD_AM_FILES"

_recorded_names: ContextVar[set[str] | None] = ContextVar("recorded_names", default=None)


class Relocation(NamedTuple):
    """Where the files of a job of another machine are. All paths are absolute.

    copies: a folder with copies, below their names there. local: folders whose files keep their
    paths. home: home folder there of the user whose job it is. machines: folders there with the
    user's machine files.
    """

    copies: str
    local: tuple[str, ...]
    home: str
    machines: tuple[str, ...]


def relocation() -> Relocation | None:
    """Return where the files of a job of another machine are; None for a job of this machine."""
    return _parse_relocation(os.environ.get(ENVIRONMENT_VARIABLE, ""))


def locate(path: str | os.PathLike[str]) -> Path:
    """Return the path of the file of this name on this machine, whether or not it exists."""
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
    """Return whether a file of this name exists."""
    return os.path.isfile(locate(path))


def expanded(name: str) -> str:
    """A name with the home folder of the user whose job it is instead of `~`."""
    moved = relocation()
    if moved is not None and (name == "~" or name.startswith("~/")):
        return moved.home + name[1:]
    return os.path.expanduser(name)


@contextlib.contextmanager
def record_names() -> Iterator[set[str]]:
    """Collect the absolute names of the files that are requested meanwhile, whether or not they
    exist.
    """
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


# ---- The bytes of a file from outside, which may be no file at all or larger than memory

MB = 1_000_000


def read_content(path: str | Path, largest: int, code: str, where: str) -> bytes:
    """Return all bytes of a file.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    largest : int
        Largest size, MB.
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
    """Return the SHA-256 of a file, without holding all its bytes.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    largest : int
        Largest size, MB.
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
