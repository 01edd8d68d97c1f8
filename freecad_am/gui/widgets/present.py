# SPDX-License-Identifier: LGPL-2.1-or-later
"""Children of a widget."""

from __future__ import annotations

import contextlib
from typing import Any


def present(parent: Any, kind: Any) -> list[Any]:
    """Return child widgets of a kind, without those that PySide takes for deleted ones: it finds them by their
    memory address, which an older widget may have had (docs/versions.md)."""
    widgets = []
    for widget in parent.findChildren(kind):
        with contextlib.suppress(RuntimeError):
            widget.objectName()
            widgets.append(widget)
    return widgets
