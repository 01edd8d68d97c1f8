# SPDX-License-Identifier: LGPL-2.1-or-later
"""Features without a chord error get one from size and bead; given and saved values stay."""

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.strategy import scaled


@pytest.fixture
def block():
    document = App.newDocument()
    block_object = document.addObject("Part::Feature", "Block")

    def sized(length):
        block_object.Shape = Part.makeBox(length, 20, 4)
        return block_object

    yield sized
    App.closeDocument(document.Name)


def codes(feature):
    return [issue.code for issue in api.issues(feature)]


@pytest.mark.parametrize(
    ("extent", "bead", "chord_error"),
    [
        (0.0, 5.0, 0.01),
        (250.0, 5.0, 0.01),
        (388.0, 5.0, 0.04),
        (610.0, 5.0, 0.05),
        (610.0, 15.0, 0.08),
        (610.0, 0.5, 0.01),
        (float("inf"), float("inf"), 0.01),
    ],
)
def test_it_grows_with_part_and_bead(extent, bead, chord_error):
    assert scaled(extent, bead) == chord_error


def test_small_parts_keep_it_and_large_ones_say_so(block):
    large_block = block(250)
    small = api.make_solid_feature(large_block.Document, large_block, layer_height=2)
    assert float(small.ChordError) == 0.01 and "CHORD_ERROR" not in codes(small)
    large = api.make_solid_feature(large_block.Document, block(500), layer_height=2)
    assert float(large.ChordError) == pytest.approx(0.05) and "CHORD_ERROR" in codes(large)
    assert api.result(api.make_toolpath(large_block.Document, large)).chord_error == pytest.approx(
        0.05
    )
    wall = api.make_surface_feature(large_block.Document, large_block, ["Face1"], layer_height=1)
    assert float(wall.ChordError) == 0.01, "the chosen face is 20 mm long"


def test_a_datum_plane_in_the_container_does_not_count(block):
    """FreeCAD includes the unbounded face of a datum plane in the shape of a container."""
    block_object = block(100)
    block_object.Shape = Part.Compound([block_object.Shape, Part.Plane().toShape()])
    feature = api.make_solid_feature(block_object.Document, block_object, layer_height=2)
    assert float(feature.ChordError) == 0.01 and "CHORD_ERROR" not in codes(feature)


@pytest.mark.parametrize("given", ["keyword", "dataclass"])
def test_a_given_value_stays(block, given):
    block_object = block(500)
    options = (
        {"chord_error": 0.01}
        if given == "keyword"
        else {"strategy": SolidParameters(chord_error=0.01)}
    )
    feature = api.make_solid_feature(block_object.Document, block_object, **options)
    assert float(feature.ChordError) == 0.01 and "CHORD_ERROR" not in codes(feature)
    block_object.Shape = Part.makeBox(900, 20, 4)
    api.recompute(feature)
    assert float(feature.ChordError) == 0.01


def test_a_default_dataclass_leaves_it_out(block):
    block_object = block(500)
    feature = api.make_solid_feature(
        block_object.Document, block_object, strategy=SolidParameters(layer_height=2)
    )
    assert float(feature.ChordError) == pytest.approx(0.05)


def test_turning_triangles_into_view_changes_nothing(block):
    block_object = block(10)
    block_object.Shape = Part.makeCylinder(130, 4)
    feature = api.make_solid_feature(block_object.Document, block_object, layer_height=2)
    shape = block_object.Shape.copy()
    shape.tessellate(20.0)
    block_object.Shape = shape
    second_feature = api.make_solid_feature(block_object.Document, block_object, layer_height=2)
    assert float(feature.ChordError) == float(second_feature.ChordError) == 0.01
