# SPDX-License-Identifier: LGPL-2.1-or-later
"""What each of the objects selected is for in a new job, and the family and layers that suit them: those of `kind: auto`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...core.parameters.filled import GEODESIC, PLANES
from ...objects.planned.proposed_family import Proposal, proposed, stands_on_hub
from ...objects.shapes.bodies import Taken, global_shape, snapshot_of
from ..picking import picking
from ..picking.picking import Pick
from ..texts.translation import tr, translated

# as in job files
REVOLUTION, SURFACE, DEVELOPABLE, SOLID, CURVES = (
    "revolution",
    "surface",
    "developable",
    "solid",
    "curves",
)
CLADDING = "cladding"


@dataclass(frozen=True)
class JobProposal:
    """A family, why it, what is deposited, and what it grows on. missing: what to select besides, '' for nothing. layers: of
    solids. mend: mm across of the largest hole that has to be closed for it, 0 for the usual one."""

    kind: str
    reason: str
    parts: tuple[Pick, ...] = ()
    ground: Pick | None = None
    missing: str = ""
    layers: str = ""
    mend: float = 0.0

    @property
    def choice(self) -> str:
        """The entry of the kinds to choose from."""
        return self.layers if self.layers == GEODESIC else self.kind


def proposal(picks: Sequence[Pick], width: float) -> Callable[[], JobProposal]:
    """The work, which touches no document, that finds out what picks mean, for beads of a width, mm. InputError NO_SHAPE; of the work FAULTY,
    NO_FACES."""
    known = [(pick, _looked_at(pick)) for pick in picks]
    if len(known) == 1:
        return lambda: _of_one(*known[0], width)
    return lambda: _of_several(known, width)


def as_kind(choice: str, picks: Sequence[Pick], reason: str) -> JobProposal:
    """The roles of picks where the family is chosen."""
    kind, layers = (SOLID, choice) if choice == GEODESIC else (choice, "")
    if kind == REVOLUTION:
        if picking.is_mesh(picks[0].obj):
            return JobProposal(
                kind,
                reason,
                (),
                None,
                tr("A part of revolution needs exact faces; {} is a mesh.").format(
                    picks[0].obj.Label
                ),
            )
        return JobProposal(kind, reason, (picking.whole(picks[0]),))
    if kind == SURFACE:
        wall, ground, unclear = picking.proposal(picks)
        if wall is None:
            missing = unclear or tr("Select also, with Ctrl, the faces to deposit on {}.").format(
                picks[0].obj.Label
            )
            return JobProposal(kind, reason, (), ground, missing)
        wall = picking.whole(wall)
        missing = "" if picking.stands(wall) else _ground_missing(wall, ground)
        return JobProposal(kind, reason, (wall,), ground, unclear or missing)
    if kind == CURVES:
        return JobProposal(
            kind, reason, (_with_edges(picks[0]),), next((Pick(one.obj) for one in picks[1:]), None)
        )
    if kind == CLADDING:
        faces = picking.with_faces(picks[0])
        solid = not picking.is_mesh(faces.obj) and bool(global_shape(faces.obj).Solids)
        missing = tr("Click, with Ctrl, the faces to cover.") if solid and not faces.names else ""
        return JobProposal(
            kind, reason, (faces,), next((Pick(one.obj) for one in picks[1:]), None), missing
        )
    if kind == SOLID:
        return JobProposal(kind, reason, tuple(Pick(pick.obj) for pick in picks), layers=layers)
    faced = [pick for pick in picks if picking.with_faces(pick).names]
    if len(picks) == 1:
        mesh = picking.is_mesh(picks[0].obj)
        lonely = mesh or (not faced and len(global_shape(picks[0].obj).Solids) < 2)
        missing = tr("Select also, with Ctrl, the hub: a cylinder or cone.") if lonely else ""
        ground = picking.with_faces(faced[0]) if faced else None
        return JobProposal(kind, reason, (Pick(picks[0].obj),), ground, missing)
    hub = faced[0] if len(faced) == 1 else picks[-1]
    return JobProposal(
        kind,
        reason,
        tuple(Pick(one.obj) for one in picks if one is not hub),
        picking.with_faces(hub),
    )


def taken_whole(found: JobProposal, picks: Sequence[Pick]) -> str:
    """That all of an object is deposited of which one face was clicked; '' where none was."""
    clicked = {pick.obj.Name for pick in picks if len(picking.with_faces(pick).names) == 1}
    for part in found.parts:
        if found.kind != DEVELOPABLE and not part.names and part.obj.Name in clicked:
            return tr(
                "The whole of {} is used. To use single faces, click several with Ctrl; for a "
                "single one, use the panel of Feature or Wall on Part."
            ).format(part.obj.Label)
    return ""


def _of_one(pick: Pick, part: Taken, width: float) -> JobProposal:
    meant = _meant(pick, part)
    clicked = picking.with_faces(pick).names
    found = proposed(
        part, meant.names, None, False, width, True, clicked=() if meant.names else clicked
    )
    if found.kind == DEVELOPABLE:  # hub and solids are of one object
        ground = (
            Pick(pick.obj, clicked)
            if clicked and part.shape is not None and len(part.shape.Solids) < 2
            else None
        )
        return _as_proposed(found, (Pick(pick.obj),), ground)
    return _as_proposed(found, (meant,), None)


def _of_several(known: Sequence[tuple[Pick, Taken]], width: float) -> JobProposal:
    """By what stands on what, their number, and the faces picked."""
    picks = [pick for pick, _ in known]
    faced = [one for one in known if picking.with_faces(one[0]).names]
    for ground, hub in (*faced, *(one for one in reversed(known) if one not in faced)):
        rest = [one for one in known if one[0] is not ground]
        base = picking.with_faces(ground).names
        if all(
            not picking.with_faces(pick).names and stands_on_hub(part, hub, base)
            for pick, part in rest
        ):
            found = proposed(rest[0][1], (), hub, False, width, True, base=base)
            return _as_proposed(
                found, tuple(Pick(pick.obj) for pick, _ in rest), picking.with_faces(ground)
            )
    if len(known) > 2:
        if all(part.shape is None or part.shape.Solids for _, part in known):
            reason = tr("{} solids are selected, to be filled").format(len(known))
            return JobProposal(
                SOLID, reason, tuple(Pick(pick.obj) for pick in picks), layers=PLANES
            )
        return as_kind(SURFACE, picks, tr("the selection includes an object that is not a solid"))
    wall, ground, _ = picking.proposal(picks)
    if wall is None or ground is None:  # both are meshes
        wall, ground = picks
    part, under = (
        next(look for pick, look in known if pick.obj == one.obj) for one in (wall, ground)
    )
    meant = _meant(next(pick for pick in picks if pick.obj == wall.obj), part)
    return _as_proposed(
        proposed(part, meant.names, under, False, width, True), (meant,), Pick(ground.obj)
    )


def _as_proposed(found: Proposal, parts: tuple[Pick, ...], ground: Pick | None) -> JobProposal:
    starts = found.stands and picking.is_alone(parts[0].obj)
    missing = _ground_missing(parts[0], ground) if found.kind == SURFACE and not starts else ""
    return JobProposal(
        found.kind, translated(found.reason), parts, ground, missing, found.layers, found.mend
    )


def _ground_missing(wall: Pick, ground: Pick | None) -> str:
    """What a wall lacks; a mesh may stand on the platform."""
    if ground is not None or picking.is_mesh(wall.obj):
        return ""
    return tr("Select also, with Ctrl, the part it grows on.")


def _meant(pick: Pick, part: Taken) -> Pick:
    """What is to be deposited of what was clicked: several edges, several faces, or all of it."""
    if part.shape is None:
        return Pick(pick.obj)
    if not part.shape.Faces or sum(name.startswith(picking.EDGE) for name in pick.names) > 1:
        return _with_edges(pick)
    faces = picking.with_faces(pick)
    return Pick(pick.obj) if len(faces.names) == 1 and len(part.shape.Faces) > 1 else faces


def _with_edges(pick: Pick) -> Pick:
    """A pick with edges and faces as they were clicked; a lone one stands for the whole."""
    return pick if len(pick.names) > 1 else Pick(pick.obj)


def _looked_at(pick: Pick) -> Taken:
    """What an object is now; a copy, as the window draws the original, maybe at the very moment it is looked at."""
    found = snapshot_of(pick.obj)
    return found if found.shape is None else Taken(found.label, found.shape.copy(False))
