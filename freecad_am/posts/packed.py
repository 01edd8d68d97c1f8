# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns of what readers find: packed, for a list of floats takes four times the memory."""

from __future__ import annotations

from array import array


def floats() -> array[float]:
    """An empty column of numbers."""
    return array("d")
