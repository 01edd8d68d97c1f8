# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a new job: the shape and the name, everything else at its default."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
from PySide import QtGui

from .. import api
from ..core.issues import AmError
from ..objects.feature import RevolutionFeature
from . import icons, inputs, recorded
from .colours import WRONG
from .fold import Fold
from .stage_panel import CLOSED


class JobPanel:
    """OK makes all stages in one step."""

    def __init__(self) -> None:
        self.document = App.ActiveDocument
        self.form = QtGui.QWidget()
        self.form.setObjectName("RoboticAM_NewJob")
        self.form.setWindowTitle("New job")
        self.form.setWindowIcon(QtGui.QIcon(icons.path("new_job")))
        column = QtGui.QVBoxLayout(self.form)
        self.error = QtGui.QLabel()
        self.error.setObjectName("error")
        self.error.setWordWrap(True)
        self.error.setStyleSheet(f"QLabel {{ color: {WRONG}; }}")
        self.source = inputs.ShapeChoice(RevolutionFeature.links[0], None, take_now=True)
        name = "" if self.source.present is None else api.proposed_name(self.source.present[0].Label)
        self.name = inputs.NameChoice(name)
        fold = Fold("Inputs", True)
        for choice in (self.source, self.name):
            fold.add(choice.label, choice.widget)
        hint = QtGui.QLabel("Cell, feature, toolpath, joint path and program are made with their defaults; "
                            "double-click one in the tree to change it.")
        hint.setWordWrap(True)
        for widget in (self.error, fold.widget, hint):
            column.addWidget(widget)
        column.addStretch(1)
        self.source.text.textChanged.connect(self._propose)
        self.say(self.source.missing)

    def _propose(self, *_: Any) -> None:
        """A shape was chosen now: its name, unless one was typed."""
        self.say("")
        if not self.name.widget.text():
            self.name.widget.setText(api.proposed_name(self.source.present[0].Label))

    def say(self, text: str) -> None:
        """Show what is wrong."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def accept(self) -> bool:
        """Make all stages; True closes the panel, an error is shown in it."""
        try:
            recorded.make(self.document, "make_all", {**self.source.arguments(), **self.name.arguments()})
        except AmError as error:
            self.say(str(error))
        except ReferenceError:
            self.say(CLOSED)
        else:
            return True
        return False

    def reject(self) -> Any:
        """Nothing was done."""
        return True
