# SPDX-License-Identifier: LGPL-2.1-or-later
"""ABB modules: exact bytes, splitting, times and speeds, refusals, and reading of modules written
by hand."""

import dataclasses
import json
import math
import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.issues import InputError
from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Wait,
    WaitBelow,
    WaitInput,
)
from freecad_am.posts import catalogue
from freecad_am.posts.abb import post as abb
from tests.posts.fanuc_programs import put_tool_on_robot

VARIANTS = [
    ("joint", "part-on-robot"),
    ("cartesian", "part-on-robot"),
    ("cartesian", "tool-on-robot"),
]
NO_AXES = [9e9] * 6


def moves(kind, degrees, duration=0.5, layer=0, bead=0, speed=6.0, **extra):
    degrees = np.atleast_2d(np.asarray(degrees, float))
    duration = np.broadcast_to(np.asarray(duration, float), len(degrees)).copy()
    return Moves(
        kind, layer, bead, np.radians(degrees), duration, np.full(len(degrees), speed), **extra
    )


def program(*blocks, name="part", **options):
    defaults = {
        "continuous": (False,) * 6, "station": (300.0, 0.0, 310.5, 0.0, 0.0, math.pi / 2),
        "carried": (0.0, 0.0, 5.0, 0.0, 0.0, 0.0),
    }  # fmt: skip
    return Program(name, "a machine", blocks, **{**defaults, **options})


def beads(count, points, layers=1, **options):
    """Return beads of `points` points each, each after two rapid moves."""
    blocks = []
    for layer in range(layers):
        blocks.append(LayerStart(layer))
        for bead in range(count):
            value = np.arange(points)[:, None] * 0.1 + np.full(6, 0.1)
            blocks += [moves("rapid", [[1.0] * 6, [0.0] * 6], layer=layer, bead=bead), DepositOn()]
            blocks += [moves("deposit", value, layer=layer, bead=bead), DepositOff()]
    return program(*blocks, **options)


def lines(files, name):
    """Return the statements of a module's routine."""
    text = files[name].decode("ascii").split("\r\n")
    start = next(k for k, line in enumerate(text) if line.startswith("  PROC "))
    return [line.strip() for line in text[start + 1 : text.index("  ENDPROC")]]


def values(line):
    """Return the aggregate that a move goes to."""
    return json.loads(re.match(r"Move\w+ (\[.*\])(?:\\NoEOffs)?,v_am", line)[1])


def declared(files, name, kind):
    """Return the values that a module declares of a type, by name."""
    matches = re.findall(
        rf"^  LOCAL (?:PERS|CONST) {kind} (\w+):=(.*);\r$",
        files[name].decode("ascii"),
        re.MULTILINE,
    )
    return {
        word: json.loads(value.replace("TRUE", "true").replace("FALSE", "false"))
        for word, value in matches
    }


def refusal(source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        abb.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


def assert_modules(files):
    """Assert that modules are plain: every aggregate has the number of values of its type, and
    every name is declared."""
    for file, content in files.items():
        text = content.decode("ascii")
        assert text.count("\n") == text.count("\r\n") and text.endswith("ENDMODULE\r\n")
        assert (
            text.startswith(f"MODULE {file.removesuffix('.mod')}\r\n") and text.count("PROC ") == 1
        )
        tools, objects, speeds, zones = (
            declared(files, file, f"{kind}data") for kind in ("tool", "wobj", "speed", "zone")
        )
        for (on_robot, (_, turn), load), (is_held, fixed, unit, (_, user_turn), inside) in zip(
            tools.values(), objects.values()
        ):
            assert (
                on_robot is not is_held
                and fixed is (unit == "")
                and (inside if fixed else user_turn)
                == ([[0, 0, 0], [1, 0, 0, 0]] if fixed else [1, 0, 0, 0])
            )
            assert (f"ActUnit {unit};" in lines(files, file)) is not fixed
            assert load[0] > 0.0 and [len(load[1]), len(load[2]), len(load)] == [3, 4, 6]
            assert (
                np.linalg.norm(turn)
                == pytest.approx(1.0, abs=1e-6)
                == pytest.approx(np.linalg.norm(user_turn), abs=1e-6)
            )
        assert all(len(value) == 4 for value in speeds.values()) and all(
            len(value) == 7 for value in zones.values()
        )
        used = set()
        for line in lines(files, file):
            if line.startswith("Move"):
                target = values(line)
                joint = line.startswith("MoveAbsJ ")
                on_track = fixed and file == "rail.mod"
                part_count = 4 if file.startswith("both") else 3
                beside_it = (
                    [*target[-1][:2], *target[-1][3:], NO_AXES[0]]
                    if on_track
                    else (
                        target[-1]
                        if fixed
                        else [target[-1][0], *target[-1][part_count:], *NO_AXES[: part_count - 1]]
                    )
                )
                assert [len(component) for component in target] == (
                    [6, 6] if joint else [3, 4, 4, 6]
                ) and beside_it == NO_AXES
                assert joint or abs(np.linalg.norm(target[1]) - 1.0) < 1e-6
                speed, zone, tool, work_object = re.fullmatch(
                    r".*\],?(?:\\NoEOffs,)?(\w+)\\[TV]:=[\d.]+,(\w+),(\w+)\\WObj:=(\w+);", line
                ).groups()
                assert (
                    speed in speeds
                    and tool in tools
                    and work_object in objects
                    and (zone == "fine" or zone in zones)
                )
                used.add(zone)
            else:
                assert re.fullmatch(
                    r"!.*|Conf[LJ]\\Off;|SingArea\\Off;|ActUnit \w+;|SetDO do\d+,[01];|WaitTime \d+\.\d{3};|WaitDI di\d+,1;|"
                    r'WaitAI ai\d+,\\LT,-?\d+\.\d+;|Load \\Dynamic,"HOME:/\w+\.mod";|%"\w+_p"%;|UnLoad "HOME:/\w+\.mod";|'
                    r"[A-Za-z]\w*;",
                    line,
                ), line
        assert used - {"fine"} == set(zones)


JOINT = program(
    LayerStart(0),
    moves("rapid", [[0.0, -30.0, 120.0, 0.0, 60.0, 170.0], [1.25, -29.5, 120.25, 0.1, 60.5, 175.0]], [10.0, 0.8]),
    DepositOn(0.5),
    moves("deposit", [[1.25, -29.5, 120.25, 0.1, 60.5, 176.0], [1.25, -29.5, 120.3, 0.1, 60.5, 177.4]], [0.2, 0.25]),
    DepositOff(0.25),
    Wait(12.5), WaitInput(3), WaitBelow(2, 1.25, 1, 0), Call("clean"),
    LayerStart(1),
    moves("rapid", [[0.0, -30.0, 120.0, 0.0, 60.0, 177.4]], 1.0, layer=1),
    name="Joint", remarks=('A remark ]]> with "marks": Größe',), deposit_output=3,
)  # fmt: skip

TURNED = np.array(
    [
        [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],
    ]
)


def straight_bead(layer):
    positions = np.array([[10.0, 0.25, 105.0], [12.0, 0.25, 105.0 + layer], [14.0, 0.5, 105.0]])
    joints = [[0.5 * layer, -30.0, 120.0, 0.0, 60.0, 10.0 * n] for n in range(3)]
    return [
        LayerStart(layer),
        moves(
            "rapid",
            [joints[0], joints[0]],
            layer=layer,
            position=positions[:2],
            rotation=TURNED[:2],
        ),
        DepositOn(),
        moves(
            "deposit",
            joints,
            [0.3, 0.4, 0.5],
            layer=layer,
            speed=5.0,
            position=positions,
            rotation=TURNED,
            interpolation="linear",
        ),
        DepositOff(),
    ]


HELD_PART = program(
    *straight_bead(0), *straight_bead(1), name="held", motion="cartesian", max_points=8, blend=50
)


def add_positioner(source, **changes):
    """Return the program with the tool on the robot and two external axes that tilt by 30 deg and
    turn further with every move."""
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
            "setup": "tool-on-robot",
            "external_kinds": ("rotary", "rotary"),
            "unit": "STN1",
            "first_external": 2,
            "station": (0, 0, 20, 0, 0, 0),
            **changes,
        },
    )


def put_on_track(source, **changes):
    """Return the program with the robot on a track, written as eax_c, that advances by 12.5 mm with
    every move."""
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
            "setup": "tool-on-robot",
            "external_kinds": ("linear",),
            "unit": "",
            "first_external": 3,
            "station": (1200, 0, 20, 0, 0, 0),
            **changes,
        },
    )


def put_on_track_with_positioner(source, **changes):
    """Return the program on a track as eax_c with a positioner whose axes are eax_b and eax_d."""
    source = add_positioner(source)
    blocks, count = [], 0
    for block in source.blocks:
        if isinstance(block, Moves):
            slid = 12.5 * (count + np.arange(len(block))) - 900.125
            count, block = (
                count + len(block),
                dataclasses.replace(block, joints=np.insert(block.joints, 7, slid, axis=1)),
            )
        blocks.append(block)
    return dataclasses.replace(
        source,
        blocks=tuple(blocks),
        **{
            "name": "both",
            "continuous": (False,) * 9,
            "external_kinds": ("rotary", "linear", "rotary"),
            **changes,
        },
    )


GOLDENS = {
    "joint": JOINT,
    "held": HELD_PART,
    "positioner": add_positioner(HELD_PART),
    "track": put_on_track(HELD_PART, max_points=2000),
    "track-joint": put_on_track(JOINT),
    "both": put_on_track_with_positioner(HELD_PART),
    "tool-joint": put_tool_on_robot(JOINT),
    "tool": put_tool_on_robot(HELD_PART),
    "positioner-joint": add_positioner(JOINT),
    "both-joint": put_on_track_with_positioner(JOINT),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_modules_to_the_byte(root, name):
    files = abb.write(GOLDENS[name])
    folder = root / "tests/golden/abb" / name
    assert files == {path.name: path.read_bytes() for path in folder.iterdir()}
    assert_modules(files)


def test_a_part_on_a_positioner_is_a_work_object_that_its_unit_moves():
    for source in (
        add_positioner(HELD_PART),
        add_positioner(JOINT),
        add_positioner(HELD_PART, max_points=2000),
    ):
        files, run = abb.write(source), source.moves
        readback, joints = abb.read(files), np.concatenate([moves.joints for moves in run])
        np.testing.assert_allclose(readback.joints[:, 6:], joints[:, 6:], rtol=0.0, atol=1e-6)
        assert (readback.unit, readback.first_external) == ("STN1", 2) and np.isnan(
            readback.joints[readback.linear, :6]
        ).all()
        for file in files:
            if "Move" in files[file].decode():
                ((is_held, fixed, unit, user, inside),) = declared(files, file, "wobjdata").values()
                assert (is_held, fixed, unit, user) == (
                    False,
                    False,
                    "STN1",
                    [[0, 0, 0], [1, 0, 0, 0]],
                )
                assert inside == [[0, 0, 20], [1, 0, 0, 0]]
                turned = [
                    values(line)[-1] for line in lines(files, file) if line.startswith("Move")
                ]
                assert all(
                    row[0] == row[3] == 9e9 and row[1] == 30.0 and row[2] < 360.0 for row in turned
                )
    refusal(
        add_positioner(JOINT, first_external=6), code="UNSUPPORTED_AXES", where="program.axes.first"
    )
    for unit in ("", "1", "my unit"):
        refusal(
            add_positioner(JOINT, unit=unit), code="UNSUPPORTED_AXES", where="program.axes.unit"
        )


def test_a_track_carries_the_robot_and_the_work_object_stands():
    for source in (
        put_on_track(HELD_PART),
        put_on_track(JOINT),
        put_on_track(HELD_PART, unit="TRACK_1"),
    ):
        files, run = abb.write(source), source.moves
        readback, joints = abb.read(files), np.concatenate([moves.joints for moves in run])
        assert np.array_equal(readback.joints[:, 6], joints[:, 6])  # mm stay unchanged
        np.testing.assert_allclose(
            readback.joints[~readback.linear, :6], joints[~readback.linear, :6], rtol=0.0, atol=1e-6
        )
        assert (readback.unit, readback.first_external, readback.linear_digits) == (
            source.unit,
            3,
            0.00005,
        )
        for file in files:
            if "Move" in files[file].decode():
                ((is_held, fixed, unit, user, _),) = declared(files, file, "wobjdata").values()
                assert (is_held, fixed, unit, user[0]) == (False, True, "", [1200, 0, 20])
                assert ("ActUnit TRACK_1;" in lines(files, file)) is bool(source.unit)
                slid = [values(line)[-1] for line in lines(files, file) if line.startswith("Move")]
                assert all(row[:2] == [9e9] * 2 and row[3:] == [9e9] * 3 for row in slid)
                assert np.allclose(np.diff([row[2] for row in slid]), 12.5)
    refusal(
        put_on_track(JOINT, first_external=7), code="UNSUPPORTED_AXES", where="program.axes.first"
    )
    refusal(put_on_track(JOINT, unit="my unit"), code="UNSUPPORTED_AXES", where="program.axes.unit")


def test_a_track_and_a_positioner_are_told_together():
    for source in (put_on_track_with_positioner(HELD_PART), put_on_track_with_positioner(JOINT)):
        files, joints = abb.write(source), np.concatenate([moves.joints for moves in source.moves])
        readback = abb.read(files)
        assert np.array_equal(readback.joints[:, 7], joints[:, 7])  # mm stay unchanged
        np.testing.assert_allclose(
            readback.joints[:, [6, 8]], joints[:, [6, 8]], rtol=0.0, atol=1e-6
        )
        assert (readback.unit, readback.first_external, readback.linear_digits) == (
            "STN1",
            2,
            0.00005,
        )
        main = files["both.mod"].decode()
        assert "! eax_c is the track in mm" in main and "w_am is on the face of STN1" in main
        for file in files:
            if "Move" in files[file].decode():
                ((_, fixed, unit, user, _),) = declared(files, file, "wobjdata").values()
                assert (fixed, unit, user) == (False, "STN1", [[0, 0, 0], [1, 0, 0, 0]])
        for old, new in (
            ("! eax_c is the track", "! eax_e is the track"),
            ("ActUnit STN1;", "ActUnit STN2;"),
        ):
            name = next(file for file in files if old in files[file].decode())
            with pytest.raises(InputError):
                abb.read({**files, name: files[name].replace(old.encode(), new.encode())})
    refusal(
        put_on_track_with_positioner(JOINT, first_external=5),
        code="UNSUPPORTED_AXES",
        where="program.axes.first",
    )
    refusal(
        put_on_track_with_positioner(JOINT, unit=""),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )


def test_a_part_that_is_held_is_a_work_object_and_the_nozzle_a_tool_that_stands():
    files = abb.write(dataclasses.replace(HELD_PART, max_points=20))
    half = math.sqrt(0.5)
    (tool,), (work_object,) = (
        declared(files, "held.mod", f"{kind}data").values() for kind in ("tool", "wobj")
    )
    assert tool[0] is False and tool[1] == [
        [300.0, 0.0, 310.5],
        pytest.approx([half, 0, 0, half], abs=1e-7),
    ]
    assert work_object[0] is True and work_object[3] == [[0.0, 0.0, 5.0], [1.0, 0.0, 0.0, 0.0]]
    targets = [values(line) for line in lines(files, "held.mod") if line.startswith("MoveL")][:3]
    assert [target[0] for target in targets] == [
        [10.0, 0.25, 105.0],
        [12.0, 0.25, 105.0],
        [14.0, 0.5, 105.0],
    ]
    assert [target[1] for target in targets] == [
        [1, 0, 0, 0],
        pytest.approx([half, 0, 0, half], abs=1e-7),
        [0, 0, 1, 0],
    ]
    tool_on_robot = abb.write(dataclasses.replace(HELD_PART, max_points=20, setup="tool-on-robot"))
    (tool,), (fixed,) = (
        declared(tool_on_robot, "held.mod", f"{kind}data").values() for kind in ("tool", "wobj")
    )
    assert (
        tool[0] is True
        and tool[1][0] == [0.0, 0.0, 5.0]
        and fixed[0] is False
        and fixed[3][0] == [300.0, 0.0, 310.5]
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("motion", "setup"), VARIANTS)
def test_random_programs_come_back_to_their_digits(random_application, seed, motion, setup):
    source = random_application(seed, motion, setup, max_points=60)
    files = abb.write(source)
    assert_modules(files)
    readback, run = abb.read(files), list(source.moves)
    joints = np.concatenate([moves_.joints for moves_ in run])
    straight = np.concatenate(
        [np.full(len(moves_), moves_.interpolation == "linear") for moves_ in run]
    )
    np.testing.assert_array_equal(readback.linear, straight)
    np.testing.assert_allclose(
        readback.joints[~straight], joints[~straight], rtol=0.0, atol=readback.digits + 1e-12
    )
    assert np.degrees(readback.digits) == pytest.approx(0.00005)
    np.testing.assert_allclose(
        readback.duration[~straight],
        np.concatenate([moves_.duration for moves_ in run])[~straight],
        rtol=0.0,
        atol=5.1e-6,
    )
    np.testing.assert_array_equal(
        readback.stops,
        np.concatenate(
            [
                moves_.stops
                | (moves_.kind == "deposit")
                & (0.005 * source.blend * min(moves_.speed * moves_.duration) < 0.001)
                for moves_ in run
            ]
        ),
    )
    wet = np.concatenate([np.full(len(moves_), moves_.kind == "deposit") for moves_ in run])
    np.testing.assert_array_equal(readback.deposit, wet)
    if motion == "cartesian":
        positions, turn = (
            np.concatenate([getattr(moves_, name) for moves_ in run])[straight]
            for name in ("position", "rotation")
        )
        frame, carried = (np.eye(4), np.eye(4))
        for pose, six in ((frame, source.station), (carried, source.carried)):
            pose[:3, :3], pose[:3, 3] = Rotation.from_euler("XYZ", six[3:]).as_matrix(), six[:3]
        target = np.tile(np.eye(4), (len(positions), 1, 1))
        target[:, :3, :3], target[:, :3, 3] = turn, positions
        if setup == "part-on-robot":
            target = np.linalg.inv(target)
        flange_poses = np.tile(np.eye(4), (len(positions), 1, 1))
        flange_poses[:, :3, :3], flange_poses[:, :3, 3] = (
            readback.rotation[straight],
            readback.position[straight],
        )
        # the commanded flange pose
        expected, driven = (
            a @ b @ np.linalg.inv(c)
            for a, b, c in (
                (frame, target, carried),
                (readback.frame, flange_poses, readback.tool[straight]),
            )
        )
        np.testing.assert_allclose(driven, expected, rtol=0.0, atol=4e-3)
        np.testing.assert_allclose(driven[:, :3, :3], expected[:, :3, :3], rtol=0.0, atol=1e-6)
        assert readback.held == (setup == "part-on-robot")


def test_same_program_same_bytes_and_parts_are_the_program(random_application):
    for motion, setup in VARIANTS:
        part_files = abb.write(random_application(2, motion, setup, max_points=50))
        assert (
            part_files == abb.write(random_application(2, motion, setup, max_points=50))
            and len(part_files) > 3
        )
        complete, cut = (
            abb.read(abb.write(random_application(2, motion, setup, max_points=10**5))),
            abb.read(part_files),
        )
        for field in (
            candidate for candidate in dataclasses.fields(complete) if candidate.name != "lines"
        ):
            if field.name in (
                "rotation",
                "position",
            ):  # products may differ in their last bit, depending on their address in memory
                np.testing.assert_equal(
                    getattr(cut, field.name) is None, getattr(complete, field.name) is None
                )
                if getattr(cut, field.name) is not None:
                    np.testing.assert_allclose(
                        getattr(cut, field.name),
                        getattr(complete, field.name),
                        rtol=0.0,
                        atol=1e-11,
                    )
            else:
                np.testing.assert_array_equal(
                    getattr(cut, field.name), getattr(complete, field.name), field.name
                )


def test_a_dry_run_moves_the_same_and_switches_nothing(random_application):
    wet = random_application(5, max_points=10**4)
    files, dry = abb.write(wet), abb.write(dataclasses.replace(wet, dry_run=True))
    assert (
        not any(b"SetDO" in content for content in dry.values())
        and b"! dry run: no deposit" in dry["Random.mod"]
    )
    moving = [
        [line for line in lines(f, "Random.mod") if line.startswith("Move")] for f in (files, dry)
    ]
    assert moving[0] == moving[1] and len(moving[0]) > 10


def test_times_and_corners():
    moves_ = [line for line in lines(abb.write(JOINT), "Joint.mod") if line.startswith("Move")]
    assert [re.search(r"\\T:=([\d.]+),(\w+),", line).groups() for line in moves_] == [
        ("10.00000", "fine"), ("0.80000", "fine"), ("0.20000", "z_am1"), ("0.25000", "fine"), ("1.00000", "fine"),
    ]  # fmt: skip
    for blend, size in ((0, None), (50, 0.3), (100, 0.6)):  # the shorter move is 1.2 mm long
        zones = declared(
            abb.write(dataclasses.replace(JOINT, blend=blend)), "Joint.mod", "zonedata"
        )
        assert zones == (
            {}
            if size is None
            else {"z_am1": [False, size, size, size, size / 10.0, size, size / 10.0]}
        )
    fast = program(
        moves("rapid", np.zeros(6)), moves("deposit", np.ones(6), 0.00004, layer=2, bead=1)
    )
    assert "takes 0.00004 s" in refusal(fast, code="MOVE_TIME", where="layer 2 bead 1")
    for speed in (0.004, 1e6, np.nan):
        blocks = (
            dataclasses.replace(b, speed=np.full(len(b), speed)) if isinstance(b, Moves) else b
            for b in HELD_PART.blocks
        )
        refusal(
            dataclasses.replace(HELD_PART, blocks=tuple(blocks)),
            code="MOVE_SPEED",
            where="layer 0 bead 0",
        )


def test_parts_hold_whole_beads_are_loaded_away_from_them_and_their_sum_is_told():
    files = abb.write(beads(3, 20, layers=2, max_points=50))
    assert_modules(files)
    assert lines(files, "part.mod")[:3] == [
        'Load \\Dynamic,"HOME:/part01.mod";',
        '%"part01_p"%;',
        'UnLoad "HOME:/part01.mod";',
    ]
    total = sum(len(content) for name, content in files.items() if name != "part.mod")
    assert f"  ! 3 parts of {total} bytes in all".encode() in files["part.mod"]
    for number in (1, 2, 3):
        statements = lines(files, f"part{number:02d}.mod")
        assert statements.count("SetDO do1,1;") == statements.count("SetDO do1,0;") == 2
        last_move = max(n for n, line in enumerate(statements) if line.startswith("Move"))
        assert (
            last_move > statements[::-1].index("SetDO do1,0;") and statements[-1].startswith("Move")
        ) == (number < 3)
        assert sum(line.startswith("Move") for line in statements) == (45, 44, 43)[number - 1]
    message = refusal(
        beads(2, 25, max_points=20, layers=2), code="BEAD_TOO_LONG", where="program.max_points"
    )
    assert "layer 0 bead 0 has 27 points" in message and message.endswith("use at least 28")
    abb.write(beads(2, 25, max_points=28, layers=2))


def test_of_beads_too_long_for_a_part_the_longest_is_named():
    """Of beads that are too long for a part, the error names the longest, and the limit that it
    states is enough."""
    blocks = [block for points in (22, 40, 31) for block in beads(1, points).blocks]
    too_long = dataclasses.replace(beads(1, 22, max_points=20), blocks=tuple(blocks))
    enough = int(
        refusal(too_long, code="BEAD_TOO_LONG", where="program.max_points").rsplit(" ", 1)[1]
    )
    assert enough > 40
    abb.write(dataclasses.replace(too_long, max_points=enough))


@pytest.mark.parametrize(("name", "why", "proposal"), [
    ("", "empty", "am"), ("my part", "letters", "my_part"), ("2nd", "start with a letter", "am_2nd"),
    ("x" * 15, "14 characters", "x" * 10), ("con", "reserved", "am_con"), ("endFor", "reserved", "am_endFor"),
    ("Main", "reserved", "am_Main"), ("T_am", "reserved", "am_T_am"),
])  # fmt: skip
def test_names_the_controller_refuses(name, why, proposal):
    message = refusal(dataclasses.replace(JOINT, name=name), code="PROGRAM_NAME", where="name")
    assert why in message and message.endswith(f"use {proposal!r}")
    abb.write(dataclasses.replace(JOINT, name=proposal))


def test_what_cannot_be_said_is_refused():
    still, where = program(moves("rapid", np.ones(6))), "process.between_layers.call"
    refusal(
        dataclasses.replace(still, setup="rotary-table"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    continuous = dataclasses.replace(still, continuous=(False,) * 5 + (True,))
    assert "axis 6" in refusal(continuous, code="ENDLESS_AXIS", where="cell.limits")
    refusal(
        dataclasses.replace(HELD_PART, station=None), code="NO_POSITIONS", where="program.motion"
    )
    refusal(program(LayerStart(0)), code="NOTHING_TO_WRITE")
    refusal(program(moves("rapid", [0, 0, 0, np.nan, 0, 0])), code="UNREACHABLE")
    refusal(program(moves("rapid", np.ones(5))), code="UNSUPPORTED_AXES", where="program.post")
    wire = program(
        moves("rapid", np.ones(6)), moves("deposit", np.ones(6) * 2, wire=np.array([10.0]))
    )
    assert "TriggSpeed" in refusal(wire, code="NO_WIRE_OUTPUT")
    for called in ("Part", "two words", "main"):
        refusal(program(moves("rapid", np.ones(6)), Call(called)), code="PROGRAM_NAME", where=where)
    refusal(beads(3, 20, max_points=25, name="x" * 13), code="PROGRAM_NAME", where="name")
    refusal(
        program(*beads(3, 20).blocks, Call("PART02_p"), max_points=25),
        code="PROGRAM_NAME",
        where=where,
    )
    abb.write(program(moves("rapid", np.ones(6)), Call("party")))
    assert catalogue.load("abb") is abb


# modules by hand

HAND = """MODULE hand
  ! by hand
  LOCAL PERS tooldata nozzle:=[TRUE,[[1,2,250],[0.7071068,0,0.7071068,0]],[5,[0,0,100],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata plate:=[FALSE,TRUE,"",[[1200,0,300],[0,0,0,1]],[[10,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata slow:=[50,500,5000,1000];
  LOCAL CONST zonedata near:=[FALSE,0.3,0.3,0.3,0.03,0.3,0.03];
  PROC main()
    ConfL\\Off;
    MoveAbsJ [[1.5,-30.0,20.0,0.0,45.0,-190.5],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,slow\\T:=10.0,fine,nozzle\\WObj:=plate;
    SetDO do7,1;
    WaitTime 0.25;
    MoveL [[20.5,0.25,5.0],[0.0,0.0,1.0,0.0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],slow\\V:=30.5,near,nozzle\\WObj:=plate;
    MoveL [[21.5,0.25,5.0],[0.6,0.0,0.8,0.0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],slow\\V:=30.5,fine,nozzle\\WObj:=plate;
    SetDO do7,0;
    gripper_open;
  ENDPROC
ENDMODULE
"""


def by_hand(old="", new=""):
    assert not old or old in HAND
    return {"hand.mod": HAND.replace(old, new).encode()}


def test_a_module_by_hand():
    readback = abb.read(by_hand())
    np.testing.assert_allclose(
        np.degrees(readback.joints[0]), [1.5, -30.0, 20.0, 0.0, 45.0, -190.5]
    )
    assert np.isnan(readback.joints[1:]).all() and readback.position[1:].tolist() == [
        [20.5, 0.25, 5.0],
        [21.5, 0.25, 5.0],
    ]
    turned = Rotation.from_quat([[0.0, 1.0, 0.0, 0.0], [0.0, 0.8, 0.0, 0.6]]).as_matrix()
    np.testing.assert_allclose(readback.rotation[1:], turned, atol=1e-15)
    # the work object is rotated by 180 deg about Z, so its X 10 is at X 1190
    np.testing.assert_allclose(
        readback.frame, [[-1, 0, 0, 1190], [0, -1, 0, 0], [0, 0, 1, 300], [0, 0, 0, 1]], atol=1e-12
    )
    np.testing.assert_allclose(
        readback.tool[2], [[0, 0, 1, 1], [0, 1, 0, 2], [-1, 0, 0, 250], [0, 0, 0, 1]], atol=1e-12
    )
    assert (
        readback.deposit.tolist() == readback.linear.tolist() == [False, True, True]
        and not readback.held
    )
    assert readback.stops.tolist() == [True, False, True] and readback.rounding[1] == 0.3
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (1, "on", 7.0, "do"),
        (1, "wait", 0.25),
        (3, "off", 7.0, "do"),
        (3, "call", "GRIPPER_OPEN"),
    ]
    np.testing.assert_array_equal(readback.speed, [np.nan, 30.5, 30.5])
    np.testing.assert_array_equal(readback.duration, [10.0, np.nan, np.nan])


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("MODULE hand", "MODULE other", "called other"),
        ("ENDMODULE\n", "ENDMODULE\nx\n", "one routine"),
        ("slow:=[50,500", "slow:=[50,50", "value of slow"),
        ("0.3,0.3,0.3,0.03", "0.3,0.3,30,0.03", "value of near"),
        ("LOCAL PERS tooldata", "PERS tooldata", "not understood"),
        ('[FALSE,TRUE,""', '[FALSE,FALSE,"STN1"', "value of plate"),
        ('[FALSE,TRUE,""', '[TRUE,TRUE,""', "either the tool or the work object"),
        ("0.7071068,0]]", "0.8,0]]", "value of nozzle"),
        ("0.6,0.0,0.8,0.0", "0.6,0.0,0.7,0.0", "unit quaternion"),
        ("ConfL\\Off", "ConfL\\On", "not understood"),
        ("    ConfL\\Off;\n", "", "configuration supervision"),
        ("near,nozzle", "z50,nozzle", "does not define the zone"),
        ("SetDO do7,0", "SetDO do8,0", "second output"),
        ("V:=30.5,fine", "V:=30.5,near", "before the previous move ends"),
        ("gripper_open;", "main;", "not loaded"),
        ("gripper_open;", "MoveJ x,y;", "not understood"),
        ("slow\\V:=30.5", "slow\\T:=30.5", "other than"),
        ("gripper_open;", "GOTO start;", "not understood"),
        ("9E9]]\\NoEOffs", "0]]\\NoEOffs", "not understood"),
    ],
)
def test_what_is_not_understood_is_refused(old, new, why):
    with pytest.raises(InputError) as raised:
        abb.read(by_hand(old, new))
    assert raised.value.code == "UNREADABLE_PROGRAM" and why in raised.value.message
