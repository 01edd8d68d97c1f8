# SPDX-License-Identifier: LGPL-2.1-or-later
"""Payload check: mass of the growing part, and distance of its centre of gravity from the last axis.

The part consists of the deposit and its substrate bodies, all with the density of the deposit.
Bodies that are not a closed mesh have no mass. The limit is the moment about the axis, so a lighter
load may be farther from the axis.
"""

from __future__ import annotations

import numpy as np

from ..geometry import frames
from ..geometry.obstacles import enclosed_volume
from ..issues import ERROR, Issue, Text, Word
from ..kinematics.cell import Cell
from ..kinematics.machines.machine import Machine
from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from ..types import Array
from .timeline import volumes

CODE = "PAYLOAD"
KG = 1e-6  # kg; mass of 1 mm3 at 1 g/cm3
REMEDY = "check process.density, and the payload in the machine file"


def issues(
    motion: Motion, cell: Cell, toolpath: Toolpath, process: ProcessParameters
) -> list[Issue]:
    """Report where the growing part overloads its carriers.

    The mass is checked for each carrier, and the part's moment for the last axis.

    Parameters
    ----------
    motion : Motion
        The motion, with the deposit in print order.
    cell : Cell
        The cell; its carriers state the payloads.
    toolpath : Toolpath
        Widths, heights and substrate bodies.
    process : ProcessParameters
        The density, g/cm^3, and the nominal bead width, mm.

    Returns
    -------
    list of Issue
        Errors PAYLOAD at the row where each overload begins: at most one for each carrier, and one
        for the distance from the axis.
    """
    if all(
        np.isinf([carrier.payload.kg, carrier.payload.from_axis]).all() for carrier in cell.carriers
    ):
        return []
    deposited = KG * process.density * np.nan_to_num(volumes(motion, process, toolpath))
    bodies, centre = enclosed_volume(toolpath.surroundings)
    bodies *= KG * process.density
    mass, issue_list = bodies + np.cumsum(deposited), []
    for machine in cell.carriers:
        over = mass > machine.payload.kg
        if over.any():
            row = int(over.argmax())
            issue_list.append(
                _issue_at(
                    motion,
                    row,
                    Text(
                        "from here on the part weighs more than {:g} kg ({:.4g} kg when "
                        "finished, including {:.3g} kg of substrate), the payload of {}; {}",
                        machine.payload.kg,
                        mass[-1],
                        bodies,
                        machine.title,
                        REMEDY,
                    ),
                )
            )
    out = cell.carriers[-1].payload.from_axis
    if np.isfinite(out):
        from_axis = _from_axis(cell, cell.carriers[-1], motion.position, deposited, bodies, centre)
        issue_list += _too_far(motion, cell.carriers[-1], mass, from_axis)
    return issue_list


def finished(motion: Motion, cell: Cell, toolpath: Toolpath, process: ProcessParameters) -> float:
    """Return the mass of the finished part, including closed substrate bodies.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        Not used.
    toolpath : Toolpath
        Widths, heights and substrate bodies.
    process : ProcessParameters
        The density, g/cm^3, and the nominal bead width, mm.

    Returns
    -------
    float
        Mass, kg.
    """
    deposited = np.nan_to_num(volumes(motion, process, toolpath)).sum()
    return float(KG * process.density * (deposited + enclosed_volume(toolpath.surroundings)[0]))


def _too_far(motion: Motion, machine: Machine, mass: Array, moment: Array) -> list[Issue]:
    """Report where moments (n,), kg mm, of masses (n,), kg, about the last axis exceed the payload."""
    load = machine.payload
    max_moment = load.from_axis * (mass if np.isinf(load.kg) else load.kg)
    over = moment > max_moment * (1.0 + 1e-9)
    if not over.any():
        return []
    row = int(over.argmax())
    middle = moment[-1] / mass[-1] if mass[-1] > 0.0 else 0.0
    rated = (
        Text("{:g} mm", load.from_axis)
        if np.isinf(load.kg)
        else Text("{:g} mm with {:g} kg", load.from_axis, load.kg)
    )
    out = moment[row] / mass[row]
    return [
        _issue_at(
            motion,
            row,
            Text(
                "the centre of gravity of the part, {:.4g} kg at that time, is {:.4g} mm from "
                "the last axis of {} ({:.4g} mm when finished), whose payload is {}; move the "
                "part nearer to the axis (cell.platform may be a pose); {}",
                mass[row],
                out,
                machine.title,
                middle,
                Word(rated),
                REMEDY,
            ),
        )
    ]


def _from_axis(
    cell: Cell, machine: Machine, position: Array, deposited: Array, bodies: float, centre: Array
) -> Array:
    """Return the part's moment about the carrier's last axis after each row, (n,) kg mm."""
    frames_at_rest = machine.chain.frames(np.zeros(machine.chain.axes))
    to_flange = frames.inverse(frames_at_rest.flange)
    axis = to_flange[:3, :3] @ frames_at_rest.directions[-1]
    through = to_flange[:3, :3] @ frames_at_rest.origins[-1] + to_flange[:3, 3]
    middles = 0.5 * (position + np.concatenate([position[:1], position[:-1]]))
    arms = np.cross(cell.to_carrier(np.nan_to_num(middles)) - through, axis)
    own_moment = np.cross(cell.to_carrier(centre[None]) - through, axis)
    return np.asarray(
        np.linalg.norm(bodies * own_moment + np.cumsum(deposited[:, None] * arms, axis=0), axis=1)
    )


def _issue_at(motion: Motion, row: int, message: str) -> Issue:
    return Issue(
        ERROR,
        CODE,
        message,
        int(motion.layer[row]),
        int(motion.bead[row]),
        max(0, int(motion.point[row])),
    )
