# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page in a browser: the path is drawn, turned, read by a click and stepped through, and places of the preflight lead to
it. Needs Chromium, which nothing else does."""

import base64
import csv
import io
import re

import numpy as np
import pytest

from tests import browser
from tests.batch.conftest import Workshop, make_cup

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(browser.found() is None, reason="there is no Chromium here; on Debian: apt-get install chromium"),
]
RESTED = "new Promise((done) => setTimeout(done, 600))"


@pytest.fixture(scope="module")
def page(tmp_path_factory, root):
    folder = tmp_path_factory.mktemp("browser")
    make_cup(folder)
    shop = Workshop(folder, root / "freecad-am")
    shop.write_job()
    assert shop.run("plan", "cup.yaml").status == 0
    rows = list(csv.DictReader(shop.files()["waypoints.csv"].decode().splitlines()))
    with browser.Browser(folder / "out" / "cup" / "report.html", folder / "profile") as opened:
        opened.rows = rows
        yield opened
        assert opened.errors == []


def told(page):
    return page.run("document.querySelector('#path .told').textContent")


def agrees(page, row):
    """What is told of the point shown is that row of the waypoints."""
    words, expected = told(page), page.rows[row]
    place = f"layer {expected['layer']} bead {expected['bead']}"
    assert words.startswith(f"{place} point {expected['point']}" if expected["kind"] == "deposit" else f"{place}, rapid")
    at = [float(text) for text in re.search(r"x y z (\S+) (\S+) (\S+) mm", words).groups()]
    assert all(abs(float(expected[key]) - value) < 0.02 for key, value in zip(("x_mm", "y_mm", "z_mm"), at))


def picture(page):
    """(h, w, 3) the canvas as it is seen."""
    from PIL import Image

    page.run("document.getElementById('path').scrollIntoView()")
    page.run(RESTED)
    box = page.run("(() => { const b = document.querySelector('#path canvas').getBoundingClientRect();"
                   " return [b.left, b.top, b.right, b.bottom]; })()")
    image = Image.open(io.BytesIO(base64.b64decode(page.picture()))).convert("RGB").crop([round(side) for side in box])
    return np.asarray(image, float)


def middle(page):
    return page.run("(() => { document.getElementById('path').scrollIntoView();"
                    " const b = document.querySelector('#path canvas').getBoundingClientRect();"
                    " return [b.left + b.width / 2, b.top + b.height / 2]; })()")


def test_the_path_takes_the_place_of_the_picture_and_is_drawn_in_the_colours_of_its_layers(page):
    assert page.run("['path', 'path-still'].map((name) => document.getElementById(name).hidden)") == [False, True]
    seen = picture(page).reshape(-1, 3)
    paper = seen[0]
    drawn = seen[np.abs(seen - paper).max(axis=1) > 20.0]
    assert 0.05 < len(drawn) / len(seen) < 0.8
    for low, high in (((0, 0, 40), (90, 60, 140)), ((0, 60, 50), (60, 180, 160)), ((90, 110, 0), (255, 240, 90))):
        assert ((drawn >= low) & (drawn <= high)).all(axis=1).sum() > 200  # dark blue, green, yellow


def test_a_place_of_the_preflight_leads_to_its_row(page):
    rows = page.run("[...document.querySelectorAll('td button[data-row]')].map((one) => Number(one.dataset.row))")
    assert len(rows) >= 3
    for number, row in enumerate(rows):
        page.run(f"document.querySelectorAll('td button[data-row]')[{number}].click()")
        agrees(page, row)


def test_it_is_stepped_through_layer_by_layer_and_point_by_point(page):
    page.run("document.querySelector('[name=whole]').click()")
    agrees(page, len(page.rows) - 1)
    for _ in range(3):
        page.run("document.querySelector('[name=back]').click()")
    agrees(page, len(page.rows) - 4)
    page.run("(() => { const to = document.querySelector('[name=to]'); to.value = 2;"
             " to.dispatchEvent(new Event('input')); })()")
    last = max(at for at, row in enumerate(page.rows) if row["layer"] == "2")
    agrees(page, last)
    fewer = picture(page)
    page.run("document.querySelector('[name=whole]').click()")
    assert np.abs(picture(page) - fewer).max(axis=2).mean() > 2.0


def test_a_click_reads_the_bead_that_is_there(page):
    page.run("document.querySelector('[name=whole]').click(); document.querySelector('[name=above]').click()")
    page.run(RESTED)
    x, y = middle(page)
    right, up, _ = page.run("window.pathViewer.camera.seen(window.pathViewer.path.at(200))")
    for kind in ("mousePressed", "mouseReleased"):
        page.mouse(kind, x + right, y - up, button="left", clickCount=1)
    row = page.run("window.pathViewer.look.row")
    near = np.array([[float(one[key]) for key in ("x_mm", "y_mm")] for one in (page.rows[row], page.rows[200])])
    assert np.linalg.norm(near[0] - near[1]) < 2.0  # seen from above, within a few pixels
    agrees(page, row)


def test_it_turns_with_the_mouse_and_the_wheel_is_its_own_only_after_a_click(page):
    page.run("document.querySelector('[name=reset]').click(); document.activeElement.blur()")
    x, y = middle(page)
    zoom = page.run("window.pathViewer.camera.zoom")
    page.mouse("mouseWheel", x, y, deltaX=0, deltaY=-1)
    assert page.run("window.pathViewer.camera.zoom") == zoom
    page.mouse("mousePressed", x, y, button="left", clickCount=1)
    page.mouse("mouseMoved", x + 50, y, button="left", buttons=1)
    page.mouse("mouseReleased", x + 50, y, button="left", clickCount=1)
    turned = page.run("window.pathViewer.camera.azimuth")
    assert turned == pytest.approx(-28 + 0.4 * 50, abs=1.0)
    page.mouse("mouseWheel", x, y, deltaX=0, deltaY=-100)
    page.run(RESTED)
    assert page.run("window.pathViewer.camera.zoom") > 1.05 * zoom
    product = page.run("(() => { const t = window.pathViewer.camera.turn; return t; })()")
    assert np.allclose(np.array(product) @ np.array(product).T, np.eye(3), atol=1e-9)
    assert np.linalg.det(np.array(product)) == pytest.approx(1.0)


def test_every_colour_and_option_is_drawn(page):
    page.run("document.querySelector('[name=reset]').click(); document.querySelector('[name=whole]').click()")
    before = picture(page)
    for number in range(1, page.run("window.pathViewer.path.columns.length")):
        page.run(f"(() => {{ const c = document.querySelector('[name=colour]'); c.value = {number};"
                 " c.dispatchEvent(new Event('input')); })()")
        assert page.run("document.querySelector('#path .most').textContent") != ""
        now = picture(page)
        assert np.abs(now - before).max() > 20.0
    for name in ("rapids", "directions"):
        before = picture(page)
        page.run(f"document.querySelector('[name={name}]').click()")
        assert (np.abs(picture(page) - before).max(axis=2) > 20.0).sum() > 30
