# SPDX-License-Identifier: LGPL-2.1-or-later
"""Show problems of a panel's entries under their fields, else at the top."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Sequence
from typing import Any

from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError, values_in
from ...core.parameters.field import check_value
from ...objects.fields import rows
from ...objects.stage import Stage
from ..colours import INVALID, PLAIN, set_role
from ..in_language import translated, translated_error
from ..widgets import fields
from ..widgets.fold import Fold, Messages
from ..widgets.pick_field import Input
from ..widgets.upright import present, scroll_areas_of


class Noted:
    """Fields with a note under each; a panel has them filled in."""

    draft = ""  # name of an object to be created, in errors
    proxy: type[Stage]
    choices: Sequence[Input]
    obj: Any
    document: Any
    form: Any
    messages: Messages
    error: Any  # at the top
    heading: Any  # of the inputs
    marked: dict[str, str]  # keys with an error from OK or Apply, and their entries
    remarks: dict[str, str]  # those with what an expression gives or is wrong as typed, and that
    notes: dict[str, Any]  # under the fields, by the label of an input or the place of a parameter
    places: dict[
        str, tuple[fields.Field, str, Fold]
    ]  # by the name that errors give a parameter: field, how it is called

    def say(self, text: str) -> None:
        """Show an error at the top."""
        self.error.setText(text)
        self.error.setVisible(bool(text))
        self.messages.to_top()

    def show_note(self, key: str, text: str, wrong: bool = True) -> None:
        """Show a note under a field; '' hides it."""
        note = self.notes[key]
        set_role(note, INVALID if wrong else PLAIN)
        note.setText(text)
        note.setVisible(bool(text))

    def show_error(self, error: AmError) -> None:
        """Under the field it belongs to, which is brought into sight and gets the focus; else at the top."""
        key, text = self._locate(error)
        if not key:
            self.say(translated_error(error))
            return
        self.marked[key] = self._entry(key)
        self.show_note(key, text)
        widget = self._unfolded(key)
        widget.setFocus()
        QtCore.QTimer.singleShot(0, lambda: _bring_into_sight(self.form, self.notes.get(key)))

    def _locate(self, error: AmError) -> tuple[str, str]:
        """Return the key of the note for an error, '' for none, and its text."""
        error_key, names = error.where.replace(".", "_"), self._names()
        for key, (field, _, _) in self.places.items():
            if key == error_key or error.where in [f"{name}.{field.row.name}" for name in names]:
                return key, translated(error.message)
        for choice in self.choices:
            input_name = choice.link.name if hasattr(choice, "link") else choice.widget.objectName()
            missing = error.code == "NO_INPUT" and input_name in values_in(error.message)
            if missing or error.where in [
                *choice.places,
                *(f"{name}.{input_name}" for name in names),
            ]:
                return choice.label, translated(error.message)
        return "", translated_error(error)

    def _names(self) -> list[str]:
        """What errors call the stage: by its label, while it is made and where it is but previewed."""
        return [
            self.draft,
            self.proxy.kind.capitalize(),
            *([] if self.obj is None else [self.obj.Label]),
        ]

    def leave_out(self, keys: Collection[str], also_entered: bool = False) -> None:
        """Show all fields except `keys`. A field with an entry stays visible unless `also_entered`."""
        for key, (field, _, fold) in self.places.items():
            default = field.row.outer(
                field.row.default
            )  # which some fields hold as a text, of nothing too
            empty = {repr(default), repr("" if default is None else str(default))}
            holds = not also_entered and self._entry(key) not in empty
            fold.show(field.widget, key not in keys or holds)

    def _unfolded(self, key: str) -> Any:
        """Unfold the section of a key and return its widget."""
        if key in self.places:
            field, _, fold = self.places[key]
            fold.show(field.widget, True)
            fold.heading.setChecked(True)
            return field.widget
        self.heading.heading.setChecked(True)
        return next(choice.widget for choice in self.choices if choice.label == key)

    def _entry(self, key: str) -> str:
        """Return the entry of a key for comparison."""
        try:
            if key in self.places:
                return repr(self.places[key][0].value)
            widgets = [choice.widget for choice in self.choices if choice.label == key]
            return repr([line.text() for widget in widgets for line in lines_of(widget)])
        except InputError as error:
            return error.message

    def judge_entries(self) -> None:
        """Show the value or problem of each expression under its field; clear errors of changed entries."""
        for key, entry in list(self.marked.items()):
            if self._entry(key) != entry:
                del self.marked[key]
                self.show_note(key, "")
        for key, (field, _, _) in self.places.items():
            with contextlib.suppress(ReferenceError):
                judged = self._judge_field(field)
                if judged is not None:
                    self.show_note(key, *judged)
                    self.remarks[key] = judged[0]
                elif self.remarks.pop(key, None) == self.notes[key].text():
                    self.show_note(key, "")

    def _judge_field(self, field: fields.Field) -> tuple[str, bool] | None:
        """Return the value of a field's expression or the problem of its entry; None without either."""
        try:
            value = field.value
            if field.row.form not in rows.FOLLOW:
                return None
            if rows.is_expression(value):
                result = self._evaluated(field, value)
                return f"= {getattr(result, 'UserString', result)}", False
            check_value(field.row.spec, field.row.inner(value, field.label), field.label)
        except InputError as error:
            return translated(error.message), True
        return None

    def _evaluated(self, field: fields.Field, value: str) -> Any:
        """An expression's value now, in the unit that a plain entry would have."""
        around = self.obj if self.obj is not None else next(iter(self.document.Objects), None)
        result = rows.evaluated(value, around, field.label)
        field.row.inner(result, field.label)  # refuses another dimension
        return result


def lines_of(widget: Any) -> list[Any]:
    """The line edits of a field: itself, or those in it."""
    return [widget] if isinstance(widget, QtGui.QLineEdit) else present(widget, QtGui.QLineEdit)


def _bring_into_sight(form: Any, widget: Any) -> None:
    """Scroll the task panel to something in it."""
    with contextlib.suppress(RuntimeError):  # the panel is gone by now
        for area in scroll_areas_of(form):
            if widget is not None and area.isVisible():
                area.ensureWidgetVisible(widget)
