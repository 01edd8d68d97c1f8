# SPDX-License-Identifier: LGPL-2.1-or-later
"""Heights of a scanned surface along given directions, from local smooth patches.

Patches are quadratic. The weights of the fit fall with the distance (Cleveland 1979) and with Tukey's biweight, so that
outliers such as spatter and reflections have no weight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.mesh.refine import refine_mesh
from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..issues import InputError, Text, Word
from ..parameters.inspection import UNITS
from ..types import Array, Mask
from .inspect import UNLIKE

# ---- Checks of a scan's unit and of the scanned part

LOOKED = 10_000  # maximum number of points to check
LEAST_ON_PART = 0.8  # minimum fraction of a scan's points on the scanned body
SCALE_RATIO = 1.5  # maximum size ratio of scan and part, in either direction, for a unit to match


def share_near(points: Array, body: Body, within: float) -> float:
    """Return the fraction of points near a body.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    body : Body
        The body.
    within : float
        Maximum distance, mm.

    Returns
    -------
    float
        Fraction from 0 to 1.
    """
    return float((_distances(points, body) <= within).mean())


def refuse_size(points: Array, label: str, body: Body) -> None:
    """Reject a scan whose size differs too much from a body.

    Parameters
    ----------
    points : (n, 3) array
        Points of the scan, mm.
    label : str
        Name of the scan.
    body : Body
        The body.

    Raises
    ------
    InputError
        SCAN_UNIT, with the unit that would match, if any.
    """
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
        Text("the size would match in {}; set this unit as substrate.scan_unit", unit)
        if unit
        else ("check substrate.scan_unit and the scanned object")
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
    """Reject aligned points that do not belong to a body.

    Parameters
    ----------
    points : (n, 3) array
        Points in part coordinates, mm.
    label : str
        Name of the scan.
    body : Body
        The body.
    within : float
        Maximum distance from the body of a point on it, mm.

    Raises
    ------
    InputError
        SCAN_OTHER with the measured distances.
    """
    off = _distances(points, body)
    share = float((off <= within).mean())
    if share >= LEAST_ON_PART:
        return
    raise InputError(
        "SCAN_OTHER",
        label,
        "only {:.0%} of the {} scanned points are within {:g} mm of {}, but at least {:.0%} are "
        "needed; the median distance is {:.3g} mm. The scan extends over {:.4g} mm, {} over "
        "{:.4g} mm: scan the right part, crop the scan, check its unit, or raise "
        "substrate.scan_within",
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
    """Return the distances (k,) of a sample of points (n, 3) from a body, mm."""
    sample = points[np.unique(np.linspace(0, len(points) - 1, LOOKED).astype(np.intp))]
    solid = SolidMesh(body.vertices, body.triangles)
    return np.asarray(
        solid.searched(0.02 * float(np.ptp(body.vertices, axis=0).max())).distance(sample)
    )


def extent(points: Array) -> float:
    """Return the diagonal of the bounding box of points.

    With more than 500 points, the outermost percent on each side is ignored.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.

    Returns
    -------
    float
        Diagonal, mm.
    """
    low, high = (
        np.quantile(points, (0.01, 0.99), axis=0)
        if len(points) > 500
        else (points.min(axis=0), points.max(axis=0))
    )
    return float(np.linalg.norm(high - low))


PATCH_POINTS = 64  # points of a patch
MIN_POINTS = 12  # minimum number of points of a patch with weight
BIWEIGHT = 4.685  # times the standard deviation of residuals; maximum residual with weight (Tukey)
SPREAD = 1.4826  # ratio of the standard deviation to the median absolute value
ROUNDS = 4
OFF_CENTRE = 0.5  # fraction of the patch radius; maximum centroid offset of a position within the scan's edges
MAX_RADIUS_RATIO = 3.0  # times the usual patch radius; wider patches span a hole in the scan
PIECE = 4000  # positions in a batch
TINY_MM = 1e-6  # mm; lower bound of divisors


@dataclass(frozen=True, eq=False)
class Heights:
    """Scan heights at m positions.

    off: (m,) offset of the scan along the direction, mm, NaN at uncovered positions. slope: (m,) slope of the scan.
    covered: (m,) whether the scan covers the position.
    """

    off: Array
    slope: Array
    covered: Mask


@dataclass(frozen=True, eq=False)
class _Patches(Heights):
    """Heights with wide: (m,) whether the patch spans a hole in the scan."""

    wide: Mask


@dataclass(frozen=True, eq=False)
class Scan:
    """Scanned points, (n, 3) mm in part coordinates.

    label: file name. within: mm, maximum distance from the plan of points of the part.
    """

    points: Array
    label: str
    within: float

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points)

    @cached_property
    def _radius(self) -> float:
        """Usual patch radius of the scan, mm."""
        sample = self.points[np.unique(np.linspace(0, len(self.points) - 1, 400).astype(np.intp))]
        return float(
            np.median(
                np.asarray(self._tree.query(sample, k=min(PATCH_POINTS, len(self.points)))[0])[
                    :, -1
                ]
            )
        )

    def heights(self, positions: Array, directions: Array) -> Heights:
        """Return the scan heights at positions (m, 3), m >= 1, along unit vectors (m, 3)."""
        if len(self.points) < MIN_POINTS:
            nothing = np.full(len(positions), np.nan)
            return Heights(nothing, nothing, np.zeros(len(positions), dtype=np.bool_))
        blocks = []
        for begin in range(0, len(positions), PIECE):
            rows = slice(begin, begin + PIECE)
            rough = self._patches(positions[rows], directions[rows], rough=True)
            # repeat from the surface, where the nearest points surround the position
            start = np.where(rough.covered, rough.off, 0.0)
            then = self._patches(
                positions[rows] + start[:, None] * directions[rows], directions[rows]
            )
            blocks.append(
                Heights(start + then.off, then.slope, rough.covered & then.covered & ~then.wide)
            )
        off, slope, covered = (
            np.concatenate([getattr(block, name) for block in blocks])
            for name in ("off", "slope", "covered")
        )
        return Heights(np.where(covered, off, np.nan), slope, covered)

    def _patches(self, positions: Array, directions: Array, rough: bool = False) -> _Patches:
        """Fit patches; `rough` fits planes only."""
        _, neighbours = self._tree.query(positions, k=min(PATCH_POINTS, len(self.points)))
        arm = self.points[neighbours] - positions[:, None]
        along, across = _sideways(directions)
        u, v, high = (np.einsum("mkc,mc->mk", arm, axis) for axis in (along, across, directions))
        radius = np.maximum(np.hypot(u, v).max(axis=1), TINY_MM)[:, None]
        u, v = u / radius, v / radius
        close = np.maximum(1.0 - np.hypot(u, v) ** 3, 0.0) ** 3 * (
            np.abs(high) <= 2.0 * self.within
        )
        flat = np.stack([np.ones_like(u), u, v], axis=2)
        bent = np.concatenate([flat, np.stack([u * u, u * v, v * v], axis=2)], axis=2)
        weight = close
        for columns in (flat,) if rough else (flat, bent):
            for _ in range(ROUNDS):
                solved = _solved(columns, high, weight)
                residual = np.abs(high - np.einsum("mkc,mc->mk", columns, solved))
                limit = (
                    BIWEIGHT * np.maximum(SPREAD * _median(residual, close > 0.0), TINY_MM)[:, None]
                )
                weight = close * np.maximum(1.0 - (residual / limit) ** 2, 0.0) ** 2
        total = np.maximum(weight.sum(axis=1), TINY_MM)
        off_centre = np.hypot((weight * u).sum(axis=1), (weight * v).sum(axis=1)) / total
        covered = ((weight > 0.0).sum(axis=1) >= min(MIN_POINTS, neighbours.shape[1])) & (
            off_centre <= OFF_CENTRE
        )
        slope = np.hypot(solved[:, 1], solved[:, 2]) / radius[:, 0]
        wide = radius[:, 0] > max(MAX_RADIUS_RATIO * self._radius, TINY_MM)
        return _Patches(np.where(covered, solved[:, 0], 0.0), slope, covered, wide)


def _sideways(directions: Array) -> tuple[Array, Array]:
    """Return two unit vectors (m, 3) perpendicular to each direction (m, 3) and to each other."""
    axis = np.eye(3)[np.argmin(np.abs(directions), axis=1)]
    along = np.cross(directions, axis)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return along, np.cross(directions, along)


def _solved(columns: Array, high: Array, weight: Array) -> Array:
    """Return the weighted least-squares coefficients (m, c) of heights (m, k) in columns (m, k, c)."""
    weighted = columns * weight[:, :, None]
    system = np.einsum("mkc,mkd->mcd", weighted, columns)
    system += (
        1e-9 * np.maximum(weight.sum(axis=1), 1e-300)[:, None, None] * np.eye(columns.shape[2])
    )
    return np.asarray(
        np.linalg.solve(system, np.einsum("mkc,mk->mc", weighted, high)[:, :, None])[:, :, 0]
    )


def _median(values: Array, valid: Mask) -> Array:
    """Return the medians (m,) of the valid values (m, k); 0 in rows without valid values."""
    ordered = np.sort(np.where(valid, values, np.inf), axis=1)
    count = valid.sum(axis=1)
    middle = ordered[np.arange(len(values)), np.maximum(count - 1, 0) // 2]
    return np.where(count > 0, middle, 0.0)


PARTS = 40  # minimum number of triangle edges along the longest side of the refined body
MIN_EDGE_MM = 4.0  # mm; lower bound of the edge length in refinement
MAX_TRIANGLES = 100_000  # maximum number of triangles
FACING = 0.2  # minimum cosine between the normal of a face and a growth direction for the face to be moved


def facing(points: Array, body: Body, directions: Array) -> Mask:
    """Return which points are nearest to triangles that face one of several directions.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    body : Body
        The body.
    directions : (m, 3) array
        Unit vectors.

    Returns
    -------
    (n,) bool array
        True if the nearest triangle faces one of the directions.
    """
    solid = SolidMesh(body.vertices, body.triangles)
    extent = float(np.ptp(body.vertices, axis=0).max())
    _, _, nearest = solid.searched(extent / PARTS).signed(points)
    sample = directions[np.unique(np.linspace(0, len(directions) - 1, 50).astype(np.intp))]
    return np.asarray((solid.units @ sample.T).max(axis=1)[nearest] > FACING)


def scanned(body: Body, scan: Scan, directions: Array) -> Body:
    """Move the vertices of a body to a scan.

    Parameters
    ----------
    body : Body
        The body in part coordinates.
    scan : Scan
        The scan in part coordinates.
    directions : (m, 3) array
        Unit vectors; only faces that face one of them are moved.

    Returns
    -------
    Body
        The moved body, possibly with finer triangles.
    """
    longest = max(float(np.ptp(body.vertices, axis=0).max()) / PARTS, MIN_EDGE_MM)
    owner = np.zeros(len(body.triangles), dtype=np.intp)
    refinement = refine_mesh(
        body.vertices, body.triangles, owner, longest, lambda middle, *_: middle, MAX_TRIANGLES
    )
    vertices, triangles = (body.vertices, body.triangles) if refinement is None else refinement[:2]
    units = SolidMesh(vertices, triangles).units
    sample = directions[np.unique(np.linspace(0, len(directions) - 1, 50).astype(np.intp))]
    level = (units @ sample.T).max(axis=1)
    order = np.argsort(level, kind="stable")  # the best-facing triangle of a vertex is written last
    normals, best = np.zeros_like(vertices), np.full(len(vertices), -1.0)
    for corner in range(3):
        corner_vertices = triangles[order, corner]
        better = level[order] >= best[corner_vertices]
        best[corner_vertices[better]], normals[corner_vertices[better]] = (
            level[order][better],
            units[order][better],
        )
    looking = np.flatnonzero(best > FACING)
    if not len(looking):
        return body
    heights = scan.heights(vertices[looking], normals[looking])
    good = heights.covered & (np.abs(np.where(heights.covered, heights.off, np.inf)) <= scan.within)
    shifted = vertices.copy()
    shifted[looking[good]] += heights.off[good, None] * normals[looking[good]]
    return Body(body.name, shifted, triangles)
