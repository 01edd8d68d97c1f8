# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an ABB program tells of the process on its moves: ArcL with seam, weld and weave data, deposit switched ahead of its
place, wire in proportion to the real speed. Texts are read here by patterns of their own, and any damage is refused."""

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
from tests.posts.fanuc_programs import with_tool
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.posts.test_abb import HELD, JOINT, beside
from tests.programs import build

SCHEDULES, WEAVES = {"wall": 7, "contour": 3, "fill": 12}, {"wall": 4, "contour": 2, "fill": 0}
RATIO, LEAD = 4.25, 0.045
FED = WireParameters(feed_mode="proportional")
# set-up, motion, and what is told
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
def written(kind, most=2000, dry_run=False):
    setup, way = KINDS[kind]
    cell, _, motion = planned(setup)
    number = (motion.layer + motion.bead) % 3
    motion = dataclasses.replace(
        motion, bead_class=np.array([CLASSES.index(name) for name in SCHEDULES])[number]
    )
    process, told = PROCESS, {}
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
        told = {"schedule": ScheduleParameters(by="arc")}
    elif kind != "wire":
        process = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
        told = {"trigger": TriggerParameters(lead=0.0 if kind == "joint" else LEAD)}
    if kind.startswith("wire"):
        motion = dataclasses.replace(
            motion, wire=np.where(motion.deposit, RATIO * motion.speed, np.nan)
        )
        told["nc"] = NcParameters(wire_output=9, wire_gain=2.5)
    if "ahead" in kind and way == "cartesian":
        motion = linear_approach.shorten_approaches(motion, cell)
    parameters = ProgramParameters(post="abb", motion=way, max_points=most, dry_run=dry_run, **told)
    program = build(motion, cell, process, parameters, "job")
    return cell, motion, program, abb.write(program)


def codes(kind, files, most=2000):
    cell, motion, program, _ = written(kind, most)
    try:
        found = verify(cell, motion, program, files, abb, CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in found.issues if issue.level == ERROR}


def lines_of(kind, most=2000):
    files = written(kind, most)[3]
    return [
        line.strip() for name in sorted(files) for line in files[name].decode("ascii").split("\r\n")
    ]


def deposits(motion):
    """Rows of the beads that are moved to, one array each."""
    rows = np.flatnonzero(motion.moves & motion.deposit)
    return np.split(
        rows,
        np.flatnonzero((np.diff(motion.layer[rows]) != 0) | (np.diff(motion.bead[rows]) != 0)) + 1,
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("most", [2000, 40])
def test_what_is_written_reads_back_as_planned(kind, most):
    files = written(kind, most)[3]
    assert codes(kind, files, most) == set() and (len(files) > 1) == (most == 40)


@pytest.mark.parametrize("kind", ["arc", "held"])
def test_each_bead_is_welded_at_its_speed_by_its_seam_and_weave_and_no_rapid_is(kind):
    _, motion, program, _ = written(kind)
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
    taken = dict(found for line in lines for found in re.findall(r"^(\w+):=weld(\d+);", line))
    dry = {
        name: float(value)
        for line in lines
        for name, value in re.findall(r"speeddata (\w+):=\[([\d.]+),", line)
    }
    assert speeds == again and set(speeds) == set(taken)
    beads, inside, before = [], False, None
    for line in lines:
        arc = re.match(
            r"(ArcL(?:Start|End|)) \[\[([^]]*)\].*\],(\w+),seam(\d+),(\w+)(?:\\Weave:=weave(\d+))?,(\w+),t_am",
            line,
        )
        if not arc:
            assert not (inside and line.startswith("Move"))
            continue
        name, place, speed, seam, weld, weave, zone = arc.groups()
        place = [float(number) for number in place.split(",")]
        assert taken[weld] == seam
        if name == "ArcLStart":
            assert not inside and zone == "fine"
            beads.append(
                {
                    "seam": int(seam),
                    "weave": int(weave or 0),
                    "start": place,
                    "points": [],
                    "speeds": [],
                }
            )
        elif (name, place) != ("ArcLEnd", before):  # not where the torch stood after the bead
            assert dry[speed] == speeds[weld]
            beads[-1]["points"].append(place)
            beads[-1]["speeds"].append(speeds[weld])
        assert (int(seam), int(weave or 0)) == (beads[-1]["seam"], beads[-1]["weave"])
        inside, before = name != "ArcLEnd", place
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
        before for before, run in zip(program.moves, program.moves[1:]) if run.kind == "deposit"
    ]
    np.testing.assert_allclose(
        [b["start"] for b in beads], [one.position[-1] for one in starts], rtol=0.0, atol=5.1e-4
    )
    assert not any("SetDO" in line for line in lines)
    head = next(line for line in lines if line.startswith("! declare on the controller"))
    assert {f"seam{n}" for n in SCHEDULES.values()} | {
        f"weld{n}" for n in SCHEDULES.values()
    } <= set(head.split())
    assert (kind == "arc") == ("weave2 weave4" in head)


@pytest.mark.parametrize("kind", ["ahead", "joint", "wire ahead", "joint ahead", "turned ahead"])
def test_the_deposit_is_switched_on_the_moves_onto_the_beads_and_at_their_ends(kind):
    _, motion, _, _ = written(kind)
    on, off, row, triggered, early, lead = [], [], 0, {}, [], 0.0 if kind == "joint" else LEAD
    rows = np.flatnonzero(motion.moves)
    for line in lines_of(kind):
        if found := re.match(r"TriggIO (\w+),(\S+?)\\DOp:=do1,([01]);", line):
            triggered[found[1]] = (found[2], found[3])
        if re.match(r"(Move|Trigg)(AbsJ|L) \[", line):
            used = [name for name in triggered if re.search(rf"[,=]{name}(?=[,\\])", line)]
            on += [row for name in used if triggered[name][1] == "1"]
            off += [row for name in used if triggered[name][1] == "0"]
            early += [float(triggered[name][0]) - lead * motion.speed[rows][row] for name in used]
            assert len(used) < 2
            row += 1
    # so far before the end of a move as the tip gets in the lead at the speed of that very move
    assert np.abs(early).max() <= 0.00005 + lead * 0.0005 and len(early) == len(on + off)
    assert (
        (set(triggered) == {"g_on", "g_off"})
        == (kind == "joint")
        == ({way for way, _ in triggered.values()} == {"0"})
    )
    moved = motion.deposit[np.flatnonzero(motion.moves)]
    assert on == (np.flatnonzero(np.diff(moved.astype(int)) == 1)).tolist()
    assert off == (np.flatnonzero(np.diff(moved.astype(int)) == -1)).tolist()
    assert not any("SetDO" in line for line in lines_of(kind))
    # an IRC5 has no TriggAbsJ, so far as is known: Cartesian programs do without
    assert any("TriggAbsJ" in line for line in lines_of(kind)) is (KINDS[kind][1] == "joint")


@pytest.mark.parametrize("kind", ["wire", "wire ahead"])
def test_the_wire_follows_the_real_speed_on_all_moves_of_beads_and_no_other(kind):
    _, motion, _, _ = written(kind)
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
    wanted = 2.5 * 0.06 * RATIO * motion.speed[rows][list(fed)]
    np.testing.assert_allclose(list(fed.values()), wanted, rtol=2e-4)
    assert ends == np.flatnonzero(np.diff(motion.deposit[rows].astype(int)) == -1).tolist()


N = r"-?\d+\.\d+"
ARC_LINE = r"^    ArcL \[[^\n]*\n"
DAMAGE = [  # of which text, what is found in it, and what stands there then
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
    """At its first place, its last one, and one between, in the whole text and in parts."""
    for most in (2000, 40):
        files = written(kind, most)[3]
        places = [
            (name, found)
            for name in sorted(files)
            for found in re.finditer(pattern, files[name].decode())
        ]
        assert places, pattern
        for name, found in {
            id(one): one for one in (places[0], places[len(places) // 2], places[-1])
        }.values():
            text = files[name].decode()
            damaged = text[: found.start()] + found.expand(change) + text[found.end() :]
            assert damaged != text and codes(kind, {**files, name: damaged.encode()}, most), found[
                0
            ]


@pytest.mark.parametrize(
    "name", ["Weld5", "seam5", "weave2", "d_am1", "v_am1", "z_am1", "do1", "di4", "ai2"]
)
def test_no_module_and_no_routine_that_is_called_has_the_name_of_what_the_program_uses(name):
    of = GOLDENS["arc"]
    more = dataclasses.replace(of, blocks=(*of.blocks, WaitInput(4), WaitBelow(2, 1.0, 0, 0)))
    for bad, where in (
        (dataclasses.replace(more, name=name), "name"),
        (
            dataclasses.replace(more, blocks=(*more.blocks, Call(name))),
            "process.between_layers.call",
        ),
    ):
        with pytest.raises(InputError) as error:
            abb.write(bad)
        assert (error.value.code, error.value.where) == ("PROGRAM_NAME", where)
    abb.write(dataclasses.replace(GOLDENS["arc-held"], name=f"{name}0"))


def test_a_trigger_on_a_corner_is_not_read():
    """By itself, without a plan: the time of a trigger counts from where the robot stops."""
    files = written("ahead")[3]
    damaged = files["job.mod"].replace(b"g_on1,fine", b"g_on1,z_am1", 1)
    with pytest.raises(InputError) as error:
        abb.read({"job.mod": damaged})
    assert "the corner is rounded" in error.value.message


def onto(rapid):
    """A rapid with a linear move as its last one."""
    columns = ("joints", "duration", "speed", "position", "rotation", "stops", "halt")
    before, last = (
        {name: getattr(rapid, name)[rows] for name in columns}
        for rows in (slice(-1), slice(-1, None))
    )
    return [
        dataclasses.replace(rapid, **before, role=rapid.role[:-1]),
        dataclasses.replace(rapid, **last, role=rapid.role[-1:], interpolation="linear"),
    ]


def told(of, name, **how):
    """The program with its beads told otherwise. arc, weave: numbers; ahead, wire: the lead, and wire a mm."""
    blocks = []
    for block in of.blocks:
        if isinstance(block, (DepositOn, DepositOff)):
            begins = isinstance(block, DepositOn)
            weave = [Weave(how["weave"] if begins else 0)] if "weave" in how else []
            lead = 0.0 if "ahead" in how else block.lead
            if begins and "ahead" in how and of.motion == "cartesian":
                blocks[-1:] = onto(blocks[-1])
            new = dataclasses.replace(
                block, schedule=how.get("arc"), ahead=how.get("ahead"), lead=lead
            )
            blocks += [new, *weave] if begins else [*weave, new]
        elif isinstance(block, Moves) and block.kind == "deposit" and "wire" in how:
            blocks.append(dataclasses.replace(block, wire=how["wire"] * block.speed))
        else:
            blocks.append(block)
    return dataclasses.replace(of, name=name, blocks=tuple(blocks), max_points=2000)


TOOL = with_tool(HELD)
GOLDENS = {
    "arc": told(beside(HELD), "arc", arc=5, weave=2),
    "arc-held": told(HELD, "archeld", arc=5),
    "ahead": told(TOOL, "ahead", ahead=0.05),
    "ahead-joint": told(JOINT, "aheadj", ahead=0.0),
    "wire": told(TOOL, "wire", wire=3.5, ahead=0.02),
}


@pytest.mark.parametrize("name", GOLDENS)
def test_golden_modules_to_the_byte(root, name):
    files, folder = abb.write(GOLDENS[name]), root / "tests/golden/abb" / name
    assert files == {path.name: path.read_bytes() for path in folder.iterdir()}
    read = abb.read(files)
    deposit = np.repeat(
        [run.kind == "deposit" for run in GOLDENS[name].moves],
        [len(run) for run in GOLDENS[name].moves],
    )
    assert read.deposit.tolist() == deposit.tolist()
    if name == "wire":
        wire = 0.06 * 3.5 * np.concatenate([run.speed for run in GOLDENS[name].moves])
        np.testing.assert_allclose(read.wire[deposit], wire[deposit], rtol=1e-6)


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
    asked = ProgramParameters(
        post="abb", motion=motion, schedule=ScheduleParameters(by=by), **program
    )
    with pytest.raises(InputError) as error:
        refuse(planned(setup)[0], ProcessParameters(**process), asked)
    assert error.value.code == code and words in error.value.message


def ending_at(of, speed):
    """The program with the last moves of its beads at another speed of the tip, and the time that this takes."""

    def slower(block):
        if not isinstance(block, Moves) or block.kind != "deposit":
            return block
        last = np.arange(len(block)) == len(block) - 1
        duration = np.where(last, block.duration * block.speed / speed, block.duration)
        return dataclasses.replace(
            block, speed=np.where(last, speed, block.speed), duration=duration
        )

    return dataclasses.replace(of, blocks=tuple(map(slower, of.blocks)))


@pytest.mark.parametrize("of", [TOOL, JOINT])
def test_rounding_moves_no_switch_by_more_than_half_a_millisecond_and_slower_moves_are_refused(of):
    for speed in (0.1, 0.123, 0.7891, 7.7777):
        for lead in (0.0007, 0.0123, 0.1, 0.15):
            program = ending_at(told(of, "ahead", ahead=lead), speed)
            kept = np.round(speed, 3) if of is TOOL else speed
            (early,) = {
                event.before / kept
                for event in abb.read(abb.write(program)).events
                if event.kind == "off"
            }
            assert abs(early - lead) <= MOST_DIGITS + 1e-12
    slow = ending_at(told(of, "ahead", ahead=0.02), 0.09)
    with pytest.raises(InputError) as error:
        abb.write(slow)
    assert error.value.code == "TRIGGER" and "0.09 mm/s" in error.value.message
    abb.write(ending_at(told(of, "ahead", ahead=0.0), 0.09))  # where it ends, whatever the speed


def test_a_way_is_as_long_ahead_as_the_tip_takes_for_it_on_that_very_move():
    ways = ((1, 0.5), (2, 0.5), (3, 0.5), (4, 0.0))
    events = tuple(Event(row, "off", (1.0, "do"), 0.00005, before=way) for row, way in ways)
    other = Event(2, "on", (1.0, "do"), 0.001, ahead=0.03)
    first, second, third, fourth, fifth = timed((*events, other), np.array([10.0, 0.05, 0.0, 0.0]))
    assert (first.ahead, first.digits, first.before) == (0.05, 5e-6, None)
    assert (second.ahead, second.digits) == (
        10.0,
        MOST_DIGITS,
    )  # digits explain no more than that
    assert np.isnan(third.ahead) and (fourth.ahead, fourth.digits) == (0.0, 0.0) and fifth is other


def many_speeds(block):
    """A bead of 501 points and as many speeds."""
    if not isinstance(block, Moves) or block.kind != "deposit":
        return block
    names = ("joints", "duration", "position", "rotation")
    points = {name: np.repeat(getattr(block, name)[:1], 501, axis=0) for name in names}
    return dataclasses.replace(
        block, **points, speed=1.0 + 0.01 * np.arange(501), stops=None, halt=None, role=()
    )


def test_writing_refuses_it_too_and_weaves_and_speeds_beyond_what_there_is():
    for wrong, code in (
        (told(JOINT, "arc", arc=3), "SCHEDULE"),
        (told(TOOL, "weave", weave=2), "WEAVE"),
        (told(HELD, "weave", arc=3, weave=2), "WEAVE"),
        (told(TOOL, "weave", arc=3, weave=256), "WEAVE"),
        (told(JOINT, "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (told(HELD, "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (told(beside(HELD), "wire", wire=2.0), "NO_WIRE_OUTPUT"),
        (told(TOOL, "wire", arc=3, wire=2.0), "NO_WIRE_OUTPUT"),
        (told(TOOL, "seam", arc=10000), "SCHEDULE"),
        (told(TOOL, "ahead", ahead=0.51), "TRIGGER_LEAD"),
    ):
        with pytest.raises(InputError) as error:
            abb.write(wrong)
        assert error.value.code == code, code
    many = tuple(many_speeds(block) for block in told(TOOL, "many", arc=3).blocks)
    with pytest.raises(InputError) as error:
        abb.write(dataclasses.replace(TOOL, blocks=many, max_points=5000))
    assert error.value.code == "MOVE_SPEED" and "500" in error.value.message


def test_a_dry_run_has_no_arc_no_trigger_and_no_wire_and_moves_alike():
    for kind in ("held", "wire ahead"):
        text = b"".join(written(kind, dry_run=True)[3].values())
        assert not re.search(rb"Arc|Trigg|trigg|weld|ao9|SetDO", text)
        cell, motion, program, files = written(kind, dry_run=True)
        assert not [
            issue
            for issue in verify(cell, motion, program, files, abb, CHORD_ERROR).issues
            if issue.level == ERROR
        ]


def test_lines_of_moves_are_found_where_an_arc_stands_too():
    """As many as there are moves, and none of them is where an arc is struck or ends standing."""
    for kind in KINDS:
        _, motion, _, files = written(kind)
        found = found_lines("abb", files)
        assert len(found) == int(motion.moves.sum())
        (text,) = (content.decode().split("\n") for content in files.values())
        assert not any(
            "ArcLStart" in text[line] or ",v_am,seam" in text[line] for line in found.line.tolist()
        )
    assert catalogue.load("abb").NO_TRIGGER == ""
