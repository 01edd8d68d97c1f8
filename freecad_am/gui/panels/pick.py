# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels whose inputs are picked in the tree or the 3D view, with a preview of what OK would make while they are open."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore

from ...core.issues import AmError
from ..nodes.wall import WallNodes
from ..picking import picking
from ..picking.pick_field import PickField
from ..texts.translation import tr, translated, translated_error
from .preview import PreviewPanel


class PickPanel(PreviewPanel):
    """Makes a feature of what is selected, or changes one."""

    armed: PickField | None = None  # the one that waits for clicks

    def __init__(self, title: str, picks: list[PickField], obj: Any, nodes: WallNodes) -> None:
        self.picks = picks
        unclear = self._propose(picking.selected(App.ActiveDocument)) if obj is None else ""
        super().__init__(title, picks, obj, nodes)
        Gui.Selection.clearSelection()  # or its colour would hide what is previewed
        Gui.Selection.addObserver(self)
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

    def _link_places(self) -> dict[str, str]:
        """The label of the input that each link is entered by."""
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
        """Of a new feature the part and whatever else was picked, of one that is changed all inputs: some may be emptied."""
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
        try:
            picks = picking.selected(self.document)
        except ReferenceError:
            self._gone()
            return
        for pick in picks:
            following = self._following(field)
            if field.take(pick):
                self.tell(field.label, "")
            elif following is not None and following.take(pick):
                field = following
            else:
                self.tell(field.label, self._refusal(field, pick))
        if picks:
            self._taken(field)
            Gui.Selection.clearSelection()
            if field.picks and not field.more:
                for one in self.picks:
                    one.pick.setChecked(False)
                self._arm_missing()

    def _placed(self, error: AmError) -> tuple[str, str]:
        place, text = super()._placed(error)
        if place:
            return place, text
        names = [self.draft, *self._names()]
        named = [(pick.obj.Label, field.label) for field in self.picks for pick in field.picks]
        named += [
            (f"{name}.{link}", place)
            for link, place in self._link_places().items()
            for name in names
        ]
        for label, place in sorted(named, key=lambda pair: -len(pair[0])):
            if error.where == label or error.where.startswith(f"{label} "):
                return (
                    place,
                    f"{error.where.removeprefix(label)} {translated(error.message)}".strip(),
                )
        return "", translated_error(error)

    # ---- the end

    def close(self, *_: Any) -> None:
        """Take away the preview, and look at clicks no more; once or more often."""
        if self.is_open:
            Gui.Selection.removeObserver(self)
        super().close()

    def _show_own(self, visible: bool) -> None:
        if self.obj is not None:
            self.obj.ViewObject.Proxy.wall.show(visible)
