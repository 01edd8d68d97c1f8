# SPDX-License-Identifier: LGPL-2.1-or-later
"""Brings a job's part into a document; for an FCStd part, sets properties first and recomputes it."""

from __future__ import annotations

import functools
import re
from typing import Any

import FreeCAD as App

from freecad_am import api
from freecad_am.brep.shapes.chosen import solids_of
from freecad_am.core.geometry.mesh.file_unit import MESHES
from freecad_am.core.issues import InputError, Text
from freecad_am.objects.shapes import linked_files
from freecad_am.objects.shapes.part_file import add_part, changed_part

from .part_source import PartSource

PATIENCE = 100.0  # times as long as reading a document may take; building a part of other values may be long work
CELL_ADDRESS = re.compile("[A-Z]{1,2}[1-9][0-9]*")  # of a spreadsheet
UNIT_OF_BARE_NUMBERS = {"Length": "mm", "Angle": "deg"}  # in a cell that has a unit


def bring(document: Any, source: PartSource, key: str = "part", meshes: bool = False) -> Any:
    """The part, or another source named by the job's section `key`, as an object of the document.
    meshes: the part may be one.

    Raises the InputErrors of `api.open_part`, NO_OBJECT and BAD_VALUE.
    """
    if key == "part" and not meshes and source.file.lower().endswith(MESHES):
        raise _no_surfaces()
    obj = _opened(document, source, key)
    if key == "part" and not meshes and getattr(obj, "Mesh", None) is not None:
        raise _no_surfaces()
    return _only_solids(obj, source, key)


def _no_surfaces() -> InputError:
    return InputError(
        "UNSUPPORTED_FILE",
        "part.file",
        "a mesh has no exact surfaces; for this strategy use STEP, IGES, BREP or FCStd; a mesh "
        "can serve as substrate or fixture",
    )


def _opened(document: Any, source: PartSource, key: str) -> Any:
    if not source.settings:
        return api.open_part(document, source.file, source.object or "", source.scale)
    shape, label, issues = changed_part(
        source.file,
        source.object or "",
        functools.partial(_change, part=source, section=key),
        f"{key}.set",
        PATIENCE,
    )
    return add_part(document, shape, label, issues)


def _only_solids(obj: Any, source: PartSource, key: str) -> Any:
    """The object, with only its named solids. InputError BAD_VALUE for a missing one."""
    if not source.solids:
        return obj
    if getattr(obj, "Mesh", None) is not None:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} is a mesh without solids; remove `solids`",
            obj.Label,
        )
    solids = obj.Shape.Solids
    numbers = [int(name.removeprefix("Solid")) for name in source.solids]
    wrong = [name for name, number in zip(source.solids, numbers) if number > len(solids)]
    if wrong:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} has {} solid(s), but no {}; choose others",
            obj.Label,
            len(solids),
            ", ".join(wrong),
        )
    obj.Shape = solids_of(obj.Shape, numbers)
    obj.Label = f"{obj.Label} {', '.join(source.solids)}"
    obj.purgeTouched()
    return obj


def _change(source: Any, part: PartSource, section: str) -> list[Any]:
    """Set the properties of an open document, and build it with them; the objects that were changed.

    InputError BAD_PART, BAD_VALUE, NO_OBJECT.
    """
    changed = [_set(source, name, key, text, section) for name, key, text in part.settings]
    failed = {obj for obj in source.Objects if "Invalid" in obj.State}
    for linked_document in linked_files.in_order(source):
        linked_document.recompute()
    invalid = [obj.Label for obj in source.Objects if "Invalid" in obj.State and obj not in failed]
    if invalid:
        names = ", ".join(invalid)
        raise InputError(
            "BAD_PART",
            f"{section}.set",
            "{} cannot be built with these values; change them",
            names,
        )
    return changed


def _set(document: Any, name: str, key: str, text: str, section: str) -> Any:
    """Set a property of an object of the document, or of one that it links to; the object."""
    where = f"{section}.set.{name}.{key}"
    name, constraints, _ = name.partition(".Constraints")
    matches: list[Any] = []
    for linked_document in reversed(linked_files.in_order(document)):
        matches = matches or [obj for obj in linked_document.Objects if obj.Name == name]
        matches = matches or linked_document.getObjectsByLabel(name)
    if len(matches) != 1:
        names = ", ".join(obj.Label for obj in matches or document.Objects) or "none"
        message = "no object is called {!r}; the document has {}"
        if matches:
            message = "{!r} is the label of several objects ({}); use the name of one"
            names = ", ".join(obj.Name for obj in matches)
        raise InputError("NO_OBJECT", where, message, name, names)
    obj = matches[0]
    try:
        if constraints:
            _set_constraint(obj, key, text, where)
        elif obj.TypeId == "Spreadsheet::Sheet" and key not in ("Label", "Label2"):
            _set_cell(obj, key, text, where)
        elif key not in obj.PropertiesList:
            property_names = ", ".join(sorted(obj.PropertiesList))
            message = "{} has no property {!r}; use one of {}"
            raise InputError("BAD_VALUE", where, message, name, key, property_names)
        else:
            # the given value replaces an expression too
            obj.setExpression(key, None)
            setattr(obj, key, _typed(getattr(obj, key), text))
    except (ValueError, TypeError, ArithmeticError, RuntimeError, IndexError, NameError):
        message = Text(
            "{!r} does not fit this property; give a value of the same type as its current one",
            text,
        )
        raise InputError("BAD_VALUE", where, message) from None
    except AttributeError:
        message = Text("{} is computed and cannot be set here; set its inputs", key)
        raise InputError("BAD_VALUE", where, message) from None
    return obj


def _set_constraint(sketch: Any, name: str, text: str, where: str) -> None:
    """Set a named dimension of a sketch; an expression that drives it is removed."""
    constraints = [item for item in getattr(sketch, "Constraints", ()) if item.Name]
    if name not in [item.Name for item in constraints]:
        names = ", ".join(item.Name for item in constraints) or "none"
        message = "{} has no constraint with this name (it has {}); name it in the sketch"
        raise InputError("BAD_VALUE", where, message, sketch.Label, names)
    now = sketch.getDatum(name)
    sketch.setExpression(f"Constraints.{name}", None)
    sketch.setDatum(name, _typed(now, text))


def _set_cell(sheet: Any, key: str, text: str, where: str) -> None:
    """Set a cell of a spreadsheet by its alias or its address; its unit stays."""
    address = sheet.getCellFromAlias(key) or key
    if not CELL_ADDRESS.fullmatch(address):
        message = "{} has no cell with the alias or address {!r}; check the spreadsheet"
        raise InputError("BAD_VALUE", where, message, sheet.Label, key)
    if not sheet.getContents(address):
        message = "cell {} of {} is empty; name one that has a value"
        raise InputError("BAD_VALUE", where, message, address, sheet.Label)
    now = sheet.get(address)
    if isinstance(now, str):
        sheet.set(address, f"'{text}")
        return
    value = _typed(now if isinstance(now, App.Units.Quantity) else float(now), text)
    unit = ""
    if isinstance(value, App.Units.Quantity) and value.Unit != now.Unit:
        if now.Unit.Type not in UNIT_OF_BARE_NUMBERS:
            raise InputError("BAD_VALUE", where, "{!r} has no unit; add one", text)
        unit = UNIT_OF_BARE_NUMBERS[now.Unit.Type]
    sheet.set(address, f"={text} {unit}")


def _typed(now: Any, text: str) -> Any:
    """The text as a value of the kind that the property has now."""
    if "," in text and not isinstance(now, str):
        raise ValueError(text)
    if isinstance(now, App.Units.Quantity):
        quantity = App.Units.Quantity(text)
        if quantity.Unit != now.Unit and quantity.Unit != App.Units.Unit():
            raise ValueError(text)
        return quantity
    if isinstance(now, bool):
        if text not in ("true", "false"):
            raise ValueError(text)
        return text == "true"
    if isinstance(now, int):
        return int(text)
    return float(text) if isinstance(now, float) else text
