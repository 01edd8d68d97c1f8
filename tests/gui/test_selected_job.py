# SPDX-License-Identifier: LGPL-2.1-or-later
"""With two jobs in a document, tools act on the selected one, not on the newest."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.gui.path import dock as paths
from freecad_am.gui.plots import dock as plots
from freecad_am.gui.redundancy_map import dock as spin_map
from freecad_am.gui.simulation import dock as simulation
from freecad_am.objects.job_group import grouped

KINDS = ("cell", "feature", "toolpath", "joint path")


@pytest.fixture
def stages(person, hemisphere):
    """Return the stages, by kind, of two jobs of few layers on one part."""
    doc = hemisphere.Document
    job_stages = []
    for name in ("First", "Second"):
        cell, feature = (
            api.make_cell(doc, limits="paper"),
            api.make_feature(doc, hemisphere, layer_height=15),
        )
        toolpath = api.make_toolpath(doc, feature, cell)
        job_stages.append(
            dict(zip(KINDS, (cell, feature, toolpath, api.make_joint_path(doc, toolpath, cell))))
        )
        for kind, stage in job_stages[-1].items():
            stage.Label = f"{name} {kind}"
    person.open_workbench()
    return job_stages


@pytest.fixture
def jobs(stages):
    """Return the groups of the two jobs."""
    return [
        grouped(job_stages["cell"].Document, name, list(job_stages.values()))
        for name, job_stages in zip(("First", "Second"), stages)
    ]


@pytest.fixture
def opened(monkeypatch):
    """Return the labels of the stages that tools without a panel open."""
    labels = []
    monkeypatch.setattr(simulation, "simulate_object", lambda obj: labels.append(obj.Label))
    monkeypatch.setattr(spin_map, "show", lambda obj: labels.append(obj.Label))
    return labels


def inputs_of(person, command, panel, *links):
    """Return the links that a panel proposes."""
    person.click(command)
    form = person.panel(panel)
    labels = [person.field(form, f"Input{link}").currentText() for link in links]
    person.press("Cancel")
    person.panel_closed()
    return labels


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.always("0")
def test_tools_take_the_stages_of_the_job_that_is_selected(person, jobs, which):
    name = jobs[which].Label
    person.select(jobs[which])
    person.click("RoboticAM_ExportPath")
    assert (
        person.field(person.panel("RoboticAM_ExportPath"), "Path").currentText()
        == f"{name} joint path"
    )
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_JointPath")
    panel = person.panel("RoboticAM_JointPath")
    labels = [person.field(panel, f"Input{link}").currentText() for link in ("Toolpath", "Cell")]
    assert labels == [f"{name} toolpath", f"{name} cell"]
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_Inspect")
    panel = person.panel("RoboticAM_Inspection")
    assert person.field(panel, "Planned").currentText() == f"{name} feature"
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_Plots")
    panel = person.panel(plots.NAME)
    person.until(
        lambda: person.field(panel, "plotted").currentText() == f"{name} joint path",
        "the path of the job",
        5,
    )
    person.until(
        lambda: plots.only.dock.building.worker is None and plots.only.dock.canvas.ready,
        "the picture",
        20,
    )
    panel.close()
    person.idle()


@pytest.mark.parametrize("in_groups", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_stage_stands_for_its_job(person, stages, opened, request, in_groups):
    if in_groups:
        request.getfixturevalue("jobs")
    for name, job_stages in zip(("First", "Second"), stages):
        for kind in KINDS:
            opened.clear()
            tools_take(person, job_stages[kind], kind, name, opened)


def tools_take(person, stage, kind, name, opened):
    """Assert that every tool proposes stages of the job of the selected stage."""
    person.select(stage)
    person.click("RoboticAM_Simulate")
    person.click("RoboticAM_SpinMap")
    assert opened == [f"{name} joint path"] * 2
    assert inputs_of(person, "RoboticAM_Program", "RoboticAM_Program", "JointPath") == [
        f"{name} joint path"
    ]
    labels = inputs_of(person, "RoboticAM_JointPath", "RoboticAM_JointPath", "Toolpath", "Cell")
    assert labels == [f"{name} toolpath", f"{name} cell"]
    person.click("RoboticAM_ExportPath")
    path = "toolpath" if kind == "toolpath" else "joint path"
    assert (
        person.field(person.panel("RoboticAM_ExportPath"), "Path").currentText() == f"{name} {path}"
    )
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_of_two_jobs_that_are_selected_the_first_is_taken(person, jobs, opened, order):
    person.select(jobs[order[0]])
    person.gui.Selection.addSelection(jobs[order[1]].Document.Name, jobs[order[1]].Name)
    person.click("RoboticAM_Simulate")
    assert opened == [f"{jobs[order[0]].Label} joint path"]


def test_what_jobs_share_stands_for_the_job_that_was_made_last(person, stages, opened):
    first_job, second_job = stages
    second_job["toolpath"].Cell = second_job["joint path"].Cell = first_job["cell"]
    person.select(first_job["cell"])
    person.click("RoboticAM_Simulate")
    person.select(first_job["toolpath"])
    person.click("RoboticAM_Simulate")
    assert opened == ["Second joint path", "First joint path"]


def test_a_cell_in_the_group_of_another_job_is_found(person, stages):
    first_job, second_job = stages
    doc = first_job["cell"].Document
    second_job["toolpath"].Cell = second_job["joint path"].Cell = first_job["cell"]
    group = grouped(doc, "Second", [second_job["feature"], second_job["toolpath"]])
    grouped(doc, "First", list(first_job.values()))
    person.select(group)
    labels = inputs_of(person, "RoboticAM_JointPath", "RoboticAM_JointPath", "Toolpath", "Cell")
    assert labels == ["Second toolpath", "First cell"]


@pytest.mark.parametrize("of_group", [True, False])
def test_tools_tell_what_the_job_lacks_and_take_no_other(person, stages, jobs, opened, of_group):
    first_job = stages[0]
    first_job["cell"].Document.removeObject(first_job["joint path"].Name)
    person.select(jobs[0] if of_group else first_job["cell"])
    for command, text in (("Simulate", "to simulate"), ("SpinMap", "to map")):
        person.click(f"RoboticAM_{command}")
        status_text = person.window.statusBar().currentMessage()
        assert (
            status_text
            == f"First has no joint path {text}; make a joint path first, or select another job."
        )
    assert opened == []
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_Simulate")
    person.click("RoboticAM_SpinMap")
    assert opened == ["Second joint path"] * 2


@pytest.mark.parametrize("which, name, post", [(0, "PART", "staubli"), (1, "BALL", "fanuc")])
def test_a_program_is_proposed_for_part_and_machine_of_its_job(
    person, stages, jobs, which, name, post
):
    first_job, second_job = stages
    first_job["feature"].Source[0].Label = "part"
    ball = first_job["cell"].Document.addObject("Part::Sphere", "Ball")
    second_job["feature"].Source = (ball, [])
    first_job["cell"].Machine = "staubli-tx60"
    person.select(jobs[which])
    person.click("RoboticAM_Program")
    panel = person.panel("RoboticAM_Program")
    assert person.field(panel, "ProgramName").text() == name
    assert person.field(panel, "Post").currentText() == post
    person.press("Cancel")
    person.panel_closed()


def test_the_cell_follows_the_toolpath_until_one_is_chosen(person, stages):
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_JointPath")
    panel = person.panel("RoboticAM_JointPath")
    toolpath, cell = (person.field(panel, f"Input{link}") for link in ("Toolpath", "Cell"))
    assert (toolpath.currentText(), cell.currentText()) == ("Second toolpath", "Second cell")
    toolpath.setCurrentIndex(toolpath.findText("First toolpath"))
    assert cell.currentText() == "First cell"
    cell.setCurrentIndex(cell.findText("Second cell"))
    toolpath.setCurrentIndex(toolpath.findText("Second toolpath"))
    toolpath.setCurrentIndex(toolpath.findText("First toolpath"))
    assert cell.currentText() == "Second cell"
    person.press("Cancel")
    person.panel_closed()
    person.select(stages[0]["toolpath"])
    person.gui.Selection.addSelection(stages[1]["cell"].Document.Name, stages[1]["cell"].Name)
    labels = inputs_of(person, "RoboticAM_JointPath", "RoboticAM_JointPath", "Toolpath", "Cell")
    assert labels == ["First toolpath", "Second cell"]  # both are selected


def test_the_point_at_the_origin_is_of_no_path(person, jobs):
    """A joint path without its toolpath, as in a document with only its copy, draws nothing."""
    from freecad_am.gui.nodes.lines import Points

    points = Points(7.0, (1.0, 0.0, 0.0))
    assert points.set_node.numPoints.getValue() == 0 and points.coordinates.point.getNum() == 0
    points.set([[1.0, 2.0, 3.0]])
    assert points.set_node.numPoints.getValue() == 1


def test_a_new_job_is_seen_alone(person, hemisphere, coarse):
    doc = hemisphere.Document
    second_sphere = doc.addObject("Part::Sphere", "Other")
    second_sphere.Radius, second_sphere.Angle1, second_sphere.Placement.Base.x = 40, 0, 200
    doc.recompute()
    jobs_stages = []
    for sphere in (hemisphere, second_sphere):
        old_stages = set(api.stages_of(doc))
        person.select(sphere)
        person.click("RoboticAM_NewJob")
        person.as_revolution()
        person.press("Ok")
        person.panel_closed()
        jobs_stages.append([stage for stage in api.stages_of(doc) if stage not in old_stages])
    visible_names = [
        [stage.Name for stage in stages if stage.ViewObject.Visibility] for stages in jobs_stages
    ]
    assert visible_names[0] == [] and {
        doc.getObject(name).Proxy.kind for name in visible_names[1]
    } >= {
        "cell",
        "joint path",
    }
    assert (
        second_sphere.ViewObject.Visibility is False
    )  # as for any job, the path is in its surface


@pytest.mark.parametrize("kind", [*KINDS, "job"])
@pytest.mark.always("joint path", "job")
def test_the_dock_of_paths_opens_with_the_path_of_what_is_selected(person, stages, jobs, kind):
    """This holds for the first opening in a session and for later ones."""
    person.select(jobs[0] if kind == "job" else stages[0][kind])
    if paths.only.dock is not None:
        paths.only.dock.target = None  # as in a new session
    person.click("RoboticAM_Path")
    choice = person.field(person.panel(paths.NAME), "path")
    expected = "toolpath" if kind == "toolpath" else "joint path"
    assert choice.currentText() == f"First {expected}"
    assert stages[0][expected].ViewObject.Visibility
    paths.only.dock.dock.close()
    person.select(jobs[1] if kind == "job" else stages[1][kind])
    person.click("RoboticAM_Path")
    assert choice.currentText() == f"Second {expected}"


def test_a_program_shows_its_joint_path(person, stages, jobs):
    document = stages[0]["cell"].Document
    program = api.make_program(document, stages[0]["joint path"], "ONE")
    person.select(program)
    if paths.only.dock is not None:
        paths.only.dock.target = None
    person.click("RoboticAM_Path")
    choice = person.field(person.panel(paths.NAME), "path")
    assert choice.currentText() == "First joint path"


def test_the_dock_of_paths_follows_the_document(person, stages, jobs):
    """The selection in another document does not count."""
    person.select(stages[0]["joint path"])
    other_document = App.newDocument("Other")
    toolpath = api.make_toolpath(
        other_document,
        api.make_feature(other_document, _sphere(other_document), layer_height=20),
        api.make_cell(other_document),
    )
    toolpath.Label = "Third toolpath"
    person.idle()
    person.click("RoboticAM_Path")
    choice = person.field(person.panel(paths.NAME), "path")
    assert choice.currentText() == "Third toolpath"


def _sphere(document):
    sphere = document.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 30, 0, 90
    document.recompute()
    return sphere
