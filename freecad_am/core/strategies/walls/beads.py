# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads from curves on a wall: points, tangents and directions; and the issues of layers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.frames import TURN, unit
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface_wall import SurfaceWall
from ...issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import SurfaceParameters
from ...process import classes
from ...slicing.wall_directions import (
    MIN_IN_PLANE,
    cap_lean,
    lean_tool,
    limit_turns,
    local_directions,
    project_onto_plane,
)
from ...toolpath import Bead, BeadRole
from ...types import Array

UP = np.array([0.0, 0.0, 1.0])
TOLERANCE_RAD = 1e-9  # rad


class Along(NamedTuple):
    """Unit vectors (n, 3) at the points of a bead.

    forward: along the bead. up: up the wall, perpendicular to the bead. normal: out of the wall.
    """

    forward: Array
    up: Array
    normal: Array

    def reversed(self) -> Along:
        """Return the directions for the bead in the opposite direction."""
        return Along(-self.forward[::-1], self.up[::-1], self.normal[::-1])


class Directions(NamedTuple):
    """Build directions and tool axes (n, 3) of a bead.

    back: maximum angle by which max_tilt limited the tilt, rad. spread: maximum angle by which max_turn spread the
    directions, rad.
    """

    build: Array
    tool: Array
    back: float
    spread: float


def symmetry_plane(wall: SurfaceWall | PatchWall, build: BuildDirectionParameters) -> Array | None:
    """Return the plane that contains the tool axes.

    Parameters
    ----------
    wall : SurfaceWall or PatchWall
        The wall, with a known plane of symmetry if any.
    build : BuildDirectionParameters
        Build direction with its mode and plane.

    Returns
    -------
    (3,) array or None
        Unit normal; None if tool axes may lean in any direction.

    Raises
    ------
    InputError
        NO_SYMMETRY_PLANE if a plane of symmetry is requested and none is known for the wall.
    """
    if build.mode != "symmetry-plane":
        return None
    if build.plane is not None:
        return np.asarray(np.array(build.plane) / np.linalg.norm(build.plane))
    normal = wall.symmetry_normal
    if normal is None:
        raise InputError(
            "NO_SYMMETRY_PLANE",
            "build_direction.mode",
            "{} is not a bend of a torus, so there is no plane of symmetry; give the normal as "
            "build_direction.plane, or use local, layer or fixed",
            wall.label,
        )
    return normal


def directions(
    points: Array,
    closed: bool,
    along: Along,
    build: BuildDirectionParameters,
    plane: Array | None,
    label: str,
) -> Directions:
    """Return build directions and tool axes of a bead.

    Parameters
    ----------
    points : (n, 3) array
        Points of the bead, mm.
    closed : bool
        Whether the bead is closed.
    along : Along
        Directions along the bead, up the wall and out of it.
    build : BuildDirectionParameters
        Mode, lead, tilt and limits.
    plane : (3,) array or None
        Unit normal of the plane onto which directions are projected; None for any
        direction.
    label : str
        Name of the wall, for messages.

    Returns
    -------
    Directions
        The directions and their deviation from the requested directions.

    Raises
    ------
    InputError
        NO_DIRECTION if a direction is normal to the plane, TURN_LIMIT if the turn rate cannot be
        reduced enough.
    """
    up = along.up
    if build.mode == "fixed":
        up = np.tile(UP, (len(up), 1))
    elif build.mode == "layer":
        mean = up.mean(axis=0)
        length = np.linalg.norm(mean)
        up = np.tile(mean / length if length > MIN_IN_PLANE else UP, (len(up), 1))
    tool = lean_tool(up, along.forward, along.normal, build.lead, build.tilt)
    axes_pair = [up] if tool is up else [up, tool]
    if plane is not None:
        axes_pair = [project_onto_plane(axes, plane, label) for axes in axes_pair]
    turned = [cap_lean(axes, build.max_tilt) for axes in axes_pair]
    axes_pair, back, spread = [axes for axes, _ in turned], turned[-1][1], 0.0
    if build.turn() < np.inf:  # last, because the tilt limit increases the turn rate
        slower = [
            limit_turns(points, axes, closed, build.turn(), max_lean=build.max_tilt)
            for axes in axes_pair
        ]
        axes_pair = [axes for axes, _ in slower]
        spread = float(max(departure.max() for _, departure in slower))
    return Directions(axes_pair[0], axes_pair[-1], back, spread)


def notes(keyed_directions: list[tuple[int, Directions]]) -> list[Issue]:
    """Return notes on the maximum deviations from the requested directions; input by layer of each bead."""
    issues = []
    for code, values, text in (
        (
            "TILT_CAPPED",
            [directions_.back for _, directions_ in keyed_directions],
            "tool axes are turned back by up to {:.3g} deg to stay within build_direction.max_tilt",
        ),
        (
            "TURN_LIMITED",
            [directions_.spread for _, directions_ in keyed_directions],
            "tool axes are spread along the bead, by up to {:.3g} deg, to "
            "turn no faster than build_direction.max_turn",
        ),
    ):
        worst = int(np.argmax(values))
        if values[worst] > TOLERANCE_RAD:
            issues.append(
                Issue(NOTE, code, Text(text, np.degrees(values[worst])), keyed_directions[worst][0])
            )
    return issues


MIN_DISTANCE_MM = (
    1e-3  # mm; nearer points of a bead are merged, because no controller resolves such a move
)


class Traced(NamedTuple):
    """Points (n, 3) of a bead, with unit tangents (n, 2, 3) on arrival and departure.

    A closed bead ends at its start point.
    """

    points: Array
    tangents: Array
    closed: bool

    def reversed(self) -> Traced:
        """Return the bead in the opposite direction."""
        return Traced(self.points[::-1], -self.tangents[::-1, ::-1], self.closed)


def traced(curve: SpaceCurve, w: Array, closed: bool) -> Traced:
    """Return the bead through parameters of a curve.

    Points that nearly coincide are merged. A closed bead ends exactly at its start point.

    Parameters
    ----------
    curve : SpaceCurve
        The curve.
    w : (n,) array
        Parameters of the points.
    closed : bool
        Whether the bead is closed.

    Returns
    -------
    Traced
        Points and tangents.
    """
    points, out, _ = curve.at(w)
    if closed:
        points[-1] = points[0]
    into = out.copy()
    corners = curve.corners
    if len(corners):
        nearest = np.clip(
            np.searchsorted(curve.w[corners], curve.wrap(w) - 1e-12), 0, len(corners) - 1
        )
        is_corner = np.abs(curve.w[corners][nearest] - curve.wrap(w)) < 1e-9 * curve.period
        into[is_corner], out[is_corner] = (
            curve.into[corners[nearest[is_corner]]],
            curve.out[corners[nearest[is_corner]]],
        )
    points, into, out = _merge_points(points, into, out)
    if not closed:
        into[0], out[-1] = out[0], into[-1]
    return Traced(points, unit(np.stack([into, out], axis=1)), closed)


def _merge_points(points: Array, into: Array, out: Array) -> tuple[Array, Array, Array]:
    """Merge points nearer than MIN_DISTANCE_MM to the previous point; the first and the last point stay.

    Of merged points, such as an end next to a corner, the incoming tangent of the first and the outgoing tangent of the
    last remain.
    """
    if np.linalg.norm(np.diff(points, axis=0), axis=1).min() >= MIN_DISTANCE_MM:
        return points, into, out
    starts, end = [0], len(points) - 1
    for k in range(1, end):
        if np.linalg.norm(points[k] - points[starts[-1]]) >= MIN_DISTANCE_MM:
            starts.append(k)
    merged = end
    while len(starts) > 1 and np.linalg.norm(points[end] - points[starts[-1]]) < MIN_DISTANCE_MM:
        merged = starts.pop()
    starts.append(merged)
    ends = [*(k - 1 for k in starts[1:]), end]
    return points[[*starts[:-1], end]], into[starts], out[ends]


def directions_along(trace: Traced, normal: Array, up: Array) -> Along:
    """Return the directions at the points of a bead; at a corner, the mean of both sides.

    Parameters
    ----------
    trace : Traced
        Points and tangents of the bead.
    normal : (n, 3) array
        Normals out of the wall.
    up : (n, 3) array
        Vectors away from the layer below, not along the bead.

    Returns
    -------
    Along
        Unit vectors along the bead, up the wall and out of it.
    """
    into, out = trace.tangents[:, 0], trace.tangents[:, 1]
    return Along(unit(into + out), local_directions(normal, into, out, up), normal)


class BeadSettings(NamedTuple):
    """Settings of a wall's beads.

    plane: unit normal (3,) of the plane that contains the tool axes, if any. label: name of the wall, for messages.
    """

    build: BuildDirectionParameters
    process: ProcessParameters
    plane: Array | None
    label: str

    def bead(
        self, trace: Traced, vectors: Along, layer: int, closing: bool = False
    ) -> tuple[Bead, Directions]:
        """Return a bead and its directions.

        The variable of the bead's polynomial is the arc length, scaled to one turn (2 pi).

        Parameters
        ----------
        trace : Traced
            Points and tangents of the bead.
        vectors : Along
            Directions along the bead, up the wall and out of it.
        layer : int
            Index of the layer, for the bead's class.
        closing : bool, optional
            Whether the bead closes a gap between fronts.

        Returns
        -------
        bead : Bead
            The bead.
        directions : Directions
            Directions of the bead.
        """
        bead_class = classes.wall_bead_class(layer, closing)
        build = classes.leaning(self.build, self.process, bead_class)
        directions_ = directions(trace.points, trace.closed, vectors, build, self.plane, self.label)
        speed = np.full(len(trace.points), self.process.for_class(bead_class).travel_speed)
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(trace.points, axis=0), axis=1))]
        return Bead(
            trace.points,
            directions_.build,
            directions_.tool,
            TURN * length / length[-1],
            speed,
            trace.closed,
            tangents=trace.tangents,
            role=BeadRole(closing=closing, bead_class=bead_class),
        ), directions_


def spacing_issues(distances: list[Array], strategy: SurfaceParameters) -> list[Issue]:
    """Report the range of local distances between layers.

    Parameters
    ----------
    distances : list of (n,) array
        Distances of each layer after the first, mm.
    strategy : SurfaceParameters
        Layer height, spacing and tolerances, mm.

    Returns
    -------
    list of Issue
        An issue SPACING: a note, or a warning if the range is not as requested. Empty for one
        layer.
    """
    if not distances:
        return []
    smallest = min(layer.min() for layer in distances)
    largest = max(layer.max() for layer in distances)
    height = strategy.layer_height
    exact = strategy.spacing == "constant-distance"
    # ten times the tolerance is allowed between points, where arcs approximate the front
    allowed = 10.0 * strategy.tolerance if exact else strategy.band * height
    text = Text("the local distance between layers is {:.6g} to {:.6g} mm", smallest, largest)
    if max(height - smallest, largest - height) <= allowed:
        return [Issue(NOTE, "SPACING", text)]
    worst = int(np.argmax([np.abs(layer - height).max() for layer in distances])) + 1
    advice = (
        "set a larger strategy.tolerance to accept the deviation"
        if exact
        else "use spacing: constant-distance for an even distance"
    )
    return [
        Issue(
            WARNING,
            "SPACING",
            Text("{}, the layer height {:g} mm; {}", Word(text), height, Word(advice)),
            worst,
        )
    ]


def corner_notes(turns: list[Array]) -> list[Issue]:
    """Report corners of the layers' fronts, where a robot slows down.

    Parameters
    ----------
    turns : list of (n,) array
        Turn angles at the corners of each layer, rad.

    Returns
    -------
    list of Issue
        A note CORNERS at the sharpest corner; empty without corners.
    """
    cornered = [index for index, layer in enumerate(turns) if len(layer)]
    if not cornered:
        return []
    sharpest = [float(layer.max(initial=0.0)) for layer in turns]
    return [
        Issue(
            NOTE,
            "CORNERS",
            Text(
                "{} of {} fronts have corners, first in layer {}; the sharpest corner turns by "
                "{:.3g} deg, and the robot slows down there",
                len(cornered),
                len(turns),
                cornered[0],
                np.degrees(max(sharpest)),
            ),
            int(np.argmax(sharpest)),
        )
    ]


def turn_notes(rates: list[float], strategy: SurfaceParameters) -> list[Issue]:
    """Report the sharpest turn of layers, as a warning if smooth layers exceed their limit.

    rates: rad/mm of each layer within the wall, infinite where it has corners.
    """
    # the substrate determines the first layer
    over = [index for index, rate in enumerate(rates) if index and rate > strategy.bead_turn]
    corners = sum(np.isinf(rates[index]) for index in over)
    finite = np.where(np.isinf(rates), 0.0, rates)
    if strategy.spacing == "smooth" and over:
        corner_text = Text(", {} in corners", corners) if corners else ""
        return [
            Issue(
                WARNING,
                "TURN",
                Text(
                    "a band of {:g} % is too narrow: within the wall {} of {} layers turn by "
                    "more than {:.3g} deg/mm{}, first layer {}, by up to {:.3g} deg/mm{}, and "
                    "the robot slows down there; use a wider strategy.band to round the layers",
                    100.0 * strategy.band,
                    len(over),
                    len(rates),
                    np.degrees(strategy.bead_turn),
                    Word(corner_text),
                    over[0],
                    np.degrees(finite[1:].max()),
                    Word(" elsewhere" if corners else ""),
                ),
                int(np.argmax(rates[1:])) + 1,
            )
        ]
    text = Text(
        "no layer has a corner; within the wall the layers turn by up to {:.3g} deg/mm",
        np.degrees(finite.max()),
    )
    return [Issue(NOTE, "TURN", text, int(np.argmax(finite)))] if not np.isinf(rates).any() else []


def short_note(dropped: int) -> list[Issue]:
    """Return a note about beads omitted because they are too short."""
    if not dropped:
        return []
    return [
        Issue(
            NOTE,
            "SHORT_BEADS",
            Text("{} bead(s) at the end shorter than half a layer height are omitted", dropped),
        )
    ]
