# SPDX-License-Identifier: LGPL-2.1-or-later
"""A robot on a track under a part of 2 m: driven in the world by two PyKDL chains built here from
the numbers."""

import dataclasses
import json
import math
import re

import numpy as np
import PyKDL
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning import other_cells, remedies
from freecad_am.core.planning.external import remedies as external_remedies
from freecad_am.core.planning.external.level import figures
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, Layer, MotionRules, Toolpath
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.core.planning.test_external_axes import bryant, drive_chain, kdl_chain, kdl_pose
from tests.programs import build

ROBOT, ABB = "kuka-kr6-r900-sixx", "abb-irb1200-5-90"
STANDS = (40.0, -250.0, -420.0, 0.0, 0.0, 80.0)  # mm, deg
TORCH, PLATFORM = (10.0, 0.0, 150.0, 0.0, 20.0, 0.0), (520.0, 0.0, -100.0, 0.0, 0.0, 90.0)
TRACK = {
    "id": "track",
    "title": "Track of 3 m",
    "sources": ["made up"],
    "joints": [
        {
            "name": "rail",
            "type": "prismatic",
            "origin": [0, 30, 50],
            "rpy": [0, 0, 10],
            "axis": [1, 0, 0],
            "max_speed": 1500,
        }
    ],
    "flange": {"origin": [5, 0, 300], "rpy": [0, 0, 25]},
    "controller": {"matrix": [[1]], "offset": [0], "remark": "as it is", "posts": []},
    "limits": {"maker": {"axes": [[-1500, 1500]], "source": "made up"}},
    "check_poses": [],
}


def slid(value):
    """The track's plate seen from its base, computed by PyKDL from the numbers above."""
    joint = TRACK["joints"][0]
    chain = PyKDL.Chain()
    chain.addSegment(PyKDL.Segment(PyKDL.Joint(), kdl_pose(joint["origin"], joint["rpy"])))
    chain.addSegment(
        PyKDL.Segment(
            PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), PyKDL.Joint.TransAxis)
        )
    )
    chain.addSegment(
        PyKDL.Segment(PyKDL.Joint(), kdl_pose(TRACK["flange"]["origin"], TRACK["flange"]["rpy"]))
    )
    return drive_chain(chain, [value])


@pytest.fixture(scope="module")
def track(tmp_path_factory):
    path = tmp_path_factory.mktemp("track") / "track.json"
    poses = []
    for value in (0.0, 700.25, -1500.0):
        plate = slid(value)
        poses.append(
            {
                "q": [value],
                "origin": list(plate.p),
                "rotation": [[plate.M[i, k] for k in range(3)] for i in range(3)],
            }
        )
    path.write_text(json.dumps({**TRACK, "check_poses": poses}), encoding="utf-8")
    return path


def cell_for(track, **options):
    degrees = (*PLATFORM[:3], *np.radians(PLATFORM[3:]))
    return cells.resolve(
        CellParameters(
            **{
                "machine": ROBOT,
                "setup": "tool-on-robot",
                "branch": ("front", "up", "noflip"),
                "mount": "part",
                "deposition_point": degrees,
                "external": f"{track} at {' '.join(map(str, STANDS))} carries robot",
                "platform_diameter": 0.0,
                "nozzle": NozzleParameters(tool=(*TORCH[:3], *np.radians(TORCH[3:]))),
                **options,
            }
        ),
        np.eye(4),
        "curves",
    )


def wall(length=2000.0, layers=2, step=50.0):
    """A wavy wall along X of the part, to and fro, with a leaning tool."""
    along = np.linspace(-0.5 * length, 0.5 * length, int(length / step) + 1)
    beads = []
    for layer in range(layers):
        x = along if layer % 2 == 0 else along[::-1]
        points = np.stack([x, 40.0 * np.sin(x / 200.0), np.full(len(x), 5.0 * layer)], axis=1)
        tool = np.tile([0.0, math.sin(0.2), math.cos(0.2)], (len(x), 1))
        arc_length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
        beads.append(
            Bead(
                points,
                tool,
                tool,
                2.0 * math.pi * arc_length / arc_length[-1],
                np.full(len(x), 10.0),
                False,
            )
        )
    return Toolpath(tuple(Layer((bead,)) for bead in beads), np.eye(4), 5.0, 0.5, family="curves")


@pytest.fixture(scope="module")
def planned(track):
    path = plan_joints(wall(), cell_for(track), JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    return path


def in_the_world(joints):
    """Tip and tool axis in the part's frame for joint values (n, 7), mm and rad, computed through
    the world."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    start = bryant(STANDS)
    at_zero = (start * slid(0.0)).Inverse()
    tips, tools = [], []
    for row in joints:
        stands = start * slid(row[6]) * at_zero
        tip_in_part = (
            bryant(PLATFORM).Inverse()
            * stands
            * robot_base
            * drive_chain(robot, row[:6])
            * bryant(TORCH)
        )
        tips.append(list(tip_in_part.p))
        tools.append([-component for component in tip_in_part.M.UnitZ()])
    return np.array(tips), np.array(tools)


def test_a_part_of_two_metres_is_met_at_every_point(track, planned):
    tip, tool = in_the_world(planned.joints)
    assert np.abs(tip - np.concatenate([path.bead.points for path in planned.beads])).max() < 1e-6
    assert np.abs(tool - np.concatenate([path.bead.tool for path in planned.beads])).max() < 1e-9
    cell = cell_for(track)
    assert (planned.joints >= cell.limits.lower).all() and (
        planned.joints <= cell.limits.upper
    ).all()
    # the arm without the track cannot
    alone = plan_joints(wall(), cell_for(track, external="none"), JointParameters())
    assert not alone.feasible


def test_a_long_part_without_a_track_is_told_of_one(track):
    """The proposed remedy is planned here by a different call from the one that proposes it."""
    settings = CellParameters(
        machine=ROBOT,
        setup="tool-on-robot",
        branch=("front", "up", "noflip"),
        mount="part",
        platform_diameter=0.0,
        deposition_point=(*PLATFORM[:3], *np.radians(PLATFORM[3:])),
        nozzle=NozzleParameters(tool=(*TORCH[:3], *np.radians(TORCH[3:]))),
    )
    long, short = wall(1800.0, 1, 100.0), wall(500.0, 1, 100.0)
    assert not list(external_remedies.added(settings, (), short, {"UNREACHABLE"}))
    ((text, changed),) = external_remedies.added(settings, (), long, {"UNREACHABLE"})
    assert text == (
        "`cell.external: [{machine: kuka-kl100-2, pose: [0, 0, -356, 0, 0, 90], carries: robot}]` and "
        "`cell.branch: auto`"
    )
    assert not plan_joints(
        long, cells.resolve(settings, np.eye(4), "curves"), JointParameters(method="constant")
    ).feasible
    joint_path = plan_joints(long, cells.resolve(changed, np.eye(4), "curves"), JointParameters())
    assert joint_path.feasible, [issue.message for issue in joint_path.issues]
    issues = plan_joints(
        long, cells.resolve(settings, np.eye(4), "curves"), JointParameters()
    ).issues
    tried = other_cells.Tried(lambda: long, settings, (), ProcessParameters(), JointParameters())
    (note,) = remedies.remedies(tried, joint_path, issues, lambda *_: None)
    assert note.code == "REMEDY" and text in note.message
    # a robot with a track gets no other, and there is no positioner to move
    assert not list(external_remedies.added(changed, (), long, {"UNREACHABLE"}))
    assert not list(external_remedies.move_positioner(changed, ()))


def test_between_the_points_too(planned):
    """Between the points the tip stays within the chord error."""
    for path in planned.beads:
        start, end = path.joints[:-1], path.joints[1:]
        for share in (0.3, 0.5):
            tip, _ = in_the_world(start + share * (end - start))
            along = np.diff(path.bead.points, axis=0)
            gap = tip - path.bead.points[:-1]
            share_of_segment = np.clip((gap * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
            assert (
                np.linalg.norm(gap - share_of_segment[:, None] * along, axis=1).max() <= 0.5 + 1e-6
            )


def test_the_track_goes_along_smoothly_and_no_farther_than_it_needs(track, planned):
    """The track moves smoothly and no farther than needed."""
    for path in planned.beads:
        x_values, value = path.bead.points[:, 0], path.joints[:, 6]
        assert (np.sign(np.diff(value)) == np.sign(np.diff(value))[0]).all()
        # no faster along the part than the deposit, and at a constant share of it
        share = np.diff(value) / np.diff(x_values)
        assert np.abs(share).max() < 1.0 and np.ptp(share) < 0.05
    assert np.ptp(planned.joints[:, 6]) < 1900.0
    # a position of the part has one position of the track in every layer
    first_path, second_path = planned.beads
    ends = np.array([first_path.joints[0, 6], first_path.joints[-1, 6]])
    assert np.abs(ends - second_path.joints[[-1, 0], 6]).max() < 1.0
    track_figures = figures(cell_for(track), planned)
    assert track_figures["moved_mm"] == {
        "e1": pytest.approx(np.abs(np.diff(np.r_[first_path.joints[:, 6]])).sum() * 2.0, rel=1e-6)
    }
    assert track_figures["turned_deg"] == {}


def test_rapids_keep_the_limits_and_speeds(track, planned):
    cell = cell_for(track)
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    assert (np.abs(motion.joints[:, 6]) <= 1500.0).all()
    moves = np.flatnonzero(motion.duration[1:] > 0.0)
    rate = np.abs(np.diff(motion.joints, axis=0))[moves] / motion.duration[1:][moves, None]
    assert len(moves) > 80 and (rate <= cell.machine.max_speed * (1.0 + 1e-6)).all()
    retracts = np.flatnonzero(motion.role == 1)
    assert (
        len(retracts)
        and np.abs(motion.joints[retracts, 6] - motion.joints[retracts - 1, 6]).max() < 1e-12
    )


def test_where_the_arm_reaches_all_of_it_the_track_stands_still(track):
    path = plan_joints(wall(200.0, 1), cell_for(track), JointParameters())
    assert path.feasible and (path.joints[:, 6] == path.joints[0, 6]).all()


def test_a_track_that_is_too_short_is_told(track, tmp_path):
    description = json.loads(track.read_text(encoding="utf-8"))
    description["limits"]["maker"]["axes"] = [[-100, 150]]
    short = tmp_path / "short.json"
    short.write_text(json.dumps(description), encoding="utf-8")
    path = plan_joints(wall(), cell_for(short), JointParameters())
    assert not path.feasible
    values = np.concatenate([bead.bead.external[:, 0] for bead in path.beads])
    assert values.min() >= -100.0 and values.max() <= 150.0
    level = dataclasses.replace(
        wall(200.0, 1), rules=MotionRules(max_from_vertical=math.radians(5.0))
    )
    issues = plan_joints(level, cell_for(track), JointParameters()).issues
    assert any(
        issue.code == "NOT_LEVEL" and "no axis turns the part" in issue.message for issue in issues
    )


@pytest.mark.parametrize(
    ("external", "code", "says"),
    [
        (
            "motoman-motopos-d500 at 0 0 0 0 0 0 carries robot",
            "NOT_YET",
            "carries the robot but is not a track",
        ),
        (
            "kuka-kl100-2 at 0 0 0 0 0 0 carries part",
            "NOT_YET",
            "carries the part on a prismatic axis",
        ),
        (
            "kuka-kl100-2 at 0 0 0 0 0 0 carries robot; kuka-kl100-2 at 0 900 0 0 0 0 carries robot",
            "NOT_YET",
            "2 mechanisms",
        ),
    ],
)
def test_refused_with_a_reason(track, external, code, says):
    with pytest.raises(InputError) as error:
        cell_for(track, external=external)
    assert error.value.code == code and says in error.value.message


@pytest.fixture(scope="module")
def by_abb(track):
    cell = cell_for(track, machine=ABB)
    path = plan_joints(wall(1600.0, 1), cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    return cell, path


@pytest.mark.parametrize(
    ("post", "kind"), [("kuka", "cartesian"), ("abb", "joint"), ("abb", "cartesian")]
)
def test_programs_are_read_back_and_driven_by_two_solvers(track, planned, by_abb, post, kind):
    """Programs are read back and driven by two solvers."""
    cell, path = (cell_for(track), planned) if post == "kuka" else by_abb
    motion, issues = assemble(path, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    program = build(
        motion, cell, ProcessParameters(), ProgramParameters(post=post, motion=kind), "job"
    )
    writer = catalogue.load(post)
    files = writer.write(program)
    assert not verify(cell, motion, program, files, writer, 0.5).issues
    # a step of 0.5 mm of the track in one move is detected
    ((name, data),) = files.items()
    number = re.search(
        r"E1 (-?[\d.]+)}" if post == "kuka" else r"\[(-?[\d.]+),9E9,9E9,9E9,9E9,9E9\]",
        data.decode(),
    )[1]
    tampered = {name: data.replace(number.encode(), f"{float(number) + 0.5:.4f}".encode(), 1)}
    issues_found = verify(cell, motion, program, tampered, writer, 0.5).issues
    assert {issue.code for issue in issues_found} & {"VERIFY_JOINTS", "VERIFY_POINT", "VERIFY_POSE"}
