# SPDX-License-Identifier: LGPL-2.1-or-later
"""A picture in the window: drawn in the background, zoomed and moved by mouse and wheel, read by
pointing."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from PySide import QtCore, QtGui

from ...plots.chart import Chart, Picture, Quantity
from ...plots.look import DARK, LIGHT, Look, Words
from .. import colours
from ..background.worker import Worker
from ..texts.in_language import marked, sentence, tr, translated
from .reading import Range, shift_range, text_at, zoomed

if TYPE_CHECKING:
    from ...plots.draw import Place


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
    marked("Sum of the heights, off the layers"),
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
    marked("as the axes can"),
    marked("lowest"),
    marked("mean"),
    marked("highest"),
    marked("drift"),
    marked("least allowed"),
    marked("condition"),
    marked("layer height"),
    marked("a toolpath has no joints yet; choose a joint path"),
    marked("these layers have nothing to show"),
    marked("this machine has no condition"),
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
    marked("none of these layers rests on another"),
    marked("no bead model sets the speeds (process.bead_model)"),
)


def frame_words() -> Words:
    """Return the texts of frames."""
    return Words(
        layer=tr("layer {}"),
        beyond=tr("{}: {} points beyond the limit"),
        limits=tr("limits {} to {} {}"),
        limit=tr("limits up to {} {}"),
    )


def in_words(picture: Picture, user_units: bool = True) -> Picture:
    """Translate a picture to the language of the window; names, such as axis names, stay.
    user_units: whether quantities in its texts are in the user's units."""

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


LOOK_EVERY = 20  # ms
STEP = 1.25  # of the wheel and of buttons
MIN_DRAG = 4  # pixels of a drag that is one
PER_CHART = 92  # pixels


@dataclass(frozen=True)
class Drawn:
    """A picture as it was drawn, and where its frames are."""

    image: Any
    charts: tuple[Chart, ...]
    places: tuple[Place, ...]
    shared: bool


class Canvas(QtGui.QWidget):
    """`say` receives the value at the pointer; the visible ranges of x and y are in `across` and
    `up`, by the number of a chart.

    A thread draws a picture; a request in the meantime is drawn next. The thread runs to its end:
    stopping matplotlib while it fills its caches is unsafe.
    """

    def __init__(self, interactive: bool = True) -> None:
        super().__init__()
        self.picture: Picture | None = None
        self.text = ""
        self.across: dict[int, Range] = {}
        self.up: dict[int, Range] = {}
        self.drawn: Drawn | None = None
        self.interactive = interactive
        self.by_rectangle = False
        self.say: Callable[[str], None] = lambda text: None
        self._worker: Worker | None = None
        self._again = False
        self._drag: tuple[int, Any, Any] | None = None  # chart, where it began, where it is
        self._pointer: Any = None
        self.setMouseTracking(interactive)
        self.timer = QtCore.QTimer(self)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)

    def show_picture(self, picture: Picture | None, text: str = "", keep: bool = False) -> None:
        """Show another picture, or a text instead. keep: whether to keep the visible range."""
        self.picture, self.text = picture if picture is not None and picture.charts else None, text
        if not keep:
            self.across, self.up = {}, {}
        if self.picture is None:
            self.drawn = None
            if self.interactive:
                self.setMinimumHeight(0)  # the text is in the middle, which would be out of sight
        elif self.interactive:
            self.setMinimumHeight(PER_CHART * len(self.picture.charts))
        self.update()
        self.draw()

    @property
    def ready(self) -> bool:
        """Whether the display is up to date."""
        return self._worker is None and (self.picture is None or self.drawn is not None)

    # ---- visible range

    def show_all(self) -> None:
        """Show all there is."""
        self.across, self.up = {}, {}
        self._changed()

    def zoom(self, factor: float, chart: int = 0, share: float = 0.5, up: bool = False) -> None:
        """Show 1 / factor of the visible range, about a point at `share` of the frame; zoom y with
        `up`, else of x."""
        if self.drawn is None:
            return
        frame, number = self.drawn.places[chart], self._across_of(chart)
        if up:
            self.up[chart] = zoomed(self.up.get(chart, frame.up), factor, share, None)
        else:
            self.across[number] = zoomed(
                self.across.get(number, frame.across), factor, share, self._most(chart)
            )
        self._changed()

    def _across_of(self, chart: int) -> int:
        return 0 if self.drawn is not None and self.drawn.shared else chart

    def _most(self, chart: int) -> Range:
        """All there is across."""
        assert self.drawn is not None
        charts = self.drawn.charts if self.drawn.shared else (self.drawn.charts[chart],)
        ends = [entry.across() for entry in charts]
        return min(low for low, _ in ends), max(high for _, high in ends)

    def _changed(self) -> None:
        self.update()
        self.draw()

    # ---- drawing

    def draw(self) -> None:
        """Draw the requested picture after the running one."""
        if self.picture is None or self.width() < MIN_DRAG or self.height() < MIN_DRAG:
            return
        if self._worker is not None:
            self._again = True
            return
        ratio, look, size = (
            float(self.devicePixelRatioF()),
            look_of(),
            (self.width(), self.height()),
        )
        charts, across, up = self.picture.charts, dict(self.across), dict(self.up)
        self._worker = Worker(lambda: _render(charts, look, size, ratio, across, up))
        self._again = False
        self.timer.start()

    def _look(self) -> None:
        worker = self._worker
        if worker is None or not worker.ended.is_set():
            return
        self._worker = None
        self.timer.stop()
        try:
            self._take(worker.result())
        except ImportError:
            self.show_picture(None, tr("Plots need matplotlib, which is not installed."))
            return
        with contextlib.suppress(RuntimeError):  # the widget is gone
            self.update()
            if self._again:
                self.draw()

    def _take(
        self, drawn: tuple[bytes, int, int, float, tuple[Chart, ...], tuple[Place, ...], bool]
    ) -> None:
        pixels, width, height, ratio, charts, frames, shared = drawn
        if self.picture is not None:
            image = QtGui.QImage(
                pixels, width, height, 4 * width, QtGui.QImage.Format_RGBA8888
            ).copy()
            image.setDevicePixelRatio(ratio)
            self.drawn = Drawn(image, charts, frames, shared)

    def resizeEvent(self, event: Any) -> None:
        """Called by Qt."""
        self.draw()

    def changeEvent(self, event: Any) -> None:
        """Called by Qt, among others when the colours of the window change."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange):
            QtCore.QTimer.singleShot(0, self._follow_theme)  # once all of the window has them

    def _follow_theme(self) -> None:
        with contextlib.suppress(RuntimeError):  # the canvas is gone
            self.update()
            self.draw()

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        painter = QtGui.QPainter(self)
        painter.fillRect(self.rect(), QtGui.QColor(look_of().paper))
        if self.drawn is None:
            painter.setPen(colours.ink())
            text = self.text if self.picture is None else tr("Drawing…")
            painter.drawText(
                self.rect().adjusted(20, 10, -20, -10),
                QtCore.Qt.AlignCenter | QtCore.Qt.TextWordWrap,
                text,
            )
        else:
            painter.drawImage(QtCore.QPointF(0.0, 0.0), self.drawn.image)
            self._overlay(painter)
        painter.end()

    def _overlay(self, painter: Any) -> None:
        """Where the pointer is, and the rectangle that is drawn up."""
        assert self.drawn is not None
        pen = QtGui.QPen(colours.ink())
        pen.setStyle(QtCore.Qt.DashLine)
        painter.setPen(pen)
        if self._drag is not None and self.by_rectangle:
            painter.drawRect(QtCore.QRect(self._drag[1], self._drag[2]).normalized())
        elif self._pointer is not None:
            number, x = self._chart_at(self._pointer), float(self._pointer.x())
            for index, frame in enumerate(self.drawn.places):
                if (
                    index == number or self.drawn.shared
                ) and frame.left <= x <= frame.left + frame.width:
                    painter.drawLine(
                        QtCore.QPointF(x, frame.top), QtCore.QPointF(x, frame.top + frame.height)
                    )

    # ---- called by Qt for the mouse

    def mousePressEvent(self, event: Any) -> None:
        """Begin to move or to draw up a rectangle."""
        if self.interactive and self.drawn is not None and event.button() == QtCore.Qt.LeftButton:
            self._drag = (self._chart_at(event.pos()), event.pos(), event.pos())

    def mouseMoveEvent(self, event: Any) -> None:
        """Move the range, or read the value at the pointer."""
        self._pointer = event.pos()
        if self.drawn is None or not self.interactive:
            return
        if self._drag is not None:
            number, start, previous = self._drag
            if not self.by_rectangle:
                self._move(number, event.pos().x() - previous.x(), event.pos().y() - previous.y())
            self._drag = (number, start, event.pos())
        self._read()
        self.update()

    def mouseReleaseEvent(self, event: Any) -> None:
        """Show what the rectangle holds."""
        if self._drag is None or self.drawn is None:
            return
        number, start, _ = self._drag
        self._drag = None
        if (
            self.by_rectangle
            and min(abs(event.pos().x() - start.x()), abs(event.pos().y() - start.y())) >= MIN_DRAG
        ):
            frame, box = (
                self.drawn.places[number],
                QtCore.QRectF(QtCore.QRect(start, event.pos()).normalized()),
            )
            self.across[self._across_of(number)] = (
                self._x(frame, box.left()),
                self._x(frame, box.right()),
            )
            self.up[number] = (self._y(frame, box.bottom()), self._y(frame, box.top()))
        self._changed()

    def mouseDoubleClickEvent(self, event: Any) -> None:
        """Show all there is."""
        if self.interactive:
            self.show_all()

    def leaveEvent(self, event: Any) -> None:
        """The pointer is elsewhere."""
        self._pointer = None
        self.say("")
        self.update()

    def wheelEvent(self, event: Any) -> None:
        """Zoom about the pointer: across, or up and down with Ctrl."""
        if not self.interactive or self.drawn is None:
            super().wheelEvent(event)
            return
        where, turns = event.position(), event.angleDelta().y() / 120.0
        number = self._chart_at(where)
        frame = self.drawn.places[number]
        up = bool(event.modifiers() & QtCore.Qt.ControlModifier)
        share = (
            (frame.top + frame.height - where.y()) / frame.height
            if up
            else (where.x() - frame.left) / frame.width
        )
        self.zoom(STEP**turns, number, min(max(share, 0.0), 1.0), up)
        event.accept()

    def _move(self, number: int, right: float, down: float) -> None:
        assert self.drawn is not None
        frame, across = self.drawn.places[number], self._across_of(number)
        if across in self.across:
            low, high = self.across[across]
            self.across[across] = shift_range(
                (low, high), -right / frame.width * (high - low), self._most(number)
            )
        if number in self.up:
            low, high = self.up[number]
            self.up[number] = shift_range((low, high), down / frame.height * (high - low), None)
        self.draw()

    def _chart_at(self, where: Any) -> int:
        """The chart a place of the widget belongs to."""
        assert self.drawn is not None
        ends = [frame.top + frame.height for frame in self.drawn.places]
        return next((number for number, end in enumerate(ends) if where.y() <= end), len(ends) - 1)

    def _x(self, frame: Place, left: float) -> float:
        return frame.across[0] + (left - frame.left) / frame.width * (
            frame.across[1] - frame.across[0]
        )

    def _y(self, frame: Place, top: float) -> float:
        return frame.up[1] - (top - frame.top) / frame.height * (frame.up[1] - frame.up[0])

    def _read(self) -> None:
        if self.drawn is None or self._pointer is None:
            return
        number = self._chart_at(self._pointer)
        frame = self.drawn.places[number]
        inside = frame.left <= self._pointer.x() <= frame.left + frame.width
        self.say(
            text_at(self.drawn.charts[number], self._x(frame, self._pointer.x())) if inside else ""
        )


def look_of() -> Look:
    """The look of plots in the present theme of the window, and in its language."""
    return dataclasses.replace(DARK if colours.is_dark() else LIGHT, words=frame_words())


def _render(
    charts: tuple[Chart, ...],
    look: Look,
    size: tuple[int, int],
    ratio: float,
    across: Mapping[int, Range],
    up: Mapping[int, Range],
) -> tuple[bytes, int, int, float, tuple[Chart, ...], tuple[Place, ...], bool]:
    """Draw with matplotlib, in the background because its import is slow."""
    from ...plots import draw, files

    figure, frames = draw.figure(charts, look, *size, draw.Window(across, up))
    return (*files.pixels(figure, ratio), ratio, charts, frames, draw.share(charts))
