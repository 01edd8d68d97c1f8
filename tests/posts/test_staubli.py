# SPDX-License-Identifier: LGPL-2.1-or-later
"""VAL 3 applications: exact bytes, splitting, speeds and refusals."""

import dataclasses
import math
import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Wait,
    WaitInput,
)
from freecad_am.posts import catalogue
from freecad_am.posts.staubli import post as staubli
from tests.posts.fanuc_programs import put_tool_on_robot

VARIANTS = [
    ("joint", "part-on-robot"),
    ("cartesian", "part-on-robot"),
    ("cartesian", "tool-on-robot"),
]
NOMINAL = (math.radians(287.0), math.radians(287.0), math.radians(319.0), math.radians(410.0), math.radians(320.0),
           math.radians(700.0))  # fmt: skip


def moves(kind, degrees, duration=0.5, layer=0, bead=0, speed=6.0, **extra):
    degrees = np.atleast_2d(np.asarray(degrees, float))
    duration = np.broadcast_to(np.asarray(duration, float), len(degrees)).copy()
    return Moves(
        kind, layer, bead, np.radians(degrees), duration, np.full(len(degrees), speed), **extra
    )


def program(*blocks, name="part", **options):
    defaults = {
        "continuous": (False,) * 6, "max_speed": NOMINAL, "station": (300.0, 0.0, 310.5, 0.0, 0.0, math.pi / 2),
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
    text = files[name].decode("utf-8-sig")
    return [
        line.strip()
        for line in text[text.index("begin\n") + 6 : text.index("end]]>")].split("\n")[:-1]
    ]


def values(files, name, array):
    text = files[name].decode("utf-8-sig")
    block = re.search(rf'<Data name="{array}".*?</Data>', text, re.DOTALL)[0]
    return [dict(re.findall(r'(\w+)="([^"]*)"', line)) for line in block.split("\n")[1:-1]]


def refusal(source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        staubli.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


JOINT = program(
    LayerStart(0),
    moves("rapid", [[0.0, -30.0, 120.0, 0.0, 60.0, 170.0], [1.25, -29.5, 120.25, 0.1, 60.5, 175.0]], [10.0, 0.8]),
    DepositOn(0.5),
    moves("deposit", [[1.25, -29.5, 120.25, 0.1, 60.5, 176.0], [1.25, -29.5, 120.3, 0.1, 60.5, 177.4]], [0.2, 0.25]),
    DepositOff(0.25),
    Wait(12.5), WaitInput(3), Call("clean"),
    LayerStart(1),
    moves("rapid", [[0.0, -30.0, 120.0, 0.0, 60.0, 177.4]], 1.0, layer=1),
    name="Joint", remarks=('A remark ]]> with "marks": Größe',), deposit_output=3,
)  # fmt: skip

TURNED = np.array(
    [
        [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
    ]
)


def gauge_bead(layer):
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


GAUGE = program(
    *gauge_bead(0), *gauge_bead(1), name="gauge", motion="cartesian", max_points=8, blend=50
)
GOLDENS = {
    "joint": JOINT,
    "gauge": GAUGE,
    "tool-joint": put_tool_on_robot(JOINT),
    "tool": put_tool_on_robot(GAUGE),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_applications_to_the_byte(root, name, assert_applications):
    files = staubli.write(GOLDENS[name])
    folder = root / "tests/golden/val3" / name
    assert files == {
        str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.*")
    }
    assert_applications(files)


def test_the_gauge_is_the_papers():
    """One target is the deposition point; each tool is the point of the part, X Y Z Rx Ry Rz
    (Chalvin 2019, III.A)."""
    files = staubli.write(dataclasses.replace(GAUGE, max_points=20))
    assert [line for line in lines(files, "gauge/start.pgx") if "movel" in line] == [
        "movel(pTarget,tPath[l_nI],mPath[2])", "movel(pTarget,tPath[l_nI],mPath[5])",
    ]  # fmt: skip
    (station,), (target,) = (
        values(files, "gauge/gauge.dtx", array) for array in ("fStation", "pTarget")
    )
    assert [float(station[a]) for a in ("x", "y", "z", "rx", "ry", "rz")] == [
        300.0,
        0.0,
        310.5,
        0.0,
        0.0,
        90.0,
    ]
    assert station["fatherId"] == "world[0]" and target["fatherId"] == "fStation[0]"
    assert all(float(target[a]) == 0.0 for a in ("x", "y", "z", "rx", "ry", "rz"))
    tools = [
        [float(tool[a]) for a in ("x", "y", "z", "rx", "ry", "rz")]
        for tool in values(files, "gauge/gauge.dtx", "tPath")
    ]
    assert tools[:3] == [
        [10.0, 0.25, 105.0, 0.0, 0.0, 0.0],
        [12.0, 0.25, 105.0, 0.0, 0.0, 90.0],
        [14.0, 0.5, 105.0, 0.0, 90.0, 0.0],
    ]
    assert {speed["tmax"] for speed in values(files, "gauge/gauge.dtx", "mPath")} == {
        "99999",
        "5.000",
    }


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("motion", "setup"), VARIANTS)
@pytest.mark.always
def test_random_programs_are_applications(
    random_application, assert_applications, seed, motion, setup
):
    assert_applications(staubli.write(random_application(seed, motion, setup, max_points=60)))


def test_same_program_same_bytes(random_application):
    assert staubli.write(random_application(3, max_points=60)) == staubli.write(
        random_application(3, max_points=60)
    )


@pytest.mark.parametrize(("motion", "setup"), VARIANTS)
def test_a_dry_run_moves_the_same_and_switches_nothing(random_application, motion, setup):
    wet = random_application(5, motion, setup, max_points=10**4)
    files, dry = staubli.write(wet), staubli.write(dataclasses.replace(wet, dry_run=True))
    assert not any(b"doDeposit" in content for content in dry.values())
    assert "// dry run: no deposit" in lines(dry, "Random/start.pgx")
    moving = [
        [line for line in lines(f, "Random/start.pgx") if "move" in line or "for " in line]
        for f in (files, dry)
    ]
    assert moving[0] == moving[1] and len(moving[0]) > 10


# ---- speeds


def test_percent_of_the_fastest_axis_gives_the_time_of_the_move():
    files = staubli.write(JOINT)
    first_speed, rapid, *deposit, last_speed = [
        float(speed["vel"]) for speed in values(files, "Joint/Joint.dtx", "mPath")
    ]
    assert first_speed == 10.0  # the robot's start is unknown
    assert rapid == pytest.approx(100.0 * 5.0 / 700.0 / 0.8, abs=1e-5)
    # axis 6 decides although axis 3 is slower; at the end axis 1 does
    assert deposit == pytest.approx(
        [100.0 * 1.0 / 700.0 / 0.2, 100.0 * 1.4 / 700.0 / 0.25], abs=1e-5
    )
    assert last_speed == pytest.approx(100.0 * 1.25 / 287.0, abs=1e-5)


def test_moves_too_fast_or_too_slow_for_a_percentage_are_refused():
    fast = program(
        moves("rapid", np.zeros(6)), moves("deposit", [0, 0, 32.0, 0, 0, 0], 0.1, layer=2, bead=1)
    )
    assert "100.3 %" in refusal(fast, code="JOINT_SPEED", where="layer 2 bead 1")
    slow = program(moves("rapid", np.zeros(6)), moves("deposit", [0, 0, 0.03, 0, 0, 0], 10.0))
    assert "0.0009404 %" in refusal(slow, code="JOINT_SPEED")


def test_blending_never_reaches_past_half_a_move():
    for blend, share in ((0, 0.0), (50, 0.25), (100, 0.5)):
        files = staubli.write(dataclasses.replace(JOINT, blend=blend))
        rapid, _, *deposit, last_move = values(files, "Joint/Joint.dtx", "mPath")
        assert rapid["blend"] == last_move["blend"] == "off"
        # moves of 6 mm/s in 0.2 s and 0.25 s: the shorter one is 1.2 mm long
        assert {(d["blend"], d["leave"], d["reach"]) for d in deposit} == {
            ("joint" if blend else "off", f"{1.2 * share:.3f}", f"{1.2 * share:.3f}")
        }
    files = staubli.write(dataclasses.replace(GAUGE, max_points=20))
    assert [d["blend"] for d in values(files, "gauge/gauge.dtx", "mPath")] == [
        "off",
        "off",
        "Cartesian",
        "off",
        "off",
        "Cartesian",
    ]


@pytest.mark.parametrize("speed", [0.004, 1e6, np.nan])
def test_path_speeds_that_cannot_be_written_are_refused(speed):
    blocks = tuple(
        dataclasses.replace(b, speed=np.full(len(b), speed)) if isinstance(b, Moves) else b
        for b in GAUGE.blocks
    )
    refusal(dataclasses.replace(GAUGE, blocks=blocks), code="MOVE_SPEED", where="layer 0 bead 0")


# ---- parts


def test_parts_hold_whole_beads_and_are_loaded_away_from_them(assert_applications):
    files = staubli.write(beads(3, 20, layers=2, max_points=50))
    assert_applications(files)
    assert lines(files, "part/start.pgx")[:5] == [
        'if prog:libLoad("./part01")!=0', 'popUpMsg("part01 cannot be loaded")', "return", "endIf", "call prog:start()",
    ]  # fmt: skip
    part_lines = [lines(files, f"part/part{n:02d}/start.pgx") for n in (1, 2, 3)]
    for number, statements in enumerate(part_lines):
        assert statements.count("doDeposit=true") == statements.count("doDeposit=false") == 2
        # the first move away from the last bead belongs to its part, so the next part loads while
        # the nozzle is in the air
        last_move = [line for line in statements if line.startswith(("movej", "for"))][-1]
        after_deposit = statements[
            max(n for n, line in enumerate(statements) if line == "doDeposit=false") :
        ]
        assert (last_move in after_deposit) == (number < 2)
        points = len(values(files, f"part/part{number + 1:02d}/part{number + 1:02d}.dtx", "jPath"))
        assert points == (45, 44, 43)[number] <= 50


def test_the_parts_of_a_program_are_the_program(random_application):
    for seed in range(6):
        for motion, setup in VARIANTS:
            complete = staubli.read(
                staubli.write(random_application(seed, motion, setup, max_points=10**5))
            )
            in_parts = staubli.read(
                staubli.write(random_application(seed, motion, setup, max_points=50))
            )
            for field in (
                candidate for candidate in dataclasses.fields(complete) if candidate.name != "lines"
            ):
                np.testing.assert_array_equal(
                    getattr(in_parts, field.name), getattr(complete, field.name), field.name
                )


def test_a_bead_longer_than_a_part_is_refused_with_what_it_needs():
    message = refusal(
        beads(2, 25, max_points=20, layers=2), code="BEAD_TOO_LONG", where="program.max_points"
    )
    assert "layer 0 bead 0 has 27 points" in message and message.endswith("use at least 28")
    staubli.write(beads(2, 25, max_points=28, layers=2))


def test_a_bead_that_goes_on_through_layers_is_no_place_to_cut():
    through = program(
        LayerStart(0), moves("rapid", np.zeros(6)), DepositOn(),
        moves("deposit", np.ones((20, 6)) * np.arange(1, 21)[:, None]),
        LayerStart(1), moves("deposit", np.ones((20, 6)) * np.arange(20, 0, -1)[:, None] * 1.01, layer=1), DepositOff(),
    )  # fmt: skip
    refusal(dataclasses.replace(through, max_points=30), code="BEAD_TOO_LONG")
    staubli.write(through)


# ---- names and refusals


@pytest.mark.parametrize(("name", "why", "proposal"), [
    ("", "empty", "am"),
    ("my part", "letters", "my_part"),
    ("Größe", "letters", "Grosse"),
    ("2nd", "start with a letter", "am_2nd"),
    ("_x", "start with a letter", "x"),
    ("x" * 16, "15 characters", "x" * 12),
    ("con", "reserved", "am_con"),
    ("endFor", "reserved", "am_endFor"),
    ("prog", "reserved", "am_prog"),
])  # fmt: skip
def test_names_the_controller_refuses(name, why, proposal):
    message = refusal(dataclasses.replace(JOINT, name=name), code="PROGRAM_NAME", where="name")
    assert why in message and message.endswith(f"use {proposal!r}")
    staubli.write(dataclasses.replace(JOINT, name=proposal))


def test_names_without_room_for_the_digits_of_the_parts_and_calls_of_own_programs_are_refused():
    staubli.write(beads(3, 20, name="x" * 13, max_points=25))
    assert "2 digits" in refusal(
        beads(3, 20, name="x" * 14, max_points=25), code="PROGRAM_NAME", where="name"
    )
    for called in ("Part", "part02", "two words", "start"):
        where = "process.between_layers.call"
        refusal(program(moves("rapid", np.ones(6)), Call(called)), code="PROGRAM_NAME", where=where)
    staubli.write(program(moves("rapid", np.ones(6)), Call("party")))


def test_what_cannot_be_said_is_refused():
    still = program(moves("rapid", np.ones(6)))
    refusal(
        dataclasses.replace(still, setup="rotary-table"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    assert "axis 6" in refusal(
        dataclasses.replace(still, continuous=(False,) * 5 + (True,)),
        code="ENDLESS_AXIS",
        where="cell.limits",
    )
    for speeds in ((), (1.0,) * 5 + (math.inf,)):
        refusal(
            dataclasses.replace(still, max_speed=speeds),
            code="NO_JOINT_SPEED",
            where="cell.machine",
        )
    refusal(
        dataclasses.replace(still, motion="cartesian"), code="NO_POSITIONS", where="program.motion"
    )
    refusal(program(LayerStart(0)), code="NOTHING_TO_WRITE")
    refusal(program(moves("rapid", [0, 0, 0, np.nan, 0, 0])), code="UNREACHABLE")
    refusal(program(moves("rapid", np.ones(5))), code="UNSUPPORTED_AXES", where="program.post")


def test_the_catalogue():
    assert catalogue.load("staubli") is staubli
