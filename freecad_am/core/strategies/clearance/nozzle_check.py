# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nozzle contacts during deposition, checked with the given tool axes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision import deposit
from ...collision.scene import Nozzle, Scene, build_bodies, depositing, scene
from ...geometry.columns import columns
from ...geometry.obstacles import Body
from ...geometry.walls.surface import dot
from ...issues import ERROR, NOTE, WARNING, Issue, Text, Word
from ...parameters.cell import NozzleParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Index, Mask

CAP = 1e-9  # rad
SEAM = 1e-6  # rad; maximum excess of a closed bead over a full turn


@dataclass(frozen=True, eq=False)
class Space:
    """Data that decide whether a tool axis at a point is clear.

    points: (n, 3) in print order. own_start: (n,) first point of the adjacent beads that the bead at each point overlaps
    intentionally.
    """

    points: Array
    own_start: Index
    scene: Scene
    nozzle: Nozzle
    max_tilt: float

    def clear(self, rows_: Index, axis: Array) -> Mask:
        """Whether the axes (k, 3) at the points `rows_` (k,) are clear and within max_tilt."""
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
    """Return the nozzle for clearance checks.

    Parameters
    ----------
    nozzle : NozzleParameters
        The nozzle of the cell.
    bead_height : float, optional
        Maximum bead height, mm.
    lean : float, optional
        Intended angle between tool axis and build direction, rad.

    Returns
    -------
    Nozzle
        The nozzle during deposition.
    """
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
    """Return the clearance data of a toolpath among bodies.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    bodies : sequence of Body
        Bodies in part coordinates.
    nozzle : NozzleParameters
        The nozzle.
    max_tilt : float
        Maximum angle of the tool axis from the vertical, rad.
    often : bool, optional
        Whether the data are used repeatedly. Otherwise they take less memory.
    feature : int, optional
        Index of the checked feature, if there are several.

    Returns
    -------
    Space
        The data for all points, in order.
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
    if (toolpath.features[feature].values if toolpath.features else toolpath).traits.has_axis:
        # directions and tools rotate together; the last turn of a spiral belongs to the current layer
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
    # a closing bead overlaps the beads around the gap, also in layers below
    own_start = np.where(np.repeat([bead.role.closing for bead in beads], counts), 0, own_start)
    return Space(
        points, own_start, scene(bodies, points, nozzle_.reach, obstacles), nozzle_, max_tilt
    )


def beads_of(toolpath: Toolpath, feature: int | None) -> Mask:
    """Return which beads belong to a feature.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    feature : int or None
        Index of the feature.

    Returns
    -------
    (beads,) array of bool
        All True for None, or if the toolpath has a single feature.
    """
    mask: Mask = np.array(
        [
            feature is None or not toolpath.features or toolpath.layers[i].feature == feature
            for i, _, _ in toolpath
        ]
    )
    return mask


def _turn_before(angle: Array) -> Index:
    """Return, for each point of a bead, the first point at most one turn before it, (n,); angles are monotonic."""
    turned = np.abs(angle - angle[0])
    return np.asarray(np.searchsorted(turned, turned - 2.0 * np.pi - SEAM))


def halfway(beads: Sequence[Bead], tool: Array) -> tuple[Array, Array]:
    """Return the midpoints and mean axes between each point and the next point of the bead.

    Parameters
    ----------
    beads : sequence of Bead
        The beads.
    tool : (n, 3) array
        Tool axes at all points.

    Returns
    -------
    points : (n, 3) array
        Midpoints, mm. The last point of a bead is returned unchanged.
    axes : (n, 3) array
        Unit vectors.
    """
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
    """Return the points with a nozzle contact halfway to the next point.

    Parameters
    ----------
    space : Space
        The clearance data.
    beads : sequence of Bead
        The beads.
    tool : (n, 3) array
        Tool axes at all points.
    free : (n,) bool array
        Points at which the nozzle is clear.

    Returns
    -------
    (n,) bool array
        True if the point and the next point are clear, but not the midpoint.
    """
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
    """Return a toolpath with midpoints added.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath, n points.
    between : (n,) array of bool
        Points after which the midpoint to the next point is added.

    Returns
    -------
    Toolpath
        The toolpath with more points.
    """
    marks = iter(np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1]))
    layers = []
    for layer in toolpath.layers:
        beads = [
            bead.halved(np.flatnonzero(mark)) if mark.any() else bead
            for bead, mark in zip(layer.beads, marks)
        ]
        layers.append(dataclasses.replace(layer, beads=tuple(beads)))
    return dataclasses.replace(toolpath, layers=tuple(layers))


CLEARANCE = "CLEARANCE"  # code of nozzle contacts during deposition


def locate_row(
    bead_keys: list[tuple[int, int]], begin: Index, row: int
) -> tuple[tuple[int, int], int]:
    """Return layer, bead and point of a row of the concatenated points.

    Parameters
    ----------
    bead_keys : list[tuple[int, int]]
        Layer and bead index of each bead.
    begin : int array
        First row of each bead.
    row : int
        The row.

    Returns
    -------
    bead_key : tuple of int
        Layer and bead index.
    point : int
        Index of the point in the bead.
    """
    bead = int(np.searchsorted(begin, row, side="right")) - 1
    return bead_keys[bead], row - int(begin[bead])


def tilt_issues(
    bead_keys: list[tuple[int, int]], begin: Index, tilt: Array, stuck: Mask
) -> list[Issue]:
    """Report where tool axes are tilted, and where no tilt helps.

    Parameters
    ----------
    bead_keys : list[tuple[int, int]]
        Layer and bead index of each bead.
    begin : (beads + 1,) int array
        First row of each bead, and the number of rows.
    tilt : (n,) array
        Tilts, rad.
    stuck : (n,) bool array
        Points with nozzle contact at every tilt.

    Returns
    -------
    list of Issue
        An error for stuck points, a note for tilted points.
    """
    bead = np.repeat(np.arange(len(bead_keys)), np.diff(begin))
    layer = np.array([key[0] for key in bead_keys])[bead]
    issues = []
    if stuck.any():
        bead_key, point = locate_row(bead_keys, begin, int(np.argmax(stuck)))
        issues.append(
            Issue(
                ERROR,
                CLEARANCE,
                Text(
                    "at every possible tilt, the nozzle touches substrate, fixture, platform or "
                    "deposit at {} point(s) of layers {} to {}",
                    int(stuck.sum()),
                    layer[stuck].min(),
                    layer[stuck].max(),
                ),
                *bead_key,
                point,
            )
        )
    moved = ~stuck & (tilt > 1e-9)
    if moved.any():
        worst = int(np.argmax(np.where(moved, tilt, 0.0)))
        bead_key, point = locate_row(bead_keys, begin, worst)
        first_layer, last_layer = int(layer[moved].min()), int(layer[moved].max())
        where = (
            Text("in layer {}", first_layer)
            if first_layer == last_layer
            else Text("in layers {} to {}", first_layer, last_layer)
        )
        issues.append(
            Issue(
                NOTE,
                "TILT_BACK",
                Text(
                    "{}, tool axes are tilted back by up to {:.2f} deg for clearance",
                    Word(where),
                    np.degrees(tilt[worst]),
                ),
                *bead_key,
                point,
            )
        )
    return issues


def turn_issues(fastest: float, limit: float) -> list[Issue]:
    """Return a warning if tilted tool axes turn by `fastest`, rad/mm, above the maximum `limit`; none if 0."""
    if not fastest:
        return []
    return [
        Issue(
            WARNING,
            "TURN_PASSED",
            Text(
                "for clearance, tool axes turn by up to {:.3g} deg/mm, faster than "
                "build_direction.max_turn ({:.3g} deg/mm); use a slimmer nozzle or allow a "
                "faster turn",
                np.degrees(fastest),
                np.degrees(limit),
            ),
        )
    ]


@dataclass(frozen=True)
class Looked:
    """Number of checked points, number of contacts, and layer, bead and point of the first contact, if any."""

    count: int
    touched: int
    first_touch: tuple[int, int, int] | None


def check_nozzle(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    max_points: int,
    feature: int | None = None,
) -> Looked:
    """Check at evenly distributed points whether the nozzle touches bodies or earlier deposit.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates, with bead widths and heights.
    bodies : sequence of Body
        Bodies in part coordinates, with the platform.
    nozzle : NozzleParameters
        The nozzle.
    max_points : int
        Maximum number of points.
    feature : int or None, optional
        Index of the feature to check; None for all features.

    Returns
    -------
    Looked
        Number of checked points and of contacts, and the first contact.
    """
    space = space_of(toolpath, bodies, nozzle, np.pi, often=False, feature=feature or 0)
    beads = list(toolpath)
    starts = np.cumsum([0, *(len(bead) for _, _, bead in beads)])
    feature_rows = np.flatnonzero(np.repeat(beads_of(toolpath, feature), np.diff(starts)))
    rows = feature_rows[
        np.unique(
            np.round(
                np.linspace(0, len(feature_rows) - 1, min(max_points, len(feature_rows)))
            ).astype(np.intp)
        )
    ]
    tool = np.concatenate([bead.tool for _, _, bead in beads])
    hit = rows[~space.clear(rows, tool[rows])]
    if not len(hit):
        return Looked(len(rows), 0, None)
    bead = int(np.searchsorted(starts, hit[0], side="right")) - 1
    return Looked(len(rows), len(hit), (*beads[bead][:2], int(hit[0] - starts[bead])))


def join_checks(looks: Sequence[Looked]) -> Looked | None:
    """Combine several checks; None if there are none."""
    if not looks:
        return None
    first_touch = next(
        (check.first_touch for check in looks if check.first_touch is not None), None
    )
    return Looked(
        sum(check.count for check in looks), sum(check.touched for check in looks), first_touch
    )


def nozzle_issues(
    toolpath: Toolpath, bodies: Sequence[Body], nozzle: NozzleParameters
) -> list[Issue]:
    """Report where the nozzle would touch bodies during deposition.

    For toolpaths that are not tilted for clearance.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    bodies : sequence of Body
        Bodies in part coordinates.
    nozzle : NozzleParameters
        The nozzle.

    Returns
    -------
    list of Issue
        One error, or none.
    """
    if not bodies:
        return []
    beads = [bead for _, _, bead in toolpath]
    points = np.concatenate([bead.points for bead in beads])
    tool = np.concatenate([bead.tool for bead in beads])
    around = nozzle_of(nozzle).bodies
    scene_ = build_bodies(bodies, points, around.reach)
    hit = scene_.find_touching(around, points, tool) | scene_.find_touching(
        around, *halfway(beads, tool)
    )
    if not hit.any():
        return []
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    bead_keys = [(i, j) for i, j, _ in toolpath]
    bead_key, point = locate_row(bead_keys, begin, int(np.argmax(hit)))
    names = Text.joined(" or ", (body.name for body in bodies))
    return [
        Issue(
            ERROR,
            CLEARANCE,
            Text(
                "the nozzle touches {} at {} of {} points, and on parts of revolution the nozzle "
                "does not tilt away from fixtures; move the fixtures, or use a slimmer nozzle",
                names,
                int(hit.sum()),
                len(points),
            ),
            *bead_key,
            point,
        )
    ]
