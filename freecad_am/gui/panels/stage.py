# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of a stage, made from its parameters: OK and Apply are one call of the macro interface each."""

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

# ---- Problems of a panel's entries, under their fields, else at the top


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
        """An expression's value now, in the unit that a plain entry would have."""
        around = self.obj if self.obj is not None else next(iter(self.document.Objects), None)
        result = evaluated(value, around, field.label)
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


# ---- The task panel

_DELETED_ERRORS = (RuntimeError, ReferenceError, NameError)


class Watch:
    """Observer of documents. It refers only to the panel's widget, which FreeCAD deletes with the panel."""

    def __init__(self) -> None:
        self.form: Any = None
        self.document = ""
        self.follow_undo: Callable[[], Callable[[], None] | None] = lambda: (
            None
        )  # gives it as long as the panel is there

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is about to go; once it is gone, so does the panel."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._close)

    def slotUndoDocument(self, document: Any) -> None:
        """Something was undone or done again; once FreeCAD is through with it, the panel shows that."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._follow)

    slotRedoDocument = slotUndoDocument

    def _follow(self) -> None:
        follow = self.follow_undo()
        with contextlib.suppress(*_DELETED_ERRORS):  # it is closed already
            if self.form is not None and follow is not None:
                follow()

    def _close(self) -> None:
        form, self.form = self.form, None
        with contextlib.suppress(*_DELETED_ERRORS):  # it is closed already
            if form is not None and form.window() is not form and Gui.Control.activeDialog():
                Gui.Control.closeDialog()

    def forget(self, *_: Any) -> None:
        """The panel is closed."""
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
    """The status of a stage, its message and its findings."""
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
    """Which of the stages that follow failed or cannot be carried out, and why; none that only waits for another one."""
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
    """As many lines as there is room for, and how many more there are."""
    hidden_count = len(lines) - MOST_ISSUES
    return (
        lines
        if hidden_count <= 0
        else [*lines[:MOST_ISSUES], tr("and {} more").format(hidden_count)]
    )


MIN_FIELDS_TO_DIVIDE = 12  # fields of a section that are not advanced, from which on it is divided
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
    """The heading of each field of a section that is put under one, by its key; none of short sections."""
    section_rows = [row for row in rows if len(row.path) == 1 or not isinstance(row.path[-1], str)]
    if len([row for row in section_rows if not row.spec.advanced]) < MIN_FIELDS_TO_DIVIDE:
        return {}
    return {
        row.key: _TITLES[row.key]
        for row in section_rows
        if row.key in _TITLES and not row.spec.advanced
    }


def values_of(obj: Any, section: Any) -> dict[str, Any]:
    """Inner values of a section of a stage by row key."""
    values = {}
    for row in rows(section.cls):
        try:
            values[row.key] = row.inner(getattr(obj, row.name), row.name)
        except AmError:  # what cannot be read is replaced by its default
            values[row.key] = row.default
    return values


def entries(obj: Any, proxy: type[Stage], inputs: dict[str, Any]) -> dict[str, Any]:
    """What the fields of a panel show of an object: parameters by place, in outer units or as the expression that they
    follow, and inputs by label."""
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
BUTTON_PADDING = 26  # pixels next to its text
CLOSED = marked(
    "The document or object in this panel was deleted; cancel and open the panel again."
)


class StagePanel(Noted):
    """Inputs and parameters of a stage to create (`obj` None) or changed. Nothing happens before OK or Apply.

    A problem is shown under its field, else at the top.
    """

    icon = function = ""  # where they are not called as the stage's kind is
    lines = 3  # that messages have room for above the fields
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
        )  # above all fields, because some change the deposit
        self.marked: dict[str, str] = {}  # keys with an error from OK or Apply, and their entries
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
                choice.show_note = functools.partial(
                    type(self).show_note, weakref.proxy(self), choice.label
                )
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

    # ---- display

    def _watch_entries(self) -> None:
        """Judge the entries now and shortly after typing."""
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
        """Handle a clicked button; OK and Cancel have their own functions."""
        if _number(button) == _number(QtGui.QDialogButtonBox.Apply):
            self.apply()

    def accept(self) -> bool:
        """Make or change the stage; True closes the panel, an error is shown in it."""
        return self._carry_out()

    def apply(self) -> bool:
        """Make or change the stage in one undo step and keep the panel open."""
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
        """Return the arguments of changed fields by keyword. An InputError names the parameter, not the field."""
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
    close_with_document(panel)
