# SPDX-License-Identifier: LGPL-2.1-or-later
"""Position of the track that carries the robot.

One rule covers the whole job: the track follows a fraction of the deposit's motion along it, so
that the robot stays within half a window of its best position. Each point of the part therefore
has one track position, whatever was printed before. The track moves as smoothly as the beads. It
stands still if the whole part is within the window. Windows and offsets are tried in order of
increasing motion.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ...geometry import frames
from ...kinematics.cell import Cell
from ...kinematics.limits import RESERVE
from ...toolpath import Bead
from ...types import Array

# fractions of the arm reach: the window, and the offset of the robot from the deposit along the
# track
WINDOWS = (0.6, 0.3, 0.0)
OFFSETS = (0.0, 0.4, -0.4)
MAX_TRIALS = 3  # maximum number of placements to plan


def place_track(
    beads: Sequence[Bead], cell: Cell, served: Callable[[Sequence[Bead]], float]
) -> Iterator[list[Bead]]:
    """Yield the beads with track values at their points, in order of increasing track motion.

    Yield up to MAX_TRIALS placements in which the robot can print all sampled beads, or the best
    placement if there is none. Without a track, yield the unchanged beads.

    Parameters
    ----------
    beads : sequence of Bead
        The beads in print order.
    cell : Cell
        The cell; may have a track.
    served : callable
        Returns the fraction of the sampled beads that the robot can print.

    Yields
    ------
    list of Bead
        The beads, with track values.
    """
    external = cell.external
    if external is None or external.slides is None:
        yield list(beads)
        return
    track_positions = [_at_points(bead, cell) for bead in beads]
    arm = cell.robot.arm
    assert arm is not None  # resolve() rejects other machines
    yielded, best, best_share = 0, list(beads), -1.0
    for window in WINDOWS:
        for offset in OFFSETS:
            moved = _follow_track(
                beads, track_positions, cell, window * arm.reach, offset * arm.reach
            )
            share = served(moved)
            if share > best_share:
                best, best_share = moved, share
            if share == 1.0:
                yield moved
                yielded += 1
            if yielded == MAX_TRIALS:
                return
    if not yielded:
        yield best


def _at_points(bead: Bead, cell: Cell) -> Array:
    """Return the positions (n,) of bead points along the track in the world, mm."""
    external = cell.external
    assert external is not None and external.along is not None and bead.external is not None
    at_zero = bead.external.copy()
    at_zero[:, external.slides] = 0.0
    world = external.base(at_zero) @ cell.robot.base
    stands = cell.poses.station @ frames.inverse(cell.poses.mount)
    point = bead.points @ stands[:3, :3].T + stands[:3, 3]
    on_track = np.einsum("nji,nj->ni", world[:, :3, :3], point - world[:, :3, 3])
    return np.asarray(on_track @ external.along)


def _follow_track(
    beads: Sequence[Bead],
    track_positions: Sequence[Array],
    cell: Cell,
    window: float,
    offset: float,
) -> list[Bead]:
    """Return the beads with track values.

    The robot stays within half a window of `offset` from the deposit along the track, mm. The
    track limits bound its motion.
    """
    external = cell.external
    assert external is not None and external.slides is not None
    axis = cell.robot.chain.axes + external.slides
    lower, upper = cell.limits.lower[axis] + RESERVE, cell.limits.upper[axis] - RESERVE
    low = min(float(positions.min()) for positions in track_positions)
    high = max(float(positions.max()) for positions in track_positions)
    span = max(high - low, 1e-9)
    share = min(max(0.0, 1.0 - window / span), (upper - lower) / span)
    margin = 0.5 * share * span
    middle = float(np.clip(0.5 * (low + high) - offset, lower + margin, upper - margin))
    moved = []
    for bead, positions in zip(beads, track_positions, strict=True):
        assert bead.external is not None
        values = bead.external.copy()
        values[:, external.slides] = middle + share * (positions - 0.5 * (low + high))
        moved.append(dataclasses.replace(bead, external=values))
    return moved
