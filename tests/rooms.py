# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which functions of the package are called, in the order of their first calls, and what the page of architecture says."""

import re
import sys
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "architecture.md"
_FUNCTION = 1  # flag of code objects that are functions, not modules or class bodies


class Trail:
    """While it is entered: (file below the package, function) of every call of ours, in the order of the first ones."""

    def __init__(self):
        self.calls = {}

    def __enter__(self):
        threading.setprofile(self._called)
        sys.setprofile(self._called)
        return self

    def __exit__(self, *_):
        sys.setprofile(None)
        threading.setprofile(None)

    def _called(self, frame, event, _):
        code = frame.f_code
        if event == "call" and code.co_flags & _FUNCTION and "/freecad_am/" in code.co_filename:
            call = code.co_filename.split("/freecad_am/")[-1], code.co_name
            if call not in self.calls:
                self.calls[call] = None
                self.first(call)

    def first(self, call):
        """Called with every one of them."""


def told(heading):
    """(file, function) of the rows of the table under a heading of the page."""
    text = PAGE.read_text(encoding="utf-8").split(f"\n### {heading}\n")[1].split("\n#")[0]
    return re.findall(r"^\| \d+ \| `([\w/]+\.py)` `(\w+)` \|", text, re.MULTILINE)


def lost(calls, heading):
    """Rows of the page that were not called, or before the row above them; [] where all are in order."""
    order = {call: number for number, call in enumerate(calls)}
    at = [order.get(row, -1) for row in told(heading)]
    return [row for row, here, before in zip(told(heading), at, [-1, *at]) if here <= before]
