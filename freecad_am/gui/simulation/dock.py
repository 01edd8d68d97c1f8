# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock of a simulation: plays, tells, and ends when what it plays changes or goes."""

from __future__ import annotations

import contextlib
import time
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ..background import redraw
from ..colours import WRONG
from ..docks import places
from ..preferences import watch
from ..texts.translation import tr
from ..widgets.steady import SteadyLabel
from . import told
from .bars import JointBars
from .player import Moment, Player
from .run import Run
from .scene import Scene

NAME = "RoboticAM_Simulation"
FRAME = 30  # ms
FIT = 150  # ms
WIDE = 350  # pixels, at least
STEPS = 10_000  # of the slider
FACTORS = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 50.0, 100.0, 500.0)


class Simulation:
    """Plays a run in a 3D view until it is closed, or until something it plays is gone or computed anew."""

    def __init__(self, run: Run, view: Any) -> None:
        self.run, self.player = run, Player(run)
        self.scene: Scene | None = Scene(run, view)
        self.filling = False
        self.dock = places.dock(NAME, places.RIGHT)
        self.scroll = QtGui.QScrollArea()
        self.scroll.setWidgetResizable(True)
        self.scroll.setFrameShape(QtGui.QFrame.NoFrame)
        self.timer = QtCore.QTimer(self.scroll)
        self.timer.setInterval(FRAME)
        self.timer.timeout.connect(self._tick)
        self.before = 0.0
        self._build()
        self.dock.hold(self._title(), self.scroll)
        self.dock.closed = self.close
        self.dock.come()
        App.addDocumentObserver(self)
        watch.listen(self._preferences_changed)
        watch.listen_to_language(self._speak)
        self.show()
        QtCore.QTimer.singleShot(FIT, self._fit)  # once the dock has its place and the view the rest

    # ---- the dock

    def _title(self) -> str:
        document = App.listDocuments().get(self.run.document)
        of = self.run.title if document is None else tr("{} ({})").format(self.run.title, document.Label)
        return tr("Simulation of {title}").format(title=of)

    def _speak(self) -> None:
        """The window has another language."""
        self._build()
        self.dock.setWindowTitle(self._title())
        self._mark_play()
        self._preferences_changed()

    def _build(self) -> None:
        """The fields, in the language of the window."""
        form = QtGui.QWidget()
        form.setObjectName("form")
        column = QtGui.QVBoxLayout(form)
        column.setContentsMargins(8, 6, 8, 6)
        machine, limits = self.run.cell.machine, self.run.cell.limits
        units = machine.unit_values
        axes = len(machine.axes)
        self.bars = JointBars(machine.axes, machine.units, limits.lower[:axes] / units, limits.upper[:axes] / units)
        self.slider = QtGui.QSlider(QtCore.Qt.Horizontal)
        self.slider.setObjectName("time")
        self.slider.setRange(0, STEPS)
        self.slider.setPageStep(STEPS // 20)
        self.slider.setToolTip(tr("The time of the job"))
        self.slider.valueChanged.connect(self._slid)
        self.told = {name: SteadyLabel(name) for name in ("clock", "place", "doing", "speed", "condition")}
        self.finding = self._label("finding")
        self.finding.setWordWrap(True)
        self.finding.setMinimumHeight(2 * self.finding.fontMetrics().height() + 4)
        self.finding.setAlignment(QtCore.Qt.AlignTop)
        line = QtGui.QHBoxLayout()
        line.addWidget(self.told["clock"])
        line.addStretch(1)
        line.addWidget(self.told["place"])
        if self.run.stale:
            stale = self._label("stale", tr("This is an earlier plan; recompute the document for the present one."))
            stale.setWordWrap(True)
            stale.setStyleSheet(f"QLabel {{ color: {WRONG}; }}")
            column.addWidget(stale)
        column.addWidget(self.slider)
        column.addLayout(line)
        column.addLayout(self._buttons())
        column.addWidget(self.finding)
        column.addWidget(self.bars)
        column.addLayout(self._facts())
        column.addWidget(self._totals())
        column.addStretch(1)
        self.scroll.setWidget(form)  # what was there goes
        self._make_room()
        self._tell_finding(None)

    def _make_room(self) -> None:
        """As wide as what is told becomes, in the language and the units of now."""
        for name, texts in told.widest(self.run).items():
            self.told[name].make_room(texts)
        bar = self.scroll.verticalScrollBar().sizeHint().width()
        self.scroll.setMinimumWidth(max(WIDE, self.scroll.widget().minimumSizeHint().width() + bar))

    def _label(self, name: str, text: str = "") -> Any:
        label = QtGui.QLabel(text)
        label.setObjectName(name)
        return label

    def _buttons(self) -> Any:
        line, style = QtGui.QHBoxLayout(), QtGui.QStyle
        line.setSpacing(2)
        marks = (
            ("layer_back", style.SP_MediaSkipBackward, tr("Back to the start of the layer"),
             lambda *_: self._step_layer(-1)),
            ("point_back", style.SP_MediaSeekBackward, tr("One point back"), lambda *_: self._step(-1)),
            ("play", style.SP_MediaPlay, tr("Play or pause"), lambda *_: self.play(not self.player.playing)),
            ("point_on", style.SP_MediaSeekForward, tr("One point on"), lambda *_: self._step(1)),
            ("layer_on", style.SP_MediaSkipForward, tr("On to the next layer"), lambda *_: self._step_layer(1)),
        )
        self.buttons = {}
        for name, mark, help, act in marks:
            button = QtGui.QToolButton()
            button.setObjectName(name)
            button.setIcon(self.dock.style().standardIcon(mark))
            button.setToolTip(help)
            button.clicked.connect(act)
            line.addWidget(button)
            self.buttons[name] = button
        self.factor = QtGui.QComboBox()
        self.factor.setObjectName("factor")
        self.factor.setToolTip(tr("How many seconds of the job pass in one"))
        self.factor.addItems([f"{factor:g} ×" for factor in FACTORS])
        self.factor.setCurrentIndex(FACTORS.index(self.player.factor))
        self.factor.currentIndexChanged.connect(self._set_factor)
        self.next = QtGui.QPushButton(tr("Next finding"))
        self.next.setObjectName("next_finding")
        self.next.setToolTip(tr("To the next place where a limit, a singularity or a speed is to be looked at"))
        self.next.clicked.connect(self._next_finding)
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
            grid.addWidget(self.told[name], row, 1, QtCore.Qt.AlignLeft)
        grid.setColumnStretch(1, 1)
        return grid

    def _totals(self) -> Any:
        box = QtGui.QGroupBox(tr("The whole job"))
        box.setObjectName("totals")
        grid = QtGui.QGridLayout(box)
        grid.setVerticalSpacing(1)
        for row, (name, value) in enumerate(told.totals(self.run)):
            grid.addWidget(QtGui.QLabel(name), row, 0)
            grid.addWidget(QtGui.QLabel(value), row, 1)
        grid.setColumnStretch(1, 1)
        return box

    # ---- what the user does

    def play(self, on: bool) -> None:
        """Play, from the start when it is at the end, or pause."""
        if on and self.player.time >= self.run.times.total:
            self.player.go(0.0)
        self.player.playing = on
        self.before = time.perf_counter()
        (self.timer.start if on else self.timer.stop)()
        self._mark_play()
        self.show()

    def _mark_play(self) -> None:
        mark = QtGui.QStyle.SP_MediaPause if self.player.playing else QtGui.QStyle.SP_MediaPlay
        self.buttons["play"].setIcon(self.dock.style().standardIcon(mark))

    def _tick(self) -> None:
        now = time.perf_counter()
        self.player.advance(now - self.before)
        self.before = now
        if self.player.playing:
            self.show()
        else:
            self.play(False)

    def _slid(self, value: int) -> None:
        if not self.filling:
            self.player.go(value / STEPS * self.run.times.total)
            self.show()

    def _step(self, by: int) -> None:
        self.player.step(by)
        self.play(False)

    def _step_layer(self, by: int) -> None:
        self.player.step_layer(by)
        self.play(False)

    def _next_finding(self, *_: Any) -> None:
        found = self.player.next_finding()
        self.play(False)
        self._tell_finding(found)

    def _set_factor(self, index: int) -> None:
        self.player.factor = FACTORS[index]

    def _fit(self) -> None:
        if self.scene is not None:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view was closed
                self._make_room()  # the fields are wider with what is told by now
                self.scene.view.fitAll()

    # ---- what is shown

    def show(self) -> None:
        """Show the present moment."""
        if self.scene is None:
            return
        moment = self.player.moment()
        state = moment.state
        try:
            self.scene.show(moment.row, state.joints, state.position, not bool(state.standing), moment.links)
            redraw.with_fields(self.scene.view)
        except (RuntimeError, ReferenceError):  # the view was closed
            self.end(tr("its view was closed"))
            return
        self._tell(moment)

    def _tell(self, moment: Moment) -> None:
        self.filling = True
        self.slider.setValue(round(self.player.time / max(self.run.times.total, 1e-9) * STEPS))
        self.filling = False
        self.told["clock"].tell(told.times(self.run, self.player.time))
        self.told["place"].tell(told.place(self.run, moment))
        self.bars.set(moment.values, moment.margins, moment.ratios, moment.bad)
        speed, kept = told.speed(moment)
        for name, text, good in (
            ("doing", told.doing(self.run, moment), bool(np.isfinite(moment.state.joints).all())), ("speed", speed, kept),
            ("condition", told.condition(moment), not moment.singular),
        ):
            label = self.told[name]
            label.tell(text)
            sheet = "" if good else f"QLabel {{ color: {WRONG}; }}"
            if label.styleSheet() != sheet:
                label.setStyleSheet(sheet)

    def _tell_finding(self, found: Any) -> None:
        count = len(self.run.watch.findings)
        if found is None:
            text = tr("{count} findings").format(count=count) if count else told.nothing(self.run)
        else:
            limit = found.label in self.run.cell.machine.axes
            unit = self.run.cell.machine.units[self.run.cell.machine.axes.index(found.label)] if limit else "deg"
            text = f"{(self.player.finding or 0) + 1}/{count}: {told.finding(found, unit)}"
        self.finding.setText(text)
        self.finding.setStyleSheet(f"QLabel {{ color: {WRONG}; }}" if found is not None else "")

    def _preferences_changed(self) -> None:
        """Units of speeds, and the colour of the machine."""
        if self.scene is not None:
            self.scene.machine.renew_colours()
            self.show()
            self._make_room()
            findings = self.run.watch.findings
            self._tell_finding(None if self.player.finding is None else findings[self.player.finding])

    # ---- the end

    def close(self, document_goes: bool = False) -> None:
        """End it, and leave everything as it was."""
        scene, self.scene = self.scene, None
        if scene is None:
            return
        self.timer.stop()
        App.removeDocumentObserver(self)
        for listener in (self._preferences_changed, self._speak):
            watch.forget(listener)
        scene.remove(document_goes)
        self.dock.empty()
        if self in _open:
            _open.remove(self)

    def end(self, why: str, document_goes: bool = False) -> None:
        """End it by itself, and say why."""
        if self.scene is not None:
            self.close(document_goes)
            Gui.getMainWindow().statusBar().showMessage(tr("The simulation has ended: {why}.").format(why=why), 8000)

    def _end_soon(self, why: str) -> None:
        self.timer.stop()
        QtCore.QTimer.singleShot(0, lambda: self.end(why))

    # ---- called by FreeCAD

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is closed."""
        if document.Name == self.run.document:
            self.end(tr("the document was closed"), True)

    def slotDeletedObject(self, obj: Any) -> None:
        """An object is deleted."""
        if self._plays(obj):
            self._end_soon(tr("{label} was deleted").format(label=obj.Label))

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """A property of an object has changed."""
        if name == "Key" and self._plays(obj):
            self._end_soon(tr("{label} was computed anew").format(label=obj.Label))

    def _plays(self, obj: Any) -> bool:
        return self.scene is not None and obj.Name in self.run.objects and obj.Document.Name == self.run.document


_open: list[Simulation] = []  # Python must keep it as long as it runs; there is one


def show(run: Run, view: Any) -> Simulation:
    """Play a run in a view, in place of the one that is played."""
    while _open:
        _open[0].close()
    simulation = Simulation(run, view)
    _open.append(simulation)
    return simulation
