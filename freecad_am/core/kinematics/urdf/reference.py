# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text by which a cell names a URDF as its machine."""

from __future__ import annotations

import re
from dataclasses import dataclass

_TEXT = re.compile(
    r"(?P<file>.+\.(?:urdf|xacro))(?:\s+base=(?P<base>\S+))?(?:\s+tip=(?P<tip>\S+))?", re.IGNORECASE
)


@dataclass(frozen=True)
class Reference:
    """A chain of a URDF: its file, and its first and last link, None for links that the file
    proposes.

    Its text is `robot.urdf`, or `robot.urdf base=base_link tip=tool0`.
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
    """Return the reference that a text gives, None if it does not name a URDF."""
    match = _TEXT.fullmatch(text.strip())
    return None if match is None else Reference(match["file"], match["base"], match["tip"])
