# SPDX-License-Identifier: LGPL-2.1-or-later
"""`am.place` returns a pose that makes an infeasible joint path feasible, and rejects objects that
it cannot place."""

import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError

HIGH = (1045.747, -630.155, 2153.167, 0, 0, 0)  # out of reach
BOX = {"x": 0, "y": 0, "z": "1500 mm", "step": "500 mm", "points": 60}


@pytest.mark.any_version
def test_the_best_pose_of_a_macro_makes_the_job_feasible(doc, no_remedies):
    cup = doc.addObject("Part::Feature", "Cup")
    cup.Shape = Part.makeCylinder(30.0, 20.0)
    feature = api.make_feature(doc, cup, layer_height=10, chord_error="0.5 mm")
    cell = api.make_cell(doc, limits="paper", deposition_point=HIGH)
    path = api.make_joint_path(doc, api.make_toolpath(doc, feature, cell), cell)
    assert path.Status == "infeasible"
    placement = api.place(path, **BOX)
    assert path.Status == "infeasible" and len(placement.poses) == 7  # the search changed nothing
    api.change(cell, **placement.entries(placement.best))
    assert path.Status == "up to date"
    assert api.place(path.Toolpath, cell, **BOX).judged[3].feasible
    with pytest.raises(InputError, match="width is not known"):
        api.place(path, width=3)
    with pytest.raises(InputError, match="neither a toolpath nor a joint path"):
        api.place(cell)
