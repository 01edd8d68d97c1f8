# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a part of revolution; it previews meridian, axis and layers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...core.issues import AmError, Issue
from ...core.parameters.strategy import RevolutionParameters
from ...core.strategies.revolution.plan import Slices, sliced
from ...objects.checks import deposit
from ...objects.feature import RevolutionFeature
from ...objects.fields.preferences import in_user_units
from ...objects.stage_parts import Outcome
from ..in_language import sentence, tr, translated
from ..nodes.lines import MeridianNodes
from ..views.preview import Draft
from ..widgets import shape_inputs
from .preview import PreviewPanel

Drawing = tuple[RevolutionParameters, Slices, list[Issue]]


class FeaturePanel(PreviewPanel):
    """Creates a feature from the selected shape, or changes one."""

    stage, draft = RevolutionFeature, "Feature"

    def __init__(self, obj: Any = None) -> None:
        title = tr("Feature") if obj is None else obj.Label
        super().__init__(title, shape_inputs.of(RevolutionFeature, obj), obj, MeridianNodes())
        self.say("")  # a missing input is reported in place of the preview
        self.show_note(self.choices[0].label, self.choices[0].note, wrong=False)

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Drawing]]:
        draft.check()
        work, strategy = draft.prepare(), draft.stage.parameters(draft.obj, RevolutionParameters)

        def compute() -> tuple[Outcome, Drawing]:
            outcome = work()
            return outcome, (strategy, *sliced(outcome.value, strategy))

        return compute

    def _draw(self, outcome: Outcome, drawing: Drawing) -> str:
        strategy, slices, issues = drawing
        self.nodes.set_wall(outcome.value)
        self.nodes.set_layers(outcome.value, slices)
        text = (
            tr("About {} turns along {:.4g} mm of wall")
            if strategy.path == "spiral"
            else tr("Layers: {}, along {:.4g} mm of wall")
        )
        count = int(slices.layer.max(initial=-1)) + 1
        messages = (
            sentence(issue.message)
            for issue in (*deposit.expected(outcome.value, self.obj), *outcome.issues, *issues)
        )
        return "\n".join(
            [in_user_units(text.format(count, outcome.value.meridian.length)), *messages]
        )

    def _draw_without(self) -> None:
        self.nodes.clear()

    def _locate(self, error: AmError) -> tuple[str, str]:
        """Show a problem of the shape under its field."""
        source = self.choices[0]
        if source.present is not None and error.where == source.present[0].Label:
            return source.label, translated(error.message)
        return super()._locate(error)

    def _show_own(self, visible: bool) -> None:
        if self.obj is not None:
            self.obj.ViewObject.Proxy.revolved.show(visible)
