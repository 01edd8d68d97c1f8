# SPDX-License-Identifier: LGPL-2.1-or-later
"""A file of points as an object of the document: its curves to be seen, and what the file says to be planned. Tables of
points (CSV), G-code of a slicer, toolpaths of AdaOne."""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import Part

from ..core.geometry.curves import ada3dp, curve_table, gcode
from ..core.geometry.curves.bead_curves import POINT_FILES, BeadCurve
from ..core.geometry.file_content import content
from ..core.issues import InputError, Word

CSV, GCODE, ADA = "csv", "gcode", "ada3dp"
_PROPERTY, _FORM = "Table", "TableForm"
_LARGEST = 200  # MB
_DRAWN = 0.1  # mm, chord error of arcs as they are seen


@dataclass(frozen=True)
class Points:
    """What a file of points says: its form, CSV, GCODE or ADA, and its text; of ADA the bytes as base64."""

    form: str
    text: str

    def curves(self, label: str, chord_error: float) -> tuple[BeadCurve, ...]:
        """Its beads, arcs within the chord error (mm). InputError BAD_TABLE, BAD_GCODE, BAD_ADA3DP."""
        if self.form == GCODE:
            return gcode.curves_of(self.text, label, chord_error)
        if self.form == ADA:
            return ada3dp.curves_of(base64.b64decode(self.text), label)
        return curve_table.curves_of(self.text, label)


def open_points(document: Any, path: str) -> Any:
    """A file of points as an object. InputError NO_FILE, BAD_FILE, and those of `Points.curves`."""
    name = os.path.basename(path)
    found = _read(path, name, POINT_FILES[os.path.splitext(name)[1].lower()])
    curves = found.curves(name, _DRAWN)
    part = document.addObject("Part::Feature", "Table")
    part.Label = os.path.splitext(name)[0]
    part.addProperty(
        "App::PropertyStringList", _PROPERTY, "Table", "The points as they were read.", 1
    )
    setattr(part, _PROPERTY, found.text.splitlines())
    if found.form != CSV:
        part.addProperty("App::PropertyString", _FORM, "Table", "What the file is.", 1)
        setattr(part, _FORM, found.form)
    part.Shape = Part.Compound(
        [Part.makePolygon([App.Vector(*row) for row in one.points.tolist()]) for one in curves]
    )
    return part


def _read(path: str, name: str, form: str) -> Points:
    try:
        data = content(path, _LARGEST, "BAD_FILE", name)
        return Points(form, base64.encodebytes(data).decode() if form == ADA else data.decode())
    except UnicodeDecodeError:
        what = "G-code" if form == GCODE else "a table of points as CSV"
        raise InputError("BAD_FILE", name, "it is not text; give {}", Word(what)) from None
    except OSError as error:
        raise InputError(
            "NO_FILE", name, "it cannot be read: {}; choose a file that can", error.strerror
        ) from None


def points_of(source: Any) -> Points | None:
    """What the file said that an object was made of; None for any other."""
    lines = getattr(source, _PROPERTY, None)
    if not isinstance(lines, list) or not lines:
        return None
    return Points(getattr(source, _FORM, CSV), "\n".join(lines))
