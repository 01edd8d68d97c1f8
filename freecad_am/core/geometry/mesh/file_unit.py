# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of triangle files; STL and OBJ formats do not define a unit."""

from __future__ import annotations

import math
import os
import re

from ...issues import WARNING, InputError, Issue, Text

UNITLESS_ENDINGS = (".stl", ".obj")
MESHES = (*UNITLESS_ENDINGS, ".3mf")
HEAD = 4096  # bytes at the start of a file to search for a remark
_STATED = re.compile(r"\bunits?\b[\s:=\"']*(?:(?:is|are)\s+)?(?:in\s+)?([a-zµμ]+)", re.IGNORECASE)
_LENGTHS = {  # mm
    "mm": 1.0,
    "millimeter": 1.0,
    "cm": 10.0,
    "centimeter": 10.0,
    "m": 1000.0,
    "meter": 1000.0,
    "um": 0.001,
    "µm": 0.001,
    "μm": 0.001,
    "micron": 0.001,
    "in": 25.4,
    "inch": 25.4,
    "ft": 304.8,
    "foot": 304.8,
    "feet": 304.8,
}


def stated_unit(data: bytes, suffix: str) -> tuple[str, float] | None:
    """Return the unit stated in a remark of a file.

    Parameters
    ----------
    data : bytes
        Content of the file.
    suffix : str
        '.obj' or '.stl'.

    Returns
    -------
    tuple of (str, float) or None
        Name of the unit and length in mm; None without a remark.
    """
    head = data[:HEAD].decode("latin-1")
    if suffix == ".obj":
        lines = [line for line in head.splitlines() if line.lstrip().startswith("#")]
    else:
        lines = [head[:80].splitlines()[0]] if head else []
    for line in lines:
        for found in _STATED.finditer(line):
            name = found[1].lower().replace("metre", "meter")
            for form in (name, name.removesuffix("s"), name.removesuffix("es")):
                if form in _LENGTHS:
                    return found[1], _LENGTHS[form]
    return None


def unit_issues(data: bytes, suffix: str, scale: float, where: str) -> tuple[Issue, ...]:
    """Return a warning if a file states a unit other than mm.

    Parameters
    ----------
    data : bytes
        Content of the file.
    suffix : str
        '.obj' or '.stl'.
    scale : float
        User-defined length of one file unit, mm; 1 if not set.
    where : str
        Name of the file, for messages.

    Returns
    -------
    tuple of Issue
        One warning or none; none if a scale is set.
    """
    stated = stated_unit(data, suffix)
    if stated is None or scale != 1.0:
        return ()
    name, length = stated
    if length == 1.0:
        return ()
    message = Text(
        "{} states the unit {!r}, but is read in mm; set part.scale to {:g} mm if the unit is "
        "right",
        where,
        name,
        length,
    )
    return (Issue(WARNING, "FILE_CONTENT", message),)


def refuse_scale(scale: float, path: str, key: str) -> None:
    """Reject a scale that is not a length, or a scale for a format with its own unit.

    Parameters
    ----------
    scale : float
        Length of one file unit, mm.
    path : str
        Path of the file; the ending shows whether the format defines a unit.
    key : str
        Key of the scale, for messages.

    Raises
    ------
    InputError
        BAD_VALUE that names `key`.
    """
    if not (math.isfinite(scale) and scale > 0.0):
        raise InputError(
            "BAD_VALUE",
            key,
            "{:g} mm is not a unit; give the length of one unit of the file, such as 25.4 mm",
            scale,
        )
    if scale != 1.0 and not path.lower().endswith(UNITLESS_ENDINGS):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} states a unit; remove the scale, which is for STL and OBJ",
            os.path.basename(path),
        )
