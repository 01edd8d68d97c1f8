# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the pages of the wizard have in common: what is wrong is told on the page, and Next waits."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ...core.issues import InputError
from ..colours import WRONG, set_role
from ..texts.translation import sentence, tr, translated_error


class Page(QtGui.QWizardPage):
    """A page that makes the wizard's draft a step fuller. `fill` shows a draft that came from another source; `take` puts
    what was entered into the draft, and raises InputError."""

    def __init__(self, wizard: Any, name: str, title: str, explanation: str) -> None:
        super().__init__(wizard)
        self.owner = wizard
        self.filled_with: object = None
        self.setObjectName(name)
        self.setTitle(title)
        self.column = QtGui.QVBoxLayout(self)
        self.add_text(explanation)
        self.error = self.add_text("")
        self.error.setObjectName("error")
        set_role(self.error, WRONG)
        self.error.hide()

    def add_text(self, text: str) -> Any:
        """A paragraph."""
        label = QtGui.QLabel(text)
        label.setWordWrap(True)
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.column.addWidget(label)
        return label

    def say(self, text: str) -> None:
        """Tell what is wrong; '' for nothing any more."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def fill(self) -> None:
        """Show the draft."""

    def take(self) -> None:
        """Put what was entered into the draft."""

    def initializePage(self) -> None:
        """Called by Qt when the page comes: what was entered stays unless the machine is another one."""
        self.say("")
        if self.filled_with is not self.owner.origin:
            self.filled_with = self.owner.origin
            self.fill()

    def cleanupPage(self) -> None:
        """Called by Qt for Back: nothing is forgotten."""

    def validatePage(self) -> bool:
        """Called by Qt for Next."""
        self.say("")
        try:
            self.take()
        except InputError as error:
            self.say(error_text(error))
            return False
        return True


def error_text(error: InputError) -> str:
    """An error with its place, where that is a place a user knows."""
    return (
        sentence(error.message)
        if error.where in ("geometry", "flange", "table")
        else translated_error(error)
    )


def choice(name: str, entries: list[tuple[str, Any]]) -> Any:
    """A box of texts with their values."""
    box = QtGui.QComboBox()
    box.setObjectName(name)
    for text, value in entries:
        box.addItem(text, value)
    return box


def heading(text: str) -> Any:
    """A heading within a page."""
    label = QtGui.QLabel(f"<b>{text}</b>")
    label.setWordWrap(True)
    return label


def axis_names(owner: Any) -> list[str]:
    """How the axes of the draft are called: by number, or the names of a machine tool."""
    draft = owner.draft
    if draft.chain.sliding.any():
        return [
            tr("{} (mm)").format(name) if slides else tr("{} (deg)").format(name)
            for name, slides in zip(draft.joints, draft.chain.sliding.tolist())
        ]
    return [f"J{number}" for number in range(1, draft.chain.axes + 1)]
