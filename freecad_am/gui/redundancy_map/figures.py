# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves side by side in figures: one row each, with a box that shows it on the map."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.planning.redundancy.curve import Sums
from ..colours import PLAIN, WRONG, of
from ..texts.translation import tr

COLUMNS = 6


class Figures(QtGui.QTableWidget):
    """Rows are called by name; `changed` is called when a box was clicked."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(0, COLUMNS)
        self.setObjectName("figures")
        self.rows: dict[str, int] = {}
        self.changed = changed
        self.filling = False
        self.setHorizontalHeaderLabels(
            [tr("Curve"), tr("Lost"), tr("Margin"), tr("Condition"), tr("Speed"), tr("Criterion")]
        )
        helps = (
            tr("Shown on the map"),
            tr("Points that are unreachable, beyond a limit, near a singularity or not allowed"),
            tr("The smallest distance to a limit, as a share of half the range of the joint"),
            tr("The smallest inverse condition number of the Jacobian, sigma_min / sigma_max"),
            tr("The largest joint speed at the travel speed, as a share of its maximum"),
            tr("The displacement of the joints (Chalvin 2020, eq. 17), and its ratio to the plan"),
        )
        for number, help in enumerate(helps):
            self.horizontalHeaderItem(number).setToolTip(help)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(int(1.6 * self.fontMetrics().height()))
        self.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.setSelectionMode(QtGui.QAbstractItemView.NoSelection)
        self.horizontalHeader().setStretchLastSection(True)
        self.setMinimumWidth(200)
        self.itemChanged.connect(self._clicked)

    def set(
        self,
        name: str,
        title: str,
        colour: tuple[int, int, int],
        sums: Sums,
        planned: Sums | None,
        about: bool = False,
        help: str = "",
    ) -> None:
        """Fill a row, which is made when it is new. about: the figures are of some of the points."""
        self.filling = True
        new = name not in self.rows
        if new:
            self.rows[name] = self.rowCount()
            self.insertRow(self.rowCount())
        row, sign = self.rows[name], "≈ " if about else ""
        reached = np.isfinite(sums.margin)
        times = (
            ""
            if planned is None or not planned.displacement
            else f" (×{sums.displacement / planned.displacement:.3g})"
        )
        texts = (
            title,
            f"{sums.lost}",
            f"{100.0 * sums.margin:.1f} %" if reached else tr("unreachable"),
            f"{sums.condition:.4f}",
            f"{100.0 * sums.ratio:.1f} %" if np.isfinite(sums.ratio) else "—",
            f"{sums.displacement:.3g}{times}" if np.isfinite(sums.displacement) else "—",
        )
        for column, text in enumerate(texts):
            item = self.item(row, column)
            if item is None:
                item = QtGui.QTableWidgetItem()
                self.setItem(row, column, item)
            item.setText(text if column in (0, 1) else f"{sign}{text}")
        mark = self.item(row, 0)
        if new:
            mark.setFlags(QtCore.Qt.ItemIsEnabled | QtCore.Qt.ItemIsUserCheckable)
            mark.setCheckState(QtCore.Qt.Checked)
            image = QtGui.QPixmap(12, 12)
            image.fill(QtGui.QColor(*colour))
            mark.setIcon(QtGui.QIcon(image))
        mark.setToolTip(help)
        wound = tr(
            "{} exceed a limit only because an axis runs out of turns along its bead"
        ).format(sums.wound)
        self.item(row, 1).setToolTip(wound if sums.wound else "")
        for column, wrong in ((1, sums.lost > 0), (4, sums.ratio > 1.0)):
            ink = of(WRONG if wrong else PLAIN)
            self.item(row, column).setForeground(QtGui.QBrush(ink))
        self.resizeColumnsToContents()
        self.filling = False

    def shows(self, name: str) -> bool:
        """Whether a curve is to be seen."""
        return name in self.rows and self.item(self.rows[name], 0).checkState() == QtCore.Qt.Checked

    def hide_curve(self, name: str) -> None:
        """Take a curve from the map, as its box does."""
        self.item(self.rows[name], 0).setCheckState(QtCore.Qt.Unchecked)

    def clear_all(self) -> None:
        """No rows."""
        self.filling = True
        self.setRowCount(0)
        self.rows.clear()
        self.filling = False

    def _clicked(self, item: Any) -> None:
        if not self.filling and item.column() == 0:
            self.changed()
