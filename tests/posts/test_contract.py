# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path that was looked at is the path that a text drives: every post, motion and set-up, from the text alone, every row
of it - deposit, retract, travel and approach - through PyKDL, against a hub, the platform, and the beads laid so far, as
wide and as high as they are."""

import re

import numpy as np
import pytest

from freecad_am.core.collision import bead_ends
from freecad_am.core.issues import ERROR
from freecad_am.core.planning.rapids import clearance as rapids
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts import planned_jobs
from tests.posts.driven import Drive, bead_body, depth_in_hub, depths_in_nozzle
from tests.posts.planned_jobs import CHORD_ERROR, HEIGHT, SETUPS, SPANNING, WAYS, WIDTH, written

pytestmark = pytest.mark.any_version

# mm: how deep the nozzle may touch: looks 0.5 mm apart, and digits; and how far digits and chords lead away
DEEP, APART = 0.3, 0.15
CARTESIAN = ("fanuc", "cartesian", "time", "fanuc tool-on-robot")
# one of each post
STACKED = (
    WAYS[1],
    WAYS[4],
    ("siemens", "joint", "time", "table"),
    ("linuxcnc", "cartesian", "time", "table"),
    ("abb", "cartesian", "time", "abb part-on-robot"),
)


def bodies_of(drive, laying):
    """Points in the bead that ends at each row of a text, none at rapids; beads are as their text lays them."""
    bodies = [np.zeros((0, 3))]
    for row in range(1, len(laying)):
        tips, axes = drive.way(row)
        bodies.append(bead_body(tips, axes, WIDTH, HEIGHT) if laying[row] else np.zeros((0, 3)))
    return bodies


def inside_at(drive, row, points):
    """(k,) which of the points are in the nozzle where a row ends: none of those above the bead that it stands in."""
    tip, axis = drive.ends(row)
    deep, height = (
        each[0] for each in depths_in_nozzle(tip[None], axis[None], drive.cell.nozzle, points)
    )
    return (deep > 0.0) & (height < HEIGHT)


def contacts(way, files, lift=planned_jobs.LIFT):
    """(row, mm) of the rows of a text on which the nozzle gets into hub, deposit or platform, and the drive.

    What is in the nozzle while it lays an end of a bead, no higher over the tip than the bead, may be in it on the way off
    and onto that end.
    """
    cell, motion, _, _ = written(way, lift=lift)
    setup, rows = SETUPS[way[3]], np.flatnonzero(motion.moves)
    drive = Drive(cell, catalogue.load(way[0]).read(files), motion.joints[rows[0]])
    laying, nozzle, found = drive.read.deposit, cell.nozzle, []
    bodies = bodies_of(drive, laying)
    for row in range(1, len(rows)):
        tips, axes = drive.way(row)
        laid = np.concatenate(bodies[:row])
        deep, height = depths_in_nozzle(tips, axes, nozzle, laid)
        if laying[row]:
            deep = np.minimum(deep, height - HEIGHT)
        else:
            before = row - int(np.argmax(laying[:row][::-1])) - 1 if laying[:row].any() else None
            after = row + int(np.argmax(laying[row:])) - 1 if laying[row:].any() else None
            for end in (before, after):
                if end is not None:
                    deep = np.where(inside_at(drive, end, laid), 0.0, deep)
        up = (tips - cell.poses.mount[:3, 3]) @ cell.poses.mount[:3, 2]
        beside = (
            np.linalg.norm((tips - cell.poses.mount[:3, 3]) @ cell.poses.mount[:3, :2], axis=1)
            > 0.5 * cell.platform_diameter
        )
        deepest = max(
            depth_in_hub(tips, axes, nozzle, setup.hub, setup.top),
            float(deep.max(initial=0.0)),
            float(np.where(beside, 0.0, -up).max()),
        )
        found += [(row, deepest)] if deepest > DEEP else []
    return found, drive


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_text_drives_the_way_that_was_looked_at(way):
    cell, motion, _, files = written(way)
    found, drive = contacts(way, files)
    assert found == []
    rows = np.flatnonzero(motion.moves)
    read, joints = drive.read, motion.joints[rows]
    # what stops and what runs straight, by the plan: rapids joint by joint and stopping, beads to their ends
    assert read.stops.tolist() == motion.stops[rows].tolist()
    assert read.linear.tolist() == (motion.deposit[rows] & (way[1] == "cartesian")).tolist()
    furthest = 0.0
    for row in np.flatnonzero(~motion.deposit[rows])[1:]:
        tips, axes = drive.way(row)
        planned = joints[row - 1] + np.linspace(0.0, 1.0, len(tips))[:, None] * (
            joints[row] - joints[row - 1]
        )
        tip, axis = cell.tip_in_part(drive.arm.forward(planned))
        furthest = max(
            furthest,
            np.linalg.norm(tips - tip, axis=1).max(),
            100.0 * np.linalg.norm(axes - axis, axis=1).max(),
        )
    assert 0.0 < furthest < APART


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_travels_have_something_to_pass(way):
    """The straight way of the tip would lead through the hub on most sides: what is driven is not free by chance."""
    _, motion, _, _ = written(way)
    rows = np.flatnonzero(motion.moves)
    lifted = np.flatnonzero(motion.role[rows] == 2)
    assert (
        len(lifted) >= 5
        and np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)[lifted[1:] - 1].min()
        > 60.0
    )


@pytest.mark.parametrize("way", STACKED, ids=" ".join)
def test_a_retract_distance_of_nothing_leads_over_what_was_just_laid(way):
    files = written(way, lift=0.0)[3]
    found, drive = contacts(way, files, 0.0)
    assert found == []
    assert (~drive.read.deposit).sum() >= 4  # there is a retract after all


@pytest.mark.parametrize(
    "broken",
    ["beads are lines", "moves off and onto beads are not looked at", "nothing is laid yet"],
)
def test_the_drive_finds_what_a_broken_check_lets_pass(broken, monkeypatch):
    """The same jobs planned by a check that misses something: the drive of the text finds it."""
    way = STACKED[0]
    met, built = rapids.RapidObstacles.find_collisions, bead_ends.build_deposit
    with monkeypatch.context() as patch:
        if broken == "beads are lines":
            patch.setattr(
                bead_ends,
                "build_deposit",
                lambda points, build, width, *rest, **more: built(
                    points, build, 0.0 * width, *rest, **more
                ),
            )
        elif broken == "nothing is laid yet":
            patch.setattr(
                rapids.RapidObstacles,
                "find_collisions",
                lambda self, moves: met(self, moves._replace(deposited=0 * moves.deposited)),
            )
        else:
            patch.setattr(
                rapids.RapidObstacles,
                "find_collisions",
                lambda self, moves: np.zeros(len(moves.deposited), dtype=bool),
            )
        planned_jobs.planned.cache_clear(), planned_jobs.written.cache_clear()
        found, _ = contacts(way, written(way, lift=0.0)[3], 0.0)
    planned_jobs.planned.cache_clear(), planned_jobs.written.cache_clear()
    assert found


def old_text(files):
    """As it was written before: rapids of Cartesian programs straight in space, without a stop on retract and travel."""
    ((name, content),) = files.items()
    text = re.sub(r"(?m)^( *\d+:)J(?= P\[\d+\] \d+msec)", r"\1L", content.decode())
    text = re.sub(r"FINE(?=    ;\r\n *\d+:[JL] P\[\d+\] \d+msec FINE)", "CNT100", text)
    return {name: text.encode()}


def test_straight_rapids_with_rounded_corners_are_found_by_the_drive_and_refused():
    cell, motion, program, files = written(CARTESIAN)
    old = old_text(files)
    found, drive = contacts(CARTESIAN, old)
    assert (
        ~drive.read.stops
    ).sum() > motion.deposit.sum() - 20 and drive.read.linear.sum() > motion.deposit.sum()
    assert found and max(deep for _, deep in found) > 5.0
    result = verify(cell, motion, program, old, catalogue.load("fanuc"), CHORD_ERROR)
    assert {"VERIFY_INTERPOLATION", "VERIFY_BLEND", "VERIFY_BETWEEN"} <= {
        i.code for i in result.issues if i.level == ERROR
    }


@pytest.mark.parametrize("way", WAYS, ids=lambda way: "-".join(way[:4]))
def test_the_size_that_is_told_before_planning_is_about_that_of_the_program(way):
    """Without the head, which is most of so short a program."""
    _, _, program, files = written(way)
    moves = sum(len(run) for run in program.moves)
    size = sum(map(len, files.values()))
    told = moves * catalogue.controller(way[0]).point_bytes
    assert 0.4 * size < told < 1.3 * size
