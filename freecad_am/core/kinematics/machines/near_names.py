# SPDX-License-Identifier: LGPL-2.1-or-later
"""The error of a machine whose name is not known, with names to write instead."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

from ...issues import InputError, Text


def unknown(name: str, names: Sequence[str]) -> InputError:
    """UNKNOWN_MACHINE, of the names that there are."""
    return InputError(
        "UNKNOWN_MACHINE", "cell.machine", "unknown name {!r}; {}", name, _near(name, names)
    )


def _near(name: str, names: Sequence[str]) -> str:
    """Return the most similar names; without any, one name of each manufacturer, because all
    would fill a page.
    """
    alike = difflib.get_close_matches(name.lower().replace("_", "-"), names, n=3, cutoff=0.5)
    if alike:
        return Text("did you mean {}?", ", ".join(alike))
    of_makers = {
        name_of_maker.partition("-")[0]: name_of_maker for name_of_maker in reversed(names)
    }
    return Text(
        "none of {} machines has a similar name; use a name that `freecad-am machines` lists, "
        "such as {}, or the path of a machine file or URDF",
        len(names),
        ", ".join(sorted(of_makers.values())),
    )
