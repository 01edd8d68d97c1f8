# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work on a large layer reports often enough to be cancelled at once: little is done between two reports,
and every report ends the work if it raises."""

import FreeCAD as App
import numpy as np
import Part
import pytest
import shapely.geometry
import shapely.ops

from freecad_am import api
from freecad_am.brep.shapes import off_part
from freecad_am.core.geometry.regions import region as region_module
from freecad_am.core.geometry.regions.region import along
from freecad_am.core.progress import pulse_each, pulsing
from freecad_am.core.strategies.solids import filling, plan
from freecad_am.objects.work import progress

ISLANDS = 12


class Stopped(BaseException):
    """Raised by a listener to cancel."""


@pytest.fixture
def feature(doc):
    """Return a layer of islands that all differ, and a feature of it."""
    part = doc.addObject("Part::Feature", "Islands")
    part.Shape = Part.makeCompound(
        [
            Part.makeBox(8 + 0.3 * k, 7, 2, App.Vector(20 * (k % 4), 12 * (k // 4), 0))
            for k in range(ISLANDS)
        ]
    )
    doc.recompute()
    return api.make_solid_feature(
        doc, part, layer_height=2, bead_spacing=3, chord_error=0.2, fill="zigzag", walls=1
    )


def test_little_is_done_between_two_reports(doc, feature, monkeypatch):
    """Regions, beads and solids are done one by one."""
    done, most = {}, {}

    def count(module, name):
        function = getattr(module, name)

        def counted(*arguments, **options):
            done[name] = done.get(name, 0) + 1
            most[name] = max(most.get(name, 0), done[name])
            return function(*arguments, **options)

        monkeypatch.setattr(module, name, counted)

    for module, name in (
        (filling, "fill"),
        (filling, "adapt_lines"),
        (plan.BeadMaker, "bead_of"),
        (off_part, "_by_kernel"),
        (off_part.Search, "signed"),
    ):
        count(module, name)
    with progress.told_to(lambda share, text: done.clear()):
        toolpath = api.result(api.make_toolpath(doc, feature))
    assert len(toolpath.layers[0].beads) >= ISLANDS
    assert set(most) == {"fill", "adapt_lines", "bead_of", "_by_kernel", "signed"}
    assert set(most.values()) == {1}


def test_every_report_can_cancel(doc, feature):
    reports = []
    with progress.told_to(lambda share, text: reports.append(share)):
        toolpath = api.make_toolpath(doc, feature)
    assert len(reports) > 10 * ISLANDS and (np.diff(reports) >= 0.0).all()
    doc.removeObject(toolpath.Name)
    for limit in np.linspace(0, len(reports) - 1, 8).astype(int).tolist():
        heard = _cancelled(doc, feature, limit)
        assert len(heard) == limit + 1


def _cancelled(doc, feature, limit):
    """Return the reports until a listener cancels at one of them, by its number."""
    heard = []

    def listen(share, text):
        heard.append(share)
        if len(heard) > limit:
            raise Stopped

    with pytest.raises(Stopped), progress.told_to(listen):
        api.make_toolpath(doc, feature)
    return heard


def test_nested_work_repeats_the_last_report():
    heard = []
    with progress.told_to(lambda share, text: heard.append((share, text))):
        list(pulse_each(range(3)))
        assert heard == []
        progress.report(0.25, "cutting")
        with progress.one_of(1, 2, 0.0, 1.0):
            list(pulse_each(range(5), step=2))
        list(pulse_each(range(2)))
    assert heard == [(0.25, "cutting")] * 6
    list(pulse_each(range(2)))
    assert len(heard) == 6


@pytest.mark.parametrize("most", [7, 40])
def test_large_unions_are_made_in_blocks(monkeypatch, most):
    """The union of many bands is that of one call of the library."""
    rng = np.random.default_rng(most)
    starts = rng.uniform(0.0, 60.0, (400, 2))
    lines = [(np.stack([start, start + rng.uniform(-6.0, 6.0, 2)]), False) for start in starts]
    halves = rng.uniform(0.3, 1.5, len(lines))
    expected = shapely.ops.unary_union(
        [
            shapely.geometry.LineString(line).buffer(half, 64)
            for (line, _), half in zip(lines, halves)
        ]
    )
    monkeypatch.setattr(region_module, "MOST_UNITED", most)
    pulses = []
    with pulsing(lambda: pulses.append(None)):
        united = along(lines, halves, 1e-3)
    assert len(pulses) > len(lines) / most
    total = shapely.ops.unary_union([region.shape for region in united])
    assert total.symmetric_difference(expected).area < 0.003 * expected.area  # chords of arcs
