# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the files of a job are: where it says, or, of a job that has travelled to another machine, in a folder of copies.

Whoever opens a file of a job, or looks whether it is there, asks here; what is stored and told are the names as the job has
them, so that a job comes to the same wherever it is planned.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

_copies: str = ""  # the folder of copies, absolute; empty where a job is at home
_own: tuple[str, ...] = ()  # folders of this machine all the same
_home: str = ""  # of the user whose job it is
_asked: set[str] | None = None


def located(path: str | os.PathLike[str]) -> Path:
    """The place where the file of this name is on this machine, whether or not it is there."""
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
    """Whether there is a file of this name."""
    return os.path.isfile(located(path))


def expanded(name: str) -> str:
    """A name with the home folder of the user whose job it is instead of `~`."""
    return (
        _home + name[1:]
        if _home and (name == "~" or name.startswith("~/"))
        else os.path.expanduser(name)
    )


def travelled(copies: str, own: tuple[str, ...], home: str) -> None:
    """From now on, files are in the folder `copies`, below their absolute names; those in the folders `own` are where they
    say. home: of the user whose job it is. All are absolute."""
    global _copies, _own, _home
    _copies, _own, _home = copies, own, home


@contextlib.contextmanager
def recorded() -> Iterator[set[str]]:
    """Collects the absolute names of the files that are asked for meanwhile, there or not."""
    global _asked
    before, _asked = _asked, set()
    try:
        yield _asked
    finally:
        _asked = before
