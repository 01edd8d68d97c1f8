# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a headless process asks the system for memory.

glibc gives every freed array beyond a few MB back at once, and the next one, which is most often as large, comes back as
pages that the system has to clear again: of a million points that was a fifth of all the time. A process that plans and
ends may keep what it has freed.
"""

from __future__ import annotations

import contextlib
import ctypes
import sys

# numbers of glibc's mallopt (malloc.h), and bytes
_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
LARGEST, LARGEST_BEFORE, KEPT = (
    1 << 30,
    1 << 25,
    1 << 30,
)  # before glibc 2.35 arrays no larger than that


def keep_freed() -> None:
    """From now on arrays up to LARGEST bytes take the place of freed ones, of which KEPT bytes stay at the end; nothing
    where the library is another."""
    if sys.platform.startswith("linux"):
        with contextlib.suppress(OSError, AttributeError):
            mallopt = ctypes.CDLL(None).mallopt
            if not mallopt(_MMAP_THRESHOLD, LARGEST):
                mallopt(_MMAP_THRESHOLD, LARGEST_BEFORE)
            mallopt(_TRIM_THRESHOLD, KEPT)
