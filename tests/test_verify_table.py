# SPDX-License-Identifier: LGPL-2.1-or-later
"""The read-back of programs of five-axis machines accepts correct ones and catches every single
error."""

import dataclasses
import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.read_moves import Event, ReadMoves
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.read_back import text_path
from tests.programs import build

CHORD_ERROR = 0.02
MM, RAD, UNIT, RELATIVE = 5e-4, math.radians(5e-4), 5e-7, 5e-6
CARTESIAN = ("directions", "rotary words")


def turned_bead(distance, start):
    base = Developable(60.0, 200.0).offset(distance)
    theta, z = start + np.linspace(0.0, 1.2, 36), np.linspace(10.0, 70.0, 36)
    rho = base.radius * (1.0 - z / base.height)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    up = base.normals(points)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(points, up, up, 2.0 * math.pi * length / length[-1], np.full(36, 8.0), False)


@pytest.fixture(scope="module", params=["table-xyzac", "table-xyzbc", "head-table-xyzbc"])
def planned(request):
    parameters = CellParameters(
        machine=request.param,
        setup="rotary-table",
        platform=(10.0, -4.0, 30.0, 0.0, 0.0, 0.4),
        mount="part",
    )
    cell = cells.resolve(parameters, np.eye(4), "developable")
    layers = tuple(Layer((turned_bead(3.0 * k, 0.9 * k),)) for k in range(3))
    path = plan_joints(
        Toolpath(layers, np.eye(4), 3.0, CHORD_ERROR, family="developable"), cell, JointParameters()
    )
    motion, issues = assemble(path, cell, ProcessParameters(travel_speed=8.0))
    assert path.feasible and not issues
    return cell, motion


def planned_events(program):
    """Return the events of a text that matches the plan: layers, and output 1 with no time before
    or after."""
    events, row = [], 0
    for block in program.blocks:
        kind = {"LayerStart": "layer", "DepositOn": "on", "DepositOff": "off"}.get(
            type(block).__name__
        )
        row += len(block) if kind is None else 0
        if kind:
            events.append(
                Event(row, kind, (float(block.layer),) if kind == "layer" else (1.0, "H1"))
            )
        if kind in ("on", "off") and block.lead:
            events.insert(len(events) - (kind == "off"), Event(row, "wait", (block.lead,)))
    return tuple(events)


def unset_first(duration):
    """Return values with the first one unset: the duration of the first move depends on where the
    machine starts."""
    duration = duration.copy()
    duration[0] = 10.0
    return duration


def write_program(cell, motion, output):
    """Return the program and what a reader gets from its text, with rounded values."""
    cartesian = output in CARTESIAN
    parameters = ProgramParameters(
        post="siemens",
        motion="cartesian" if cartesian else "joint",
        origin=(3.0, 2.0, 1.0, 0.0, 0.0, 0.2) if cartesian else "auto",
    )
    program = build(motion, cell, ProcessParameters(travel_speed=8.0), parameters, "cone")

    def column(name):
        return np.concatenate([getattr(moves, name) for moves in program.moves])

    def rounded(values, half):
        return np.round(values / (2.0 * half)) * 2.0 * half

    slides = cell.machine.chain.sliding
    joints = np.where(slides, rounded(column("joints"), MM), rounded(column("joints"), RAD))
    duration = column("duration")
    deposit = np.concatenate(
        [np.full(len(moves), moves.kind == "deposit") for moves in program.moves]
    )
    flags = [deposit & cartesian, motion.stops[motion.moves], planned_events(program)]
    if output == "joints":
        times = duration * (1.0 + RELATIVE * np.sin(np.arange(len(duration))))
        return program, ReadMoves(
            joints,
            RAD,
            times,
            deposit,
            *flags,
            linear_digits=MM,
            duration_digits=duration * RELATIVE,
        )
    position = rounded(column("position"), MM)
    fields = {
        "position": position,
        "position_digits": MM,
        "speed": np.round(column("speed"), 3),
        "speed_digits": 5e-4,
    }
    nothing = np.full(len(duration), np.nan)
    if output == "directions":
        direction = rounded(column("direction"), UNIT)
        fields |= {"direction": direction, "direction_digits": UNIT}
        return program, ReadMoves(None, 0.0, unset_first(nothing), deposit, *flags, **fields)
    return program, ReadMoves(
        np.where(slides, np.nan, joints), RAD, unset_first(nothing), deposit, *flags, **fields
    )


def verify(cell, motion, program, readback):
    post = SimpleNamespace(read=lambda files: readback)
    return verification.verify(cell, motion, program, {}, post, CHORD_ERROR)


def codes(result):
    return {issue.code for issue in result.issues}


@pytest.mark.parametrize("way", ["joints", *CARTESIAN])
def test_a_right_text_passes(planned, way):
    result = verify(*planned, *write_program(*planned, way))
    assert result.issues == () and result.solvers == ("chain", "pykdl")
    assert 1e-5 < result.at_points_mm <= result.bound_mm < 0.02
    if way == "joints":
        assert 0.2 * CHORD_ERROR < result.between_mm < CHORD_ERROR + result.bound_mm


@pytest.mark.parametrize("axis", range(5))
@pytest.mark.parametrize("row", [3, 60, -2])
def test_an_axis_value_that_is_off_is_caught(planned, axis, row):
    cell, motion = planned
    program, readback = write_program(cell, motion, "joints")
    slides = cell.machine.chain.sliding[axis]
    joints = readback.joints.copy()
    joints[row, axis] += 3.0 * (MM if slides else RAD)
    result = verify(cell, motion, program, dataclasses.replace(readback, joints=joints))
    (issue,) = (issue for issue in result.issues if issue.code == "VERIFY_JOINT")
    assert (
        f"axis {cell.machine.axes[axis]} " in issue.message
        and (" mm " if slides else " deg ") in issue.message
    )


def test_whole_turns_are_turns(planned):
    # a rotary axis of a machine tool counts its turns: 360 deg further is another position
    cell, motion = planned
    for output in ("joints", "rotary words"):
        program, readback = write_program(cell, motion, output)
        for axis in np.flatnonzero(~cell.machine.chain.sliding):
            joints = readback.joints.copy()
            joints[60:, axis] += 2.0 * math.pi
            assert "VERIFY_JOINT" in codes(
                verify(cell, motion, program, dataclasses.replace(readback, joints=joints))
            )


def test_times_that_do_not_give_the_speed_are_caught(planned):
    cell, motion = planned
    program, readback = write_program(cell, motion, "joints")
    for factor in (1.0 + 4.0 * RELATIVE, 1.0 - 4.0 * RELATIVE):
        times = readback.duration.copy()
        times[40] *= factor
        assert codes(
            verify(cell, motion, program, dataclasses.replace(readback, duration=times))
        ) == {"VERIFY_TIME"}
    # a rapid at full machine speed has no time; a bead must have one
    times = unset_first(np.where(readback.deposit, readback.duration, np.nan))
    assert verify(cell, motion, program, dataclasses.replace(readback, duration=times)).issues == ()
    times[np.flatnonzero(readback.deposit)[5]] = np.nan
    assert codes(verify(cell, motion, program, dataclasses.replace(readback, duration=times))) == {
        "VERIFY_TIME"
    }


def test_deposit_and_count_are_caught(planned):
    cell, motion = planned
    program, readback = write_program(cell, motion, "joints")
    deposit = readback.deposit.copy()
    deposit[20] = ~deposit[20]
    assert codes(verify(cell, motion, program, dataclasses.replace(readback, deposit=deposit))) == {
        "VERIFY_DEPOSIT"
    }
    incomplete = dataclasses.replace(
        readback,
        joints=readback.joints[1:],
        duration=readback.duration[1:],
        deposit=readback.deposit[1:],
        duration_digits=readback.duration_digits[1:],
        linear=readback.linear[1:],
        stops=readback.stops[1:],
    )
    assert codes(verify(cell, motion, program, incomplete)) == {"VERIFY_COUNT"}


@pytest.mark.parametrize("way", CARTESIAN)
def test_positions_directions_and_speeds_that_are_off_are_caught(planned, way):
    cell, motion = planned
    program, readback = write_program(cell, motion, way)
    for axis in range(3):
        position = readback.position.copy()
        position[33, axis] += 4.0 * MM
        assert "VERIFY_POINT" in codes(
            verify(cell, motion, program, dataclasses.replace(readback, position=position))
        )
    speed = readback.speed.copy()
    speed[33] += 0.002
    assert codes(verify(cell, motion, program, dataclasses.replace(readback, speed=speed))) == {
        "VERIFY_SPEED"
    }
    elsewhere = dataclasses.replace(
        program, carried=(program.carried[0] + 0.01, *program.carried[1:])
    )
    assert "VERIFY_POINT" in codes(verify(cell, motion, elsewhere, readback))
    if way == "directions":
        for change in (
            lambda d: -d,
            lambda d: d + [5e-6, 0.0, 0.0],
            lambda d: np.full_like(d, np.nan),
        ):
            direction = readback.direction.copy()
            direction[33] = change(direction[33])
            assert "VERIFY_TOOL" in codes(
                verify(cell, motion, program, dataclasses.replace(readback, direction=direction))
            )
        # the length of a direction vector does not matter
        scaled = dataclasses.replace(
            readback,
            direction=2.0 * readback.direction,
            direction_digits=2.0 * readback.direction_digits,
        )
        assert verify(cell, motion, program, scaled).issues == ()
    else:
        for axis in np.flatnonzero(~cell.machine.chain.sliding):
            joints = readback.joints.copy()
            joints[33, axis] += 3.0 * RAD
            assert codes(
                verify(cell, motion, program, dataclasses.replace(readback, joints=joints))
            ) >= {"VERIFY_JOINT"}
        nothing = dataclasses.replace(readback, joints=None)
        assert codes(verify(cell, motion, program, nothing)) == {"VERIFY_TOOL", "VERIFY_BETWEEN"}


def test_the_bound_holds_and_is_tight(planned):
    cell, _ = planned
    rng = np.random.default_rng(4)
    slides = cell.machine.chain.sliding
    digits = np.where(slides, 0.0005, math.radians(0.002))
    corners = np.array(list(itertools.product([-1.0, 1.0], repeat=5))) * digits
    for _ in range(20):
        controller_joints = np.where(slides, rng.uniform(-200, 200, 5), rng.uniform(-2, 2, 5))
        path, _ = text_path.joint_path(cell, controller_joints[None], digits)
        tips, tools = cell.tip_in_part(cell.machine.chain.forward(controller_joints + corners))
        off = np.linalg.norm(tips - path.position, axis=1).max()
        tilt = np.linalg.norm(tools - path.tool, axis=1).max()
        assert (
            0.3 * path.bound[0] < off <= path.bound[0]
            and 0.2 * path.tool_bound[0] < tilt <= path.tool_bound[0]
        )
