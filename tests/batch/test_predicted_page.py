# SPDX-License-Identifier: LGPL-2.1-or-later
"""The drawings of a predicted deposit in `report.html`, read with their own scales, agree with
`report.json`."""

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
    """Return functions that turn horizontal and vertical pixels into values, from the numbers next
    to the picture and their tick positions."""
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
    axes = []
    for ticks in (across, up):
        (first_tick, low), (last_tick, high) = ticks[0], ticks[-1]
        assert len(ticks) >= 2 and first_tick != last_tick
        per = (high - low) / (last_tick - first_tick)
        axes.append(
            (
                lambda pixel, first_tick=first_tick, low=low, per=per: (
                    low + per * (pixel - first_tick)
                ),
                abs(per),
            )
        )
    return axes


def dots(text):
    """Return positions and colours of the dots, and positions of the rings, which have no colour of
    their own."""
    (x, per_x), (y, per_y) = scales(text)
    assert per_x == pytest.approx(per_y, rel=0.02)  # the same scale for both
    uses = re.findall(rf'<use [^>]*x="{NUMBER}" y="{NUMBER}" style="([^"]*)"', text)
    positions = [(x(float(px)), y(float(py)), style) for px, py, style in uses]
    coloured = [
        (px, py, match[1])
        for px, py, style in positions
        if (match := re.search(r"fill: (#\w{6})", style))
    ]
    rings = [(px, py) for px, py, style in positions if "fill: #" not in style]
    return coloured, rings, PIXEL * per_x


def key(page):
    """Return the smallest and largest mm of each colour, from the legend below the maps."""
    text = page[page.index("Deposit beyond the faces, mm:") :]
    colour_ranges = {}
    for colour, words in re.findall(
        r'color:(#\w{6})">&#9632;</span> ([^&]*(?:&\w+;[^&]*)?)&ensp;', text
    ):
        words = html.unescape(words).strip()
        numbers = [float(value) for value in re.findall(NUMBER, words)]
        colour_ranges[colour] = (
            (-math.inf, numbers[0])
            if words.startswith("<")
            else (numbers[0], math.inf)
            if words.startswith(">")
            else (-numbers[0], numbers[0])
            if "±" in words
            else tuple(sorted(numbers))
        )
    return colour_ranges


def test_the_maps_show_the_faces_to_scale_with_the_worst_places_by_name(made):
    report, page = made
    ranges = key(page)
    assert len(ranges) == 7
    named = {worst_place["name"]: worst_place for worst_place in report["worst_places"]}
    assert list(named) == list("ABCDE")
    seen_from = {
        "Seen from the front": lambda x, y, z: (x, z * COS + y * SIN),
        "Seen from behind": lambda x, y, z: (-x, z * COS - y * SIN),
    }
    colours = set()
    for title, project in seen_from.items():
        text = picture(page, title)
        coloured, rings, labels = dots(text)
        corners = np.array(
            [
                project(x, y, z)
                for x in (0.0, SIZE[0])
                for y in (0.0, SIZE[1])
                for z in (0.0, SIZE[2])
            ]
        )
        for axis in (0, 1):  # the whole block, and nothing outside
            values = [dot[axis] for dot in coloured]
            assert (
                min(values) >= corners[:, axis].min() - labels
                and max(values) <= corners[:, axis].max() + labels
            )
            assert np.ptp(values) > 0.96 * np.ptp(corners[:, axis])
        assert len(coloured) > 1000
        assert re.findall(r">([A-E])</text>", text) == list(
            named
        )  # all are on the top, which both views show
        assert len(rings) == len(named)
        for worst_place, ring in zip(named.values(), rings, strict=True):
            point = project(*worst_place["place"])
            assert math.dist(ring, point) < labels
            colour = min(coloured, key=lambda dot, target=point: math.dist(dot[:2], target))[2]
            low, high = ranges[colour]
            assert low <= worst_place["beyond_mm"] <= high
        colours |= {dot[2] for dot in coloured}
    spread = report["spread"]
    ends = zip(spread["edges_mm"], spread["edges_mm"][1:], spread["area_share"], strict=False)
    filled = [(low, high) for low, high, share in ends if share]
    for colour, (low, high) in ranges.items():  # a colour appears where the spread has deviations
        has_spread = any(start >= low and end <= high for start, end in filled)
        assert not has_spread or colour in colours


def test_the_worst_places_are_apart_and_the_least_is_the_worst(made):
    report, page = made
    rows = report["worst_places"]
    assert (
        rows[0]["place"] == report["worst"]["place"]
        and rows[0]["beyond_mm"] == report["beyond_mm"]["min"]
    )
    assert all(rows[0][word] == report["worst"][word] for word in ("layer", "bead", "point"))
    assert [worst_place["beyond_mm"] for worst_place in rows] == sorted(
        worst_place["beyond_mm"] for worst_place in rows
    )
    min_distance = 0.1 * math.hypot(*SIZE)
    assert all(
        math.dist(worst_place["place"], second_place["place"]) > 0.99 * min_distance
        for worst_place in rows
        for second_place in rows
        if worst_place is not second_place
    )
    for worst_place in rows:  # on a face of the block
        assert any(
            min(abs(value), abs(value - size)) < 1e-6
            for value, size in zip(worst_place["place"], SIZE, strict=True)
        )
        row = re.search(
            rf'<tr><td>{worst_place["name"]}</td><td>{NUMBER} mm</td>.*?<button data-row="(\d+)">([^<]*)</button>',
            page,
        )
        assert float(row[1]) == pytest.approx(worst_place["beyond_mm"], abs=6e-4)
        assert (
            row[3]
            == f"layer {worst_place['layer']} bead {worst_place['bead']} point {worst_place['point']}"
        )


def test_the_histogram_is_the_spread_of_the_report(made):
    report, page = made
    edges, shares = (np.array(report["spread"][name]) for name in ("edges_mm", "area_share"))
    assert shares.sum() == pytest.approx(1.0, abs=1e-9) and (np.diff(edges) > 0.0).all()
    assert edges[0] <= report["beyond_mm"]["min"] and edges[-1] >= report["beyond_mm"]["max"]
    assert (
        abs(0.5 * (edges[1:] + edges[:-1]) @ shares - report["beyond_mm"]["mean"])
        < edges[1] - edges[0]
    )
    smallest_reported = 0.25 * report["cube_mm"]  # smaller values are not reported
    assert (
        shares[edges[1:] <= -smallest_reported].sum()
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
        expected = np.array([(row["layer"], row["beyond_mm"][name]) for row in report["layers"]])
        for point in expected:  # on the curve, joined from its straight segments
            on = np.interp(point[0], points[:, 0], points[:, 1])
            assert on == pytest.approx(point[1], abs=2.0 * PIXEL * per_y + 0.02)
    assert min(row["beyond_mm"]["min"] for row in report["layers"]) == report["beyond_mm"]["min"]
