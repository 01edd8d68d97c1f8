# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding by clicks: faces are selected, previewed and covered."""

import math

import FreeCAD as App
import numpy as np
import Part
import pytest
from pivy import coin

from freecad_am import api
from freecad_am.gui.nodes.wall import face_mesh
from freecad_am.objects.shapes.bodies import snapshot_of

pytestmark = pytest.mark.usefixtures("person")


def test_the_panel_previews_and_covers_a_face(person):
    doc = App.newDocument("Cladding")
    block = doc.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 30, 20)
    doc.recompute()
    person.select(block, "Face6")
    person.click("RoboticAM_Cladding")
    panel = person.panel("RoboticAM_CladdingFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 face, 12 cm²" in preview_text.text(), "the preview", 30)
    person.type(panel, "Layers", "2")
    person.screenshot("cladding_panel")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Source, feature.Layers) == ("up to date", (block, ["Face6"]), 2)
    assert feature.ViewObject.Proxy.icon == "cladding"
    assert len(api.result(api.make_toolpath(doc, feature)).layers) == 2


def drawn_triangles(obj):
    """Return the triangles of an object as FreeCAD draws it: (m, 3, 3), each with its corners in
    order of their numbers."""
    search = coin.SoSearchAction()
    search.setType(coin.SoCoordinate3.getClassTypeId())
    search.apply(obj.ViewObject.RootNode)
    points = np.array([tuple(vertex) for vertex in search.getPath().getTail().point.getValues()])
    search.reset()
    search.setType(coin.SoIndexedFaceSet.getClassTypeId())
    search.setSearchingAll(True)
    search.apply(obj.ViewObject.RootNode)
    corners = np.array(list(search.getPath().getTail().coordIndex.getValues())).reshape(-1, 4)[
        :, :3
    ]
    return points[corners]


def test_a_bent_face_is_tinted_by_the_triangles_that_are_on_screen(person):
    """Other triangles would be partly in front of the drawn ones and partly behind them."""
    doc = App.newDocument("Cladding")
    feature = doc.addObject("Part::Feature", "Part")
    feature.Shape = Part.makeTorus(60, 25).cut(
        Part.makeBox(200, 200, 100, App.Vector(-100, -100, -100))
    )
    doc.recompute()
    person.look()
    face = max(range(len(feature.Shape.Faces)), key=lambda k: feature.Shape.Faces[k].Area)
    points, corners = face_mesh(snapshot_of(feature), [f"Face{face + 1}"])
    assert len(corners) > 100
    drawn = {
        tuple(sorted(map(tuple, np.round(triangle, 3)))) for triangle in drawn_triangles(feature)
    }
    assert {
        tuple(sorted(map(tuple, np.round(corner_set, 3)))) for corner_set in points[corners]
    } <= drawn
    area = (
        0.5
        * np.linalg.norm(
            np.cross(*np.diff(points[corners], axis=1).transpose(1, 0, 2)), axis=1
        ).sum()
    )
    assert math.isclose(area, feature.Shape.Faces[face].Area, rel_tol=0.02)  # the whole face
