# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of solids on a hub."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...core.parameters.filled import DevelopableParameters
from ...objects.shapes.bodies import Taken, global_shape
from .. import picking
from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal, solid_arguments

if TYPE_CHECKING:
    from ...core.process.deposit.balance import Balance


class DevelopableWindow(FeatureWindow):
    """Solids on Hub…: solids on the cylinder or cone of a face."""

    rank = 4
    job_rank = 4
    page = "solids-on-hub"
    face_is_base = True

    def tools(self) -> dict[str, Tool]:
        return {
            "SolidsOnHub": Tool(
                "solids_on_hub",
                marked("Solids on Hub…"),
                marked(
                    "Deposits the selected solids on the cylinder or cone that is selected last"
                ),
                self.open_panel,
                whats_this.part,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.hub import HubPanel

        return HubPanel

    def view(self) -> type[Any]:
        from ..views.hub import HubView

        return HubView

    def entries(self) -> dict[str, str]:
        return {"developable": tr("Solids on a hub")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        faced = [pick for pick in picks if picking.pick_of_faces(pick).names]
        if len(picks) == 1:
            mesh = picking.is_mesh(picks[0].obj)
            lonely = mesh or (not faced and len(global_shape(picks[0].obj).Solids) < 2)
            missing = tr("Also Ctrl+click the hub: a cylinder or cone.") if lonely else ""
            ground = picking.pick_of_faces(faced[0]) if faced else None
            return JobProposal("developable", reason, (Pick(picks[0].obj),), ground, missing)
        hub = faced[0] if len(faced) == 1 else picks[-1]
        parts = tuple(Pick(pick.obj) for pick in picks if pick is not hub)
        return JobProposal("developable", reason, parts, picking.pick_of_faces(hub))

    def arguments(self, job: JobProposal) -> dict[str, str]:
        return solid_arguments(job)

    def balance(
        self, job: JobProposal, snapshots: Sequence[Taken], under: Taken | None, width: float
    ) -> Balance | None:
        from ...core.process.deposit.balance import feature_balance
        from ...objects.developable_feature import found_in
        from ...objects.families.developable import COARSE

        face_names = () if job.ground is None else job.ground.names
        base = None if under is None or not face_names else (under, face_names)
        faces = face_names if under is None else ()
        solids = found_in(snapshots, faces, under, base, DevelopableParameters(chord_error=COARSE))
        return feature_balance(solids, width)
