# SPDX-License-Identifier: LGPL-2.1-or-later
"""Patterns read the texts, and the joints of the machine files, multiplied here, drive them: the
tip follows the given beads at their speed between the lines that switch the output, and every rapid
stops. The test uses only the text and the frames of the cell, no reader or chain of the product. It
does not read external axes."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.posts.planned_jobs import SETUPS, SIDES, WAYS, _bead, wanted_speeds, write_program

pytestmark = pytest.mark.any_version

MACHINES = Path(__file__).parents[2] / "freecad_am" / "machines"
# mm off the bead, from its chords and rounding; mm by which the rounding of both ends of a move and
# half a millisecond change its length; the share of a bead's speed that chords explain
MAX_DEVIATION, MAX_LENGTH_ERROR, SPEED_SHARE = 0.1, 0.06, 0.005
FANUC = r"^ *\d+:(J|L) P\[(\d+)\] (?:(\d+)msec|([\d.]+)sec|([\d.]+)mm/sec|\d+%) (FINE|CNT\d+)"
ABB = r"MoveAbsJ \[\[([^\]]*)\].*\\T:=([\d.]+),(\w+),"
UR = r"movej\(\[([^\]]*)\].* t=([\d.]+), r=([\d.]+)\)"
SIDES_OF = {
    "fanuc": r"DO\[1\]=(ON|OFF)",
    "abb": r"SetDO \w+,(1|0);",
    "ur": r"set_standard_digital_out\(0, (True|False)\)",
}


def lines_of(files):
    """Return all lines of a program in one file."""
    (content,) = files.values()
    return content.decode("utf-8").splitlines()


def fanuc(lines):
    """Return the moves of a listing in order: controller joint values or (x, y, z), whether
    straight, s, mm/s, whether it stops."""
    records = dict(re.findall(r"P\[(\d+)\]\{(.*?)\};", "\n".join(lines), re.DOTALL))
    for line in lines:
        match = re.match(FANUC, line)
        if match:
            text, straight = records[match[2]], match[1] == "L"
            axes = [float(value) for value in re.findall(r"J[1-6]= *(-?\d*\.\d+) deg", text)]
            position = [float(value) for value in re.findall(r"[XYZ] = *(-?\d*\.\d+) +mm", text)]
            seconds = float(match[3]) / 1000.0 if match[3] else float(match[4] or "nan")
            yield (
                line,
                axes or position,
                straight,
                seconds,
                float(match[5] or "nan"),
                match[6] == "FINE",
            )
        else:
            yield line, None, False, 0.0, 0.0, False


def line_reader(pattern, scale, stop):
    """Return a function that reads the same from a text with each joint move on one line."""

    def moves(lines):
        for line in lines:
            match = re.search(pattern, line)
            axes = (
                None if match is None else [scale * float(value) for value in match[1].split(",")]
            )
            yield (
                line,
                axes,
                False,
                float(match[2]) if match else 0.0,
                np.nan,
                match is not None and stop(match[3]),
            )

    return moves


READERS = {
    "fanuc": fanuc,
    "abb": line_reader(ABB, 1.0, lambda zone: zone == "fine"),
    "ur": line_reader(UR, np.degrees(1.0), lambda radius: float(radius) == 0.0),
}


def pose(position, rpy):
    x, y, z = np.radians(rpy)
    around = [
        np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]]),
        np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]),
        np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]]),
    ]
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = around[2] @ around[1] @ around[0], position
    return matrix


def rotation(axis, degrees):
    """Return a rotation about a unit axis, by Rodrigues' formula."""
    x, y, z = axis
    cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix


def flange(machine, controller_joints):
    """Return the pose of the flange in the base frame of a machine file, from controller joint
    values."""
    values = np.linalg.solve(
        machine["controller"]["matrix"],
        np.array(controller_joints) - machine["controller"]["offset"],
    )
    matrix = np.eye(4)
    for joint, value in zip(machine["joints"], values, strict=True):
        matrix = matrix @ pose(joint["origin"], joint["rpy"]) @ rotation(joint["axis"], value)
    return matrix @ pose(machine["flange"]["origin"], machine["flange"]["rpy"])


def tips(variant, moves):
    """Return (n, 3) where the moves end, in part coordinates."""
    setup = SETUPS[variant[3]].cell
    machine = json.loads((MACHINES / f"{setup.machine}.json").read_text(encoding="utf-8"))
    cell = write_program(variant)[0]
    rows = []
    for values in moves:
        if len(values) == 6:
            flange_pose = flange(machine, values)
            rows.append(
                (
                    cell.poses.mount
                    @ np.linalg.inv(flange_pose @ cell.poses.carried)
                    @ cell.poses.station
                    if setup.setup == "part-on-robot"
                    else cell.poses.mount
                    @ np.linalg.inv(cell.poses.station)
                    @ flange_pose
                    @ cell.poses.carried
                )[:3, 3]
            )
        else:
            rows.append(
                (cell.poses.mount @ [*values, 1.0])[:3]
            )  # the program's origin is the mount of the part
    return np.array(rows)


@pytest.mark.parametrize(
    "way",
    [
        variant
        for variant in WAYS
        if variant[0] in READERS
        and not re.search("positioner|track", variant[3])
        and (variant[1] == "joint" or variant[0] == "fanuc")
    ],
    ids=" ".join,
)
def test_the_tip_runs_along_the_beads_at_their_speed_and_stops_on_rapids(way):
    post, files = way[0], write_program(way)[3]
    on, moves, move_data = False, [], []
    for line, values, straight, time, speed, stop in READERS[post](lines_of(files)):
        switched = re.search(SIDES_OF[post], line)
        on = switched[1] in ("ON", "1", "True") if switched else on
        if values is not None:
            moves.append(values)
            move_data.append((on, stop, straight, time, speed))
    positions, (laid, stops, lines, seconds, speeds) = (
        tips(way, moves),
        map(np.array, zip(*move_data)),
    )
    assert stops[~laid].all() and not stops[laid].all()
    assert (lines == (laid & (way[1] == "cartesian"))).all()  # rapids are straight in joint space
    starts = np.flatnonzero(laid & ~np.r_[False, laid[:-1]])
    ends = np.flatnonzero(laid & ~np.r_[laid[1:], False])
    assert len(starts) == 2 * SIDES and stops[ends].all()
    used_beads = []
    for start, end in zip(starts, ends):
        run = positions[start - 1 : end + 1]
        length = np.linalg.norm(np.diff(run, axis=0), axis=1)
        bead_speeds, time = speeds[start : end + 1], seconds[start : end + 1]
        time = np.where(np.isnan(bead_speeds), time, length / bead_speeds)
        beads = {
            (layer, side): _bead(SETUPS[way[3]].hub, side, layer).points
            for layer in range(2)
            for side in range(SIDES)
        }
        distances = {}
        for key, points in beads.items():
            dense = np.concatenate(
                [
                    a + np.linspace(0.0, 1.0, 400)[:, None] * (b - a)
                    for a, b in zip(points, points[1:])
                ]
            )
            distances[key] = np.linalg.norm(run[:, None] - dense, axis=2).min(axis=1).max()
        best = min(distances, key=distances.get)
        assert distances[best] < MAX_DEVIATION
        ahead = np.linalg.norm(run[[0, -1]] - beads[best][[0, -1]], axis=1).max()
        back = np.linalg.norm(run[[0, -1]] - beads[best][[-1, 0]], axis=1).max()
        assert min(ahead, back) < MAX_DEVIATION
        expected = wanted_speeds(best[1], np.r_[0.0, np.cumsum(length)])
        assert np.abs(length - expected * time).max() < MAX_LENGTH_ERROR
        for speed in set(expected):
            stretch = expected == speed
            tolerance = 0.0 if len(set(expected)) == 1 else MAX_LENGTH_ERROR / length[stretch].sum()
            assert length[stretch].sum() / time[stretch].sum() == pytest.approx(
                speed, rel=SPEED_SHARE + tolerance
            )
        used_beads.append(best)
    assert sorted(used_beads) == sorted(beads)
