# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw solids: base cylinders, cones or plane, the guide and the first layer's contours."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.geometry.curves.guide import Guide
from ...core.geometry.developable import Plane
from ...core.geometry.on_hub import Base, Group, SolidsOnHub
from ...core.layers.field import footprints
from ...core.types import Array
from .lines import Lines
from .wall import WallNodes, unpickable

OUTLINE, TINT = (0.0, 0.45, 0.45), (0.1, 0.62, 0.6)
SIDES = 96
# extension of a base at either end, as a fraction of the axial distance between contours
MARGIN_RATIO = 0.15
# radial offset as a fraction of the radius, so that the base is visible in front of the hub face
OUTSIDE = 0.003
APEX_RATIO = 0.98  # fraction of the distance to the apex


class HubNodes(WallNodes):
    """Draws bases and first layers. Clicks pass through the bases, and through everything unless
    `pickable`.
    """

    tint, transparency = TINT, 0.65

    def __init__(self, pickable: bool) -> None:
        super().__init__(pickable)
        self.outline = Lines(2.0, OUTLINE)
        self.root.addChild(unpickable())
        self.root.addChild(self.outline.node)

    def set_solids(self, solids: SolidsOnHub) -> None:
        """Draw solids. Raises InputError OPEN_MESH."""
        self.set(drawing(solids))

    def set(self, drawn: Drawing) -> None:
        """Draw the result of `drawing`."""
        self.set_first(
            [contour for group in drawn.contours for solid in group for contour in solid]
        )
        self.outline.set(
            np.concatenate([np.zeros((0, 3)), *drawn.lines]), [len(line) for line in drawn.lines]
        )
        self.faces.set(drawn.points, drawn.corners)


class Drawing(NamedTuple):
    """The drawing of solids.

    contours: of each solid of each group, (k, 3), with the first point repeated. points, corners:
    points (n, 3) and triangles (m, 3) of the bases. lines: (k, 3), along the ends of the bases and
    up them.
    """

    contours: list[list[list[Array]]]
    points: Array
    corners: Array
    lines: list[Array]


NOTHING = Drawing([], np.zeros((0, 3)), np.zeros((0, 3), int), [])


def drawing(solids: SolidsOnHub) -> Drawing:
    """Return the drawing of solids, computed without the window. Raises InputError OPEN_MESH."""
    contours = [first_contours(group, solids.chord_error) for group in solids.groups]
    bases = [
        _base(group, [contour for solid in curves for contour in solid])
        for group, curves in zip(solids.groups, contours)
    ]
    counts = np.cumsum([0, *(len(points) for points, _, _ in bases)])
    return Drawing(
        contours,
        np.concatenate([np.zeros((0, 3)), *(points for points, _, _ in bases)]),
        np.concatenate(
            [np.zeros((0, 3), int), *(corners + k for (_, corners, _), k in zip(bases, counts))]
        ),
        [line for _, _, curves in bases for line in curves],
    )


def first_contours(group: Group, chord_error: float) -> list[list[Array]]:
    """Return the curves (k, 3) in which each solid of a group leaves the base, in part coordinates.

    The curves are closed; the first point is repeated.
    """
    return [
        [np.concatenate([loop, loop[:1]]) for loop in loops]
        for loops in footprints(group, chord_error)
    ]


def _base(group: Group, contours: list[Array]) -> tuple[Array, Array, list[Array]]:
    """Return points and triangles of the base around contours, and lines along its ends and up it."""
    base = group.base
    if isinstance(base.surface, Guide):
        points, corners, lines = _plane(
            base, np.concatenate(contours or [body.vertices for body in group.bodies])
        )
        length = max(
            float(base.surface.distance(base.inside(body.vertices)).max()) for body in group.bodies
        )
        arc_lengths = np.linspace(0.0, length, SIDES + 1)
        return points, corners, [*lines, base.to_part(base.surface.at(arc_lengths)[0])]
    if isinstance(base.surface, Plane):
        return _plane(base, np.concatenate(contours or [body.vertices for body in group.bodies]))
    low, high = _reach(base, contours or [body.vertices for body in group.bodies])
    outside = base.surface.offset(OUTSIDE * base.surface.radius)
    turn = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    rings = [base.to_part(_ring(outside, turn, z)) for z in (low, high)]
    k = np.arange(SIDES)
    corners = np.concatenate(
        [
            np.stack([k, k + 1, k + SIDES + 1], axis=1),
            np.stack([k + 1, k + SIDES + 2, k + SIDES + 1], axis=1),
        ]
    )
    up = [np.stack([rings[0][number], rings[1][number]]) for number in range(0, SIDES, SIDES // 8)]
    return np.concatenate(rings), corners, [*rings, *up]


def _plane(base: Base, around: Array) -> tuple[Array, Array, list[Array]]:
    """Return points, triangles and border of a rectangle of the base around points (n, 3)."""
    flat = base.inside(around)[:, :2]
    low, high = flat.min(axis=0), flat.max(axis=0)
    margin = MARGIN_RATIO * float((high - low).max())
    (x0, y0), (x1, y1) = low - margin, high + margin
    corners = base.to_part(np.array([[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]]))
    return corners, np.array([[0, 1, 2], [0, 2, 3]]), [np.concatenate([corners, corners[:1]])]


def _reach(base: Base, curves: list[Array]) -> tuple[float, float]:
    along = base.inside(np.concatenate(curves))[:, 2]
    low, high = float(along.min()), float(along.max())
    margin = MARGIN_RATIO * max(high - low, 0.1 * base.surface.radius)
    return low - margin, high + margin if base.surface.is_cylinder else min(
        high + margin, APEX_RATIO * base.surface.height
    )


def _ring(surface: Any, turn: Array, z: float) -> Array:
    radius = surface.radius - z * np.tan(surface.taper)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(len(turn), z)])
