# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tree by mouse and keys: valid and invalid drops, deleting and restoring."""

import subprocess
import time

import pytest

from freecad_am import api
from freecad_am.objects.job_group import grouped, is_group


@pytest.fixture
def job(person, hemisphere):
    """Return the document of a job of few layers, in its group."""
    doc = hemisphere.Document
    hemisphere.Label = "Cup"
    cell, feature = (
        api.make_cell(doc, limits="paper"),
        api.make_feature(doc, hemisphere, layer_height=15),
    )
    toolpath = api.make_toolpath(doc, feature, cell)
    api.make_program(doc, api.make_joint_path(doc, toolpath, cell), name="CUP")
    grouped(doc, "Job of a cup", api.stages_of(doc))
    for dock in person.present(person.widgets.QDockWidget):
        if dock.objectName() in ("Combo View", "Model", "Tree view"):
            dock.show()
            dock.raise_()
    open_up(person, "Job of a cup")
    return doc


def open_up(person, label):
    """Expand an object in the tree, which creates its children."""
    match = person.core.Qt.MatchExactly | person.core.Qt.MatchRecursive

    def find_item():
        trees = [tree for tree in person.present(person.widgets.QTreeWidget) if tree.isVisible()]
        return [item for tree in trees for item in tree.findItems(label, match)]

    for item in person.until(find_item, f"{label} in the tree", 5):
        item.setExpanded(True)
    person.idle()


def group_of(doc):
    return next(obj for obj in doc.Objects if is_group(obj))


def statuses(doc):
    return [obj.Status for obj in api.stages_of(doc)]


def state(doc):
    return {obj.Name: (obj.Key, obj.Status, obj.Message) for obj in api.stages_of(doc)}


def click_soon(person, button_of):
    """Click a button of the next step's dialog; return a list of the timer that does it, then of
    the texts."""
    texts = []

    def look():
        box = person.widgets.QApplication.activeModalWidget()
        if not isinstance(box, person.widgets.QDialog):
            return
        timer.stop()
        texts.append(
            " ".join(
                str(getattr(box, name, str)())
                for name in ("text", "informativeText", "detailedText")
            )
        )
        button = button_of(box)
        position = button.mapToGlobal(button.rect().center())
        subprocess.Popen(
            ["xdotool", "mousemove", str(position.x()), str(position.y()), "click", "1"]
        )

    timer = person.core.QTimer()
    timer.setInterval(300)
    timer.timeout.connect(look)
    timer.start()
    texts.append(timer)
    return texts


def yes_by_mouse(person):
    """Click Yes in the next step's question."""
    return click_soon(person, lambda box: box.button(person.widgets.QMessageBox.Yes))


def delete(person, hand, label):
    """Select an object in the tree, press Delete, answer each question with Yes, and return the
    questions."""
    hand.click_tree(label)
    person.until(
        lambda: [obj.Label for obj in person.gui.Selection.getSelection()] == [label],
        f"{label} to be selected",
        5,
    )
    (obj,) = person.gui.Selection.getSelection()
    document, name = obj.Document, obj.Name
    questions = yes_by_mouse(person)
    # a busy machine may still process the click when the key arrives, so a person presses it again
    for _ in range(3):
        hand.do("key", "Delete")
        end = time.monotonic() + 4.0
        while document.getObject(name) is not None and time.monotonic() < end:
            person.idle(0.1)
        if document.getObject(name) is None:
            break
    assert document.getObject(name) is None, f"{label} is not deleted"
    person.idle(0.5)
    questions.pop(0).stop()
    return questions


def test_a_job_is_dragged_into_a_folder_and_out_again(person, hand, job):
    folder = job.addObject("App::DocumentObjectGroup", "Folder")
    job.recompute()
    original = state(job)
    group = group_of(job)
    hand.drag_in_tree(group.Label, "Folder")
    assert [obj.Name for obj in folder.Group] == [group.Name] and len(group.Group) == 5
    job.recompute()
    assert state(job) == original
    person.gui.runCommand("Std_Undo")
    person.idle()
    assert folder.Group == [] and len(group.Group) == 5
    job.recompute()
    assert state(job) == original


def test_what_does_not_belong_somewhere_cannot_be_dropped_there(person, hand, job):
    group, original = group_of(job), state(job)
    members = {obj.Name for obj in group.Group}  # FreeCAD 1.0 puts them in another order
    hand.drag_in_tree("Cup", group.Label)  # a part into a job
    hand.drag_in_tree("Toolpath", "Feature")  # a stage onto another one
    hand.drag_in_tree("Feature", "Cell")
    assert {obj.Name for obj in group.Group} == members and len(group.Group) == len(members)
    assert job.Toolpath.Feature == job.Feature and job.Feature.Source[0] == job.Sphere
    job.recompute()
    assert state(job) == original


def test_a_stage_is_dragged_out_of_its_job(person, hand, job):
    group, original = group_of(job), state(job)
    hand.drag_in_tree("Toolpath", job.Label)
    assert job.Toolpath not in group.Group and len(group.Group) == 4
    job.recompute()
    assert state(job) == original
    hand.drag_in_tree("Toolpath", group.Label)
    assert job.Toolpath in group.Group
    job.recompute()
    assert state(job) == original


def test_the_part_of_a_job_is_deleted_and_brought_back_by_keys(person, hand, job):
    """FreeCAD asks before it deletes an object that others depend on, and names them."""
    original = state(job)
    (question,) = delete(person, hand, "Cup")
    assert "Feature" in question
    assert job.getObject("Sphere") is None and job.Feature.Status == "failed"
    assert "Source is missing" in job.Feature.Message
    job.recompute()
    assert statuses(job) == ["up to date", *["failed"] * 4]
    hand.click_tree("Feature")
    hand.undo()
    person.until(lambda: job.getObject("Sphere") is not None, "the part to come back", 5)
    job.recompute()
    assert state(job) == original and job.Feature.Source[0] == job.Sphere
    hand.redo()
    person.until(lambda: job.getObject("Sphere") is None, "the part to go again", 5)
    assert job.Feature.Status == "failed"
    hand.undo()
    person.until(lambda: job.getObject("Sphere") is not None, "the part to come back again", 5)
    job.recompute()
    assert state(job) == original


@pytest.mark.parametrize("name", ["Cell", "Feature", "Toolpath", "JointPath", "Program"])
@pytest.mark.always("Cell")
def test_a_stage_is_deleted_and_brought_back_by_keys(person, hand, job, name):
    original = state(job)
    label = job.getObject(name).Label
    questions = delete(person, hand, label)
    assert len(questions) == 0 if name == "Program" else len(questions) == 1
    assert job.getObject(name) is None
    job.recompute()
    outdated = [obj for obj in api.stages_of(job) if obj.Status != "up to date"]
    assert all("is missing" in obj.Message or "waits for" in obj.Message for obj in outdated)
    assert any("is missing" in obj.Message for obj in outdated) or name == "Program"
    hand.click_tree("Cup")
    hand.undo()
    person.until(lambda: job.getObject(name) is not None, f"{label} to come back", 5)
    job.recompute()
    assert state(job) == original and job.getObject(name) in group_of(job).Group


def test_a_whole_job_is_deleted_and_brought_back_by_keys(person, hand, job):
    original, label = state(job), group_of(job).Label
    # no remaining object depends on it, so FreeCAD asks nothing
    assert delete(person, hand, label) == []
    assert [obj.Name for obj in job.Objects] == ["Sphere"]
    hand.click_tree("Cup")
    hand.undo()
    person.until(lambda: len(api.stages_of(job)) == 5, "the job to come back", 5)
    job.recompute()
    assert state(job) == original and len(group_of(job).Group) == 5


def test_what_a_macro_puts_into_a_job_stays_and_a_paste_comes_beside_it(person, hand, job):
    group = group_of(job)
    stages = len(group.Group)
    body = job.addObject("Part::Box", "Body")
    group.addObject(body)
    assert body in group.Group and len(group.Group) == stages + 1
    hand.click_tree("Cup")
    person.gui.runCommand("Std_Copy")
    hand.click_tree(group.Label)
    object_names = {obj.Name for obj in job.Objects}
    person.gui.runCommand("Std_Paste")
    (pasted,) = person.until(
        lambda: [obj for obj in job.Objects if obj.Name not in object_names], "the copy", 5
    )
    assert pasted not in group.Group and body in group.Group and len(group.Group) == stages + 1
    group.removeObject(job.Toolpath)
    assert body in group.Group and len(group.Group) == stages


def test_a_job_pasted_while_it_is_selected_comes_beside_it(person, hand, job):
    """FreeCAD would put it, and the copy of its part, into the job."""
    group, original = group_of(job), state(job)
    members, names = [obj.Name for obj in group.Group], {obj.Name for obj in job.Objects}
    hand.click_tree(group.Label)
    questions = click_soon(
        person,
        lambda box: box.findChild(person.widgets.QDialogButtonBox).button(
            person.widgets.QDialogButtonBox.Ok
        ),
    )
    person.gui.runCommand("Std_Copy")  # FreeCAD asks which objects to include
    questions.pop(0).stop()
    person.gui.runCommand("Std_Paste")
    person.until(lambda: len(api.stages_of(job)) == 10, "the copy", 5)
    assert [obj.Name for obj in group.Group] == members
    copied = next(obj for obj in job.Objects if is_group(obj) and obj != group)
    assert len(copied.Group) == 5 and copied.InList == []
    assert copied.Group[1].Source[0].Name not in names | {obj.Name for obj in copied.Group}
    job.recompute()
    assert statuses(job) == ["up to date"] * 10
    hand.click_tree("Cup")
    hand.do("key", "ctrl+z")
    person.until(lambda: len(api.stages_of(job)) == 5, "the copy to go", 5)
    assert {obj.Name for obj in job.Objects} == names and [
        obj.Name for obj in group.Group
    ] == members
    job.recompute()
    assert state(job) == original
