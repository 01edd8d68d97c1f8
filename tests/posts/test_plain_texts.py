# SPDX-License-Identifier: LGPL-2.1-or-later
"""Patterns read texts of KUKA, VAL 3, Yaskawa, SINUMERIK and LinuxCNC, and the joints of the
machine files, multiplied in test_plain_reading, drive them. Every move reaches its row of
waypoints.csv with the tool direction there, within the limits and speeds of the machine file; beads
run at their speed with the output on, and rapids stop. The test uses only the text and the frames
of the cell from the product."""

import json
import re
from typing import NamedTuple

import numpy as np
import pytest

from tests.posts.planned_jobs import (
    PROCESS,
    PULSES,
    SETUPS,
    SIDES,
    WAYS,
    wanted_speeds,
    write_program,
)
from tests.posts.test_plain_reading import MACHINES, MAX_LENGTH_ERROR, SPEED_SHARE, pose, rotation

pytestmark = pytest.mark.any_version

NUMBER = r"(-?[\d.]+)"
LEAN, AXIS = (
    0.03,
    0.002,
)  # deg between the tool and a direction with the digits of a text; deg of an axis, or mm
DWELLS = r"(?:delay\(|TIMER T=|WAIT SEC |G4 [FP])([\d.]+)"
POLLED = 0.1  # s between two reads of an input
POSTS = ("kuka", "staubli", "yaskawa", "siemens", "linuxcnc")


class Move(NamedTuple):
    """A move of a text. joints: controller joint values, NaN where the text states none; or place
    and the tool's direction there. straight: in space. The text states one of time in s, speed of
    the tip in mm/s, and rate, a share of the axes' largest speeds."""

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
    match = re.search(pattern, line)
    return None if match is None else tuple(float(value) for value in match.groups())


def text_of(files, ending):
    return next(content for name, content in files.items() if name.endswith(ending)).decode(
        "utf-8-sig"
    )


def kuka(files):
    """Read PTP in joints at a share of their speeds, and LIN at $VEL.CP, in the base on the
    part."""
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
                rotation((0, 0, 1), base[3])
                @ rotation((0, 1, 0), base[4])
                @ rotation((1, 0, 0), base[5])
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
    """Read loops over arrays of the data: joints, points or tools, and the kind of move to each."""
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
            stated = array[moved[4]][index[1]] if carried else point
            x, y, z, rx, ry, rz = (
                float(stated[name]) for name in ("x", "y", "z", "rx", "ry", "rz")
            )
            frame = rotation((1, 0, 0), rx) @ rotation((0, 1, 0), ry) @ rotation((0, 0, 1), rz)
            direction = frame[:3, 2] if carried else -frame[:3, 2]
            yield Move(
                on, stop, True, place=(x, y, z), way=tuple(direction), speed=float(how["tmax"])
            )


def waited(moves):
    """Return the moves with stops: a move stops before a None, which waits for the end of all
    motion."""
    moves_ = []
    for move in moves:
        if move is not None:
            moves_.append(move)
        elif moves_:
            moves_[-1] = moves_[-1]._replace(stop=True)
    return moves_


def yaskawa(files):
    """Read MOVJ at a share of the axes' speeds and MOVL at the tip's speed, all in pulses."""
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
            statements = (
                {"rate": float(moved[4]) / 100.0} if moved[1] == "J" else {"speed": float(moved[4])}
            )
            yield Move(on, moved[5] == "0", moved[1] == "L", axes, **statements)


def nc(on_line, off_line, stopped, dwells):
    """Return a reader of texts in blocks, in which a dwell stops the motion or not: G1 in axes or
    on the part, F as inverse minutes under G93 and as a speed under G94."""

    def moves(files, names):
        on, inverse, exact, on_part, last_position, words = False, False, True, False, None, {}
        for line in "".join(content.decode("utf-8") for content in files.values()).splitlines():
            on = True if on_line in line else False if off_line in line else on
            inverse = True if "G93" in line else False if "G94" in line else inverse
            on_part = (
                True
                if re.search(r"TRAORI|M428", line)
                else False
                if re.search(r"TRAFOOF|M429", line)
                else on_part
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
            position_ = tuple(float(words[name]) for name in "XYZ")
            moved = (
                np.inf
                if last_position is None
                else float(np.linalg.norm(np.subtract(position_, last_position)))
            )
            time = 60.0 / float(words["F"]) if inverse else 60.0 * moved / float(words["F"])
            last_position = position_
            if on_part:
                direction = (
                    tuple(float(words[name]) for name in ("A3", "B3", "C3"))
                    if "A3" in words
                    else ()
                )
                axes = (
                    ()
                    if direction
                    else tuple(np.nan if name in "XYZ" else float(words[name]) for name in names)
                )
                yield Move(
                    on,
                    stop,
                    True,
                    axes,
                    place=position_,
                    way=direction,
                    speed=float(words["F"]) / 60.0,
                )
            else:
                yield Move(on, stop, False, tuple(float(words[name]) for name in names), time=time)

    return moves


NC = {
    "siemens": nc("H1=1", "H1=0", lambda line, exact: "G9 " in line, False),
    "linuxcnc": nc("M64 P0", "M65 P0", lambda line, exact: exact, True),
}


def flange_pose(machine, controller_joints):
    """Return the pose of the flange in the base frame of a machine file, from controller joint
    values."""
    values = np.linalg.solve(
        machine["controller"]["matrix"],
        np.array(controller_joints) - machine["controller"]["offset"],
    )
    matrix = np.eye(4)
    for joint, value in zip(machine["joints"], values, strict=True):
        slid = pose(value * np.array(joint["axis"], float), (0, 0, 0))
        matrix = (
            matrix
            @ pose(joint["origin"], joint["rpy"])
            @ (slid if joint.get("type") == "prismatic" else rotation(joint["axis"], value))
        )
    return matrix @ pose(machine["flange"]["origin"], machine["flange"]["rpy"])


def tip(cell, setup, machine, move):
    """Return the end of a move in part coordinates, and the tool's direction; None where the text
    states none."""
    if move.place:
        direction = (
            cell.poses.mount[:3, :3] @ move.way / np.linalg.norm(move.way) if move.way else None
        )
        return (cell.poses.mount @ [*move.place, 1.0])[
            :3
        ], direction  # the program's origin is the mount of the part
    flange = flange_pose(machine, move.joints)
    if setup.setup == "tool-on-robot":
        frame = cell.poses.mount @ np.linalg.inv(cell.poses.station) @ flange @ cell.poses.carried
        return frame[:3, 3], -frame[:3, 2]
    frame = cell.poses.mount @ np.linalg.inv(flange @ cell.poses.carried) @ cell.poses.station
    return frame[:3, 3], frame[:3, 2]


def read(variant):
    setup = SETUPS[variant[3]].cell
    machine = json.loads((MACHINES / f"{setup.machine}.json").read_text(encoding="utf-8"))
    cell, motion, _, files = write_program(variant)
    if variant[0] in NC:
        names = [joint["name"][-1].upper() for joint in machine["joints"]]
        moves = NC[variant[0]](files, names)
    else:
        moves = {"kuka": kuka, "staubli": staubli, "yaskawa": yaskawa}[variant[0]](files)
    return setup, machine, cell, motion, waited(moves)


@pytest.mark.parametrize(
    "way",
    [
        variant
        for variant in WAYS
        if variant[0] in POSTS and not re.search("positioner|track", variant[3])
    ],
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
    ).tolist()  # rapids are straight in joint space
    ends = laid & ~np.r_[laid[1:], False]
    assert [move.stop for move in moves if move.on] == ends[laid].tolist()
    limits = machine["limits"]["maker"]["axes"]
    speeds = np.array([joint["max_speed"] for joint in machine["joints"]], float)
    continuous = np.array([bounds is None for bounds in limits])
    previous = (None, None)
    runs = {}  # lengths and times of the moves of each bead
    for move, row in zip(moves, rows, strict=True):
        position, direction = tip(cell, setup, machine, move)
        assert np.linalg.norm(position - motion.position[row]) < MAX_LENGTH_ERROR / 2.0
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
            # DC states no turns
            off = np.where(continuous, np.remainder(off + 180.0, 360.0) - 180.0, off)
            assert np.nanmax(np.abs(off)) < AXIS
            for value, bounds in zip(move.joints, limits):
                assert bounds is None or np.isnan(value) or bounds[0] <= value <= bounds[1]
        if move.joints and previous[1] and not move.place:
            steps = np.abs(np.subtract(move.joints, previous[1]))
            steps = np.where(
                continuous & (steps > 180.0), np.abs(steps - 360.0), steps
            )  # DC takes the shorter way
            share = float(np.nanmax(steps / speeds))
            time = move.time if np.isnan(move.rate) else share / move.rate
            assert np.isnan(time) or share <= time * 1.001
            rounding = 0.005 / move.rate if way[0] == "kuka" else 0.0  # whole percents
            assert (
                move.on or time > (0.99 - rounding) * motion.duration[row]
            )  # rapids are not faster than planned
        else:
            time = move.time
        assert np.isnan(move.rate) or 0.0 < move.rate <= 1.0
        if move.on:
            length = float(np.linalg.norm(motion.position[row] - previous[0]))
            time = length / move.speed if np.isfinite(move.speed) else time
            runs.setdefault((motion.layer[row], motion.bead[row]), []).append((length, time))
        previous = (motion.position[row], move.joints)
    stated_kinds = "".join(
        content.decode("utf-8-sig")
        for name, content in write_program(way)[3].items()
        if not name.endswith("stop.pgx")
    )
    dwells = sorted(
        float(value)
        for value in re.findall(DWELLS, stated_kinds)
        if float(value) not in (0.0, POLLED)
    )
    leads, wait = (PROCESS.lead_off, PROCESS.lead_on), PROCESS.between_layers.wait
    assert dwells == [*(lead for lead in leads for _ in range(2 * SIDES)), wait]
    assert len(runs) == 2 * SIDES
    for (_, side), run in runs.items():
        length, time = np.array(run).T
        expected = wanted_speeds(side, np.r_[0.0, np.cumsum(length)])
        assert np.isfinite(time).all() and np.abs(length - expected * time).max() < max(
            MAX_LENGTH_ERROR, SPEED_SHARE * length.max()
        )
        for speed in set(expected):  # Yaskawa's VJ has steps of a hundredth
            stretch = expected == speed
            tolerance = 0.0 if len(set(expected)) == 1 else MAX_LENGTH_ERROR / length[stretch].sum()
            assert length[stretch].sum() / time[stretch].sum() == pytest.approx(
                speed, rel=0.011 + tolerance
            )
