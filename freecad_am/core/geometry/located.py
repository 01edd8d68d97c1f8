# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths of the files of a job: the stated path or, for a job of another machine, the path of a copy.

All code that opens a file of a job, or checks that it exists, asks here. Stored and reported names
are those of the job, so planning gives the same result on every machine.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import NamedTuple

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
