# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan solids in planes, curved layers, or layers along a guide."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import Part

from ...brep.kernel import limits as kernel
from ...core.families.solid import Solid
from ...core.geometry.formatting import at_least
from ...core.geometry.obstacles import Body
from ...core.issues import Text, Word
from ...core.layers.curved_field import CONTACT_HEIGHTS
from ...core.layers.stacking import evaluate_direction, facets, rank_directions
from ...core.parameters.filled import GEODESIC, PLANES, SolidParameters
from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath
from ...core.types import Array, Mask
from ..shapes.bodies import Taken
from .filled_planner import FilledPlanner
from .given import Given
from .planner import PartDistances
from .recognition import STEEP_RAD, UP, Proposal, Refusal, SelectedPart

OVER = 0.1  # overhang area fraction above which parts get layers that need no support
NEGLIGIBLE_SHARE = 0.005  # surface fraction that rounds to zero
LEVEL_COSINE = float(np.cos(np.radians(1.0)))
BOTTOM_SHARE = 0.01  # height above the lowest point that counts as supported, fraction of height
MAX_MEND_MM = 10000.0  # mm; maximum of `strategy.mend`
PLANE = "Part::GeomPlane"
TOUCHING_FACE = 0.05  # mm; maximum distance of a face that touches a curved face
ACROSS = (0.2, 0.5, 0.8)  # sample positions along both parameters of a face, fractions
MAX_TESTED_SOLIDS = 8  # maximum number of tested solids


class SolidPlanner(FilledPlanner):
    """Planner of solids in layers of any kind."""

    proxy = ("solid_feature", "SolidFeature")
    recognition_rank = 60

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose every part that no other family recognises."""
        if part.shape is None:
            return _propose_for_mesh(part)
        why = (
            Text("{} holds {} solids{}", part.label, part.solids, bend_hint(part.shape))
            if part.is_several_solids
            else Text("{} is a solid", part.label)
        )
        return _choose_layers(part, Text("{}; {}", why, remark) if remark else why)

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return distances at the slicing height, above the lower surface of a layer's beads."""
        up = inputs.strategy.share_of_cut * inputs.strategy.layer_height * places.build
        cut_places = places._replace(points=places.points + up)
        return super().part_distances(toolpath, inputs, sources, cut_places)


def _propose_for_mesh(part: SelectedPart) -> Proposal:
    """Propose to fill a mesh.

    Intersecting pieces, as in display models, are filled too, with openings closed, because they
    are not a wall one bead thick.
    """
    mesh = part.mesh
    if not mesh.is_open:
        return _choose_layers(part, Text("{} is a mesh, to be filled", part.label))
    size = at_least(mesh.opening)
    why = Text(
        "{} is an open mesh that intersects itself at {} pairs of triangles, as at {}, so a wall "
        "of one bead is impossible; the mesh is filled, with its {} holes of up to {:.4g} mm "
        "closed",
        part.label,
        mesh.crossings,
        mesh.crossing,
        mesh.holes,
        size,
    )
    return replace(_choose_layers(part, why), mend=min(size, MAX_MEND_MM))


def _choose_layers(part: SelectedPart, reason: str) -> Proposal:
    """Propose planes, or curved layers if the machine can tilt and the part needs them.

    A part needs curved layers if it has much overhang or rests on a curved substrate.
    """
    ground = part.substrate
    if part.tilts and ground is not None and rests_on_bend(part.source, ground):
        return Proposal(
            Solid.kind,
            Text("{}, and layers follow the bend of {} at its base", reason, ground.label),
            GEODESIC,
        )
    bodies = [part.source.body()]
    best_direction = rank_directions(
        bodies, SolidParameters(max_overhang=STEEP_RAD, layer_height=part.layer_height)
    )[0].direction
    direction = (
        best_direction
        if part.direction is None
        else np.array(part.direction) / np.linalg.norm(part.direction)
    )
    over = _overhang(bodies[0], direction)
    along = (
        ""
        if np.array_equal(direction, UP)
        else Text(", stacked along {}", _direction_text(direction))
    )
    if over < NEGLIGIBLE_SHARE:
        return Proposal(
            Solid.kind,
            Text(
                "{}, and less than 1% of its surface overhangs by more than 45 deg{}",
                reason,
                Word(along),
            ),
            PLANES,
        )
    why = Text(
        "{}, and {:.0%} of its surface overhangs by more than 45 deg{}", reason, over, Word(along)
    )
    if over <= OVER:
        return Proposal(Solid.kind, why, PLANES)
    best_overhang = _overhang(bodies[0], best_direction)
    hint = (
        Text(
            "; stacked along {} the share would be {:.0%}",
            _direction_text(best_direction),
            best_overhang,
        )
        if best_overhang <= OVER
        else ""
    )
    if not _stands(bodies[0], direction, part.layer_height):
        return Proposal(
            Solid.kind,
            Text(
                "{}; curved layers need a flat base face, which the part lacks{}",
                Word(why),
                Word(hint),
            ),
            PLANES,
        )
    if part.tilts:
        return Proposal(
            Solid.kind,
            Text(
                "{}, and layers along the path through the part support this surface{}",
                Word(why),
                Word(hint),
            ),
            GEODESIC,
        )
    what = Text("a machine that tilts can use layers: {}, which need no support", GEODESIC)
    return Proposal(Solid.kind, Text("{}; {}{}", Word(why), Word(what), Word(hint)), PLANES)


def _overhang(body: Body, direction: Array) -> float:
    """Return the surface fraction that overhangs by more than 45 deg, excluding the bottom.

    direction: stacking direction, (3,).
    """
    corners, normals, areas = facets([body], None)
    heights = corners @ direction
    overhang = evaluate_direction(
        direction,
        corners,
        normals,
        areas,
        float(np.sin(STEEP_RAD)),
        BOTTOM_SHARE * float(np.ptp(heights)),
    )
    return overhang.area / max(float(areas.sum()), 1e-300)


def _stands(body: Body, direction: Array, layer_height: float) -> bool:
    """Whether a body has a flat bottom normal to the stacking direction, from which layers start.

    direction: stacking direction, (3,). Triangles of a rounded bottom do not count.
    """
    corners, normals, _ = facets([body], None)
    heights = corners @ direction
    low: Mask = (heights.max(axis=1) < heights.min() + CONTACT_HEIGHTS * layer_height) & (
        normals @ direction < -LEVEL_COSINE
    )
    return bool(low.any())


def _direction_text(direction: Array) -> str:
    x, y, z = (round(float(value), 3) + 0.0 for value in direction)
    return f"({x:g}, {y:g}, {z:g})"


def rests_on_bend(deposit: Taken, ground: Taken) -> bool:
    """Whether a part rests on a curved face of the ground; False for meshes or kernel failures."""
    with contextlib.suppress(*kernel.FAULTS):
        return (
            deposit.shape is not None
            and ground.shape is not None
            and lies_on_bend(deposit.shape, ground.shape)
        )
    return False


def lies_on_bend(part: Any, ground: Any) -> bool:
    """Whether a face of a shape rests on a curved face of the shape `ground`."""
    bent = [face for face in ground.Faces if face.Surface.TypeId != PLANE]
    return any(
        all(
            face.distToShape(Part.Vertex(point))[0] < TOUCHING_FACE
            for point in _face_points(face_of_part)
        )
        for face_of_part in part.Faces
        if face_of_part.Surface.TypeId != PLANE
        for face in bent
        if face.BoundBox.intersect(face_of_part.BoundBox)
    )


def _face_points(face: Any) -> list[Any]:
    """Return points inside a face, at its centre and around the centre."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    shares = [
        (low_u + u * (high_u - low_u), low_v + v * (high_v - low_v)) for u in ACROSS for v in ACROSS
    ]
    points = [face.valueAt(*uv) for uv in shares if face.isPartOfDomain(*uv)]
    return points or [vertex.Point for vertex in face.Vertexes]


def bend_hint(shape: Any) -> str:
    """Return a hint if most of several solids rest on a curved face of another solid, else ''."""
    with contextlib.suppress(*kernel.FAULTS):
        if name := carrier(shape.Solids):
            return Text(
                " (other solids are on the bend of {}: as the substrate it shapes their layers)",
                name,
            )
    return ""


def carrier(solids: Sequence[Any]) -> str:
    """Return the name of the largest solid, such as `Solid1`, if it carries most other solids.

    Up to MAX_TESTED_SOLIDS other solids are tested for contact with its curved faces. Else ''.
    """
    sizes = [abs(solid.Volume) for solid in solids]
    largest = sizes.index(max(sizes))
    other_solids = [solid for k, solid in enumerate(solids) if k != largest][:MAX_TESTED_SOLIDS]
    carried = sum(lies_on_bend(other_solid, solids[largest]) for other_solid in other_solids)
    return f"Solid{largest + 1}" if carried > 0.5 * len(other_solids) else ""
