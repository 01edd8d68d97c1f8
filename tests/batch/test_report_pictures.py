# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report has pictures of the job's values, and a note instead if matplotlib is missing."""

import json
import os
import re
from xml.etree import ElementTree

TITLES = (
    "q1",
    "q6 (endless)",
    "Joint speeds while depositing",
    "Joint accelerations while depositing",
    "Joint jerks while depositing",
    "Condition of the Jacobian (0 is singular)",
    "Speed along the path",
    "Deposit rate",
    "Deposited mass",
    "Distance to the previous layer (requested: 4 mm)",
)


def pictures(page):
    drawings = [
        ElementTree.fromstring(text) for text in re.findall(r"<svg.*?</svg>", page, re.DOTALL)
    ]
    return {picture.get("aria-label"): picture for picture in drawings}


def test_the_report_has_them(workshop):
    workshop.write_job()
    assert workshop.launch("plan", "cup.yaml").status == 0
    files = workshop.files()
    page = files["report.html"].decode()
    drawings = pictures(page)
    assert set(TITLES) <= set(drawings) and len(drawings) >= 14 and "matplotlib" not in page
    texts = {
        title: [node.text for node in picture.iter() if node.tag.endswith("text")]
        for title, picture in drawings.items()
    }
    assert "limits -185 to 185 deg" in texts["q1"]
    assert "layer 0" in texts["q1"] and json.loads(files["report.json"])["counts"]["layers"] > 5
    assert workshop.launch("plan", "cup.yaml", "-o", "again").status == 0
    again = pictures(workshop.files("again")["report.html"].decode())
    assert all(
        ElementTree.tostring(again[title]) == ElementTree.tostring(drawings[title])
        for title in TITLES
    )


def test_without_matplotlib_the_report_says_so(workshop, monkeypatch):
    missing = workshop.folder / "missing" / "matplotlib"
    missing.mkdir(parents=True)
    (missing / "__init__.py").write_text("raise ImportError('not installed')\n", encoding="utf-8")
    monkeypatch.setenv(
        "PYTHONPATH",
        os.pathsep.join(filter(None, (str(missing.parent), os.environ.get("PYTHONPATH")))),
    )
    workshop.write_job()
    command = workshop.launch("plan", "cup.yaml")
    assert command.status == 0, command.err
    page = workshop.files()["report.html"].decode()
    assert (
        page.count("matplotlib is not installed") == 1
        and "largest share of the speed limit" in page
    )
    assert not pictures(page)
    assert "<figure></figure>" not in page and '<div class="grid"></div>' not in page
