# SPDX-License-Identifier: LGPL-2.1-or-later
"""The judge of the rounds detects every kind of fault."""

import numpy as np
import pytest

from tests.batch.conftest import Ended
from tests.robust import rounds, triangles

CORNERS = np.array([[x, y, z] for x in (0.0, 2.0) for y in (0.0, 2.0) for z in (0.0, 2.0)])
QUADS = (
    (0, 1, 3, 2),
    (4, 6, 7, 5),
    (0, 4, 5, 1),
    (2, 3, 7, 6),
    (0, 2, 6, 4),
    (1, 5, 7, 3),
)  # looking from outside
CUBE = CORNERS[[corner for a, b, c, d in QUADS for corner in ((a, b, c), (a, c, d))]]
SOUND = {
    "status": 2,
    "out": "",
    "err": "error[BAD_VALUE] job.yaml: x: is wrong\n",
    "seconds": 1.0,
    "memory": 100.0,
}


def test_distances_from_a_cube():
    points = np.random.default_rng(1).uniform(-2.0, 4.0, (300, 3))
    outside = np.linalg.norm(np.maximum(np.abs(points - 1.0) - 1.0, 0.0), axis=1)
    depth = np.minimum(points, 2.0 - points).min(axis=1)
    assert np.allclose(triangles.distance(points, CUBE), np.where(depth > 0.0, depth, outside))
    assert (triangles.inside(points, CUBE) == (depth > 0.0)).all()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"status": 1}, "status 1"),
        ({"status": -9}, "status -9"),
        ({"err": "error[INTERNAL] KeyError: x\n"}, "INTERNAL"),
        ({"err": "Traceback\n"}, "Traceback"),
        ({"err": ""}, "without one line"),
        ({"err": "error[X] a\nb\n"}, "without one line"),
        ({"seconds": 61.0}, "61 s"),
        ({"memory": 2001.0}, "2001 MB"),
        ({"err": "error[X] \u202ea\n"}, "control signs"),
        ({"err": "error[CRASHED] part.step: x\n"}, "CRASHED"),
        ({"status": 0}, "no report"),
    ],
)
def test_what_is_wrong_is_seen(tmp_path, change, told):
    assert rounds.faults(Ended(**SOUND), tmp_path) == []
    assert told in " ".join(rounds.faults(Ended(**{**SOUND, **change}), tmp_path))
    assert (
        rounds.faults(
            Ended(**{**SOUND, "seconds": 70.0, "err": "note[LARGE] job: x\n" + SOUND["err"]}),
            tmp_path,
        )
        == []
    )


def test_a_large_job_may_be_stopped_where_it_was_told_to_be_one(tmp_path):
    stopped = {**SOUND, "status": 1, "seconds": 90.0, "err": "error[ENDED] job.yaml: signal 24\n"}
    assert rounds.faults(Ended(**stopped), tmp_path)
    assert (
        rounds.faults(
            Ended(**{**stopped, "err": "note[LARGE] job: x\n" + stopped["err"]}), tmp_path
        )
        == []
    )


def test_litter_is_seen(tmp_path):
    (tmp_path / "out" / ".unfinished-1").mkdir(parents=True)
    assert len(rounds.faults(Ended(**SOUND), tmp_path)) == 2


def test_points_beside_the_part_are_seen(tmp_path):
    """A round fails if it writes points outside of its part."""

    def make(number, chance, folder):
        out = folder / "out"
        out.mkdir()
        rows = (
            "layer,bead,kind,x_mm,y_mm,z_mm,bx,by,bz",
            "0,0,rapid,9,9,9,0,0,1",
            "0,0,deposit,1,2,3,0,0,1",
        )
        rows = *rows, "0,0,deposit,1,2,4,0,0,1"
        (out / "waypoints.csv").write_text("\n".join(rows))
        return ["machines"], lambda points, _: triangles.distance(points, CUBE).max() - 0.5

    result = rounds.run(make, 0, 1, tmp_path)
    assert result["status"] == 0 and "off the part: 1.5 mm more than it may be" in result["wrong"]
