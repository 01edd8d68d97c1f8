# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of the panel of a new job."""

from __future__ import annotations

from typing import Any

from PySide import QtGui

from ...objects.fields import saved_cells
from ..texts.translation import tr
from ..widgets import choices


def label(name: str) -> Any:
    """A text that is hidden until there is something to tell."""
    text = QtGui.QLabel()
    text.setObjectName(name)
    text.setWordWrap(True)
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
    machine.setToolTip(tr("The machine that deposits, or a saved cell; the program is written for its controller"))
    machine.setEditable(True)
    cells = [(path, tr("saved cell: {}").format(name)) for path, name in saved_cells.known(doc)]
    choices.offer(machine, [*cells, *choices.machines()])
    choices.enter(machine, chosen)
    return machine
