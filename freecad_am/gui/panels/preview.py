# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels that preview the result of OK while they are open."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore

from ...core.issues import AmError, InputError, has_errors
from ...objects.families.developable import COARSE
from ...objects.fields import rows
from ...objects.stage import Stage
from ...objects.stage_parts import Outcome
from ...objects.staleness import STALE
from ...objects.work import hooks
from .. import picking
from ..colours import INVALID, PLAIN, set_role
from ..in_language import tr, translated, translated_error
from ..nodes.wall import WallNodes
from ..views.preview import Draft, Preview
from ..widgets.pick_field import Input, PickField
from ..widgets.shape_inputs import StageChoice
from ..worker import Background, Worker
from .stage import CLOSED, StagePanel

LOOK_EVERY = 200  # ms; an entry that is stable for this long is previewed
SHOWN_AFTER_MS = 400  # ms; when a longer preview shows a message


class PreviewPanel(StagePanel):
    """Panel that creates or changes a stage, with a preview in the 3D view if it has nodes.

    The document changes only on OK.
    """

    stage: type[Stage]
    is_open = True
    refused: Any = None  # the entries that OK or Apply rejected
    lines = 5

    def __init__(self, title: str, choices: Sequence[Input], obj: Any, nodes: Any) -> None:
        self.nodes = nodes
        super().__init__(self.stage, title, choices, obj)
        self.seen: Any = None  # the entries at the last check
        self.shown: Any = None  # the previewed entries
        self.blamed: set[str] = set()  # fields with an error from the last preview
        self.state = self.messages.add("preview", PLAIN)
        self.preview = None if nodes is None else Preview(self.document, nodes.switch)
        self._show_own(False)
        self.timer = QtCore.QTimer(self.form)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)
        self.timer.start()
        self.background = Background(self.form)
        self.form.destroyed.connect(self.close)

    # ---- to be defined by a panel

    def _lacks(self) -> str:
        """Return which input is missing, '' for none."""
        return next((choice.missing for choice in self.choices if choice.missing), "")

    def _links(self) -> dict[str, Any]:
        """Return the inputs in the form of the stage's links."""
        return {choice.link.name: choice.value() for choice in self.choices}

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Any]]:
        """Return a function that computes the outcome and its drawing without touching the
        document.

        Both raise AmError.
        """
        raise NotImplementedError

    def _draw(self, outcome: Outcome, drawing: Any) -> str:
        """Draw the outcome and return its summary."""
        raise NotImplementedError

    def _draw_without(self) -> None:
        """Draw without an outcome."""
        raise NotImplementedError

    def _show_own(self, visible: bool) -> None:
        """Show or hide the object's own drawing, which the preview replaces."""
        raise NotImplementedError

    # ---- preview

    def _look(self) -> None:
        """Preview the entries once they settle. Wait for a running recompute, which may change inputs."""
        if hooks.carrying():
            return
        try:
            now = self._entered()
            if now != self.seen:
                self.seen = now
            elif now != self.shown:
                self.shown = now
                self._renew()
        except ReferenceError:
            self._report_closed()

    def _report_closed(self) -> None:
        """Report a deleted document or object before the user clicks or types anything else."""
        self.close()
        with contextlib.suppress(RuntimeError):  # the panel may be deleted, too
            self.say(tr(CLOSED))

    def _entered(self) -> Any:
        texts = []
        for field, _, _ in self.places.values():
            try:
                texts.append((field.row.name, field.value))
            except InputError as error:
                texts.append((field.row.name, error.message))
        results = [(stage.Key, stage.Status) for stage in self._stages()]
        return self.document.Name, self._inputs(), results, texts

    def _stages(self) -> list[Any]:
        """Return the stages that are inputs."""
        stages = [choice.value() for choice in self.choices if isinstance(choice, StageChoice)]
        return [stage for stage in stages if stage is not None]

    def _stale_inputs(self) -> tuple[str, ...]:
        """Return the labels of stale inputs."""
        return tuple(stage.Label for stage in self._stages() if stage.Status == STALE)

    def _renew(self) -> None:
        """Start computing the entries; cancel the previous run."""
        self.background.cancel()
        refused = set(self.marked) if self.shown == self.refused else set()
        for key in (self.blamed | set(self.marked)) - refused:
            # keep the remark on the entry; it may belong to the previous entry until the next check
            if self.remarks.get(key) != self.notes[key].text():
                self.show_note(key, "")
        self.blamed.clear()
        lacks = self._lacks()
        if lacks:
            self._say(lacks, False)
            self._draw_without()
            return
        try:
            draft = Draft(self.proxy, self.document, self.draft, self._links(), self._values())
            self.background.start(draft.reporting(self._work(draft)), self._show_result)
        except AmError as error:
            self._refuse(error)
            return
        worker = self.background.worker
        QtCore.QTimer.singleShot(SHOWN_AFTER_MS, lambda: self._say_waiting(worker))

    def _say_waiting(self, worker: Worker | None) -> None:
        if worker is not None and self.background.worker is worker:
            with contextlib.suppress(RuntimeError):
                self._say(tr("Computing the preview."), False)

    def _show_result(self, worker: Worker) -> None:
        """Show the result or the error, unless the entries have changed meanwhile."""
        try:
            if self._entered() != self.shown:
                self.shown = None
                return
            outcome, drawing = worker.result()
            self._say(self._draw(outcome, drawing), has_errors(outcome.issues))
        except AmError as error:
            self._refuse(error)
        except ReferenceError:
            self.close()
        except Exception as error:  # unexpected; OK would report it too
            self._say(f"{type(error).__name__}: {error}", True)
            self._draw_without()

    def _refuse(self, error: AmError) -> None:
        key, text = self._locate(error)
        if key:
            self._say(tr("No preview: see the marked field."), False)
            self._unfolded(key)
            self.show_note(key, text)
            self.blamed.add(key)
        else:
            self._say(translated_error(error), True)
        self._draw_without()

    def _values(self) -> dict[str, Any]:
        values = {}
        for key, (field, _, _) in self.places.items():
            try:
                value = field.value
                if rows.is_expression(value) and field.row.form in rows.FOLLOW:
                    value = self._evaluated(field, value)
                values[field.row.name] = value
            except InputError as error:
                raise InputError(error.code, key, error.message) from None
        return values

    def _say(self, text: str, wrong: bool) -> None:
        """Show a message about the preview."""
        set_role(self.state, INVALID if wrong else PLAIN)
        self.state.setText(text)
        self.state.setVisible(bool(text))

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Create or change the feature; return True to close the panel."""
        succeeded = super().accept()
        if succeeded:
            self.close()
        return succeeded

    def apply(self) -> bool:
        """Create or change the feature; the preview continues to replace its drawing."""
        succeeded = super().apply()
        if succeeded:
            self._show_own(False)
        return succeeded

    def _carry_out(self) -> bool:
        self.background.cancel()
        succeeded = super()._carry_out()
        self.seen = self.shown = None  # the preview restarts, because the created object differs
        if not succeeded:
            with contextlib.suppress(ReferenceError):
                self.refused = self._entered()
        return succeeded

    def reject(self) -> bool:
        """Close without a change and remove the preview."""
        self.close()
        return super().reject()

    def close(self, *_: Any) -> None:
        """Remove the preview; may be called repeatedly."""
        if not self.is_open:
            return
        self.is_open = False
        self.background.cancel()
        if self.preview is not None:
            self.preview.remove()
        with contextlib.suppress(RuntimeError):  # the panel and its timer are deleted
            self.timer.stop()
        with contextlib.suppress(
            RuntimeError, ReferenceError, AttributeError
        ):  # the object is deleted
            self._show_own(True)


def stale_lines(labels: Sequence[str]) -> list[str]:
    """Return the note on inputs that were out of date when the preview started."""
    return [
        tr("{} is out of date; the preview shows its earlier state.").format(label)
        for label in labels
    ]


def coarsened(values: dict[str, Any]) -> dict[str, Any]:
    """Return the entries, with a valid fine chord error replaced by the preview's coarse chord
    error.
    """
    error = values["ChordError"]
    return (
        {**values, "ChordError": COARSE}
        if 0.0 < getattr(error, "Value", error) < COARSE
        else values
    )


class PickPanel(PreviewPanel):
    """Panel that creates a feature from the selection, or changes one."""

    armed: PickField | None = None  # the field that waits for clicks

    def __init__(self, title: str, picks: list[PickField], obj: Any, nodes: WallNodes) -> None:
        self.picks = picks
        unclear = self._propose(picking.selected(App.ActiveDocument)) if obj is None else ""
        super().__init__(title, picks, obj, nodes)
        Gui.Selection.clearSelection()  # the selection colour would hide the preview
        Gui.Selection.addObserver(self)
        self._arm_missing()
        self.say(unclear)

    # ---- to be defined by a panel

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Fill in the selection and return what is unclear."""
        raise NotImplementedError

    def _lacking(self) -> PickField | None:
        """Return the first missing input."""
        raise NotImplementedError

    def _following(self, field: PickField) -> PickField | None:
        """Return the only input that can take a click which the waiting input rejects."""
        return None

    def _handle_pick(self, field: PickField) -> None:
        """Handle a pick for an input."""

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        """Return why an input rejects a click."""
        raise NotImplementedError

    def _link_places(self) -> dict[str, str]:
        """Return the label of the input for each link."""
        return {field.link.name: field.label for field in self.picks}

    def _lacks(self) -> str:
        lacking = self._lacking()
        if lacking is None:
            return ""
        text = (
            tr("{} are missing: click them in the tree or the 3D view.")
            if lacking.several
            else tr("{} is missing: click it in the tree or the 3D view.")
        )
        return text.format(lacking.label)

    # ---- picking

    def _worth_telling(self, inputs: dict[str, str]) -> dict[str, str]:
        """Return the part and other picks of a new feature, or all inputs of an existing feature.

        Inputs of an existing feature may be cleared.
        """
        if self.obj is not None:
            return inputs
        return {
            key: text
            for key, text in inputs.items()
            if key == "source" or text not in ("None", "[]")
        }

    def _field(self, name: str) -> PickField:
        return next(field for field in self.picks if field.link.name == name)

    def _arm(self, field: PickField, on: bool) -> None:
        """Handle the pick button of a field."""
        for pick_field in self.picks:
            if on and pick_field is not field:
                pick_field.pick.setChecked(False)
        self.armed = field if on else (None if self.armed is field else self.armed)
        field.show()
        if on:
            self._take()  # the current selection

    def _arm_missing(self) -> None:
        """Wait for the first missing input."""
        field = self._lacking()
        if field is not None:
            field.pick.setChecked(True)

    def addSelection(self, *_: Any) -> None:
        """Handle a click after FreeCAD has finished it; called by FreeCAD."""
        if self.armed is not None:
            QtCore.QTimer.singleShot(0, self._take)

    setSelection = addSelection

    def _take(self) -> None:
        field = self.armed
        if field is None or not self.is_open:
            return
        try:
            picks = picking.selected(self.document)
        except ReferenceError:
            self._report_closed()
            return
        for pick in picks:
            following = self._following(field)
            if field.take(pick):
                self.show_note(field.label, "")
            elif following is not None and following.take(pick):
                field = following
            else:
                self.show_note(field.label, self._refusal(field, pick))
        if picks:
            self._handle_pick(field)
            Gui.Selection.clearSelection()
            if field.picks and not field.more:
                for pick_field in self.picks:
                    pick_field.pick.setChecked(False)
                self._arm_missing()

    def _locate(self, error: AmError) -> tuple[str, str]:
        key, text = super()._locate(error)
        if key:
            return key, text
        names = [self.draft, *self._names()]
        named = [(pick.obj.Label, field.label) for field in self.picks for pick in field.picks]
        named += [
            (f"{name}.{link}", key) for link, key in self._link_places().items() for name in names
        ]
        for label, key in sorted(named, key=lambda pair: -len(pair[0])):
            if error.where == label or error.where.startswith(f"{label} "):
                return (
                    key,
                    f"{error.where.removeprefix(label)} {translated(error.message)}".strip(),
                )
        return "", translated_error(error)

    # ---- closing

    def close(self, *_: Any) -> None:
        """Remove the preview and stop observing clicks; may be called repeatedly."""
        if self.is_open:
            Gui.Selection.removeObserver(self)
        super().close()

    def _show_own(self, visible: bool) -> None:
        if self.obj is not None:
            self.obj.ViewObject.Proxy.wall.show(visible)
