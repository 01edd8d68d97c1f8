# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which family of features a selection means, what each of its objects is for, and why: a proposal for a new job."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..brep import hub as hubs
from ..brep import kernel
from ..brep.revolution import find_wall
from ..core.issues import InputError
from ..objects.shapes import global_shape, taken
from . import picking
from .picking import Pick
from .texts import tr, translated

REVOLUTION, SURFACE, DEVELOPABLE = "revolution", "surface", "developable"  # as macros and job files call them
_TOUCHING = 0.05  # mm from the surface of a hub
_LEAST = 3  # corners of a solid that lie on what it stands on
_ROUND = ("Part::GeomCylinder", "Part::GeomCone")


@dataclass(frozen=True)
class Guess:
    """A family, why it, what is deposited, and what it grows on. missing: what to select besides, '' for nothing."""

    kind: str
    reason: str
    parts: tuple[Pick, ...] = ()
    ground: Pick | None = None
    missing: str = ""


def of_several(picks: Sequence[Pick]) -> Guess:
    """What two or more picks mean, by their number, the faces picked, and what stands on what."""
    if len(picks) > 2:
        reason = tr("several objects are selected; they grow on the one with faces picked, else on the last one")
        return as_kind(DEVELOPABLE, picks, reason)
    one, other = picks
    for part, ground in ((one, other), (other, one)):
        if not _faces(part) and not picking.is_mesh(ground.obj) and _stands_on(part.obj, ground):
            reason = tr("{} stands on a cylinder or cone of {}").format(part.obj.Label, ground.obj.Label)
            return Guess(DEVELOPABLE, reason, (part,), picking.with_faces(ground))
    if picking.is_mesh(one.obj) and picking.is_mesh(other.obj):
        return as_kind(DEVELOPABLE, picks, tr("meshes have no exact faces for a wall"))
    wall, ground, _ = picking.proposal(picks)
    assert wall is not None and ground is not None  # there are two, and not both meshes
    named = tr("faces of {} are picked") if wall.names else tr("{} is no solid on a cylinder or cone")
    reason = tr("{}; {} is what they grow on") if wall.names else tr("{}; {} is what it grows on")
    return Guess(SURFACE, reason.format(named.format(wall.obj.Label), ground.obj.Label), (wall,), ground)


def of_one(pick: Pick) -> Guess | Callable[[], Guess]:
    """What a single pick means; or the work that finds it out, which touches no document."""
    label = pick.obj.Label
    if picking.is_mesh(pick.obj):
        return Guess(DEVELOPABLE, tr("{} is a mesh, which may be deposited on a hub").format(label), (pick,), None,
                     tr("Select also, with Ctrl, the hub it grows on; or the faces of a wall that grows on it."))
    shape, faces = global_shape(pick.obj).copy(False), _faces(pick)
    if len(shape.Solids) > 1 and not faces:
        reason = tr("{} holds {} solids").format(label, len(shape.Solids))
        return Guess(DEVELOPABLE, reason, (pick,), None)

    def work() -> Guess:
        try:
            with kernel.told(label):
                find_wall(shape, faces, label=label)
        except InputError as error:
            if error.code == kernel.FAULTY:
                raise
            return _not_turned(pick, label, shape, faces, error)
        told = tr("the faces picked turn about one axis") if faces else tr("{} turns about one axis").format(label)
        return Guess(REVOLUTION, told, (picking.with_faces(pick),))

    return work


def _not_turned(pick: Pick, label: str, shape: Any, faces: Sequence[str], error: InputError) -> Guess:
    """What a shape means that is not of revolution; the object itself is not asked, which may go meanwhile."""
    if error.code == "NO_AXIS":
        missing = tr("Use the tool Feature…: it takes an edge as the axis.")
        return Guess(REVOLUTION, translated(error.message), (pick,), None, missing)
    chosen = [shape.getElement(name) for name in faces]
    if chosen and shape.Solids and all(face.Surface.TypeId in _ROUND for face in chosen):
        return Guess(DEVELOPABLE, tr("cylinders and cones of {} are picked as hub").format(label),
                     (Pick(pick.obj),), pick)
    return Guess(SURFACE, tr("{} is not of revolution, so it is a wall").format(label),
                 (picking.with_faces(pick),), None, tr("Select also, with Ctrl, the part that it grows on."))


def as_kind(kind: str, picks: Sequence[Pick], reason: str) -> Guess:
    """The roles of picks where the family is known."""
    if kind == REVOLUTION:
        if picking.is_mesh(picks[0].obj):
            return Guess(kind, reason, (), None, tr("A part of revolution needs exact faces; {} is a mesh.")
                         .format(picks[0].obj.Label))
        return Guess(kind, reason, (picking.with_faces(picks[0]),))
    if kind == SURFACE:
        wall, ground, unclear = picking.proposal(picks)
        missing = unclear or ("" if ground is not None else tr("Select also, with Ctrl, the part that it grows on."))
        if wall is None:
            missing = unclear or tr("Select also, with Ctrl, the faces to deposit on {}.").format(picks[0].obj.Label)
        return Guess(kind, reason, () if wall is None else (wall,), ground, missing)
    faced = [pick for pick in picks if _faces(pick)]
    if len(picks) == 1:
        mesh = picking.is_mesh(picks[0].obj)
        lonely = mesh or (not faced and len(global_shape(picks[0].obj).Solids) < 2)
        missing = tr("Select also, with Ctrl, the hub: a cylinder or cone.") if lonely else ""
        return Guess(kind, reason, (Pick(picks[0].obj),), picking.with_faces(faced[0]) if faced else None, missing)
    ground = faced[0] if len(faced) == 1 else picks[-1]
    return Guess(kind, reason, tuple(Pick(one.obj) for one in picks if one is not ground), picking.with_faces(ground))


def _faces(pick: Pick) -> tuple[str, ...]:
    return picking.with_faces(pick).names


def _stands_on(part: Any, ground: Pick) -> bool:
    """Whether a solid or mesh has corners on a cylinder or cone of another object, on the faces picked of it or any."""
    body, hub = taken(part), global_shape(ground.obj)
    if body.shape is not None and not body.shape.Solids:
        return False  # a surface is no solid to be filled
    corners = _corners(body)
    chosen = _faces(ground)
    named = [(f"Face{number}", face) for number, face in enumerate(hub.Faces, start=1)]
    seats = hubs.seats([(name, face) for name, face in named if not chosen or name in chosen], False)
    near = [np.abs(seat.base.surface.distance(seat.base.inside(corners))) < _TOUCHING for seat in seats]
    return any(int(some.sum()) >= _LEAST for some in near)


def _corners(body: Any) -> Any:
    """(n, 3) corners of a shape, or of a mesh."""
    if body.shape is None:
        return body.body().vertices
    return np.array([tuple(vertex.Point) for vertex in body.shape.Vertexes]).reshape(-1, 3)
