# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields next to the map: its display, and the numbers of the curve."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from PySide import QtGui

from ...core.kinematics.inverse import opw
from ...core.parameters.joints import HIGHEST
from ...core.planning.redundancy_map import ROTATION, RZ
from ..in_language import tr
from .board import Board
from .draft import CONSTANT, POLYNOMIALS, Draft
from .painting import KINDS

STEP = 1.0  # deg of an arrow of a coefficient
MAX_VALUE = 1e6
AXES, CURVES = (RZ, ROTATION), (POLYNOMIALS, CONSTANT)


class Controls(QtGui.QWidget):
    """Functions are called with what the user chose; `fill` shows a state without calling any."""

    def __init__(
        self,
        on_choice: Callable[[], None],
        curve: Callable[[], None],
        set_value: Callable[[int, float], None],
    ) -> None:
        super().__init__()
        self.setObjectName("controls")
        self.filling = False
        self.chosen, self.curve, self.set_value = on_choice, curve, set_value
        self.grid = QtGui.QGridLayout(self)
        self.grid.setContentsMargins(4, 2, 4, 2)
        self.grid.setVerticalSpacing(3)
        self.layer = self._box(
            "layer", tr("Layer"), tr("The layer shown; -1 for all layers"), on_choice
        )
        self.layer.setSpecialValueText(tr("all"))
        self.branch = self._combo(
            "branch",
            tr("Branch"),
            tr("Shoulder, elbow and wrist, with the share of the map within reach and limits"),
            on_choice,
        )
        self.kind = self._combo(
            "colours", tr("Colours"), tr("Quantity shown by the colours"), on_choice
        )
        self.kind.addItems([tr(kind) for kind in KINDS])
        help = tr(
            "RZ as in Chalvin 2020, the true tool rotation, or an external axis that is not on "
            "the other axis of the map"
        )
        self.axis = self._combo("axis", tr("Vertical axis"), help, on_choice)
        self.across = self._add_across()
        self.type = self._combo(
            "curve", tr("Curve"), tr("One polynomial per bead, or one RZ for the whole job"), curve
        )
        self.type.addItems([tr("polynomials"), tr("constant RZ")])
        self.bead = self._box(
            "bead",
            tr("Bead"),
            tr("The bead whose polynomial is shown; click the map to choose one"),
            curve,
        )
        self.degree = self._box("degree", tr("Degree"), tr("Degree of the polynomials"), curve)
        self.degree.setRange(0, HIGHEST)
        self.together = QtGui.QCheckBox(tr("All beads together"))
        self.together.setObjectName("together")
        self.together.setToolTip(tr("Change all beads together"))
        self.together.setChecked(True)
        self.grid.addWidget(self.together, self.grid.rowCount(), 0, 1, 2)
        self.coefficients, self.names = [], []
        for number in range(HIGHEST + 1):
            box = QtGui.QDoubleSpinBox()
            box.setObjectName(f"c{number}")
            box.setRange(-MAX_VALUE, MAX_VALUE)
            box.setDecimals(3)
            box.setSingleStep(STEP)
            box.setKeyboardTracking(False)
            box.setSuffix(
                " °"
                if number == 0
                else " °/" + tr("turn") + ("" if number == 1 else "²³⁴⁵⁶"[number - 2])
            )
            box.valueChanged.connect(lambda value, number=number: self._entered(number, value))
            row = self.grid.rowCount()
            self.names.append(QtGui.QLabel())
            self.grid.addWidget(self.names[-1], row, 0)
            self.grid.addWidget(box, row, 1)
            self.coefficients.append(box)
        self.grid.setColumnStretch(1, 1)
        self.grid.setRowStretch(self.grid.rowCount(), 1)

    def _box(self, name: str, text: str, help: str, act: Callable[[], None]) -> Any:
        box = QtGui.QSpinBox()
        box.valueChanged.connect(lambda *_: None if self.filling else act())
        return self._add(box, name, text, help)

    def _combo(self, name: str, text: str, help: str, act: Callable[[], None]) -> Any:
        combo = QtGui.QComboBox()
        combo.setMinimumContentsLength(8)
        combo.activated.connect(lambda *_: None if self.filling else act())
        return self._add(combo, name, text, help)

    def _add_across(self) -> Any:
        help = tr(
            "The path, or an external axis at the point clicked last, with the other axes as "
            "planned there"
        )
        return self._combo("across", tr("Horizontal axis"), help, self.chosen)

    def _add(self, widget: Any, name: str, text: str, help: str) -> Any:
        widget.setObjectName(name)
        widget.setToolTip(help)
        row = self.grid.rowCount()
        self.grid.addWidget(QtGui.QLabel(text), row, 0)
        self.grid.addWidget(widget, row, 1)
        return widget

    def _entered(self, number: int, value: float) -> None:
        if not self.filling:
            self.set_value(number, value)

    def selection(self) -> tuple[int | None, str, int | None, int | None]:
        """Which layer, None for all; the rotation upwards; which external axis across, None for the path; and which external
        axis upwards, None for the rotation."""
        layer, across, axis = (
            self.layer.value(),
            self.across.currentIndex() - 1,
            self.axis.currentIndex(),
        )
        up = (
            axis - len(AXES) if axis >= len(AXES) and across not in (-1, axis - len(AXES)) else None
        )
        return (
            None if layer < 0 else layer,
            AXES[axis if axis < len(AXES) else 0],
            across if across >= 0 else None,
            up,
        )

    # ---- display

    def fill(self, board: Board, draft: Draft, bead: int) -> None:
        """Show a state."""
        self.filling = True
        source = board.source
        self.layer.setRange(-1, max(layer for layer, _ in source.places))
        self.layer.setValue(-1 if board.layer is None else board.layer)
        self._fill_branches(board, draft.branch)
        self._fill_across(board)
        self.type.setCurrentIndex(CURVES.index(draft.kind))
        constant = draft.kind == CONSTANT
        self.bead.setRange(board.beads[0], board.beads[-1])
        self.bead.setValue(bead)
        self.bead.setSuffix("  ({}/{})".format(*source.places[bead]))
        self.degree.setValue(draft.degree)
        for widget in (self.bead, self.degree, self.together):
            widget.setEnabled(not constant)
        values = (
            [draft.rz]
            if constant
            else [c * (2.0 * np.pi) ** k for k, c in enumerate(draft.coefficients[bead])]
        )
        for number, (name, box) in enumerate(zip(self.names, self.coefficients, strict=True)):
            is_used = number < len(values)
            name.setVisible(is_used)
            box.setVisible(is_used)
            name.setText("RZ" if constant else _coefficient(number))
            if is_used and not (
                box.hasFocus() and abs(box.value() - np.degrees(values[number])) < 6e-4
            ):
                box.setValue(float(np.degrees(values[number])))
        self.filling = False

    def _fill_across(self, board: Board) -> None:
        machine = board.source.cell.machine
        external = list(machine.axes[len(machine.axes) - machine.external :])
        names = [tr("the path"), *external]
        for combo, texts in (
            (self.across, names),
            (self.axis, [tr("RZ"), tr("rotation"), *external]),
        ):
            if [combo.itemText(k) for k in range(combo.count())] != texts:
                combo.clear()
                combo.addItems(texts)
        self.axis.setCurrentIndex(
            AXES.index(board.axis) if board.up is None else len(AXES) + board.up
        )
        self.across.setCurrentIndex(0 if board.across is None else board.across + 1)
        self.across.setEnabled(len(names) > 1)

    def _fill_branches(self, board: Board, branch: int) -> None:
        served = None if board.map is None else board.reachable_shares()
        texts = []
        for number in range(8):
            text = " ".join(opw.branch_name(number))
            text += "" if served is None else f"   {100.0 * served[number]:.0f} %"
            texts.append(text + ("   " + tr("(planned)") if number == board.source.branch else ""))
        if [self.branch.itemText(k) for k in range(self.branch.count())] != texts:
            self.branch.clear()
            self.branch.addItems(texts)
        self.branch.setCurrentIndex(branch)


def _coefficient(number: int) -> str:
    """What the panel calls a coefficient of a polynomial over the turns of a bead."""
    words = {0: tr("RZ at the start"), 1: tr("Linear"), 2: tr("Quadratic"), 3: tr("Cubic")}
    return words.get(number) or tr("Degree {}").format(number)
