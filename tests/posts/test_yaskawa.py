# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is written for Yaskawa: jobs to the byte, pulses, shares of speed, parts, and what is refused and not read."""

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
from tests.posts.fanuc_programs import GOLDEN_JOINT, beads, moves, program, with_tool

PULSES = (1435.3, 1308.25, -1313.5, 980.0, 876.8125, 454.75)
STATION = (*PULSES, 1019.6875, -568.5)
FAST = tuple(np.radians([197.0, 190.0, 210.0, 410.0, 410.0, 610.0]).tolist())


def known(of, **more):
    """A program whose machine file tells what is needed."""
    return dataclasses.replace(
        of, continuous=(False,) * 6, pulses_per_degree=PULSES, max_speed=FAST, **more
    )


def linear(of, unit="mm/s"):
    """Its beads in linear moves, with the tool on the robot."""
    blocks = tuple(
        dataclasses.replace(block, interpolation="linear")
        if isinstance(block, Moves) and block.kind == "deposit"
        else block
        for block in of.blocks
    )
    return known(
        dataclasses.replace(of, blocks=blocks),
        motion="cartesian",
        setup="tool-on-robot",
        speed_unit=unit,
    )


def beside(of, **more):
    """The same with a station of two axes: they tilt by 30 deg, and turn on with every move."""
    count, blocks = 0, []
    for block in of.blocks:
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
        of,
        blocks=tuple(blocks),
        **{
            "name": "station",
            "continuous": (False,) * 8,
            "setup": "tool-on-robot",
            "external_kinds": ("rotary", "rotary"),
            "unit": "ST1",
            "pulses_per_degree": STATION,
            "max_speed": (*FAST, *np.radians([80.0, 160.0])),
            **more,
        },
    )


def along(of, at=0, **more):
    """The same with the robot on a track, which goes on by 12.5 mm with every move: its axis so far behind the robot's."""
    count, blocks = 0, []
    for block in of.blocks:
        if isinstance(block, Moves):
            way = 12.5 * (count + np.arange(len(block))) - 900.125
            count += len(block)
            block = dataclasses.replace(block, joints=np.insert(block.joints, 6 + at, way, axis=1))
        blocks.append(block)
    kinds = [*of.external_kinds]
    kinds.insert(at, "linear")
    return dataclasses.replace(
        of,
        blocks=tuple(blocks),
        **{
            "name": "rail",
            "continuous": (False,) * (7 + len(of.external_kinds)),
            "setup": "tool-on-robot",
            "external_kinds": tuple(kinds),
            **{
                name: (*getattr(of, name)[: 6 + at], value, *getattr(of, name)[6 + at :])
                for name, value in (("pulses_per_degree", 81.92), ("max_speed", 2500.0))
            },
            **more,
        },
    )


GOLDENS = {
    "joint": known(GOLDEN_JOINT),
    "tool": with_tool(known(GOLDEN_JOINT)),
    "station": beside(known(GOLDEN_JOINT)),
    "rail": along(known(GOLDEN_JOINT)),
    "both": along(beside(known(GOLDEN_JOINT)), at=1, name="both"),
    "linear": linear(
        dataclasses.replace(GOLDEN_JOINT, name="linear", tool_frame=3, deposit_output=7, blend=50)
    ),
    "parts": linear(beads(1, 12, layers=2, name="parts", max_points=10)),
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
        f"{file}: {fault}" for file, content in files.items() for fault in faults(file, content)
    ]


INSTRUCTIONS = [
    r"MOVJ C(\d{5})(?: BC\1)?(?: EC\1)? VJ=(?:100\.00|\d\d?\.\d\d) PL=[0-8]", r"MOVL C\d{5} V=\d{1,5}(?:\.\d)? PL=[0-8]",
    r"DOUT OT#\(\d+\) (?:ON|OFF)", r"WVON WEV#\(\d+\)", r"WVOF",
    r"TIMER T=\d{1,3}\.\d\d", r"WAIT IN#\(\d+\)=ON", r"CALL JOB:[A-Z][A-Z0-9_]{0,31}", r"'[ -~]{1,32}",
]  # fmt: skip


def faults(file, content):
    """What of a job is not as jobs are that controllers wrote: headers, counts, positions used once and in order."""
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
    own, base = int(count[1]), int(count[1]) + int(count[2])
    base_it, beside_it, points = points[own:base], points[base:], points[:own]
    for letters, told, due, values in (
        ("BC", base_it, count[2], 1),
        ("EC", beside_it, count[3], 2),
    ):
        form = ",".join([r"-?\d+"] * values)
        if (
            int(due) not in (0, len(points))
            or len(told) != int(due)
            or any(
                not re.fullmatch(rf"{letters}{k:05d}={form}", line) for k, line in enumerate(told)
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
        not any(re.fullmatch(one, line) for one in INSTRUCTIONS) for line in body
    ):
        yield "instructions"
    if [int(number) for number in re.findall(r"MOV[JL] C(\d+)", text)] != list(range(len(points))):
        yield "positions out of order"


def test_a_positioner_is_a_station_of_the_group():
    for of in (beside(known(GOLDEN_JOINT)), beside(known(beads(2, 9, layers=2)), max_points=8)):
        read = yaskawa.read(yaskawa.write(of))
        half = np.radians(0.5 / np.abs(STATION))
        assert (
            np.abs(read.joints - np.concatenate([run.joints for run in of.moves])) <= half + 1e-12
        ).all()
        assert read.unit == "ST1" and read.digits == pytest.approx(half)
    told = yaskawa.write(beside(known(GOLDEN_JOINT)))["STATION.JBI"].decode()
    assert "'pulses/deg E1 1019.6875" in told and "'pulses/deg E2 -568.5" in told
    first = re.search(r"^EC00000=(-?\d+),(-?\d+)", told, re.MULTILINE)
    assert (int(first[1]), int(first[2])) == (round(30.0 * 1019.6875), round(0.25 * 568.5))
    refusal(
        beside(known(GOLDEN_JOINT), motion="cartesian"),
        code="COORDINATED_MOTION",
        where="program.motion",
    )
    refusal(
        beside(known(GOLDEN_JOINT), unit="STN1"), code="UNSUPPORTED_AXES", where="program.axes.unit"
    )
    refusal(
        beside(known(GOLDEN_JOINT), first_external=2),
        code="UNSUPPORTED_AXES",
        where="program.axes.first",
    )
    refusal(
        beside(known(GOLDEN_JOINT), pulses_per_degree=PULSES),
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
        assert old in told
        with pytest.raises(InputError):
            yaskawa.read({"STATION.JBI": told.replace(old, new, 1).encode()})


def test_a_track_is_the_base_axis_of_the_group():
    stationed = beside(known(beads(2, 9, layers=2)), max_points=8)
    for of in (along(known(GOLDEN_JOINT)), *(along(stationed, at=at) for at in (0, 1, 2))):
        read = yaskawa.read(yaskawa.write(of))
        slides = np.array([*(False,) * 6, *(kind == "linear" for kind in of.external_kinds)])
        half = 0.5 / np.abs(of.pulses_per_degree)
        half = np.where(slides, half, np.radians(half))
        assert (
            np.abs(read.joints - np.concatenate([run.joints for run in of.moves])) <= half + 1e-12
        ).all()
        assert read.linear_digits == 0.5 / 81.92 and read.digits[~slides] == pytest.approx(
            half[~slides]
        )
        assert read.unit == of.unit == ("ST1" if len(of.external_kinds) > 1 else "")
    told = yaskawa.write(along(beside(known(GOLDEN_JOINT)), at=1, name="both"))["BOTH.JBI"].decode()
    assert (
        "'pulses/deg E1 1019.6875" in told
        and "'pulses/mm E2 81.92" in told
        and "'pulses/deg E3 -568.5" in told
    )
    assert re.search(r"^BC00000=(-?\d+)\r", told, re.MULTILINE)[1] == str(round(-900.125 * 81.92))
    assert "RB1,BS1,ST1" in told and "MOVJ C00001 BC00001 EC00001 VJ=" in told
    assert "base axis" in refusal(
        along(known(GOLDEN_JOINT), motion="cartesian"), code="COORDINATED_MOTION"
    )
    refusal(
        along(known(GOLDEN_JOINT), unit="ST1"), code="UNSUPPORTED_AXES", where="program.axes.unit"
    )
    refusal(
        along(beside(known(GOLDEN_JOINT)), unit=""),
        code="UNSUPPORTED_AXES",
        where="program.axes.unit",
    )
    # the share is that of the axis that takes longest
    slow = along(known(GOLDEN_JOINT), max_speed=(*FAST, 50.0))
    first, _, third = re.findall(r"VJ=([\d.]+)", yaskawa.write(slow)["RAIL.JBI"].decode())[:3]
    assert (
        float(third) == pytest.approx(100.0 * 12.5 / 50.0 / slow.moves[1].duration[0], abs=0.006)
        and first == "10.00"
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
        assert old in told
        with pytest.raises(InputError):
            yaskawa.read({"BOTH.JBI": told.replace(old, new, 1).encode()})


def seeded(random_program, seed, cartesian):
    of = random_program(seed, continuous=False)
    blocks = tuple(
        dataclasses.replace(block, duration=np.clip(block.duration, 0.3, 0.9))
        if isinstance(block, Moves)
        else block
        for block in of.blocks
    )
    of = known(dataclasses.replace(of, blocks=blocks))
    of = linear(of, ("mm/s", "cm/min", "mm/min")[seed % 3]) if cartesian else of
    return dataclasses.replace(of, max_speed=(12.0,) * 6)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cartesian", [False, True])
def test_random_programs_come_back_and_are_as_jobs_are(random_program, seed, cartesian):
    of = seeded(random_program, seed, cartesian)
    files = yaskawa.write(of)
    assert not [
        f"{file}: {fault}" for file, content in files.items() for fault in faults(file, content)
    ]
    read = yaskawa.read(files)
    joints, duration, speed, stops = (
        np.concatenate([getattr(run, name) for run in of.moves])
        for name in ("joints", "duration", "speed", "stops")
    )
    straight = np.concatenate(
        [np.full(len(run), run.interpolation == "linear") for run in of.moves]
    )
    half = np.radians(0.5 / np.abs(PULSES))
    assert (np.abs(read.joints - joints) <= half + 1e-12).all() and read.digits == pytest.approx(
        half
    )
    assert (
        read.linear.tolist() == straight.tolist()
        and read.stops.tolist() == (stops | (of.blend == 0)).tolist()
    )
    steps = (np.abs(np.diff(read.joints, axis=0, prepend=read.joints[:1])) / 12.0).max(axis=1)
    taken = steps / read.share
    by_share = ~straight & (np.arange(len(steps)) > 0)
    assert (np.abs(taken - duration) <= steps * (0.5e-4 / read.share**2) * 1.01 + 1e-9)[
        by_share
    ].all()
    assert read.share[0] == pytest.approx(0.1)
    step = {"mm/s": 0.05, "cm/min": 0.5 / 6.0, "mm/min": 0.5 / 60.0}[of.speed_unit or "mm/s"]
    assert (np.abs(read.speed - speed)[straight] <= step + 1e-9).all()
    assert set(read.tool_frame) == {float(of.tool_frame)}


def body(content):
    lines = content.decode("ascii").split("\r\n")
    return [
        line
        for line in lines[lines.index("NOP") + 1 : -2]
        if not line.startswith(("'pulses", "'V in"))
    ]


def test_the_order_of_a_layer():
    of = known(program(
        LayerStart(12), moves("rapid", np.zeros((2, 6))), DepositOn(0.5),
        moves("deposit", np.array([[2.0] * 6, [4.0] * 6]), 2.0),
        DepositOff(0.125), Wait(1300.0), WaitInput(4), Call("Clean_1"), deposit_output=9, blend=13,
    ))  # fmt: skip
    (content,) = yaskawa.write(of).values()
    assert body(content)[2:] == [
        "'layer 12", "MOVJ C00000 VJ=10.00 PL=0", "MOVJ C00001 VJ=100.00 PL=0", "DOUT OT#(9) ON", "TIMER T=0.50",
        "MOVJ C00002 VJ=0.53 PL=2", "MOVJ C00003 VJ=0.53 PL=0", "TIMER T=0.12", "DOUT OT#(9) OFF", "TIMER T=600.00",
        "TIMER T=600.00", "TIMER T=100.00", "WAIT IN#(4)=ON", "CALL JOB:CLEAN_1",
    ]  # fmt: skip
    dry = yaskawa.write(dataclasses.replace(of, dry_run=True))["PART.JBI"]
    assert b"DOUT" not in dry and b"'dry run: no deposit" in dry


@pytest.mark.parametrize(
    ("unit", "told"), [("mm/s", "V=6.3"), ("cm/min", "V=38"), ("mm/min", "V=378")]
)
def test_speeds_have_the_unit_of_the_controller(unit, told):
    run = dataclasses.replace(moves("deposit", np.zeros((1, 6))), speed=np.array([6.3]))
    (content,) = yaskawa.write(linear(program(moves("rapid", np.zeros(6)), run), unit)).values()
    assert (
        f"MOVL C00001 {told} PL=0".encode() in content and f"'V in {unit}\r\n".encode() in content
    )


def test_how_far_off_the_speed_of_beads_is_is_told():
    """VJ of 0.526 % is written as 0.53 %."""
    of = known(
        program(
            moves("rapid", np.zeros(6)),
            moves("deposit", np.full((1, 6), 2.0), 2.0 / 190.0 / 0.00526),
        )
    )
    text = yaskawa.write(of)["PART.JBI"].decode()
    assert "VJ=0.53" in text and "speed of\r\n'beads is right to 0.8 %" in text.replace(
        "'VJ has steps of 0.01 %: ", ""
    )
    assert "beads is right" not in yaskawa.write(GOLDENS["linear"])["LINEAR.JBI"].decode()


def test_parts_hold_whole_beads_and_their_sum_is_told():
    files = yaskawa.write(linear(beads(3, 20, layers=4, max_points=50)))
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
    long = dataclasses.replace(linear(beads(3, 4000, max_points=10**6)), max_speed=(1e3,) * 6)
    assert len(yaskawa.write(long)) == 3


def test_programs_of_ours_are_known_again_in_their_folder(tmp_path):
    """A later program of the same name replaces all of an earlier one; remarks of a job follow its positions."""
    for post, of in (
        (yaskawa, GOLDENS["parts"]),
        (yaskawa, GOLDENS["joint"]),
        (ur, dataclasses.replace(GOLDENS["joint"], name="script", setup="tool-on-robot")),
    ):
        told = dataclasses.replace(of, remarks=("Limits: maker", "Travel speed 6 mm/s"))
        files = post.write(told)
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        main = min(files, key=len)
        assert own_programs.programs(str(tmp_path))[main] == set(files)


# refusals


def refusal(of, *, code, where=None):
    with pytest.raises(InputError) as raised:
        yaskawa.write(of)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


def test_what_no_job_says_is_refused():
    still = moves("rapid", np.zeros(6))
    carrying = dataclasses.replace(GOLDENS["linear"], setup="part-on-robot")
    assert "external reference point" in refusal(
        carrying, code="REMOTE_TCP", where="program.motion"
    )
    refusal(
        known(program(still), setup="rotary-table"), code="UNSUPPORTED_SETUP", where="cell.setup"
    )
    refusal(
        dataclasses.replace(known(program(still)), continuous=(False,) * 5 + (True,)),
        code="ENDLESS_AXIS",
    )
    refusal(
        dataclasses.replace(known(program(still)), pulses_per_degree=()),
        code="NO_PULSES",
        where="cell.machine",
    )
    refusal(linear(program(still), ""), code="NO_SPEED_UNIT", where="cell.machine")
    refusal(
        dataclasses.replace(known(program(still)), max_speed=(1.0,) * 5 + (np.inf,)),
        code="NO_JOINT_SPEED",
    )
    refusal(known(program(still, WaitBelow(1, 1.0, 0, 0))), code="NO_ANALOGUE_INPUT")
    refusal(known(program(still, name="1part")), code="PROGRAM_NAME", where="name")
    assert "program of the job" in refusal(known(program(still, Call("part"))), code="PROGRAM_NAME")
    slow = moves("deposit", np.full((1, 6), 0.01), 10.0, layer=4, bead=2)
    assert "steps of 0.01 %" in refusal(
        known(program(still, slow)), code="JOINT_SPEED", where="layer 4 bead 2"
    )
    refusal(known(program(still, moves("deposit", np.full((1, 6), 90.0), 0.1))), code="JOINT_SPEED")
    quick = dataclasses.replace(moves("deposit", np.zeros((1, 6))), speed=np.array([1501.0]))
    refusal(linear(program(still, quick)), code="MOVE_SPEED")


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
    own = tmp_path / "motoman-ma2010.json"

    def told(**more):
        own.write_text(
            json.dumps({**text, "controller": {**text["controller"], **more}}), encoding="utf-8"
        )
        return machine.load(own)

    mine = told(pulses_per_degree=PULSES)
    assert mine.pulses_per_degree == PULSES and written_by(mine) == ("yaskawa",)
    check_pulses(mine, "joint", "yaskawa")
    with pytest.raises(InputError) as raised:
        check_pulses(mine, "cartesian", "yaskawa")
    assert raised.value.code == "NO_SPEED_UNIT"
    check_pulses(told(pulses_per_degree=PULSES, speed_unit="cm/min"), "cartesian", "yaskawa")
    for key, wrong in (
        ("pulses_per_degree", [1, 2, 3]),
        ("pulses_per_degree", [1, 2, 3, 4, 5, 0]),
        ("speed_unit", "m/s"),
    ):
        with pytest.raises(InputError) as raised:
            told(**{key: wrong})
        assert raised.value.code == "BAD_MACHINE" and f"controller.{key}" in raised.value.where


# reading


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
