# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of a layer from curves on the plane: wrapped onto the layer, with directions and speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...filling.centre import PlaneCurve, divide_by_share
from ...filling.cover import Cover, total
from ...geometry.curves.plane_curve import (
    arcs,
    divide_edges,
    fractions,
    nearest_among,
    running_sums,
    sines,
    steps,
)
from ...geometry.frames import TURN
from ...geometry.on_hub import Base, SolidsOnHub
from ...geometry.regions.region import select_significant, simplified
from ...layers.plane_field import PlaneLayer, group_of, slabs
from ...layers.surface import Slice
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process import classes
from ...process.bead_model import BeadModel
from ...process.model_notes import at_speed, limit_acceleration, radii, segment_speeds
from ...process.seams import START, SeamLocation, SeamPlacer, start_bead
from ...toolpath import Bead, BeadRole
from ...types import Array, Mask
from .filling import bead_width
from .flattened_bead import Course
from .torch_tilt import Lean, Turned, hold_torch

OUTLINE = 0.55  # bead spacings; maximum distance from the outline of beads along it (nominal: 0.5)
PROBES = 9  # number of longest edges that decide the side of the outline


def leaning(
    curve: PlaneCurve, layer: Slice, strategy: FilledParameters, build: BuildDirectionParameters
) -> Lean:
    """Return how the torch leans on a curve.

    The lead and tilt of the build direction apply. On a contour, and on a spiral while it runs
    along the outline, the torch is also deflected towards the outline.

    Parameters
    ----------
    curve : PlaneCurve
        The curve on the plane.
    layer : Slice
        Layer of the curve.
    strategy : FilledParameters
        Deflection and bead spacing.
    build : BuildDirectionParameters
        Build direction with lead and tilt.

    Returns
    -------
    Lean
        The lean.
    """
    plain = Lean(build.lead, build.tilt)
    if strategy.deflection == 0.0 or curve.kind not in ("contour", "spiral") or curve.ring > 0:
        return plain
    count, until = len(curve.points), math.inf
    if not curve.closed:
        adjacent = nearest_among(layer.borders, curve.points)[1] < OUTLINE * strategy.bead_spacing
        count = len(adjacent) if adjacent.all() else int(np.argmin(adjacent))
        if count < 2:
            return plain
        if count < len(adjacent):
            until = float(np.hypot(*steps(curve.points[:count], False).T).sum())
    edges = steps(curve.points[:count], curve.closed and not curve.turns)
    longest = np.argsort(-np.hypot(*edges.T), kind="stable")[:PROBES]
    middle = curve.points[longest] + 0.5 * edges[longest]
    is_left = (
        sines(edges[longest], nearest_among(layer.borders, middle)[0] - middle).sum() > 0.0
    )  # the outline is left of the curve
    side = -1.0 if is_left else 1.0
    return Lean(build.lead, build.tilt + side * strategy.deflection, build.tilt, until)


WRAP_SHARE = 0.5  # fraction of the chord error between a bead's chords and the surface
GRID = 6  # decimals of mm to which points are rounded for comparison
NEEDLESS = (
    0.02  # fraction of the chord error; minimum effect of a needed point (offsets double the nodes)
)
SHARES = 0.02  # resolution of bead shares, as a fraction of the nominal width
MIN_DISTANCE_MM = (
    2e-3  # mm; nearer points are merged, because no controller resolves the time of such a move
)
AGILE = (
    500.0  # mm/s^2; acceleration that every machine follows, used if only the speed sets the width
)
BRIEF = 1.0001e-4  # s; minimum duration of a move (narrow, fast beads would have shorter moves)


class MadeBead(NamedTuple):
    """A bead with its report.

    clamped: (n,) where the speed for the width is outside the table. tight: (n,) where the bend is tighter than in the
    table. Both are None without a bead model. turned: rotation of the torch.
    """

    bead: Bead
    clamped: Mask | None = None
    tight: Mask | None = None
    turned: Turned | None = None


def bead_of(
    curve: PlaneCurve,
    layer: Slice,
    strategy: FilledParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
) -> MadeBead:
    """Return the bead of a curve, with the settings and lean of its class.

    The variable of the bead's polynomial is the arc length, scaled to one turn (2 pi).

    Parameters
    ----------
    curve : PlaneCurve
        The curve on the plane.
    layer : Slice
        Layer of the curve.
    strategy : FilledParameters
        Chord error, spacing and deflection.
    build : BuildDirectionParameters
        Build direction.
    process : ProcessParameters
        Speeds by class.
    model : BeadModel or None
        Bead model that sets the speeds; None to use the travel speed.

    Returns
    -------
    MadeBead
        The bead in part coordinates, with its report.
    """
    surface = layer.surface
    base = layer.base
    name = classes.fill_bead_class(curve.kind, layer.number)
    build, process = classes.leaning(build, process, name), process.for_class(name)
    line, share = curve.closed_points(surface.period)
    error = WRAP_SHARE * strategy.chord_error
    flat = needed(
        line, error, None if share is None else select_significant(arcs(line), share, SHARES)
    )
    if share is not None and strategy.adapts_widths:
        flat_share = np.interp(fractions(flat), fractions(line), share)
        flat = divide_by_share(flat, flat_share)[0]
    flat = divide_edges(flat, surface.pieces(flat, error))[0]
    course = Course(flat, curve.closed, surface.for_sheet(flat, curve.sheet))
    flat, points, normals, tool, turned = hold_torch(
        course, leaning(curve, layer, strategy, build), build, strategy.chord_error
    )
    points = base.to_part(points)
    if curve.closed:
        points[-1] = points[0]
    arc = running_sums(np.linalg.norm(np.diff(points, axis=0), axis=1))
    bead = Bead(
        points,
        base.rotate_to_part(normals),
        base.rotate_to_part(tool),
        TURN * arc / arc[-1],
        np.full(len(arc), process.travel_speed),
        curve.closed,
        role=BeadRole(curve.kind, curve.ring, bead_class=name),
    )
    if share is not None:
        share = np.interp(fractions(flat), fractions(line), share)
    heights = surface.heights(flat) if model is None else None
    closed = curve.closed and not curve.turns
    return _thinned(
        _set_speed(bead, flat, closed, share, heights, strategy, process, model)
    )._replace(turned=turned)


def restart(made_bead: MadeBead, location: SeamLocation) -> MadeBead:
    """Return a closed bead that starts at a place, with its report."""
    if location == START:
        return made_bead
    index, added = location.segment, location.share > 0.0

    def roll(mask: Mask | None) -> Mask | None:
        if mask is None:
            return None
        longer = np.insert(mask, index + 1, mask[index + 1]) if added else mask
        start = index + added
        rolled: Mask = np.r_[longer[start:-1], longer[: start + 1]]
        return rolled

    return made_bead._replace(
        bead=start_bead(made_bead.bead, location),
        clamped=roll(made_bead.clamped),
        tight=roll(made_bead.tight),
    )


def start_beads(
    made_beads: Sequence[MadeBead], placer: SeamPlacer, layer: int
) -> Sequence[MadeBead]:
    """Return the beads of a layer with their seams placed.

    Parameters
    ----------
    made_beads : sequence of MadeBead
        Beads of the layer, in the order in which they were made.
    placer : SeamPlacer
        The rule, with the layer below.
    layer : int
        Index of the layer in its stack.

    Returns
    -------
    sequence of MadeBead
        The beads.
    """
    if not placer.is_active:
        return made_beads
    locations = placer.choose_locations([made_bead.bead for made_bead in made_beads], layer)
    return list(map(restart, made_beads, locations))


class BeadMaker:
    """Make beads of curves with `bead_of`; a curve repeated in another planar layer reuses its bead, translated."""

    def __init__(
        self,
        strategy: FilledParameters,
        build: BuildDirectionParameters,
        process: ProcessParameters,
        model: BeadModel | None,
    ) -> None:
        self._parameters = strategy, build, process, model
        self._may_move = strategy.deflection == 0.0
        self._made: dict[tuple[PlaneCurve, str], tuple[Base, PlaneLayer, MadeBead]] = {}

    def bead_of(self, curve: PlaneCurve, layer: Slice) -> MadeBead:
        """Return the bead of a curve in a layer."""
        surface = layer.surface
        if not self._may_move or not isinstance(surface, PlaneLayer):
            return bead_of(curve, layer, *self._parameters)
        key = curve, classes.fill_bead_class(curve.kind, layer.number)
        base, plane, made_bead = self._made.get(key, (None, None, None))
        if base is not layer.base or plane is None or made_bead is None:
            made_bead = bead_of(curve, layer, *self._parameters)
            self._made[key] = layer.base, surface, made_bead
            return made_bead
        rise = layer.base.rotate_to_part(np.array([[0.0, 0.0, surface.height - plane.height]]))
        return made_bead._replace(bead=replace(made_bead.bead, points=made_bead.bead.points + rise))


def _thinned(dense: MadeBead) -> MadeBead:
    """Remove points that follow the previous point too soon for any controller."""
    is_kept = _sparse(dense.bead.points, dense.bead.speed[1:], BRIEF)
    if is_kept.all():
        return dense
    clamped, tight = (
        None if mask is None else mask[is_kept] for mask in (dense.clamped, dense.tight)
    )
    return MadeBead(dense.bead.thinned(np.flatnonzero(is_kept)), clamped, tight)


def _set_speed(
    bead: Bead,
    flat: Array,
    closed: bool,
    share: Array | None,
    heights: Array | None,
    strategy: FilledParameters,
    process: ProcessParameters,
    model: BeadModel | None,
) -> MadeBead:
    """Return a bead at the speeds that keep its width.

    flat: (n, 2) points on the plane. share: (n,) fraction of the nominal width, None if uniform. heights: (n,) local
    layer height, mm, None if uniform; not used with a bead model.
    """
    if model is not None:
        radius = radii(flat, closed, process.bead_width)
        return MadeBead(
            *at_speed(bead, radius, flat, closed, process, model, 1.0 if share is None else share)
        )
    if share is None and heights is None:
        return MadeBead(bead)
    high = np.ones(len(flat)) if heights is None else heights / strategy.layer_height
    section = high if share is None else high * share
    speed = limit_acceleration(
        flat, process.travel_speed / section, closed, max(process.acceleration, AGILE)
    )
    section = process.travel_speed / speed  # at constant wire feed
    bead = replace(bead, speed=segment_speeds(speed))
    if share is None:
        return MadeBead(replace(bead, height=strategy.layer_height * section))
    width = bead_width(strategy, process, model) * section / high
    return MadeBead(replace(bead, width=width, height=heights))


def _sparse(points: Array, speed: Array, min_step: float) -> Mask:
    """Return the mask of polyline points (n, k) at least `min_step` apart; both ends stay.

    Distances are along the polyline and divided by the speed (n-1,) of the segments.
    """
    arc = running_sums(np.linalg.norm(np.diff(points, axis=0), axis=1) / speed)
    is_kept: Mask = np.ones(len(arc), dtype=bool)
    is_kept[1:] = np.diff(np.floor(arc / min_step)) > 0.0
    is_kept &= (arc < arc[-1] - min_step) | (arc == 0.0)
    is_kept[0] = is_kept[-1] = True
    rows = np.flatnonzero(is_kept)
    between = np.linalg.norm(np.diff(points[rows], axis=0), axis=1) / speed[rows[1:] - 1]
    # of two adjacent points on both sides of a step, the first is enough
    is_kept[rows[1:-1][between[:-1] < min_step]] = False
    return is_kept


def needed(line: Array, chord_error: float, besides: Mask | None = None) -> Array:
    """Remove coinciding points and points that the chord error does not need.

    Parameters
    ----------
    line : (n, 2) array
        Polyline on the plane, mm.
    chord_error : float
        Chord error, mm.
    besides : (n,) bool array or None, optional
        Points to keep in any case.

    Returns
    -------
    (m, 2) array
        The remaining points.
    """
    grid = np.ascontiguousarray(
        np.round(line, GRID) + 0.0
    )  # equal points round equally for any position of the hub
    simple = np.ascontiguousarray(simplified(grid, NEEDLESS * chord_error))
    is_kept = np.isin(grid.view(np.complex128).ravel(), simple.view(np.complex128).ravel())
    is_kept[[0, -1]] = True
    line = line[is_kept if besides is None else is_kept | besides]
    result: Array = line[_sparse(line, np.ones(len(line) - 1), MIN_DISTANCE_MM)]
    return result


EXACT = 3e-3  # fraction of the part volume; solids that share more overlap


def layer_volumes(
    strategy: FilledParameters, covers: Sequence[Cover]
) -> tuple[float, float, float]:
    """Return total, missed and stray volume of layers.

    Parameters
    ----------
    strategy : FilledParameters
        Layer height.
    covers : sequence of Cover
        Areas of the layers.

    Returns
    -------
    layers : float
        Volume of the layers, mm3.
    missed : float
        Volume that no bead covers, mm3.
    stray : float
        Deposit outside the layers, mm3.
    """
    total_, missed, outside, _ = (strategy.layer_height * area for area in total(covers))
    return total_, missed, outside


def volumes(
    part_volume: float | None,
    strategy: FilledParameters,
    covers: Sequence[Cover],
    uncut: float = 0.0,
    within: Array | None = None,
    numbers: Sequence[int] = (),
) -> tuple[float, float, float]:
    """Return part volume, missed volume and stray volume.

    Each cut solid counts as high as its layers. Volume above the last cut is therefore missed,
    and layers beyond the part are stray.

    Parameters
    ----------
    part_volume : float or None
        Volume of the part, mm3. None, with a margin or an open part, means a part as large as its
        layers.
    strategy : FilledParameters
        Layer height.
    covers : sequence of Cover
        Areas of the layers.
    uncut : float, optional
        Volume of solids without a layer cut, mm3. It counts as missed even if other solids'
        layers extend beyond the part.
    within : (k,) array or None, optional
        Volume of the part within each layer, mm3, so that stray deposit in a layer does not
        offset missed volume in another layer. None compares only the sum over the layers.
    numbers : sequence of int, optional
        Layer indices of the covers.

    Returns
    -------
    part : float
        Volume of the part, mm3.
    missed : float
        Volume that no bead covers, mm3.
    stray : float
        Deposit outside the part, mm3.
    """
    layer_volume, missed, outside = layer_volumes(strategy, covers)
    if part_volume is None:
        return layer_volume, missed, outside
    if within is not None and abs(float(within.sum()) - part_volume) <= EXACT * part_volume:
        areas = np.bincount(
            np.asarray(numbers, dtype=np.intp),
            [cover.area for cover in covers],
            minlength=len(within),
        )
        within = np.r_[within, np.zeros(len(areas) - len(within))]
        lacking = within - strategy.layer_height * areas
        return (
            part_volume,
            missed + float(np.maximum(lacking, 0.0).sum()),
            outside + float(np.maximum(-lacking, 0.0).sum()),
        )
    uncut = min(uncut, part_volume)
    cut = part_volume - uncut
    return (
        part_volume,
        missed + uncut + max(cut - layer_volume, 0.0),
        outside + max(layer_volume - cut, 0.0),
    )


def slab_volumes(solids: SolidsOnHub, strategy: FilledParameters) -> Array | None:
    """Return the volumes of solids between the planes of their layers.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids.
    strategy : FilledParameters
        Layer height and kind of layers.

    Returns
    -------
    (k,) array or None
        Volumes, mm3; None if layers are not planes.
    """
    group = group_of(solids)
    if group is None or strategy.has_curved_layers or strategy.follows_guide:
        return None  # curved layers may begin on a plane too
    return slabs(group, strategy.layer_height, np.zeros((0, 3)), np.zeros(0)).part_volume


def twice_volume(
    made_beads: Sequence[MadeBead],
    strategy: FilledParameters,
    covers: Sequence[Cover],
    width: float,
) -> float:
    """Return the over-deposited volume: bead volume in excess of the covered area.

    Each bead counts as wide as its spacing.

    Parameters
    ----------
    made_beads : sequence of MadeBead
        The beads.
    strategy : FilledParameters
        Layer height and spacing.
    covers : sequence of Cover
        Areas of the layers.
    width : float
        Width of beads without a predicted width, mm.

    Returns
    -------
    float
        Volume, mm3.
    """
    area = 0.0
    for bead in (made_bead.bead for made_bead in made_beads):
        step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        wide = np.full(len(bead), width) if bead.width is None else bead.width
        high = np.ones(len(bead)) if bead.height is None else bead.height / strategy.layer_height
        section = wide * high * strategy.bead_spacing / width
        area += float((0.5 * (section[1:] + section[:-1])) @ step)
    return max(total(covers).over(area), 0.0) * strategy.layer_height
