# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of a stage, made from its parameters: OK is one call of the macro interface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..core.issues import AmError, InputError
from ..objects.rows import rows
from ..objects.stage import Stage, issues_of
from . import fields, icons, inputs, recorded, suggestions
from .colours import WRONG
from .fold import Fold

MOST_ISSUES = 6
CLOSED = "The document or object of this panel is gone; cancel and open the panel again."


class StagePanel:
    """Inputs and parameters of a stage to be made (`obj` None) or changed. Nothing happens before OK."""

    icon = function = ""  # where they are not called as the stage's kind is

    def __init__(self, proxy: type[Stage], title: str, choices: Sequence[inputs.Input], obj: Any = None) -> None:
        self.proxy, self.choices, self.obj = proxy, choices, obj
        self.document = App.ActiveDocument if obj is None else obj.Document
        self.form = QtGui.QWidget()
        self.form.setObjectName(f"RoboticAM_{proxy.__name__}")
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(QtGui.QIcon(icons.path(self.icon or proxy.kind.replace(" ", "_"))))
        self.column = QtGui.QVBoxLayout(self.form)
        self.column.setContentsMargins(2, 2, 2, 2)
        self.error = self._note("error", WRONG)
        self.notes: dict[str, Any] = {}  # under the fields, by the label of an input or the place of a parameter
        if choices:
            heading = Fold("Inputs", obj is None)
            for choice in choices:
                self.notes[choice.label] = heading.add(choice.label, choice.widget)
            self.column.addWidget(heading.widget)
        self.first_inputs = self._inputs()
        # by the name that errors give a parameter: its field, how the panel calls it, where it is
        self.places: dict[str, tuple[fields.Field, str, Fold]] = {}
        for section in proxy.sections:
            self._add_section(section)
        self.findings = self._note("findings", "palette(text)")
        self.column.addStretch(1)
        self._show_findings()
        missing = [choice.missing for choice in choices if choice.missing]
        if obj is None and missing:
            self.say(missing[0])

    # ---- what is shown

    def _note(self, name: str, colour: str) -> Any:
        label = QtGui.QLabel()
        label.setObjectName(name)
        label.setWordWrap(True)
        label.setStyleSheet(f"QLabel {{ color: {colour}; }}")
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        label.hide()
        self.column.addWidget(label)
        return label

    def _add_section(self, section: Any) -> None:
        current = None if self.obj is None else self._current(section)
        folds: dict[str, Fold] = {}
        for row in rows(section.cls):
            nested = isinstance(row.path[-1], str) and len(row.path) > 1
            title = str(row.path[0]).replace("_", " ").capitalize() if nested else section.group
            title = f"{section.group}: advanced" if row.spec.advanced else title
            if title not in folds:
                folds[title] = Fold(title, title == section.group)
            value = row.default if current is None else current[row.key]
            field = fields.make(row, value, suggestions.of(section.prefix, row.key))
            self._mark_driven(field)
            self.notes[f"{section.prefix}_{row.key}"] = folds[title].add(field.label, field.widget)
            name = field.label if title == section.group or row.spec.advanced else f"{title}, {field.label.lower()}"
            self.places[f"{section.prefix}_{row.key}"] = (field, name, folds[title])
        for fold in folds.values():
            self.column.addWidget(fold.widget)

    def _current(self, section: Any) -> dict[str, Any]:
        found = {}
        for row in rows(section.cls):
            try:
                found[row.key] = row.inner(getattr(self.obj, row.name), row.name)
            except AmError:  # what cannot be read is replaced by its default
                found[row.key] = row.default
        return found

    def _mark_driven(self, field: fields.Field) -> None:
        driven = dict(self.obj.ExpressionEngine) if self.obj is not None else {}
        expression = driven.get(field.row.name)
        if expression:
            field.widget.setEnabled(False)
            field.widget.setToolTip(f"Driven by the expression {expression}")

    def _show_findings(self) -> None:
        if self.obj is None:
            return
        found = issues_of(self.obj)
        lines = [self.obj.Message] if self.obj.Message and not found else []
        lines += [f"{' '.join(filter(None, (issue.level, issue.where)))}: {issue.message}" for issue in found[:MOST_ISSUES]]
        if len(found) > MOST_ISSUES:
            lines.append(f"and {len(found) - MOST_ISSUES} more")
        self.findings.setText("\n".join([f"Status: {self.obj.Status}", *lines]))
        self.findings.show()

    def _inputs(self) -> dict[str, str]:
        return {key: text for choice in self.choices for key, text in choice.arguments().items()}

    def say(self, text: str) -> None:
        """Show what is wrong."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Make or change the stage; True closes the panel, an error is shown in it."""
        self.say("")
        try:
            chosen = self._inputs()
            changed = self._changed()
            if self.obj is None:
                function = self.function or f"make_{self.proxy.kind.replace(' ', '_')}"
                recorded.make(self.document, function, {**chosen, **changed})
            elif changed or chosen != self.first_inputs:
                recorded.change(self.obj, {**(chosen if chosen != self.first_inputs else {}), **changed})
        except AmError as error:
            self.say(self._told(error))
        except ReferenceError:
            self.say(CLOSED)
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

    def _told(self, error: AmError) -> str:
        """The error with the name the panel gives the field, which is unfolded."""
        place = error.where.replace(".", "_")
        if place not in self.places:
            return str(error)
        _, name, fold = self.places[place]
        fold.heading.setChecked(True)
        return f"{name}: {error.message}"

    def reject(self) -> bool:
        """Nothing was done, so nothing is taken back."""
        return True


def show(panel: Any) -> None:
    """Open a task panel, unless another one is open."""
    if Gui.Control.activeDialog():
        App.Console.PrintWarning("Another task panel is open; close it first.\n")
        return
    Gui.Control.showDialog(panel)


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    own = _own_panel(type(obj.Proxy))
    if own is not None:
        show(own(obj))
        return
    choices = inputs.of(type(obj.Proxy), obj)
    if obj.Proxy.kind == "program":
        choices.append(inputs.NameChoice(obj.ProgramName))
    show(StagePanel(type(obj.Proxy), obj.Label, choices, obj))


def _own_panel(proxy: type[Stage]) -> Any:
    """The panel of a stage that has one of its own, else None."""
    from . import cell_panel, hub_panel, toolpath_panel, wall_panel

    own = (hub_panel.HubPanel, wall_panel.WallPanel, cell_panel.CellPanel, toolpath_panel.ToolpathPanel)
    return next((panel for panel in own if panel.stage is proxy), None)
