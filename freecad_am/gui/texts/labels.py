# SPDX-License-Identifier: LGPL-2.1-or-later
"""Labels of objects as texts of the window."""

from __future__ import annotations


def escape_mnemonic(label: str) -> str:
    """A label for a menu, title, tab or button, where Qt would take an `&` for the mark of a key."""
    return label.replace("&", "&&")
