# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reject machines and motions that the controller of a post does not support, before planning."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ...core.geometry.formatting import count
from ...core.issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...core.kinematics.cell import Cell
from ...core.kinematics.machines import machine as machines
from ...core.kinematics.machines.machine import UNKNOWN_REMARK, Machine
from ...core.parameters.cell import CellParameters
from ...core.parameters.program import MOTIONS, ProgramParameters
from ...core.toolpath import Toolpath
from ...posts.catalogue import NAMES, controller, fitting, motion_written

MB = 1e6
LARGE_MB, MANY_FILES = 2.0, 20  # program size and file count above which a note is given
MOVES_A_BEAD = 4  # number of approach and retract moves per bead
APPROACH_POINTS = 50  # maximum number of approach points counted per bead


def check(cell: Cell, parameters: ProgramParameters) -> None:
    """Check that the controller of the program's post supports the cell.

    Raises InputError WRONG_CONTROLLER, UNSUPPORTED_AXES, NOT_FOR_WRIST, NO_PULSES, NO_SPEED_UNIT.
    """
    check_controller(cell.robot, parameters.post)
    check_external(cell, parameters.post)
    check_wrist(cell.machine, parameters.motion, parameters.post)
    check_pulses(cell.machine, parameters.motion, parameters.post)


def check_controller(machine: Machine, post: str) -> None:
    """Raise InputError WRONG_CONTROLLER if the machine file excludes the post."""
    if machine.posts is None or post in machine.posts:
        return
    if machine.controller_remark == UNKNOWN_REMARK:
        raise InputError(
            "WRONG_CONTROLLER",
            "program.post",
            "{} is a URDF, which does not define the display of the controller; plan without a "
            "program, or convert the URDF with New Machine…",
            machine.title,
        )
    readable = (
        Text("use one of {}", ", ".join(machine.posts))
        if machine.posts
        else (
            "no post supports the controller yet; plan without a program, and use the axis values in waypoints.csv"
        )
    )
    raise InputError(
        "WRONG_CONTROLLER",
        "program.post",
        "the controller of {} does not read {}; {}",
        machine.title,
        post,
        Word(readable),
    )


def check_beads(toolpath: Toolpath, post: str, max_points: int) -> None:
    """Raise InputError BEAD_TOO_LONG if a bead has more points than a program file may have.

    Applies to posts that keep a whole bead in one file.
    """
    if not controller(post).whole_beads:
        return
    points, layer, index = max(
        ((len(bead), layer, index) for layer, index, bead in toolpath), default=(0, 0, 0)
    )
    if points > max_points:
        raise InputError(
            "BEAD_TOO_LONG",
            "program.max_points",
            "layer {} bead {} has {} points, and loading another part within a bead would stop "
            "the robot while it deposits; set program.max_points to at least {}, or a larger "
            "strategy.chord_error",
            layer,
            index,
            points,
            points + APPROACH_POINTS,
        )


def size_issues(toolpath: Toolpath, parameters: ProgramParameters) -> list[Issue]:
    """Return a warning if the program will exceed the controller's known capacity.

    Return a note if the program is large or has many files. The size is estimated from the toolpath
    points, before joint planning.
    """
    if parameters.post == "none":
        return []
    kind = controller(parameters.post)
    beads = [len(bead) for _, _, bead in toolpath]
    points = sum(beads) + MOVES_A_BEAD * len(beads)
    files = 1 if points <= parameters.max_points else 1 + math.ceil(points / parameters.max_points)
    megabytes = points * kind.point_bytes / MB
    is_too_large = bool(kind.memory_mb) and megabytes > kind.memory_mb
    if not is_too_large and megabytes < LARGE_MB and files < MANY_FILES:
        return []
    room = (
        Text(
            "known controllers of this type store about {:g} MB in total",
            kind.memory_mb,
        )
        if kind.memory_mb
        else Text("the memory of the controller is unknown; look up its size")
    )
    return [
        Issue(
            WARNING if is_too_large else NOTE,
            "PROGRAM_SIZE",
            Text(
                "the program of {} will have about {} points in {} files, {:.2g} MB: {}; use a "
                "larger strategy.chord_error or strategy.layer_height for a smaller program, and "
                "program.max_points for smaller files",
                parameters.post,
                count(points),
                files,
                megabytes,
                room,
            ),
        )
    ]


def likely_size_issues(toolpath: Toolpath, cell: Cell) -> list[Issue]:
    """Return `size_issues` before a program exists, for the machine's first post and defaults."""
    posts = readers(cell)
    return size_issues(toolpath, ProgramParameters(post=posts[0])) if posts else []


def base_issues(machine: Machine, parameters: ProgramParameters) -> list[Issue]:
    """Return a warning if a Cartesian program's base frame may differ from the controller's."""
    if machine.base_is_known or parameters.motion != "cartesian" or parameters.post == "none":
        return []
    return [
        Issue(
            WARNING,
            "BASE_NOT_KNOWN",
            Text(
                "the base frame of {} is unknown, so positions of the program refer to its "
                "base_link; compare the pose of a known point on the controller before running "
                "the program, set `base` in a copy of the machine file, or use program.motion: "
                "joint",
                machine.title,
            ),
        )
    ]


def machine_issues(cell: Cell, parameters: ProgramParameters) -> list[Issue]:
    """Return a note with the machine file's uncertainties on joint values, limits and speeds."""
    if parameters.post == "none":
        return []
    kinds = ["limits", f"limits.{cell.limits.name}", "speeds"]
    kinds += ["joint"] if parameters.motion == "joint" else []
    texts = [
        text
        for machine in dict.fromkeys((cell.robot, cell.machine))
        for text in machine.warnings_of(*kinds)
    ]
    if not texts:
        return []
    message = Text("{}: {}", cell.robot.title, " ".join(dict.fromkeys(texts)))
    return [Issue(NOTE, "MACHINE_NOT_VERIFIED", message)]


def check_external(cell: Cell, post: str) -> None:
    """Raise InputError UNSUPPORTED_AXES if the post does not support the cell's external axes."""
    written = readers(cell)
    if cell.external is None or written is None or post in written:
        return
    external = (
        "a positioner"
        if cell.external.slides is None
        else ("a track and a positioner together" if cell.external.turning else "a track")
    )
    reason = (
        Text("use one of {}", ", ".join(written))
        if written
        else "plan without a program, and use the axis values in waypoints.csv"
    )
    raise InputError(
        "UNSUPPORTED_AXES",
        "program.post",
        "programs of {} are not written with {}; {}",
        post,
        Word(external),
        Word(reason),
    )


def check_wrist(machine: Machine, motion: str, post: str) -> None:
    """Raise InputError NOT_FOR_WRIST for a Cartesian program of a robot without a spherical wrist.

    Applies to posts that write configurations, which are unknown for such robots.
    """
    if (
        motion == "cartesian"
        and machine.arm is not None
        and machine.opw is None
        and controller(post).configurations
    ):
        raise InputError(
            "NOT_FOR_WRIST",
            "program.motion",
            "{} has no spherical wrist, and the configuration names of its controller are "
            "unknown for Cartesian positions; use joint",
            machine.title,
        )


def check_pulses(machine: Machine, motion: str, post: str) -> None:
    """Raise InputError NO_PULSES or NO_SPEED_UNIT if the machine file lacks data that a post needs.

    Only the robot's own controller shows this data.
    """
    if controller(post).pulses and not machine.pulses_per_degree:
        raise InputError(
            "NO_PULSES",
            "cell.machine",
            "the pulses per degree of {} are unknown, and differ between models; make your own "
            "machine file with controller.pulses_per_degree as shown on the pendant (a position "
            "in pulses divided by the same in degrees), or plan without a program",
            machine.title,
        )
    if controller(post).pulses and motion == "cartesian" and not machine.speed_unit:
        raise InputError(
            "NO_SPEED_UNIT",
            "cell.machine",
            "the unit of V is a setting of the controller of {}, and a wrong unit changes the "
            "speed; set controller.speed_unit in your own machine file, or use `motion: joint`",
            machine.title,
        )


def written_by(machine: Machine) -> tuple[str, ...] | None:
    """Return the posts that can write programs for a machine, by its file; None for any post."""
    if machine.posts is None or machine.pulses_per_degree:
        return machine.posts
    return tuple(post for post in machine.posts if not controller(post).pulses)


def writers(machine: Machine, posts: Sequence[str], setup: str) -> list[tuple[str, str]]:
    """Return the usable posts with their motion type, for a machine in a set-up.

    Posts that write the default motion type come first.
    """
    usual = ProgramParameters().motion
    written = [(post, usual) for post in fitting(posts, usual, setup)]
    return written + [
        (post, motion)
        for motion in MOTIONS
        if motion != usual
        for post in fitting(posts, motion, setup)
        if (post, usual) not in written and _is_written(machine, motion, post)
    ]


def _is_written(machine: Machine, motion: str, post: str) -> bool:
    try:
        check_wrist(machine, motion, post)
        check_pulses(machine, motion, post)
    except InputError:
        return False
    return True


def post_of(settings: CellParameters, preferred: str, folders: Sequence[str]) -> tuple[str, str]:
    """Return post and motion type of a new program in a cell.

    Use the preferred post ('' for the default) if the controller reads its format, else another
    suitable post. Return ('', '') without a suitable post.
    """
    machine, usual = machines.load(settings.machine, tuple(folders)), ProgramParameters()
    posts = written_by(machine)
    if settings.external:
        posts = _select_external(posts)
    preferred = preferred or usual.post
    if posts is None or preferred in posts:
        return next(iter(writers(machine, (preferred,), settings.setup)), (preferred, usual.motion))
    return next(iter(writers(machine, posts, settings.setup)), ("", ""))


def usual_motion(joint_path: Any, post: Any) -> dict[str, str]:
    """Return the motion type to use, as {"motion": ...}, if the post cannot write the default type.

    Empty if the post can, or if post or set-up are unknown.
    """
    linked = getattr(joint_path, "Cell", None)
    setup = getattr(linked, "Setup", "")
    usual = ProgramParameters()
    if post is not None and not isinstance(post, str):  # rejected when the program is made
        return {}
    try:
        motion = motion_written(post or usual.post, str(setup))
    except InputError:  # reported when the program is made
        return {}
    return {} if motion == usual.motion else {"motion": motion}


def readers(cell: Cell) -> tuple[str, ...] | None:
    """Return the posts that the controller of a cell reads, None for any post.

    With external axes, return only posts that support external axes.
    """
    posts = cell.machine.posts
    if cell.external is None:
        return posts
    return _select_external(posts)


def _select_external(posts: Sequence[str] | None) -> tuple[str, ...]:
    """Return those `posts` (None for all posts) that support external axes."""
    return tuple(
        post for post in sorted(NAMES if posts is None else posts) if controller(post).external
    )
