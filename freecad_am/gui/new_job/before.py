# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the last job of a document had."""

from __future__ import annotations

import contextlib
from typing import Any

from ... import api
from ...objects.fields import preferences


def machine(document: Any) -> str:
    """The machine of the last cell of a document, else the one by default."""
    cells = api.stages_of(document, "cell")
    return str(cells[-1].Machine) if cells else preferences.machine()


def setup(document: Any, name: str) -> str:
    """The set-up of the last cell of a document where that has the machine, else ''."""
    with contextlib.suppress(ReferenceError, RuntimeError, NameError):  # the document is closed
        cells = api.stages_of(document, "cell")
        return str(cells[-1].Setup) if cells and cells[-1].Machine == name else ""
    return ""
