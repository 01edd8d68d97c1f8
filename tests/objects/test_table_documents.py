# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job whose cell becomes a five-axis table: the document follows, and gives the same after reopening."""

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError


def test_a_cell_becomes_a_table_and_the_job_follows(job):
    job.cell.Machine, job.cell.Setup, job.cell.Limits = "table-xyzac", "rotary-table", "maker"
    with pytest.raises(InputError) as caught:  # the program is one for FANUC
        api.recompute(job.program)
    assert caught.value.code == "UNSUPPORTED_SETUP" and "rotary-table" in caught.value.message
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

    job.cell.Machine, job.cell.Setup, job.cell.Limits, job.program.Post = "table-xyzbc", "rotary-table", "maker", "linuxcnc"
    api.recompute(job.program)
    motion, files = api.result(job.joint_path).motion, api.result(job.program).files
    path = str(tmp_path / "table.FCStd")
    job.doc.saveAs(path)
    again = FreeCAD.openDocument(path)
    try:
        joint_path, program = again.getObject(job.joint_path.Name), again.getObject(job.program.Name)
        assert joint_path.Status == program.Status == "up to date"
        np.testing.assert_array_equal(api.result(joint_path).motion.joints, motion.joints)
        assert np.isnan(api.result(joint_path).joint_path.beads[0].condition).all()
        assert api.result(program).files == files
    finally:
        FreeCAD.closeDocument(again.Name)
