# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Redundancy Map dock: cells, curves and statistics; the edited curve can replace the joint
path's curve.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtGui

from ...core.issues import AmError
from ...core.planning import redundancy_curve as rotation_curve
from ...core.planning.redundancy_curve import Compared
from ...core.planning.task import Task
from ...core.types import Array
from ...objects.stage import stage_of
from ...objects.work import progress
from ...objects.work.progress import Cancelled
from .. import dock_area, preferences_watch, recorded
from ..dock_area import Lookout
from ..in_language import error_line, tr, translated, translated_error
from ..path import dock as path_dock
from ..path.path_view import PathView
from ..plots.saving import save_map
from ..simulation import dock as simulation_dock
from ..widgets.shape_inputs import job_named, job_selection
from ..widgets.steady import Scrolled
from ..worker import Background, Later, Work, Worker
from .beside import AXES, CURVES, Consequences, Controls, Figures, Form, readout
from .board import COLOURS, Board, Dragged, build_curves
from .draft import Draft, Source, source_of, status_of
from .painting import KINDS, Canvas, painted

# ---- Planning a toolpath by all methods


def comparison_work(source: Source, task: Task) -> Callable[[], tuple[Compared, ...]]:
    """Return work that plans the beads of the toolpath, from their own seams, by all methods.

    With external axes, the work plans the beads of the joint path, which hold their positions.
    """
    beads = source.beads if source.cell.external else tuple(bead for _, _, bead in source.toolpath)
    return lambda: rotation_curve.compared(task, beads, source.places, progress.report)


# ---- Compute the cells of a map in the background: first without the robot's links, then with a coarse
# link check, then with every row checked

ROUGH_STRIDE, FINE_STRIDE = 6, 1  # row stride of the link checks


class Cells:
    """Computes and shows cells. Calls `known` when more of a board is computed, and `drawn` when
    its cells are shown.
    """

    def __init__(
        self, form: Any, canvas: Canvas, on_known: Callable[[], None], drawn: Callable[[], None]
    ) -> None:
        self.canvas, self.known, self.drawn = canvas, on_known, drawn
        self.background = Background(form)

    def cancel(self) -> None:
        """Cancel the computation."""
        self.background.cancel()

    def show(self, board: Board, branch: int, kind: str) -> None:
        """Show a branch by margin or condition, after computing missing cells."""
        self.board, self.branch, self.kind = board, branch, kind
        if branch in board.pictures:
            self._draw()
            self._go_on()
            return
        self.canvas.set_map(None, board.marks, board.labels)

        def take(worker: Worker) -> None:
            board.take(worker.result())
            self.known()
            self._draw()
            self._go_on()

        self.background.start(lambda: board.compute(branch), take)

    def _go_on(self) -> None:
        """Check the robot's links until every row is checked."""
        board, branch = self.board, self.branch
        previous = board.looked.get(branch)
        if previous == FINE_STRIDE:
            self.background.cancel()
            return
        stride = ROUGH_STRIDE if previous is None else FINE_STRIDE

        def take(worker: Worker) -> None:
            board.take_arm(branch, worker.result(), stride)
            self._draw()
            self._go_on()

        self.background.start(lambda: board.arm(branch, stride), take)

    def _draw(self) -> None:
        board = self.board
        self.canvas.title = board.title
        self.canvas.heights = (
            None if board.pair is None else (board.pair.labels, board.pair.planned)
        )
        self.canvas.set_map(
            painted(board.pictures[self.branch], self.kind), board.marks, board.labels
        )
        self.drawn()


def jump(obj: Any, layer: int, position: Array) -> bool:
    """Go to the point in a layer of a joint path that is nearest to a position (3,), mm.

    Return whether the simulation or the path view followed.
    """
    simulated, followed = _simulation(obj, layer, position), _path(obj, layer, position)
    return simulated or followed


def _simulation(obj: Any, layer: int, position: Array) -> bool:
    for running in list(simulation_dock._open):
        motion = running.run.motion
        if running.run.document != obj.Document.Name or obj.Name not in running.run.objects:
            continue
        rows = np.flatnonzero(motion.deposit & (motion.layer == layer))
        if len(rows):
            distance = np.linalg.norm(motion.position[rows] - position, axis=1)
            running.player.go_to_row(int(rows[int(distance.argmin())]))
            running.play(False)
            return True
    return False


def _path(obj: Any, layer: int, position: Array) -> bool:
    """Show the layer up to the point in the joint path's view, if the path dock is open."""
    opened, view = path_dock.only.dock, obj.ViewObject.Proxy
    if (
        opened is None
        or not opened.dock.isVisible()
        or not isinstance(view, PathView)
        or view.rows is None
    ):
        return False
    start, end = view.rows.layer_rows(layer, layer)
    if end <= start:
        return False
    distance = np.linalg.norm(view.rows.points[start:end] - position, axis=1)
    begin = 0 if view.shown is None else min(view.shown[0], layer)
    view.show((begin, layer, int(distance.argmin()) + 1))
    opened.follow(obj)
    return True


NAME = "RoboticAM_SpinMap"
WIDTH_SHARE, HEIGHT = 0.85, 380  # fraction of the window's width; pixels


class RedundancyMapDock:
    """Shows the map of a joint path until the dock is closed or the joint path is deleted."""

    def __init__(self, obj: Any, closed: Callable[[RedundancyMapDock], None]) -> None:
        """closed: called when the dock closes."""
        self.obj, self.closed, self.gone = obj, closed, False
        self.dock = dock_area.dock(NAME, dock_area.BELOW, WIDTH_SHARE, HEIGHT)
        self.holder = QtGui.QStackedWidget()
        self.canvas = Canvas()
        self._build()
        self.cells = Cells(self.holder, self.canvas, self._fill_controls, self._show_curves)
        self.consequences = Consequences(self.holder, self.form, lambda: status_of(self.obj))
        self.comparison = Work(
            self.holder,
            self._show_compared,
            lambda text, _: self.form.tell(text),
            tr("Planning"),
        )
        self.renewing = Later(self.holder, self.renew)
        self.canvas.hovered, self.canvas.clicked = self._hovered, self._clicked
        self.canvas.dragged, self.canvas.dropped = self._dragged, self.consequences.exactly
        self.dock.hold("", Scrolled(self.holder))
        self.dock.closed = self.close
        self._take(source_of(obj))
        self.dock.come()
        self.lookout = Lookout(
            lambda: self.source, self._changed_object, lambda why, _: self.end(why)
        )
        preferences_watch.listen(self._renew_cells)
        preferences_watch.listen_to_language(self._speak)

    # ---- the fields

    def _build(self) -> None:
        """Build the fields around the canvas in the window's language."""
        self.controls = Controls(self._chosen, self._curve_chosen, self._entered)
        self.figures = Figures(self._show_curves)
        self.form = Form(self.canvas, self.controls, self.figures)
        self.form.buttons["save"].clicked.connect(
            lambda *_: save_map(self.board, self.draft.branch, self.canvas, self.obj)
        )
        for name, act in (
            ("use", self._use),
            ("free", self._free),
            ("again", self._again),
            ("compare", self._compare),
        ):
            self.form.buttons[name].clicked.connect(lambda *_, act=act: act())
        old_form = self.holder.currentWidget()
        self.holder.addWidget(self.form)
        self.holder.setCurrentWidget(self.form)
        if old_form is not None:
            self.holder.removeWidget(old_form)
            old_form.deleteLater()

    def _speak(self) -> None:
        """Rebuild in the window's new language; keep the choices."""
        old_controls, hidden = (
            self.controls,
            [name for name in self.figures.rows if not self.figures.shows(name)],
        )
        self._build()
        self.controls.kind.setCurrentIndex(old_controls.kind.currentIndex())
        self.controls.together.setChecked(old_controls.together.isChecked())
        self.consequences.form = self.form
        self._say_title()
        self._changed_for_good()
        self._show_compared(self.compared)
        for name in hidden:
            self.figures.hide_curve(name)
        self._renew_cells()

    def _say_title(self) -> None:
        self.dock.setWindowTitle(tr("Free rotation of {title}").format(title=self.source.title))

    def _name_compare(self) -> None:
        """Label the button with its current action."""
        self.form.buttons["compare"].setText(
            tr("Cancel") if self.comparison.runs else tr("Compare methods")
        )

    # ---- the joint path

    def _take(self, source: Source, board: Board | None = None) -> None:
        """Show the current plan of a joint path, at the layer and axis of another board."""
        self.source, self.draft = source, Draft(source)
        self._say_title()
        layers = {layer for layer, _ in source.places}
        layer = board.layer if board is not None and board.layer in layers else None
        self.board = Board(source, layer, AXES[0] if board is None else board.axis)
        self.bead = self.board.beads[0]
        self.clicked: dict[int, int] = {}  # last clicked point of each bead
        self.compared: tuple[Compared, ...] = ()
        self.comparison.cancel()
        self._name_compare()
        self.figures.clear_all()
        self.consequences.take(self.draft)
        self._changed_for_good()
        self._renew_cells()

    def renew(self) -> None:
        """Show the current joint path; close the map if it no longer has a result."""
        if self.gone:
            return
        try:
            self._take(source_of(self.obj), self.board)
        except (AmError, ReferenceError, RuntimeError, AttributeError) as error:
            self.end(translated_error(error))

    # ---- the cells

    def _renew_cells(self) -> None:
        """Show the picture of the branch, after computing it if missing."""
        self._fill_controls()
        self.cells.show(
            self.board, self.draft.branch, KINDS[max(self.controls.kind.currentIndex(), 0)]
        )

    def _fill_controls(self) -> None:
        self.controls.fill(self.board, self.draft, self.bead)

    def _chosen(self) -> None:
        """Show another layer, branch or axis, or other colours."""
        layer, axis, across, up = selection = self.controls.selection()
        branch = self.controls.branch.currentIndex()
        if selection != (self.board.layer, self.board.axis, self.board.across, self.board.up):
            if layer is not None and layer not in {number for number, _ in self.source.places}:
                self._fill_controls()
                return
            self.board = Board(
                self.source, layer, axis, across, (self.bead, self.clicked.get(self.bead)), up
            )
            beads = self.board.columns.bead
            self.bead = int(beads[np.abs(beads - self.bead).argmin()])
        if branch != self.draft.branch:
            self.draft.branch = branch
            self._changed_for_good()
        self._renew_cells()

    # ---- the curve

    def _together(self) -> list[int]:
        return (
            list(range(len(self.source.beads)))
            if self.controls.together.isChecked()
            else [self.bead]
        )

    def _curve_chosen(self) -> None:
        """Switch the kind of curve, the bead or the degree."""
        self.draft.kind = CURVES[self.controls.type.currentIndex()]
        self.bead = self.controls.bead.value()
        if self.controls.degree.value() != self.draft.degree:
            self.draft.set_degree(self.controls.degree.value())
        self._changed_for_good()

    def _entered(self, number: int, value: float) -> None:
        """Apply an entered coefficient, deg and deg per turn."""
        self.draft.enter(number, np.radians(value), self.bead, self._together())
        self._changed_for_good()

    def _dragged(self, drag: Dragged, by: float) -> None:
        """Apply a drag of the curve or of a handle."""
        draft, board = self.draft, self.board
        changed = board.change(draft, drag.column, drag.value - by, drag.value)
        if drag.handle is not None:
            draft.pull(drag.handle.bead, drag.handle.number, changed, self._together())
        else:
            self.bead = int(board.columns.bead[drag.column])
            draft.shift(changed, self._together())
        self._changed()

    # ---- statistics

    def _changed(self) -> None:
        """Show the statistics of the edited curve at once."""
        self.consequences.now()
        self._fill_controls()
        self._show_curves()

    def _changed_for_good(self) -> None:
        """Show the statistics of all points shortly after."""
        self._changed()
        self.consequences.exactly()

    def _show_curves(self) -> None:
        """Draw the visible curves."""
        self.canvas.set_curves(
            *build_curves(
                self.board,
                self.draft,
                self.bead,
                self.source.planned.beads,
                self.compared,
                self.consequences.followed,
                self.figures.shows,
            )
        )

    # ---- comparison of methods

    def _compare(self) -> None:
        """Plan all methods in the background, or cancel."""
        if self.comparison.runs:
            self.comparison.cancel()
            self._changed()
        else:
            task = self.source.task(self.draft.branch)
            self.comparison.start(comparison_work(self.source, task))
        self._name_compare()

    def _show_compared(self, compared: tuple[Compared, ...] | None) -> None:
        """Show an ended comparison; None: without a result."""
        self._name_compare()
        if compared:
            self.compared = compared
            self._changed()
        planned = self.consequences.planned_sums()
        for method in self.compared:
            help = "; ".join(translated(issue.message) for issue in method.issues[:3]) or tr(
                "no issues"
            )
            self.figures.set(
                method.name,
                translated(method.name),
                COLOURS[method.name],
                method.sums,
                planned,
                help=help,
            )
        self._show_curves()

    # ---- the mouse position

    def _hovered(self, column: int, value: float) -> None:
        self.form.readout.setText(
            readout(self.board.cell(self.draft.branch, column, value), self.source.cell.machine)
        )

    def _clicked(self, column: int, value: float) -> None:
        self.bead = int(self.board.columns.bead[column])
        self.clicked[self.bead] = int(self.board.columns.point[column])
        self._fill_controls()
        self._show_curves()
        with contextlib.suppress(ReferenceError, RuntimeError):  # the view is closed
            jump(self.obj, self.board.place(column)[0], self.board.columns.points.position[column])

    # ---- applying the curve

    def _use(self) -> None:
        self._change(self.draft.arguments())

    def _free(self) -> None:
        self._change({"method": "'layer-by-layer'", "given": "()", "own_branch": "'cell'"})

    def _again(self) -> None:
        self.draft.reset()
        self._changed_for_good()
        self._renew_cells()

    def _change(self, arguments: dict[str, str]) -> None:
        try:
            recorded.change(self.obj, arguments)
        except (AmError, Cancelled, ReferenceError) as error:
            self.form.tell(
                translated_error(error) or tr("Cancelled: the document is unchanged."), True
            )
            return
        self.renewing.timer.stop()
        self.renew()

    # ---- closing

    def close(self) -> None:
        """Close the map."""
        if self.gone:
            return
        self.gone = True
        self.lookout.stop()
        for listener in (self._renew_cells, self._speak):
            preferences_watch.forget(listener)
        for background in (self.cells, self.consequences, self.comparison):
            background.cancel()
        self.renewing.timer.stop()
        self.dock.empty()
        self.closed(self)

    def end(self, why: str) -> None:
        """Close the dock and show the reason."""
        if not self.gone:
            self.close()
            Gui.getMainWindow().statusBar().showMessage(
                tr("The map was closed: {why}").format(why=why), 8000
            )

    def _changed_object(self, obj: Any, name: str) -> None:
        if name in ("Key", "Label"):
            self.renewing.ask()


# ---- The tool that opens the Redundancy Map

_open: list[RedundancyMapDock] = []  # keeps the open dock alive; at most one


def show(obj: Any) -> RedundancyMapDock:
    """Close the open map and open the map of a joint path. Raises InputError if the path has no
    map.
    """
    source_of(obj)
    while _open:
        _open[0].close()
    _open.append(RedundancyMapDock(obj, _open.remove))
    return _open[0]


def redundancy_map() -> None:
    """Open the map of the selected joint path, program or job.

    Without such a selection, use the last joint path with a result.
    """
    selected = [path for path in map(_joint_path, job_selection()) if path is not None]
    if not selected and job_named():
        _say(
            tr(
                "{} has no joint path to map; make a joint path first, or select another job."
            ).format(job_named())
        )
        return
    candidates = [obj for obj in App.ActiveDocument.Objects if _joint_path(obj) is obj and obj.Key]
    if not selected and not candidates:
        _say(tr("There is no joint path to map; make a joint path first."))
        return
    try:
        show(selected[0] if selected else candidates[-1])
    except AmError as error:
        App.Console.PrintWarning(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)


def _joint_path(obj: Any) -> Any:
    stage = stage_of(obj)
    if stage is not None and stage.kind == "program":
        return obj.JointPath
    return obj if stage is not None and stage.kind == "joint path" else None


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
