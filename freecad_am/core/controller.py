# SPDX-License-Identifier: LGPL-2.1-or-later
"""What planning must know of the controller that a program is for. Every post has one such record and hands it down."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Controller:
    """The requirements of a controller on planning; the defaults describe a controller without any.

    external: whether axes next to the robot are written, and positioner: its default name for the
    first one that carries the part (mechanical unit, motion group, number of MACHINE_DEF).
    configurations: whether Cartesian positions name the configuration of the arm, in words of a
    spherical wrist. flange: whether programs with the part on the robot count on the pose of the
    flange. pulses: whether positions are in pulses of the axes, and Cartesian speeds in the unit of
    the controller. whole_beads: whether a program of several files is loaded file by file, each
    with whole beads. straight_in_part: whether linear moves with the part on the robot run straight
    as the part sees them, so that beads need no points in between. least_step: s, shorter moves of
    a bead are not taken, 0 where there is no limit. least_blend: mm next to a point, by controllers
    that blend by a share of it at 100 % and stop where that is too little. arc_moves: whether arc
    instructions are linear moves themselves, the one onto the start of a bead and its last one.
    linear_triggers: whether the deposit is switched ahead of a place on linear moves, in Cartesian
    programs on the one onto a bead too. point_bytes: about how many bytes of the program a point
    takes. memory_mb: MB of programs that a user of such a controller was known to have room for, 0
    if unknown.
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
