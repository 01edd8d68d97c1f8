# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts too heavy, or too far from the middle, for what carries them: masses and places worked out here."""

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

DENSITY = 7.85  # g/cm3, where a job says nothing
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


def turned(axis, degrees):
    x, y, z = axis
    cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], float), math.radians(degrees)
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def step(told, axis=None, degrees=0.0):
    found = np.eye(4)
    roll, pitch, yaw = told["rpy"]
    found[:3, :3] = turned((0, 0, 1), yaw) @ turned((0, 1, 0), pitch) @ turned((1, 0, 0), roll)
    found[:3, 3] = told["origin"]
    if axis is not None:
        moved = np.eye(4)
        moved[:3, :3] = turned(axis, degrees)
        found = found @ moved
    return found


def face(turn):
    """The face of the positioner with axis 1 at zero."""
    return (
        step(JOINTS[0], JOINTS[0]["axis"]) @ step(JOINTS[1], JOINTS[1]["axis"], turn) @ step(SKEWED)
    )


@pytest.fixture
def positioner(tmp_path):
    """Writes a positioner whose axes neither meet nor are square, with a payload."""

    def write(**load):
        q = ((0.0, 0.0), (0.0, 90.0), (0.0, -170.0))
        poses = [
            {
                "q": one,
                "origin": face(one[1])[:3, 3].tolist(),
                "rotation": face(one[1])[:3, :3].tolist(),
            }
            for one in q
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


def grown(toolpath, width):
    """Masses (n,) kg of all segments as beads of that width, and their middles (n, 3) in part coordinates."""
    masses, middles = [], []
    for _, _, bead in toolpath:
        steps = np.diff(bead.points, axis=0)
        masses += (
            1e-6 * DENSITY * width * toolpath.layer_height * np.linalg.norm(steps, axis=1)
        ).tolist()
        middles += (bead.points[:-1] + 0.5 * steps).tolist()
    return np.array(masses), np.array(middles)


def on_face(toolpath, places, platform):
    """As the part stands: its own frame on the platform."""
    x, y, z, *angles = platform
    mounted = np.eye(4)
    mounted[:3, :3] = (
        turned((1, 0, 0), angles[0]) @ turned((0, 1, 0), angles[1]) @ turned((0, 0, 1), angles[2])
    )
    mounted[:3, 3] = x, y, z
    seen = mounted @ np.linalg.inv(toolpath.frame)
    return places @ seen[:3, :3].T + seen[:3, 3]


def found(toolpath, path, process=None, **more):
    process = process or ProcessParameters()
    return payload.issues(
        timeline.deposit_motion(toolpath), cell_with(path, toolpath, **more), toolpath, process
    )


def test_the_mass_counts_as_the_part_grows(toolpath, positioner):
    masses, _ = grown(toolpath, toolpath.bead_width or ProcessParameters().bead_width)
    whole = masses.sum()
    assert found(toolpath, positioner(kg=1.001 * whole)) == []
    (issue,) = found(toolpath, positioner(kg=0.6 * whole))
    assert issue.code == "PAYLOAD" and issue.level == "error"
    assert (
        "above the payload of" in issue.message and f"{whole:.4g} kg when finished" in issue.message
    )
    counts = np.cumsum([len(bead.points) - 1 for _, _, bead in toolpath])
    row = int(np.searchsorted(np.cumsum(masses), 0.6 * whole))
    layer, number, _ = list(toolpath)[int(np.searchsorted(counts, row, side="right"))]
    assert (issue.layer, issue.bead) == (layer, number)
    assert (
        found(toolpath, positioner(kg=0.6 * whole), ProcessParameters(density=0.5 * DENSITY)) == []
    )


def test_what_it_grows_on_weighs_too(toolpath, positioner):
    plate = obstacles.box((200.0, 100.0, 20.0), np.eye(4), "substrate")
    masses, _ = grown(toolpath, toolpath.bead_width or ProcessParameters().bead_width)
    on_plate = dataclasses.replace(toolpath, surroundings=(plate,))
    whole = masses.sum() + 0.4e6 * 1e-6 * DENSITY
    assert found(on_plate, positioner(kg=1.001 * whole)) == []
    (issue,) = found(on_plate, positioner(kg=0.999 * whole))
    assert "including 3.14 kg of substrate" in issue.message
    # a plate without its top encloses nothing
    open_plate = dataclasses.replace(plate, triangles=plate.triangles[:-1])
    assert (
        found(
            dataclasses.replace(toolpath, surroundings=(open_plate,)), positioner(kg=0.999 * whole)
        )
        == []
    )


@pytest.mark.parametrize("with_plate", [False, True])
def test_the_middle_of_the_part_may_be_so_far_from_the_last_axis(toolpath, positioner, with_plate):
    """Half of the way between where the middle of the part is now, and with the table turned half round."""
    platform = (60.0, -20.0, 5.0, 0.0, 0.0, 30.0)
    masses, middles = grown(toolpath, toolpath.bead_width or ProcessParameters().bead_width)
    if with_plate:
        at = np.eye(4)
        at[:3, 3] = 30.0, 10.0, -10.0
        toolpath = dataclasses.replace(
            toolpath, surroundings=(obstacles.box((60.0, 40.0, 20.0), at, "substrate"),)
        )
        masses, middles = np.r_[0.048 * DENSITY, masses], np.concatenate([at[None, :3, 3], middles])
    places = on_face(toolpath, middles, platform)
    ways = []
    for turn in (0.0, 180.0):
        pose = face(turn)
        ways.append(np.cumsum(masses[:, None] * (places @ pose[:3, :3].T + pose[:3, 3]), axis=0))
    moment = 0.5 * np.linalg.norm(ways[0] - ways[1], axis=1)
    far, whole = (moment / np.cumsum(masses)).max(), masses.sum()
    assert found(toolpath, positioner(from_axis=1.0001 * far)) == []
    (issue,) = found(toolpath, positioner(from_axis=0.9999 * far))
    assert (
        issue.code == "PAYLOAD"
        and "nearer to the axis" in issue.message
        and "Skew positioner" in issue.message
    )
    # what weighs half of the load may be twice as far out
    rated = moment.max() / (2.0 * whole)
    assert found(toolpath, positioner(kg=2.0 * whole, from_axis=1.0001 * rated)) == []
    assert len(found(toolpath, positioner(kg=2.0 * whole, from_axis=0.9999 * rated))) == 1


def test_robots_that_hold_the_part_and_what_is_not_told(toolpath):
    parameters = CellParameters(machine="kuka-kr10-r1100-2", limits="maker", branch="auto")
    held = cells.resolve(parameters, toolpath.frame)
    heavy = ProcessParameters(
        density=DENSITY * 10.1 / grown(toolpath, toolpath.bead_width or 0.0)[0].sum()
    )
    (issue,) = payload.issues(timeline.deposit_motion(toolpath), held, toolpath, heavy)
    assert "above the payload of" in issue.message and "more than 10 kg" in issue.message
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
    process = ProcessParameters()
    whole = grown(toolpath, toolpath.bead_width or process.bead_width)[0].sum()
    for share, kept in ((1.001, True), (0.6, False)):
        (row,) = promised(toolpath, cell_with(positioner(kg=share * whole), toolpath), process)
        assert (
            row.ok is kept
            and row.worst == pytest.approx(whole, rel=1e-9)
            and row.bound == pytest.approx(share * whole)
        )
        assert (row.place is None) is kept and "Skew positioner" in row.how
    (untold,) = promised(toolpath, cell_with(positioner(from_axis=5e3), toolpath), process)
    assert untold.ok is None and untold.how.startswith(
        "not checked: the machine file of Skew positioner has no payload"
    )
    parameters = CellParameters(machine="kuka-kr10-r1100-2", limits="maker", branch="auto")
    held = cells.resolve(parameters, toolpath.frame)
    assert [row.ok for row in promised(toolpath, held, process)] == [True]
    stands = cells.resolve(dataclasses.replace(parameters, setup="tool-on-robot"), toolpath.frame)
    assert promised(toolpath, stands, process) == []


def test_positioners_offered_carry_the_part_and_are_of_the_robots_maker(
    toolpath, positioner, tmp_path
):
    """Two of the user's beside the one built in whose speeds are known, which is rated for 500 kg: by weight, by size, by
    maker; and after these the built-in ones of which less is known."""
    dkp, kp2, irbp = "kuka-dkp-400", "kuka-kp2-hv500", "abb-irbp-a250"
    plain = json.loads(positioner(kg=900).read_text(encoding="utf-8"))
    (tmp_path / "skew.json").unlink()
    folder = tmp_path / "mine"
    folder.mkdir()
    table = {
        "source": "made up",
        "turn": [{"cylinder": [1200, 40], "origin": [0, 0, 0], "rpy": [0, 0, 0]}],
    }
    for name, title, kg, more in (
        ("large", "ABB Large", 900, {"bodies": table}),
        ("small", "KUKA Small", 120, {}),
        ("robotless", "KUKA Wrong", 1, {}),
    ):
        told = {
            **plain,
            "id": name,
            "title": title,
            "payload": {"kg": kg, "source": "made up"},
            **more,
        }
        (folder / f"{name}.json").write_text(json.dumps(told), encoding="utf-8")
    (folder / "broken.json").write_text("{", encoding="utf-8")
    abb, kuka = machines.load("abb-irb4600-40-255"), machines.load("kuka-kr10-r1100-2")

    def ids(robot, mass, radius=100.0):
        return [one.id for one in external.positioners(robot, mass, radius, (str(folder),))]

    assert ids(kuka, 50.0) == ["small", "motoman-motopos-d500", "large", dkp, kp2, irbp]
    assert ids(abb, 50.0) == ["large", "small", "motoman-motopos-d500", irbp, dkp, kp2]
    assert ids(kuka, 300.0) == ["motoman-motopos-d500", "large", dkp, kp2] and ids(kuka, 700.0) == [
        "large"
    ]
    assert ids(kuka, 1000.0) == []
    # wider than the table of the D500, 502 mm
    assert ids(kuka, 300.0, 400.0) == ["large", dkp, kp2, "motoman-motopos-d500"]
    assert [one.id for one in external.tracks(kuka, (str(folder),))] == ["kuka-kl100-2"]


def test_weights_that_positioners_are_chosen_by_are_those_of_the_payload(toolpath):
    plate = obstacles.box((200.0, 100.0, 20.0), np.eye(4), "substrate")
    whole = (
        grown(toolpath, toolpath.bead_width or ProcessParameters().bead_width)[0].sum()
        + 0.4 * DENSITY
    )
    found = remedies.weight(
        dataclasses.replace(toolpath, surroundings=(plate,)), ProcessParameters()
    )
    assert found == pytest.approx(whole, rel=1e-9)
