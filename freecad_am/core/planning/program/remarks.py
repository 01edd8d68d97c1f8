# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program says of itself at its head: where the part is, frames, and ranges of its axes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry import frames
from ...kinematics.cell import Cell
from ...parameters.program import ProgramParameters
from ...program import DEPOSIT, Moves, Six
from ...types import Array


def frames_of(cell: Cell, parameters: ProgramParameters) -> tuple[Array, Array]:
    """Return the fixed frame in base_link and the load of the flange (4, 4); the one that is the part is
    taken at the program's origin.
    """
    if isinstance(parameters.origin, str):
        return cell.station, cell.carried
    origin = frames.inverse(cell.mount) @ frames.bryant(parameters.origin)
    if cell.torch_stands:
        return cell.station, cell.carried @ origin
    return cell.station @ origin, cell.carried


def six_of(pose: Array) -> Six:
    x, y, z = pose[:3, 3].tolist()
    rx, ry, rz = frames.to_bryant(pose[:3, :3]).tolist()
    return (x, y, z, rx, ry, rz)


def remarks_of(
    cell: Cell, parameters: ProgramParameters, moves: Sequence[Moves]
) -> tuple[str, ...]:
    moved = not isinstance(parameters.origin, str)
    station, carried = frames_of(cell, parameters)
    if not cell.machine.free:
        where, frame = (
            "Work offset" if parameters.motion == "cartesian" else "Platform on the table",
            carried,
        )
    else:
        where = "Deposition point" if cell.torch_stands else "User frame" if moved else "Platform"
        where += " on the face" if cell.external is not None and cell.external.turning else ""
        frame = frames.inverse(cell.machine.base) @ station
    return (
        cell.machine.title,
        f"Limits: {cell.limits.name}",
        *_pose_remarks(where, six_of(frame)),
        *(
            ()
            if isinstance(parameters.origin, str)
            else _pose_remarks("Program origin on the part", parameters.origin)
        ),
        *_ranges(moves),
        *((cell.machine.controller_remark,) if cell.machine.controller_remark else ()),
        *(
            ("Base frame not known: positions count from base_link",)
            if parameters.motion == "cartesian" and not cell.machine.base_is_known
            else ()
        ),
    )


def _ranges(moves: Sequence[Moves]) -> list[str]:
    """Return the figures of the program itself: the speeds of its beads and, if it states them, of their
    wire.
    """
    beads = [run for run in moves if run.kind == DEPOSIT]
    if not beads:
        return []
    wires = [run.wire for run in beads if run.wire is not None]
    return [
        f"Travel speed {_range(np.concatenate([run.speed for run in beads]))} mm/s",
        *([f"Wire in proportion to it {_range(np.concatenate(wires))} mm/s"] if wires else []),
    ]


def _range(values: Array) -> str:
    low, high = (f"{float(value):.4g}" for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _pose_remarks(what: str, six: Six) -> tuple[str, str]:
    x, y, z, *angles = six
    rx, ry, rz = np.degrees(angles) + 0.0
    return f"{what} {x:.3f} {y:.3f} {z:.3f}", f"RX RY RZ {rx:.3f} {ry:.3f} {rz:.3f}"
