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


def drawn(person):
    """Which pixels (450, 600) of a picture show something, the legend left out."""
    view = person.gui.activeDocument().activeView()
    path = str(person.folder / "path.png")
    view.saveImage(path, 600, 450, "White")
    image = person.widgets.QImage(path).convertToFormat(person.widgets.QImage.Format_RGB32)
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(450, -1, 4)[:, :600, :3]
    seen = (rows < 250).any(axis=2)
    seen[:, :140] = False  # the legend
    return seen


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
    whole = drawn(person)
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
    lower = drawn(person)
    tops = [int(np.flatnonzero(one.any(axis=1))[0]) for one in (whole, lower)]
    assert tops[1] > tops[0] + 40  # the upper layers are gone
    assert 0 < lower.sum() < whole.sum()
    person.field(panel, "from_spin").setValue(3)
    alone = drawn(person)
    assert 0 < alone.sum() < 0.5 * lower.sum()
    assert joint_path.ViewObject.Proxy.shown == (3, 3, None)
    low, high = rows.layer_rows(3, 3)
    assert (point.minimum(), point.maximum()) == (0, high - low - 1)
    point.setValue((high - low) // 2)
    person.idle()
    assert 0 < drawn(person).sum() < alone.sum()
    text = person.field(panel, "facts").text()
    row = low + (high - low) // 2
    assert (
        f"point {point.value()} (0 to {high - low - 1})" in text
    )  # the field and the text count alike
    assert person.field(panel, "point_spin").value() == point.value()
    told = joint_path.ViewObject.Proxy.scale.text_at(row)
    assert told.startswith("joint margin ") and told.endswith(" %")
    assert text == f"{told} · {facts(rows, row)}" and "Layer 3 (0 to" in text and "mm/s" in text
    person.screenshot("path_dock")
    hand.click(person.field(panel, "all"))
    assert joint_path.ViewObject.Proxy.shown is None and drawn(person).sum() == whole.sum()
    hand.click(person.field(panel, "single"))
    assert joint_path.ViewObject.Proxy.shown == (rows.layer_count - 1, rows.layer_count - 1, None)
    hand.click(person.field(panel, "from_back"))
    assert joint_path.ViewObject.Proxy.shown == (rows.layer_count - 2, rows.layer_count - 2, None)
    hand.click(person.field(panel, "from_slider"))
    there = joint_path.ViewObject.Proxy.shown[0]
    hand.do("key", "Right")
    assert joint_path.ViewObject.Proxy.shown == (there + 1, there + 1, None)
    hand.do("key", "Left", "Left")
    assert joint_path.ViewObject.Proxy.shown == (there - 1, there - 1, None)
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
    person.gui.runCommand("Std_Undo")  # of the joint path
    person.idle()
    assert choice.count() == 1 and choice.currentText() == toolpath.Label
    person.field(panel, "colouring").activated.emit(0)
    document.removeObject(toolpath.Name)
    person.idle()
    assert choice.count() == 0 and "no path" in person.field(panel, "facts").text()
    other = App.newDocument("Other")
    person.idle()
    App.closeDocument(document.Name)
    person.idle()
    App.closeDocument(other.Name)
    person.idle()
    assert not person.field(panel, "to_slider").isEnabled()
    panel.close()


def test_tubes_are_as_wide_and_as_high_as_they_are(person, joint_path):
    vobj = joint_path.ViewObject
    vobj.Colouring, vobj.ShowRapids, vobj.ShowLegend = "kind of bead", False, False
    front(person)
    lines = drawn(person)
    scale = (np.ptp(np.flatnonzero(lines.any(axis=0))) - 1) / 90.0  # lines are 2 px wide
    vobj.Look = "tubes"
    vobj.Proxy.show((0, 0, None))
    person.idle()
    first = drawn(person)
    person.screenshot("tubes")
    across, down = np.flatnonzero(first.any(axis=0)), np.flatnonzero(first.any(axis=1))
    assert np.ptp(across) + 1 == pytest.approx(
        scale * (90.0 + 8.0), abs=3
    )  # the part, and half a width on both sides
    assert np.ptp(down) + 1 == pytest.approx(scale * 5.0, abs=3)
    vobj.Proxy.show(None)
    assert drawn(person).sum() > 3 * lines.sum()


def test_each_kind_of_bead_is_told(person, joint_path):
    bead = joint_path.ViewObject.Proxy.rows.beads[0]
    kinds = ("", "contour", "zigzag", "line", "spiral", "centre", "closing")
    beads = [dataclasses.replace(bead, role=BeadRole(kind)) for kind in kinds]
    found = [colouring.class_of(each) for each in beads]
    assert found == [
        colouring.CLOSED_BEAD,
        colouring.CLOSED_BEAD,
        *3 * [colouring.OPEN_BEAD],
        colouring.CENTRE,
        colouring.CLOSING,
    ]
    told = [facts(Rows.of([each], [0], 8.0, lambda: 1.0), 3) for each in beads]
    assert len(set(told)) == len(kinds) and "centre bead" in told[5]


def test_of_several_beads_the_point_is_told_as_the_dock_counts(person, joint_path):
    beads = joint_path.ViewObject.Proxy.rows.beads[:2]
    rows = Rows.of(list(beads), [0, 0], 8.0, lambda: 1.0)
    first, second = map(len, beads)
    told = facts(rows, first + 3)
    assert "bead 1 (0 to 1), closed" in told
    assert (
        f"point {first + 3} (0 to {first + second - 1}) of the layer, of the bead point 3 (0 to {second - 1}) at"
        in told
    )


def test_directions_and_rapids_are_of_what_is_shown(person, joint_path):
    vobj = joint_path.ViewObject
    vobj.ShowDirections, vobj.DirectionStep = True, 1
    person.look()

    def pink():
        return person.screen_pixels((219, 51, 140), 30)

    whole = pink()
    assert whole > 200
    vobj.Proxy.show((2, 2, None))
    assert 0 < pink() < 0.6 * whole
    counted = vobj.Proxy.rapids.lines.numVertices.getNum()
    vobj.Proxy.show(None)
    assert 0 < counted < vobj.Proxy.rapids.lines.numVertices.getNum()
    vobj.ShowDirections = False
    assert pink() == 0


def test_a_stretch_of_a_large_path_changes_little(person, joint_path):
    """Whole pieces are kept; only the two at the ends are made anew."""
    document = joint_path.Document
    path = api.result(document.Toolpath)
    layers = tuple(
        Layer(layer.beads) for _ in range(-(-30_000 // path.point_count)) for layer in path.layers
    )
    many = dataclasses.replace(path, layers=layers)
    toolpath = document.Toolpath
    toolpath.ViewObject.Visibility = True
    view = toolpath.ViewObject.Proxy
    view.draw(toolpath, many)
    view.path.paint(np.full((len(view.rows), 3), 0.5))
    cuts = view.rows.cuts
    assert (
        len(cuts) > 6
        and np.diff(cuts).max() < 2 * PIECE
        and (cuts[0], cuts[-1]) == (0, len(view.rows))
    )
    pieces = [view.path.lines.pieces.getChild(k).getChild(0) for k in range(len(cuts) - 1)]
    for look, first, block in ((view.path.lines, 1, 0), (view.path.tubes, 0, BLOCK)):
        view.path.look(look is view.path.tubes)
        made = []
        make = look.make
        look.make = lambda first, end, made=made, make=make: (
            made.append((first, end)) or make(first, end)
        )
        for last in range(view.rows.layer_count - 1, 0, -3):
            view.show((first, last, 5))
        # but for what lies before the first piece, no more than the last segment, of tubes the last block, is made anew
        before = view.rows.layer_rows(first, first)[0]
        assert max(end - start for start, end in made) < 2 * PIECE
        assert (
            max((end - start for start, end in made if start not in (before, *cuts)), default=0)
            < 9 + block
        )
        view.show(None)
        made.clear()
        for end in range(len(view.rows) - 300, len(view.rows)):  # as a simulation grows
            view.path.show(0, end)
        assert len(made) < 302 and sum(end - start for start, end in made) < (4 + block) * 302
        look.make = make
    view.path.look(False)
    assert [view.path.lines.pieces.getChild(k).getChild(0) for k in range(len(cuts) - 1)] == pieces
    view.show(None)


@pytest.mark.parametrize("first", [0, 1, 57, 4096, 5000])
@pytest.mark.always("4096", "0", "1")
def test_every_row_of_a_stretch_is_drawn_once(person, joint_path, first):
    """Line sets of pieces and of ends, put together, are the polylines of the rows."""
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
        wanted = [row for row in range(first, end - 1) if bead_of[row] == bead_of[row + 1]]
        assert len(drawn_edges) == len(wanted)
    lengths = np.linalg.norm(np.diff(rows.points, axis=0), axis=1)[wanted]
    assert sum(drawn_edges) == pytest.approx(lengths.sum(), rel=1e-4)


def shown_nodes(look):
    for k in range(look.pieces.getNumChildren()):
        switch = look.pieces.getChild(k)
        if switch.whichChild.getValue() != -1:
            yield switch.getChild(0).getChild(0)
    for k in range(look.ends.getNumChildren()):
        yield look.ends.getChild(k).getChild(0)


def edges(line_set, rows):
    """Lengths of the edges of a line set."""
    values = line_set.vertexProperty.getValue()
    points = np.array([point.getValue() for point in values.vertex.getValues()])
    at = 0
    for count in line_set.numVertices.getValues():
        yield from np.linalg.norm(np.diff(points[at : at + count], axis=0), axis=1)
        at += count
    assert at <= len(points)


def where(view, hand, point):
    """Where a point of the 3D view is on the screen, by FreeCAD's own projection."""
    on_view = getattr(view, "getPointOnViewport", None) or view.getPointOnScreen
    x, y = on_view(App.Vector(*map(float, point)))
    place = hand.corner(view) + hand.person.core.QPoint(x, view.getSize()[1] - 1 - y)
    return place.x(), place.y()


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
    person.field(panel, "single").setChecked(False)  # as another test may have left it
    view = person.gui.activeDocument().activeView()
    view.viewFront()
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle(0.5)
    toward = np.array(view.getViewDirection())
    aim = rows.points + (0.5 * rows.height[:, None] * rows.build if look == "tubes" else 0.0)
    facing = np.flatnonzero(rows.points @ toward < -12.0)  # the near side of the dome
    random = np.random.default_rng(8)
    chosen = random.choice(facing, 6, replace=False)
    for wanted in chosen:
        proxy.show(None)
        person.idle(0.1)
        if wanted == chosen[0]:  # a mouse that is dragged means no point
            hand.do("mousemove", *where(view, hand, aim[wanted]))
            hand.do("mousedown", 1)
            hand.do("mousemove_relative", 30, 12)
            hand.do("mouseup", 1)
            person.idle(0.3)
            assert proxy.shown is None
        hand.at(where(view, hand, aim[wanted]))
        person.until(lambda: proxy.shown is not None, "the click to count", 5)
        first, layer, count = proxy.shown
        row = rows.layer_rows(layer, layer)[0] + count - 1
        # as seen a pixel or two away, where points of the dome's side are close to each other; beads are 5 mm apart
        away = np.subtract(where(view, hand, aim[row]), where(view, hand, aim[wanted]))
        assert (
            np.abs(away).max() <= 3
            and np.linalg.norm(rows.points[row] - rows.points[wanted]) < 3.0
            and first == 0
        )
        assert layer == rows.layers[rows.bead_of(int(wanted))]
        assert (
            person.field(panel, "to_spin").value() == layer
            and person.field(panel, "point_spin").value() == count - 1
        )
        assert facts(rows, row) in person.field(panel, "facts").text()
    person.screenshot(f"path_clicked_{look}")
    # what is hidden is not hit: with the lower layers alone a click on a higher one does nothing
    proxy.show((0, 2, None))
    person.idle(0.1)
    top = int(rows.layer_rows(rows.layer_count - 3, rows.layer_count - 3)[0])
    hand.at(where(view, hand, aim[top]))
    person.idle(0.3)
    assert proxy.shown == (0, 2, None)
    # nor anything once the dock is closed, with which all is to be seen again
    panel.close()
    assert proxy.shown is None
    hand.at(where(view, hand, aim[facing[0]]))
    person.idle(0.3)
    assert proxy.shown is None


def test_nothing_of_a_path_is_kept_once_its_document_is_closed(person, joint_path):
    document = joint_path.Document
    document.Toolpath.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    front(person)
    views = [obj.ViewObject.Proxy for obj in (document.Toolpath, joint_path)]
    assert all(len(view.rows) for view in views)
    kept = [
        weakref.ref(one)
        for view in views
        for one in (view, view.rows, view.clicks, view.path, view.legend)
    ]
    del views
    gc.collect()
    assert all(one() is not None for one in kept)  # the document has them
    App.closeDocument(document.Name)
    person.idle(0.5)
    gc.collect()
    assert [one() for one in kept if one() is not None] == []


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
    for place in random.uniform([200, 150], [600, 450], (20, 2)):
        found = path_view.nearest(points, 0.0, 2.0, sight, place)
        away = np.linalg.norm(flat - place, axis=1)
        near = away <= path_view.REACH_PX
        highest = world[near, 2].max()
        front = near & (world[:, 2] >= highest - path_view.DEEP * 2.0)
        assert front[found] and away[found] == away[front].min()
    assert path_view.nearest(points, 0.0, 2.0, sight, np.array([5.0, 5.0])) is None
    # a tube of 9 mm is as wide as it is seen: 22.5 px to each side
    alone, beside = world[:1] - turn[3, :3], np.array([[20.0, 0.0], [25.0, 0.0]]) + flat[0]
    hit = [path_view.nearest(alone @ turn[:3, :3].T, 9.0, 9.0, sight, place) for place in beside]
    assert hit == [0, None]


def test_the_nozzle_stands_where_the_stretch_ends_that_is_shown(person, joint_path):
    cell, rows = joint_path.Cell, joint_path.ViewObject.Proxy.rows
    cell.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    panel = person.panel(dock.NAME)
    nozzle = cell.ViewObject.Proxy.nodes.nozzle

    def stands():
        """Tip and axis of the nozzle that is drawn."""
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
