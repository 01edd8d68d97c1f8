# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on a hub."""

from __future__ import annotations

from .filled_planner import FilledPlanner


class DevelopablePlanner(FilledPlanner):
    """Plans solids in equidistant layers around a hub."""

    proxy = ("developable_feature", "DevelopableFeature")
