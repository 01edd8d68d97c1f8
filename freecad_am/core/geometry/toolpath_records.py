# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records on a toolpath: a scan that its layers were fitted to, and the comparison of its
predicted deposit with the part.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..types import Array, Index

REMAINS_CODE = "SCAN_REMAINS"  # that the last layer is still off the plan


@dataclass(frozen=True, eq=False)
class Fitted:
    """The fit of layers to a scan.

    file: name of the scan. points: number of its points used. left_out: number that face
    another way than the layers grow. layer: number of the first fitted layer. layers: number
    of layers, from that one, over which the deposit returns to the plan. places: (m, 3) mm in
    part coordinates, spread over that layer as planned; off: (m,) mm along the build
    direction from there to the scan. laid: (k, 3) mm, positions on that layer as deposited
    now, between points too; left: (k,) mm from there to the scan. slope: maximum rise of the
    scan along beads against the plan, per mm. remains: mm that the last layer is still off
    the plan. motion: (4, 4) from the scan's coordinates to the part.
    """

    file: str
    points: int
    left_out: int
    layer: int
    layers: int
    places: Array
    off: Array
    laid: Array
    left: Array
    slope: float
    remains: float
    motion: Array


@dataclass(frozen=True, eq=False)
class DeviationMap:
    """The deviation of the predicted deposit from the faces of a part.

    places: (k, 3) mm, spread over the faces. normals: (k, 3) outward. beyond: (k,) mm that
    the deposit reaches beyond the faces there. worst: (w, 3) layer, bead and point nearest to
    each of the first w places, which are the smallest, in rising order. edges: (n + 1,) mm of
    ranges of `beyond`; shares: (n,) of the faces' area in each, over all examined places.
    layers: (layers, 2) smallest and mean mm of the places nearest to each layer, NaN without
    places.
    """

    places: Array
    normals: Array
    beyond: Array
    worst: Index
    edges: Array
    shares: Array
    layers: Array


@dataclass(frozen=True, eq=False)
class PredictedShape:
    """Figures of the predicted deposit.

    fed, laid: mm3 that the wire feeds, and that the predicted deposit holds. edge: mm of the
    cubes of the prediction. drift: (layers,) mm by which the surface of each layer ends above
    where the next one should begin, NaN without beads. allowance: mm required on all faces.
    places: number of examined positions on the faces. least, mean, most: mm that the deposit
    reaches beyond the faces there, along their normals, negative where the part sticks out.
    short: share of the faces with less than the allowance; outside: share that sticks out.
    bare: share without deposit within `reach` mm. worst: (3,) mm, the position with the
    smallest value; layer, bead, point: the path point nearest to it. deviation: the map to
    draw, None in predictions made before it was stored.
    """

    fed: float
    laid: float
    edge: float
    drift: Array
    allowance: float
    places: int
    least: float
    mean: float
    most: float
    short: float
    outside: float
    bare: float
    reach: float
    worst: Array
    layer: int
    bead: int
    point: int
    deviation: DeviationMap | None = None
