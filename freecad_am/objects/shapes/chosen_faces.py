# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether faces that a feature names are still those that were chosen: FreeCAD numbers them anew when a part changes."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import FreeCAD as App
import numpy as np
import Part

from ...core.issues import WARNING, AmError, InputError, Issue, Text
from ..fields.properties import HIDDEN, OUTPUT
from ..stage import Stage
from ..stage_parts import Outcome
from ..staleness import UP_TO_DATE
from .bodies import shape_of

CODE = "FACES_CHANGED"
PLANE, TURNED = "Part::GeomPlane", ("Part::GeomCylinder", "Part::GeomCone", "Part::GeomToroid")
LEANS = np.radians(1.0)  # by which a face may turn and be the same
WHOLE = "Shape"  # the name of what is stored of the whole part
TOLERANCE = 1e-6  # of the part's size, squared of its area: by how much a face may have moved, or grown, and be the same
SURFACES = {
    PLANE: Text("a plane"), "Part::GeomCylinder": Text("a cylinder"), "Part::GeomCone": Text("a cone"),
    "Part::GeomSphere": Text("a sphere"), "Part::GeomToroid": Text("a torus"),
}
FREE_FORM = Text("a free-form surface")


class Mark(NamedTuple):
    """What a face, or with no surface a whole part, is known by where the part places itself: its surface, the way that a
    plane faces or the line that another one turns about (0 for others), area (mm2) and middle (mm)."""

    name: str
    surface: str
    way: tuple[float, float, float]
    area: float
    middle: tuple[float, float, float]

    def text(self) -> str:
        """As it is stored."""
        return " ".join((self.name, self.surface, *(repr(value) for value in (*self.way, self.area, *self.middle))))

    def is_same(self, other: Mark, size: float) -> bool:
        """Whether nothing changed, of a part of a size (mm)."""
        near = float(np.abs(np.subtract(self.middle, other.middle)).max()) <= TOLERANCE * size
        return self.is_alike(other) and near and abs(self.area - other.area) <= TOLERANCE * size**2

    def is_alike(self, other: Mark) -> bool:
        """Whether a face is of the same kind of surface and lies the same way, as a part that grows leaves it."""
        along = float(np.dot(self.way, other.way))
        lies = not any(self.way) or (along if self.surface == PLANE else abs(along)) > np.cos(LEANS)
        return self.surface == other.surface and lies


class FaceStage(Stage):
    """Base of the features that are made for some faces of a shape."""

    def complete(self, obj: Any) -> None:
        """With the marks of the faces as they were when they were chosen."""
        super().complete(obj)
        if "ChosenFaces" not in obj.PropertiesList:
            help = "The faces as they were chosen."
            obj.addProperty("App::PropertyStringList", "ChosenFaces", "Result", help, HIDDEN | OUTPUT)
            if obj.Status == UP_TO_DATE:  # a document from before this was kept
                obj.ChosenFaces = _texts(obj, _marks(obj))

    def onChanged(self, obj: Any, name: str) -> None:
        """Other faces are what they are when they are chosen. FreeCAD 1.0 and later tell of a change also where the part was
        changed and the names of its faces stay."""
        document = obj.Document
        by_hand = not (document is None or document.Restoring or document.Transacting or document.Recomputing)
        asked = name == "Source" and by_hand and "ChosenFaces" in obj.PropertiesList
        if asked and _named(obj) not in (None, _stored(obj).keys() - {WHOLE}):
            self.confirm(obj)
        super().onChanged(obj, name)

    def confirm(self, obj: Any) -> None:
        """The faces that are named are meant, as they are now."""
        obj.ChosenFaces = []

    def renew(self, obj: Any, force: bool = False) -> Any:
        """As any stage; anew where faces were confirmed that it warned about."""
        return super().renew(obj, force or (not obj.ChosenFaces and is_warned(obj)))

    def _store(self, obj: Any, outcome: Outcome, *packed: Any) -> None:
        marks = _marks(obj)
        issues = _compared(obj, marks)
        if not issues:
            obj.ChosenFaces = _texts(obj, marks)
        super()._store(obj, dataclasses.replace(outcome, issues=(*issues, *outcome.issues)), *packed)


def is_warned(obj: Any) -> bool:
    """Whether an object is a feature whose faces are no longer those that were chosen."""
    return isinstance(getattr(obj, "Proxy", None), FaceStage) and f'"{CODE}"' in obj.Issues


def _named(obj: Any) -> set[str] | None:
    """The names of the faces of a feature, whether these are there or not; None where its source is missing."""
    try:
        return set(source_of(obj)[1])
    except AmError:
        return None


def _stored(obj: Any) -> dict[str, Mark]:
    """What is stored of the faces, and of the whole, by name."""
    return {mark.name: mark for mark in map(_read, obj.ChosenFaces) if mark is not None}


def _texts(obj: Any, marks: list[Mark]) -> list[str]:
    """What is stored of the faces that a feature names, as they are, and of the whole; nothing where it names none."""
    return [mark.text() for mark in (*marks, _whole(shape_of(obj.Source[0])))] if marks else []


def _marks(obj: Any) -> list[Mark]:
    """Of the faces that a feature names, as they are; none where it names none, or what it names is not there."""
    try:
        source, names = source_of(obj)
        shape = shape_of(source) if names else None
    except AmError:
        return []
    return [] if shape is None else _marks_of(shape, set(names))


def _marks_of(shape: Any, names: set[str]) -> list[Mark]:
    """Of the faces of these names; of all others with none."""
    place, named = shape.Placement.inverse(), enumerate(shape.Faces, start=1)
    return [_mark(f"Face{k}", face, place) for k, face in named if not names or f"Face{k}" in names]


def _mark(name: str, face: Any, place: Any) -> Mark:
    try:
        surface = face.Surface
        kind, way = surface.TypeId, App.Vector()
        if kind == PLANE:
            way = place.Rotation.multVec(face.normalAt(0.0, 0.0))
        elif kind in TURNED:
            way = place.Rotation.multVec(surface.Axis)
    except (TypeError, RuntimeError, Part.OCCError):  # a surface that FreeCAD has no name for
        kind, way = "other", App.Vector()
    return Mark(name, kind, tuple(way), face.Area, tuple(place.multVec(face.CenterOfMass)))


def _whole(shape: Any) -> Mark:
    faces = shape.Faces
    middle = shape.Placement.inverse().multVec(shape.BoundBox.Center)
    return Mark(WHOLE, str(len(faces)), (0.0, 0.0, 0.0), shape.Area, tuple(middle))


def _compared(obj: Any, marks: list[Mark]) -> tuple[Issue, ...]:
    """What is wrong with the faces that a feature names, as they are, by what they were when they were chosen.

    Parts grow and move: a face that is of the same kind, and lies the same way, is the same one, unless the one that was
    chosen is there unchanged under another number, and others came or went, or nothing but numbers changed.
    """
    before, now = _stored(obj), {mark.name: mark for mark in marks}
    was = before.pop(WHOLE, None)
    if was is None or before.keys() != now.keys():
        return ()
    source = obj.Source[0]
    shape = shape_of(source)
    size = shape.BoundBox.DiagonalLength
    moved = [mark for mark in before.values() if not mark.is_same(now[mark.name], size)]
    if not moved:
        return ()
    every = _marks_of(shape, set())
    middles = np.array([mark.middle for mark in every])
    whole = _whole(shape)
    renumbered = whole.surface != was.surface or was.is_same(whole, size)
    for mark in moved:
        near = np.flatnonzero(np.abs(middles - mark.middle).max(axis=1) <= TOLERANCE * size).tolist()
        same = [one.name for one in (every[k] for k in near) if mark.is_same(one, size)]
        if any(name in now for name in same):
            continue  # in another order
        if same and (renumbered or not mark.is_alike(now[mark.name])):
            return (_issue(Text(
                "{} of {} is not the face that was chosen: that face is {} now, as FreeCAD numbers faces anew when a part "
                "changes; choose the faces again, or confirm them: OK in the panel with nothing else entered", mark.name,
                source.Label, same[0],
            )),)
        if not mark.is_alike(now[mark.name]):
            return (_changed(mark, now[mark.name], source.Label),)
    return ()


def _changed(mark: Mark, now: Mark, label: str) -> Issue:
    if mark.surface == now.surface:
        return _issue(Text(
            "{} of {} lies another way than when it was chosen, so it may be another face, as FreeCAD numbers faces anew "
            "when a part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered",
            mark.name, label,
        ))
    return _issue(Text(
        "{} of {} was {} when it was chosen and is {} now, so it may be another face, as FreeCAD numbers faces anew when a "
        "part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered", mark.name, label,
        SURFACES.get(mark.surface, FREE_FORM), SURFACES.get(now.surface, FREE_FORM),
    ))


def _issue(message: str) -> Issue:
    return Issue(WARNING, CODE, message)


def _read(text: str) -> Mark | None:
    """What was stored; None of what is damaged."""
    try:
        name, surface, *values = text.split(" ")
        i, j, k, area, x, y, z = map(float, values)
    except ValueError:
        return None
    return Mark(name, surface, (i, j, k), area, (x, y, z))


def source_of(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """The object of a feature's Source and the names of the faces chosen. InputError 'NO_INPUT', 'BAD_FACES'."""
    if not obj.Source:
        raise InputError("NO_INPUT", obj.Label, "Source is missing; choose the shape to deposit, or some of its faces")
    source, names = obj.Source
    faces = tuple(name for name in names if name)
    lost = ", ".join(name.lstrip("?") for name in faces if name.startswith("?"))
    if lost:  # by FreeCAD 1.0 and later
        raise InputError(
            "BAD_FACES", f"{obj.Label}.Source", "{} is not there any more since the part changed; choose the faces again",
            lost,
        )
    wrong = [name for name in faces if not name.rsplit(".", maxsplit=1)[-1].startswith("Face")]
    if wrong:
        named = ", ".join(wrong)
        raise InputError("BAD_FACES", f"{obj.Label}.Source", "{} is not a face; choose faces or the whole shape", named)
    return source, tuple(name.rsplit(".", maxsplit=1)[-1] for name in faces)
