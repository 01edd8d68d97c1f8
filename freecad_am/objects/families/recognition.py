# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part with what the user selected of it, what a family answers about it, and facts that several
families ask for, each computed once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...brep.kernel import limits as kernel
from ...brep.revolution.wall import find_wall
from ...brep.shapes import part_depths
from ...core.geometry.curves.profile import RevolvedWall
from ...core.geometry.formatting import place
from ...core.geometry.mesh.manifold import find_holes, separate_vertices
from ...core.geometry.mesh.near_triangles import find_crossings, remove_crossings
from ...core.geometry.mesh.repair import WELDS_MM, connected_triangles
from ...core.issues import InputError
from ...core.parameters.filled import SolidParameters
from ...core.parameters.strategy import SurfaceParameters
from ...core.process.deposit.balance import NEGLIGIBLE, wall_balance
from ...core.types import Array
from ..shapes.bodies import Taken

UP = (0.0, 0.0, 1.0)
STEEP_RAD = float(np.radians(45.0))
MAX_HOLE_SHARE = 0.1  # share of its size; a mesh with a wider hole is a wall
LYING = 0.95  # share of its area; an open mesh with a larger share below STEEP_RAD from level is not an upright wall
MAX_BEAD_FACTOR = 1.5  # factor of the part's volume; one bead along the side of a part that is not a shell deposits more: on a rod it meets itself in the middle


@dataclass(frozen=True)
class Proposal:
    """A family, by its `strategy.kind`, and why. layers: of solids, '' for other families. mend:
    width, mm, of the largest hole that has to be closed for it; 0 if the usual limit suffices.
    stands: a wall that starts on the platform.
    """

    kind: str
    reason: str
    layers: str = ""
    mend: float = 0.0
    stands: bool = False

    def text(self) -> str:
        """The proposal in one sentence."""
        layers = f", layers: {self.layers}" if self.layers else ""
        return f"kind: {self.kind}{layers}: {self.reason}"


@dataclass(frozen=True)
class Refusal:
    """The answer of a family that a part does not suit. remark: a clause that the reason for another
    family adds; '' for none.
    """

    remark: str = ""


class MeshFacts(NamedTuple):
    """Triangles (m, 3, 3) of a mesh, the number of its holes and the size of the largest, mm. is_open:
    whether it is wide open. crossings: number of pairs of triangles that intersect and cannot be
    separated, crossing: the position of the longest intersection as text.
    """

    corners: Array
    holes: int
    opening: float
    is_open: bool
    crossings: int
    crossing: str

    @property
    def is_sheet(self) -> bool:
        """Whether it can be a wall or a face to cover."""
        return self.is_open and not self.crossings


@dataclass(frozen=True, eq=False)
class SelectedPart:
    """A part as the user selected it, and how it is printed.

    names: faces or edges of it, none for the whole part. substrate: what it grows on, base: faces
    of that. edges: it names edges to start from. width: mm of a bead. tilts: a machine is known,
    which can tilt. clicked: a face by which the whole part was chosen, maybe its hub. direction: in
    which planes are stacked, layer_height mm apart, None for the best.
    """

    source: Taken
    names: Sequence[str]
    substrate: Taken | None
    edges: bool
    width: float
    tilts: bool
    base: Sequence[str] = ()
    clicked: Sequence[str] = ()
    direction: Sequence[float] | None = UP
    layer_height: float = SolidParameters.layer_height

    @property
    def label(self) -> str:
        """The name of the part in messages."""
        return self.source.label

    @property
    def shape(self) -> Any:
        """The shape; None for a mesh."""
        return self.source.shape

    @property
    def solids(self) -> int:
        """The number of solids of the shape; 0 for a mesh."""
        return 0 if self.shape is None else len(self.shape.Solids)

    @property
    def is_skin(self) -> bool:
        """Whether the part is a shape of faces without a solid."""
        return self.shape is not None and not self.solids

    @property
    def is_several_solids(self) -> bool:
        """Whether several solids are to be printed as a whole."""
        return self.solids > 1 and not self.names

    @cached_property
    def revolved_wall(self) -> RevolvedWall | None:
        """The wall of revolution of the shape or its named faces, or None. Raises InputError FAULTY."""
        try:
            with kernel.reported(self.label, self.shape):
                return find_wall(self.shape.copy(False), tuple(self.names), label=self.label)
        except InputError as error:
            if error.code == kernel.FAULTY:
                raise
            return None

    @cached_property
    def is_one_bead_thick(self) -> bool:
        """Whether the faces of the solid, named or else detected, form a wall of one bead."""
        try:
            from ...brep.walls.wall_on import named_faces  # loads splines

            names = tuple(name for name, _ in named_faces(self.shape, self.names, self.label))
            depths = part_depths.face_depths(self.shape, names, self.label, None)
        except (InputError, *kernel.FAULTS):
            return False
        balance = None if depths is None else wall_balance(depths, self.width)
        if balance is None:
            return False
        volume = balance.part_volume or 0.0
        inside = (balance.beads or 0.0) - (balance.outside or 0.0)
        return (balance.left_out or 0.0) <= NEGLIGIBLE * volume and (
            bool(self.names) or inside <= MAX_BEAD_FACTOR * volume
        )

    @cached_property
    def mesh(self) -> MeshFacts:
        """The mesh of a part without a shape. Raises InputError NO_FACES."""
        body = self.source.body()
        mesh = connected_triangles(body.vertices, body.triangles, self.label, 0.0)
        holes = find_holes(separate_vertices(mesh.vertices, mesh.triangles))
        opening = max((hole.size for hole in holes), default=0.0)
        size = float(np.linalg.norm(np.ptp(body.vertices, axis=0)))
        is_open = opening > MAX_HOLE_SHARE * size
        pairs, position = 0, ""
        if is_open and not self.edges:
            crossed = find_crossings(mesh.vertices, mesh.triangles, WELDS_MM[-1])
            sheet = mesh.vertices, mesh.triangles
            if len(crossed.pairs) and (
                remove_crossings(*sheet, crossed.pairs, SurfaceParameters.mend, WELDS_MM[-1])
                is None
            ):
                pairs = len(crossed.pairs)
                position = place(crossed.positions[crossed.length.argmax()])
        corners = mesh.vertices[mesh.triangles]
        return MeshFacts(corners, len(holes), opening, is_open, pairs, position)

    @cached_property
    def lying_share(self) -> float:
        """The share of a mesh or skin, by its area, that is less than STEEP_RAD from level."""
        if self.shape is None:
            corners = self.mesh.corners
        else:
            body = self.source.body()
            corners = body.vertices[body.triangles]
        normals = np.cross(*np.diff(corners, axis=1).swapaxes(0, 1))
        areas = np.linalg.norm(normals, axis=1)
        return float(areas[np.abs(normals[:, 2]) > np.cos(STEEP_RAD) * areas].sum()) / max(
            float(areas.sum()), 1e-300
        )
