# SPDX-License-Identifier: LGPL-2.1-or-later
"""Process data on the moves of an ABB program: ArcL with seam, weld and weave data, deposit
switched ahead of its position, wire in proportion to the real speed. Patterns of this file read the
texts, and any damage is rejected."""

import dataclasses
import functools
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.bead_classes import CLASSES
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.parameters.program import (
    NcParameters,
    ProgramParameters,
    ScheduleParameters,
    TriggerParameters,
)
from freecad_am.core.planning import linear_approach
from freecad_am.core.program import Call, DepositOff, DepositOn, Moves, WaitBelow, WaitInput, Weave
from freecad_am.core.read_moves import Event
from freecad_am.objects.program import refuse
from freecad_am.posts import catalogue
from freecad_am.posts.abb import post as abb
from freecad_am.posts.catalogue import lines_of as found_lines
from freecad_am.read_back.events import MOST_DIGITS, timed
from freecad_am.verify import verify
from tests.posts.fanuc_programs import put_tool_on_robot
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.posts.test_abb import HELD_PART, JOINT, add_positioner
from tests.programs import build

SCHEDULES, WEAVES = {"wall": 7, "contour": 3, "fill": 12}, {"wall": 4, "contour": 2, "fill": 0}
RATIO, LEAD = 4.25, 0.045
FED = WireParameters(feed_mode="proportional")
# set-up, motion and process data
KINDS = {
    "arc": ("abb positioner", "cartesian"),
    "held": ("abb part-on-robot", "cartesian"),
    "ahead": ("abb tool-on-robot", "cartesian"),
    "joint": ("abb part-on-robot", "joint"),
    "joint ahead": ("abb part-on-robot", "joint"),
    "turned ahead": ("abb positioner", "joint"),
    "wire": ("abb track", "cartesian"),
    "wire ahead": ("abb tool-on-robot", "cartesian"),
}


@functools.cache
def write_program(kind, max_points=2000, dry_run=False):
    setup, motion_kind = KINDS[kind]
    cell, _, motion = planned(setup)
    number = (motion.layer + motion.bead) % 3
    motion = dataclasses.replace(
        motion, bead_class=np.array([CLASSES.index(name) for name in SCHEDULES])[number]
    )
    process, options = PROCESS, {}
    if kind in ("arc", "held"):
        weave = (
            "; fill: schedule 12, weave 0, lead_off 0"
            if kind == "arc"
            else ", weave 0; fill: schedule 12"
        )
        process = dataclasses.replace(
            PROCESS,
            schedule=7,
            weave=4 if kind == "arc" else 0,
            lead_off=0.25 if kind == "arc" else 0.0,
            classes=f"contour: schedule 3{', weave 2' if kind == 'arc' else ''}{weave}",
        )
        options = {"schedule": ScheduleParameters(by="arc")}
    elif kind != "wire":
        process = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
        options = {"trigger": TriggerParameters(lead=0.0 if kind == "joint" else LEAD)}
    if kind.startswith("wire"):
        motion = dataclasses.replace(
            motion, wire=np.where(motion.deposit, RATIO * motion.speed, np.nan)
        )
        options["nc"] = NcParameters(wire_output=9, wire_gain=2.5)
    if "ahead" in kind and motion_kind == "cartesian":
        motion = linear_approach.shorten_approaches(motion, cell)
    parameters = ProgramParameters(
        post="abb", motion=motion_kind, max_points=max_points, dry_run=dry_run, **options
    )
    program = build(motion, cell, process, parameters, "job")
    return cell, motion, program, abb.write(program)


def codes(kind, files, max_points=2000):
    cell, motion, program, _ = write_program(kind, max_points)
    try:
        result = verify(cell, motion, program, files, abb, CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def lines_of(kind, max_points=2000):
    files = write_program(kind, max_points)[3]
    return [
        line.strip() for name in sorted(files) for line in files[name].decode("ascii").split("\r\n")
    ]


def deposits(motion):
    """Return the rows of each bead's moves, one array for each bead."""
    rows = np.flatnonzero(motion.moves & motion.deposit)
    return np.split(
        rows,
        np.flatnonzero((np.diff(motion.layer[rows]) != 0) | (np.diff(motion.bead[rows]) != 0)) + 1,
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("most", [2000, 40])
def test_what_is_written_reads_back_as_planned(kind, most):
    files = write_program(kind, most)[3]
    assert codes(kind, files, most) == set() and (len(files) > 1) == (most == 40)


@pytest.mark.parametrize("kind", ["arc", "held"])
def test_each_bead_is_welded_at_its_speed_by_its_seam_and_weave_and_no_rapid_is(kind):
    _, motion, program, _ = write_program(kind)
    lines, runs = lines_of(kind), [run for run in program.moves if run.kind == "deposit"]
    speeds = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"^(\w+)\.weld_speed:=([\d.]+);", line)
    }
    again = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"^(\w+)\.org_weld_speed:=([\d.]+);", line)
    }
    weld_numbers = dict(
        match for line in lines for match in re.findall(r"^(\w+):=weld(\d+);", line)
    )
    dry = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"speeddata (\w+):=\[([\d.]+),", line)
    }
    assert speeds == again and set(speeds) == set(weld_numbers)
    beads, inside, previous = [], False, None
    for line in lines:
        arc = re.match(
            r"(ArcL(?:Start|End|)) \[\[([^]]*)\].*\],(\w+),seam(\d+),(\w+)(?:\\Weave:=weave(\d+))?,(\w+),t_am",
            line,
        )
        if not arc:
            assert not (inside and line.startswith("Move"))
            continue
        name, position, speed, seam, weld, weave, zone = arc.groups()
        position = [float(number) for number in position.split(",")]
        assert weld_numbers[weld] == seam
        if name == "ArcLStart":
            assert not inside and zone == "fine"
            beads.append(
                {
                    "seam": int(seam),
                    "weave": int(weave or 0),
                    "start": position,
                    "points": [],
                    "speeds": [],
                }
            )
        elif (name, position) != ("ArcLEnd", previous):  # not at the torch position after the bead
            assert dry[speed] == speeds[weld]
            beads[-1]["points"].append(position)
            beads[-1]["speeds"].append(speeds[weld])
        assert (int(seam), int(weave or 0)) == (beads[-1]["seam"], beads[-1]["weave"])
        inside, previous = name != "ArcLEnd", position
        assert inside or zone == "fine"
    classes = [list(SCHEDULES)[(run.layer + run.bead) % 3] for run in runs]
    assert [bead["seam"] for bead in beads] == [SCHEDULES[name] for name in classes]
    assert [bead["weave"] for bead in beads] == [
        WEAVES[name] if kind == "arc" else 0 for name in classes
    ]
    assert (
        len({tuple(bead["speeds"]) for bead in beads}) > 2
        and len(beads) == len(deposits(motion)) > 4
    )
    for bead, run, rows in zip(beads, runs, deposits(motion), strict=True):
        np.testing.assert_allclose(bead["points"], run.position, rtol=0.0, atol=5.1e-4)
        np.testing.assert_allclose(bead["speeds"], motion.speed[rows], rtol=0.0, atol=5.1e-4)
    starts = [
        previous for previous, run in zip(program.moves, program.moves[1:]) if run.kind == "deposit"
    ]
    np.testing.assert_allclose(
        [b["start"] for b in beads], [start.position[-1] for start in starts], rtol=0.0, atol=5.1e-4
    )
    assert not any("SetDO" in line for line in lines)
    head = next(line for line in lines if line.startswith("! declare on the controller"))
    assert {f"seam{n}" for n in SCHEDULES.values()} | {
        f"weld{n}" for n in SCHEDULES.values()
    } <= set(head.split())
    assert (kind == "arc") == ("weave2 weave4" in head)


@pytest.mark.parametrize("kind", ["ahead", "joint", "wire ahead", "joint ahead", "turned ahead"])
def test_the_deposit_is_switched_on_the_moves_onto_the_beads_and_at_their_ends(kind):
    _, motion, _, _ = write_program(kind)
    on, off, row, triggered, early, lead = [], [], 0, {}, [], 0.0 if kind == "joint" else LEAD
    rows = np.flatnonzero(motion.moves)
    for line in lines_of(kind):
        if match := re.match(r"TriggIO (\w+),(\S+?)\\DOp:=do1,([01]);", line):
            triggered[match[1]] = (match[2], match[3])
        if re.match(r"(Move|Trigg)(AbsJ|L) \[", line):
            used = [name for name in triggered if re.search(rf"[,=]{name}(?=[,\\])", line)]
            on += [row for name in used if triggered[name][1] == "1"]
            off += [row for name in used if triggered[name][1] == "0"]
            early += [float(triggered[name][0]) - lead * motion.speed[rows][row] for name in used]
            assert len(used) < 2
            row += 1
    # the output switches before the end of a move, at the distance that the tip covers in the lead
    # time at the speed of that move
    assert np.abs(early).max() <= 0.00005 + lead * 0.0005 and len(early) == len(on + off)
    assert (
        (set(triggered) == {"g_on", "g_off"})
        == (kind == "joint")
        == ({distance for distance, _ in triggered.values()} == {"0"})
    )
    moved = motion.deposit[np.flatnonzero(motion.moves)]
    assert on == (np.flatnonzero(np.diff(moved.astype(int)) == 1)).tolist()
    assert off == (np.flatnonzero(np.diff(moved.astype(int)) == -1)).tolist()
    assert not any("SetDO" in line for line in lines_of(kind))
    # as far as known, an IRC5 has no TriggAbsJ, so Cartesian programs avoid it
    assert any("TriggAbsJ" in line for line in lines_of(kind)) is (KINDS[kind][1] == "joint")


@pytest.mark.parametrize("kind", ["wire", "wire ahead"])
def test_the_wire_follows_the_real_speed_on_all_moves_of_beads_and_no_other(kind):
    _, motion, _, _ = write_program(kind)
    lines, row, fed, ends = lines_of(kind), 0, {}, []
    scales = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"TriggSpeed (\w+),0\\Start,0,ao9,(\S+);", line)
    }
    stop = [name for line in lines for name in re.findall(r"TriggSpeed (\w+),0,0,ao9,0;", line)]
    speed = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"speeddata (\w+):=\[([\d.]+),", line)
    }
    for line in lines:
        if re.match(r"(Move|Trigg)(AbsJ|L) \[", line):
            names = [name for name in scales if f",{name}" in line]
            if names:
                fed[row] = scales[names[0]] * speed[re.search(r"\],(\w+),", line)[1]]
            ends += [row] if re.search(rf"\\T2:={stop[0]}\b", line) else []
            row += 1
    rows = np.flatnonzero(motion.moves)
    assert list(fed) == np.flatnonzero(motion.deposit[rows]).tolist()
    expected = 2.5 * 0.06 * RATIO * motion.speed[rows][list(fed)]
    np.testing.assert_allclose(list(fed.values()), expected, rtol=2e-4)
    assert ends == np.flatnonzero(np.diff(motion.deposit[rows].astype(int)) == -1).tolist()


N = r"-?\d+\.\d+"
ARC_LINE = r"^    ArcL \[[^\n]*\n"
DAMAGE = [  # kind of text, pattern to find, and its replacement
    ("arc", r"(?m)^    ArcLStart[^\n]*\n", ""), ("arc", r"(?m)^(    ArcLStart[^\n]*\n)", r"\1\1"),
    ("arc", r"(?m)^    ArcLEnd[^\n]*\n", ""), ("arc", r"(?m)^(    ArcLEnd[^\n]*\n)", r"\1\1"),
    ("arc", r"ArcLEnd(?=[^\n]*v_am\d)", "ArcL"), ("arc", rf"(?m){ARC_LINE}", ""), ("arc", rf"(?m)({ARC_LINE})", r"\1\1"),
    ("arc", r"(?m)^    ArcL (?=[^\n]*z_am)", "    ArcLEnd "), ("arc", r"    ArcL (?=\[)", "    MoveL "),
    ("arc", r"seam7(?=,d_am\d+\\Weave:=weave4,z)", "seam3"), ("arc", r":=weld7;", ":=weld12;"),
    ("arc", r"(\.weld_speed:=)8\.000", r"\g<1>8.500"), ("arc", r"(\.org_weld_speed:=)8\.000", r"\g<1>8.001"),
    ("arc", r"(?m)^    d_am2\.weld_speed[^\n]*\n", ""), ("arc", r"(?m)^    d_am2\.org_weld_speed[^\n]*\n", ""),
    ("arc", r"(?m)^    d_am2:=weld[^\n]*\n", ""), ("arc", r"(speeddata v_am2:=\[)8\.000", r"\g<1>8.500"),
    ("arc", r"d_am1(?=\\Weave:=weave4,z)", "d_am2"), ("arc", r"v_am1(?=,seam)", "v_am2"),
    ("arc", r"\\Weave:=weave4(?=,z)", ""), ("arc", r"\\Weave:=weave4(?=,z)", r"\\Weave:=weave2"),
    ("arc", r"\\Weave:=weave4(?=,fine)", ""), ("arc", r"(?s)\\Weave:=weave2(.*?ArcLEnd.*?)\\Weave:=weave2", r"\1"),
    ("arc", rf"(ArcLStart \[\[{N},)({N})", r"\g<1>0.500"), ("arc", rf"(ArcLStart \[\[[^]]*\],\[){N}", r"\g<1>0.5000000"),
    ("arc", r"(ArcLStart [^\n]*\[0,0,0,0\],\[)45\.0000", r"\g<1>45.5000"),
    ("arc", rf"(ArcLEnd \[\[{N},)({N})(?=[^\n]*v_am,)", r"\g<1>0.500"),
    ("arc", r"(?m)^    WaitTime 0\.500;\r\n(    ArcL )", r"\1"),
    ("arc", r"(?m)^    WaitTime 0\.250;\r\n(    ArcLEnd)", r"\1"), ("arc", rf"(ArcL \[\[){N}", r"\g<1>40.000"),
    ("arc", r"(welddata d_am2:=\[8\.000),8\.000", r"\1,7.000"), ("arc", r"welddata d_am2:=", "welddata d_am92:="),
    ("arc", r"z_am\d+(?=,t_am)", "fine"), ("arc", r"fine(?=,t_am\S*\s+WaitTime )", "z_am1"),
    ("arc", r"t_am(?=\\WObj:=w_am;\r\n    ArcL )", "tool0"), ("arc", r"d_am\d+(?=\S*,fine\S*\s+MoveAbsJ)", "d_am9"),
    ("arc", r"d_am2(?=\\Weave:=weave4,fine)", "d_am1"),
    ("arc", r"(speeddata v_am1:=\[[^]]*,)5000", r"\g<1>2500"), ("arc", r"(speeddata v_am:=\[[^]]*,)1000(?=\])", r"\g<1>90"),
    ("held", r"(?m)^    ArcLEnd[^\n]*\n", ""), ("held", rf"(ArcLStart \[\[){N}", r"\g<1>0.100"),
    ("ahead", rf"(TriggIO \w+,){N}", r"\g<1>0"), ("ahead", rf"(TriggIO \w+,){N}", r"\g<1>0.045\\Time"),
    ("ahead", rf"(TriggIO \w+,{N})", r"\1\\Start"), ("ahead", r"(TriggIO \w+,)0(\.[1-9])\d+", r"\g<1>9\2"),
    ("ahead", r"(TriggIO g_off\d+,\d+\.\d)(?!0+\\)\d+", r"\1"), ("ahead", r"(g_on\d+,\S*do)1", r"\g<1>2"),
    ("ahead", r"(g_off\d+,\S*do1,)0", r"\g<1>1"), ("ahead", r"(?m)^    TriggIO g_off[^\n]*\n", ""),
    ("ahead", r"g_off\d+(?=,fine)(?=[^\n]*\n(?:[^\n]*\n)*?[^\n]*(g_off\d+))", r"\1"),
    ("ahead", r"TriggL (\[[^\n]*),v_am1,g_on", r"MoveL \1,v_am\\V:=100.000"), ("ahead", r"g_off\d+(?=,fine)", "g_on1"),
    ("ahead", r"g_on\d+(?=,fine)", "g_off1"), ("ahead", r"(speeddata v_am1:=\[)[\d.]+", r"\g<1>8.100"),
    ("ahead", r"(?m)^    TriggL[^\n]*\n", ""), ("ahead", r"(?m)^(    Move[^\n]*\n)(    TriggL[^\n]*g_on[^\n]*\n)", r"\2\1"),
    ("ahead", r"(?m)^(    TriggL [^\n]*g_on)", r"    SetDO do1,1;\r\n\1"),
    ("ahead", r"(g_off\d+)(?=,fine)", r"\1\\T2:=g_on1"),
    ("ahead", r"(?m)^  LOCAL VAR triggdata g_on[^\n]*\n", ""), ("ahead", rf"(TriggL \[\[){N}", r"\g<1>40.000"),
    ("joint", r"TriggAbsJ (\[[^\n]*T:=[\d.]+),g_on", r"MoveAbsJ \1"),
    ("joint", r"(?m)^(    TriggAbsJ \[)", r"    SetDO do1,1;\r\n\1"),
    ("joint", r"(TriggIO g_off,)0(?=\\)", r"\g<1>0.002\\Time"), ("joint", r"(TriggIO g_off,)0(?=\\)", r"\g<1>0.0100"),
    ("joint ahead", rf"(TriggIO \w+,){N}", r"\g<1>0"), ("joint ahead", rf"(TriggIO \w+,){N}", r"\g<1>0.045\\Time"),
    ("joint ahead", r"(TriggIO g_off\d+,\d+\.\d)(?!0+\\)\d+", r"\1"), ("joint ahead", r"g_off\d+(?=,fine)", "g_on1"),
    ("joint ahead", r"(TriggIO \w+,\d+\.)\d", r"\g<1>91"), ("turned ahead", r"(TriggIO \w+,\d+\.)\d", r"\g<1>91"),
    ("joint", rf"(TriggAbsJ \[\[){N}", r"\g<1>1.0000"),
    ("joint", r"(TriggAbsJ [^\n]*T:=)([\d.]+)", r"\g<1>0.77777"),
    ("wire", r"(ao9,)(\d\.\d+)", r"\g<1>0.6400000"), ("wire", r"ao9,0;", "ao8,0;"), ("wire", r"ao9", "ao8"),
    ("wire", r"\\T2:=s_off", ""),
    ("wire", r"TriggL (\[[^\n]*),v_am2,s_am1(?=,)", r"MoveL \1,v_am\\V:=8.000"), ("wire", r"s_am1\\T2:=s_off", "s_off"),
    ("wire", r"s_am1(?=,z)", r"s_am1\\T2:=s_off"), ("wire", r"v_am1(?=,s_am1)", "v_am2"), ("wire", r"(0\\Start)", "5"),
    ("wire", r"(?m)^    SetDO do1,1;\r\n", ""), ("wire", r"T2:=s_off", "T3:=s_off"),
    ("wire", r"(s_am1,0\\Start,)0", r"\g<1>0.1"),
    ("wire ahead", r"\\T3:=g_off\d+", ""), ("wire ahead", r"\\T2:=s_off\\T3:=(g_off\d+)", r"\\T2:=\1\\T3:=s_off,"),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "pattern", "change"), DAMAGE)
def test_a_text_with_anything_else_is_refused(kind, pattern, change):
    """Damage at the first, a middle and the last match is rejected, in a single text and in
    parts."""
    for max_points in (2000, 40):
        files = write_program(kind, max_points)[3]
        all_matches = [
            (name, match)
            for name in sorted(files)
            for match in re.finditer(pattern, files[name].decode())
        ]
        assert all_matches, pattern
        for name, match in {
            id(candidate): candidate
            for candidate in (all_matches[0], all_matches[len(all_matches) // 2], all_matches[-1])
        }.values():
            text = files[name].decode()
            damaged = text[: match.start()] + match.expand(change) + text[match.end() :]
            assert damaged != text and codes(kind, {**files, name: damaged.encode()}, max_points), (
                match[0]
            )


@pytest.mark.parametrize(
    "name", ["Weld5", "seam5", "weave2", "d_am1", "v_am1", "z_am1", "do1", "di4", "ai2"]
)
def test_no_module_and_no_routine_that_is_called_has_the_name_of_what_the_program_uses(name):
    source = GOLDENS["arc"]
    with_waits = dataclasses.replace(
        source, blocks=(*source.blocks, WaitInput(4), WaitBelow(2, 1.0, 0, 0))
    )
    for bad, where in (
        (dataclasses.replace(with_waits, name=name), "name"),
        (
            dataclasses.replace(with_waits, blocks=(*with_waits.blocks, Call(name))),
            "process.between_layers.call",
        ),
    ):
        with pytest.raises(InputError) as error:
            abb.write(bad)
        assert (error.value.code, error.value.where) == ("PROGRAM_NAME", where)
    abb.write(dataclasses.replace(GOLDENS["arc-held"], name=f"{name}0"))


def test_a_trigger_on_a_corner_is_not_read():
    """A reader without a plan rejects a trigger on a rounded corner, because its time counts from
    the stop."""
    files = write_program("ahead")[3]
    damaged = files["job.mod"].replace(b"g_on1,fine", b"g_on1,z_am1", 1)
    with pytest.raises(InputError) as error:
        abb.read({"job.mod": damaged})
    assert "the corner is rounded" in error.value.message


def approach_linearly(rapid):
    """Return a rapid that ends with a linear move."""
    columns = ("joints", "duration", "speed", "position", "rotation", "stops", "halt")
    joint_moves, linear_move = (
        {name: getattr(rapid, name)[rows] for name in columns}
        for rows in (slice(-1), slice(-1, None))
    )
    return [
        dataclasses.replace(rapid, **joint_moves, role=rapid.role[:-1]),
        dataclasses.replace(rapid, **linear_move, role=rapid.role[-1:], interpolation="linear"),
    ]


def add_process_data(source, name, **options):
    """Return the program with process data on its beads. arc, weave: numbers of the data; ahead:
    the lead; wire: wire per mm."""
    blocks = []
    for block in source.blocks:
        if isinstance(block, (DepositOn, DepositOff)):
            begins = isinstance(block, DepositOn)
            weave = [Weave(options["weave"] if begins else 0)] if "weave" in options else []
            lead = 0.0 if "ahead" in options else block.lead
            if begins and "ahead" in options and source.motion == "cartesian":
                blocks[-1:] = approach_linearly(blocks[-1])
            new = dataclasses.replace(
                block, schedule=options.get("arc"), ahead=options.get("ahead"), lead=lead
            )
            blocks += [new, *weave] if begins else [*weave, new]
        elif isinstance(block, Moves) and block.kind == "deposit" and "wire" in options:
            blocks.append(dataclasses.replace(block, wire=options["wire"] * block.speed))
        else:
            blocks.append(block)
    return dataclasses.replace(source, name=name, blocks=tuple(blocks), max_points=2000)


TOOL = put_tool_on_robot(HELD_PART)
GOLDENS = {
    "arc": add_process_data(add_positioner(HELD_PART), "arc", arc=5, weave=2),
    "arc-held": add_process_data(HELD_PART, "archeld", arc=5),
    "ahead": add_process_data(TOOL, "ahead", ahead=0.05),
    "ahead-joint": add_process_data(JOINT, "aheadj", ahead=0.0),
    "wire": add_process_data(TOOL, "wire", wire=3.5, ahead=0.02),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_modules_to_the_byte(root, name):
    files, folder = abb.write(GOLDENS[name]), root / "tests/golden/abb" / name
    assert files == {path.name: path.read_bytes() for path in folder.iterdir()}
    readback = abb.read(files)
    deposit = np.repeat(
        [run.kind == "deposit" for run in GOLDENS[name].moves],
        [len(run) for run in GOLDENS[name].moves],
    )
    assert readback.deposit.tolist() == deposit.tolist()
    if name == "wire":
        wire = 0.06 * 3.5 * np.concatenate([run.speed for run in GOLDENS[name].moves])
        np.testing.assert_allclose(readback.wire[deposit], wire[deposit], rtol=1e-6)


@pytest.mark.parametrize(
    ("process", "program", "setup", "code", "words"),
    [
        (
            {"schedule": 3},
            {"by": "arc", "motion": "joint"},
            "abb tool-on-robot",
            "SCHEDULE",
            "motion: cartesian",
        ),
        ({"weave": 2}, {}, "abb tool-on-robot", "WEAVE", "program.schedule.by: arc"),
        (
            {"weave": 2, "schedule": 3},
            {"by": "call"},
            "abb tool-on-robot",
            "WEAVE",
            "program.schedule.by: arc",
        ),
        (
            {"weave": 2, "schedule": 3},
            {"by": "arc", "dry_run": True},
            "abb tool-on-robot",
            "WEAVE",
            "dry run",
        ),
        (
            {"weave": 2, "schedule": 3},
            {"by": "arc"},
            "abb part-on-robot",
            "WEAVE",
            "below a fixed torch",
        ),
        (
            {"wire": FED, "schedule": 3},
            {"by": "arc"},
            "abb tool-on-robot",
            "NO_WIRE_OUTPUT",
            "welddata",
        ),
        ({"wire": FED}, {"motion": "joint"}, "abb tool-on-robot", "NO_WIRE_OUTPUT", "joint moves"),
        ({"wire": FED}, {}, "abb part-on-robot", "NO_WIRE_OUTPUT", "moving part"),
        ({"wire": FED}, {}, "abb positioner", "NO_WIRE_OUTPUT", "moving part"),
        (
            {"schedule": 3},
            {"by": "arc", "trigger": TriggerParameters(lead=0.1)},
            "abb tool-on-robot",
            "TRIGGER",
            "arc instruct",
        ),
    ],
)
def test_what_does_not_go_together_is_refused_before_planning(process, program, setup, code, words):
    by, motion = program.pop("by", "output"), program.pop("motion", "cartesian")
    parameters = ProgramParameters(
        post="abb", motion=motion, schedule=ScheduleParameters(by=by), **program
    )
    with pytest.raises(InputError) as error:
        refuse(planned(setup)[0], ProcessParameters(**process), parameters)
    assert error.value.code == code and words in error.value.message


def ending_at(source, speed):
    """Return the program with another tip speed on the last moves of its beads, and the matching
    time."""

    def slower(block):
        if not isinstance(block, Moves) or block.kind != "deposit":
            return block
        is_last = np.arange(len(block)) == len(block) - 1
        duration = np.where(is_last, block.duration * block.speed / speed, block.duration)
        return dataclasses.replace(
            block, speed=np.where(is_last, speed, block.speed), duration=duration
        )

    return dataclasses.replace(source, blocks=tuple(map(slower, source.blocks)))


@pytest.mark.parametrize("of", [TOOL, JOINT])
def test_rounding_moves_no_switch_by_more_than_half_a_millisecond_and_slower_moves_are_refused(of):
    for speed in (0.1, 0.123, 0.7891, 7.7777):
        for lead in (0.0007, 0.0123, 0.1, 0.15):
            program = ending_at(add_process_data(of, "ahead", ahead=lead), speed)
            written_speed = np.round(speed, 3) if of is TOOL else speed
            (early,) = {
                event.before / written_speed
                for event in abb.read(abb.write(program)).events
                if event.kind == "off"
            }
            assert abs(early - lead) <= MOST_DIGITS + 1e-12
    slow = ending_at(add_process_data(of, "ahead", ahead=0.02), 0.09)
    with pytest.raises(InputError) as error:
        abb.write(slow)
    assert error.value.code == "TRIGGER" and "0.09 mm/s" in error.value.message
    abb.write(ending_at(add_process_data(of, "ahead", ahead=0.0), 0.09))  # at its end, at any speed


def test_a_way_is_as_long_ahead_as_the_tip_takes_for_it_on_that_very_move():
    distances = ((1, 0.5), (2, 0.5), (3, 0.5), (4, 0.0))
    events = tuple(
        Event(row, "off", (1.0, "do"), 0.00005, before=distance) for row, distance in distances
    )
    timed_event = Event(2, "on", (1.0, "do"), 0.001, ahead=0.03)
    switch_on, switch_1, switch_2, switch_3, switch_4 = timed(
        (*events, timed_event), np.array([10.0, 0.05, 0.0, 0.0])
    )
    assert (switch_on.ahead, switch_on.digits, switch_on.before) == (0.05, 5e-6, None)
    assert (switch_1.ahead, switch_1.digits) == (
        10.0,
        MOST_DIGITS,
    )  # the rounding explains no more than this
    assert (
        np.isnan(switch_2.ahead)
        and (switch_3.ahead, switch_3.digits) == (0.0, 0.0)
        and switch_4 is timed_event
    )


def many_speeds(block):
    """Return a bead of 501 points with a different speed at each."""
    if not isinstance(block, Moves) or block.kind != "deposit":
        return block
    names = ("joints", "duration", "position", "rotation")
    points = {name: np.repeat(getattr(block, name)[:1], 501, axis=0) for name in names}
    return dataclasses.replace(
        block, **points, speed=1.0 + 0.01 * np.arange(501), stops=None, halt=None, role=()
    )


def test_writing_refuses_it_too_and_weaves_and_speeds_beyond_what_there_is():
    for wrong, code in (
        (add_process_data(JOINT, "arc", arc=3), "SCHEDULE"),
        (add_process_data(TOOL, "weave", weave=2), "WEAVE"),
        (add_process_data(HELD_PART, "weave", arc=3, weave=2), "WEAVE"),
        (add_process_data(TOOL, "weave", arc=3, weave=256), "WEAVE"),
        (add_process_data(JOINT, "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (add_process_data(HELD_PART, "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (add_process_data(add_positioner(HELD_PART), "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (add_process_data(TOOL, "wire", arc=3, wire=2.0), "NO_WIRE_OUTPUT"),
        (add_process_data(TOOL, "seam", arc=10000), "SCHEDULE"),
        (add_process_data(TOOL, "ahead", ahead=0.51), "TRIGGER_LEAD"),
    ):
        with pytest.raises(InputError) as error:
            abb.write(wrong)
        assert error.value.code == code, code
    blocks = tuple(many_speeds(block) for block in add_process_data(TOOL, "many", arc=3).blocks)
    with pytest.raises(InputError) as error:
        abb.write(dataclasses.replace(TOOL, blocks=blocks, max_points=5000))
    assert error.value.code == "MOVE_SPEED" and "500" in error.value.message


def test_a_dry_run_has_no_arc_no_trigger_and_no_wire_and_moves_alike():
    for kind in ("held", "wire ahead"):
        text = b"".join(write_program(kind, dry_run=True)[3].values())
        assert not re.search(rb"Arc|Trigg|trigg|weld|ao9|SetDO", text)
        cell, motion, program, files = write_program(kind, dry_run=True)
        assert not [
            issue
            for issue in verify(cell, motion, program, files, abb, CHORD_ERROR).issues
            if issue.level == ERROR
        ]


def test_lines_of_moves_are_found_where_an_arc_stands_too():
    """A program with arcs lists one line for each move; none of them is a line that only strikes or
    ends an arc."""
    for kind in KINDS:
        _, motion, _, files = write_program(kind)
        move_lines = found_lines("abb", files)
        assert len(move_lines) == int(motion.moves.sum())
        (text,) = (content.decode().split("\n") for content in files.values())
        assert not any(
            "ArcLStart" in text[line] or ",v_am,seam" in text[line]
            for line in move_lines.line.tolist()
        )
    assert catalogue.load("abb").NO_TRIGGER == ""
