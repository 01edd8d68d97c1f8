# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of curves printed as beads; it previews the points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...objects.curves_feature import CurvesFeature
from ...objects.fields.preferences import in_user_units
from ...objects.shapes.bodies import FIXTURES
from ...objects.stage_parts import Link, Outcome
from .. import picking, recorded
from ..in_language import marked, sentence, tr
from ..nodes.wall import WallNodes
from ..views.preview import Draft
from ..widgets.pick_field import PickField
from .preview import PickPanel

CURVES = Link(
    "Source",
    "",
    marked("Edges, wire, sketch or table of points to deposit as beads."),
    type_name="App::PropertyLinkSub",
)
NORMALS = Link(
    "Normals",
    "",
    marked(
        "Faces of the same object under the curves, whose normals set the tool directions; none: "
        "the directions in the table, or the direction below."
    ),
    required=False,
    type_name="App::PropertyLinkSub",
)
SUBSTRATE = Link(
    "Substrate",
    "",
    marked("Part below the curves; not needed on a platform."),
    required=False,
)


class CurvesPanel(PickPanel):
    """Panel that creates a curves feature from the selection, or changes one."""

    stage, icon, function, draft = CurvesFeature, "curves", "make_curves_feature", "Curves"

    def __init__(self, obj: Any = None) -> None:
        curves, faces, substrate, fixtures = (
            (None, None, None, ()) if obj is None else _present(obj)
        )
        self.curves = PickField(
            CURVES, tr("Curves"), curves, self._arm, picking.EDGE, allow_whole=True
        )
        self.normals = PickField(NORMALS, tr("Faces"), faces, self._arm, picking.FACE)
        self.substrate = PickField(SUBSTRATE, tr("Substrate"), substrate, self._arm)
        self.fixtures = PickField(FIXTURES, tr("Fixtures"), fixtures, self._arm)
        picks = [self.curves, self.normals, self.substrate, self.fixtures]
        super().__init__(
            tr("Curves as beads") if obj is None else obj.Label,
            picks,
            obj,
            WallNodes(pickable=False),
        )

    def _stored(self) -> dict[str, Any]:
        return {
            pick.label: stored for pick, stored in zip(self.picks, _present(self.obj), strict=True)
        }

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Take the first selected object with its edges."""
        if picks:
            self.curves.take(picks[0])
        return ""

    def _lacking(self) -> PickField | None:
        return None if self.curves.picks else self.curves

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        return tr("{} cannot be used here.").format(pick.obj.Label)

    def _elements(self) -> list[str]:
        """Return the names of edges and faces of the source."""
        source_pick = self.curves.picks[0] if self.curves.picks else picking.Pick(None)
        faces = [
            name
            for pick in self.normals.picks
            if pick.obj == source_pick.obj
            for name in pick.names
        ]
        return [*source_pick.names, *faces]

    def _links(self) -> dict[str, Any]:
        return {
            "Source": (self.curves.picks[0].obj, self._elements()),
            "Substrate": self.substrate.value(),
            "Fixtures": self.fixtures.value(),
        }

    def _inputs(self) -> dict[str, str]:
        arguments = {
            "source": recorded.reference(self.curves.picks[0].obj) if self.curves.picks else "None",
            "faces": repr(self._elements()),
            **self.substrate.arguments(),
            **self.fixtures.arguments(),
        }
        return self._worth_telling(arguments)

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Any]]:
        draft.check()
        work = draft.prepare()

        def both() -> tuple[Outcome, Any]:
            return work(), None

        return both

    def _link_places(self) -> dict[str, str]:
        return {
            "Source": self.curves.label,
            "Substrate": self.substrate.label,
            "Fixtures": self.fixtures.label,
        }

    def _draw(self, outcome: Outcome, drawing: Any) -> str:
        curves = [curve.points for curve in outcome.value.curves]
        self.nodes.set_first(curves)
        length = sum(
            float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) for points in curves
        )
        text = tr("{} curves, {:.4g} mm in all").format(len(curves), length)
        return "\n".join(
            [in_user_units(text), *(sentence(issue.message) for issue in outcome.issues)]
        )

    def _draw_without(self) -> None:
        self.nodes.set_first([])


def _present(obj: Any) -> tuple[Any, ...]:
    """Return an object's curves, faces for their normals, substrate and fixtures."""
    source, names = obj.Source or (None, [])
    edges, faces = (
        [name for name in names if name.rsplit(".", maxsplit=1)[-1].startswith(kind)]
        for kind in (picking.EDGE, picking.FACE)
    )
    return (
        None if source is None else (source, edges),
        (source, faces) if faces else None,
        obj.Substrate,
        obj.Fixtures,
    )
