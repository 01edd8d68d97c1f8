# SPDX-License-Identifier: LGPL-2.1-or-later
"""The placement dock, and the tool that opens it."""

from __future__ import annotations

import contextlib
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

from ...core.geometry import frames
from ...core.issues import AmError
from ...core.kinematics import cell as cells
from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters.cell import CellParameters
from ...core.parameters.place import PLATFORM, POSITIONER, SIDES, PlaceParameters
from ...core.placement.place import Placed, pose_of
from ...core.placement.reach import Reach, reach
from ...core.simulation.table_links import at_rest, placing
from ...core.toolpath import Toolpath
from ...core.types import Array
from ...objects import user_machines
from ...objects.checks.placed import Placing, change_parameters, placing_of
from ...objects.fields.preferences import in_user_units
from ...objects.fields.rows import flat, rows
from ...objects.stage import stage_of
from ...objects.work import progress
from ...objects.work.progress import Cancelled
from .. import dock_area, preferences_watch, recorded
from ..colours import INVALID, PLAIN, ramp, set_role
from ..dock_area import Lookout
from ..in_language import error_line, tr, translated_error
from ..nodes.cell import CellNodes, machine_scenery, resting_point
from ..nodes.lines import Lines, fill, unshaded
from ..nodes.wall import unpickable
from ..widgets import fields
from ..widgets.fold import Fold
from ..widgets.shape_inputs import job_named, job_selection
from ..worker import Work
from . import figures
from .figures import Coloured

# ---- A placement in the 3D view: the machine at rest around the part, as in the document, and the
# candidate positions around it

_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
_SIDES = np.array(
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
)
_EDGES = np.array(
    [(0, 1), (1, 3), (3, 2), (2, 0), (4, 5), (5, 7), (7, 6), (6, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)
CHOSEN = (0.86, 0.1, 0.12)
DOT = 7.0  # pixels


class Cubes:
    """Coloured cubes of one size, transparent to clicks; one cube may be framed."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        self.colour, binding, hints = (
            coin.SoMaterial(),
            coin.SoMaterialBinding(),
            coin.SoShapeHints(),
        )
        binding.value = coin.SoMaterialBinding.PER_FACE
        hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING
        self.coordinates, self.faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
        self.frame = Lines(3.0, CHOSEN)
        cubes = coin.SoSeparator()
        for child in (self.colour, binding, hints, self.coordinates, self.faces):
            cubes.addChild(child)
        for child in (unpickable(), cubes, self.frame.node):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)), 1.0)

    def set(self, centres: Array, colours: Array, size: float) -> None:
        """Draw cubes of edge length `size` mm at centres (n, 3), mm, with colours (n, 3) in 0..1."""
        corners = centres[:, None] + 0.5 * size * _CORNERS
        offsets = 8 * np.arange(len(centres))[:, None, None]
        sides = np.concatenate([offsets + _SIDES, np.full((len(centres), 6, 1), -1)], axis=2)
        fill(self.coordinates.point, corners.reshape(-1, 3))
        fill(self.colour.diffuseColor, np.repeat(colours, 6, axis=0))
        fill(self.faces.coordIndex, sides.ravel())
        self.choose(None, size)

    def choose(self, centre: Array | None, size: float) -> None:
        """Frame the cube at a centre (3,); None removes the frame."""
        if centre is None:
            self.frame.set([], [])
            return
        ends = (np.asarray(centre) + 0.6 * size * _CORNERS)[_EDGES]
        self.frame.set(ends.reshape(-1, 3), [2] * len(_EDGES))


class Cloud:
    """Coloured points, transparent to clicks."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        style, binding = coin.SoDrawStyle(), coin.SoMaterialBinding()
        style.pointSize = DOT
        binding.value = coin.SoMaterialBinding.PER_VERTEX
        self.colour, self.coordinates, self.points = (
            coin.SoMaterial(),
            coin.SoCoordinate3(),
            coin.SoPointSet(),
        )
        for child in (
            unpickable(),
            unshaded(),
            style,
            self.colour,
            binding,
            self.coordinates,
            self.points,
        ):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)))

    def set(self, points: Array, colours: Any) -> None:
        """Draw points (n, 3), mm, with colours (n, 3) in 0..1."""
        fill(self.coordinates.point, points)
        fill(self.colour.diffuseColor, colours)
        self.points.numPoints = len(points)


# maximum cube edge, mm, and cube edge as a fraction of the step between positions
_MAX_EDGE_MM, _SHARE = 120.0, 0.35


class Scene:
    """Nodes in a 3D view, from construction until `remove`."""

    def __init__(self, view: Any) -> None:
        self.view, self.machine, self.cubes, self.cloud = (
            view,
            CellNodes(ghost=True),
            Cubes(),
            Cloud(),
        )
        self.places, self.size = np.zeros((0, 3)), 1.0
        self.root = coin.SoSeparator()
        for node in (self.machine.switch, self.cubes.node, self.cloud.node):
            self.root.addChild(node)
        self.camera, self.camera_text = view.getCameraNode().copy(), view.getCamera()
        self.graph = view.getSceneGraph()
        self.graph.addChild(self.root)

    def stand(self, settings: CellParameters, toolpath: Toolpath) -> None:
        """Draw the machine of a cell around the part, which stays fixed."""
        folders = user_machines.folders()
        cell = cells.resolve(settings, toolpath.frame, toolpath.family, folders)
        joints = at_rest(cell, resting_point(toolpath, cell.poses.mount))
        self.settings, self.cell, self.joints = settings, cell, joints
        self.rest = placing(cell, joints)
        self.to_view = frames.inverse(self.rest.part)
        self.machine.set(machine_scenery(settings, toolpath, folders))

    def positions_of(self, moves: str, poses: Array) -> Array:
        """Return the positions (n, 3) in the view for poses (n, 6) of the moved object."""
        if moves == POSITIONER:
            links = self.cell.links(self.joints)
            base = frames.inverse(links[0]) @ self.cell.world(self.joints[None])[0]
        else:
            nozzle = arrangement_of(self.cell.setup).holds_part and moves != PLATFORM
            stands = self.rest.nozzle if nozzle else self.rest.platform
            base = stands @ frames.inverse(frames.bryant(pose_of(self.settings, moves)))
        positions: Array = (self.to_view @ base @ frames.bryant(poses))[:, :3, 3]
        return positions

    def show(self, placed: Placed | None, coloured: Coloured | None, number: int | None) -> None:
        """Draw a cube at each position in the colour of its best pose."""
        if placed is None or coloured is None:
            self.places = np.zeros((0, 3))
            self.cubes.set(self.places, self.places, 1.0)
            return
        self.places = self.positions_of(placed.moves, placed.poses)
        self.size = _size(placed.poses[:, :3])
        self.cubes.set(self.places[coloured.numbers], coloured.colours, self.size)
        self.cubes.choose(None if number is None else self.places[number], self.size)

    def show_reach(self, reach: Reach | None) -> None:
        """Draw the robot's reach; None removes it."""
        if reach is None:
            self.cloud.set(np.zeros((0, 3)), np.zeros((0, 3)))
            return
        points = reach.places @ self.to_view[:3, :3].T + self.to_view[:3, 3]
        self.cloud.set(points, ramp(reach.share))

    def fit(self) -> None:
        """Fit the view to the whole scene."""
        self.view.fitAll()

    def remove(self, document_goes: bool = False) -> None:
        """Restore the view and its camera. The view may already be deleted, for example with its
        document.
        """
        with contextlib.suppress(RuntimeError, ReferenceError):
            if self.graph.findChild(self.root) >= 0:
                self.graph.removeChild(self.root)
        if document_goes:
            return
        with contextlib.suppress(RuntimeError, ReferenceError):
            camera = self.view.getCameraNode()
            if camera.getTypeId() == self.camera.getTypeId():
                camera.copyFieldValues(self.camera)
            else:  # switched between perspective and orthographic meanwhile
                self.view.setCamera(self.camera_text)


def _size(positions: Array) -> float:
    """Return the cube edge length, mm, that leaves gaps between positions."""
    steps = [np.diff(np.unique(np.round(column, 6))) for column in positions.T]
    smallest = min((float(step.min()) for step in steps if len(step)), default=_MAX_EDGE_MM)
    return min(_MAX_EDGE_MM, _SHARE * smallest)


# ---- The placement dock: tries poses in the background, draws them as a map, and enters the
# selected pose

SECTION, HIGH = "place", 160  # section name; minimum height of the table, pixels


class Form(QtGui.QWidget):
    """The widgets of the dock; the caller connects their signals. values: field values in macro
    form.
    """

    def __init__(self, values: dict[str, Any]) -> None:
        super().__init__()
        column = QtGui.QVBoxLayout(self)
        self.fields: dict[str, fields.Field] = {}
        box, advanced = Fold(tr("Poses to try"), True), Fold(tr("More"), False)
        current = flat(change_parameters(None, values))
        for row in rows(PlaceParameters):
            field = fields.make(row, current[row.key], None, "", SECTION)
            self.fields[row.key] = field
            heading = f"± {field.heading}" if row.key in SIDES else field.heading
            (advanced if row.spec.advanced else box).add(heading, field.widget)
        column.addWidget(box.widget)
        column.addWidget(advanced.widget)
        self.compute = _button(
            "compute", tr("Compute"), tr("Try all poses in the background; can be cancelled")
        )
        self.use = _button(
            "use", tr("Use this"), tr("Enter the pose selected in the table into the cell")
        )
        self.reach = _reach()
        self.colour = QtGui.QComboBox()
        self.colour.setObjectName("colour")
        self.colour.setToolTip(tr("Quantity shown by the colours of the poses"))
        for name in figures.NAMES:
            self.colour.addItem(figures.heading(name), name)
        self.key, self.summary = QtGui.QLabel(), QtGui.QLabel()
        self.key.setObjectName("key")
        self.summary.setObjectName("told")
        for label, lines in (
            (self.key, 1),
            (self.summary, 2),
        ):  # number of lines; a fixed height keeps the widgets below in place
            label.setWordWrap(True)
            label.setMinimumHeight(lines * label.fontMetrics().lineSpacing())
            label.setAlignment(QtCore.Qt.AlignLeft | QtCore.Qt.AlignTop)
        self.table = _table()
        buttons = QtGui.QHBoxLayout()
        buttons.addWidget(self.compute)
        buttons.addWidget(self.use)
        column.addLayout(buttons)
        for widget in (self.reach, self.summary, self.colour, self.key, self.table):
            column.addWidget(widget)
        column.addStretch(1)

    def values(self) -> dict[str, Any]:
        """Return the entered values in macro form. Raises InputError for unreadable input."""
        return {key: field.value for key, field in self.fields.items()}

    def tell(self, text: str, wrong: bool = False) -> None:
        """Show the progress or the result."""
        self.summary.setText(text)
        set_role(self.summary, INVALID if wrong else PLAIN)

    def tell_colours(self, coloured: figures.Coloured | None) -> None:
        """Explain the colours."""
        if coloured is None or coloured.lowest != coloured.lowest:
            self.key.setText("")
            return
        self.key.setText(
            tr("blue {:.4g} … yellow {:.4g}; grey: not feasible").format(
                coloured.lowest, coloured.highest
            )
        )

    def fill(self, placed: Placed | None, numbers: list[int]) -> None:
        """Fill the table."""
        self.table.setRowCount(0 if placed is None else len(numbers))
        for row, number in enumerate(numbers if placed is not None else ()):
            assert placed is not None
            for column, text in enumerate(figures.texts(placed, number)):
                item = QtGui.QTableWidgetItem(text)
                item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
                self.table.setItem(row, column, item)
        self.table.resizeColumnsToContents()
        if numbers and placed is not None:
            self.table.selectRow(0)


def _button(name: str, text: str, help: str) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    return button


def _reach() -> Any:
    box = QtGui.QCheckBox(tr("Reach of the robot"))
    box.setObjectName("reach")
    box.setSizePolicy(
        QtGui.QSizePolicy.Fixed, QtGui.QSizePolicy.Fixed
    )  # Qt accepts clicks only on the text of the box
    box.setToolTip(
        tr("Show the workspace of the robot: blue for few directions, yellow for all directions")
    )
    return box


def _table() -> Any:
    table = QtGui.QTableWidget(0, len(figures.heads()))
    table.setObjectName("poses")
    table.setHorizontalHeaderLabels(figures.heads())
    table.verticalHeader().hide()
    table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
    table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
    table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
    table.setMinimumHeight(HIGH)
    return table


NAME = "RoboticAM_Placement"
MIN_WIDTH = 380  # pixels; minimum width
REACH_STEP = 150.0  # mm
FIT = 150  # ms


class PlacementDock:
    """Tries poses of a joint path or toolpath until the dock closes or the object is deleted."""

    def __init__(self, obj: Any, view: Any) -> None:
        self.obj, self.gone, self.entering = obj, False, False
        self.placing: Placing = placing_of(obj)
        self.found: Placed | None = None
        self.numbers: list[int] = []
        self.volume: Reach | None = None
        self.scene: Scene | None = Scene(view)
        self.dock = dock_area.dock(NAME, dock_area.RIGHT)
        self.scroll = QtGui.QScrollArea()
        self.scroll.setWidgetResizable(True)
        self.scroll.setFrameShape(QtGui.QFrame.NoFrame)
        self.scroll.setMinimumWidth(MIN_WIDTH)
        self._build({})
        self.work, self.reaching = (
            Work(
                self.scroll,
                take,
                lambda text, wrong: self.form.tell(text, wrong),
                tr("Computing"),
            )
            for take in (self._take_poses, self._take_reach)
        )
        self.dock.hold(self._title(), self.scroll)
        self.dock.closed = self.close
        self._stand()
        self.dock.come()
        QtCore.QTimer.singleShot(
            FIT, self._fit
        )  # after the dock and the view have their final sizes
        self.lookout = Lookout(lambda: _Shown(self.placing), self._changed_object, self.end)
        preferences_watch.listen(self._paint)
        preferences_watch.listen_to_language(self._speak)

    # ---- the fields

    def _build(self, values: dict[str, Any]) -> None:
        self.form = Form(values)
        self.form.compute.clicked.connect(lambda *_: self._compute())
        self.form.use.clicked.connect(lambda *_: self._use())
        self.form.reach.clicked.connect(lambda *_: self._reach())
        self.form.colour.activated.connect(lambda *_: self._paint())
        self.form.table.itemSelectionChanged.connect(self._paint)
        self.scroll.setWidget(self.form)  # removes the old widget
        self._name_buttons()

    def _speak(self) -> None:
        """Rebuild in the window's new language; keep entries and results."""
        values, has_reach = {}, self.form.reach.isChecked()
        with contextlib.suppress(AmError):
            values = self.form.values()
        self._build(values)
        self.form.reach.setChecked(has_reach)
        self.dock.setWindowTitle(self._title())
        self._show()

    def _title(self) -> str:
        return tr("Placement of {}").format(self.obj.Label)

    def _name_buttons(self) -> None:
        runs = hasattr(self, "work") and self.work.runs
        self.form.compute.setText(tr("Cancel") if runs else tr("Compute"))
        self.form.use.setEnabled(not runs and bool(self.numbers))

    # ---- computation

    def _compute(self) -> None:
        """Start trying the poses, or cancel."""
        if self.work.runs:
            self.work.cancel()
            self.form.tell(tr("Cancelled."))
            self._name_buttons()
            return
        try:
            parameters: PlaceParameters = change_parameters(None, self.form.values())
            self.placing = placing_of(self.obj)
        except (AmError, ReferenceError) as error:
            self.form.tell(translated_error(error), True)
            return
        placing = self.placing
        self.work.start(lambda: placing.search_poses(parameters))
        self._name_buttons()

    def _take_poses(self, placed: Placed | None) -> None:
        if placed is not None:
            self.found = placed
            self.numbers = figures.rows(placed, str(self.form.fields["best"].value))
        self._show()
        self._fit()
        self._name_buttons()

    def _reach(self) -> None:
        """Show or hide the robot's reach."""
        self.reaching.cancel()
        if not self.form.reach.isChecked():
            self.volume = None
            self._paint()
            return
        settings, folders = self.placing.settings, user_machines.folders()

        def work() -> Reach:
            import numpy as np

            return reach(
                cells.resolve(settings, np.eye(4), folders=folders), REACH_STEP, progress.report
            )

        self.reaching.start(work)

    def _take_reach(self, reach: Reach | None) -> None:
        self.volume = reach
        if reach is not None:
            self.form.tell(
                in_user_units(
                    tr("The robot reaches {} points of a grid of {:.0f} mm.").format(
                        len(reach.places), reach.step
                    )
                )
            )
        self._paint()
        self._fit()

    # ---- display

    def _show(self) -> None:
        self.form.table.blockSignals(True)
        self.form.fill(self.found, self.numbers)
        self.form.table.blockSignals(False)
        if self.found is not None:
            self.form.tell(figures.summed(self.found), self.found.best is None)
        self._paint()
        self._name_buttons()

    def chosen(self) -> int | None:
        """Return the index of the pose selected in the table; None without a selection."""
        row = self.form.table.currentRow()
        return self.numbers[row] if 0 <= row < len(self.numbers) else None

    def _fit(self) -> None:
        if self.scene is not None:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view was closed
                self.scene.fit()

    def _stand(self) -> None:
        """Draw the machine of the current cell."""
        if self.scene is not None:
            self.scene.stand(self.placing.settings, self.placing.job().toolpath)
            self._paint()

    def _paint(self) -> None:
        if self.scene is None:
            return
        try:
            coloured = (
                None
                if self.found is None
                else figures.coloured(self.found, self.form.colour.currentData())
            )
            self.scene.show(self.found, coloured, self.chosen())
            self.scene.show_reach(self.volume)
        except (RuntimeError, ReferenceError):
            self.end(tr("the view was closed"))
            return
        self.form.tell_colours(coloured)

    # ---- applying the selected pose

    def _use(self) -> None:
        """Enter the selected pose into the cell and recompute the dependent stages."""
        number = self.chosen()
        if self.found is None or number is None:
            return
        entries = {key: repr(value) for key, value in self.found.entries(number).items()}
        self.entering = True
        try:
            recorded.change(self.placing.cell, entries)
            self.placing = placing_of(self.obj)
        except (AmError, Cancelled, ReferenceError) as error:
            self.form.tell(
                translated_error(error) or tr("Cancelled: the document is unchanged."), True
            )
            return
        finally:
            self.entering = False
        self.form.tell(tr("The pose was entered into {}.").format(self.placing.cell.Label))
        self._stand()

    # ---- closing

    def _changed_object(self, obj: Any, name: str) -> None:
        """Discard results of outdated inputs."""
        if name != "Key" or self.entering or self.found is None:
            return
        self.found, self.numbers = None, []
        self._show()
        self.form.tell(tr("{} has changed; compute again.").format(obj.Label), True)

    def close(self, document_goes: bool = False) -> None:
        """End the search and restore the view."""
        if self.gone:
            return
        self.gone = True
        self.lookout.stop()
        for listener in (self._paint, self._speak):
            preferences_watch.forget(listener)
        self.work.cancel()
        self.reaching.cancel()
        scene, self.scene = self.scene, None
        if scene is not None:
            scene.remove(document_goes)
        self.dock.empty()
        if self in _open:
            _open.remove(self)

    def end(self, why: str, document_goes: bool = False) -> None:
        """Close the dock and show the reason."""
        if not self.gone:
            self.close(document_goes)
            Gui.getMainWindow().statusBar().showMessage(
                tr("The placement was closed: {}").format(why), 8000
            )


class _Shown:
    """The objects for a lookout to watch."""

    def __init__(self, placing: Placing) -> None:
        self.document, self.objects = placing.document, placing.names


_open: list[PlacementDock] = []  # keeps the open dock alive; at most one


def show(obj: Any) -> PlacementDock | None:
    """Close the open dock and open it for a joint path or toolpath in a 3D view of its document.

    Raises InputError if there is nothing to place.
    """
    placing_of(obj)
    document = Gui.getDocument(obj.Document.Name)
    views = document.mdiViewsOfType("Gui::View3DInventor")
    active = document.activeView()
    view = active if hasattr(active, "getSceneGraph") else views[0] if views else None
    if view is None:
        App.Console.PrintWarning(tr("There is no 3D view for the poses; open a 3D view.") + "\n")
        return None
    while _open:
        _open[0].close()
    opened = PlacementDock(obj, view)
    _open.append(opened)
    return opened


KINDS = ("joint path", "toolpath")  # kinds of objects that can be placed, most complete first


def placement() -> None:
    """Place the selected joint path, toolpath with a cell, or path of the selected program.

    Without such a selection, use the last candidate of the document.
    """
    selected = [path for path in map(_path, job_selection()) if path is not None]
    if not selected and job_named():
        _say(
            tr(
                "{} has no toolpath with a cell to place; make a toolpath first, or select "
                "another job."
            ).format(job_named())
        )
        return
    paths = [obj for obj in App.ActiveDocument.Objects if _path(obj) is obj]
    candidates = sorted(paths, key=lambda obj: -KINDS.index(_kind(obj)))
    if not selected and not candidates:
        _say(tr("There is no toolpath with a cell to place; make a toolpath first."))
        return
    try:
        show(selected[0] if selected else candidates[-1])
    except AmError as error:
        App.Console.PrintWarning(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)


def _kind(obj: Any) -> str:
    stage = stage_of(obj)
    return "" if stage is None else stage.kind


def _path(obj: Any) -> Any:
    """Return the joint path, or toolpath with a cell, that an object is or belongs to; None without
    one.
    """
    kind = _kind(obj)
    if kind == "program":
        return obj.JointPath
    if kind == "joint path" or (kind == "toolpath" and obj.Cell is not None):
        return obj
    return None


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
