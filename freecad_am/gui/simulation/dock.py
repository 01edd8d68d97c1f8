# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock of a simulation, and its tool. The dock plays a run and ends when an object of the run
changes or is deleted.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

from ...core.geometry import frames
from ...core.issues import AmError
from ...core.kinematics.links.self_collision import NONE
from ...core.simulation.table_links import Placing, at_rest, heights, placing
from ...core.toolpath import Bead
from ...core.types import Array, Mask
from ...objects.stage import stage_of
from ...objects.work import hooks
from ...objects.work.progress import Cancelled
from .. import colours, dock_area, preferences_watch
from ..dock_area import Lookout, schedule_redraw
from ..in_language import error_line, tr, translated_error
from ..nodes.cell import (
    NOZZLE,
    PLATFORM,
    ExternalLinkNodes,
    MachineNodes,
    coloured,
    holder_node,
    move,
    nozzle_node,
    plain_links,
    platform_nodes,
    resting_point,
)
from ..nodes.lines import Lines, fill
from ..path.pieces import PathNodes, Rows
from ..widgets.shape_inputs import job_named, job_selection
from .fields import Fields
from .player import Player, Run, prepared

# ---- The scene of a simulation: the whole document moves with the part, surrounded by machine and
# nozzle

METAL_COLOUR, SLOW_COLOUR, WRONG_COLOUR = (0.62, 0.66, 0.72), (0.96, 0.55, 0.05), (0.86, 0.1, 0.12)
TO_COME = (0.5, 0.52, 0.56)
OURS = ("toolpath", "joint path", "cell")


class Scene:
    """Nodes in a 3D view, from construction until `remove`."""

    def __init__(self, run: Run, view: Any) -> None:
        self.run, self.view = run, view
        cell, mount = run.cell, run.cell.poses.mount
        resting = placing(cell, at_rest(cell, resting_point(run.toolpath, mount)))
        self.to_view = frames.inverse(resting.part)
        looks = run.looks
        self.machine = MachineNodes(
            cell.robot, plain_links(cell.robot, looks.platform_diameter, looks.nozzle.length)
        )
        self.external_links = ExternalLinkNodes(cell.shapes.external_links)
        self.part, self.nozzle = coin.SoMatrixTransform(), coin.SoMatrixTransform()
        self.part_matrix, self.nozzle_matrix = self.part.matrix, self.nozzle.matrix
        self.deposit, self.to_come = PathNodes(), PathNodes()
        self.deposit.as_tubes, self.to_come.style.lineWidth = True, 1.0
        self.last, self.growing = (
            Lines(3.0, METAL_COLOUR),
            False,
        )  # the current segment, and whether there is one
        self.last.set(np.zeros((2, 3)), [2])
        self.last.show(False)
        self.last_points = self.last.coordinates.point
        self.root = coin.SoSeparator()
        nozzle, part_node = coin.SoSeparator(), coin.SoSeparator()
        nozzle.addChild(self.nozzle)
        for node in (nozzle_node(run.looks), holder_node(run.looks)):
            nozzle.addChild(coloured(NOZZLE, node))
        part_node.addChild(self.part)
        platform = coin.SoSeparator()
        for child in platform_nodes(run.looks, mount):
            platform.addChild(child)
        for child in (
            self.deposit.node,
            self.last.node,
            self.to_come.node,
            coloured(PLATFORM, platform),
        ):
            part_node.addChild(child)
        for child in (self.machine.node, self.external_links.node, nozzle, part_node):
            self.root.addChild(child)
        self._place(resting)  # pose of the machine until a point is reached
        self._fill()
        self.camera, self.camera_text = view.getCameraNode().copy(), view.getCamera()
        self.graph = view.getSceneGraph()
        self.graph.insertChild(self.root, 0)
        self.graph.insertChild(self.part, 1)
        self.hidden = _hide_ours(run.document)

    def _fill(self) -> None:
        """Fill the deposit, with one row for each deposit row of the motion.

        Metal colour by default, orange where the speed is not kept, red where something is wrong.
        """
        motion = self.run.motion
        deposit = motion.deposit
        self.rows_before = np.concatenate([[0], np.cumsum(deposit)])
        beads = _beads(self.run)
        rows = Rows.of(
            beads, _layers(self.run), self.run.width, lambda: self.run.toolpath.layer_height
        )
        colours = np.tile(METAL_COLOUR, (len(rows), 1))
        slowed, wrong = self.run.feed.slowed[deposit], _wrong(self.run)[deposit]
        colours[slowed], colours[wrong] = SLOW_COLOUR, WRONG_COLOUR
        self.deposit.set(rows)
        self.deposit.paint(colours)
        self.deposit.show(0, 0)
        self.to_come.set(rows)
        plain = np.tile(TO_COME, (len(rows), 1))
        plain[slowed], plain[wrong] = SLOW_COLOUR, WRONG_COLOUR
        self.to_come.paint(plain)

    # ---- frames

    def show(self, row: int, joints: Array, position: Array, running: bool, bad: Mask) -> None:
        """Show the state on the way to a row, or at the row. joints: (axes,), NaN keeps the
        machine's pose.
        """
        if np.isfinite(joints).all():
            self._place(placing(self.run.cell, joints))
        robot_links = len(self.machine.bad)
        self.machine.paint(bad[:robot_links])
        self.external_links.paint(bad[robot_links:])
        row_count = int(self.rows_before[row if running else row + 1])
        if row_count != self.deposit.end:
            self.deposit.show(0, row_count)
            rows = self.deposit.rows
            # from the last point, unless the bead has ended there
            self.to_come.show(
                max(row_count - 1, int(rows.starts[rows.bead_of(row_count)])), len(rows)
            )
        motion = self.run.motion
        growing = running and row > 0 and bool(motion.deposit[row] and motion.deposit[row - 1])
        if growing != self.growing:
            self.growing = growing
            self.last.show(growing)
        if growing:
            fill(self.last_points, np.stack([motion.position[row - 1], position]))

    def _place(self, pose: Placing) -> None:
        self.machine.pose(self.to_view @ pose.links)
        self.external_links.pose(self.to_view @ pose.external_links)
        move(self.part_matrix, self.to_view @ pose.part)
        move(self.nozzle_matrix, self.to_view @ pose.nozzle)

    # ---- closing

    def remove(self, document_goes: bool = False) -> None:
        """Restore the view. The view may already be deleted; a closing document needs no restoring."""
        with contextlib.suppress(RuntimeError, ReferenceError):
            for node in (self.root, self.part):
                if self.graph.findChild(node) >= 0:
                    self.graph.removeChild(node)
        if document_goes:
            return
        _show_again(self.run.document, self.hidden)
        with contextlib.suppress(RuntimeError, ReferenceError):
            camera = self.view.getCameraNode()
            if camera.getTypeId() == self.camera.getTypeId():
                camera.copyFieldValues(self.camera)
            else:  # switched between perspective and orthographic meanwhile
                self.view.setCamera(self.camera_text)


def _wrong(run: Run) -> Mask:
    """Return the rows (n,) beyond a limit, near a singularity, out of reach, or with a touching
    link.
    """
    wrong: Mask = (
        run.watch.past | run.watch.singular | (run.watch.touching != NONE) | ~run.motion.reachable
    )
    return wrong


def _beads(run: Run) -> list[Bead]:
    """Return the beads of the run, one for every stretch of deposit rows, with these rows as
    points.

    The beads have their predicted height if it is known.
    """
    motion = run.motion
    height = None if run.deposit is None else heights(run.deposit, motion.position, motion.layer)
    rows = np.flatnonzero(motion.deposit)
    stretches = np.split(rows, np.flatnonzero(motion.point[rows] == 0)[1:])
    return [
        Bead(
            points=motion.position[stretch],
            build=motion.build[stretch],
            tool=motion.tool[stretch],
            parameter=np.arange(len(stretch)),
            speed=motion.speed[stretch],
            closed=False,
            width=None if np.isnan(motion.width[stretch]).any() else motion.width[stretch],
            height=None if height is None or np.isnan(height[stretch]).any() else height[stretch],
        )
        for stretch in stretches
    ]


def _layers(run: Run) -> Sequence[int]:
    motion = run.motion
    starts = motion.deposit & (motion.point == 0)
    return [int(layer) for layer in motion.layer[starts]]


def _hide_ours(document: str) -> dict[str, int]:
    """Hide the objects that the simulation draws itself, without changing properties.

    Return the previous switch states by object name.
    """
    hidden = {}
    for obj in App.getDocument(document).Objects:
        stage = stage_of(obj)
        if stage is not None and stage.kind in OURS and obj.ViewObject.Visibility:
            switch = obj.ViewObject.SwitchNode
            hidden[obj.Name] = int(switch.whichChild.getValue())
            switch.whichChild = coin.SO_SWITCH_NONE
    return hidden


def _show_again(document: str, hidden: dict[str, int]) -> None:
    if document not in App.listDocuments():
        return
    for name, child in hidden.items():
        obj = App.getDocument(document).getObject(name)
        if obj is not None and obj.ViewObject.Visibility:
            obj.ViewObject.SwitchNode.whichChild = child


NAME = "RoboticAM_Simulation"
FRAME = 30  # ms
FIT = 150  # ms
MIN_WIDTH = 350  # pixels; minimum width


class Simulation:
    """Plays a run in a 3D view until the dock closes, or an object of the run is deleted or
    recomputed.
    """

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
        preferences_watch.listen(self._preferences_changed)
        preferences_watch.listen_to_language(self._speak)
        colours.listen(self._follow_theme)
        self.show()
        QtCore.QTimer.singleShot(
            FIT, self._fit
        )  # after the dock and the view have their final sizes

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
        """Rebuild in the window's new language."""
        self._build()
        self.dock.setWindowTitle(self._title())
        self.fields.mark_play()
        self._preferences_changed()

    def _follow_theme(self) -> None:
        """Adapt to a light or dark theme."""
        self.fields.show_icons()
        self.fields.update()

    def _build(self) -> None:
        """Build the fields in the window's language."""
        acts = {
            "layer_back": lambda: self._step_layer(-1),
            "point_back": lambda: self._step(-1),
            "play": lambda: self.play(not self.player.playing),
            "point_on": lambda: self._step(1),
            "layer_on": lambda: self._step_layer(1),
            "next_finding": self._next_finding,
        }
        self.fields = Fields(self.run, self.player, self._slid, acts)
        self.scroll.setWidget(self.fields)  # removes the old widget
        self._reserve_width()
        self.fields.tell_finding(None)

    def _reserve_width(self) -> None:
        self.fields.reserve_width()
        bar = self.scroll.verticalScrollBar().sizeHint().width()
        self.scroll.setMinimumWidth(max(MIN_WIDTH, self.fields.minimumSizeHint().width() + bar))

    # ---- user actions

    def play(self, on: bool) -> None:
        """Play, from the start if at the end, or pause."""
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
        """Show the current moment."""
        if self.scene is None:
            return
        moment = self.player.moment()
        state = moment.state
        try:
            self.scene.show(
                moment.row, state.joints, state.position, not bool(state.standing), moment.links
            )
            schedule_redraw(self.scene.view)
        except (RuntimeError, ReferenceError):  # the view was closed
            self.end(tr("the view was closed"))
            return
        self.fields.tell(moment)

    def _preferences_changed(self) -> None:
        """Update speed units and machine colour."""
        if self.scene is not None:
            self.scene.machine.renew_colours()
            self.show()
            self._reserve_width()
            findings = self.run.watch.findings
            self.fields.tell_finding(
                None if self.player.finding is None else findings[self.player.finding]
            )

    # ---- closing

    def close(self, document_goes: bool = False) -> None:
        """End the simulation and restore the view."""
        scene, self.scene = self.scene, None
        if scene is None:
            return
        self.timer.stop()
        self.lookout.stop()
        for listener in (self._preferences_changed, self._speak):
            preferences_watch.forget(listener)
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


_open: list[Simulation] = []  # keeps the running simulation alive; at most one


def show(run: Run, view: Any) -> Simulation:
    """Play a run in a view; end a running simulation."""
    while _open:
        _open[0].close()
    simulation = Simulation(run, view)
    _open.append(simulation)
    return simulation


# ---- The tool that opens a simulation

SIMULATED_KINDS = ("program", "joint path")


def simulate() -> None:
    """Simulate the selected joint path, program or job.

    Without such a selection, use the document's last joint path with a result.
    """
    selected = [obj for obj in job_selection() if _kind(obj) in SIMULATED_KINDS]
    if not selected and job_named():
        _say(
            tr(
                "{} has no joint path to simulate; make a joint path first, or select another job."
            ).format(job_named())
        )
        return
    candidates = [
        obj for obj in App.ActiveDocument.Objects if _kind(obj) == "joint path" and obj.Key
    ]
    if selected or candidates:
        simulate_object(selected[0] if selected else candidates[-1])
    else:
        _say(tr("There is no joint path to simulate; make a joint path first."))


def simulate_object(obj: Any) -> None:
    """Simulate a joint path or a program in a 3D view of its document; errors go to the status bar.

    A long run is prepared in the background and can be cancelled.
    """
    name = obj.Document.Name
    document = Gui.getDocument(obj.Document.Name)
    views = document.mdiViewsOfType("Gui::View3DInventor")
    active = document.activeView()
    view = active if hasattr(active, "getSceneGraph") else views[0] if views else None
    if view is None:
        _say(tr("There is no 3D view for the simulation; open a 3D view."))
        return
    try:
        run = hooks.carry_out(prepared(obj), tr("Simulation"))
    except AmError as error:
        App.Console.PrintError(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)
        return
    except Cancelled:
        return
    # events were handled meanwhile
    if name in App.listDocuments() and all(map(App.getDocument(name).getObject, run.objects)):
        show(run, view)


def _kind(obj: Any) -> str:
    stage = stage_of(obj)
    return "" if stage is None else stage.kind


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
