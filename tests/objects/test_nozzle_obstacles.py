# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle next to a block, in the families whose directions follow faces and curves: it leans
away, or the job is rejected. Points of its cone and of the block's box show contact, without code
of the package."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InfeasibleError

HALF_ANGLE, TIP, LENGTH = np.radians(20.0), 0.5, 60.0  # the nozzle
LOW_BLOCK, HIGH_BLOCK = (
    np.array([-30.0, 12.0, 0.0]),
    np.array([30.0, 22.0, 45.0]),
)  # the blocks, next to a deposit at y up to 10
TOLERANCE_MM = 0.05  # mm, the deviation of bodies and cones from their true positions


@pytest.fixture
def block(doc):
    obj = doc.addObject("Part::Feature", "Block")
    obj.Shape = Part.makeBox(*(HIGH_BLOCK - LOW_BLOCK), App.Vector(*LOW_BLOCK))
    return obj


@pytest.fixture
def plate(doc):
    obj = doc.addObject("Part::Feature", "Plate")
    obj.Shape = Part.makeBox(40, 20, 5, App.Vector(-20, -10, -5))
    doc.recompute()
    top = next(
        f"Face{k}" for k, face in enumerate(obj.Shape.Faces, 1) if face.CenterOfMass.z > -1e-9
    )
    return obj, top


@pytest.fixture
def line(doc):
    obj = doc.addObject("Part::Feature", "Line")
    obj.Shape = Part.Wire(Part.makeLine(App.Vector(-20, 9, 0), App.Vector(20, 9, 0)))
    doc.recompute()
    return obj


@pytest.fixture
def cell(doc):
    return api.make_cell(
        doc,
        nozzle_half_angle=np.degrees(HALF_ANGLE),
        nozzle_diameter=2 * TIP,
        nozzle_length=LENGTH,
        platform_diameter=0,
    )


def clad(doc, plate, block, **values):
    values = {"layers": 1, "layer_height": 2, "bead_spacing": 4, **values}
    return api.make_cladding_feature(doc, *_face(plate), fixtures=[block], **values)


def plan_curve(doc, line, block, **values):
    return api.make_curves_feature(doc, line, fixtures=[block], layer_height=2, **values)


def _part(request, family):
    """Return the part that a family prints, and the function that makes its feature."""
    name, make = ("plate", clad) if family == "cladding" else ("line", plan_curve)
    return request.getfixturevalue(name), make


def _face(plate):
    return plate[0], [plate[1]]


def inside(toolpath):
    """Return how many points of cones, on 24 lines of each, are inside of the block."""
    points, tools = (
        np.vstack([getattr(bead, name) for _, _, bead in toolpath]) for name in ("points", "tool")
    )
    aside = np.cross(tools, [1.0, 0.0, 0.0])
    aside /= np.linalg.norm(aside, axis=1)[:, None]
    third_axis = np.cross(tools, aside)
    up = np.linspace(1.0, LENGTH, 120)
    count = 0
    for turn in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
        out = np.cos(turn) * aside + np.sin(turn) * third_axis
        cone_points = (
            points[:, None]
            + up[:, None] * tools[:, None]
            + (TIP + np.tan(HALF_ANGLE) * up)[:, None] * out[:, None]
        )
        count += int(
            ((cone_points > LOW_BLOCK + TOLERANCE_MM) & (cone_points < HIGH_BLOCK - TOLERANCE_MM))
            .all(axis=-1)
            .sum()
        )
    return count


@pytest.mark.parametrize("family", ["cladding", "curves"])
def test_the_tool_leans_away_from_what_stands_beside(doc, request, block, cell, family):
    shape, make = _part(request, family)
    blind = api.result(api.make_toolpath(doc, make(doc, shape, block, clearance="none"), cell))
    assert inside(blind) > 0
    clear = api.result(api.make_toolpath(doc, make(doc, shape, block), cell))
    assert inside(clear) == 0
    assert clear.family == family and not any(issue.level == "error" for issue in clear.issues)
    leans = np.vstack([bead.tool for _, _, bead in clear])[:, 1]
    assert leans.min() < -0.1 and leans.max() < 1e-9  # away from the block, never towards it


@pytest.mark.parametrize("family", ["cladding", "curves"])
def test_where_it_cannot_lean_far_enough_the_job_is_refused(doc, request, cell, block, family):
    shape, make = _part(request, family)
    roof = doc.addObject("Part::Feature", "Roof")
    roof.Shape = Part.makeBox(120, 120, 5, App.Vector(-60, -60, 8))
    doc.recompute()
    toolpath = api.make_toolpath(doc, make(doc, shape, roof), cell)
    issue = api.issues(toolpath)[0]
    assert (toolpath.Status, issue.level, issue.code) == ("infeasible", "error", "CLEARANCE")
    with pytest.raises(InfeasibleError):
        api.make_joint_path(doc, toolpath, cell)
