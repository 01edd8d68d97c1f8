# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way between two points: beads against their planned lines, rapids against the way that was looked at."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Index, Mask

from ..core.geometry import frames
from ..core.geometry.columns import lengths
from ..core.kinematics.cell import Cell
from ..core.program import OFF_WAY_MM, OFF_WAY_RAD
from .planned import Planned, pieces
from .text_path import Joints, Path, tip_bounds

# of the way between two points, where the path is looked at
BETWEEN = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) / 6.0


def rapids_between(
    cell: Cell, planned: Planned, text: Joints, path: Path, linear: Mask
) -> tuple[float, float, Mask]:
    """Largest distance of the tip, mm, and of its direction, deg, from where it was looked at on rapids, and the moves (n,) that leave that way by more than
    the digits explain: as the text says them, the joints straight or (linear) the tip."""
    off, ends = np.zeros(len(planned.deposit), dtype=bool), planned.rapids
    if not len(ends):
        return 0.0, 0.0, off
    looked_at = _between(planned.joints, ends)
    tip, tool = _tips(cell, looked_at)
    driven_tip, driven_tool = _tips(cell, _between(text.serial, ends))
    straight_tip, straight_tool = _between(path.position, ends), _between(path.tool, ends)
    along = np.repeat(linear[ends], len(BETWEEN))[:, None]
    distances = np.linalg.norm(np.where(along, straight_tip, driven_tip) - tip, axis=1)
    tilted = np.linalg.norm(np.where(along, straight_tool, driven_tool) - tool, axis=1)
    bound, tool_bound = tip_bounds(cell, looked_at, _between(text.reach, ends))
    # what runs straight where joints were looked at is refused elsewhere, unless it was planned so
    # near a singularity digits may explain more than the clearance of rapids has to spare; then the text is none
    allowed = np.where(along[:, 0], OFF_WAY_MM, np.minimum(bound, OFF_WAY_MM))
    wrong = ~(
        (distances <= allowed) & (tilted <= np.maximum(tool_bound, OFF_WAY_RAD * along[:, 0]))
    )
    off[ends] = wrong.reshape(len(ends), -1).any(axis=1)
    return float(distances.max()), float(np.degrees(tilted.max())), off


def _between(rows: Array, ends: Index) -> Array:
    """(len(ends) * len(BETWEEN), ...) what lies on the straight way to the rows `ends` from those before."""
    step = (rows[ends] - rows[ends - 1])[:, None]
    between: Array = (rows[ends - 1, None] + BETWEEN[:, None] * step).reshape(-1, rows.shape[1])
    return between


def _tips(cell: Cell, serial: Array) -> tuple[Array, Array]:
    return cell.tip_in_part(cell.machine.chain.forward(serial))


def beads_between(
    cell: Cell, planned: Planned, controller_values: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """Largest distance of the tip from the planned segments while joints run straight, and the moves too far off.

    The tip is driven where it can be off, or farther than it is anywhere else: between points no farther from the planned
    ones it leaves their segment by that and its bow at most.
    """
    serial, ends = cell.machine.from_controller(controller_values), planned.ends
    largest, off = 0.0, np.zeros(len(controller_values), dtype=bool)
    upper_bounds = _larger_at_ends(lengths(path.position - planned.position), ends) + _bow(
        cell, serial, ends
    )
    upper_bounds[~(upper_bounds <= chord_error + _larger_at_ends(path.bound, ends))] = np.inf
    falling = np.argsort(-upper_bounds)
    for candidates in pieces(falling):
        if upper_bounds[candidates[0]] <= largest:
            break
        rows = ends[candidates]
        tips = cell.tip_at(_between(serial, rows))
        strayed, off[rows] = _off_segments(planned, rows, tips, path, chord_error)
        largest = float(np.maximum(largest, strayed))
    return largest, off


def _larger_at_ends(values: Array, ends: Index) -> Array:
    """(len(ends),) the larger of what is told of the row `ends` and of the one before; NaN where one is."""
    return np.maximum(values[ends - 1], values[ends])


def _bow(cell: Cell, serial: Array, ends: Index) -> Array:
    """(len(ends),) mm by how much the tip leaves its chord at most while joints run straight to the rows `ends`: an eighth
    of its second derivative, in which each turn acts on each other one over a lever no longer than the whole chain, and
    twice on what slides."""
    chain, slides = cell.machine.chain, cell.machine.chain.sliding
    links = [*chain.origins, chain.flange, cell.carried, cell.station]
    lever = (
        sum(np.linalg.norm(link[:3, 3]) for link in links)
        + np.abs(serial[:, slides]).max(axis=0).sum()
    )
    step = np.abs(serial[ends] - serial[ends - 1])
    turned, slid = step[:, ~slides].sum(axis=1), step[:, slides].sum(axis=1)
    bow: Array = turned * (0.125 * lever * turned + 0.25 * slid)
    return bow


def tools_between(
    cell: Cell, planned: Planned, flanges: Array, tools: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """The same while tools (n, 4, 4), another one at each point, on flanges at `flanges` (n, 4, 4) run straight."""
    largest, off = 0.0, np.zeros(len(flanges), dtype=bool)
    for ends in pieces(planned.ends):
        flanges_between = (
            _straight(flanges[ends - 1] @ tools[ends], flanges[ends] @ tools[ends])
            @ frames.inverse(tools[ends])[:, None]
        )
        strayed, off[ends] = _off_segments(
            planned, ends, cell.tip_in_part(flanges_between.reshape(-1, 4, 4))[0], path, chord_error
        )
        largest = float(np.maximum(largest, strayed))
    return largest, off


def _off_segments(
    planned: Planned, ends: Index, tips: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """Largest distance of tips (len(ends) * len(BETWEEN), 3) from the planned segments that end at the rows `ends`,
    and which of these (len(ends),) leave theirs by more than the chord error and the digits of their two points."""
    tips = tips.reshape(len(ends), len(BETWEEN), 3)
    start, step = planned.position[ends - 1], planned.position[ends] - planned.position[ends - 1]
    offsets = tips - start[:, None]
    squared = np.maximum(np.einsum("ni,ni->n", step, step), 1e-300)
    share = np.clip(np.einsum("nki,ni->nk", offsets, step) / squared[:, None], 0.0, 1.0)
    offsets -= share[..., None] * step[:, None]
    squared_distances = np.einsum("nki,nki->nk", offsets, offsets)
    distance = np.sqrt(np.maximum.reduce([squared_distances[:, k] for k in range(len(BETWEEN))]))
    return float(distance.max()), ~(distance <= chord_error + _larger_at_ends(path.bound, ends))


def _straight(start: Array, end: Array) -> Array:
    """(n, len(BETWEEN), 4, 4) poses on the way from start to end (n, 4, 4): straight, turning about one axis."""
    turn = np.swapaxes(start[:, :3, :3], 1, 2) @ end[:, :3, :3]
    axis = 0.5 * np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        1,
    )
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0))
    axis = np.where(sine[:, None] > 1e-12, axis / np.maximum(sine, 1e-12)[:, None], [0.0, 0.0, 1.0])
    rotated = start[:, None, :3, :3] @ frames.rotation_about(
        axis[:, None], BETWEEN * angle[:, None]
    )
    return frames.pose(
        rotated, start[:, None, :3, 3] + BETWEEN[:, None] * (end - start)[:, None, :3, 3]
    )
