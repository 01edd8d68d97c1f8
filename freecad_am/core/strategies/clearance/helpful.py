# SPDX-License-Identifier: LGPL-2.1-or-later
"""Remedies for a touching nozzle that no tilt clears: changes tried one at a time at the points concerned."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ...geometry import frames
from ...geometry.obstacles import Body
from ...issues import Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...toolpath import Toolpath
from ...types import Array, Index
from .places import CAP, Space, space_of
from .tilt_search import AZIMUTHS, MAX_TILT_RAD, RING

LOOKED_AT = 240  # points, at most
BATCH_POINTS = 24  # points in a batch; if one has no room, later batches are skipped
SHARES = (0.75, 0.5, 0.25)  # half angles of the nozzle that are tried
FARTHER = np.radians(15.0)  # by which the largest tilt is raised
MAX_TRIALS = 4  # changes with which every bead is tilted again, at most
MAX_TRIAL_POINTS = 20_000  # points of a toolpath that is


class Change(NamedTuple):
    """Bodies, nozzle and build directions in place of others, and the words for it."""

    bodies: Sequence[Body]
    nozzle: NozzleParameters
    build: BuildDirectionParameters
    words: Text


class Touching(NamedTuple):
    """A toolpath with the axes asked for, and the points (k,) that no tilt clears. plane, feature: as of
    `tilt_back.keep_clear`."""

    toolpath: Toolpath
    rows: Index
    plane: Array | None
    feature: int | None

    def clear_at(self, change: Change) -> bool:
        """Whether each of the points has a clear tilt, by up to LARGEST, after a change; of many points, a regular sample is checked."""
        space = space_of(
            self.toolpath,
            change.bodies,
            change.nozzle,
            change.build.max_tilt,
            False,
            self.feature or 0,
        )
        sample = self.rows[
            np.unique(
                np.linspace(0, len(self.rows) - 1, min(LOOKED_AT, len(self.rows))).astype(np.intp)
            )
        ]
        tool = np.concatenate([bead.tool for _, _, bead in self.toolpath])
        return all(
            self._clear_at(space, tool, sample[start : start + BATCH_POINTS])
            for start in range(0, len(sample), BATCH_POINTS)
        )

    def _clear_at(self, space: Space, tool: Array, rows: Index) -> bool:
        for number in range(round(MAX_TILT_RAD / RING) + 1):
            axes = self._cone(tool[rows], number * RING)
            free = (
                space.clear(np.repeat(rows, axes.shape[1]), axes.reshape(-1, 3))
                .reshape(len(rows), -1)
                .any(axis=1)
            )
            rows = rows[~free]
            if not len(rows):
                return True
        return False

    def _cone(self, tool: Array, angle: float) -> Array:
        """Axes (k, s, 3) at an angle, rad, from those asked for (k, 3)."""
        if self.plane is not None:
            sides = np.cross(self.plane, tool)[:, None] * np.array([1.0, -1.0])[:, None]
        else:
            turn = 2.0 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS
            level = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(AZIMUTHS)])
            sides = np.einsum(
                "sj,kij->ksi", level, frames.smallest_rotation(np.array([0.0, 0.0, 1.0]), tool)
            )
        axes: Array = np.cos(angle) * tool[:, None] + np.sin(angle) * sides
        return axes


def what_helps(touching: Touching, now: Change, clears: Callable[[Change], bool]) -> Text:
    """The remedy as the end of a message: the first change with which the nozzle is clear, or that none is known. clears: tilts
    every bead again.
    """
    trials: list[Text] = []
    trials_left = MAX_TRIALS
    for changes in (_tilts(now), _half_angles(now), _cleared_away(now)):
        for change in _useful_changes(touching, changes):
            if touching.toolpath.point_count > MAX_TRIAL_POINTS:
                return Text(
                    "these points would be clear with {}, which was not tested for the others",
                    change.words,
                )
            trials_left -= 1
            if trials_left >= 0 and clears(change):
                return Text("with {} the nozzle is clear (tested)", change.words)
        trials += [change.words for change in changes[-1:] if trials_left >= 0]
    fallback = Text("use other layers or another direction, or exclude the region of these points")
    return (
        Text(
            "it still does with {} (all tested); {}",
            Text.joined(", ", trials),
            fallback,
        )
        if trials
        else fallback
    )


def _useful_changes(touching: Touching, changes: list[Change]) -> list[Change]:
    """The smallest change that gives every point room, and the largest; empty if the largest does not."""
    if not changes or not touching.clear_at(changes[-1]):
        return []
    smallest = next((change for change in changes[:-1] if touching.clear_at(change)), changes[-1])
    return [smallest] if smallest is changes[-1] else [smallest, changes[-1]]


def _tilts(now: Change) -> list[Change]:
    """Larger tilts, the largest last."""
    max_tilt = now.build.max_tilt
    angles = [
        min(np.pi, max_tilt + FARTHER * (k + 1))
        for k in range(int(np.ceil((np.pi - max_tilt) / FARTHER - CAP)))
    ]
    return [
        now._replace(
            build=dataclasses.replace(now.build, max_tilt=angle),
            words=Text("`build_direction.max_tilt: {:.3g} deg`", np.degrees(angle)),
        )
        for angle in angles
    ]


def _cleared_away(now: Change) -> list[Change]:
    """Nothing but the deposit itself in the way."""
    names = Text.joined(", ", (body.name for body in now.bodies))
    return [now._replace(bodies=(), words=Text("{} out of the way", names))] if now.bodies else []


def _half_angles(now: Change) -> list[Change]:
    """Slimmer nozzles, half angles in whole degrees, the slimmest last."""
    half = float(np.degrees(now.nozzle.half_angle))
    angles = sorted({round(share * half) for share in SHARES} - {0}, reverse=True)
    return [
        now._replace(
            nozzle=dataclasses.replace(now.nozzle, half_angle=float(np.radians(angle))),
            words=Text("`cell.nozzle.half_angle: {:d} deg`", angle),
        )
        for angle in angles
        if angle < half
    ]
