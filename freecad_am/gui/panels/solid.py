# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of solids; it previews the base plane, and offers a guide for the layers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.issues import AmError
from ...core.layers import centre_line
from ...core.layers import guide_field as along
from ...core.layers.stacking import CONTACT_HEIGHTS, Leaning, find_leaning, prepare_stack
from ...core.parameters.filled import SolidParameters
from ...core.strategies import estimated_size
from ...core.types import Array
from ...objects.fields.preferences import in_user_units
from ...objects.shapes.bodies import FIXTURES
from ...objects.solid_feature import SolidFeature
from ...objects.stage_parts import Link, Outcome
from .. import picking, recorded
from ..in_language import marked, sentence, tr
from ..nodes.hub import NOTHING, Drawing, HubNodes, drawing
from ..nodes.lines import Faces
from ..views.preview import Draft
from ..widgets.pick_field import PickField
from ..widgets.upright import scrolls
from .preview import PickPanel, coarsened

STEEPEST = 89  # deg; maximum of the slider
MM2_PER_CM2 = 100.0
OVERHUNG = (0.86, 0.1, 0.12)

SOLIDS = Link(
    "Solids",
    "",
    marked(
        "Solids or closed meshes to deposit, one after the other; click an object again to "
        "remove it."
    ),
    type_name="App::PropertyLinkList",
)
SUBSTRATE = Link(
    "Substrate",
    "",
    marked("Part below the solids; not needed on a platform."),
    required=False,
)
GUIDE = Link(
    "Guide",
    "",
    marked(
        "Edges, wire or sketch as a guide; layers are normal to it; none: the centre line of the "
        "solid."
    ),
    required=False,
    type_name="App::PropertyLinkSub",
)
START = Link(
    "StartFaces",
    "",
    marked("Start faces of geodesic and offset layers; none: the base of the solid."),
    required=False,
    type_name="App::PropertyLinkSub",
)


class SolidNodes(HubNodes):
    """Draws the base plane of solids, their first layer and their overhangs."""

    def __init__(self) -> None:
        super().__init__(pickable=False)
        self.over = Faces(OVERHUNG, 0.0)
        self.root.addChild(self.over.node)

    def set_overhang(self, corners: Array) -> None:
        """Show facets (m, 3, 3) in red."""
        self.over.set(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


class SolidPanel(PickPanel):
    """Panel that creates a feature of solids in planar layers from the selection, or changes one."""

    stage, icon, function, draft = SolidFeature, "solid", "make_solid_feature", "Solids"
    nodes: SolidNodes
    leaning: Leaning | None = None  # overhang of the previewed part
    lean = -1  # deg; value of the maximum overhang field that the slider last followed
    cached: tuple[Any, Outcome] | None = None  # inputs and outcome of the last solids

    def __init__(self, obj: Any = None) -> None:
        solids, substrate, guide, start, fixtures = (
            ([], None, None, None, ()) if obj is None else _present(obj)
        )
        self.solids = PickField(SOLIDS, tr("Solids"), solids, self._arm)
        self.substrate = PickField(SUBSTRATE, tr("Substrate"), substrate, self._arm)
        self.fixtures = PickField(FIXTURES, tr("Fixtures"), fixtures, self._arm)
        self.guide = PickField(GUIDE, tr("Guide"), guide, self._arm, picking.EDGE, allow_whole=True)
        self.start = PickField(START, tr("Starts on"), start, self._arm, picking.FACE)
        picks = [self.solids, self.substrate, self.guide, self.start, self.fixtures]
        super().__init__(
            tr("Solids in plane layers") if obj is None else obj.Label, picks, obj, SolidNodes()
        )
        self._add_overhang()

    def _stored(self) -> dict[str, Any]:
        return {
            pick.label: stored for pick, stored in zip(self.picks, _present(self.obj), strict=True)
        }

    def _add_overhang(self) -> None:
        """Add the slider of the overhang view, which changes only the colours."""
        box, help = (
            QtGui.QWidget(),
            tr("Faces that overhang by more than this angle are red in the 3D view"),
        )
        column = QtGui.QVBoxLayout(box)
        column.setContentsMargins(4, 0, 4, 0)
        self.overhang, self.overhung = QtGui.QSlider(QtCore.Qt.Horizontal), QtGui.QLabel()
        self.overhang.setObjectName("OverhangAngle")
        self.overhang.setRange(0, STEEPEST)
        self.overhung.setObjectName("OverhangArea")
        for widget in (self.overhung, self.overhang):
            widget.setToolTip(help)
            widget.setWhatsThis(help)
            column.addWidget(widget)
        self._show_overhang()
        self.overhang.valueChanged.connect(self._show_overhang)
        self.column.insertWidget(self.column.indexOf(self.messages) + 1, box)
        scrolls(box)

    def _show_overhang(self, *_: Any) -> None:
        """Colour overhangs steeper than the slider's angle."""
        angle = self.overhang.value()
        if self.leaning is None:
            self.nodes.set_overhang(np.zeros((0, 3, 3)))
            self.overhung.setText(tr("Overhang > {}°").format(angle))
            return
        corners, area = self.leaning.steeper_than(math.radians(angle))
        self.nodes.set_overhang(corners)
        share = 100.0 * area / max(self.leaning.total_area, 1e-300)
        self.overhung.setText(
            in_user_units(
                tr("Overhang > {}°: {:.4g} cm² ({:.0f} %)").format(angle, area / MM2_PER_CM2, share)
            )
        )

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Take all selected objects as solids to deposit."""
        for pick in picks:
            self.solids.take(pick)
        return ""

    def _lacking(self) -> PickField | None:
        return None if self.solids.picks else self.solids

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        return tr("{} cannot be used here.").format(pick.obj.Label)

    def _links(self) -> dict[str, Any]:
        solids = [pick.obj for pick in self.solids.picks]
        return {
            "Source": (solids[0], []),
            "Further": solids[1:],
            "Substrate": self.substrate.value(),
            "Guide": self.guide.value(),
            "StartFaces": self.start.value(),
            "Fixtures": self.fixtures.value(),
        }

    def _inputs(self) -> dict[str, str]:
        solids = [recorded.reference(pick.obj) for pick in self.solids.picks]
        arguments = {
            "source": solids[0] if solids else "None",
            "further": f"[{', '.join(solids[1:])}]",
            **self.substrate.arguments(),
            "guide": _pick_argument(self.guide),
            "start_faces": _pick_argument(self.start),
            **self.fixtures.arguments(),
        }
        return self._worth_telling(arguments)

    def _values(self) -> dict[str, Any]:
        """Return the entries, with a valid fine chord error replaced by the preview's coarse chord
        error.
        """
        return coarsened(super()._values())

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, tuple[Drawing, Leaning, int]]]:
        """Return work that reads the solids again only if they changed."""
        draft.check()
        cached, work = self.cached, draft.prepare()
        strategy: SolidParameters = draft.stage.parameters(draft.obj, SolidParameters)
        guided = strategy.follows_guide
        key = (self._inputs(), strategy.direction if guided else None, guided)

        def compute() -> tuple[Outcome, tuple[Drawing, Leaning, int]]:
            outcome = cached[1] if cached is not None and cached[0] == key else work()
            self.cached = (key, outcome)
            bodies = outcome.value.groups[0].bodies
            solids = (
                outcome.value if guided else prepare_stack(bodies, strategy, outcome.value.label)
            )
            estimated_size.refuse_absurd(estimated_size.solids_size(solids, strategy), strategy)
            if guided:  # reject layers that are too high or too low at once
                list(along.slices(solids.groups[0].base, bodies, strategy))
            slit = strategy.chord_error if strategy.fuse == "auto" else None
            lean = find_leaning(
                bodies, solids.groups[0].base, CONTACT_HEIGHTS * strategy.layer_height, slit
            )
            overhang_deg = round(math.degrees(strategy.max_overhang))
            return Outcome(solids, solids.issues), (
                drawing(solids),
                lean,
                min(overhang_deg, STEEPEST),
            )

        return compute

    def _link_places(self) -> dict[str, str]:
        return {
            "Source": self.solids.label,
            "Further": self.solids.label,
            "Substrate": self.substrate.label,
            "Guide": self.guide.label,
            "StartFaces": self.start.label,
            "Fixtures": self.fixtures.label,
        }

    def _locate(self, error: AmError) -> tuple[str, str]:
        if error.where == centre_line.WHERE:
            return self.guide.label, sentence(error.message)
        return super()._locate(error)

    def _draw(self, outcome: Outcome, drawn: tuple[Drawing, Leaning, int]) -> str:
        drawing, self.leaning, overhang_deg = drawn
        self.nodes.set(drawing)
        # the slider starts at the field's value and follows its changes
        if overhang_deg != self.lean:
            self.lean = overhang_deg
            self.overhang.setValue(overhang_deg)
        self._show_overhang()
        group = outcome.value.groups[0]
        height = max(
            float(group.base.surface.distance(group.base.inside(body.vertices)).max())
            for body in group.bodies
        )
        contours = sum(
            len(solid_contours) for solids in drawing.contours for solid_contours in solids
        )
        size_text = (
            tr("1 solid, {:.4g} mm high").format(height)
            if len(group.bodies) == 1
            else (tr("{} solids, {:.4g} mm high").format(len(group.bodies), height))
        )
        first_layer = (
            tr("first layer: 1 contour")
            if contours == 1
            else tr("first layer: {} contours").format(contours)
        )
        text = f"{in_user_units(size_text)}; {first_layer}"
        return "\n".join([text, *(sentence(issue.message) for issue in outcome.issues)])

    def _draw_without(self) -> None:
        self.nodes.set(NOTHING)
        self.leaning = None
        self._show_overhang()


def _pick_argument(field: PickField) -> str:
    """Return an object with its edges or faces as a macro argument."""
    if not field.picks:
        return "None"
    pick = field.picks[0]
    return f"({recorded.reference(pick.obj)}, {list(pick.names) or ['']!r})"


def _present(obj: Any) -> tuple[Any, ...]:
    """Return an object's solids, substrate, guide, start faces and fixtures."""
    solids = [obj.Source[0], *obj.Further] if obj.Source else []
    return (
        solids,
        obj.Substrate,
        getattr(obj, "Guide", None),
        getattr(obj, "StartFaces", None),
        obj.Fixtures,
    )
