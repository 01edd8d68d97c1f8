# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpret the selection in the tree or the 3D view: objects with faces or edges, wall and
substrate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import FreeCADGui as Gui

from ..brep.walls.patch_wall import stand
from ..objects.job_group import is_group
from ..objects.shapes import bodies, nested
from ..objects.shapes.bodies import global_shape
from ..objects.shapes.containers import links_to_nothing
from ..objects.stage import stage_of
from .in_language import tr

FACE, EDGE = nested.FACE, nested.EDGE


@dataclass(frozen=True)
class Pick:
    """An object and the names of its picked faces or edges; no names for the whole object."""

    obj: Any
    names: tuple[str, ...] = ()


def selected(document: Any) -> list[Pick]:
    """Return the selection of a document in order, without objects that can be neither wall nor
    substrate.
    """
    picks: dict[str, Pick] = {}
    for entry in Gui.Selection.getSelectionEx(document.Name, 0):
        for path in entry.SubElementNames or ("",):
            obj, name = nested.clicked(entry.Object, path)
            obj = _single_member(obj)
            if usable(obj):
                names = picks.get(obj.Name, Pick(obj)).names
                picks[obj.Name] = Pick(obj, (*names, name) if name and name not in names else names)
    return list(picks.values())


def selected_line(document: Any) -> Pick | None:
    """Return the axis of revolution from the selection: an edge, datum line or sketch axis, or a
    whole object.

    Return None without a selection.
    """
    whole_pick: Pick | None = None
    for entry in Gui.Selection.getSelectionEx(document.Name, 0):
        for path in entry.SubElementNames or ("",):
            obj, name = nested.line_of(entry.Object, path)
            pick = Pick(obj, (name,) if name else ())
            if name or obj.TypeId in nested.LINES:
                return pick
            whole_pick = whole_pick or pick
    return whole_pick


def _single_member(obj: Any) -> Any:
    """Return the only member of a group that has a shape; otherwise the object itself."""
    if not any(obj.isDerivedFrom(kind) for kind in nested.GROUPS):
        return obj
    members = [member for member in obj.Group if usable(member)]
    return members[0] if len(members) == 1 else obj


def usable(obj: Any) -> bool:
    """Whether an object has a shape or a mesh and is not one of our stages."""
    if obj is None or stage_of(obj) is not None:
        return False
    shape = getattr(obj, "Shape", None)
    return is_mesh(obj) or (shape is not None and not shape.isNull())


def is_mesh(obj: Any) -> bool:
    """Whether an object is a mesh, which has no faces to deposit."""
    return bodies.is_mesh(obj)


def pick_of_faces(pick: Pick) -> Pick:
    """Return the pick with only its faces."""
    return Pick(pick.obj, tuple(name for name in pick.names if name.startswith(FACE)))


def expand_pick(pick: Pick) -> Pick:
    """Interpret a click on an object to deposit.

    A single face selects the whole object, because a click in the 3D view picks a face. Several
    faces select themselves.
    """
    faces = pick_of_faces(pick)
    lone = len(faces.names) == 1 and len(global_shape(pick.obj).Faces) > 1
    return Pick(pick.obj) if lone else faces


def stands(wall: Pick) -> bool:
    """Whether a wall starts on the platform if nothing else is picked.

    A mesh may. Faces with an edge on the platform may if the document contains no other part that
    they could grow on.
    """
    if is_mesh(wall.obj):
        return True
    if not is_alone(wall.obj):
        return False
    shape, names = global_shape(wall.obj), pick_of_faces(wall).names
    return stand([shape.getElement(name) for name in names] or list(shape.Faces))


def is_alone(obj: Any) -> bool:
    """Whether all solids and meshes of the document derive from the object or are its sources."""
    related_names = {
        obj.Name,
        *(member.Name for member in (*obj.OutListRecursive, *obj.InListRecursive)),
    }
    unrelated = [
        member
        for member in obj.Document.Objects
        if member.Name not in related_names and stage_of(member) is None
    ]
    return not any(is_mesh(member) or _has_solids(member) for member in unrelated)


def _has_solids(obj: Any) -> bool:
    shape = getattr(obj, "Shape", None)
    return shape is not None and not shape.isNull() and bool(shape.Solids)


def proposal(picks: Sequence[Pick]) -> tuple[Pick | None, Pick | None, str]:
    """Return wall and substrate of a selection, None if undetermined, and a text on ambiguities.

    The wall is the pick with faces, or else the first pick. A mesh is the substrate; a single mesh
    is a wall.
    """
    if len(picks) == 1 and is_mesh(picks[0].obj):
        return picks[0], None, ""
    picks = [pick_of_faces(pick) for pick in picks]
    walls = [pick for pick in picks if not is_mesh(pick.obj)]
    faced = [pick for pick in walls if pick.names]
    if len(picks) > 2:
        wall = faced[0] if len(faced) == 1 else None
        text = (
            tr("{} objects are selected; pick the wall and the substrate")
            if wall is None
            else tr("{} objects are selected; pick the substrate")
        )
        return wall, None, text.format(len(picks))
    wall = (faced or walls or [None])[0]
    substrates = [pick for pick in picks if pick is not wall]
    return wall, Pick(substrates[0].obj) if len(substrates) == 1 else None, ""


def refused(document: Any) -> str:
    """Return why the selection in a document cannot be deposited; '' without a selection."""
    for entry in Gui.Selection.getSelectionEx(document.Name, 0):
        obj, _ = nested.clicked(entry.Object, (entry.SubElementNames or ("",))[0])
        if usable(obj):
            continue
        if stage_of(obj) is not None or is_group(obj):
            return tr("{} belongs to a job; select the part itself.").format(obj.Label)
        if links_to_nothing(obj):
            return tr("{} links to no object: its target was deleted or is not loaded.").format(
                obj.Label
            )
        return tr("{} has no shape; select a body, solid, face, link or sketch.").format(obj.Label)
    return ""
