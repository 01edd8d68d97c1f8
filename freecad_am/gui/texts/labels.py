# SPDX-License-Identifier: LGPL-2.1-or-later
"""Labels of objects as texts of the window."""

from __future__ import annotations


def escape_mnemonic(label: str) -> str:
    """Escape `&` in a label for a menu, title, tab or button, where Qt marks a key with it."""
    return label.replace("&", "&&")
