# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is to be seen below a widget."""

from __future__ import annotations

import contextlib
from typing import Any


def present(parent: Any, kind: Any) -> list[Any]:
    """The widgets of a kind below another, without those that PySide takes for deleted ones: it finds them by their place in
    memory, where others may have been before (docs/versions.md)."""
    widgets = []
    for widget in parent.findChildren(kind):
        with contextlib.suppress(RuntimeError):
            widget.objectName()
            widgets.append(widget)
    return widgets
