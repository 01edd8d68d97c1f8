# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a wall on an existing part; it previews the first layer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.issues import Issue
from ...objects.checks import deposit
from ...objects.fields.preferences import in_user_units
from ...objects.shapes.bodies import snapshot_of
from ...objects.stage_parts import Outcome
from ...objects.surface_feature import SurfaceFeature
from .. import picking
from ..in_language import marked, sentence, tr, translated
from ..nodes.wall import WallNodes, face_mesh, first_curves
from ..views.preview import Draft
from ..widgets.pick_field import PickField
from .preview import PickPanel

_NAMES = {"Source": marked("Wall")}
_ELEMENTS = {"Source": picking.FACE, "StartEdges": picking.EDGE}


class WallPanel(PickPanel):
    """Panel that creates a wall on a part from the selection, or changes one."""

    note = ""  # note about the selection when the panel opened
    stage, icon, function, draft = SurfaceFeature, "wall_on_part", "make_surface_feature", "Wall"

    def __init__(self, obj: Any = None) -> None:
        picks = [
            PickField(
                link,
                _label(link),
                None if obj is None else getattr(obj, link.name),
                self._arm,
                _ELEMENTS.get(link.name, ""),
                meshes=link.name == "Source",
            )
            for link in SurfaceFeature.links
        ]
        super().__init__(
            tr("Wall on part") if obj is None else obj.Label, picks, obj, WallNodes(pickable=False)
        )
        self.show_note(self._field("Source").label, self.note, wrong=False)

    def _propose(self, picks: list[picking.Pick]) -> str:
        wall, substrate, unclear = picking.proposal(picks)
        whole_part = None if wall is None else picking.expand_pick(wall)
        if wall is not None and whole_part is not None and wall.names and not whole_part.names:
            self.note = tr(
                "The whole of {} is used; Pick selects single faces, click by click."
            ).format(wall.obj.Label)
            wall = whole_part
        for name, pick in (("Source", wall), ("Substrate", substrate)):
            if pick is not None:
                self._field(name).take(pick)
        edges = [pick for pick in picks if wall is not None and pick.obj == wall.obj]
        for field in self.picks:
            if field.element == picking.EDGE and edges:
                field.take(edges[0])
        return unclear

    def _lacking(self) -> PickField | None:
        """Return the first missing input.

        A wall that starts at its own edges, or may start on the platform, needs no substrate.
        """
        if not self._field("Source").picks:
            return self._field("Source")
        edges = any(field.picks for field in self.picks if field.element == picking.EDGE)
        if (
            edges
            or self._field("Substrate").picks
            or picking.stands(self._field("Source").picks[0])
        ):
            return None
        return self._field("Substrate")

    def _following(self, field: PickField) -> PickField | None:
        """Return the substrate while a click on another object than the wall's can only select it."""
        substrate = self._field("Substrate")
        return (
            substrate
            if field.link.name == "Source" and field.picks and not substrate.picks
            else None
        )

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        if field.element == picking.EDGE:
            return tr("Click edges of one object.")
        text = tr(
            "{} is another object, but the wall faces must belong to one object; clear the field "
            "to start again."
        )
        return text.format(pick.obj.Label)

    def _links(self) -> dict[str, Any]:
        return {field.link.name: field.value() for field in self.picks}

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Any]]:
        work, snapshot = draft.prepare(), snapshot_of(draft.obj.Source[0])

        def compute() -> tuple[Outcome, Any]:
            outcome = work()
            return outcome, face_mesh(snapshot, outcome.value.faces)

        return compute

    def _draw(self, outcome: Outcome, drawing: Any) -> str:
        curves = first_curves(outcome.value)
        self.nodes.set_first(curves)
        self.nodes.faces.show(True)
        self.nodes.faces.set(*drawing)
        return _summary(curves, (*deposit.expected(outcome.value, self.obj), *outcome.issues))

    def _draw_without(self) -> None:
        wall = self._field("Source").picks
        self.nodes.set_first([])
        self.nodes.faces.show(bool(wall))
        if wall:
            self.nodes.set_faces(wall[0].obj, wall[0].names)


def _label(link: Any) -> str:
    return tr(_NAMES[link.name]) if link.name in _NAMES else translated(link.label)


def _summary(curves: list[Any], issues: tuple[Issue, ...]) -> str:
    lengths = [float(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()) for curve in curves]
    curve_texts = [
        (
            tr("closed, {:.1f} mm")
            if np.allclose(curve[0], curve[-1], atol=1e-9)
            else tr("open, {:.1f} mm")
        ).format(length)
        for curve, length in zip(curves, lengths, strict=True)
    ]
    findings = (sentence(issue.message) for issue in issues)
    return "\n".join(
        [tr("First layer: {}").format(in_user_units("; ".join(curve_texts))), *findings]
    )
