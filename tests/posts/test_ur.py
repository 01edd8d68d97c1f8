# SPDX-License-Identifier: LGPL-2.1-or-later
"""Universal Robots scripts: exact bytes, blends, times, parts and refusals.

Except for its `end` and `p[`, URScript is so close to Python that the test runs a text as Python,
with functions that record the robot calls: a second opinion that shares no code with the post's
reader.
"""

import dataclasses
import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.orientation import ROTATION_VECTOR
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
from freecad_am.posts.ur import post as ur
from tests.posts.fanuc_programs import GOLDEN_JOINT, GOLDEN_TABLE, beads, moves, program

LIMITED = dataclasses.replace(
    GOLDEN_JOINT,
    continuous=(False,) * 6,
    setup="tool-on-robot",
    carried=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0),
)
TABLE = dataclasses.replace(
    GOLDEN_TABLE,
    station=(700.0, 10.5, -100.0, 0.1, -0.2, 3.0),
    carried=(0.0, 0.0, 150.0, np.pi, 0.0, 0.5),
)


def put_part_on_robot(source, radius=100.0):
    """Return the program with a part on the robot, on a flange that turns with the first axis and
    shifts with the second."""

    def flange(run):
        poses = np.tile(np.eye(4), (len(run), 1, 1))
        sine, cosine = np.sin(run.joints[:, 0]), np.cos(run.joints[:, 0])
        poses[:, 0, 0], poses[:, 0, 1], poses[:, 1, 0], poses[:, 1, 1] = cosine, -sine, sine, cosine
        poses[:, 0, 3] = radius * run.joints[:, 1]
        return dataclasses.replace(run, flange=poses)

    blocks = tuple(flange(block) if isinstance(block, Moves) else block for block in source.blocks)
    return dataclasses.replace(source, blocks=blocks, setup="part-on-robot", carried=(0.0,) * 6)


def put_tool_on_robot(source):
    return dataclasses.replace(source, setup="tool-on-robot")


def shift_beads(source):
    """Return the program with beads that do not begin at the end of the rapid to them."""

    def shift(block):
        is_rapid = isinstance(block, Moves) and block.kind == "rapid"
        return dataclasses.replace(block, joints=block.joints - 0.01) if is_rapid else block

    return dataclasses.replace(source, blocks=tuple(shift(block) for block in source.blocks))


GOLDENS = {
    "joint": LIMITED,
    "table": TABLE,
    "carried": put_part_on_robot(
        shift_beads(beads(1, 12, layers=2, name="carried", max_points=14))
    ),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_programs_to_the_byte(root, name):
    ((file, content),) = ur.write(GOLDENS[name]).items()
    assert content == (root / "tests/golden/ur" / file).read_bytes()


def run_script(files):
    """Return (function, arguments by name or position) of every robot call of a script, in
    order."""
    (content,) = files.values()
    lines = [line for line in content.decode("ascii").split("\n") if line.strip() != "end"]
    text = "\n".join(lines).replace("global platform =", "global platform; platform =")
    calls = []

    class Pose(tuple):
        def __repr__(self):
            return f"p{list(self)}"

    class Poses:
        def __getitem__(self, values):
            return Pose(values)

    def keeps(function, result=None):
        def call(*arguments, **named):
            if result is None:
                calls.append((function, *arguments, named) if named else (function, *arguments))
            return result(*arguments) if result else None

        return call

    waited = []

    def inputs(*pin):
        waited.append(pin)
        if len(waited) % 2 == 0:
            calls.append(("waited", *pin))
        return len(waited) % 2 == 0

    def analogue(pin):
        waited.append(pin)
        if len(waited) % 2 == 0:
            calls.append(("below", pin))
        return 1e9 if len(waited) % 2 else -1e9

    names = {
        "p": Poses(),
        "movej": keeps("movej"),
        "movep": keeps("movep"),
        "set_tcp": keeps("set_tcp"),
        "sleep": keeps("sleep"),
        "set_standard_digital_out": keeps("out"),
        "set_configurable_digital_out": keeps("configurable"),
        "get_standard_digital_in": inputs,
        "get_configurable_digital_in": lambda pin: inputs("configurable", pin),
        "get_standard_analog_in": analogue,
        "pose_trans": lambda frame, pose: ("in", frame, pose),
        "get_inverse_kin": lambda pose, near: ("of", pose, near),
        "clean": keeps("clean"),
    }
    exec(compile(text, "script", "exec"), names)
    (main,) = (name for name in re.findall(r"^def (\w+)\(\):", text, re.MULTILINE))
    names[main]()
    return calls


def rotation_by_series(vector):
    """Return the rotation of a vector, by its series."""
    x, y, z = vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix, term = np.eye(3), np.eye(3)
    for k in range(1, 40):
        term = term @ cross / k
        matrix = matrix + term
    return matrix


def expected_calls(source):
    """Return the expected calls from the blocks of a program, without numbers that depend on
    rounding."""
    for block in source.blocks:
        if isinstance(block, Moves):
            for k in range(len(block)):
                yield ("move", block, k)
        elif isinstance(block, DepositOn):
            yield ("out", source.deposit_output - 1, True)
            yield ("sleep", block.lead)
        elif isinstance(block, DepositOff):
            yield ("sleep", block.lead)
            yield ("out", source.deposit_output - 1, False)
        elif isinstance(block, Wait):
            yield ("sleep", block.seconds)
        elif isinstance(block, WaitInput):
            yield ("waited", block.number - 1)
        elif isinstance(block, Call):
            yield (block.program,)


def random_script(random_program, seed, motion):
    program_ = random_program(seed, motion, continuous=False)
    blocks = tuple(
        dataclasses.replace(
            block,
            duration=np.clip(block.duration, 0.05, 40.0),
            speed=np.clip(block.speed, 6.0, 200.0),
        )
        if isinstance(block, Moves)
        else block
        for block in program_.blocks
    )
    return dataclasses.replace(
        program_,
        name="script",
        blocks=blocks,
        setup="tool-on-robot",
        deposit_output=seed % 8 + 1,
        station=(1.0, 2.0, 3.0, 0.1, 0.2, 0.3),
        carried=(4.0, 5.0, 6.0, 0.3, 0.2, 0.1),
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_a_script_run_as_python_asks_for_what_the_program_holds(random_program, seed, motion):
    source = random_script(random_program, seed, motion)
    calls = [
        call
        for call in run_script(ur.write(source))
        if call[0] != "set_tcp" and call[:2] != ("sleep", 0.01)
    ]
    expected = [what for what in expected_calls(source) if what != ("sleep", 0.0)]
    assert len(calls) == len(expected)
    for call, what in zip(calls, expected):
        if what[0] != "move":
            assert call == pytest.approx(what, abs=6e-4) if what[0] == "sleep" else call == what
            continue
        (function, target, named), (_, run, k) = call, what
        linear = run.interpolation == "linear"
        assert function == ("movep" if linear else "movej")
        if motion == "joint":
            seed_joints, pose = target, None
        elif linear:
            seed_joints, pose = None, target
        else:
            _, pose, seed_joints = target
        if seed_joints is not None:
            np.testing.assert_allclose(seed_joints, run.joints[k], atol=5.1e-8)
        if pose is not None:
            np.testing.assert_allclose(pose[2][:3], 0.001 * run.position[k], atol=5.1e-8)
            np.testing.assert_allclose(rotation_by_series(pose[2][3:]), run.rotation[k], atol=2e-7)
            np.testing.assert_allclose(pose[1], [0.001, 0.002, 0.003, *pose[1][3:]], atol=1e-9)
        if linear:
            assert (named["a"], named["v"]) == (
                1.2,
                pytest.approx(0.001 * run.speed[k], abs=5.1e-7),
            )
        else:
            assert named["t"] == pytest.approx(run.duration[k], abs=5.1e-7)
        assert (named["r"] > 0.0) == (not run.stops[k] and source.blend > 0)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_random_programs_come_back(random_program, seed, motion):
    source = random_script(random_program, seed, motion)
    readback = ur.read(ur.write(source))
    joints, duration, speed, stops = (
        np.concatenate([getattr(run, name) for run in source.moves])
        for name in ("joints", "duration", "speed", "stops")
    )
    linear = np.concatenate(
        [np.full(len(run), run.interpolation == "linear") for run in source.moves]
    )
    assert (
        readback.linear.tolist() == linear.tolist()
        and readback.stops.tolist() == (stops | (source.blend == 0)).tolist()
    )
    stated_joints = readback.joints if motion == "joint" else readback.near
    np.testing.assert_allclose(stated_joints[~linear], joints[~linear], atol=5.1e-8)
    assert readback.digits == 0.5e-7 if motion == "joint" else readback.near_digits == 0.5e-7
    np.testing.assert_allclose(readback.duration[~linear], duration[~linear], atol=5.1e-7)
    np.testing.assert_allclose(readback.speed[linear], speed[linear], atol=5.1e-4)
    if motion == "cartesian":
        position, rotation = (
            np.concatenate([getattr(run, name) for run in source.moves])
            for name in ("position", "rotation")
        )
        np.testing.assert_allclose(readback.position, position, atol=5.1e-5)
        np.testing.assert_allclose(readback.rotation, rotation, atol=2e-7)


def test_rotations_of_half_a_turn_and_of_none():
    for axis in np.eye(3)[[0, 1, 2]], np.array([[0.6, 0.0, 0.8], [-0.6, 0.8, 0.0]]):
        for angle in (0.0, 1e-9, 1e-4, 3.0, np.pi - 1e-7, np.pi):
            rotation_vectors = np.array(
                [rotation_by_series(angle * component) for component in axis]
            )
            vectors = ROTATION_VECTOR.numbers(rotation_vectors)
            np.testing.assert_allclose(
                [rotation_by_series(vector) for vector in vectors], rotation_vectors, atol=1e-8
            )
            assert np.linalg.norm(vectors, axis=1).max() <= np.pi + 1e-12


# ---- blends


def radii(files):
    (content,) = files.values()
    return [
        1000.0 * float(value)
        for value in re.findall(r"r=([\d.]+)\)$", content.decode(), re.MULTILINE)
    ]


@pytest.mark.parametrize("blend", [100, 50, 0])
def test_blends_are_two_fifths_of_the_shorter_neighbour_and_never_meet(blend):
    duration = np.array([0.5, 1.0, 0.25, 0.5, 2.0])
    run = moves("deposit", np.zeros((5, 6)), duration)  # 6 mm/s
    source = put_tool_on_robot(
        program(moves("rapid", np.zeros(6)), DepositOn(), run, DepositOff(), blend=blend)
    )
    lengths = 6.0 * duration
    blend_radii = radii(ur.write(source))
    assert blend_radii == pytest.approx(
        [0.0, *(0.004 * blend * np.minimum(lengths[:-1], lengths[1:])), 0.0], abs=0.0011
    )
    assert all(
        radius + next_radius <= length
        for radius, next_radius, length in zip(blend_radii[1:], blend_radii[2:], lengths[1:])
    )


def test_the_tool_that_blends_count_on_is_one_that_moves_where_the_part_spins():
    """A part that turns about the flange's own axis does not move the middle of the flange."""
    values = np.zeros((9, 6))
    values[:, 0] = np.degrees(0.05 * np.arange(9))
    source = put_part_on_robot(
        program(
            moves("rapid", values[0]), DepositOn(), moves("deposit", values[1:], 0.5), DepositOff()
        )
    )
    files = ur.write(source)
    match = re.search(rb"set_tcp\(p\[(.*?), (.*?), ", files["part.script"])
    assert abs(float(match[1])) + abs(float(match[2])) == pytest.approx(0.2)
    chord = 2.0 * 200.0 * np.sin(0.025)
    assert radii(files)[1:-1] == pytest.approx([0.4 * chord] * 7, abs=0.0011)


def test_a_blend_too_small_to_be_written_is_refused():
    values = np.zeros((4, 6))
    source = put_part_on_robot(
        program(moves("rapid", values[0]), DepositOn(), moves("deposit", values, 0.5), DepositOff())
    )
    assert "stop there with the deposit on" in refusal(
        source, code="BLEND_RADIUS", where="layer 0 bead 0"
    )
    assert set(radii(ur.write(dataclasses.replace(source, blend=0)))) == {0.0}


# ---- events and parts


def test_the_order_of_a_layer():
    source = program(
        LayerStart(12), moves("rapid", np.zeros((2, 6))), DepositOn(0.5), moves("deposit", np.zeros((1, 6))),
        DepositOff(0.125), Wait(0.0001), WaitInput(12), WaitBelow(2, 1.75, 12, 0), Call("clean_1"), deposit_output=9,
    )  # fmt: skip
    (content,) = ur.write(put_tool_on_robot(source)).values()
    lines = [
        re.sub(r"\(\[.*\], a=.*, t", "(t", line.strip()) for line in content.decode().split("\n")
    ]
    assert lines[lines.index("# layer 12"):] == [
        "# layer 12", "movej(t=0.100000, r=0.000000)", "movej(t=0.100000, r=0.000000)",
        "set_configurable_digital_out(0, True)", "sleep(0.500)", "movej(t=0.100000, r=0.000000)", "sleep(0.125)",
        "set_configurable_digital_out(0, False)", "sleep(0.001)", "while get_configurable_digital_in(3) == False:",
        "sleep(0.010)", "end", "while get_standard_analog_in(1) >= 1.750000:", "sleep(0.100)", "end", "clean_1()", "end", "",
    ]  # fmt: skip
    dry = ur.write(put_tool_on_robot(dataclasses.replace(source, dry_run=True)))[
        "part.script"
    ].decode()
    assert "digital_out" not in dry and "# dry run: no deposit" in dry


def test_parts_are_functions_of_whole_beads_in_one_file():
    source = put_tool_on_robot(beads(3, 20, layers=4, max_points=50))
    (content,) = ur.write(source).values()
    text = content.decode()
    part_texts = re.split(r"(?m)^  def part\d\d\(\):$", text)[1:]
    assert len(part_texts) == 6 and re.findall(r"(?m)^  (part\d\d)\(\)$", text) == [
        f"part{n:02d}" for n in range(1, 7)
    ]
    assert (
        all(part_text.count("True") == part_text.count("False") == 2 for part_text in part_texts)
        and "264 moves in 6 parts" in text
    )
    complete = run_script(ur.write(dataclasses.replace(source, max_points=10**6)))
    assert run_script({"part.script": content}) == complete


# ---- refusals


def refusal(source, *, code, where=None):
    with pytest.raises(InputError) as raised:
        ur.write(source)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


@pytest.mark.parametrize(("name", "why", "proposal"), [
    ("my part", "letters", "my_part"), ("Größe", "letters", "Grosse"), ("2nd", "start with a letter", "am_2nd"),
    ("movej", "reserved", "am_movej"), ("While", "reserved", "am_While"), ("x" * 31, "30 characters", "x" * 26),
    ("", "empty", "am"),
])  # fmt: skip
def test_names_the_controller_refuses(name, why, proposal):
    source = put_tool_on_robot(program(moves("rapid", np.zeros(6)), name=name))
    message = refusal(source, code="PROGRAM_NAME", where="name")
    assert why in message and message.endswith(f"use {proposal!r}")
    assert list(ur.write(dataclasses.replace(source, name=proposal))) == [f"{proposal}.script"]


def test_what_no_script_says_is_refused():
    still = moves("rapid", np.zeros(6))
    carrying = dataclasses.replace(TABLE, setup="part-on-robot")
    assert "documented" in refusal(carrying, code="REMOTE_TCP", where="program.motion")
    refusal(
        dataclasses.replace(LIMITED, setup="rotary-table"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    refusal(put_tool_on_robot(GOLDEN_JOINT), code="ENDLESS_AXIS", where="cell.limits")
    refusal(program(still), code="NO_POSITIONS")  # a part on a robot without known flange poses
    refusal(
        put_tool_on_robot(program(still, DepositOn(), deposit_output=17)),
        code="DEPOSIT_OUTPUT",
        where="program.deposit_output",
    )
    refusal(
        put_tool_on_robot(program(still, WaitInput(17))),
        code="DEPOSIT_INPUT",
        where="process.between_layers.input",
    )
    refusal(put_tool_on_robot(program(still, WaitBelow(3, 1.0, 0, 0))), code="ANALOGUE_INPUT")
    refusal(
        put_tool_on_robot(program(still, Call("Part-2"))),
        code="PROGRAM_NAME",
        where="process.between_layers.call",
    )
    assert "program of the job" in refusal(
        put_tool_on_robot(program(still, Call("part"))), code="PROGRAM_NAME"
    )
    short = put_tool_on_robot(program(still, moves("deposit", np.zeros((3, 6)), 0.001, 4, 2)))
    assert "1 ms, less than the 2 ms" in refusal(short, code="MOVE_TIME", where="layer 4 bead 2")
    run = dataclasses.replace(TABLE.blocks[2], speed=np.array([6.0, 1000.1]))
    refusal(dataclasses.replace(TABLE, blocks=(*TABLE.blocks[:2], run)), code="MOVE_SPEED")
    wired = dataclasses.replace(LIMITED.blocks[2], wire=np.full(3, 5.0))
    refusal(dataclasses.replace(LIMITED, blocks=(still, wired)), code="NO_WIRE_OUTPUT")


def test_a_rapid_of_no_time_takes_a_millisecond():
    (content,) = ur.write(
        put_tool_on_robot(program(moves("rapid", np.zeros((3, 6)), 0.0)))
    ).values()
    assert re.findall(rb"t=([\d.]+)", content) == [b"0.001000"] * 3


# ---- reading


def by_hand(pattern="", replacement=""):
    text = ur.write(TABLE)["TABLE.script"].decode()
    changed = re.sub(pattern, replacement, text, count=1) if pattern else text
    assert changed != text or not pattern
    return {"TABLE.script": changed.encode()}


@pytest.mark.parametrize(("pattern", "replacement", "where", "why"), [
    ("a=1.2, v", "v", "TABLE.script line 6", "is not understood"),
    ("movep", "movel", "TABLE.script line 6", "is not understood"),
    (r"v=0\.006000", "v=0.003*2", "TABLE.script line 6", "is not understood"),
    (r"v=0\.006000", "v=speed()", "TABLE.script line 6", "is not understood"),
    (r"v=0\.006000", "v=1e-3", "TABLE.script line 6", "is not understood"),
    ("platform, p", "plane, p", "TABLE.script line 4", "is not understood"),
    ("  set_tcp", "  x = 1\n  set_tcp", "TABLE.script line 2", "'x = 1' is not understood"),
    ("  set_tcp", "  import os\n  set_tcp", "TABLE.script line 2", "is not understood"),
    ("  set_tcp", "  thread x():\n  set_tcp", "TABLE.script line 2", "is not understood"),
    ("def TABLE", "def OTHER", "TABLE.script", "the function in the file is called OTHER"),
    ("end\n$", "end\nTABLE()\n", "TABLE.script", "a single function"),
    ("def TABLE", "x = 1\ndef TABLE", "TABLE.script", "a single function"),
    (r"  movep[^\n]*\n", "  def a():\n    a()\n  end\n  a()\n", "TABLE.script line 7", "a calls itself"),
    (r"  movep[^\n]*\n", "  a()\n  def a():\n    sleep(0.1)\n  end\n", "TABLE.script line 6", "before it is defined"),
    (r"  movep[^\n]*\n", "  while True:\n    sleep(0.1)\n  end\n", "TABLE.script line 6", "is not understood"),
    (r"  movep[^\n]*\n", "  while get_standard_digital_in(1) == False:\n  end\n", "TABLE.script line 6", "a loop that"),
    (r"  movep[^\n]*\n", "  set_tcp(p[0.0, 0.0, 0.0, 0.0, 0.0, 0.0])\n", "TABLE.script line 6", "sets tool or platform a second time"),
    (r"  movep[^\n]*\n", "  set_standard_digital_out(1, True)\n", "TABLE.script line 6", "a second output"),
    (r"  movep", "movep", "TABLE.script line 6", "outside its function"),
    (r"movej\(get_inverse_kin\([^\n]*\), (\[[^\]]*\])\)", r"movej(\1", "TABLE.script line 4", "positions are given"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(pattern, replacement, where, why):
    with pytest.raises(InputError) as raised:
        ur.read(by_hand(pattern, replacement))
    assert raised.value.code == "UNREADABLE_PROGRAM" and why in raised.value.message
    assert raised.value.where == where


def test_two_files_and_other_characters_are_refused():
    text = by_hand()["TABLE.script"]
    for files in (
        {},
        {"TABLE.script": text, "OTHER.script": text},
        {"TABLE.script": b"# \xe9\n" + text},
    ):
        with pytest.raises(InputError) as raised:
            ur.read(files)
        assert raised.value.code == "UNREADABLE_PROGRAM"


def test_coarse_digits_of_an_edited_text_are_told():
    readback = ur.read(by_hand(r"v=0\.006000", "v=0.006"))
    assert readback.speed_digits == 0.5 and ur.read(by_hand()).speed_digits == pytest.approx(0.0005)
