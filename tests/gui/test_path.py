# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths layer by layer and point by point, as lines and as tubes, and clicks on them."""

import dataclasses
import gc
import weakref

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.toolpath import BeadRole, Layer
from freecad_am.gui.path import colouring, dock, path_view
from freecad_am.gui.path.dock import facts
from freecad_am.gui.path.pieces import BLOCK, PIECE, Rows


def drawn_pixels(person):
    """Return which pixels (450, 600) of a picture show something, without the legend."""
    view = person.gui.activeDocument().activeView()
    path = str(person.folder / "path.png")
    view.saveImage(path, 600, 450, "White")
    image = person.widgets.QImage(path).convertToFormat(person.widgets.QImage.Format_RGB32)
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(450, -1, 4)[:, :600, :3]
    is_drawn = (rows < 250).any(axis=2)
    is_drawn[:, :140] = False  # the legend
    return is_drawn


def front(person):
    view = person.gui.activeDocument().activeView()
    view.viewFront()
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle(0.3)


def test_layers_and_points_by_sliders_and_numbers(person, hand, joint_path):
    rows = joint_path.ViewObject.Proxy.rows
    person.click("RoboticAM_Path")
    panel = person.panel(dock.NAME)
    front(person)
    full_picture = drawn_pixels(person)
    to, point = person.field(panel, "to_slider"), person.field(panel, "point_slider")
    assert (to.minimum(), to.maximum(), to.value()) == (
        0,
        rows.layer_count - 1,
        rows.layer_count - 1,
    )
    hand.click(person.field(panel, "to_back"))
    assert to.value() == rows.layer_count - 2
    hand.click(person.field(panel, "to_spin"))
    hand.do("key", "ctrl+a")
    hand.do("type", "3")
    hand.do("key", "Tab")
    lower = drawn_pixels(person)
    tops = [int(np.flatnonzero(picture_.any(axis=1))[0]) for picture_ in (full_picture, lower)]
    assert tops[1] > tops[0] + 40  # the upper layers are hidden
    assert 0 < lower.sum() < full_picture.sum()
    person.field(panel, "from_spin").setValue(3)
    alone = drawn_pixels(person)
    assert 0 < alone.sum() < 0.5 * lower.sum()
    assert joint_path.ViewObject.Proxy.shown == (3, 3, None)
    low, high = rows.layer_rows(3, 3)
    assert (point.minimum(), point.maximum()) == (0, high - low - 1)
    point.setValue((high - low) // 2)
    person.idle()
    assert 0 < drawn_pixels(person).sum() < alone.sum()
    text = person.field(panel, "facts").text()
    row = low + (high - low) // 2
    assert (
        f"point {point.value()} (0 to {high - low - 1})" in text
    )  # the field and the text have the same numbers
    assert person.field(panel, "point_spin").value() == point.value()
    row_text = joint_path.ViewObject.Proxy.scale.text_at(row)
    assert row_text.startswith("joint margin ") and row_text.endswith(" %")
    assert text == f"{row_text} · {facts(rows, row)}" and "Layer 3 (0 to" in text and "mm/s" in text
    person.screenshot("path_dock")
    hand.click(person.field(panel, "all"))
    assert (
        joint_path.ViewObject.Proxy.shown is None
        and drawn_pixels(person).sum() == full_picture.sum()
    )
    hand.click(person.field(panel, "single"))
    assert joint_path.ViewObject.Proxy.shown == (rows.layer_count - 1, rows.layer_count - 1, None)
    hand.click(person.field(panel, "from_back"))
    assert joint_path.ViewObject.Proxy.shown == (rows.layer_count - 2, rows.layer_count - 2, None)
    hand.click(person.field(panel, "from_slider"))
    shown_state = joint_path.ViewObject.Proxy.shown[0]
    hand.do("key", "Right")
    assert joint_path.ViewObject.Proxy.shown == (shown_state + 1, shown_state + 1, None)
    hand.do("key", "Left", "Left")
    assert joint_path.ViewObject.Proxy.shown == (shown_state - 1, shown_state - 1, None)
    panel.close()


def test_the_dock_follows_what_there_is(person, joint_path):
    document = joint_path.Document
    toolpath = document.Toolpath
    dock.show()
    panel = person.panel(dock.NAME)
    choice = person.field(panel, "path")
    assert choice.currentText() == joint_path.Label and choice.count() == 2
    choice.setCurrentIndex(choice.findText(toolpath.Label))
    choice.activated.emit(choice.currentIndex())
    person.idle()
    assert toolpath.ViewObject.Visibility and not joint_path.ViewObject.Visibility
    person.gui.runCommand("Std_Undo")  # the joint path is undone
    person.idle()
    assert choice.count() == 1 and choice.currentText() == toolpath.Label
    person.field(panel, "colouring").activated.emit(0)
    document.removeObject(toolpath.Name)
    person.idle()
    assert choice.count() == 0 and "no path" in person.field(panel, "facts").text()
    other_document = App.newDocument("Other")
    person.idle()
    App.closeDocument(document.Name)
    person.idle()
    App.closeDocument(other_document.Name)
    person.idle()
    assert not person.field(panel, "to_slider").isEnabled()
    panel.close()


def test_tubes_are_as_wide_and_as_high_as_they_are(person, joint_path):
    vobj = joint_path.ViewObject
    vobj.Colouring, vobj.ShowRapids, vobj.ShowLegend = "kind of bead", False, False
    front(person)
    lines = drawn_pixels(person)
    scale = (np.ptp(np.flatnonzero(lines.any(axis=0))) - 1) / 90.0  # lines are 2 px wide
    vobj.Look = "tubes"
    vobj.Proxy.show((0, 0, None))
    person.idle()
    line_picture = drawn_pixels(person)
    person.screenshot("tubes")
    across, down = (
        np.flatnonzero(line_picture.any(axis=0)),
        np.flatnonzero(line_picture.any(axis=1)),
    )
    assert np.ptp(across) + 1 == pytest.approx(
        scale * (90.0 + 8.0), abs=3
    )  # the part, and half a width on both sides
    assert np.ptp(down) + 1 == pytest.approx(scale * 5.0, abs=3)
    vobj.Proxy.show(None)
    assert drawn_pixels(person).sum() > 3 * lines.sum()


def test_each_kind_of_bead_is_told(person, joint_path):
    bead = joint_path.ViewObject.Proxy.rows.beads[0]
    kinds = ("", "contour", "zigzag", "line", "spiral", "centre", "closing")
    beads = [dataclasses.replace(bead, role=BeadRole(kind)) for kind in kinds]
    bead_kinds = [colouring.class_of(bead) for bead in beads]
    assert bead_kinds == [
        colouring.CLOSED_BEAD,
        colouring.CLOSED_BEAD,
        *3 * [colouring.OPEN_BEAD],
        colouring.CENTRE,
        colouring.CLOSING,
    ]
    texts = [facts(Rows.of([bead], [0], 8.0, lambda: 1.0), 3) for bead in beads]
    assert len(set(texts)) == len(kinds) and "centre bead" in texts[5]


def test_of_several_beads_the_point_is_told_as_the_dock_counts(person, joint_path):
    beads = joint_path.ViewObject.Proxy.rows.beads[:2]
    rows = Rows.of(list(beads), [0, 0], 8.0, lambda: 1.0)
    first_length, second_length = map(len, beads)
    text = facts(rows, first_length + 3)
    assert "bead 1 (0 to 1), closed" in text
    assert (
        f"point {first_length + 3} (0 to {first_length + second_length - 1}) of the layer, of the bead point 3 (0 to {second_length - 1}) at"
        in text
    )


def test_directions_and_rapids_are_of_what_is_shown(person, joint_path):
    vobj = joint_path.ViewObject
    vobj.ShowDirections, vobj.DirectionStep = True, 1
    person.look()

    def pink():
        return person.screen_pixels((219, 51, 140), 30)

    full_count = pink()
    assert full_count > 200
    vobj.Proxy.show((2, 2, None))
    assert 0 < pink() < 0.6 * full_count
    counted = vobj.Proxy.rapids.lines.numVertices.getNum()
    vobj.Proxy.show(None)
    assert 0 < counted < vobj.Proxy.rapids.lines.numVertices.getNum()
    vobj.ShowDirections = False
    assert pink() == 0


def test_a_stretch_of_a_large_path_changes_little(person, joint_path):
    """Complete blocks stay; only the two at the ends change."""
    document = joint_path.Document
    path = api.result(document.Toolpath)
    layers = tuple(
        Layer(layer.beads) for _ in range(-(-30_000 // path.point_count)) for layer in path.layers
    )
    large_path = dataclasses.replace(path, layers=layers)
    toolpath = document.Toolpath
    toolpath.ViewObject.Visibility = True
    view = toolpath.ViewObject.Proxy
    view.draw(toolpath, large_path)
    view.path.paint(np.full((len(view.rows), 3), 0.5))
    cuts = view.rows.cuts
    assert (
        len(cuts) > 6
        and np.diff(cuts).max() < 2 * PIECE
        and (cuts[0], cuts[-1]) == (0, len(view.rows))
    )
    blocks = [view.path.lines.pieces.getChild(k).getChild(0) for k in range(len(cuts) - 1)]
    for look, first_row, block in ((view.path.lines, 1, 0), (view.path.tubes, 0, BLOCK)):
        view.path.look(look is view.path.tubes)
        made_ranges = []
        make = look.make
        look.make = lambda first_row, end, made_ranges=made_ranges, make=make: (
            made_ranges.append((first_row, end)) or make(first_row, end)
        )
        for last_layer in range(view.rows.layer_count - 1, 0, -3):
            view.show((first_row, last_layer, 5))
        # besides the rows before the first block, only the last segment, or the last block of
        # tubes, changes
        start_row = view.rows.layer_rows(first_row, first_row)[0]
        assert max(end - start for start, end in made_ranges) < 2 * PIECE
        assert (
            max(
                (end - start for start, end in made_ranges if start not in (start_row, *cuts)),
                default=0,
            )
            < 9 + block
        )
        view.show(None)
        made_ranges.clear()
        for end in range(len(view.rows) - 300, len(view.rows)):  # as in a running simulation
            view.path.show(0, end)
        assert (
            len(made_ranges) < 302
            and sum(end - start for start, end in made_ranges) < (4 + block) * 302
        )
        look.make = make
    view.path.look(False)
    assert [view.path.lines.pieces.getChild(k).getChild(0) for k in range(len(cuts) - 1)] == blocks
    view.show(None)


@pytest.mark.parametrize("first", [0, 1, 57, 4096, 5000])
@pytest.mark.always("4096", "0", "1")
def test_every_row_of_a_stretch_is_drawn_once(person, joint_path, first):
    """The line sets of blocks and ends together are the polylines of the rows."""
    path = api.result(joint_path.Document.Toolpath)
    bead = path.layers[0].beads[0]
    long = dataclasses.replace(
        bead,
        **{
            name: np.tile(getattr(bead, name), (150, 1))[:14000]
            for name in ("points", "build", "tool")
        },
        parameter=np.arange(14000.0),
        speed=np.full(14000, 8.0),
        closed=False,
        width=None,
        tangents=None,
    )
    rows = Rows.of([bead, long, bead], [0, 1, 2], 8.0, lambda: 1.0)
    view = joint_path.Document.Toolpath.ViewObject.Proxy
    view.rows = rows
    view.path.set(rows)
    view.path.paint(np.full((len(rows), 3), 0.5))
    for end in (first + 2, 5001, 9000, len(rows)):
        view.path.show(first, end)
        drawn_edges = sorted(
            edge for node in shown_nodes(view.path.lines) for edge in edges(node, rows)
        )
        bead_of = np.searchsorted(rows.starts, np.arange(len(rows)), side="right")
        expected = [row for row in range(first, end - 1) if bead_of[row] == bead_of[row + 1]]
        assert len(drawn_edges) == len(expected)
    lengths = np.linalg.norm(np.diff(rows.points, axis=0), axis=1)[expected]
    assert sum(drawn_edges) == pytest.approx(lengths.sum(), rel=1e-4)


def shown_nodes(look):
    for k in range(look.pieces.getNumChildren()):
        switch = look.pieces.getChild(k)
        if switch.whichChild.getValue() != -1:
            yield switch.getChild(0).getChild(0)
    for k in range(look.ends.getNumChildren()):
        yield look.ends.getChild(k).getChild(0)


def edges(line_set, rows):
    """Return the lengths of the edges of a line set."""
    values = line_set.vertexProperty.getValue()
    points = np.array([point.getValue() for point in values.vertex.getValues()])
    start = 0
    for count in line_set.numVertices.getValues():
        yield from np.linalg.norm(np.diff(points[start : start + count], axis=0), axis=1)
        start += count
    assert start <= len(points)


def screen_position(view, hand, point):
    """Return the position of a point of the 3D view on the screen, by FreeCAD's own projection."""
    on_view = getattr(view, "getPointOnViewport", None) or view.getPointOnScreen
    x, y = on_view(App.Vector(*map(float, point)))
    position = hand.corner(view) + hand.person.core.QPoint(x, view.getSize()[1] - 1 - y)
    return position.x(), position.y()


@pytest.mark.parametrize("look", ["lines", "tubes"])
@pytest.mark.always("tubes")
def test_a_click_on_the_path_goes_to_the_point(person, hand, joint_path, look):
    proxy = joint_path.ViewObject.Proxy
    rows = proxy.rows
    document = joint_path.Document
    joint_path.ViewObject.Look = look
    document.Sphere.ViewObject.Visibility = False
    person.click("RoboticAM_Path")
    panel = person.panel(dock.NAME)
    person.field(panel, "single").setChecked(False)  # another test may have left it on
    view = person.gui.activeDocument().activeView()
    view.viewFront()
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle(0.5)
    toward = np.array(view.getViewDirection())
    aim = rows.points + (0.5 * rows.height[:, None] * rows.build if look == "tubes" else 0.0)
    facing = np.flatnonzero(rows.points @ toward < -12.0)  # the near side of the dome
    random = np.random.default_rng(8)
    targets = random.choice(facing, 6, replace=False)
    for target in targets:
        proxy.show(None)
        person.idle(0.1)
        if target == targets[0]:  # dragging the mouse selects no point
            hand.do("mousemove", *screen_position(view, hand, aim[target]))
            hand.do("mousedown", 1)
            hand.do("mousemove_relative", 30, 12)
            hand.do("mouseup", 1)
            person.idle(0.3)
            assert proxy.shown is None
        hand.at(screen_position(view, hand, aim[target]))
        person.until(lambda: proxy.shown is not None, "the click to count", 5)
        first_shown, layer, count = proxy.shown
        row = rows.layer_rows(layer, layer)[0] + count - 1
        # the distance as seen, a pixel or two, because points of the dome's side are close to each
        # other; beads are 5 mm apart
        offset = np.subtract(
            screen_position(view, hand, aim[row]), screen_position(view, hand, aim[target])
        )
        assert (
            np.abs(offset).max() <= 3
            and np.linalg.norm(rows.points[row] - rows.points[target]) < 3.0
            and first_shown == 0
        )
        assert layer == rows.layers[rows.bead_of(int(target))]
        assert (
            person.field(panel, "to_spin").value() == layer
            and person.field(panel, "point_spin").value() == count - 1
        )
        assert facts(rows, row) in person.field(panel, "facts").text()
    person.screenshot(f"path_clicked_{look}")
    # a hidden point cannot be selected: with only the lower layers, a click on a higher one does
    # nothing
    proxy.show((0, 2, None))
    person.idle(0.1)
    top = int(rows.layer_rows(rows.layer_count - 3, rows.layer_count - 3)[0])
    hand.at(screen_position(view, hand, aim[top]))
    person.idle(0.3)
    assert proxy.shown == (0, 2, None)
    # nor can one after the dock is closed, when everything is visible again
    panel.close()
    assert proxy.shown is None
    hand.at(screen_position(view, hand, aim[facing[0]]))
    person.idle(0.3)
    assert proxy.shown is None


def test_nothing_of_a_path_is_kept_once_its_document_is_closed(person, joint_path):
    document = joint_path.Document
    document.Toolpath.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    front(person)
    views = [obj.ViewObject.Proxy for obj in (document.Toolpath, joint_path)]
    assert all(len(view.rows) for view in views)
    references = [
        weakref.ref(obj)
        for view in views
        for obj in (view, view.rows, view.clicks, view.path, view.legend)
    ]
    del views
    gc.collect()
    assert all(reference() is not None for reference in references)  # the document has them
    App.closeDocument(document.Name)
    person.idle(0.5)
    gc.collect()
    assert [reference() for reference in references if reference() is not None] == []


def test_of_three_hundred_thousand_points_the_foremost_near_the_mouse_is_meant():
    random = np.random.default_rng(9)
    points = random.uniform(-100, 100, (300_000, 3))
    turn = np.eye(4)
    turn[:3, :3] = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn[3, :3] = 5.0, -3.0, 2.0
    to_screen = np.diag([1 / 150, 1 / 120, -1 / 400, 1.0])  # orthographic, from above
    size = np.array([800.0, 600.0])
    sight = path_view.Sight(turn, to_screen, size, np.array([0.0, 0.0, -1.0]))
    world = points @ turn[:3, :3] + turn[3, :3]
    flat = 0.5 * (world[:, :2] / [150, 120] + 1) * size
    for mouse in random.uniform([200, 150], [600, 450], (20, 2)):
        nearest_row = path_view.nearest(points, 0.0, 2.0, sight, mouse)
        distances = np.linalg.norm(flat - mouse, axis=1)
        is_near = distances <= path_view.REACH_PX
        highest = world[is_near, 2].max()
        front = is_near & (world[:, 2] >= highest - path_view.DEEP * 2.0)
        assert front[nearest_row] and distances[nearest_row] == distances[front].min()
    assert path_view.nearest(points, 0.0, 2.0, sight, np.array([5.0, 5.0])) is None
    # a tube of 9 mm has its visible width: 22.5 px to each side
    alone, beside = world[:1] - turn[3, :3], np.array([[20.0, 0.0], [25.0, 0.0]]) + flat[0]
    hit = [
        path_view.nearest(alone @ turn[:3, :3].T, 9.0, 9.0, sight, pointer) for pointer in beside
    ]
    assert hit == [0, None]


def test_the_nozzle_stands_where_the_stretch_ends_that_is_shown(person, joint_path):
    cell, rows = joint_path.Cell, joint_path.ViewObject.Proxy.rows
    cell.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    panel = person.panel(dock.NAME)
    nozzle = cell.ViewObject.Proxy.nodes.nozzle

    def stands():
        """Return tip and axis of the drawn nozzle."""
        search = nozzle.getChild(0).matrix.getValue().getValue()
        return np.array(search)[3, :3], np.array(search)[2, :3]

    end = stands()
    person.field(panel, "to_spin").setValue(3)
    low, high = rows.layer_rows(3, 3)
    assert np.allclose(stands()[0], rows.points[high - 1], atol=1e-3)
    person.field(panel, "point_slider").setValue(7)
    bead = rows.bead(rows.bead_of(low + 7))
    assert np.allclose(stands()[0], rows.points[low + 7], atol=1e-3)
    assert np.allclose(stands()[1], bead.tool[7], atol=1e-5)
    person.screenshot("nozzle-at-layer")
    person.field(panel, "all").click()
    assert np.allclose(stands(), end, atol=1e-6)
    panel.close()
