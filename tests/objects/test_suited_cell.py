# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job gets a cell in which it is feasible: a positioner if the torch would lean too far,
chosen before planning, and another location if the robot's usual one does not work. PyKDL chains of
the machine files check the result."""

import dataclasses
import json
import math
import types

import numpy as np
import PyKDL
import pytest

from freecad_am import api
from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.core.parameters.cell_records import EXTERNAL
from freecad_am.core.planning import remedies
from freecad_am.macro import suit

pytestmark = pytest.mark.any_version

ROBOT, TOOL, MAX_LEAN_DEG = "kuka-kr8-r2100-2-arc-hw", "tool-on-robot", 10.0
COARSE = {"layer_height": 15.0, "chord_error": 0.3}


@pytest.fixture
def dome(doc, monkeypatch):
    make = api.make_feature_of

    def coarse(*arguments, values, **named):
        return make(*arguments, values={**COARSE, **values}, **named)

    monkeypatch.setattr(api, "make_feature_of", coarse)
    sphere = doc.addObject("Part::Sphere", "Dome")
    sphere.Radius, sphere.Angle1 = 45, 0
    doc.recompute()
    return sphere


@pytest.fixture
def looked(monkeypatch):
    """Record how many layers were planned to find a cell."""
    counts, errors = [], remedies._errors
    monkeypatch.setattr(
        remedies,
        "_errors",
        lambda job, toolpath, report: (
            counts.append(len(toolpath.layers)) or errors(job, toolpath, report)
        ),
    )
    return counts


def leaning(path, positioner):
    """Return the lean of the torch from the vertical in deg at each point of a joint path object,
    by a PyKDL chain of the positioner's file."""
    chain = PyKDL.Chain()
    for joint in json.loads(
        (external.MECHANISMS / f"{positioner.machine}.json").read_text(encoding="utf-8")
    )["joints"]:
        chain.addSegment(PyKDL.Segment(PyKDL.Joint(), PyKDL.Frame(PyKDL.Vector(*joint["origin"]))))
        axis = PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), PyKDL.Joint.RotAxis)
        chain.addSegment(PyKDL.Segment(axis, PyKDL.Frame()))
    solver, lean_angles = PyKDL.ChainFkSolverPos_recursive(chain), []
    for bead in api.result(path).joint_path.beads:
        for tool, values in zip(bead.bead.tool, bead.joints[:, 6:], strict=True):
            angles, face = PyKDL.JntArray(2), PyKDL.Frame()
            for k in (0, 1):
                angles[k] = float(values[k])
            solver.JntToCart(angles, face)
            up = face.M * PyKDL.Vector(*map(float, tool))
            lean_angles.append(math.degrees(math.acos(max(-1.0, min(1.0, up[2])))))
    return np.array(lean_angles)


def test_a_positioner_is_proposed_before_the_job_is_planned_without(doc, dome, looked):
    cell, feature, _, path, program = api.make_all(
        doc, dome, machine=ROBOT, setup=TOOL, max_from_vertical=f"{MAX_LEAN_DEG:g} deg"
    )
    assert math.isclose(feature.MaxFromVertical.Value, MAX_LEAN_DEG)
    assert path.Status == program.Status == "up to date", (api.issues(path), api.issues(program))
    cell_result = api.result(cell)
    (positioner,) = EXTERNAL.read(cell_result.external)
    assert positioner.carries == "part" and cell_result.setup == TOOL
    assert leaning(path, positioner).max() <= MAX_LEAN_DEG + 1e-6
    assert len(looked) >= 2 and max(looked) <= 4


def test_without_a_limit_the_platform_that_suits_the_robot_stays(doc, dome, looked):
    cell, _, _, path, *_ = api.make_all(doc, dome, machine=ROBOT, setup=TOOL)
    assert api.result(cell) == cell_of(ROBOT, setup=TOOL) and path.Status == "up to date"
    assert len(looked) == 1


@pytest.mark.parametrize("setup", ["", TOOL, "part-on-robot"])
@pytest.mark.always(TOOL)
def test_a_place_that_does_not_serve_is_changed(doc, dome, monkeypatch, looked, setup):
    """A job of each set-up that starts out of reach is moved to a feasible location."""
    begin = cell_of(ROBOT)
    out_of_reach = (5000.0, 0.0, 900.0, 0.0, 0.0, 0.0)
    monkeypatch.setattr(
        api,
        "cell_of",
        lambda *arguments: type(begin)(
            machine=ROBOT, setup=arguments[2], deposition_point=out_of_reach, branch=begin.branch
        ),
    )
    cell, _, _, path, *_ = api.make_all(doc, dome, setup=setup)
    assert path.Status == "up to date", api.issues(path)
    assert api.result(cell).deposition_point != out_of_reach and api.result(cell).setup == (
        setup or "part-on-robot"
    )


@pytest.mark.long
def test_what_no_cell_helps_is_left_as_it_is(doc, dome, looked):
    """The part is too heavy for every positioner."""
    cell, *_, path = api.make_all(
        doc,
        dome,
        machine=ROBOT,
        setup=TOOL,
        max_from_vertical=f"{MAX_LEAN_DEG:g} deg",
        process={"density": 1e6},
    )[:4]
    assert path.Status == "infeasible" and api.result(cell) == cell_of(ROBOT, setup=TOOL)
    assert "NOT_LEVEL" in {issue.code for issue in api.issues(path)}


def test_what_is_proposed_is_named_as_the_panel_names_it(doc, monkeypatch):
    messages = []
    console = types.SimpleNamespace(PrintWarning=messages.append)
    monkeypatch.setattr(suit, "App", types.SimpleNamespace(Console=console))
    monkeypatch.setattr(
        suit.suited_cell,
        "suit_to_toolpath",
        lambda *_: lambda cell: dataclasses.replace(cell, platform=7.0, arm_clearance=3.0),
    )
    cell = api.make_cell(doc)
    monkeypatch.setattr(suit, "_write", lambda *_: None)
    suit.suit(cell, None)
    assert messages == [
        "Cell: Platform, Arm clearance: proposed for this job; enter the values of your cell\n"
    ]


def test_layers_that_failed_are_planned_in_the_next_search(doc, dome, monkeypatch):
    """A search plans some layers; if another layer fails after it, a second search finds a cell for
    that one too."""
    first_cell = api.make_cell(doc, platform=3.0)
    feature = api.make_feature_of(doc, "revolution", dome, (), links={}, values={})
    toolpath = api.make_toolpath(doc, feature, first_cell)
    count = len(api.result(toolpath).layers)
    assert count >= 4
    beside = next(k for k in range(count) if k not in {0, (count - 1) // 2, count // 2, count - 1})
    planned = []

    def errors(job, partial_toolpath, _):
        numbers = {api.result(toolpath).layers.index(layer) for layer in partial_toolpath.layers}
        planned.append(numbers)
        return {"SINGULAR"} if beside in numbers and job.settings == usual else set()

    monkeypatch.setattr(remedies, "_errors", errors)
    usual = api.result(first_cell)
    assert not suit.suit(first_cell, toolpath)
    assert all(beside not in numbers for numbers in planned)
    assert suit.suit(first_cell, toolpath, failed_layers={beside})
    assert beside in planned[-1] and api.result(first_cell) != usual
