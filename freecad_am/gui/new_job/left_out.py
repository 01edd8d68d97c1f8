# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a part would not be deposited by a new job, before anything is made."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ...brep.kernel import limits as kernel
from ...brep.revolution.wall import find_wall
from ...brep.shapes import part_depths
from ...brep.walls.wall_on import named_faces
from ...core.issues import InputError, Issue
from ...core.parameters.filled import DevelopableParameters
from ...core.process.deposit import balance as deposit_balance
from ...objects.developable_feature import found_in
from ...objects.planned.proposed_family import COARSE
from ...objects.shapes.bodies import Taken, snapshot_of
from .proposal import DEVELOPABLE, REVOLUTION, SURFACE, JobProposal


def left_out(found: JobProposal, width: float) -> Callable[[], tuple[Issue, ...]]:
    """The work, which touches no document, that finds what of the part would not be deposited as it is understood, by beads
    of a width, mm.
    What refuses the job is told by who makes it."""
    parts, ground = [snapshot_of(pick.obj) for pick in found.parts], found.ground
    names = found.parts[0].names
    own = ground is not None and ground.obj == found.parts[0].obj
    under = None if ground is None or own else snapshot_of(ground.obj)

    def work() -> tuple[Issue, ...]:
        try:
            return deposit_balance.issues(_balance(found, parts, names, under, width))
        except (InputError, *kernel.FAULTS):
            return ()

    return work


def _balance(
    found: JobProposal,
    parts: Sequence[Taken],
    names: tuple[str, ...],
    under: Taken | None,
    width: float,
) -> deposit_balance.Balance | None:
    first, depths = parts[0], None
    if found.kind == DEVELOPABLE:
        chosen = () if found.ground is None else found.ground.names
        base = None if under is None or not chosen else (under, chosen)
        faces = chosen if under is None else ()
        solids = found_in(parts, faces, under, base, DevelopableParameters(chord_error=COARSE))
        return deposit_balance.feature_balance(solids, width)
    if found.kind not in (REVOLUTION, SURFACE) or first.shape is None:
        return None
    shape = first.shape.copy(False)
    if found.kind == REVOLUTION:
        depths = part_depths.revolved_depths(
            shape, find_wall(shape, names, label=first.label), first.label
        )
    else:
        faces = tuple(name for name, _ in named_faces(shape, names, first.label))
        depths = part_depths.face_depths(
            shape, faces, first.label, None if under is None else under.body()
        )
    return None if depths is None else deposit_balance.wall_balance(depths, width)
