# SPDX-License-Identifier: LGPL-2.1-or-later
"""Helical beads on faces of revolution: round shafts and bores."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..filling.centre import PlaneCurve
from ..filling.cover import Cover
from ..geometry.frames import TURN, pose, unit
from ..geometry.walls.patch_wall import PatchWall
from ..issues import NOTE, InputError, Issue, Text
from ..layers.chart import PART, OpenSurface, axes, count_pieces
from ..layers.parted_chart import borders
from ..layers.surface import Slice, Wrapped
from ..parameters.filled import CladdingParameters
from ..parameters.process import ProcessParameters
from ..types import Array, Index
from .solids.filling import Filled

ROUNDNESS = 2e-3  # fraction of the radius; maximum deviation of a rim from a circle
LEAN_RAD = math.radians(1.0)  # maximum angle between a normal and the plane through the axis
STEPS_PER_BEAD = 16  # steps along the profile in a bead spacing
LEAST_STEPS = 32  # of the straight distance between the rims
MOST_STEPS = 20_000  # of a profile
LOOKS_PER_TURN = 64  # samples of a turn in the test for bending
AZIMUTHS = 64  # azimuths at which the cover is measured
SAME_TURNS_MM = 1e-6  # mm; shorter profiles between the end turns have no helix between these


class Axis(NamedTuple):
    """Axis of a sheet. frame: (4, 4) pose, z along the axis. lower, upper: height and radius of the rims, mm."""

    frame: Array
    lower: tuple[float, float]
    upper: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Profile:
    """Meridian of a layer on a sheet of revolution.

    feet: (k, 2) radius and height on the faces, mm. arc: (k,) arc length on the layer, mm. radius: (k,)
    radius on the layer, mm.
    """

    feet: Array
    arc: Array
    radius: Array

    @property
    def length(self) -> float:
        """Length of the profile on the layer, mm."""
        return float(self.arc[-1])

    @cached_property
    def radius_integral(self) -> Array:
        """Return the integral of the radius over the arc length.

        Returns
        -------
        (k,) array
            Values at the points of the profile, mm2.
        """
        mean = 0.5 * (self.radius[1:] + self.radius[:-1])
        return np.asarray(np.r_[0.0, np.cumsum(mean * np.diff(self.arc))])

    @property
    def mean_radius(self) -> float:
        """Mean radius of the layer, mm."""
        return float(self.radius_integral[-1]) / self.length


@dataclass(frozen=True, eq=False)
class RevolvedLayer(OpenSurface):
    """Layer on a sheet of revolution, a `LayerSurface`.

    On the plane, x is the azimuth times the mean radius and y the arc length of the profile, mm.
    sign: 1 if the sheet faces away from the axis, -1 in a bore; x runs so that the plane is seen from outside.
    distance: mm above the faces.
    """

    sheet: PatchWall
    axis: Axis
    profile: Profile
    sign: float
    distance: float

    def azimuth(self, flat: Array) -> Array:
        """Return the azimuths (n,) of points of the plane, rad."""
        return np.asarray(self.sign * flat[:, 0] / self.profile.mean_radius)

    def unroll(self, points: Array) -> Array:
        """Return the points (n, 2) of the plane of the nearest profile points, mm."""
        local = (points - self.axis.frame[:3, 3]) @ self.axis.frame[:3, :3]
        azimuth = np.arctan2(local[:, 1], local[:, 0])
        meridian = np.column_stack([np.hypot(local[:, 0], local[:, 1]), local[:, 2]])
        distances = np.linalg.norm(meridian[:, None] - self.profile.feet, axis=2)
        arc = self.profile.arc[np.argmin(distances, axis=1)]
        return np.column_stack([self.sign * azimuth * self.profile.mean_radius, arc])

    def in_part(self, flat: Array) -> tuple[Array, Array]:
        """Return points (n, 3) and unit normals (n, 3) of the layer in the part."""
        azimuth = self.azimuth(flat)
        radius, height = (
            np.interp(flat[:, 1], self.profile.arc, column) for column in self.profile.feet.T
        )
        local = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height])
        approximate = local @ self.axis.frame[:3, :3].T + self.axis.frame[:3, 3]
        feet, normals = self.sheet.project(approximate)
        return feet + self.distance * normals, normals

    def wrap(self, flat: Array) -> Wrapped:
        """Map a curve of the plane to bead points in the part."""
        points, normals = self.in_part(flat)
        axis_x, axis_y = self.axes(normals)
        azimuth = self.azimuth(flat)
        around = np.column_stack([-np.sin(azimuth), np.cos(azimuth), np.zeros(len(azimuth))])
        heading = self.sign * around @ self.axis.frame[:3, :3].T
        turn = np.arctan2((heading * axis_y).sum(axis=1), (heading * axis_x).sum(axis=1))
        return Wrapped(points, normals, -np.unwrap(turn))

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return the number of pieces of each edge that keeps the chord error, mm."""
        look = TURN * self.profile.mean_radius / LOOKS_PER_TURN
        return count_pieces(lambda points: self.in_part(points)[0], flat, look, chord_error)


def filled_layers(
    sheet: PatchWall, strategy: CladdingParameters, process: ProcessParameters
) -> Iterator[tuple[Slice, Filled]]:
    """Yield the layers of a sheet of revolution, each with one helical bead.

    Each end has a whole turn at half a bead spacing from the rim. The helix between them has the
    largest pitch up to the bead spacing with a whole number of turns. Odd layers run back from the far
    end, so their lay is reversed.

    Parameters
    ----------
    sheet : PatchWall
        Smoothly connected faces.
    strategy : CladdingParameters
        Number of layers, layer height and bead spacing.
    process : ProcessParameters
        Azimuth of the start.

    Yields
    ------
    layer : Slice
        The layer, without regions.
    filled : Filled
        Its bead with the measured cover.

    Raises
    ------
    InputError
        NOT_REVOLVED if the faces do not turn about one axis, or do not close around it.
    """
    refuse_fill_keys(strategy)
    axis = find_axis(sheet)
    points, normals = trace_profile(sheet, axis, strategy.bead_spacing)
    for number in range(strategy.layers):
        distance = number * strategy.layer_height
        surface = _layer_on(sheet, axis, points, normals, distance)
        azimuth = surface.sign * (process.seam.angle + number * process.seam.step)
        curve = wind_helix(surface.profile, strategy.bead_spacing, azimuth, number % 2 == 1)
        cover = measure_cover(surface.profile, curve, strategy.bead_spacing)
        yield Slice(number, PART, surface, ()), Filled([curve], (), [[0]], cover, [])


def refuse_fill_keys(strategy: CladdingParameters) -> None:
    """Raise InputError NOT_FOR_FAMILY for parameters of fills that a helix does not have."""
    for key, is_given in (
        ("fill_density", strategy.fill_density < 1.0),
        ("deflection", strategy.deflection != 0.0),
    ):
        if is_given:
            raise InputError(
                "NOT_FOR_FAMILY",
                f"strategy.{key}",
                "a helix is one dense bead along the normals; remove strategy.{}, or use pattern: fill",
                key,
            )


def find_axis(sheet: PatchWall) -> Axis:
    """Return the axis of a sheet that closes around it.

    The axis passes through the centres of the two rims, which are circles across it. Every normal
    lies in a plane through the axis.

    Raises
    ------
    InputError
        NOT_REVOLVED.
    """
    mesh = sheet.mesh
    loops = [mesh.vertices[loop] for loop in borders(mesh)]
    if len(loops) != 2:
        raise _not_revolved(
            sheet,
            Text(
                "the faces have {} border loop(s), but faces that close around an axis have two",
                len(loops),
            ),
        )
    centres, directions, radii = zip(*(_circle(loop) for loop in loops))
    direction = directions[0]
    direction = direction * np.sign(direction[np.abs(direction).argmax()])
    heights = [float(centre @ direction) for centre in centres]
    order = np.argsort(heights)
    lower, upper = (int(index) for index in order)
    across = max(radii)
    rise = centres[upper] - centres[lower]
    off_axis = float(np.linalg.norm(rise - (rise @ direction) * direction))
    parallel = abs(float(directions[1] @ direction))
    roundness = max(
        _roundness(loop - centre, radius, direction)
        for loop, centre, radius in zip(loops, centres, radii)
    )
    if off_axis > ROUNDNESS * across or parallel < math.cos(LEAN_RAD) or roundness > ROUNDNESS:
        raise _not_revolved(sheet, "the faces end in rims that are not circles about one axis")
    axis_x, axis_y = axes(direction[None])
    frame = pose(np.column_stack([axis_x[0], axis_y[0], direction]), centres[lower])
    feet, normals = sheet.project(mesh.vertices)
    local = (feet - frame[:3, 3]) @ frame[:3, :3]
    around = unit(np.column_stack([-local[:, 1], local[:, 0], np.zeros(len(local))]))
    lean = np.abs(((normals @ frame[:3, :3]) * around).sum(axis=1))
    if float(lean.max()) > math.sin(LEAN_RAD):
        raise _not_revolved(sheet, "the normals of the faces do not point to or from one axis")
    return Axis(frame, (0.0, radii[lower]), (float(rise @ direction), radii[upper]))


def _circle(loop: Array) -> tuple[Array, Array, float]:
    """Return centre (3,), unit normal (3,) and mean radius, mm, of a closed polyline (n, 3)."""
    middle = 0.5 * (loop + np.roll(loop, -1, axis=0))
    weight = np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1)
    centre = weight @ middle / weight.sum()
    local = loop - centre
    normal = unit(np.cross(local, np.roll(local, -1, axis=0)).sum(axis=0)[None])[0]
    return centre, normal, float(np.linalg.norm(local, axis=1).mean())


def _roundness(local: Array, radius: float, direction: Array) -> float:
    """Return the largest deviation of a loop (n, 3) about its centre from a circle, as a share of its radius."""
    out_of_plane = np.abs(local @ direction).max()
    return float(max(np.abs(np.linalg.norm(local, axis=1) - radius).max(), out_of_plane) / radius)


def _not_revolved(sheet: PatchWall, reason: str) -> InputError:
    return InputError(
        "NOT_REVOLVED",
        sheet.label,
        "{}; choose faces of revolution that close around their axis, or use pattern: fill",
        reason,
    )


def trace_profile(sheet: PatchWall, axis: Axis, spacing: float) -> tuple[Array, Array]:
    """Return a meridian of a sheet.

    Parameters
    ----------
    sheet : PatchWall
        The sheet, part coordinates.
    axis : Axis
        Its axis.
    spacing : float
        Bead spacing, mm; the steps are fine fractions of it.

    Returns
    -------
    points : (k, 3) array
        Points from the lower to the upper rim, mm.
    normals : (k, 3) array
        Unit normals.

    Raises
    ------
    InputError
        NOT_REVOLVED if the profile does not lead from rim to rim.
    """
    rotation, origin = axis.frame[:3, :3], axis.frame[:3, 3]
    ends = (
        np.array([[radius, 0.0, height] for height, radius in (axis.lower, axis.upper)])
        @ rotation.T
        + origin
    )
    (start, end), normals = sheet.project(ends)
    straight = float(np.linalg.norm(end - start))
    step = min(spacing / STEPS_PER_BEAD, straight / LEAST_STEPS)
    points, point_normals = [start], [normals[0]]
    around = rotation[:, 1]
    while float(np.linalg.norm(end - points[-1])) > 1.5 * step:
        if len(points) > MOST_STEPS:
            raise _not_revolved(sheet, "the profile of the faces does not lead from rim to rim")
        along = np.cross(point_normals[-1], around)
        if len(points) == 1:
            along *= np.sign(along @ (end - start)) or 1.0
        else:
            along *= np.sign(along @ (points[-1] - points[-2]))
        foot, normal = sheet.project((points[-1] + step * along)[None])
        points.append(foot[0])
        point_normals.append(normal[0])
    return np.array([*points, end]), np.array([*point_normals, normals[1]])


def _layer_on(
    sheet: PatchWall, axis: Axis, points: Array, normals: Array, distance: float
) -> RevolvedLayer:
    """Return the layer at a distance, mm, above the meridian points (k, 3) with normals (k, 3)."""
    rotation, origin = axis.frame[:3, :3], axis.frame[:3, 3]
    feet = (points - origin) @ rotation
    local_normals = normals @ rotation
    raised = feet + distance * local_normals
    arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(raised[:, ::2], axis=0), axis=1))]
    if (raised[:, 0] <= 0.0).any() or (
        np.diff(raised[:, ::2], axis=0) * np.diff(feet[:, ::2], axis=0)
    ).sum(axis=1).min() <= 0.0:
        raise InputError(
            "FOLDED",
            "strategy.layers",
            "a layer {:.4g} mm above {} would pass the centre of a bore or hollow; deposit fewer layers",
            distance,
            sheet.label,
        )
    # seen from outside, the meridian runs up where x runs around the axis in the positive sense
    meridian = np.diff(feet[:2], axis=0)[0]
    sign = float(np.sign(np.cross([0.0, 1.0, 0.0], meridian) @ local_normals[0]))
    return RevolvedLayer(sheet, axis, Profile(feet[:, ::2], arc, raised[:, 0]), sign, distance)


def wind_helix(profile: Profile, spacing: float, azimuth: float, is_reversed: bool) -> PlaneCurve:
    """Return the bead of a layer on the plane.

    Parameters
    ----------
    profile : Profile
        Profile of the layer.
    spacing : float
        Bead spacing, mm; the largest pitch.
    azimuth : float
        Azimuth of the start on the plane, rad.
    is_reversed : bool
        Whether the bead starts at the far end, so that its lay is reversed.
    """
    turn = TURN * profile.mean_radius
    margin = 0.5 * min(spacing, profile.length)
    climb = profile.length - 2.0 * margin
    turns = math.ceil(climb / spacing - 1e-9) if climb > SAME_TURNS_MM else 0
    corners = [(0.0, margin), (turn, margin)]
    if turns:
        top = profile.length - margin
        corners += [((1 + turns) * turn, top), ((2 + turns) * turn, top)]
    points = np.array(corners) + [azimuth * profile.mean_radius, 0.0]
    if is_reversed:
        points[:, 1] = profile.length - points[:, 1]
    return PlaneCurve(points, False, "spiral", 0)


def note_ends(volume: float) -> Issue:
    """Return the note on a volume, mm3, that helices deposit twice beside the whole turns at their ends."""
    return Issue(
        NOTE,
        "DEPOSITED_TWICE",
        Text(
            "each helix begins and ends beside a whole turn, where about {:.3g} cm3 are deposited "
            "twice in total",
            1e-3 * volume,
        ),
    )


def measure_cover(profile: Profile, curve: PlaneCurve, width: float) -> Cover:
    """Measure how a helical bead of constant width covers its layer.

    At each of AZIMUTHS azimuths the bead covers intervals of the profile. Their union is integrated.

    Parameters
    ----------
    profile : Profile
        Profile of the layer.
    curve : PlaneCurve
        The bead on the plane.
    width : float
        Bead width, mm.
    """
    turn = TURN * profile.mean_radius
    start, end = curve.points[0, 0], curve.points[-1, 0]
    area = TURN * float(profile.radius_integral[-1])
    inside = outside = 0.0
    for azimuth in start + turn * (np.arange(AZIMUTHS) + 0.5) / AZIMUTHS:
        crossings = np.arange(azimuth, end, turn)
        heights = np.sort(np.interp(crossings, curve.points[:, 0], curve.points[:, 1]))
        low, high = heights - 0.5 * width, heights + 0.5 * width
        high = np.minimum(high, np.r_[low[1:], np.inf])
        ends = np.clip([low, high], 0.0, profile.length)
        covered = np.diff(np.interp(ends, profile.arc, profile.radius_integral), axis=0).sum()
        inside += TURN / AZIMUTHS * float(covered)
        beyond = (high - low).sum() - np.diff(ends, axis=0).sum()
        outside += TURN / AZIMUTHS * float(beyond) * profile.mean_radius
    return Cover(area, max(area - inside, 0.0), outside, inside + outside)
