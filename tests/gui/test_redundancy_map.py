# SPDX-License-Identifier: LGPL-2.1-or-later
"""The redundancy map by mouse: it shows the values of the core, and a dragged curve becomes the
plan."""

import csv

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics.limits import margins
from freecad_am.core.parameters.joints import GIVEN
from freecad_am.core.planning import redundancy_curve as spin_curve
from freecad_am.core.planning import redundancy_map
from freecad_am.core.planning import redundancy_map as spin_map
from freecad_am.core.simulation.achievable_feed import speed_ratios
from freecad_am.gui.path.colouring import BELOW_COLOUR, NONE
from freecad_am.gui.redundancy_map import dock as docks
from freecad_am.gui.redundancy_map.dock import FINE_STRIDE, NAME
from freecad_am.gui.redundancy_map.painting import TURN
from freecad_am.objects.staleness import UP_TO_DATE
from tests.gui.positioner_jobs import make_positioner_job

ROBOT = {"limits": "paper"}
TIMEOUT_S = 30  # s


def job(hemisphere, layer_height=9, joints=None, **cell):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=layer_height)
    cell_object = api.make_cell(doc, **(cell or ROBOT))
    toolpath = api.make_toolpath(doc, feature, cell_object)
    return api.make_joint_path(doc, toolpath, cell_object, **(joints or {}))


def opened(person, path):
    person.select(path)
    person.click("RoboticAM_SpinMap")
    panel = person.panel(NAME)
    dock = docks._open[0]
    person.until(lambda: dock.canvas.painted is not None, "the cells", TIMEOUT_S)
    person.until(
        lambda: dock.board.looked.get(dock.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        TIMEOUT_S,
    )
    person.idle(0.2)
    return panel, dock


def screen_position(canvas, column, value):
    """Return the position of a column and a value on the screen."""
    from PySide import QtCore

    position = canvas.mapToGlobal(
        QtCore.QPoint(round(float(canvas.x_of(column))), round(float(canvas.y_of(value))))
    )
    return position.x(), position.y()


def drag(hand, canvas, column, value, to):
    """Press at a position, move in steps like a hand, and release."""
    start, end = screen_position(canvas, column, value), screen_position(canvas, column, to)
    hand.do("mousemove", *start)
    hand.do("mousedown", "1")
    for share in (0.15, 0.4, 0.7, 1.0):
        hand.do("mousemove", start[0], round(start[1] + share * (end[1] - start[1])))
    hand.do("mouseup", "1")
    hand.person.idle(0.2)


def values_of(dock):
    return dock.board.draft_values(dock.draft)


def grabbed(canvas):
    """Return the picture on the canvas, (height, width, 3) 0..255."""
    from PySide import QtGui

    image = canvas.grab().toImage().convertToFormat(QtGui.QImage.Format_RGB32)
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)
    return rows[:, : image.width(), 2::-1].astype(int)


def test_the_picture_is_what_core_computes(person, hemisphere):
    path = job(hemisphere)
    panel, dock = opened(person, path)
    person.screenshot("spin_map")
    picture, canvas = dock.board.pictures[dock.draft.branch], dock.canvas
    dock.figures.item(0, 0).setCheckState(person.core.Qt.Unchecked)
    dock.figures.item(1, 0).setCheckState(person.core.Qt.Unchecked)
    person.idle()
    assert canvas.curves == []
    pixels = grabbed(canvas)
    random = np.random.default_rng(4)
    for column, row in zip(
        random.integers(2, len(dock.board.columns) - 2, 80), random.integers(3, 177, 80)
    ):
        if np.abs(canvas.seams - column).min() <= 2:
            continue  # lines are drawn there
        x, y = (
            round(float(canvas.x_of(column))),
            round(float(canvas.y_of(dock.board.map.values[row]))),
        )
        expected = canvas.painted.colours[row - 3 : row + 4, column - 1 : column + 2].astype(int)
        hatch = (
            canvas.painted.hatched[row - 3 : row + 4, column - 1 : column + 2].any()
            and (pixels[y, x] == 20).all()
        )
        assert hatch or np.abs(pixels[y, x] - expected).max(axis=2).min() <= 3, (row, column)
    for cells, colour in ((picture.past_limit, BELOW_COLOUR), (~picture.reachable, NONE)):
        if cells.any():
            assert (canvas.painted.colours[cells] == np.round(255 * np.array(colour))).all()
    assert picture.past_limit.any()
    person.choose(panel, "colours", "condition")
    panel.findChild(person.widgets.QComboBox, "colours").activated.emit(1)
    person.idle()
    assert canvas.painted.scale.title == "condition"
    dock.dock.close()
    assert docks._open == []


@pytest.mark.parametrize("overlap", [0, 5])
@pytest.mark.always("5")
def test_a_plan_that_moves_seams_is_shown_as_it_runs(person, hemisphere, overlap):
    """Axes with limits have room for a whole turn from some seams only; a feasible plan must not
    look infeasible."""
    path = job(hemisphere, limits="maker")
    api.change(path.Toolpath, overlap=overlap)
    api.recompute(path)
    planned = api.result(path).joint_path
    toolpath = api.result(path.Toolpath)
    moved = [
        (bead_path.layer, bead_path.index)
        for (_, _, bead), bead_path in zip(toolpath, planned.beads)
        if np.linalg.norm(bead.points[0] - bead_path.bead.points[0]) > 1.0
    ]
    assert moved
    _, dock = opened(person, path)
    followed = dock.draft.evaluate(live=False)
    sums = spin_curve.sums(followed)
    assert (sums.lost, sums.wound) == (0, 0) and sums.margin >= 0.0
    for bead, start, end in zip(planned.beads, dock.source.starts, dock.source.starts[1:]):
        shown_joints = followed.joints[start:end]
        np.testing.assert_allclose(shown_joints[0], bead.joints[0], atol=1e-9)
        if (
            not overlap
        ):  # otherwise the plan continues past the seam; between the ends it may have more points
            np.testing.assert_allclose(shown_joints[-1], bead.joints[-1], atol=1e-9)
    assert dock.draft.full.points.closed.all()


def test_a_certificate_is_told_of_the_plan(person, hemisphere):
    path = job(hemisphere, joints={"certificate": True})
    _, dock = opened(person, path)
    optimality = dock.source.planned.optimality
    assert 0.0 <= optimality["gap"] < 0.01
    last_line = dock.form.verdict.text().splitlines()[-1]
    assert last_line == (
        f"Certificate: {optimality['objective']:.4g} as planned, lower bound over all rotations {optimality['bound']:.4g}: a gap of "
        f"{100 * optimality['gap']:.1f} %, the largest, {100 * optimality['worst']['gap']:.1f} %, in layer {optimality['worst']['layer']} bead "
        f"{optimality['worst']['bead']}"
    )


def test_what_the_mouse_is_over_is_told(person, hemisphere, hand):
    path = job(hemisphere)
    panel, dock = opened(person, path)
    label = person.field(panel, "readout")
    for column, value in ((20, 0.4), (90, -1.5), (150, 2.2)):
        hand.do("mousemove", *screen_position(dock.canvas, column, value))
        person.idle(0.1)
        label_text = label.text()
        neighbours = [
            k
            for k in (column - 1, column, column + 1)  # a column may be narrower than a pixel
            if label_text.startswith("Layer {} bead {} point {} ".format(*dock.board.place(k)))
        ]
        assert len(neighbours) == 1
        rz = float(label_text.split("RZ ")[1].split("°")[0])
        pixel = np.degrees(dock.canvas.high - dock.canvas.low) / dock.canvas.area().height()
        assert rz == pytest.approx(np.degrees(value), abs=1.5 * pixel)
        shown_joints = [
            float(text.split()[-1].rstrip("°")) for text in label_text.splitlines()[1].split("   ")
        ]
        tool = dock.board.columns.points.tool[neighbours]
        phi = float(
            spin_map.rotation_of(dock.source.cell, tool, np.array([np.radians(rz)]), "rz")[0]
        )
        q = spin_map.joints_at(
            dock.source.task(dock.draft.branch), dock.board.columns, neighbours[0], phi
        )[dock.draft.branch]
        assert shown_joints == pytest.approx(np.degrees(q), abs=0.6)


def test_where_a_link_touches_the_map_is_hatched_and_says_what(person, hemisphere, hand):
    path = job(hemisphere, limits="paper", platform_diameter=200.0)
    panel, dock = opened(person, path)
    person.screenshot("spin_map_touching")
    board, branch = dock.board, dock.draft.branch
    picture = board.pictures[branch]
    assert (
        picture.arm.any()
        and (dock.canvas.painted.hatched == (picture.forbidden | picture.arm)).all()
    )
    touching_links = spin_map.arm_touched(
        dock.source.task(branch), board.map, branch, dock.source.arm, board.moment
    )
    assert (picture.arm == touching_links).all()
    free = picture.feasible & ~picture.hatched
    inside = {}
    for name, cells in (
        ("touching", picture.arm),
        ("free", free),
    ):  # cells with equal neighbours
        same = cells[2:-2, 1:-1].copy()
        for rows in range(5):
            for columns in range(3):
                same &= cells[
                    rows : cells.shape[0] - 4 + rows, columns : cells.shape[1] - 2 + columns
                ]
        inside[name] = np.argwhere(same) + [2, 1]
        assert len(inside[name])
    label = person.field(panel, "readout")
    for name, inner_cells in inside.items():
        row, column = inner_cells[len(inner_cells) // 2]
        hand.do(
            "mousemove", *screen_position(dock.canvas, int(column), float(board.map.values[row]))
        )
        person.idle(0.2)
        assert ("the link of q4 touches the platform" in label.text()) == (name == "touching"), (
            label.text()
        )


def test_the_curve_is_dragged_and_becomes_the_plan(person, hemisphere, hand):
    path = job(hemisphere)
    doc = path.Document
    panel, dock = opened(person, path)
    use = person.field(panel, "use")
    assert not use.isEnabled()
    planned = [bead.coefficients.copy() for bead in path.Proxy.value(path).joint_path.beads]
    column = len(dock.board.columns) // 2
    value = float(values_of(dock)[column])
    drag(hand, dock.canvas, column, value, value + 0.5)
    moved = float(values_of(dock)[column])
    assert moved == pytest.approx(value + 0.5, abs=0.06)  # a pixel or two
    assert use.isEnabled() and len(dock.draft.changed) == len(planned)
    person.screenshot("spin_map_dragged")
    sums = spin_curve.sums(dock.draft.evaluate(False))
    assert dock.figures.item(0, 1).text().split()[0] == str(sums.lost)
    expected = dock.draft.coefficients.copy()
    steps = doc.UndoCount
    hand.click(use)
    person.until(lambda: path.Given, "the curve to be planned", TIMEOUT_S)
    person.until(lambda: docks._open and not dock.draft.changed, "the map to follow", TIMEOUT_S)
    person.idle(0.3)
    assert doc.UndoCount == steps + 1
    joints = path.Proxy.value(path).joint_path
    assert (path.Status == "up to date") == (sums.lost == 0) == joints.feasible
    assert np.allclose([bead.coefficients for bead in joints.beads], expected, atol=1e-9)
    assert not use.isEnabled()
    person.screenshot("spin_map_used")
    doc.saveAs(str(person.folder / "given.FCStd"))
    doc.undo()
    person.idle(0.5)
    assert path.Given == []
    assert np.allclose(
        [bead.coefficients for bead in path.Proxy.value(path).joint_path.beads], planned
    )
    person.until(
        lambda: np.allclose(dock.draft.coefficients, planned),
        "the map to follow the undo",
        TIMEOUT_S,
    )
    doc.redo()
    person.until(
        lambda: np.allclose(dock.draft.coefficients, expected, atol=1e-9),
        "the map to follow the redo",
        TIMEOUT_S,
    )
    name = doc.FileName
    App.closeDocument(doc.Name)
    person.idle(0.2)
    assert docks._open == []
    again = App.openDocument(name)
    person.idle(0.3)
    coefficients = {
        polynomial.bead: polynomial.coefficients
        for polynomial in GIVEN.read(again.getObject("JointPath").Given)
    }
    assert coefficients and np.allclose(
        [
            coefficients.get((layer, index), coefficients.get(None))
            for layer, index in dock.source.places
        ],
        expected,
        atol=1e-8,
    )


def test_handles_bend_the_polynomial_of_one_bead(person, hemisphere, hand):
    path = job(hemisphere)
    panel, dock = opened(person, path)
    person.field(panel, "layer").setValue(2)
    person.until(
        lambda: dock.canvas.painted is not None and dock.board.layer == 2, "the layer", TIMEOUT_S
    )
    person.field(panel, "degree").setValue(2)
    person.field(panel, "together").setChecked(False)
    person.idle(0.3)
    assert len(dock.canvas.handles) == 3
    person.screenshot("spin_map_layer")
    old_coefficients, handle = dock.draft.coefficients.copy(), dock.canvas.handles[1]
    drag(hand, dock.canvas, handle.column, handle.value, handle.value + 0.6)
    new_coefficients = dock.draft.coefficients
    bead = dock.bead
    other_beads = [k for k in range(len(new_coefficients)) if k != bead]
    assert np.array_equal(new_coefficients[other_beads], old_coefficients[other_beads])
    handles = dock.draft.handles(bead)
    change = np.polynomial.polynomial.polyval(
        handles, new_coefficients[bead] - old_coefficients[bead]
    )
    assert change[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-9) and change[1] == pytest.approx(
        0.6, abs=0.08
    )
    # the fields have the same numbers, and accept typed ones
    field_values = [person.field(panel, f"c{k}").value() for k in range(3)]
    assert field_values == pytest.approx(
        np.degrees(new_coefficients[bead] * TURN ** np.arange(3)), abs=1e-3
    )
    hand.enter(panel, "c0", "12.5")
    assert np.degrees(dock.draft.coefficients[bead, 0]) == pytest.approx(12.5)
    assert np.array_equal(dock.draft.coefficients[other_beads], old_coefficients[other_beads])
    person.screenshot("spin_map_handles")


@pytest.mark.long
def test_one_rz_for_all_is_dragged_and_used(person, hemisphere, hand):
    path = job(hemisphere, joints={"method": "constant", "rz": 20})
    panel, dock = opened(person, path)
    values = values_of(dock)
    assert np.abs(values - np.radians(20)).max() < 1e-6
    column = len(values) // 3
    drag(hand, dock.canvas, column, float(values[column]), float(values[column]) - 0.7)
    assert dock.draft.rz == pytest.approx(np.radians(20) - 0.7, abs=0.06)
    assert np.abs(values_of(dock) - dock.draft.rz).max() < 1e-6
    expected = dock.draft.rz
    sums = spin_curve.sums(dock.draft.evaluate(False))
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Rz != "20.0 deg", "the plan", TIMEOUT_S)
    person.idle(0.3)
    assert path.Method == "constant" and float(path.Rz.split()[0]) == pytest.approx(
        np.degrees(expected), abs=1e-6
    )
    assert (path.Status == "up to date") == (sums.lost == 0)
    person.screenshot("spin_map_constant")
    hand.click(person.field(panel, "free"))
    person.until(lambda: path.Method == "layer-by-layer", "the planner's own", TIMEOUT_S)
    assert path.Status == "up to date"


def test_another_branch_is_shown_and_used(person, hemisphere, hand):
    path = job(hemisphere)
    panel, dock = opened(person, path)
    combo = person.field(panel, "branch")
    assert "(planned)" in combo.itemText(dock.source.branch)
    combo.setCurrentIndex(0)
    combo.activated.emit(0)
    person.until(lambda: 0 in dock.board.pictures, "the other branch", TIMEOUT_S)
    person.idle(0.2)
    person.screenshot("spin_map_branch")
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.OwnBranch == "front-up-noflip", "the plan", TIMEOUT_S)
    assert path.Proxy.value(path).joint_path.branch == ("front", "up", "noflip")


def test_methods_side_by_side(person, hemisphere, hand):
    path = job(hemisphere)
    panel, dock = opened(person, path)
    hand.click(person.field(panel, "compare"))
    person.until(lambda: len(dock.compared) == 3, "the methods", 60)
    person.idle(0.3)
    person.screenshot("spin_map_compared")
    table = person.field(panel, "figures")
    assert [table.item(row, 0).text() for row in range(5)] == [
        "This curve",
        "As planned",
        "layer-by-layer",
        "point-by-point",
        "constant",
    ]
    assert len(dock.canvas.curves) == 5
    own_value, by_layer = (table.item(row, 5).text().split()[0] for row in (1, 2))
    assert float(own_value) == pytest.approx(float(by_layer), rel=1e-2)
    for row, method in enumerate(
        ("layer-by-layer", "point-by-point", "constant"), 2
    ):  # each equals that of its own stage
        plan = api.make_joint_path(path.Document, path.Toolpath, path.Cell, method=method)
        planned_path, compared_path = api.result(plan).joint_path, dock.compared[row - 2]
        assert (
            planned_path.branch == api.result(path).joint_path.branch
            and compared_path.name == method
        )
        for drawn, bead in zip(compared_path.paths, planned_path.beads, strict=True):
            ends = [
                np.exp(1j * bead_path.joints[[0, -1]]) for bead_path in (drawn, bead)
            ]  # without whole turns and added points
            assert np.allclose(*ends, atol=1e-9)
        smallest = min(float(bead.condition.min()) for bead in compared_path.paths)
        assert table.item(row, 3).text() == f"{smallest:.4f}"
        assert (table.item(row, 1).text() == "0") == planned_path.feasible
    curves = [np.concatenate([bead.phi for bead in method.paths]) for method in dock.compared]
    assert (
        min(
            np.abs(curves[first_curve] - curves[second_curve]).max()
            for first_curve, second_curve in ((0, 1), (0, 2), (1, 2))
        )
        > 0.01
    )
    table.item(3, 0).setCheckState(person.core.Qt.Unchecked)
    person.idle(0.1)
    assert len(dock.canvas.curves) == 4


def test_a_click_takes_the_simulation_and_the_path_there(person, hemisphere, hand):
    from freecad_am.gui.path import dock as paths
    from freecad_am.gui.simulation import dock as simulations

    path = job(hemisphere)
    person.select(path)
    person.click("RoboticAM_Simulate")
    person.click("RoboticAM_Path")
    _, dock = opened(person, path)
    column = (2 * len(dock.board.columns)) // 3
    free = float(values_of(dock)[column]) + 0.9  # off the curve
    hand.at(screen_position(dock.canvas, column, free if free < dock.canvas.high else free - 1.8))
    person.idle(0.3)
    layer, _, _ = dock.board.place(column)
    moment = simulations._open[0].player.moment()
    motion = simulations._open[0].run.motion
    assert motion.layer[moment.row] == layer
    # a pixel of a narrow map covers several columns
    pixel = -(-len(dock.board.columns) // dock.canvas.width())
    clicked = dock.board.columns.points.position[column - pixel : column + pixel + 1]
    assert np.linalg.norm(clicked - motion.position[moment.row], axis=1).min() < 1e-6
    assert path.ViewObject.Proxy.shown[1] == layer
    assert paths.only.dock.view() is path.ViewObject.Proxy
    assert dock.bead == int(dock.board.columns.bead[column])
    paths.only.dock.dock.close()
    simulations._open[0].close()


def test_it_goes_when_its_joint_path_goes(person, hemisphere):
    path = job(hemisphere)
    opened(person, path)
    path.Document.removeObject(path.Name)
    person.until(lambda: docks._open == [], "the map to close", 5)
    assert "deleted" in person.window.statusBar().currentMessage()


def test_a_path_from_point_to_point_is_smoothed(person, hemisphere, hand):
    """Its curve has no polynomial: the user may use the nearest one unchanged."""
    path = job(hemisphere, layer_height=15, joints={"method": "point-by-point"})
    panel, dock = opened(person, path)
    gap = np.abs(values_of(dock) - dock.board.path_values(dock.draft, dock.source.planned.beads))
    assert person.field(panel, "use").isEnabled() and gap.max() < 0.1
    low, high = (
        np.degrees(end(dock.consequences.followed.joints[:, 1])) for end in (np.min, np.max)
    )
    assert f"q2&nbsp;{low:.1f}…{high:.1f}°" in person.field(panel, "joints").text()
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Method == "layer-by-layer", "the plan", TIMEOUT_S)
    assert len(path.Given) in (1, len(dock.source.places)) and path.Status == "up to date"


def test_a_table_has_no_map(person, hemisphere):
    path = job(hemisphere, machine="table-xyzac", setup="rotary-table")
    person.select(path)
    person.click("RoboticAM_SpinMap")
    assert docks._open == [] and "rotary axes" in person.window.statusBar().currentMessage()


def test_external_axes_go_along_or_stand_across(person, hand, hemisphere, monkeypatch, tmp_path):
    """Along the path the external axes are as planned; across, one of them varies at the clicked
    point, with a mark at the plan."""
    path = make_positioner_job(hemisphere, 12)
    assert path.Status == UP_TO_DATE, api.issues(path)
    panel, dock = opened(person, path)
    _coloured_by_all_axes(path, dock.source.cell)
    assert dock.board.across is None and len(dock.source.beads) == len(dock.source.planned.beads)
    board = dock.board
    np.testing.assert_allclose(
        board.columns.points.external,
        [
            dock.source.planned.beads[k].joints[n, 6:]
            for k, n in zip(board.columns.bead, board.columns.point)
        ],
        atol=1e-9,
    )
    column = int(np.flatnonzero(board.columns.bead == 1)[5])
    free = float(values_of(dock)[column]) + 0.9  # off the curve
    hand.at(screen_position(dock.canvas, column, free if free < dock.canvas.high else free - 1.8))
    person.until(lambda: dock.clicked.get(1) is not None, "the click")
    point = dock.clicked[1]
    assert point in board.columns.point[column - 1 : column + 2]  # a column is a pixel or two wide
    person.choose(panel, "across", "e2")
    box = person.field(panel, "across")
    box.activated.emit(box.currentIndex())
    person.until(
        lambda: dock.board.across == 1 and dock.canvas.painted is not None, "e2 across", TIMEOUT_S
    )
    person.until(
        lambda: dock.board.looked.get(dock.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        TIMEOUT_S,
    )
    planned = dock.source.planned.beads[1].joints[point]
    assert dock.board.place(0) == (*dock.source.places[1], point)
    marked_column = dock.board.marks[1]
    assert abs(dock.board.offsets[marked_column] - planned[7]) < 2.0 * np.pi / 100.0
    assert np.ptp(dock.board.columns.points.external[:, 0]) == 0.0
    # at the plan, the map has the plan's joints
    phi = dock.source.planned.beads[1].phi[point]
    cross_section = redundancy_map.across(
        dock.source.beads, dock.source.cell, (1, point), 1, planned[[7]]
    )
    map_joints = spin_map.joints_at(
        dock.source.task(dock.source.branch), cross_section, 0, float(phi)
    )[dock.source.branch]
    turns = (map_joints - planned) / TURN
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
    person.screenshot("map_e2_across")
    assert dock.board.title.startswith("e2 at layer ")
    hand.do(
        "mousemove",
        *screen_position(
            dock.canvas,
            marked_column,
            float(board.values(np.full(len(board.columns), phi))[column]),
        ),
    )
    person.until(lambda: "   e2 " in dock.form.readout.text(), "the axes under the mouse")
    _saved(person, panel, dock, monkeypatch, tmp_path / "e2")
    _two_against_each_other(person, hand, dock, panel, point)
    _saved(person, panel, dock, monkeypatch, tmp_path / "both")
    box = person.field(panel, "axis")
    person.choose(panel, "axis", "RZ")
    box.activated.emit(box.currentIndex())
    person.until(
        lambda: dock.board.up is None and dock.canvas.painted is not None, "RZ upwards", TIMEOUT_S
    )
    assert dock.canvas.heights is None and dock.canvas.curves
    box = person.field(panel, "across")
    person.choose(panel, "across", "the path")
    box.activated.emit(box.currentIndex())
    person.until(lambda: dock.board.across is None, "the path across", TIMEOUT_S)


def _coloured_by_all_axes(path, cell):
    """Beads of the view are coloured by the reserve of robot and positioner, and by speeds
    including the positioner's."""
    motion, limits, view = api.result(path).motion, cell.limits, path.ViewObject
    assert motion.joints.shape[1] == 8
    share = np.nanmin(
        np.concatenate(
            [
                margins(motion.joints, limits.lower, limits.upper),
                margins(
                    motion.joints @ limits.coefficients.T,
                    limits.coupled_lower,
                    limits.coupled_upper,
                ),
            ],
            axis=1,
        ),
        axis=1,
    )
    view.Colouring = "joint margin"
    assert view.Proxy.scale.lowest == pytest.approx(100.0 * share[motion.deposit].min())
    assert view.Proxy.scale.highest == pytest.approx(100.0 * share[motion.deposit].max())
    ratio = speed_ratios(motion.joints, motion.duration, cell.machine.max_speed)
    view.Colouring = "joint speed"
    assert view.Proxy.scale.highest == pytest.approx(
        100.0 * ratio.max(axis=1)[motion.deposit].max()
    )
    view.Colouring = "joint margin"


def _two_against_each_other(person, hand, dock, panel, point):
    """With e2 across and e1 upwards, the planned pair is marked, the rotation is that of the plan,
    the axes under the mouse belong to the cell, and no curve can be dragged."""
    box = person.field(panel, "axis")
    person.choose(panel, "axis", "e1")
    box.activated.emit(box.currentIndex())
    person.until(
        lambda: dock.board.up == 0 and dock.canvas.painted is not None, "e1 upwards", TIMEOUT_S
    )
    person.until(
        lambda: dock.board.looked.get(dock.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        TIMEOUT_S,
    )
    planned = dock.source.planned.beads[1]
    pair, picture = dock.board.pair, dock.board.pictures[dock.draft.branch]
    assert (
        picture.margin.shape
        == (len(pair.values), len(dock.board.offsets))
        == dock.canvas.painted.hatched.shape
    )
    assert (
        dock.board.title.startswith("e2 against e1 at layer ")
        and not dock.canvas.curves
        and not dock.canvas.handles
    )
    assert (
        pair.values[0] <= planned.joints[point, 6] <= pair.values[-1]
        and pair.phi == planned.phi[point]
    )
    texts, height = dock.canvas.heights
    low, high = (float(text.rstrip("°")) for text in (texts[0][1], texts[-1][1]))
    where = low + (height + np.pi) / TURN * (high - low)
    assert abs(where - np.degrees(planned.joints[point, 6])) < 0.51  # texts are whole degrees
    cell_ = dock.board.cell(dock.draft.branch, int(dock.board.marks[1]), height)
    turns = (cell_.joints - planned.joints[point])[6:]
    assert np.abs(turns).max() < np.radians(3.0) and cell_.phi == planned.phi[point]
    hand.do("mousemove", *screen_position(dock.canvas, 20, 0.8 * np.pi))
    expected = np.degrees(
        [pair.values[round(0.9 * (len(pair.values) - 1))], dock.board.offsets[20]]
    )

    def shown_axes():
        words = dock.form.readout.text().split()
        matches = [
            float(words[words.index(name) + 1].rstrip("°"))
            for name in ("e1", "e2")
            if name in words
        ]
        return len(matches) == 2 and np.abs(np.array(matches) - expected).max() < 5.0

    person.until(
        lambda: shown_axes() or "out of reach" in dock.form.readout.text(),
        "the axes under the mouse",
    )
    person.screenshot("map_e2_against_e1")


def _saved(person, panel, dock, monkeypatch, name):
    """Check the map in files: a row for each cell, whose margin is that of recomputed joints; the
    drawing has its words."""
    for ending in ("png", "svg", "csv"):
        path = name.with_suffix(f".{ending}")
        monkeypatch.setattr(
            person.widgets.QFileDialog,
            "getSaveFileName",
            staticmethod(lambda *_, path=path: (str(path), "")),
        )
        person.field(panel, "save").click()
        person.until(path.exists, f"the {ending}", TIMEOUT_S)
        person.idle(0.1)
    assert name.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert dock.board.title in name.with_suffix(".svg").read_text(encoding="utf-8")
    with open(name.with_suffix(".csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    board, limits = dock.board, dock.source.cell.limits
    count = len(board.map.values) if board.pair is None else len(board.pair.values)
    assert len(rows) == count * len(board.offsets) and {row["point"] for row in rows} == {
        str(board.place(0)[2])
    }
    picture = board.pictures[dock.draft.branch]
    for index in np.random.default_rng(5).integers(0, len(rows), 40):
        row, column = rows[index], index // count
        height = (
            2.0 * np.pi * (index % count) / (count - 1) - np.pi
            if board.pair is not None
            else float(board.map.values[index % count])
        )
        cell = board.cell(dock.draft.branch, int(column), height)
        assert (row["joint_margin_percent"] == "") == bool(np.isnan(cell.joints).any())
        assert float(row["e2_deg"]) == pytest.approx(np.degrees(board.offsets[column]), abs=1e-6)
        if board.pair is not None:
            assert float(row["e1_deg"]) == pytest.approx(
                np.degrees(board.pair.values[index % count]), abs=1e-6
            )
        if not np.isnan(cell.joints).any():
            assert float(row["e2_deg"]) == pytest.approx(
                np.degrees(cell.joints[7]) % 360.0, abs=1e-6
            ) or float(row["e2_deg"]) == pytest.approx(np.degrees(cell.joints[7]), abs=1e-6)
            share = float(
                np.nanmin(
                    np.r_[
                        margins(cell.joints[None], limits.lower, limits.upper)[0],
                        margins(
                            cell.joints[None] @ limits.coefficients.T,
                            limits.coupled_lower,
                            limits.coupled_upper,
                        )[0],
                    ]
                )
            )
            assert float(row["joint_margin_percent"]) == pytest.approx(100.0 * share, abs=1e-6)
    states = np.array([row["state"] for row in rows]).reshape(len(board.offsets), count).T
    assert (states == "unreachable").sum() == (~picture.reachable).sum()
    assert (states == "").sum() == (picture.feasible & ~picture.hatched).sum()
