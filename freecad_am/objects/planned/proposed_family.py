# SPDX-License-Identifier: LGPL-2.1-or-later
"""The family and layers that suit a part, and why: used for `strategy.kind: auto` of a job and
proposed by New Job.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import Part
from FreeCAD import Vector

from ...brep import hub as hubs
from ...brep.kernel import limits as kernel
from ...brep.revolution.wall import find_wall
from ...brep.shapes import part_depths
from ...brep.walls.patch_wall import stand
from ...brep.walls.wall_on import named_faces
from ...core.geometry.curves.profile import RevolvedWall
from ...core.geometry.formatting import at_least, place
from ...core.geometry.mesh.manifold import find_holes, separate_vertices
from ...core.geometry.mesh.near_triangles import find_crossings, remove_crossings
from ...core.geometry.mesh.repair import WELDS_MM, connected_triangles
from ...core.geometry.obstacles import Body
from ...core.issues import InputError, Text, Word
from ...core.layers.curved_field import CONTACT_HEIGHTS
from ...core.layers.stacking import evaluate_direction, facets, rank_directions
from ...core.parameters.filled import GEODESIC, PLANES, DevelopableParameters, SolidParameters
from ...core.parameters.strategy import SurfaceParameters
from ...core.process.deposit.balance import MM3, NEGLIGIBLE, wall_balance
from ...core.types import Array, Mask
from ..developable_feature import found_in
from ..shapes.bodies import Taken

# ---- Whether a curved face carries a solid

PLANE = "Part::GeomPlane"
TOUCHING_FACE = 0.05  # mm from a curved face
ACROSS = (0.2, 0.5, 0.8)  # of a face, either way
MAX_TESTED_SOLIDS = 8  # solids that are tested


def lies_on_bend(part: Any, ground: Any) -> bool:
    """Whether a face of a shape rests on a curved face of its carrier, another shape."""
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


def carrier(solids: Sequence[Any]) -> str:
    """The name of the largest of several solids, such as `Solid1`, if most of up to LOOKED others
    rest on one of its curved faces; else ''.
    """
    sizes = [abs(solid.Volume) for solid in solids]
    largest = sizes.index(max(sizes))
    other_solids = [solid for k, solid in enumerate(solids) if k != largest][:MAX_TESTED_SOLIDS]
    carried = sum(lies_on_bend(other_solid, solids[largest]) for other_solid in other_solids)
    return f"Solid{largest + 1}" if carried > 0.5 * len(other_solids) else ""


def _face_points(face: Any) -> list[Any]:
    """Points within a face, in its middle and around it."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    shares = [
        (low_u + u * (high_u - low_u), low_v + v * (high_v - low_v)) for u in ACROSS for v in ACROSS
    ]
    points = [face.valueAt(*uv) for uv in shares if face.isPartOfDomain(*uv)]
    return points or [vertex.Point for vertex in face.Vertexes]


# ---- The proposal

COARSE = 0.3  # mm; chord error that suffices for a first look at solids
TOUCHING = 0.05  # mm from the surface of a hub
MAX_TESTED_CORNERS = 60  # corners of a solid that are tested against a hub
MIN_CORNERS = 3  # least number of corners of a solid on its support
OVER = 0.1  # share of the surface; with more overhang, parts get layers that need no support
NEGLIGIBLE_SHARE = 0.005  # share of the surface that rounds to nothing
STEEP_RAD, LEVEL_COSINE = float(np.radians(45.0)), float(np.cos(np.radians(1.0)))
BOTTOM_SHARE = 0.01  # share of the height above the lowest point that counts as supported
MAX_HOLE_SHARE = 0.1  # share of its size; a mesh with a wider hole is a wall
LYING = 0.95  # share of its area; an open mesh with a larger share below STEEP_RAD from level is not an upright wall
MAX_BEAD_FACTOR = 1.5  # factor of the part's volume; one bead along the side of a part that is not a shell deposits more: on a rod it meets itself in the middle
MAX_MEND_MM = 10000.0  # mm; the bound of `strategy.mend`
ROUND = ("Part::GeomCylinder", "Part::GeomCone")
UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Proposal:
    """A family, by its `strategy.kind`, layers of solids ('' for other families), and why. mend:
    width, mm, of the largest hole that has to be closed for it; 0 if the usual limit suffices.
    stands: a wall that starts on the platform.
    """

    kind: str
    layers: str
    reason: str
    mend: float = 0.0
    stands: bool = False

    def text(self) -> str:
        """The proposal in one sentence."""
        layers = f", layers: {self.layers}" if self.layers else ""
        return f"kind: {self.kind}{layers}: {self.reason}"


class _Planes(NamedTuple):
    """How planes would be stacked: the direction (None for the best), their spacing, mm, and the
    ground below the part.
    """

    direction: Sequence[float] | None
    spacing: float
    ground: Taken | None


def proposed(
    source: Taken,
    names: Sequence[str],
    substrate: Taken | None,
    edges: bool,
    width: float,
    tilts: bool,
    *,
    base: Sequence[str] = (),
    clicked: Sequence[str] = (),
    direction: Sequence[float] | None = UP,
    layer_height: float = SolidParameters.layer_height,
) -> Proposal:
    """The proposal for a part, or for its named faces or edges. edges: it names edges to start
    from; width: mm of a bead; tilts: a machine is known, which can tilt; base: faces of the
    substrate; clicked: a face by which the whole part was chosen, maybe its hub; direction: in
    which planes are stacked, layer_height mm apart, None for the best. If nothing serves the whole
    part, the closest proposal names its omissions. Raises InputError FAULTY, NO_FACES.
    """
    planes = _Planes(direction, layer_height, substrate)
    shape = source.shape
    if shape is not None and (not shape.Faces or any(name.startswith("Edge") for name in names)):
        what = (
            Text("edges of {} are selected", source.label)
            if names
            else Text("{} has edges but no faces", source.label)
        )
        return Proposal("curves", "", Text("{}, to be deposited as beads", Word(what)))
    if not names and substrate is not None and stands_on_hub(source, substrate, base):
        return Proposal(
            "developable",
            "",
            Text("{} is on a cylinder or cone of {}", source.label, substrate.label),
        )
    if shape is None:
        return _propose_for_mesh(source, substrate, edges, tilts, planes)
    if edges:
        return Proposal("surface", "", Text("{} names its start edges", source.label))
    if substrate is not None and (names or not shape.Solids):
        return Proposal(
            "surface", "", Text("{} is a thin wall that grows on {}", source.label, substrate.label)
        )
    if len(shape.Solids) > 1 and not names:
        if clicked and substrate is None and _own_hub(source, clicked):
            why = Text(
                "{} of {} is selected, the base of most of its solids",
                ", ".join(clicked),
                source.label,
            )
            return Proposal("developable", "", why)
        hint = "; to deposit on one, name it as the substrate" if _own_hub(source) else ""
        return _solid(
            source,
            Text(
                "{} holds {} solids{}{}",
                source.label,
                len(shape.Solids),
                bend_hint(shape),
                Word(hint),
            ),
            tilts,
            planes,
        )
    omission = ""
    wall = _find_revolved_wall(source, names) if substrate is None else None
    if wall is not None:
        if names:
            return Proposal(
                "revolution",
                "",
                Text("the selected faces of {} share one axis of revolution", source.label),
            )
        if not shape.Solids:
            return Proposal("revolution", "", Text("{} is a surface of revolution", source.label))
        deep = part_depths.revolved_depths(shape, wall, source.label)
        balance = None if deep is None else wall_balance(deep, width)
        out = 0.0 if balance is None else balance.left_out or 0.0
        if balance is None or out <= NEGLIGIBLE * (balance.part_volume or 0.0):
            why = Text(
                "{} is a solid of revolution, and its wall is one bead of {:.4g} mm",
                source.label,
                width,
            )
            return Proposal("revolution", "", why)
        omission = Text(
            "; it is a solid of revolution, but a wall of one bead would leave out {:.3g} of its "
            "{:.3g} cm3",
            out / MM3,
            (balance.part_volume or 0.0) / MM3,
        )
    if names and shape.Solids and not _thin(source, width, names):
        return Proposal(
            "cladding",
            "",
            Text(
                "the selected faces of {} share no axis of revolution, and the part is thicker "
                "there than a bead of {:.4g} mm, so they are covered",
                source.label,
                width,
            ),
        )
    if names and stand([shape.getElement(name) for name in names]):
        return Proposal(
            "surface",
            "",
            Text(
                "the selected faces of {} share no axis of revolution, so they are a wall that "
                "starts on the platform if nothing else supports it",
                source.label,
            ),
            stands=True,
        )
    if names:
        return Proposal(
            "surface",
            "",
            Text(
                "the selected faces of {} share no axis of revolution, so they are a wall; it "
                "needs a substrate, or start edges",
                source.label,
            ),
        )
    if not shape.Solids:
        return _propose_for_skin(source)
    if clicked and not omission and substrate is None and _own_hub(source, clicked):
        return Proposal(
            "developable",
            "",
            Text(
                "{} of {} is selected, the base of the rest",
                ", ".join(clicked),
                source.label,
            ),
        )
    if substrate is not None and _thin(source, width):
        return Proposal(
            "surface",
            "",
            Text(
                "{} is a thin shell, one bead of {:.4g} mm, on {}",
                source.label,
                width,
                substrate.label,
            ),
        )
    return _solid(source, Text("{} is a solid{}", source.label, Word(omission)), tilts, planes)


def _propose_for_mesh(
    source: Taken, substrate: Taken | None, edges: bool, tilts: bool, planes: _Planes
) -> Proposal:
    """A wall where it is wide open, else filled; so is what cuts itself, as pieces of a model for display that are pushed
    into one another do: no wall of one bead is that."""
    body = source.body()
    mesh = connected_triangles(body.vertices, body.triangles, source.label, 0.0)
    open_ = find_holes(separate_vertices(mesh.vertices, mesh.triangles))
    opening = max((hole.size for hole in open_), default=0.0)
    if opening <= MAX_HOLE_SHARE * float(np.linalg.norm(np.ptp(body.vertices, axis=0))):
        return _solid(source, Text("{} is a mesh, to be filled", source.label), tilts, planes)
    crossed = find_crossings(mesh.vertices, mesh.triangles, WELDS_MM[-1])
    sheet = mesh.vertices, mesh.triangles
    if (
        len(crossed.pairs)
        and not edges
        and remove_crossings(*sheet, crossed.pairs, SurfaceParameters.mend, WELDS_MM[-1]) is None
    ):
        position = place(crossed.positions[crossed.length.argmax()])
        size = at_least(opening)
        why = Text(
            "{} is an open mesh that intersects itself at {} pairs of triangles, as at {}, so it "
            "is not a wall of one bead: it is filled, with its {} holes of up to {:.4g} mm "
            "closed",
            source.label,
            len(crossed.pairs),
            position,
            len(open_),
            size,
        )
        return replace(_solid(source, why, tilts, planes), mend=min(size, MAX_MEND_MM))
    lies = _lying(mesh.vertices[mesh.triangles])
    if substrate is None and not edges and lies >= LYING:
        return Proposal(
            "cladding",
            "",
            Text(
                "{} is a flat rather than upright open mesh, {:.0%} at less than 45 deg to the "
                "platform, so it is a face to cover",
                source.label,
                lies,
            ),
        )
    where = "starts on the platform" if substrate is None else Text("grows on {}", substrate.label)
    return Proposal(
        "surface",
        "",
        Text("{} is an open mesh, so it is a thin wall that {}", source.label, Word(where)),
    )


def _propose_for_skin(source: Taken) -> Proposal:
    """A cladding for a flat-lying face, else a wall, as for an open mesh."""
    body = source.body()
    lies = _lying(body.vertices[body.triangles])
    if lies >= LYING:
        return Proposal(
            "cladding",
            "",
            Text(
                "{} is a flat rather than upright open surface, {:.0%} at less than 45 deg to "
                "the platform, so it is a face to cover",
                source.label,
                lies,
            ),
        )
    if stand(source.shape.Faces):
        return Proposal(
            "surface",
            "",
            Text(
                "{} is an open surface without an axis of revolution, so it is a thin wall, "
                "which starts on the platform if nothing else supports it",
                source.label,
            ),
            stands=True,
        )
    return Proposal(
        "surface",
        "",
        Text(
            "{} is an open surface without an axis of revolution, and no other strategy applies; "
            "it needs a substrate or start edges, and regions that do not grow from there are "
            "omitted",
            source.label,
        ),
    )


def _lying(corners: Array) -> float:
    """The share of triangles (m, 3, 3), by their area, that are less than STEEP from level."""
    normals = np.cross(*np.diff(corners, axis=1).swapaxes(0, 1))
    areas = np.linalg.norm(normals, axis=1)
    return float(areas[np.abs(normals[:, 2]) > np.cos(STEEP_RAD) * areas].sum()) / max(
        float(areas.sum()), 1e-300
    )


def _solid(source: Taken, reason: str, tilts: bool, planes: _Planes) -> Proposal:
    """In planes, or in layers without support where the machine can tilt and much hangs over, or
    its ground is curved.
    """
    if tilts and planes.ground is not None and rests_on_bend(source, planes.ground):
        return Proposal(
            "solid",
            GEODESIC,
            Text("{}, and layers follow the bend of {} at its base", reason, planes.ground.label),
        )
    bodies = [source.body()]
    best_direction = rank_directions(
        bodies, SolidParameters(max_overhang=STEEP_RAD, layer_height=planes.spacing)
    )[0].direction
    direction = (
        best_direction
        if planes.direction is None
        else np.array(planes.direction) / np.linalg.norm(planes.direction)
    )
    over = _overhang(bodies[0], direction)
    along = (
        ""
        if np.array_equal(direction, UP)
        else Text(", stacked along {}", _direction_text(direction))
    )
    if over < NEGLIGIBLE_SHARE:
        return Proposal(
            "solid",
            PLANES,
            Text(
                "{}, and less than 1% of its surface overhangs by more than 45 deg{}",
                reason,
                Word(along),
            ),
        )
    why = Text(
        "{}, and {:.0%} of its surface overhangs by more than 45 deg{}", reason, over, Word(along)
    )
    if over <= OVER:
        return Proposal("solid", PLANES, why)
    best_overhang = _overhang(bodies[0], best_direction)
    hint = (
        Text(
            "; stacked along {} it would be {:.0%}", _direction_text(best_direction), best_overhang
        )
        if best_overhang <= OVER
        else ""
    )
    if not _stands(bodies[0], direction, planes.spacing):
        return Proposal(
            "solid",
            PLANES,
            Text(
                "{}; curved layers need a flat base face, which it lacks{}",
                Word(why),
                Word(hint),
            ),
        )
    if tilts:
        return Proposal(
            "solid",
            GEODESIC,
            Text("{}, which layers along the path through it support{}", Word(why), Word(hint)),
        )
    what = Text("a machine that tilts can use layers: {}, which need no support", GEODESIC)
    return Proposal("solid", PLANES, Text("{}; {}{}", Word(why), Word(what), Word(hint)))


def _overhang(body: Body, direction: Array) -> float:
    """The share of the surface that leans out by more than 45 deg from the direction of stacking
    (3,), without its bottom.
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
    """Whether the plane through the lowest point along a direction of stacking (3,) has level
    triangles: curved layers begin there. Triangles of a round bottom do not count.
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


def _find_revolved_wall(source: Taken, faces: Sequence[str]) -> RevolvedWall | None:
    """The wall of revolution of a shape, or None."""
    try:
        with kernel.reported(source.label, source.shape):
            return find_wall(source.shape.copy(False), tuple(faces), label=source.label)
    except InputError as error:
        if error.code == kernel.FAULTY:
            raise
        return None


def _thin(source: Taken, width: float, selected: Sequence[str] = ()) -> bool:
    """Whether the faces of a solid, chosen or else detected, form a wall of one bead."""
    try:
        names = tuple(name for name, _ in named_faces(source.shape, selected, source.label))
        deep = part_depths.face_depths(source.shape, names, source.label, None)
    except (InputError, *kernel.FAULTS):
        return False
    balance = None if deep is None else wall_balance(deep, width)
    return (
        balance is not None
        and (balance.left_out or 0.0) <= NEGLIGIBLE * (balance.part_volume or 0.0)
        and (
            bool(selected)
            or (balance.beads or 0.0) - (balance.outside or 0.0)
            <= MAX_BEAD_FACTOR * (balance.part_volume or 0.0)
        )
    )


def _own_hub(source: Taken, faces: Sequence[str] = ()) -> bool:
    """Whether most solids of a part rest on a cylinder or cone of another solid, or the rest of the
    part rests on its given faces.
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
    """Whether a solid or mesh has corners on a cylinder or cone of the substrate, on its chosen
    faces or any, or reaches through one into the substrate, as the root of a blade does.
    """
    if substrate.shape is None or (source.shape is not None and not source.shape.Solids):
        return False  # a surface is not a solid to be filled
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
    """Whether corners (n, 3) above a cylinder or cone, by their heights (n,) mm, have others below it that are in the
    substrate."""
    below = np.flatnonzero(heights < -TOUCHING)
    if (heights > TOUCHING).sum() < MIN_CORNERS or len(below) < MIN_CORNERS:
        return False
    sample = below[:: max(1, len(below) // MAX_TESTED_CORNERS)]
    inside = [
        substrate.shape.isInside(Vector(*corner), TOUCHING, True) for corner in corners[sample]
    ]
    return sum(inside) >= MIN_CORNERS


# ---- Whether a deposit rests on a curved surface, for the choice of a family


def rests_on_bend(deposit: Taken, ground: Taken) -> bool:
    """Whether a part rests on a curved face of the ground; False for meshes, and if the kernel
    fails.
    """
    with contextlib.suppress(*kernel.FAULTS):
        return (
            deposit.shape is not None
            and ground.shape is not None
            and lies_on_bend(deposit.shape, ground.shape)
        )
    return False


def bend_hint(shape: Any) -> str:
    """A hint for several solids if most rest on a curved face of another one; else ''."""
    with contextlib.suppress(*kernel.FAULTS):
        if name := carrier(shape.Solids):
            return Text(
                " (others are on the bend of {}: as the substrate it shapes their layers)",
                name,
            )
    return ""
