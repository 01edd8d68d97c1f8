# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters follow a spreadsheet through the macro interface."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError


@pytest.fixture
def sheet(doc, part):
    sheet_object = doc.addObject(
        "App::FeaturePython", "Sheet"
    )  # this object replaces a spreadsheet
    sheet_object.addProperty("App::PropertyLength", "height")
    sheet_object.addProperty("App::PropertyInteger", "count")
    sheet_object.height = 10
    return sheet_object


def test_a_parameter_follows_an_expression_until_it_is_given_a_value(doc, part, sheet):
    feature = api.make_feature(doc, part, layer_height="=Sheet.height / 2")
    toolpath = api.make_toolpath(doc, feature, travel_speed="=600 mm/min")
    assert (feature.LayerHeight.Value, toolpath.Layers, toolpath.TravelSpeed.Value) == (
        5.0,
        15,
        10.0,
    )
    assert dict(feature.ExpressionEngine) == {"LayerHeight": "Sheet.height / 2"}
    sheet.height = 20
    doc.recompute()
    assert (feature.LayerHeight.Value, feature.Status, toolpath.Status) == (
        10.0,
        "up to date",
        "up to date",
    )
    assert toolpath.Layers < 10
    api.change(feature, layer_height=7)
    assert feature.ExpressionEngine == [] and feature.LayerHeight.Value == 7.0
    doc.recompute()
    assert feature.LayerHeight.Value == 7.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("=", "not understood"),
        ("=Sheet.heigth", "not understood"),
        ("=Sheet.height + 1 deg", "not understood"),
        ("=90 deg", "is an angle; give a length"),
        ("=0 mm * Sheet.height / 1 mm", "more than 0 mm"),
        ("=Sheet.Label", "not a number"),
    ],
)
def test_a_wrong_expression_is_told_and_changes_nothing(doc, part, sheet, text, told):
    doc.UndoMode = 1
    feature = api.make_feature(doc, part, layer_height=5)
    with pytest.raises(InputError, match=told) as caught:
        api.change(feature, layer_height=text)
    assert caught.value.where == "strategy.layer_height" and feature.ExpressionEngine == []
    assert (feature.LayerHeight.Value, feature.Status) == (5.0, "up to date")


def test_a_parameter_cannot_follow_itself_and_words_follow_nothing(doc, part):
    doc.UndoMode = 1
    feature = api.make_feature(doc, part, layer_height=5)
    with pytest.raises(InputError, match="not understood"):
        api.change(feature, layer_height="=Feature.LayerHeight * 2")
    with pytest.raises(InputError, match="cannot follow"):
        api.change(feature, spacing="=Sheet.height")
    assert feature.ExpressionEngine == [] and feature.LayerHeight.Value == 5.0
    assert App.ActiveDocument is doc


def test_an_expression_that_lost_what_it_follows_is_told_until_it_is_mended(doc, part, sheet):
    feature = api.make_feature(doc, part, layer_height="=Sheet.height / 2")
    toolpath = api.make_toolpath(doc, feature)
    doc.removeObject("Sheet")
    doc.recompute()
    assert feature.Status == "failed" and toolpath.Status != "up to date"
    assert feature.Message.startswith(
        "LayerHeight follows the expression Sheet.height / 2, which no longer gives a value"
    )
    with pytest.raises(InputError, match="no longer gives a value"):
        api.recompute(feature)
    api.change(feature, layer_height=7)
    doc.recompute()
    assert (feature.Status, toolpath.Status, feature.Message) == ("up to date", "up to date", "")
