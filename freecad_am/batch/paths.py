# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a user's own files are kept."""

from __future__ import annotations

import os

from freecad_am.core.issues import InputError

from . import host

MACHINES = os.path.join("RoboticAM", "machines")  # in FreeCAD's folder of user data


def require_freecad() -> None:
    """Make FreeCAD importable. Raises InputError NO_FREECAD where this Python has none."""
    if not host.find_freecad():
        raise InputError(
            "NO_FREECAD", "Python", "FreeCAD cannot be imported; set FREECAD_AM_PYTHON to a Python that can"
        )


def machine_folders() -> tuple[str, ...]:
    """Folders with the user's machine files, those that exist."""
    require_freecad()
    import FreeCAD

    folder = os.path.join(FreeCAD.getUserAppDataDir(), MACHINES)
    return (folder,) if os.path.isdir(folder) else ()


def machine_file(name: str) -> str:
    """The file of a machine in the user's folders, or the name itself where it is built in, a path or unknown."""
    for folder in machine_folders():
        path = os.path.join(folder, name + ".json")
        if os.path.isfile(path):
            return path
    return name
