# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of programs: rules of a controller, proposals for rejected names, and the names of parts."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass, field

from ..core.issues import InputError, Text

# names that files cannot have on the computers programs pass through
DEVICES = frozenset(
    ("CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10)))
)


@dataclass(frozen=True)
class Naming:
    """The rules of a controller.

    written: how it writes a name. start, starts: a pattern of how one begins, and in words.
    longest: characters; spare of them are left free in proposals, for the digits of parts.
    reserved: words, upper case, that are not names; DEVICES never are. prefix: begins proposals if
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
        """The name as the controller has it. Raises InputError PROGRAM_NAME saying why not, and proposing one."""
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
        """Whether the controller takes a name, with the digits of parts behind it."""
        try:
            return len(self.checked(name, "name")) <= self.longest - self.spare
        except InputError:
            return False

    def refused(self, name: str, where: str, why: str) -> InputError:
        """The error for a name that is none, with one that is."""
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
        """One like it that the controller takes, with the digits of parts behind it."""
        proposal = self.written(re.sub(r"[^A-Za-z0-9]+", "_", plain(name)).strip("_"))
        if not re.match(self.start, proposal) or self._is_reserved(proposal):
            proposal = f"{self.prefix}{proposal}".rstrip("_")
        return proposal[: self.longest - self.spare].rstrip("_")

    def parts(self, name: str, count: int) -> list[str]:
        """Names of `count` parts. Raises InputError PROGRAM_NAME without room for their digits."""
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
    """The text in ASCII characters that can be printed."""
    ascii_text = (
        unicodedata.normalize("NFKD", text.replace("ß", "ss"))
        .encode("ascii", "ignore")
        .decode("ascii")
    )
    return re.sub(r"[^ -~]+", " ", ascii_text)
