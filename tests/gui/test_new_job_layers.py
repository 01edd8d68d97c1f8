# SPDX-License-Identifier: LGPL-2.1-or-later
"""If curved layers that New Job proposes are infeasible, it makes planes and says so; layers chosen
by the user stay."""

import pytest

from freecad_am import api
from tests.batch.test_auto_jobs import tee


@pytest.mark.parametrize("chosen", [False, True])
def test_planes_are_laid_where_curved_layers_that_were_proposed_cannot_be(
    person, hand, doc, monkeypatch, chosen
):
    make = api.make_feature_of
    coarse = {"layer_height": 8.0, "chord_error": 0.4, "bead_spacing": 6.0}
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *arguments, values, **named: make(*arguments, values={**coarse, **values}, **named),
    )
    tee_object = doc.addObject("Part::Feature", "Tee")
    tee_object.Shape = tee()
    doc.recompute()
    person.select(tee_object)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    kind = person.field(panel, "Kind")
    person.until(lambda: kind.currentData() == "geodesic", "the proposal", 20)
    if chosen:
        for choice_ in ("solid", "geodesic"):
            person.choose(panel, "Kind", choice_)
            kind.activated.emit(kind.currentIndex())
        person.until(
            lambda: "as you chose" in person.field(panel, "reason").text(), "that it was chosen", 5
        )
    hand.enter(panel, "Machine", "kuka-kr16-2")
    console_length, steps = len(person.console()), doc.UndoCount
    person.press("Ok")
    person.panel_closed()
    _, feature, _, path = api.stages_of(doc)[:4]
    console_text, status = (
        person.console()[console_length:],
        person.window.statusBar().currentMessage(),
    )
    assert doc.UndoCount == steps + 1
    if chosen:
        assert (feature.Layers, path.Status) == (
            "geodesic",
            "infeasible",
        ) and "Joint path is infeasible" in status
    else:
        assert (feature.Layers, path.Status) == ("planes", "up to date"), console_text
        assert "layers: planes, because geodesic layers end with " in console_text
        assert status.startswith("Planar layers are used, as curved layers were infeasible. ")
