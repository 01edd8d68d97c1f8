# SPDX-License-Identifier: LGPL-2.1-or-later
"""Waiting for a temperature before returning to a solid, from beads to programs read back;
tampering is detected."""

import dataclasses
import math

import numpy as np
import pytest

from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import (
    BetweenLayersParameters,
    CoolingParameters,
    ProcessParameters,
)
from freecad_am.core.parameters.program import NcParameters, ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.program import returning
from freecad_am.core.program import Moves, WaitBelow
from freecad_am.core.strategies.solids.plan import plan as plan_solids
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.core.planning.test_leaning_programs import CHORD_ERROR, HUB, ON_ROBOT, TABLE, UP
from tests.core.strategies.test_developable import box
from tests.programs import build

COOLING = CoolingParameters(below=150.0, input=3, gain=0.01, zero=0.25)
LIFT = 20.0


def toolpath(frame, order="around-axis", angle_between=0.9):
    """Two neighbouring blades with three layers each and two rings per layer."""
    blade = box(np.array([40.0, -11.0, 20.0]), np.array([76.0, 11.0, 44.0]))
    bodies = []
    for number, turn in enumerate((0.0, angle_between)):
        cos, sin = math.cos(turn), math.sin(turn)
        turned = blade.vertices @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
        bodies.append(
            dataclasses.replace(blade, name=f"blade {number}", vertices=turned @ frame[:3, :3].T)
        )
    strategy = DevelopableParameters(
        layer_height=5.0, chord_error=CHORD_ERROR, bead_spacing=6.0, order=order
    )
    solids = SolidsOnHub("part", (Group(Base("hub", HUB, frame), tuple(bodies)),), 0.0)
    return plan_solids(solids, strategy, BuildDirectionParameters(), ProcessParameters(), None)


def planned(settings, frame, **changes):
    path = toolpath(frame, **changes)
    cell = cells.resolve(settings, np.eye(4), "developable")
    joint_path = plan_joints(path, cell, JointParameters(degree=1))
    assert joint_path.feasible, [issue.message for issue in joint_path.issues]
    return cell, path, joint_path, assemble(joint_path, cell, process())[0]


def process(cooling=COOLING):
    return ProcessParameters(cooling=cooling, between_layers=BetweenLayersParameters(lift=LIFT))


def program(cell, path, joint_path, motion, post, cooling=COOLING, kind="joint", **options):
    parameters = ProgramParameters(post=post, nc=NcParameters(), motion=kind, **options)
    return build(
        motion, cell, process(cooling), parameters, "cool", (), returning(path, joint_path.beads)
    )


@pytest.fixture(scope="module")
def on_table():
    return planned(TABLE, np.eye(4))


@pytest.mark.parametrize("order", ["around-axis", "feature"])
def test_the_torch_waits_above_each_solid_once_a_layer(order):
    """The torch waits above each solid once per layer."""
    cell, path, joint_path, motion = planned(TABLE, np.eye(4), order=order)
    program_ = program(cell, path, joint_path, motion, "siemens")
    waits = [block for block in program_.blocks if isinstance(block, WaitBelow)]
    beads = {(bead_path.layer, bead_path.index): bead_path.bead for bead_path in joint_path.beads}

    def blade(bead):
        return int(math.atan2(*bead.points.mean(axis=0)[[1, 0]]) > 0.45)

    def level(bead):
        return round(float(np.hypot(*bead.points[0, :2]) - 60.0) / 5.0)

    # the first bead of each layer of each blade, except its first layer
    firsts = {}
    for bead_place, bead in beads.items():
        firsts.setdefault((blade(bead), level(bead)), bead_place)
    expected = [
        bead_place
        for bead_place in beads
        if bead_place in firsts.values() and level(beads[bead_place]) > 0
    ]
    assert [(wait.layer, wait.bead) for wait in waits] == expected and len(expected) >= 4
    assert all((wait.number, wait.below) == (3, pytest.approx(1.75)) for wait in waits)
    # right before the wait the torch is above the start of the bead, right after it approaches and
    # deposits
    for number, block in enumerate(program_.blocks):
        if isinstance(block, WaitBelow):
            above, down = program_.blocks[number - 1], program_.blocks[number + 1]
            assert isinstance(above, Moves) and isinstance(down, Moves) and len(down) == 1
            bead = beads[block.layer, block.bead]
            for moves, lift in ((above, LIFT), (down, 0.0)):
                joints = cell.machine.from_controller(moves.joints[-1:])
                tip, _ = cell.tip_in_part(cell.machine.chain.forward(joints))
                np.testing.assert_allclose(tip[0], bead.points[0] + lift * bead.tool[0], atol=1e-6)


@pytest.mark.parametrize(("post", "kind"), [("siemens", "joint"), ("siemens", "cartesian"), ("linuxcnc", "joint"),
                                            ("linuxcnc", "cartesian")])  # fmt: skip
def test_programs_of_tables_read_the_sensor(on_table, post, kind):
    """Programs of tables read the sensor, and tampering with the wait is detected."""
    cell, path, joint_path, motion = on_table
    writer = catalogue.load(post)
    program_ = program(cell, path, joint_path, motion, post, kind=kind, max_points=60)
    files = writer.write(program_)
    count = sum(isinstance(block, WaitBelow) for block in program_.blocks)
    assert count >= 4 and len(files) > 1
    checked = verify(cell, motion, program_, files, writer, CHORD_ERROR)
    assert checked.issues == ()
    condition_text, error_check = {"siemens": (b"WHILE $A_INA[3]>=1.75", b"WHILE $A_IN[3]==0"),
                  "linuxcnc": (b"while [#5399 GE 1.75]", b"")}[post]  # fmt: skip
    assert sum(text.count(condition_text) for text in files.values()) == count
    name = max(name for name, text in files.items() if condition_text in text)
    changes = [
        (condition_text, condition_text.replace(b"1.75", b"1.76")),
        (
            condition_text,
            condition_text.replace(b"[3]", b"[2]") if error_check else condition_text + b"1",
        ),
    ]
    changes += (
        [(condition_text, error_check)]
        if error_check
        else [(b"M66 E2 L0\no<cool", b"M66 E1 L0\no<cool")]
    )
    for old, new in changes:
        spoilt = {**files, name: files[name].replace(old, new, 1)}
        try:
            codes = [
                issue.code
                for issue in verify(cell, motion, program_, spoilt, writer, CHORD_ERROR).issues
            ]
        except InputError as error:
            codes = [error.code]
        assert codes in (
            ["VERIFY_COOLING"],
            ["VERIFY_WAIT", "VERIFY_COOLING"],
            ["UNREADABLE_PROGRAM"],
        ), (old, new)
    without = program(
        cell, path, joint_path, motion, post, CoolingParameters(), kind=kind, max_points=60
    )
    assert not any(isinstance(block, WaitBelow) for block in without.blocks)
    (condition_text,) = verify(cell, motion, without, files, writer, CHORD_ERROR).issues
    assert condition_text.code == "VERIFY_COOLING" and f"{count} of" in condition_text.message


def test_loops_that_read_once_are_not_understood(on_table):
    """Loops that read the sensor only once are rejected."""
    cell, path, joint_path, motion = on_table
    writer = catalogue.load("linuxcnc")
    ((name, text),) = writer.write(
        program(cell, path, joint_path, motion, "linuxcnc", max_points=10**6)
    ).items()
    start = text.index(b"M66 E2 L0")
    loop = text[start : text.index(b"endwhile", start)]
    for old, new in (
        (b"G4 P0.100\nM66 E2 L0\n", b"G4 P0.100\n"),
        (b"M66 E2 L0\no<", b"o<"),
        (b"G4 P0.100", b"G1 X0 F5"),
        (b"G4 P0.100\nM66 E2 L0", b"G4 P0.100\nM66 E1 L0"),
    ):
        assert old in loop
        with pytest.raises(InputError) as raised:
            writer.read({name: text.replace(old, new, 1)})
        assert raised.value.code == "UNREADABLE_PROGRAM"


def test_robots_wait_or_say_why_not():
    """Robots wait for the temperature, or the post gives the reason why not."""
    cell, path, joint_path, motion = planned(ON_ROBOT, UP, angle_between=0.6)
    writer = catalogue.load("fanuc")
    cooling_in_units = CoolingParameters(below=150.0, input=2, gain=8.0, zero=-3.0)
    program_ = program(cell, path, joint_path, motion, "fanuc", cooling_in_units)
    files = writer.write(program_)
    count = sum(isinstance(block, WaitBelow) for block in program_.blocks)
    assert sum(text.count(b"WAIT AI[2]<1197 ") for text in files.values()) == count >= 4
    assert verify(cell, motion, program_, files, writer, CHORD_ERROR).issues == ()
    name = next(name for name in files if b"WAIT AI[2]" in files[name])
    for new in (b"WAIT AI[3]<1197", b"WAIT AI[2]<1198", b"WAIT DI[2]=ON"):
        spoilt = {**files, name: files[name].replace(b"WAIT AI[2]<1197", new, 1)}
        codes = {
            issue.code
            for issue in verify(cell, motion, program_, spoilt, writer, CHORD_ERROR).issues
        }
        assert codes == {"VERIFY_COOLING", *(["VERIFY_WAIT"] if b"DI[" in new else [])}
    for post, cooling, code in (
        ("fanuc", COOLING, "ANALOGUE_INPUT"),
        ("fanuc", CoolingParameters(below=150.0, input=26), "ANALOGUE_INPUT"),
        ("staubli", cooling_in_units, "NO_ANALOGUE_INPUT"),
    ):
        for_post = dataclasses.replace(
            program(cell, path, joint_path, motion, "fanuc", cooling), continuous=(False,) * 6
        )
        with pytest.raises(InputError) as raised:
            catalogue.load(post).write(for_post)
        assert raised.value.code == code
