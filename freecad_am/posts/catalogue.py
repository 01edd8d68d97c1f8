# SPDX-License-Identifier: LGPL-2.1-or-later
"""Load posts by their names in jobs, and find the moves in the files that they write."""

from __future__ import annotations

import contextlib
import importlib
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from ..core.controller import Controller
from ..core.issues import InputError, Text
from ..core.orientation import Pendant
from ..core.program import Program
from ..core.read_moves import ReadMoves
from ..core.types import Integers
from .refusals import Asked


def controller_checks(*promises: str) -> tuple[str, ...]:
    """Collect requirements on the controller, one sentence each; docs/posts describes the settings."""
    return promises


# file names that Windows reserves for devices
DEVICES = frozenset(
    ("CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10)))
)


@dataclass(frozen=True)
class Naming:
    """Naming rules of a controller.

    written: converts a name to its form on the controller. start: pattern of the beginning of a
    name. starts: description of that pattern. longest: maximum number of characters. spare:
    characters that proposals leave free for part numbers. prefix: begins a proposal if the name
    itself is not valid. reserved: upper-case words that cannot be names, in addition to DEVICES.
    """

    written: Callable[[str], str]
    start: str
    starts: str
    longest: int
    spare: int
    prefix: str
    reserved: frozenset[str] = field(default_factory=frozenset)
    what: str = "a program's name"

    def checked(self, name: str, where: str) -> str:
        """Return the name in its form on the controller.

        Raises InputError PROGRAM_NAME with the reason and a valid proposal.
        """
        as_written = self.written(name) if name.isascii() else name
        if not name:
            raise self.refused(name, where, "the name is empty")
        if re.search(r"[^A-Za-z0-9_]", as_written):
            raise self.refused(
                name, where, "a name may contain only the letters A to Z, digits and underscores"
            )
        if not re.match(self.start, as_written):
            raise self.refused(name, where, Text("a name must start with {}", self.starts))
        if len(as_written) > self.longest:
            raise self.refused(
                name, where, Text("the name has more than {} characters", self.longest)
            )
        if self._is_reserved(as_written):
            raise self.refused(name, where, "the name is a reserved word")
        return as_written

    def fits(self, name: str) -> bool:
        """Whether a name is valid with room for part numbers."""
        try:
            return len(self.checked(name, "name")) <= self.longest - self.spare
        except InputError:
            return False

    def refused(self, name: str, where: str, why: str) -> InputError:
        """Build the error for an invalid name, with a valid proposal.

        Parameters
        ----------
        name : str
            The name.
        where : str
            Key of the name, for messages.
        why : str
            Why the name is invalid.

        Returns
        -------
        InputError
            Error PROGRAM_NAME.
        """
        return InputError(
            "PROGRAM_NAME",
            where,
            "{!r} cannot be {} on the controller: {}; use {!r}",
            name,
            self.what,
            why,
            self.proposed(name),
        )

    def proposed(self, name: str) -> str:
        """Return a similar name that is valid with room for part numbers."""
        proposal = self.written(re.sub(r"[^A-Za-z0-9]+", "_", plain(name)).strip("_"))
        if not re.match(self.start, proposal) or self._is_reserved(proposal):
            proposal = f"{self.prefix}{proposal}".rstrip("_")
        return proposal[: self.longest - self.spare].rstrip("_")

    def parts(self, name: str, count: int) -> list[str]:
        """Return names for `count` parts. Raises InputError PROGRAM_NAME if their numbers do not
        fit.
        """
        digits = max(2, len(str(count)))
        names = [f"{name}{number:0{digits}d}" for number in range(1, count + 1)]
        if len(names[0]) > self.longest:
            raise self.refused(
                name,
                "name",
                Text(
                    "with the {} digits of its parts the name has more than {} characters",
                    digits,
                    self.longest,
                ),
            )
        return names

    def _is_reserved(self, name: str) -> bool:
        return name.upper() in DEVICES | self.reserved


def plain(text: str) -> str:
    """Convert text to printable ASCII characters."""
    ascii_text = (
        unicodedata.normalize("NFKD", text.replace("ß", "ss"))
        .encode("ascii", "ignore")
        .decode("ascii")
    )
    return re.sub(r"[^ -~]+", " ", ascii_text)


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
_MOTIONS = ("joint", "cartesian")  # the default first

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
    """Interface of a post module.

    CONTROLLER: properties of the controller for planning. PENDANT: how its pendant shows frames;
    None if it shows only axes. NO_WIRE, NO_WEAVE, NO_TRIGGER: why programs cannot set the wire feed
    along a bead, weave beads, or switch the deposit ahead of a position; '' if they can.
    NO_SCHEDULE: why schedules are not supported, by method ('output', 'arc'). MOVE_LINE: pattern of
    the beginning of a line with a move, or with several moves in a loop. NAMING: rules for program
    names. ON_CONTROLLER: checks that are possible only on the controller.
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
        """Return the program's name on the controller.

        Raises InputError PROGRAM_NAME, at `where`, for an invalid name.
        """

    def write(self, program: Program) -> dict[str, bytes]:
        """Return the controller's files, name -> content.

        Raises InputError for everything that the controller would reject.
        """

    def refuse_setup(
        self,
        motion: str,
        setup: str,
        external: tuple[str, ...] = (),
        carried: tuple[float, ...] | None = None,
    ) -> None:
        """Reject a set-up that the controller does not support.

        Parameters
        ----------
        motion : str
            'joint' or 'cartesian'.
        setup : str
            Set-up of the cell, such as 'tool-on-robot'.
        external : tuple of str, optional
            Kinds of the external axes, as in programs.
        carried : tuple[float, ...] or None, optional
            Frame that the flange carries, X Y Z RX RY RZ in mm and rad; None if not known yet.

        Raises
        ------
        InputError
            With the reason.
        """

    def refuse_process(self, request: Asked) -> None:
        """Raise InputError, with the reason, if process settings conflict with each other, the
        motion or the set-up.
        """

    def read(self, files: dict[str, bytes]) -> ReadMoves:
        """Read the moves of the files in the order of execution. Raises InputError
        UNREADABLE_PROGRAM.
        """


def load(name: str) -> Post:
    """Return the post with a name, imported on first use. Raises InputError UNKNOWN_POST."""
    if name not in NAMES:
        names = ", ".join(NAMES)
        raise InputError(
            "UNKNOWN_POST", "program.post", "unknown post {!r}; use one of {}, or none", name, names
        )
    post: Any = importlib.import_module(f".{name}.post", __package__)
    post_module: Post = post
    return post_module


def controller(name: str) -> Controller:
    """Return a controller's properties for planning; the post `none` has no requirements.

    Raises InputError UNKNOWN_POST.
    """
    return Controller() if name == "none" else load(name).CONTROLLER


def reads_nc(post: str, parameter: str) -> bool:
    """Whether programs of a post depend on a parameter below `program.nc`; True for an unknown
    post.
    """
    return parameter in NC_PARAMETERS.get(post, ()) if post in NAMES or post == "none" else True


def fitting(posts: Iterable[str], motion: str, setup: str) -> tuple[str, ...]:
    """Return the posts that support a motion in a set-up.

    Parameters
    ----------
    posts : iterable of str
        Names of posts.
    motion : str
        'joint' or 'cartesian'.
    setup : str
        Set-up of the cell.

    Returns
    -------
    tuple of str
        Names of the supporting posts.
    """
    names = []
    for name in posts:
        with contextlib.suppress(InputError):
            load(name).refuse_setup(motion, setup)
            names.append(name)
    return tuple(names)


def motion_written(post: str, setup: str) -> str:
    """Return the default motion of a program: joint if the post supports it in the set-up or
    supports neither motion, otherwise cartesian. Raises InputError UNKNOWN_POST.
    """
    load(post)
    return next((motion for motion in _MOTIONS if fitting((post,), motion, setup)), _MOTIONS[0])


def main_file(files: Iterable[str]) -> str:
    """Return the main file of a program: the start of a VAL 3 application, otherwise the shortest
    name, which has no part number.
    """
    return min(files, key=lambda name: (not name.endswith("/start.pgx"), len(name), name))


_NUMBER = re.compile(r"\d+")
_LOOP = re.compile(rb"for \w+=(\d+) to (\d+)")  # VAL 3 loop around a single move


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of n moves in the order of execution.

    files: file names. file: (n,) index into `files`. line: (n,) line number, from 0.
    """

    files: tuple[str, ...]
    file: Integers
    line: Integers

    def __len__(self) -> int:
        return len(self.line)

    def of(self, row: int) -> tuple[str, int]:
        """Return file and line of a move.

        Parameters
        ----------
        row : int
            Index of the move.

        Returns
        -------
        file : str
            Name of the file.
        line : int
            Line number, from 0.
        """
        return self.files[self.file[row]], int(self.line[row])

    def move_at(self, name: str, line: int) -> int | None:
        """Return the move at a line of a file.

        In a loop this is the first move, between two moves the next one, and after all moves the
        last one. Return None for a file without moves.
        """
        moves_of_file = (
            np.flatnonzero(self.file == self.files.index(name))
            if name in self.files
            else np.zeros(0, np.int64)
        )
        if not len(moves_of_file):
            return None
        return int(
            moves_of_file[
                min(int(np.searchsorted(self.line[moves_of_file], line)), len(moves_of_file) - 1)
            ]
        )


def lines_of(post: str, files: dict[str, bytes]) -> Lines:
    """Return the lines of all moves in one of our programs. Parts run in the order of their
    numbers.
    """
    pattern = load(post).MOVE_LINE
    names = tuple(
        sorted(files, key=lambda name: [int(number) for number in _NUMBER.findall(name)] + [0])
    )
    move_lines = [_moves(pattern, files[name]) for name in names]
    file = np.repeat(np.arange(len(names)), [len(lines) for lines in move_lines])
    return Lines(
        names, file, np.array([line for lines in move_lines for line in lines], dtype=np.int64)
    )


def _moves(pattern: re.Pattern[bytes], content: bytes) -> list[int]:
    """Return the line of each move of a file, repeated as often as the move runs."""
    move_lines: list[int] = []
    times = 1
    for number, line in enumerate(content.split(b"\n")):
        loop = _LOOP.search(line)
        if loop:
            times = int(loop[2]) - int(loop[1]) + 1
        elif pattern.match(line):
            move_lines += [number] * times
            times = 1
    return move_lines
