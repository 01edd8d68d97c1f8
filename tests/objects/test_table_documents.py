# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job whose cell becomes a five-axis machine: the document follows, with the same results after
reopening."""

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.objects import toolpath as toolpaths


def test_a_cell_becomes_a_table_and_the_job_follows(job):
    job.cell.Machine, job.cell.Setup, job.cell.Limits = "table-xyzac", "rotary-table", "maker"
    with pytest.raises(InputError) as caught:  # the program is for FANUC
        api.recompute(job.program)
    assert (
        caught.value.code == "WRONG_CONTROLLER"
        and "does not read fanuc; use one of siemens" in caught.value.message
    )
    job.program.Post = "siemens"
    api.recompute(job.program)
    planned = api.result(job.joint_path)
    assert planned.joint_path.branch == () and planned.joint_path.method == "five-axis"
    assert planned.motion.joints.shape[1] == 5 and job.joint_path.SmallestCondition == 0.0
    files = api.result(job.program).files
    assert set(files) == {"CUP.MPF"} and b"X45.00000" in files["CUP.MPF"]
    assert "Trunnion" in job.cell.MachineTitle


def test_a_table_is_there_after_reopening(job, tmp_path):
    import FreeCAD

    job.cell.Machine, job.cell.Setup, job.cell.Limits, job.program.Post = (
        "table-xyzbc",
        "rotary-table",
        "maker",
        "linuxcnc",
    )
    api.recompute(job.program)
    motion, files = api.result(job.joint_path).motion, api.result(job.program).files
    path = str(tmp_path / "table.FCStd")
    job.doc.saveAs(path)
    again = FreeCAD.openDocument(path)
    try:
        joint_path, program = (
            again.getObject(job.joint_path.Name),
            again.getObject(job.program.Name),
        )
        assert joint_path.Status == program.Status == "up to date"
        np.testing.assert_array_equal(api.result(joint_path).motion.joints, motion.joints)
        assert np.isnan(api.result(joint_path).joint_path.beads[0].condition).all()
        assert api.result(program).files == files
    finally:
        FreeCAD.closeDocument(again.Name)


@pytest.mark.any_version
@pytest.mark.parametrize(
    "cell",
    [
        {"Platform": "11 -7 60 0 20 35"},
        {"Machine": "fanuc-arcmate120ic", "Setup": "tool-on-robot"},
    ],
)
def test_what_makes_a_program_impossible_is_told_before_anything_is_planned(job, cell, monkeypatch):
    """The document rejects such a job before planning, like a command."""
    import FreeCAD

    job.cell.Machine, job.cell.Setup, job.cell.Limits = "table-xyzac", "rotary-table", "maker"
    job.program.Post, job.program.Motion = "linuxcnc", "cartesian"
    api.recompute(job.program)
    assert job.program.Status == "up to date"
    messages = []
    planned = toolpaths.planned

    def watched(*inputs):
        messages.append((job.program.Status, job.program.Message))
        return planned(*inputs)

    monkeypatch.setattr(toolpaths, "planned", watched)
    # these values change the layers too
    for name, value in {**cell, "NozzleDiameter": 1.5}.items():
        setattr(job.cell, name, value)
    FreeCAD.ActiveDocument.recompute()
    early = messages[0]  # remedies of an infeasible plan are tried by planning again
    reason = (
        "cell.platform: [11, -7, 60, 0, 0, 35]" if "Platform" in cell else "does not read linuxcnc"
    )
    assert early[0] == "failed" and reason in early[1]
    if job.joint_path.Status == "up to date":
        assert early == (job.program.Status, job.program.Message)
    job.cell.Machine, job.cell.Setup, job.cell.Platform = "table-xyzac", "rotary-table", "60"
    FreeCAD.ActiveDocument.recompute()
    assert job.program.Status == "up to date", job.program.Message
