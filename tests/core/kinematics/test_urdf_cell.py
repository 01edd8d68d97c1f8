"""Robot, track and positioner recognised in the URDF of a whole cell."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.urdf.cell import UrdfCell, cell_values
from freecad_am.core.kinematics.urdf.reference import Reference, reference
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import EXTERNAL
from tests.core.kinematics.urdf_cells import FINGERS, add_prefix, fixed, link_poses, whole_cell

SEVENTH = """\
<link name="more"/><joint name="seventh" type="revolute"><parent link="robot_tool0"/><child link="more"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" velocity="1"/></joint>
"""


def write_urdf(tmp_path, text):
    path = tmp_path / "cell.urdf"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("track", [False, True])
@pytest.mark.parametrize("positioner", [False, True])
@pytest.mark.parametrize("more", ["", FINGERS])
@pytest.mark.always
def test_tool_part_and_base_are_where_the_tree_has_them(tmp_path, track, positioner, more):
    """Tool, part and base have the poses of the URDF tree."""
    text = whole_cell(track, positioner, more)
    machine, beside = cell_values(Reference(str(write_urdf(tmp_path, text))))
    assert (reference(machine).base, reference(machine).tip) == ("robot_base_link", "robot_tool0")
    named = EXTERNAL.read(beside)
    assert [mechanism.carries for mechanism in named] == ["robot"] * track + ["part"] * positioner
    cell = cells.resolve(
        CellParameters(machine=machine, setup="tool-on-robot", external=beside, platform=0.0),
        np.eye(4),
    )
    count = cell.machine.chain.axes
    assert count == 6 + track + 2 * positioner
    joints = np.random.default_rng(14).uniform(-1.0, 1.0, (20, count))
    names = [
        name
        for name in text.split('"')
        if name.startswith("robot_") and f'joint name="{name}" type="rev' in text
    ]
    names += ["track_E1"] * track + ["positioner_E1", "positioner_E2"] * positioner
    for row in joints:
        row[6 : 6 + track] *= 900.0
        values = {
            name: value * (0.001 if name.startswith("track") else 1.0)
            for name, value in zip(names, row, strict=True)
        }
        poses_of_links = link_poses(text, {"left": 0.0, "right": 0.0, **values})
        # seen from the start of the machine's chain: the face plate, or the world, i.e. the robot's
        # base with the track at zero
        still = link_poses(text, {"left": 0.0, "right": 0.0, **values, "track_E1": 0.0})
        start = poses_of_links["positioner_tool0"] if positioner else still["robot_base_link"]
        start = start @ cell.robot.base if track and not positioner else start
        expected = np.linalg.inv(start) @ poses_of_links["robot_tool0"]
        np.testing.assert_allclose(cell.machine.chain.forward(row[None])[0], expected, atol=1e-7)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (whole_cell(extra=SEVENTH), "the file has no robot: no chain has six revolute axes"),
        (
            whole_cell(
                extra=add_prefix(external.load("motoman-motopos-d500"), "second_")
                + fixed("world", "second_base_link")
            ),
            "the file has 2 chains .positioner_E1 - positioner_E2, second_E1 - second_E2",
        ),
        (
            whole_cell().replace(
                '<parent link="world"/><child link="positioner_base_link"/>',
                '<parent link="track_tool0"/><child link="positioner_base_link"/>',
            ),
            "'positioner_E2' is carried by 'track_E1', as the robot is",
        ),
        (
            whole_cell().replace(
                '<parent link="world"/><child link="track_base_link"/>',
                '<parent link="robot_tool0"/><child link="track_base_link"/>',
            ),
            "carries itself",
        ),
    ],
)
def test_what_cannot_be_told_apart_is_refused(tmp_path, text, words):
    with pytest.raises(InputError, match=words) as caught:
        UrdfCell(write_urdf(tmp_path, text))
    assert caught.value.code == "BAD_URDF"


def test_two_robots_are_named(tmp_path):
    text = whole_cell(track=False)
    second = add_prefix(external.load("kuka-kr8-r2100-2-arc-hw"), "other_") + fixed(
        "world", "other_base_link", "0 3 0"
    )
    with pytest.raises(
        InputError, match=r"the file has 2 robots, with the last axes other_.*, robot_"
    ):
        UrdfCell(write_urdf(tmp_path, text.replace("</robot>", second + "</robot>")))


def test_links_of_a_mechanism_are_not_named_as_well(tmp_path):
    path = write_urdf(tmp_path, whole_cell())
    with pytest.raises(InputError, match="remove base and tip"):
        cell_values(Reference(str(path), "robot_base_link"))
    with pytest.raises(InputError, match="does not exist"):
        cell_values(Reference(str(path) + "x.urdf"))


def test_a_mechanism_of_a_urdf_needs_no_cell_of_its_own(tmp_path):
    """A mechanism of a URDF can be loaded without the cell."""
    path = write_urdf(tmp_path, whole_cell(track=False))
    alone = external.load(f"{path} base=positioner_base_link tip=positioner_tool0")
    original = external.load("motoman-motopos-d500")
    q = np.random.default_rng(3).uniform(-2.0, 2.0, (50, 2))
    np.testing.assert_allclose(alone.chain.forward(q), original.chain.forward(q), atol=1e-9)
    np.testing.assert_allclose(
        alone.limits("maker").upper, original.limits("maker").upper, rtol=1e-12
    )
    np.testing.assert_allclose(alone.max_speed, original.max_speed, rtol=1e-12)
    with pytest.raises(InputError, match="no link 'face'"):
        external.load(f"{path} base=positioner_base_link tip=face")
    refused = dataclasses.replace(
        CellParameters(), machine=f"{path} base=positioner_base_link tip=positioner_tool0"
    )
    with pytest.raises(InputError, match="the machine has 2 axes, 0 prismatic") as caught:
        cells.resolve(refused, np.eye(4))
    assert caught.value.code == "NO_CLOSED_FORM"
