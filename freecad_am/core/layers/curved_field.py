# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slice solids into curved layers by the distance from the start, through the part or straight."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.mesh.solid import Search, SolidMesh
from ..geometry.on_hub import Group, SolidsOnHub
from ..issues import NOTE, WARNING, InputError, Issue, Text
from ..parameters.filled import SolidParameters
from ..types import Array
from . import geodesic
from .chart import Charted, Place
from .geodesic import GeodesicField
from .surface import Slice

# ---- A piece of a curved layer through a solid as a surface to fill

CHORD = 1.0  # in grid steps; sample distance along an edge


@dataclass(frozen=True, eq=False)
class ChartLayer(Charted):
    """Layer on the chart of a piece of the cut.

    distance: distance from the start to the beads of the layer, mm. The stretch of the chart is at
    most `geodesic.Piece.stretch`.
    """

    field: GeodesicField
    distance: float

    @property
    def look(self) -> float:
        """Sample distance along edges, mm: one grid step."""
        return CHORD * self.field.grid.step

    @property
    def bends_freely(self) -> bool:
        """True: the layer bends where paths through the part turn around corners."""
        return True

    def in_part(self, location: Place) -> tuple[Array, Array]:
        """Map the chart onto the cut, then along the gradient of the field to the bead points."""
        cut = self.chart.to_part(location)
        return self.field.onto(cut, self.distance), self.field.directions(cut)


FINE, COARSE = 0.4, 0.8  # in layer heights; normal and maximum distance between grid nodes
MAX_NODES = (
    2_000_000  # approximate maximum number of nodes; the distance grows up to COARSE instead
)


def step_of(volume: float, layer_height: float) -> float:
    """Return the distance between grid nodes, mm, for solids with a total volume, mm3."""
    return max(FINE * layer_height, float(np.cbrt(volume / MAX_NODES)))


# in layer heights; maximum distance of a start facet from the base plane or the substrate
CONTACT_HEIGHTS = 0.05
UNREACHED = 0.002  # maximum fraction of a part that no path reaches, from rounding at corners
FACETS = 1.5  # in chord errors; maximum distance between two triangulations of a face
REPORTED_DISTORTION = 0.05  # minimum distortion of a piece that is reported


def slices(solids: SolidsOnHub, group: Group, strategy: SolidParameters) -> Iterator[Slice]:
    """Yield the curved layers of a group of solids, outwards from the start.

    The start consists of the faces in contact with the base plane and the surroundings, or of start
    faces. A layer in several pieces yields several slices with the same number.

    Parameters
    ----------
    solids : SolidsOnHub
        All solids and their surroundings.
    group : Group
        The group to slice.
    strategy : SolidParameters
        Layer height, cut and chord error.

    Yields
    ------
    Slice
        The layers in order.

    Raises
    ------
    InputError
        TOO_FINE, NOT_STANDING, NOT_CONNECTED, NOT_FOR_FAMILY.
    """
    _refuse(strategy)
    base, bodies = group.base, group.bodies
    start = (
        None if group.start is None else base.inside(group.start.reshape(-1, 3)).reshape(-1, 3, 3)
    )
    meshes = [
        SolidMesh(base.inside(body.vertices), np.asarray(body.triangles, dtype=np.intp))
        for body in bodies
    ]
    name = bodies[0].name if len(bodies) == 1 else f"{len(bodies)} solids"
    worst, height, cut = 0.0, strategy.layer_height, max(strategy.share_of_cut, 1e-3)
    volume = sum(solid.volume for solid in meshes)
    step = step_of(volume, height)
    if step > COARSE * height:
        raise InputError(
            "TOO_FINE",
            "strategy.layer_height",
            "{:g} mm is too fine for curved layers of {}, {:.4g} cm3; use at least {:.2g} mm, or "
            "layers: planes",
            height,
            name,
            volume / 1000.0,
            step / COARSE,
        )
    field = _field(
        meshes,
        [base.inside(body.vertices)[body.triangles] for body in solids.surroundings],
        name,
        start,
        step,
        strategy,
    )
    layers = int(np.ceil(field.top / height - cut + 1e-6))
    for number in range(max(layers, 0)):
        for chart, regions, stretch in field.pieces((number + cut) * height):
            issues: tuple[Issue, ...] = ()
            if stretch > max(worst, REPORTED_DISTORTION):
                worst = stretch
                issues = (
                    Issue(
                        NOTE if stretch <= 3.0 * REPORTED_DISTORTION else WARNING,
                        "DISTORTED",
                        Text(
                            "a curved layer cannot be flattened without distortion: the bead "
                            "spacing varies by up to {:.2g} %",
                            100.0 * stretch,
                        ),
                        number,
                    ),
                )
            yield Slice(
                number,
                base,
                ChartLayer(chart, field, number * height),
                regions,
                issues,
                share_before=number / layers,
            )


def _refuse(strategy: SolidParameters) -> None:
    """Raise InputError NOT_FOR_FAMILY for parameters that only planar layers support."""
    for key, is_set, instead in (
        ("margin", strategy.margin != 0.0, "0 mm"),
        ("solid_layers", strategy.solid_layers != 0, "0"),
    ):
        if is_set:
            raise InputError(
                "NOT_FOR_FAMILY",
                f"strategy.{key}",
                "the setting needs planar layers; use {}, or layers: planes",
                instead,
            )


def _field(
    solids: Sequence[SolidMesh],
    substrate: Sequence[Array],
    name: str,
    start_faces: Array | None,
    step: float,
    strategy: SolidParameters,
) -> GeodesicField:
    tolerance = CONTACT_HEIGHTS * strategy.layer_height
    if start_faces is None:
        below = [triangles for triangles in substrate if triangles[:, :, 2].min() < -tolerance]
        # a part on a body that extends below the base plane stands on this body, not on the
        # platform
        is_carried = any(
            len(_find_start_faces(solid, below, tolerance, plane=False)) for solid in solids
        )
        start = np.concatenate(
            [
                _find_start_faces(solid, substrate, tolerance, plane=not is_carried)
                for solid in solids
            ]
        )
    else:
        tolerance = max(tolerance, FACETS * strategy.chord_error)
        start = np.concatenate(
            [_find_start_faces(solid, [start_faces], tolerance, plane=False) for solid in solids]
        )
        if not len(start):
            gap = min(
                float(np.abs(_to(start_faces, solid.vertices, tolerance)).min()) for solid in solids
            )
            raise InputError(
                "NOT_STANDING",
                "strategy.start_faces",
                "no face of {} touches the start faces, which are {:.4g} mm away; choose start "
                "faces in contact, or clear them",
                name,
                gap,
            )
    try:
        field = geodesic.field(solids, start, step, through=strategy.layers == "geodesic")
    except ValueError:
        raise InputError(
            "NOT_STANDING",
            name,
            "the part has no face to start from: none is on the plane through its lowest point "
            "along strategy.direction, or on the substrate; turn the part, set "
            "strategy.direction, or choose a substrate in contact",
        ) from None
    if field.unreached > UNREACHED:
        raise InputError(
            "NOT_CONNECTED",
            name,
            "{:.3g} % of the solid is not connected to the platform or the substrate; deposit "
            "that part separately, or set strategy.direction",
            100.0 * field.unreached,
        )
    return field


def _find_start_faces(
    solid: SolidMesh, substrate: Sequence[Array], tolerance: float, plane: bool = True
) -> Array:
    """Return the triangles (k, 3, 3) of a solid that touch the substrate, within `tolerance` mm.

    If `plane` is set, downward triangles on the plane z = 0 also count.
    """
    corners = solid.vertices[solid.triangles]
    is_start = (
        plane & (np.abs(corners[:, :, 2]) < tolerance).all(axis=1) & (solid.units[:, 2] < -0.5)
    )
    for triangles in substrate:
        low, high = triangles.min(axis=(0, 1)) - tolerance, triangles.max(axis=(0, 1)) + tolerance
        candidates = np.flatnonzero(((corners > low) & (corners < high)).all(axis=(1, 2)))
        if len(candidates):
            distance = np.abs(
                _to(triangles, corners[candidates].reshape(-1, 3), tolerance)
            ).reshape(-1, 3)
            is_start[candidates[(distance < tolerance).all(axis=1)]] = True
    start_triangles: Array = corners[is_start]
    return start_triangles


def _to(triangles: Array, points: Array, tolerance: float) -> Array:
    """Return the signed distances (n,), mm, of points from triangles (k, 3, 3)."""
    under = SolidMesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    return Search(under, 4.0 * tolerance).signed(points)[0]
