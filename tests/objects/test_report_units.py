# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window's report uses the units of its scheme; a command's report is metric."""

import json
import re

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.report import of_document

IMPERIAL = 3


@pytest.fixture
def toolpath():
    document = App.newDocument("Units")
    cup = document.addObject("Part::Feature", "Cup")
    cup.Label = "Cup 5 mm"
    cup.Shape = Part.makeCylinder(50.8, 60.0).cut(Part.makeCylinder(45.8, 60.0))
    document.recompute()
    feature = api.make_feature(document, cup, layer_height=5)
    yield api.make_toolpath(document, feature)
    App.Units.setSchema(0)
    App.closeDocument(document.Name)


def page_of(toolpath, monkeypatch, window, scheme):
    App.Units.setSchema(scheme)
    monkeypatch.setattr(of_document, "window_is_open", lambda: window)
    page = of_document.reported(toolpath)()
    page = re.sub(r"(?s)<h2>Time taken.*?</table>", "", page)  # the seconds differ each time
    facts = json.loads(re.search(r'id="path-facts">(.*?)</script>', page)[1])
    return facts, re.sub(
        r"(?s)<script.*?</script>|<style.*?</style>|<metadata.*?</metadata>", "", page
    )


def test_the_window_s_report_follows_the_scheme(toolpath, monkeypatch):
    facts, metric = page_of(toolpath, monkeypatch, True, 0)
    assert facts["length"] == [1.0, "mm"] and re.search(r"[\d.]+ cm³", metric)
    facts, page = page_of(toolpath, monkeypatch, True, IMPERIAL)
    assert facts["length"] == [pytest.approx(1 / 25.4), "in"]
    speeds = [column for column in facts["columns"] if column["name"] == "speed"]
    assert [column["unit"] for column in speeds] == ["in/min"]
    metric_texts = re.findall(r"[^<>]*\d\s*(?:mm|cm³|cm3|mm/s|g|m)\b[^<>]*", page)
    assert [text for text in metric_texts if "Cup 5 mm" not in text] == []
    cubic = float(re.search(r"deposit, ([\d.]+) cm³", metric)[1])
    assert float(re.search(r"deposit, ([\d.]+) in³", page)[1]) == pytest.approx(
        cubic / 16.387064, rel=1e-3
    )


def test_the_report_of_a_command_is_metric_in_every_scheme(toolpath, monkeypatch):
    metric_page = page_of(toolpath, monkeypatch, False, 0)[1]
    second = page_of(toolpath, monkeypatch, False, IMPERIAL)[1]

    def remove_ids(page):
        return re.sub(r"(?s)<svg.*?</svg>", "", page)

    assert remove_ids(metric_page) == remove_ids(second)
