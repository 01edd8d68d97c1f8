# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a toolpath keeps of what it was held against: a scan that its layers were fitted to, and the part that its predicted
deposit is to hold."""

from __future__ import annotations

from dataclasses import dataclass

from ..types import Array, Index

REMAINS = "SCAN_REMAINS"  # that the last layer is still off the plan


@dataclass(frozen=True, eq=False)
class Fitted:
    """file: name of the scan. points: how many of its points were used, left_out: how many face another way than the
    layers grow. layer: number of the first layer that was fitted; layers: over how many, from that one, the deposit is led
    back to the plan. places: (m, 3) mm in part coordinates, all over that layer as it was planned; off: (m,) mm along the
    build direction from there to the scan. laid: (k, 3) mm, places of that layer as it is laid now, between points too;
    left: (k,) mm from there to the scan. slope: the most that the scan rises along beads against the plan, per mm. remains:
    mm that the last layer is still off the plan. motion: (4, 4) from where the scan was measured to the part.
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
    """places: (k, 3) mm on the faces of a part, spread over them. normals: (k, 3) out of it. beyond: (k,) mm that the
    deposit reaches beyond the faces there. worst: (w, 3) layer, bead and point nearest to each of the first w places, which
    are those with the least, the least one first. edges: (n + 1,) mm of ranges of what it reaches; shares: (n,) of the
    faces' area in each, of all places that were looked at. layers: (layers, 2) least and mean mm of all places nearest to
    each layer, NaN where there are none."""

    places: Array
    normals: Array
    beyond: Array
    worst: Index
    edges: Array
    shares: Array
    layers: Array


@dataclass(frozen=True, eq=False)
class PredictedShape:
    """fed, laid: mm3 that the wire feeds, and that the predicted deposit holds. edge: mm of the cubes that it is told in.
    drift: (layers,) mm by which the surface of each layer ends above where the next one should begin, NaN where it has no
    beads. allowance: mm asked for on all faces. places: how many of the faces were looked at. least, mean, most: mm that the
    deposit reaches beyond the faces there, along their normals, less than 0 where the part sticks out of it. short: share of
    the faces with less than the allowance; outside: share that sticks out. bare: share with no deposit within `reach` mm.
    worst: (3,) mm, the place with the least; layer, bead, point: what of the path is nearest to it. deviation: what of it is
    drawn, None of what was predicted before that was kept."""

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
