# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text that names a URDF as the machine of a cell."""

from __future__ import annotations

import re
from dataclasses import dataclass

_TEXT = re.compile(
    r"(?P<file>.+\.(?:urdf|xacro))(?:\s+base=(?P<base>\S+))?(?:\s+tip=(?P<tip>\S+))?", re.IGNORECASE
)


@dataclass(frozen=True)
class Reference:
    """A chain of a URDF: its file, first link and last link.

    A link is None if the file proposes it. The text is `robot.urdf`, or
    `robot.urdf base=base_link tip=tool0`.
    """

    file: str
    base: str | None = None
    tip: str | None = None

    def __str__(self) -> str:
        words = [
            self.file,
            *(f"{key}={value}" for key, value in (("base", self.base), ("tip", self.tip)) if value),
        ]
        return " ".join(words)


def reference(text: str) -> Reference | None:
    """Return the reference in a text; None if the text does not name a URDF."""
    match = _TEXT.fullmatch(text.strip())
    return None if match is None else Reference(match["file"], match["base"], match["tip"])
