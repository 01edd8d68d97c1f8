# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of solids."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...core.parameters.filled import GEODESIC
from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal, solid_arguments


class SolidWindow(FeatureWindow):
    """Solid…: solids in layers of any kind."""

    rank = 3
    job_rank = 3
    page = "solid"

    def tools(self) -> dict[str, Tool]:
        return {
            "Solid": Tool(
                "solid",
                marked("Solid…"),
                marked("Deposits the selected solids in planar layers"),
                self.open_panel,
                whats_this.part,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.solid import SolidPanel

        return SolidPanel

    def view(self) -> type[Any]:
        from ..views.hub import SolidView

        return SolidView

    def entries(self) -> dict[str, str]:
        return {"solid": tr("Solids in plane layers"), GEODESIC: tr("Solids without support")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        parts = tuple(Pick(pick.obj) for pick in picks)
        return JobProposal("solid", reason, parts, layers=layers)

    def arguments(self, job: JobProposal) -> dict[str, str]:
        return solid_arguments(job)
