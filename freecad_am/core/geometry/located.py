# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths of the files of a job: the stated path or, for a job moved to another machine, a
folder of copies.

All code that opens a file of a job, or checks that it exists, asks here. Stored and
reported names are those of the job, so planning gives the same result on every machine.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

_copies: str = ""  # the folder of copies, absolute; empty where a job is at home
_own: tuple[str, ...] = ()  # folders of this machine nevertheless
_home: str = ""  # of the user whose job it is
_asked: set[str] | None = None


def locate(path: str | os.PathLike[str]) -> Path:
    """Return the path of the file of this name on this machine, whether or not it exists."""
    name = (
        os.path.abspath(os.path.expanduser(os.fspath(path)))
        if _copies or _asked is not None
        else ""
    )
    if _asked is not None:
        _asked.add(name)
    if not _copies or any(
        name == folder or name.startswith(folder + os.sep) for folder in (*_own, _copies)
    ):
        return Path(path)
    return Path(_copies + name)


def is_there(path: str | os.PathLike[str]) -> bool:
    """Return whether a file of this name exists."""
    return os.path.isfile(locate(path))


def expanded(name: str) -> str:
    """A name with the home folder of the user whose job it is instead of `~`."""
    return (
        _home + name[1:]
        if _home and (name == "~" or name.startswith("~/"))
        else os.path.expanduser(name)
    )


def use_copies(copies: str, local_folders: tuple[str, ...], home: str) -> None:
    """From now on, look for files in the folder `copies`, below their absolute names.

    Files in the folders `local_folders` keep their paths. home: home folder of the user whose
    job it is. All are absolute.
    """
    global _copies, _own, _home
    _copies, _own, _home = copies, local_folders, home


@contextlib.contextmanager
def record_names() -> Iterator[set[str]]:
    """Collect the absolute names of the files that are requested meanwhile, whether or not they
    exist.
    """
    global _asked
    previous, _asked = _asked, set()
    try:
        yield _asked
    finally:
        _asked = previous
