# SPDX-License-Identifier: LGPL-2.1-or-later
"""A text drives the path that was checked: for every post, motion and set-up, PyKDL drives every
row of the text alone (deposit, retract, travel and approach) against the hub, the platform and the
full size of the beads deposited so far."""

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
from tests.posts.planned_jobs import (
    CHORD_ERROR,
    HEIGHT,
    SETUPS,
    SPANNING,
    WAYS,
    WIDTH,
    write_program,
)

pytestmark = pytest.mark.any_version

# mm: how deep the nozzle may touch, because checks are 0.5 mm apart and numbers are rounded; and
# how far rounding and chords may move it
DEEP, MAX_DEVIATION = 0.3, 0.15
CARTESIAN = ("fanuc", "cartesian", "time", "fanuc tool-on-robot")
# one variant for each post
STACKED = (
    WAYS[1],
    WAYS[4],
    ("siemens", "joint", "time", "table"),
    ("linuxcnc", "cartesian", "time", "table"),
    ("abb", "cartesian", "time", "abb part-on-robot"),
)


def bodies_of(drive, laying):
    """Return points in the bead that ends at each row of a text, as the text deposits it; none for
    rapids."""
    bodies = [np.zeros((0, 3))]
    for row in range(1, len(laying)):
        tips, axes = drive.way(row)
        bodies.append(bead_body(tips, axes, WIDTH, HEIGHT) if laying[row] else np.zeros((0, 3)))
    return bodies


def inside_at(drive, row, points):
    """Return which of the points (k,) are in the nozzle at the end of a row, except those above the
    current bead."""
    tip, axis = drive.ends(row)
    deep, height = (
        row_depths[0]
        for row_depths in depths_in_nozzle(tip[None], axis[None], drive.cell.nozzle, points)
    )
    return (deep > 0.0) & (height < HEIGHT)


def contacts(variant, files, lift=planned_jobs.LIFT):
    """Return (row, mm) for the rows of a text on which the nozzle gets into hub, deposit or
    platform, and the drive. Deposit that is in the nozzle while it prints an end of a bead, at most
    as high over the tip as the bead, may stay in it on the retract and approach at that end."""
    cell, motion, _, _ = write_program(variant, lift=lift)
    setup, rows = SETUPS[variant[3]], np.flatnonzero(motion.moves)
    drive = Drive(cell, catalogue.load(variant[0]).read(files), motion.joints[rows[0]])
    laying, nozzle, contact_rows = drive.read.deposit, cell.nozzle, []
    bodies = bodies_of(drive, laying)
    for row in range(1, len(rows)):
        tips, axes = drive.way(row)
        laid = np.concatenate(bodies[:row])
        deep, height = depths_in_nozzle(tips, axes, nozzle, laid)
        if laying[row]:
            deep = np.minimum(deep, height - HEIGHT)
        else:
            previous_end = (
                row - int(np.argmax(laying[:row][::-1])) - 1 if laying[:row].any() else None
            )
            next_start = row + int(np.argmax(laying[row:])) - 1 if laying[row:].any() else None
            for end in (previous_end, next_start):
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
        contact_rows += [(row, deepest)] if deepest > DEEP else []
    return contact_rows, drive


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_text_drives_the_way_that_was_looked_at(way):
    cell, motion, _, files = write_program(way)
    contact_rows, drive = contacts(way, files)
    assert contact_rows == []
    rows = np.flatnonzero(motion.moves)
    readback, joints = drive.read, motion.joints[rows]
    # stops and straight moves follow the plan: rapids are joint moves with stops, beads run to
    # their ends
    assert readback.stops.tolist() == motion.stops[rows].tolist()
    assert readback.linear.tolist() == (motion.deposit[rows] & (way[1] == "cartesian")).tolist()
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
    assert 0.0 < furthest < MAX_DEVIATION


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_travels_have_something_to_pass(way):
    """The straight path of the tip leads through the hub on most sides, so the driven travels are
    not free by chance."""
    _, motion, _, _ = write_program(way)
    rows = np.flatnonzero(motion.moves)
    lifted = np.flatnonzero(motion.role[rows] == 2)
    assert (
        len(lifted) >= 5
        and np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)[lifted[1:] - 1].min()
        > 60.0
    )


@pytest.mark.parametrize("way", STACKED, ids=" ".join)
def test_a_retract_distance_of_nothing_leads_over_what_was_just_laid(way):
    files = write_program(way, lift=0.0)[3]
    contact_rows, drive = contacts(way, files, 0.0)
    assert contact_rows == []
    assert (~drive.read.deposit).sum() >= 4  # a retract exists even so


@pytest.mark.parametrize(
    "broken",
    ["beads are lines", "moves off and onto beads are not looked at", "nothing is laid yet"],
)
def test_the_drive_finds_what_a_broken_check_lets_pass(broken, monkeypatch):
    """The drive of a text finds the collisions of a job that was planned with a faulty check."""
    variant = STACKED[0]
    met, built = rapids.RapidObstacles.find_collisions, bead_ends.build_deposit
    with monkeypatch.context() as patch:
        if broken == "beads are lines":
            patch.setattr(
                bead_ends,
                "build_deposit",
                lambda points, build, width, *others_, **options: built(
                    points, build, 0.0 * width, *others_, **options
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
        planned_jobs.planned.cache_clear(), planned_jobs.write_program.cache_clear()
        contact_rows, _ = contacts(variant, write_program(variant, lift=0.0)[3], 0.0)
    planned_jobs.planned.cache_clear(), planned_jobs.write_program.cache_clear()
    assert contact_rows


def old_text(files):
    """Return the text of an earlier version: rapids of Cartesian programs were straight in space,
    without stops on retract and travel."""
    ((name, content),) = files.items()
    text = re.sub(r"(?m)^( *\d+:)J(?= P\[\d+\] \d+msec)", r"\1L", content.decode())
    text = re.sub(r"FINE(?=    ;\r\n *\d+:[JL] P\[\d+\] \d+msec FINE)", "CNT100", text)
    return {name: text.encode()}


def test_straight_rapids_with_rounded_corners_are_found_by_the_drive_and_refused():
    cell, motion, program, files = write_program(CARTESIAN)
    old = old_text(files)
    contact_rows, drive = contacts(CARTESIAN, old)
    assert (
        ~drive.read.stops
    ).sum() > motion.deposit.sum() - 20 and drive.read.linear.sum() > motion.deposit.sum()
    assert contact_rows and max(deep for _, deep in contact_rows) > 5.0
    result = verify(cell, motion, program, old, catalogue.load("fanuc"), CHORD_ERROR)
    assert {"VERIFY_INTERPOLATION", "VERIFY_BLEND", "VERIFY_BETWEEN"} <= {
        i.code for i in result.issues if i.level == ERROR
    }


@pytest.mark.parametrize("way", WAYS, ids=lambda variant: "-".join(variant[:4]))
def test_the_size_that_is_told_before_planning_is_about_that_of_the_program(way):
    """The size estimate before planning is near that of the program without its head, which
    dominates such a short program."""
    _, _, program, files = write_program(way)
    moves = sum(len(run) for run in program.moves)
    size = sum(map(len, files.values()))
    estimate = moves * catalogue.controller(way[0]).point_bytes
    assert 0.4 * size < estimate < 1.3 * size
