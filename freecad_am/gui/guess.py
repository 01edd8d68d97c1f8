# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which family of features a selection means, what each of its objects is for, and why: a proposal for a new job."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..brep import hub as hubs
from ..brep import kernel, part_depths
from ..brep.revolution import find_wall
from ..brep.wall_on import named_faces
from ..core.issues import InputError, Issue
from ..core.parameters.strategy import DevelopableParameters
from ..core.process import deposit_balance
from ..objects import deposit
from ..objects.developable_feature import found_in
from ..objects.shapes import Taken, global_shape, taken
from . import picking
from .picking import Pick
from .texts import tr, translated

REVOLUTION, SURFACE, DEVELOPABLE, SOLID = "revolution", "surface", "developable", "solid"  # as in job files
COARSE = 0.3  # mm; of triangles that a look at solids is content with
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


def taken_whole(guess: Guess, picks: Sequence[Pick]) -> str:
    """That all of an object is deposited of which one face was clicked; '' where none was."""
    clicked = {pick.obj.Name for pick in picks if len(_faces(pick)) == 1}
    for part in guess.parts:
        if guess.kind != DEVELOPABLE and not part.names and part.obj.Name in clicked:
            return tr("The whole of {} is taken. For faces alone, click several with Ctrl; for a single one, use the panel "
                      "of Feature or Wall on Part.").format(part.obj.Label)
    return ""


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
    return Guess(SURFACE, reason.format(named.format(wall.obj.Label), ground.obj.Label), (picking.whole(wall),), ground)


def of_one(pick: Pick) -> Guess | Callable[[], Guess]:
    """What a single pick means; or the work that finds it out, which touches no document."""
    label = pick.obj.Label
    if picking.is_mesh(pick.obj):
        return Guess(SOLID, tr("{} is a mesh, which is filled in plane layers").format(label), (pick,))
    clicked, pick = pick, picking.whole(pick)
    shape, faces = global_shape(pick.obj).copy(False), _faces(pick)
    if len(shape.Solids) > 1 and not faces:
        reason = tr("{} holds {} solids").format(label, len(shape.Solids))
        look = taken(pick.obj)
        return lambda: Guess(DEVELOPABLE if _own_hub(look) else SOLID, reason, (pick,), None)

    def work() -> Guess:
        try:
            with kernel.told(label):
                find_wall(shape, faces, label=label)
        except InputError as error:
            if error.code == kernel.FAULTY:
                raise
            return _not_turned(clicked, label, shape, _faces(clicked), error)
        told = tr("the faces picked turn about one axis") if faces else tr("{} turns about one axis").format(label)
        return Guess(REVOLUTION, told, (pick,))

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
    part = Pick(pick.obj) if len(chosen) == 1 and len(shape.Faces) > 1 else picking.with_faces(pick)
    missing = tr("Select also, with Ctrl, the part that it grows on.")
    if shape.Solids and not part.names and not _has_wall(shape, label):
        return Guess(SOLID, tr("{} is not of revolution and has no wall, so it is filled in plane layers").format(label),
                     (Pick(pick.obj),))
    return Guess(SURFACE, tr("{} is not of revolution, so it is a wall").format(label), (part,), None, missing)


def _own_hub(part: Taken) -> bool:
    """Whether most solids of a part stand on a cylinder or cone of another of them."""
    try:
        found_in([part], (), None, None, DevelopableParameters(chord_error=COARSE))
    except (InputError, *kernel.FAULTS):
        return False
    return True


def _has_wall(shape: Any, label: str) -> bool:
    """Whether the faces of a solid tell which of them are its wall."""
    try:
        return bool(named_faces(shape, (), label))
    except InputError:
        return False


def as_kind(kind: str, picks: Sequence[Pick], reason: str) -> Guess:
    """The roles of picks where the family is known."""
    if kind == REVOLUTION:
        if picking.is_mesh(picks[0].obj):
            return Guess(kind, reason, (), None, tr("A part of revolution needs exact faces; {} is a mesh.")
                         .format(picks[0].obj.Label))
        return Guess(kind, reason, (picking.whole(picks[0]),))
    if kind == SURFACE:
        wall, ground, unclear = picking.proposal(picks)
        missing = unclear or ("" if ground is not None else tr("Select also, with Ctrl, the part that it grows on."))
        if wall is None:
            missing = unclear or tr("Select also, with Ctrl, the faces to deposit on {}.").format(picks[0].obj.Label)
        return Guess(kind, reason, () if wall is None else (picking.whole(wall),), ground, missing)
    if kind == SOLID:
        return Guess(kind, reason, tuple(Pick(pick.obj) for pick in picks))
    faced = [pick for pick in picks if _faces(pick)]
    if len(picks) == 1:
        mesh = picking.is_mesh(picks[0].obj)
        lonely = mesh or (not faced and len(global_shape(picks[0].obj).Solids) < 2)
        missing = tr("Select also, with Ctrl, the hub: a cylinder or cone.") if lonely else ""
        return Guess(kind, reason, (Pick(picks[0].obj),), picking.with_faces(faced[0]) if faced else None, missing)
    ground = faced[0] if len(faced) == 1 else picks[-1]
    return Guess(kind, reason, tuple(Pick(one.obj) for one in picks if one is not ground), picking.with_faces(ground))


def left_out(guess: Guess) -> Callable[[], tuple[Issue, ...]]:
    """The work, which touches no document, that finds what of the part would not be deposited as it is understood.
    What refuses the job is told by who makes it."""
    parts, ground, width = [taken(pick.obj) for pick in guess.parts], guess.ground, deposit.bead_width()
    names = guess.parts[0].names
    own = ground is not None and ground.obj == guess.parts[0].obj
    under = None if ground is None or own else taken(ground.obj)

    def work() -> tuple[Issue, ...]:
        try:
            return deposit_balance.issues(_balance(guess, parts, names, under, width))
        except (InputError, *kernel.FAULTS):
            return ()

    return work


def _balance(
    guess: Guess, parts: Sequence[Taken], names: tuple[str, ...], under: Taken | None, width: float
) -> deposit_balance.Balance | None:
    first, depths = parts[0], None
    if guess.kind == DEVELOPABLE:
        chosen = () if guess.ground is None else guess.ground.names
        base = None if under is None or not chosen else (under, chosen)
        faces = chosen if under is None else ()
        solids = found_in(parts, faces, under, base, DevelopableParameters(chord_error=COARSE))
        return deposit_balance.of_feature(solids, width)
    if guess.kind == SOLID:
        return None
    shape = first.shape.copy(False)
    if guess.kind == REVOLUTION:
        depths = part_depths.of_revolved(shape, find_wall(shape, names, label=first.label), first.label)
    else:
        faces = tuple(name for name, _ in named_faces(shape, names, first.label))
        depths = part_depths.of_faces(shape, faces, first.label, None if under is None else under.body())
    return None if depths is None else deposit_balance.of_wall(depths, width)


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
