# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.retreat` in the programs of every post, motion and set-up: the text drives back over the
bead's end."""

import numpy as np
import pytest

from freecad_am.core.issues import has_errors
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, ONE_OF_EACH, WAYS, planned, write_program

pytestmark = pytest.mark.any_version

RETREAT_MM = 5.5  # mm; longer than the phases at the ends of the beads


def _steps(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1)


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.always(*ONE_OF_EACH)
def test_beads_end_where_they_were_before_their_end(way):
    """The motion of the plan and then the text, read back and compared with it, return over each
    bead's end, with a stop at both ends."""
    cell, motion, program, files = write_program(way, retreat=RETREAT_MM)
    checked = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    assert not has_errors(checked.issues), [issue.message for issue in checked.issues]
    plain = planned(way[3])[1]
    starts = np.flatnonzero(motion.deposit & (motion.point == 0))
    assert len(starts) == len(plain)
    for start, bead in zip(starts, plain, strict=True):
        rows = start + np.arange(np.argmax(~np.append(motion.deposit[start:], False)))
        rows = rows[motion.point[rows] == np.arange(len(rows))]  # the next bead may follow at once
        (turn,) = np.flatnonzero(motion.halt[rows])
        positions = motion.position[rows]
        np.testing.assert_allclose(positions[turn], bead.points[-1], atol=1e-9)
        assert _steps(positions[turn:]).sum() == pytest.approx(RETREAT_MM, abs=0.01)
        # points on the way back lie on the nearest segments of the way forward
        for point in positions[turn:]:
            a, b = positions[:turn], positions[1 : turn + 1]
            share = np.clip(
                ((point - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0.0, 1.0
            )
            assert np.linalg.norm(a + share[:, None] * (b - a) - point, axis=1).min() < CHORD_ERROR
    assert motion.stops[motion.halt].all()


STOPS = {"fanuc": ("FINE", "CNT100"), "linuxcnc": ("G61.1\nG1", "G1"), "siemens": (" G9 G1", " G1")}


TIMED = [variant for variant in WAYS if variant[1:3] == ("joint", "time") and variant[0] in STOPS]


@pytest.mark.parametrize("way", TIMED, ids=" ".join)
def test_a_text_that_does_not_stop_there_is_refused(way):
    """A text without one of the stops is rejected, in posts that stop once more for each bead than
    without a retreat."""
    cell, motion, program, files = write_program(way, retreat=RETREAT_MM)
    stop, passed = STOPS[way[0]]
    files_, plain_files = (
        {name: data.decode("ascii") for name, data in program_files.items()}
        for program_files in (files, write_program(way)[3])
    )
    stop_count, plain_stop_count = (
        sum(text.count(stop) for text in program_files.values())
        for program_files in (files_, plain_files)
    )
    assert stop_count == plain_stop_count + int(motion.halt.sum())
    for name, text in files_.items():
        stop_positions = [k for k in range(len(text)) if text.startswith(stop, k)]
        for stop_position in stop_positions:
            changed = {
                **files,
                name: (text[:stop_position] + passed + text[stop_position + len(stop) :]).encode(
                    "ascii"
                ),
            }
            checked = verify(cell, motion, program, changed, catalogue.load(way[0]), CHORD_ERROR)
            assert has_errors(checked.issues), text[stop_position - 80 : stop_position + 80]
