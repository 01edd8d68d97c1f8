# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines from and to URDF, DH tables and figures: every built-in machine both ways, random arms,
and errors."""

import dataclasses
import itertools

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.chain import Chain
from freecad_am.core.kinematics.inverse import opw_recognition, recognition
from freecad_am.core.kinematics.inverse.spherical_wrist import OpwArm
from freecad_am.core.kinematics.machines import denavit_hartenberg as dh
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.kinematics.urdf import read as urdf
from freecad_am.core.kinematics.urdf import text as urdf_text
from freecad_am.kdl import KdlArm
from tests.core.kinematics.arms import EXAMPLES

NAMES = EXAMPLES
ROBOTS = [name for name in NAMES if machine.load(name).opw is not None]
Q6 = np.random.default_rng(8).uniform(-3.0, 3.0, (20, 6))
LENGTHS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")


def joints(count, axes):
    return np.random.default_rng(7).uniform(-3.0, 3.0, (count, axes))


def read(tmp_path, text, base="", tip=""):
    path = tmp_path / "arm.urdf"
    path.write_text(text, encoding="utf-8")
    robot = urdf.Urdf(path)
    base = base or robot.bases()[0]
    return robot.between(base, tip or robot.tips(base)[0])


@pytest.mark.parametrize("name", NAMES)
def test_a_machine_as_urdf_is_the_same_machine(name, tmp_path):
    original = machine.load(name)
    restored = read(tmp_path, urdf_text.text(original))
    q = joints(40, len(original.axes))
    # KDL's chain comes from the machine file only
    np.testing.assert_allclose(
        restored.chain.forward(q), KdlArm(original).forward(q), atol=1e-9, rtol=0
    )
    limits, count = original.limits("maker"), len(original.axes)
    np.testing.assert_allclose(restored.lower, limits.lower[:count], rtol=1e-14)
    np.testing.assert_allclose(restored.upper, limits.upper[:count], rtol=1e-14)
    np.testing.assert_allclose(restored.max_speed, original.max_speed, rtol=1e-14)
    np.testing.assert_allclose(
        np.eye(4) if restored.base is None else restored.base, original.base, atol=1e-9
    )


@pytest.mark.parametrize("name,modified", list(itertools.product(NAMES, (False, True))))
def test_a_machine_as_table_is_the_same_machine(name, modified):
    original = machine.load(name)
    table = dh.table_of(original.chain, modified)
    q = joints(40, len(original.axes))
    np.testing.assert_allclose(
        dh.chain_of(table).forward(q), KdlArm(original).forward(q), atol=1e-9, rtol=0
    )
    # a table's own formula, written out
    pose = table.before
    for row, value in zip(table.rows, q[0]):
        theta, d = (row.theta, row.d + value) if row.sliding else (row.theta + value, row.d)
        ca, sa, ct, st = np.cos(row.alpha), np.sin(row.alpha), np.cos(theta), np.sin(theta)
        standard = [
            [ct, -st * ca, st * sa, row.a * ct],
            [st, ct * ca, -ct * sa, row.a * st],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
        craig = [
            [ct, -st, 0, row.a],
            [st * ca, ct * ca, -sa, -sa * d],
            [st * sa, ct * sa, ca, ca * d],
            [0, 0, 0, 1],
        ]
        pose = pose @ np.array(craig if modified else standard)
    np.testing.assert_allclose(
        pose @ table.after, KdlArm(original).forward(q[:1])[0], atol=1e-9, rtol=0
    )


def test_signs_of_a_table_turn_its_joints():
    table = dh.table_of(machine.load("staubli-tx60").chain)
    signs = (1, -1, -1, 1, -1, 1)
    rows = tuple(
        dh.Row(row.theta, row.d, row.a, row.alpha, sign) for row, sign in zip(table.rows, signs)
    )
    turned = dh.Table(rows, table.before, table.after)
    q = joints(20, 6)
    np.testing.assert_allclose(
        dh.chain_of(turned).forward(q), dh.chain_of(table).forward(q * signs), atol=1e-9
    )
    with pytest.raises(InputError, match=r"row 2: 3 is not a sign"):
        dh.chain_of(dh.Table((table.rows[0], dh.Row(0, 0, 0, 0, 3)), np.eye(4), np.eye(4)))


@pytest.mark.parametrize("name", ROBOTS)
def test_the_closed_form_of_a_chain_is_that_of_its_file(name):
    """The closed form recognised from a chain has the parameters of its file."""
    original = machine.load(name)
    for chain in (
        original.chain,
        dh.chain_of(dh.table_of(original.chain)),
        opw_recognition.chain_of(original.opw),
    ):
        parameters = opw_recognition.recognise(chain)
        assert parameters.signs == original.opw.signs and np.allclose(
            parameters.offsets, original.opw.offsets, atol=1e-12
        )
        for length in LENGTHS:
            assert getattr(parameters, length) == pytest.approx(
                getattr(original.opw, length), abs=1e-9
            )


def random_arm(rng, square):
    offsets = rng.integers(-1, 3, 6) * np.pi / 2 if square else rng.uniform(-3.1, 3.1, 6)
    to_flange = rng.uniform(-50, 200)
    if np.cos(offsets[4]) < 1e-9:  # a flange behind a wrist that is folded back points into it
        to_flange = abs(to_flange)
    return OpwArm(
        *rng.uniform(-300, 300, 3),
        *rng.uniform(100, 900, 3),
        to_flange,
        tuple(offsets.tolist()),
        tuple(rng.choice([-1, 1], 6).tolist()),
    )


@pytest.mark.parametrize("square", [True, False])
def test_random_arms_are_recognised(square):
    rng = np.random.default_rng(11)
    q = joints(30, 6)
    for _ in range(150):
        arm = random_arm(rng, square)
        chain = opw_recognition.chain_of(arm)
        np.testing.assert_allclose(chain.forward(q), arm.forward(q), atol=1e-9)
        recognised = opw_recognition.recognise(chain)
        np.testing.assert_allclose(recognised.forward(q), arm.forward(q), atol=1e-8)
        assert recognised.c2 > 0 and recognised.c3 > 0 and recognised.a1 >= 0


def turned_apart(angles_a, angles_b):
    return np.abs((angles_a - angles_b + np.pi) % (2 * np.pi) - np.pi)


@pytest.mark.parametrize("bend", [90.0, -90.0, 30.0, 180.0, 0.0])
def test_an_arm_whose_wrist_is_bent_at_zero_is_planned_as_any_other(bend):
    """An arm whose wrist is bent at zero has the same solutions and configurations."""
    straight_chain = machine.load("fanuc-arcmate120ic").chain
    chain = changed(straight_chain, 4, shift(about=1, deg=bend))
    arm = opw_recognition.recognise(chain)
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (2000, 6))
    poses = chain.forward(q)
    solutions = arm.inverse(poses)
    assert np.nanmax(np.abs(solutions)) <= np.pi
    reached = ~np.isnan(solutions[..., 0])
    assert np.abs(chain.forward(solutions) - poses)[reached].max() < 1e-8
    own_solutions = solutions[arm.branch_of(q), np.arange(len(q))]
    clear = (
        np.abs(np.sin(q[:, 4] + np.sign(straight_chain.directions[4, 1]) * np.radians(bend))) > 1e-3
    )
    assert clear.mean() > 0.9 and turned_apart(own_solutions, q)[clear].max() < 1e-7
    branches = np.broadcast_to(np.arange(8)[:, None], reached.shape)
    assert np.array_equal(arm.branch_of(solutions)[reached], branches[reached])
    # a pose has the same configuration as with the arm that is straight at zero
    straight = machine.load("fanuc-arcmate120ic").opw
    q5 = turned_apart(straight.inverse(poses)[..., 4], solutions[..., 4])[reached]
    np.testing.assert_allclose(q5, abs(np.radians(bend)), atol=1e-6)


def test_an_arm_that_stands_elsewhere_is_seen_from_its_first_axis():
    arm = machine.load("fanuc-arcmate120ic")
    turn = np.array([[0.0, 0, 1, 300], [1, 0, 0, -20], [0, 1, 0, 55], [0, 0, 0, 1]])
    origins = np.concatenate((turn @ arm.chain.origins[:1], arm.chain.origins[1:]))
    moved = Chain(origins, arm.chain.directions, arm.chain.flange)
    with pytest.raises(InputError, match="axis 1 is not the Z of the base frame"):
        opw_recognition.recognise(moved)
    rooted, old = opw_recognition.rooted(moved)
    q = joints(20, 6)
    np.testing.assert_allclose(rooted.forward(q), old @ moved.forward(q), atol=1e-9)
    assert opw_recognition.recognise(rooted).c2 == pytest.approx(790.0)


def changed(chain, index, step):
    origins = chain.origins.copy()
    origins[index] = origins[index] @ step
    return Chain(origins, chain.directions, chain.flange)


def shift(x=0.0, y=0.0, z=0.0, about=None, deg=0.0):
    from freecad_am.core.geometry import frames

    turn = np.eye(3) if about is None else frames.rotation_about(np.eye(3)[about], np.radians(deg))
    return frames.pose(turn, (x, y, z))


@pytest.mark.parametrize(
    "index,step,reason",
    [
        (4, {"z": 12.0}, r"axis 4 passes 12 mm off"),
        (5, {"y": 3.0}, r"axis 6 passes 3 mm off"),
        (1, {"about": 0, "deg": 2.0}, r"axes 1 and 2 are 88 deg apart"),
        (2, {"about": 2, "deg": 0.01}, r"axes 2 and 3 are not parallel, but 0.01 deg"),
        (
            3,
            {"about": 2, "deg": 90.0},
            r"the wrist is not spherical: axis 4 is parallel to axes 2 and 3",
        ),
        (3, {"about": 2, "deg": 40.0}, r"axes 3 and 4 are 50 deg apart, not 90 deg"),
    ],
)
def test_what_is_no_such_arm_is_refused_with_the_reason(index, step, reason):
    chain = machine.load("fanuc-arcmate120ic").chain
    with pytest.raises(InputError, match=reason) as caught:
        opw_recognition.recognise(changed(chain, index, shift(**step)))
    assert caught.value.code == "NO_CLOSED_FORM"


def test_flanges_and_counts_that_will_not_do():
    chain = machine.load("kuka-kr16-2").chain
    with pytest.raises(InputError, match="the Z of the flange is not parallel to axis 6"):
        opw_recognition.recognise(
            Chain(chain.origins, chain.directions, chain.flange @ shift(about=1, deg=90.0))
        )
    with pytest.raises(InputError, match="is not on axis 6"):
        opw_recognition.recognise(
            Chain(chain.origins, chain.directions, chain.flange @ shift(x=5.0))
        )
    with pytest.raises(InputError, match="the machine has 5 axes, 3 prismatic"):
        opw_recognition.recognise(machine.load("table-xyzac").chain)


def test_a_flange_that_points_into_the_wrist_is_told_as_that():
    chain = machine.load("fanuc-arcmate120ic").chain
    with pytest.raises(InputError, match="points into the wrist instead of outwards"):
        opw_recognition.recognise(
            Chain(chain.origins, chain.directions, chain.flange @ shift(about=0, deg=180.0))
        )


# ---- URDF

ARM = """<?xml version="1.0"?>
<robot name="two">
  <material name="orange"><color rgba="1 0.5 0 1"/></material>
  <link name="world"/>
  <link name="base_link"><visual><origin xyz="0 0 0.01" rpy="0 0 1.5708"/>
    <geometry><mesh filename="package://two_support/meshes/base.stl" scale="0.001 0.001 0.001"/></geometry>
    <material name="orange"/></visual></link>
  <link name="arm"><visual><geometry><mesh filename="package://two_support/meshes/arm.dae"/></geometry></visual></link>
  <link name="plate"/>
  <link name="hand"/>
  <link name="finger"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base_link"/><origin xyz="1 2 3"/></joint>
  <joint name="turn" type="revolute"><parent link="base_link"/><child link="arm"/>
    <origin xyz="0 0 0.5" rpy="1.5708 0 0"/><axis xyz="0 0 2"/>
    <limit lower="-2.967" upper="2.9671" velocity="3.4034" effort="0"/></joint>
  <joint name="bolted" type="fixed"><parent link="arm"/><child link="plate"/><origin xyz="0.1 0 0"/></joint>
  <joint name="spin" type="continuous"><parent link="plate"/><child link="hand"/><origin xyz=".2 0 0" rpy="0 1 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/>
    <limit lower="0" upper="0.04" velocity="0.1" effort="0"/><mimic joint="spin"/></joint>
</robot>
"""


def test_a_urdf_is_read_with_fixed_joints_units_rounded_angles_and_meshes(tmp_path):
    """A URDF with fixed joints, units, rounded angles and meshes is read."""
    folder = tmp_path / "two_support"
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    for name in ("base.stl", "arm.dae"):
        (folder / "meshes" / name).touch()
    described = read(folder / "urdf", ARM, "base_link", "hand")
    assert described.joints == ("turn", "spin") and described.name == "two"
    # 1.5708 is a right angle; both limits are 170 deg, one of them rounded down
    np.testing.assert_allclose(
        np.degrees([described.lower[0], described.upper[0], described.max_speed[0]]),
        [-170, 170, 195],
        atol=1e-12,
    )
    assert np.isinf([described.lower[1], described.upper[1], described.max_speed[1]]).all()
    tip_pose = described.chain.forward([np.radians(90.0), 0.0])
    np.testing.assert_allclose(tip_pose[:3, 3], [0, 0, 800], atol=1e-9)  # both links up
    np.testing.assert_allclose(described.chain.directions, [[0, 0, 1], [1, 0, 0]])
    shape = described.shapes[0]
    assert (
        shape.path == folder / "meshes" / "base.stl"
        and shape.scale == 1.0
        and shape.colour == (1.0, 0.5, 0.0)
    )
    np.testing.assert_allclose(
        shape.pose, [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 10], [0, 0, 0, 1]], atol=1e-12
    )
    assert described.shapes[1:] == (None, None) and any(
        "arm.dae cannot be drawn" in note for note in described.notes
    )


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        ("0.001 -0.001 0.001", "base.stl is mirrored or flat by its scale 0.001 -0.001 0.001"),
        ("-1 -1 -1", "base.stl is mirrored"),
        ("1 0 1", "base.stl is mirrored or flat"),
        ("0.001 0.001 0.002", "base.stl has unequal scales"),
    ],
)
def test_meshes_that_are_mirrored_or_stretched_are_told_and_not_drawn(tmp_path, scale, words):
    """Mirrored or stretched meshes are reported and not drawn."""
    folder = tmp_path / "two_support" / "meshes"
    folder.mkdir(parents=True)
    (folder / "base.stl").touch()
    described = read(
        folder, ARM.replace('scale="0.001 0.001 0.001"', f'scale="{scale}"'), "base_link", "hand"
    )
    assert described.shapes[0] is None
    assert any(
        note.startswith(f"line 6: {words}") and "base_link is drawn plain" in note
        for note in described.notes
    )


def test_links_to_choose_from(tmp_path):
    path = tmp_path / "two.urdf"
    path.write_text(ARM, encoding="utf-8")
    robot = urdf.Urdf(path)
    assert robot.bases()[:2] == ["base_link", "world"]
    assert robot.tips("base_link") == ["finger", "hand", "arm", "plate"]
    assert robot.tips("world")[0] == "finger"


def add_links(text, **poses):
    """The URDF of a machine with tool0 under other names: links fixed to the last one, each rotated
    by rpy."""
    text = text.replace("tool0", "plate")
    for link, (rpy, xyz) in poses.items():
        text = text.replace(
            "</robot>",
            f'''<link name="{link}"/><joint name="to_{link}" type="fixed"><parent link="plate"/>
<child link="{link}"/><origin xyz="{xyz}" rpy="{rpy}"/></joint></robot>''',
        )
    return text


Z_OUT, X_OUT, BACK = "0 0 0", "0 -1.5707963267948966 0", "3.141592653589793 0 0"


@pytest.mark.parametrize(
    "poses,tip",
    [
        # FANUC's links: X out of `flange`, Z out of fanuc_flange
        ({"flange": (X_OUT, "0 0 0"), "fanuc_flange": (Z_OUT, "0 0 0")}, "fanuc_flange"),
        (
            {"flange": (BACK, "0 0 0"), "fanuc_flange": (Z_OUT, "0 0 0")},
            "fanuc_flange",
        ),  # R-2000: Z into the wrist
        ({"tool0": (Z_OUT, "0 0 0"), "flange": (X_OUT, "0 0 0")}, "tool0"),
        ({"flange": (Z_OUT, "0 0 0"), "ee_link": (Z_OUT, "0 0 0.1")}, "flange"),
    ],
)
def test_the_tip_whose_z_points_out_along_the_last_axis_is_proposed(poses, tip, tmp_path):
    """The proposed tip is the link whose Z points out along the last axis."""
    original = machine.load("fanuc-arcmate120ic")
    path = tmp_path / "arm.urdf"
    path.write_text(add_links(urdf_text.text(original), **poses), encoding="utf-8")
    robot = urdf.Urdf(path)
    # "plate", where the machine file has its flange, and which comes first in the file, is as good by its Z
    assert robot.tips("base_link")[0] == tip
    np.testing.assert_allclose(
        robot.between("base_link", tip).chain.forward(Q6), original.chain.forward(Q6), atol=1e-9
    )


def test_an_x_that_points_out_is_turned_to_be_the_z_and_told(tmp_path):
    """An X that points out of the flange is turned into the Z, with a note."""
    original = machine.load("fanuc-arcmate120ic")
    (tmp_path / "arm.urdf").write_text(
        add_links(urdf_text.text(original), flange=(X_OUT, "0 0 0")), encoding="utf-8"
    )
    described = urdf.Urdf(tmp_path / "arm.urdf").between("base_link", "flange")
    np.testing.assert_allclose(described.chain.forward(Q6), original.chain.forward(Q6), atol=1e-9)
    assert any("X of flange points out of the flange" in note for note in described.notes)


def test_what_xacro_wrote_is_read_and_xacro_itself_refused(tmp_path):
    text = urdf_text.text(machine.load("kuka-kr16-2"))
    written = text.replace("<robot ", '<robot xmlns:xacro="http://ros.org/wiki/xacro" ')
    assert read(tmp_path, written).chain.axes == 6
    for line in ('<xacro:include filename="$(find x)/y.xacro"/>', '<xacro:kr16 prefix=""/>'):
        with pytest.raises(InputError, match="the file is xacro"):
            read(tmp_path, written.replace("</robot>", line + "</robot>"))


def test_a_urdf_is_a_machine_and_says_what_it_does_not_tell(tmp_path):
    """A URDF is loaded as a machine, and its missing information is stated."""
    original = machine.load("abb-irb2400-12-155")
    path = tmp_path / "arm.urdf"
    path.write_text(urdf_text.text(original), encoding="utf-8")
    for name in (str(path), f"{path} base=base_link tip=tool0"):
        loaded = machine.load(name)
        np.testing.assert_allclose(
            loaded.chain.forward(Q6), KdlArm(original).forward(Q6), atol=1e-9
        )
        np.testing.assert_allclose(loaded.base, original.base, atol=1e-9)
        np.testing.assert_allclose(
            loaded.limits("maker").lower, original.limits("maker").lower[:6], rtol=1e-14
        )
        assert loaded.axes == original.axes and loaded.posts == () and loaded.free
        assert "does not define the values shown by the controller" in loaded.controller_remark
    for name, words in (
        (f"{path} tip=hand", "arm.urdf has no link 'hand'; use one of base_link"),
        (f"{path} base=tool0", "moves relative to"),
        (f"{path} tip=link_5", "from base_link to link_5: .* the machine has 5 axes"),
        (tmp_path / "no.urdf", "does not exist"),
    ):
        with pytest.raises(InputError, match=words):
            machine.load(name)


@pytest.mark.parametrize(
    "old,new,line,words",
    [
        ('"0 0 2"', '"0 0 x"', 14, "'x', which is not a number"),
        ('"0 0 2"', '"0 0"', 14, "needs 3 numbers"),
        ('"0 0 2"', '"0 0 0"', 14, "has no direction"),
        ('type="revolute"', 'type="floating"', 13, "is floating"),
        (
            '<limit lower="-2.967" upper="2.9671" velocity="3.4034" effort="0"/>',
            "",
            13,
            "the joint 'turn' has no <limit>",
        ),
        ('lower="-2.967" upper="2.9671"', "", 15, "run from 0 to 0; give the lower limit first"),
        ('lower="-2.967" upper="2.9671"', 'lower="1" upper="-1"', 15, "give the lower limit first"),
        ('<child link="hand"/>', '<child link="arm"/>', 17, "already has a parent joint, 'turn'"),
        ('<child link="hand"/>', '<child link="fist"/>', 17, "the link 'fist' does not exist"),
        ('<child link="hand"/>', "", 17, "<joint> 'spin' has no <child>"),
        ('name="bolted" ', "", 16, "<joint> has no name"),
        (
            '<link name="hand"/>',
            '<link name="arm"/>',
            10,
            "a link 'arm' already exists, in line 8",
        ),
        (
            '</joint>\n  <joint name="bolted"',
            '\n  <joint name="bolted"',
            20,
            "the file is not XML: mismatched tag",
        ),
        (
            '<?xml version="1.0"?>',
            '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "c">]>',
            1,
            "entities such as 'b'",
        ),
    ],
)
def test_mistakes_in_a_urdf_are_told_with_their_line(tmp_path, old, new, line, words):
    assert old in ARM
    with pytest.raises(InputError) as caught:
        read(tmp_path, ARM.replace(old, new, 1), "base_link", "hand")
    assert caught.value.code == "BAD_URDF"
    assert caught.value.where == f"arm.urdf: line {line}" and words in caught.value.message


def test_chains_that_cannot_be_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"line 19: the joint 'grip' mimics another joint"):
        read(tmp_path, ARM, "base_link", "finger")
    with pytest.raises(InputError, match="'hand' does not carry 'arm'"):
        read(tmp_path, ARM, "hand", "arm")
    with pytest.raises(InputError, match="no joint moves 'plate'"):
        read(tmp_path, ARM, "arm", "plate")
    with pytest.raises(InputError, match="the file is xacro"):
        urdf.Urdf(tmp_path / "arm.xacro")
    with pytest.raises(InputError, match="cannot be read"):
        urdf.Urdf(tmp_path / "missing.urdf")
    loop = ARM.replace(
        '<parent link="base_link"/><child link="arm"/>', '<parent link="hand"/><child link="arm"/>'
    )
    with pytest.raises(InputError, match="carries itself"):
        read(tmp_path, loop, "arm", "hand")


@pytest.mark.parametrize("name", ["abb-irb2400-12-155", "ur-ur10e", "kuka-kr16-2"])
@pytest.mark.parametrize("off_deg", [1e-6, 4e-4, 0.01])
def test_a_table_with_angles_that_are_nearly_right_is_solved_as_it_is(name, off_deg):
    """A table with almost right angles is solved with its exact angles."""
    table = dh.table_of(machine.load(name).chain)
    rows = tuple(
        dataclasses.replace(row, alpha=row.alpha + np.radians(off_deg) * (1.0 + 0.1 * k))
        for k, row in enumerate(table.rows)
    )
    chain = dh.chain_of(dataclasses.replace(table, rows=rows))
    arm = recognition.arm_of(opw_recognition.rooted(chain)[0])
    q = np.random.default_rng(0).uniform(-2.5, 2.5, (100, 6))
    poses = arm.chain.forward(q)
    solutions = arm.inverse(poses)
    forward_poses = arm.chain.forward(np.nan_to_num(solutions))
    is_solution = np.isfinite(solutions[..., 0])
    assert np.abs(forward_poses - poses)[is_solution].max() < 1e-6
    off = np.abs((solutions - q + np.pi) % (2.0 * np.pi) - np.pi).max(axis=2)
    assert (np.nanmin(np.where(is_solution, off, np.inf), axis=0) < 1e-6).mean() > 0.95
