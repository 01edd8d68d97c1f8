# SPDX-License-Identifier: LGPL-2.1-or-later
"""Brings a job's part into a document; of an FCStd part, sets properties first and recomputes it."""

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


def bring(document: Any, part: PartSource, key: str = "part", meshes: bool = False) -> Any:
    """The part, or what else the job's section `key` names, as an object of the document. meshes: the part may be one.

    Raises the InputErrors of `api.open_part`, NO_OBJECT and BAD_VALUE.
    """
    if key == "part" and not meshes and part.file.lower().endswith(MESHES):
        raise _no_surfaces()
    obj = _opened(document, part, key)
    if key == "part" and not meshes and getattr(obj, "Mesh", None) is not None:
        raise _no_surfaces()
    return _only_solids(obj, part, key)


def _no_surfaces() -> InputError:
    return InputError(
        "UNSUPPORTED_FILE",
        "part.file",
        "a mesh has no exact surfaces; give a part of this family as STEP, IGES, "
        "BREP or FCStd; a mesh may be the substrate, or a fixture",
    )


def _opened(document: Any, part: PartSource, key: str) -> Any:
    if not part.settings:
        return api.open_part(document, part.file, part.object or "", part.scale)
    shape, label, issues = changed_part(
        part.file,
        part.object or "",
        functools.partial(_change, part=part, section=key),
        f"{key}.set",
        PATIENCE,
    )
    return add_part(document, shape, label, issues)


def _only_solids(obj: Any, part: PartSource, key: str) -> Any:
    """The object, with those solids alone that are named. InputError BAD_VALUE for one that there is not."""
    if not part.solids:
        return obj
    if getattr(obj, "Mesh", None) is not None:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} is a mesh, which has no solids; leave them out",
            obj.Label,
        )
    solids = obj.Shape.Solids
    numbers = [int(name.removeprefix("Solid")) for name in part.solids]
    wrong = [name for name, number in zip(part.solids, numbers) if number > len(solids)]
    if wrong:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} has {} solid(s), and no {}; name others",
            obj.Label,
            len(solids),
            ", ".join(wrong),
        )
    obj.Shape = solids_of(obj.Shape, numbers)
    obj.Label = f"{obj.Label} {', '.join(part.solids)}"
    obj.purgeTouched()
    return obj


def _change(source: Any, part: PartSource, section: str) -> list[Any]:
    """Set the properties of an open document, and build it with them; the objects that were changed.

    InputError BAD_PART, BAD_VALUE, NO_OBJECT.
    """
    changed = [_set(source, name, key, text, section) for name, key, text in part.settings]
    failed = {obj for obj in source.Objects if "Invalid" in obj.State}
    for one in linked_files.in_order(source):
        one.recompute()
    invalid = [obj.Label for obj in source.Objects if "Invalid" in obj.State and obj not in failed]
    if invalid:
        names = ", ".join(invalid)
        raise InputError(
            "BAD_PART",
            f"{section}.set",
            "with these values {} cannot be built; change them",
            names,
        )
    return changed


def _set(document: Any, name: str, key: str, text: str, section: str) -> Any:
    """Set a property of an object of the document, or of one that it links to; the object."""
    place = f"{section}.set.{name}.{key}"
    name, constraints, _ = name.partition(".Constraints")
    found: list[Any] = []
    for one in reversed(linked_files.in_order(document)):
        found = found or [obj for obj in one.Objects if obj.Name == name]
        found = found or one.getObjectsByLabel(name)
    if len(found) != 1:
        names = ", ".join(obj.Label for obj in found or document.Objects) or "none"
        message = "no object is called {!r}; the document has {}"
        if found:
            message = "{!r} is the label of several objects ({}); use the name of one of them"
            names = ", ".join(obj.Name for obj in found)
        raise InputError("NO_OBJECT", place, message, name, names)
    obj = found[0]
    try:
        if constraints:
            _set_constraint(obj, key, text, place)
        elif obj.TypeId == "Spreadsheet::Sheet" and key not in ("Label", "Label2"):
            _set_cell(obj, key, text, place)
        elif key not in obj.PropertiesList:
            near = ", ".join(sorted(obj.PropertiesList))
            message = "{} has no property {!r}; use one of {}"
            raise InputError("BAD_VALUE", place, message, name, key, near)
        else:
            # the given value replaces an expression too
            obj.setExpression(key, None)
            setattr(obj, key, _typed(getattr(obj, key), text))
    except (ValueError, TypeError, ArithmeticError, RuntimeError, IndexError, NameError):
        message = Text("{!r} does not fit this property; give a value such as it has now", text)
        raise InputError("BAD_VALUE", place, message) from None
    except AttributeError:
        message = Text("{} cannot be set here; set what it is computed from", key)
        raise InputError("BAD_VALUE", place, message) from None
    return obj


def _set_constraint(sketch: Any, name: str, text: str, place: str) -> None:
    """Set a named dimension of a sketch; an expression that drives it is removed."""
    constraints = [item for item in getattr(sketch, "Constraints", ()) if item.Name]
    if name not in [item.Name for item in constraints]:
        names = ", ".join(item.Name for item in constraints) or "none"
        message = "{} has no constraint of this name (it has {}); name it in the sketch"
        raise InputError("BAD_VALUE", place, message, sketch.Label, names)
    now = sketch.getDatum(name)
    sketch.setExpression(f"Constraints.{name}", None)
    sketch.setDatum(name, _typed(now, text))


def _set_cell(sheet: Any, key: str, text: str, place: str) -> None:
    """Set a cell of a spreadsheet by its alias or its address; its unit stays."""
    address = sheet.getCellFromAlias(key) or key
    if not CELL_ADDRESS.fullmatch(address):
        message = "{} has no cell with the alias or address {!r}; check the spreadsheet"
        raise InputError("BAD_VALUE", place, message, sheet.Label, key)
    if not sheet.getContents(address):
        message = "cell {} of {} is empty; name one that has a value"
        raise InputError("BAD_VALUE", place, message, address, sheet.Label)
    now = sheet.get(address)
    if isinstance(now, str):
        sheet.set(address, f"'{text}")
        return
    value = _typed(now if isinstance(now, App.Units.Quantity) else float(now), text)
    unit = ""
    if isinstance(value, App.Units.Quantity) and value.Unit != now.Unit:
        if now.Unit.Type not in UNIT_OF_BARE_NUMBERS:
            raise InputError("BAD_VALUE", place, "{!r} has no unit; give it with one", text)
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
