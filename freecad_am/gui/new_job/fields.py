# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of the panel of a new job."""

from __future__ import annotations

from typing import Any

from PySide import QtGui

from ...core.issues import InputError
from ...core.kinematics.arrangement import OF_ROBOTS
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import FilledParameters
from ...core.parameters.process import ProcessParameters
from ...objects.checks import deposit
from ...objects.fields import naming, preferences, saved_cells
from ...objects.fields.expressions import is_expression
from ...objects.fields.rows import Row, rows
from ..picking import inputs
from ..texts.translation import tr, translated
from ..widgets import choices, fields, suggestions
from ..widgets.quantity import QuantityField
from ..widgets.wrapped import WrappedLabel

LEANING = "max_from_vertical"


def label(name: str) -> Any:
    """A text that is hidden until there is something to tell."""
    text = WrappedLabel()
    text.setObjectName(name)
    text.hide()
    return text


def shown(name: str, help: str) -> Any:
    """What was clicked, by name."""
    line = QtGui.QLineEdit()
    line.setObjectName(name)
    line.setReadOnly(True)
    line.setToolTip(help)
    line.setWhatsThis(help)
    line.setPlaceholderText(tr("click it") if name == "Source" else tr("click it with Ctrl"))
    return line


def machines(chosen: str, doc: Any) -> Any:
    """The machines there are, one of them chosen, and the saved cells, first."""
    machine = QtGui.QComboBox()
    machine.setObjectName("Machine")
    machine.setToolTip(
        tr("The machine that deposits, or a saved cell; the program matches its controller")
    )
    machine.setEditable(True)
    cells = [(path, tr("saved cell: {}").format(name)) for path, name in saved_cells.known(doc)]
    choices.offer(machine, [*cells, *choices.machines()])
    choices.enter(machine, chosen)
    return machine


class JobName:
    """The name of the program: of what is deposited, as the controller takes it, until another one is typed."""

    place = "name"  # as errors call it

    def __init__(self) -> None:
        self.choice = inputs.NameChoice("")
        self.widget = self.choice.widget
        self.label = self.post = self.proposed = ""
        self.asked: tuple[str, str] | None = None  # machine and set-up that the post is of

    def of(self, label: str) -> None:
        """Name it after what has a label."""
        self.label = label
        self._propose()

    def follow(self, machine: str, setup: str) -> str:
        """Propose one for a machine or saved cell; why its controller refuses what is entered, '' where it does not."""
        if self.asked != (machine, setup):
            self.asked, self.post = (machine, setup), suggestions.post_of_job(machine, setup)
            self._propose()
        text = self.widget.text().strip()
        return naming.refusal(text, self.post) if text else ""

    def _propose(self) -> None:
        if self.label and self.widget.text() in ("", self.proposed):
            self.proposed = naming.name_for(self.label, self.post)
            self.widget.setText(self.proposed)


class HowItStands:
    """What a robot carries, `setup`, and, where that is the tool, how far it may lean, `leaning`."""

    def __init__(self) -> None:
        self.setup = QtGui.QComboBox()
        self.setup.setObjectName("Setup")
        self.setup.setToolTip(
            tr(
                "What the robot carries. If the job is infeasible in the proposed cell, another "
                "position, another branch or a positioner is proposed and shown."
            )
        )
        for one in OF_ROBOTS:
            if one.planned:
                self.setup.addItem(choices.worded(one.setup), one.setup)
        self.proposed = str(self.setup.currentData())
        row = _row(BuildDirectionParameters, LEANING)
        self.leaning = fields.make(row, row.default)

    def follow(self, is_robot: bool) -> None:
        """Leave out what means nothing for a machine that is no robot, or a saved cell."""
        self.setup.setEnabled(is_robot)
        self.leaning.widget.setEnabled(bool(self.chosen()))

    def propose(self, setup: str) -> None:
        """Put a set-up that suits the machine, unless another one was chosen than was proposed before."""
        at = self.setup.findData(setup)
        if at >= 0 and self.setup.currentData() == self.proposed:
            self.proposed = setup
            self.setup.setCurrentIndex(at)

    def chosen(self) -> str:
        """The set-up that was chosen, '' where it is the usual one, or there is none to choose."""
        return (
            str(self.setup.currentData())
            if self.setup.isEnabled() and self.setup.currentIndex()
            else ""
        )

    def arguments(self) -> dict[str, str]:
        """Keywords of `make_all` and their values as text; none for the usual set-up. InputError for what cannot be read."""
        if not self.chosen():
            return {}
        given, value = {"setup": repr(self.chosen())}, self.leaning.value
        return given if value == self.leaning.shown else {**given, LEANING: repr(value)}


class FittedLength:
    """A length that may be left empty, as which it is found out when the job is made."""

    def __init__(self, row: Row, placeholder: str, more: str) -> None:
        self.quantity = QuantityField(row.outer(row.default), row.unit, row.label)
        self.widget = self.quantity.box
        self.widget.setObjectName(row.name)
        self.label = self.heading = translated(row.label)
        self.widget.setToolTip(f"{translated(row.spec.help)} {more}")
        self.widget.setWhatsThis(fields.whats_this(row, "cell"))
        self.quantity.known_text = ""
        self.quantity.line.clear()
        self.quantity.make_room()
        self.quantity.line.setPlaceholderText(placeholder)

    @property
    def value(self) -> Any:
        """What is entered, in outer units, or an expression; None where the field is empty. InputError."""
        return self.quantity.read() if self.quantity.line.text().strip() else None


class Sizes:
    """Layer height, width or spacing of beads, and the platform of a new job."""

    def __init__(self) -> None:
        layer, spacing = (_row(FilledParameters, key) for key in ("layer_height", "bead_spacing"))
        width = _row(ProcessParameters, "bead_width")
        self.layer = fields.make(layer, layer.default, section="strategy")
        self.width = fields.make(width, deposit.bead_width(), section="process")
        self.spacing = fields.make(spacing, spacing.default, section="strategy")
        self.platform = FittedLength(
            _row(CellParameters, "platform_diameter"),
            tr("auto"),
            tr("If empty, it is sized for the first layer."),
        )
        self.of_job = {
            "strategy.layer_height": self.layer,
            "process.bead_width": self.width,
            "strategy.bead_spacing": self.spacing,
            "cell.platform_diameter": self.platform,
        }

    def bead_width(self) -> float:
        """What parts are judged by, mm; the usual one where an expression or nothing that is understood is entered."""
        try:
            value = self.width.value
        except InputError:
            return deposit.bead_width()
        return deposit.bead_width() if is_expression(value) or value <= 0.0 else float(value)

    def arguments(self, filled: bool, saved: bool) -> dict[str, str]:
        """Keywords of `make_all` and their values as text, of what is entered. filled: beads have a spacing; saved: the cell
        has a platform of its own. InputError for what cannot be read."""
        given = {}
        for field in (self.layer, *((self.spacing,) if filled else ())):
            if field.changed:
                given[field.row.key] = repr(field.value)
        if not filled and self.width.changed:
            values = {**preferences.process(), self.width.row.key: self.width.value}
            given["process"] = repr(values)
        if not saved and self.platform.value is not None:
            given["platform_diameter"] = repr(self.platform.value)
        return given


def _row(section: type, key: str) -> Row:
    return next(row for row in rows(section) if row.key == key)
