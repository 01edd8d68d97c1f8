# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program must know of the controller that reads it, and machines and motions that it does not read."""

from __future__ import annotations

from ..issues import InputError
from ..kinematics.cell import Cell
from ..kinematics.machine import NOT_TOLD, Machine
from ..toolpath import Toolpath

# posts whose programs count on where the flange is, and those whose positions need no words for configurations of the arm
FLANGE_TOLD, WITHOUT_CONFIGURATIONS = frozenset({"ur"}), frozenset({"ur"})
# posts that write positions in pulses of the axes, and Cartesian speeds in the unit of the controller
IN_PULSES = frozenset({"yaskawa"})
# posts whose files are loaded one after the other, each with whole beads
WHOLE_BEADS = frozenset({"abb", "staubli"})
BESIDE = 50  # points of the ways to a bead, which are counted with it, at most
# what controllers call the first positioner of a cell: mechanical unit, motion group, number of MACHINE_DEF
UNITS = {"abb": "STN1", "fanuc": "2", "kuka": "2", "yaskawa": "ST1"}


def check_controller(machine: Machine, post: str) -> None:
    """InputError WRONG_CONTROLLER when the machine file says that its controller does not read that post's programs."""
    if machine.posts is None or post in machine.posts:
        return
    if machine.controller_remark == NOT_TOLD:
        raise InputError("WRONG_CONTROLLER", "program.post", f"{machine.title} is a URDF, which does not tell what the "
                         "controller shows; plan without a program, or make a machine file of it with New Machine…")
    known = f"use one of {', '.join(machine.posts)}" if machine.posts else (
        "there is no post for it yet: plan without a program; waypoints.csv has its axes")
    raise InputError("WRONG_CONTROLLER", "program.post", f"the controller of {machine.title} does not read {post}; {known}")


def check_beads(toolpath: Toolpath, post: str, max_points: int) -> None:
    """InputError BEAD_TOO_LONG when a bead alone has more points than a file of the program may have: programs tell all
    points of beads."""
    if post not in WHOLE_BEADS:
        return
    points, layer, index = max(((len(bead), layer, index) for layer, index, bead in toolpath), default=(0, 0, 0))
    if points > max_points:
        raise InputError(
            "BEAD_TOO_LONG", "program.max_points", f"layer {layer} bead {index} has {points} points, and loading another "
            f"part within a bead would stop the robot while it deposits; use at least {points + BESIDE}, or a larger "
            "strategy.chord_error",
        )


def check_external(cell: Cell, post: str) -> None:
    """InputError UNSUPPORTED_AXES when a post of the robot does not write the axes beside it."""
    written = cell.machine.posts
    if cell.external is None or written is None or post in written:
        return
    beside = "a positioner" if cell.external.slides is None else (
        "a track and a positioner together" if cell.external.turning else "a track")
    known = f"use one of {', '.join(written)}" if written else "plan without a program; waypoints.csv has all axes"
    raise InputError("UNSUPPORTED_AXES", "program.post", f"programs of {post} are not written with {beside}; {known}")


def check_wrist(machine: Machine, motion: str, post: str) -> None:
    """InputError NOT_FOR_WRIST: Cartesian programs of robots without a spherical wrist by posts that name configurations."""
    if motion == "cartesian" and machine.redundant and machine.opw is None and post not in WITHOUT_CONFIGURATIONS:
        raise InputError(
            "NOT_FOR_WRIST", "program.motion", f"{machine.title} has no spherical wrist, and what its controller calls the "
            "configurations of cartesian positions is not known; use joint",
        )


def check_pulses(machine: Machine, motion: str, post: str) -> None:
    """InputError NO_PULSES, NO_SPEED_UNIT where a post needs what only the controller of that very robot tells."""
    if post in IN_PULSES and not machine.pulses_per_degree:
        raise InputError(
            "NO_PULSES", "cell.machine", f"how many pulses {machine.title} counts to a degree of each axis is not known, "
            "and no two models are alike; make a machine file of your own of it, with controller.pulses_per_degree as the "
            "pendant tells (a position in pulses over the same in degrees), or plan without a program",
        )
    if post in IN_PULSES and motion == "cartesian" and not machine.speed_unit:
        raise InputError(
            "NO_SPEED_UNIT", "cell.machine", f"the unit of V is a setting of the controller of {machine.title}, and another "
            "one is another speed; give controller.speed_unit in a machine file of your own, or use `motion: joint`",
        )


def written_by(machine: Machine) -> tuple[str, ...] | None:
    """The posts that programs for a machine can be written by, with what its file tells; None for any."""
    if machine.posts is None or machine.pulses_per_degree:
        return machine.posts
    return tuple(post for post in machine.posts if post not in IN_PULSES)
