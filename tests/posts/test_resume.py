# SPDX-License-Identifier: LGPL-2.1-or-later
"""A text that resumes at a layer or a bead starts from a safe position above what the complete text
has printed until then, and continues like the complete text. Only its own words drive it."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import ERROR
from freecad_am.core.parameters.program import NcParameters, ProgramParameters, StartParameters
from freecad_am.core.planning.beads import steps
from freecad_am.core.planning.program import rows_from
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.driven import Drive, depth_in_hub, depths_in_nozzle
from tests.posts.planned_jobs import (
    CHORD_ERROR,
    HEIGHT,
    LIFT,
    PROCESS,
    SETUPS,
    WAYS,
    planned,
    write_program,
)
from tests.posts.test_contract import DEEP, bodies_of
from tests.programs import build

pytestmark = pytest.mark.any_version

ONE_OF_EACH = {
    variant[0]: variant for variant in WAYS if variant[3].endswith(("tool-on-robot", "table"))
}.values()  # one for each post
STARTS = {"layer": StartParameters(layer=1), "bead": StartParameters(layer=1, bead=1)}
MOVE_COLUMNS = (
    "joints",
    "duration",
    "share",
    "speed",
    "deposit",
    "linear",
    "stops",
    "position",
    "rotation",
    "direction",
    "wire",
    "rounding",
    "level",
    "user_frame",
    "tool_frame",
)  # of each move
MIN_FIRST_MOVE_S = (
    5.0  # minimum time of the first move, unless the text states a share of the axis speeds
)
# height of the end of the first move above its bead, as a share of the retract distance
MIN_START_SHARE = 0.5


def resumed(variant, start):
    """Return the cell, the rows that run, and the files."""
    post, kind, feed, name = variant
    cell, beads, motion = planned(name)
    if post == "staubli" and kind == "cartesian" and cell.setup == "part-on-robot":
        motion = steps.refined_to_chord_error(motion, cell, CHORD_ERROR, beads)
    parameters = ProgramParameters(
        post=post, motion=kind, max_points=2000, nc=NcParameters(feed=feed), start_at=start
    )
    program = build(motion, cell, PROCESS, parameters, "job")
    rows = rows_from(motion, start)
    run = dataclasses.replace(
        motion,
        **{field.name: getattr(motion, field.name)[rows] for field in dataclasses.fields(motion)},
    )
    return cell, motion, rows, run, program, catalogue.load(post).write(program)


def after(events, row):
    return [(event.row - row, event.kind, event.value) for event in events if event.row > row]


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("start", STARTS)
@pytest.mark.always(*(f"layer-{' '.join(variant)}" for variant in ONE_OF_EACH))
def test_it_is_the_rest_of_the_whole_text(way, start):
    _, motion, rows, _, _, files = resumed(way, STARTS[start])
    post = catalogue.load(way[0])
    resumed_text, complete = post.read(files), post.read(write_program(way)[3])
    first_row = len(complete.deposit) - len(
        resumed_text.deposit
    )  # the row of the complete text at which the resumed text begins
    assert first_row > 0 and int(motion.moves[~rows].sum()) <= first_row + 1
    # every move equals the complete text, except for the duration of the first
    for name in MOVE_COLUMNS:
        resumed_values, complete_values = getattr(resumed_text, name), getattr(complete, name)
        if complete_values is None:
            continue
        resumed_values, complete_values = (
            np.asarray(values, float)[skip:]
            for values, skip in ((resumed_values, 1), (complete_values, first_row + 1))
        )
        np.testing.assert_array_equal(resumed_values, complete_values, err_msg=name)
    assert after(resumed_text.events, 0) == after(complete.events, first_row)
    assert not [
        event
        for event in resumed_text.events
        if event.row == 0 and event.kind in ("on", "input", "call", "wait")
    ]
    # slow to its first position, with the deposit off until its first bead
    assert not resumed_text.deposit[0] and (
        np.isnan(resumed_text.duration[0]) or resumed_text.duration[0] >= MIN_FIRST_MOVE_S
    )
    assert 1 <= int(np.argmax(resumed_text.deposit)) <= 6


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("start", STARTS)
@pytest.mark.always("layer-ur cartesian time ur tool-on-robot")
def test_it_comes_from_over_what_was_laid_before(way, start):
    cell, motion, _, run, program, files = resumed(way, STARTS[start])
    post = catalogue.load(way[0])
    resumed_text, complete = post.read(files), post.read(write_program(way)[3])
    first_row, begins = (
        len(complete.deposit) - len(resumed_text.deposit),
        int(np.argmax(resumed_text.deposit)),
    )
    drive, printed_bodies = (
        Drive(cell, resumed_text, run.joints[np.flatnonzero(run.moves)[0]]),
        Drive(cell, complete, motion.joints[np.flatnonzero(motion.moves)[0]]),
    )
    bodies = np.concatenate(bodies_of(printed_bodies, complete.deposit)[: first_row + 1])
    assert len(bodies) > 100  # there is at least one layer below
    setup, nozzle = SETUPS[way[3]], cell.nozzle
    tip, axis = drive.ends(0)
    assert np.linalg.norm(tip - drive.ends(begins - 1)[0]) > MIN_START_SHARE * LIFT
    for row in range(begins):
        tips, axes = (tip[None], axis[None]) if row == 0 else drive.way(row)
        deep, height = depths_in_nozzle(tips, axes, nozzle, bodies)
        if row == begins - 1:  # the bead touches the one below at its start
            deep = np.minimum(deep, height - HEIGHT)
        assert (
            max(float(deep.max()), depth_in_hub(tips, axes, nozzle, setup.hub, setup.top)) < DEEP
        ), row
    result = verify(cell, run, program, files, post, CHORD_ERROR)
    assert not [issue for issue in result.issues if issue.level == ERROR]
