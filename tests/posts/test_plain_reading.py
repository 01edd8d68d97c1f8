# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts read by a few patterns, and driven by the joints of the machine files, multiplied here: the tip runs along the beads
that were given, at their speed, between the lines that switch the output; and every rapid stops. Of the product nothing but
the text and the frames of the cell is used: no reader, no chain. Axes beside a robot are not read here."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.posts.planned_jobs import SETUPS, SIDES, WAYS, _bead, wanted_speeds, written

pytestmark = pytest.mark.any_version

MACHINES = Path(__file__).parents[2] / "freecad_am" / "machines"
# mm off the bead: its chords and digits; mm by which the digits of both ends of a move, and half a millisecond, change its
# length; and the share of a bead's speed that chords explain
OFF, ENDS, SLOW = 0.1, 0.06, 0.005
FANUC = r"^ *\d+:(J|L) P\[(\d+)\] (?:(\d+)msec|([\d.]+)sec|([\d.]+)mm/sec|\d+%) (FINE|CNT\d+)"
ABB = r"MoveAbsJ \[\[([^\]]*)\].*\\T:=([\d.]+),(\w+),"
UR = r"movej\(\[([^\]]*)\].* t=([\d.]+), r=([\d.]+)\)"
SIDES_OF = {
    "fanuc": r"DO\[1\]=(ON|OFF)",
    "abb": r"SetDO \w+,(1|0);",
    "ur": r"set_standard_digital_out\(0, (True|False)\)",
}


def lines_of(files):
    """All lines of a program in one file."""
    (content,) = files.values()
    return content.decode("utf-8").splitlines()


def fanuc(lines):
    """Moves of a listing: controller joint values or (x, y, z), whether a line, s, mm/s, whether it stops; in order."""
    records = dict(re.findall(r"P\[(\d+)\]\{(.*?)\};", "\n".join(lines), re.DOTALL))
    for line in lines:
        found = re.match(FANUC, line)
        if found:
            text, straight = records[found[2]], found[1] == "L"
            axes = [float(value) for value in re.findall(r"J[1-6]= *(-?\d*\.\d+) deg", text)]
            place = [float(value) for value in re.findall(r"[XYZ] = *(-?\d*\.\d+) +mm", text)]
            seconds = float(found[3]) / 1000.0 if found[3] else float(found[4] or "nan")
            yield (
                line,
                axes or place,
                straight,
                seconds,
                float(found[5] or "nan"),
                found[6] == "FINE",
            )
        else:
            yield line, None, False, 0.0, 0.0, False


def told(pattern, scale, stop):
    """The same of a text whose joint moves are each told on a line."""

    def moves(lines):
        for line in lines:
            found = re.search(pattern, line)
            axes = (
                None if found is None else [scale * float(value) for value in found[1].split(",")]
            )
            yield (
                line,
                axes,
                False,
                float(found[2]) if found else 0.0,
                np.nan,
                found is not None and stop(found[3]),
            )

    return moves


READERS = {
    "fanuc": fanuc,
    "abb": told(ABB, 1.0, lambda zone: zone == "fine"),
    "ur": told(UR, np.degrees(1.0), lambda radius: float(radius) == 0.0),
}


def pose(place, rpy):
    x, y, z = np.radians(rpy)
    around = [
        np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]]),
        np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]),
        np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]]),
    ]
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = around[2] @ around[1] @ around[0], place
    return made


def turned(axis, degrees):
    """About a unit axis, by the formula of Rodrigues."""
    x, y, z = axis
    cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.radians(degrees)
    made = np.eye(4)
    made[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return made


def flange(machine, shown):
    """The pose of the flange in the base frame of a machine file, of joint values as its controller shows them."""
    values = np.linalg.solve(
        machine["controller"]["matrix"], np.array(shown) - machine["controller"]["offset"]
    )
    made = np.eye(4)
    for joint, value in zip(machine["joints"], values, strict=True):
        made = made @ pose(joint["origin"], joint["rpy"]) @ turned(joint["axis"], value)
    return made @ pose(machine["flange"]["origin"], machine["flange"]["rpy"])


def tips(way, moves):
    """(n, 3) where the moves end, in part coordinates."""
    setup = SETUPS[way[3]].cell
    machine = json.loads((MACHINES / f"{setup.machine}.json").read_text(encoding="utf-8"))
    cell = written(way)[0]
    rows = []
    for values in moves:
        if len(values) == 6:
            seen = flange(machine, values)
            rows.append(
                (
                    cell.poses.mount @ np.linalg.inv(seen @ cell.poses.carried) @ cell.poses.station
                    if setup.setup == "part-on-robot"
                    else cell.poses.mount
                    @ np.linalg.inv(cell.poses.station)
                    @ seen
                    @ cell.poses.carried
                )[:3, 3]
            )
        else:
            rows.append(
                (cell.poses.mount @ [*values, 1.0])[:3]
            )  # the program's origin is where the part is mounted
    return np.array(rows)


@pytest.mark.parametrize(
    "way",
    [
        way
        for way in WAYS
        if way[0] in READERS
        and not re.search("positioner|track", way[3])
        and (way[1] == "joint" or way[0] == "fanuc")
    ],
    ids=" ".join,
)
def test_the_tip_runs_along_the_beads_at_their_speed_and_stops_on_rapids(way):
    post, files = way[0], written(way)[3]
    on, moves, rest = False, [], []
    for line, values, straight, time, speed, stop in READERS[post](lines_of(files)):
        switched = re.search(SIDES_OF[post], line)
        on = switched[1] in ("ON", "1", "True") if switched else on
        if values is not None:
            moves.append(values)
            rest.append((on, stop, straight, time, speed))
    place, (laid, stops, lines, seconds, speeds) = tips(way, moves), map(np.array, zip(*rest))
    assert stops[~laid].all() and not stops[laid].all()
    assert (lines == (laid & (way[1] == "cartesian"))).all()  # rapids run straight in the joints
    starts = np.flatnonzero(laid & ~np.r_[False, laid[:-1]])
    ends = np.flatnonzero(laid & ~np.r_[laid[1:], False])
    assert len(starts) == 2 * SIDES and stops[ends].all()
    taken = []
    for start, end in zip(starts, ends):
        run = place[start - 1 : end + 1]
        length = np.linalg.norm(np.diff(run, axis=0), axis=1)
        given, time = speeds[start : end + 1], seconds[start : end + 1]
        time = np.where(np.isnan(given), time, length / given)
        beads = {
            (layer, side): _bead(SETUPS[way[3]].hub, side, layer).points
            for layer in range(2)
            for side in range(SIDES)
        }
        away = {}
        for key, points in beads.items():
            dense = np.concatenate(
                [
                    a + np.linspace(0.0, 1.0, 400)[:, None] * (b - a)
                    for a, b in zip(points, points[1:])
                ]
            )
            away[key] = np.linalg.norm(run[:, None] - dense, axis=2).min(axis=1).max()
        best = min(away, key=away.get)
        assert away[best] < OFF
        ahead = np.linalg.norm(run[[0, -1]] - beads[best][[0, -1]], axis=1).max()
        back = np.linalg.norm(run[[0, -1]] - beads[best][[-1, 0]], axis=1).max()
        assert min(ahead, back) < OFF
        wanted = wanted_speeds(best[1], np.r_[0.0, np.cumsum(length)])
        assert np.abs(length - wanted * time).max() < ENDS
        for speed in set(wanted):
            stretch = wanted == speed
            more = 0.0 if len(set(wanted)) == 1 else ENDS / length[stretch].sum()
            assert length[stretch].sum() / time[stretch].sum() == pytest.approx(
                speed, rel=SLOW + more
            )
        taken.append(best)
    assert sorted(taken) == sorted(beads)
