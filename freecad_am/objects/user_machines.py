# SPDX-License-Identifier: LGPL-2.1-or-later
"""Folders of user-defined machine files.

Machine files are in RoboticAM/machines of FreeCAD's user data folder, and in the window also in the
folder set in the preferences.
"""

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
    """Return the existing folders of user-defined machine files.

    For a job from another computer, return the folders listed in the job's relocation.
    """
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
    """Write a machine file for an id and return its path. The write is atomic.

    Raises InputError NOT_WRITTEN if the file cannot be written or the id is taken.
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
            "the file cannot be written: {}; check the folder",
            error.strerror or error,
        ) from None
    return path


def files_of(name: str) -> list[str]:
    """Return the user-defined files of a machine, given by id or path.

    Empty for a built-in or unknown machine.
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
