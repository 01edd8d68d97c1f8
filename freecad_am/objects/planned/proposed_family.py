# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which family and layers suit a part, and why: what `strategy.kind: auto` of a job stands for, and New Job proposes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from FreeCAD import Vector

from freecad_am.core.types import Array, Mask

from ...brep import hub as hubs
from ...brep.kernel import limits as kernel
from ...brep.revolution.wall import find_wall
from ...brep.shapes import part_depths
from ...brep.walls.standing import stand
from ...brep.walls.wall_on import named_faces
from ...core.geometry.curves.profile import RevolvedWall
from ...core.geometry.formatting import at_least, place
from ...core.geometry.mesh.crossing import find_crossings
from ...core.geometry.mesh.manifold import find_holes, separate_vertices
from ...core.geometry.mesh.repair import WELDS_MM, connected_triangles
from ...core.geometry.mesh.uncrossed import remove_crossings
from ...core.geometry.obstacles import Body
from ...core.issues import InputError, Text, Word
from ...core.layers.curved.field import CONTACT_HEIGHTS
from ...core.layers.planes.stacking import evaluate_direction, facets, rank_directions
from ...core.parameters.filled import GEODESIC, PLANES, DevelopableParameters, SolidParameters
from ...core.parameters.strategy import SurfaceParameters
from ...core.process.deposit.balance import MM3, NEGLIGIBLE, wall_balance
from ..developable_feature import found_in
from ..shapes.bodies import Taken
from .on_bends import carried, on_bend

COARSE = 0.3  # mm; of triangles that a look at solids is content with
TOUCHING = 0.05  # mm from the surface of a hub
LOOKED_AT = 60  # corners of a solid that are looked for in a hub
LEAST = 3  # corners of a solid that lie on what it stands on
OVER = 0.1  # of the surface; parts of which more hangs over get layers that need no support
ROUNDED_OFF = 0.005  # of the surface; what rounds to nothing
STEEP, LEVEL = float(np.radians(45.0)), float(np.cos(np.radians(1.0)))
FLAT = 0.01  # of the height, above the lowest point; what lies there stands on something
OPEN = 0.1  # of its size; a mesh with a wider hole is a wall
LYING = 0.95  # of its area; an open mesh of which more is less than STEEP from level is not a wall that stands
TWOFOLD = 1.5  # of a part; one bead on the side of what is no shell lays more: on a rod it meets itself in the middle
WIDEST = 10000.0  # mm; the bound of `strategy.mend`
ROUND = ("Part::GeomCylinder", "Part::GeomCone")
UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Proposal:
    """A family, by its `strategy.kind`, layers of solids ('' of other families), and why. mend: mm across of the largest
    hole that has to be closed for it; 0 for those that are closed anyway. stands: a wall that starts on the platform."""

    kind: str
    layers: str
    reason: str
    mend: float = 0.0
    stands: bool = False

    def text(self) -> str:
        """What is proposed, in one sentence."""
        layers = f", layers: {self.layers}" if self.layers else ""
        return f"kind: {self.kind}{layers}: {self.reason}"


class _Planes(NamedTuple):
    """How planes would be stacked: the direction, None for the best, and how far apart, mm; and what the part stands on."""

    way: Sequence[float] | None
    apart: float
    ground: Taken | None


def proposed(
    part: Taken,
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
    """What suits a part, or faces or edges of it. edges: it names edges to start from; width: mm of a bead; tilts: a machine
    is known, which can tilt; base: faces of the substrate; clicked: a face by which the whole part was chosen, maybe its
    hub; direction: in which planes are stacked, layer_height mm apart, None for the best. A part that nothing serves as a
    whole gets the nearest, told with what that leaves out. InputError FAULTY, NO_FACES."""
    planes = _Planes(direction, layer_height, substrate)
    shape = part.shape
    if shape is not None and (not shape.Faces or any(name.startswith("Edge") for name in names)):
        what = (
            Text("edges of {} are chosen", part.label)
            if names
            else Text("{} has edges and no faces", part.label)
        )
        return Proposal("curves", "", Text("{}, which are laid as beads", Word(what)))
    if not names and substrate is not None and stands_on_hub(part, substrate, base):
        return Proposal(
            "developable",
            "",
            Text("{} stands on a cylinder or cone of {}", part.label, substrate.label),
        )
    if shape is None:
        return _of_mesh(part, substrate, edges, tilts, planes)
    if edges:
        return Proposal("surface", "", Text("{} names the edges that it starts from", part.label))
    if substrate is not None and (names or not shape.Solids):
        return Proposal(
            "surface", "", Text("{} is a thin wall that grows on {}", part.label, substrate.label)
        )
    if len(shape.Solids) > 1 and not names:
        if clicked and substrate is None and _own_hub(part, clicked):
            why = Text(
                "{} of {} is chosen, which most solids of it stand on",
                ", ".join(clicked),
                part.label,
            )
            return Proposal("developable", "", why)
        hint = "; to deposit on one of them, name it as the substrate" if _own_hub(part) else ""
        return _solid(
            part,
            Text(
                "{} holds {} solids{}{}",
                part.label,
                len(shape.Solids),
                carried(shape),
                Word(hint),
            ),
            tilts,
            planes,
        )
    left = ""
    wall = _turned(part, names) if substrate is None else None
    if wall is not None:
        if names:
            return Proposal(
                "revolution", "", Text("the faces chosen of {} turn about one axis", part.label)
            )
        if not shape.Solids:
            return Proposal(
                "revolution", "", Text("{} is a skin that turns about one axis", part.label)
            )
        deep = part_depths.revolved_depths(shape, wall, part.label)
        balance = None if deep is None else wall_balance(deep, width)
        out = 0.0 if balance is None else balance.left_out or 0.0
        if balance is None or out <= NEGLIGIBLE * (balance.part_volume or 0.0):
            why = Text(
                "{} turns about one axis, and its wall is one bead of {:.4g} mm", part.label, width
            )
            return Proposal("revolution", "", why)
        left = Text(
            "; it turns about one axis, but a wall of one bead would leave out {:.3g} of its {:.3g} cm3",
            out / MM3,
            (balance.part_volume or 0.0) / MM3,
        )
    if names and shape.Solids and not _thin(part, width, names):
        return Proposal(
            "cladding",
            "",
            Text(
                "faces of {} are chosen, which do not turn about one axis, and it is thicker there than a "
                "bead of {:.4g} mm, so they are covered",
                part.label,
                width,
            ),
        )
    if names and stand([shape.getElement(name) for name in names]):
        return Proposal(
            "surface",
            "",
            Text(
                "faces of {} are chosen, which do not turn about one axis, so they are a wall that starts "
                "on the platform where nothing carries it",
                part.label,
            ),
            stands=True,
        )
    if names:
        return Proposal(
            "surface",
            "",
            Text(
                "faces of {} are chosen, which do not turn about one axis, so they are a wall; it needs a "
                "substrate, or edges to start from",
                part.label,
            ),
        )
    if not shape.Solids:
        return _of_skin(part)
    if clicked and not left and substrate is None and _own_hub(part, clicked):
        return Proposal(
            "developable",
            "",
            Text(
                "{} of {} is chosen, which the rest of it stands on", ", ".join(clicked), part.label
            ),
        )
    if substrate is not None and _thin(part, width):
        return Proposal(
            "surface",
            "",
            Text(
                "{} is a thin shell, one bead of {:.4g} mm, on {}",
                part.label,
                width,
                substrate.label,
            ),
        )
    return _solid(part, Text("{} is a solid{}", part.label, Word(left)), tilts, planes)


def _of_mesh(
    part: Taken, substrate: Taken | None, edges: bool, tilts: bool, planes: _Planes
) -> Proposal:
    """A wall where it is wide open, else filled; so is what cuts itself, as pieces of a model for display that are pushed
    into one another do: no wall of one bead is that."""
    body = part.body()
    found = connected_triangles(body.vertices, body.triangles, part.label, 0.0)
    open_ = find_holes(separate_vertices(found.vertices, found.triangles))
    opening = max((hole.size for hole in open_), default=0.0)
    if opening <= OPEN * float(np.linalg.norm(np.ptp(body.vertices, axis=0))):
        return _solid(part, Text("{} is a mesh, which is filled", part.label), tilts, planes)
    crossed = find_crossings(found.vertices, found.triangles, WELDS_MM[-1])
    sheet = found.vertices, found.triangles
    if (
        len(crossed.pairs)
        and not edges
        and remove_crossings(*sheet, crossed.pairs, SurfaceParameters.mend, WELDS_MM[-1]) is None
    ):
        at = place(crossed.positions[crossed.length.argmax()])
        size = at_least(opening)
        why = Text(
            "{} is an open mesh that cuts itself at {} pairs of its triangles, as at {}, so it is not a wall of one bead: "
            "it is filled, with its {} holes of up to {:.4g} mm closed",
            part.label,
            len(crossed.pairs),
            at,
            len(open_),
            size,
        )
        return replace(_solid(part, why, tilts, planes), mend=min(size, WIDEST))
    lies = _lying(found.vertices[found.triangles])
    if substrate is None and not edges and lies >= LYING:
        return Proposal(
            "cladding",
            "",
            Text(
                "{} is an open mesh that lies rather than stands, {:.0%} of it at less than 45 deg to the "
                "platform, so it is a face that is covered",
                part.label,
                lies,
            ),
        )
    where = "starts on the platform" if substrate is None else Text("grows on {}", substrate.label)
    return Proposal(
        "surface",
        "",
        Text("{} is an open mesh, so it is a thin wall that {}", part.label, Word(where)),
    )


def _of_skin(part: Taken) -> Proposal:
    """A face that is covered where it lies, else a wall, as an open mesh."""
    body = part.body()
    lies = _lying(body.vertices[body.triangles])
    if lies >= LYING:
        return Proposal(
            "cladding",
            "",
            Text(
                "{} is an open skin that lies rather than stands, {:.0%} of it at less than 45 deg to the "
                "platform, so it is a face that is covered",
                part.label,
                lies,
            ),
        )
    if stand(part.shape.Faces):
        return Proposal(
            "surface",
            "",
            Text(
                "{} is an open skin and not of revolution, so it is a thin wall, which starts on the "
                "platform where nothing carries it",
                part.label,
            ),
            stands=True,
        )
    return Proposal(
        "surface",
        "",
        Text(
            "{} is an open skin and not of revolution, and nothing else serves it; it needs a substrate, or "
            "edges to start from, and what does not grow from there is left out",
            part.label,
        ),
    )


def _lying(corners: Array) -> float:
    """The share of triangles (m, 3, 3), by their area, that are less than STEEP from level."""
    normals = np.cross(*np.diff(corners, axis=1).swapaxes(0, 1))
    areas = np.linalg.norm(normals, axis=1)
    return float(areas[np.abs(normals[:, 2]) > np.cos(STEEP) * areas].sum()) / max(
        float(areas.sum()), 1e-300
    )


def _solid(part: Taken, reason: str, tilts: bool, planes: _Planes) -> Proposal:
    """In planes, or in layers without support where the machine can tilt and much hangs over, or it stands on a bend."""
    if tilts and planes.ground is not None and on_bend(part, planes.ground):
        return Proposal(
            "solid",
            GEODESIC,
            Text("{}, and layers have the bend of {} where it stands", reason, planes.ground.label),
        )
    bodies = [part.body()]
    least = rank_directions(bodies, SolidParameters(max_overhang=STEEP, layer_height=planes.apart))[
        0
    ].direction
    way = least if planes.way is None else np.array(planes.way) / np.linalg.norm(planes.way)
    over = _overhang(bodies[0], way)
    along = "" if np.array_equal(way, UP) else Text(", stacked along {}", _direction_text(way))
    if over < ROUNDED_OFF:
        return Proposal(
            "solid",
            PLANES,
            Text(
                "{}, and less than 1% of its surface hangs over by more than 45 deg{}",
                reason,
                Word(along),
            ),
        )
    why = Text(
        "{}, and {:.0%} of its surface hangs over by more than 45 deg{}", reason, over, Word(along)
    )
    if over <= OVER:
        return Proposal("solid", PLANES, why)
    other = _overhang(bodies[0], least)
    hint = (
        Text("; stacked along {} it would be {:.0%}", _direction_text(least), other)
        if other <= OVER
        else ""
    )
    if not _stands(bodies[0], way, planes.apart):
        return Proposal(
            "solid",
            PLANES,
            Text(
                "{}; curved layers need a flat face that it stands on, which it has not{}",
                Word(why),
                Word(hint),
            ),
        )
    if tilts:
        return Proposal(
            "solid",
            GEODESIC,
            Text("{}, which layers along the way through it carry{}", Word(why), Word(hint)),
        )
    what = Text("a machine that tilts could lay layers: {}, which need no support", GEODESIC)
    return Proposal("solid", PLANES, Text("{}; {}{}", Word(why), Word(what), Word(hint)))


def _overhang(body: Body, way: Array) -> float:
    """The share of the surface that leans out by more than 45 deg from the direction of stacking (3,), but for what the part
    stands on."""
    corners, normals, areas = facets([body], None)
    heights = corners @ way
    found = evaluate_direction(
        way, corners, normals, areas, float(np.sin(STEEP)), FLAT * float(np.ptp(heights))
    )
    return found.area / max(float(areas.sum()), 1e-300)


def _stands(body: Body, way: Array, layer_height: float) -> bool:
    """Whether level triangles lie on the plane through the lowest place along a direction of stacking (3,): what curved
    layers begin on, but for those that a round bottom is made of."""
    corners, normals, _ = facets([body], None)
    heights = corners @ way
    low: Mask = (heights.max(axis=1) < heights.min() + CONTACT_HEIGHTS * layer_height) & (
        normals @ way < -LEVEL
    )
    return bool(low.any())


def _direction_text(way: Array) -> str:
    x, y, z = (round(float(value), 3) + 0.0 for value in way)
    return f"({x:g}, {y:g}, {z:g})"


def _turned(part: Taken, faces: Sequence[str]) -> RevolvedWall | None:
    """The wall of revolution of a shape, None where it is of none."""
    try:
        with kernel.reported(part.label, part.shape):
            return find_wall(part.shape.copy(False), tuple(faces), label=part.label)
    except InputError as error:
        if error.code == kernel.FAULTY:
            raise
        return None


def _thin(part: Taken, width: float, chosen: Sequence[str] = ()) -> bool:
    """Whether the faces of a solid, those chosen or else what tells its wall, are those of a wall that is one bead."""
    try:
        names = tuple(name for name, _ in named_faces(part.shape, chosen, part.label))
        deep = part_depths.face_depths(part.shape, names, part.label, None)
    except (InputError, *kernel.FAULTS):
        return False
    balance = None if deep is None else wall_balance(deep, width)
    return (
        balance is not None
        and (balance.left_out or 0.0) <= NEGLIGIBLE * (balance.part_volume or 0.0)
        and (
            bool(chosen)
            or (balance.beads or 0.0) - (balance.outside or 0.0)
            <= TWOFOLD * (balance.part_volume or 0.0)
        )
    )


def _own_hub(part: Taken, faces: Sequence[str] = ()) -> bool:
    """Whether most solids of a part stand on a cylinder or cone of another of them, or what it is of stands on faces of
    it that are nothing else."""
    chosen = [part.shape.getElement(name) for name in faces]
    if any(face.Surface.TypeId not in ROUND for face in chosen):
        return False
    try:
        found_in([part], faces, None, None, DevelopableParameters(chord_error=COARSE))
    except (InputError, *kernel.FAULTS):
        return False
    return True


def stands_on_hub(part: Taken, substrate: Taken, faces: Sequence[str] = ()) -> bool:
    """Whether a solid or mesh has corners on a cylinder or cone of the substrate, on the faces chosen of it or any, or reaches
    through one into the substrate, as the root of a blade does."""
    if substrate.shape is None or (part.shape is not None and not part.shape.Solids):
        return False  # a surface is not a solid to be filled
    corners = (
        part.body().vertices
        if part.shape is None
        else np.array([tuple(vertex.Point) for vertex in part.shape.Vertexes]).reshape(-1, 3)
    )
    named = [(f"Face{number}", face) for number, face in enumerate(substrate.shape.Faces, start=1)]
    seats = hubs.seats([(name, face) for name, face in named if not faces or name in faces], False)
    heights = [seat.base.surface.distance(seat.base.inside(corners)) for seat in seats]
    return any(
        int((np.abs(height) < TOUCHING).sum()) >= LEAST
        or _reaches_into(substrate, corners, np.asarray(height))
        for height in heights
    )


def _reaches_into(substrate: Taken, corners: Array, heights: Array) -> bool:
    """Whether corners (n, 3) above a cylinder or cone, by their heights (n,) mm, have others below it that are in the
    substrate."""
    below = np.flatnonzero(heights < -TOUCHING)
    if (heights > TOUCHING).sum() < LEAST or len(below) < LEAST:
        return False
    some = below[:: max(1, len(below) // LOOKED_AT)]
    inside = [substrate.shape.isInside(Vector(*corner), TOUCHING, True) for corner in corners[some]]
    return sum(inside) >= LEAST
