# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the nozzle is clear of bodies and deposit at the points of beads, and halfway between them.

The deposit has its width and height. Beads of the current layer next to the tip count as lines, and the lowest section of the
nozzle is left out (`collision.nozzle`), because it touches them on purpose.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision import deposit
from ...collision.nozzle import Nozzle, depositing
from ...collision.scene import Scene, scene
from ...geometry.columns import columns
from ...geometry.obstacles import Body
from ...geometry.walls.surface import dot
from ...parameters.cell import NozzleParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Index, Mask

CAP = 1e-9  # rad
SEAM = 1e-6  # rad that a closed bead's end may be past a turn


@dataclass(frozen=True, eq=False)
class Space:
    """Data that decide whether an axis at a point is clear: points (n, 3) in the order of deposit, own_start (n,) the first point
    of the beads that each overlaps by intention next to them.
    """

    points: Array
    own_start: Index
    scene: Scene
    nozzle: Nozzle
    max_tilt: float

    def clear(self, rows_: Index, axis: Array) -> Mask:
        """Whether the axes (k, 3) at the points numbered `rows_` (k,) are clear and within the cap."""
        x, y, z = columns(axis)
        clear: Mask = np.arctan2(np.hypot(x, y), z) <= self.max_tilt + CAP
        rows = np.flatnonzero(clear)
        clear_rows = rows_[rows]
        clear[rows] = ~self.scene.find_touching(
            self.nozzle,
            self.points[clear_rows],
            axis[rows],
            clear_rows + 1,
            self.own_start[clear_rows],
        )
        return clear


def nozzle_of(nozzle: NozzleParameters, bead_height: float = 0.0, lean: float = 0.0) -> Nozzle:
    """The nozzle for clearance checks of beads up to a height, mm, leaning by intention, rad."""
    return depositing(
        0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, bead_height, lean
    )


def space_of(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    max_tilt: float,
    often: bool = True,
    feature: int = 0,
) -> Space:
    """The clearance data of the points of a toolpath, in order, among bodies.

    max_tilt: rad. often: the data are used repeatedly; if not, they take less memory. feature: number of the feature whose points
    are checked, if several.
    """
    beads = [bead for _, _, bead in toolpath]
    points, build = (
        np.concatenate([getattr(bead, name) for bead in beads]) for name in ("points", "build")
    )
    counts = np.array([len(bead) for bead in beads])
    starts = np.cumsum(counts) - counts
    layer = np.repeat([i for i, _, _ in toolpath], counts)
    heights = toolpath.heights
    lean, own_start = 0.0, np.searchsorted(layer, layer)
    if (toolpath.features[feature] if toolpath.features else toolpath).family == "revolution":
        # directions and tools are turned as one there; the last turn of a spiral belongs to the current layer
        feature_rows = np.repeat(beads_of(toolpath, feature), counts)
        turned = np.arccos(
            np.clip(dot(build, np.concatenate([bead.tool for bead in beads])), -1.0, 1.0)
        )
        lean = float(turned[feature_rows].max())
        own_start = np.concatenate(
            [
                start + _turn_before(bead.parameter)
                for start, bead in zip(own_start[starts], beads, strict=True)
            ]
        )
    nozzle_ = nozzle_of(nozzle, float(heights.max()), lean)
    build_obstacles = deposit.build_deposit if often else deposit.in_parts
    obstacles = build_obstacles(points, build, toolpath.widths, heights, starts, foot=nozzle_.foot)
    # a bead that closes a gap overlaps those about the gap, of layers below too
    own_start = np.where(np.repeat([bead.closing for bead in beads], counts), 0, own_start)
    return Space(
        points, own_start, scene(bodies, points, nozzle_.reach, obstacles), nozzle_, max_tilt
    )


def beads_of(toolpath: Toolpath, feature: int | None) -> Mask:
    """(beads,) which beads are of a feature, where a toolpath has several; all where None is asked about."""
    mask: Mask = np.array(
        [
            feature is None or not toolpath.features or toolpath.layers[i].feature == feature
            for i, _, _ in toolpath
        ]
    )
    return mask


def _turn_before(angle: Array) -> Index:
    """(n,) the first point of a bead that is a turn or less before each of its points, of angles rising or falling."""
    turned = np.abs(angle - angle[0])
    return np.asarray(np.searchsorted(turned, turned - 2.0 * np.pi - SEAM))


def halfway(beads: Sequence[Bead], tool: Array) -> tuple[Array, Array]:
    """Points and axes (n, 3) halfway from each point to the next of its bead; at the last of a bead its own."""
    points, axes, start = [], [], 0
    for bead in beads:
        bead_tool = tool[start : start + len(bead)]
        start += len(bead)
        mean = bead_tool[:-1] + bead_tool[1:]
        points += [bead.outline.at(np.arange(len(bead) - 1), 0.5)[0], bead.points[-1:]]
        axes += [
            mean / np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), CAP),
            bead_tool[-1:],
        ]
    return np.concatenate(points), np.concatenate(axes)


def touched_between(space: Space, beads: Sequence[Bead], tool: Array, free: Mask) -> Mask:
    """The points (n,) that are free as the next of their bead is, and the nozzle touches halfway to it."""
    points, axes = halfway(beads, tool)
    both_free = free & np.r_[free[1:], False]
    both_free[np.cumsum([len(bead) for bead in beads]) - 1] = False
    midway = dataclasses.replace(
        space, points=points, nozzle=space.nozzle.halfway(), max_tilt=float(np.pi)
    )
    touched = np.zeros(len(points), dtype=bool)
    rows = np.flatnonzero(both_free)
    touched[rows] = ~midway.clear(rows, axes[rows])
    return touched


def halved(toolpath: Toolpath, between: Mask) -> Toolpath:
    """The toolpath with a point halfway after each marked point (n,)."""
    marks = iter(np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1]))
    return dataclasses.replace(
        toolpath,
        layers=tuple(
            dataclasses.replace(
                layer,
                beads=tuple(
                    bead.halved(np.flatnonzero(mark)) if mark.any() else bead
                    for bead, mark in zip(layer.beads, marks)
                ),
            )
            for layer in toolpath.layers
        ),
    )
