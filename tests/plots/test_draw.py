# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drawn pictures show the values of their charts: lines, limits, bars. Their bytes depend only on
the values, and tables return them."""

import csv
import io
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from freecad_am.plots import draw, files, pictures
from freecad_am.plots.chart import (
    DARK,
    LAYER_NUMBER,
    LIGHT,
    PAGE,
    VARIABLES,
    Chart,
    Curve,
    Picture,
    Quantity,
)
from freecad_am.plots.draw import envelope
from freecad_am.plots.pictures import PATH

TIME, ANGLE = Quantity("time", "s"), Quantity("angle", "deg")


def lines(axes):
    """Return the lines in a frame that are not marks, in data units."""
    return [line for line in axes.get_lines() if line.get_transform() == axes.transData]


def test_lines_are_the_values(dome):
    source, _ = dome
    for name in ("angles", "speeds", "deposit", "condition"):
        charts = pictures.picture(name, source).charts
        figure, frames = draw.figure(charts, LIGHT, 4000, 900)  # wide enough for every point
        assert len(figure.axes) == len(frames) == len(charts)
        for axes, chart, frame in zip(figure.axes, charts, frames, strict=True):
            for line, curve in zip(lines(axes), chart.curves, strict=True):
                assert np.array_equal(line.get_xdata(), curve.x)
                assert np.array_equal(line.get_ydata(), curve.y, equal_nan=True)
            assert axes.get_xlim() == frame.across and axes.get_ylim() == frame.up


def test_a_wide_curve_looks_the_same_with_few_points():
    random = np.random.default_rng(8)
    x = np.sort(random.uniform(0.0, 100.0, 300_000))
    y = np.cumsum(random.normal(size=len(x)))
    y[120_000:150_000] = np.nan
    y[77_777] = 5000.0
    for low, high in ((0.0, 100.0), (20.0, 61.0)):
        kept_rows = envelope(x, y, 500, low, high)
        assert len(kept_rows) <= 4 * 502 and (np.diff(kept_rows) > 0).all()
        edges = np.linspace(low, high, 501)
        for values, reduce in ((y, np.fmax), (y, np.fmin)):
            column = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, 499)
            is_visible = (x >= low) & (x < high)
            full_curve, reduced_curve = np.full(500, np.nan), np.full(500, np.nan)
            reduce.at(full_curve, column[is_visible], values[is_visible])
            visible_rows = kept_rows[is_visible[kept_rows]]
            reduce.at(reduced_curve, column[visible_rows], values[visible_rows])
            assert np.array_equal(full_curve, reduced_curve, equal_nan=True)
        assert 77_777 in kept_rows
    gap = envelope(x, y, 500, 0.0, 100.0)
    assert np.isnan(y[gap]).sum() >= 90  # the gap is a tenth of the columns
    assert np.array_equal(envelope(x[:50], y[:50], 500, x[0], x[49]), np.arange(50))
    assert envelope(x, np.full(len(x), np.nan), 100, 0.0, 100.0).size <= 204


def test_limits_are_bands_and_what_breaks_them_is_marked():
    x = np.linspace(0.0, 10.0, 101)
    chart = Chart("A", TIME, ANGLE, (Curve("A", x, 100.0 * np.sin(x)),), limits=(-120.0, 90.0))
    figure, frames = draw.figure((chart,), LIGHT, 600, 300)
    (axes,) = figure.axes
    over = 100.0 * np.sin(x) > 90.0
    assert chart.wrong_count == over.sum()
    _, wrong = lines(axes)
    assert np.array_equal(np.isfinite(wrong.get_ydata()), over) and wrong.get_color() == LIGHT.bad
    bands = [(patch.get_y(), patch.get_y() + patch.get_height()) for patch in axes.patches]
    low, high = frames[0].up
    assert sorted(bands) == pytest.approx([(low, -120.0), (90.0, high)]) and low < -120.0
    texts = [text.get_text() for text in figure.texts]
    assert any(text == f"A: {over.sum()} points beyond the limit" for text in texts)
    assert {"90", "-120"} <= set(texts) and "time, s" in texts
    distant = Chart("A", TIME, ANGLE, (Curve("A", x, np.sin(x)),), limits=(-120.0, 90.0))
    figure, frames = draw.figure((distant,), DARK, 600, 300)
    assert frames[0].up[1] < 2.0 and not figure.axes[0].patches  # outside the frame, but reported
    assert "limits -120 to 90 deg" in [text.get_text() for text in figure.texts]


def test_layers_have_whole_numbers():
    x = np.arange(20.0)
    chart = Chart("volume", LAYER_NUMBER, Quantity("share", "%"), (Curve("share", x, x / 7.0),))
    for width in (300, 900):
        figure, _ = draw.figure((chart,), LIGHT, width, 300)
        figure.canvas.draw()
        numbers = [label.get_text() for label in figure.axes[0].get_xticklabels()]
        assert len(numbers) > 2 and all(number.lstrip("\u2212").isdigit() for number in numbers)


def test_a_window_shows_a_part(dome):
    source, _ = dome
    charts = pictures.picture("angles", source).charts
    low, high = charts[0].across()
    section = (low + 0.2 * (high - low), low + 0.4 * (high - low))
    figure, frames = draw.figure(
        charts, LIGHT, 500, 600, draw.Window({0: section}, {2: (-1.0, 1.0)})
    )
    assert {frame.across for frame in frames} == {section} and frames[2].up == (-1.0, 1.0)
    assert figure.axes[2].get_ylim() == (-1.0, 1.0)
    x = lines(figure.axes[0])[0].get_xdata()
    assert (
        (x > section[0]).any()
        and x[0] <= section[0]
        and x[-1] >= section[1]
        and len(x) < len(charts[0].curves[0].x)
    )


@pytest.mark.parametrize("kind", files.KINDS)
def test_the_same_values_are_the_same_bytes(dome, kind):
    source, _ = dome
    charts = pictures.picture("deposit", source).charts
    images = [files.image(draw.figure(charts, LIGHT, 500, 300)[0], kind) for _ in range(2)]
    assert images[0] == images[1] and len(images[0]) > 2000
    other_image = files.image(
        draw.figure(pictures.picture("deposit", source, PATH).charts, LIGHT, 500, 300)[0], kind
    )
    assert other_image != images[0]
    assert not re.search(rb"20\d\d-\d\d-\d\d|Matplotlib v|D:20", images[0])


def test_pictures_in_a_page_take_its_colours(dome):
    source, _ = dome
    chart = pictures.picture("angles", source).charts[0]
    text = files.inline(draw.figure((chart,), PAGE, 460, 230)[0], 'a "name" & more')
    tree = ElementTree.fromstring(text)
    assert tree.get("aria-label") == 'a "name" & more' and tree.get("viewBox") == "0 0 331.2 165.6"
    assert "width" not in tree.attrib
    assert (
        not any(colour in text for colour in VARIABLES)
        and "var(--ink)" in text
        and "var(--line)" in text
    )
    assert "<style" not in text and "<metadata" not in text and "date" not in text
    used = set(re.findall(r"url\(#(\w+)\)", text))
    assert used and used <= set(re.findall(r'id="(\w+)"', text))
    assert [node for node in tree.iter() if node.tag.endswith("text") and node.text == "q1"]


def test_scales_in_a_page_keep_their_decimals():
    chart = Chart("a", Quantity("x"), Quantity("y"), (Curve("", *np.array([[0, 1], [0.0, 0.25]])),))
    text = files.inline(draw.figure((chart,), PAGE, 460, 230)[0], "a")
    labels = [
        node.text for node in ElementTree.fromstring(text).iter() if node.tag.endswith("text")
    ]
    assert {"0.00", "0.05", "0.10", "0.15", "0.20", "0.25"} <= set(labels)


@pytest.mark.parametrize("name", ["angles", "jerks", "deposit", "condition"])
def test_tables_give_the_values_back(dome, name):
    source, _ = dome
    picture = pictures.picture(name, source)
    table = list(csv.reader(io.StringIO("".join(files.values(picture)))))
    curves = [curve for chart in picture.charts for curve in chart.curves]
    assert len(table[0]) == 2 + len(curves) and len(set(table[0])) == len(table[0])
    unit = picture.charts[0].x.unit
    assert table[0][:2] == [f"time_{unit}", "layer"] and all(
        re.fullmatch(r"\w+", cell) for cell in table[0]
    )
    columns = list(zip(*table[1:], strict=True))
    np.testing.assert_allclose(np.array(columns[0], float), curves[0].x, rtol=1e-9, atol=1e-12)
    assert [int(cell) for cell in columns[1]] == curves[0].layer.tolist()
    for cells, curve in zip(columns[2:], curves, strict=True):
        np.testing.assert_allclose(
            [float(cell) if cell else np.nan for cell in cells], curve.y, rtol=1e-9, atol=1e-12
        )


@pytest.mark.parametrize("name", ["spread", "fit", "heights"])
def test_tables_of_what_is_no_course(modelled, name):
    picture = pictures.picture(name, modelled)
    table = list(csv.reader(io.StringIO("".join(files.values(picture)))))
    if name == "heights":
        assert table[0][:2] == ["layer", "lowest_mm"]
        return
    assert table[0] == ["chart", "curve", "from", "to", "value"]
    expected = [
        (chart.title, low, high, value)
        for chart in picture.charts
        if chart.bars is not None
        for low, high, value in zip(
            chart.bars.edges[:-1], chart.bars.edges[1:], chart.bars.heights, strict=True
        )
    ]
    expected += [
        (chart.title, x, x, y)
        for chart in picture.charts
        for curve in chart.curves
        for x, y in zip(curve.x, curve.y, strict=True)
    ]
    assert len(table) == 1 + len(expected)
    for row, (title, *numbers) in zip(table[1:], expected, strict=True):
        assert row[0] == title and [float(cell) for cell in row[2:]] == pytest.approx(
            numbers, rel=1e-9, abs=1e-12
        )


def test_a_comma_in_a_name_does_not_make_a_column():
    chart = Chart(
        'so, "said"',
        TIME,
        ANGLE,
        (
            Curve("one, two", np.arange(2.0), np.arange(2.0)),
            Curve("b", np.arange(3.0), np.arange(3.0)),
        ),
    )
    table = list(csv.reader(io.StringIO("".join(files.values(Picture("a", "A", (chart,)))))))
    assert all(len(row) == 5 for row in table) and table[1][:2] == ['so, "said"', "one, two"]


@pytest.mark.parametrize("width", [300, 520, 1500])
def test_names_of_curves_are_beside_or_above_their_frame_and_clear_of_each_other(width):
    x = np.linspace(0.0, 1.0, 50)
    curves = tuple(
        Curve(f"radius {5 * number} mm, measured", x, x + number, number) for number in range(7)
    )
    chart = Chart("Width of beads", TIME, ANGLE, curves)
    figure, (frame,) = draw.figure((chart,), LIGHT, width, 400)
    renderer = FigureCanvasAgg(figure).get_renderer()
    texts = {text.get_text(): text.get_window_extent(renderer) for text in figure.texts}
    boxes = [texts[curve.name] for curve in curves] + [texts["Width of beads"]]
    for number, box in enumerate(boxes):
        assert box.y0 >= 400 - frame.top  # pixels from the bottom: above the frame
        assert box.x0 >= 0.0 and box.x1 <= width and box.y1 <= 400
        for other_box in boxes[:number]:
            assert not box.overlaps(other_box)
    assert frame.height > 150
