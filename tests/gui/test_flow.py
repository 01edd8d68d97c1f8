# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a selection to a program: one tool for every family and every kind of selection; menus,
groups, deletion."""

from pathlib import Path

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.gui.registry import edit
from freecad_am.gui.tools.commands import GROUPS
from freecad_am.objects.families.recognition import SelectedPart
from freecad_am.objects.families.registry import propose_family
from freecad_am.objects.job_group import is_group
from freecad_am.objects.shapes.bodies import snapshot_of
from tests.gui.nested_cone import nested_cone

EXAMPLES = Path(__file__).resolve().parent.parent.parent / "resources" / "examples"
V = App.Vector


def kinds(doc):
    return [obj.Proxy.kind for obj in api.stages_of(doc)]


def jobs(doc):
    return [obj for obj in doc.Objects if is_group(obj)]


def new_job(person, turned=True, **texts):
    """Click the tool, read its interpretation of the selection, and press OK; return the panel's
    texts. turned: as a part of revolution, whatever the panel proposes."""
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(
        lambda: "Looking" not in person.field(panel, "reason").text(),
        "the selection to be understood",
        20,
    )
    if turned:
        person.as_revolution(panel)
    panel_texts = {
        name: person.field(panel, name).text() for name in ("Source", "Ground", "reason", "error")
    }
    panel_texts["Kind"] = person.field(panel, "Kind").currentText()
    for name, text in texts.items():
        person.type(panel, name, text)
    person.press("Ok")
    person.until(lambda: not person.gui.Control.activeDialog(), "the job to be made", 60)
    return panel_texts


def cup(doc):
    """Return the body of a PartDesign cone in a moved and rotated part, and its outer part."""
    outer, body = nested_cone(doc, V(40, -20, 5), 12)
    body.Placement.Base = V(3, 4, 5)
    doc.recompute()
    return outer, body


def test_tools_stand_in_the_order_of_the_work(person, hemisphere):
    bar = next(
        bar for bar in person.present(person.widgets.QToolBar) if bar.windowTitle() == "Robotic AM"
    )
    actions = bar.actions()
    names = [
        "|" if action.isSeparator() else action.objectName() or action.data() for action in actions
    ]
    names_ = [name.removeprefix("RoboticAM_") for name in names if name != "|"]
    order = [name for group in GROUPS for name in group]
    assert names_ == [name for name in order if name in names_] and names_[:2] == [
        "OpenPart",
        "NewJob",
    ]
    for previous, following in zip(names, names[1:], strict=False):
        separators = (
            next(k for k, group in enumerate(GROUPS) if previous[10:] in group)
            if previous != "|"
            else None
        )
        if separators is not None and following != "|":
            assert following[10:] in GROUPS[separators]
    menu = next(
        menu
        for menu in person.window.menuBar().findChildren(person.widgets.QMenu)
        if menu.title() == "Robotic AM"
    )
    help = [True, False]  # below all tools
    assert [action.isSeparator() for action in menu.actions()] == [
        name == "|" for name in names
    ] + help
    assert menu.toolTipsVisible()


@pytest.mark.parametrize(
    "how",
    ["body", "feature", "face in the part", "link", "face of a link", "the part", "twice nested"],
)
@pytest.mark.always("body", "face of a link", "face in the part")
def test_a_part_of_revolution_however_it_is_selected(person, coarse, how):
    doc = App.newDocument("Cups")
    outer, body = cup(doc)
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = body
    link.Placement = App.Placement(V(0, 100, 0), App.Rotation(V(0, 1, 0), 20))
    doc.recompute()
    side = next(
        f"Face{k}"
        for k, face in enumerate(body.Shape.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCone"
    )
    select = {
        "body": (body, ""),
        "feature": (doc.Cone, ""),
        "face in the part": (outer, f"Body.Cone.{side}"),
        "link": (link, ""),
        "face of a link": (link, f"Cone.{side}"),
        "the part": (outer, "Body."),
        "twice nested": (outer, f"Body.{side}"),
    }[how]
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(doc.Name, select[0].Name, select[1])
    texts = new_job(person)
    assert texts["Kind"] == "Part of revolution" and texts["error"] == ""
    assert [obj.Status for obj in api.stages_of(doc)][:3] == [
        "up to date"
    ] * 3 and doc.Feature.LayerHeight.Value == 5.0
    wall = api.result(doc.Feature)
    placement = body.Placement if "link" not in how else link.Placement
    frame = (outer.Placement if "link" not in how else App.Placement()).multiply(placement)
    axis = frame.Rotation.multVec(V(0, 0, 1))
    assert (V(*wall.frame[:3, 2]) - axis).Length < 1e-7
    offset = (V(*wall.frame[:3, 3]) - frame.Base).cross(axis)
    assert offset.Length < 1e-6  # the axis passes through the body at its visible location


def load(doc, *names):
    return [api.open_part(doc, str(EXAMPLES / name)) for name in names]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.always("order1")
def test_a_wall_on_a_part_is_told_from_its_faces(person, coarse, no_remedies, order):
    doc = App.newDocument("Wall")
    objects = load(doc, "tube-on-pipe.step", "pipe.step")
    person.gui.Selection.clearSelection()
    for k in order:
        person.gui.Selection.addSelection(doc.Name, objects[k].Name, "Face1" if k == 0 else "")
    texts = new_job(person, False, Machine="kuka-kr16-2")
    assert (
        texts["Kind"] == "Wall on a part"
        and objects[1].Label in texts["Ground"]
        and objects[0].Label in texts["reason"]
    )
    assert kinds(doc)[:3] == ["cell", "feature", "toolpath"] and doc.Feature.Substrate == objects[1]
    assert doc.Cell.Machine == "kuka-kr16-2"


def test_solids_on_a_hub_are_told_from_what_stands_on_what(person, coarse):
    doc = App.newDocument("Hub")
    hub = doc.addObject("Part::Feature", "Hub")
    hub.Shape = Part.makeCylinder(30, 60)
    blade = doc.addObject("Part::Feature", "Blade")
    blade.Shape = Part.makeBox(14, 10, 20, V(28, -5, 15)).cut(hub.Shape)
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(doc.Name, blade.Name, "")
    person.gui.Selection.addSelection(doc.Name, hub.Name, "Face1")
    texts = new_job(person, False, Machine="table-xyzac")
    assert (
        texts["Kind"] == "Solids on a hub"
        and "Blade is on a cylinder or cone of Hub" in texts["reason"]
    )
    assert doc.Feature.Substrate == hub and list(doc.Feature.BaseFaces[1]) == ["Face1"]
    assert doc.Cell.Setup == "rotary-table"
    program = api.stages_of(doc, "program")
    assert (
        [obj.Post for obj in program] == ["siemens"]
        if doc.JointPath.Status == "up to date"
        else not program
    )


def test_what_is_proposed_is_what_jobs_of_kind_auto_get(person):
    """Family, layers and reason of each shape equal those of `proposed_family`."""
    doc = App.newDocument("Kinds")
    post = Part.makeBox(20, 20, 40)
    hub = Part.makeCylinder(25, 80)
    shapes = {
        "Bush": Part.makeCylinder(40, 50).cut(Part.makeCylinder(32, 50)),
        "Rod": Part.makeCylinder(30, 20),
        "Tee": post.fuse(Part.makeBox(90, 20, 12, V(-35, 0, 40))),
        "Wire": Part.makePolygon([V(), V(30, 0, 0), V(30, 20, 0)]),
        "Rotor": Part.makeCompound(
            [hub, *(Part.makeBox(20, 8, 30, V(x, -4, 20)).cut(hub) for x in (20, -40))]
        ),
    }
    for name, shape in shapes.items():
        doc.addObject("Part::Feature", name).Shape = shape
    proposals = {}
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    for name in shapes:
        obj = doc.getObject(name)
        person.select(obj)
        person.until(
            lambda name=name: (
                f": {name} " in person.field(panel, "reason").text()
                or f"of {name} " in person.field(panel, "reason").text()
            ),
            f"a proposal for {name}",
            30,
        )
        auto = propose_family(SelectedPart(snapshot_of(obj), (), None, False, 8.0, True))
        assert auto.reason.split(" (")[0].split(";")[0] in person.field(panel, "reason").text()
        proposals[name] = person.field(panel, "Kind").currentText()
    assert proposals == {
        "Bush": "Part of revolution",
        "Rod": "Solids in plane layers",
        "Tee": "Solids without support",
        "Wire": "Curves as beads",
        "Rotor": "Solids in plane layers",
    }
    person.screenshot("new_job_kinds")
    person.press("Cancel")
    person.panel_closed()


def test_what_is_not_of_revolution_asks_for_what_it_grows_on(person):
    doc = App.newDocument("Bend")
    (bend,) = load(doc, "walls/elbow.step")
    block = doc.addObject("Part::Box", "Block")
    doc.recompute()
    person.select(bend)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    reason = person.field(panel, "reason")
    person.until(
        lambda: (
            "without an axis of revolution" in reason.text()
            and "Ctrl+click the substrate" in reason.text()
        ),
        "the question",
        30,
    )
    person.press("Ok")
    assert "Ctrl+click the substrate" in person.panel_error(panel) and api.stages_of(doc) == []
    person.gui.Selection.addSelection(doc.Name, block.Name)  # with Ctrl, while the panel is open
    person.until(
        lambda: "Block" in person.field(panel, "Ground").text(), "the block to be taken", 5
    )
    assert person.panel_error(panel) == ""
    person.press("Cancel")
    person.panel_closed()
    assert doc.UndoCount == 0 or api.stages_of(doc) == []


def test_a_wrong_selection_is_named_and_the_panel_waits(person, hemisphere, coarse):
    doc = hemisphere.Document
    cell = api.make_cell(doc)
    sheet = doc.addObject("Spreadsheet::Sheet", "Table")
    folder = doc.addObject("App::DocumentObjectGroup", "Folder")
    folder.addObject(hemisphere)
    broken = doc.addObject("App::Link", "Nowhere")
    doc.recompute()
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    assert "Click the object to deposit" in person.field(panel, "reason").text()
    for obj, words in (
        (cell, "Cell belongs to a job"),
        (sheet, "Table has no shape"),
        (broken, "Nowhere links to no object"),
    ):
        person.select(obj)
        person.idle(0.3)
        assert words in person.panel_error(panel), (obj.Label, person.panel_error(panel))
        person.press("Ok")
        assert person.gui.Control.activeDialog()
    person.select(folder)  # the folder holds a single object
    person.until(lambda: person.field(panel, "Source").text() == hemisphere.Label, "the part", 5)
    assert person.panel_error(panel) == ""
    person.as_revolution(panel)
    person.press("Ok")
    person.panel_closed()
    assert kinds(doc) == ["cell", "cell", "feature", "toolpath", "joint path", "program"]


def test_what_is_wrong_in_a_new_job_is_told_under_its_field(person, hemisphere, coarse):
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    machine, name = (person.field(panel, f"{field}Note") for field in ("Machine", "ProgramName"))
    person.as_revolution(panel)
    for field, note, wrong, words in (
        ("Machine", machine, "kuka-kr17", "unknown name"),
        ("ProgramName", name, "my part!", "only the letters"),
    ):
        right = person.field(panel, field)
        right = right.currentText() if field == "Machine" else right.text()
        person.type(panel, field, wrong)
        person.press("Ok")
        assert note.isVisible() and words in note.text(), (
            field,
            note.text(),
            person.panel_error(panel),
        )
        assert (
            not person.field(panel, "error").isVisible()
            and api.stages_of(hemisphere.Document) == []
        )
        person.screenshot(f"new_job_wrong_{field}")
        person.type(panel, field, right)
        assert not note.isVisible()  # its subject is no longer selected
    person.press("Ok")
    person.panel_closed()
    assert len(api.stages_of(hemisphere.Document)) == 5


def test_a_wrong_name_of_a_program_is_told_under_its_field(person, hemisphere):
    doc = hemisphere.Document
    cell, feature = (
        api.make_cell(doc, limits="paper"),
        api.make_feature(doc, hemisphere, layer_height=15),
    )
    api.make_joint_path(doc, api.make_toolpath(doc, feature, cell), cell)
    for obj in (None, "made"):
        if obj is None:
            person.click("RoboticAM_Program")
            panel = person.panel("RoboticAM_Program")
        else:
            api.make_program(doc, doc.JointPath, "RIGHT")
            edit(doc.Program)
            panel = person.panel("RoboticAM_Program")
        person.type(panel, "ProgramName", "9 lives")
        person.press("Ok")
        note = person.field(panel, "ProgramNameNote")
        assert note.isVisible() and "cannot be a program" in note.text(), person.panel_error(panel)
        assert not person.field(panel, "error").isVisible()
        person.type(panel, "ProgramName", "LIVES")
        person.until(lambda note=note: not note.isVisible(), "the note to go", 5)
        person.press("Cancel")
        person.panel_closed()


def test_the_result_is_seen_whole_and_the_next_step_is_told(person, hemisphere, coarse):
    view = person.gui.activeDocument().activeView()
    view.viewTop()
    person.idle(0.2)
    person.select(hemisphere)
    new_job(person)
    assert not view.getCameraOrientation().isIdentity()  # heights are visible
    assert "The job is ready. Simulate" in person.window.statusBar().currentMessage()
    view.viewFront()
    person.idle(0.2)
    front = view.getCameraOrientation()
    person.select(hemisphere)
    new_job(person)
    assert view.getCameraOrientation().isSame(front, 1e-6)  # a direction that the user chose stays
    assert len(jobs(hemisphere.Document)) == 2


def test_a_job_is_a_group_that_can_be_left_and_deleted_whole(person, hemisphere, coarse):
    doc = hemisphere.Document
    person.select(hemisphere)
    new_job(person)
    (job,) = jobs(doc)
    assert job.Group == api.stages_of(doc) or {obj.Name for obj in job.Group} == {
        obj.Name for obj in api.stages_of(doc)
    }
    assert hemisphere.Label in job.Label
    keys = [obj.Key for obj in api.stages_of(doc)]
    doc.openTransaction("Drag")
    job.removeObject(doc.Toolpath)  # as dragging it to the document does
    doc.commitTransaction()
    doc.recompute()
    assert (
        doc.JointPath.Toolpath == doc.Toolpath and [obj.Key for obj in api.stages_of(doc)] == keys
    )
    job.addObject(doc.Toolpath)
    doc.recompute()
    assert {obj.Status for obj in api.stages_of(doc)} == {"up to date"}
    assert not job.ViewObject.Proxy.canDropObject(
        hemisphere
    ) and job.ViewObject.Proxy.canDropObject(doc.Cell)
    person.select(job)
    person.gui.runCommand("Std_Delete")  # this asks nothing, or the watch would report it
    person.idle(0.5)
    assert [obj.Name for obj in doc.Objects] == [hemisphere.Name]
    person.gui.runCommand("Std_Undo")
    person.idle()
    doc.recompute()
    assert [obj.Key for obj in api.stages_of(doc)] == keys and len(jobs(doc)[0].Group) == 5
    assert {obj.Status for obj in api.stages_of(doc)} == {"up to date"}


def entries(person, obj):
    menu = person.widgets.QMenu()
    obj.ViewObject.Proxy.setupContextMenu(obj.ViewObject, menu)
    return {
        action.objectName().removeprefix("RoboticAM_Menu"): action for action in menu.actions()
    }, menu


def test_context_menus_do_what_they_say(person, hemisphere, coarse):
    doc = hemisphere.Document
    person.select(hemisphere)
    new_job(person)
    menu_entries, _menu = entries(person, doc.JointPath)
    tools = {"Edit", "Renew", "Simulate", "Program", "SpinMap", "Plots", "ExportPath"}
    assert tools | {"Input_Toolpath", "Input_Cell"} <= set(menu_entries) and all(
        menu_entries[name].isEnabled() for name in tools
    )
    menu_entries["Input_Toolpath"].trigger()
    assert [obj.Name for obj in person.gui.Selection.getSelection()] == ["Toolpath"]
    doc.Feature.LayerHeight = 3
    menu_entries, _menu = entries(person, doc.Program)
    assert doc.Program.Status == "stale"
    menu_entries["Renew"].trigger()
    person.idle()
    assert {obj.Status for obj in api.stages_of(doc)} == {"up to date"}
    menu_entries, _menu = entries(person, doc.Toolpath)
    menu_entries["Edit"].trigger()
    person.panel("RoboticAM_Toolpath")
    person.press("Cancel")
    person.panel_closed()
    menu_entries, _menu = entries(person, jobs(doc)[0])
    menu_entries["Shown"].trigger()
    assert doc.JointPath.ViewObject.Visibility and not doc.Toolpath.ViewObject.Visibility
    person.select(hemisphere)
    from freecad_am.gui.tools import tool

    assert tool.for_selection() == ["RoboticAM_NewJob"]
    person.select(doc.Cell)
    assert tool.for_selection() == []


def test_a_shape_the_kernel_fails_on_is_told(person, hemisphere, monkeypatch):
    """The kernel's errors must not be mistaken for those of a deleted panel."""

    def fail(*_, **__):
        raise RuntimeError("Bnd_Box is void")

    monkeypatch.setattr("freecad_am.objects.families.recognition.find_wall", fail)
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(
        lambda: "Bnd_Box is void" in person.field(panel, "reason").text(), "what is wrong", 10
    )
    person.press("Ok")
    assert person.gui.Control.activeDialog() and hemisphere.Document.Objects == [hemisphere]
    person.press("Cancel")
