# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recognition of a part: the selection, the answers of families, and cached part properties."""

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
# maximum hole size of a closed mesh, fraction of the mesh size
MAX_HOLE_SHARE = 0.1
# area fraction inclined less than STEEP_RAD from level, above which an open mesh is not a wall
LYING = 0.95
# maximum ratio of deposit to part volume for a shell one bead thick; a bead along the side of a
# solid part deposits more, since on a rod it meets itself at the centre
MAX_BEAD_FACTOR = 1.5


@dataclass(frozen=True)
class Proposal:
    """A proposed family and the reason.

    kind: `strategy.kind`. layers: layer kind of solids, '' for other families. mend: size of the
    largest hole to close, mm; 0 if the default limit suffices. stands: whether a wall starts on the
    platform.
    """

    kind: str
    reason: str
    layers: str = ""
    mend: float = 0.0
    stands: bool = False

    def text(self) -> str:
        """Return the proposal as one sentence."""
        layers = f", layers: {self.layers}" if self.layers else ""
        return f"kind: {self.kind}{layers}: {self.reason}"


@dataclass(frozen=True)
class Refusal:
    """Refusal of a part by a family. remark: clause to add to another family's reason, or ''."""

    remark: str = ""


class MeshFacts(NamedTuple):
    """Properties of a mesh.

    corners: triangles (m, 3, 3). holes: number of holes. opening: size of the largest hole, mm.
    is_open: whether this hole exceeds MAX_HOLE_SHARE. crossings: number of intersecting triangle
    pairs that cannot be separated. crossing: location of the longest intersection, as text.
    """

    corners: Array
    holes: int
    opening: float
    is_open: bool
    crossings: int
    crossing: str

    @property
    def is_sheet(self) -> bool:
        """Whether the mesh can be a wall or a face to cover."""
        return self.is_open and not self.crossings


@dataclass(frozen=True, eq=False)
class SelectedPart:
    """A part as selected by the user, and its print settings.

    names: names of faces or edges, empty for the whole part. substrate: the object below the part.
    base: face names of the substrate. edges: whether start edges are named. width: bead width, mm.
    tilts: whether the machine is known and can tilt. clicked: face by which the whole part was
    selected, possibly its hub. direction: stacking direction of planes, None for the best.
    layer_height: mm.
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
        """Return the part name for messages."""
        return self.source.label

    @property
    def shape(self) -> Any:
        """Return the shape, None for a mesh."""
        return self.source.shape

    @property
    def solids(self) -> int:
        """Return the number of solids in the shape, 0 for a mesh."""
        return 0 if self.shape is None else len(self.shape.Solids)

    @property
    def is_skin(self) -> bool:
        """Whether the part is a shape of faces without a solid."""
        return self.shape is not None and not self.solids

    @property
    def is_several_solids(self) -> bool:
        """Whether the whole part is selected and has several solids."""
        return self.solids > 1 and not self.names

    @cached_property
    def revolved_wall(self) -> RevolvedWall | None:
        """Return the wall of revolution of the shape or its named faces, or None.

        Raises InputError FAULTY.
        """
        try:
            with kernel.reported(self.label, self.shape):
                return find_wall(self.shape.copy(False), tuple(self.names), label=self.label)
        except InputError as error:
            if error.code == kernel.FAULTY:
                raise
            return None

    @cached_property
    def is_one_bead_thick(self) -> bool:
        """Whether the named or detected faces of the solid form a wall one bead thick."""
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
        """Return the mesh properties of a part without a shape. Raises InputError NO_FACES."""
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
        """Return the area fraction of a mesh or skin inclined less than STEEP_RAD from level."""
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
