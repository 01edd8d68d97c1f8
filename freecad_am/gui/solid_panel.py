# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of solids in plane layers: solids are picked, and the plane they stand on is seen while it is open."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..core.layers.stacking import stacked
from ..core.parameters.strategy import SolidParameters
from ..core.strategies import size
from ..objects.shapes import FIXTURES
from ..objects.solid_feature import SolidFeature
from ..objects.stage import Link, Outcome
from . import picking, recorded
from .guess import COARSE
from .hub_nodes import NOTHING, Drawing, HubNodes, drawing
from .pick_field import PickField
from .pick_panel import PickPanel
from .preview import Draft
from .texts import marked, sentence, tr

SOLIDS = Link(
    "Solids", "", marked("The solids or closed meshes to deposit, one after the other; a click on one again leaves it out."),
    type_name="App::PropertyLinkList",
)
SUBSTRATE = Link("Substrate", "", marked("The part that they stand on; none is needed on a platform."), required=False)


class SolidPanel(PickPanel):
    """Makes a feature of solids in plane layers of what is selected, or changes one."""

    stage, icon, function, draft = SolidFeature, "solid", "make_solid_feature", "Solids"
    nodes: HubNodes
    kept: tuple[Any, Outcome] | None = None  # the solids read last: what of, and what

    def __init__(self, obj: Any = None) -> None:
        solids = [] if obj is None or not obj.Source else [obj.Source[0], *obj.Further]
        self.solids = PickField(SOLIDS, tr("Solids"), solids, self._arm)
        self.substrate = PickField(SUBSTRATE, tr("Stands on"), None if obj is None else obj.Substrate, self._arm)
        self.fixtures = PickField(FIXTURES, tr("Fixtures"), () if obj is None else obj.Fixtures, self._arm)
        picks = [self.solids, self.substrate, self.fixtures]
        super().__init__(tr("Solids in plane layers") if obj is None else obj.Label, picks, obj, HubNodes(pickable=False))

    def _propose(self, picks: list[picking.Pick]) -> str:
        """All that is selected is to be deposited."""
        for pick in picks:
            self.solids.take(pick)
        return ""

    def _lacking(self) -> PickField | None:
        return None if self.solids.picks else self.solids

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        return tr("{} cannot be taken for this.").format(pick.obj.Label)

    def _links(self) -> dict[str, Any]:
        solids = [pick.obj for pick in self.solids.picks]
        return {
            "Source": (solids[0], []), "Further": solids[1:], "Substrate": self.substrate.value(),
            "Fixtures": self.fixtures.value(),
        }

    def _inputs(self) -> dict[str, str]:
        solids = [recorded.reference(pick.obj) for pick in self.solids.picks]
        found = {
            "source": solids[0] if solids else "None", "further": f"[{', '.join(solids[1:])}]",
            **self.substrate.arguments(), **self.fixtures.arguments(),
        }
        return found if self.obj is not None else {
            key: text for key, text in found.items() if key == "source" or text not in ("None", "[]")
        }

    def _values(self) -> dict[str, Any]:
        """Entries, but for the chord error, which a picture need not keep; a wrong one stays wrong."""
        found = super()._values()
        if 0.0 < getattr(found["ChordError"], "Value", found["ChordError"]) < COARSE:
            found["ChordError"] = COARSE
        return found

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Drawing]]:
        """Solids are read anew only where they are others."""
        draft.check()
        key, kept, work = self._inputs(), self.kept, draft.prepare()
        strategy: SolidParameters = draft.stage.parameters(draft.obj, SolidParameters)

        def both() -> tuple[Outcome, Drawing]:
            made = kept[1] if kept is not None and kept[0] == key else work()
            self.kept = (key, made)
            bodies = made.value.groups[0].bodies
            solids = stacked(bodies, strategy, made.value.label)
            size.refuse_absurd(size.of_solids(solids, strategy), strategy)
            return Outcome(solids, solids.issues), drawing(solids)

        return both

    def _link_places(self) -> dict[str, str]:
        return {
            "Source": self.solids.label, "Further": self.solids.label, "Substrate": self.substrate.label,
            "Fixtures": self.fixtures.label,
        }

    def _draw(self, made: Outcome, drawing: Drawing) -> str:
        self.nodes.set(drawing)
        group = made.value.groups[0]
        height = max(float(group.base.surface.distance(group.base.inside(body.vertices)).max()) for body in group.bodies)
        contours = sum(len(some) for solids in drawing.contours for some in solids)
        told = tr("{} solids, {:.4g} mm high; first layer: {} contours").format(len(group.bodies), height, contours)
        return "\n".join([told, *(sentence(issue.message) for issue in made.issues)])

    def _draw_without(self) -> None:
        self.nodes.set(NOTHING)
