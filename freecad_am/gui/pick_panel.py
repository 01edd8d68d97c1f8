# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels whose inputs are picked in the tree or the 3D view, with a preview of what OK would make while they are open."""

from __future__ import annotations

import contextlib
from time import monotonic
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore

from ..core.issues import AmError, InputError
from ..objects.stage import Outcome, Stage
from . import picking
from .colours import WRONG
from .pick_field import PickField
from .preview import Draft, Preview
from .stage_panel import StagePanel
from .wall_nodes import WallNodes

LOOK_EVERY = 250  # ms; what has not changed between two looks is previewed,
LONGEST_WAIT = 1.5  # s; and where that takes long, not before as long has passed, but for this


class PickPanel(StagePanel):
    """Makes a feature of what is selected, or changes one. The document is left alone before OK."""

    stage: type[Stage]
    draft = ""  # the name in errors of what is not made yet
    is_open = True
    armed: PickField | None = None  # the one that waits for clicks
    changed_at = took = 0.0  # s; when the entries last changed, and how long the last preview took

    def __init__(self, title: str, picks: list[PickField], obj: Any, nodes: WallNodes) -> None:
        self.picks, self.nodes = picks, nodes
        unclear = self._propose(picking.selected(App.ActiveDocument)) if obj is None else ""
        super().__init__(self.stage, title, picks, obj)
        self.seen: Any = None  # the entries at the last look
        self.shown: Any = None  # those that are previewed
        self.state = self._note("preview", "palette(text)")
        self.column.removeWidget(self.state)
        self.column.insertWidget(2, self.state)
        self.preview = Preview(self.document, nodes.switch)
        self._show_own(False)
        Gui.Selection.clearSelection()  # or its colour would hide what is previewed
        Gui.Selection.addObserver(self)
        self.timer = QtCore.QTimer(self.form)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)
        self.timer.start()
        self.form.destroyed.connect(self.close)
        self._arm_missing()
        self.say(unclear)

    # ---- what a panel defines

    def _propose(self, picks: list[picking.Pick]) -> str:
        """Fill in what the selection tells; what is unclear about it."""
        raise NotImplementedError

    def _lacking(self) -> PickField | None:
        """The first input that is missing."""
        raise NotImplementedError

    def _following(self, field: PickField) -> PickField | None:
        """The input that a click can only mean which the one that waits for it does not take."""
        return None

    def _taken(self, field: PickField) -> None:
        """Something was picked for an input."""

    def _refusal(self, field: PickField, pick: picking.Pick) -> str:
        """Why an input does not take what was clicked."""
        raise NotImplementedError

    def _links(self) -> dict[str, Any]:
        """The inputs as the links of the stage hold them."""
        raise NotImplementedError

    def _link_places(self) -> dict[str, str]:
        """The label of the input that each link is entered by."""
        return {field.link.name: field.label for field in self.picks}

    def _made(self, draft: Draft) -> Outcome:
        """What is entered makes. Raises AmError."""
        return draft.outcome()

    def _draw(self, made: Outcome | None) -> str:
        """Draw what was computed, or what can be without; what to tell about it."""
        raise NotImplementedError

    # ---- picking

    def _field(self, name: str) -> PickField:
        return next(field for field in self.picks if field.link.name == name)

    def _arm(self, field: PickField, on: bool) -> None:
        """The pick button of a field was pressed or released."""
        for other in self.picks:
            if on and other is not field:
                other.pick.setChecked(False)
        self.armed = field if on else (None if self.armed is field else self.armed)
        field.show()
        if on:
            self._take()  # what is selected already

    def _arm_missing(self) -> None:
        """Wait for the first input that is missing."""
        field = self._lacking()
        if field is not None:
            field.pick.setChecked(True)

    def addSelection(self, *_: Any) -> None:
        """Something was clicked; called by FreeCAD, which must first be done with it."""
        if self.armed is not None:
            QtCore.QTimer.singleShot(0, self._take)

    setSelection = addSelection

    def _take(self) -> None:
        field = self.armed
        if field is None or not self.is_open:
            return
        picks = picking.selected(self.document)
        for pick in picks:
            following = self._following(field)
            if field.take(pick):
                self._tell(field.label, "")
            elif following is not None and following.take(pick):
                field = following
            else:
                self._tell(field.label, self._refusal(field, pick))
        if picks:
            self._taken(field)
            Gui.Selection.clearSelection()
            if field.picks and not field.more:
                for one in self.picks:
                    one.pick.setChecked(False)
                self._arm_missing()

    # ---- preview

    def _look(self) -> None:
        """Preview what is entered once it no longer changes."""
        try:
            now, time = self._entered(), monotonic()
            if now != self.seen:
                self.seen, self.changed_at = now, time
            elif now != self.shown and time - self.changed_at >= min(self.took, LONGEST_WAIT):
                self.shown = now
                self._renew()
                self.took = monotonic() - time
        except ReferenceError:
            self.close()

    def _entered(self) -> Any:
        texts = []
        for field, _, _ in self.places.values():
            try:
                texts.append((field.row.name, field.value))
            except InputError as error:
                texts.append((field.row.name, error.message))
        return self._inputs(), texts

    def _renew(self) -> None:
        for place in self.notes:
            self._tell(place, "")
        lacking = self._lacking()
        if lacking is not None:
            verb, them = ("are", "them") if lacking.several else ("is", "it")
            self._say(f"{lacking.label} {verb} missing: click {them} in the tree or the 3D view.", False)
            self._draw(None)
            return
        try:
            draft = Draft(self.proxy, self.document, self.draft, self._links(), self._values())
            self._say(self._draw(self._made(draft)), False)
            return
        except InputError as error:
            self._place(error)
        except AmError as error:
            self._say(str(error), True)
        except Exception as error:  # of OpenCASCADE; OK would tell it too
            self._say(f"{type(error).__name__}: {error}", True)
        self._draw(None)

    def _values(self) -> dict[str, Any]:
        found = {}
        for place, (field, _, _) in self.places.items():
            try:
                found[field.row.name] = field.value
            except InputError as error:
                raise InputError(error.code, place, error.message) from None
        return found

    def _place(self, error: InputError) -> None:
        """Tell an error under the field it belongs to."""
        self._say("No preview: see the field marked.", False)
        for place, (field, _, fold) in self.places.items():
            if error.where.replace(".", "_") == place or error.where == f"{self.draft}.{field.row.name}":
                fold.heading.setChecked(True)
                self._tell(place, error.message)
                return
        named = [(pick.obj.Label, field.label) for field in self.picks for pick in field.picks]
        named += [(f"{self.draft}.{link}", place) for link, place in self._link_places().items()]
        for label, place in sorted(named, key=lambda pair: -len(pair[0])):
            if error.where == label or error.where.startswith(f"{label} "):
                self._tell(place, f"{error.where.removeprefix(label)} {error.message}".strip())
                return
        self._say(str(error), True)

    def _tell(self, place: str, text: str) -> None:
        self.notes[place].setText(text)
        self.notes[place].setVisible(bool(text))

    def _say(self, text: str, wrong: bool) -> None:
        self.state.setStyleSheet(f"QLabel {{ color: {WRONG if wrong else 'palette(text)'}; }}")
        self.state.setText(text)
        self.state.setVisible(bool(text))

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Make or change the feature; True closes the panel."""
        done = super().accept()
        if done:
            self.close()
        return done

    def reject(self) -> bool:
        """Nothing was done; what was previewed goes."""
        self.close()
        return super().reject()

    def close(self, *_: Any) -> None:
        """Take away the preview, and look at clicks no more; once or more often."""
        if not self.is_open:
            return
        self.is_open = False
        Gui.Selection.removeObserver(self)
        self.preview.remove()
        with contextlib.suppress(RuntimeError):  # the panel is gone, and with it the timer
            self.timer.stop()
        with contextlib.suppress(RuntimeError, ReferenceError, AttributeError):  # the object is gone
            self._show_own(True)

    def _show_own(self, visible: bool) -> None:
        """Show or hide what the object itself draws, which the preview stands for."""
        if self.obj is not None:
            self.obj.ViewObject.Proxy.wall.show(visible)
