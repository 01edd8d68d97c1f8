# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of the panel of a new job."""

from __future__ import annotations

from typing import Any

from PySide import QtGui

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


def machines(chosen: str) -> Any:
    """The machines there are, one of them chosen."""
    machine = QtGui.QComboBox()
    machine.setObjectName("Machine")
    machine.setToolTip(tr("The machine that deposits; the program is written for its controller"))
    machine.setEditable(True)
    choices.offer(machine, choices.machines())
    choices.enter(machine, chosen)
    return machine
