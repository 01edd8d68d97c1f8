# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of solids on a hub; it previews base and first layer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...core.issues import AmError, Issue
from ...core.parameters.filled import DevelopableParameters
from ...core.strategies import estimated_size
from ...core.types import Array
from ...objects.checks import deposit
from ...objects.developable_feature import DevelopableFeature
from ...objects.fields.preferences import in_user_units
from ...objects.shapes.bodies import FIXTURES
from ...objects.stage_parts import Link, Outcome
from .. import picking, recorded
from ..in_language import marked, sentence, tr
from ..nodes.hub import NOTHING, Drawing, HubNodes, drawing
from ..views.preview import Draft
from ..widgets.pick_field import PickField
from .preview import PickPanel, coarsened

SOLIDS = Link(
    "Solids",
    "",
    marked(
        "Solids or closed meshes to deposit, one after the other; click an object again to "
        "remove it."
    ),
    type_name="App::PropertyLinkList",
)
HUB = Link(
    "Hub",
    "",
    marked(
        "The cylinder or cone of the hub, or the whole hub: then the surface under each solid is "
        "detected."
    ),
    required=False,
    type_name="App::PropertyLinkSub",
)
# properties that determine base and solids
_SHAPING = ("ChordError", "BaseRadius", "BaseHeight", "BaseAxis")
_OF_WALLS = ("build_direction_mode", "build_direction_max_tilt", "build_direction_plane")
_NO_BASE = ("NO_HUB", "NO_BASE")


class HubPanel(PickPanel):
    """Panel that creates a feature of solids on a hub from the selection, or changes one.

    If a face of the only solid is picked as hub, solid and hub are the same object.
    """

    stage, icon, function, draft = (
        DevelopableFeature,
        "solids_on_hub",
        "make_developable_feature",
        "Solids",
    )
    nodes: HubNodes
    cached: tuple[Any, Outcome, Drawing] | None = (
        None  # last result: its inputs, outcome and drawing
    )

    def __init__(self, obj: Any = None) -> None:
        solids, hub, fixtures = ((), None, ()) if obj is None else _present(obj)
        self.solids = PickField(SOLIDS, tr("Solids"), solids, self._arm)
        self.hub = PickField(HUB, tr("Hub"), hub, self._arm, picking.FACE, meshes=True)
        self.fixtures = PickField(FIXTURES, tr("Fixtures"), fixtures, self._arm)
        picks = [self.solids, self.hub, self.fixtures]
        title = tr("Solids on hub") if obj is None else obj.Label
        super().__init__(title, picks, obj, HubNodes(pickable=False))
        for key in _OF_WALLS:
            field, _, fold = self.places[key]
            if field.value == field.row.outer(
                field.row.default
            ):  # a rejected value must stay editable
                fold.enable(field.widget, False)
                field.widget.setToolTip(
                    tr("For walls only: solids on a hub grow along the normals of its surface")
                )

    def _stored(self) -> dict[str, Any]:
        return {
            pick.label: stored for pick, stored in zip(self.picks, _present(self.obj), strict=True)
        }

    # ---- picks

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Assign the picks: the hub is the only pick with faces, or else the last; a single pick is
        deposited.
        """
        faced = [
            pick for pick in picks if any(name.startswith(picking.FACE) for name in pick.names)
        ]
        hub = None if len(picks) < 2 else faced[0] if len(faced) == 1 else picks[-1]
        for pick in picks:
            (self.hub if pick is hub else self.solids).take(pick)
        return ""

    def _lacking(self) -> PickField | None:
        return None if self.solids.picks else self.solids

    def _handle_pick(self, field: PickField) -> None:
        """Remove the hub from the solids if there are other solids."""
        hub = self.hub.picks[0].obj if self.hub.picks else None
        solid_picks = [pick for pick in self.solids.picks if pick.obj != hub]
        if solid_picks and len(solid_picks) < len(self.solids.picks):
            self.solids.picks = solid_picks
            self.solids.show()

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        text = tr(
            "{} is another object, but the hub faces must belong to one object; clear the field "
            "to start again."
        )
        return text.format(pick.obj.Label)

    def _roles(self) -> tuple[list[Any], tuple[str, ...], Any, tuple[str, ...]]:
        """Return the objects to deposit, base faces of the first object, the hub and its faces."""
        solids = [pick.obj for pick in self.solids.picks]
        hub = self.hub.picks[0] if self.hub.picks else picking.Pick(None)
        if solids == [hub.obj]:
            return solids, hub.names, None, ()
        return solids, (), hub.obj, hub.names

    def _links(self) -> dict[str, Any]:
        solids, faces, hub, base_faces = self._roles()
        return {
            "Source": (solids[0], list(faces)),
            "Further": solids[1:],
            "Substrate": hub,
            "BaseFaces": (hub, list(base_faces)) if base_faces else None,
            "Fixtures": self.fixtures.value(),
        }

    def _inputs(self) -> dict[str, str]:
        solids, faces, hub, base_faces = self._roles()
        further = ", ".join(recorded.reference(obj) for obj in solids[1:])
        arguments = {
            "source": recorded.reference(solids[0]) if solids else "None",
            "faces": repr(list(faces)),
            "further": f"[{further}]",
            "substrate": "None" if hub is None else recorded.reference(hub),
            "base_faces": repr(list(base_faces)),
            **self.fixtures.arguments(),
        }
        return self._worth_telling(arguments)

    # ---- preview

    def _values(self) -> dict[str, Any]:
        """Return the entries, with a valid fine chord error replaced by the preview's coarse chord
        error.
        """
        return coarsened(super()._values())

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Drawing]]:
        """Return work that recomputes the solids only if the solids or the hub changed."""
        draft.check()
        key = (self._inputs(), [str(getattr(draft.obj, name)) for name in _SHAPING])
        cached, work, strategy = self.cached, draft.prepare(), self._strategy()

        def compute() -> tuple[Outcome, Drawing]:
            _, outcome, drawn = (
                cached if cached is not None and cached[0] == key else (key, work(), None)
            )
            estimated_size.refuse_absurd(
                estimated_size.solids_size(outcome.value, strategy), strategy
            )
            self.cached = (key, outcome, drawing(outcome.value) if drawn is None else drawn)
            return self.cached[1:]

        return compute

    def _strategy(self) -> DevelopableParameters:
        """Return the entered parameters, with the chord error of the deposit."""
        entered = Draft(self.proxy, self.document, self.draft, self._links(), super()._values())
        strategy: DevelopableParameters = entered.stage.parameters(
            entered.obj, DevelopableParameters
        )
        return strategy

    def _link_places(self) -> dict[str, str]:
        return {
            "Source": self.solids.label,
            "Further": self.solids.label,
            "Substrate": self.hub.label,
            "BaseFaces": self.hub.label,
            "Fixtures": self.fixtures.label,
        }

    def _locate(self, error: AmError) -> tuple[str, str]:
        if error.code in _NO_BASE:
            return self.hub.label, sentence(error.message)
        return super()._locate(error)

    def _draw(self, outcome: Outcome, drawing: Drawing) -> str:
        self.nodes.set(drawing)
        return _summary(
            outcome, drawing.contours, (*deposit.expected(outcome.value, self.obj), *outcome.issues)
        )

    def _draw_without(self) -> None:
        self.nodes.set(NOTHING)


def _present(obj: Any) -> tuple[list[Any], Any, list[Any]]:
    """Return solids, hub and fixtures of a feature."""
    source, faces = obj.Source or (None, [])
    faces = [name for name in faces if name]
    hub = (
        (source, faces)
        if faces
        else obj.BaseFaces or (None if obj.Substrate is None else (obj.Substrate, []))
    )
    return [*([] if source is None else [source]), *obj.Further], hub, obj.Fixtures


def _summary(
    outcome: Outcome, contours: Sequence[Sequence[Sequence[Array]]], findings: Sequence[Issue]
) -> str:
    lines = []
    for group, solids in zip(outcome.value.groups, contours, strict=True):
        surface, count = group.base.surface, len(group.bodies)
        if surface.is_cylinder:
            shape = tr("cylinder, R {:.4g} mm").format(surface.radius)
        else:
            shape = tr("cone, R {:.4g} mm, half angle {:.4g}°").format(
                surface.radius, np.degrees(surface.taper)
            )
        length = sum(
            float(np.linalg.norm(np.diff(contour, axis=0), axis=1).sum())
            for solid in solids
            for contour in solid
        )
        stands = tr("1 solid on {1} ({2})") if count == 1 else tr("{0} solids on {1} ({2})")
        first_layer = tr("first layer: {} contours, {:.1f} mm").format(
            sum(map(len, solids)), length
        )
        stands = stands.format(count, group.base.name, in_user_units(shape))
        lines.append(f"{stands}; {in_user_units(first_layer)}")
    return "\n".join([*lines, *(sentence(issue.message) for issue in findings)])
