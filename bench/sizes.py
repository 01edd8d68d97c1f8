# SPDX-License-Identifier: LGPL-2.1-or-later
"""The size of a benchmark: full, or the smallest that still runs all of its code (`bench --smallest`, as CI does)."""

from __future__ import annotations

import os
from typing import TypeVar

Value = TypeVar("Value")


def is_smallest() -> bool:
    """Return True when only the code is exercised and no figure is judged."""
    return os.environ.get("BENCH_SMALLEST") == "1"


def choose(full: Value, smallest: Value) -> Value:
    """Return the value for the size in use."""
    return smallest if is_smallest() else full
