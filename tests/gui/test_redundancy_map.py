# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map of the free rotation by mouse: it shows what core computes, its curve is dragged, and becomes the plan."""

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
from tests.gui.positioner_jobs import on_positioner

ROBOT = {"limits": "paper"}
LONG = 30  # s


def job(hemisphere, layer_height=9, joints=None, **cell):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=layer_height)
    made = api.make_cell(doc, **(cell or ROBOT))
    toolpath = api.make_toolpath(doc, feature, made)
    return api.make_joint_path(doc, toolpath, made, **(joints or {}))


def opened(person, path):
    person.select(path)
    person.click("RoboticAM_SpinMap")
    panel = person.panel(NAME)
    one = docks._open[0]
    person.until(lambda: one.canvas.painted is not None, "the cells", LONG)
    person.until(
        lambda: one.board.looked.get(one.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        LONG,
    )
    person.idle(0.2)
    return panel, one


def on_screen(canvas, column, value):
    """Where a column and a value are on the screen."""
    from PySide import QtCore

    place = canvas.mapToGlobal(
        QtCore.QPoint(round(float(canvas.x_of(column))), round(float(canvas.y_of(value))))
    )
    return place.x(), place.y()


def drag(hand, canvas, column, value, to):
    """Press on a place, move in steps as a hand does, and let go."""
    start, end = on_screen(canvas, column, value), on_screen(canvas, column, to)
    hand.do("mousemove", *start)
    hand.do("mousedown", "1")
    for share in (0.15, 0.4, 0.7, 1.0):
        hand.do("mousemove", start[0], round(start[1] + share * (end[1] - start[1])))
    hand.do("mouseup", "1")
    hand.person.idle(0.2)


def values_of(one):
    return one.board.draft_values(one.draft)


def grabbed(canvas):
    """The picture on the canvas, (height, width, 3) 0..255."""
    from PySide import QtGui

    image = canvas.grab().toImage().convertToFormat(QtGui.QImage.Format_RGB32)
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)
    return rows[:, : image.width(), 2::-1].astype(int)


def test_the_picture_is_what_core_computes(person, hemisphere):
    path = job(hemisphere)
    panel, one = opened(person, path)
    person.screenshot("spin_map")
    picture, canvas = one.board.pictures[one.draft.branch], one.canvas
    one.figures.item(0, 0).setCheckState(person.core.Qt.Unchecked)
    one.figures.item(1, 0).setCheckState(person.core.Qt.Unchecked)
    person.idle()
    assert canvas.curves == []
    seen = grabbed(canvas)
    random = np.random.default_rng(4)
    for column, row in zip(
        random.integers(2, len(one.board.columns) - 2, 80), random.integers(3, 177, 80)
    ):
        if np.abs(canvas.seams - column).min() <= 2:
            continue  # lines are drawn there
        x, y = (
            round(float(canvas.x_of(column))),
            round(float(canvas.y_of(one.board.map.values[row]))),
        )
        wanted = canvas.painted.colours[row - 3 : row + 4, column - 1 : column + 2].astype(int)
        hatch = (
            canvas.painted.hatched[row - 3 : row + 4, column - 1 : column + 2].any()
            and (seen[y, x] == 20).all()
        )
        assert hatch or np.abs(seen[y, x] - wanted).max(axis=2).min() <= 3, (row, column)
    for cells, colour in ((picture.past_limit, BELOW_COLOUR), (~picture.reachable, NONE)):
        if cells.any():
            assert (canvas.painted.colours[cells] == np.round(255 * np.array(colour))).all()
    assert picture.past_limit.any()
    person.choose(panel, "colours", "condition")
    panel.findChild(person.widgets.QComboBox, "colours").activated.emit(1)
    person.idle()
    assert canvas.painted.scale.title == "condition"
    one.dock.close()
    assert docks._open == []


@pytest.mark.parametrize("overlap", [0, 5])
@pytest.mark.always("5")
def test_a_plan_that_moves_seams_is_shown_as_it_runs(person, hemisphere, overlap):
    """Axes with limits have room for a whole turn from some seams only: what is feasible must not look lost."""
    path = job(hemisphere, limits="maker")
    api.change(path.Toolpath, overlap=overlap)
    api.recompute(path)
    planned = api.result(path).joint_path
    toolpath = api.result(path.Toolpath)
    moved = [
        (other.layer, other.index)
        for (_, _, bead), other in zip(toolpath, planned.beads)
        if np.linalg.norm(bead.points[0] - other.bead.points[0]) > 1.0
    ]
    assert moved
    _, one = opened(person, path)
    followed = one.draft.evaluate(live=False)
    sums = spin_curve.sums(followed)
    assert (sums.lost, sums.wound) == (0, 0) and sums.margin >= 0.0
    for bead, start, end in zip(planned.beads, one.source.starts, one.source.starts[1:]):
        shown = followed.joints[start:end]
        np.testing.assert_allclose(shown[0], bead.joints[0], atol=1e-9)
        if (
            not overlap
        ):  # else the plan runs on past the seam; between the ends it may have more points
            np.testing.assert_allclose(shown[-1], bead.joints[-1], atol=1e-9)
    assert one.draft.full.points.closed.all()


def test_a_certificate_is_told_of_the_plan(person, hemisphere):
    path = job(hemisphere, joints={"certificate": True})
    _, one = opened(person, path)
    found = one.source.planned.optimality
    assert 0.0 <= found["gap"] < 0.01
    told = one.form.verdict.text().splitlines()[-1]
    assert told == (
        f"Certificate: {found['objective']:.4g} as planned, lower bound over all rotations {found['bound']:.4g}: a gap of "
        f"{100 * found['gap']:.1f} %, the largest, {100 * found['worst']['gap']:.1f} %, in layer {found['worst']['layer']} bead "
        f"{found['worst']['bead']}"
    )


def test_what_the_mouse_is_over_is_told(person, hemisphere, hand):
    path = job(hemisphere)
    panel, one = opened(person, path)
    label = person.field(panel, "readout")
    for column, value in ((20, 0.4), (90, -1.5), (150, 2.2)):
        hand.do("mousemove", *on_screen(one.canvas, column, value))
        person.idle(0.1)
        told = label.text()
        near = [
            k
            for k in (column - 1, column, column + 1)  # a column may be narrower than a pixel
            if told.startswith("Layer {} bead {} point {} ".format(*one.board.place(k)))
        ]
        assert len(near) == 1
        rz = float(told.split("RZ ")[1].split("°")[0])
        pixel = np.degrees(one.canvas.high - one.canvas.low) / one.canvas.area().height()
        assert rz == pytest.approx(np.degrees(value), abs=1.5 * pixel)
        shown = [float(text.split()[-1].rstrip("°")) for text in told.splitlines()[1].split("   ")]
        tool = one.board.columns.points.tool[near]
        phi = float(
            spin_map.rotation_of(one.source.cell, tool, np.array([np.radians(rz)]), "rz")[0]
        )
        q = spin_map.joints_at(one.source.task(one.draft.branch), one.board.columns, near[0], phi)[
            one.draft.branch
        ]
        assert shown == pytest.approx(np.degrees(q), abs=0.6)


def test_where_a_link_touches_the_map_is_hatched_and_says_what(person, hemisphere, hand):
    path = job(hemisphere, limits="paper", platform_diameter=200.0)
    panel, one = opened(person, path)
    person.screenshot("spin_map_touching")
    board, branch = one.board, one.draft.branch
    picture = board.pictures[branch]
    assert (
        picture.arm.any()
        and (one.canvas.painted.hatched == (picture.forbidden | picture.arm)).all()
    )
    known = spin_map.arm_touched(
        one.source.task(branch), board.map, branch, one.source.arm, board.moment
    )
    assert (picture.arm == known).all()
    free = picture.feasible & ~picture.hatched
    inside = {}
    for name, cells in (
        ("touching", picture.arm),
        ("free", free),
    ):  # cells whose neighbours are like them
        same = cells[2:-2, 1:-1].copy()
        for rows in range(5):
            for columns in range(3):
                same &= cells[
                    rows : cells.shape[0] - 4 + rows, columns : cells.shape[1] - 2 + columns
                ]
        inside[name] = np.argwhere(same) + [2, 1]
        assert len(inside[name])
    label = person.field(panel, "readout")
    for name, places in inside.items():
        row, column = places[len(places) // 2]
        hand.do("mousemove", *on_screen(one.canvas, int(column), float(board.map.values[row])))
        person.idle(0.2)
        assert ("the link of q4 touches the platform" in label.text()) == (name == "touching"), (
            label.text()
        )


def test_the_curve_is_dragged_and_becomes_the_plan(person, hemisphere, hand):
    path = job(hemisphere)
    doc = path.Document
    panel, one = opened(person, path)
    use = person.field(panel, "use")
    assert not use.isEnabled()
    planned = [bead.coefficients.copy() for bead in path.Proxy.value(path).joint_path.beads]
    column = len(one.board.columns) // 2
    value = float(values_of(one)[column])
    drag(hand, one.canvas, column, value, value + 0.5)
    moved = float(values_of(one)[column])
    assert moved == pytest.approx(value + 0.5, abs=0.06)  # a pixel or two
    assert use.isEnabled() and len(one.draft.changed) == len(planned)
    person.screenshot("spin_map_dragged")
    sums = spin_curve.sums(one.draft.evaluate(False))
    assert one.figures.item(0, 1).text().split()[0] == str(sums.lost)
    wanted = one.draft.coefficients.copy()
    steps = doc.UndoCount
    hand.click(use)
    person.until(lambda: path.Given, "the curve to be planned", LONG)
    person.until(lambda: docks._open and not one.draft.changed, "the map to follow", LONG)
    person.idle(0.3)
    assert doc.UndoCount == steps + 1
    joints = path.Proxy.value(path).joint_path
    assert (path.Status == "up to date") == (sums.lost == 0) == joints.feasible
    assert np.allclose([bead.coefficients for bead in joints.beads], wanted, atol=1e-9)
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
        lambda: np.allclose(one.draft.coefficients, planned), "the map to follow the undo", LONG
    )
    doc.redo()
    person.until(
        lambda: np.allclose(one.draft.coefficients, wanted, atol=1e-9),
        "the map to follow the redo",
        LONG,
    )
    name = doc.FileName
    App.closeDocument(doc.Name)
    person.idle(0.2)
    assert docks._open == []
    again = App.openDocument(name)
    person.idle(0.3)
    read = {one.bead: one.coefficients for one in GIVEN.read(again.getObject("JointPath").Given)}
    assert read and np.allclose(
        [read.get((layer, index), read.get(None)) for layer, index in one.source.places],
        wanted,
        atol=1e-8,
    )


def test_handles_bend_the_polynomial_of_one_bead(person, hemisphere, hand):
    path = job(hemisphere)
    panel, one = opened(person, path)
    person.field(panel, "layer").setValue(2)
    person.until(lambda: one.canvas.painted is not None and one.board.layer == 2, "the layer", LONG)
    person.field(panel, "degree").setValue(2)
    person.field(panel, "together").setChecked(False)
    person.idle(0.3)
    assert len(one.canvas.handles) == 3
    person.screenshot("spin_map_layer")
    before, handle = one.draft.coefficients.copy(), one.canvas.handles[1]
    drag(hand, one.canvas, handle.column, handle.value, handle.value + 0.6)
    after = one.draft.coefficients
    bead = one.bead
    others = [k for k in range(len(after)) if k != bead]
    assert np.array_equal(after[others], before[others])
    at = one.draft.handles(bead)
    change = np.polynomial.polynomial.polyval(at, after[bead] - before[bead])
    assert change[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-9) and change[1] == pytest.approx(
        0.6, abs=0.08
    )
    # the numbers say the same, and can be typed
    shown = [person.field(panel, f"c{k}").value() for k in range(3)]
    assert shown == pytest.approx(np.degrees(after[bead] * TURN ** np.arange(3)), abs=1e-3)
    hand.enter(panel, "c0", "12.5")
    assert np.degrees(one.draft.coefficients[bead, 0]) == pytest.approx(12.5)
    assert np.array_equal(one.draft.coefficients[others], before[others])
    person.screenshot("spin_map_handles")


@pytest.mark.long
def test_one_rz_for_all_is_dragged_and_used(person, hemisphere, hand):
    path = job(hemisphere, joints={"method": "constant", "rz": 20})
    panel, one = opened(person, path)
    values = values_of(one)
    assert np.abs(values - np.radians(20)).max() < 1e-6
    column = len(values) // 3
    drag(hand, one.canvas, column, float(values[column]), float(values[column]) - 0.7)
    assert one.draft.rz == pytest.approx(np.radians(20) - 0.7, abs=0.06)
    assert np.abs(values_of(one) - one.draft.rz).max() < 1e-6
    wanted = one.draft.rz
    sums = spin_curve.sums(one.draft.evaluate(False))
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Rz != "20.0 deg", "the plan", LONG)
    person.idle(0.3)
    assert path.Method == "constant" and float(path.Rz.split()[0]) == pytest.approx(
        np.degrees(wanted), abs=1e-6
    )
    assert (path.Status == "up to date") == (sums.lost == 0)
    person.screenshot("spin_map_constant")
    hand.click(person.field(panel, "free"))
    person.until(lambda: path.Method == "layer-by-layer", "the planner's own", LONG)
    assert path.Status == "up to date"


def test_another_branch_is_shown_and_used(person, hemisphere, hand):
    path = job(hemisphere)
    panel, one = opened(person, path)
    combo = person.field(panel, "branch")
    assert "(planned)" in combo.itemText(one.source.branch)
    combo.setCurrentIndex(0)
    combo.activated.emit(0)
    person.until(lambda: 0 in one.board.pictures, "the other branch", LONG)
    person.idle(0.2)
    person.screenshot("spin_map_branch")
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.OwnBranch == "front-up-noflip", "the plan", LONG)
    assert path.Proxy.value(path).joint_path.branch == ("front", "up", "noflip")


def test_methods_side_by_side(person, hemisphere, hand):
    path = job(hemisphere)
    panel, one = opened(person, path)
    hand.click(person.field(panel, "compare"))
    person.until(lambda: len(one.compared) == 3, "the methods", 60)
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
    assert len(one.canvas.curves) == 5
    own, by_layer = (table.item(row, 5).text().split()[0] for row in (1, 2))
    assert float(own) == pytest.approx(float(by_layer), rel=1e-2)
    for row, method in enumerate(
        ("layer-by-layer", "point-by-point", "constant"), 2
    ):  # each as its own stage has it
        plan = api.make_joint_path(path.Document, path.Toolpath, path.Cell, method=method)
        made, shown = api.result(plan).joint_path, one.compared[row - 2]
        assert made.branch == api.result(path).joint_path.branch and shown.name == method
        for drawn, bead in zip(shown.paths, made.beads, strict=True):
            ends = [
                np.exp(1j * one.joints[[0, -1]]) for one in (drawn, bead)
            ]  # whole turns and added points aside
            assert np.allclose(*ends, atol=1e-9)
        least = min(float(bead.condition.min()) for bead in shown.paths)
        assert table.item(row, 3).text() == f"{least:.4f}"
        assert (table.item(row, 1).text() == "0") == made.feasible
    curves = [np.concatenate([bead.phi for bead in method.paths]) for method in one.compared]
    assert (
        min(np.abs(curves[one] - curves[other]).max() for one, other in ((0, 1), (0, 2), (1, 2)))
        > 0.01
    )
    table.item(3, 0).setCheckState(person.core.Qt.Unchecked)
    person.idle(0.1)
    assert len(one.canvas.curves) == 4


def test_a_click_takes_the_simulation_and_the_path_there(person, hemisphere, hand):
    from freecad_am.gui.path import dock as paths
    from freecad_am.gui.simulation import dock as simulations

    path = job(hemisphere)
    person.select(path)
    person.click("RoboticAM_Simulate")
    person.click("RoboticAM_Path")
    _, one = opened(person, path)
    column = (2 * len(one.board.columns)) // 3
    free = float(values_of(one)[column]) + 0.9  # beside the curve
    hand.at(on_screen(one.canvas, column, free if free < one.canvas.high else free - 1.8))
    person.idle(0.3)
    layer, _, _ = one.board.place(column)
    moment = simulations._open[0].player.moment()
    motion = simulations._open[0].run.motion
    assert motion.layer[moment.row] == layer
    # a pixel of a narrow map stands for several columns
    pixel = -(-len(one.board.columns) // one.canvas.width())
    clicked = one.board.columns.points.position[column - pixel : column + pixel + 1]
    assert np.linalg.norm(clicked - motion.position[moment.row], axis=1).min() < 1e-6
    assert path.ViewObject.Proxy.shown[1] == layer
    assert paths.only.dock.view() is path.ViewObject.Proxy
    assert one.bead == int(one.board.columns.bead[column])
    paths.only.dock.dock.close()
    simulations._open[0].close()


def test_it_goes_when_its_joint_path_goes(person, hemisphere):
    path = job(hemisphere)
    opened(person, path)
    path.Document.removeObject(path.Name)
    person.until(lambda: docks._open == [], "the map to close", 5)
    assert "deleted" in person.window.statusBar().currentMessage()


def test_a_path_from_point_to_point_is_smoothed(person, hemisphere, hand):
    """Its curve has no polynomial: the nearest one may be used as it is."""
    path = job(hemisphere, layer_height=15, joints={"method": "point-by-point"})
    panel, one = opened(person, path)
    gap = np.abs(values_of(one) - one.board.path_values(one.draft, one.source.planned.beads))
    assert person.field(panel, "use").isEnabled() and gap.max() < 0.1
    low, high = (
        np.degrees(end(one.consequences.followed.joints[:, 1])) for end in (np.min, np.max)
    )
    assert f"q2&nbsp;{low:.1f}…{high:.1f}°" in person.field(panel, "joints").text()
    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Method == "layer-by-layer", "the plan", LONG)
    assert len(path.Given) in (1, len(one.source.places)) and path.Status == "up to date"


def test_a_table_has_no_map(person, hemisphere):
    path = job(hemisphere, machine="table-xyzac", setup="rotary-table")
    person.select(path)
    person.click("RoboticAM_SpinMap")
    assert docks._open == [] and "rotary axes" in person.window.statusBar().currentMessage()


def test_external_axes_go_along_or_stand_across(person, hand, hemisphere, monkeypatch, tmp_path):
    """Along the path they are as planned; across is one of them at the point that was clicked, where the plan is marked."""
    path = on_positioner(hemisphere, 12)
    assert path.Status == UP_TO_DATE, api.issues(path)
    panel, one = opened(person, path)
    _coloured_by_all_axes(path, one.source.cell)
    assert one.board.across is None and len(one.source.beads) == len(one.source.planned.beads)
    board = one.board
    np.testing.assert_allclose(
        board.columns.points.external,
        [
            one.source.planned.beads[k].joints[n, 6:]
            for k, n in zip(board.columns.bead, board.columns.point)
        ],
        atol=1e-9,
    )
    column = int(np.flatnonzero(board.columns.bead == 1)[5])
    free = float(values_of(one)[column]) + 0.9  # beside the curve
    hand.at(on_screen(one.canvas, column, free if free < one.canvas.high else free - 1.8))
    person.until(lambda: one.clicked.get(1) is not None, "the click")
    point = one.clicked[1]
    assert point in board.columns.point[column - 1 : column + 2]  # a column is a pixel or two wide
    person.choose(panel, "across", "e2")
    box = person.field(panel, "across")
    box.activated.emit(box.currentIndex())
    person.until(
        lambda: one.board.across == 1 and one.canvas.painted is not None, "e2 across", LONG
    )
    person.until(
        lambda: one.board.looked.get(one.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        LONG,
    )
    planned = one.source.planned.beads[1].joints[point]
    assert one.board.place(0) == (*one.source.places[1], point)
    here = one.board.marks[1]
    assert abs(one.board.offsets[here] - planned[7]) < 2.0 * np.pi / 100.0
    assert np.ptp(one.board.columns.points.external[:, 0]) == 0.0
    # where the plan is, the map has the plan's joints
    phi = one.source.planned.beads[1].phi[point]
    at = redundancy_map.across(one.source.beads, one.source.cell, (1, point), 1, planned[[7]])
    found = spin_map.joints_at(one.source.task(one.source.branch), at, 0, float(phi))[
        one.source.branch
    ]
    turns = (found - planned) / TURN
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
    person.screenshot("map_e2_across")
    assert one.board.title.startswith("e2 at layer ")
    hand.do(
        "mousemove",
        *on_screen(one.canvas, here, float(board.values(np.full(len(board.columns), phi))[column])),
    )
    person.until(lambda: "   e2 " in one.form.readout.text(), "the axes under the mouse")
    _saved(person, panel, one, monkeypatch, tmp_path / "e2")
    _two_against_each_other(person, hand, one, panel, point)
    _saved(person, panel, one, monkeypatch, tmp_path / "both")
    box = person.field(panel, "axis")
    person.choose(panel, "axis", "RZ")
    box.activated.emit(box.currentIndex())
    person.until(
        lambda: one.board.up is None and one.canvas.painted is not None, "RZ upwards", LONG
    )
    assert one.canvas.heights is None and one.canvas.curves
    box = person.field(panel, "across")
    person.choose(panel, "across", "the path")
    box.activated.emit(box.currentIndex())
    person.until(lambda: one.board.across is None, "the path across", LONG)


def _coloured_by_all_axes(path, cell):
    """Beads of the view by the share that robot and positioner have left, and by speeds: the positioner's count."""
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


def _two_against_each_other(person, hand, one, panel, point):
    """e2 across, e1 upwards: where both are planned is marked, the rotation is the plan's, the axes under the mouse are
    those of the place, and there is no curve to drag."""
    box = person.field(panel, "axis")
    person.choose(panel, "axis", "e1")
    box.activated.emit(box.currentIndex())
    person.until(lambda: one.board.up == 0 and one.canvas.painted is not None, "e1 upwards", LONG)
    person.until(
        lambda: one.board.looked.get(one.draft.branch) == FINE_STRIDE,
        "the links of the robot",
        LONG,
    )
    planned = one.source.planned.beads[1]
    pair, picture = one.board.pair, one.board.pictures[one.draft.branch]
    assert (
        picture.margin.shape
        == (len(pair.values), len(one.board.offsets))
        == one.canvas.painted.hatched.shape
    )
    assert (
        one.board.title.startswith("e2 against e1 at layer ")
        and not one.canvas.curves
        and not one.canvas.handles
    )
    assert (
        pair.values[0] <= planned.joints[point, 6] <= pair.values[-1]
        and pair.phi == planned.phi[point]
    )
    texts, height = one.canvas.heights
    low, high = (float(text.rstrip("°")) for text in (texts[0][1], texts[-1][1]))
    where = low + (height + np.pi) / TURN * (high - low)
    assert abs(where - np.degrees(planned.joints[point, 6])) < 0.51  # texts are whole degrees
    there = one.board.cell(one.draft.branch, int(one.board.marks[1]), height)
    turns = (there.joints - planned.joints[point])[6:]
    assert np.abs(turns).max() < np.radians(3.0) and there.phi == planned.phi[point]
    hand.do("mousemove", *on_screen(one.canvas, 20, 0.8 * np.pi))
    wanted = np.degrees([pair.values[round(0.9 * (len(pair.values) - 1))], one.board.offsets[20]])

    def told():
        words = one.form.readout.text().split()
        found = [
            float(words[words.index(name) + 1].rstrip("°"))
            for name in ("e1", "e2")
            if name in words
        ]
        return len(found) == 2 and np.abs(np.array(found) - wanted).max() < 5.0

    person.until(
        lambda: told() or "out of reach" in one.form.readout.text(), "the axes under the mouse"
    )
    person.screenshot("map_e2_against_e1")


def _saved(person, panel, one, monkeypatch, name):
    """The map in files: a row for each cell, whose margin is that of joints worked out anew; the drawing has its words."""
    for ending in ("png", "svg", "csv"):
        path = name.with_suffix(f".{ending}")
        monkeypatch.setattr(
            person.widgets.QFileDialog,
            "getSaveFileName",
            staticmethod(lambda *_, path=path: (str(path), "")),
        )
        person.field(panel, "save").click()
        person.until(path.exists, f"the {ending}", LONG)
        person.idle(0.1)
    assert name.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert one.board.title in name.with_suffix(".svg").read_text(encoding="utf-8")
    with open(name.with_suffix(".csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    board, limits = one.board, one.source.cell.limits
    count = len(board.map.values) if board.pair is None else len(board.pair.values)
    assert len(rows) == count * len(board.offsets) and {row["point"] for row in rows} == {
        str(board.place(0)[2])
    }
    picture = board.pictures[one.draft.branch]
    for index in np.random.default_rng(5).integers(0, len(rows), 40):
        row, column = rows[index], index // count
        height = (
            2.0 * np.pi * (index % count) / (count - 1) - np.pi
            if board.pair is not None
            else float(board.map.values[index % count])
        )
        cell = board.cell(one.draft.branch, int(column), height)
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
