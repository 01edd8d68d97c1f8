# SPDX-License-Identifier: LGPL-2.1-or-later
"""Doubts noted in machine files become issues of the programs that they affect."""

import numpy as np

from freecad_am.core.geometry.curves.bead_curves import BeadCurve, Curves
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import CurvesParameters
from freecad_am.core.strategies import curves
from freecad_am.objects.checks import controllers


def test_the_size_of_a_program_is_told_before_there_is_one():
    """The size follows the first post of the machine; robots of a URDF have none."""
    line = np.column_stack([np.linspace(0.0, 600.0, 60_050), np.zeros((60_050, 2))])
    toolpath = curves.plan(
        Curves("line", (BeadCurve(line),)),
        CurvesParameters(),
        BuildDirectionParameters(),
        ProcessParameters(),
    )
    for machine, level in (("kuka-kr16-2", "warning"), ("fanuc-arcmate120ic", "note")):
        placed = {"deposition_point": (1000.0, 0.0, 0.0, 0.0, 0.0, 0.0)}
        cell = cells.resolve(CellParameters(machine=machine, **placed), np.eye(4))
        (issue,) = controllers.likely_size_issues(toolpath, cell)
        assert (issue.level, issue.code) == (level, "PROGRAM_SIZE")
        assert f"the program of {cell.machine.posts[0]}" in issue.message


def test_doubts_in_machine_files_become_issues_of_programs():
    """Every file whose remarks doubt base, joints, limits or speeds gives a warning; remarks about
    other set-ups give none."""
    placed = {"deposition_point": (1000.0, 0.0, 0.0, 0.0, 0.0, 0.0)}

    def codes(name, motion, **options):
        cell = cells.resolve(CellParameters(machine=name, **placed, **options), np.eye(4))
        post = cell.machine.posts[0]
        settings = ProgramParameters(post=post, motion=motion)
        issues = [
            *controllers.base_issues(cell.machine, settings),
            *controllers.machine_issues(cell, settings),
        ]
        return [(issue.level, issue.code) for issue in issues], " ".join(
            str(issue.message) for issue in issues
        )

    doubted = [("note", "MACHINE_NOT_VERIFIED")]
    unknown = [("warning", "BASE_NOT_KNOWN")]
    issue_codes, words = codes("fanuc-arcmate120ic", "joint")
    assert issue_codes == doubted and "q3 - q2" in words and "dress-out" not in words
    issue_codes, words = codes("fanuc-arcmate120ic", "joint", limits="brochure_2018")
    assert issue_codes == doubted and "q3 - q2" in words and "dress-out" in words
    assert codes("fanuc-arcmate120ic", "cartesian")[0] == []
    assert codes("abb-irb1600-8-145", "cartesian")[0] == doubted
    assert codes("staubli-rx60b", "cartesian")[0] == unknown
    assert codes("staubli-rx60b", "joint")[0] == []
    assert codes("motoman-ar1440", "cartesian")[0] == unknown + doubted
    assert codes("kuka-kr16-2", "cartesian")[0] == []
