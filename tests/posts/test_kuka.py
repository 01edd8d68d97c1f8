# SPDX-License-Identifier: LGPL-2.1-or-later
"""KUKA modules: exact bytes, splitting, speeds, refusals, and reading of modules written by
hand."""

import dataclasses
import json
import math
import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.external import MECHANISMS
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.program import build_header
from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Schedule,
    Wait,
    WaitBelow,
    WaitInput,
)
from freecad_am.posts import catalogue
from freecad_am.posts.kuka import post as kuka

NOMINAL = tuple(math.radians(value) for value in (156.0, 156.0, 156.0, 330.0, 330.0, 615.0))
NUMBER = r"-?\d+\.\d{%d}"
EXTERNAL_AXES = rf"(?:,E2 {NUMBER % 4},E3 {NUMBER % 4}(?:,E4 {NUMBER % 4})?|,E1 {NUMBER % 4})?"
INSTRUCTIONS = [
    "PTP {" + ",".join(f"A{axis} {NUMBER % 4}" for axis in range(1, 7)) + EXTERNAL_AXES + "}",
    "LIN {" + ",".join(f"{axis} {NUMBER % (3 if axis in 'XYZ' else 4)}" for axis in "XYZABC") + EXTERNAL_AXES + "}(?: C_DIS)?",
    r"\$BASE=EK\(MACHINE_DEF\[3\]\.ROOT,MACHINE_DEF\[3\]\.MECH_TYPE,BASE_DATA\[\d+\]\)", r"\$VEL_EXTAX\[[1234]\]=\d+",
    r"BAS\(#(?:INITMOV,0|BASE,\d+|TOOL,\d+|VEL_PTP,(?:[1-9]\d?|100))\)", r"\$IPO_MODE=#BASE", r"\$ORI_TYPE=#VAR",
    r"\$VEL\.CP=[0-2]\.\d{6}", r"\$APO\.CDIS=\d+\.\d{3}", r"\$OUT\[\d+\]=(?:TRUE|FALSE)", r"WAIT SEC (?:0|\d+\.\d{3})",
    r"TRIGGER WHEN (?:DISTANCE=1|PATH=ArcGetPath\(#\w+,WDAT(?:OFF)?\d+\)) DELAY=(?:0|ArcGetDelay\(#\w+,WDAT\d+\)) "
    r"DO ArcMainNG\(#\w+,WDAT(?:OFF)?\d+,WSEAM\) PRIO=-1", r"ArcMainNG\(#\w+,WDAT(?:OFF)?\d+,WSEAM\)",
    r"TRIGGER WHEN DISTANCE=1 DELAY=(?:0|-\d+) DO \$OUT\[\d+\]=(?:TRUE|FALSE)",
    r"WAIT FOR \$IN\[\d+\]==TRUE", r"[A-Za-z]\w{0,19}\(\)", r"; [ -~]{1,80}",
]  # fmt: skip


def moves(kind, degrees, duration=0.5, layer=0, bead=0, speed=6.0, **extra):
    degrees = np.atleast_2d(np.asarray(degrees, float))
    duration = np.broadcast_to(np.asarray(duration, float), len(degrees)).copy()
    return Moves(
        kind, layer, bead, np.radians(degrees), duration, np.full(len(degrees), speed), **extra
    )


def linear_bead(points, layer=0, bead=0, speed=6.0, duration=0.25):
    """Return a bead of linear moves through the points, with the tool turning in all directions."""
    k = np.arange(points)[:, None]
    turns = Rotation.from_euler(
        "ZYX", np.hstack([10.0 * k, 3.0 * k - 20.0, 179.0 + k]), degrees=True
    ).as_matrix()
    return moves(
        "deposit",
        0.1 * k + np.full(6, 0.1),
        duration,
        layer,
        bead,
        speed,
        interpolation="linear",
        rotation=turns,
        position=np.hstack([1.5 * k, 0.25 + 0.0 * k, 5.0 - 0.1 * k]),
    )


def program(*blocks, name="part", **options):
    defaults = {
        "continuous": (False,) * 6, "max_speed": NOMINAL, "station": (900.0, 0.0, 310.5, 0.0, 0.0, math.pi / 2),
        "carried": (0.0, 0.0, 150.0, 0.0, math.pi / 4, 0.0), "motion": "cartesian", "setup": "tool-on-robot",
    }  # fmt: skip
    return Program(name, "a machine", blocks, **{**defaults, **options})


def beads(count, points, layers=1, **options):
    """Return beads of `points` points each, each after two rapid moves."""
    blocks = []
    for layer in range(layers):
        blocks.append(LayerStart(layer))
        for bead in range(count):
            blocks += [moves("rapid", [[1.0] * 6, [0.0] * 6], layer=layer, bead=bead), DepositOn()]
            blocks += [linear_bead(points, layer, bead), DepositOff()]
    return program(*blocks, **options)


def lines(files, name):
    return files[name].decode("ascii").split("\r\n")[3:-2]


def refusal(source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        kuka.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


def assert_modules(files):
    """Assert that a module has plain instructions only, the name of its file, no approximation
    before a stop, and all settings of its moves."""
    for file, content in files.items():
        text = content.decode("ascii")
        assert text.count("\n") == text.count("\r\n") and text.endswith("\r\nEND\r\n")
        assert text.startswith(f"&ACCESS RVP\r\n&REL 1\r\nDEF {file.removesuffix('.src')}()\r\n")
        statements = lines(files, file)
        assert not [
            line
            for line in statements
            if not any(re.fullmatch(pattern, line) for pattern in INSTRUCTIONS)
        ]
        moving = [n for n, line in enumerate(statements) if line.startswith(("PTP", "LIN"))]
        for n in moving:
            text_before = "\n".join(statements[:n])
            assert all(
                word in text_before
                for word in ("INITMOV", "#BASE,", "#TOOL,", "IPO_MODE", "ORI_TYPE")
            )
            assert ("VEL_PTP" if statements[n].startswith("PTP") else "$VEL.CP") in text_before
            calls = (";", "$VEL", "$APO", "BAS", "TRIGGER", "ArcMainNG")
            next_move = next(line for line in statements[n + 1 :] if not line.startswith(calls))
            assert not statements[n].endswith("C_DIS") or (
                next_move.startswith("LIN") and "$APO.CDIS" in text_before
            )
            assert next_move.startswith(
                ("PTP", "LIN", "WAIT")
            )  # outputs and calls come at a standstill


JOB = program(
    LayerStart(0),
    moves("rapid", [[0.0, -90.0, 90.0, 0.0, 60.0, 170.0], [1.25, -89.5, 90.25, 0.1, 60.5, 175.0]], [10.0, 0.8]),
    DepositOn(0.5), linear_bead(3), DepositOff(0.25), Wait(12.5), WaitInput(3), Call("clean"), LayerStart(1),
    moves("rapid", [[0.0, -90.0, 90.0, 0.0, 60.0, 177.4]], 1.0, layer=1), DepositOn(), linear_bead(2, 1, speed=7.5), DepositOff(),
    name="Job", remarks=('A remark ]]> with "marks": Größe',), deposit_output=3, user_frame=2,
)  # fmt: skip


def add_positioner(source, **changes):
    """Return the program with two external axes, written as E2 and E3, that tilt by 30 deg and turn
    further with every move."""
    count, blocks = 0, []
    for block in source.blocks:
        if isinstance(block, Moves):
            turned = np.radians(
                np.c_[np.full(len(block), 30.0), 10.0 * (count + np.arange(len(block))) - 0.25]
            )
            count, block = (
                count + len(block),
                dataclasses.replace(block, joints=np.hstack([block.joints, turned])),
            )
        blocks.append(block)
    return dataclasses.replace(
        source,
        blocks=tuple(blocks),
        **{
            "name": "dome",
            "continuous": (False,) * 8,
            "max_speed": NOMINAL + tuple(np.radians([80.0, 160.0])),
            "external_kinds": ("rotary", "rotary"),
            "unit": "3",
            "first_external": 2,
            "station": (0, 0, 20, 0, 0, 0),
            **changes,
        },
    )


def put_on_track(source, **changes):
    """Return the program on a track, written as E1, that advances by 12.5 mm with every move."""
    count, blocks = 0, []
    for block in source.blocks:
        if isinstance(block, Moves):
            slid = 12.5 * (count + np.arange(len(block)))[:, None] - 900.125
            count, block = (
                count + len(block),
                dataclasses.replace(block, joints=np.hstack([block.joints, slid])),
            )
        blocks.append(block)
    return dataclasses.replace(
        source,
        blocks=tuple(blocks),
        **{
            "name": "rail",
            "continuous": (False,) * 7,
            "max_speed": (*NOMINAL, 2500.0),
            "external_kinds": ("linear",),
            "unit": "",
            "first_external": 1,
            "station": (1200, 0, 20, 0, 0, 0),
            **changes,
        },
    )


def put_on_track_with_positioner(source, **changes):
    """Return the program on a track as E2, with two positioner axes around it as E3 and E4."""
    source, count, blocks = add_positioner(source), 0, []
    for block in source.blocks:
        if isinstance(block, Moves):
            slid = 12.5 * (count + np.arange(len(block))) - 900.125
            count, block = (
                count + len(block),
                dataclasses.replace(block, joints=np.insert(block.joints, 6, slid, axis=1)),
            )
        blocks.append(block)
    return dataclasses.replace(
        source,
        blocks=tuple(blocks),
        **{
            "name": "both",
            "continuous": (False,) * 9,
            "max_speed": (*NOMINAL, 2500.0, *np.radians([80.0, 160.0])),
            "external_kinds": ("linear", "rotary", "rotary"),
            **changes,
        },
    )


def light_arc(source, **changes):
    """Return the program with the arc lit at the end of a linear move onto each bead, by schedules
    3, 4 and so on."""
    blocks, schedule = list(source.blocks), 3
    for n in range(len(blocks) - 2, -1, -1):  # backwards, because blocks are inserted
        if isinstance(blocks[n], DepositOn):
            bead_moves, approach = blocks[n + 1], blocks[n - 1]
            onto = moves(
                "rapid",
                np.degrees(approach.joints[-1:]) + 0.01,
                0.2,
                approach.layer,
                approach.bead,
                100.0,
                interpolation="linear",
                position=bead_moves.position[:1] - [1.5, 0.0, 0.0],
                rotation=bead_moves.rotation[:1],
            )
            blocks.insert(n, onto)
    for n, block in enumerate(blocks):
        if isinstance(block, DepositOn):
            blocks[n] = dataclasses.replace(block, schedule=schedule)
        if isinstance(block, DepositOff):
            blocks[n], schedule = DepositOff(0.0, schedule), schedule + 1
    return dataclasses.replace(source, blocks=tuple(blocks), **{"name": "arc", **changes})


def switch_on_moves(source, lead=0.12, **changes):
    """Return the program with the deposit switched on the moves themselves."""
    blocks = [
        dataclasses.replace(block, lead=0.0, ahead=lead)
        if isinstance(block, (DepositOn, DepositOff))
        else block
        for block in source.blocks
    ]
    return dataclasses.replace(source, blocks=tuple(blocks), **{"name": "early", **changes})


GOLDENS = {
    "trigger": switch_on_moves(JOB),
    "triggers": switch_on_moves(JOB, 0.0, max_points=5, name="earlies"),
    "arc": light_arc(JOB),
    "arcparts": light_arc(JOB, max_points=5, blend=50, name="arcs"),
    "whole": JOB,
    "parts": dataclasses.replace(JOB, max_points=5, blend=50, name="cup"),
    "positioner": add_positioner(JOB),
    "track": put_on_track(JOB),
    "both": put_on_track_with_positioner(JOB),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_modules_to_the_byte(root, name):
    files = kuka.write(GOLDENS[name])
    folder = root / "tests/golden/kuka" / name
    assert files == {path.name: path.read_bytes() for path in folder.iterdir()}
    assert_modules(files)


def test_a_track_carries_the_robot_and_the_base_stands():
    source = put_on_track(JOB)
    readback, joints = (
        kuka.read(kuka.write(source)),
        np.concatenate([moves.joints for moves in source.moves]),
    )
    assert (
        np.array_equal(readback.joints[:, 6], joints[:, 6])
        and np.isnan(readback.joints[readback.linear, :6]).all()
    )
    np.testing.assert_allclose(
        readback.joints[~readback.linear, :6], joints[~readback.linear, :6], rtol=0.0, atol=1e-6
    )
    assert (readback.unit, readback.first_external, readback.linear_digits) == ("", 1, 0.00005)
    text = kuka.write(source)["rail.src"].decode()
    assert "EK(" not in text and "E1 is the track in mm" in text and "$VEL_EXTAX[1]=100" in text
    slid = [float(value) for value in re.findall(r"(?:PTP|LIN) \{.*?E1 (-?[\d.]+)", text)]
    assert np.allclose(np.diff(slid), 12.5) and slid[0] == -900.125
    refusal(put_on_track(JOB, unit="2"), code="UNSUPPORTED_AXES", where="program.axes.unit")
    refusal(
        put_on_track(JOB, first_external=7), code="UNSUPPORTED_AXES", where="program.axes.first"
    )


def test_a_track_and_a_positioner_are_told_together():
    source = put_on_track_with_positioner(JOB)
    files = kuka.write(source)
    readback, joints = kuka.read(files), np.concatenate([moves.joints for moves in source.moves])
    assert (
        np.array_equal(readback.joints[:, 6], joints[:, 6])
        and np.isnan(readback.joints[readback.linear, :6]).all()
    )
    np.testing.assert_allclose(readback.joints[:, 7:], joints[:, 7:], rtol=0.0, atol=1e-6)
    assert (readback.unit, readback.first_external, readback.linear_digits) == ("3", 2, 0.00005)
    text = files["both.src"].decode()
    assert (
        "EK(MACHINE_DEF[3].ROOT" in text
        and "E2 is the track in mm" in text
        and "the base of MACHINE_DEF[3]" in text
    )
    with pytest.raises(InputError):
        kuka.read(
            {
                "both.src": text.replace(
                    "; E2 is the track in mm", "; E5 is the track in mm"
                ).encode()
            }
        )
    refusal(
        put_on_track_with_positioner(JOB, unit=""),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )


@pytest.mark.parametrize("seed", range(4))
def test_random_programs_come_back_to_their_digits(random_application, seed):
    source = random_application(seed, "cartesian", "tool-on-robot", max_points=60)
    source = dataclasses.replace(
        source,
        tool_frame=4,
        blocks=tuple(
            # rapids whose speed a whole percentage can express
            dataclasses.replace(
                b,
                joints=np.cumsum(np.full(b.joints.shape, 0.1), axis=0) + 0.01 * n,
                duration=np.full(len(b), 0.3),
            )
            if isinstance(b, Moves) and b.kind == "rapid"
            else b
            for n, b in enumerate(source.blocks)
        ),
    )
    source = dataclasses.replace(source, max_speed=(40.0,) * 6)
    files = kuka.write(source)
    assert_modules(files)
    readback, run = kuka.read(files), list(source.moves)
    straight = np.concatenate(
        [np.full(len(moves_), moves_.interpolation == "linear") for moves_ in run]
    )
    np.testing.assert_array_equal(readback.linear, straight)
    joints = np.concatenate([moves_.joints for moves_ in run])
    np.testing.assert_allclose(
        readback.joints[~straight], joints[~straight], rtol=0.0, atol=readback.digits + 1e-12
    )
    positions, turn = (
        np.concatenate([getattr(moves_, name) for moves_ in run])[straight]
        for name in ("position", "rotation")
    )
    np.testing.assert_allclose(readback.position[straight], positions, rtol=0.0, atol=5.01e-4)
    np.testing.assert_allclose(readback.rotation[straight], turn, rtol=0.0, atol=4e-6)
    np.testing.assert_allclose(
        readback.speed[straight],
        np.concatenate([moves_.speed for moves_ in run])[straight],
        atol=5.1e-4,
    )
    np.testing.assert_array_equal(readback.deposit, straight)
    assert (
        set(readback.user_frame) == {source.user_frame}
        and set(readback.tool_frame) == {4}
        and readback.share[0] == 0.1
    )


def test_parts_are_the_program_hold_whole_beads_and_their_sum_is_told():
    complete, files = (
        kuka.read(kuka.write(beads(3, 20, layers=2))),
        kuka.write(beads(3, 20, layers=2, max_points=50)),
    )
    assert_modules(files)
    # each file ends with a standstill of no time
    complete, cut = (
        dataclasses.replace(
            readback,
            events=tuple(e for e in readback.events if (e.kind, e.value) != ("wait", (0.0,))),
        )
        for readback in (complete, kuka.read(files))
    )
    for field in (
        candidate for candidate in dataclasses.fields(complete) if candidate.name != "lines"
    ):
        if (
            field.name == "rotation"
        ):  # sines may differ in their last bit, depending on their address in memory
            np.testing.assert_allclose(cut.rotation, complete.rotation, rtol=0.0, atol=1e-15)
        else:
            np.testing.assert_array_equal(
                getattr(cut, field.name), getattr(complete, field.name), field.name
            )
    total = sum(len(content) for name, content in files.items() if name != "part.src")
    assert lines(files, "part.src")[-4:] == [
        f"; 3 parts of {total} bytes in all",
        "part01()",
        "part02()",
        "part03()",
    ]
    assert all(lines(files, f"part0{n}.src").count("$OUT[1]=TRUE") == 2 for n in (1, 2, 3))
    longer = kuka.write(beads(2, 25, max_points=20))
    assert_modules(longer)
    assert len(longer) == 3 and lines(longer, "part01.src").count("$OUT[1]=FALSE") == 1


def test_a_dry_run_moves_the_same_and_switches_nothing():
    files, dry = kuka.write(JOB), kuka.write(dataclasses.replace(JOB, dry_run=True))
    assert b"$OUT" not in dry["Job.src"] and b"; dry run: no deposit" in dry["Job.src"]
    moving = [
        [line for line in lines(f, "Job.src") if line.startswith(("PTP", "LIN", "$VEL"))]
        for f in (files, dry)
    ]
    assert moving[0] == moving[1] and len(moving[0]) > 8


def test_speeds_and_corners():
    statements = lines(kuka.write(JOB), "Job.src")
    # axis 6 turns by 5 deg in 0.8 s, of 615 deg/s; then axis 2 by 90.3 in 1 s, of 156
    assert [line for line in statements if "VEL_PTP" in line] == [
        f"BAS(#VEL_PTP,{share})" for share in (10, 1, 58)
    ]
    assert [line for line in statements if "VEL.CP" in line] == [
        "$VEL.CP=0.006000",
        "$VEL.CP=0.007500",
    ]
    assert [line for line in statements if "CDIS" in line] == [
        "$APO.CDIS=0.750",
        "$APO.CDIS=0.937",
    ]  # half of 0.25 s
    assert not [
        line
        for line in lines(kuka.write(dataclasses.replace(JOB, blend=0)), "Job.src")
        if "DIS" in line
    ]
    fast, slow = (
        program(moves("rapid", np.zeros(6)), moves("rapid", [0, 0, step, 0, 0, 0], 1.0))
        for step in (160.0, 0.7)
    )
    assert "103 %" in refusal(fast, code="JOINT_SPEED", where="layer 0 bead 0")
    assert "0.449 %" in refusal(slow, code="JOINT_SPEED")
    short = program(
        moves("rapid", np.zeros(6)), moves("rapid", [0, 0, 0.03, 0, 0, 0], 0.05)
    )  # 0.385 % for the shortest time
    assert [line for line in lines(kuka.write(short), "part.src") if "VEL_PTP" in line] == [
        f"BAS(#VEL_PTP,{share})" for share in (10, 1)
    ]
    for speed in (0.004, 1e6, np.nan):
        refusal(
            program(moves("rapid", np.zeros(6)), linear_bead(3, 2, 1, speed)),
            code="MOVE_SPEED",
            where="layer 2 bead 1",
        )


def test_frames_are_told_as_the_pendant_takes_them():
    statements = lines(kuka.write(JOB), "Job.src")
    assert "BAS(#BASE,2)" in statements and "BAS(#TOOL,1)" in statements
    values = {
        line.split()[1]: [float(value) for value in line.split()[3::2]]
        for line in statements
        if line[6:9] == " X "
    }
    np.testing.assert_allclose(values["BASE"], [900.0, 0.0, 310.5, 90.0, 0.0, 0.0])
    np.testing.assert_allclose(values["TOOL"], [0.0, 0.0, 150.0, 0.0, 45.0, 0.0])


@pytest.mark.parametrize(("name", "why", "proposal"), [
    ("", "empty", "am"), ("my part", "letters", "my_part"), ("2nd", "start with a letter", "am_2nd"),
    ("x" * 21, "20 characters", "x" * 16), ("con", "reserved", "am_con"), ("endFor", "reserved", "am_endFor"),
])  # fmt: skip
def test_names_the_controller_refuses(name, why, proposal):
    message = refusal(dataclasses.replace(JOB, name=name), code="PROGRAM_NAME", where="name")
    assert why in message and message.endswith(f"use {proposal!r}")
    kuka.write(dataclasses.replace(JOB, name=proposal))


def test_no_module_has_the_name_of_what_it_declares_or_uses():
    for name in ("WDAT3", "wdatoff4", "WSEAM", "ArcMainNG"):
        assert "variable" in refusal(
            dataclasses.replace(light_arc(JOB), name=name), code="PROGRAM_NAME", where="name"
        )
        kuka.write(dataclasses.replace(JOB, name=name))  # this program uses none of it
    changed = dataclasses.replace(
        JOB, blocks=(JOB.blocks[0], Schedule(3), *JOB.blocks[1:]), schedule_output=20
    )
    refusal(dataclasses.replace(changed, name="AM_schedule"), code="PROGRAM_NAME", where="name")
    called = dataclasses.replace(changed, blocks=(*changed.blocks, Call("am_schedule")))
    refusal(called, code="PROGRAM_NAME", where="process.between_layers.call")


def test_what_cannot_be_said_is_refused():
    where = "process.between_layers.call"
    refusal(
        dataclasses.replace(JOB, setup="rotary-table"), code="UNSUPPORTED_SETUP", where="cell.setup"
    )
    assert "#TCP" in refusal(
        dataclasses.replace(JOB, setup="part-on-robot"), code="REMOTE_TCP", where="cell.setup"
    )
    joint = dataclasses.replace(JOB, motion="joint")
    assert "whole percents" in refusal(joint, code="JOINT_DEPOSIT", where="program.motion")
    refusal(
        dataclasses.replace(JOB, continuous=(False,) * 5 + (True,)),
        code="ENDLESS_AXIS",
        where="cell.limits",
    )
    refusal(
        dataclasses.replace(JOB, tool_frame=17),
        code="UNSUPPORTED_FRAME",
        where="program.tool_frame",
    )
    refusal(
        dataclasses.replace(JOB, user_frame=33),
        code="UNSUPPORTED_FRAME",
        where="program.user_frame",
    )
    for speeds in ((), (1.0,) * 5 + (math.inf,)):
        refusal(
            dataclasses.replace(JOB, max_speed=speeds), code="NO_JOINT_SPEED", where="cell.machine"
        )
    refusal(program(moves("rapid", np.ones(6)), WaitBelow(1, 0.5, 0, 0)), code="NO_ANALOGUE_INPUT")
    refusal(
        program(moves("rapid", np.ones(6)), dataclasses.replace(linear_bead(2), wire=np.ones(2))),
        code="NO_WIRE_OUTPUT",
    )
    refusal(
        program(moves("rapid", np.ones(6)), dataclasses.replace(linear_bead(2), position=None)),
        code="NO_POSITIONS",
    )
    refusal(program(LayerStart(0)), code="NOTHING_TO_WRITE")
    for called in ("Part", "two words", "loop"):
        refusal(program(moves("rapid", np.ones(6)), Call(called)), code="PROGRAM_NAME", where=where)
    refusal(
        program(*beads(3, 20).blocks, Call("PART02"), max_points=25),
        code="PROGRAM_NAME",
        where=where,
    )
    assert catalogue.load("kuka") is kuka


def test_axes_beside_the_robot():
    readback, run = kuka.read(kuka.write(add_positioner(JOB))), add_positioner(JOB).moves
    joints = np.concatenate([moves.joints for moves in run])
    np.testing.assert_allclose(readback.joints[:, 6:], joints[:, 6:], rtol=0.0, atol=1e-6)
    assert (readback.unit, readback.first_external) == ("3", 2) and np.isnan(
        readback.joints[readback.linear, :6]
    ).all()
    statements = lines(kuka.write(add_positioner(JOB)), "dome.src")
    # 10 deg of 160 deg/s in 0.8 s
    assert [line for line in statements if "VEL_PTP" in line] == [
        f"BAS(#VEL_PTP,{share})" for share in (10, 8, 58)
    ]
    assert [line for line in statements if "EXTAX[3]" in line] == [
        f"$VEL_EXTAX[3]={share}" for share in (10, 8, 100, 58, 100)
    ]
    refusal(
        add_positioner(JOB, first_external=6), code="UNSUPPORTED_AXES", where="program.axes.first"
    )
    for unit in ("", "1", "STN1", "17"):
        refusal(add_positioner(JOB, unit=unit), code="UNSUPPORTED_AXES", where="program.axes.unit")
    refusal(
        dataclasses.replace(add_positioner(JOB), external_kinds=()),
        code="UNSUPPORTED_AXES",
        where="program.post",
    )


def _refused_beside(mechanism):
    """Return the refusal of a program for the joint speeds in the file of a mechanism that carries
    the part."""
    cell = cells.resolve(
        CellParameters(
            machine="kuka-kr8-r2100-2-arc-hw",
            setup="tool-on-robot",
            branch="auto",
            external=f"{mechanism} at 1400 0 0 0 0 0 carries part",
        ),
        np.eye(4),
    )
    header = build_header(
        cell,
        ProgramParameters(post="kuka", motion="cartesian"),
        catalogue.controller("kuka"),
        "dome",
    )
    return refusal(
        dataclasses.replace(header, blocks=add_positioner(JOB).blocks),
        code="NO_JOINT_SPEED",
        where="cell.external",
    )


def test_the_file_that_lacks_a_joint_speed_is_named(tmp_path):
    """The message names the file of the robot, or of its positioner or track."""
    slow, expected = (
        (*NOMINAL[:5], math.inf),
        json.loads((MECHANISMS / "motoman-motopos-d500.json").read_text(encoding="utf-8")),
    )
    message = refusal(
        dataclasses.replace(JOB, machine="a robot", max_speed=slow),
        code="NO_JOINT_SPEED",
        where="cell.machine",
    )
    assert message.endswith(
        "which the machine file of a robot lacks; add `max_speed` to its joints"
    )
    for lacking, where in ((0, "cell.machine"), (1, "cell.external")):
        speeds = (*slow, 1.0, 1.0) if lacking == 0 else (*NOMINAL, 1.0, math.inf)
        message = refusal(
            add_positioner(
                JOB, max_speed=speeds, axis_machines=("a robot",) * 6 + ("a table",) * 2
            ),
            code="NO_JOINT_SPEED",
            where=where,
        )
        assert f"file of {('a robot', 'a table')[lacking]} lacks" in message
        message = refusal(
            add_positioner(
                JOB, max_speed=speeds, of_urdf=(lacking == 0,) * 6 + (lacking == 1,) * 2
            ),
            code="NO_JOINT_SPEED",
            where=where,
        )
        assert message.endswith("; add `velocity` to the `<limit>` of each of its joints")
    del expected["joints"][1]["max_speed"]
    (tmp_path / "mine.json").write_text(json.dumps({**expected, "id": "mine"}), encoding="utf-8")
    message = _refused_beside(tmp_path / "mine.json")
    assert f"the machine file of {expected['title']} lacks; add `max_speed`" in message
    (tmp_path / "turn.urdf").write_text(
        '<robot name="turn"><link name="foot"/><link name="arm"/><link name="plate"/>'
        '<joint name="tilt" type="revolute"><parent link="foot"/><child link="arm"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        '<joint name="turn" type="revolute"><parent link="arm"/><child link="plate"/><axis xyz="0 0 1"/>'
        '<limit lower="-3" upper="3" effort="1"/></joint></robot>',
        encoding="utf-8",
    )
    message = _refused_beside(tmp_path / "turn.urdf")
    assert message.endswith(
        "of turn tilt - turn lacks; add `velocity` to the `<limit>` of each of its joints"
    )


def test_the_deposit_is_switched_on_the_moves_themselves():
    statements = lines(kuka.write(switch_on_moves(JOB)), "early.src")
    trigger_lines = [n for n, line in enumerate(statements) if line.startswith("TRIGGER")]
    assert [statements[n].partition("DELAY=")[2] for n in trigger_lines] == [
        f"-120 DO $OUT[3]={word}" for word in ("TRUE", "FALSE", "TRUE", "FALSE")
    ]
    # directly before a move with a stop, the last one onto a bead or of it; waits and outputs are
    # nowhere else
    assert [statements[n + 1].split()[0] for n in trigger_lines] == ["PTP", "LIN", "PTP", "LIN"]
    assert all(statements[n + 1].endswith("}") for n in trigger_lines) and not [
        line for line in statements if line.startswith("$OUT")
    ]
    readback = kuka.read(kuka.write(switch_on_moves(JOB)))
    switched = [
        (e.row, e.kind, e.value, round(e.ahead, 9))
        for e in readback.events
        if e.kind in ("on", "off")
    ]
    assert switched == [
        (row, kind, (3.0, "$OUT"), 0.12)
        for row, kind in ((2, "on"), (5, "off"), (6, "on"), (8, "off"))
    ]
    assert readback.deposit.tolist() == kuka.read(kuka.write(JOB)).deposit.tolist()
    assert (
        "TRIGGER"
        not in kuka.write(dataclasses.replace(switch_on_moves(JOB), dry_run=True))[
            "early.src"
        ].decode()
    )
    refusal(
        switch_on_moves(JOB, 0.26), code="TRIGGER_LEAD", where="layer 0 bead 0"
    )  # the last move of the bead takes 0.25 s


HAND = """&ACCESS RVP
&REL 1
DEF hand()
; by hand
BAS(#INITMOV,0)
BAS(#BASE,3)
BAS(#TOOL,5)
$IPO_MODE=#BASE
$ORI_TYPE=#VAR
BAS(#VEL_PTP,25)
PTP {A1 0.5,A2 -90.0,A3 90.0,A4 0.0,A5 -10.0,A6 200.25}
WAIT SEC 0.5
$OUT[7]=TRUE
$VEL.CP=0.0305
$APO.CDIS=0.5
LIN {X 10.0,Y 0.25,Z 5.0,A 30.0,B 20.0,C 10.0} C_DIS
LIN {X 20.5,Y 0.25,Z 5.0,A -170.0,B 0.0,C 179.5}
WAIT FOR $IN[4]==TRUE
$OUT[7]=FALSE
gripper_open()
END
"""


def by_hand(old="", new=""):
    assert not old or old in HAND
    return {"hand.src": HAND.replace(old, new).encode()}


def test_a_module_by_hand():
    readback = kuka.read(by_hand())
    np.testing.assert_allclose(
        np.degrees(readback.joints[0]), [0.5, -90.0, 90.0, 0.0, -10.0, 200.25]
    )
    assert np.isnan(readback.joints[1:]).all() and readback.position[1:].tolist() == [
        [10.0, 0.25, 5.0],
        [20.5, 0.25, 5.0],
    ]
    turned = Rotation.from_euler(
        "ZYX", [[30.0, 20.0, 10.0], [-170.0, 0.0, 179.5]], degrees=True
    ).as_matrix()
    np.testing.assert_allclose(readback.rotation[1:], turned, atol=1e-15)
    assert readback.deposit.tolist() == readback.linear.tolist() == [False, True, True]
    assert readback.stops.tolist() == [True, False, True] and readback.rounding[1] == 0.5
    np.testing.assert_allclose(readback.speed, [np.nan, 30.5, 30.5])
    np.testing.assert_array_equal(readback.share, [0.25, np.nan, np.nan])
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (1, "wait", 0.5),
        (1, "on", 7.0, "$OUT"),
        (3, "input", 4.0),
        (3, "off", 7.0, "$OUT"),
        (3, "call", "GRIPPER_OPEN"),
    ]
    assert readback.user_frame.tolist() == [3.0] * 3 and readback.tool_frame.tolist() == [5.0] * 3


@pytest.mark.parametrize(("old", "new", "why"), [
    ("DEF hand()", "DEF other()", "the routine DEF other() and the file have different names"),
    ("DEF hand()", "GLOBAL DEF hand( )  ; by hand", "one routine of the same name that begins with &ACCESS RVP, &REL 1 and DEF and ends with END: the file has GLOBAL DEF hand( );"), ("DEF hand()", "", "END: the file has no DEF;"),
    ("\nEND\n", "\nEND\nDEF more()\nEND\n", "END: the file has DEF hand(), DEF more();"),
    ("\nEND\n", "\n", "one routine"), ("BAS(#BASE,3)\n", "", "does not set base, tool, speed and rounding"),
    ("$IPO_MODE=#BASE", "$IPO_MODE=#TCP", "not understood"), ("BAS(#VEL_PTP,25)\n", "", "does not set base, tool, speed and rounding"),
    ("VEL_PTP,25", "VEL_PTP,125", "1 to 100"), ("$APO.CDIS=0.5\n", "", "does not set base, tool, speed and rounding"), ("$VEL.CP=0.0305\n", "", "does not set base, tool, speed and rounding"),
    ("WAIT FOR $IN[4]==TRUE\n", "", "ahead of the motion"), ("WAIT SEC 0.5\n", "", "ahead of the motion"),
    ("C 179.5}", "C 179.5} C_DIS", "approximated"), ("$OUT[7]=FALSE", "$OUT[8]=FALSE", "second output"),
    ("gripper_open()", "hand()", "called by no other"), ("gripper_open()", "GOTO x", "not understood"),
    ("WAIT FOR", "TRIGGER WHEN DISTANCE=1 DELAY=-50 DO $OUT[7]=FALSE\nWAIT FOR", "interrupts the lines"),
    ("LIN {X 10.0", "TRIGGER WHEN DISTANCE=1 DELAY=-50 DO $OUT[7]=FALSE\nLIN {X 10.0", "corner is rounded"),
    ("LIN {X 20.5", "TRIGGER WHEN DISTANCE=1 DELAY=-50 DO $OUT[8]=FALSE\nLIN {X 20.5", "second output"),
    ("LIN {X 20.5", "TRIGGER WHEN DISTANCE=1 DELAY=50 DO $OUT[7]=FALSE\nLIN {X 20.5", "ahead of the motion"),
    ("LIN {X 20.5", "TRIGGER WHEN DISTANCE=0 DELAY=-50 DO $OUT[7]=FALSE\nLIN {X 20.5", "ahead of the motion"),
    ("gripper_open()\n", "TRIGGER WHEN DISTANCE=1 DELAY=-50 DO $OUT[7]=TRUE\n", "before its last move"),
    (",A6 200.25", "", "not understood"), ("C 10.0}", "C 10.0,E1 5.0}", "use different external axes"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(old, new, why):
    with pytest.raises(InputError) as raised:
        kuka.read(by_hand(old, new))
    assert raised.value.code == "UNREADABLE_PROGRAM" and why in raised.value.message


@pytest.mark.parametrize(
    "line", ["$VEL.ORI1=200", "FOO()+1", "PTP_REL {A1 5}", "GOTO x", "CONTINUE"]
)
def test_an_unknown_instruction_is_named_as_such_wherever_it_stands(line):
    with pytest.raises(InputError) as raised:
        kuka.read(by_hand("LIN {X 20.5", f"{line}\nLIN {{X 20.5"))
    assert f"the instruction {line!r} is not understood" in raised.value.message
    assert re.search(r"line \d+$", raised.value.where)
