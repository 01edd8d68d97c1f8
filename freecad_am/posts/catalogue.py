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
# of the modules beside this one

# what each post reads of the parameters below `program.nc`; the others read none of them
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
    """What a post module offers. CONTROLLER: what planning must know of the controller. PENDANT: how its pendant shows
    frames, None where it shows axes alone. NO_WIRE: why programs cannot tell the speed of the wire along a bead, '' where
    they can. NO_SCHEDULE: why it cannot be told schedules, by the ways ('output', 'arc') in which it cannot. NO_WEAVE: why
    beads cannot be woven, NO_TRIGGER: why the deposit cannot be switched ahead of a place; '' where they can. MOVE_LINE:
    how a line begins that tells a move, or, in a loop, several. NAMING: of programs. ON_CONTROLLER: what only the controller
    can show."""

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
        """Raises InputError, saying why, when this motion of this set-up cannot be said to the controller, with external
        axes of these kinds, as programs have them, and what the flange carries, None where that is not known yet."""

    def refuse_process(self, asked: Asked) -> None:
        """Raises InputError, saying why, where things of the process can be told, but not with each other, or not with this
        motion or set-up."""

    def read(self, files: dict[str, bytes]) -> ReadMoves:
        """The moves found in the files, in the order of execution; raises InputError UNREADABLE_PROGRAM."""


def load(name: str) -> Post:
    """The post of that name, imported when it is first asked for. Raises InputError UNKNOWN_POST."""
    if name not in NAMES:
        names = ", ".join(NAMES)
        raise InputError(
            "UNKNOWN_POST", "program.post", "{!r} is not known; use one of {}, or none", name, names
        )
    post: Any = importlib.import_module(f".{name}.post", __package__)
    post_module: Post = post
    return post_module


def controller(name: str) -> Controller:
    """What planning must know of the controller of a post; of `none` that it asks for nothing. InputError UNKNOWN_POST."""
    return Controller() if name == "none" else load(name).CONTROLLER


def reads_nc(post: str, parameter: str) -> bool:
    """Whether programs of a post depend on a parameter below `program.nc`; of an unknown post they may."""
    return parameter in NC_PARAMETERS.get(post, ()) if post in NAMES or post == "none" else True


def fitting(posts: Iterable[str], motion: str, setup: str) -> tuple[str, ...]:
    """Those of the posts, by name, that can say this motion of this set-up."""
    names = []
    for name in posts:
        with contextlib.suppress(InputError):
            load(name).refuse_setup(motion, setup)
            names.append(name)
    return tuple(names)


def motion_written(post: str, setup: str) -> str:
    """The motion of a program that names none: joint, where the post writes that of the set-up or neither, else cartesian.
    InputError UNKNOWN_POST."""
    load(post)
    return next((motion for motion in _MOTIONS if fitting((post,), motion, setup)), _MOTIONS[0])


def main_file(files: Iterable[str]) -> str:
    """The file that begins a program, of the names of all its files: the start of a VAL 3 application, else the one with the
    shortest name, which has no number of a part."""
    return min(files, key=lambda name: (not name.endswith("/start.pgx"), len(name), name))
