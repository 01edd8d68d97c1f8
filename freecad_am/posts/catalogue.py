# SPDX-License-Identifier: LGPL-2.1-or-later
"""The posts there are, by the name a job uses."""

from __future__ import annotations

import contextlib
import importlib
import re
from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from ..core.controller import Controller
from ..core.issues import InputError
from ..core.orientation import Pendant
from ..core.program import Program
from ..core.read_moves import ReadMoves
from .names import Naming
from .refusals import Asked

NAMES = (
    "fanuc",
    "staubli",
    "siemens",
    "linuxcnc",
    "ur",
    "yaskawa",
    "abb",
    "kuka",
)
_MOTIONS = ("joint", "cartesian")  # the usual one first
# of the modules next to this one

# the parameters below `program.nc` that each post reads; other posts read none
NC_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    "siemens": (
        "feed",
        "compress",
        "smooth",
        "deposit_on",
        "deposit_off",
        "wire_output",
        "wire_gain",
    ),
    "linuxcnc": (
        "feed",
        "tolerance",
        "deposit_on",
        "deposit_off",
        "wire_output",
        "wire_gain",
        "switch_kinematics",
    ),
    "abb": ("wire_output", "wire_gain"),
}


class Post(Protocol):
    """The interface of a post module. CONTROLLER: properties of the controller for planning.
    PENDANT: how its pendant shows frames, None if it shows only axes. NO_WIRE: why programs cannot
    set the speed of the wire along a bead, '' if they can. NO_SCHEDULE: why schedules are not
    supported, by the unsupported ways ('output', 'arc'). NO_WEAVE: why beads cannot be woven,
    NO_TRIGGER: why the deposit cannot be switched ahead of a position; '' if they can. MOVE_LINE:
    pattern of the beginning of a line with a move, or, in a loop, several. NAMING: of programs.
    ON_CONTROLLER: checks that only the controller can do.
    """

    CONTROLLER: Controller
    PENDANT: Pendant | None
    NO_WIRE: str
    NO_SCHEDULE: Mapping[str, str]
    NO_WEAVE: str
    NO_TRIGGER: str
    MOVE_LINE: re.Pattern[bytes]
    NAMING: Naming
    ON_CONTROLLER: tuple[str, ...]

    def program_name(self, name: str, where: str) -> str:
        """The program's name on the controller; raises InputError PROGRAM_NAME, at `where`, for one it refuses."""

    def write(self, program: Program) -> dict[str, bytes]:
        """The controller's files, name -> content; raises InputError for what the controller would refuse."""

    def refuse_setup(
        self,
        motion: str,
        setup: str,
        external: tuple[str, ...] = (),
        carried: tuple[float, ...] | None = None,
    ) -> None:
        """Raises InputError, with the reason, if the controller does not support a motion in a
        set-up with external axes of given kinds, as in programs, and with the flange's load
        `carried`, None if not known yet.
        """

    def refuse_process(self, request: Asked) -> None:
        """Raises InputError, with the reason, if process settings exclude each other, or the motion
        or set-up.
        """

    def read(self, files: dict[str, bytes]) -> ReadMoves:
        """The moves found in the files, in the order of execution; raises InputError UNREADABLE_PROGRAM."""


def load(name: str) -> Post:
    """The post with a name, imported on first use. Raises InputError UNKNOWN_POST."""
    if name not in NAMES:
        names = ", ".join(NAMES)
        raise InputError(
            "UNKNOWN_POST", "program.post", "unknown post {!r}; use one of {}, or none", name, names
        )
    post: Any = importlib.import_module(f".{name}.post", __package__)
    post_module: Post = post
    return post_module


def controller(name: str) -> Controller:
    """Properties of a post's controller for planning; none required for the post `none`. InputError
    UNKNOWN_POST.
    """
    return Controller() if name == "none" else load(name).CONTROLLER


def reads_nc(post: str, parameter: str) -> bool:
    """Whether programs of a post depend on a parameter below `program.nc`; True for an unknown
    post.
    """
    return parameter in NC_PARAMETERS.get(post, ()) if post in NAMES or post == "none" else True


def fitting(posts: Iterable[str], motion: str, setup: str) -> tuple[str, ...]:
    """The posts, by name, that support a motion in a set-up."""
    names = []
    for name in posts:
        with contextlib.suppress(InputError):
            load(name).refuse_setup(motion, setup)
            names.append(name)
    return tuple(names)


def motion_written(post: str, setup: str) -> str:
    """The default motion of a program: joint if the post supports it in the set-up, or supports
    neither, else cartesian. InputError UNKNOWN_POST.
    """
    load(post)
    return next((motion for motion in _MOTIONS if fitting((post,), motion, setup)), _MOTIONS[0])


def main_file(files: Iterable[str]) -> str:
    """The main file of a program by the names of its files: the start of a VAL 3 application, else
    the shortest name, which has no part number.
    """
    return min(files, key=lambda name: (not name.endswith("/start.pgx"), len(name), name))
