# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts too heavy for their carrier, or too far off-centre: masses and centres are computed
independently here."""

import dataclasses
import json
import math

import numpy as np
import pytest

from freecad_am.core.geometry import obstacles
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.external import remedies
from freecad_am.core.preflight.checks import payload_promises
from freecad_am.core.simulation import payload, timeline
from tests.core.planned_dome import planned_dome

DENSITY = 7.85  # g/cm3, the default of a job
SKEWED = {"origin": [2, -3, 70], "rpy": [1, 0, 40]}
JOINTS = [
    {
        "name": "tilt",
        "origin": [10, -20, 400],
        "rpy": [3, 0, 5],
        "axis": [0, 1, 0],
        "max_speed": 90,
    },
    {"name": "turn", "origin": [35, 12, 60], "rpy": [0, 8, 0], "axis": [0, 0, 1], "max_speed": 180},
]


def rotation_about(axis, degrees):
    x, y, z = axis
    cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], float), math.radians(degrees)
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def step(joint_data, axis=None, degrees=0.0):
    pose = np.eye(4)
    roll, pitch, yaw = joint_data["rpy"]
    pose[:3, :3] = (
        rotation_about((0, 0, 1), yaw)
        @ rotation_about((0, 1, 0), pitch)
        @ rotation_about((1, 0, 0), roll)
    )
    pose[:3, 3] = joint_data["origin"]
    if axis is not None:
        moved = np.eye(4)
        moved[:3, :3] = rotation_about(axis, degrees)
        pose = pose @ moved
    return pose


def face(turn):
    """The face plate of the positioner with axis 1 at zero."""
    return (
        step(JOINTS[0], JOINTS[0]["axis"]) @ step(JOINTS[1], JOINTS[1]["axis"], turn) @ step(SKEWED)
    )


@pytest.fixture
def positioner(tmp_path):
    """Write a positioner whose axes neither intersect nor are perpendicular, with a payload."""

    def write(**load):
        q = ((0.0, 0.0), (0.0, 90.0), (0.0, -170.0))
        poses = [
            {
                "q": pose_values,
                "origin": face(pose_values[1])[:3, 3].tolist(),
                "rotation": face(pose_values[1])[:3, :3].tolist(),
            }
            for pose_values in q
        ]
        path = tmp_path / "skew.json"
        path.write_text(
            json.dumps(
                {
                    "id": "skew",
                    "title": "Skew positioner",
                    "sources": ["made up"],
                    "joints": JOINTS,
                    "flange": SKEWED,
                    "controller": {
                        "matrix": [[1, 0], [0, 1]],
                        "offset": [0, 0],
                        "remark": "as it is",
                    },
                    "limits": {"maker": {"axes": [[-140, 140], [-400, 400]], "source": "made up"}},
                    "check_poses": poses,
                    "payload": {**load, "source": "made up"},
                }
            ),
            encoding="utf-8",
        )
        return path

    return write


def cell_with(path, toolpath, platform=(60.0, -20.0, 5.0, 0.0, 0.0, 30.0)):
    return cells.resolve(
        CellParameters(
            machine="kuka-kr8-r2100-2-arc-hw",
            setup="tool-on-robot",
            branch="auto",
            platform=(*platform[:3], *np.radians(platform[3:])),
            external=f"{path} at 1400 0 0 0 0 0 carries part",
        ),
        toolpath.frame,
    )


@pytest.fixture(scope="module")
def toolpath():
    return planned_dome(9.0, ProcessParameters()).toolpath


def segment_masses(toolpath, width):
    """Masses (n,) in kg of all segments as beads of the given width, and their centres (n, 3) in
    part coordinates."""
    masses, middles = [], []
    for _, _, bead in toolpath:
        steps = np.diff(bead.points, axis=0)
        masses += (
            1e-6 * DENSITY * width * toolpath.layer_height * np.linalg.norm(steps, axis=1)
        ).tolist()
        middles += (bead.points[:-1] + 0.5 * steps).tolist()
    return np.array(masses), np.array(middles)


def mount_points(toolpath, positions, platform):
    """Points in the frame of the face plate, for the part mounted on the platform."""
    x, y, z, *angles = platform
    mounted = np.eye(4)
    mounted[:3, :3] = (
        rotation_about((1, 0, 0), angles[0])
        @ rotation_about((0, 1, 0), angles[1])
        @ rotation_about((0, 0, 1), angles[2])
    )
    mounted[:3, 3] = x, y, z
    part_pose = mounted @ np.linalg.inv(toolpath.frame)
    return positions @ part_pose[:3, :3].T + part_pose[:3, 3]


def find_issues(toolpath, path, process=None, **options):
    process = process or ProcessParameters()
    return payload.issues(
        timeline.deposit_motion(toolpath), cell_with(path, toolpath, **options), toolpath, process
    )


def test_the_mass_counts_as_the_part_grows(toolpath, positioner):
    """The mass is checked as the part grows, so that the error names the bead that exceeds the
    payload."""
    masses, _ = segment_masses(toolpath, toolpath.bead_width or ProcessParameters().bead_width)
    part_mass = masses.sum()
    assert find_issues(toolpath, positioner(kg=1.001 * part_mass)) == []
    (issue,) = find_issues(toolpath, positioner(kg=0.6 * part_mass))
    assert issue.code == "PAYLOAD" and issue.level == "error"
    assert (
        "), the payload of" in issue.message
        and f"{part_mass:.4g} kg when finished" in issue.message
    )
    counts = np.cumsum([len(bead.points) - 1 for _, _, bead in toolpath])
    row = int(np.searchsorted(np.cumsum(masses), 0.6 * part_mass))
    layer, number, _ = list(toolpath)[int(np.searchsorted(counts, row, side="right"))]
    assert (issue.layer, issue.bead) == (layer, number)
    assert (
        find_issues(
            toolpath, positioner(kg=0.6 * part_mass), ProcessParameters(density=0.5 * DENSITY)
        )
        == []
    )


def test_what_it_grows_on_weighs_too(toolpath, positioner):
    """The substrate counts in the mass."""
    plate = obstacles.box((200.0, 100.0, 20.0), np.eye(4), "substrate")
    masses, _ = segment_masses(toolpath, toolpath.bead_width or ProcessParameters().bead_width)
    on_plate = dataclasses.replace(toolpath, surroundings=(plate,))
    total_mass = masses.sum() + 0.4e6 * 1e-6 * DENSITY
    assert find_issues(on_plate, positioner(kg=1.001 * total_mass)) == []
    (issue,) = find_issues(on_plate, positioner(kg=0.999 * total_mass))
    assert "including 3.14 kg of substrate" in issue.message
    # a plate without its top encloses no volume
    open_plate = dataclasses.replace(plate, triangles=plate.triangles[:-1])
    assert (
        find_issues(
            dataclasses.replace(toolpath, surroundings=(open_plate,)),
            positioner(kg=0.999 * total_mass),
        )
        == []
    )


@pytest.mark.parametrize("with_plate", [False, True])
def test_the_middle_of_the_part_may_be_so_far_from_the_last_axis(toolpath, positioner, with_plate):
    """Half the distance between the centre of mass now and with the table rotated by half a
    turn."""
    platform = (60.0, -20.0, 5.0, 0.0, 0.0, 30.0)
    masses, middles = segment_masses(
        toolpath, toolpath.bead_width or ProcessParameters().bead_width
    )
    if with_plate:
        plate_pose = np.eye(4)
        plate_pose[:3, 3] = 30.0, 10.0, -10.0
        toolpath = dataclasses.replace(
            toolpath, surroundings=(obstacles.box((60.0, 40.0, 20.0), plate_pose, "substrate"),)
        )
        masses, middles = (
            np.r_[0.048 * DENSITY, masses],
            np.concatenate([plate_pose[None, :3, 3], middles]),
        )
    positions = mount_points(toolpath, middles, platform)
    moments = []
    for turn in (0.0, 180.0):
        pose = face(turn)
        moments.append(
            np.cumsum(masses[:, None] * (positions @ pose[:3, :3].T + pose[:3, 3]), axis=0)
        )
    moment = 0.5 * np.linalg.norm(moments[0] - moments[1], axis=1)
    max_offset, total_mass = (moment / np.cumsum(masses)).max(), masses.sum()
    assert find_issues(toolpath, positioner(from_axis=1.0001 * max_offset)) == []
    (issue,) = find_issues(toolpath, positioner(from_axis=0.9999 * max_offset))
    assert (
        issue.code == "PAYLOAD"
        and "nearer to the axis" in issue.message
        and "Skew positioner" in issue.message
    )
    # half of the rated load may be twice as far off-centre
    rated = moment.max() / (2.0 * total_mass)
    assert find_issues(toolpath, positioner(kg=2.0 * total_mass, from_axis=1.0001 * rated)) == []
    assert (
        len(find_issues(toolpath, positioner(kg=2.0 * total_mass, from_axis=0.9999 * rated))) == 1
    )


def test_robots_that_hold_the_part_and_what_is_not_told(toolpath):
    """Robots that carry the part are checked; unknown payloads are not."""
    parameters = CellParameters(machine="kuka-kr10-r1100-2", limits="maker", branch="auto")
    cell = cells.resolve(parameters, toolpath.frame)
    heavy = ProcessParameters(
        density=DENSITY * 10.1 / segment_masses(toolpath, toolpath.bead_width or 0.0)[0].sum()
    )
    (issue,) = payload.issues(timeline.deposit_motion(toolpath), cell, toolpath, heavy)
    assert "), the payload of" in issue.message and "more than 10 kg" in issue.message
    tool = cells.resolve(dataclasses.replace(parameters, setup="tool-on-robot"), toolpath.frame)
    assert payload.issues(timeline.deposit_motion(toolpath), tool, toolpath, heavy) == []
    unknown = cells.resolve(
        dataclasses.replace(parameters, machine="fanuc-arcmate120ic"), toolpath.frame
    )
    assert payload.issues(timeline.deposit_motion(toolpath), unknown, toolpath, heavy) == []


@pytest.mark.parametrize("load", [{"kg": -1}, {"kg": "many"}, {"from_axis": 0}, {"grams": 3}])
def test_payloads_that_are_none(positioner, load):
    path = positioner(**load)
    with pytest.raises(InputError, match="payload"):
        machines.load(path)


def promised(toolpath, cell, process):
    motion = timeline.deposit_motion(toolpath)
    return payload_promises(
        motion, cell, toolpath, process, payload.issues(motion, cell, toolpath, process)
    )


def test_the_preflight_tells_what_it_weighs_and_what_carries_it(toolpath, positioner):
    """The preflight reports the mass and its carrier."""
    process = ProcessParameters()
    part_mass = segment_masses(toolpath, toolpath.bead_width or process.bead_width)[0].sum()
    for share, is_ok in ((1.001, True), (0.6, False)):
        (row,) = promised(toolpath, cell_with(positioner(kg=share * part_mass), toolpath), process)
        assert (
            row.ok is is_ok
            and row.worst == pytest.approx(part_mass, rel=1e-9)
            and row.bound == pytest.approx(share * part_mass)
        )
        assert (row.place is None) is is_ok and "Skew positioner" in row.how
    (untold,) = promised(toolpath, cell_with(positioner(from_axis=5e3), toolpath), process)
    assert untold.ok is None and untold.how.startswith(
        "not checked: the machine file of Skew positioner has no payload"
    )
    parameters = CellParameters(machine="kuka-kr10-r1100-2", limits="maker", branch="auto")
    cell = cells.resolve(parameters, toolpath.frame)
    assert [row.ok for row in promised(toolpath, cell, process)] == [True]
    tool_cell = cells.resolve(
        dataclasses.replace(parameters, setup="tool-on-robot"), toolpath.frame
    )
    assert promised(toolpath, tool_cell, process) == []


def test_positioners_offered_carry_the_part_and_are_of_the_robots_maker(
    toolpath, positioner, tmp_path
):
    """Two positioners of the user and the built-in one with known speeds, rated for 500 kg: by
    weight, by size, by manufacturer, then the built-in ones with less data."""
    dkp, kp2, irbp = "kuka-dkp-400", "kuka-kp2-hv500", "abb-irbp-a250"
    plain = json.loads(positioner(kg=900).read_text(encoding="utf-8"))
    (tmp_path / "skew.json").unlink()
    folder = tmp_path / "mine"
    folder.mkdir()
    table = {
        "source": "made up",
        "turn": [{"cylinder": [1200, 40], "origin": [0, 0, 0], "rpy": [0, 0, 0]}],
    }
    for name, title, kg, extra in (
        ("large", "ABB Large", 900, {"bodies": table}),
        ("small", "KUKA Small", 120, {}),
        ("robotless", "KUKA Wrong", 1, {}),
    ):
        description = {
            **plain,
            "id": name,
            "title": title,
            "payload": {"kg": kg, "source": "made up"},
            **extra,
        }
        (folder / f"{name}.json").write_text(json.dumps(description), encoding="utf-8")
    (folder / "broken.json").write_text("{", encoding="utf-8")
    abb, kuka = machines.load("abb-irb4600-40-255"), machines.load("kuka-kr10-r1100-2")

    def ids(robot, mass, radius=100.0):
        return [
            candidate.id for candidate in external.positioners(robot, mass, radius, (str(folder),))
        ]

    assert ids(kuka, 50.0) == ["small", "motoman-motopos-d500", "large", dkp, kp2, irbp]
    assert ids(abb, 50.0) == ["large", "small", "motoman-motopos-d500", irbp, dkp, kp2]
    assert ids(kuka, 300.0) == ["motoman-motopos-d500", "large", dkp, kp2] and ids(kuka, 700.0) == [
        "large"
    ]
    assert ids(kuka, 1000.0) == []
    # larger than the table of the D500, 502 mm
    assert ids(kuka, 300.0, 400.0) == ["large", dkp, kp2, "motoman-motopos-d500"]
    assert [candidate.id for candidate in external.tracks(kuka, (str(folder),))] == ["kuka-kl100-2"]


def test_weights_that_positioners_are_chosen_by_are_those_of_the_payload(toolpath):
    """The mass that selects positioners is the mass that the payload check uses."""
    plate = obstacles.box((200.0, 100.0, 20.0), np.eye(4), "substrate")
    total_mass = (
        segment_masses(toolpath, toolpath.bead_width or ProcessParameters().bead_width)[0].sum()
        + 0.4 * DENSITY
    )
    mass = remedies.weight(
        dataclasses.replace(toolpath, surroundings=(plate,)), ProcessParameters()
    )
    assert mass == pytest.approx(total_mass, rel=1e-9)
