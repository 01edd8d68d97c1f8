# SPDX-License-Identifier: LGPL-2.1-or-later
"""What `report.html` draws of a predicted deposit, read from its pictures by their own scales, against `report.json`."""

import html
import json
import math
import re

import numpy as np
import Part
import pytest

from tests.batch.test_predicted_jobs import BLOCK, KEY

SIZE = (50.0, 30.0, 14.0)
COS, SIN = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
PIXEL = 0.12  # coordinates of a picture have one decimal
NUMBER = r"(-?\d+(?:\.\d+)?)"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    from freecad_am.batch import cli

    folder = tmp_path_factory.mktemp("page")
    Part.makeBox(*SIZE).exportStep(str(folder / "block.step"))
    (folder / "block.yaml").write_text(BLOCK % {"margin": 2, "more": KEY})
    assert cli.main(["plan", str(folder / "block.yaml"), "-o", str(folder / "out")]) == 0
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    return json.loads((folder / "out" / "report.json").read_text())["predicted_shape"], page


def picture(page, title):
    start = page.index(f'aria-label="{title}"')
    return page[start : page.index("</svg>", start)]


def scales(text):
    """What turns pixels across and down into values, from the numbers beside the picture and the lines they stand at."""
    ends = rf"M {NUMBER} {NUMBER} \nL {NUMBER} {NUMBER} \n"
    lines = re.findall(
        rf'<path d="{ends}"[^>]*--line[^>]*>\s*</g>\s*<g>\s*<text[^>]*>([^<]*)</text>', text
    )
    across = [
        (float(x), float(value.replace("\u2212", "-"))) for x, _, x1, _, value in lines if x == x1
    ]
    up = [
        (float(y), float(value.replace("\u2212", "-"))) for _, y, _, y1, value in lines if y == y1
    ]
    found = []
    for ticks in (across, up):
        (first, low), (last, high) = ticks[0], ticks[-1]
        assert len(ticks) >= 2 and first != last
        per = (high - low) / (last - first)
        found.append(
            (lambda pixel, first=first, low=low, per=per: low + per * (pixel - first), abs(per))
        )
    return found


def dots(text):
    """Places and colours of the dots, and of the rings, which have no colour of their own."""
    (x, per_x), (y, per_y) = scales(text)
    assert per_x == pytest.approx(per_y, rel=0.02)  # one scale for both
    uses = re.findall(rf'<use [^>]*x="{NUMBER}" y="{NUMBER}" style="([^"]*)"', text)
    places = [(x(float(px)), y(float(py)), style) for px, py, style in uses]
    coloured = [
        (px, py, found[1])
        for px, py, style in places
        if (found := re.search(r"fill: (#\w{6})", style))
    ]
    rings = [(px, py) for px, py, style in places if "fill: #" not in style]
    return coloured, rings, PIXEL * per_x


def key(page):
    """The least and largest mm that each colour stands for, by the words below the maps."""
    text = page[page.index("Deposit beyond the faces, mm:") :]
    found = {}
    for colour, words in re.findall(
        r'color:(#\w{6})">&#9632;</span> ([^&]*(?:&\w+;[^&]*)?)&ensp;', text
    ):
        words = html.unescape(words).strip()
        numbers = [float(value) for value in re.findall(NUMBER, words)]
        found[colour] = (
            (-math.inf, numbers[0])
            if words.startswith("<")
            else (numbers[0], math.inf)
            if words.startswith(">")
            else (-numbers[0], numbers[0])
            if "±" in words
            else tuple(sorted(numbers))
        )
    return found


def test_the_maps_show_the_faces_to_scale_with_the_worst_places_by_name(made):
    report, page = made
    ranges = key(page)
    assert len(ranges) == 7
    named = {one["name"]: one for one in report["worst_places"]}
    assert list(named) == list("ABCDE")
    seen_from = {
        "Seen from the front": lambda x, y, z: (x, z * COS + y * SIN),
        "Seen from behind": lambda x, y, z: (-x, z * COS - y * SIN),
    }
    colours = set()
    for title, shown in seen_from.items():
        text = picture(page, title)
        coloured, rings, near = dots(text)
        corners = np.array(
            [shown(x, y, z) for x in (0.0, SIZE[0]) for y in (0.0, SIZE[1]) for z in (0.0, SIZE[2])]
        )
        for axis in (0, 1):  # all of the block, and nothing beside it
            values = [dot[axis] for dot in coloured]
            assert (
                min(values) >= corners[:, axis].min() - near
                and max(values) <= corners[:, axis].max() + near
            )
            assert np.ptp(values) > 0.96 * np.ptp(corners[:, axis])
        assert len(coloured) > 1000
        assert re.findall(r">([A-E])</text>", text) == list(
            named
        )  # all lie on the top, which both show
        assert len(rings) == len(named)
        for one, ring in zip(named.values(), rings, strict=True):
            place = shown(*one["place"])
            assert math.dist(ring, place) < near
            colour = min(coloured, key=lambda dot, at=place: math.dist(dot[:2], at))[2]
            low, high = ranges[colour]
            assert low <= one["beyond_mm"] <= high
        colours |= {dot[2] for dot in coloured}
    spread = report["spread"]
    ends = zip(spread["edges_mm"], spread["edges_mm"][1:], spread["area_share"], strict=False)
    filled = [(low, high) for low, high, share in ends if share]
    for colour, (low, high) in ranges.items():  # a colour is there where the spread has deviations
        there = any(start >= low and end <= high for start, end in filled)
        assert not there or colour in colours


def test_the_worst_places_are_apart_and_the_least_is_the_worst(made):
    report, page = made
    rows = report["worst_places"]
    assert (
        rows[0]["place"] == report["worst"]["place"]
        and rows[0]["beyond_mm"] == report["beyond_mm"]["min"]
    )
    assert all(rows[0][word] == report["worst"][word] for word in ("layer", "bead", "point"))
    assert [one["beyond_mm"] for one in rows] == sorted(one["beyond_mm"] for one in rows)
    least = 0.1 * math.hypot(*SIZE)
    assert all(
        math.dist(one["place"], other["place"]) > 0.99 * least
        for one in rows
        for other in rows
        if one is not other
    )
    for one in rows:  # on a face of the block
        assert any(
            min(abs(value), abs(value - size)) < 1e-6
            for value, size in zip(one["place"], SIZE, strict=True)
        )
        row = re.search(
            rf'<tr><td>{one["name"]}</td><td>{NUMBER} mm</td>.*?<button data-row="(\d+)">([^<]*)</button>',
            page,
        )
        assert float(row[1]) == pytest.approx(one["beyond_mm"], abs=6e-4)
        assert row[3] == f"layer {one['layer']} bead {one['bead']} point {one['point']}"


def test_the_histogram_is_the_spread_of_the_report(made):
    report, page = made
    edges, shares = (np.array(report["spread"][name]) for name in ("edges_mm", "area_share"))
    assert shares.sum() == pytest.approx(1.0, abs=1e-9) and (np.diff(edges) > 0.0).all()
    assert edges[0] <= report["beyond_mm"]["min"] and edges[-1] >= report["beyond_mm"]["max"]
    assert (
        abs(0.5 * (edges[1:] + edges[:-1]) @ shares - report["beyond_mm"]["mean"])
        < edges[1] - edges[0]
    )
    known = 0.25 * report["cube_mm"]  # less is not told
    assert (
        shares[edges[1:] <= -known].sum()
        <= report["outside"] + 1e-9
        <= shares[edges[:-1] < 0.0].sum() + 1e-9
    )
    text = picture(page, "Deposit beyond the faces")
    (x, per_x), (y, per_y) = scales(text)
    path = max(re.findall(r'<path d="([^"]*)"', text), key=len)
    corners = np.array(
        [(x(float(px)), y(float(py))) for px, py in re.findall(rf"[ML] {NUMBER} {NUMBER}", path)]
    )
    for low, high, share in zip(edges[:-1], edges[1:], shares, strict=True):
        middle = 0.5 * (low + high)
        up = [
            max(a[1], b[1])
            for a, b in zip(corners, corners[1:], strict=False)
            if min(a[0], b[0]) <= middle <= max(a[0], b[0]) and abs(a[1] - b[1]) < PIXEL * per_y
        ]
        assert max(up) == pytest.approx(100.0 * share, abs=2.0 * PIXEL * per_y)
    dashed = re.search(rf'<path d="M {NUMBER} [^"]*"[^>]*stroke-dasharray[^>]*--ink', text)
    assert abs(x(float(dashed[1])) - report["allowance_mm"]) < PIXEL * per_x


def test_layers_are_drawn_as_the_report_has_them(made):
    report, page = made
    text = picture(page, "Layer by layer")
    (x, _), (y, per_y) = scales(text)
    curves = re.findall(
        r'<path d="(M [^"]*)"[^>]*stroke: (#d9633b|#3b6fd4)[^>]*stroke-width: 1.1', text
    )
    assert len(curves) == 2
    for path, colour in curves:
        name = {"#d9633b": "min", "#3b6fd4": "mean"}[colour]
        points = np.array(
            [
                (x(float(px)), y(float(py)))
                for px, py in re.findall(rf"[ML] {NUMBER} {NUMBER}", path)
            ]
        )
        wanted = np.array([(row["layer"], row["beyond_mm"][name]) for row in report["layers"]])
        for point in wanted:  # on the curve, whose straight pieces are put together
            on = np.interp(point[0], points[:, 0], points[:, 1])
            assert on == pytest.approx(point[1], abs=2.0 * PIXEL * per_y + 0.02)
    assert min(row["beyond_mm"]["min"] for row in report["layers"]) == report["beyond_mm"]["min"]
