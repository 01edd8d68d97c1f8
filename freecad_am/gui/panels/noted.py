# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is wrong with what is entered in a panel, told under the field it belongs to, else at the top."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Sequence
from typing import Any

from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError, values_in
from ...core.parameters.field import check_value
from ...objects.fields import rows
from ...objects.stage import Stage
from ..colours import PLAIN, WRONG, set_role
from ..picking.pick_field import Input
from ..texts.in_language import translated, translated_error
from ..widgets import fields
from ..widgets.fold import Fold, Messages
from ..widgets.present import present
from ..widgets.upright import around


class Noted:
    """Fields with a note under each; a panel has them filled in."""

    draft = ""  # the name in errors of what is not made yet
    proxy: type[Stage]
    choices: Sequence[Input]
    obj: Any
    document: Any
    form: Any
    messages: Messages
    error: Any  # at the top
    heading: Any  # of the inputs
    marked: dict[str, str]  # places with an error of OK or Apply, and what was entered there
    remarks: dict[str, str]  # those with what an expression gives or is wrong as typed, and that
    notes: dict[str, Any]  # under the fields, by the label of an input or the place of a parameter
    places: dict[
        str, tuple[fields.Field, str, Fold]
    ]  # by the name that errors give a parameter: field, how it is called

    def say(self, text: str) -> None:
        """Show what is wrong."""
        self.error.setText(text)
        self.error.setVisible(bool(text))
        self.messages.to_top()

    def tell(self, place: str, text: str, wrong: bool = True) -> None:
        """Something about a field, under it; '' for nothing any more."""
        note = self.notes[place]
        set_role(note, WRONG if wrong else PLAIN)
        note.setText(text)
        note.setVisible(bool(text))

    def tell_error(self, error: AmError) -> None:
        """Under the field it belongs to, which is brought into sight and gets the focus; else at the top."""
        place, text = self._placed(error)
        if not place:
            self.say(translated_error(error))
            return
        self.marked[place] = self._entry(place)
        self.tell(place, text)
        widget = self._unfolded(place)
        widget.setFocus()
        QtCore.QTimer.singleShot(0, lambda: _bring_into_sight(self.form, self.notes.get(place)))

    def _placed(self, error: AmError) -> tuple[str, str]:
        """The place among the notes that an error belongs to, '' for none, and what to say there."""
        place, names = error.where.replace(".", "_"), self._names()
        for known, (field, _, _) in self.places.items():
            if known == place or error.where in [f"{name}.{field.row.name}" for name in names]:
                return known, translated(error.message)
        for choice in self.choices:
            own = choice.link.name if hasattr(choice, "link") else choice.widget.objectName()
            missing = error.code == "NO_INPUT" and own in values_in(error.message)
            if missing or error.where in [*choice.places, *(f"{name}.{own}" for name in names)]:
                return choice.label, translated(error.message)
        return "", translated_error(error)

    def _names(self) -> list[str]:
        """What errors call the stage: by its label, while it is made and where it is but previewed."""
        return [
            self.draft,
            self.proxy.kind.capitalize(),
            *([] if self.obj is None else [self.obj.Label]),
        ]

    def leave_out(self, places: Collection[str], also_entered: bool = False) -> None:
        """Show all fields but some that mean nothing now; those that hold something all the same only where it is said."""
        for place, (field, _, fold) in self.places.items():
            default = field.row.outer(
                field.row.default
            )  # which some fields hold as a text, of nothing too
            empty = {repr(default), repr("" if default is None else str(default))}
            holds = not also_entered and self._entry(place) not in empty
            fold.show(field.widget, place not in places or holds)

    def _unfolded(self, place: str) -> Any:
        """The widget of a place, its part of the panel unfolded."""
        if place in self.places:
            field, _, fold = self.places[place]
            fold.show(field.widget, True)
            fold.heading.setChecked(True)
            return field.widget
        self.heading.heading.setChecked(True)
        return next(choice.widget for choice in self.choices if choice.label == place)

    def _entry(self, place: str) -> str:
        """What is entered at a place, to be compared."""
        try:
            if place in self.places:
                return repr(self.places[place][0].value)
            chosen = [choice.widget for choice in self.choices if choice.label == place]
            return repr([line.text() for widget in chosen for line in lines_of(widget)])
        except InputError as error:
            return error.message

    def judge_entries(self) -> None:
        """Tell under each field what its expression gives or is wrong as typed; an error of OK goes with its entry."""
        for place, entry in list(self.marked.items()):
            if self._entry(place) != entry:
                del self.marked[place]
                self.tell(place, "")
        for place, (field, _, _) in self.places.items():
            with contextlib.suppress(ReferenceError):
                judged = self._judged(field)
                if judged is not None:
                    self.tell(place, *judged)
                    self.remarks[place] = judged[0]
                elif self.remarks.pop(place, None) == self.notes[place].text():
                    self.tell(place, "")

    def _judged(self, field: fields.Field) -> tuple[str, bool] | None:
        """What the expression in a field gives, or what is wrong with what it holds; None where there is nothing to tell."""
        try:
            value = field.value
            if field.row.form not in rows.FOLLOW:
                return None
            if rows.is_expression(value):
                found = self._evaluated(field, value)
                return f"= {getattr(found, 'UserString', found)}", False
            check_value(field.row.spec, field.row.inner(value, field.label), field.label)
        except InputError as error:
            return translated(error.message), True
        return None

    def _evaluated(self, field: fields.Field, value: str) -> Any:
        """An expression's value now, in the unit that a plain entry would have."""
        around = self.obj if self.obj is not None else next(iter(self.document.Objects), None)
        found = rows.evaluated(value, around, field.label)
        field.row.inner(found, field.label)  # refuses another dimension
        return found


def lines_of(widget: Any) -> list[Any]:
    """The line edits of a field: itself, or those in it."""
    return [widget] if isinstance(widget, QtGui.QLineEdit) else present(widget, QtGui.QLineEdit)


def _bring_into_sight(form: Any, widget: Any) -> None:
    """Scroll the task panel to something in it."""
    with contextlib.suppress(RuntimeError):  # the panel is gone by now
        for area in around(form):
            if widget is not None and area.isVisible():
                area.ensureWidgetVisible(widget)
