# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point files as document objects: point tables (CSV), slicer G-code and AdaOne toolpaths.

The object shows the curves and stores the file content for planning.
"""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import Part

from ..core.geometry.curves import ada3dp, bead_curves, gcode, gcode_roles
from ..core.geometry.curves.bead_curves import POINT_FILES, ReadCurves
from ..core.geometry.job_files import read_content
from ..core.issues import InputError, Word

CSV, GCODE, ADA = "csv", "gcode", "ada3dp"
_PROPERTY, _FORM = "Table", "TableForm"
_MAX_FILE_MB = 200  # MB
_DRAWN = 0.1  # mm; chord error of displayed arcs


@dataclass(frozen=True)
class Points:
    """Content of a point file.

    form: CSV, GCODE or ADA. text: the file text; for ADA, the bytes as base64.
    """

    form: str
    text: str

    def read(self, label: str, chord_error: float, roles: str, rotary: str) -> ReadCurves:
        """Return the beads, with arcs within the chord error (mm), and issues on ignored content.

        roles, rotary: as in `gcode.read`. Raises InputError BAD_TABLE, BAD_GCODE or BAD_ADA3DP;
        BAD_VALUE for missing roles; NOT_USED if roles or rotary are set for other files.
        """
        if self.form == GCODE:
            return gcode.read(self.text, label, chord_error, roles, rotary)
        if self.form == ADA:
            refuse_gcode_keys(label, gcode_roles.PART, rotary)
            return ada3dp.read(base64.b64decode(self.text), label, roles)
        refuse_gcode_keys(label, roles, rotary)
        return ReadCurves(bead_curves.curves_of(self.text, label))


def open_points(document: Any, path: str) -> Any:
    """Open a point file as an object.

    Raises InputError NO_FILE, BAD_FILE, and the errors of `Points.read`.
    """
    name = os.path.basename(path)
    content = _read(path, name, POINT_FILES[os.path.splitext(name)[1].lower()])
    curves = content.read(name, _DRAWN, gcode_roles.ALL, gcode.ANY_ROTARY).curves
    table_object = document.addObject("Part::Feature", "Table")
    table_object.Label = os.path.splitext(name)[0]
    table_object.addProperty(
        "App::PropertyStringList", _PROPERTY, "Table", "The points read from the file.", 1
    )
    setattr(table_object, _PROPERTY, content.text.splitlines())
    if content.form != CSV:
        table_object.addProperty("App::PropertyString", _FORM, "Table", "Type of the file.", 1)
        setattr(table_object, _FORM, content.form)
    table_object.Shape = Part.Compound(
        [Part.makePolygon([App.Vector(*row) for row in curve.points.tolist()]) for curve in curves]
    )
    return table_object


def refuse_gcode_keys(label: str, roles: str, rotary: str) -> None:
    """Raise InputError NOT_USED if G-code keys are set for another file type."""
    defaults = {
        "strategy.roles": (roles, (gcode_roles.PART, gcode_roles.ALL)),
        "strategy.rotary": (rotary, (gcode.NO_ROTARY, gcode.ANY_ROTARY)),
    }
    for key, (value, allowed) in defaults.items():
        if value not in allowed:
            raise InputError(
                "NOT_USED",
                key,
                "{!r} is for G-code, but {} is not G-code; remove the setting",
                value,
                label,
            )


def _read(path: str, name: str, form: str) -> Points:
    try:
        data = read_content(path, _MAX_FILE_MB, "BAD_FILE", name)
        if form == GCODE:  # commands are ASCII; comments may be in any encoding
            return Points(form, data.decode(errors="replace"))
        return Points(form, base64.encodebytes(data).decode() if form == ADA else data.decode())
    except UnicodeDecodeError:
        raise InputError(
            "BAD_FILE", name, "the file is not text; give {}", Word("a table of points as CSV")
        ) from None
    except OSError as error:
        raise InputError(
            "NO_FILE", name, "the file cannot be read: {}; choose another file", error.strerror
        ) from None


def points_of(source: Any) -> Points | None:
    """Return the point file content stored in an object; None for any other object."""
    lines = getattr(source, _PROPERTY, None)
    if not isinstance(lines, list) or not lines:
        return None
    return Points(getattr(source, _FORM, CSV), "\n".join(lines))
