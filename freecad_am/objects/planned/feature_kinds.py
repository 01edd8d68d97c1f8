# SPDX-License-Identifier: LGPL-2.1-or-later
"""The feature object of each family, imported when one is made."""

from __future__ import annotations

import importlib
from typing import Any

from ...core.families.registry import KINDS
from ...core.issues import InputError, Text
from ..families.registry import planner_of


def proxy_of(kind: str) -> type[Any]:
    """The class of the features of a family. Raises InputError BAD_VALUE for an unknown kind."""
    if kind not in KINDS:
        raise InputError(
            "BAD_VALUE",
            "kind",
            "{!r} is not one of {}; choose one",
            kind,
            Text.joined(", ", KINDS),
        )
    module, name = planner_of(KINDS[kind]).proxy
    proxy_class: type[Any] = getattr(importlib.import_module(f"freecad_am.objects.{module}"), name)
    return proxy_class
