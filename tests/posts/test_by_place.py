# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings by place in every post: two meet inside a bead, whose deposit stays on in the text. The text, read back, has the speed,
schedule and weave of each place; a text without them is refused, and what a controller cannot do is rejected by its post."""

import dataclasses
import functools

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import NcParameters, ProgramParameters, ScheduleParameters
from freecad_am.core.parameters.settings import Setting
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.program import DepositOff, DepositOn, Moves, Schedule, Weave
from freecad_am.core.simulation.timeline import timeline
from freecad_am.core.strategies.by_place import apply_settings
from freecad_am.core.toolpath import Layer, MotionRules, Toolpath
from freecad_am.objects.program import refuse
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import (
    CHORD_ERROR,
    HEIGHT,
    ONE_OF_EACH,
    PROCESS,
    PULSES,
    SETUPS,
    SIDES,
    SPEED,
    WAYS,
    _bead,
    body,
)
from tests.programs import build

pytestmark = pytest.mark.any_version

UP = np.array([0.0, 0.0, 1.0])
SLOW, FAST = 5.0, 11.0
LAYER = Setting(first_layer=1, travel_speed=SLOW, schedule=3)
BAND = Setting(low=4.0, high=9.5, travel_speed=FAST, schedule=4)  # beads rise by 18 mm
EACH = [tuple(name.split(" ", 3)) for name in ONE_OF_EACH]
LEANS = ("fanuc", "yaskawa")  # weave numbers on linear moves


def placed(name, process):
    setup = SETUPS[name]
    cell = cells.resolve(setup.cell, np.eye(4), "developable")
    if name.startswith("yaskawa"):
        machine = dataclasses.replace(
            cell.machine, pulses_per_degree=PULSES[: cell.machine.chain.axes], speed_unit="mm/s"
        )
        cell = dataclasses.replace(cell, machine=machine)
    layers = tuple(
        Layer(
            tuple(
                dataclasses.replace(_bead(setup.hub, side, k), ends=None) for side in range(SIDES)
            )
        )
        for k in range(2)
    )
    rules = MotionRules(max_from_vertical=setup.most)
    toolpath = Toolpath(layers, np.eye(4), HEIGHT, CHORD_ERROR, family="developable", rules=rules)
    low = min(bead.points[:, 2].min() for _, _, bead in toolpath)
    toolpath = apply_settings(toolpath, process, (), UP)
    path = plan_joints(toolpath, cell, JointParameters(degree=1))
    motion, _ = assemble(path, cell, process, [body(setup)], layer_height=HEIGHT)
    return cell, motion, low


def parameters_of(way, by="output"):
    post, kind, feed, _ = way
    return ProgramParameters(
        post=post,
        motion=kind,
        nc=NcParameters(feed=feed),
        schedule=ScheduleParameters(output=20, by=by),
    )


@functools.cache
def written(way, keys, by="output"):
    name = way[3]
    settings = tuple(
        dataclasses.replace(
            one,
            travel_speed=one.travel_speed if "travel_speed" in keys else None,
            schedule=one.schedule if "schedule" in keys else None,
            weave=dict(zip((LAYER, BAND), (1, 2)))[one] if "weave" in keys else None,
            lead_on=0.3 if one is BAND else 0.4,
        )
        for one in (LAYER, BAND)
    )
    process = dataclasses.replace(
        PROCESS, schedule=9 if "schedule" in keys else None, settings=settings
    )
    cell, motion, low = placed(name, process)
    program = build(motion, cell, process, parameters_of(way, by), "job")
    return cell, process, motion, program, low


def expected(motion, low, layer_value, band_value, value):
    """(n,) values of rows by the middle of their segments alone."""
    wanted = np.full(len(motion), value, dtype=float)
    middle = 0.5 * (motion.position + np.roll(motion.position, 1, axis=0))[:, 2] - low
    wanted[motion.layer >= 1] = layer_value
    wanted[(middle >= BAND.low) & (middle <= BAND.high)] = band_value
    return wanted


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_speeds_change_inside_beads_of_every_post_without_an_end(way):
    cell, _, motion, program, low = written(way, ("travel_speed",))
    moves = motion.deposit & (motion.point > 0)
    wanted = expected(motion, low, SLOW, FAST, SPEED)
    np.testing.assert_allclose(motion.speed[moves], wanted[moves], rtol=1e-9)
    heights = motion.position[moves, 2] - low
    for border in (BAND.low, BAND.high):
        assert (np.abs(heights - border) < 2e-3).sum() == 2 * SIDES  # a point of each bead
    assert sum(isinstance(block, DepositOn) for block in program.blocks) == 2 * SIDES
    assert not motion.halt.any()
    files = catalogue.load(way[0]).write(program)
    found = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    assert [issue.code for issue in found.issues if issue.level == ERROR] == []
    even = dataclasses.replace(
        motion,
        speed=np.where(moves, SPEED, motion.speed),
        duration=np.where(moves, motion.duration * motion.speed / SPEED, motion.duration),
    )
    other = build(
        even,
        cell,
        dataclasses.replace(PROCESS, settings=()),
        ProgramParameters(post=way[0], motion=way[1], nc=NcParameters(feed=way[2])),
        "job",
    )
    refused = verify(
        cell,
        motion,
        program,
        catalogue.load(way[0]).write(other),
        catalogue.load(way[0]),
        CHORD_ERROR,
    )
    assert {"VERIFY_SPEED", "VERIFY_TIME"} & {issue.code for issue in refused.issues}


@pytest.mark.parametrize("way", EACH, ids=" ".join)
def test_schedules_change_inside_beads_or_the_post_says_why_not(way):
    cell, process, motion, program, _ = written(way, ("schedule",))
    # each bead begins below the band or in it, and none changes more often than at its two borders
    told = [block for block in program.blocks if isinstance(block, Schedule) and block.inside]
    assert len(told) == 2 * 2 * SIDES
    if way[0] != "linuxcnc":
        with pytest.raises(InputError) as error:
            refuse(cell, process, parameters_of(way))
            catalogue.load(way[0]).write(program)
        assert error.value.code == "SCHEDULE"
        return
    files = catalogue.load(way[0]).write(program)
    found = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    assert [issue.code for issue in found.issues if issue.level == ERROR] == []
    (text,) = (content.decode() for content in files.values())
    numbers = [line.split("Q")[1] for line in text.splitlines() if line.startswith("M67 E19 Q")]
    assert numbers == [*["4", "9"] * SIDES, *["4", "3"] * SIDES]
    for line in {line for line in text.splitlines() if line.startswith("M67 E19 Q")}:
        changed = {name: text.replace(line, line + "0").encode() for name in files}
        refused = verify(cell, motion, program, changed, catalogue.load(way[0]), CHORD_ERROR)
        assert any(issue.level == ERROR for issue in refused.issues)


@pytest.mark.parametrize("by", ["call", "arc"])
def test_only_an_output_changes_a_schedule_within_a_bead(by):
    way = next(way for way in WAYS if way[0] == "fanuc" and way[1] == "cartesian")
    with pytest.raises(InputError) as error:
        written(way, ("schedule",), by)
    assert error.value.code == "SCHEDULE"


@pytest.mark.parametrize("way", EACH, ids=" ".join)
def test_a_schedule_of_whole_beads_needs_no_change_inside(way):
    """Every post that sends schedules sends those of a layer, each before its beads."""
    settings = (dataclasses.replace(LAYER, travel_speed=None),)
    process = dataclasses.replace(PROCESS, schedule=9, settings=settings)
    cell, motion, _ = placed(way[3], process)
    parameters = ProgramParameters(
        post=way[0],
        motion=way[1],
        nc=NcParameters(feed=way[2]),
        schedule=ScheduleParameters(output=4),
    )
    program = build(motion, cell, process, parameters, "job")
    if way[0] == "staubli":
        with pytest.raises(InputError) as error:
            refuse(cell, process, parameters)
        assert error.value.code == "SCHEDULE"
        return
    files = catalogue.load(way[0]).write(program)
    found = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    assert [issue.code for issue in found.issues if issue.level == ERROR] == []
    numbers = [block.number for block in program.blocks if isinstance(block, Schedule)]
    assert numbers == [9] * SIDES + [3] * SIDES


@pytest.mark.parametrize("post", LEANS)
def test_a_weave_changes_inside_a_bead_and_is_read_back(post):
    way = (post, "cartesian", "time", f"{post} tool-on-robot")
    cell, _, motion, program, low = written(way, ("weave",))
    files = catalogue.load(post).write(program)
    found = verify(cell, motion, program, files, catalogue.load(post), CHORD_ERROR)
    assert [issue.code for issue in found.issues if issue.level == ERROR] == []
    weave, woven = 0, []
    for block in program.blocks:
        if isinstance(block, Weave):
            assert weave == 0 or block.number == 0
            weave = block.number
        elif isinstance(block, Moves) and block.kind == "deposit":
            woven += [weave] * len(block)
    moves = motion.deposit & (motion.point > 0)
    assert woven == expected(motion, low, 1, 2, 0)[moves].tolist()


def test_leads_are_those_of_the_places_where_beads_begin_and_end():
    way = EACH[0]
    _, process, motion, program, low = written(way, ("travel_speed",))
    leads = [block.lead for block in program.blocks if isinstance(block, DepositOn)]
    starts = np.flatnonzero(motion.deposit & (motion.point == 0))
    wanted = expected(motion, low, 0.4, 0.3, PROCESS.lead_on)[starts + 1].tolist()
    assert leads == wanted and len(set(wanted)) > 1
    ends = [block.lead for block in program.blocks if isinstance(block, DepositOff)]
    assert ends == [PROCESS.lead_off] * len(ends)
    lit = timeline(motion, process).lit
    np.testing.assert_allclose(lit[starts], wanted)
    assert ProcessParameters().settings == ()
