# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the window lives beside long work, in FreeCAD's window under Xvfb: how soon Cancel has ended it, and the longest time
in which nothing else in the window goes on, beside work and beside a panel's preview.

Peer: what is allowed. Jobs are those of the tests (tests/gui/long_jobs.py), which take minutes.
"""

from __future__ import annotations

from pathlib import Path

import in_window
from rows import Row

SCRIPT = Path(__file__).resolve().parent / "long_work_window.py"
LONGEST = 600  # s
ALLOWED = (  # key, what it is, s
    ("cancel", "until Cancel has ended it", 0.5),
    ("pause", "longest pause beside work", 0.5),
    ("preview", "longest pause beside a preview", 0.2),
)


def run() -> list[Row]:
    """A row for each thing that is allowed so long, of every kind of work."""
    return [
        Row(f"{what}, {one['job']}; what is allowed", one[key], most, "s", 1.0)
        for one in in_window.found_by(SCRIPT, LONGEST)
        for key, what, most in ALLOWED
        if key in one
    ]
