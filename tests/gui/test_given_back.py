# SPDX-License-Identifier: LGPL-2.1-or-later
"""What draws a path goes with it: nothing holds its rows, clicks and legends for the rest of the session."""

import gc
import weakref

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.gui.path import dock


@pytest.fixture
def paths(person, hemisphere):
    """A toolpath and its joint path, both seen, with the dock of paths open."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )
    made = toolpath, api.make_joint_path(document, toolpath, cell)
    toolpath.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    person.panel(dock.NAME)
    person.idle(0.3)
    return made


def drawing(obj):
    """Weak references to all that draws a path and hears of clicks on it."""
    view = obj.ViewObject.Proxy
    assert len(view.rows)
    return [weakref.ref(one) for one in (view, view.rows, view.clicks, view.path, view.legend)]


def left(person, kept):
    """What is still there once the window has come to rest."""
    person.idle(0.5)
    gc.collect()
    return [one() for one in kept if one() is not None]


def test_nothing_of_a_deleted_path_is_kept(person, paths):
    toolpath, joint_path = paths
    document, names = toolpath.Document, [joint_path.Name, toolpath.Name]
    document.clearUndos()
    document.UndoMode = 0  # what can be undone is kept for that
    kept = {name: drawing(document.getObject(name)) for name in names}
    del toolpath, joint_path, paths
    for name in names:
        assert len(left(person, kept[name])) == len(kept[name])  # the document has them
        document.removeObject(name)
        assert left(person, kept[name]) == []


def test_a_path_whose_deletion_can_be_undone_comes_back_and_goes_with_the_steps(person, paths):
    joint_path = paths[1]
    document, name = joint_path.Document, joint_path.Name
    document.openTransaction("Delete")
    document.removeObject(name)
    document.commitTransaction()
    person.idle(0.3)
    document.undo()
    person.idle(0.3)
    again = document.getObject(name)
    assert len(again.ViewObject.Proxy.rows) and again.ViewObject.Visibility
    kept = drawing(again)
    document.openTransaction("Delete")
    document.removeObject(name)
    document.commitTransaction()
    del again, joint_path, paths
    document.clearUndos()
    assert left(person, kept) == []
    App.closeDocument(document.Name)
