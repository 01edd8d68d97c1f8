# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of parts of revolution."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...objects.shapes.bodies import Taken
from .. import picking
from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal

if TYPE_CHECKING:
    from ...core.process.deposit.balance import Balance


class RevolutionWindow(FeatureWindow):
    """Feature…: a shape of revolution, or some of its faces."""

    rank = 1
    job_rank = 1
    page = "feature"

    def tools(self) -> dict[str, Tool]:
        return {
            "Feature": Tool(
                "feature",
                marked("Feature…"),
                marked("Deposits the selected shape of revolution"),
                self.open_panel,
                whats_this.faces,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.revolution import FeaturePanel

        return FeaturePanel

    def entries(self) -> dict[str, str]:
        return {"revolution": tr("Part of revolution")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        if picking.is_mesh(picks[0].obj):
            missing = tr("A part of revolution needs exact faces; {} is a mesh.").format(
                picks[0].obj.Label
            )
            return JobProposal("revolution", reason, missing=missing)
        return JobProposal("revolution", reason, (picking.expand_pick(picks[0]),))

    def balance(
        self, job: JobProposal, snapshots: Sequence[Taken], under: Taken | None, width: float
    ) -> Balance | None:
        from ...brep.revolution.wall import find_wall
        from ...brep.shapes.part_depths import revolved_depths
        from ...core.process.deposit.balance import wall_balance

        snapshot = snapshots[0]
        if snapshot.shape is None:
            return None
        shape = snapshot.shape.copy(False)
        wall = find_wall(shape, job.parts[0].names, label=snapshot.label)
        depths = revolved_depths(shape, wall, snapshot.label)
        return None if depths is None else wall_balance(depths, width)
