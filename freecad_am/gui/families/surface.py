# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of walls on a part."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...objects.shapes.bodies import Taken
from .. import picking
from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal, ground_missing

if TYPE_CHECKING:
    from ...core.process.deposit.balance import Balance


class SurfaceWindow(FeatureWindow):
    """Wall on Part…: faces on another object."""

    rank = 2
    job_rank = 2
    page = "wall-on-part"

    def tools(self) -> dict[str, Tool]:
        return {
            "WallOnPart": Tool(
                "wall_on_part",
                marked("Wall on Part…"),
                marked("Deposits the selected faces as a wall on the other selected object"),
                self.open_panel,
                whats_this.faces,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.wall import WallPanel

        return WallPanel

    def entries(self) -> dict[str, str]:
        return {"surface": tr("Wall on a part")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        wall, ground, unclear = picking.proposal(picks)
        if wall is None:
            missing = unclear or tr("Also Ctrl+click the faces to deposit on {}.").format(
                picks[0].obj.Label
            )
            return JobProposal("surface", reason, (), ground, missing)
        wall = picking.expand_pick(wall)
        missing = "" if picking.stands(wall) else ground_missing(wall, ground)
        return JobProposal("surface", reason, (wall,), ground, unclear or missing)

    def balance(
        self, job: JobProposal, snapshots: Sequence[Taken], under: Taken | None, width: float
    ) -> Balance | None:
        from ...brep.shapes.part_depths import face_depths
        from ...brep.walls.wall_on import named_faces
        from ...core.process.deposit.balance import wall_balance

        snapshot = snapshots[0]
        if snapshot.shape is None:
            return None
        shape = snapshot.shape.copy(False)
        faces = named_faces(shape, job.parts[0].names, snapshot.label)
        depths = face_depths(
            shape,
            tuple(name for name, _ in faces),
            snapshot.label,
            None if under is None else under.body(),
        )
        return None if depths is None else wall_balance(depths, width)
