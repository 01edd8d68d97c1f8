# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two jobs in a document: tools are for the one that is selected, not for the one that was made last."""

import pytest

from freecad_am import api
from freecad_am.gui.plots import dock as plots
from freecad_am.objects.job_group import grouped


@pytest.fixture
def jobs(person, hemisphere):
    """The groups of two jobs of few layers on one part."""
    doc = hemisphere.Document
    made = []
    for name in ("First", "Second"):
        cell, feature = api.make_cell(doc, limits="paper"), api.make_feature(doc, hemisphere, layer_height=15)
        toolpath = api.make_toolpath(doc, feature, cell)
        stages = [cell, feature, toolpath, api.make_joint_path(doc, toolpath, cell)]
        for stage in stages:
            stage.Label = f"{name} {stage.Proxy.kind}"
        made.append(grouped(doc, name, stages))
    person.open_workbench()
    return made


@pytest.mark.parametrize("which", [0, 1])
def test_tools_take_the_stages_of_the_job_that_is_selected(person, jobs, which):
    name = jobs[which].Label
    person.select(jobs[which])
    person.click("RoboticAM_ExportPath")
    assert person.field(person.panel("RoboticAM_ExportPath"), "Path").currentText() == f"{name} joint path"
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_JointPath")
    panel = person.panel("RoboticAM_JointPath")
    shown = [person.field(panel, f"Input{link}").currentText() for link in ("Toolpath", "Cell")]
    assert shown == [f"{name} toolpath", f"{name} cell"]
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_Inspect")
    panel = person.panel("RoboticAM_Inspection")
    assert person.field(panel, "Planned").currentText() == f"{name} feature"
    person.press("Cancel")
    person.panel_closed()
    person.click("RoboticAM_Plots")
    panel = person.panel(plots.NAME)
    person.until(lambda: person.field(panel, "plotted").currentText() == f"{name} joint path", "the path of the job", 5)
    person.until(lambda: plots._dock.building.worker is None and plots._dock.canvas.ready, "the picture", 20)
    panel.close()
    person.idle()


def test_the_point_at_the_origin_is_of_no_path(person, jobs):
    """A joint path without its toolpath, as in a document that it was copied into alone, draws nothing."""
    from freecad_am.gui.lines import Points

    points = Points(7.0, (1.0, 0.0, 0.0))
    assert points.set_node.numPoints.getValue() == 0 and points.coordinates.point.getNum() == 0
    points.set([[1.0, 2.0, 3.0]])
    assert points.set_node.numPoints.getValue() == 1
