# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window functions of cladding."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...objects.shapes.bodies import global_shape
from .. import picking
from ..in_language import marked, tr
from ..picking import Pick
from ..tools import whats_this
from ..tools.tool import Tool
from .window import FeatureWindow, JobProposal, second_ground


class CladdingWindow(FeatureWindow):
    """Cladding…: layers on faces."""

    rank = 6
    job_rank = 5
    page = "cladding"

    def tools(self) -> dict[str, Tool]:
        return {
            "Cladding": Tool(
                "cladding",
                marked("Cladding…"),
                marked("Covers the selected faces with layers of beads"),
                self.open_panel,
                whats_this.faces,
            )
        }

    def panel(self) -> type[Any]:
        from ..panels.cladding import CladdingPanel

        return CladdingPanel

    def view(self) -> type[Any]:
        from ..views.cladding import CladdingView

        return CladdingView

    def entries(self) -> dict[str, str]:
        return {"cladding": tr("Cladding of faces")}

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        faces = picking.pick_of_faces(picks[0])
        is_solid = not picking.is_mesh(faces.obj) and bool(global_shape(faces.obj).Solids)
        missing = tr("Ctrl+click the faces to cover.") if is_solid and not faces.names else ""
        return JobProposal("cladding", reason, (faces,), second_ground(picks), missing)
