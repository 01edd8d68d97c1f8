# SPDX-License-Identifier: LGPL-2.1-or-later
"""A judge of FANUC listings that shares nothing with the post, and programs to judge."""

import os
import re
import subprocess
import sys
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
INSTRUCTIONS = [
    rf"J P\[\d+\] {SPEED} (?:FINE|CNT(?:\d\d?|100))    ;",
    rf"L P\[\d+\] (?:{SPEED}|\d{{1,4}}\.\dmm/sec) (?:FINE|CNT(?:\d\d?|100))    ;",
    r"  U(?:FRAME|TOOL)_NUM=\d+ ;",
    r"  DO\[\d+\]=(?:ON|OFF) ;",
    r"  WAIT(?=.{7}\() *\d*\.\d\d\(sec\) ;",
    r"  WAIT DI\[\d+\]=ON    ;",
    r"  CALL [A-Z][A-Z0-9_]{0,35}    ;",
    r"  ![ -:<-~]{1,32} ;",
]
VALUE = r"(?=.{10} )(?: *-?[1-9]\d*\.\d{3}| *-?\.(?!000)\d{3}| *0\.000)"
FRAMES = r"\tUF : (\d+), UT : (\d+),"
JOINTS = [FRAMES + r"\t"] + [
    ",".join(rf"\tJ{axis}={VALUE} deg" for axis in row) + end for row, end in (((1, 2, 3), ","), ((4, 5, 6), ""))
]
POSES = [
    FRAMES + r"\t\tCONFIG : '[NF] [UD] [TB], 0, 0, -?\d',",
    ",".join(rf"\t{axis} ={VALUE}  mm" for axis in "XYZ") + ",",
    ",".join(rf"\t{axis} ={VALUE} deg" for axis in "WPR"),
]


def _faults(file, content):
    """What is not as controllers write it; strict, and for the plain instructions of a path only."""
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
        if line[:5] != f"{number:4d}:" or not any(re.fullmatch(pattern, line[5:]) for pattern in INSTRUCTIONS):
            yield f"instruction {number}: {line!r}"
    used = [int(point) for point in re.findall(r"[JL] P\[(\d+)\]", "\n".join(body))]
    records = lines[positions + 1 : -1]
    if used != list(range(1, len(used) + 1)) or len(records) != 6 * len(used):
        yield "points and records"
    for number in range(len(records) // 6):
        start, group, *values, end = records[6 * number : 6 * number + 6]
        shape = JOINTS if "CONFIG" not in values[0] else POSES
        right = all(re.fullmatch(pattern, line) for pattern, line in zip(shape, values, strict=True))
        if (start, group, end) != (f"P[{number + 1}]{{", "   GP1:", "};") or not right:
            yield f"record {number + 1}: {values}"
        frames = re.match(FRAMES, values[0])
        if frames and [f"   1:  UFRAME_NUM={frames[1]} ;", f"   2:  UTOOL_NUM={frames[2]} ;"] != body[:2]:
            yield f"record {number + 1} is in another frame than the one selected"


@pytest.fixture
def assert_listings(tmp_path, root):
    """A function that fails when a file of a program is not as controllers write it."""
    other = Path(os.environ.get("FANUC_LS_CHECK", root.parent / "shared/recipes/posts/fanuc_ls_check.py"))

    def judge(files):
        assert not [f"{file}: {fault}" for file, content in files.items() for fault in _faults(file, content)]
        if other.exists():
            for file, content in files.items():
                (tmp_path / file).write_bytes(content)
            command = [sys.executable, str(other), "--style", *(str(tmp_path / file) for file in files)]
            result = subprocess.run(command, capture_output=True, text=True)
            assert result.returncode == 0, result.stdout

    return judge


def _random_program(seed, motion="joint", endless=True, **options):
    rng = np.random.default_rng(seed)
    endless = endless and motion == "joint"
    at = rng.uniform(-2.0, 2.0, 6)
    blocks = []

    def moves(kind, layer, bead, count):
        nonlocal at
        steps = rng.normal(0.0, 0.03, (count, 6))
        if endless:
            steps[:, 5] = rng.uniform(-3.1, 3.1, count)
        joints = at + np.cumsum(steps, axis=0)
        joints[:, :5][rng.random((count, 5)) < 0.1] *= 1e-5  # small values, of both signs
        if not endless:
            joints = np.clip(joints, -3.1, 3.1)
        at = joints[-1]
        duration = rng.choice([0.0011, 0.05, 0.3, 4.0, 31.9994, 40.0, 3000.0], count) * rng.uniform(1.0, 1.05, count)
        extra = {}
        if motion == "cartesian":
            normal = rng.normal(size=(count, 3, 3))
            turned = np.linalg.qr(normal)[0]
            turned *= np.linalg.det(turned)[:, None, None]
            words = [("front", ("up", "down")[int(down)], "flip") for down in rng.integers(0, 2, count)]
            extra = {
                "position": rng.uniform(-2000, 2000, (count, 3)),
                "rotation": turned,
                "configuration": tuple(words),
            }
        return Moves(kind, layer, bead, joints, duration, rng.uniform(0.5, 150.0, count), **extra)

    for layer in range(int(rng.integers(1, 5))):
        blocks.append(LayerStart(layer))
        for bead in range(int(rng.integers(1, 4))):
            blocks.append(moves("rapid", layer, bead, int(rng.integers(1, 4))))
            blocks.append(DepositOn(float(rng.choice([0.0, 0.004, 0.5]))))
            blocks.append(moves("deposit", layer, bead, int(rng.integers(1, 40))))
            blocks.append(DepositOff(float(rng.choice([0.0, 1.25]))))
        blocks += [Wait(float(rng.choice([0.0, 12.5, 700.0]))), WaitInput(3), Call("clean")][: int(rng.integers(0, 4))]
    blocks.append(moves("rapid", layer, bead, 1))
    setup = "tool-on-robot" if motion == "cartesian" else "part-on-robot"
    options = {"max_points": int(rng.integers(10, 120)), "blend": int(rng.integers(0, 101))} | options
    return Program(
        "Random",
        "a machine",
        tuple(blocks),
        (False,) * 5 + (endless,),
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
    """A function that makes a program of a seed, of all kinds of blocks."""
    return _random_program
