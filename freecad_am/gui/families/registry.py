# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window classes of all families, imported on first use.

`core.families.registry` lists the families; each module here is named after the family's kind.
"""

from __future__ import annotations

import functools
import importlib

from ...core.families.family import Family
from ...core.families.registry import FAMILIES
from .window import FeatureWindow


@functools.cache
def window_of(family: Family) -> FeatureWindow:
    """Return the `FeatureWindow` of a family."""
    module = importlib.import_module(f"{__package__}.{family.kind}")
    window: FeatureWindow = getattr(module, f"{type(family).__name__}Window")()
    return window


def feature_windows() -> list[FeatureWindow]:
    """Return the windows of all families in the order of their tools."""
    return sorted(map(window_of, FAMILIES), key=lambda window: window.rank)
