# SPDX-License-Identifier: LGPL-2.1-or-later
"""The available posts, by the names in jobs."""

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
    """Requirements on the controller, one sentence each; docs/posts describes the settings."""
    return promises


# names that files cannot have on the computers that handle programs
DEVICES = frozenset(
    ("CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10)))
)


@dataclass(frozen=True)
class Naming:
    """The rules of a controller.

    written: converts a name to its form on the controller. start, starts: pattern of its beginning,
    and the same in words. longest: maximum characters; proposals leave `spare` of them for the
    digits of parts.
    reserved: upper-case words that cannot be names; DEVICES never can. prefix: begins proposals if
    the name itself is not valid.
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
        """The name as the controller has it. Raises InputError PROGRAM_NAME with the reason and a
        valid proposal.
        """
        as_written = self.written(name) if name.isascii() else name
        if not name:
            raise self.refused(name, where, "it is empty")
        if re.search(r"[^A-Za-z0-9_]", as_written):
            raise self.refused(
                name, where, "it may hold only the letters A to Z, digits and underscores"
            )
        if not re.match(self.start, as_written):
            raise self.refused(name, where, Text("it must start with {}", self.starts))
        if len(as_written) > self.longest:
            raise self.refused(name, where, Text("it has more than {} characters", self.longest))
        if self._is_reserved(as_written):
            raise self.refused(name, where, "it is a reserved word")
        return as_written

    def fits(self, name: str) -> bool:
        """Whether a name is valid with the digits of parts appended."""
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
            Why it is invalid.

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
        """A similar name that is valid with the digits of parts appended."""
        proposal = self.written(re.sub(r"[^A-Za-z0-9]+", "_", plain(name)).strip("_"))
        if not re.match(self.start, proposal) or self._is_reserved(proposal):
            proposal = f"{self.prefix}{proposal}".rstrip("_")
        return proposal[: self.longest - self.spare].rstrip("_")

    def parts(self, name: str, count: int) -> list[str]:
        """Names of `count` parts. Raises InputError PROGRAM_NAME if their digits do not fit."""
        digits = max(2, len(str(count)))
        names = [f"{name}{number:0{digits}d}" for number in range(1, count + 1)]
        if len(names[0]) > self.longest:
            raise self.refused(
                name,
                "name",
                Text(
                    "with the {} digits of its parts it has more than {} characters",
                    digits,
                    self.longest,
                ),
            )
        return names

    def _is_reserved(self, name: str) -> bool:
        return name.upper() in DEVICES | self.reserved


def plain(text: str) -> str:
    """The text in printable ASCII characters."""
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
        """The program's name on the controller. Raises InputError PROGRAM_NAME, at `where`, for an
        invalid one.
        """

    def write(self, program: Program) -> dict[str, bytes]:
        """The controller's files, name -> content. Raises InputError for what the controller would
        reject.
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
            The flange's load as X Y Z RX RY RZ, mm and rad; None if not known yet.

        Raises
        ------
        InputError
            With the reason.
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
        The names that fit.
    """
    names = []
    for name in posts:
        with contextlib.suppress(InputError):
            load(name).refuse_setup(motion, setup)
            names.append(name)
    return tuple(names)


def motion_written(post: str, setup: str) -> str:
    """The default motion of a program: joint if the post supports it in the set-up, or supports
    neither, else cartesian. Raises InputError UNKNOWN_POST.
    """
    load(post)
    return next((motion for motion in _MOTIONS if fitting((post,), motion, setup)), _MOTIONS[0])


def main_file(files: Iterable[str]) -> str:
    """The main file of a program by the names of its files: the start of a VAL 3 application, else
    the shortest name, which has no part number.
    """
    return min(files, key=lambda name: (not name.endswith("/start.pgx"), len(name), name))


_NUMBER = re.compile(r"\d+")
_LOOP = re.compile(rb"for \w+=(\d+) to (\d+)")  # of VAL 3, about a single move


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of n moves, in the order of execution. files: names; file: (n,) index into them;
    line: (n,) from 0.
    """

    files: tuple[str, ...]
    file: Integers
    line: Integers

    def __len__(self) -> int:
        return len(self.line)

    def of(self, row: int) -> tuple[str, int]:
        """Return where a move is in the files.

        Parameters
        ----------
        row : int
            Number of the move.

        Returns
        -------
        file : str
            Name of the file.
        line : int
            Number of the line, from 0.
        """
        return self.files[self.file[row]], int(self.line[row])

    def move_at(self, name: str, line: int) -> int | None:
        """The move in a line of a file: the first one of a loop, the next one between two moves,
        the last one after all moves. None for a file without moves.
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
    """Return the lines of the moves of one of our programs. The parts of a program run in the order
    of their numbers.
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
    """The line of each move of a file, repeated as often as it runs."""
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
