# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job with layers from chosen edges: no substrate, the first layer on one edge, the end at the
other."""

import types

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am import api
from freecad_am.batch import run
from freecad_am.batch.job.job import read_job
from freecad_am.core.issues import InputError

JOB = """\
name: half
part: {{file: half.step, start_edges: [{edge}]}}
strategy: {{kind: surface, layer_height: 5 mm}}
build_direction: {{clearance: none}}
"""
QUIET = types.SimpleNamespace(check=lambda: None, issues=lambda *_: None, progress=lambda *_: None)


@pytest.fixture
def part(tmp_path):
    """Write a half shell from z = 7 to 47 to a file."""
    file = str(tmp_path / "half.step")
    Part.makeCylinder(15, 40, Vector(0, 0, 7), Vector(0, 0, 1), 180).Faces[0].exportStep(file)
    return Part.read(file)


@pytest.fixture
def planned(doc, part, tmp_path):
    def plan(edge):
        (tmp_path / "half.yaml").write_text(JOB.format(edge=edge), encoding="utf-8")
        return run.plan(read_job(str(tmp_path / "half.yaml")), doc, QUIET)

    return plan


def test_layers_start_at_the_edge(planned, part):
    low = next(k for k, edge in enumerate(part.Edges, 1) if edge.BoundBox.ZMax < 7.001)
    stages = planned(f"Edge{low}")
    wall = api.result(stages.features[0])
    (curve,) = wall.first
    assert not curve.closed and curve.points[:, 2] == pytest.approx(7.0, abs=1e-9)
    heights = np.array(
        [layer.beads[0].points[:, 2].mean() for layer in api.result(stages.toolpath).layers]
    )
    assert (
        heights == pytest.approx(7.0 + 5.0 * np.arange(len(heights)), abs=1e-3)
        and len(heights) >= 8
    )


def test_an_edge_that_is_not_there(planned):
    with pytest.raises(InputError) as caught:
        planned("Edge77")
    assert caught.value.code == "UNKNOWN_EDGE" and "Edge77" in caught.value.message
