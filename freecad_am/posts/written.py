# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files of a program written into a folder, replacing an earlier program of the same name."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Mapping

from . import earlier


def write(folder: str, files: Mapping[str, bytes]) -> list[str]:
    """Write the files (name with slashes -> content) into a folder, which is made, and remove the parts that an earlier
    program of the same name has left there; the paths.

    Each file appears whole or not at all, and none is written or removed through a link below the folder. OSError.
    """
    os.makedirs(folder, exist_ok=True)
    earlier_programs = earlier.programs(folder)
    paths = [os.path.join(folder, *name.split("/")) for name in files]
    waiting: list[tuple[str, str]] = []
    try:
        for path, content in zip(paths, files.values(), strict=True):
            _refuse_links(path, folder)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            handle, temporary = tempfile.mkstemp(prefix=".unfinished-", dir=os.path.dirname(path))
            waiting.append((temporary, path))
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            os.chmod(temporary, 0o666 & ~_umask())
        stale = set().union(
            *(earlier_programs[main] for main in files if main in earlier_programs)
        ) - set(files)
        for name in sorted(stale):
            _remove(os.path.join(folder, *name.split("/")), folder)
        while waiting:
            os.replace(*waiting[0])
            del waiting[0]
    finally:
        for temporary, _ in waiting:
            with contextlib.suppress(OSError):
                os.remove(temporary)
    return paths


def _refuse_links(path: str, folder: str) -> None:
    parent = os.path.dirname(path)
    while len(parent) > len(folder):
        if os.path.islink(parent):
            raise NotADirectoryError(
                20, "a link takes the place of a folder of the program", parent
            )
        parent = os.path.dirname(parent)


def _remove(path: str, folder: str) -> None:
    """Remove a file, and the folder of a part that is empty without it."""
    os.remove(path)
    parent = os.path.dirname(path)
    if len(parent) > len(folder) and not os.listdir(parent):
        os.rmdir(parent)


def _umask() -> int:
    now = os.umask(0o077)
    os.umask(now)
    return now
