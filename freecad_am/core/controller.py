# SPDX-License-Identifier: LGPL-2.1-or-later
"""Controller requirements that planning must meet. Every post provides one such record."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Controller:
    """Requirements of a controller on planning; the defaults describe a controller without any.

    external: whether the post writes external axes. positioner: default name of the first
    mechanism that carries the part (mechanical unit, motion group, number of MACHINE_DEF).
    configurations: whether Cartesian positions name the arm configuration, in terms of a spherical
    wrist. flange: whether programs with the part on the robot need the flange pose. pulses: whether
    positions are in axis pulses, and Cartesian speeds in the controller's unit. whole_beads:
    whether a program of several files is loaded file by file, each with whole beads.
    straight_in_part: whether linear moves with the part on the robot are straight in the part
    frame, so that beads need no intermediate points. least_step: s, minimum duration of a bead
    move, 0 without a limit. least_blend: mm next to a point, for controllers whose blend at 100 %
    is a fraction of that distance and which stop if it is too short. arc_moves: whether arc
    instructions are themselves linear moves, namely the move onto the start of a bead and its last
    move. linear_triggers: whether the deposit can be switched ahead of a point on linear moves; in
    Cartesian programs this includes the move onto a bead. point_bytes: approximate program bytes
    per point. memory_mb: MB, known program memory of such a controller, 0 if unknown.
    """

    external: bool = False
    positioner: str = ""
    configurations: bool = True
    flange: bool = False
    pulses: bool = False
    whole_beads: bool = False
    straight_in_part: bool = False
    least_step: float = 0.0
    least_blend: float = 0.0
    arc_moves: bool = False
    linear_triggers: bool = False
    point_bytes: int = 100
    memory_mb: float = 0.0
