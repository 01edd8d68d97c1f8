# SPDX-License-Identifier: LGPL-2.1-or-later
"""matplotlib's canvas and toolbar for Qt: draw, zoom, pan and read charts.

matplotlib uses the Qt binding that FreeCAD has imported, PySide2 or PySide6.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_qtagg import FigureCanvasQTAgg, NavigationToolbar2QT
from matplotlib.figure import Figure
from PySide import QtCore, QtGui

from ...plots.chart import Chart
from ...plots.draw import DPI, Place, Range, Window, fill, share
from .. import colours
from ..in_language import marked, tr
from .reading import look_of, text_at

WHEEL_STEP = 1.25  # zoom factor per wheel step
ICON_SIZE = 18  # pixels
# name, tooltip, matplotlib's icon, method, and object name of the button
TOOLS = (
    ("Home", marked("Show everything, also with a double click"), "home", "home", "whole"),
    ("Back", marked("Show the previous view"), "back", "back", "back"),
    ("Forward", marked("Show the next view"), "forward", "forward", "forward"),
    ("Pan", marked("Move the picture by dragging"), "move", "pan", "pan"),
    (
        "Zoom",
        marked("Zoom into a rectangle; the wheel zooms too, with Ctrl the vertical axis"),
        "zoom_to_rect",
        "zoom",
        "rectangle",
    ),
    (
        "Save",
        marked("Save as an image (PNG, SVG, PDF), or the values (CSV)"),
        "filesave",
        "save_figure",
        "save",
    ),
)


class View(FigureCanvasQTAgg):
    """Charts in a column.

    across, up: x and y ranges that the user has chosen, by chart index. places: positions of the
    drawn frames.
    """

    def __init__(self, interactive: bool) -> None:
        super().__init__(Figure(dpi=DPI))
        # the canvas shows the background around the charts
        self.setAttribute(QtCore.Qt.WA_OpaquePaintEvent, False)
        self.charts: tuple[Chart, ...] = ()
        self.places: tuple[Place, ...] = ()
        self.across: dict[int, Range] = {}
        self.up: dict[int, Range] = {}
        self.toolbar: Toolbar | None = None
        self._limits: list[tuple[Range, Range]] = []  # limits of the axes when last drawn
        self._pointer: tuple[int, float] | None = None  # chart, pixels from the left
        if interactive:
            self.mpl_connect("scroll_event", self._turn_wheel)
            self.mpl_connect("button_press_event", self._press)
            self.mpl_connect("motion_notify_event", self._point)
            self.mpl_connect("figure_leave_event", self._leave)
        else:
            self.setAttribute(QtCore.Qt.WA_TransparentForMouseEvents)

    def show_charts(self, charts: Sequence[Chart], keep: bool) -> None:
        """Show other charts. keep: whether to keep the visible range."""
        if keep:
            self._note_ranges()
        self.charts, self.places, self._limits = tuple(charts), (), []
        self.figure.clear()
        if not keep:
            self.show_all()
        self.draw_idle()

    def show_all(self) -> None:
        """Show the full range of all charts."""
        self.across, self.up, self._limits = {}, {}, []
        self.draw_idle()

    def draw(self) -> None:
        """Draw the charts for the current ranges and size; called by matplotlib."""
        if self.charts and min(self.width(), self.height()) > 0:
            self._note_ranges()
            is_new = not self.figure.axes
            window = Window(self.across, self.up)
            self.places = fill(self.figure, self.charts, look_of(), window)
            axes = self.figure.axes
            if is_new:
                self._prepare_axes(axes)
            self._limits = [(entry.get_xlim(), entry.get_ylim()) for entry in axes]
        super().draw()

    def _prepare_axes(self, axes: Sequence[Any]) -> None:
        for chart, entry in zip(self.charts, axes, strict=True):
            entry.format_coord = lambda x, y, chart=chart: text_at(chart, x)
        if share(self.charts):
            for entry in axes[1:]:
                entry.sharex(axes[0])
        if self.toolbar is not None:
            self.toolbar.update()
            self.toolbar.push_current()

    def _note_ranges(self) -> None:
        """Store the limits that toolbar and wheel have changed since the last drawing."""
        for number, (axes, (across, up)) in enumerate(
            zip(self.figure.axes, self._limits, strict=False)
        ):
            if axes.get_xlim() != across:
                self.across[0 if share(self.charts) else number] = axes.get_xlim()
            if axes.get_ylim() != up:
                self.up[number] = axes.get_ylim()

    def _turn_wheel(self, event: Any) -> None:
        """Zoom about the pointer: horizontally, or vertically with Ctrl."""
        axes = event.inaxes
        if axes is None:
            return
        factor = WHEEL_STEP ** (-event.step)
        if event.guiEvent.modifiers() & QtCore.Qt.ControlModifier:
            axes.set_ylim(event.ydata + factor * (np.array(axes.get_ylim()) - event.ydata))
        else:
            charts = self.charts
            if not share(charts):
                charts = (charts[self.figure.axes.index(axes)],)
            lows, highs = zip(*(chart.across() for chart in charts), strict=True)
            limits = event.xdata + factor * (np.array(axes.get_xlim()) - event.xdata)
            axes.set_xlim(np.clip(limits, min(lows), max(highs)))
        if self.toolbar is not None:
            self.toolbar.push_current()
        self.draw_idle()

    def _press(self, event: Any) -> None:
        if event.dblclick and self.toolbar is not None:
            self.toolbar.home()

    def _point(self, event: Any) -> None:
        axes = event.inaxes
        self._pointer = (
            None
            if axes is None
            else (self.figure.axes.index(axes), event.x / self.device_pixel_ratio)
        )
        self.update()

    def _leave(self, event: Any) -> None:
        self._pointer = None
        self.update()

    def paintEvent(self, event: Any) -> None:
        """Called by Qt; also draw a line at the pointer through all charts with the same x."""
        super().paintEvent(event)
        if self._pointer is None:
            return
        number, x = self._pointer
        painter = QtGui.QPainter(self)
        pen = QtGui.QPen(colours.ink())
        pen.setStyle(QtCore.Qt.DashLine)
        painter.setPen(pen)
        for index, place in enumerate(self.places):
            if index == number or share(self.charts):
                top, bottom = place.top, place.top + place.height
                painter.drawLine(QtCore.QPointF(x, top), QtCore.QPointF(x, bottom))
        painter.end()


class Toolbar(NavigationToolbar2QT):
    """matplotlib's toolbar of a view, in the window's language and colours.

    save: called by the save button. show_reading: called with the text for the pointer position.
    """

    def __init__(
        self, view: View, save: Callable[[], None], show_reading: Callable[[str], None]
    ) -> None:
        self.toolitems = [(name, tr(help), icon, method) for name, help, icon, method, _ in TOOLS]
        self._save, self._show_reading = save, show_reading
        super().__init__(view, None, coordinates=False)
        view.toolbar = self
        # frame around the active tool, whose icon is hardly visible on the theme's background
        self.setStyleSheet("QToolButton:checked { background: transparent; border: 1px solid; }")
        self.setIconSize(QtCore.QSize(ICON_SIZE, ICON_SIZE))
        for action, (name, *_, button) in zip(self.actions(), TOOLS, strict=False):
            action.setText("")
            self.widgetForAction(action).setAccessibleName(name)
            self.widgetForAction(action).setObjectName(button)
        self.pan()  # dragging pans the picture unless another tool is chosen

    def speak(self) -> None:
        """Show the tooltips in the window's language."""
        for action, (_, help, *_) in zip(self.actions(), TOOLS, strict=False):
            action.setToolTip(tr(help))

    def minimumSizeHint(self) -> Any:
        """Called by Qt; prevents buttons from hiding behind an arrow."""
        return self.sizeHint()

    def home(self, *_: Any) -> None:
        """Show the full range of all charts."""
        super().home()
        self.canvas.show_all()

    def set_message(self, s: str) -> None:
        """Called by matplotlib, whose own signal PySide2 does not find on Python 3.13."""
        # matplotlib also sends the name of the tool
        self._show_reading("" if s == self.mode else s)

    def save_figure(self, *_: Any) -> None:
        """Ask for a file and save to it."""
        self._save()

    def changeEvent(self, event: Any) -> None:
        """Called by Qt, among others when the colours of the window change."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange):
            for action, (_, _, icon, *_) in zip(self.actions(), TOOLS, strict=False):
                action.setIcon(self._icon(f"{icon}.png"))

    def _icon(self, name: str) -> Any:
        """Called by matplotlib; recolour its black icons in the text colour."""
        file = Path(matplotlib.get_data_path(), "images", name.replace(".png", "_large.png"))
        pixmap = QtGui.QPixmap(str(file))
        mask = pixmap.createMaskFromColor(QtGui.QColor("black"), QtCore.Qt.MaskOutColor)
        pixmap.fill(colours.ink())
        pixmap.setMask(mask)
        return QtGui.QIcon(pixmap)
