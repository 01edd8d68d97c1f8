# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of the path in the page, decoded independently, are the rows of waypoints.csv. The page
loads nothing, and no other script may run in it."""

import base64
import csv
import hashlib
import json
import math
import re
import struct

import numpy as np
import pytest

from freecad_am.report.viewer_3d import columns
from tests.batch.conftest import JOB, Workshop, make_cup

FORMATS = {"u1": "B", "u2": "H", "i2": "h", "u4": "I", "f4": "f"}


class Page:
    """Read the page as a browser would, with patterns of this file."""

    def __init__(self, text):
        self.text = text
        self.scripts = re.findall(r"<script([^>]*)>(.*?)</script>", text, re.DOTALL)
        self.facts = json.loads(self._of('id="path-facts"'))
        self.bytes = base64.b64decode(self._of('id="path-columns"'), validate=True)

    def _of(self, mark):
        (script,) = (text for attributes, text in self.scripts if mark in attributes)
        return script

    def column(self, index):
        return struct.unpack_from(
            f"<{index['count']}{FORMATS[index['kind']]}", self.bytes, index["at"]
        )

    def values(self, column_facts):
        span = (column_facts["high"] - column_facts["low"]) / 65534
        return [
            math.nan if value == 65535 else column_facts["low"] + span * value
            for value in self.column(column_facts["values"])
        ]

    def positions(self):
        flat = self.column(self.facts["position"])
        return [
            [
                low + self.facts["step"] * value
                for low, value in zip(self.facts["low"], flat[offset : offset + 3])
            ]
            for offset in range(0, len(flat), 3)
        ]


@pytest.fixture(scope="module")
def planned(tmp_path_factory, root):
    folder = tmp_path_factory.mktemp("path")
    make_cup(folder)
    shop = Workshop(folder, root / "freecad-am")
    shop.write_job()
    assert shop.run("plan", "cup.yaml").status == 0
    files = shop.files()
    rows = list(csv.DictReader(files["waypoints.csv"].decode().splitlines()))
    return Page(files["report.html"].decode()), rows, json.loads(files["report.json"])


def test_its_bytes_are_the_waypoints(planned):
    page, rows, report = planned
    facts = page.facts
    assert facts["rows"] == len(rows) > 500
    size = max(max(abs(float(row[key])) for row in rows) for key in ("x_mm", "y_mm", "z_mm"))
    assert facts["step"] < 3.0 * size / 65000
    for row, position in zip(rows, page.positions(), strict=True):
        assert all(
            abs(float(row[key]) - value) <= 0.51 * facts["step"] + 1e-6
            for key, value in zip(("x_mm", "y_mm", "z_mm"), position)
        )
    for key, name in (("build", "b"), ("tool", "t")):
        flat = page.column(facts[key])
        for index, row in enumerate(rows):
            assert all(
                abs(float(row[f"{name}{axis}"]) - value / 32767) < 2e-5
                for axis, value in zip("xyz", flat[3 * index : 3 * index + 3])
            )
    laid = [row["kind"] == "deposit" and row["point"] != "0" for row in rows]
    assert laid == [bool(value) for value in page.column(facts["laid"])]
    assert [int(row["point"]) for row in rows] == list(page.column(facts["point"]))
    assert [axis_facts["name"] for axis_facts in facts["axes"]] == report["machine"]["labels"]
    for number, axis in enumerate(facts["axes"], 1):
        resolution = (axis["high"] - axis["low"]) / 65534 + 1e-6
        assert all(
            abs(float(row[f"q{number}_deg"]) - value) <= resolution
            for row, value in zip(rows, page.values(axis), strict=True)
        )
    speed = next(
        column_facts for column_facts in facts["columns"] if column_facts["name"] == "speed"
    )
    speeds = {round(value, 3) for value, on in zip(page.values(speed), laid) if on}
    assert (
        speeds == {6.0} and speed["least"] == speed["most"] == 6.0 < speed["high"]
    )  # rapids are faster and have no colour
    times = page.column(facts["time"])
    assert list(times) == sorted(times) and times[-1] == pytest.approx(
        report["totals"]["time_s"], rel=1e-3
    )


def test_a_row_takes_few_bytes_and_no_word_of_its_own(planned):
    """A page of 1e5 rows has some 8 MB, which a browser can load at once: three numbers of 2 bytes
    for each position and direction, one for every value that may colour it and every axis."""
    page, rows, _ = planned
    facts = page.facts
    a_row = 3 * 3 * 2 + 1 + 4 + 4 + 2 * (len(facts["columns"]) + len(facts["axes"]))
    bodies = sum(
        4 * body[key]["count"] for body in facts["bodies"] for key in ("vertices", "triangles")
    )
    assert (
        a_row * len(rows) <= len(page.bytes) - bodies <= a_row * len(rows) + 3 * 40 and a_row <= 60
    )
    of_page = len(page.text) - len(
        page.text[page.text.index('id="path-columns"') :].split("</script>")[0]
    )
    assert of_page < 400_000  # the rest of the page does not grow with the rows


def test_its_stretches_are_those_of_the_rows(planned):
    page, rows, _ = planned
    expected, previous = [], None
    for index, row in enumerate(rows):
        key = (int(row["layer"]), int(row["bead"]), row["kind"] == "deposit")
        if key != previous:
            expected.append([key[0], key[1], index, int(key[2])])
        previous = key
    assert page.facts["blocks"] == expected


def test_places_of_findings_and_promises_lead_to_their_rows(planned):
    page, rows, report = planned
    links = re.findall(
        r'<button data-row="(\d+)">layer (\d+)(?: bead (\d+))?(?: point (\d+))?</button>', page.text
    )
    locations = [entry["place"] for entry in report["preflight"] if entry["place"]] + [
        issue for issue in report["issues"] if issue["layer"] is not None
    ]
    assert len(links) == len(locations) >= 3
    for row, *location in links:
        waypoint = rows[int(row)]
        assert waypoint["kind"] == "deposit"
        expected = [
            (key, value) for key, value in zip(("layer", "bead", "point"), location) if value
        ]
        assert [(key, waypoint[key]) for key, _ in expected] == expected


def test_nothing_is_fetched_and_no_other_script_runs(planned):
    page, _, _ = planned
    assert not re.search(
        r"""(?:src|href|action)\s*=\s*["'](?!#)|url\((?!#)|@import|https?:(?!//www\.w3\.org)""",
        page.text,
    )
    (policy,) = re.findall(
        r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page.text
    )
    (script,) = (text for attributes, text in page.scripts if "type=" not in attributes)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert policy == f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"
    assert page.text.index("Content-Security-Policy") < page.text.index("<style")
    assert "<" not in page._of('id="path-facts"')


def test_a_page_of_a_path_alone_has_it_too(workshop):
    text = JOB.split("cell:")[0] + "process:\n  travel_speed: 6 mm/s\n"
    workshop.write_job(text)
    assert workshop.run("plan", "cup.yaml").status == 0
    page = Page(workshop.files()["report.html"].decode())
    assert page.facts["axes"] == [] and {"layer", "speed", "tilt"} == {
        column_facts["name"] for column_facts in page.facts["columns"]
    }


def test_of_longer_motions_every_so_many_th_row_is_shown_with_the_ends_of_beads(
    planned, monkeypatch, random_motion
):
    motion = random_motion
    for max_rows in (len(motion), len(motion) // 3, 40):
        monkeypatch.setattr(columns, "MOST_ROWS", max_rows)
        rows = columns._thinned(motion)
        starts = [
            row
            for row in range(len(motion))
            if row == 0
            or any(
                column[row] != column[row - 1]
                for column in (motion.deposit, motion.layer, motion.bead)
            )
        ]
        ends = [*(start - 1 for start in starts[1:]), len(motion) - 1]
        assert (
            set(starts) <= set(rows)
            and set(ends) <= set(rows)
            and len(rows) <= max_rows + 2 * len(starts)
        )
        columns_shown = columns.Shown(motion, rows, np.zeros(len(rows)), [], [])
        for number in range(0, len(motion), 7):
            if motion.deposit[number]:
                row = columns_shown.row_of(
                    int(motion.layer[number]), int(motion.bead[number]), int(motion.point[number])
                )
                assert rows[row] <= number and (row + 1 == len(rows) or rows[row + 1] > number)
        assert (
            columns_shown.row_of(10_000, 0, 0) is None
            and columns_shown.row_of(None, None, None) is None
        )


@pytest.fixture
def random_motion():
    from freecad_am.core.motion import Motion

    random = np.random.default_rng(8)
    deposit, layer, bead, point = [], [], [], []
    for number in range(12):
        for block in range(int(random.integers(1, 4))):
            count = int(random.integers(2, 60))
            for laid, length in ((False, 3), (True, count)):
                deposit += [laid] * length
                layer += [number] * length
                bead += [block] * length
                point += list(range(length)) if laid else [0] * length
    n = len(deposit)
    up = np.tile([0.0, 0.0, 1.0], (n, 1))
    return Motion(
        np.array(deposit),
        np.array(layer),
        np.array(bead),
        np.array(point),
        random.normal(size=(n, 3)),
        up,
        up,
        np.ones(n),
        np.full(n, np.nan),
        np.zeros((n, 6)),
        np.ones(n),
    )
