# SPDX-License-Identifier: LGPL-2.1-or-later
"""Responsiveness of the window during long work, in FreeCAD's window under Xvfb: the delay until
Cancel has ended the work, and the longest pause of the window during work and during a panel's
preview. Peer: the allowed time. The jobs come from the tests (tests/gui/long_jobs.py) and take
minutes."""

from __future__ import annotations

from pathlib import Path

import in_window
from rows import Row

SCRIPT = Path(__file__).resolve().parent / "long_work_window.py"
TIME_LIMIT_S = 600  # s
ALLOWED = (  # key, description, s
    ("cancel", "until Cancel has ended it", 0.5),
    ("pause", "longest pause beside work", 0.5),
    ("preview", "longest pause beside a preview", 0.2),
)


def run() -> list[Row]:
    """Return a row for each limit and each kind of work."""
    return [
        Row(f"{what}, {result['job']}; what is allowed", result[key], limit, "s", 1.0)
        for result in in_window.run_script(SCRIPT, TIME_LIMIT_S)
        for key, what, limit in ALLOWED
        if key in result
    ]
