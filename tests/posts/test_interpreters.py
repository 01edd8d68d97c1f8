# SPDX-License-Identifier: LGPL-2.1-or-later
"""Independent interpreters run five-axis programs: these reach their ends at the planned speed,
with the deposit on."""

import math
import re

import numpy as np
import pytest

from freecad_am.posts.linuxcnc import post as linuxcnc
from freecad_am.posts.siemens import post as siemens
from tests.posts.interpreters import nc_python, rs274, run_nc, run_rs274
from tests.posts.nc_programs import deposit_of, random_program, set_options

linuxcnc_is_here = pytest.mark.skipif(
    rs274() is None, reason="no rs274 of LinuxCNC: `./freecad-am test` fetches it"
)
sinumerik_is_here = pytest.mark.skipif(
    nc_python() is None, reason="no nc-gcode-interpreter: `./freecad-am test` fetches it"
)
LETTERS = "XYZABC"
# half of the last digit of a word, and the rounding of interpreter 0.1.9, which uses single
# precision
HALF, SINGLE = 5e-6 + 1e-9, 1.2e-7


def columns(source, name):
    return np.concatenate([getattr(run, name) for run in source.moves])


def expected_positions(source):
    """Return (n, 6) X Y Z in mm and A B C in deg that LinuxCNC must reach in all moves; 0 for
    missing axes."""
    joints, values = columns(source, "joints"), np.zeros((len(columns(source, "joints")), 6))
    for column, name in enumerate(source.axis_names):
        values[:, LETTERS.index(name)] = (
            joints[:, column] if name in "XYZ" else np.degrees(joints[:, column])
        )
    if source.motion == "cartesian":
        deposit = np.repeat(
            [run.kind == "deposit" for run in source.moves], [len(run) for run in source.moves]
        )
        values[deposit, :3] = columns(source, "position")[deposit]
    return values


def wires(source):
    """Return the wire speed in each move, NaN where not stated, and whether the move is the first
    of a bead."""
    speeds = [np.full(len(run), np.nan) if run.wire is None else run.wire for run in source.moves]
    return np.concatenate(speeds), np.concatenate(
        [np.arange(len(run)) == 0 for run in source.moves]
    )


@linuxcnc_is_here
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    ("motion", "feed"), [("joint", False), ("joint", True), ("cartesian", False)]
)
def test_linuxcnc_goes_where_it_should(tmp_path, seed, motion, feed):
    names = (("X", "Y", "Z", "A", "C"), ("X", "Y", "Z", "B", "C"))[seed % 2]
    source = random_program(
        seed, motion, seed % 3 == 0, names, wire=seed % 2 == 0, deposit_output=4
    )
    source = set_options(source, path_feed=feed, wire_output=7, wire_gain=2.5)
    moves, complaints = run_rs274(tmp_path, linuxcnc.write(source), "random.ngc", 250.0)
    assert not complaints and not any(move["rapid"] for move in moves)
    positions = np.array([move["at"] for move in moves])
    assert (
        np.abs(positions - expected_positions(source)).max() <= 5e-6 + 5e-5 + 1e-9
    )  # rounding of the text and of rs274's output
    assert [move["deposit"] for move in moves] == deposit_of(source)
    for move, wire, is_first in zip(moves, *wires(source), strict=True):
        if np.isfinite(wire):
            value, queued = move["analogue"][6]
            assert value == pytest.approx(0.15 * wire, rel=5.1e-5) and not (is_first and queued)
    # rapids stop exactly at every point, and only beads round corners
    assert [move["corner"] for move in moves] == [0.05 if on else 0.0 for on in deposit_of(source)]
    tip = [motion == "cartesian" and on for on in deposit_of(source)]
    assert [move["kinematics"] for move in moves] == [428 if on else 429 for on in tip]
    assert [move["offset"] for move in moves] == [source.user_frame if on else 9 for on in tip]
    seconds, planned = np.array([move["seconds"] for move in moves]), columns(source, "duration")
    lengths, feeds = (
        np.array([move["way"] for move in moves]),
        np.array([move["feed"] for move in moves]),
    )
    steps = np.abs(np.diff(np.round(expected_positions(source), 5), axis=0, prepend=0.0))
    slides = np.linalg.norm(steps[:, :3], axis=1)
    # rs274 prints four decimals, too few for short moves and small feeds
    is_precise = (
        (lengths > 0.05)
        & (feeds > 0.01)
        & ((slides > 0.05) | (slides == 0.0))
        & (np.arange(len(moves)) > 0)
    )
    off = np.abs(seconds / planned - 1.0) - (
        2e-4 / np.maximum(lengths, 1e-9) + 1e-4 / np.maximum(feeds, 1e-9)
    )
    if motion == "cartesian":
        speed = columns(source, "speed")
        assert (np.abs(feeds / 60.0 - speed) / (1e-6 * speed + 1e-6))[tip].max() < 1.0
        is_precise &= ~np.array(tip) & ~np.roll(tip, 1)
    assert is_precise.sum() > (0 if motion == "cartesian" else 10) and off[is_precise].max() < 1e-6


@linuxcnc_is_here
@pytest.mark.parametrize("damage", [
    (r" F[\d.]+\n", "\n"), (r"\nM2\n", "\n"), (r"G17", "G18 G19"), (r"M429", "M431"), (r"G43", "G143"),
])  # fmt: skip
def test_linuxcnc_refuses_what_is_wrong(tmp_path, damage):
    """The interpreter is a real judge: it rejects texts that are not programs."""
    ((name, content),) = linuxcnc.write(random_program(1, max_points=10**5)).items()
    text = re.sub(damage[0], damage[1], content.decode(), count=0)
    assert text != content.decode()
    assert run_rs274(tmp_path, {name: text.encode()}, name)[1]


@sinumerik_is_here
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("motion", "feed"), [("joint", False), ("joint", True), ("cartesian", False)]
)
@pytest.mark.always
def test_a_sinumerik_goes_where_it_should(seed, motion, feed):
    continuous = seed % 2 == 1
    source = random_program(seed, motion, continuous, wire=seed % 2 == 0, deposit_output=4)
    source = set_options(source, path_feed=feed, wire_output=7, wire_gain=2.5)
    files = siemens.write(source)
    rows, positions, names = {}, [], set()
    order = sorted(files)  # parts are called in the order of their names
    for file, (rows_, calls, complaint) in zip(
        order, run_nc([files[file].decode() for file in order]), strict=True
    ):
        assert not complaint
        names |= set(calls)
        for row in rows_:
            rows.setdefault((file, row["N"]), row)
        positions += [
            (file, int(number)) for number in re.findall(r"\nN(\d+) .*G1 ", files[file].decode())
        ]
    assert names <= {"CLEAN", *(file.removesuffix(".SPF") for file in files)}
    joints, deposit = columns(source, "joints"), np.array(deposit_of(source))
    tip = deposit & (motion == "cartesian")
    assert len(positions) == len(joints)
    for position_row, axes, is_tip, position, run_on, wire, stops in zip(
        positions,
        joints,
        tip,
        columns(source, "position") if motion == "cartesian" else joints,
        deposit,
        wires(source)[0],
        columns(source, "stops"),
        strict=True,
    ):
        row = rows[position_row]
        assert np.isnan(wire) or row["O7"] == pytest.approx(0.15 * wire, rel=5.1e-5)
        if is_tip:
            assert np.all(
                np.abs([row[name] for name in "XYZ"] - position) <= HALF + SINGLE * np.abs(position)
            )
            assert math.hypot(row["A3"], row["B3"], row["C3"]) == pytest.approx(1.0, abs=2e-6)
        else:
            assert np.all(
                np.abs([row[name] for name in "XYZ"] - axes[:3]) <= HALF + SINGLE * np.abs(axes[:3])
            )
            angle_errors = np.array([row["A"], row["C"]]) - np.degrees(axes[3:])
            angle_errors[1] -= 360.0 * np.rint(angle_errors[1] / 360.0) * continuous
            assert np.abs(angle_errors).max() <= HALF + 360.0 * SINGLE
        assert (row["gg01_motion"], row["gg07_tool_radius"], row["gg06_plane_select"]) == (
            "G1",
            "G40",
            "G17",
        )
        assert row["gg08_work_offset"] == (siemens._offset(source.user_frame) if is_tip else "G500")
        assert (row.get("H4") == 1.0) == run_on
        assert (row["gg10_exact_stop_mode"], row["gg11_exact_stop_non_modal"] == "G9") == (
            "G642",
            stops,
        )


@sinumerik_is_here
def test_a_sinumerik_refuses_what_is_wrong():
    (content,) = siemens.write(random_program(1, max_points=10**5)).values()
    text = content.decode()
    damages = (("; layer", "( layer"), ("G4 F", "G4 F=)"), ("ENDWHILE", ""), ("G1 X", "G1 X=1,5 Y"))
    assert all(old in text for old, _ in damages)
    answers = run_nc(
        [text, *(text.replace(*damage) for damage in damages), "N10 TRAFOOFF\nN20 M30\n"]
    )
    assert [bool(complaint) for _, _, complaint in answers] == [
        False,
        True,
        True,
        True,
        True,
        False,
    ]
    assert answers[-1][1] == ["TRAFOOFF"]


def test_programs_end_with_what_their_controllers_want():
    source = random_program(2, max_points=45)
    for post, ends in ((siemens, ("M30", "M17")), (linuxcnc, ("M2", "M2"))):
        files = post.write(source)
        assert len(files) > 2
        lasts = [content.decode().split("\n")[-2].split()[-1] for content in files.values()]
        assert lasts == [ends[0]] + [ends[1]] * (len(files) - 1)
