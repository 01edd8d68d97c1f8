# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job with infeasible curved layers gets plane layers if the user allows it, like jobs with
`kind: auto`."""

import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from tests.batch.test_auto_jobs import tee

pytestmark = pytest.mark.any_version

ROBOT, TOOL = (
    "kuka-kr16-2",
    "tool-on-robot",
)  # this robot passes its singularity along curved layers of the T


@pytest.fixture
def coarse_tee(doc, monkeypatch):
    """Return a T as an object, and make its features in coarse layers."""
    make = api.make_feature_of
    coarse = {"layer_height": 8.0, "chord_error": 0.4, "bead_spacing": 6.0}
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *arguments, values, **named: make(*arguments, values={**coarse, **values}, **named),
    )
    tee_object = doc.addObject("Part::Feature", "Tee")
    tee_object.Shape = tee()
    return tee_object


def test_planes_are_laid_where_curved_layers_cannot_be(doc, coarse_tee, no_remedies):
    options = {
        "kind": "solid",
        "layers": "geodesic",
        "machine": ROBOT,
        "setup": TOOL,
        "process": {"bead_width": 6.0},
    }
    doc.UndoMode = 1
    _, feature, _, path = api.make_all(doc, coarse_tee, **options)
    assert (feature.Layers, path.Status) == ("geodesic", "infeasible")
    doc.undo()
    _, feature, toolpath, path, program = api.make_all(
        doc, coarse_tee, **options, layers_otherwise="planes"
    )
    assert feature.Layers == "planes" and {
        stage.Status for stage in (feature, toolpath, path, program)
    } == {"up to date"}
    doc.undo()  # all of it is one undo step
    assert doc.Objects == [coarse_tee]


def test_curved_layers_that_can_be_carried_out_stay(doc, coarse_tee):
    stages = api.make_all(
        doc,
        coarse_tee,
        kind="solid",
        layers="geodesic",
        process={"bead_width": 6.0},
        layers_otherwise="planes",
    )
    assert stages[1].Layers == "geodesic" and stages[3].Status == "up to date"


@pytest.mark.long  # 14 s; test_suited_cell.py searches cells of other jobs
def test_planes_have_the_cell_that_suits_them(doc, coarse_tee):
    """Curved layers of the T lean more than 30 deg and get a positioner; upright ones need none."""
    options = {
        "kind": "solid",
        "machine": ROBOT,
        "setup": TOOL,
        "max_from_vertical": "30 deg",
        "process": {"bead_width": 6.0, "travel_speed": 150.0},
    }
    curved = api.make_all(doc, coarse_tee, **options, layers="geodesic")
    assert curved[-1].Status == "infeasible" and curved[0].External != "none"
    planes = api.make_all(doc, coarse_tee, **options, layers="planes")
    instead = api.make_all(doc, coarse_tee, **options, layers="geodesic", layers_otherwise="planes")
    assert [stage.Status for stage in instead] == ["up to date"] * 5 and instead[
        1
    ].Layers == "planes"
    assert api.result(instead[0]) == api.result(planes[0]) and instead[0].External == "none"
    assert len(api.stages_of(doc)) == len(curved) + len(planes) + len(instead)


@pytest.mark.parametrize(
    ("kind", "layers", "where"),
    [
        ("revolution", "planes", "layers_otherwise"),
        ("solid", "plane", "strategy.layers"),
    ],
)
def test_layers_that_are_none_are_refused_before_anything_is_made(
    doc, coarse_tee, kind, layers, where
):
    with pytest.raises(InputError) as error:
        api.make_all(doc, coarse_tee, kind=kind, machine=ROBOT, layers_otherwise=layers)
    assert error.value.where == where and doc.Objects == [coarse_tee]
