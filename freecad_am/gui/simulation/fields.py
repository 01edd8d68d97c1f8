# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of a simulation: time, buttons, and texts of the moment, of issues and of the whole
job.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.types import Array, Mask
from .. import colours, icons
from ..colours import INVALID, PLAIN, set_role
from ..in_language import tr
from ..widgets.steady import SteadyLabel
from . import wording
from .player import Moment, Player, Run

GROOVE = 60  # of 255; opacity of a bar's background
GOOD, BAD = QtGui.QColor(59, 111, 212), QtGui.QColor(206, 34, 44)
_PAD, _GAP = 4, 6


class JointBars(QtGui.QWidget):
    """Bars of the joint values.

    lower, upper: (axes,) in displayed units, infinite for continuous axes, which have a rotary
    symbol instead of a bar.
    """

    def __init__(
        self, names: Sequence[str], units: Sequence[str], lower: Array, upper: Array
    ) -> None:
        super().__init__()
        self.setObjectName("joints")
        self.names, self.units, self.lower, self.upper = names, units, lower, upper
        self.values = np.zeros(len(names))
        self.margins = np.full(len(names), np.inf)
        self.ratios = np.zeros(len(names))
        self.bad = np.zeros(len(names), dtype=bool)
        self.row = self.fontMetrics().height() + 6
        self.setMinimumHeight(self.row * (len(names) + 1) + 2)
        self.setToolTip(
            tr(
                "Range of each joint, its distance to the nearer limit, and its speed as a share "
                "of the maximum"
            )
        )

    def set(self, values: Array, margins: Array, ratios: Array, bad: Mask) -> None:
        """Set values and margins (axes,) in displayed units, fractions of the maximum speeds, and
        which axes are red.
        """
        self.values, self.margins, self.ratios, self.bad = values, margins, ratios, bad
        self.update()

    def texts(self, axis: int) -> tuple[str, str, str]:
        """Return value, margin and speed fraction of an axis as texts."""
        unit = "°" if self.units[axis] == "deg" else " mm"
        if not np.isfinite(self.values[axis]):
            return "–", "–", "–"
        margin = f"{self.margins[axis]:.1f}{unit}" if np.isfinite(self.margins[axis]) else "∞"
        return (
            f"{round(float(self.values[axis]), 1) + 0.0:.1f}{unit}",
            margin,
            f"{100.0 * self.ratios[axis]:.0f} %",
        )

    def paintEvent(self, event: Any) -> None:
        """Draw all rows."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        wide = self.fontMetrics().boundingRect
        widest = "8888.8 mm" if "mm" in self.units else "8888.8°"
        name, value, margin, speed = (
            wide(text).width() + _GAP
            for text in (max(self.names, key=len), f"-{widest}", widest, "88888 %")
        )
        name = max(name, 22)
        left, right = _PAD + name + value, self.width() - _PAD - margin - speed
        heads = (
            (left, right - left, tr("range")),
            (right, margin, tr("margin")),
            (right + margin, speed, tr("speed")),
        )
        ink, faint = colours.ink(), QtGui.QColor(colours.ink())
        faint.setAlpha(GROOVE)
        painter.setPen(colours.of(colours.FAINT))
        for x, width, text in heads:
            flags = QtCore.Qt.AlignVCenter | (
                QtCore.Qt.AlignHCenter if text == heads[0][2] else QtCore.Qt.AlignRight
            )
            painter.drawText(QtCore.QRect(x, 0, width, self.row), int(flags), text)
        for axis, label in enumerate(self.names):
            top = (axis + 1) * self.row
            colour = colours.of(colours.INVALID) if self.bad[axis] else ink
            painter.setPen(colour)
            texts = self.texts(axis)
            self._text(painter, _PAD, top, name, label, False)
            self._text(painter, _PAD + name, top, value - _GAP, texts[0], True)
            self._text(painter, right, top, margin, texts[1], True)
            self._text(painter, right + margin, top, speed, texts[2], True)
            self._bar(painter, left, top, right - left, axis, faint)
        painter.end()

    def _bar(self, painter: Any, left: int, top: int, width: int, axis: int, faint: Any) -> None:
        high = self.row
        groove = QtCore.QRectF(
            left + _GAP, top + 0.36 * high, max(width - 2 * _GAP, 8), 0.28 * high
        )
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(faint)
        painter.drawRoundedRect(groove, 2, 2)
        value = self.values[axis]
        if not np.isfinite(value):
            return
        lower, upper = self.lower[axis], self.upper[axis]
        if not np.isfinite(upper - lower):
            lower, upper, value = 0.0, 360.0, value % 360.0
        share = float(np.clip((value - lower) / (upper - lower), 0.0, 1.0))
        colour = BAD if self.bad[axis] else GOOD
        middle = groove.left() + 0.5 * groove.width()
        x = groove.left() + share * groove.width()
        painter.setBrush(colour.lighter(150))
        painter.drawRect(
            QtCore.QRectF(min(middle, x), groove.top(), abs(x - middle), groove.height())
        )
        painter.setBrush(colour)
        painter.drawRoundedRect(QtCore.QRectF(x - 2.5, top + 0.18 * high, 5.0, 0.64 * high), 2, 2)

    def _text(
        self, painter: Any, left: int, top: int, width: int, text: str, to_right: bool
    ) -> None:
        side = QtCore.Qt.AlignRight if to_right else QtCore.Qt.AlignLeft
        painter.drawText(
            QtCore.QRect(left, top, width, self.row), int(side | QtCore.Qt.AlignVCenter), text
        )


STEPS = 10_000  # slider steps
FACTORS = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 50.0, 100.0, 500.0)


class Fields(QtGui.QWidget):
    """The fields in the window's language.

    slid: called with the chosen fraction of the job's time. acts: action of each button, by name.
    """

    def __init__(
        self,
        run: Run,
        player: Player,
        slid: Callable[[float], None],
        acts: dict[str, Callable[[], None]],
    ) -> None:
        super().__init__()
        self.setObjectName("form")
        self.run, self.player, self.filling = run, player, False
        machine, limits = run.cell.machine, run.cell.limits
        units, axes = machine.unit_values, len(machine.axes)
        self.bars = JointBars(
            machine.axes, machine.units, limits.lower[:axes] / units, limits.upper[:axes] / units
        )
        self.slider = self._slider(slid)
        self.labels = {
            name: SteadyLabel(name) for name in ("clock", "place", "doing", "speed", "condition")
        }
        self.finding = _label("finding")
        self.finding.setWordWrap(True)
        self.finding.setMinimumHeight(2 * self.finding.fontMetrics().height() + 4)
        self.finding.setAlignment(QtCore.Qt.AlignTop)
        column = QtGui.QVBoxLayout(self)
        column.setContentsMargins(8, 6, 8, 6)
        if run.stale:
            stale = _label(
                "stale",
                tr(
                    "The simulation shows an earlier plan; recompute the document to update the "
                    "simulation."
                ),
            )
            stale.setWordWrap(True)
            set_role(stale, INVALID)
            column.addWidget(stale)
        column.addWidget(self.slider)
        column.addLayout(self._moment())
        column.addLayout(self._buttons(acts))
        column.addWidget(self.finding)
        column.addWidget(self.bars)
        column.addLayout(self._facts())
        column.addWidget(_totals(run))
        column.addStretch(1)

    def _slider(self, slid: Callable[[float], None]) -> Any:
        slider = QtGui.QSlider(QtCore.Qt.Horizontal)
        slider.setObjectName("time")
        slider.setRange(0, STEPS)
        slider.setPageStep(STEPS // 20)
        slider.setToolTip(tr("The time of the job"))
        slider.valueChanged.connect(lambda value: None if self.filling else slid(value / STEPS))
        return slider

    def _moment(self) -> Any:
        line = QtGui.QHBoxLayout()
        line.addWidget(self.labels["clock"])
        line.addStretch(1)
        line.addWidget(self.labels["place"])
        return line

    def _buttons(self, acts: dict[str, Callable[[], None]]) -> Any:
        line = QtGui.QHBoxLayout()
        line.setSpacing(2)
        marks = (
            ("layer_back", tr("Back to the start of the layer")),
            ("point_back", tr("One point back")),
            ("play", tr("Play or pause")),
            ("point_on", tr("One point forward")),
            ("layer_on", tr("Forward to the next layer")),
        )
        self.buttons = {}
        for name, help in marks:
            button = QtGui.QToolButton()
            button.setObjectName(name)
            button.setToolTip(help)
            button.clicked.connect(lambda *_, act=acts[name]: act())
            line.addWidget(button)
            self.buttons[name] = button
        self.show_icons()
        self.factor = QtGui.QComboBox()
        self.factor.setObjectName("factor")
        self.factor.setToolTip(tr("Playback speed, in seconds of the job per second"))
        self.factor.addItems([f"{factor:g} ×" for factor in FACTORS])
        self.factor.setCurrentIndex(FACTORS.index(self.player.factor))
        self.factor.currentIndexChanged.connect(
            lambda index: setattr(self.player, "factor", FACTORS[index])
        )
        self.next = QtGui.QPushButton(tr("Next finding"))
        self.next.setObjectName("next_finding")
        self.next.setToolTip(
            tr("To the next place where a limit, a singularity or a speed needs attention")
        )
        self.next.clicked.connect(lambda *_: acts["next_finding"]())
        self.next.setEnabled(bool(self.run.watch.findings))
        line.addWidget(self.factor)
        line.addStretch(1)
        line.addWidget(self.next)
        return line

    def _facts(self) -> Any:
        grid = QtGui.QGridLayout()
        grid.setVerticalSpacing(2)
        names = (("doing", tr("Machine")), ("speed", tr("Speed")), ("condition", tr("Condition")))
        for row, (name, text) in enumerate(names):
            grid.addWidget(QtGui.QLabel(text), row, 0)
            grid.addWidget(self.labels[name], row, 1, QtCore.Qt.AlignLeft)
        grid.setColumnStretch(1, 1)
        return grid

    def reserve_width(self) -> None:
        """Set widths for the widest texts in the current language and units."""
        for name, texts in wording.widest(self.run).items():
            self.labels[name].reserve_width(texts)

    # ---- display

    def mark_play(self) -> None:
        """Show the play button as a pause button while the simulation plays."""
        mark = "pause" if self.player.playing else "play"
        self.buttons["play"].setIcon(icons.player_icon(mark, colours.ink()))

    def show_icons(self) -> None:
        """Set the icons of all buttons in the theme's text colour."""
        for name, button in self.buttons.items():
            button.setIcon(icons.player_icon(name, colours.ink()))
        self.mark_play()

    def tell(self, moment: Moment) -> None:
        """Show a moment."""
        self.filling = True
        self.slider.setValue(round(self.player.time / max(self.run.times.total, 1e-9) * STEPS))
        self.filling = False
        self.labels["clock"].show_text(wording.times(self.run, self.player.time))
        self.labels["place"].show_text(wording.place(self.run, moment))
        self.bars.set(moment.values, moment.margins, moment.ratios, moment.bad)
        speed, is_kept = wording.speed(moment)
        for name, text, good in (
            (
                "doing",
                wording.doing(self.run, moment),
                bool(np.isfinite(moment.state.joints).all()),
            ),
            ("speed", speed, is_kept),
            ("condition", wording.condition(moment), not moment.singular),
        ):
            label = self.labels[name]
            label.show_text(text)
            set_role(label, PLAIN if good else INVALID)

    def tell_finding(self, finding: Any) -> None:
        """Show an issue, or the number of issues."""
        count = len(self.run.watch.findings)
        if finding is None:
            text = wording.count_of_findings(count) if count else wording.nothing(self.run)
        else:
            limit = finding.label in self.run.cell.machine.axes
            unit = (
                self.run.cell.machine.units[self.run.cell.machine.axes.index(finding.label)]
                if limit
                else "deg"
            )
            text = f"{(self.player.finding or 0) + 1}/{count}: {wording.finding(finding, unit)}"
        self.finding.setText(text)
        set_role(self.finding, INVALID if finding is not None else PLAIN)


def _label(name: str, text: str = "") -> Any:
    label = QtGui.QLabel(text)
    label.setObjectName(name)
    return label


def _totals(run: Run) -> Any:
    box = QtGui.QGroupBox(tr("The whole job"))
    box.setObjectName("totals")
    grid = QtGui.QGridLayout(box)
    grid.setVerticalSpacing(1)
    for row, (name, value) in enumerate(wording.totals(run)):
        grid.addWidget(QtGui.QLabel(name), row, 0)
        grid.addWidget(QtGui.QLabel(value), row, 1)
    grid.setColumnStretch(1, 1)
    return box
