# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part files as objects of a document."""

from __future__ import annotations

from typing import Any

from ..core.geometry.curves.bead_curves import POINT_FILES
from ..core.issues import InputError
from .arguments import (
    checked_document,
    checked_number,
    checked_object,
    checked_target,
    checked_text,
    named,
)
from .steps import one_step


def open_part(doc: Any, path: str, object: str = "", scale: float = 1.0) -> Any:
    """A part file as an object of the document: STEP, IGES, BREP, an object (Name or Label) of an FCStd file; or a mesh
    (STL, OBJ, 3MF): solids on a hub, or what a wall grows on or is kept clear of; or a table of points (CSV), G-code of a
    slicer or a toolpath of AdaOne (.ada3dp), which are laid as beads.

    scale: mm of one unit of an STL or OBJ file, which do not tell it. `am.open_part(doc, "cup.step")`
    """
    checked_document(doc)
    path = checked_target(path, "path")
    checked_text(object, "object")
    scale = checked_number(scale, "scale")
    if path.lower().endswith(tuple(POINT_FILES)):
        from ..objects.table_part import open_points

        with one_step(doc, "Open part"):
            table = open_points(doc, path)
            table.purgeTouched()
        return table
    from ..objects.shapes.part_file import add_part, part_content

    shape, label, issues = part_content(path, object, scale)
    with one_step(doc, "Open part"):
        part = add_part(doc, shape, label, issues)
        if hasattr(shape, "Topology"):
            part.addProperty(
                "App::PropertyLength", "FileScale", "Part", "Length of one unit of the file.", 1
            )
            part.FileScale = scale
        part.purgeTouched()
    return part


def array_element(array: Any, index: int) -> Any:
    """An element of a link array as an object that stages can be made of, numbered from 0 as in FreeCAD's selection.

    It is the element itself where FreeCAD shows elements as objects (`ShowElement`, of Draft `ExpandArray`), else a hidden
    link to it beside the array. `am.make_solid_feature(doc, am.array_element(doc.Array, 1))`
    """
    from ..objects.shapes.array_elements import object_of

    checked_object(array, "array")
    if isinstance(index, bool) or not isinstance(index, int):
        raise InputError(
            "BAD_INPUT", "index", "{} is not a whole number; give one such as 1", named(index)
        )
    with one_step(array.Document, "Element of array"):
        return object_of(array, index)
