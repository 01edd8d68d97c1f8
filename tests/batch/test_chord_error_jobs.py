# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job without a chord error gets one from the size of the part, and the report states it."""

import json

import Part
import pytest

JOB = """\
version: 1
name: bar
part: {file: bar.step}
strategy: {kind: KIND, layer_height: 2 mm}
"""


def reported(workshop, text):
    (workshop.folder / "bar.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("kind", ["solid", "auto"])
def test_the_report_tells_what_a_large_part_gets(workshop, kind):
    Part.makeBox(500, 20, 4).exportStep(str(workshop.folder / "bar.step"))
    text = JOB.replace("KIND", kind)
    report = reported(workshop, text)
    assert report["chord_error_mm"] == pytest.approx(0.05)
    (note,) = [issue for issue in report["issues"] if issue["code"] == "CHORD_ERROR"]
    assert note["level"] == "note" and "0.05 mm" in note["message"]
    report = reported(workshop, text.replace("2 mm}", "2 mm, chord_error: 0.01 mm}"))
    assert report["chord_error_mm"] == 0.01
    assert "CHORD_ERROR" not in [issue["code"] for issue in report["issues"]]
