# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock of a simulation: it plays a run and ends when an object of the run changes or is
deleted."""

from __future__ import annotations

import contextlib
import time
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .. import colours
from ..background import redraw
from ..docks import dock_area
from ..docks.dock_area import Lookout
from ..preferences import watch
from ..texts.in_language import tr
from .fields import Fields
from .player import Player, Run
from .scene import Scene

NAME = "RoboticAM_Simulation"
FRAME = 30  # ms
FIT = 150  # ms
MIN_WIDTH = 350  # pixels, at least


class Simulation:
    """Plays a run in a 3D view until the dock closes or an object of the run is deleted or
    recomputed."""

    def __init__(self, run: Run, view: Any) -> None:
        self.run, self.player = run, Player(run)
        self.scene: Scene | None = Scene(run, view)
        self.dock = dock_area.dock(NAME, dock_area.RIGHT)
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
        self.lookout = Lookout(lambda: self.run, self._changed_object, self.end, self.timer.stop)
        watch.listen(self._preferences_changed)
        watch.listen_to_language(self._speak)
        colours.listen(self._follow_theme)
        self.show()
        QtCore.QTimer.singleShot(
            FIT, self._fit
        )  # once the dock has its place and the view the rest

    # ---- the dock

    def _title(self) -> str:
        document = App.listDocuments().get(self.run.document)
        title = (
            self.run.title
            if document is None
            else tr("{} ({})").format(self.run.title, document.Label)
        )
        return tr("Simulation of {title}").format(title=title)

    def _speak(self) -> None:
        """The window has another language."""
        self._build()
        self.dock.setWindowTitle(self._title())
        self.fields.mark_play()
        self._preferences_changed()

    def _follow_theme(self) -> None:
        """The window is light or dark now."""
        self.fields.show_icons()
        self.fields.update()

    def _build(self) -> None:
        """The fields, in the language of the window."""
        acts = {
            "layer_back": lambda: self._step_layer(-1),
            "point_back": lambda: self._step(-1),
            "play": lambda: self.play(not self.player.playing),
            "point_on": lambda: self._step(1),
            "layer_on": lambda: self._step_layer(1),
            "next_finding": self._next_finding,
        }
        self.fields = Fields(self.run, self.player, self._slid, acts)
        self.scroll.setWidget(self.fields)  # remove the old widget
        self._reserve_width()
        self.fields.tell_finding(None)

    def _reserve_width(self) -> None:
        self.fields.reserve_width()
        bar = self.scroll.verticalScrollBar().sizeHint().width()
        self.scroll.setMinimumWidth(max(MIN_WIDTH, self.fields.minimumSizeHint().width() + bar))

    # ---- what the user does

    def play(self, on: bool) -> None:
        """Play, from the start when it is at the end, or pause."""
        if on and self.player.time >= self.run.times.total:
            self.player.go(0.0)
        self.player.playing = on
        self.before = time.perf_counter()
        (self.timer.start if on else self.timer.stop)()
        self.fields.mark_play()
        self.show()

    def _tick(self) -> None:
        now = time.perf_counter()
        self.player.advance(now - self.before)
        self.before = now
        if self.player.playing:
            self.show()
        else:
            self.play(False)

    def _slid(self, share: float) -> None:
        self.player.go(share * self.run.times.total)
        self.show()

    def _step(self, by: int) -> None:
        self.player.step(by)
        self.play(False)

    def _step_layer(self, by: int) -> None:
        self.player.step_layer(by)
        self.play(False)

    def _next_finding(self) -> None:
        finding = self.player.next_finding()
        self.play(False)
        self.fields.tell_finding(finding)

    def _fit(self) -> None:
        if self.scene is not None:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view was closed
                self._reserve_width()  # the current texts may be wider
                self.scene.view.fitAll()

    # ---- display

    def show(self) -> None:
        """Show the present moment."""
        if self.scene is None:
            return
        moment = self.player.moment()
        state = moment.state
        try:
            self.scene.show(
                moment.row, state.joints, state.position, not bool(state.standing), moment.links
            )
            redraw.schedule_redraw(self.scene.view)
        except (RuntimeError, ReferenceError):  # the view was closed
            self.end(tr("its view was closed"))
            return
        self.fields.tell(moment)

    def _preferences_changed(self) -> None:
        """Units of speeds, and the colour of the machine."""
        if self.scene is not None:
            self.scene.machine.renew_colours()
            self.show()
            self._reserve_width()
            findings = self.run.watch.findings
            self.fields.tell_finding(
                None if self.player.finding is None else findings[self.player.finding]
            )

    # ---- the end

    def close(self, document_goes: bool = False) -> None:
        """End it, and leave everything as it was."""
        scene, self.scene = self.scene, None
        if scene is None:
            return
        self.timer.stop()
        self.lookout.stop()
        for listener in (self._preferences_changed, self._speak):
            watch.forget(listener)
        colours.forget(self._follow_theme)
        scene.remove(document_goes)
        self.dock.empty()
        if self in _open:
            _open.remove(self)

    def end(self, why: str, document_goes: bool = False) -> None:
        """Close the dock and show the reason."""
        if self.scene is not None:
            self.close(document_goes)
            Gui.getMainWindow().statusBar().showMessage(
                tr("The simulation has ended: {why}.").format(why=why), 8000
            )

    def _changed_object(self, obj: Any, name: str) -> None:
        if name == "Key":
            self.timer.stop()
            text = tr("{label} was computed again").format(label=obj.Label)
            QtCore.QTimer.singleShot(0, lambda: self.end(text))


_open: list[Simulation] = []  # Python must keep it as long as it runs; there is one


def show(run: Run, view: Any) -> Simulation:
    """Play a run in a view, in place of the one that is played."""
    while _open:
        _open[0].close()
    simulation = Simulation(run, view)
    _open.append(simulation)
    return simulation
