# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of every kind of stage."""

from __future__ import annotations

from typing import Any

from ..inspection.panel import InspectionPanel
from .cell import CellPanel
from .features.cladding import CladdingPanel
from .features.curves import CurvesPanel
from .features.hub import HubPanel
from .features.revolution import FeaturePanel
from .features.solid import SolidPanel
from .features.wall import WallPanel
from .joint_path import JointPathPanel
from .program import ProgramPanel
from .stage import show
from .toolpath import ToolpathPanel

PANELS: dict[type, Any] = {
    panel.stage: panel
    for panel in (
        CellPanel,
        FeaturePanel,
        WallPanel,
        HubPanel,
        SolidPanel,
        CladdingPanel,
        CurvesPanel,
        ToolpathPanel,
        JointPathPanel,
        ProgramPanel,
        InspectionPanel,
    )
}


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    show(PANELS[type(obj.Proxy)](obj))
