# SPDX-License-Identifier: LGPL-2.1-or-later
"""Yaskawa jobs: exact bytes, pulses, speed shares, parts, refusals and unreadable jobs."""

import dataclasses
import json
import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Wait,
    WaitBelow,
    WaitInput,
)
from freecad_am.objects.checks.controllers import check_pulses, written_by
from freecad_am.posts import own_programs
from freecad_am.posts.ur import post as ur
from freecad_am.posts.yaskawa import post as yaskawa
from tests.posts.fanuc_programs import GOLDEN_JOINT, beads, moves, program, put_tool_on_robot

PULSES = (1435.3, 1308.25, -1313.5, 980.0, 876.8125, 454.75)
STATION = (*PULSES, 1019.6875, -568.5)
FAST = tuple(np.radians([197.0, 190.0, 210.0, 410.0, 410.0, 610.0]).tolist())


def add_machine_facts(source, **changes):
    """Return a program with the required values of its machine file."""
    return dataclasses.replace(
        source, continuous=(False,) * 6, pulses_per_degree=PULSES, max_speed=FAST, **changes
    )


def make_linear(source, unit="mm/s"):
    """Return its beads in linear moves, with the tool on the robot."""
    blocks = tuple(
        dataclasses.replace(block, interpolation="linear")
        if isinstance(block, Moves) and block.kind == "deposit"
        else block
        for block in source.blocks
    )
    return add_machine_facts(
        dataclasses.replace(source, blocks=blocks),
        motion="cartesian",
        setup="tool-on-robot",
        speed_unit=unit,
    )


def add_station(source, **changes):
    """Return the program with a station of two axes that tilt by 30 deg and turn further with every
    move."""
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
            "name": "station",
            "continuous": (False,) * 8,
            "setup": "tool-on-robot",
            "external_kinds": ("rotary", "rotary"),
            "unit": "ST1",
            "pulses_per_degree": STATION,
            "max_speed": (*FAST, *np.radians([80.0, 160.0])),
            **changes,
        },
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
            **{
                name: (
                    *getattr(source, name)[: 6 + axis_index],
                    value,
                    *getattr(source, name)[6 + axis_index :],
                )
                for name, value in (("pulses_per_degree", 81.92), ("max_speed", 2500.0))
            },
            **changes,
        },
    )


GOLDENS = {
    "joint": add_machine_facts(GOLDEN_JOINT),
    "tool": put_tool_on_robot(add_machine_facts(GOLDEN_JOINT)),
    "station": add_station(add_machine_facts(GOLDEN_JOINT)),
    "rail": put_on_track(add_machine_facts(GOLDEN_JOINT)),
    "both": put_on_track(add_station(add_machine_facts(GOLDEN_JOINT)), axis_index=1, name="both"),
    "linear": make_linear(
        dataclasses.replace(GOLDEN_JOINT, name="linear", tool_frame=3, deposit_output=7, blend=50)
    ),
    "parts": make_linear(beads(1, 12, layers=2, name="parts", max_points=10)),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_programs_to_the_byte(root, name):
    files = yaskawa.write(GOLDENS[name])
    stem = GOLDENS[name].name.upper()
    assert files == {
        path.name: path.read_bytes()
        for path in (root / "tests/golden/yaskawa").glob(f"{stem}*.JBI")
    }
    assert not [
        f"{file}: {fault}"
        for file, content in files.items()
        for fault in find_faults(file, content)
    ]


INSTRUCTIONS = [
    r"MOVJ C(\d{5})(?: BC\1)?(?: EC\1)? VJ=(?:100\.00|\d\d?\.\d\d) PL=[0-8]", r"MOVL C\d{5} V=\d{1,5}(?:\.\d)? PL=[0-8]",
    r"DOUT OT#\(\d+\) (?:ON|OFF)", r"WVON WEV#\(\d+\)", r"WVOF",
    r"TIMER T=\d{1,3}\.\d\d", r"WAIT IN#\(\d+\)=ON", r"CALL JOB:[A-Z][A-Z0-9_]{0,31}", r"'[ -~]{1,32}",
]  # fmt: skip


def find_faults(file, content):
    """Return the differences of a job from those that controllers write: headers, counts, positions
    used once and in order."""
    text = content.decode("ascii")
    if "\n" in text.replace("\r\n", ""):
        yield "line ends"
    lines = text.split("\r\n")
    start = lines.index("//INST")
    count = re.fullmatch(r"///NPOS (\d+),(\d+),(\d+),0,0,0", lines[3])
    if [lines[0], lines[1], lines[2]] != [
        "/JOB",
        f"//NAME {file.removesuffix('.JBI')}",
        "//POS",
    ] or count is None:
        yield "header"
    points = lines[7:start] if int(count[1]) else []
    if int(count[1]) and (
        not re.fullmatch(r"///TOOL \d+", lines[4]) or lines[5:7] != ["///POSTYPE PULSE", "///PULSE"]
    ):
        yield "kind of positions"
    own_count, base = int(count[1]), int(count[1]) + int(count[2])
    base_it, beside_it, points = points[own_count:base], points[base:], points[:own_count]
    for letters, stated, due, values in (
        ("BC", base_it, count[2], 1),
        ("EC", beside_it, count[3], 2),
    ):
        form = ",".join([r"-?\d+"] * values)
        if (
            int(due) not in (0, len(points))
            or len(stated) != int(due)
            or any(
                not re.fullmatch(rf"{letters}{k:05d}={form}", line) for k, line in enumerate(stated)
            )
        ):
            yield f"positions {letters}"
    if len(points) != int(count[1]) or any(
        not re.fullmatch(rf"C{k:05d}=-?\d+(?:,-?\d+){{5}}", line) for k, line in enumerate(points)
    ):
        yield "positions"
    group = "///GROUP1 RB1" + {"STATION": ",ST1", "RAIL": ",BS1", "BOTH": ",BS1,ST1"}.get(
        file.removesuffix(".JBI"), ""
    )
    if lines[start + 3 : start + 6] != ["///ATTR SC,RW", group, "NOP"] or lines[-2:] != ["END", ""]:
        yield "frame of the instructions"
    body = lines[start + 6 : -2]
    if len(body) + 2 > 9999 or any(
        not any(re.fullmatch(pattern, line) for pattern in INSTRUCTIONS) for line in body
    ):
        yield "instructions"
    if [int(number) for number in re.findall(r"MOV[JL] C(\d+)", text)] != list(range(len(points))):
        yield "positions out of order"


def test_a_positioner_is_a_station_of_the_group():
    for source in (
        add_station(add_machine_facts(GOLDEN_JOINT)),
        add_station(add_machine_facts(beads(2, 9, layers=2)), max_points=8),
    ):
        readback = yaskawa.read(yaskawa.write(source))
        half = np.radians(0.5 / np.abs(STATION))
        assert (
            np.abs(readback.joints - np.concatenate([run.joints for run in source.moves]))
            <= half + 1e-12
        ).all()
        assert readback.unit == "ST1" and readback.digits == pytest.approx(half)
    job_text = yaskawa.write(add_station(add_machine_facts(GOLDEN_JOINT)))["STATION.JBI"].decode()
    assert "'pulses/deg E1 1019.6875" in job_text and "'pulses/deg E2 -568.5" in job_text
    match = re.search(r"^EC00000=(-?\d+),(-?\d+)", job_text, re.MULTILINE)
    assert (int(match[1]), int(match[2])) == (round(30.0 * 1019.6875), round(0.25 * 568.5))
    refusal(
        add_station(add_machine_facts(GOLDEN_JOINT), motion="cartesian"),
        code="COORDINATED_MOTION",
        where="program.motion",
    )
    refusal(
        add_station(add_machine_facts(GOLDEN_JOINT), unit="STN1"),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )
    refusal(
        add_station(add_machine_facts(GOLDEN_JOINT), first_external=2),
        code="UNSUPPORTED_AXES",
        where="program.axes.first",
    )
    refusal(
        add_station(add_machine_facts(GOLDEN_JOINT), pulses_per_degree=PULSES),
        code="NO_PULSES",
        where="cell.machine",
    )
    for old, new in (
        ("C00001 EC00001", "C00001"),
        ("C00001 EC00001", "C00001 EC00002"),
        ("RB1,ST1", "RB1"),
        ("EC00001=", "EC00009="),
        ("'pulses/deg E2 -568.5\r\n", ""),
    ):
        assert old in job_text
        with pytest.raises(InputError):
            yaskawa.read({"STATION.JBI": job_text.replace(old, new, 1).encode()})


def test_a_track_is_the_base_axis_of_the_group():
    stationed = add_station(add_machine_facts(beads(2, 9, layers=2)), max_points=8)
    for source in (
        put_on_track(add_machine_facts(GOLDEN_JOINT)),
        *(put_on_track(stationed, axis_index=index) for index in (0, 1, 2)),
    ):
        readback = yaskawa.read(yaskawa.write(source))
        slides = np.array([*(False,) * 6, *(kind == "linear" for kind in source.external_kinds)])
        half = 0.5 / np.abs(source.pulses_per_degree)
        half = np.where(slides, half, np.radians(half))
        assert (
            np.abs(readback.joints - np.concatenate([run.joints for run in source.moves]))
            <= half + 1e-12
        ).all()
        assert readback.linear_digits == 0.5 / 81.92 and readback.digits[~slides] == pytest.approx(
            half[~slides]
        )
        assert readback.unit == source.unit == ("ST1" if len(source.external_kinds) > 1 else "")
    job_text = yaskawa.write(
        put_on_track(add_station(add_machine_facts(GOLDEN_JOINT)), axis_index=1, name="both")
    )["BOTH.JBI"].decode()
    assert (
        "'pulses/deg E1 1019.6875" in job_text
        and "'pulses/mm E2 81.92" in job_text
        and "'pulses/deg E3 -568.5" in job_text
    )
    assert re.search(r"^BC00000=(-?\d+)\r", job_text, re.MULTILINE)[1] == str(
        round(-900.125 * 81.92)
    )
    assert "RB1,BS1,ST1" in job_text and "MOVJ C00001 BC00001 EC00001 VJ=" in job_text
    assert "base axis" in refusal(
        put_on_track(add_machine_facts(GOLDEN_JOINT), motion="cartesian"), code="COORDINATED_MOTION"
    )
    refusal(
        put_on_track(add_machine_facts(GOLDEN_JOINT), unit="ST1"),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )
    refusal(
        put_on_track(add_station(add_machine_facts(GOLDEN_JOINT)), unit=""),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )
    # the share is that of the axis that takes longest
    slow = put_on_track(add_machine_facts(GOLDEN_JOINT), max_speed=(*FAST, 50.0))
    first_share, _, third_share = re.findall(
        r"VJ=([\d.]+)", yaskawa.write(slow)["RAIL.JBI"].decode()
    )[:3]
    assert (
        float(third_share)
        == pytest.approx(100.0 * 12.5 / 50.0 / slow.moves[1].duration[0], abs=0.006)
        and first_share == "10.00"
    )
    for old, new in (
        ("C00001 BC00001", "C00001"),
        ("C00001 BC00001", "C00001 BC00002"),
        ("RB1,BS1", "RB1"),
        ("BC00000=", "BC00009="),
        ("'pulses/mm E2", "'pulses/deg E2"),
        ("'pulses/mm E2 81.92\r\n", ""),
        ("BC00001 EC00001", "EC00001 BC00001"),
    ):
        assert old in job_text
        with pytest.raises(InputError):
            yaskawa.read({"BOTH.JBI": job_text.replace(old, new, 1).encode()})


def random_job(random_program, seed, cartesian):
    source = random_program(seed, continuous=False)
    blocks = tuple(
        dataclasses.replace(block, duration=np.clip(block.duration, 0.3, 0.9))
        if isinstance(block, Moves)
        else block
        for block in source.blocks
    )
    source = add_machine_facts(dataclasses.replace(source, blocks=blocks))
    source = make_linear(source, ("mm/s", "cm/min", "mm/min")[seed % 3]) if cartesian else source
    return dataclasses.replace(source, max_speed=(12.0,) * 6)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cartesian", [False, True])
def test_random_programs_come_back_and_are_as_jobs_are(random_program, seed, cartesian):
    source = random_job(random_program, seed, cartesian)
    files = yaskawa.write(source)
    assert not [
        f"{file}: {fault}"
        for file, content in files.items()
        for fault in find_faults(file, content)
    ]
    readback = yaskawa.read(files)
    joints, duration, speed, stops = (
        np.concatenate([getattr(run, name) for run in source.moves])
        for name in ("joints", "duration", "speed", "stops")
    )
    straight = np.concatenate(
        [np.full(len(run), run.interpolation == "linear") for run in source.moves]
    )
    half = np.radians(0.5 / np.abs(PULSES))
    assert (
        np.abs(readback.joints - joints) <= half + 1e-12
    ).all() and readback.digits == pytest.approx(half)
    assert (
        readback.linear.tolist() == straight.tolist()
        and readback.stops.tolist() == (stops | (source.blend == 0)).tolist()
    )
    steps = (np.abs(np.diff(readback.joints, axis=0, prepend=readback.joints[:1])) / 12.0).max(
        axis=1
    )
    durations = steps / readback.share
    by_share = ~straight & (np.arange(len(steps)) > 0)
    assert (np.abs(durations - duration) <= steps * (0.5e-4 / readback.share**2) * 1.01 + 1e-9)[
        by_share
    ].all()
    assert readback.share[0] == pytest.approx(0.1)
    step = {"mm/s": 0.05, "cm/min": 0.5 / 6.0, "mm/min": 0.5 / 60.0}[source.speed_unit or "mm/s"]
    assert (np.abs(readback.speed - speed)[straight] <= step + 1e-9).all()
    assert set(readback.tool_frame) == {float(source.tool_frame)}


def body(content):
    lines = content.decode("ascii").split("\r\n")
    return [
        line
        for line in lines[lines.index("NOP") + 1 : -2]
        if not line.startswith(("'pulses", "'V in"))
    ]


def test_the_order_of_a_layer():
    source = add_machine_facts(program(
        LayerStart(12), moves("rapid", np.zeros((2, 6))), DepositOn(0.5),
        moves("deposit", np.array([[2.0] * 6, [4.0] * 6]), 2.0),
        DepositOff(0.125), Wait(1300.0), WaitInput(4), Call("Clean_1"), deposit_output=9, blend=13,
    ))  # fmt: skip
    (content,) = yaskawa.write(source).values()
    assert body(content)[2:] == [
        "'layer 12", "MOVJ C00000 VJ=10.00 PL=0", "MOVJ C00001 VJ=100.00 PL=0", "DOUT OT#(9) ON", "TIMER T=0.50",
        "MOVJ C00002 VJ=0.53 PL=2", "MOVJ C00003 VJ=0.53 PL=0", "TIMER T=0.12", "DOUT OT#(9) OFF", "TIMER T=600.00",
        "TIMER T=600.00", "TIMER T=100.00", "WAIT IN#(4)=ON", "CALL JOB:CLEAN_1",
    ]  # fmt: skip
    dry = yaskawa.write(dataclasses.replace(source, dry_run=True))["PART.JBI"]
    assert b"DOUT" not in dry and b"'dry run: no deposit" in dry


@pytest.mark.parametrize(
    ("unit", "told"), [("mm/s", "V=6.3"), ("cm/min", "V=38"), ("mm/min", "V=378")]
)
def test_speeds_have_the_unit_of_the_controller(unit, told):
    run = dataclasses.replace(moves("deposit", np.zeros((1, 6))), speed=np.array([6.3]))
    (content,) = yaskawa.write(
        make_linear(program(moves("rapid", np.zeros(6)), run), unit)
    ).values()
    assert (
        f"MOVL C00001 {told} PL=0".encode() in content and f"'V in {unit}\r\n".encode() in content
    )


def test_how_far_off_the_speed_of_beads_is_is_told():
    """VJ of 0.526 % is written as 0.53 %."""
    source = add_machine_facts(
        program(
            moves("rapid", np.zeros(6)),
            moves("deposit", np.full((1, 6), 2.0), 2.0 / 190.0 / 0.00526),
        )
    )
    text = yaskawa.write(source)["PART.JBI"].decode()
    assert "VJ=0.53" in text and "speed of\r\n'beads is right to 0.8 %" in text.replace(
        "'VJ has steps of 0.01 %: ", ""
    )
    assert "beads is right" not in yaskawa.write(GOLDENS["linear"])["LINEAR.JBI"].decode()


def test_parts_hold_whole_beads_and_their_sum_is_told():
    files = yaskawa.write(make_linear(beads(3, 20, layers=4, max_points=50)))
    assert list(files) == ["PART.JBI"] + [f"PART{n:02d}.JBI" for n in range(1, 7)]
    assert body(files["PART.JBI"]) == [
        "'264 moves in 6 parts",
        *(f"CALL JOB:PART{n:02d}" for n in range(1, 7)),
    ]
    for name in list(files)[1:]:
        assert (
            body(files[name]).count("DOUT OT#(1) ON")
            == body(files[name]).count("DOUT OT#(1) OFF")
            == 2
        )
    long = dataclasses.replace(make_linear(beads(3, 4000, max_points=10**6)), max_speed=(1e3,) * 6)
    assert len(yaskawa.write(long)) == 3


def test_programs_of_ours_are_known_again_in_their_folder(tmp_path):
    """A later program of the same name replaces the whole earlier one; remarks of a job follow its
    positions."""
    for post, source in (
        (yaskawa, GOLDENS["parts"]),
        (yaskawa, GOLDENS["joint"]),
        (ur, dataclasses.replace(GOLDENS["joint"], name="script", setup="tool-on-robot")),
    ):
        with_remarks = dataclasses.replace(source, remarks=("Limits: maker", "Travel speed 6 mm/s"))
        files = post.write(with_remarks)
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        main = min(files, key=len)
        assert own_programs.programs(str(tmp_path))[main] == set(files)


# ---- refusals


def refusal(source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        yaskawa.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


def test_what_no_job_says_is_refused():
    still = moves("rapid", np.zeros(6))
    carrying = dataclasses.replace(GOLDENS["linear"], setup="part-on-robot")
    assert "external reference point" in refusal(
        carrying, code="REMOTE_TCP", where="program.motion"
    )
    refusal(
        add_machine_facts(program(still), setup="rotary-table"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    refusal(
        dataclasses.replace(add_machine_facts(program(still)), continuous=(False,) * 5 + (True,)),
        code="ENDLESS_AXIS",
    )
    refusal(
        dataclasses.replace(add_machine_facts(program(still)), pulses_per_degree=()),
        code="NO_PULSES",
        where="cell.machine",
    )
    refusal(make_linear(program(still), ""), code="NO_SPEED_UNIT", where="cell.machine")
    refusal(
        dataclasses.replace(add_machine_facts(program(still)), max_speed=(1.0,) * 5 + (np.inf,)),
        code="NO_JOINT_SPEED",
    )
    refusal(add_machine_facts(program(still, WaitBelow(1, 1.0, 0, 0))), code="NO_ANALOGUE_INPUT")
    refusal(add_machine_facts(program(still, name="1part")), code="PROGRAM_NAME", where="name")
    assert "program of the job" in refusal(
        add_machine_facts(program(still, Call("part"))), code="PROGRAM_NAME"
    )
    slow = moves("deposit", np.full((1, 6), 0.01), 10.0, layer=4, bead=2)
    assert "steps of 0.01 %" in refusal(
        add_machine_facts(program(still, slow)), code="JOINT_SPEED", where="layer 4 bead 2"
    )
    refusal(
        add_machine_facts(program(still, moves("deposit", np.full((1, 6), 90.0), 0.1))),
        code="JOINT_SPEED",
    )
    quick = dataclasses.replace(moves("deposit", np.zeros((1, 6))), speed=np.array([1501.0]))
    refusal(make_linear(program(still, quick)), code="MOVE_SPEED")


def test_pulses_are_those_of_a_machine_file(tmp_path):
    built_in = machine.load("motoman-ma2010")
    assert built_in.posts == ("yaskawa",) and written_by(built_in) == ()
    with pytest.raises(InputError) as raised:
        check_pulses(built_in, "joint", "yaskawa")
    assert (
        raised.value.code == "NO_PULSES" and "controller.pulses_per_degree" in raised.value.message
    )
    check_pulses(built_in, "joint", "fanuc")
    text = json.loads((machine.BUILT_IN / "motoman-ma2010.json").read_text(encoding="utf-8"))
    machine_file = tmp_path / "motoman-ma2010.json"

    def write_with(**values):
        machine_file.write_text(
            json.dumps({**text, "controller": {**text["controller"], **values}}), encoding="utf-8"
        )
        return machine.load(machine_file)

    own_machine = write_with(pulses_per_degree=PULSES)
    assert own_machine.pulses_per_degree == PULSES and written_by(own_machine) == ("yaskawa",)
    check_pulses(own_machine, "joint", "yaskawa")
    with pytest.raises(InputError) as raised:
        check_pulses(own_machine, "cartesian", "yaskawa")
    assert raised.value.code == "NO_SPEED_UNIT"
    check_pulses(write_with(pulses_per_degree=PULSES, speed_unit="cm/min"), "cartesian", "yaskawa")
    for key, wrong in (
        ("pulses_per_degree", [1, 2, 3]),
        ("pulses_per_degree", [1, 2, 3, 4, 5, 0]),
        ("speed_unit", "m/s"),
    ):
        with pytest.raises(InputError) as raised:
            write_with(**{key: wrong})
        assert raised.value.code == "BAD_MACHINE" and f"controller.{key}" in raised.value.where


# ---- reading


@pytest.mark.parametrize(("pattern", "replacement", "why"), [
    ("MOVL C00003", "MOVL C00099", "is missing"), ("MOVL C00003 V=6.0", "MOVL C00003 V=0.0", "the speed 0.0 is not valid"),
    ("MOVL C00003", "SMOVL C00003", "is not understood"), ("C00003=", "C00004=", "is not position 3"),
    ("VJ=10.00", "VJ=110.00", "is not valid"), ("NOP", "NOP\r\nJUMP *A", "is not understood"),
    ("NOP", "NOP\r\nSPEED V=1.0", "is not understood"), ("DOUT OT#(7) OFF", "DOUT OT#(8) OFF", "a second output"),
    ("//NAME LINEAR", "//NAME OTHER", "the job in the file is called OTHER"), ("CALL JOB:CLEAN", "CALL JOB:LINEAR", "0 jobs are called"),
    ("///NPOS 6", "///NPOS 7", "is not position 6"), ("SC,RW", "SC,RO", "do not begin"), ("/JOB\r", "JOB\r", "not a job"),
    ("NOP", "NOP\r\n'pulses/deg S 1.0", "are missing or given twice"), ("'V in mm/s", "'V in m/s", "the unit of V is missing"),
    ("'V in mm/s", "'V in mm/s\r\n'V in cm/min", "two units"), ("S 1435.3", "S 0.0", "or are missing"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(pattern, replacement, why):
    text = yaskawa.write(GOLDENS["linear"])["LINEAR.JBI"].decode()
    assert pattern in text
    with pytest.raises(InputError) as raised:
        yaskawa.read({"LINEAR.JBI": text.replace(pattern, replacement, 1).encode()})
    assert raised.value.code == "UNREADABLE_PROGRAM" and why in raised.value.message
