# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of curves on a wall: points, tangents and directions; and the issues of their layers."""

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
    """Unit vectors (n, 3) at the points of a bead: the way the bead runs, up the wall at right angles to it, and the normal
    out of the wall."""

    forward: Array
    up: Array
    normal: Array

    def reversed(self) -> Along:
        """The directions of the bead run the other way."""
        return Along(-self.forward[::-1], self.up[::-1], self.normal[::-1])


class Directions(NamedTuple):
    """Build directions and tool axes (n, 3) of a bead; the largest angles (rad) by which max_tilt has turned them back, and max_turn
    has spread them.
    """

    build: Array
    tool: Array
    back: float
    spread: float


def symmetry_plane(wall: SurfaceWall | PatchWall, build: BuildDirectionParameters) -> Array | None:
    """Return the plane that tool axes stay in.

    Parameters
    ----------
    wall : SurfaceWall or PatchWall
        The wall, perhaps with a known plane of symmetry.
    build : BuildDirectionParameters
        Build direction with its mode and plane.

    Returns
    -------
    (3,) array or None
        Unit normal; None if tool axes may lean any way.

    Raises
    ------
    InputError
        NO_SYMMETRY_PLANE if a plane of symmetry is requested and the wall has no known one.
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
            "{} is not a bend of a torus, so it has no plane of symmetry; give the normal as "
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
        The directions and how far they depart from the requested ones.

    Raises
    ------
    InputError
        NO_DIRECTION where one is normal to that plane, TURN_LIMIT where they cannot be made
        to turn slower.
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
    if build.turn() < np.inf:  # last, for turned back beyond the level they turn faster
        slower = [
            limit_turns(points, axes, closed, build.turn(), max_lean=build.max_tilt)
            for axes in axes_pair
        ]
        axes_pair = [axes for axes, _ in slower]
        spread = float(max(departure.max() for _, departure in slower))
    return Directions(axes_pair[0], axes_pair[-1], back, spread)


def notes(keyed_directions: list[tuple[int, Directions]]) -> list[Issue]:
    """Notes on how far directions depart from the requested ones, by layer of each bead."""
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
    1e-3  # mm; nearer points of a bead are merged: no controller resolves the time between them
)


class Traced(NamedTuple):
    """Points (n, 3) of a bead and its unit tangents (n, 2, 3), arriving at and leaving each. A closed one ends where it
    starts."""

    points: Array
    tangents: Array
    closed: bool

    def reversed(self) -> Traced:
        """Run the other way."""
        return Traced(self.points[::-1], -self.tangents[::-1, ::-1], self.closed)


def traced(curve: SpaceCurve, w: Array, closed: bool) -> Traced:
    """Return the bead through parameters of a curve.

    Points that nearly coincide are merged; a closed bead ends exactly where it starts.

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
    """The columns (n, 3) with points nearer than MIN_DISTANCE_MM to the one before left out; the first and the last stay. Of merged
    points, such as an end next to a corner, the outgoing tangent of the last and the incoming one of the first remain.
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
    """Return the directions at the points of a bead, at a corner halfway between its two sides.

    Parameters
    ----------
    trace : Traced
        Points and tangents of the bead.
    normal : (n, 3) array
        Normals out of the wall.
    up : (n, 3) array
        Vectors away from the layer below that are not along the bead.

    Returns
    -------
    Along
        Unit vectors along the bead, up the wall and out of it.
    """
    into, out = trace.tangents[:, 0], trace.tangents[:, 1]
    return Along(unit(into + out), local_directions(normal, into, out, up), normal)


class BeadSettings(NamedTuple):
    """Settings of a wall's beads. plane: unit normal (3,) of the plane that tool axes stay in, if any. label: the wall's, for messages."""

    build: BuildDirectionParameters
    process: ProcessParameters
    plane: Array | None
    label: str

    def bead(
        self, trace: Traced, vectors: Along, layer: int, closing: bool = False
    ) -> tuple[Bead, Directions]:
        """Return a bead and its directions.

        The variable of its polynomial is the arc length, scaled to one turn (2 pi).

        Parameters
        ----------
        trace : Traced
            Points and tangents of the bead.
        vectors : Along
            Directions along the bead, up the wall and out of it.
        layer : int
            Number of the layer, for the bead's class.
        closing : bool, optional
            Whether the bead closes a gap between fronts.

        Returns
        -------
        bead : Bead
            The bead.
        directions : Directions
            Its directions.
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
        A note SPACING, a warning if the range is not as requested; empty for one layer.
    """
    if not distances:
        return []
    smallest = min(layer.min() for layer in distances)
    largest = max(layer.max() for layer in distances)
    height = strategy.layer_height
    exact = strategy.spacing == "constant-distance"
    # between the points, where arcs approximate the front, ten times the tolerance is allowed
    allowed = 10.0 * strategy.tolerance if exact else strategy.band * height
    text = Text("the local distance between layers is {:.6g} to {:.6g} mm", smallest, largest)
    if max(height - smallest, largest - height) <= allowed:
        return [Issue(NOTE, "SPACING", text)]
    worst = int(np.argmax([np.abs(layer - height).max() for layer in distances])) + 1
    advice = (
        "set a larger strategy.tolerance to accept this"
        if exact
        else "spacing: constant-distance is even"
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
    """Report corners that the fronts of layers have formed, for a robot slows down there.

    Parameters
    ----------
    turns : list of (n,) array
        Turns at the corners of each layer, rad.

    Returns
    -------
    list of Issue
        A note CORNERS at the sharpest; empty without corners.
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
                "{} of {} fronts have corners, first layer {}; the sharpest turns by {:.3g} deg. "
                "The robot slows down there",
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
    # the first layer is the substrate's
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
                    "more than {:.3g} deg/mm{}, first layer {}, by up to {:.3g} deg/mm{}. The "
                    "robot slows down there; a wider strategy.band rounds them",
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
        "no layer has a corner; within the wall they turn by up to {:.3g} deg/mm",
        np.degrees(finite.max()),
    )
    return [Issue(NOTE, "TURN", text, int(np.argmax(finite)))] if not np.isinf(rates).any() else []


def short_note(dropped: int) -> list[Issue]:
    """Says that beads too short to be worth a start are left out."""
    if not dropped:
        return []
    return [
        Issue(
            NOTE,
            "SHORT_BEADS",
            Text("{} bead(s) at the end shorter than half a layer height are omitted", dropped),
        )
    ]
