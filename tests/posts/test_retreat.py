# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.retreat` in the programs of every post, motion and set-up: what is written is driven back over the bead's end."""

import numpy as np
import pytest

from freecad_am.core.issues import has_errors
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, ONE_OF_EACH, WAYS, planned, written

pytestmark = pytest.mark.any_version

BACK = 5.5  # mm; longer than what differs at the ends of the beads


def _steps(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1)


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.always(*ONE_OF_EACH)
def test_beads_end_where_they_were_before_their_end(way):
    """By the motion of the plan, then by the text, which is read back and held against it; a stop at each end of a bead."""
    cell, motion, program, files = written(way, retreat=BACK)
    checked = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    assert not has_errors(checked.issues), [issue.message for issue in checked.issues]
    plain = planned(way[3])[1]
    starts = np.flatnonzero(motion.deposit & (motion.point == 0))
    assert len(starts) == len(plain)
    for start, bead in zip(starts, plain, strict=True):
        rows = start + np.arange(np.argmax(~np.append(motion.deposit[start:], False)))
        rows = rows[motion.point[rows] == np.arange(len(rows))]  # the next bead may follow at once
        (turn,) = np.flatnonzero(motion.halt[rows])
        place = motion.position[rows]
        np.testing.assert_allclose(place[turn], bead.points[-1], atol=1e-9)
        assert _steps(place[turn:]).sum() == pytest.approx(BACK, abs=0.01)
        # places on the way back are places of the way there, by the segments nearest to them
        for point in place[turn:]:
            a, b = place[:turn], place[1 : turn + 1]
            share = np.clip(
                ((point - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0.0, 1.0
            )
            assert np.linalg.norm(a + share[:, None] * (b - a) - point, axis=1).min() < CHORD_ERROR
    assert motion.stops[motion.halt].all()


STOPS = {"fanuc": ("FINE", "CNT100"), "linuxcnc": ("G61.1\nG1", "G1"), "siemens": (" G9 G1", " G1")}


TIMED = [way for way in WAYS if way[1:3] == ("joint", "time") and way[0] in STOPS]


@pytest.mark.parametrize("way", TIMED, ids=" ".join)
def test_a_text_that_does_not_stop_there_is_refused(way):
    """Each stop of the text in turn is left out; where the text stops once more for each bead than without a retreat."""
    cell, motion, program, files = written(way, retreat=BACK)
    stop, passed = STOPS[way[0]]
    first, plain = (
        {name: data.decode("ascii") for name, data in some.items()}
        for some in (files, written(way)[3])
    )
    here, there = (sum(text.count(stop) for text in some.values()) for some in (first, plain))
    assert here == there + int(motion.halt.sum())
    for name, text in first.items():
        places = [k for k in range(len(text)) if text.startswith(stop, k)]
        for place in places:
            changed = {
                **files,
                name: (text[:place] + passed + text[place + len(stop) :]).encode("ascii"),
            }
            checked = verify(cell, motion, program, changed, catalogue.load(way[0]), CHORD_ERROR)
            assert has_errors(checked.issues), text[place - 80 : place + 80]
