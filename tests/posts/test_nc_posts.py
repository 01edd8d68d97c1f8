# SPDX-License-Identifier: LGPL-2.1-or-later
"""SINUMERIK and LinuxCNC programs: exact bytes, feeds, parts, names and refusals."""

import dataclasses
import math
import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.program import Call, DepositOff, DepositOn, LayerStart, Moves, Wait, WaitInput
from freecad_am.posts import catalogue, nc_numbers
from freecad_am.posts.linuxcnc import post as linuxcnc
from freecad_am.posts.siemens import post as siemens
from tests.posts.nc_programs import deposit_of, moves, program, random_program, set_options

POSTS = (siemens, linuxcnc)


def text(files):
    (content,) = files.values()
    return content.decode("ascii")


def column(source, key):
    return np.concatenate([getattr(run, key) for run in source.moves])


def refusal(post, source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        post.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


# a ring on a cone, where only C turns, then a line along the cone, where C stands still
RING = [[10.0, 0.00001 * (n % 2), 5.0, -20.0, 15.0 * n] for n in range(4)]
LINE = [[12.0 + n, 0.25 * n, 5.0, -20.0, 60.0] for n in range(3)]
JOINT = program(
    LayerStart(0),
    moves("rapid", [[10.0, 0.0, 55.0, -20.0, 0.0], [10.0, 0.0, 5.0, -20.0, 0.0]], [10.0, 0.8]),
    DepositOn(0.5), moves("deposit", RING[1:], [0.5, 0.5, 0.4]), DepositOff(0.25),
    Wait(12.5), WaitInput(3), Call("clean"),
    LayerStart(1),
    moves("rapid", LINE[:1], 1.0, layer=1), DepositOn(), moves("deposit", LINE[1:], [0.2, 0.25], layer=1), DepositOff(),
    moves("rapid", [[14.0, 0.5, 55.0, -20.0, 60.0]], 1.0, layer=1),
    name="Joint", remarks=('A remark (in brackets) with "marks": Größe',), deposit_output=3,
)  # fmt: skip


def tip_bead(layer):
    tilt = np.radians([10.0, 11.0, 12.0])
    directions = np.stack([np.sin(tilt), np.zeros(3), np.cos(tilt)], axis=1)
    axes = [
        [10.0, 0.25, 5.0, 10.0, 90.0],
        [11.0, 0.25, 5.0, 11.0, 90.0],
        [12.0, 0.5, 5.0, 12.0, 91.0],
    ]
    return [
        LayerStart(layer), moves("rapid", axes[:1], layer=layer), DepositOn(0.5),
        moves("deposit", axes, layer=layer, speed=5.0, direction=directions,
              position=[[10.0, 0.0, 1.0], [11.0, 0.25, 1.0 + layer], [-12.5, 0.0, 1.0]], interpolation="linear"),
        DepositOff(),
    ]  # fmt: skip


def as_arrays(block):
    has_position = isinstance(block, Moves) and block.position
    return dataclasses.replace(block, position=np.array(block.position)) if has_position else block


TIP = program(*map(as_arrays, [*tip_bead(0), *tip_bead(1)]), name="tip", motion="cartesian", max_points=5, user_frame=2,
              continuous=(False,) * 4 + (True,))  # fmt: skip
GOLDENS = {"joint": JOINT, "path": set_options(JOINT, path_feed=True), "tip": TIP}


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
@pytest.mark.parametrize("name", GOLDENS)
def test_golden_programs_to_the_byte(root, name, post):
    folder = root / "tests/golden" / post.__name__.split(".")[-2] / name
    assert post.write(GOLDENS[name]) == {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    ("motion", "feed"), [("joint", False), ("joint", True), ("cartesian", False)]
)
def test_random_programs_come_back(post, seed, motion, feed):
    source = set_options(random_program(seed, motion, seed % 2 == 1), path_feed=feed)
    files = post.write(source)
    assert files == post.write(source)  # the same bytes
    readback = post.read(files)
    joints, duration, speed = (column(source, key) for key in ("joints", "duration", "speed"))
    deposit = np.repeat(
        [run.kind == "deposit" for run in source.moves], [len(run) for run in source.moves]
    )
    tip = deposit & (motion == "cartesian")
    assert readback.deposit.tolist() == deposit.tolist()
    assert (readback.linear_digits, readback.digits) == pytest.approx((5e-6, math.radians(5e-6)))
    joint_errors = readback.joints - joints
    if post is siemens:  # a continuous axis states no turns
        assert readback.shorter_way.tolist() == list(source.continuous)
        joint_errors[:, 4] -= (
            2.0 * np.pi * np.rint(joint_errors[:, 4] / (2.0 * np.pi)) * source.continuous[4]
        )
    is_stated = np.isfinite(joint_errors)
    assert (is_stated[~tip].all(), is_stated[tip, :3].any(), is_stated[tip, 3:].all()) == (
        True,
        False,
        post is linuxcnc or not tip.any(),
    )
    assert (
        np.abs(joint_errors[:, :3][is_stated[:, :3]]).max() <= 5e-6 + 1e-9
        and np.abs(joint_errors[:, 3:][is_stated[:, 3:]]).max() < 8.8e-8
    )
    timed = np.isfinite(readback.duration)
    assert (timed == ~tip).all()
    moving = timed & (np.abs(np.diff(np.round(joints, 9), axis=0, prepend=0.0)).max(axis=1) > 0.0)
    assert (np.abs(readback.duration - duration) <= readback.duration_digits + 1e-9 * duration)[
        moving
    ].all()
    assert (readback.duration_digits / duration)[moving].max() <= 5.1e-7  # seven digits
    if motion == "cartesian":
        position, direction = column(source, "position"), column(source, "direction")
        assert (
            np.abs(readback.position - position)[tip].max() <= 5e-6 + 1e-9
            and np.isnan(readback.position[~tip]).all()
        )
        assert (np.abs(readback.speed - speed) / speed)[tip].max() < 1e-6 and np.isnan(
            readback.speed[~tip]
        ).all()
        if post is siemens:
            assert np.abs(readback.direction - direction)[
                tip
            ].max() < 1.5e-6 and readback.direction_digits == pytest.approx(5e-7)


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_the_parts_of_a_program_are_the_program(post):
    for seed, motion in ((0, "joint"), (1, "cartesian"), (2, "joint")):
        files = [
            post.write(random_program(seed, motion, max_points=max_points))
            for max_points in (10**5, 45)
        ]
        assert len(files[0]) == 1 and len(files[1]) > 2
        complete, in_parts = map(post.read, files)
        for field in (
            candidate for candidate in dataclasses.fields(complete) if candidate.name != "lines"
        ):
            np.testing.assert_array_equal(
                getattr(in_parts, field.name), getattr(complete, field.name), field.name
            )


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_a_dry_run_moves_the_same_and_switches_nothing(post, motion):
    source = random_program(5, motion, max_points=10**4, deposit_output=7)
    wet, dry = text(post.write(source)), text(post.write(dataclasses.replace(source, dry_run=True)))
    assert "dry run: no deposit" in dry and not re.search(
        r"H7=|M6[2-5]|G4 [FP](?:0\.[2-9]|1\.250)", dry
    )
    assert [line.partition("G1 ")[2] for line in wet.split("\n") if "G1 " in line] == [
        line.partition("G1 ")[2] for line in dry.split("\n") if "G1 " in line
    ]
    assert not post.read(post.write(dataclasses.replace(source, dry_run=True))).deposit.any()


def test_only_speeds_are_compressed():
    """Compressed blocks have the F of the last one, which is right for a speed and wrong for a
    time."""
    for motion, feed, compress in (
        ("joint", False, True),
        ("cartesian", False, True),
        ("cartesian", False, False),
    ):
        source = set_options(
            random_program(3, motion, max_points=10**4), path_feed=feed, compress=compress
        )
        written = text(siemens.write(source))
        assert ("COMPCAD" in written) == (compress and (motion == "cartesian"))
        for inside in re.findall(r"COMPCAD\n(.*?)COMPOF", written, re.DOTALL):
            assert re.fullmatch(
                r"(?:N\d+ (?:G9 )?G1 X\S+ Y\S+ Z\S+ A3=\S+ B3=\S+ C3=\S+ F\S+\n)+N\d+ $", inside
            )
    line = set_options(JOINT, path_feed=True)
    assert text(siemens.write(line)).count("COMPCAD") == 1  # the ring states times, the line speeds
    assert "COMPCAD" not in text(
        siemens.write(dataclasses.replace(line, nc=dataclasses.replace(line.nc, compress=False)))
    )


def test_path_feeds_are_speeds_of_the_linear_axes():
    """A path feed is V_s of Dai 2020, section 3, computed by hand from the line of the golden
    program."""
    step = math.hypot(1.0, 0.25)
    for post in POSTS:
        feeds = re.findall(
            r"G1 X1[34].* F([\d.]+)\n", text(post.write(set_options(JOINT, path_feed=True)))
        )
        # two moves of the bead, then a rapid of one second
        assert [float(feed) for feed in feeds] == pytest.approx(
            [60.0 * step / 0.2, 60.0 * step / 0.25, 60.0], rel=1e-6
        )


def test_linuxcnc_is_told_the_speed_of_slow_moves():
    """LinuxCNC's interpreter uses 0.1 mm/min if the time implies less: on a ring the linear axes
    move by 0.00001 mm."""
    written = text(linuxcnc.write(JOINT))
    ring = re.findall(
        r"\n((?:G9[34] )?)G1 X10.00000 \S+ Z5.00000 \S+ C(?:15|30|45)\.\S+ F(\S+)", written
    )
    assert [float(feed) for _, feed in ring] == pytest.approx(
        [60.0 * 0.00001 / 0.5] * 2 + [60.0 * 0.00001 / 0.4], rel=1e-6
    )
    assert "G94\nG1 X10.00000 Y0.00001" in written
    assert linuxcnc.read(linuxcnc.write(JOINT)).duration[2:5] == pytest.approx(
        [0.5, 0.5, 0.4], rel=1e-6
    )
    assert "G94" not in text(siemens.write(JOINT))


@pytest.mark.parametrize("value", [1e-9, 0.001, 0.99999999, 1.0, 123.4567891, 999999.0])
def test_feeds_have_seven_digits_and_no_exponent(value):
    word = nc_numbers.feed(value)
    assert re.fullmatch(r"F\d+(?:\.\d+)?", word) and float(word[1:]) == pytest.approx(
        value, rel=5.1e-7
    )


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_times_and_speeds_that_cannot_be_written(post):
    def ring(duration):
        bead = moves("deposit", RING[1], duration, layer=2, bead=1)
        return program(moves("rapid", RING[0]), DepositOn(), bead, DepositOff())

    for duration in (0.0, 5e-5, 6.1e4, math.nan):
        assert "cannot be written" in refusal(
            post, ring(duration), code="MOVE_TIME", where="layer 2 bead 1"
        )
    post.write(ring(7e-5))
    for speed in (0.0, 1e-6, 2e4, math.nan):
        blocks = [
            dataclasses.replace(b, speed=np.full(len(b), speed)) if isinstance(b, Moves) else b
            for b in TIP.blocks
        ]
        refusal(
            post,
            dataclasses.replace(TIP, blocks=tuple(blocks)),
            code="MOVE_SPEED",
            where="layer 0 bead 0",
        )


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_words_that_switch_the_deposit(post):
    source = set_options(random_program(2, max_points=10**4), deposit_on="M7", deposit_off="M9")
    written = text(post.write(source))
    assert "M7\n" in written and "M9\n" in written and not re.search(r"H\d+=|M6[45]", written)
    assert post.read(post.write(source)).deposit.tolist() == deposit_of(source)
    for on, off in (("M7", ""), ("", "M9"), ("M7", "M7"), ("on", "off"), ("M7 M8", "M9")):
        refusal(post, set_options(source, deposit_on=on, deposit_off=off), code="DEPOSIT_WORD")
    for word in ("M30", "M02", "M6"):
        changed = set_options(source, deposit_on=word, deposit_off="M9")
        refusal(post, changed, code="DEPOSIT_WORD", where="program.nc.deposit_on")
    changed = set_options(source, deposit_on="H2=1", deposit_off="H2=0")
    if post is linuxcnc:
        refusal(post, changed, code="DEPOSIT_WORD")
    else:
        assert "H2=1\n" in text(post.write(changed))


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_what_cannot_be_said_is_refused(post):
    still = program(moves("rapid", RING))
    refusal(
        post,
        dataclasses.replace(still, setup="part-on-robot"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    for last_axis in "DA":
        changed = dataclasses.replace(still, axis_names=("X", "Y", "Z", "A", last_axis))
        refusal(post, changed, code="UNSUPPORTED_AXES", where="cell.machine")
    refusal(
        post,
        dataclasses.replace(still, axis_names=()),
        code="UNSUPPORTED_AXES",
        where="program.post",
    )
    refusal(post, program(LayerStart(0)), code="NOTHING_TO_WRITE")
    refusal(post, program(moves("rapid", [0, 0, math.nan, 0, 0])), code="UNREACHABLE")
    refusal(
        post,
        dataclasses.replace(JOINT, motion="cartesian"),
        code="NO_POSITIONS",
        where="program.motion",
    )
    refusal(
        post,
        dataclasses.replace(JOINT, deposit_output=100),
        code="DEPOSIT_OUTPUT",
        where="program.deposit_output",
    )
    where = "process.between_layers.input"
    refusal(post, program(moves("rapid", RING), WaitInput(65)), code="DEPOSIT_INPUT", where=where)


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_a_bead_longer_than_a_part_is_a_part_by_itself(post):
    """These controllers read files of any length, so `max_points` cuts between beads and rejects
    none."""
    sizes = (2, 40, 3, 3, 25)
    blocks = [
        block
        for n, size in enumerate(sizes)
        for block in (
            moves("rapid", RING[:1], bead=n),
            DepositOn(),
            moves("deposit", [[n, k, 5.0, 0.0, 0.0] for k in range(size)], bead=n),
            DepositOff(),
        )
    ]
    files = post.write(program(*blocks, max_points=10))
    counts = [content.decode().count("G1 ") for _, content in sorted(files.items())]
    assert counts == [0, 3, 41, 8, 26]  # the main program; both short beads are in one part
    readback = post.read(files)
    assert readback.deposit.tolist() == [on for size in sizes for on in (False, *[True] * size)]


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("motion", "feed"), [("joint", False), ("joint", True), ("cartesian", False)]
)
def test_the_speed_of_the_wire_comes_back(post, seed, motion, feed):
    plain = set_options(random_program(seed, motion), path_feed=feed)
    source = set_options(
        random_program(seed, motion, wire=True), path_feed=feed, wire_output=3, wire_gain=400.0
    )
    files = post.write(source)
    readback, deposit = post.read(files), np.array(deposit_of(source))
    expected = np.concatenate(
        [np.full(len(run), np.nan) if run.wire is None else run.wire for run in source.moves]
    )
    written_values = expected[deposit] * 0.06 * 400.0  # at a gain of 400 a value of 400 is 1 m/min
    assert np.abs(readback.wire[deposit] / written_values - 1.0).max() <= 5.1e-5
    assert (
        np.abs(readback.wire[deposit] - written_values) <= readback.wire_digits[deposit] + 1e-9
    ).all()
    assert (readback.wire_digits[deposit] <= 5.1e-5 * written_values).all()
    written = "".join(content.decode() for _, content in sorted(files.items()))
    within, switches_before = (
        (r"DO \$A_OUTA\[3\]=", r"N\d+ \$A_OUTA\[3\]=")
        if post is siemens
        else (r"M67 E2 Q", r"M68 E2 Q")
    )
    beads = [run.wire for run in source.moves if run.wire is not None]
    assert len(re.findall(switches_before, written)) == len(beads)
    assert len(re.findall(within, written)) == sum(
        int((np.diff(wire) != 0.0).sum()) for wire in beads
    )
    # the only other difference: blocks with a wire value are not compressed
    ours, theirs = (
        [
            re.sub(r"^N\d+ ", "", line)
            for _, content in sorted(program_files.items())
            for line in content.decode().split("\n")
            if not re.search(r"OUTA|M6[78]|COMP", line)
        ]
        for program_files in (files, post.write(plain))
    )
    assert ours == theirs
    for inside in re.findall(r"COMPCAD\n(.*?)COMPOF", written, re.DOTALL):
        assert "OUTA" not in inside


@pytest.mark.parametrize("post", POSTS, ids=["siemens", "linuxcnc"])
def test_the_wire_of_a_dry_run_and_of_outputs_that_are_not_there(post):
    source = random_program(5, wire=True, max_points=10**4)
    last_output = {siemens: 8, linuxcnc: 64}[post]
    post.write(set_options(source, wire_output=last_output))
    where = "program.nc.wire_output"
    assert f"1 to {last_output}" in refusal(
        post, set_options(source, wire_output=last_output + 1), code="WIRE_OUTPUT", where=where
    )
    still = text(
        post.write(set_options(random_program(5, max_points=10**4), wire_output=last_output + 1))
    )
    assert "OUTA" not in still and not re.search(r"M6[78]", still)
    dry = text(
        post.write(
            dataclasses.replace(
                source,
                dry_run=True,
                blocks=tuple(
                    dataclasses.replace(block, wire=None)
                    if isinstance(block, (Moves, DepositOn))
                    else block
                    for block in source.blocks
                ),
            )
        )
    )
    assert "OUTA" not in dry and not re.search(r"M6[78]", dry)
    assert post.read(post.write(random_program(5))).wire is None


def test_what_one_controller_alone_cannot_say():
    for number in (0, 9):
        changed = dataclasses.replace(TIP, user_frame=number)
        refusal(linuxcnc, changed, code="UNSUPPORTED_FRAME", where="program.user_frame")
    tilted = dataclasses.replace(TIP, carried=(0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert "cell.platform: [0, 0, 0, 0, 0, 0]" in refusal(
        linuxcnc, tilted, code="UNSUPPORTED_FRAME", where="program.origin"
    )
    siemens.write(tilted)
    fixed = set_options(TIP, switch_kinematics=False)
    refusal(linuxcnc, fixed, code="NO_TIP_KINEMATICS", where="program.nc.switch_kinematics")
    assert "M42" not in text(linuxcnc.write(set_options(JOINT, switch_kinematics=False)))
    turns = [[0.0, 0.0, 0.0, 0.0, angle] for angle in (0.0, 179.0, 359.5)]
    continuous = program(moves("rapid", turns), continuous=(False,) * 4 + (True,))
    assert "C turns 180.5 deg" in refusal(
        siemens, continuous, code="ENDLESS_STEP", where="layer 0 bead 0"
    )
    linuxcnc.write(continuous)


@pytest.mark.parametrize(
    ("user_frame", "word"), [(0, "G500"), (1, "G54"), (4, "G57"), (5, "G505"), (61, "G561")]
)
def test_work_offsets_of_sinumerik(user_frame, word):
    source = dataclasses.replace(TIP, user_frame=user_frame, max_points=100)
    written = text(siemens.write(source))
    assert f" {word}\nN" in written and siemens.read(siemens.write(source)).position is not None


def test_the_angles_of_a_work_offset_are_the_controllers():
    """The angles turn about Z, then the new Y, then the new X; the expected rotations are
    multiplied here."""
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(3)
    for bryant in [
        *rng.uniform(-3.0, 3.0, (20, 3)),
        np.array([0.3, math.pi / 2.0, 0.2]),
        np.zeros(3),
    ]:
        source = dataclasses.replace(TIP, carried=(1.0, 2.0, 3.0, *bryant))
        match = re.search(
            r"then Z (\S+) Y (\S+) X (\S+) deg", siemens.write(source)["TIP.MPF"].decode()
        )
        rotation = Rotation.from_euler(
            "ZYX", [float(angle) for angle in match.groups()], degrees=True
        )
        assert (rotation.inv() * Rotation.from_euler("XYZ", bryant)).magnitude() < 3e-6


@pytest.mark.parametrize(("post", "name", "why", "proposal"), [
    (siemens, "", "empty", "AM"), (siemens, "my part", "letters", "MY_PART"), (siemens, "Größe", "letters", "GROSSE"),
    (siemens, "x10", "two letters", "AM_X10"), (siemens, "_1", "two letters", "AM_1"),
    (siemens, "x" * 25, "24 characters", "X" * 21),
    (siemens, "traori", "reserved", "AM_TRAORI"), (siemens, "con", "reserved", "AM_CON"),
    (linuxcnc, "", "empty", "am"), (linuxcnc, "my part", "letters", "my_part"), (linuxcnc, "Größe", "letters", "grosse"),
    (linuxcnc, "2nd", "start with a letter", "am_2nd"), (linuxcnc, "x" * 31, "30 characters", "x" * 27),
    (linuxcnc, "Con", "reserved", "am_con"),
])  # fmt: skip
def test_names_the_controllers_refuse(post, name, why, proposal):
    message = refusal(
        post, dataclasses.replace(JOINT, name=name), code="PROGRAM_NAME", where="name"
    )
    assert why in message and message.endswith(f"use {proposal!r}")
    post.write(dataclasses.replace(JOINT, name=proposal))


def test_names_of_parts_and_calls_of_own_programs():
    for post, longest in ((siemens, 24), (linuxcnc, 30)):
        post.write(dataclasses.replace(TIP, name="x" * (longest - 2)))
        renamed = dataclasses.replace(TIP, name="x" * (longest - 1))
        assert "2 digits" in refusal(post, renamed, code="PROGRAM_NAME", where="name")
        for called in ("Tip", "tip02", "two words"):
            source = dataclasses.replace(TIP, blocks=(*TIP.blocks, Call(called)))
            refusal(post, source, code="PROGRAM_NAME", where="process.between_layers.call")
        post.write(dataclasses.replace(TIP, blocks=(*TIP.blocks, Call("tip03"))))


def test_remarks_are_plain_and_carry_nothing_out():
    source = dataclasses.replace(JOINT, remarks=("msg, (debug, x) Größe\n; M30", "py,import os"))
    for post in POSTS:
        written = text(post.write(source))
        assert all(len(line) < 120 for line in written.split("\n")) and "Grosse" in written
        assert post.read(post.write(source)).deposit.any()
    assert "(remark: msg, [debug, x] Grosse ; M30)" in text(linuxcnc.write(source))


def test_the_catalogue():
    assert catalogue.load("siemens") is siemens and catalogue.load("linuxcnc") is linuxcnc
