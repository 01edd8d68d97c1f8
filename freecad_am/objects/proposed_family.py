# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which family and layers suit a part, and why: what `strategy.kind: auto` of a job stands for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..brep import hub as hubs
from ..brep import kernel, part_depths
from ..brep.revolution import find_wall
from ..brep.wall_on import named_faces
from ..core.geometry.profile import RevolvedWall
from ..core.issues import InputError
from ..core.parameters.strategy import DevelopableParameters
from ..core.process.deposit_balance import LITTLE, MM3, of_wall
from .developable_feature import found_in
from .shapes import Taken

COARSE = 0.3  # mm; of triangles that a look at solids is content with
TOUCHING = 0.05  # mm from the surface of a hub
LEAST = 3  # corners of a solid that lie on what it stands on
OVER = 0.1  # of the surface; parts of which more hangs over get layers that need no support
STEEP = np.radians(45.0)
FLAT = 0.01  # of the height, above the lowest point; what lies there stands on something
PLANES, GEODESIC = "planes", "geodesic"


@dataclass(frozen=True)
class Proposal:
    """A family, by its `strategy.kind`, layers of solids ('' of other families), and why."""

    kind: str
    layers: str
    reason: str

    def told(self) -> str:
        """What is proposed, in one sentence."""
        layers = f", layers: {self.layers}" if self.layers else ""
        return f"kind: {self.kind}{layers}: {self.reason}"


def proposed(
    part: Taken, faces: Sequence[str], substrate: Taken | None, edges: bool, width: float, tilts: bool
) -> Proposal:
    """What suits a part, or faces of it. edges: it names edges to start from; width: mm of a bead; tilts: a machine is
    known, which can tilt. A part that nothing serves as a whole gets the nearest, told with what that leaves out."""
    if part.shape is None:
        return _solid(part, f"{part.label} is a mesh, which is filled", tilts)
    shape = part.shape
    if edges:
        return Proposal("surface", "", f"{part.label} names the edges that it starts from")
    stands = substrate is not None and substrate.shape is not None and bool(shape.Solids) and not faces
    if stands and _on_hub(part, substrate):
        assert substrate is not None
        return Proposal("developable", "", f"{part.label} stands on a cylinder or cone of {substrate.label}")
    if substrate is not None and (faces or not shape.Solids):
        return Proposal("surface", "", f"{part.label} is a thin wall that grows on {substrate.label}")
    if len(shape.Solids) > 1 and not faces:
        if _own_hub(part):
            why = f"most solids of {part.label} stand on a cylinder or cone of another of them"
            return Proposal("developable", "", why)
        return _solid(part, f"{part.label} holds {len(shape.Solids)} solids", tilts)
    left = ""
    wall = _turned(part, faces) if substrate is None else None
    if wall is not None:
        if not shape.Solids:
            return Proposal("revolution", "", f"{part.label} is a skin that turns about one axis")
        deep = part_depths.of_revolved(shape, wall, part.label)
        balance = None if deep is None else of_wall(deep, width)
        out = 0.0 if balance is None else balance.left_out or 0.0
        if balance is None or out <= LITTLE * (balance.part or 0.0):
            why = f"{part.label} turns about one axis, and its wall is one bead of {width:.4g} mm"
            return Proposal("revolution", "", why)
        left = (
            f"; it turns about one axis, but a wall of one bead would leave out {out / MM3:.3g} of its "
            f"{(balance.part or 0.0) / MM3:.3g} cm3"
        )
    if not shape.Solids:
        return Proposal(
            "surface", "", f"{part.label} is an open skin and not of revolution, and nothing else serves it; it needs a "
            "substrate, or part.start_edges, and what does not grow from there is left out"
        )
    if substrate is not None and _thin(part, width):
        return Proposal("surface", "", f"{part.label} is a thin shell, one bead of {width:.4g} mm, on {substrate.label}")
    return _solid(part, f"{part.label} is a solid{left}", tilts)


def _solid(part: Taken, reason: str, tilts: bool) -> Proposal:
    """Filled in plane layers, or in ones that need no support where much hangs over and the machine can tilt."""
    over = _overhang(part)
    if over <= OVER:
        return Proposal("solid", PLANES, f"{reason}, and {over:.0%} of its surface hang over by more than 45 deg")
    why = f"{reason}, and {over:.0%} of its surface hang over by more than 45 deg"
    if tilts:
        return Proposal("solid", GEODESIC, f"{why}, which layers along the way through it carry")
    return Proposal("solid", PLANES, f"{why}; a machine that tilts could lay layers: {GEODESIC}, which need no support")


def _overhang(part: Taken) -> float:
    """The share of the surface that faces down by more than 45 deg from the vertical, but for what the part stands on."""
    corners = part.body().corners()
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.linalg.norm(normal, axis=1)
    low, high = float(corners[..., 2].min()), float(corners[..., 2].max())
    stands = corners[..., 2].max(axis=1) <= low + FLAT * (high - low)
    down = normal[:, 2] < -np.sin(STEEP) * double
    return float(double[down & ~stands].sum() / max(double.sum(), 1e-300))


def _turned(part: Taken, faces: Sequence[str]) -> RevolvedWall | None:
    """The wall of revolution of a shape, None where it is of none."""
    try:
        with kernel.told(part.label):
            return find_wall(part.shape.copy(False), tuple(faces), label=part.label)
    except InputError as error:
        if error.code == kernel.FAULTY:
            raise
        return None


def _thin(part: Taken, width: float) -> bool:
    """Whether the faces of a solid tell its wall, and this is one bead."""
    try:
        names = tuple(name for name, _ in named_faces(part.shape, (), part.label))
        deep = part_depths.of_faces(part.shape, names, part.label, None)
    except (InputError, *kernel.FAULTS):
        return False
    balance = None if deep is None else of_wall(deep, width)
    return balance is not None and (balance.left_out or 0.0) <= LITTLE * (balance.part or 0.0)


def _own_hub(part: Taken) -> bool:
    """Whether most solids of a part stand on a cylinder or cone of another of them."""
    try:
        found_in([part], (), None, None, DevelopableParameters(chord_error=COARSE))
    except (InputError, *kernel.FAULTS):
        return False
    return True


def _on_hub(part: Taken, substrate: Any) -> bool:
    """Whether a solid has corners on a cylinder or cone of the substrate."""
    corners = np.array([tuple(vertex.Point) for vertex in part.shape.Vertexes]).reshape(-1, 3)
    named = [(f"Face{number}", face) for number, face in enumerate(substrate.shape.Faces, start=1)]
    seats = hubs.seats(named, False)
    near = [np.abs(seat.base.surface.distance(seat.base.inside(corners))) < TOUCHING for seat in seats]
    return any(int(some.sum()) >= LEAST for some in near)
