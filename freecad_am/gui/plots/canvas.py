# SPDX-License-Identifier: LGPL-2.1-or-later
"""A widget that shows a picture or a text; matplotlib is imported for the first picture."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from PySide import QtCore, QtGui

from ...plots.chart import Chart, Picture, Quantity
from ..in_language import marked, sentence, tr, translated

if TYPE_CHECKING:
    from .view import Range, View


# standalone texts of pictures, which `plots` draws in English for reports
WORDS = (
    marked("Joint angles"),
    marked("Joint speeds"),
    marked("Joint speeds in %"),
    marked("Joint accelerations"),
    marked("Joint jerks"),
    marked("Condition"),
    marked("Speed along the path"),
    marked("Deposit rate"),
    marked("Deposited mass"),
    marked("Distance between layers"),
    marked("Predicted heights"),
    marked("Predicted widths and speeds"),
    marked("Fit of the bead widths"),
    marked("Width of beads"),
    marked("Joint speeds while depositing"),
    marked("Condition of the Jacobian (0 is singular)"),
    marked("Travel speed"),
    marked("Predicted width of the bead"),
    marked("Predicted height of the bead"),
    marked("Predicted height by layer"),
    marked("Sum of the heights, minus the planned layers"),
    marked("time"),
    marked("path"),
    marked("layer"),
    marked("angle"),
    marked("place"),
    marked("speed"),
    marked("acceleration"),
    marked("jerk"),
    marked("rate"),
    marked("mass"),
    marked("width"),
    marked("height"),
    marked("off"),
    marked("travel speed"),
    marked("local distance"),
    marked("share of the limit"),
    marked("share of the points"),
    marked("share of the length"),
    marked("rapid"),
    marked("deposit"),
    marked("limited by the axes"),
    marked("lowest"),
    marked("void"),
    marked("mean"),
    marked("highest"),
    marked("drift"),
    marked("least allowed"),
    marked("condition"),
    marked("layer height"),
    marked("a toolpath has no joints yet; choose a joint path"),
    marked("these layers have no values to show"),
    marked("the machine has no condition number"),
    marked("no limit known: the machine file has no max_speed"),
    marked("no limit known: the machine file has no max_acceleration"),
    marked("no limit known: the machine file has no max_jerk"),
    marked("Volume by layer"),
    marked("Section of the last layer"),
    marked("volume"),
    marked("share"),
    marked("part"),
    marked("deposited"),
    marked("bead"),
    marked("only solids in planar layers have sections and volumes of layers"),
    marked("no layer shown rests on another layer"),
    marked("no bead model sets the speeds (process.bead_model)"),
)


def in_words(picture: Picture, user_units: bool = True) -> Picture:
    """Translate a picture to the window's language; names, such as axis names, stay.

    user_units: whether quantities in the texts are in the user's units.
    """

    def translate_chart(chart: Chart) -> Chart:
        return replace(
            chart,
            title=translated(chart.title, user_units),
            x=Quantity(translated(chart.x.name), chart.x.unit),
            y=Quantity(translated(chart.y.name), chart.y.unit),
            curves=tuple(
                replace(curve, name=translated(curve.name, user_units)) for curve in chart.curves
            ),
            marks=tuple((value, translated(name)) for value, name in chart.marks),
            unlimited=translated(chart.unlimited),
            upright=tuple((value, translated(name)) for value, name in chart.upright),
        )

    return replace(
        picture,
        charts=tuple(map(translate_chart, picture.charts)),
        lacking=sentence(picture.lacking),
    )


PER_CHART = 92  # pixels; minimum height of a chart


class Canvas(QtGui.QWidget):
    """Shows charts in a `view.View`, or a text.

    interactive: whether the mouse zooms and reads values; also gives each chart a minimum height.
    """

    def __init__(self, interactive: bool = True) -> None:
        super().__init__()
        self.picture: Picture | None = None
        self.text = ""
        self.interactive = interactive
        self.view: View | None = None
        self.label = QtGui.QLabel()
        self.label.setAlignment(QtCore.Qt.AlignCenter)
        self.label.setWordWrap(True)
        self.label.setMargin(10)
        self.pages = QtGui.QStackedLayout(self)
        self.pages.addWidget(self.label)

    def show_picture(self, picture: Picture | None, text: str = "", keep: bool = False) -> None:
        """Show another picture, or a text instead. keep: whether to keep the visible range."""
        has_charts = picture is not None and bool(picture.charts)
        if has_charts and self.provide_view() is None:
            has_charts, text = False, tr("Plots need matplotlib, which is not installed.")
        self.picture, self.text = picture if has_charts else None, text
        self.label.setText(text)
        charts = self.picture.charts if self.picture is not None else ()
        if self.interactive:  # without charts, the text is centred in the visible area
            self.setMinimumHeight(PER_CHART * len(charts))
        if self.view is not None:
            self.view.show_charts(charts, keep)
        self.pages.setCurrentIndex(1 if charts else 0)

    def provide_view(self) -> View | None:
        """Return the view of the charts, created at the first call; None without matplotlib."""
        if self.view is None:
            try:
                from .view import View
            except ImportError:
                return None
            self.view = View(self.interactive)
            self.pages.addWidget(self.view)
        return self.view

    @property
    def ready(self) -> bool:
        """Whether the display is up to date."""
        return self.picture is None or (self.view is not None and bool(self.view.places))

    def ranges(self) -> tuple[dict[int, Range], dict[int, Range]]:
        """Return the x and y ranges that the user has chosen, by chart index."""
        return ({}, {}) if self.view is None else (dict(self.view.across), dict(self.view.up))

    def changeEvent(self, event: Any) -> None:
        """Called by Qt, among others when the colours of the window change."""
        super().changeEvent(event)
        changed = event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange)
        if changed and self.view is not None:
            self.view.draw_idle()
