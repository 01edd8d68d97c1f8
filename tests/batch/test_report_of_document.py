# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report of a document's stages is the page that the command wrote for the same job."""

import re

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from tests.batch.conftest import JOB

BEND = """\
version: 1
name: bend
part: {file: bend.step, faces: [Face1]}
substrate: {file: block.step}
strategy: {kind: surface, layer_height: 5 mm, chord_error: 0.1 mm, compare: [smooth]}
build_direction: {clearance: none}
cell: {limits: paper, platform: [0, 0, 30, 0, 0, 0]}
joints: {method: constant}
"""
TWO = """\
version: 1
name: two
strategy: {kind: solid, layer_height: 5 mm, chord_error: 0.1 mm}
features:
- {name: plate, part: {file: plate.step}}
- {name: post, part: {file: post.step}, process: {travel_speed: 9 mm/s}}
cell: {limits: paper, mount: feature}
joints: {method: constant}
"""


def sections(page):
    """Return the text under each heading, without measured times."""
    head, *blocks = page.split("<h2>")
    texts = {"": head, **dict(block.split("</h2>", 1) for block in blocks)}
    assert texts.pop("Time taken").count("<tr>") >= 2
    return texts


def both(workshop, name, kind):
    """Return the sections of the command's page and of the page of the saved document."""
    theirs = workshop.files(f"out/{name}")["report.html"].decode()
    folder = workshop.folder / "page"
    folder.mkdir()
    document = App.openDocument(str(workshop.folder / f"out/{name}/{name}.FCStd"))
    try:
        stage = next(obj for obj in api.stages_of(document) if obj.Proxy.kind == kind)
        path = api.export_report(stage, str(folder / "page.html"))
    finally:
        App.closeDocument(document.Name)
    assert [entry.name for entry in folder.iterdir()] == ["page.html"]
    with open(path, encoding="utf-8") as stream:
        return sections(theirs), sections(stream.read())


def test_it_is_the_page_of_the_command(workshop):
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 0, command.err
    theirs, ours = both(workshop, "cup", "program")
    assert ours == theirs
    assert {"Preflight", "Programs", "Joints against their limits", "Time and material"} <= set(
        ours
    )
    assert "program/CUP.LS" in ours["Programs"]


def test_a_toolpath_has_the_path_alone(workshop):
    without_cell = JOB.replace("cell:\n  limits: paper\n  platform_diameter: 100 mm\n", "")
    workshop.write_job(without_cell.replace("program:\n  post: fanuc\n", ""))
    assert workshop.run("plan", "cup.yaml").status == 0
    theirs, ours = both(workshop, "cup", "toolpath")
    assert (
        ours == theirs and "Joints against their limits" not in ours and "Layers and path" in ours
    )


@pytest.mark.long
def test_of_a_wall_it_compares_spacings_with_the_robots_motion(workshop):
    shell = Part.makeTorus(30.0, 8.0, App.Vector(-5, 0, 0), App.Vector(0, -1, 0), -180, 180, 40)
    shell.rotate(App.Vector(), App.Vector(0, 1, 0), -90)
    face = next(face for face in shell.Faces if isinstance(face.Surface, Part.Toroid))
    face.exportStep(str(workshop.folder / "bend.step"))
    Part.makeBox(60, 60, 20, App.Vector(0, -30, -20)).exportStep(
        str(workshop.folder / "block.step")
    )
    workshop.write_job(BEND)
    assert workshop.run("plan", "cup.yaml").status in (0, 3)
    theirs, ours = both(workshop, "bend", "joint path")
    assert (
        ours == theirs and "Joint motion by spacing" in ours and "Distances between layers" in ours
    )


def test_several_features_are_told_one_by_one(workshop):
    Part.makeBox(40, 40, 10, App.Vector(-20, -20, 0)).exportStep(
        str(workshop.folder / "plate.step")
    )
    Part.makeCylinder(12, 15, App.Vector(0, 0, 10)).exportStep(str(workshop.folder / "post.step"))
    workshop.write_job(TWO)
    command = workshop.run("plan", "cup.yaml")
    assert command.status in (0, 3), command.err
    theirs, ours = both(workshop, "two", "joint path")
    assert (
        ours == theirs and "plate" in ours["Layers and path"] and "post" in ours["Layers and path"]
    )


def test_what_does_not_fit_its_inputs_is_refused(doc, tmp_path):
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45.0, 0, 90
    doc.recompute()
    toolpath = api.make_toolpath(doc, api.make_feature(doc, sphere, layer_height=15))
    with pytest.raises(InputError, match="use the extension"):
        api.export_report(toolpath, str(tmp_path / "page.txt"))
    with pytest.raises(InputError, match=re.escape(f"the folder {tmp_path}/none does not exist")):
        api.export_report(toolpath, str(tmp_path / "none" / "page.html"))
    with pytest.raises(InputError, match="the object has no path"):
        api.export_report(toolpath.Feature, str(tmp_path / "page.html"))
    sphere.Radius = 40.0
    with pytest.raises(InputError, match="recompute the object first"):
        api.export_report(toolpath, str(tmp_path / "page.html"))
    assert not any(tmp_path.iterdir())
