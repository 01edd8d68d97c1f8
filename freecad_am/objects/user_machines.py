# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a user's own machine files are kept: RoboticAM/machines in FreeCAD's folder of user data."""

from __future__ import annotations

import os

import FreeCAD as App

FOLDER = os.path.join("RoboticAM", "machines")


def folders() -> tuple[str, ...]:
    """Folders with the user's machine files, those that exist."""
    folder = os.path.join(App.getUserAppDataDir(), FOLDER)
    return (folder,) if os.path.isdir(folder) else ()


def file_of(machine: str) -> str | None:
    """The user's file of a machine given by its id or by a path; None for a built-in or unknown one."""
    candidates = [machine, *(os.path.join(folder, f"{machine}.json") for folder in folders())]
    return next((path for path in candidates if os.path.isfile(path)), None)
