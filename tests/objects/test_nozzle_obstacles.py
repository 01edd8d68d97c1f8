# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle beside a block, in the families whose directions are those of faces and curves: it leans away, or is refused.

Whether it touches is found by points of its cone and of the block's box, none of it from the package.
"""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InfeasibleError

HALF_ANGLE, TIP, LENGTH = np.radians(20.0), 0.5, 60.0  # of the nozzle
LOW, HIGH = (
    np.array([-30.0, 12.0, 0.0]),
    np.array([30.0, 22.0, 45.0]),
)  # of the block, beside what is laid at y up to 10
DEEP = 0.05  # mm, what bodies and cones are off their true places


@pytest.fixture
def block(doc):
    obj = doc.addObject("Part::Feature", "Block")
    obj.Shape = Part.makeBox(*(HIGH - LOW), App.Vector(*LOW))
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


def laid(doc, line, block, **values):
    return api.make_curves_feature(doc, line, fixtures=[block], layer_height=2, **values)


def _part(request, family):
    """What is laid in a family, and what makes a feature of it."""
    name, make = ("plate", clad) if family == "cladding" else ("line", laid)
    return request.getfixturevalue(name), make


def _face(plate):
    return plate[0], [plate[1]]


def inside(toolpath):
    """How many points of cones, on 24 lines of each, are inside of the block."""
    points, tools = (
        np.vstack([getattr(bead, name) for _, _, bead in toolpath]) for name in ("points", "tool")
    )
    aside = np.cross(tools, [1.0, 0.0, 0.0])
    aside /= np.linalg.norm(aside, axis=1)[:, None]
    other = np.cross(tools, aside)
    up = np.linspace(1.0, LENGTH, 120)
    count = 0
    for turn in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
        out = np.cos(turn) * aside + np.sin(turn) * other
        places = (
            points[:, None]
            + up[:, None] * tools[:, None]
            + (TIP + np.tan(HALF_ANGLE) * up)[:, None] * out[:, None]
        )
        count += int(((places > LOW + DEEP) & (places < HIGH - DEEP)).all(axis=-1).sum())
    return count


@pytest.mark.parametrize("family", ["cladding", "curves"])
def test_the_tool_leans_away_from_what_stands_beside(doc, request, block, cell, family):
    part, make = _part(request, family)
    blind = api.result(api.make_toolpath(doc, make(doc, part, block, clearance="none"), cell))
    assert inside(blind) > 0
    clear = api.result(api.make_toolpath(doc, make(doc, part, block), cell))
    assert inside(clear) == 0
    assert clear.family == family and not any(issue.level == "error" for issue in clear.issues)
    leans = np.vstack([bead.tool for _, _, bead in clear])[:, 1]
    assert leans.min() < -0.1 and leans.max() < 1e-9  # away from the block, nowhere towards it


@pytest.mark.parametrize("family", ["cladding", "curves"])
def test_where_it_cannot_lean_far_enough_the_job_is_refused(doc, request, cell, block, family):
    part, make = _part(request, family)
    roof = doc.addObject("Part::Feature", "Roof")
    roof.Shape = Part.makeBox(120, 120, 5, App.Vector(-60, -60, 8))
    doc.recompute()
    toolpath = api.make_toolpath(doc, make(doc, part, roof), cell)
    found = api.issues(toolpath)[0]
    assert (toolpath.Status, found.level, found.code) == ("infeasible", "error", "CLEARANCE")
    with pytest.raises(InfeasibleError):
        api.make_joint_path(doc, toolpath, cell)
