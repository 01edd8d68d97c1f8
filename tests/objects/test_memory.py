# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two sizes of a job show the peak memory for a point in each stage. `bench load` measures complete
processes and a million points."""

import tracemalloc

import FreeCAD
import pytest

from freecad_am import api

pytestmark = pytest.mark.any_version

# bytes for a point at the peak, including all results kept by then. Packing has no fixed cost any
# more, so the small job no longer hides the memory of a program's read-back.
MAX_POINT_BYTES = 2200.0
CHORD_ERRORS_MM = (0.004, 0.001)  # mm; about 2,500 and 5,000 points


def peaks(chord):
    """Return the points of the motion, and the peak of each stage in bytes above the start."""
    doc = FreeCAD.newDocument("Memory")
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45.0, 0, 90
    doc.recompute()
    cell = api.make_cell(doc, limits="paper")
    feature = api.make_feature(doc, sphere, layer_height=5, chord_error=chord)
    tracemalloc.start()
    try:
        stage_peaks = {}
        toolpath = api.make_toolpath(doc, feature, cell)
        stage_peaks["toolpath"] = tracemalloc.get_traced_memory()[1]
        tracemalloc.reset_peak()
        path = api.make_joint_path(doc, toolpath, cell)
        stage_peaks["joint path"] = tracemalloc.get_traced_memory()[1]
        tracemalloc.reset_peak()
        api.make_program(doc, path, name="CUP")
        stage_peaks["program"] = tracemalloc.get_traced_memory()[1]
        return len(api.result(path).motion), stage_peaks
    finally:
        tracemalloc.stop()
        FreeCAD.closeDocument(doc.Name)


@pytest.fixture(scope="module")
def grown():
    """Return the additional points of the larger job, and its additional bytes at the peak of each
    stage."""
    peaks(0.1)  # for the imports
    (point_count, small), (larger_count, large) = (peaks(chord) for chord in CHORD_ERRORS_MM)
    assert 2000 < point_count < 3000 and 4000 < larger_count < 6000
    return larger_count - point_count, {stage: large[stage] - small[stage] for stage in small}


@pytest.mark.parametrize("stage", ["toolpath", "joint path", "program"])
def test_a_point_takes_so_much_memory_and_no_more(grown, stage):
    points, additional_bytes = grown
    assert additional_bytes[stage] / points < MAX_POINT_BYTES
