# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal, second_ground, several_elements


class CurvesWindow(FeatureWindow):
    """Curves…: edges, wires, sketches or tables."""

    rank = 5
    job_rank = 6
    page = "curves"

    def tools(self) -> dict[str, Tool]:
        return {
            "Curves": Tool(
                "curves",
                marked("Curves…"),
                marked("Deposits the selected edges, wires, sketches or tables as beads"),
                self.open_panel,
                whats_this.document,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.curves import CurvesPanel

        return CurvesPanel

    def view(self) -> type[Any]:
        from ..views.curves import CurvesView

        return CurvesView

    def entries(self) -> dict[str, str]:
        return {"curves": tr("Curves as beads")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        return JobProposal("curves", reason, (several_elements(picks[0]),), second_ground(picks))
