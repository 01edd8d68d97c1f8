# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is told of the place under the mouse."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ...core.kinematics.cell import Cell as Station
from ...core.kinematics.machines.machine import Machine
from ..texts.touching import link_touches
from ..texts.translation import tr
from .drawn.board import Cell

PAST = 1e-9  # rad, of rounding


def readout(cell: Cell, machine: Machine) -> str:
    """Two lines: place and rotation, margins; and the joints."""
    layer, bead, point = cell.place
    where = tr("Layer {} bead {} point {}").format(layer, bead, point)
    turned = f"RZ {np.degrees(cell.rz):.1f}°   " + tr("rotation") + f" {np.degrees(cell.phi):.1f}°"
    notes = []
    if not np.isfinite(cell.joints).all():
        return f"{where}   {turned}\n" + tr("out of reach in this configuration")
    if cell.margin < 0.0:
        notes.append(tr("beyond a limit"))
    if cell.condition < cell.threshold:
        notes.append(tr("near a singularity"))
    if cell.outside:
        notes.append(tr("rotation not allowed"))
    if cell.touching:
        notes.append(tr("the nozzle touches platform or part"))
    if cell.arm is not None:
        notes.append(link_touches(*cell.arm))
    margin = tr("margin {:.1f} % ({})").format(100.0 * cell.margin, cell.nearest)
    condition = tr("condition {:.4f}, least {:.4f}").format(cell.condition, cell.threshold)
    joints = "   ".join(
        f"{name} {value:.2f}{unit}"
        for name, value, unit in zip(
            machine.axes, cell.joints / machine.unit_values, _units(machine), strict=True
        )
    )
    return f"{where}   {turned}   {margin}   {condition}   {', '.join(notes)}\n{joints}"


def certified(optimality: Mapping[str, Any] | None) -> str:
    """What a certificate says of the plan; '' where none was asked for."""
    if optimality is None:
        return ""
    text = tr(
        "Certificate: {:.4g} as planned, no rotation goes below {:.4g}: a gap of {:.1f} %, {:.1f} % in layer {} bead {}"
    )
    worst = optimality["worst"]
    return text.format(
        optimality["objective"],
        optimality["bound"],
        100.0 * optimality["gap"],
        100.0 * worst["gap"],
        worst["layer"],
        worst["bead"],
    )


def joint_ranges(joints: Array, station: Station) -> list[tuple[str, bool]]:
    """For each axis from where to where joints (T, axes) go, deg, and whether that is past a limit of its own."""
    reached = joints[np.isfinite(joints).all(axis=1)]
    if not len(reached):
        return []
    low, high = reached.min(axis=0), reached.max(axis=0)
    units = station.machine.unit_values
    past = (low < station.limits.lower - PAST) | (high > station.limits.upper + PAST)
    return [
        (f"{name} {a:.1f}…{b:.1f}{unit}", bool(wrong))
        for name, a, b, wrong, unit in zip(
            station.machine.axes,
            low / units,
            high / units,
            past,
            _units(station.machine),
            strict=True,
        )
    ]


def _units(machine: Machine) -> list[str]:
    """What stands behind the values of the axes."""
    return [" mm" if unit == "mm" else "°" for unit in machine.units]
