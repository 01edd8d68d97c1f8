# SPDX-License-Identifier: LGPL-2.1-or-later
"""A text that resumes at a layer or a bead: driven from its words alone it comes from where it is safe, over what the whole
text has laid until then, and goes on as that one does."""

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
    written,
)
from tests.posts.test_contract import DEEP, bodies_of
from tests.programs import build

pytestmark = pytest.mark.any_version

ONE_OF_EACH = {
    way[0]: way for way in WAYS if way[3].endswith(("tool-on-robot", "table"))
}.values()  # post
STARTS = {"layer": StartParameters(layer=1), "bead": StartParameters(layer=1, bead=1)}
TOLD = (
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
SLOW = 5.0  # s that the first move takes at least, or the text says by what share of the speeds it goes
LEAST = 0.5  # of the retract distance: how far above its bead the first move ends


def resumed(way, start):
    """The cell, the rows that are run, and the files."""
    post, kind, feed, name = way
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
@pytest.mark.always(*(f"layer-{' '.join(way)}" for way in ONE_OF_EACH))
def test_it_is_the_rest_of_the_whole_text(way, start):
    _, motion, rows, _, _, files = resumed(way, STARTS[start])
    post = catalogue.load(way[0])
    rest, whole = post.read(files), post.read(written(way)[3])
    first = len(whole.deposit) - len(
        rest.deposit
    )  # the row of the whole text that the other one begins with
    assert first > 0 and int(motion.moves[~rows].sum()) <= first + 1
    # every move as in the whole text, but for how long the first one takes
    for name in TOLD:
        mine, theirs = getattr(rest, name), getattr(whole, name)
        if theirs is None:
            continue
        mine, theirs = (
            np.asarray(one, float)[skip:] for one, skip in ((mine, 1), (theirs, first + 1))
        )
        np.testing.assert_array_equal(mine, theirs, err_msg=name)
    assert after(rest.events, 0) == after(whole.events, first)
    assert not [
        event
        for event in rest.events
        if event.row == 0 and event.kind in ("on", "input", "call", "wait")
    ]
    # slow to its first place, the deposit off until its first bead
    assert not rest.deposit[0] and (np.isnan(rest.duration[0]) or rest.duration[0] >= SLOW)
    assert 1 <= int(np.argmax(rest.deposit)) <= 6


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("start", STARTS)
@pytest.mark.always("layer-ur cartesian time ur tool-on-robot")
def test_it_comes_from_over_what_was_laid_before(way, start):
    cell, motion, _, run, program, files = resumed(way, STARTS[start])
    post = catalogue.load(way[0])
    rest, whole = post.read(files), post.read(written(way)[3])
    first, begins = len(whole.deposit) - len(rest.deposit), int(np.argmax(rest.deposit))
    drive, before = (
        Drive(cell, rest, run.joints[np.flatnonzero(run.moves)[0]]),
        Drive(cell, whole, motion.joints[np.flatnonzero(motion.moves)[0]]),
    )
    bodies = np.concatenate(bodies_of(before, whole.deposit)[: first + 1])
    assert len(bodies) > 100  # a layer at least lies there
    setup, nozzle = SETUPS[way[3]], cell.nozzle
    tip, axis = drive.ends(0)
    assert np.linalg.norm(tip - drive.ends(begins - 1)[0]) > LEAST * LIFT
    for row in range(begins):
        tips, axes = (tip[None], axis[None]) if row == 0 else drive.way(row)
        deep, height = depths_in_nozzle(tips, axes, nozzle, bodies)
        if row == begins - 1:  # where the bead begins it stands on the one below
            deep = np.minimum(deep, height - HEIGHT)
        assert (
            max(float(deep.max()), depth_in_hub(tips, axes, nozzle, setup.hub, setup.top)) < DEEP
        ), row
    result = verify(cell, run, program, files, post, CHORD_ERROR)
    assert not [issue for issue in result.issues if issue.level == ERROR]
