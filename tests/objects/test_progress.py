# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reported progress of a toolpath never decreases, and continues during every step that may
take long."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.objects.planned.toolpaths import CHECKED, CLEARING, STRATEGY
from freecad_am.objects.work import progress


def leaning(doc):
    """Return a bar that leans far over the platform, whose curved layers tilt the nozzle towards
    its surroundings."""
    bar = doc.addObject("Part::Feature", "Bar")
    foot, arm = (
        Part.makeBox(16, 16, 14, App.Vector(-40, 0, 0)),
        Part.makeBox(30, 16, 6, App.Vector(-32, 0, 8)),
    )
    bar.Shape = foot.fuse(arm).removeSplitter()
    doc.recompute()
    return [
        api.make_solid_feature(
            doc, bar, layers="geodesic", layer_height=2, bead_spacing=4, chord_error=0.2
        )
    ]


def several(doc):
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1 = 30, 0
    ring = doc.addObject("Part::Cylinder", "Post")
    ring.Radius, ring.Height, ring.Placement.Base = 4, 12, App.Vector(60, 0, 0)
    doc.recompute()
    return [
        api.make_feature(doc, ball, layer_height=3),
        api.make_solid_feature(doc, ring, layer_height=3, bead_spacing=3),
    ]


@pytest.mark.parametrize("made", [leaning, several])
def test_it_rises(doc, made):
    features, reported = made(doc), []
    cell = api.make_cell(doc, limits="paper")
    with progress.told_to(lambda share, text: reported.append((share, str(text)))):
        api.make_toolpath(doc, features, cell)
    shares = np.array([share for share, _ in reported])
    assert (np.diff(shares) >= 0.0).all() and shares[0] >= 0.0 and shares[-1] <= 1.0, reported


def test_curved_layers_and_tilts_move_on(doc):
    (feature,), shares = leaning(doc), []
    with progress.told_to(lambda share, text: shares.append((share, str(text)))):
        toolpath_result = api.result(api.make_toolpath(doc, feature, api.make_cell(doc)))
    layers = [(share, int(text.rsplit(" ", 1)[1])) for share, text in shares if " layer " in text]
    last_layer = max(number for _, number in layers)
    assert last_layer + 1 == len(toolpath_result.layers) and last_layer > 8
    for share, number in layers:
        assert abs(share - STRATEGY * number / (last_layer + 1)) < STRATEGY / last_layer, (
            share,
            number,
        )  # within one layer
    clearing = {share for share, text in shares if text == CLEARING}
    assert len(clearing) > 5 and min(clearing) >= STRATEGY and max(clearing) <= CHECKED
