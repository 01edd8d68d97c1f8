# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a user's own machine files are kept: RoboticAM/machines in FreeCAD's folder of user data, and, for the window, the
folder of the preferences."""

from __future__ import annotations

import os

import FreeCAD as App

from ..core.geometry import job_files
from ..core.geometry.job_files import is_there
from ..core.issues import InputError
from ..core.kinematics.machines import calibration, machine
from ..core.kinematics.urdf import reference as urdf_reference
from .fields import preferences

FOLDER = os.path.join("RoboticAM", "machines")


def folders() -> tuple[str, ...]:
    """Existing folders with the user's machine files; for a job of another machine, those there."""
    relocation = job_files.relocation()
    if relocation is not None:
        return relocation.machines
    own_folder = os.path.join(App.getUserAppDataDir(), FOLDER)
    return tuple(
        folder
        for folder in (own_folder, preferences.machine_folder())
        if preferences.existing(folder)
    )


def save(name: str, text: str) -> str:
    """Write the text of a machine file under an id; return the path. The file is written completely
    or not at all.

    Raises InputError NOT_WRITTEN if it cannot be written, or if the id is already taken.
    """
    folder = os.path.join(App.getUserAppDataDir(), FOLDER)
    path = os.path.join(folder, f"{name}.json")
    if os.path.exists(path) or (machine.BUILT_IN / f"{name}.json").exists():
        raise InputError(
            "NOT_WRITTEN", "id", "a machine {!r} already exists; choose another name", name
        )
    try:
        os.makedirs(folder, exist_ok=True)
        with open(f"{path}.new", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(f"{path}.new", path)
    except OSError as error:
        raise InputError(
            "NOT_WRITTEN",
            path,
            "it cannot be written: {}; check the folder",
            error.strerror or error,
        ) from None
    return path


def files_of(name: str) -> list[str]:
    """The user's files of a machine given by its id or by a path; empty for a built-in or unknown
    one.
    """
    measured = calibration.named(name)
    if measured is not None:
        return [*files_of(measured.machine), *([measured.file] if is_there(measured.file) else [])]
    reference = urdf_reference.reference(name)
    candidates = [
        name if reference is None else reference.file,
        *(os.path.join(folder, f"{name}.json") for folder in folders()),
    ]
    return [path for path in candidates if is_there(path)][:1]
