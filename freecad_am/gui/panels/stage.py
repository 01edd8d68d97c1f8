# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of a stage, made from its parameters: OK and Apply are one call of the macro interface each."""

from __future__ import annotations

import contextlib
import functools
import weakref
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError
from ...objects.fields import expressions, preferences
from ...objects.fields.link_targets import is_there
from ...objects.fields.rows import group_of, rows
from ...objects.shapes.chosen import is_warned
from ...objects.stage import Stage
from ...objects.work.progress import Cancelled
from .. import icons, recorded
from ..background.later import Later
from ..colours import PLAIN, WRONG
from ..picking.an_input import Input
from ..signals import connect
from ..texts.labels import without_key
from ..texts.translation import marked, tr, translated
from ..widgets import fields, suggestions
from ..widgets.fold import Fold
from ..widgets.messages import Messages
from ..widgets.upright import upright
from ..widgets.wheel import scrolls
from . import closing, parts, present, standing
from .noted import Noted, lines_of

ADVANCED = marked("{}: advanced")
BUTTON_PADDING = 26  # pixels beside its text
CLOSED = marked(
    "The document or object in this panel was deleted; cancel and open the panel again."
)


class StagePanel(Noted):
    """Inputs and parameters of a stage to be made (`obj` None) or changed. Nothing happens before OK or Apply.

    What is wrong is told under the field it belongs to, else at the top.
    """

    icon = function = ""  # where they are not called as the stage's kind is
    lines = 3  # that messages have room for above the fields
    draft = ""  # the name in errors of what is not made yet

    def __init__(
        self, proxy: type[Stage], title: str, choices: Sequence[Input], obj: Any = None
    ) -> None:
        self.proxy, self.choices, self.obj = proxy, choices, obj
        self.document = App.ActiveDocument if obj is None else obj.Document
        self.form = QtGui.QWidget()
        self.form.setObjectName(f"RoboticAM_{proxy.__name__}")
        self.form.setWindowTitle(without_key(title))
        self.form.setWindowIcon(QtGui.QIcon(icons.path(self.icon or proxy.kind.replace(" ", "_"))))
        self.column = QtGui.QVBoxLayout(self.form)
        self.column.setContentsMargins(2, 2, 2, 2)
        self.messages = Messages(self.lines)
        self.column.addWidget(self.messages)
        self.error = self.messages.add("error", WRONG)
        self.following = self.messages.add("following", WRONG)
        self.findings = self.messages.add(
            "findings", PLAIN
        )  # above all fields: some change what is deposited
        self.marked: dict[
            str, str
        ] = {}  # places with an error of OK or Apply, and what was entered there
        self.remarks: dict[
            str, str
        ] = {}  # those with what an expression gives or is wrong as typed, and that
        self.heading: Any = None
        self.notes: dict[
            str, Any
        ] = {}  # under the fields, by the label of an input or the place of a parameter
        if choices:
            self.heading = Fold(tr("Inputs"), obj is None)
            for choice in choices:
                self.notes[choice.label] = self.heading.add(choice.label, choice.widget)
                choice.tell = functools.partial(type(self).tell, weakref.proxy(self), choice.label)
            self.column.addWidget(self.heading.widget)
        self.first_inputs = self._inputs()
        # by the name that errors give a parameter: its field, how the panel calls it, where it is
        self.places: dict[str, tuple[fields.Field, str, Fold]] = {}
        for section in proxy.sections:
            self._add_section(section)
        self.column.addStretch(1)
        self._show_findings()
        if obj is not None:
            self.messages.hold(self.findings)
        self._watch_entries()
        self.known = (
            {} if obj is None else self._entries()
        )  # what the document had when it was shown last
        scrolls(self.form)
        upright(self.form)
        missing = [choice.missing for choice in choices if choice.missing]
        if obj is None and missing:
            self.say(missing[0])

    # ---- what is shown

    def _watch_entries(self) -> None:
        """Judge what is entered, now and a moment after it was typed."""
        self.later_entries = Later(self.form, self.judge_entries)
        widgets = [
            *(field.widget for field, _, _ in self.places.values()),
            *(choice.widget for choice in self.choices),
        ]
        for line in (line for widget in widgets for line in lines_of(widget)):
            connect(line, "textChanged(QString)", self.later_entries.ask)
        self.judge_entries()

    def _add_section(self, section: Any) -> None:
        current = None if self.obj is None else present.values_of(self.obj, section)
        folds: dict[str, Fold] = {}
        parted = parts.titles(rows(section.cls))
        for row in rows(section.cls):
            nested = isinstance(row.path[-1], str) and len(row.path) > 1
            title = group = group_of(row) if nested else section.group
            title = ADVANCED if row.spec.advanced else parted.get(row.key, title)
            if title not in folds:
                text = (
                    tr(ADVANCED).format(translated(section.group))
                    if title == ADVANCED
                    else translated(title)
                )
                folds[title] = Fold(text, title == section.group)
            value = (
                preferences.proposed(section.prefix, row) if current is None else current[row.key]
            )
            follows = "" if self.obj is None else expressions.of(self.obj, row)
            field = fields.make(
                row, value, suggestions.of(section.prefix, row.key), follows, section.prefix
            )
            if current is None and value != row.default:
                field.differs_from(row.default)
            if row.key in parted and value != row.default:
                folds[title].heading.setChecked(True)  # what is changed is seen
            self._mark_driven(field)
            own = group == section.group
            heading = field.heading if own or title == group else _in_group(group, field.heading)
            self.notes[f"{section.prefix}_{row.key}"] = folds[title].add(heading, field.widget)
            name = field.label if own else _in_group(group, field.label)
            self.places[f"{section.prefix}_{row.key}"] = (field, name, folds[title])
        for fold in folds.values():
            self.column.addWidget(fold.widget)

    def _mark_driven(self, field: fields.Field) -> None:
        """What the window cannot let follow an expression may do so all the same, from a macro: it is not changed here."""
        driven = dict(self.obj.ExpressionEngine) if self.obj is not None else {}
        expression = driven.get(field.row.name)
        if expression and field.row.form not in expressions.FOLLOW:
            field.widget.setEnabled(False)
            field.widget.setToolTip(tr("Driven by the expression {}").format(expression))

    def _show_findings(self) -> None:
        if self.obj is None:
            return
        self.findings.setText("\n".join(standing.own_lines(self.obj)))
        self.following.setText("\n".join(standing.lines_of_followers(self.obj)))
        self.following.setVisible(bool(self.following.text()))
        self.findings.show()

    def follow_undo(self) -> None:
        """Show what undo or redo has changed; what is entered elsewhere, and not applied, stays."""
        if self.obj is None:
            return
        if not is_there(self.obj):
            self.say(tr(CLOSED))
            return
        before, self.known = self.known, self._entries()
        fields_of = [(place, field) for place, (field, _, _) in self.places.items()]
        with contextlib.suppress(AmError, ReferenceError):  # an input that is gone is told by OK
            first, shown = self.first_inputs, self._inputs()
            present.show_other(fields_of, self.choices, before, self.known)
            self.first_inputs = {
                key: first[key] if key in first and shown.get(key) == text != first[key] else text
                for key, text in self._inputs().items()
            }
        self._show_findings()

    def _entries(self) -> dict[str, Any]:
        return present.entries(self.obj, self.proxy, self._stored())

    def _stored(self) -> dict[str, Any]:
        """What the object has of the inputs, by their labels."""
        return {choice.label: choice.stored(self.obj) for choice in self.choices}

    def _inputs(self) -> dict[str, str]:
        return {key: text for choice in self.choices for key, text in choice.arguments().items()}

    # ---- called by FreeCAD

    def getStandardButtons(self) -> int:
        """OK, Apply and Cancel."""
        buttons = QtGui.QDialogButtonBox
        return sum(_number(button) for button in (buttons.Ok, buttons.Apply, buttons.Cancel))

    def modifyStandardButtons(self, box: Any) -> None:
        """Let three buttons be as narrow as two: the task panel would be cut off on the right."""
        QtCore.QTimer.singleShot(0, lambda: _narrow(box))  # once they have their texts

    def clicked(self, button: Any) -> None:
        """One of them was clicked; OK and Cancel have functions of their own."""
        if _number(button) == _number(QtGui.QDialogButtonBox.Apply):
            self.apply()

    def accept(self) -> bool:
        """Make or change the stage; True closes the panel, an error is shown in it."""
        return self._carry_out()

    def apply(self) -> bool:
        """Make or change the stage and keep the panel open, as that of the stage; a step of undo of its own."""
        before = set() if self.obj is not None else {obj.Name for obj in self.document.Objects}
        if not self._carry_out():
            return False
        if self.obj is None:
            made = [
                obj
                for obj in self.document.Objects
                if obj.Name not in before and type(obj.Proxy) is self.proxy
            ]
            self.obj = made[-1]
            self.form.setWindowTitle(without_key(self.obj.Label))
        for field, _, _ in self.places.values():
            field.applied()
        for choice in self.choices:
            choice.applied()
        self.first_inputs = self._inputs()
        self.known = self._entries()
        self._show_findings()
        return True

    def _carry_out(self) -> bool:
        """Do what is entered, in one step of undo; False where it is refused, which is told."""
        self.say("")
        for place in self.marked:
            self.tell(place, "")
        self.marked.clear()
        try:
            chosen = self._inputs()
            changed = self._changed()
            if self.obj is None:
                function = self.function or f"make_{self.proxy.kind.replace(' ', '_')}"
                recorded.make(self.document, function, {**chosen, **changed})
            elif changed or chosen != self.first_inputs or is_warned(self.obj):
                # what is no longer what was chosen is confirmed by OK, where nothing else was entered
                inputs = chosen if chosen != self.first_inputs or not changed else {}
                recorded.change(self.obj, {**inputs, **changed})
        except AmError as error:
            self.tell_error(error)
        except Cancelled:
            self.say(tr("Cancelled: the document is unchanged."))
        except ReferenceError:
            self.say(tr(CLOSED))
        else:
            return True
        return False

    def _changed(self) -> dict[str, str]:
        """Arguments of what was changed by keyword. Raises InputError named as a parameter is, not as a field."""
        found = {}
        for place, (field, _, _) in self.places.items():
            try:
                if field.changed:
                    found[field.row.key] = repr(field.value)
            except InputError as error:
                raise InputError(error.code, place, error.message) from None
        return found

    def reject(self) -> bool:
        """Nothing was done since the last Apply, so nothing is taken back."""
        return True


def _in_group(group: str, label: str) -> str:
    """A label that is read away from the heading of its group: 'Trigger, lead' of 'Lead'."""
    return tr("{}, {}").format(translated(group), label[:1].lower() + label[1:])


def _narrow(box: Any) -> None:
    with contextlib.suppress(RuntimeError):  # the panel is closed again
        for button in box.buttons():
            button.setIcon(QtGui.QIcon())
            if QtGui.QApplication.instance().styleSheet():  # which may pad them beyond their width
                button.setStyleSheet("QPushButton { padding: 2px; min-width: 0px; }")
            button.setFixedWidth(
                button.fontMetrics().boundingRect(button.text()).width() + BUTTON_PADDING
            )


def _number(button: Any) -> int:
    return int(getattr(button, "value", button))  # an enumeration of Qt 6


def show(panel: Any) -> None:
    """Open a task panel, unless another one is open."""
    if Gui.Control.activeDialog():
        App.Console.PrintWarning(tr("Another task panel is open; close it first.") + "\n")
        return
    Gui.Control.showDialog(panel)
    closing.with_document(panel)
