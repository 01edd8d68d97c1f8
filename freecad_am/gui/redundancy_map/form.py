# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a map's dock holds: the map, the place under the mouse, the fields, the figures, what there is to say, buttons."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ..colours import PLAIN, WRONG, of, set_role
from ..texts.translation import tr
from ..widgets.scrolled import Scrolled

NARROWEST = 190  # pixels of the controls


class Form(QtGui.QWidget):
    """The widgets at their places; whoever makes it connects them."""

    def __init__(self, canvas: Any, controls: Any, figures: Any) -> None:
        super().__init__()
        self.figures = figures
        row, left = QtGui.QHBoxLayout(self), QtGui.QVBoxLayout()
        beside = QtGui.QWidget()
        right = QtGui.QVBoxLayout(beside)
        right.setContentsMargins(0, 0, 0, 0)
        row.setContentsMargins(4, 2, 4, 4)
        row.setSpacing(4)
        self.readout = QtGui.QLabel()
        self.readout.setObjectName("readout")
        self.readout.setMinimumHeight(2 * self.readout.fontMetrics().height() + 4)
        self.readout.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Preferred)
        left.addWidget(canvas, 1)
        left.addWidget(self.readout)
        self.verdict = QtGui.QLabel()
        self.verdict.setObjectName("verdict")
        self.verdict.setWordWrap(True)
        self.joints = QtGui.QLabel()
        self.joints.setObjectName("joints")
        self.joints.setWordWrap(True)
        self.joints.setTextFormat(QtCore.Qt.RichText)
        self.joints.setToolTip(tr("Range of each joint on this curve; red beyond a limit"))
        right.addWidget(figures, 1)
        right.addWidget(self.joints)
        right.addWidget(self.verdict)
        grid = QtGui.QGridLayout()
        self.buttons = {
            name: _button(name, text, help)
            for name, text, help in (
                (
                    "use",
                    tr("Use this"),
                    tr("Use the curve for the joint path, and plan it again"),
                ),
                (
                    "free",
                    tr("Let the planner choose"),
                    tr("Plan the joint path again layer by layer, without a given curve"),
                ),
                ("again", tr("Back"), tr("Reset to the planned curve")),
                (
                    "compare",
                    tr("Compare methods"),
                    tr(
                        "Plan constant, point-by-point and layer-by-layer in this configuration, "
                        "for comparison"
                    ),
                ),
                ("save", tr("Save…"), tr("Save as an image (PNG, SVG, PDF), or the values (CSV)")),
            )
        }
        for number, button in enumerate(self.buttons.values()):
            grid.addWidget(button, number // 2, number % 2)
        right.addLayout(grid)
        row.addLayout(left, 7)
        row.addWidget(Scrolled(controls, NARROWEST), 2)
        row.addWidget(Scrolled(beside), 4)

    def tell(self, text: str, wrong: bool = False) -> None:
        """Say how the curve stands, or what goes on."""
        self.verdict.setText(text)
        set_role(self.verdict, WRONG if wrong else PLAIN)

    def show_joints(self, ranges: list[tuple[str, bool]]) -> None:
        """What each joint does, and whether it goes past a limit."""
        whole = [(text.replace(" ", "&nbsp;"), wrong) for text, wrong in ranges]
        parts = [
            f'<font color="{of(WRONG).name()}">{text}</font>' if wrong else text
            for text, wrong in whole
        ]
        self.joints.setText(" &nbsp; ".join(parts))


def _button(name: str, text: str, help: str) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    return button
