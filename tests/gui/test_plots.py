# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plots by mouse and keys: every picture is shown, zoomed, read and saved, and follows changes,
deletions and closed documents."""

import csv

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.gui.plots import canvas as canvases
from freecad_am.gui.plots import dock as docks
from freecad_am.plots import pictures
from freecad_am.plots.pictures import rows


@pytest.fixture
def planned(hemisphere):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=15)
    cell = api.make_cell(doc, limits="paper")
    toolpath = api.make_toolpath(doc, feature, cell, between_layers_wait=2.0)
    return api.make_joint_path(doc, toolpath, cell)


@pytest.fixture
def panel(person, planned):
    person.look()
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_Plots")
    panel = person.panel(docks.NAME)
    person.field(panel, "over").setCurrentIndex(0)
    wait_until_drawn(person)
    yield panel
    panel.close()


def wait_until_drawn(person):
    dock = docks.only.dock
    timers = (dock.soon.timer, dock.changed.timer)
    person.until(
        lambda: (
            dock.building.worker is None
            and dock.canvas.ready
            and not any(timer.isActive() for timer in timers)
        ),
        "the picture",
        20,
    )
    person.idle(0.05)
    return dock


def wait_for_range(person, as_wanted):
    """Return the range of the first chart when it is as expected."""
    person.until(
        lambda: as_wanted(*docks.only.dock.canvas.view.places[0].across),
        "the range that is shown",
        5,
    )
    return wait_until_drawn(person).canvas.view.places[0].across


def take(person, panel, name):
    box = person.field(panel, "picture")
    box.setCurrentIndex(box.findData(name))
    return wait_until_drawn(person)


def colours(person, widget, least=80):
    """Return how many pixels of a widget have the colour of a curve, of a limit, of bars or of
    overlapping beads; with a smaller `least` difference of red, green and blue also of single
    beads."""
    image = widget.grab().toImage().convertToFormat(person.widgets.QImage.Format_RGB32)
    pixels = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)[
        :, : image.width(), :3
    ]
    return int((np.ptp(pixels.astype(int), axis=2) > least).sum())


def test_every_picture_is_seen(person, planned, panel):
    dock = docks.only.dock
    assert person.field(panel, "plotted").currentText() == planned.Label
    for name, entry in pictures.PICTURES.items():
        take(person, panel, name)
        if name in ("angles", "deposit", "spacing", "fit"):
            person.screenshot(f"plots_{name}")
        if name in ("heights", "spread", "fit"):
            assert (
                dock.picture is None
                and "bead model" in dock.canvas.text
                and not person.field(panel, "save").isEnabled()
            )
        elif name in ("volumes", "section", "infill"):
            assert dock.picture is None and "planar layers" in dock.canvas.text
        else:
            assert dock.picture.title == entry.title and colours(person, dock.canvas) > 200, name
            assert len(dock.canvas.view.places) == len(dock.picture.charts)
    source = dock.source[1]
    motion = api.result(planned).motion
    take(person, panel, "angles")
    for axis, chart in enumerate(dock.picture.charts):
        drawn = np.radians(chart.curves[0].y[~rows(source).standing])
        np.testing.assert_allclose(drawn, motion.joints[:, axis], atol=1e-12)


def test_layers_chosen_of_one_job_are_not_those_of_another_with_its_names(
    person, planned, coarse, panel
):
    from_box, to_box = person.field(panel, "from"), person.field(panel, "to")
    to_box.setValue(1)
    from_box.setValue(1)
    wait_until_drawn(person)
    names = planned.Document.Name, planned.Name
    App.closeDocument(planned.Document.Name)
    document = App.newDocument(names[0])
    sphere = document.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1 = 45, 0
    document.recompute()
    other_path = api.make_all(document, sphere)[3]
    assert (other_path.Document.Name, other_path.Name) == names
    docks.show(other_path)
    wait_until_drawn(person)
    assert (from_box.value(), to_box.value()) == (0, other_path.Toolpath.Layers - 1)


def test_zoom_move_and_read_by_mouse(person, hand, planned, panel):
    dock = take(person, panel, "angles")
    canvas = dock.canvas
    full_range = canvas.view.places[0].across
    frame = canvas.view.places[0]

    def position(share, up=0.5):
        where = canvas.mapToGlobal(
            person.core.QPoint(
                int(frame.left + share * frame.width), int(frame.top + (1 - up) * frame.height)
            )
        )
        return where.x(), where.y()

    hand.do("mousemove", *position(0.25))
    person.until(lambda: person.field(panel, "reading").text(), "what is pointed at", 5)
    chart, x = dock.picture.charts[0], full_range[0] + 0.25 * (full_range[1] - full_range[0])
    curve = chart.curves[0]
    nearest = int(np.abs(curve.x - x).argmin())
    text = person.field(panel, "reading").text()
    value = float(text.split(curve.name + " ")[1].split()[0])
    assert abs(value - curve.y[max(nearest - 2, 0) : nearest + 3]).min() < 1e-3 and text.startswith(
        "layer "
    )
    hand.do("mousemove", *position(0.5), "click", 4, "click", 4)
    low, high = wait_for_range(
        person,
        lambda low, high: (
            high - low == pytest.approx((full_range[1] - full_range[0]) / 1.25**2, rel=1e-6)
        ),
    )
    assert canvas.view.places[1].across == (low, high)  # all charts together
    hand.do("mousemove", *position(0.5), "mousedown", 1, "mousemove", *position(0.4), "mouseup", 1)
    wait_for_range(
        person, lambda start, end: start > low and end - start == pytest.approx(high - low)
    )
    hand.click(person.field(panel, "whole"))
    wait_for_range(person, lambda *ends: ends == full_range)
    hand.click(person.field(panel, "rectangle"))
    hand.do(
        "mousemove",
        *position(0.3, 0.9),
        "mousedown",
        1,
        "mousemove",
        *position(0.5, 0.5),
        "mousemove",
        *position(0.6, 0.2),
        "mouseup",
        1,
    )
    width = full_range[1] - full_range[0]
    wait_for_range(
        person,
        lambda *ends: (
            ((np.array(ends) - full_range[0]) / width).tolist()
            == pytest.approx([0.3, 0.6], abs=0.01)
        ),
    )
    assert 0 in canvas.view.up
    person.screenshot("plots_zoomed")
    hand.click(person.field(panel, "rectangle"))
    hand.click(person.field(panel, "whole"))
    wait_for_range(person, lambda *ends: ends == full_range)
    hand.click(person.field(panel, "back"))
    wait_for_range(
        person,
        lambda *ends: (
            ((np.array(ends) - full_range[0]) / width).tolist()
            == pytest.approx([0.3, 0.6], abs=0.01)
        ),
    )
    hand.do("mousemove", *position(0.5), "click", "--repeat", 2, "--delay", 50, 1)
    wait_for_range(person, lambda *ends: ends == full_range)


def test_layers_path_and_files(person, panel, planned, tmp_path, monkeypatch):
    take(person, panel, "deposit")
    person.field(panel, "from").setValue(1)
    person.field(panel, "to").setValue(2)
    dock = wait_until_drawn(person)
    assert set(dock.picture.charts[0].curves[0].layer.tolist()) == {1, 2}
    person.choose(panel, "over", "path")
    dock = wait_until_drawn(person)
    assert dock.picture.charts[0].x.name == "path"
    person.screenshot("plots_two_layers")
    for ending, begins in (
        ("png", b"\x89PNG"),
        ("svg", b"<?xml"),
        ("pdf", b"%PDF"),
        ("csv", b"path_mm,layer,"),
    ):
        path = tmp_path / f"plot.{ending}"
        monkeypatch.setattr(
            person.widgets.QFileDialog,
            "getSaveFileName",
            staticmethod(lambda *_, path=path: (str(path), "")),
        )
        person.field(panel, "save").click()
        person.until(path.exists, f"the {ending}", 10)
        person.idle(0.1)
        assert path.read_bytes().startswith(begins)
    table = list(csv.reader((tmp_path / "plot.csv").read_text(encoding="utf-8").splitlines()))
    curve = dock.picture.charts[1].curves[0]
    column = [row[3] for row in table[1:]]
    np.testing.assert_allclose([float(value) for value in column], curve.y, rtol=1e-9)
    monkeypatch.setattr(
        person.widgets.QFileDialog,
        "getSaveFileName",
        staticmethod(lambda *_: (str(tmp_path / "none" / "plot.png"), "")),
    )
    person.field(panel, "save").click()
    person.until(
        lambda: "cannot be written" in person.window.statusBar().currentMessage(), "the message", 10
    )


def test_a_stale_plot_is_not_saved(person, planned, panel, monkeypatch, tmp_path):
    take(person, panel, "angles")
    path = tmp_path / "plot.csv"
    monkeypatch.setattr(
        person.widgets.QFileDialog, "getSaveFileName", staticmethod(lambda *_: (str(path), ""))
    )
    planned.Toolpath.TravelSpeed = "4 mm/s"
    person.field(panel, "save").click()
    person.until(
        lambda: "is out of date" in person.window.statusBar().currentMessage(), "the message", 10
    )
    assert not path.exists()


def test_changes_are_followed(person, planned, panel):
    dock = take(person, panel, "angles")
    toolpath, doc = planned.Toolpath, planned.Document
    original_total = dock.source[1].times.total
    toolpath.TravelSpeed = "3 mm/s"
    person.idle(0.1)
    wait_until_drawn(person)
    assert "recompute" in person.field(panel, "note").text()
    doc.recompute()
    person.idle(0.5)
    wait_until_drawn(person)
    assert (
        person.field(panel, "note").text() == ""
        and dock.source[1].times.total > 1.5 * original_total
    )
    person.select(toolpath)
    person.idle(0.3)
    wait_until_drawn(person)
    assert person.field(panel, "plotted").currentText() == toolpath.Label
    assert dock.picture is None and "no joints" in dock.canvas.text
    take(person, panel, "spacing")
    assert dock.picture.charts[0].bars is not None
    doc.removeObject(planned.Name)
    doc.removeObject(toolpath.Name)
    person.idle(0.4)
    assert dock.picture is None and "no path to plot" in dock.canvas.text
    doc.undo()


def test_closed_documents_and_long_beads(person, planned, panel):
    dock = take(person, panel, "jerks")
    other_document = App.newDocument("Other")
    person.idle(0.4)
    assert dock.picture is None
    App.closeDocument(other_document.Name)
    App.setActiveDocument(planned.Document.Name)
    person.idle(0.4)
    wait_until_drawn(person)
    assert dock.picture is not None
    box = person.field(panel, "picture")
    for index in list(range(box.count())) * 2:  # faster than pictures are drawn
        box.setCurrentIndex(index)
        person.idle(0.02)
    App.closeDocument(planned.Document.Name)
    person.idle(0.5)
    assert dock.picture is None
    assert "Traceback" not in person.console()


def test_that_there_is_nothing_to_plot_is_seen(person, planned, panel):
    """The note also replaces many charts that did not fit before."""
    canvas = take(person, panel, "angles").canvas
    assert canvas.minimumHeight() == 6 * canvases.PER_CHART
    App.closeDocument(planned.Document.Name)
    person.until(lambda: "no path to plot" in canvas.text, "the text", 5)
    person.until(
        lambda: canvas.visibleRegion().boundingRect().contains(canvas.rect().center()),
        "the text in sight",
        5,
    )
    assert canvas.height() <= canvas.visibleRegion().boundingRect().height()


def test_a_dock_that_was_open_before_the_job_goes_on_to_its_joint_path(person, planned, panel):
    document = App.newDocument("Later")
    sphere = document.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1 = 45, 0
    document.recompute()
    feature = api.make_feature(document, sphere, layer_height=15)
    cell = api.make_cell(document, limits="paper")
    toolpath = api.make_toolpath(document, feature, cell, between_layers_wait=2.0)
    plotted = person.field(panel, "plotted")
    person.until(lambda: plotted.currentText() == toolpath.Label, "the toolpath", 5)
    path = api.make_joint_path(document, toolpath, cell)
    person.until(lambda: plotted.currentText() == path.Label, "the joint path", 5)
    person.select(toolpath)
    person.until(lambda: plotted.currentText() == toolpath.Label, "what is selected", 5)
    api.change(path, objective="condition")
    person.idle(0.3)
    assert plotted.currentText() == toolpath.Label


def test_a_solid_in_plane_layers_is_seen_layer_by_layer(person):
    document = App.newDocument("Filled")
    block = document.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(60, 40, 22).cut(Part.makeCylinder(9, 22, App.Vector(40, 20, 0)))
    document.recompute()
    feature = api.make_solid_feature(
        document, block, layer_height=5, chord_error=0.1, bead_spacing=5
    )
    docks.show(api.make_toolpath(document, feature))
    panel = person.panel(docks.NAME)
    dock = take(person, panel, "volumes")
    volume = dock.picture.charts[0]
    assert 1000.0 * volume.curves[0].y.sum() == pytest.approx(block.Shape.Volume, rel=2e-3)
    assert colours(person, dock.canvas) > 200
    person.screenshot("plots_volumes")
    person.field(panel, "to").setValue(2)
    take(person, panel, "section")
    names = [curve.name for curve in dock.picture.charts[0].curves]
    assert names.count("part") == 1 and "bead" in names
    # beads fill the part except for a few gaps, and hardly overlap
    assert colours(person, dock.canvas) < 2000 < 30000 < colours(person, dock.canvas, 40)
    person.screenshot("plots_section")
