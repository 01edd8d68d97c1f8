# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drawings that belong to a path follow it: marks of issues through undo and redo, the nozzle of
its cell, its colours in a selection."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path import colouring


@pytest.fixture
def toolpath(person, hemisphere):
    document = hemisphere.Document
    document.UndoMode = 1
    return api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=5))


def mark_count(joint_path):
    """Return how many points the scene marks as faulty."""
    return int(joint_path.ViewObject.Proxy.wrong.set_node.numPoints.getValue())


def nozzle_tip(cell):
    """Return the position (3,) of the drawn nozzle's tip."""
    return np.array(cell.ViewObject.Proxy.nodes.nozzle.getChild(0).matrix.getValue().getValue())[
        3, :3
    ]


def test_marks_of_what_is_wrong_go_and_come_back_with_undo_and_redo(person, toolpath, no_remedies):
    document = toolpath.Document
    cell = api.make_cell(document, limits="paper")
    joint_path = api.make_joint_path(document, toolpath, cell)
    assert joint_path.Status == "up to date" and mark_count(joint_path) == 0
    document.openTransaction("One rotation for all")
    api.change(joint_path, method="constant", rz=np.pi)
    document.commitTransaction()
    assert joint_path.Status == "infeasible"
    wrong = mark_count(joint_path)
    assert wrong > 0
    for _ in range(2):
        document.undo()
        person.idle()
        assert joint_path.Method == "layer-by-layer" and mark_count(joint_path) == 0
        document.redo()
        person.idle()
        assert joint_path.Method == "constant" and mark_count(joint_path) == wrong


@pytest.mark.parametrize("named", [True, False])
def test_the_nozzle_stands_where_the_deposit_ends_wherever_that_is(
    person, toolpath, hemisphere, named
):
    """This holds for a toolpath that names the cell, and for a toolpath whose joint path is planned
    in the cell."""
    cell = api.make_cell(toolpath.Document)
    assert np.array_equal(nozzle_tip(cell), np.zeros(3))
    if named:
        api.change(toolpath, cell=cell)
    else:
        api.make_joint_path(toolpath.Document, toolpath, cell)

    def ends_there():
        return np.allclose(
            nozzle_tip(cell), api.result(toolpath).layers[-1].beads[-1].points[-1], atol=1e-4
        )

    person.until(ends_there, "the nozzle at the end of the deposit", 5)
    original_tip = nozzle_tip(cell)
    hemisphere.Placement = App.Placement(
        App.Vector(40, -30, 20), App.Rotation(App.Vector(1, 0, 0), 20)
    )
    toolpath.Document.recompute()
    person.until(ends_there, "the nozzle at the end of the moved deposit", 5)
    assert np.linalg.norm(nozzle_tip(cell) - original_tip) > 20


def test_the_colours_of_tubes_stay_when_their_path_is_selected(person, toolpath):
    view = toolpath.ViewObject
    view.Look, view.Colouring = "tubes", colouring.LAYER
    toolpath.Document.Feature.ViewObject.Visibility = False
    toolpath.Feature.Source[0].ViewObject.Visibility = False
    person.gui.Selection.clearSelection()
    lowest, highest = person.path_pixels()
    assert lowest > 50 and highest > 50
    person.select(toolpath)
    assert person.path_pixels() == pytest.approx((lowest, highest), rel=0.1)
    person.screenshot("selected_tubes")


def test_another_cell_that_leaves_a_toolpath_as_it_is_is_drawn_where_that_is(person, hemisphere):
    document = hemisphere.Document
    first_cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=15), first_cell
    )
    key, second_cell = (
        toolpath.Key,
        api.make_cell(document, deposition_point=[900, 50, 600, 0, 5, 0]),
    )
    person.idle()
    assert (second_cell.ViewObject.Proxy.stands_on, first_cell.ViewObject.Proxy.stands_on) == (
        "",
        key,
    )
    toolpath.Cell = second_cell
    document.recompute()
    person.idle()
    assert (toolpath.Status, toolpath.Key) == ("up to date", key)
    assert second_cell.ViewObject.Proxy.stands_on == key
    assert (
        np.abs(second_cell.ViewObject.Proxy.end[0] - first_cell.ViewObject.Proxy.end[0]).max()
        == 0.0
    )
