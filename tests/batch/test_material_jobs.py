# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material files: their defaults, overrides of the job, errors in them, and layers from the
model."""

import json
import math
from pathlib import Path

import Part
import pytest

from freecad_am.batch.job import feature_sections
from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError

JOB = "part: {file: bar.step}\nstrategy: {kind: solid, layer_height: 2 mm}\n"
MINE = """\
name: ER70S-6, our own
source: lab book 7
density: 7.8
wire: {diameter: 1.0 mm, feed: 6.5 m/min}
gas: M20
temperature: 180
stand_off: 12 mm
travel_speed: 480 mm/min
speed_range: [5 mm/s, 14 mm/s]
schedules: {all: 2, contour: 3, fill: 4}
beads: own.csv
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "bar.step").write_text("only looked for")
    table = Path(feature_sections.FOLDER).parent / "beads" / "dai-2020.csv"
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "own.csv").write_bytes(table.read_bytes())
    return tmp_path


def read(folder, process, material=MINE, job_text=JOB):
    (folder / "sub" / "er70s-6.yaml").write_text(material, encoding="utf-8")
    (folder / "job.yaml").write_text(job_text + process, encoding="utf-8")
    return jobs.read_job(str(folder / "job.yaml"))


def test_a_material_fills_in_what_the_job_leaves_out(folder):
    process = read(folder, "process: {material: sub/er70s-6.yaml}\n").process
    assert (process.density, process.gas, process.temperature, process.stand_off) == (
        7.8,
        "M20",
        180.0,
        12.0,
    )
    assert (process.wire.diameter, process.wire.feed, process.travel_speed) == (
        1.0,
        pytest.approx(6500.0 / 60.0),
        8.0,
    )
    assert (process.material.name, process.material.source) == ("ER70S-6, our own", "lab book 7")
    assert (process.material.slowest, process.material.fastest) == (5.0, 14.0)
    assert process.bead_model == str(
        folder / "sub" / "own.csv"
    )  # its path starts at the material file
    schedules = {
        name: process.for_class(name).schedule for name in ("first_layer", "contour", "fill")
    }
    assert schedules == {"first_layer": 2, "contour": 3, "fill": 4}


def test_what_the_job_says_itself_wins(folder):
    process = read(
        folder,
        """\
process:
  material: sub/er70s-6.yaml
  density: 8
  gas: null
  wire: {diameter: 1.6 mm}
  bead_model: none
  schedule: 7
  classes: {contour: {schedule: 9}, fill: {lead: 5 deg}}
""",
    ).process
    assert (process.density, process.gas, process.bead_model, process.schedule) == (
        8.0,
        None,
        "none",
        7,
    )
    assert (process.wire.diameter, process.wire.feed) == (1.6, pytest.approx(6500.0 / 60.0))
    assert [process.for_class(name).schedule for name in ("contour", "fill", "closing")] == [
        9,
        4,
        7,
    ]
    assert process.of_class("fill").own_values()["lead"] == pytest.approx(math.radians(5.0))


@pytest.mark.parametrize("name", ["er2319", "er2319.yaml", "stainless"])
def test_materials_that_come_with_the_program(folder, name):
    process = read(folder, f"process: {{material: {name}}}\n").process
    assert process.bead_model == ("csw" if name == "stainless" else "li-2025")
    assert process.density == (7.9 if name == "stainless" else 2.84)
    assert "(20" in process.material.source and process.material.slowest < process.material.fastest
    assert feature_sections.built_in() == ["er2319", "stainless"]


def test_a_material_may_be_told_in_the_job(folder):
    process = read(
        folder, "process: {material: {name: clay, source: own, fastest: 20 mm/s}}\n"
    ).process
    assert (process.material.name, process.material.fastest, process.bead_model) == (
        "clay",
        20.0,
        "none",
    )


@pytest.mark.parametrize(
    ("change", "code", "where", "told"),
    [
        (("density: 7.8\n", ""), "BAD_VALUE", "density", "the material has no density"),
        (("source: lab book 7\n", ""), "BAD_VALUE", "source", "the material has no source"),
        (("density: 7.8", "density: -7.8"), "BAD_VALUE", "density", "more than 0 (line 3)"),
        (("density: 7.8", "density: 7.8 mm"), "BAD_UNIT", "density", "line 3"),
        (("density", "densty"), "UNKNOWN_KEY", "densty", "did you mean density?"),
        (("6.5 m/min}", "6.5 mm}"), "BAD_UNIT", "wire.feed", "speed"),
        (("diameter", "width"), "UNKNOWN_KEY", "wire.width", "diameter"),
        (("1.0 mm", "0 mm"), "BAD_VALUE", "wire.diameter", "more than 0"),
        (("feed: 6.5", "feed: 9.5"), "BAD_VALUE", "wire.feed", "108.3 to 108.3"),
        (
            ("[5 mm/s, 14 mm/s]", "[14 mm/s, 5 mm/s]"),
            "BAD_VALUE",
            "speed_range",
            "slower speed first",
        ),
        (("[5 mm/s, 14 mm/s]", "14 mm/s"), "BAD_VALUE", "speed_range", "[slowest, fastest]"),
        (("[5 mm/s, 14 mm/s]", "[7 mm/s, 9 kg]"), "BAD_UNIT", "speed_range", "line 9"),
        (
            (
                "480 mm/min\nspeed_range: [5 mm/s, 14 mm/s]",
                "40 mm/s\nspeed_range: [30 mm/s, 50 mm/s]",
            ),
            "BAD_VALUE",
            "beads",
            "5 to 15 mm/s",
        ),
        (("480 mm/min", "480 mm/s"), "BAD_VALUE", "travel_speed", "outside speed_range"),
        (("contour: 3", "contour: 0"), "BAD_VALUE", "schedules.contour", "from 1 to"),
        (("contour: 3", "rim: 3"), "UNKNOWN_KEY", "schedules.rim", "contour"),
        (("own.csv", "other.csv"), "NO_FILE", "other.csv", "calibration table"),
        ((MINE, ""), "EMPTY_FILE", "er70s-6.yaml", "source: and density:"),
        ((MINE, "- 1\n"), "BAD_FILE", "er70s-6.yaml", "give keys such as source and density"),
    ],
)
def test_what_is_wrong_with_a_material_file_is_told_in_its_words(folder, change, code, where, told):
    material_text = MINE.replace(*change)
    assert material_text != MINE
    with pytest.raises(InputError) as caught:
        read(folder, "process: {material: sub/er70s-6.yaml}\n", material_text)
    assert caught.value.code == code
    assert where in caught.value.where and told in caught.value.message


def test_an_unknown_material_names_those_there_are(folder):
    with pytest.raises(InputError, match="er2319, stainless") as caught:
        read(folder, "process: {material: unobtainium}\n")
    assert caught.value.code == "NO_FILE" and "process.material" in caught.value.where


def test_features_share_the_material(folder):
    job = read(
        folder,
        "process: {material: stainless}\nfeatures:\n  - {name: a}\n"
        "  - {name: b, process: {travel_speed: 7}}\n",
    )
    assert [feature.process.density for feature in job.features] == [
        7.9,
        7.9,
    ] and job.process.density == 7.9
    assert [feature.process.bead_model for feature in job.features] == ["csw", "csw"]


M, P, T = 85.550, 52.742, -1.7542  # Dai 2020, table 1 refitted (errata): width
HIGH = "part: {file: bar.step}\nstrategy: {kind: solid, layer_height: HIGH, bead_spacing: auto, fill: lines}\n"
AUTO = HIGH.replace("HIGH", "auto")


def test_layers_and_spacing_that_the_model_makes(folder):
    """The layer height is that of a straight bead of this width, by the mean of the table's three
    radii without the fit, and the spacing is the width that the wire fills."""
    job = read(folder, "process: {bead_model: csw, bead_width: 9.5 mm}\n", job_text=AUTO)
    speed = (M / (9.5 - T)) ** 3  # mm/min
    wire = math.pi / 4.0 * 1.2**2 * 6500.0 / speed
    assert (
        2.2 < job.strategy.layer_height < 3.1
    )  # the table's beads of 9.22 to 9.86 mm have 2.5 to 2.7
    assert job.strategy.bead_spacing * job.strategy.layer_height == pytest.approx(wire, rel=2e-4)


@pytest.mark.parametrize(
    ("process", "rest", "where", "told"),
    [
        ("", AUTO, "strategy.layer_height", "process.bead_model"),
        ("", HIGH.replace("HIGH", "2 mm"), "strategy.bead_spacing", "process.bead_model"),
        (
            "process: {bead_model: csw, bead_width: 9.5 mm}\n",
            HIGH.replace("HIGH", "0.5 mm"),
            "strategy.bead_spacing",
            "use higher layers",
        ),
        (
            "process: {bead_model: csw}\n",
            HIGH.replace("HIGH", "0 mm"),
            "strategy.layer_height",
            "more than 0",
        ),
    ],
)
def test_what_the_model_cannot_say(folder, process, rest, where, told):
    with pytest.raises(InputError) as caught:
        read(folder, process, job_text=rest)
    assert (
        caught.value.code == "BAD_VALUE"
        and where in caught.value.where
        and told in caught.value.message
    )


def test_a_slowest_speed_above_the_fastest(workshop):
    Part.makeCylinder(60.0, 9.0).exportStep(str(workshop.folder / "tube.step"))
    (workshop.folder / "tube.yaml").write_text(
        "part: {file: tube.step, faces: [Face1]}\nprocess: {material: {slowest: 9 mm/s, fastest: 5 mm/s}}\n"
    )
    command = workshop.run("plan", "tube.yaml", "-o", "out", "--no-page")
    assert (
        command.status == 2
        and "error[BAD_VALUE]" in command.err
        and "9 mm/s is above the fastest speed, 5 mm/s" in command.err
    )


def test_a_job_with_a_material_from_file_to_report(workshop):
    """The rings of a tube have the speeds of the model, above the material's maximum: the worst is
    reported."""
    Part.makeCylinder(60.0, 9.0).exportStep(str(workshop.folder / "tube.step"))
    (workshop.folder / "slow.yaml").write_text(
        "source: own\ndensity: 7.9\nbeads: csw\nspeed_range: [5 mm/s, 6 mm/s]\n"
    )
    job = (
        "part: {file: tube.step, faces: [Face1]}\nstrategy: {layer_height: auto, chord_error: 0.1 mm}\n"
        "process: {material: NAME, bead_width: 9.5 mm}\n"
    )
    issues = {}
    for name in ("stainless", "slow.yaml"):
        (workshop.folder / "tube.yaml").write_text(job.replace("NAME", name))
        command = workshop.run("plan", "tube.yaml", "-o", "out")
        assert command.status == 0, command.err
        issues[name] = json.loads(
            (workshop.folder / "out" / "report.json").read_text(encoding="utf-8")
        )
        page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
        assert "<td>material</td>" in page
    good, slow = issues["stainless"], issues["slow.yaml"]
    assert (
        good["process"]["material"]["name"] == "Stainless steel"
        and "Dai" in good["process"]["material"]["source"]
    )
    assert good["process"]["wire"]["feed_mm_s"] == pytest.approx(6500.0 / 60.0)
    assert "MATERIAL_SPEED" not in {issue["code"] for issue in good["issues"]}
    # with rings this curved, the height stays near that of the straight bead: a drift of a few
    # hundredths over the layers
    assert abs(good["beads"]["layers"][-1]["drift_mm"]) < 0.1 * good["counts"]["layers"]
    (issue,) = [issue for issue in slow["issues"] if issue["code"] == "MATERIAL_SPEED"]
    assert issue["level"] == "warning" and "slow at 5 to 6 mm/s" in issue["message"]
