# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drafts of machines: poses in the notation of controllers, errors in a machine, and the resulting
file."""

import dataclasses
import json

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.inverse import opw_recognition
from freecad_am.core.kinematics.machines import draft as machine_draft
from freecad_am.core.kinematics.machines import machine, pendant
from freecad_am.core.kinematics.machines.pendant import Shown
from freecad_am.core.kinematics.urdf import cell as urdf_cell
from freecad_am.core.kinematics.urdf import read as urdf
from freecad_am.core.kinematics.urdf import text as urdf_text
from freecad_am.core.kinematics.urdf.reference import reference
from freecad_am.kdl import KdlArm
from tests.core.kinematics import urdf_cells
from tests.core.kinematics.arms import EXAMPLES

FANUC = machine.load("fanuc-arcmate120ic")
TRUE = Shown((1,) * 6, (0.0,) * 6, pendant.HORIZONTAL)


def displayed_poses(arm=FANUC, count=4, seed=5, digits=2):
    """Values as the controller of a built-in machine shows them, and its flange poses, rounded as
    on a display."""
    values = np.random.default_rng(seed).uniform(-80, 80, (count, 6)).round(2)
    values[0] = np.degrees(arm.controller_offset)
    poses = KdlArm(arm).forward(arm.from_controller(np.radians(values)))
    poses[:, :3, 3] = poses[:, :3, 3].round(digits)
    return values, poses


# ---- poses as they are written


@pytest.mark.parametrize("convention", machine_draft.CONVENTIONS)
def test_poses_are_written_and_read_in_every_convention(convention):
    """Poses are written and read in every convention."""
    rng = np.random.default_rng(2)
    figures = np.column_stack((rng.uniform(-900, 900, (60, 3)), rng.uniform(-179, 179, (60, 3))))
    turned = machine_draft.rotation(machine_draft.FANUC, figures[:, 3:])
    turned[:6] = [
        np.diag(signs)
        for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1), (1, -1, -1))
    ]
    turned[6] = frames.about_y(np.pi / 2)  # where W and R, or A and C, coincide
    poses = frames.pose(turned, figures[:, :3])
    written = machine_draft.figures_of(convention, poses)
    base, tool = (
        frames.bryant((10.0, 20.0, 330.0, 0.1, 0.2, 0.3)),
        frames.bryant((1.0, 2.0, 3.0, -0.4, 0.5, 0.6)),
    )
    restored = machine_draft.flange_poses(convention, written, base, tool)
    np.testing.assert_allclose(restored @ tool, base @ poses, atol=1e-9)


@pytest.mark.parametrize(
    "convention,figures,turned",
    [
        (
            machine_draft.FANUC,
            (90, 0, 90),
            [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        ),  # W about X, then R about the outer Z
        (
            machine_draft.KUKA,
            (90, 0, 90),
            [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        ),  # A about Z, then C about its own X
        (
            machine_draft.STAUBLI,
            (90, 0, 90),
            [[0, -1, 0], [0, 0, -1], [1, 0, 0]],
        ),  # RX, then RZ about its own Z
        (machine_draft.ZYZ, (90, 90, 0), [[0, -1, 0], [0, 0, 1], [-1, 0, 0]]),
        (
            machine_draft.QUATERNION,
            (0, 0, 2, 0),
            [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],
        ),  # half a turn about Y
    ],
)
def test_conventions_are_those_of_the_makers(convention, figures, turned):
    np.testing.assert_allclose(
        machine_draft.rotation(convention, np.array(figures, float)), turned, atol=1e-12
    )


# ---- what is wrong


def test_a_machine_that_is_right_gives_its_poses_and_nothing_is_suspected():
    """A correct machine reproduces its poses and raises no suspicion."""
    values, poses = displayed_poses()
    plain = FANUC.from_controller(np.radians(values))
    np.testing.assert_allclose(pendant.serial(TRUE, FANUC.chain, values), plain, atol=1e-12)
    deviations = pendant.deviations(FANUC.chain, TRUE, values, poses)
    assert max(deviation.position for deviation in deviations) < 0.01 and pendant.fits(deviations)
    assert pendant.suspects(FANUC.chain, TRUE, values, poses) == []


@pytest.mark.parametrize("axis", range(6))
def test_a_wrong_sign_is_found(axis):
    values, poses = displayed_poses()
    wrong = dataclasses.replace(TRUE, signs=tuple(-1 if index == axis else 1 for index in range(6)))
    suspect = pendant.suspects(FANUC.chain, wrong, values, poses)[0]
    assert (suspect.kind, suspect.axes, suspect.shown) == (pendant.SIGN, (axis,), TRUE)


@pytest.mark.parametrize("axis,off", [(1, 90.0), (2, -90.0), (4, 12.34), (3, 180.0), (2, -3.5)])
def test_a_wrong_zero_is_found(axis, off):
    values, poses = displayed_poses()
    wrong = dataclasses.replace(
        TRUE, zeros=tuple(off if index == axis else 0.0 for index in range(6))
    )
    suspect = pendant.suspects(FANUC.chain, wrong, values, poses)[0]
    assert (suspect.kind, suspect.axes) == (pendant.ZERO, (axis,))
    assert np.isclose(np.mod(np.array(suspect.shown.zeros) + 1.0, 360.0), 1.0, atol=0.011).all()


def test_two_signs_and_the_coupling_are_found():
    values, poses = displayed_poses()
    suspect = pendant.suspects(
        FANUC.chain, Shown((1, 1, 1, -1, 1, -1), TRUE.zeros, TRUE.coupling), values, poses
    )[0]
    assert suspect.axes == (3, 5) and suspect.shown == TRUE
    suspect = pendant.suspects(
        FANUC.chain, dataclasses.replace(TRUE, coupling=pendant.NONE), values, poses
    )[0]
    assert suspect.kind == pendant.COUPLED and suspect.shown == TRUE


@pytest.mark.parametrize("kind", [pendant.BASE, pendant.FLANGE])
def test_another_base_or_flange_is_found_with_its_pose(kind):
    values, poses = displayed_poses(digits=6)
    moved = frames.bryant((30.0, -20.0, 525.0, 0.3, 0.0, -0.2))
    moved_poses = frames.inverse(moved) @ poses if kind == pendant.BASE else poses @ moved
    suspects = [
        suspect
        for suspect in pendant.suspects(FANUC.chain, TRUE, values, moved_poses)
        if suspect.kind == kind
    ]
    np.testing.assert_allclose(suspects[0].pose, moved, atol=1e-4)


def test_a_sign_is_found_in_an_unknown_base():
    values, poses = displayed_poses()
    moved = frames.bryant((0.0, 0.0, 525.0, 0.0, 0.0, 0.0))
    wrong = dataclasses.replace(TRUE, signs=(1, 1, 1, 1, -1, 1))
    suspect = pendant.suspects(FANUC.chain, wrong, values, frames.inverse(moved) @ poses)[0]
    assert (suspect.kind, suspect.axes, suspect.shown) == (pendant.SIGN, (4,), TRUE)
    np.testing.assert_allclose(suspect.pose, moved, atol=0.02)


def test_a_slip_in_one_figure_is_not_explained_away():
    values, poses = displayed_poses(count=6)
    poses[2, 0, 3] += 40.0
    assert pendant.suspects(FANUC.chain, TRUE, values, poses) == []


# ---- the file


def draft(tmp_path, name="fanuc-arcmate120ic", **changes):
    """The draft of a built-in machine as the wizard makes it from its URDF."""
    path = tmp_path / "arm.urdf"
    path.write_text(urdf_text.text(machine.load(name)), encoding="utf-8")
    description = machine_draft.draft_of_description(
        urdf.Urdf(path).between("base_link", "tool0"), "URDF arm.urdf"
    )
    values, poses = displayed_poses(machine.load(name))
    return dataclasses.replace(
        description, id="mine", title="Mine", values=values, poses=poses, shown=TRUE, **changes
    )


def test_a_draft_makes_a_machine_file_that_loads(tmp_path):
    made_of = draft(tmp_path, horizontal=(-185.0, 273.0), posts=("fanuc",), remarks=("hall 3",))
    (tmp_path / "mine.json").write_text(machine_draft.text(made_of), encoding="utf-8")
    machine_loaded = machine.load("mine", [tmp_path])
    q = np.random.default_rng(3).uniform(-3, 3, (30, 6))
    np.testing.assert_allclose(machine_loaded.chain.forward(q), KdlArm(FANUC).forward(q), atol=1e-9)
    np.testing.assert_allclose(machine_loaded.opw.forward(q), KdlArm(FANUC).forward(q), atol=1e-9)
    np.testing.assert_allclose(machine_loaded.to_controller(q), FANUC.to_controller(q), atol=1e-12)
    ours, theirs = machine_loaded.limits("maker"), FANUC.limits("maker")
    np.testing.assert_allclose(ours.lower, theirs.lower)
    np.testing.assert_allclose(ours.coefficients, theirs.coefficients)
    np.testing.assert_allclose(
        [ours.coupled_lower, ours.coupled_upper], [theirs.coupled_lower, theirs.coupled_upper]
    )
    np.testing.assert_allclose(machine_loaded.max_speed, FANUC.max_speed)
    assert (
        machine_loaded.posts == ("fanuc",)
        and machine_loaded.remarks == ("hall 3",)
        and machine_loaded.sources[0] == "URDF arm.urdf"
    )


@pytest.mark.parametrize("name", ["motoman-motopos-d500", "kuka-kl100-2"])
def test_what_stands_beside_a_robot_gets_a_file_too(tmp_path, name):
    """From the URDF of a whole cell: one prismatic and two revolute axes, with poses by PyKDL from
    the manufacturer's figures."""
    path = tmp_path / "cell.urdf"
    path.write_text(urdf_cells.whole_cell(), encoding="utf-8")
    prefix = "track" if name.startswith("kuka") else "positioner"
    base_link = next(
        base
        for mechanism in urdf_cell.UrdfCell(path).external()
        if (base := reference(mechanism.machine).base).startswith(prefix)
    )
    made_of = machine_draft.draft_of_description(
        urdf.Urdf(path).between(base_link, f"{prefix}_tool0"), "URDF cell.urdf"
    )
    original = external.load(name)
    count = original.chain.axes
    values = np.random.default_rng(8).uniform(-60.0, 60.0, (4, count))
    values[0] = 0.0
    poses = KdlArm(original).forward(values * original.unit_values)
    made_of = dataclasses.replace(made_of, id="mine", title="Mine", values=values, poses=poses)
    (tmp_path / "mine.json").write_text(machine_draft.text(made_of), encoding="utf-8")
    copy_loaded = external.load("mine", (str(tmp_path),))
    q = np.random.default_rng(3).uniform(-2, 2, (30, count))
    np.testing.assert_allclose(copy_loaded.chain.forward(q), KdlArm(original).forward(q), atol=1e-9)
    np.testing.assert_allclose(
        copy_loaded.limits("maker").upper, original.limits("maker").upper, rtol=1e-9
    )
    np.testing.assert_allclose(copy_loaded.max_speed, original.max_speed, rtol=1e-9)
    # the user's file takes precedence over the built-in one of the same name
    (tmp_path / f"{name}.json").write_text(
        machine_draft.text(dataclasses.replace(made_of, id=name)), encoding="utf-8"
    )
    assert (
        external.load(name, (str(tmp_path),)).title == "Mine"
        and external.load(name).title != "Mine"
    )


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_machine_can_be_copied(name, tmp_path):
    copy = machine_draft.draft_of_machine(name)
    (tmp_path / f"{copy.id}.json").write_text(machine_draft.text(copy), encoding="utf-8")
    copy_loaded, original = machine.load(copy.id, [tmp_path]), machine.load(name)
    q = np.random.default_rng(3).uniform(-3, 3, (20, len(copy_loaded.axes)))
    np.testing.assert_allclose(copy_loaded.chain.forward(q), original.chain.forward(q), atol=1e-9)
    np.testing.assert_allclose(copy_loaded.to_controller(q), original.to_controller(q), atol=1e-9)
    np.testing.assert_allclose(copy_loaded.base, original.base, atol=1e-12)
    np.testing.assert_allclose(
        copy_loaded.limits("maker").upper[:6], original.limits("maker").upper[:6]
    )
    assert copy_loaded.axes == original.axes and copy_loaded.posts == original.posts


@pytest.mark.parametrize(
    "change,words",
    [
        (lambda made_draft: {"values": None}, "at least 3 joint vectors"),
        (
            lambda made_draft: {"values": made_draft.values[:2], "poses": made_draft.poses[:2]},
            "at least 3 joint vectors",
        ),
        (
            lambda made_draft: {"values": made_draft.values[1:], "poses": made_draft.poses[1:]},
            "the pose at all zeros is missing|at least 3",
        ),
        (
            lambda made_draft: {"shown": Shown((1, 1, 1, -1, 1, 1), TRUE.zeros, TRUE.coupling)},
            "correct the geometry or the pose",
        ),
        (lambda made_draft: {"id": "my robot"}, "cannot be the name"),
        (lambda made_draft: {"title": ""}, "give manufacturer and model"),
    ],
)
def test_no_file_without_what_it_needs(tmp_path, change, words):
    made_draft = draft(tmp_path)
    with pytest.raises(InputError, match=words):
        machine_draft.text(dataclasses.replace(made_draft, **change(made_draft)))


def test_rounded_poses_say_so_and_rounding_has_an_end(tmp_path):
    content = json.loads(machine_draft.text(draft(tmp_path)))
    assert "within" not in content["check_poses"][0]  # nothing is rounded at zero
    assert content["check_poses"][1]["within"] == {"mm": 0.01, "deg": 0.001}
    path = tmp_path / "mine.json"

    def load_with(**changes):
        path.write_text(
            json.dumps(
                {
                    **content,
                    "check_poses": [
                        content["check_poses"][0],
                        {**content["check_poses"][1], **changes},
                        *content["check_poses"][2:],
                    ],
                }
            )
        )
        return machine.load("mine", [tmp_path])

    x, y, z = content["check_poses"][1]["origin"]
    assert load_with().id == "mine"
    with pytest.raises(InputError, match=r"check_poses\[1\].within.mm: 2 exceeds the rounding"):
        load_with(within={"mm": 2.0, "deg": 0.0})
    with pytest.raises(InputError, match=r"the key 'cm' is not known"):
        load_with(within={"cm": 0.1})
    with pytest.raises(InputError, match=r"check_poses\[1\].*deviates by"):
        load_with(origin=[x + 0.1, y, z])


def test_meshes_of_a_urdf_are_those_of_the_machine_file(tmp_path):
    (tmp_path / "base.stl").touch()
    text = urdf_text.text(FANUC).replace(
        '<link name="base_link"/>',
        """<link name="base_link"><visual>
        <origin xyz="0 0 0.1" rpy="0 0 1.5708"/><geometry><mesh filename="base.stl"/></geometry></visual></link>""",
    )
    path = tmp_path / "arm.urdf"
    path.write_text(text, encoding="utf-8")
    description = machine_draft.draft_of_description(
        urdf.Urdf(path).between("base_link", "tool0"), "URDF"
    )
    values, poses = displayed_poses()
    content = json.loads(
        machine_draft.text(
            dataclasses.replace(
                description, id="mine", title="Mine", values=values, poses=poses, shown=TRUE
            )
        )
    )
    assert content["shapes"] == {
        "base": {
            "file": str(tmp_path / "base.stl"),
            "origin": [0, 0, 100],
            "rpy": [0, 0, 90],
            "scale": 1000.0,
        }
    }


def test_figures_of_an_arm_give_a_draft_of_that_arm():
    description = machine_draft.draft_of_chain(opw_recognition.chain_of(FANUC.opw), "figures")
    arm = machine_draft.closed_form(description)
    assert (arm.a1, arm.a2, arm.c3, arm.signs) == (150.0, -250.0, 835.0, FANUC.opw.signs)
    assert np.array_equal(description.base, np.eye(4)) and np.isinf(description.upper).all()
