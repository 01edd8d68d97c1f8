# SPDX-License-Identifier: LGPL-2.1-or-later
"""FANUC listings: exact bytes, times, turns and parts."""

import dataclasses
import re
import subprocess
import sys

import numpy as np
import pytest

from freecad_am.core.program import Call, DepositOff, DepositOn, LayerStart, Moves, Wait, WaitInput
from freecad_am.posts.fanuc import post as fanuc
from tests.posts.fanuc_programs import (
    GOLDEN_JOINT,
    GOLDEN_TABLE,
    beads,
    moves,
    program,
    put_tool_on_robot,
    refusal,
)


def body(content):
    text = content.decode("ascii")
    return [
        line[5:] for line in text[text.index("/MN") + 5 : text.index("/POS")].split("\r\n")[:-1]
    ]


GOLDENS = {
    "joint": GOLDEN_JOINT,
    "table": GOLDEN_TABLE,
    "parts": beads(1, 12, layers=2, name="parts", max_points=10),
    "tool": put_tool_on_robot(GOLDEN_JOINT),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_programs_to_the_byte(root, name, assert_listings):
    files = fanuc.write(GOLDENS[name])
    golden = {
        path.name: path.read_bytes() for path in (root / "tests/golden").glob(f"{name.upper()}*.LS")
    }
    assert files == golden
    assert_listings(files)


def add_second_group(source, **changes):
    """Return the program with two axes of another motion group, which tilt by 30 deg and turn
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
            "name": "groups",
            "continuous": (False,) * 8,
            "setup": "tool-on-robot",
            "external_kinds": ("rotary", "rotary"),
            "unit": "2",
            **changes,
        },
    )


def test_a_positioner_is_a_second_motion_group(root):
    source = add_second_group(beads(1, 12, layers=2, max_points=20))
    files = fanuc.write(source)
    assert files == {
        path.name: path.read_bytes() for path in (root / "tests/golden/fanuc").glob("GROUPS*.LS")
    }
    readback, joints = fanuc.read(files), np.concatenate([moves.joints for moves in source.moves])
    np.testing.assert_allclose(readback.joints, joints, rtol=0.0, atol=np.radians(5.1e-4))
    assert readback.unit == "2" and readback.position is None
    assert all(b"DEFAULT_GROUP\t= 1,1,*,*,*;" in content for content in files.values())
    text = fanuc.write(add_second_group(GOLDEN_JOINT, unit="4"))["GROUPS.LS"].decode()
    assert "= 1,*,*,1,*;" in text and text.count(
        "   GP4:\r\n\tUF : 1, UT : 1,\t\r\n\tJ1=    30.000 deg,\tJ2="
    ) == len(re.findall(r"^P\[", text, re.MULTILINE))
    assert "COORD" in refusal(
        dataclasses.replace(source, motion="cartesian"),
        code="COORDINATED_MOTION",
        where="program.motion",
    )
    refusal(
        dataclasses.replace(source, first_external=2),
        code="UNSUPPORTED_AXES",
        where="program.axes.first",
    )
    for unit in ("1", "6", "STN1"):
        refusal(
            dataclasses.replace(source, unit=unit),
            code="UNSUPPORTED_AXES",
            where="program.axes.unit",
        )


def put_on_track(source, axis_index=0, **changes):
    """Return the program with the robot on a track that advances by 12.5 mm with every move;
    `axis_index` counts its axis from the robot's."""
    count, blocks = 0, []
    for block in source.blocks:
        if isinstance(block, Moves):
            track_positions = 12.5 * (count + np.arange(len(block))) - 900.125
            count += len(block)
            block = dataclasses.replace(
                block, joints=np.insert(block.joints, 6 + axis_index, track_positions, axis=1)
            )
        blocks.append(block)
    kinds = [*source.external_kinds]
    kinds.insert(axis_index, "linear")
    return dataclasses.replace(
        source,
        blocks=tuple(blocks),
        **{
            "name": "rail",
            "continuous": (False,) * (7 + len(source.external_kinds)),
            "setup": "tool-on-robot",
            "external_kinds": tuple(kinds),
            **changes,
        },
    )


def test_a_track_is_an_axis_of_the_robots_own_group(root):
    grouped = add_second_group(beads(1, 12, layers=2, max_points=20))
    for source, group in (
        (put_on_track(GOLDEN_JOINT), "1"),
        (put_on_track(grouped, axis_index=2, name="railgrp"), "2"),
        (put_on_track(grouped, axis_index=1), "2"),
    ):
        files = fanuc.write(source)
        readback, joints = (
            fanuc.read(files),
            np.concatenate([moves.joints for moves in source.moves]),
        )
        slides = np.array([*(False,) * 6, *(kind == "linear" for kind in source.external_kinds)])
        # mm stay unchanged
        np.testing.assert_array_equal(readback.joints[:, slides], joints[:, slides])
        np.testing.assert_allclose(
            readback.joints[:, ~slides], joints[:, ~slides], rtol=0.0, atol=np.radians(5.1e-4)
        )
        assert (readback.unit, readback.linear_digits) == (group if group != "1" else "", 0.0005)
        for content in files.values():
            text = content.decode()
            records = text[text.index("/POS") :].split("};")[:-1]
            # the form in a controller's records: after the last angle, blank before mm, in the
            # first group
            matches = [
                re.search(r" deg,\r\n\tE1=(.{10})  mm\r\n(?:   GP2:\r\n|$)", record)
                for record in records
            ]
            assert all(matches) and np.allclose(
                np.diff([float(match[1]) for match in matches]), 12.5
            )
            assert f"DEFAULT_GROUP\t= {'1,1' if group == '2' else '1,*'},*,*,*;" in text
    files = fanuc.write(put_on_track(GOLDEN_JOINT)) | fanuc.write(
        put_on_track(grouped, axis_index=2, name="railgrp")
    )
    assert files == {
        path.name: path.read_bytes() for path in (root / "tests/golden/fanuc").glob("RAIL*.LS")
    }
    on_rail = dataclasses.replace(put_on_track(GOLDEN_JOINT), motion="cartesian")
    assert "rail" in refusal(on_rail, code="COORDINATED_MOTION", where="program.motion")
    refusal(
        put_on_track(GOLDEN_JOINT, unit="2"), code="UNSUPPORTED_AXES", where="program.axes.unit"
    )
    refusal(put_on_track(grouped, unit=""), code="UNSUPPORTED_AXES", where="program.axes.unit")


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_random_programs_are_as_controllers_write_them(
    random_program, assert_listings, seed, motion
):
    assert_listings(fanuc.write(random_program(seed, motion)))


def test_same_program_same_bytes_and_no_clock(random_program):
    assert fanuc.write(random_program(3)) == fanuc.write(random_program(3))
    assert b"DATE 00-01-01  TIME 00:00:00" in fanuc.write(random_program(3))["RANDOM.LS"]


def test_a_locale_with_decimal_commas_changes_nothing(tmp_path, root):
    source = tmp_path / "comma"
    source.write_text(
        'comment_char %\nescape_char /\nLC_NUMERIC\ndecimal_point "<U002C>"\n'
        'thousands_sep "<U002E>"\ngrouping 3;3\nEND LC_NUMERIC\n'
    )
    process = subprocess.run(
        ["localedef", "-c", "-i", source, "-f", "UTF-8", tmp_path / "comma.utf8"],
        capture_output=True,
    )
    if not (tmp_path / "comma.utf8/LC_NUMERIC").exists():
        pytest.skip(f"no locale with decimal commas can be made here: {process.stderr[-200:]!r}")
    code = (
        "import locale, importlib.util as u, sys; locale.setlocale(locale.LC_NUMERIC, 'comma.utf8');"
        "assert locale.str(0.5) == '0,5', locale.str(0.5);"
        "sys.path.insert(0, sys.argv[1]); s = u.spec_from_file_location('t', sys.argv[2]); t = u.module_from_spec(s);"
        "s.loader.exec_module(t); f = t.fanuc.write(t.GOLDEN_JOINT); r = t.fanuc.read(f);"
        "sys.stdout.buffer.write(f['JOINT.LS'])"
    )
    command = [sys.executable, "-c", code, str(root), __file__]
    environment = {
        "LOCPATH": str(tmp_path),
        "PATH": "/usr/bin:/bin",
        "PYTHONPATH": ":".join(sys.path),
    }
    result = subprocess.run(command, capture_output=True, env=environment)
    assert result.returncode == 0, result.stderr[-500:]
    assert result.stdout == fanuc.write(GOLDEN_JOINT)["JOINT.LS"]


# ---- times


def written_times(content):
    """Return the times of all moves but the first, in ms."""
    matches = re.findall(r"J P\[\d+\] ([\d.]+)(msec|sec|%)", content.decode("ascii"))
    return [float(value) * {"msec": 1, "sec": 1000, "%": 0}[unit] for value, unit in matches][1:]


@pytest.mark.parametrize("seed", range(20))
def test_milliseconds_add_up_over_a_bead_and_none_is_zero(seed):
    rng = np.random.default_rng(seed)
    duration = rng.exponential(0.003, 500) if seed % 2 else rng.uniform(0.001, 0.4, 500)
    file = fanuc.write(
        program(moves("rapid", np.zeros(6)), moves("deposit", np.zeros((500, 6)), duration))
    )["PART.LS"]
    times = np.array(written_times(file))
    assert times.min() >= 1.0 and abs(times.sum() - 1000.0 * duration.sum()) <= 0.5 + 1e-9
    if not seed % 2:  # no move is too short, so every partial sum is right
        assert np.abs(np.cumsum(times) - 1000.0 * np.cumsum(duration)).max() <= 0.5 + 1e-9


def test_long_moves_are_in_tenths_of_a_second_and_leave_the_others_alone():
    duration = [0.1, 32.0, 32.0004, 32.0006, 0.1, 3200.0]
    file = fanuc.write(
        program(moves("rapid", np.zeros(6)), moves("deposit", np.zeros((6, 6)), duration))
    )["PART.LS"]
    words = re.findall(r"\] (\S+) (?:CNT|FINE)", "\n".join(body(file)))[1:]
    assert words == ["100msec", "32000msec", "32000msec", "32.0sec", "100msec", "3200.0sec"]


def test_times_that_cannot_be_written_are_refused():
    start = moves("rapid", np.zeros(6))
    message = refusal(
        program(start, moves("deposit", np.zeros((2, 6)), [1.0, 3201.0], 4, 2)),
        code="MOVE_TIME",
        where="layer 4 bead 2",
    )
    assert "3201 s" in message
    message = refusal(program(start, moves("deposit", np.zeros((9, 6)), 0.0005)), code="MOVE_TIME")
    assert "9 moves take 0.0045 s" in message and "chord error" in message


def test_a_short_rapid_takes_a_millisecond():
    file = fanuc.write(program(moves("rapid", np.zeros((3, 6)), 0.0001)))["PART.LS"]
    assert written_times(file) == [1.0, 1.0]


def test_the_first_move_goes_slowly_from_wherever_the_robot_stands():
    lines = body(fanuc.write(program(moves("rapid", np.zeros((3, 6)), 0.0)))["PART.LS"])
    assert lines[2] == "J P[1] 10% FINE    ;"


# ---- events


def test_the_order_of_a_layer():
    lines = body(fanuc.write(program(
        LayerStart(12), moves("rapid", np.zeros((2, 6))), DepositOn(0.5), moves("deposit", np.zeros((2, 6))),
        DepositOff(0.125), Wait(0.001), WaitInput(4), Call("Clean_1"), deposit_output=9, blend=70,
    ))["PART.LS"])  # fmt: skip
    assert lines == [
        "  UFRAME_NUM=1 ;", "  UTOOL_NUM=1 ;", "  !layer 12 ;", "J P[1] 10% FINE    ;", "J P[2] 100msec FINE    ;",
        "  DO[9]=ON ;", "  WAIT    .50(sec) ;", "J P[3] 100msec CNT70    ;", "J P[4] 100msec FINE    ;",
        "  WAIT    .12(sec) ;", "  DO[9]=OFF ;", "  WAIT    .01(sec) ;", "  WAIT DI[4]=ON    ;", "  CALL CLEAN_1    ;",
    ]  # fmt: skip


def test_a_dry_run_moves_the_same_and_switches_nothing():
    wet = dataclasses.replace(GOLDEN_JOINT)
    dry = fanuc.write(dataclasses.replace(wet, dry_run=True))["JOINT.LS"]
    assert b"DO[" not in dry and b"!dry run: no deposit" in dry
    assert [line for line in body(dry) if line[0] == "J"] == [
        line for line in body(fanuc.write(wet)["JOINT.LS"]) if line[0] == "J"
    ]


def test_an_endless_axis_says_what_it_needs_and_a_limited_one_keeps_its_turns():
    turning = moves("rapid", np.outer(np.arange(9), [0, 0, 0, 0, 0, 100.0]))
    text = fanuc.write(program(turning, continuous=(False,) * 5 + (True,)))["PART.LS"].decode()
    assert "!axis 6 turns without end: set it" in text and "Continuous Turn" in text
    axis_6 = [float(value) for value in re.findall(r"J6= *(\S+)", text)]
    assert axis_6 == [0.0, 100.0, -160.0, -60.0, 40.0, 140.0, -120.0, -20.0, 80.0]
    text = fanuc.write(program(turning))["PART.LS"].decode()
    assert "Continuous" not in text
    assert [float(value) for value in re.findall(r"J6= *(\S+)", text)] == [
        100.0 * n for n in range(9)
    ]


@pytest.mark.parametrize(("degrees", "written"), [
    (180.0, "180.000"), (-180.0, "180.000"), (540.0, "180.000"), (180.0004, "180.000"), (180.0006, "-179.999"),
    (-180.0004, "180.000"), (-0.0004, "0.000"), (359.9996, "0.000"), (-179.9996, "180.000"), (0.25, ".250"),
    (-360.25, "-.250"),
])  # fmt: skip
def test_angles_of_an_endless_axis_lie_within_half_a_turn(degrees, written):
    text = fanuc.write(
        program(moves("rapid", [0, 0, 0, 0, 0, degrees]), continuous=(False,) * 5 + (True,))
    )["PART.LS"].decode()
    assert re.search(r"J6=(.{10}) deg", text)[1] == written.rjust(10)


def test_a_move_of_half_a_turn_on_an_endless_axis_is_refused():
    values = [[0, 0, 0, 0, 0, 0.0], [0, 0, 0, 0, 0, 179.9], [0, 0, 0, 0, 0, 359.9]]
    source = program(
        moves("rapid", values[:2]),
        moves("deposit", values[2:], layer=3, bead=1),
        continuous=(False,) * 5 + (True,),
    )
    assert "axis 6 turns 180.0 deg" in refusal(source, code="ENDLESS_STEP", where="layer 3 bead 1")
    fanuc.write(dataclasses.replace(source, continuous=(False,) * 6))


# ---- parts


def test_parts_hold_whole_beads(assert_listings):
    files = fanuc.write(beads(3, 20, layers=4, max_points=50))
    assert list(files) == ["PART.LS"] + [f"PART{n:02d}.LS" for n in range(1, 7)]
    assert body(files["PART.LS"])[2:] == [f"  CALL PART{n:02d}    ;" for n in range(1, 7)]
    for file in list(files)[1:]:
        lines = body(files[file])
        assert lines.count("  DO[1]=ON ;") == lines.count("  DO[1]=OFF ;") == 2
        assert lines[-1] == "  DO[1]=OFF ;" and not any("goes on" in line for line in lines)
        assert sum(line[0] == "J" for line in lines) == 44
    assert_listings(files)


def test_a_bead_longer_than_a_part_is_cut_and_says_so(assert_listings):
    files = fanuc.write(beads(2, 25, max_points=10, layers=1))
    bodies = [body(files[name]) for name in list(files)[1:]]
    points = [sum(line[0] == "J" for line in statements) for statements in bodies]
    assert points == [10, 10, 7, 10, 10, 7]
    assert [
        any("bead goes on in the next part" in line for line in statements) for statements in bodies
    ] == [
        True,
        True,
        False,
    ] * 2
    assert [any("bead goes on here" in line for line in statements) for statements in bodies] == [
        False,
        True,
        True,
    ] * 2
    # the cut is passed without a stop; the bead's end is a stop
    assert bodies[0][-2].endswith("CNT100    ;") and [line for line in bodies[2] if line[0] == "J"][
        -1
    ].endswith("FINE    ;")
    assert_listings(files)


def test_a_bead_that_goes_on_through_layers_is_no_place_to_cut():
    through = program(
        LayerStart(0), moves("rapid", np.zeros(6)), DepositOn(), moves("deposit", np.zeros((20, 6))),
        LayerStart(1), moves("deposit", np.zeros((20, 6)), layer=1), DepositOff(),
    )  # fmt: skip
    first_run, second_run = (
        body(fanuc.write(dataclasses.replace(through, max_points=30))[f"PART0{n}.LS"])
        for n in (1, 2)
    )
    assert "  !layer 1 ;" in first_run and first_run[-1] == "  !bead goes on in the next part ;"
    assert second_run[2] == "  !bead goes on here ;" and second_run[-1] == "  DO[1]=OFF ;"


def test_no_file_has_more_lines_than_a_controller_takes(assert_listings):
    files = fanuc.write(beads(3, 4000, max_points=10**6))
    assert len(files) == 3
    assert_listings(files)


def test_the_parts_of_a_program_are_the_program(random_program):
    """The moves and events in the order of execution do not depend on the limit of points."""

    def executed(files, name="RANDOM"):
        for line in body(files[f"{name}.LS"]):
            call = re.fullmatch(r"  CALL (RANDOM\d+)    ;", line)
            if call:
                yield from executed(files, call[1])
            elif "_NUM=" not in line and "goes on" not in line and "!the next part" not in line:
                yield re.sub(r"P\[\d+\]", "P[]", line)

    def records(files):
        return [re.sub(r"P\[\d+\]", "P[]", record) for name in sorted(files) for record in
                re.findall(r"P\[\d+\]\{.*?\};", files[name].decode(), re.DOTALL)]  # fmt: skip

    for seed in range(8):
        complete = fanuc.write(random_program(seed, max_points=10**5))
        for max_points in (1, 7, 40):
            part_files = fanuc.write(random_program(seed, max_points=max_points))
            assert list(executed(part_files)) == list(executed(complete)) and records(
                part_files
            ) == records(complete)
