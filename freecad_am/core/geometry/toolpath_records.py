# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records of a toolpath: the fit of layers to a scan, and predicted deposit against the part."""

from __future__ import annotations

from dataclasses import dataclass

from ..types import Array, Index

REMAINS_CODE = "SCAN_REMAINS"  # the last layer still deviates from the plan


@dataclass(frozen=True, eq=False)
class Fitted:
    """The fit of layers to a scan.

    file: name of the scan. points: number of scan points used. left_out: number of points dropped
    because they do not face the build direction. layer: index of the first fitted layer. layers:
    number of fitted layers, after which the deposit follows the plan again. places: (m, 3) mm in
    part coordinates, samples of the first fitted layer as planned; off: (m,) mm from these samples
    to the scan along the build direction. laid: (k, 3) mm, samples of that layer as fitted, also
    between path points; left: (k,) mm from these samples to the scan. slope: maximum rise of the
    scan against the plan along beads, mm per mm. remains: remaining deviation of the last layer
    from the plan, mm. motion: (4, 4) pose of the scan in part coordinates.
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

    places: (k, 3) mm, samples of the faces. normals: (k, 3) outwards. beyond: (k,) mm by which
    the deposit extends beyond the faces at the samples. worst: (w, 3) layer, bead and point nearest
    to each of the first w samples, which have the smallest values, rising. edges: (n + 1,) bin
    edges of `beyond`, mm; shares: (n,) fraction of the face area in each bin, over all examined
    samples. layers: (layers, 2) minimum and mean of the samples nearest to each layer, mm, NaN
    without samples.
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
    """Statistics of the predicted deposit.

    fed, laid: volume of the wire feed and of the predicted deposit, mm3. edge: voxel edge of the
    prediction, mm. drift: (layers,) height of each layer's surface above the planned start of the
    next layer, mm, NaN without beads. allowance: required allowance on all faces, mm. places:
    number of samples on the faces. least, mean, most: minimum, mean and maximum distance by which
    the deposit extends beyond the faces along their normals, mm; negative where the part protrudes.
    short: area fraction with less than the allowance. outside: area fraction where the part
    protrudes. bare: area fraction without deposit within `reach` mm. worst: (3,) sample with the
    minimum value, mm. layer, bead, point: path point nearest to `worst`. deviation: the map to
    draw; None in predictions stored without a map.
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
