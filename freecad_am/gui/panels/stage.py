# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of a stage, built from its parameters. OK and Apply are one call of the macro
interface each.
"""

from __future__ import annotations

import contextlib
import functools
import weakref
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any
from weakref import WeakMethod

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ... import api
from ...core.issues import AmError, InputError, summarised, values_in
from ...core.parameters.field import check_value
from ...objects.fields import preferences
from ...objects.fields.rows import FOLLOW, Row, evaluated, group_of, is_expression, of, rows
from ...objects.results.findings import issues_of, message_of, reason_of
from ...objects.shapes.chosen import is_warned
from ...objects.shapes.containers import is_there
from ...objects.stage import Stage
from ...objects.staleness import FAILED, INFEASIBLE
from ...objects.work.progress import Cancelled
from .. import icons, recorded
from ..colours import INVALID, PLAIN, set_role
from ..in_language import escape_mnemonic, marked, tr, translated, translated_error
from ..signals import connect
from ..widgets import fields, suggestions
from ..widgets.fields import Field
from ..widgets.fold import Fold, Messages
from ..widgets.pick_field import Input
from ..widgets.upright import present, scroll_areas_of, scrolls, upright
from ..worker import Later

# ---- Problems of a panel's entries, under their fields or else at the top


class Noted:
    """Fields with a note under each; a panel fills them in."""

    draft = ""  # name of an object to be created, in errors
    proxy: type[Stage]
    choices: Sequence[Input]
    obj: Any
    document: Any
    form: Any
    messages: Messages
    error: Any  # at the top
    heading: Any  # heading of the inputs
    marked: dict[str, str]  # entries with an error from OK or Apply, by key
    remarks: dict[str, str]  # notes with the value of an expression or a typing error, by key
    notes: dict[str, Any]  # notes under the fields, by input label or parameter key
    places: dict[
        str, tuple[fields.Field, str, Fold]
    ]  # field, displayed name and section, by the parameter name in errors

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
        """Show an error under its field, scroll to the field and focus it; otherwise show it at the
        top.
        """
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
        """Return key ('' for none) and text of the note for an error."""
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
        """Return the names of the stage in errors: its label, and its names as a draft and in a
        preview.
        """
        return [
            self.draft,
            self.proxy.kind.capitalize(),
            *([] if self.obj is None else [self.obj.Label]),
        ]

    def leave_out(self, keys: Collection[str], also_entered: bool = False) -> None:
        """Show all fields except `keys`. A field with an entry stays visible unless `also_entered`."""
        for key, (field, _, fold) in self.places.items():
            default = field.row.outer(field.row.default)  # some fields hold None as a text, too
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
        """Show the value or problem of each expression under its field; clear errors of changed
        entries.
        """
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
        """Return the value of a field's expression or the problem of its entry; None without
        either.
        """
        try:
            value = field.value
            if field.row.form not in FOLLOW:
                return None
            if is_expression(value):
                result = self._evaluated(field, value)
                return f"= {getattr(result, 'UserString', result)}", False
            check_value(field.row.spec, field.row.inner(value, field.label), field.label)
        except InputError as error:
            return translated(error.message), True
        return None

    def _evaluated(self, field: fields.Field, value: str) -> Any:
        """Return an expression's current value in the unit of a plain entry."""
        around = self.obj if self.obj is not None else next(iter(self.document.Objects), None)
        result = evaluated(value, around, field.label)
        field.row.inner(result, field.label)  # rejects other dimensions
        return result


def lines_of(widget: Any) -> list[Any]:
    """Return the line edits of a field: the field itself or its children."""
    return [widget] if isinstance(widget, QtGui.QLineEdit) else present(widget, QtGui.QLineEdit)


def _bring_into_sight(form: Any, widget: Any) -> None:
    """Scroll the task panel to a widget in it."""
    with contextlib.suppress(RuntimeError):  # the panel is already deleted
        for area in scroll_areas_of(form):
            if widget is not None and area.isVisible():
                area.ensureWidgetVisible(widget)


# ---- The task panel

_DELETED_ERRORS = (RuntimeError, ReferenceError, NameError)


class Watch:
    """Observer of documents. It refers only to the panel's widget, which FreeCAD deletes with the
    panel.
    """

    def __init__(self) -> None:
        self.form: Any = None
        self.document = ""
        self.follow_undo: Callable[[], Callable[[], None] | None] = lambda: (
            None
        )  # returns the method while the panel exists

    def slotDeletedDocument(self, document: Any) -> None:
        """Close the panel after its document is deleted."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._close)

    def slotUndoDocument(self, document: Any) -> None:
        """Update the panel after FreeCAD has finished an undo or redo."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._follow)

    slotRedoDocument = slotUndoDocument

    def _follow(self) -> None:
        follow = self.follow_undo()
        with contextlib.suppress(*_DELETED_ERRORS):  # the panel is already closed
            if self.form is not None and follow is not None:
                follow()

    def _close(self) -> None:
        form, self.form = self.form, None
        with contextlib.suppress(*_DELETED_ERRORS):  # the panel is already closed
            if form is not None and form.window() is not form and Gui.Control.activeDialog():
                Gui.Control.closeDialog()

    def forget(self, *_: Any) -> None:
        """Forget the closed panel."""
        self.form = None


_watches: list[Watch] = []


def close_with_document(panel: Any) -> None:
    """Close a panel that was just opened when its document is closed."""
    if not _watches:
        _watches.append(Watch())
        App.addDocumentObserver(_watches[0])
    watch = _watches[0]
    watch.form, watch.document = (
        panel.form,
        panel.document.Name if panel.document is not None else "",
    )
    follow = getattr(panel, "follow_undo", None)
    watch.follow_undo = (lambda: None) if follow is None else WeakMethod(follow)
    panel.form.destroyed.connect(watch.forget)


MOST_ISSUES = 6


def own_lines(obj: Any) -> list[str]:
    """Return the status of a stage, its message and its issues."""
    issues = summarised(issues_of(obj))
    message = [translated(message_of(obj))] if obj.Message and not issues else []
    lines = [
        tr("{}: {}").format(
            " ".join(filter(None, (translated(issue.level), translated(issue.where)))),
            translated(issue.message),
        )
        for issue in issues
    ]
    return [tr("Status: {}").format(translated(obj.Status)), *message, *_first(lines)]


def lines_of_followers(obj: Any) -> list[str]:
    """Return which following stages failed or are infeasible, and why; stages that only wait are
    omitted.
    """
    followers = set(obj.InListRecursive)
    wrong = [
        stage
        for stage in api.stages_of(obj.Document)
        if stage.Status in (FAILED, INFEASIBLE) and (stage is obj or stage in followers)
    ]
    causes = [
        stage
        for stage in wrong
        if stage is not obj and not set(stage.OutListRecursive) & set(wrong)
    ]
    texts = {FAILED: tr("{} failed: {}"), INFEASIBLE: tr("{} is infeasible: {}")}
    return _first(
        [texts[stage.Status].format(stage.Label, translated(reason_of(stage))) for stage in causes]
    )


def _first(lines: list[str]) -> list[str]:
    """Return as many lines as fit, and the number of hidden lines."""
    hidden_count = len(lines) - MOST_ISSUES
    return (
        lines
        if hidden_count <= 0
        else [*lines[:MOST_ISSUES], tr("and {} more").format(hidden_count)]
    )


MIN_FIELDS_TO_DIVIDE = 12  # minimum number of basic fields for which a section is divided
PARTS = {
    marked("Filling in detail"): (
        "spacing_range_low",
        "spacing_range_high",
        "fill_density",
        "solid_layers",
        "fill_angle",
        "fill_angle_step",
        "contour",
        "walls",
        "margin",
        "thin",
    ),
    marked("Order and waits"): ("starts", "order", "wait", "min_layer_time", "deflection"),
    marked("Starts and ends of beads"): ("lead_on", "lead_off", "overlap", "retreat"),
}
_TITLES = {key: title for title, keys in PARTS.items() for key in keys}


def titles(rows: Sequence[Row]) -> dict[str, str]:
    """Return the heading of each field that belongs under a heading, by key; empty for short
    sections.
    """
    section_rows = [row for row in rows if len(row.path) == 1 or not isinstance(row.path[-1], str)]
    if len([row for row in section_rows if not row.spec.advanced]) < MIN_FIELDS_TO_DIVIDE:
        return {}
    return {
        row.key: _TITLES[row.key]
        for row in section_rows
        if row.key in _TITLES and not row.spec.advanced
    }


def values_of(obj: Any, section: Any) -> dict[str, Any]:
    """Return the inner values of a stage's section, by row key."""
    values = {}
    for row in rows(section.cls):
        try:
            values[row.key] = row.inner(getattr(obj, row.name), row.name)
        except AmError:  # an unreadable value is replaced by its default
            values[row.key] = row.default
    return values


def entries(obj: Any, proxy: type[Stage], inputs: dict[str, Any]) -> dict[str, Any]:
    """Return the field values of a panel for an object: parameters by key, in outer units or as
    their expression, and inputs by label.
    """
    shown_values = dict(inputs)
    for section in proxy.sections:
        values = values_of(obj, section)
        for row in rows(section.cls):
            shown_values[f"{section.prefix}_{row.key}"] = _expression_of(obj, row) or row.outer(
                values[row.key]
            )
    return shown_values


def show_other(
    fields: Iterable[tuple[str, Field]],
    choices: Sequence[Input],
    previous: dict[str, Any],
    now: dict[str, Any],
) -> None:
    """Show changed values; keep other entries."""
    for key, field in fields:
        if now[key] != previous[key]:
            field.show(now[key])
            field.applied()
    for choice in choices:
        if now[choice.label] != previous[choice.label]:
            choice.show_stored(now[choice.label])
            choice.applied()


def _expression_of(obj: Any, row: Row) -> str:
    return of(obj, row) if row.form in FOLLOW else ""


ADVANCED = marked("{}: advanced")
BUTTON_PADDING = 26  # pixels next to the button text
CLOSED = marked(
    "The document or object in this panel was deleted; cancel and open the panel again."
)


class StagePanel(Noted):
    """Inputs and parameters of a stage to create (`obj` None) or change.

    Nothing happens before OK or Apply. A problem is shown under its field, otherwise at the top.
    """

    icon = function = ""  # set where the names differ from the stage's kind
    lines = 3  # lines reserved for messages above the fields
    draft = ""  # name of an object to be created, in errors

    def __init__(
        self, proxy: type[Stage], title: str, choices: Sequence[Input], obj: Any = None
    ) -> None:
        self.proxy, self.choices, self.obj = proxy, choices, obj
        self.document = App.ActiveDocument if obj is None else obj.Document
        self.form = QtGui.QWidget()
        self.form.setObjectName(f"RoboticAM_{proxy.__name__}")
        self.form.setWindowTitle(escape_mnemonic(title))
        self.form.setWindowIcon(QtGui.QIcon(icons.path(self.icon or proxy.kind.replace(" ", "_"))))
        self.column = QtGui.QVBoxLayout(self.form)
        self.column.setContentsMargins(2, 2, 2, 2)
        self.messages = Messages(self.lines)
        self.column.addWidget(self.messages)
        self.error = self.messages.add("error", INVALID)
        self.following = self.messages.add("following", INVALID)
        self.findings = self.messages.add(
            "findings", PLAIN
        )  # above all fields, because some findings change the deposit
        self.marked: dict[str, str] = {}  # entries with an error from OK or Apply, by key
        self.remarks: dict[
            str, str
        ] = {}  # notes with the value of an expression or a typing error, by key
        self.heading: Any = None
        self.notes: dict[str, Any] = {}  # notes under the fields, by input label or parameter key
        if choices:
            self.heading = Fold(tr("Inputs"), obj is None)
            for choice in choices:
                self.notes[choice.label] = self.heading.add(choice.label, choice.widget)
                choice.show_note = functools.partial(
                    type(self).show_note, weakref.proxy(self), choice.label
                )
            self.column.addWidget(self.heading.widget)
        self.first_inputs = self._inputs()
        # field, displayed name and section, by the parameter name in errors
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
        )  # the document's values when they were last shown
        scrolls(self.form)
        upright(self.form)
        missing = [choice.missing for choice in choices if choice.missing]
        if obj is None and missing:
            self.say(missing[0])

    # ---- display

    def _watch_entries(self) -> None:
        """Check the entries now and shortly after typing."""
        self.later_entries = Later(self.form, self.judge_entries)
        widgets = [
            *(field.widget for field, _, _ in self.places.values()),
            *(choice.widget for choice in self.choices),
        ]
        for line in (line for widget in widgets for line in lines_of(widget)):
            connect(line, "textChanged(QString)", self.later_entries.ask)
        self.judge_entries()

    def _add_section(self, section: Any) -> None:
        current = None if self.obj is None else values_of(self.obj, section)
        folds: dict[str, Fold] = {}
        parted = titles(rows(section.cls))
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
            follows = "" if self.obj is None else of(self.obj, row)
            field = fields.make(
                row, value, suggestions.of(section.prefix, row.key), follows, section.prefix
            )
            if current is None and value != row.default:
                field.differs_from(row.default)
            if row.key in parted and value != row.default:
                folds[title].heading.setChecked(True)  # show changed fields
            self._mark_driven(field)
            is_direct = group == section.group
            heading = (
                field.heading if is_direct or title == group else _in_group(group, field.heading)
            )
            self.notes[f"{section.prefix}_{row.key}"] = folds[title].add(heading, field.widget)
            name = field.label if is_direct else _in_group(group, field.label)
            self.places[f"{section.prefix}_{row.key}"] = (field, name, folds[title])
        for fold in folds.values():
            self.column.addWidget(fold.widget)

    def _mark_driven(self, field: fields.Field) -> None:
        """Lock a field whose expression, such as one from a macro, the window cannot edit."""
        driven = dict(self.obj.ExpressionEngine) if self.obj is not None else {}
        expression = driven.get(field.row.name)
        if expression and field.row.form not in FOLLOW:
            field.widget.setEnabled(False)
            field.widget.setToolTip(tr("Driven by the expression {}").format(expression))

    def _show_findings(self) -> None:
        if self.obj is None:
            return
        self.findings.setText("\n".join(own_lines(self.obj)))
        self.following.setText("\n".join(lines_of_followers(self.obj)))
        self.following.setVisible(bool(self.following.text()))
        self.findings.show()

    def follow_undo(self) -> None:
        """Show changes of undo and redo; keep entries that are not applied."""
        if self.obj is None:
            return
        if not is_there(self.obj):
            self.say(tr(CLOSED))
            return
        previous, self.known = self.known, self._entries()
        fields_of = [(name, field) for name, (field, _, _) in self.places.items()]
        with contextlib.suppress(AmError, ReferenceError):  # OK reports a deleted input
            stored_inputs, current_inputs = self.first_inputs, self._inputs()
            show_other(fields_of, self.choices, previous, self.known)
            self.first_inputs = {
                key: stored_inputs[key]
                if key in stored_inputs and current_inputs.get(key) == text != stored_inputs[key]
                else text
                for key, text in self._inputs().items()
            }
        self._show_findings()

    def _entries(self) -> dict[str, Any]:
        return entries(self.obj, self.proxy, self._stored())

    def _stored(self) -> dict[str, Any]:
        """Return the object's stored inputs by label."""
        return {choice.label: choice.stored(self.obj) for choice in self.choices}

    def _inputs(self) -> dict[str, str]:
        return {key: text for choice in self.choices for key, text in choice.arguments().items()}

    # ---- called by FreeCAD

    def getStandardButtons(self) -> int:
        """Return OK, Apply and Cancel."""
        buttons = QtGui.QDialogButtonBox
        return sum(_number(button) for button in (buttons.Ok, buttons.Apply, buttons.Cancel))

    def modifyStandardButtons(self, box: Any) -> None:
        """Make the three buttons as narrow as two; otherwise the task panel would be cut off on the
        right.
        """
        QtCore.QTimer.singleShot(0, lambda: _narrow(box))  # after the buttons have their texts

    def clicked(self, button: Any) -> None:
        """Handle a clicked button; OK and Cancel have their own functions."""
        if _number(button) == _number(QtGui.QDialogButtonBox.Apply):
            self.apply()

    def accept(self) -> bool:
        """Create or change the stage; return True to close the panel, or show an error in it."""
        return self._carry_out()

    def apply(self) -> bool:
        """Create or change the stage in one undo step and keep the panel open."""
        old_names = set() if self.obj is not None else {obj.Name for obj in self.document.Objects}
        if not self._carry_out():
            return False
        if self.obj is None:
            new_objects = [
                obj
                for obj in self.document.Objects
                if obj.Name not in old_names and type(obj.Proxy) is self.proxy
            ]
            self.obj = new_objects[-1]
            self.form.setWindowTitle(escape_mnemonic(self.obj.Label))
        for field, _, _ in self.places.values():
            field.applied()
        for choice in self.choices:
            choice.applied()
        self.first_inputs = self._inputs()
        self.known = self._entries()
        self._show_findings()
        return True

    def _carry_out(self) -> bool:
        """Apply the entries in one undo step; on rejection report it and return False."""
        self.say("")
        for key in self.marked:
            self.show_note(key, "")
        self.marked.clear()
        try:
            current_inputs = self._inputs()
            changed = self._changed()
            if self.obj is None:
                function = self.function or f"make_{self.proxy.kind.replace(' ', '_')}"
                recorded.make(self.document, function, {**current_inputs, **changed})
            elif changed or current_inputs != self.first_inputs or is_warned(self.obj):
                # OK confirms a replaced input if nothing else was entered
                inputs = (
                    current_inputs if current_inputs != self.first_inputs or not changed else {}
                )
                recorded.change(self.obj, {**inputs, **changed})
        except AmError as error:
            self.show_error(error)
        except Cancelled:
            self.say(tr("Cancelled: the document is unchanged."))
        except ReferenceError:
            self.say(tr(CLOSED))
        else:
            return True
        return False

    def _changed(self) -> dict[str, str]:
        """Return the arguments of changed fields by keyword. An InputError names the parameter, not
        the field.
        """
        arguments = {}
        for key, (field, _, _) in self.places.items():
            try:
                if field.changed:
                    arguments[field.row.key] = repr(field.value)
            except InputError as error:
                raise InputError(error.code, key, error.message) from None
        return arguments

    def reject(self) -> bool:
        """Close the panel; nothing has changed since the last Apply, so nothing is reverted."""
        return True


def _in_group(group: str, label: str) -> str:
    """Return a label for use outside its group: 'Trigger, lead' for 'Lead'."""
    return tr("{}, {}").format(translated(group), label[:1].lower() + label[1:])


def _narrow(box: Any) -> None:
    with contextlib.suppress(RuntimeError):  # the panel is already closed
        for button in box.buttons():
            button.setIcon(QtGui.QIcon())
            if QtGui.QApplication.instance().styleSheet():  # may pad the buttons too much
                button.setStyleSheet("QPushButton { padding: 2px; min-width: 0px; }")
            button.setFixedWidth(
                button.fontMetrics().boundingRect(button.text()).width() + BUTTON_PADDING
            )


def _number(button: Any) -> int:
    return int(getattr(button, "value", button))  # an enumeration in Qt 6


def show(panel: Any) -> None:
    """Open a task panel, unless another one is open."""
    if Gui.Control.activeDialog():
        App.Console.PrintWarning(tr("Another task panel is open; close it first.") + "\n")
        return
    Gui.Control.showDialog(panel)
    close_with_document(panel)
