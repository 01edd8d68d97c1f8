# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of Edit > Preferences > Robotic AM."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ..core.issues import InputError
from ..core.kinematics.machines import machine
from ..objects import user_machines
from ..objects.fields import preferences
from ..objects.fields.rows import MIXED
from ..posts import catalogue
from .in_language import tr, translated
from .widgets import choices, fields


class PreferencesPage:
    """The page, created once per opening of the dialog."""

    def __init__(self, *_: Any) -> None:
        self.form = QtGui.QWidget()
        self.form.setObjectName("RoboticAM_Preferences")
        self.form.setWindowTitle(tr("General"))
        self.column = QtGui.QVBoxLayout(self.form)
        note = QtGui.QLabel(
            tr(
                "Defaults and appearance of the window for new objects. Existing documents, jobs "
                "and macros do not depend on these settings."
            )
        )
        note.setWordWrap(True)
        self.column.addWidget(note)
        self._new_work()
        self._process()
        self._folders()
        self._add_appearance()
        self.column.addStretch(1)

    def _group(self, title: str) -> Any:
        box = QtGui.QGroupBox(title)
        self.column.addWidget(box)
        return QtGui.QFormLayout(box)

    def _new_work(self) -> None:
        rows = self._group(tr("New jobs and cells"))
        self.machine = QtGui.QComboBox()
        self.machine.setObjectName("machine")
        self.machine.setEditable(True)
        choices.offer(self.machine, choices.machines())
        self.post = QtGui.QComboBox()
        self.post.setObjectName("post")
        self.post.addItem(tr("from the controller of the machine"), "")
        for name in catalogue.NAMES:
            self.post.addItem(name, name)
        rows.addRow(tr("Machine"), self.machine)
        rows.addRow(tr("Post"), self.post)

    def _process(self) -> None:
        rows = self._group(tr("Process of new toolpaths"))
        preferred = preferences.process()
        self.process = {}
        for row in preferences.process_rows():
            value = row.inner(preferred[row.key], row.name) if row.key in preferred else row.default
            field = fields.make(row, value, section="process")
            _remove_expression_action(field.widget)
            rows.addRow(translated(preferences.label(row)), field.widget)
            self.process[row.key] = field

    def _folders(self) -> None:
        rows = self._group(tr("Folders"))
        self.machines = self._folder(
            rows,
            "machineFolder",
            tr("Machine files"),
            tr(
                "Additional folder of machine files, such as a shared folder; your own machine "
                "files are in {}"
            ).format(os.path.join("RoboticAM", "machines")),
        )
        self.programs = self._folder(
            rows,
            "programsFolder",
            tr("Programs"),
            tr("Default folder for programs; empty for the last folder, or next to the document"),
        )

    def _folder(self, rows: Any, name: str, label: str, help: str) -> Any:
        line, edit, button = (
            QtGui.QHBoxLayout(),
            QtGui.QLineEdit(),
            QtGui.QPushButton(tr("Browse…")),
        )
        edit.setObjectName(name)
        edit.setToolTip(help)
        button.setAutoDefault(False)

        def browse(*_: Any) -> None:
            folder = QtGui.QFileDialog.getExistingDirectory(self.form, label, edit.text())
            if folder:
                edit.setText(folder)

        button.clicked.connect(browse)
        line.addWidget(edit, 1)
        line.addWidget(button)
        rows.addRow(label, line)
        return edit

    def _add_appearance(self) -> None:
        rows = self._group(tr("Looks"))
        self.unit, self.ramp = QtGui.QComboBox(), QtGui.QComboBox()
        self.unit.setObjectName("speedUnit")
        self.unit.setToolTip(
            tr("For speeds in fields and read-outs; typed values may use any unit")
        )
        self.unit.addItem(tr("as FreeCAD shows speeds"), "")
        for unit in preferences.SPEED_UNITS:
            self.unit.addItem(unit, unit)
        self.ramp.setObjectName("ramp")
        self.ramp.setToolTip(tr("For paths, from the smallest to the largest value"))
        names = (tr("blue to yellow"), tr("violet to orange"), tr("grey"))
        for key, text in zip(preferences.RAMPS, names, strict=True):
            self.ramp.addItem(text, key)
        self.colour = Gui.UiLoader().createWidget("Gui::ColorButton")
        self.colour.setObjectName("machineColour")
        rows.addRow(tr("Unit of speeds"), self.unit)
        rows.addRow(tr("Colours of paths"), self.ramp)
        rows.addRow(tr("Colour of machines"), self.colour)

    # ---- called by FreeCAD, through preferences_hook

    def loadSettings(self) -> None:
        """Show the stored preferences."""
        choices.enter(self.machine, preferences.machine())
        self.post.setCurrentIndex(max(0, self.post.findData(preferences.post())))
        self.machines.setText(preferences.machine_folder())
        self.programs.setText(preferences.text("ProgramsFolder"))
        self.unit.setCurrentIndex(self.unit.findData(preferences.preferred_speed_unit()))
        self.ramp.setCurrentIndex(self.ramp.findData(preferences.ramp()))
        self.colour.setProperty("color", QtGui.QColor.fromRgbF(*preferences.machine_colour()))

    def saveSettings(self) -> None:
        """Store the entries. Report a rejected entry in the report view and keep its stored value."""
        preferences.keep("Post", self.post.currentData())
        for name, edit in (("MachineFolder", self.machines), ("ProgramsFolder", self.programs)):
            folder = edit.text().strip()
            if folder and not os.path.isdir(folder):
                _warn(tr("the folder {} does not exist").format(folder))
            else:
                preferences.keep(name, folder)
        self._keep_machine()  # the machine may be in the folder
        preferences.keep_process(self._figures())
        preferences.keep("SpeedUnit", self.unit.currentData())
        preferences.keep("Ramp", "" if self.ramp.currentIndex() == 0 else self.ramp.currentData())
        colour = self.colour.property("color")
        plain = QtGui.QColor.fromRgbF(*preferences.MACHINE_COLOUR).name()
        preferences.keep("MachineColour", "" if colour.name() == plain else colour.name())

    def _keep_machine(self) -> None:
        name = choices.entered(self.machine) or preferences.builtin_machine()
        try:
            machine.load(name, user_machines.folders())
        except InputError as error:
            _warn(tr("{}: {}").format(tr("Machine"), translated(error.message)))
        else:
            preferences.keep("Machine", "" if name == preferences.builtin_machine() else name)

    def _figures(self) -> dict[str, Any]:
        """Return the valid values in outer units by row key; texts for fields that accept words."""
        figures: dict[str, Any] = {}
        for key, field in self.process.items():
            try:
                value = field.value
                inner = field.row.inner(value, field.label)
                preferences.check(field.row, inner)
                figures[key] = (
                    field.row.text(inner)
                    if field.row.form == MIXED
                    else float(field.row.outer(inner))
                )
            except InputError as error:
                _warn(tr("{}: {}").format(field.label, translated(error.message)))
        return figures


def _remove_expression_action(widget: Any) -> None:
    """Remove the expression action: a preference has no document with expressions."""
    line = widget if isinstance(widget, QtGui.QLineEdit) else widget.findChild(QtGui.QLineEdit)
    for action in line.actions():
        line.removeAction(action)


def _warn(text: str) -> None:
    App.Console.PrintWarning(tr("Robotic AM, preferences: {}").format(text) + "\n")


class RoboticAMPreferences:
    """Preferences page that FreeCAD creates when its dialog opens."""

    def __init__(self, *_: Any) -> None:

        self.page = PreferencesPage()
        self.form = self.page.form

    def loadSettings(self) -> None:
        """Show the stored preferences; called by FreeCAD."""
        self.page.loadSettings()

    def saveSettings(self) -> None:
        """Store the entries; called by FreeCAD."""
        self.page.saveSettings()
