# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of every kind of stage."""

from __future__ import annotations

from typing import Any

from ..inspection.panel import InspectionPanel
from .cell import CellPanel
from .cladding import CladdingPanel
from .curves import CurvesPanel
from .feature import FeaturePanel
from .hub import HubPanel
from .joint_path import JointPathPanel
from .program import ProgramPanel
from .solid import SolidPanel
from .stage import show
from .toolpath import ToolpathPanel
from .wall import WallPanel

PANELS: dict[type, Any] = {panel.stage: panel for panel in (
    CellPanel, FeaturePanel, WallPanel, HubPanel, SolidPanel, CladdingPanel, CurvesPanel, ToolpathPanel, JointPathPanel,
    ProgramPanel, InspectionPanel,
)}


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    show(PANELS[type(obj.Proxy)](obj))
