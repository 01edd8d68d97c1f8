# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of faces that are covered with layers of beads; it previews the borders of the picked
faces.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...core.parameters.filled import CladdingParameters
from ...objects.cladding_feature import CladdingFeature
from ...objects.fields.preferences import in_user_units
from ...objects.shapes.bodies import FIXTURES
from ...objects.stage_parts import Link, Outcome
from .. import picking, recorded
from ..in_language import marked, sentence, tr
from ..nodes.wall import WallNodes
from ..views.cladding import borders_of
from ..views.preview import Draft
from ..widgets.pick_field import PickField
from .preview import PickPanel

FACES = Link(
    "Source",
    "",
    marked("Faces to cover; if no face is selected, all faces of an object that is not a solid."),
    type_name="App::PropertyLinkSub",
)
SUBSTRATE = Link(
    "Substrate", "", marked("Another part that the nozzle must clear."), required=False
)
CM2 = 100.0  # mm2


class CladdingPanel(PickPanel):
    """Panel that creates a cladding feature from the selection, or changes one."""

    stage, icon, function, draft = CladdingFeature, "cladding", "make_cladding_feature", "Cladding"

    def __init__(self, obj: Any = None) -> None:
        self.faces = PickField(
            FACES,
            tr("Faces"),
            None if obj is None else obj.Source,
            self._arm,
            picking.FACE,
            meshes=True,
        )
        self.substrate = PickField(
            SUBSTRATE, tr("Further part"), None if obj is None else obj.Substrate, self._arm
        )
        self.fixtures = PickField(
            FIXTURES, tr("Fixtures"), () if obj is None else obj.Fixtures, self._arm
        )
        picks = [self.faces, self.substrate, self.fixtures]
        super().__init__(
            tr("Cladding") if obj is None else obj.Label, picks, obj, WallNodes(pickable=False)
        )

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Take the first selected object with its faces."""
        if picks:
            self.faces.take(picks[0])
        return ""

    def _lacking(self) -> PickField | None:
        return None if self.faces.picks else self.faces

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        return tr("{} cannot be used here.").format(pick.obj.Label)

    def _elements(self) -> list[str]:
        """Return the names of the picked faces."""
        return list(self.faces.picks[0].names) if self.faces.picks else []

    def _links(self) -> dict[str, Any]:
        return {
            "Source": (self.faces.picks[0].obj, self._elements()),
            "Substrate": self.substrate.value(),
            "Fixtures": self.fixtures.value(),
        }

    def _inputs(self) -> dict[str, str]:
        arguments = {
            "source": recorded.reference(self.faces.picks[0].obj) if self.faces.picks else "None",
            "faces": repr(self._elements()),
            **self.substrate.arguments(),
            **self.fixtures.arguments(),
        }
        return self._worth_telling(arguments)

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, str]]:
        draft.check()
        work = draft.prepare()
        strategy: CladdingParameters = draft.stage.parameters(draft.obj, CladdingParameters)

        def compute() -> tuple[Outcome, str]:
            outcome = work()
            sheets = len(outcome.value.sheets)
            faces = len(outcome.value.faces) or sheets
            texts = [
                tr("1 face")
                if faces == 1
                else tr("{} faces in 1 sheet").format(faces)
                if sheets == 1
                else tr("{} faces in {} sheets").format(faces, sheets),
                tr("{:.4g} cm² in 1 layer").format(outcome.value.area / CM2)
                if strategy.layers == 1
                else tr("{:.4g} cm² in each of {} layers").format(
                    outcome.value.area / CM2, strategy.layers
                ),
            ]
            return outcome, in_user_units(", ".join(texts))

        return compute

    def _draw(self, outcome: Outcome, drawing: str) -> str:
        self.nodes.set_first(borders_of(outcome.value))
        self.nodes.set_faces(self.faces.picks[0].obj, outcome.value.faces)
        return "\n".join([drawing, *(sentence(issue.message) for issue in outcome.issues)])

    def _draw_without(self) -> None:
        self.nodes.set_first([])
