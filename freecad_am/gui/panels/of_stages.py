# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of every kind of stage; families have those of their features."""

from __future__ import annotations

from typing import Any

from ...objects.families.registry import stage_family
from ..families.registry import window_of
from ..inspection.panel import InspectionPanel
from .cell import CellPanel
from .joint_path import JointPathPanel
from .program import ProgramPanel
from .stage import show
from .toolpath import ToolpathPanel

PANELS: dict[type, Any] = {
    panel.stage: panel
    for panel in (
        CellPanel,
        ToolpathPanel,
        JointPathPanel,
        ProgramPanel,
        InspectionPanel,
    )
}


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    family = stage_family(obj.Proxy)
    panel = PANELS[type(obj.Proxy)] if family is None else window_of(family).panel()
    show(panel(obj))
