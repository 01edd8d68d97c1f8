# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `inspect` writes tables, data and a page from files of measured points, a job and a
saved document."""

import csv
import json
import re
import xml.dom.minidom

import pytest

from freecad_am.batch import cli

SETTINGS = ["--set", "probe_radius=1.5", "tolerance=0.1 mm", "heights=15 25 35"]


@pytest.fixture
def examples(root):
    return root / "resources" / "examples"


@pytest.fixture
def spheres(examples, tmp_path):
    """Return two files with fewer points than the example's."""
    lines = (examples / "inspection" / "hemisphere-synthetic.csv").read_text().splitlines()
    paths = []
    for number in (0, 1):
        path = tmp_path / f"sphere {number + 1}.csv"
        path.write_text("\n".join([*lines[:3], *lines[3 + number :: 5]]))
        paths.append(str(path))
    return paths


def test_several_parts_have_a_table_with_mean_and_standard_deviation(
    examples, spheres, tmp_path, capfd
):
    out = tmp_path / "out"
    assert (
        cli.main(
            [
                "inspect",
                str(examples / "hemisphere.yaml"),
                "--measured",
                *spheres,
                *SETTINGS,
                "-o",
                str(out),
            ]
        )
        == 0
    )
    printed = capfd.readouterr().out.split("\n")
    assert printed[:-1] == sorted(str(path) for path in out.iterdir())
    assert {path.name for path in out.iterdir()} == {
        "inspection.csv",
        "inspection.json",
        "inspection.html",
        "inspection.FCStd",
        "sphere 1-deviations.csv",
        "sphere 2-deviations.csv",
    }
    rows = {
        row[0]: row[1:] for row in csv.reader((out / "inspection.csv").read_text().splitlines())
    }
    assert rows["figure"] == ["unit", "sphere 1", "sphere 2", "mean", "standard deviation"]
    unit, first_value, second_value, mean, deviation = rows["Spherical defect"]
    assert unit == "mm" and float(mean) == pytest.approx(
        0.5 * (float(first_value) + float(second_value)), abs=2e-6
    )
    assert float(deviation) == pytest.approx(
        abs(float(first_value) - float(second_value)) / 2**0.5, abs=2e-6
    )
    data = json.loads((out / "inspection.json").read_text())
    assert data["version"] == 1 and [
        len(inspection["circles"]) for inspection in data["inspections"]
    ] == [3, 3]
    assert data["inspections"][0]["sphericity_mm"]["minimum_zone"] == pytest.approx(
        float(first_value), abs=1e-6
    )
    page = (out / "inspection.html").read_text()
    xml.dom.minidom.parseString(
        page[page.index("<body>") : page.index("</html>")].replace("&ensp;", "")
    )
    assert (
        page.count("<svg") == 4
        and "sphere 2" in page
        and "src=" not in page
        and not re.search(r'href="(?!#)', page)
    )

    saved = str(out / "inspection.FCStd")
    again = tmp_path / "again"
    command = [
        "inspect",
        saved,
        "--measured",
        spheres[0],
        *SETTINGS,
        "-o",
        str(again),
        "--object",
        "Feature",
    ]
    assert cli.main(command) == 0
    repeated = json.loads((again / "inspection.json").read_text())["inspections"][0]
    assert repeated["deviation_mm"] == pytest.approx(data["inspections"][0]["deviation_mm"])


POINTS = "inspection/hemisphere-synthetic.csv"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["hemisphere.yaml"], "--measured"),
        (["hemisphere.yaml", "--measured", "nowhere.csv"], "cannot be read"),
        (["hemisphere.yaml", "--measured", POINTS, "--set", "tolerance"], "not a setting"),
        (["hemisphere.yaml", "--measured", POINTS, "--set", "colour=3"], "colour is not known"),
        (["hemisphere.yaml", "--measured", POINTS, "--object", "X"], "of an FCStd document"),
        (["nowhere.FCStd", "--measured", POINTS], "the file does not exist"),
    ],
)
def test_bad_input_is_told_and_nothing_is_written(
    examples, tmp_path, capfd, monkeypatch, words, told
):
    monkeypatch.chdir(examples)
    assert cli.main(["inspect", *words, "-o", str(tmp_path / "out")]) == 2
    message = capfd.readouterr().err
    assert told in message and message.startswith("error[") and message.count("\n") == 1
    assert not (tmp_path / "out").exists()
