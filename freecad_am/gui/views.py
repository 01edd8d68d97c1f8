# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gives objects of ours their view providers; named to `objects.hooks` by InitGui."""

from __future__ import annotations

from typing import Any

from .view_base import MODE, StageView
from .view_cell import CellView
from .view_feature import FeatureView
from .view_joint_path import JointPathView
from .view_program import ProgramView
from .view_toolpath import ToolpathView

VIEWS: dict[str, type[StageView]] = {
    "cell": CellView, "feature": FeatureView, "toolpath": ToolpathView, "joint path": JointPathView,
    "program": ProgramView,
}


def attach(obj: Any) -> None:
    """Show an object: with a new view provider when it has none (new, or made without a window), else redrawn."""
    vobj = obj.ViewObject
    if not getattr(vobj, "Proxy", None):
        VIEWS[obj.Proxy.kind](vobj)
        vobj.DisplayMode = MODE
        vobj.Visibility = True
    else:
        vobj.Proxy.complete(vobj)
    vobj.Proxy.refresh()
