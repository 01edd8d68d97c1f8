# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes of beads on a wall (Chalvin 2019, section II D), as the parameters ask for them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface_wall import SurfaceWall
from ...issues import NOTE, InputError, Issue, Text
from ...parameters.build_direction import BuildDirectionParameters
from ...slicing.directions.wall import (
    MIN_IN_PLANE,
    cap_lean,
    lean_tool,
    limit_turns,
    project_onto_plane,
)
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
    """Unit normal (3,) of the plane that tool axes stay in, None if they may lean any way.

    InputError NO_SYMMETRY_PLANE if a plane of symmetry is requested and the wall has no known one.
    """
    if build.mode != "symmetry-plane":
        return None
    plane_normal = build.plane_normal()
    if plane_normal is not None:
        return np.asarray(np.array(plane_normal) / np.linalg.norm(plane_normal))
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
    """The directions at the points (n, 3) of a bead. plane: unit normal (3,) of the one they are projected onto, if any.

    InputError NO_DIRECTION where one is normal to that plane, TURN_LIMIT where they cannot be made to turn slower.
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
        axes_pair, spread = (
            [axes for axes, _ in slower],
            float(max(departure.max() for _, departure in slower)),
        )
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
