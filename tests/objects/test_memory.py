# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a point of a job takes of memory at the peak of each stage, told by two sizes of it. `bench load` measures whole
processes, and a million points."""

import tracemalloc

import FreeCAD
import pytest

from freecad_am import api

pytestmark = pytest.mark.any_version

# bytes a point at the peak, of all that is kept by then too. Packing has no fixed cost any more, so that the small job no
# longer hides what the read-back of a program takes.
MOST = 2200.0
CHORDS = (0.004, 0.001)  # mm; about 2,500 and 5,000 points


def peaks(chord):
    """Points of the motion, and the peak of each stage in bytes above what was there before the first."""
    doc = FreeCAD.newDocument("Memory")
    part = doc.addObject("Part::Sphere", "Sphere")
    part.Radius, part.Angle1, part.Angle2 = 45.0, 0, 90
    doc.recompute()
    cell = api.make_cell(doc, limits="paper")
    feature = api.make_feature(doc, part, layer_height=5, chord_error=chord)
    tracemalloc.start()
    try:
        found = {}
        toolpath = api.make_toolpath(doc, feature, cell)
        found["toolpath"] = tracemalloc.get_traced_memory()[1]
        tracemalloc.reset_peak()
        path = api.make_joint_path(doc, toolpath, cell)
        found["joint path"] = tracemalloc.get_traced_memory()[1]
        tracemalloc.reset_peak()
        api.make_program(doc, path, name="CUP")
        found["program"] = tracemalloc.get_traced_memory()[1]
        return len(api.result(path).motion), found
    finally:
        tracemalloc.stop()
        FreeCAD.closeDocument(doc.Name)


@pytest.fixture(scope="module")
def grown():
    """Points, and bytes at the peak of each stage, that the larger job has more."""
    peaks(0.1)  # imports
    (few, small), (many, large) = (peaks(chord) for chord in CHORDS)
    assert 2000 < few < 3000 and 4000 < many < 6000
    return many - few, {stage: large[stage] - small[stage] for stage in small}


@pytest.mark.parametrize("stage", ["toolpath", "joint path", "program"])
def test_a_point_takes_so_much_memory_and_no_more(grown, stage):
    points, more = grown
    assert more[stage] / points < MOST
