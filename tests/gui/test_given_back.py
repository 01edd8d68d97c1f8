# SPDX-License-Identifier: LGPL-2.1-or-later
"""The drawing of a path disappears with it: nothing keeps its rows, click handlers and legends for
the rest of the session."""

import gc
import weakref

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.gui.path import dock


@pytest.fixture
def paths(person, hemisphere):
    """Return a toolpath and its joint path, both visible, with the dock of paths open."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )
    both_paths = toolpath, api.make_joint_path(document, toolpath, cell)
    toolpath.ViewObject.Visibility = True
    person.click("RoboticAM_Path")
    person.panel(dock.NAME)
    person.idle(0.3)
    return both_paths


def drawing(obj):
    """Return weak references to all objects that draw a path and handle clicks on it."""
    view = obj.ViewObject.Proxy
    assert len(view.rows)
    return [weakref.ref(obj) for obj in (view, view.rows, view.clicks, view.path, view.legend)]


def remaining(person, references):
    """Return the objects that still exist when the window is at rest."""
    person.idle(0.5)
    gc.collect()
    return [reference() for reference in references if reference() is not None]


def test_nothing_of_a_deleted_path_is_kept(person, paths):
    toolpath, joint_path = paths
    document, names = toolpath.Document, [joint_path.Name, toolpath.Name]
    document.clearUndos()
    document.UndoMode = 0  # objects stay as long as their deletion can be undone
    references = {name: drawing(document.getObject(name)) for name in names}
    del toolpath, joint_path, paths
    for name in names:
        assert len(remaining(person, references[name])) == len(
            references[name]
        )  # the document has them
        document.removeObject(name)
        assert remaining(person, references[name]) == []


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
    references = drawing(again)
    document.openTransaction("Delete")
    document.removeObject(name)
    document.commitTransaction()
    del again, joint_path, paths
    document.clearUndos()
    assert remaining(person, references) == []
    App.closeDocument(document.Name)
