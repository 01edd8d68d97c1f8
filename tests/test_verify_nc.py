# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write programs on a cone for SINUMERIK and LinuxCNC, read them back and verify them; deviations
are caught."""

import dataclasses
import functools
import itertools
import math
import re

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import NcParameters, ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.posts import catalogue
from tests.programs import build

CHORD_ERROR = 0.02
MACHINES = ("table-xyzac", "table-xyzbc", "head-table-xyzbc")
WAYS = tuple(
    itertools.product(
        ("siemens", "linuxcnc"), (("joint", "time"), ("joint", "path"), ("cartesian", "time"))
    )
)
# (machine, output format); the machine file lists the controllers that drive tilting heads
CASES = [
    (name, output) for name in MACHINES for output in WAYS if output[0] in machines.load(name).posts
]


def turned_bead(distance, start):
    base = Developable(60.0, 200.0).offset(distance)
    theta, z = start + np.linspace(0.0, 1.2, 36), np.linspace(10.0, 70.0, 36)
    rho = base.radius * (1.0 - z / base.height)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    up = base.normals(points)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(points, up, up, 2.0 * math.pi * length / length[-1], np.full(36, 8.0), False)


@functools.cache
def plan(machine):
    parameters = CellParameters(
        machine=machine,
        setup="rotary-table",
        platform=(10.0, -4.0, 30.0, 0.0, 0.0, 0.4),
        mount="part",
    )
    cell = cells.resolve(parameters, np.eye(4), "developable")
    layers = tuple(Layer((turned_bead(3.0 * k, 0.9 * k),)) for k in range(3))
    path = plan_joints(
        Toolpath(layers, np.eye(4), 3.0, CHORD_ERROR, family="developable"), cell, JointParameters()
    )
    motion, issues = assemble(path, cell, ProcessParameters(travel_speed=8.0))
    assert path.feasible and not issues
    return cell, motion


def write_program(planned, output, max_points=2000):
    cell, motion = planned
    post, (kind, feed) = output
    parameters = ProgramParameters(
        post=post,
        motion=kind,
        max_points=max_points,
        nc=NcParameters(feed=feed),
        origin=(3.0, 2.0, 1.0, 0.0, 0.0, 0.2) if kind == "cartesian" else "auto",
    )
    process = ProcessParameters(travel_speed=8.0)
    program = build(motion, cell, process, parameters, "cone")
    return program, catalogue.load(post).write(program)


def codes(planned, program, files, format_):
    cell, motion = planned
    result = verification.verify(
        cell, motion, program, files, catalogue.load(format_[0]), CHORD_ERROR
    )
    return {issue.code for issue in result.issues}, result


@pytest.mark.parametrize(("machine", "way"), CASES)
@pytest.mark.parametrize("max_points", [2000, 60])
def test_programs_lead_where_they_should(machine, way, max_points):
    planned = plan(machine)
    program, files = write_program(planned, way, max_points)
    assert len(files) == (1 if max_points == 2000 else 4)
    issue_codes, result = codes(planned, program, files, way)
    assert issue_codes == set() and result.solvers == ("chain", "pykdl")
    assert 0.0 < result.at_points_mm <= result.bound_mm < 1e-3


def changed(text, line, word, step):
    """Return the text with one word of a line changed by `step` units of its last digit."""
    lines = text.split("\n")
    match = re.search(rf"(?<=\s)({word}=?(?:DC\()?)(-?\d+\.\d+)", lines[line])
    decimals = len(match[2].partition(".")[2])
    value = f"{float(match[2]) + step * 10.0**-decimals:.{decimals}f}"
    lines[line] = lines[line][: match.start()] + match[1] + value + lines[line][match.end() :]
    return "\n".join(lines)


@pytest.mark.parametrize(("machine", "way"), CASES)
def test_every_word_that_is_off_is_caught(machine, way):
    planned = plan(machine)
    program, files = write_program(planned, way)
    ((name, content),) = files.items()
    text = content.decode()
    beads = [
        n
        for n, line in enumerate(text.split("\n"))
        if " G1 " in f" {line}" and ("A3=" in line or "C" in line)
    ]
    rng = np.random.default_rng(7)
    for line in [beads[1], *rng.choice(beads[1:], 6).tolist(), beads[-1]]:
        words = re.findall(
            r"(?:^|\s)([ABC]3(?==)|[XYZABCF](?!3=))=?(?:DC\()?-?\d+\.\d", text.split("\n")[line]
        )
        assert set("XYZF") < set(words)
        for word in words:
            # a feed has seven digits, a direction three numbers of six digits
            step = {"F": 40, "A3": 40, "B3": 40, "C3": 40}.get(word, 3)
            if word in ("A3", "B3", "C3"):
                values = [
                    float(v) for v in re.findall(r"[ABC]3=(-?\d+\.\d+)", text.split("\n")[line])
                ]
                if abs(values["ABC".index(word[0])]) > 0.95:
                    continue  # a change along the direction does not turn it
            issue_codes, _ = codes(
                planned, program, {name: changed(text, line, word, step).encode()}, way
            )
            assert issue_codes & {
                "VERIFY_POINT",
                "VERIFY_JOINT",
                "VERIFY_TOOL",
                "VERIFY_TIME",
                "VERIFY_SPEED",
            }, (line, word)


@pytest.mark.parametrize(("machine", "way"), CASES)
def test_a_deposit_switched_elsewhere_is_caught(machine, way):
    planned = plan(machine)
    program, files = write_program(planned, way)
    ((name, content),) = files.items()
    text = content.decode()
    off = re.search(r"\nN\d+ H1=0" if way[0] == "siemens" else r"\nM65 P0", text)
    moved = text[: off.start()] + text[off.end() :]
    if way[1][0] == "cartesian":  # the deposit stays on while the kinematics changes
        with pytest.raises(InputError, match="while the deposit is on"):
            catalogue.load(way[0]).read({name: moved.encode()})
    else:
        assert "VERIFY_DEPOSIT" in codes(planned, program, {name: moved.encode()}, way)[0]


def test_another_turn_is_caught_by_counting_axes_and_is_none_to_endless_ones():
    planned = plan("table-xyzac")
    for post in ("siemens", "linuxcnc"):
        program, files = write_program(planned, (post, ("joint", "time")))
        ((name, content),) = files.items()
        lines = content.decode().split("\n")
        rows = [n for n, line in enumerate(lines) if " C" in line and "G1 " in line]
        assert ("C=DC(" in lines[rows[9]]) == (post == "siemens")
        for row in rows[9:]:
            if post == "linuxcnc":
                lines[row] = re.sub(
                    r"(?<= C)(-?\d+\.\d+)", lambda m: f"{float(m[0]) + 360.0:.5f}", lines[row]
                )
        issue_codes, _ = codes(planned, program, {name: "\n".join(lines).encode()}, (post, None))
        assert ("VERIFY_JOINT" in issue_codes) == (post == "linuxcnc")


def test_the_work_offset_is_taken_from_the_program():
    planned = plan("table-xyzbc")
    output = ("linuxcnc", ("cartesian", "time"))
    program, files = write_program(planned, output)
    elsewhere = dataclasses.replace(
        program, carried=(program.carried[0] + 0.01, *program.carried[1:])
    )
    assert "VERIFY_POINT" in codes(planned, elsewhere, files, output)[0]
