# SPDX-License-Identifier: LGPL-2.1-or-later
"""Judges of FANUC listings and VAL 3 applications that share no code with the posts, and random
programs to judge."""

import dataclasses
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Wait,
    WaitInput,
)

HEADER = [
    r"/PROG  [A-Z][A-Z0-9_]{0,35}",
    r"/ATTR",
    r"OWNER\t\t= MNEDITOR;",
    r'COMMENT\t\t= "[ -~]{0,16}";',
    r"PROG_SIZE\t= 0;",
    r"CREATE\t\t= DATE \d\d-\d\d-\d\d  TIME \d\d:\d\d:\d\d;",
    r"MODIFIED\t= DATE \d\d-\d\d-\d\d  TIME \d\d:\d\d:\d\d;",
    r"FILE_NAME\t= ;",
    r"VERSION\t\t= 0;",
    r"LINE_COUNT\t= \d+;",
    r"MEMORY_SIZE\t= 0;",
    r"PROTECT\t\t= READ_WRITE;",
    r"TCD:  STACK_SIZE\t= 0,",
    r"      TASK_PRIORITY\t= 50,",
    r"      TIME_SLICE\t= 0,",
    r"      BUSY_LAMP_OFF\t= 0,",
    r"      ABORT_REQUEST\t= 0,",
    r"      PAUSE_REQUEST\t= 0;",
    r"DEFAULT_GROUP\t= 1,\*,\*,\*,\*;",
    r"CONTROL_CODE\t= 00000000 00000000;",
    r"/MN",
]
SPEED = r"(?:[1-9]\d?%|(?:[1-9]\d{0,3}|[12]\d{4}|3[01]\d{3}|32000)msec|[1-9]\d{0,3}\.\dsec)"
# only before a stop
TIME_BEFORE = r"(?: TB(?=.{7}sec) *(?:0\.00|[1-9]?\.(?!00)\d\d)sec,DO\[[1-9]\d*\]=(?:ON|OFF))"
INSTRUCTIONS = [
    rf"J P\[\d+\] {SPEED} (?:FINE{TIME_BEFORE}?|CNT(?:\d\d?|100))    ;",
    rf"L P\[\d+\] (?:{SPEED}|\d{{1,4}}\.\dmm/sec) (?:FINE{TIME_BEFORE}?|CNT(?:\d\d?|100))    ;",
    r"  U(?:FRAME|TOOL)_NUM=\d+ ;",
    r"  DO\[\d+\]=(?:ON|OFF) ;",
    r"  WAIT(?=.{7}\() *\d*\.\d\d\(sec\) ;",
    r"  WAIT DI\[\d+\]=ON    ;",
    r"  Weave (?:Sine\[[1-9]\d*\]|End) ;",
    r"  CALL [A-Z][A-Z0-9_]{0,35}    ;",
    r"  ![ -:<-~]{1,32} ;",
]
VALUE = r"(?=.{10} )(?: *-?[1-9]\d*\.\d{3}| *-?\.(?!000)\d{3}| *0\.000)"
FRAMES = r"\tUF : (\d+), UT : (\d+),"
JOINTS = [FRAMES + r"\t"] + [
    ",".join(rf"\tJ{axis}={VALUE} deg" for axis in row) + end
    for row, end in (((1, 2, 3), ","), ((4, 5, 6), ""))
]
POSES = [
    FRAMES + r"\t\tCONFIG : '[NF] [UD] [TB], 0, 0, -?\d',",
    ",".join(rf"\t{axis} ={VALUE}  mm" for axis in "XYZ") + ",",
    ",".join(rf"\t{axis} ={VALUE} deg" for axis in "WPR"),
]


def _find_faults(file, content):
    """Return the differences from what controllers write. Strict, and only for the plain
    instructions of a path."""
    if content.replace(b"\r\n", b"").count(b"\n") or not content.endswith(b"/END\r\n"):
        yield "line ends"
    lines = content.decode("ascii").split("\r\n")[:-1]
    for number, (pattern, line) in enumerate(zip(HEADER, lines, strict=False)):
        if not re.fullmatch(pattern, line):
            yield f"header line {number + 1}: {line!r}"
    if lines[0] != f"/PROG  {file.removesuffix('.LS')}":
        yield "program and file differ in name"
    positions = lines.index("/POS")
    body = lines[len(HEADER) : positions]
    if f"LINE_COUNT\t= {len(body)};" not in lines or len(body) > 9999:
        yield "number of lines"
    for number, line in enumerate(body, 1):
        if line[:5] != f"{number:4d}:" or not any(
            re.fullmatch(pattern, line[5:]) for pattern in INSTRUCTIONS
        ):
            yield f"instruction {number}: {line!r}"
    used = [int(point) for point in re.findall(r"[JL] P\[(\d+)\]", "\n".join(body))]
    records = lines[positions + 1 : -1]
    if used != list(range(1, len(used) + 1)) or len(records) != 6 * len(used):
        yield "points and records"
    for number in range(len(records) // 6):
        start, group, *values, end = records[6 * number : 6 * number + 6]
        shape = JOINTS if "CONFIG" not in values[0] else POSES
        right = all(
            re.fullmatch(pattern, line) for pattern, line in zip(shape, values, strict=True)
        )
        if (start, group, end) != (f"P[{number + 1}]{{", "   GP1:", "};") or not right:
            yield f"record {number + 1}: {values}"
        frames = re.match(FRAMES, values[0])
        if (
            frames
            and [f"   1:  UFRAME_NUM={frames[1]} ;", f"   2:  UTOOL_NUM={frames[2]} ;"] != body[:2]
        ):
            yield f"record {number + 1} is in another frame than the one selected"


@pytest.fixture
def assert_listings(tmp_path, root):
    """Return a function that fails if a file of a program is not as a FANUC controller writes
    it."""
    shared_check = Path(
        os.environ.get("FANUC_LS_CHECK", root.parent / "shared/recipes/posts/fanuc_ls_check.py")
    )

    def judge(files):
        assert not [
            f"{file}: {fault}"
            for file, content in files.items()
            for fault in _find_faults(file, content)
        ]
        if shared_check.exists():
            for file, content in files.items():
                (tmp_path / file).write_bytes(content)
            command = [
                sys.executable,
                str(shared_check),
                "--style",
                *(str(tmp_path / file) for file in files),
            ]
            result = subprocess.run(command, capture_output=True, text=True)
            assert result.returncode == 0, result.stdout

    return judge


def _random_program(seed, motion="joint", continuous=True, **options):
    rng = np.random.default_rng(seed)
    continuous = continuous and motion == "joint"
    position = rng.uniform(-2.0, 2.0, 6)
    blocks = []

    def moves(kind, layer, bead, count):
        nonlocal position
        steps = rng.normal(0.0, 0.03, (count, 6))
        if continuous:
            steps[:, 5] = rng.uniform(-3.1, 3.1, count)
        joints = position + np.cumsum(steps, axis=0)
        joints[:, :5][rng.random((count, 5)) < 0.1] *= 1e-5  # small values of both signs
        if not continuous:
            joints = np.clip(joints, -3.1, 3.1)
        position = joints[-1]
        duration = rng.choice([0.0011, 0.05, 0.3, 4.0, 31.9994, 40.0, 3000.0], count) * rng.uniform(
            1.0, 1.05, count
        )
        extra = {}
        if motion == "cartesian":
            normal = rng.normal(size=(count, 3, 3))
            turned = np.linalg.qr(normal)[0]
            turned *= np.linalg.det(turned)[:, None, None]
            words = [
                ("front", ("up", "down")[int(down)], "flip") for down in rng.integers(0, 2, count)
            ]
            extra = {
                "position": rng.uniform(-2000, 2000, (count, 3)),
                "rotation": turned,
                "configuration": tuple(words),
                "interpolation": "linear" if kind == "deposit" else "joint",
            }
        return Moves(kind, layer, bead, joints, duration, rng.uniform(0.5, 150.0, count), **extra)

    for layer in range(int(rng.integers(1, 5))):
        blocks.append(LayerStart(layer))
        for bead in range(int(rng.integers(1, 4))):
            blocks.append(moves("rapid", layer, bead, int(rng.integers(1, 4))))
            blocks.append(DepositOn(float(rng.choice([0.0, 0.004, 0.5]))))
            blocks.append(moves("deposit", layer, bead, int(rng.integers(1, 40))))
            blocks.append(DepositOff(float(rng.choice([0.0, 1.25]))))
        blocks += [Wait(float(rng.choice([0.0, 12.5, 700.0]))), WaitInput(3), Call("clean")][
            : int(rng.integers(0, 4))
        ]
    blocks.append(moves("rapid", layer, bead, 1))
    setup = "tool-on-robot" if motion == "cartesian" else "part-on-robot"
    options = {
        "max_points": int(rng.integers(10, 120)),
        "blend": int(rng.integers(0, 101)),
    } | options
    return Program(
        "Random",
        "a machine",
        tuple(blocks),
        (False,) * 5 + (continuous,),
        motion=motion,
        setup=setup,
        user_frame=int(rng.integers(0, 10)),
        tool_frame=int(rng.integers(1, 10)),
        deposit_output=int(rng.integers(1, 99)),
        remarks=('A remark; longer than a line of the controller can be: Größe "1"',),
        **options,
    )


@pytest.fixture
def random_program():
    """Return a function that builds a random program with all kinds of blocks from a seed."""
    return _random_program


@pytest.fixture
def random_application(random_program):
    """Return a function that builds a random program within VAL 3's abilities from a seed, a motion
    and a set-up."""

    def make(seed, motion="joint", setup="part-on-robot", **options):
        program = random_program(seed, motion, continuous=False, **options)
        blocks = []
        for block in program.blocks:
            if isinstance(block, Moves):
                block = dataclasses.replace(block, duration=np.clip(block.duration, 0.3, 4.0))
            blocks.append(block)
        return dataclasses.replace(
            program,
            setup=setup,
            blocks=tuple(blocks),
            max_speed=(15.0, 14.0, 15.5, 20.0, 16.0, 35.0),
            station=(300.25, -20.5, 310.125, 0.1, -0.2, 3.0),
            carried=(1.0, 2.0, 105.0, 0.3, 0.2, 0.1),
        )

    return make


VAL3 = "{http://www.staubli.com/robotics/VAL3/"
WORD = r"[a-zA-Z][a-zA-Z0-9_]{0,14}"
NUMBER = r"-?(?:0|[1-9]\d*)\.\d+"
ATTRIBUTES = {
    "jointRx": dict.fromkeys(("j1", "j2", "j3", "j4", "j5", "j6"), NUMBER),
    "dio": {"link": r"BasicIO-1\\%[IQ]\d+"},
    "mdesc": {
        "accel": "100",
        "decel": "100",
        "vel": r"100|\d{1,2}\.\d{5}|100\.0{5}",
        "tmax": r"99999|\d+\.\d{3}",
        "rmax": "99999",
        "blend": "off|joint|Cartesian",
        "leave": r"\d+\.\d{3}",
        "reach": r"\d+\.\d{3}",
    },
}
ATTRIBUTES["frame"] = dict.fromkeys(("x", "y", "z", "rx", "ry", "rz"), NUMBER) | {
    "fatherId": r"world\[0\]"
}
ATTRIBUTES["tool"] = ATTRIBUTES["frame"] | {"fatherId": r"(?:flange|tCarried)\[0\]"}
ATTRIBUTES["pointRx"] = ATTRIBUTES["frame"] | {
    "fatherId": r"fStation\[0\]",
    "shoulder": "ssame",
    "elbow": "esame",
    "wrist": "wsame",
}
PLACE = r"(?:\[(\d+|l_nI(?:[+-]\d+)?)\])?"
VAL3_MOVE = rf"(move[jl])\(({WORD}){PLACE},({WORD}){PLACE},({WORD}){PLACE}\)"
STATEMENTS = [
    VAL3_MOVE, r"// [ -~]+", r"for l_nI=\d+ to \d+", "endFor", r"waitEndMove\(\)", r"resetMotion\(\)",
    "doDeposit=(?:true|false)",
    r"delay\(\d+\.\d{3}\)", rf"wait\({WORD}==true\)", rf"call {WORD}:start\(\)", rf'if prog:libLoad\("\./{WORD}"\)!=0',
    r'popUpMsg\("[ -~]+"\)', "return", "endIf",
]  # fmt: skip


def _parsed(content):
    text = content.decode("utf-8")
    assert text[0] == "\ufeff" and "\r" not in text
    return ElementTree.fromstring(text[1:])


def _find_data_faults(file, data):
    """Check types, sizes and attributes of the data. Yield the faults and return type and size by
    name."""
    for name, (kind, size, values) in data.items():
        if (
            not re.fullmatch(WORD, name)
            or kind not in ATTRIBUTES
            or int(size) != len(values)
            or not values
        ):
            yield f"{file}: {name} is {kind} of size {size} with {len(values)} values"
            continue
        for key, value in enumerate(values):
            expected = {"key": str(key)} | ATTRIBUTES[kind]
            if set(value) != set(expected) or not all(
                re.fullmatch(expected[a], value[a]) for a in expected
            ):
                yield f"{file}: {name} {value}"


def _find_code_faults(file, lines, data):
    """Check that the code has plain statements only, which stay inside their arrays and use each
    point once, in order."""
    if (lines[0], lines[-1]) != ("begin", "end"):
        yield f"{file}: begin and end"
    used, moving, counter = {"jPath": [], "tPath": [], "pPath": []}, False, None
    for line in map(str.strip, lines[1:-1]):
        if not any(re.fullmatch(pattern, line) for pattern in STATEMENTS):
            yield f"{file}: {line}"
        move, loop = re.fullmatch(VAL3_MOVE, line), re.fullmatch(r"for l_nI=(\d+) to (\d+)", line)
        if loop:
            counter = range(int(loop[1]), int(loop[2]) + 1)
            if len(counter) < 2:
                yield f"{file}: {line}"
        elif line == "endFor":
            counter = None
        elif move:
            moving = True
            kinds = ("jointRx" if move[1] == "movej" else "pointRx", "tool", "mdesc")
            for name, index, kind in zip(move.groups()[1::2], move.groups()[2::2], kinds):
                rows = [
                    eval(index or "0", {"l_nI": i})
                    for i in (counter if counter is not None else (0,))
                ]
                if data[name][0] != kind or min(rows) < 0 or max(rows) >= int(data[name][1]):
                    yield f"{file}: {line}: {name}"
                used.setdefault(name, []).extend(rows)
        elif line == "waitEndMove()":
            moving = False
        elif moving and not line.startswith("//"):
            yield f"{file}: {line} does not wait for the motion"
    for name in ("jPath", "tPath", "pPath"):
        if used[name] != list(range(int(data[name][1]) if name in data else 0)):
            yield f"{file}: {name} is not used once and in order"
    if moving:
        yield f"{file}: ends in motion"


def _find_application_faults(project, files):
    folder, name = project.rsplit("/", 1)[0], project.rsplit("/", 1)[1].removesuffix(".pjx")
    root = _parsed(files[project])
    space = VAL3 + "Project/3}"
    listed = [element.get("file") for element in root.iter(space + "Program")]
    datas = [element.get("file") for element in root.iter(space + "Data")]
    own_files = {file.rsplit("/", 1)[1] for file in files if file.rsplit("/", 1)[0] == folder}
    if (
        folder.rsplit("/", 1)[-1] != name
        or not re.fullmatch(WORD, name)
        or root.tag != space + "Project"
    ):
        yield f"{project}: name of folder and project"
    if (
        listed != ["start.pgx", "stop.pgx"]
        or datas != [f"{name}.dtx"]
        or own_files != {*listed, *datas, f"{name}.pjx"}
    ):
        yield f"{project}: files {listed} {datas} {own_files}"
    aliases = {
        element.get("alias"): element.get("path") for element in root.iter(space + "Library")
    }
    for alias, path in aliases.items():
        if (
            not re.fullmatch(rf"Disk://{alias}/{alias}\.pjx", path)
            and f"{folder}/{path.removeprefix('./')}" not in files
        ):
            yield f"{project}: library {alias} {path}"
    space = VAL3 + "Data/2}"
    data = {
        d.get("name"): (d.get("type"), d.get("size"), [dict(v.attrib) for v in d]) for d in
        _parsed(files[f"{folder}/{name}.dtx"]).iter(space + "Data")
    }  # fmt: skip
    yield from _find_data_faults(f"{folder}/{name}.dtx", data)
    for program in ("start", "stop"):
        element = _parsed(files[f"{folder}/{program}.pgx"])[0]
        code = element.findtext(VAL3 + "Program/2}Code")
        if element.get("name") != program or element.get("access") != "public":
            yield f"{folder}/{program}.pgx: name or access"
        if ("l_nI" in code) != (element.find(f".//{VAL3}Program/2}}Local") is not None):
            yield f"{folder}/{program}.pgx: the counter and its declaration"
        if set(re.findall(r"(\w+):", re.sub('//.*|"[^"]*"', "", code))) - set(aliases):
            yield f"{folder}/{program}.pgx: a library that is not declared"
        if program == "start":
            yield from _find_code_faults(f"{folder}/start.pgx", code.split("\n"), data)


LXML_LINT = """\
#!{python}
import sys
from lxml import etree
schema = etree.RelaxNG(etree.parse(sys.argv[3]))
if not schema.validate(etree.parse(sys.argv[4])):
    sys.exit("\\n".join(f"element: error : {{entry.message}}" for entry in schema.error_log))
"""


@pytest.fixture
def assert_applications(tmp_path, root):
    """Return a function that fails if the files of a program are not a valid VAL 3 application. A
    shared check with its RELAX NG schema runs too if it is next to the repository; it calls
    xmllint, or lxml where that is missing."""
    shared_check = Path(
        os.environ.get("VAL3_CHECK", root.parent / "shared/recipes/posts/val3_check.py")
    )
    environment = dict(os.environ)
    if not shutil.which("xmllint"):
        (tmp_path / "bin").mkdir()
        (tmp_path / "bin/xmllint").write_text(LXML_LINT.format(python=sys.executable))
        (tmp_path / "bin/xmllint").chmod(0o755)
        environment["PATH"] = f"{tmp_path / 'bin'}{os.pathsep}{environment['PATH']}"
        can_lint = (
            subprocess.run(
                [sys.executable, "-c", "import lxml.etree"], capture_output=True
            ).returncode
            == 0
        )
    else:
        can_lint = True

    def judge(files):
        projects = [file for file in files if file.endswith(".pjx")]
        assert not [
            fault for project in projects for fault in _find_application_faults(project, files)
        ]
        if not shared_check.exists() or not can_lint:
            return
        for file, content in files.items():
            (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / file).write_bytes(content)
        for project in projects:
            command = [sys.executable, str(shared_check), str(tmp_path / project), "--strict"]
            result = subprocess.run(command, capture_output=True, text=True, env=environment)
            assert result.returncode == 0, result.stdout + result.stderr

    return judge
