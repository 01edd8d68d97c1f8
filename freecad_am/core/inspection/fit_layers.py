# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers fitted to a scan: the first layer follows the scan, and later layers blend back to the plan.

Points move along the growth direction of the layers, by less from layer to layer. Where layers get thinner or thicker,
the torch is faster or slower, so that the deposit volume fits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.formatting import place
from ..geometry.toolpath_records import REMAINS_CODE, Fitted
from ..issues import NOTE, WARNING, InputError, Issue, Text
from ..parameters.filled import PLANES
from ..parameters.scan import ScanParameters
from ..toolpath import Bead, Layer, Toolpath
from ..types import Array, Index, Mask
from .scan_heights import Scan

Ways = Callable[[Bead], Array]
Off = Callable[[Array, Array], Array]  # (points (n, 3), directions (n, 3)) -> offsets (n,), mm

MAX_SEGMENT_MM, MIN_SEGMENT_MM = 8.0, 0.5  # mm; limits of the segment length in refinement
NOISE_MM = 0.02  # mm; noise of a scan between points
STEP = 0.25  # mm; maximum distance between samples
ROUNDS = 12
CORNER = 1e-6  # 1 - cosine between arriving and leaving tangent; above it a point is a corner


@dataclass(frozen=True, eq=False)
class Scanned:
    """A bead with growth directions (n, 3) and scan offsets (n,) along them, mm."""

    bead: Bead
    directions: Array
    off: Array

    def samples(self) -> tuple[Array, Array]:
        """Return points along the bead, at most STEP apart.

        Returns
        -------
        points : (k, 3) array
            Points, mm.
        off : (k,) array
            Scan offsets at the points, mm.
        """
        arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.bead.points, axis=0), axis=1))]
        samples_ = np.linspace(0.0, arc[-1], max(2, int(np.ceil(arc[-1] / STEP)) + 1))
        points = np.column_stack(
            [np.interp(samples_, arc, column) for column in self.bead.points.T]
        )
        return points, np.interp(samples_, arc, self.off)


def along_beads(
    beads: Sequence[Bead], directions_of: Ways, off: Off, share: float, tolerance: float
) -> list[Scanned]:
    """Refine beads until the scan offset is linear between points.

    Parameters
    ----------
    beads : sequence of Bead
        The beads.
    directions_of : Ways
        Returns the growth directions (n, 3) at the points of a bead.
    off : Off
        Returns the scan offsets (n,) of points (n, 3) along directions (n, 3).
    share : float
        Fraction of the offset that is applied.
    tolerance : float
        Maximum deviation from linear, mm.

    Returns
    -------
    list of Scanned
        The beads with directions and offsets.
    """
    close = max(tolerance, NOISE_MM)
    points = np.concatenate([bead.points for bead in beads])
    directions = np.concatenate([directions_of(bead) for bead in beads])
    offsets = np.split(off(points, directions), np.cumsum([len(bead) for bead in beads])[:-1])
    refined, open_ = list(beads), [np.ones(len(bead) - 1, dtype=np.bool_) for bead in beads]
    for _ in range(ROUNDS):
        pending = [k for k, rows in enumerate(open_) if rows.any()]
        if not pending:
            break
        segments = [np.flatnonzero(open_[k]) for k in pending]
        middles = [
            refined[k].outline.at(rows, 0.5)[0] for k, rows in zip(pending, segments, strict=True)
        ]
        between = [
            _between(directions_of(refined[k]), rows)
            for k, rows in zip(pending, segments, strict=True)
        ]
        heights = np.split(
            off(np.concatenate(middles), np.concatenate(between)),
            np.cumsum([len(rows) for rows in segments])[:-1],
        )
        for k, rows, high in zip(pending, segments, heights, strict=True):
            refined[k], offsets[k], open_[k] = _halved(
                refined[k], offsets[k], rows, high, share, close
            )
    return [
        Scanned(bead, directions_of(bead), heights)
        for bead, heights in zip(refined, offsets, strict=True)
    ]


def _between(directions: Array, segments: Index) -> Array:
    mean = directions[segments] + directions[segments + 1]
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))


def _halved(
    bead: Bead, off: Array, segments: Index, middle: Array, share: float, close: float
) -> tuple[Bead, Array, Mask]:
    """Halve the segments that need it; return the bead, its scan offsets and the segments to check next."""
    length = np.linalg.norm(bead.points[segments + 1] - bead.points[segments], axis=1)
    bent = share * np.abs(middle - 0.5 * (off[segments] + off[segments + 1])) > close
    cut = (length > 2.0 * MIN_SEGMENT_MM) & (bent | (length > MAX_SEGMENT_MM))
    halved_rows = segments[cut]
    again = np.zeros(len(bead) - 1 + len(halved_rows), dtype=np.bool_)
    if len(halved_rows):
        new_rows = halved_rows + np.arange(len(halved_rows))
        again[new_rows] = again[new_rows + 1] = True
        bead, off = bead.halved(halved_rows), np.insert(off, halved_rows + 1, middle[cut])
    return bead, off, again


def move_bead(scanned: Scanned, share: float, thinner: float, height: float) -> Bead:
    """Move a bead by a fraction of the scan offset.

    Parameters
    ----------
    scanned : Scanned
        The bead with directions and offsets.
    share : float
        The fraction.
    thinner : float
        Relative reduction of the layer height per mm of offset, 1/mm. The speed increases in
        proportion.
    height : float
        Layer height of beads without a predicted height, mm.

    Returns
    -------
    Bead
        The moved bead.
    """
    bead, shift = scanned.bead, share * scanned.off[:, None] * scanned.directions
    if bead.closed:
        shift[-1] = shift[0]
    high = 1.0 - thinner * scanned.off
    rise = np.r_[high[:1], 0.5 * (high[1:] + high[:-1])]
    changed = (
        {}
        if not thinner
        else {
            "speed": bead.speed / rise,
            "height": high * (height if bead.height is None else bead.height),
        }
    )
    return replace(bead, points=bead.points + shift, tangents=_tangents(bead, shift), **changed)


def _tangents(bead: Bead, shift: Array) -> Array | None:
    """Return the tangents of the bead after a shift (n, 3) of its points; smooth points stay smooth."""
    if bead.tangents is None:
        return None
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)[:, None]
    rise = np.diff(shift, axis=0) / np.maximum(length, 1e-12)
    ends = (rise[-1:], rise[:1]) if bead.closed else (rise[:1], rise[-1:])
    incoming, outgoing = np.vstack([ends[0], rise]), np.vstack([rise, ends[1]])
    smooth = ((bead.tangents[:, 0] * bead.tangents[:, 1]).sum(axis=1) > 1.0 - CORNER)[:, None]
    mean = 0.5 * (incoming + outgoing)
    turned = bead.tangents + np.stack(
        [np.where(smooth, mean, incoming), np.where(smooth, mean, outgoing)], axis=1
    )
    return np.asarray(turned / np.linalg.norm(turned, axis=2, keepdims=True))


RUN = 20  # number of steps over which a slope is measured
LOOKED = 20_000  # maximum number of points of the first layer kept for charts


@dataclass(frozen=True)
class _Course:
    """Fraction of the scan offset by which each layer moves.

    It is 1 in layer `first_layer` and falls to 0 over `layers` layers. Layers below `first_layer` were scanned from
    above, so they move in proportion to their height.
    """

    first_layer: int
    layers: int

    def share(self, layer: int) -> float:
        if layer < self.first_layer:
            return layer / self.first_layer
        return max(0.0, 1.0 - (layer - self.first_layer) / self.layers)


def refuse_family(toolpath: Toolpath, where: str) -> None:
    """Raise InputError NOT_YET for families whose layers cannot be fitted to scans."""
    if not toolpath.traits.fits_scans(PLANES):
        raise InputError(
            "NOT_YET",
            where,
            "layers of the family {} cannot be fitted to a scan yet, only solids in planar "
            "layers and walls on a substrate; remove the scan",
            toolpath.family,
        )


def fit_layers(
    toolpath: Toolpath, scan: Scan, parameters: ScanParameters, left_out: int, motion: Array
) -> Toolpath:
    """Return the toolpath with its layers fitted to a scan.

    The first layer above the scan follows the scan. The next layers blend back to the plan.

    Parameters
    ----------
    toolpath : Toolpath
        The planned toolpath.
    scan : Scan
        The scan in part coordinates.
    parameters : ScanParameters
        First layer and band.
    left_out : int
        Number of points of the file that were dropped.
    motion : (4, 4) array
        Motion from measuring to part coordinates.

    Returns
    -------
    Toolpath
        The toolpath with a record of the fit.

    Raises
    ------
    InputError
        NO_LAYER, SCAN_MISSES, SCAN_OFF; NOT_YET as in `refuse_family`.
    """
    refuse_family(toolpath, scan.label)
    first_layer = parameters.first
    if first_layer >= len(toolpath.layers):
        raise InputError(
            "NO_LAYER",
            "substrate.after_layer",
            "there is no layer above {}: the last layer of {} is {}; give a lower layer",
            first_layer - 1,
            len(toolpath.layers),
            len(toolpath.layers) - 1,
        )
    directions_of = ways_of(toolpath)
    beads = toolpath.layers[first_layer].beads
    planned = along_beads(
        beads,
        directions_of,
        _refusing(scan, first_layer, toolpath.layer_height),
        1.0,
        toolpath.chord_error,
    )
    off = np.concatenate([scanned_bead.off for scanned_bead in planned])
    largest = float(np.abs(off).max())
    count = max(1, math.ceil(largest / (parameters.scan_band * toolpath.layer_height) - 1e-9))
    course = _Course(first_layer, count)
    above = _Above(toolpath, planned, directions_of, scan)
    layers, uneven = [], []
    for number, layer in enumerate(toolpath.layers):
        share = course.share(number)
        if share == 0.0:
            layers.append(layer)
            continue
        scanned = (
            planned
            if number == first_layer
            else along_beads(layer.beads, directions_of, above, share, toolpath.chord_error)
        )
        thinner = share - course.share(number + 1) if number >= first_layer else 0.0
        moved_beads = [
            move_bead(scanned_bead, share, thinner / toolpath.layer_height, toolpath.layer_height)
            for scanned_bead in scanned
        ]
        layers.append(replace(layer, beads=tuple(moved_beads)))
        if thinner:
            heights = toolpath.layer_height - thinner * np.concatenate(
                [scanned_bead.off for scanned_bead in scanned]
            )
            uneven.append((number, heights.min(), heights.max()))
    record = _record(
        planned,
        layers[first_layer],
        directions_of,
        scan,
        course,
        largest,
        len(toolpath.layers),
        left_out,
        motion,
    )
    uneven_heights = np.array(uneven) if uneven else toolpath.checks.uneven
    return replace(
        toolpath.add_checks(uneven=uneven_heights, fitted=record),
        layers=tuple(layers),
        issues=(*_issues(record, toolpath.layer_height), *toolpath.issues),
    )


def max_moves(record: Fitted, layers: Index) -> Array:
    """Return the maximum displacement of points by the fit to a scan, by layer.

    Parameters
    ----------
    record : Fitted
        The record of the fit.
    layers : (n,) int array
        Layers of the points.

    Returns
    -------
    (n,) array
        Maximum displacements, mm.
    """
    largest = float(np.abs(record.off).max(initial=0.0))
    reduction = 1.0 - (
        record.remains / largest if largest else 0.0
    )  # fraction of the blend back to the plan completed at the last layer
    count = (
        (record.layers - 1) / reduction if record.remains and record.layers > 1 else record.layers
    )
    course = _Course(record.layer, max(1, round(count)))
    return (
        largest
        * np.array([course.share(layer) for layer in range(int(layers.max(initial=0)) + 1)])[layers]
    )


def ways_of(toolpath: Toolpath) -> Ways:
    """Return a function that gives the growth directions (n, 3) at the points of a bead."""
    if toolpath.traits.stacks_layers:
        up = toolpath.frame[:3, 2]
        return lambda bead: np.tile(up, (len(bead), 1))
    return lambda bead: bead.build


def _refusing(scan: Scan, layer: int, height: float) -> Off:
    """Return a function that gives the scan offset at points of the first layer above the scan.

    The function raises InputError SCAN_MISSES if the scan does not cover the points, SCAN_OFF if it is too far away.
    """

    def off(points: Array, directions: Array) -> Array:
        heights = scan.heights(points, directions)
        bare = np.flatnonzero(~heights.covered)
        if len(bare):
            size = float(np.linalg.norm(np.ptp(scan.points, axis=0))) if len(scan.points) else 0.0
            raise InputError(
                "SCAN_MISSES",
                scan.label,
                "at {} of {} places in layer {} the scan has no nearby points, first at {}; the "
                "scan extends over {:.4g} mm, the layer over {:.4g} mm: scan the whole area "
                "below the layer, or check unit and fit",
                len(bare),
                len(points),
                layer,
                place(points[bare[0]]),
                size,
                float(np.linalg.norm(np.ptp(points, axis=0))),
            )
        farthest = int(np.abs(heights.off).argmax())
        if abs(heights.off[farthest]) > scan.within:
            raise InputError(
                "SCAN_OFF",
                scan.label,
                "the scan is {:.4g} mm away from layer {} at {}, more than substrate.scan_within "
                "= {:g} mm; check that the scan shows the right part, in the right unit and "
                "position",
                heights.off[farthest],
                layer,
                place(points[farthest]),
                scan.within,
            )
        return heights.off

    return off


class _Above:
    """Scan offset for other layers than the first, from the points of the first layer below or above."""

    def __init__(
        self, toolpath: Toolpath, planned: Sequence[Scanned], directions_of: Ways, scan: Scan
    ) -> None:
        self.first = planned
        self.is_stacked, self.scan = toolpath.traits.stacks_layers, scan
        points, off = zip(*(scanned_bead.samples() for scanned_bead in planned), strict=True)
        self.off, self.tree = np.concatenate(off), cKDTree(np.concatenate(points))
        self.plane = planned[0].bead.points[0]

    def __call__(self, points: Array, directions: Array) -> Array:
        if not self.is_stacked:
            return np.asarray(self.off[self.tree.query(points)[1]])
        feet = points - ((points - self.plane) * directions).sum(axis=1)[:, None] * directions
        heights = self.scan.heights(feet, directions)
        sure = heights.covered & (
            np.abs(np.where(heights.covered, heights.off, np.inf)) <= np.abs(self.off).max() + 1e-9
        )
        # outside the first layer, use the offset at the layer's edge
        return np.where(sure, heights.off, self.off[self.tree.query(feet)[1]])


def _record(
    planned: Sequence[Scanned],
    layer: Layer,
    directions_of: Ways,
    scan: Scan,
    course: _Course,
    largest: float,
    layers: int,
    left_out: int,
    motion: Array,
) -> Fitted:
    beads: list[Bead] = [
        bead.halved(np.arange(len(bead) - 1)) for bead in layer.beads
    ]  # adds the midpoints of the segments
    deposited = np.concatenate([bead.points for bead in beads])
    heights = scan.heights(deposited, np.concatenate([directions_of(bead) for bead in beads]))
    sample = np.unique(np.linspace(0, len(deposited) - 1, LOOKED).astype(np.intp))
    positions = np.concatenate([scanned_bead.bead.points for scanned_bead in planned])
    off = np.concatenate([scanned_bead.off for scanned_bead in planned])
    position_sample = np.unique(np.linspace(0, len(positions) - 1, LOOKED).astype(np.intp))
    return Fitted(
        scan.label,
        len(scan.points),
        left_out,
        course.first_layer,
        min(course.layers, layers - course.first_layer),
        positions[position_sample],
        off[position_sample],
        deposited[sample],
        np.where(heights.covered, heights.off, 0.0)[sample],
        _slope(planned),
        largest * course.share(layers - 1),
        motion,
    )


def _motion_words(motion: Array) -> str:
    """Describe the motion that aligned a scan with the plan."""
    if np.array_equal(motion, np.eye(4)):
        return Text("; the scan was used as measured, in part coordinates")
    angle = math.degrees(
        math.acos(min(1.0, max(-1.0, 0.5 * (float(np.trace(motion[:3, :3])) - 1.0))))
    )
    return Text(
        "; the scan was rotated by {:.3f} deg and its origin moved by {:.3f} mm to match the plan",
        angle,
        float(np.linalg.norm(motion[:3, 3])),
    )


def _slope(planned: Sequence[Scanned]) -> float:
    """Return the maximum slope of the scan offset along a bead, mm/mm."""
    rises = [0.0]
    for scanned_bead in planned:
        off = scanned_bead.samples()[1]
        if len(off) > RUN:
            rises.append(float(np.abs(off[RUN:] - off[:-RUN]).max()) / (RUN * STEP))
    return max(rises)


def _issues(record: Fitted, height: float) -> list[Issue]:
    issues = [
        Issue(
            NOTE,
            "SCAN_FITTED",
            Text(
                "{}: layer {} starts on the scan, which deviates {:.3f} to {:.3f} mm from the "
                "plan, and follows it within {:.3f} mm; {} layers blend back to the plan. {} "
                "points were used, {} with opposite normals ignored; beads rise by up to {:.1f} "
                "deg against the plan{}",
                record.file,
                record.layer,
                record.off.min(),
                record.off.max(),
                np.abs(record.left).max(),
                record.layers,
                record.points,
                record.left_out,
                math.degrees(math.atan(record.slope)),
                _motion_words(record.motion),
            ),
        )
    ]
    if record.remains > 0.05 * height:
        issues.append(
            Issue(
                WARNING,
                REMAINS_CODE,
                Text(
                    "the part has too few layers to blend back to the plan: the last layer is up "
                    "to {:.3f} mm off; raise substrate.scan_band to blend within fewer layers",
                    record.remains,
                ),
            )
        )
    return issues
