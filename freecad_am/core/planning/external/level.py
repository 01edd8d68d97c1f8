# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tilt the part by the positioner axes so that the tool is upright where it deposits.

If one positioner pose keeps all tool axes of the job, or of a bead, close enough to the vertical,
the positioner holds this pose, because no axis moves without need. Otherwise it follows the bead
and keeps the tool axis vertical at every point. It passes through the pole without reversing.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np

from ...issues import ERROR, Issue, Text
from ...kinematics.cell import Cell
from ...kinematics.external import ExternalAxes, tilt_from
from ...toolpath import Bead, Toolpath
from ...types import Array
from ..joint_path import BeadPath, JointPath
from ..task import Parts
from ..turns.unwrap import is_otherwise, seam_notes
from . import stroke
from .stroke import ROUNDING, directions_on_face, middle

Place = tuple[int, int]
Levelled = tuple[list[Bead], list[Place], list[Issue]]


def ways(cell: Cell, toolpath: Toolpath) -> Iterator[Levelled]:
    """Yield the beads of `levelled`, then a variant with seams and cuts for axes that have a whole
    turn, if it differs.

    In the first variant, planning the rotation chooses such seams.
    """
    if cell.external is None:
        yield (
            [bead for _, _, bead in toolpath],
            [(layer, index) for layer, index, _ in toolpath],
            standing(cell, toolpath),
        )
        return
    initial = levelled(cell, toolpath)
    yield initial
    again = levelled(cell, toolpath, whole_turns=True)
    if [(len(bead), *bead.points[0]) for bead in again[0]] != [
        (len(bead), *bead.points[0]) for bead in initial[0]
    ]:
        yield again


def levelled(cell: Cell, toolpath: Toolpath, whole_turns: bool = False) -> Levelled:
    """Return the beads with external axis values that keep the tool upright.

    If an axis lacks the range for a bead, the seam of the bead is moved, or the bead is split.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    toolpath : Toolpath
        The toolpath in part coordinates.
    whole_turns : bool, optional
        Whether to move seams and split beads also for axes that have a whole turn.

    Returns
    -------
    beads : list of Bead
        The beads, with external axis values at their points.
    bead_ids : list of (int, int)
        Layer and index of each bead.
    issues : list of Issue
        Tool axes beyond `max_from_vertical`, moved seams and split beads.
    """
    external = cell.external
    assert external is not None
    allowed = allowed_by_layer(toolpath.parts)
    bead_directions = [directions_on_face(cell, bead.tool) for _, _, bead in toolpath]
    previous, hold = _standing_all(
        external, cell, bead_directions, min(allowed[layer] for layer, _, _ in toolpath)
    )
    levelled_beads: list[Bead] = []
    bead_ids: list[Place] = []
    issues: list[Issue] = []
    helped: tuple[list[int], list[int]] = [], []
    for (layer, index, bead), directions in zip(toolpath, bead_directions, strict=True):
        max_lean = allowed[layer]
        values = (
            np.tile(previous, (len(bead), 1))
            if hold
            else _follow_directions(external, cell, directions, max_lean, previous)
        )
        sections = [dataclasses.replace(bead, external=values)]
        if stroke.lacks(cell, values, whole_turns) or not stroke.runs_on(
            cell, sections[0], max_lean, toolpath.rules.overlap
        ):
            sections = (
                stroke.find_room(cell, bead, max_lean, previous, toolpath.rules.overlap) or sections
            )
        for section in sections:
            assert section.external is not None
            tilt = tilt_from(
                external.upright(directions_on_face(cell, section.tool), section.external),
                external.up,
            )
            issues += _not_level(bool(external.turning), tilt, max_lean, (layer, index))
            previous = section.external[-1]
        levelled_beads += sections
        bead_ids += [(layer, index)] * len(sections)
        if is_otherwise(bead, sections):
            helped[len(sections) > 1].append(layer)
    return levelled_beads, bead_ids, [*issues, *seam_notes(*helped)]


def standing(cell: Cell, toolpath: Toolpath) -> list[Issue]:
    """Report beads that tilt more than allowed, for a part that no external axis rotates.

    There is one issue per bead.
    """
    up, issues = cell.machine.base[:3, :3] @ cell.up, list[Issue]()
    allowed = allowed_by_layer(toolpath.parts)
    for layer, index, bead in toolpath:
        max_lean = allowed[layer]
        if max_lean >= math.pi:
            continue
        directions = (
            cell.poses.station[None, :3, 2]
            if cell.arrangement.carries_part
            else directions_on_face(cell, bead.tool)
        )
        issues += _not_level(False, tilt_from(directions, up), max_lean, (layer, index))
    return issues


def _not_level(turning: bool, tilt: Array, max_lean: float, bead_id: Place) -> list[Issue]:
    """Report a bead whose tool axes tilt too far, at its worst point.

    tilt: (n,) angle from the vertical, rad. turning: whether an axis rotates the part.
    """
    worst = int(tilt.argmax())
    if not tilt[worst] > max_lean + ROUNDING:
        return []
    leans, allowed = math.degrees(tilt[worst]), math.degrees(max_lean)
    if not turning:
        return [
            Issue(
                ERROR,
                "NOT_LEVEL",
                Text(
                    "the tool axis would be {:.3g} deg from the vertical, but "
                    "build_direction.max_from_vertical allows {:.3g} deg and no axis turns the "
                    "part; put the part on a positioner, or raise the limit",
                    leans,
                    allowed,
                ),
                *bead_id,
                worst,
            )
        ]
    return [
        Issue(
            ERROR,
            "NOT_LEVEL",
            Text(
                "the tool axis would be {:.3g} deg from the vertical, but "
                "build_direction.max_from_vertical allows {:.3g} deg and the positioner cannot "
                "compensate; mount the part differently, or raise the limit",
                leans,
                allowed,
            ),
            *bead_id,
            worst,
        )
    ]


def figures(cell: Cell, path: JointPath) -> dict[str, object]:
    """Return statistics of the external axes along the deposit.

    These are the maximum angle of the tool axis from the vertical, deg, and the total travel of
    each axis, deg or mm.
    """
    farthest = math.degrees(farthest_from_vertical(cell, path.beads))
    return {"from_vertical_max_deg": farthest, **axes_figures(cell, path.beads)}


def farthest_from_vertical(cell: Cell, paths: Sequence[BeadPath]) -> float:
    """Return the maximum angle between the tool axis and the vertical, rad."""
    external, farthest = cell.external, 0.0
    assert external is not None
    for path in paths:
        values = cell.external_of(path.joints)
        if values is None or not path.reachable:
            continue
        upright = external.upright(directions_on_face(cell, path.bead.tool), values)
        farthest = max(farthest, float(tilt_from(upright, external.up).max()))
    return farthest


def axes_figures(cell: Cell, paths: Sequence[BeadPath]) -> dict[str, object]:
    """Return the total travel of each external axis along the deposit, deg or mm."""
    external = cell.external
    assert external is not None
    turned = np.zeros(external.axes)
    for path in paths:
        values = cell.external_of(path.joints)
        if values is not None and path.reachable:
            turned += np.abs(np.diff(values, axis=0)).sum(axis=0)
    names, slides = cell.machine.axes[-len(turned) :], external.slides
    return {
        "turned_deg": {
            names[k]: math.degrees(distance)
            for k, distance in enumerate(turned.tolist())
            if k != slides
        },
        **({} if slides is None else {"moved_mm": {names[slides]: float(turned[slides])}}),
    }


def allowed_by_layer(features: Parts) -> dict[int, float]:
    """Return the maximum angle from the vertical that each layer allows, rad."""
    return {
        int(layer): feature.rules.max_from_vertical
        for feature, layers in features
        for layer in layers
    }


def _standing_all(
    external: ExternalAxes, cell: Cell, bead_directions: Sequence[Array], max_lean: float
) -> tuple[Array, bool]:
    """Return initial external axis values (k,), and whether they serve the whole job."""
    zero = np.zeros(external.axes)
    if not external.turning:
        return zero, True
    directions = np.concatenate(bead_directions)
    mean_direction = middle(directions)
    if mean_direction is None or float(tilt_from(directions, mean_direction).max()) > max_lean:
        return zero, False
    values = _standing(external, cell, mean_direction, zero)
    return (zero, False) if stroke.lacks(cell, values[None]) else (values, True)


def _standing(external: ExternalAxes, cell: Cell, direction: Array, previous: Array) -> Array:
    """Return external axis values (k,) nearest to `previous` that turn a direction (3,) upright."""
    return np.asarray(stroke.chosen(cell, stroke.upright(external, direction[None]), previous)[0])


def _follow_directions(
    external: ExternalAxes, cell: Cell, directions: Array, max_lean: float, previous: Array
) -> Array:
    """Return external axis values (n, k) along a bead.

    They are constant if the tool then stays close enough to the vertical. Otherwise they turn each
    direction upright.
    """
    mean_direction = middle(directions)
    if (
        mean_direction is not None
        and float(tilt_from(directions, mean_direction).max()) <= max_lean
    ):
        values = np.tile(previous, (len(directions), 1))
        if float(tilt_from(external.upright(directions, values), external.up).max()) <= max_lean:
            return values
        return np.tile(_standing(external, cell, mean_direction, previous), (len(directions), 1))
    return stroke.chosen(cell, stroke.upright(external, directions), previous)
