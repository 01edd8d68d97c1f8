# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wire feed in proportion to the travel speed, from beads to programs read back; tampering is
detected."""

import dataclasses
import math
import re

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import NcParameters, ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.program import DepositOff, DepositOn, Moves, Program
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.posts import catalogue
from freecad_am.posts.fanuc import post as fanuc
from freecad_am.posts.staubli import post as staubli
from freecad_am.verify import verify
from tests.programs import build

SHARE = 14.8  # mm of wire per mm of bead


def bead(n=150, share=SHARE):
    """One and a half turns around a cylinder, rising, with varying speeds."""
    base = Developable(60.0)
    theta, z = np.linspace(0.0, 3.0 * math.pi, n), np.linspace(10.0, 40.0, n)
    points = np.stack([60.0 * np.cos(theta), 60.0 * np.sin(theta), z], axis=1)
    normal = base.normals(points)
    speed = 9.0 + 2.0 * np.sin(np.arange(n) / 7.0)
    columns = {"width": 9.0 + 0.1 * np.cos(theta), "height": 2.5 + 0.1 * np.sin(theta)}
    return Bead(points, normal, normal, theta, speed, False, wire_share=share, **columns)


def planned(*beads):
    parameters = CellParameters(machine="table-xyzac", setup="rotary-table", mount="part")
    cell = cells.resolve(parameters, np.eye(4), "developable")
    path = plan_joints(
        Toolpath((Layer(tuple(beads)),), np.eye(4), 3.0, 0.05, family="developable"),
        cell,
        JointParameters(),
    )
    assert path.feasible, path.issues
    return cell, assemble(path, cell, ProcessParameters())[0]


def program(cell, run, post="linuxcnc", **options):
    nc = NcParameters(wire_output=2, wire_gain=400.0)
    return build(
        run, cell, ProcessParameters(), ProgramParameters(post=post, nc=nc, **options), "wire"
    )


def test_columns_of_a_bead_go_with_its_points():
    open_bead = bead()
    back = open_bead.reversed()
    assert (
        back.wire_share == SHARE
        and (back.height == open_bead.height[::-1]).all()
        and (back.width == open_bead.width[::-1]).all()
    )
    finer = open_bead.halved(np.array([3, 50]))
    np.testing.assert_allclose(
        finer.height[[4, 52]], [open_bead.height[3:5].mean(), open_bead.height[50:52].mean()]
    )
    np.testing.assert_array_equal(np.delete(finer.height, [4, 52]), open_bead.height)
    ring = np.linspace(0.0, 2.0 * math.pi, 41)
    points = np.stack([np.cos(ring), np.sin(ring), 0.0 * ring], axis=1)
    points[-1] = points[0]
    up = np.tile([0.0, 0.0, 1.0], (41, 1))
    height = 2.0 + np.r_[np.arange(40.0), 0.0]
    closed = Bead(points, up, up, ring, np.full(41, 5.0), True, height=height, wire_share=3.0)
    np.testing.assert_array_equal(
        closed.started_at(10).height, 2.0 + np.r_[np.arange(10.0, 40.0), np.arange(11.0)]
    )
    longer = closed.run_on(1.0)
    assert (
        len(longer.height) == len(longer) > 41 and longer.wire_share == 3.0 and longer.width is None
    )
    np.testing.assert_allclose(longer.height[41:46], height[1:6])
    with pytest.raises(ValueError, match="height"):
        dataclasses.replace(closed, height=height[1:])


@pytest.mark.parametrize("post", ["siemens", "linuxcnc"])
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_a_program_with_a_wire_is_read_back_and_what_is_changed_is_found(post, motion):
    cell, run = planned(bead())
    np.testing.assert_array_equal(np.isfinite(run.wire), run.deposit)
    np.testing.assert_allclose(run.wire[run.deposit], SHARE * run.speed[run.deposit])
    program_ = program(cell, run, post, motion=motion)
    files = catalogue.load(post).write(program_)
    assert not verify(cell, run, program_, files, catalogue.load(post), 0.05).issues
    ((name, content),) = files.items()
    values = list(re.finditer(r"(?:A_OUTA\[2\]=|M67 E1 Q)(\d+\.\d+)", content.decode()))
    assert len(values) > 100
    for tamper in (
        values[0],
        values[57],
        values[-1],
    ):  # one digit of one value, or the value omitted
        digit = content[tamper.end(1) - 1 : tamper.end(1)]
        tampered = (
            content[: tamper.end(1) - 1]
            + (b"4" if digit != b"4" else b"7")
            + content[tamper.end(1) :]
        )
        line_start, line_end = (
            content.rfind(b"\n", 0, tamper.start()) + 1,
            content.find(b"\n", tamper.start()) + 1,
        )
        for text in (tampered, content[:line_start] + content[line_end:]):
            issues = verify(cell, run, program_, {name: text}, catalogue.load(post), 0.05).issues
            assert {issue.code for issue in issues} == {"VERIFY_WIRE"}


@pytest.mark.parametrize("post", ["siemens", "linuxcnc"])
def test_a_text_that_would_stop_within_a_bead_is_not_read(post):
    cell, run = planned(bead())
    ((name, content),) = catalogue.load(post).write(program(cell, run, post)).items()
    within, stops = (
        (b" DO $A_OUTA[2]", b" $A_OUTA[2]") if post == "siemens" else (b"M67 E1", b"M68 E1")
    )
    second = content.replace(within, within.replace(b"2]", b"3]").replace(b"E1", b"E2"), 1)
    for text in (content.replace(within, stops, 1), second):
        assert text != content
        with pytest.raises(InputError) as caught:
            catalogue.load(post).read({name: text})
        assert caught.value.code == "UNREADABLE_PROGRAM"


def test_only_what_varies_is_told():
    """Only a varying wire feed is written."""
    cell, run = planned(bead(share=None))
    program_ = program(cell, run)
    assert all(
        block.wire is None for block in program_.blocks if isinstance(block, (Moves, DepositOn))
    )
    assert np.isnan(run.wire).all() and "Wire in proportion" not in " ".join(program_.remarks)
    cell, run = planned(bead(share=None), bead())
    has_wire = [
        block.wire is not None
        for block in program(cell, run).blocks
        if isinstance(block, DepositOn)
    ]
    assert has_wire == [False, True]
    dry = program(cell, run, dry_run=True)
    assert all(block.wire is None for block in dry.blocks if isinstance(block, (Moves, DepositOn)))
    files = catalogue.load("linuxcnc").write(dry)
    assert not verify(cell, run, dry, files, catalogue.load("linuxcnc"), 0.05).issues


@pytest.mark.parametrize("post", [fanuc, staubli])
def test_robots_refuse_it_with_the_reason(post):
    moves = Moves(
        "deposit",
        0,
        0,
        np.zeros((3, 6)) + np.arange(3.0)[:, None] * 0.01,
        np.ones(3),
        np.full(3, 6.0),
    )
    limits = {"max_speed": (2.0,) * 6, "station": (0.0,) * 6, "carried": (0.0,) * 6}
    plain = Program("part", "a robot", (DepositOn(), moves, DepositOff()), (False,) * 6, **limits)
    assert post.write(plain)
    blocks = (DepositOn(), dataclasses.replace(moves, wire=np.full(3, 100.0)), DepositOff())
    with pytest.raises(InputError) as caught:
        post.write(dataclasses.replace(plain, blocks=blocks))
    assert (caught.value.code, caught.value.where) == ("NO_WIRE_OUTPUT", "process.wire.feed_mode")
    assert caught.value.message.startswith(post.NO_WIRE) and "constant" in caught.value.message


def test_remarks_tell_the_speeds_that_are_in_the_program():
    cell, run = planned(bead())
    speed = run.speed[run.deposit & (run.point > 0)]
    remarks = program(cell, run).remarks
    assert f"Travel speed {speed.min():.4g} to {speed.max():.4g} mm/s" in remarks
    assert (
        f"Wire in proportion to it {SHARE * speed.min():.4g} to {SHARE * speed.max():.4g} mm/s"
        in remarks
    )
    cell, run = planned(dataclasses.replace(bead(share=None), speed=np.full(150, 6.0)))
    assert "Travel speed 6 mm/s" in program(cell, run).remarks
