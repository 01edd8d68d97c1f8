# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether faces that a feature names are still those that were chosen: FreeCAD numbers them anew when a part changes."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from ...core.issues import WARNING, AmError, InputError, Issue, Text
from ..fields.properties import HIDDEN, OUTPUT
from ..stage import Stage
from ..stage_parts import Outcome
from ..staleness import UP_TO_DATE
from .bodies import shape_of

CODE = "FACES_CHANGED"
TOLERANCE = 1e-6  # of the part's size, squared of its area: by how much a face may have moved, or grown, and be the same
SURFACES = {
    "Part::GeomPlane": Text("a plane"), "Part::GeomCylinder": Text("a cylinder"), "Part::GeomCone": Text("a cone"),
    "Part::GeomSphere": Text("a sphere"), "Part::GeomToroid": Text("a torus"),
}
FREE_FORM = Text("a free-form surface")


class Mark(NamedTuple):
    """What a face is known by: its surface, and area (mm2) and middle (mm) where its part places itself."""

    name: str
    surface: str
    area: float
    middle: tuple[float, float, float]

    def text(self) -> str:
        """As it is stored."""
        return " ".join((self.name, self.surface, *(repr(value) for value in (self.area, *self.middle))))

    def is_same(self, other: Mark, size: float) -> bool:
        """Whether two are of one face of a part of a size (mm)."""
        near = float(np.abs(np.subtract(self.middle, other.middle)).max()) <= TOLERANCE * size
        return self.surface == other.surface and near and abs(self.area - other.area) <= TOLERANCE * size**2


class FaceStage(Stage):
    """Base of the features that are made for some faces of a shape."""

    def complete(self, obj: Any) -> None:
        """With the marks of the faces as they were when they were chosen."""
        super().complete(obj)
        if "ChosenFaces" not in obj.PropertiesList:
            help = "The faces as they were chosen."
            obj.addProperty("App::PropertyStringList", "ChosenFaces", "Result", help, HIDDEN | OUTPUT)
            if obj.Status == UP_TO_DATE:  # a document from before this was kept
                obj.ChosenFaces = [mark.text() for mark in _marks(obj)]

    def onChanged(self, obj: Any, name: str) -> None:
        """Other faces are what they are when they are chosen. FreeCAD 1.0 and later tell of a change also where the part was
        changed and the names of its faces stay."""
        document = obj.Document
        by_hand = not (document is None or document.Restoring or document.Transacting or document.Recomputing)
        asked = name == "Source" and by_hand and "ChosenFaces" in obj.PropertiesList
        if asked and {_read(text).name for text in obj.ChosenFaces} != {mark.name for mark in _marks(obj)}:
            self.confirm(obj)
        super().onChanged(obj, name)

    def confirm(self, obj: Any) -> None:
        """The faces that are named are meant, as they are now."""
        obj.ChosenFaces = []

    def renew(self, obj: Any, force: bool = False) -> Any:
        """As any stage; anew where faces were confirmed that it warned about."""
        return super().renew(obj, force or (not obj.ChosenFaces and is_warned(obj)))

    def _store(self, obj: Any, outcome: Outcome, *packed: Any) -> None:
        issues = _compared(obj)
        if not issues:
            obj.ChosenFaces = [mark.text() for mark in _marks(obj)]
        super()._store(obj, dataclasses.replace(outcome, issues=(*issues, *outcome.issues)), *packed)


def is_warned(obj: Any) -> bool:
    """Whether an object is a feature whose faces are no longer those that were chosen."""
    return isinstance(getattr(obj, "Proxy", None), FaceStage) and f'"{CODE}"' in obj.Issues


def _marks(obj: Any) -> list[Mark]:
    """Of the faces that a feature names, as they are; none where it names none, or what it names is not there."""
    try:
        source, names = source_of(obj)
        shape = shape_of(source) if names else None
    except AmError:
        return []
    return [] if shape is None else [mark for mark in _marks_of(shape) if mark.name in names]


def _marks_of(shape: Any) -> list[Mark]:
    back = shape.Placement.inverse()
    return [
        Mark(f"Face{number}", face.Surface.TypeId, face.Area, tuple(back.multVec(face.CenterOfMass)))
        for number, face in enumerate(shape.Faces, start=1)
    ]


def _compared(obj: Any) -> tuple[Issue, ...]:
    """What is wrong with the faces that a feature names, by what they were when they were chosen."""
    before, now = [_read(text) for text in obj.ChosenFaces], {mark.name: mark for mark in _marks(obj)}
    if not now or {mark.name for mark in before} != now.keys():
        return ()
    shape, label = shape_of(obj.Source[0]), obj.Source[0].Label
    size = shape.BoundBox.DiagonalLength
    others = [mark for mark in before if not mark.is_same(now[mark.name], size)]
    every = [mark for mark in _marks_of(shape) if mark.name not in now] if others else []
    for mark in others:
        found = next((one.name for one in every if mark.is_same(one, size)), None)
        if found is not None:
            return (_issue(Text(
                "{} of {} is not the face that was chosen, which is {} now: FreeCAD numbers faces anew when a part changes; "
                "choose the faces again, or confirm them by OK in the panel", mark.name, label, found,
            )),)
    for mark in others:
        if mark.surface != now[mark.name].surface:
            return (_issue(Text(
                "{} of {} was {} when it was chosen and is {} now, maybe another face, as FreeCAD numbers faces anew when a "
                "part changes; choose the faces again, or confirm them by OK in the panel", mark.name, label,
                SURFACES.get(mark.surface, FREE_FORM), SURFACES.get(now[mark.name].surface, FREE_FORM),
            )),)
    return ()


def _issue(message: str) -> Issue:
    return Issue(WARNING, CODE, message)


def _read(text: str) -> Mark:
    name, surface, *values = text.split(" ")
    area, x, y, z = map(float, values)
    return Mark(name, surface, area, (x, y, z))


def source_of(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """The object of a feature's Source and the names of the faces chosen. InputError 'NO_INPUT', 'BAD_FACES'."""
    if not obj.Source:
        raise InputError("NO_INPUT", obj.Label, "Source is missing; choose the shape to deposit, or some of its faces")
    source, names = obj.Source
    faces = tuple(name for name in names if name)
    wrong = [name for name in faces if not name.rsplit(".", maxsplit=1)[-1].startswith("Face")]
    if wrong:
        named = ", ".join(wrong)
        raise InputError("BAD_FACES", f"{obj.Label}.Source", "{} is not a face; choose faces or the whole shape", named)
    return source, tuple(name.rsplit(".", maxsplit=1)[-1] for name in faces)
