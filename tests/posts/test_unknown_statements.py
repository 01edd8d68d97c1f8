# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements of controller languages that a reader does not understand are rejected on their own
line, at every line of a program. Understood but unknown items (numbers of frames and tools,
programs on the controller) are reported."""

import re
from pathlib import Path

import numpy as np
import pytest

from freecad_am.batch.check import _add_statement
from freecad_am.core.issues import ERROR, WARNING, InputError
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.program import build_header
from freecad_am.posts import catalogue
from freecad_am.read_back import followed
from freecad_am.read_back.selected import selection_findings
from tests.posts.planned_jobs import write_program

GOLDEN = Path(__file__).parents[1] / "golden"
# folder or file of a program, and the lines that a statement may precede
PROGRAMS = {
    "abb": ("abb/both", r"PROC \w+\(\)$"),
    "ur": ("ur/TABLE.script", r"global platform"),
    "yaskawa": ("yaskawa/WOVEN.JBI", "NOP"),
    "siemens": ("siemens/tip", r"."),
    "linuxcnc": ("linuxcnc/tip", r"."),
}
STATEMENTS = {
    "abb": r"""
VelSet 50,800;
AccSet 50,50;
SpeedRefresh 50;
PDispOn \ExeP:=p1,p2,tool0;
PDispSet pose1;
PDispOff;
EOffsSet eax;
EOffsOff;
MoveL Offs(p10,0,0,5),v100,fine,tool0;
MoveJ p10,v100,fine,tool0;
MoveC p10,p20,v100,z1,tool0;
IF reg1=1 THEN
ENDIF
FOR i FROM 1 TO 3 DO
WHILE TRUE DO
GOTO label1;
label1:
reg1:=5;
t_am.tframe.trans.z:=10;
Set do1;
SetAO ao1,5;
PulseDO do1;
SingArea\Wrist;
ConfL\On;
CornerPath;
Stop;
EXIT;
ExitCycle;
RETURN;
raise;
StopMove;
ClearPath;
StorePath;
SoftDeact;
SoftAct 1,50;
GripLoad load1;
CallByVar "p",1;
DeactUnit STN1;
WaitUntil di1=1;
clean 5;
/Stop;""",
    "ur": r"""
set_tcp(p[0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
global platform = p[0.0, 0.0, 0.1, 0.0, 0.0, 0.0]
platform = p[0,0,0,0,0,0]
movel(p[0,0,0,0,0,0], a=1.2, v=0.25)
movec(p1, p2)
servoj([0,0,0,0,0,0])
speedl([0,0,0.1,0,0,0], 0.5)
stopj(2)
if True:
while True:
x = 5
halt
halt()
freedrive_mode()
end_force_mode()
stop_conveyor_tracking()
path_offset_disable()
sync()
powerdown()
set_payload(5)
set_gravity([0,0,9.8])
set_speed(0.5)
motion_version_set(2)
run x()
return
thread t():
set_analog_out(0, 1)
set_tool_digital_out(0, True)""",
    "yaskawa": r"""
MOVJ P001 VJ=50.00
MOVL C00000 V=50.0 UNTIL IN#(1)=ON
MOVC C00000 V=50.0
MOVS C00000 V=50.0
IMOV P001 V=10.0
SFTON P001
SFTOF
SPEED VJ=50.00
SET B000 1
INC B000
JUMP *A
*A
IFTHEN B000=1
WHILEEXP B000=1
RET
PAUSE
ABORT
MFRAME UF#(1) P001
SETTOOL TL#(1) P001
PULSE OT#(1)
AOUT AO#(1) 5.0
WAIT IN#(1)=OFF
WAIT IN#(1)=ON T=5.0
CALL JOB:X IF IN#(1)=ON
REFP 1 P001
ARCON
ARCSET AC=200
GETS PX001 $PX001
END
/MOVJ""",
    "siemens": r"""
TRANS X5
TRANS
ATRANS Z1
ROT Z45
AROT
SCALE X2
MIRROR X0
SUPA
G53
G153
G700
G91
G0 X0
G2 X1 Y1 I1
G41
G19
OVR=50
FLIM=10
IF R1==1
GOTOF L
L:
LOOP
REPEAT
R1=5
$P_UIFR[1]=CTRANS(X,5)
$TC_DP3[1,1]=100
M0
M3
M30
RET
T1
DIAMON
TOFFL=5
MCALL X
PRESETON(X,5)
CYCLE800(1)
TRANSMIT
ACC[X]=50
TOROT
CDON
ORIMKS
/N10 G1
/ H1=1""",
    "linuxcnc": r"""
G0 X0
G2 X1 Y1 I1
G20
G91
G53
G92 X5
G92.1
G52 X1
G10 L2 P1 X5
G41 D1
G43.1 Z5
G28
G38.2 Z-1
G18
G19
G95
G96 D2500 S2500
G33 Z1 K1
G51
G68
G81 Z-1 R1
G7
M0
M2
M48
M49
M50 P0
M6
M61 Q2
M66 P0 L0
M70
M98
T2
S100
#1=5
#<A>=5
O100 IF [#1 EQ 1]
O<X> CALL [1]
/ G1 X0
/M64 P0
F100
(MSG,hello)
(DEBUG,x)
%""",
}


def program(post):
    """Return the files of a program that its reader understands, and by file the line numbers, from
    1, of its statements."""
    location, begins = PROGRAMS[post]
    path = GOLDEN / location
    paths = sorted(path.iterdir()) if path.is_dir() else [path]
    files = {path.name: path.read_bytes().decode("ascii") for path in paths}
    lines = {}
    for name, text in files.items():
        rows = [row.strip() for row in text.splitlines()]
        first_row = next(k for k, row in enumerate(rows) if re.match(begins, row)) + 2
        lines[name] = range(first_row, len(rows) + 1 - (2 if post == "abb" else 1))
    return files, lines


def encoded(files):
    return {name: text.encode("ascii") for name, text in files.items()}


def inserted(text, line, statement):
    rows = text.splitlines(keepends=True)
    end = "\r\n" if "\r\n" in text else "\n"
    # indented like the line before, where indentation matters
    ahead = re.match(r" *", rows[line - 2])[0] or re.match(r" *", rows[line - 1])[0]
    return "".join([*rows[: line - 1], ahead, statement, end, *rows[line - 1 :]])


@pytest.mark.parametrize("post", PROGRAMS)
def test_a_statement_that_is_not_understood_is_refused_on_its_line(post):
    files, lines = program(post)
    read_files = catalogue.load(post).read
    assert len(read_files(encoded(files)).deposit)
    statements = STATEMENTS[post].strip().splitlines()
    assert len(statements) >= 25
    for name, numbers in lines.items():
        for line in list(numbers)[:: max(1, len(numbers) // 4)]:
            for statement in statements:
                changed = encoded({**files, name: inserted(files[name], line, statement)})
                try:
                    read_files(changed)
                except InputError as error:
                    message = _add_statement(error, changed)
                    assert message.code == "UNREADABLE_PROGRAM"
                    assert message.where == f"{name} line {line}", (statement, message.message)
                    assert repr(statement.strip()) in message.message
                else:
                    raise AssertionError((name, line, statement))


@pytest.mark.parametrize(
    ("post", "file", "statement"),
    [
        ("linuxcnc", "joint/joint.ngc", "M64 P5"),
        ("linuxcnc", "joint/joint.ngc", "M8"),
        ("siemens", "joint/JOINT.MPF", "M8"),
    ],
)
def test_a_second_output_is_refused_with_the_place_of_the_first(post, file, statement):
    path = GOLDEN / post / file
    text, name = path.read_text(encoding="ascii"), path.name
    line_number = next(k for k, row in enumerate(text.splitlines(), 1) if "G1 " in row)
    changed = encoded({name: inserted(text, line_number, statement)})
    with pytest.raises(InputError) as raised:
        catalogue.load(post).read(changed)
    assert f"the first is {name} line {line_number}" in raised.value.message


@pytest.mark.parametrize("statement", ["WVON WEV#(1)", "WVOF"])
def test_a_weave_that_begins_twice_or_does_not_end_is_refused(statement):
    files, lines = program("yaskawa")
    ((name, text),) = files.items()
    for line in lines[name]:
        with pytest.raises(
            InputError, match=r"weaving is already on|the weave that begins here has no end"
        ):
            catalogue.load("yaskawa").read(encoded({name: inserted(text, line, statement)}))


FRAMES = [
    (("linuxcnc", "cartesian", "time", "table"), "G54", "G55", "the program selects work frame 2,"),
    (("linuxcnc", "cartesian", "time", "table"), "G43 H1", "G43 H2", "the program selects tool 2,"),
    (("linuxcnc", "cartesian", "time", "table"), "G43 H1", "G49", "the program selects tool 0,"),
    (("siemens", "cartesian", "time", "table"), "G54", "G55", "the program selects work frame 2,"),
    (("siemens", "cartesian", "time", "table"), " D1", " D2", "the program selects tool 2,"),
    (("kuka", "cartesian", "time", "kuka tool-on-robot"), "#BASE,1", "#BASE,4", "work frame 4"),
    (("yaskawa", "joint", "time", "yaskawa tool-on-robot"), "///TOOL 1", "///TOOL 3", "tool 3"),
]


def findings(variant, files, expected):
    cell, _, _, _ = write_program(variant)
    readback = catalogue.load(variant[0]).read(files)
    header = build_header(
        cell, ProgramParameters(post=variant[0]), catalogue.controller(variant[0]), "check"
    )
    motion = followed.drive(cell, header, readback)
    return [
        finding for finding in selection_findings(motion, readback, expected)
        if finding.issue.code == "FRAME_NUMBER"
    ]  # fmt: skip


@pytest.mark.parametrize(("way", "old", "new", "words"), FRAMES)
def test_another_frame_or_tool_than_the_job_s_is_reported(way, old, new, words):
    files = write_program(way)[3]
    assert any(old.encode() in content for content in files.values())
    changed = {name: content.replace(old.encode(), new.encode()) for name, content in files.items()}
    assert findings(way, files, (1, 1)) == []
    (finding,) = findings(way, changed, (1, 1))
    assert finding.issue.level == WARNING and words in finding.issue.message


def test_a_frame_or_tool_that_changes_on_the_way_is_an_error():
    variant = ("linuxcnc", "cartesian", "time", "table")
    ((name, content),) = write_program(variant)[3].items()
    for old, new in ((b"G54", b"G55"), (b"M428", b"G49\nM428")):
        positions = [finding.start() for finding in re.finditer(rb"\b" + old, content)]
        assert len(positions) > 2
        position = positions[1]
        changed = {name: content[:position] + new + content[position + len(old) :]}
        (finding,) = findings(variant, changed, None)
        assert finding.issue.level == ERROR and finding.row is not None


def test_a_program_that_is_not_among_the_files_is_reported_once():
    variant = ("siemens", "joint", "time", "table")
    _, motion, _, files = write_program(variant)
    reported = selection_findings(motion, catalogue.load(variant[0]).read(files), None)
    assert [(finding.issue.level, finding.issue.code) for finding in reported] == [
        (WARNING, "OTHER_PROGRAM")
    ]
    assert "calls CLEAN" in reported[0].issue.message
    assert np.isfinite(motion.position[reported[0].row]).all()
