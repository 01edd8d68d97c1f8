# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of positioner and track as bodies: their poses against PyKDL, their contacts against points
within their boxes."""

import dataclasses
import json
import re

import numpy as np
import PyKDL
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import box
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.external import MECHANISMS, load
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.kinematics.links.external_links import external_links, robot_cylinders
from freecad_am.core.kinematics.links.self_collision import NONE
from freecad_am.core.kinematics.machines import draft as machine_draft
from freecad_am.core.kinematics.urdf import machine as urdf_machine
from freecad_am.core.kinematics.urdf import read as urdf
from freecad_am.core.kinematics.urdf.cell import cell_values
from freecad_am.core.kinematics.urdf.reference import Reference
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.simulation.table_links import placing
from freecad_am.kdl import KdlArm
from tests.core.kinematics import urdf_cells

D500, TRACK = "motoman-motopos-d500", "kuka-kl100-2"
STANDS = (
    1150.0,
    120.0,
    -50.0,
    0.0,
    0.0,
    30.0,
)  # mm, deg: near, so that many random postures touch
RAIL = (0.0, -40.0, -356.0, 0.0, 0.0, 90.0)
STEP = 12.0  # mm between points within boxes


def cell_of(external, **options):
    return cells.resolve(
        CellParameters(
            **{
                "machine": "kuka-kr8-r2100-2-arc-hw",
                "setup": "tool-on-robot",
                "branch": "auto",
                "platform": 5.0,
                "platform_diameter": 0.0,
                "external": external,
                "nozzle": NozzleParameters(tool=(20.0, 0.0, 300.0, 0.0, 0.6, 0.0)),
                **options,
            }
        ),
        np.eye(4),
    )


def text(machine, pose, carries):
    return f"{machine} at {' '.join(map(str, pose))} carries {carries}"


BOTH = f"{text(D500, STANDS, 'part')}; {text(TRACK, RAIL, 'robot')}"


def kdl_frame(xyz, rpy=(0.0, 0.0, 0.0)):
    return PyKDL.Frame(PyKDL.Rotation.RPY(*np.radians(rpy)), PyKDL.Vector(*xyz))


def matrix(frame):
    transform = np.eye(4)
    transform[:3, :3] = [[frame.M[i, j] for j in range(3)] for i in range(3)]
    transform[:3, 3] = list(frame.p)
    return transform


def mechanism(name, pose, values):
    """Frames of a mechanism's links in the world, base first, by PyKDL from its file."""
    description = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))
    turned = (
        PyKDL.Rotation.RotX(np.radians(pose[3]))
        * PyKDL.Rotation.RotY(np.radians(pose[4]))
        * PyKDL.Rotation.RotZ(np.radians(pose[5]))
    )
    chain = PyKDL.Chain()
    for joint in description["joints"]:
        chain.addSegment(PyKDL.Segment(PyKDL.Joint(), kdl_frame(joint["origin"], joint["rpy"])))
        kind = PyKDL.Joint.TransAxis if joint.get("type") == "prismatic" else PyKDL.Joint.RotAxis
        chain.addSegment(
            PyKDL.Segment(
                PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), kind), PyKDL.Frame()
            )
        )
    solver, angles = PyKDL.ChainFkSolverPos_recursive(chain), PyKDL.JntArray(len(values))
    for index, value in enumerate(values):
        angles[index] = value
    link_frames = [turned_frame := PyKDL.Frame(turned, PyKDL.Vector(*pose[:3]))]
    for k in range(len(values)):
        frame = PyKDL.Frame()
        solver.JntToCart(angles, frame, 2 * k + 2)
        link_frames.append(turned_frame * frame)
    return [matrix(frame_of_link) for frame_of_link in link_frames]


def points_within(shape):
    """Points within a box or a cylinder of a file, in the frame of its link."""
    size = np.array(
        shape["box"] if "box" in shape else [shape["cylinder"][0]] * 2 + [shape["cylinder"][1]]
    )
    axes = [np.linspace(-0.5, 0.5, int(np.ceil(length / STEP)) + 1) * length for length in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    if "cylinder" in shape:
        grid = grid[np.hypot(grid[:, 0], grid[:, 1]) <= 0.5 * size[0]]
    pose = matrix(kdl_frame(shape["origin"], shape["rpy"]))
    return grid @ pose[:3, :3].T + pose[:3, 3]


def bodies_of(name):
    description = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))
    links = ("base", *(joint["name"] for joint in description["joints"]))
    return [
        np.concatenate([points_within(shape) for shape in description["bodies"][link]])
        for link in links
    ]


def anywhere(cell, count, seed):
    low, high = np.maximum(cell.limits.lower, -np.pi), np.minimum(cell.limits.upper, np.pi)
    sliding = cell.machine.chain.sliding
    low, high = (
        np.where(sliding, cell.limits.lower, low),
        np.where(sliding, cell.limits.upper, high),
    )
    return np.random.default_rng(seed).uniform(low, high, (count, len(low)))


def test_they_are_where_pykdl_has_them_seen_from_part_and_world():
    """Frames of external links agree with PyKDL in part and world coordinates."""
    cell = cell_of(BOTH)
    q = anywhere(cell, 40, 1)
    assert [
        external_link.name.rsplit(" ", 1)[1] for external_link in cell.shapes.external_links
    ] == [
        "base",
        "e1",
        "e2",
        "base",
        "e3",
    ]
    frames_in_part, world = cell.external_link_frames(q), cell.world(q)
    for k, row in enumerate(q):
        expected = [*mechanism(D500, STANDS, row[6:8]), *mechanism(TRACK, RAIL, row[8:])]
        to_world = np.linalg.inv(world[k])
        assert np.abs(to_world @ frames_in_part[k] - expected).max() < 1e-9
        # and the robot on the carriage, the platform on the face plate
        moved = expected[4] @ np.linalg.inv(mechanism(TRACK, RAIL, [0.0])[1])
        arm = (
            moved @ KdlArm(cell.robot).forward(row[None, :6])[0]
            if np.allclose(cell.robot.base, np.eye(4))
            else None
        )
        if arm is not None:
            assert np.abs(to_world @ cell.machine.chain.forward(row[None])[0] - arm).max() < 1e-6
        face = (expected[2] @ frames.pose(np.eye(3), [0, 0, 150.0]))[:3, 3]
        assert np.abs(to_world[:3, 3] - face).max() < 1e-6


def test_in_the_simulation_the_rail_stands_still_and_the_carriage_goes_under_the_robot():
    """In the simulation the rail is fixed and the carriage moves with the robot."""
    cell = cell_of(text(TRACK, RAIL, "robot"))
    q = anywhere(cell, 2, 3)
    q[:, :6] = q[0, :6]
    placed_at_start, placed_at_end = (placing(cell, row) for row in q)
    assert np.abs(placed_at_start.external_links[0] - placed_at_end.external_links[0]).max() < 1e-9
    assert np.abs(placed_at_start.part - placed_at_end.part).max() < 1e-9
    went = np.linalg.norm((placed_at_end.links[0] - placed_at_start.links[0])[:3, 3])
    assert went == pytest.approx(abs(q[1, 6] - q[0, 6])) and went > 100.0
    for placed_cell in (placed_at_start, placed_at_end):
        assert (
            np.abs(
                (np.linalg.inv(placed_cell.external_links[1]) @ placed_cell.links[0])[:3, 3]
                - [40.0, 0.0, 356.0]
            ).max()
            < 1e-6
        )


@pytest.mark.parametrize(
    "external", [text(D500, STANDS, "part"), BOTH], ids=["positioner", "with track"]
)
@pytest.mark.always("with track")
def test_what_is_not_told_to_touch_has_no_point_of_a_mechanism_in_it_and_what_is_told_is_near(
    external,
):
    """Unreported links contain no point of a mechanism, and reported ones are near."""
    cell = cell_of(external)
    rods = robot_cylinders(cell.robot.chain)
    arm = ArmContact(cell, rods)
    q = anywhere(cell, 1500, 2)
    contacts, beside = arm.touches(q), bodies_of(D500)
    reported = np.flatnonzero(
        contacts.any
        & np.isin(
            contacts.what,
            [
                arm.names.index(external_link.name)
                for external_link in cell.shapes.external_links[:3]
            ],
        )
    )
    assert len(reported) > 25 and (~contacts.any).sum() > 40
    links, frames_in_part = cell.links(q), cell.external_link_frames(q)

    def depth(k, link, body):
        """Depth (mm) of a body's points in the capsules of a link, negative outside."""
        to_link = np.linalg.inv(links[k, link]) @ frames_in_part[k, body]
        points = beside[body] @ to_link[:3, :3].T + to_link[:3, 3]
        best = -np.inf
        for rod in rods[link]:
            axis = (rod.end - rod.start) / rod.length
            offset = points - rod.start
            along = offset @ axis
            out = np.sqrt(np.maximum(np.einsum("ij,ij->i", offset, offset) - along * along, 0.0))
            best = max(
                best,
                float(np.minimum(np.minimum(along, rod.length - along), rod.radius - out).max()),
            )
        return best

    for k in np.flatnonzero(~contacts.any)[:60]:
        for link in range(0 if "track" in external else 1, 7):
            for body in range(3):
                assert depth(k, link, body) < 0.5, (k, link, body)
    checked = 0
    for k in reported[:120]:
        body = int(contacts.what[k]) - arm.names.index(cell.shapes.external_links[0].name)
        if contacts.link[k] <= 6:  # other tests cover nozzle and torch
            assert depth(k, int(contacts.link[k]), body) > -1.8 * STEP
            checked += 1
    assert checked > 15


def test_the_nozzle_is_looked_at_too():
    """About a posture whose tip is in the middle of a post: postures deep inside it, and far
    away."""
    posture = np.array([0.3, -0.6, 1.0, 0.2, 0.5, 0.1])
    middle, half = np.array([0.0, 290.0, 289.5]), 0.5 * np.array([300.0, 178.0, 429.0])

    def tip_of(cell, q):
        return (
            np.linalg.inv(cell.world(q)) @ (cell.machine.chain.forward(q) @ cell.poses.carried)
        )[:, :3, 3]

    anyhow = cell_of(text(D500, STANDS, "part"))
    post_position = tip_of(anyhow, np.append(posture, [0.0, 0.0])[None])[0] - middle
    cell = cell_of(text(D500, (*post_position, 0.0, 0.0, 0.0), "part"))
    q = np.concatenate(
        [posture + np.random.default_rng(5).uniform(-1.0, 1.0, (800, 6)) ** 3, np.zeros((800, 2))],
        axis=1,
    )
    contacts, tips = (
        ArmContact(cell, [[] for _ in range(7)]).touches(q),
        tip_of(cell, q) - post_position,
    )
    deep = (np.abs(tips - middle) < half - 5.0).all(axis=1)
    assert deep.sum() > 30 and (contacts.link[deep] == 8).all()
    names = ArmContact(cell, [[] for _ in range(7)]).names
    assert {cell.shapes.external_links[0].name} == {names[what] for what in contacts.what[deep]}
    is_far = np.linalg.norm(tips - [0.0, -90.0, 260.0], axis=1) > 900.0
    assert is_far.sum() > 10 and (contacts.link[is_far] == NONE).all()


def test_a_mechanism_against_an_obstacle_and_the_part_against_what_carries_it_not():
    """The table tilts into a neighbouring box; the table touches the box, and nothing else does."""
    cell = cell_of(text(D500, (1400.0, 0.0, 0.0, 0.0, 0.0, 0.0), "part"))
    lamp = box((40.0, 40.0, 40.0), frames.pose(np.eye(3), [1400.0 - 255.0, 0.0, 245.0]), "lamp")
    cell = dataclasses.replace(cell, shapes=dataclasses.replace(cell.shapes, obstacles=(lamp,)))
    arm = ArmContact(cell, [[] for _ in range(7)])
    q = np.zeros((3, 8))
    q[:, :6] = [0.0, -1.6, 1.2, 0.0, 0.3, 0.0]
    q[1, 6], q[2, 6] = np.radians(60.0), np.radians(15.0)
    contacts = arm.touches(q)
    # by the file e1 turns about -Y: positive values tilt the face towards -X, where the lamp is
    names = [None if link == NONE else arm.links[link] for link in contacts.link]
    assert names == [None, "Yaskawa MotoPos D500 e2", None]
    assert arm.names[contacts.what[1]] == "lamp"


def test_links_read_once_are_not_read_again():
    """Links that were read once are reused."""
    cell = cell_of(BOTH)
    moved = cell_of(text(D500, (900.0, 0.0, 0.0, 0.0, 0.0, 0.0), "part"))
    again = external_links(moved.external, known_links=cell.shapes.external_links)
    assert [
        link.body.vertices is known_link.body.vertices
        for link, known_link in zip(again, cell.shapes.external_links)
    ] == [True] * 3


URDF_BODIES = """\
<collision><origin xyz="0.1 0.2 0.3" rpy="0.3 0 0.4"/><geometry><box size="0.2 0.3 0.4"/></geometry></collision>
<collision><origin xyz="0 0 -0.05"/><geometry><cylinder radius="0.06" length="0.1"/></geometry></collision>
"""
PLATE = """\
<link name="plate"><collision><geometry><mesh filename="plate.stl" scale="0.001 0.001 0.001"/></geometry></collision></link>
"""
CORNERS = np.array([[0.0, 0.0, 0.0], [90.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 70.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def stl(path):
    """Write a tetrahedron as STL text."""
    facets = "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*corner) for corner in CORNERS[face])
        + "endloop\nendfacet\n"
        for face in FACES
    )
    path.write_text(f"solid plate\n{facets}endsolid plate\n", encoding="utf-8")


def test_collision_bodies_of_a_urdf_go_with_their_links(tmp_path):
    """Boxes, cylinders and a mesh, also of a link fixed to the table; the frames come from an
    independent traversal."""
    stl(tmp_path / "plate.stl")
    text_ = urdf_cells.whole_cell(track=True)
    for link in ("positioner_base_link", "positioner_link_1", "track_link_1"):
        text_ = text_.replace(f'<link name="{link}"/>', f'<link name="{link}">{URDF_BODIES}</link>')
    text_ = text_.replace(
        "</robot>",
        PLATE
        + urdf_cells.fixed("positioner_tool0", "plate", "0.01 0.02 0.03", "0 0 1")
        + "</robot>",
    )
    path = tmp_path / "bay.urdf"
    path.write_text(text_, encoding="utf-8")
    machine, external = cell_values(Reference(str(path)))
    cell = cells.resolve(
        CellParameters(machine=machine, setup="tool-on-robot", external=external, platform=0.0),
        np.eye(4),
    )
    cell = dataclasses.replace(
        cell, shapes=cells.CellShapes(external_links=external_links(cell.external, mesh_of))
    )
    axes = {external_link.name.rsplit(" ", 1)[1] for external_link in cell.shapes.external_links}
    assert axes == {"e1", "e2", "e3", "base"}
    values = {"track_E1": 0.4, "positioner_E1": 0.3, "positioner_E2": -0.7}
    order = [
        name
        for external_link in cell.external.mechanisms
        for name in (
            ["track_E1"] if external_link.carries == "robot" else ["positioner_E1", "positioner_E2"]
        )
    ]
    joints = np.array(
        [[0.0] * 6 + [values[name] * (1000.0 if name == "track_E1" else 1.0) for name in order]]
    )
    zero = dict.fromkeys(re.findall(r'joint name="(robot_[^"]+)" type="rev', text_), 0.0)
    link_poses = urdf_cells.link_poses(text_, {**zero, **values})
    still = urdf_cells.link_poses(text_, {**zero, **values, "track_E1": 0.0})
    to_world = np.linalg.inv(still["robot_base_link"] @ cell.robot.base)
    frames_in_world = np.linalg.inv(cell.world(joints))[0] @ cell.external_link_frames(joints)[0]
    for external_link, frame in zip(cell.shapes.external_links, frames_in_world):
        corners = external_link.body.vertices @ frame[:3, :3].T + frame[:3, 3]
        if external_link.axes_after == 0 and external_link.carries == "part":
            expected_pose = to_world @ link_poses["plate"]
            expected = CORNERS @ expected_pose[:3, :3].T + expected_pose[:3, 3]
        else:
            moved = {"track_E1": "track_link_1", "positioner_E1": "positioner_link_1"}
            link = (
                "positioner_base_link"
                if external_link.axis < 0
                else moved[order[external_link.axis]]
            )
            origin_pose = frames.from_rpy([100.0, 200.0, 300.0], [0.3, 0.0, 0.4])
            expected_pose = to_world @ link_poses[link] @ origin_pose
            sides = np.array(
                [[x, y, z] for x in (-100, 100) for y in (-150, 150) for z in (-200, 200)]
            )
            expected = sides @ expected_pose[:3, :3].T + expected_pose[:3, 3]
        gap = np.linalg.norm(corners[None] - expected[:, None], axis=2).min(axis=1)
        assert gap.max() < 1e-5, external_link.name


def test_a_machine_file_made_of_a_urdf_has_its_bodies(tmp_path):
    """The file restores box, cylinder and mesh of a table at their poses, and nothing else."""
    stl(tmp_path / "plate.stl")
    text_ = urdf_cells.whole_cell()
    for link in ("positioner_base_link", "positioner_link_2"):
        text_ = text_.replace(f'<link name="{link}"/>', f'<link name="{link}">{URDF_BODIES}</link>')
    text_ = text_.replace(
        "</robot>",
        PLATE
        + urdf_cells.fixed("positioner_tool0", "plate", "0.01 0.02 0.03", "0 0 1")
        + "</robot>",
    )
    (tmp_path / "bay.urdf").write_text(text_, encoding="utf-8")
    described = urdf_machine.external_chain(
        urdf.Urdf(tmp_path / "bay.urdf"), "positioner_base_link", "positioner_tool0"
    )
    q = np.radians([[0.0, 0.0], [20.0, -50.0], [-70.0, 130.0]])
    draft = dataclasses.replace(
        machine_draft.draft_of_description(described, "URDF bay.urdf"),
        id="mine",
        title="Mine",
        values=np.degrees(q),
        poses=described.chain.forward(q),
    )
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "mine.json").write_text(machine_draft.text(draft), encoding="utf-8")
    bodies = json.loads((folder / "mine.json").read_text(encoding="utf-8"))["bodies"]
    assert bodies["source"] == "URDF bay.urdf" and set(bodies) == {
        "source",
        "base",
        list(described.joints)[1],
    }
    base, tilt, table = load("mine", (str(folder),)).bodies
    assert (len(base), len(tilt), len(table)) == (2, 0, 3)
    shape_pose = frames.from_rpy([100.0, 200.0, 300.0], [0.3, 0.0, 0.4])
    sides = (
        np.array([[x, y, z] for x in (-100, 100) for y in (-150, 150) for z in (-200, 200)])
        @ shape_pose[:3, :3].T
        + shape_pose[:3, 3]
    )
    for brick, rod in (base, table[:2]):
        assert np.linalg.norm(brick.points[None] - sides[:, None], axis=2).min(axis=1).max() < 1e-6
        assert np.linalg.norm(brick.points[None] - sides[:, None], axis=2).min(axis=0).max() < 1e-6
        radius = np.hypot(*rod.points[:, :2].T)
        assert (
            radius.max() < 60.5
            and np.ptp(rod.points[:, 2]) == pytest.approx(100.0)
            and rod.points[:, 2].min() == -100.0
        )
        assert np.isclose(
            radius, 60.0 / np.cos(np.pi / 40)
        ).any()  # the polygon contains the cylinder
    zero = urdf_cells.link_poses(
        text_, dict.fromkeys(re.findall(r'joint name="([^"]+)" type="(?:rev|pris|con)', text_), 0.0)
    )
    plate_pose = np.linalg.inv(zero["positioner_link_2"]) @ zero["plate"]
    np.testing.assert_allclose(
        mesh_of(table[2])[0], CORNERS @ plate_pose[:3, :3].T + plate_pose[:3, 3], atol=1e-6
    )


def mesh_of(shape):
    """Stand-in for a file reader: the tetrahedron in the frame of the link."""
    assert shape.path.name == "plate.stl" and shape.scale == pytest.approx(1.0)
    return CORNERS @ shape.pose[:3, :3].T + shape.pose[:3, 3], FACES


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"source": "made up", "base": [{"box": [1, 2]}]}, "bodies.base.0..box"),
        ({"source": "made up", "base": [{"cylinder": [-1, 2]}]}, "larger than 0"),
        ({"source": "made up", "elbow": []}, "'elbow' is not known"),
        ({"base": []}, "'source' is missing"),
    ],
    ids=["two numbers", "negative", "unknown link", "no source"],
)
def test_what_a_file_says_wrongly_is_refused(tmp_path, changed, words):
    description = json.loads((MECHANISMS / f"{TRACK}.json").read_text(encoding="utf-8"))
    path = tmp_path / "rail.json"
    path.write_text(json.dumps({**description, "bodies": changed}), encoding="utf-8")
    with pytest.raises(InputError, match=words) as raised:
        cell_of(text(path, RAIL, "robot"))
    assert raised.value.code == "BAD_MACHINE"


LOOKED_AT = {  # unchecked pairs of each mechanism, by link
    "positioner": {
        "base": {"D500 base"},
        "part": {"D500 e1", "D500 e2"},
    },
    "track": {
        "base": {"KL base", "KL e1"},
        "1": {"KL e1"},
        "part": {"KL base"},
    },
    "both": {
        "base": {"KL base", "KL e3"},
        "1": {"KL e3"},
        "part": {"D500 e1", "D500 e2"},
        "KL base": {"D500 base"},
    },
}
CELLS = {
    "positioner": text(D500, STANDS, "part"),
    "track": text(TRACK, RAIL, "robot"),
    "both": BOTH,
}


def shortly(name):
    return name.replace("Yaskawa MotoPos ", "").replace("KUKA KL 100-2", "KL")


@pytest.mark.parametrize("external", CELLS)
def test_pairs_that_are_left_out_are_these_and_no_others(external):
    """The pairs of robot link and external link, or of external link and part, by name."""
    cell = cell_of(CELLS[external], platform_diameter=100.0)
    arm = ArmContact(cell, robot_cylinders(cell.robot.chain))
    names = [arm.links[number] for number in range(len(arm.links))]
    looked_at = {
        (shortly(names[number]).removeprefix("A"), shortly(what))
        for group, what in zip(arm.groups, arm.names)
        for number in group.links
        if arm.solids[number] or names[number] in ("part", "torch")
    }
    beside = [shortly(link.name) for link in cell.shapes.external_links]
    # a moving part is checked as a link, a fixed one as an obstacle: either counts
    looked_at |= {
        ("part", link) for link, second in looked_at if second == "platform" and link in beside
    }
    robot_links = [
        str(name).removeprefix("A")
        for name in names
        if shortly(name) not in beside and name not in ("torch",)
    ]
    tracks = [link for link in beside if link.startswith("KL")]
    all_pairs = {(link, second) for link in robot_links for second in beside} | {
        (link, second) for link in tracks for second in beside if not second.startswith("KL")
    }
    left_out = {}
    for link, second in all_pairs - looked_at:
        left_out.setdefault(link, set()).add(second)
    assert left_out == LOOKED_AT[external]


def box_file(folder, name, changed):
    """A mechanism file whose links consist of other boxes."""
    description = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))
    path = folder / f"{name}-of-boxes.json"
    path.write_text(
        json.dumps(
            {**description, "id": f"{name}-of-boxes", "bodies": {"source": "made up", **changed}}
        ),
        encoding="utf-8",
    )
    return path


def boxed(size, origin):
    return [{"box": list(size), "origin": list(origin), "rpy": [0, 0, 0]}]


def test_link_1_meets_a_post_of_the_rail_it_turns_past(tmp_path):
    """The post is next to the track: link 1 enters it at some carriage positions, and nothing else
    does."""
    post = boxed((60.0, 60.0, 900.0), (0.0, 200.0, 450.0))
    rail = box_file(tmp_path, TRACK, {"base": post})
    cell = cell_of(text(rail, RAIL, "robot"))
    rods = [[] if link != 1 else robot_cylinders(cell.robot.chain)[1] for link in range(7)]
    arm = ArmContact(cell, rods)
    q = np.zeros((501, 7))
    q[:, 6], q[:, 0] = (
        np.linspace(cell.limits.lower[6], cell.limits.upper[6], 501),
        np.linspace(-2.0, 2.0, 501),
    )
    contacts = arm.touches(q)
    points = points_within(post[0])
    deep = np.zeros(501)
    links, frames_in_part = cell.links(q), cell.external_link_frames(q)
    for k in range(501):
        to_link = np.linalg.inv(links[k, 1]) @ frames_in_part[k, 0]
        points_in_link = points @ to_link[:3, :3].T + to_link[:3, 3]
        for rod in rods[1]:
            axis = (rod.end - rod.start) / rod.length
            along = (points_in_link - rod.start) @ axis
            out = np.linalg.norm(points_in_link - rod.start - along[:, None] * axis, axis=1)
            deep[k] = max(
                deep[k],
                float(np.minimum(np.minimum(along, rod.length - along), rod.radius - out).max()),
            )
    assert (deep > 5.0).sum() > 10 and (deep == 0.0).sum() > 20
    assert (contacts.link[deep > 1.0] == 1).all()
    is_clear = (
        np.convolve(deep, np.ones(15), "same") == 0.0
    )  # no point in the capsule over a wide margin
    assert is_clear.sum() > 20 and not contacts.any[is_clear].any()


def test_the_base_meets_what_a_positioner_swings_at_it_and_a_carriage_runs_into_the_part(tmp_path):
    """The base touches the swung arm of a positioner, and a carriage runs into the part."""
    arm_of_table = boxed(
        (1400.0, 60.0, 60.0), (-700.0, 0.0, 0.0)
    )  # from the tilt axis towards the robot
    table = box_file(tmp_path, D500, {"joint_1": arm_of_table})
    cell = cell_of(text(table, (1300.0, 0.0, -250.0, 0.0, 0.0, 0.0), "part"))
    rods = robot_cylinders(cell.robot.chain)
    arm = ArmContact(cell, [rods[0], *[[] for _ in range(6)]])
    q = np.zeros((3, 8))
    q[:, 6] = np.radians(
        [0.0, 40.0, -60.0]
    )  # level it reaches the robot's foot, otherwise it is above it or below the floor
    names = [None if link == NONE else arm.links[link] for link in arm.touches(q).link]
    assert names == ["base", None, None]

    cell = cell_of(text(TRACK, RAIL, "robot"), deposition_point=(500.0, 900.0, 0.0, 0.0, 0.0, 0.0))
    wall = box((100.0, 100.0, 400.0), np.eye(4), "wall")
    world_in_part = cell.poses.mount @ np.linalg.inv(
        cell.poses.station
    )  # the world, with the track at zero, in part coordinates
    across = frames.pose(np.eye(3), [0.0, 700.0, -150.0])
    wall = dataclasses.replace(
        wall,
        vertices=wall.vertices @ (world_in_part @ across)[:3, :3].T
        + (world_in_part @ across)[:3, 3],
    )
    arm = ArmContact(cell, [[] for _ in range(7)], [wall])
    q = np.zeros((41, 7))
    q[:, 6] = np.linspace(-1000.0, 1000.0, 41)
    contacts = arm.touches(q)
    met = np.array([None if link == NONE else arm.links[link] for link in contacts.link])
    # RAIL turns the track's X along the world's Y; the carriage's box is 454 mm long and starts 227
    # mm before its middle
    inside = np.abs(q[:, 6] - 700.0) < 227.0
    assert set(met[inside]) == {"KUKA KL 100-2 e1"}
    assert (met[np.abs(q[:, 6] - 700.0) > 500.0] == None).all()  # noqa: E711 - elementwise
