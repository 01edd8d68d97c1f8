# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding in documents, made by the macro interface, saved, opened and changed; formulas give the
positions of a few layers."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError

COARSE = {"layer_height": 2.0, "chord_error": 0.1, "bead_spacing": 6.0}


@pytest.fixture
def cone(doc):
    obj = doc.addObject("Part::Feature", "Cone")
    obj.Shape = Part.makeCone(30, 18, 40)
    doc.recompute()
    side = next(
        f"Face{k}"
        for k, face in enumerate(obj.Shape.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCone"
    )
    return obj, side


def heights(toolpath):
    """Return the distance (n,) in mm of the points of a toolpath from the cone, and their expected
    distance in layer heights (n,)."""
    points = np.vstack([bead.points for _, _, bead in toolpath])
    layer = np.concatenate([np.full(len(bead), i) for i, _, bead in toolpath])
    slope = np.arctan(12.0 / 40.0)
    distances = (np.hypot(points[:, 0], points[:, 1]) - 30.0) * np.cos(slope) + points[
        :, 2
    ] * np.sin(slope)
    return distances, 2.0 * layer


def test_a_feature_is_saved_and_changed(doc, cone, tmp_path):
    obj, side = cone
    feature = api.make_cladding_feature(doc, obj, [side], layers=2, fill="spiral", **COARSE)
    assert (feature.Status, feature.CladFaces) == ("up to date", [side])
    assert feature.CladArea.Value == pytest.approx(obj.Shape.getElement(side).Area, rel=1e-3)
    toolpath = api.make_toolpath(doc, feature)
    distances, layer_heights = heights(api.result(toolpath))
    np.testing.assert_allclose(distances, layer_heights, atol=1e-6)
    assert (
        api.result(toolpath).family == "cladding" and api.result(toolpath).checks.unsupported == 0.0
    )
    doc.saveAs(str(tmp_path / "clad.FCStd"))
    App.closeDocument(doc.Name)
    again = App.openDocument(str(tmp_path / "clad.FCStd"))
    try:
        same = again.getObject(feature_name := "Feature")
        assert same.Status == "up to date", feature_name
        assert len(api.result(again.getObject("Toolpath")).layers) == 2
        api.change(same, layers=3)
        api.recompute(again)
        distances, layer_heights = heights(api.result(again.getObject("Toolpath")))
        np.testing.assert_allclose(distances, layer_heights, atol=1e-6)
        assert layer_heights.max() == 4.0
    finally:
        App.closeDocument(again.Name)


def test_a_closed_mesh_and_an_edge_are_refused(doc, cone):
    import Mesh

    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = Mesh.Mesh(cone[0].Shape.tessellate(0.5))
    for source, names, code in ((scan, [], "NO_FACES"), (cone[0], ["Edge1"], "BAD_FACES")):
        with pytest.raises(InputError) as error_info:
            api.make_cladding_feature(doc, source, names, **COARSE)
        assert error_info.value.code == code
