# SPDX-License-Identifier: LGPL-2.1-or-later
"""The timeline of a motion: times of rows and waits, state at any time, and totals.

The machine arrives at each row at the end of the row's segment. It may wait there while the deposit
starts or ends (lead times), and between layers. Segments are straight in joint space.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import CLASSES, number_of
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath, settings_of
from ..types import Array, ArrayLike, Integers, Mask


def volumes(motion: Motion, process: ProcessParameters, toolpath: Toolpath) -> Array:
    """Return the deposit volume of the segment that ends at each row.

    A bead's cross-section is its width times the layer height: the solid deposit, not the wire
    volume. The width is the predicted width, else the bead width of the toolpath. Layers fitted to
    a scan have their mean fitted height. For toolpaths of older documents without a bead width,
    `process.bead_width` replaces it.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    process : ProcessParameters
        The nominal bead width, mm.
    toolpath : Toolpath
        Bead width and layer heights, mm.

    Returns
    -------
    (n,) array
        Volumes, mm^3; 0 in rapids.
    """
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(motion.position, axis=0), axis=1)])[
        : len(motion)
    ]
    nominal = process.bead_width if toolpath.bead_width is None else toolpath.bead_width
    width = np.where(np.isfinite(motion.width), motion.width, nominal)
    # the width of a segment is the mean of the widths at its ends
    mean_width = 0.5 * (width + np.concatenate([width[:1], width[:-1]]))
    height: Array | float = toolpath.layer_height
    if toolpath.features or toolpath.checks.fitted is not None:
        height = (
            _mean_heights(toolpath)
            if toolpath.checks.fitted is not None
            else toolpath.layer_heights
        )[motion.layer]
    return np.where(motion.deposit & motion.moves, mean_width * length, 0.0) * height


def _mean_heights(toolpath: Toolpath) -> Array:
    """Return the mean bead height of each layer, (layers,) mm; layers fitted to a scan are uneven."""
    layer_heights = toolpath.layer_heights
    for number, layer in enumerate(toolpath.layers):
        if any(bead.height is not None for bead in layer.beads):
            sums = np.zeros(2)
            for bead in layer.beads:
                length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
                high = (
                    np.full(len(bead), layer_heights[number])
                    if bead.height is None
                    else bead.height
                )
                sums += (0.5 * length @ (high[1:] + high[:-1]), length.sum())
            layer_heights[number] = sums[0] / sums[1]
    return layer_heights


def fed_volume(motion: Motion, process: ProcessParameters, toolpath: Toolpath) -> float | None:
    """Return the volume of wire fed while depositing, without lead times.

    Parameters
    ----------
    motion : Motion
        The motion, with the wire speed of its rows if known.
    process : ProcessParameters
        The cross-section of the wire.
    toolpath : Toolpath
        The nominal wire speed, mm/s.

    Returns
    -------
    float or None
        Volume, mm^3; None if the wire speed is unknown or the process has no wire.
    """
    nominal = toolpath.wire_feed or np.nan
    feed = np.where(np.isfinite(motion.wire), motion.wire, nominal)
    seconds = np.where(motion.deposit & motion.moves, np.nan_to_num(motion.duration), 0.0)
    total = process.wire.section * float((feed * seconds).sum())
    return total if np.isfinite(total) else None


def deposit_motion(toolpath: Toolpath, axes: int = 0) -> Motion:
    """Build a motion of deposit rows only, for a job without a joint path.

    Durations follow from length and speed. The joints are `axes` columns of NaN.
    """
    beads = list(toolpath)
    sizes = [len(bead) for _, _, bead in beads]
    position = np.concatenate([bead.points for _, _, bead in beads])
    speed = np.concatenate([bead.speed for _, _, bead in beads])
    point = np.concatenate([np.arange(size) for size in sizes])
    step = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    return Motion(
        deposit=np.ones(len(position), dtype=bool),
        layer=np.repeat([layer for layer, _, _ in beads], sizes),
        bead=np.repeat([number for _, number, _ in beads], sizes),
        point=point,
        position=position,
        build=np.concatenate([bead.build for _, _, bead in beads]),
        tool=np.concatenate([bead.tool for _, _, bead in beads]),
        speed=speed,
        width=np.concatenate(
            [np.full(len(b), np.nan) if b.width is None else b.width for _, _, b in beads]
        ),
        joints=np.full((len(position), axes), np.nan),
        duration=np.where(point > 0, step / speed, 0.0),
        wire=np.concatenate(
            [
                np.full(len(b), np.nan) if b.wire_share is None else b.wire_share * b.speed
                for _, _, b in beads
            ]
        ),
        bead_class=np.repeat([number_of(bead.role.bead_class) for _, _, bead in beads], sizes),
        settings=np.concatenate([settings_of(bead) for _, _, bead in beads]).astype(np.int64),
    )


# minimum number of rapid rows between beads for the first to be a retract from the previous bead
WITH_WITHDRAWAL = 3


@dataclass(frozen=True, eq=False)
class State:
    """The machine state at times (...,). All arrays have the shape of the times.

    row: int, the row that the machine moves to or waits at. share: completed fraction of the
    segment that ends at the row; 1 at standstill. joints: (..., axes) rad or mm, NaN where
    unreachable. position: (..., 3) mm in the part, straight between rows. In rapids the tip follows
    the joints and may be far from this line. deposit: bool, whether the deposit is on. standing:
    bool, whether the machine is at standstill. speed: requested speed at the deposition point,
    mm/s; 0 at standstill.
    """

    row: Integers
    share: Array
    joints: Array
    position: Array
    deposit: Mask
    standing: Mask
    speed: Array


@dataclass(frozen=True, eq=False)
class Timeline:
    """Times of a motion of n rows, in s after the start.

    arrive, leave: (n,) arrival and departure time of each row. lit: (n,) s, wait at each row with
    the deposit on, which precedes any wait with the deposit off. layer_rows: (layers,) first row of
    each executed layer, including the rapids to the layer. layers: indices of these layers.
    """

    motion: Motion
    arrive: Array
    leave: Array
    lit: Array
    layers: Integers
    layer_rows: Integers

    @property
    def total(self) -> float:
        """Total time of moves and waits, s."""
        return float(self.leave[-1]) if len(self.leave) else 0.0

    @property
    def waits(self) -> Array:
        """Return the waiting time at each row.

        Returns
        -------
        (n,) array
            Times, s, with the deposit on or off.
        """
        return np.asarray(self.leave - self.arrive)

    def state_at(self, time: ArrayLike) -> State:
        """Return the state at times.

        Parameters
        ----------
        time : (...) array_like
            Times, s. Times before the start or after the end give the first or last row.

        Returns
        -------
        State
            The state, with arrays of the shape of the times.
        """
        motion, when = self.motion, np.clip(np.asarray(time, float), 0.0, self.total)
        row = np.minimum(np.searchsorted(self.leave, when, side="left"), len(self.leave) - 1)
        previous = np.maximum(row - 1, 0)
        went = self.arrive[row] - self.leave[previous]
        running = (when < self.arrive[row]) & (row > 0)
        share = np.where(
            running, (when - self.leave[previous]) / np.where(went > 0.0, went, 1.0), 1.0
        )
        start, end = (1.0 - share)[..., None], share[..., None]
        joints = np.where(
            end < 1.0,
            start * motion.joints[previous] + end * motion.joints[row],
            motion.joints[row],
        )
        position = start * motion.position[previous] + end * motion.position[row]
        stayed_lit = (when - self.arrive[row] < self.lit[row]) & (self.lit[row] > 0.0)
        at_start = motion.deposit[row] & (motion.point[row] == 0)
        deposit = np.where(running, motion.deposit[row] & ~at_start, stayed_lit)
        return State(
            row=row,
            share=share,
            joints=joints,
            position=position,
            deposit=deposit,
            standing=np.asarray(~running),
            speed=np.where(running, motion.speed[row], 0.0),
        )


def timeline(motion: Motion, process: ProcessParameters, waits: Sequence[float] = ()) -> Timeline:
    """Return the times of a motion, with lead times at bead ends and waits between layers.

    The time to the first row is not included, because the start position of the machine is unknown.
    Waits for inputs take no time.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    process : ProcessParameters
        Lead times of bead classes and `between_layers.wait`, s.
    waits : sequence of float, optional
        Wait before each layer, by layer index, s; `between_layers.wait` is the minimum.

    Returns
    -------
    Timeline
        Arrival and departure of each row, s from the first row.
    """
    n = len(motion)
    lit, dark = np.zeros(n), np.zeros(n)
    if n:
        is_start = motion.deposit & (motion.point == 0)
        is_end = motion.deposit & np.append(~motion.deposit[1:] | is_start[1:], True)
        lit[is_start] += _values_at(motion, process, is_start, "lead_on")
        lit[is_end] += _values_at(motion, process, is_end, "lead_off")
        dark = _between_layers(motion, process, waits)
    steps = np.nan_to_num(motion.duration)
    stay = lit + dark
    arrive = np.cumsum(steps) + np.cumsum(stay) - stay
    starts = np.flatnonzero(np.diff(motion.layer, prepend=-1)) if n else np.zeros(0, dtype=np.int64)
    return Timeline(motion, arrive, arrive + stay, lit, motion.layer[starts], starts)


def _values_at(motion: Motion, process: ProcessParameters, rows: Mask, key: str) -> Array:
    """Return a value of the process at rows, by their bead class and settings by place."""
    kinds = np.stack([motion.bead_class[rows], motion.settings[rows]])
    distinct, index = np.unique(kinds, axis=1, return_inverse=True)
    names = (*CLASSES, "")  # the last entry is for beads without a class
    values = [
        getattr(process.at_place(names[name], active), key) for name, active in distinct.T.tolist()
    ]
    return np.asarray(np.array(values, dtype=float)[np.ravel(index)])


def _between_layers(motion: Motion, process: ProcessParameters, waits: Sequence[float]) -> Array:
    """Return the wait for the next layer at each row, (n,) s.

    The machine waits after the retract from the last bead, if there is a retract.
    """
    result = np.zeros(len(motion))
    starts = np.flatnonzero(np.diff(motion.layer)) + 1
    of_layer = (
        np.asarray(waits, float)[motion.layer[starts]] if len(waits) else np.zeros(len(starts))
    )
    seconds = np.maximum(of_layer, process.between_layers.wait)
    deposits = np.flatnonzero(motion.deposit)
    # number of rapid rows before the first deposit row of the layer
    rapids = (
        deposits[np.minimum(np.searchsorted(deposits, starts), len(deposits) - 1)] - starts
        if len(deposits)
        else starts
    )
    result[np.where(rapids >= WITH_WITHDRAWAL, starts, starts - 1)] = seconds
    return result


# ---- Statistics of a motion by bead class, and totals of a job


def figures_by_class(motion: Motion, process: ProcessParameters) -> list[dict[str, Any]]:
    """Return statistics for each bead class of the motion, in the order of CLASSES.

    Number of beads, length, mm, and time, s, of deposit without lead times, minimum and maximum
    speed, mm/s, schedule, and weave if any class has a weave. Empty for motions of older versions
    without bead classes.
    """
    class_rows: list[dict[str, Any]] = []
    step_lengths = np.linalg.norm(
        np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1
    )
    for number, name in enumerate(CLASSES):
        in_class = motion.deposit & (motion.bead_class == number)
        rows = in_class & motion.moves
        if not rows.any():
            continue
        beads = motion.layer[in_class] * (1 + motion.bead[in_class].max()) + motion.bead[in_class]
        class_rows.append(
            {
                "class": name,
                "beads": len(np.unique(beads)),
                "length_mm": float(step_lengths[rows].sum()),
                "deposit_s": float(np.nan_to_num(motion.duration)[rows].sum()),
                "travel_speed_mm_s": {
                    "min": float(motion.speed[rows].min()),
                    "max": float(motion.speed[rows].max()),
                },
                "schedule": process.for_class(name).schedule,
                **({"weave": process.for_class(name).weave or None} if process.weaves else {}),
            }
        )
    return class_rows


MM3_PER_CM3 = 1000.0


@dataclass(frozen=True)
class Totals:
    """Totals of a job: times, s; lengths, mm; bead volume, mm^3, and mass, g.

    fed: wire volume, mm^3, None if the wire speed is unknown. wait_time: intended standstills of
    the machine, including lead times.
    """

    time: float
    deposit_time: float
    rapid_time: float
    wait_time: float
    length: float
    rapid_length: float
    volume: float
    mass: float
    fed: float | None


def totals(
    motion: Motion, times: Timeline, process: ProcessParameters, toolpath: Toolpath
) -> Totals:
    """Return the totals of a motion.

    Parameters
    ----------
    motion : Motion
        The motion.
    times : Timeline
        Times of the motion.
    process : ProcessParameters
        Density, g/cm^3, wire and bead width.
    toolpath : Toolpath
        Widths and heights of beads, as for `volumes`.

    Returns
    -------
    Totals
        Times, lengths, volume, mass and wire.
    """
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(motion.position, axis=0), axis=1)])[
        : len(motion)
    ]
    deposits = motion.deposit & motion.moves
    volume = float(volumes(motion, process, toolpath).sum())
    steps = np.nan_to_num(motion.duration)
    return Totals(
        time=times.total,
        deposit_time=float(steps[deposits].sum()),
        rapid_time=float(steps[~deposits].sum()),
        wait_time=float(times.waits.sum()),
        length=float(length[deposits].sum()),
        rapid_length=float(np.nan_to_num(length)[~deposits].sum()),
        volume=volume,
        mass=volume / MM3_PER_CM3 * process.density,
        fed=fed_volume(motion, process, toolpath),
    )


def as_dict(sums: Totals) -> dict[str, float | None]:
    """Return the totals as stored in report.json."""
    return {
        "time_s": sums.time,
        "deposit_s": sums.deposit_time,
        "rapid_s": sums.rapid_time,
        "wait_s": sums.wait_time,
        "deposit_mm": sums.length,
        "rapid_mm": sums.rapid_length,
        "volume_cm3": sums.volume / MM3_PER_CM3,
        "mass_g": sums.mass,
        "fed_cm3": None if sums.fed is None else sums.fed / MM3_PER_CM3,
    }
