# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of KUKA, VAL 3, Yaskawa, SINUMERIK and LinuxCNC read by a few patterns, and driven by the joints of the machine
files, multiplied in test_plain_reading: every move comes to its row of waypoints.csv with the tool's direction there, within
the limits of the machine file and its speeds; beads at their speed, with the output on, and rapids stop. Nothing of the
product but the text and the frames of the cell is used: no reader, no chain. Axes beside a robot are not read here."""

import json
import re
from typing import NamedTuple

import numpy as np
import pytest

from tests.posts.planned_jobs import PROCESS, PULSES, SETUPS, SIDES, WAYS, wanted_speeds, written
from tests.posts.test_plain_reading import ENDS, MACHINES, SLOW, pose, turned

pytestmark = pytest.mark.any_version

NUMBER = r"(-?[\d.]+)"
LEAN, AXIS = (
    0.03,
    0.002,
)  # deg, between the tool and the direction that a text tells in so many digits; of an axis, or mm
DWELLS = r"(?:delay\(|TIMER T=|WAIT SEC |G4 [FP])([\d.]+)"
POLLED = 0.1  # s, between two looks at an input
POSTS = ("kuka", "staubli", "yaskawa", "siemens", "linuxcnc")


class Move(NamedTuple):
    """joints: as the controller shows them, NaN of those that are not told, or place, and the tool's direction there, of a
    move that tells these; straight: in space. time: s; speed: mm/s of the tip; rate: share of the axes' largest speeds: what
    is told of the three."""

    on: bool
    stop: bool
    straight: bool
    joints: tuple = ()
    place: tuple = ()
    way: tuple = ()
    time: float = np.nan
    speed: float = np.nan
    rate: float = np.nan


def numbers(pattern, line):
    found = re.search(pattern, line)
    return None if found is None else tuple(float(value) for value in found.groups())


def text_of(files, ending):
    return next(content for name, content in files.items() if name.endswith(ending)).decode(
        "utf-8-sig"
    )


def kuka(files):
    """PTP in joints at a share of their speeds, LIN at $VEL.CP, in the base on the part."""
    on, rate, speed, base = False, np.nan, np.nan, None
    for line in text_of(files, "job.src").splitlines():
        on = {"TRUE": True, "FALSE": False}[line[8:]] if line.startswith("$OUT[1]=") else on
        rate = (numbers(rf"^BAS\(#VEL_PTP,{NUMBER}\)", line) or (rate * 100.0,))[0] / 100.0
        speed = (numbers(rf"^\$VEL.CP={NUMBER}", line) or (speed / 1000.0,))[0] * 1000.0
        axes = numbers(r"^PTP \{" + ",".join(rf"A{k} {NUMBER}" for k in range(1, 7)) + r"\}$", line)
        if axes:
            yield Move(on, True, False, axes, rate=rate)
        base = numbers(
            r"^LIN \{" + ",".join(rf"{k} {NUMBER}" for k in "XYZABC") + r"\}(?: C_DIS)?$", line
        )
        if base:
            frame = (
                turned((0, 0, 1), base[3]) @ turned((0, 1, 0), base[4]) @ turned((1, 0, 0), base[5])
            )
            yield Move(
                on,
                not line.endswith("C_DIS"),
                True,
                place=base[:3],
                way=tuple(-frame[:3, 2]),
                speed=speed,
            )


def staubli(files):
    """Loops over arrays of the data: joints, points or tools, and how each is moved to."""
    data, on, loop = text_of(files, ".dtx"), False, range(0)
    array = {
        name: [
            dict(re.findall(r'(\w+)="([^"]*)"', value))
            for value in re.findall("<Value (.*?)/>", body)
        ]
        for name, body in re.findall(r'<Data name="(\w+)".*?>(.*?)</Data>', data, re.DOTALL)
    }
    for line in text_of(files, "start.pgx").splitlines():
        on = line.endswith("=true") if line.strip().startswith("doDeposit=") else on
        turns = numbers(r"for l_nI=(\d+) to (\d+)", line)
        loop = range(int(turns[0]), int(turns[1]) + 1) if turns else loop
        if "waitEndMove()" in line:
            yield None
        moved = re.match(
            r" *move([jl])\((\w+)(?:\[(.*?)\])?,(\w+)(?:\[(.*?)\])?,mPath\[(.*?)\]\)", line
        )
        for k in loop if moved and "l_nI" in line else range(1) if moved else ():
            index = [
                None
                if text is None
                else sum(int(p) for p in text.replace("l_nI", str(k)).split("+"))
                for text in (moved[3], moved[5], moved[6])
            ]
            how, point = array["mPath"][index[2]], array[moved[2]][index[0] or 0]
            stop = how["blend"] == "off"
            if moved[1] == "j":
                axes = tuple(float(point[f"j{n}"]) for n in range(1, 7))
                yield Move(on, stop, False, axes, rate=float(how["vel"]) / 100.0)
                continue
            carried = index[1] is not None
            told = array[moved[4]][index[1]] if carried else point
            x, y, z, rx, ry, rz = (float(told[name]) for name in ("x", "y", "z", "rx", "ry", "rz"))
            frame = turned((1, 0, 0), rx) @ turned((0, 1, 0), ry) @ turned((0, 0, 1), rz)
            way = frame[:3, 2] if carried else -frame[:3, 2]
            yield Move(on, stop, True, place=(x, y, z), way=tuple(way), speed=float(how["tmax"]))


def waited(moves):
    """Moves of which those before a None, which waits for the end of all, stop."""
    found = []
    for move in moves:
        if move is not None:
            found.append(move)
        elif found:
            found[-1] = found[-1]._replace(stop=True)
    return found


def yaskawa(files):
    """MOVJ at a share of the axes' speeds, MOVL at the tip's; all to pulses."""
    text, on = text_of(files, ".JBI"), False
    pulses = {
        name: [float(value) for value in row.split(",")]
        for name, row in re.findall(r"^(C\d+)=(.*)$", text, re.M)
    }
    for line in text.splitlines():
        on = line.endswith("ON") if line.startswith("DOUT OT#(1)") else on
        moved = re.match(rf"MOV([JL]) (C\d+) V(J?)={NUMBER} PL=(\d)$", line)
        if moved:
            axes = tuple(value / scale for value, scale in zip(pulses[moved[2]], PULSES))
            told = (
                {"rate": float(moved[4]) / 100.0} if moved[1] == "J" else {"speed": float(moved[4])}
            )
            yield Move(on, moved[5] == "0", moved[1] == "L", axes, **told)


def nc(on_line, off_line, stopped, dwells):
    """Of a text in blocks, in which a dwell stops by itself or not: G1 in axes or in the part, F as one over minutes under
    G93, a speed under G94."""

    def moves(files, names):
        on, inverse, exact, part, last, words = False, False, True, False, None, {}
        for line in "".join(content.decode("utf-8") for content in files.values()).splitlines():
            on = True if on_line in line else False if off_line in line else on
            inverse = True if "G93" in line else False if "G94" in line else inverse
            part = (
                True
                if re.search(r"TRAORI|M428", line)
                else False
                if re.search(r"TRAFOOF|M429", line)
                else part
            )
            exact = {"G61.1": True, "G64": False}.get(line.split(" ")[0], exact)
            if dwells and re.search(r"\bG4 ", line):
                yield None
            if not re.search(r"\bG1 ", line):
                continue
            words |= dict(
                re.findall(r"([ABC]3(?==)|[A-Z])=?(?:DC\()?(-?[\d.]+)", line.split("G1 ")[1])
            )
            stop = stopped(line, exact)
            place = tuple(float(words[name]) for name in "XYZ")
            moved = np.inf if last is None else float(np.linalg.norm(np.subtract(place, last)))
            time = 60.0 / float(words["F"]) if inverse else 60.0 * moved / float(words["F"])
            last = place
            if part:
                way = (
                    tuple(float(words[name]) for name in ("A3", "B3", "C3"))
                    if "A3" in words
                    else ()
                )
                axes = (
                    ()
                    if way
                    else tuple(np.nan if name in "XYZ" else float(words[name]) for name in names)
                )
                yield Move(
                    on, stop, True, axes, place=place, way=way, speed=float(words["F"]) / 60.0
                )
            else:
                yield Move(on, stop, False, tuple(float(words[name]) for name in names), time=time)

    return moves


NC = {
    "siemens": nc("H1=1", "H1=0", lambda line, exact: "G9 " in line, False),
    "linuxcnc": nc("M64 P0", "M65 P0", lambda line, exact: exact, True),
}


def seen(machine, shown):
    """The pose of the flange in the base frame of a machine file, of values as the controller shows them."""
    values = np.linalg.solve(
        machine["controller"]["matrix"], np.array(shown) - machine["controller"]["offset"]
    )
    made = np.eye(4)
    for joint, value in zip(machine["joints"], values, strict=True):
        slid = pose(value * np.array(joint["axis"], float), (0, 0, 0))
        made = (
            made
            @ pose(joint["origin"], joint["rpy"])
            @ (slid if joint.get("type") == "prismatic" else turned(joint["axis"], value))
        )
    return made @ pose(machine["flange"]["origin"], machine["flange"]["rpy"])


def tip(cell, setup, machine, move):
    """Where a move ends in part coordinates, and the tool's direction; None where it does not tell that."""
    if move.place:
        way = cell.poses.mount[:3, :3] @ move.way / np.linalg.norm(move.way) if move.way else None
        return (cell.poses.mount @ [*move.place, 1.0])[
            :3
        ], way  # the program's origin is where the part is mounted
    flange = seen(machine, move.joints)
    if setup.setup == "tool-on-robot":
        frame = cell.poses.mount @ np.linalg.inv(cell.poses.station) @ flange @ cell.poses.carried
        return frame[:3, 3], -frame[:3, 2]
    frame = cell.poses.mount @ np.linalg.inv(flange @ cell.poses.carried) @ cell.poses.station
    return frame[:3, 3], frame[:3, 2]


def read(way):
    setup = SETUPS[way[3]].cell
    machine = json.loads((MACHINES / f"{setup.machine}.json").read_text(encoding="utf-8"))
    cell, motion, _, files = written(way)
    if way[0] in NC:
        names = [joint["name"][-1].upper() for joint in machine["joints"]]
        moves = NC[way[0]](files, names)
    else:
        moves = {"kuka": kuka, "staubli": staubli, "yaskawa": yaskawa}[way[0]](files)
    return setup, machine, cell, motion, waited(moves)


@pytest.mark.parametrize(
    "way",
    [way for way in WAYS if way[0] in POSTS and not re.search("positioner|track", way[3])],
    ids=" ".join,
)
def test_every_move_comes_to_its_waypoint_within_limits_and_speeds(way):
    setup, machine, cell, motion, moves = read(way)
    rows = np.flatnonzero(motion.moves)
    assert len(moves) == len(rows) and sum(move.on for move in moves) > 8 * 2 * SIDES - 1
    laid = motion.deposit[rows]
    assert [move.on for move in moves] == laid.tolist()
    assert all(move.stop for move in moves if not move.on)
    assert [move.straight for move in moves] == (
        laid & (way[1] == "cartesian")
    ).tolist()  # rapids run in the joints
    ends = laid & ~np.r_[laid[1:], False]
    assert [move.stop for move in moves if move.on] == ends[laid].tolist()
    limits = machine["limits"]["maker"]["axes"]
    speeds = np.array([joint["max_speed"] for joint in machine["joints"]], float)
    continuous = np.array([bounds is None for bounds in limits])
    before = (None, None)
    runs = {}  # lengths and times of the moves of each bead
    for move, row in zip(moves, rows, strict=True):
        place, direction = tip(cell, setup, machine, move)
        assert np.linalg.norm(place - motion.position[row]) < ENDS / 2.0
        if direction is not None:
            assert np.degrees(np.arccos(np.clip(direction @ motion.tool[row], -1.0, 1.0))) < LEAN
        if move.joints:
            turning = np.array([joint.get("type") != "prismatic" for joint in machine["joints"]])
            planned = np.where(turning, np.degrees(motion.joints[row]), motion.joints[row])
            planned = (
                np.array(machine["controller"]["matrix"]) @ planned
                + machine["controller"]["offset"]
            )
            off = np.subtract(move.joints, planned)
            off = np.where(continuous, np.remainder(off + 180.0, 360.0) - 180.0, off)  # of DC
            assert np.nanmax(np.abs(off)) < AXIS
            for value, bounds in zip(move.joints, limits):
                assert bounds is None or np.isnan(value) or bounds[0] <= value <= bounds[1]
        if move.joints and before[1] and not move.place:
            asked = np.abs(np.subtract(move.joints, before[1]))
            asked = np.where(
                continuous & (asked > 180.0), np.abs(asked - 360.0), asked
            )  # the shorter way of DC
            share = float(np.nanmax(asked / speeds))
            time = move.time if np.isnan(move.rate) else share / move.rate
            assert np.isnan(time) or share <= time * 1.001
            whole = 0.005 / move.rate if way[0] == "kuka" else 0.0  # whole percents
            assert (
                move.on or time > (0.99 - whole) * motion.duration[row]
            )  # rapids are no quicker than they were planned
        else:
            time = move.time
        assert np.isnan(move.rate) or 0.0 < move.rate <= 1.0
        if move.on:
            length = float(np.linalg.norm(motion.position[row] - before[0]))
            time = length / move.speed if np.isfinite(move.speed) else time
            runs.setdefault((motion.layer[row], motion.bead[row]), []).append((length, time))
        before = (motion.position[row], move.joints)
    told = "".join(
        content.decode("utf-8-sig")
        for name, content in written(way)[3].items()
        if not name.endswith("stop.pgx")
    )
    dwells = sorted(
        float(value) for value in re.findall(DWELLS, told) if float(value) not in (0.0, POLLED)
    )
    leads, wait = (PROCESS.lead_off, PROCESS.lead_on), PROCESS.between_layers.wait
    assert dwells == [*(lead for lead in leads for _ in range(2 * SIDES)), wait]
    assert len(runs) == 2 * SIDES
    for (_, side), run in runs.items():
        length, time = np.array(run).T
        wanted = wanted_speeds(side, np.r_[0.0, np.cumsum(length)])
        assert np.isfinite(time).all() and np.abs(length - wanted * time).max() < max(
            ENDS, SLOW * length.max()
        )
        for speed in set(wanted):  # VJ of Yaskawa has steps of a hundredth
            stretch = wanted == speed
            more = 0.0 if len(set(wanted)) == 1 else ENDS / length[stretch].sum()
            assert length[stretch].sum() / time[stretch].sum() == pytest.approx(
                speed, rel=0.011 + more
            )
