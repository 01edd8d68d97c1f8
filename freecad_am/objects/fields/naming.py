# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of programs from labels."""

from __future__ import annotations

import re
import unicodedata

_NAME_LENGTH = 20


def proposed_name(text: str) -> str:
    """A program name that controllers take, from a label: letters A to Z, digits and underscores.

    `am.proposed_name("Hémisphère n° 1")` is "HEMISPHERE_N_1".
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().upper()
    name = re.sub(r"[^A-Z0-9]+", "_", plain).strip("_")[:_NAME_LENGTH].rstrip("_")
    return name if name[:1].isalpha() else f"P{name}"
