# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan solids on a hub."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from FreeCAD import Vector

from ...brep import hub as hubs
from ...brep.kernel import limits as kernel
from ...core.families.developable import Developable
from ...core.issues import InputError, Text
from ...core.parameters.filled import DevelopableParameters
from ...core.types import Array
from ..developable_feature import found_in
from ..shapes.bodies import Taken
from .filled_planner import FilledPlanner
from .recognition import Proposal, Refusal, SelectedPart

COARSE = 0.3  # mm; chord error for the recognition of solids
TOUCHING = 0.05  # mm; maximum distance of a corner that touches the surface of a hub
MAX_TESTED_CORNERS = 60  # maximum number of corners of a solid tested against a hub
MIN_CORNERS = 3  # minimum number of corners of a solid on its support
ROUND = ("Part::GeomCylinder", "Part::GeomCone")


class DevelopablePlanner(FilledPlanner):
    """Planner of solids in equidistant layers around a hub."""

    proxy = ("developable_feature", "DevelopableFeature")
    recognition_rank = 20

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose solids on a cylinder or cone of the substrate, or on clicked faces of the part."""
        if part.names:
            return Refusal()
        if part.substrate is not None and stands_on_hub(part.source, part.substrate, part.base):
            return Proposal(
                Developable.kind,
                Text("{} is on a cylinder or cone of {}", part.label, part.substrate.label),
            )
        if part.edges or not part.solids:
            return Refusal()
        if part.clicked and part.substrate is None and _is_own_hub_clicked(part):
            faces = ", ".join(part.clicked)
            why = (
                Text("{} of {} is selected, the base of most of its solids", faces, part.label)
                if part.is_several_solids
                else Text("{} of {} is selected, the base of the rest", faces, part.label)
            )
            return Proposal(Developable.kind, why)
        if part.is_several_solids and _has_own_hub(part.source):
            return Refusal(Text("to deposit on one of the solids, name it as the substrate"))
        return Refusal()


def _is_own_hub_clicked(part: SelectedPart) -> bool:
    """Whether the clicked faces carry the rest of a part that is not of revolution."""
    if not part.is_several_solids and part.revolved_wall is not None:
        return False
    return _has_own_hub(part.source, part.clicked)


def _has_own_hub(source: Taken, faces: Sequence[str] = ()) -> bool:
    """Whether most solids of a part rest on a cylinder or cone of another solid of the part.

    With `faces`, whether the rest of the part rests on these faces.
    """
    selected = [source.shape.getElement(name) for name in faces]
    if any(face.Surface.TypeId not in ROUND for face in selected):
        return False
    try:
        found_in([source], faces, None, None, DevelopableParameters(chord_error=COARSE))
    except (InputError, *kernel.FAULTS):
        return False
    return True


def stands_on_hub(source: Taken, substrate: Taken, faces: Sequence[str] = ()) -> bool:
    """Whether a solid or mesh stands on a cylinder or cone of the substrate.

    Corners must touch the cylinder or cone, or reach through it into the substrate, as the root of
    a blade does. faces: names of the substrate faces to test; empty for all.
    """
    if substrate.shape is None or (source.shape is not None and not source.shape.Solids):
        return False  # a surface cannot be filled
    corners = (
        source.body().vertices
        if source.shape is None
        else np.array([tuple(vertex.Point) for vertex in source.shape.Vertexes]).reshape(-1, 3)
    )
    named = [(f"Face{number}", face) for number, face in enumerate(substrate.shape.Faces, start=1)]
    seats = hubs.seats([(name, face) for name, face in named if not faces or name in faces], False)
    heights = [seat.base.surface.distance(seat.base.inside(corners)) for seat in seats]
    return any(
        int((np.abs(height) < TOUCHING).sum()) >= MIN_CORNERS
        or _reaches_into(substrate, corners, np.asarray(height))
        for height in heights
    )


def _reaches_into(substrate: Taken, corners: Array, heights: Array) -> bool:
    """Whether corners lie both above a cylinder or cone and below it inside the substrate.

    corners: (n, 3). heights: heights (n,) above the cylinder or cone, mm.
    """
    below = np.flatnonzero(heights < -TOUCHING)
    if (heights > TOUCHING).sum() < MIN_CORNERS or len(below) < MIN_CORNERS:
        return False
    sample = below[:: max(1, len(below) // MAX_TESTED_CORNERS)]
    inside = [
        substrate.shape.isInside(Vector(*corner), TOUCHING, True) for corner in corners[sample]
    ]
    return sum(inside) >= MIN_CORNERS
