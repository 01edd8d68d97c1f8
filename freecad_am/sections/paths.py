# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of files in job files and cell files: which keys have them, and where they are. Made absolute once, as a file is
read, so that nothing after that has to know where it came from."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from ..core.geometry.job_files import expanded, is_there, locate
from ..core.kinematics.machines import calibration
from ..core.kinematics.urdf import reference as urdf_reference
from ..core.parameters.records import NONE
from ..core.process import wire

ANY_INDEX = "[]"
FEATURES = "features"
OF_FEATURE = (
    ("part", "file"),
    ("substrate", "file"),
    ("substrate", "scan"),
    ("fixtures", ANY_INDEX, "file"),
    ("strategy", "guide", "file"),
)


def folder_of(path: str) -> str:
    """The folder of a job file or cell file, absolute; where relative paths in it start."""
    return os.path.dirname(os.path.abspath(path))


def absolute(file: str, folder: str) -> str:
    """`file` as an absolute path; relative ones start at the absolute `folder`."""
    path = os.path.normpath(os.path.join(folder, expanded(file)))
    locate(path)  # notifies whoever collects the files of a job
    return path


def resolve_job(values: dict[str, Any], folder: str) -> dict[str, Any]:
    """The values of a job file in `folder` with absolute names of all files but those of the cell, which has files of its
    own; what is no name of a file stays as it is."""
    resolve = partial(absolute, folder=folder)
    for feature in ((), (FEATURES, ANY_INDEX)):
        for keys in OF_FEATURE:
            values = _changed(values, (*feature, *keys), resolve)
        values = _changed(values, (*feature, "process", "bead_model"), partial(_table, resolve))
        values = _changed(values, (*feature, "process", "material"), partial(_material, resolve))
    return _changed(values, ("settings", ANY_INDEX, "where", "inside", "file"), resolve)


def resolve_cell(section: Any, folder: str) -> Any:
    """The section `cell` of a file in `folder` with absolute names of files; where it names a cell file, that name."""

    def resolve(file: str) -> str:
        return absolute(file.strip(), folder)

    machine = partial(_machine, resolve)
    section = _changed(section, (), resolve)
    for keys in (("machine",), ("external", ANY_INDEX, "machine")):
        section = _changed(
            _changed(section, keys, machine), keys, partial(_described, resolve, machine), dict
        )
    section = _changed(section, ("obstacles", ANY_INDEX, "file"), resolve)
    section = _changed(
        section, ("nozzle", "shape"), lambda shape: shape if shape == NONE else resolve(shape)
    )
    return _changed(section, ("nozzle", "shape", "file"), resolve)


def _changed(
    value: Any, keys: tuple[str, ...], change: Callable[[Any], Any], kind: type = str
) -> Any:
    """A value with another one at these keys, where there is one of the kind and not empty; the value itself stays."""
    if not keys:
        return (
            change(value)
            if isinstance(value, kind) and (value.strip() if isinstance(value, str) else value)
            else value
        )
    key, further = keys[0], keys[1:]
    if key == ANY_INDEX:
        return (
            [_changed(entry, further, change, kind) for entry in value]
            if isinstance(value, list)
            else value
        )
    if not isinstance(value, dict) or key not in value:
        return value
    return {**value, key: _changed(value[key], further, change, kind)}


def _table(resolve: Callable[[str], str], name: str) -> str:
    """Resolve the path of a bead table that is not built in."""
    return name if name in ("none", *wire.BUILT_IN) else resolve(name)


def _material(resolve: Callable[[str], str], name: str) -> str:
    """The file of a material if there is one, else its name."""
    path = resolve(name.strip())
    return path if is_there(path) else name


def _machine(resolve: Callable[[str], str], text: str) -> str:
    """The text of a machine: its id, its machine file, a URDF with the links meant, or one of these and a calibration."""
    measured = calibration.named(text)
    if measured is not None:
        return str(calibration.Named(_machine(resolve, measured.machine), resolve(measured.file)))
    reference = urdf_reference.reference(text)
    if reference is not None:
        return str(replace(reference, file=resolve(reference.file)))
    return resolve(text) if os.sep in text or text.lower().endswith(".json") else text


def _described(
    resolve: Callable[[str], str], machine: Callable[[str], str], section: dict[str, Any]
) -> dict[str, Any]:
    """The same of a machine that is a section of its own."""
    section = _changed(_changed(section, ("name",), machine), ("calibration",), resolve)
    return _changed(section, ("file",), partial(_urdf, resolve))


def _urdf(resolve: Callable[[str], str], file: str) -> str:
    """The file of a URDF; other texts, which are refused, stay as they are."""
    reference = urdf_reference.reference(file)
    return resolve(file) if reference is not None and reference.file == file.strip() else file
