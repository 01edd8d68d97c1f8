# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a scan is of the part that it is said to be of, and in the unit that it is read in."""

from __future__ import annotations

import numpy as np

from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..issues import InputError, Text, Word
from ..parameters.inspection import UNITS
from ..types import Array
from .inspect import UNLIKE

LOOKED = 10_000  # points
LEAST_ON_PART = 0.8  # share of the points of a scan that have to be on the scanned body
SCALE_RATIO = (
    1.5  # times that a scan may be larger or smaller than a part for its unit to be guessed
)


def share_near(points: Array, body: Body, within: float) -> float:
    """The share of points (n, 3) within a distance, mm, of the body."""
    return float((_distances(points, body) <= within).mean())


def refuse_size(points: Array, label: str, body: Body) -> None:
    """InputError SCAN_UNIT if points (n, 3) of a file have quite another size than the body."""
    size, body_size = extent(points), extent(body.vertices)
    if body_size <= size * UNLIKE and size <= UNLIKE * body_size:
        return
    ratio = body_size / max(size, 1e-12)
    units = (
        name
        for name, scale in UNITS.items()
        if name != "mm" and 1.0 / SCALE_RATIO < ratio / scale < SCALE_RATIO
    )
    unit = next(units, "")
    remedy = (
        Text("in {} the size would match; set it as substrate.scan_unit", unit)
        if unit
        else ("check its unit, substrate.scan_unit, and the scanned object")
    )
    raise InputError(
        "SCAN_UNIT",
        label,
        "the scan extends over {:.4g} mm, {} over {:.4g} mm; {}",
        size,
        body.name,
        body_size,
        Word(remedy),
    )


def refuse_other(points: Array, label: str, body: Body, within: float) -> None:
    """InputError SCAN_OTHER with the measured distances if aligned points (n, 3) do not belong to the body."""
    off = _distances(points, body)
    share = float((off <= within).mean())
    if share >= LEAST_ON_PART:
        return
    raise InputError(
        "SCAN_OTHER",
        label,
        "only {:.0%} of its {} points are within {:g} mm of {}, at least {:.0%} are needed; the "
        "median distance is {:.3g} mm. The scan extends over {:.4g} mm, {} over {:.4g} mm: scan "
        "the right part, crop the scan, check its unit, or raise substrate.scan_within",
        share,
        len(points),
        within,
        body.name,
        LEAST_ON_PART,
        np.median(off),
        extent(points),
        body.name,
        extent(body.vertices),
    )


def _distances(points: Array, body: Body) -> Array:
    """Distance (k,), mm, of a sample of points (n, 3) from the body."""
    sample = points[np.unique(np.linspace(0, len(points) - 1, LOOKED).astype(np.intp))]
    solid = SolidMesh(body.vertices, body.triangles)
    return np.asarray(
        solid.searched(0.02 * float(np.ptp(body.vertices, axis=0).max())).distance(sample)
    )


def extent(points: Array) -> float:
    """Diagonal of points (n, 3), mm, without the outermost percent on each side."""
    low, high = (
        np.quantile(points, (0.01, 0.99), axis=0)
        if len(points) > 500
        else (points.min(axis=0), points.max(axis=0))
    )
    return float(np.linalg.norm(high - low))
