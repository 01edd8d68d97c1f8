# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page in a browser draws the path, turns it, reads it by a click and steps through it; links
of the preflight lead to its points. Only this test needs Chromium."""

import base64
import csv
import io
import re

import numpy as np
import pytest

from tests import browser
from tests.batch.conftest import JOB, Workshop, make_cup

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        browser.find_browser() is None,
        reason="there is no Chromium here; on Debian: apt-get install chromium",
    ),
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


def read_out(page):
    return page.run("document.querySelector('#path .told').textContent")


def assert_read_out(page, row):
    """Assert that the read-out of the shown point is that row of the waypoints."""
    words, expected = read_out(page), page.rows[row]
    location = f"layer {expected['layer']} bead {expected['bead']}"
    assert words.startswith(
        f"{location} point {expected['point']}"
        if expected["kind"] == "deposit"
        else f"{location}, rapid"
    )
    coordinates = [float(text) for text in re.search(r"x y z (\S+) (\S+) (\S+) mm", words).groups()]
    assert all(
        abs(float(expected[key]) - value) < 0.02
        for key, value in zip(("x_mm", "y_mm", "z_mm"), coordinates)
    )


def picture(page):
    """Return the canvas as pixels (h, w, 3)."""
    from PIL import Image

    page.run("document.getElementById('path').scrollIntoView()")
    page.run(RESTED)
    box = page.run(
        "(() => { const b = document.querySelector('#path canvas').getBoundingClientRect();"
        " return [b.left, b.top, b.right, b.bottom]; })()"
    )
    image = (
        Image.open(io.BytesIO(base64.b64decode(page.picture())))
        .convert("RGB")
        .crop([round(side) for side in box])
    )
    return np.asarray(image, float)


def middle(page):
    return page.run(
        "(() => { document.getElementById('path').scrollIntoView();"
        " const b = document.querySelector('#path canvas').getBoundingClientRect();"
        " return [b.left + b.width / 2, b.top + b.height / 2]; })()"
    )


def test_the_path_takes_the_place_of_the_picture_and_is_drawn_in_the_colours_of_its_layers(page):
    assert page.run(
        "['path', 'path-still'].map((name) => document.getElementById(name).hidden)"
    ) == [False, True]
    pixels = picture(page).reshape(-1, 3)
    paper = pixels[0]
    drawn = pixels[np.abs(pixels - paper).max(axis=1) > 20.0]
    assert 0.05 < len(drawn) / len(pixels) < 0.8
    for low, high in (
        ((0, 0, 40), (90, 60, 140)),
        ((0, 60, 50), (60, 180, 160)),
        ((90, 110, 0), (255, 240, 90)),
    ):
        assert ((drawn >= low) & (drawn <= high)).all(
            axis=1
        ).sum() > 200  # dark blue, green, yellow


def test_a_place_of_the_preflight_leads_to_its_row(page):
    rows = page.run(
        "[...document.querySelectorAll('td button[data-row]')].map((one) => Number(one.dataset.row))"
    )
    assert len(rows) >= 3
    for number, row in enumerate(rows):
        page.run(f"document.querySelectorAll('td button[data-row]')[{number}].click()")
        assert_read_out(page, row)


def test_it_is_stepped_through_layer_by_layer_and_point_by_point(page):
    page.run("document.querySelector('[name=whole]').click()")
    assert_read_out(page, len(page.rows) - 1)
    for _ in range(3):
        page.run("document.querySelector('[name=back]').click()")
    assert_read_out(page, len(page.rows) - 4)
    page.run(
        "(() => { const to = document.querySelector('[name=to]'); to.value = 2;"
        " to.dispatchEvent(new Event('input')); })()"
    )
    last_row = max(index for index, row in enumerate(page.rows) if row["layer"] == "2")
    assert_read_out(page, last_row)
    partial_picture = picture(page)
    page.run("document.querySelector('[name=whole]').click()")
    assert np.abs(picture(page) - partial_picture).max(axis=2).mean() > 2.0


def test_a_click_reads_the_bead_that_is_there(page):
    page.run(
        "document.querySelector('[name=whole]').click(); document.querySelector('[name=above]').click()"
    )
    page.run(RESTED)
    x, y = middle(page)
    right, up, _ = page.run("window.pathViewer.camera.seen(window.pathViewer.path.at(200))")
    for kind in ("mousePressed", "mouseReleased"):
        page.mouse(kind, x + right, y - up, button="left", clickCount=1)
    row = page.run("window.pathViewer.look.row")
    positions = np.array(
        [
            [float(waypoint[key]) for key in ("x_mm", "y_mm")]
            for waypoint in (page.rows[row], page.rows[200])
        ]
    )
    assert (
        np.linalg.norm(positions[0] - positions[1]) < 2.0
    )  # in the view from above, within a few pixels
    assert_read_out(page, row)


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
    page.run(
        "document.querySelector('[name=reset]').click(); document.querySelector('[name=whole]').click()"
    )
    previous_picture = picture(page)
    for number in range(1, page.run("window.pathViewer.path.columns.length")):
        page.run(
            f"(() => {{ const c = document.querySelector('[name=colour]'); c.value = {number};"
            " c.dispatchEvent(new Event('input')); })()"
        )
        assert page.run("document.querySelector('#path .most').textContent") != ""
        now = picture(page)
        assert np.abs(now - previous_picture).max() > 20.0
    for name in ("rapids", "directions"):
        previous_picture = picture(page)
        page.run(f"document.querySelector('[name={name}]').click()")
        assert (np.abs(picture(page) - previous_picture).max(axis=2) > 20.0).sum() > 30


ROW_COUNT = 100_000  # rows
TIMED = """(() => { const drawing = window.pathViewer.drawing, own = drawing.draw.bind(drawing), pixel = new Uint8Array(4);
  const done = () => drawing.gl.readPixels(0, 0, 1, 1, drawing.gl.RGBA, drawing.gl.UNSIGNED_BYTE, pixel);
  window.frames_ = [];
  drawing.draw = (camera, look) => { done(); const at = performance.now(); own(camera, look); done();
    window.frames_.push([performance.now() - at, !!look.moving]); }; })()"""


def frames(page):
    """Return the duration in ms of each frame since the last call, and whether it drew a moving
    path."""
    return np.array(page.run("window.frames_.splice(0)"), float).reshape(-1, 2)


def test_a_path_of_a_hundred_thousand_rows_is_turned_and_stepped_through(tmp_path, root):
    """The processor draws every frame. No frame of a moving path draws everything; each takes less
    than a fifth of the time of the full drawing, which follows when the path rests."""
    make_cup(tmp_path)
    shop = Workshop(tmp_path, root / "freecad-am")
    shop.write_job(
        JOB.replace("layer_height: 4 mm", "layer_height: 0.5 mm")
        .replace("0.1 mm", "0.00015 mm")
        .replace("post: fanuc", "post: none")
    )
    assert shop.run("plan", "cup.yaml").status == 0
    with browser.Browser(tmp_path / "out" / "cup" / "report.html", tmp_path / "profile") as page:
        assert page.run("window.pathViewer.path.rows") >= ROW_COUNT
        x, y = middle(page)
        page.run(RESTED)
        page.run(TIMED)
        page.run("window.pathViewer.redraw()")
        page.run("new Promise((done) => setTimeout(done, 3000))")
        (full_time, moving), *_ = frames(page)
        assert not moving
        page.mouse("mousePressed", x, y, button="left", clickCount=1)
        for step in range(1, 41):
            page.mouse("mouseMoved", x + 3 * step, y, button="left", buttons=1)
        turning = frames(page)
        page.run("new Promise((done) => setTimeout(done, 1000))")
        assert frames(page)[:, 1].all()  # while the button is down
        page.mouse("mouseReleased", x + 120, y, button="left", clickCount=1)
        page.run("new Promise((done) => setTimeout(done, 3000))")
        rested = frames(page)
        assert (
            len(turning) >= 20
            and turning[:, 1].all()
            and not rested[-1, 1]
            and (rested[:-1, 1] == 1.0).all()
        )
        row = page.run("window.pathViewer.look.row")
        for _ in range(20):
            page.run(
                "document.querySelector('[name=back]').click();"
                " new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
            )
        stepping = frames(page)
        assert page.run("window.pathViewer.look.row") == row - 20 and stepping[:, 1].mean() > 0.8
        page.run("document.querySelector('[name=whole]').click()")
        page.run("new Promise((done) => setTimeout(done, 3000))")
        frames(page)
        page.run("document.querySelector('[name=play]').click()")  # from the beginning
        page.run("new Promise((done) => setTimeout(done, 3000))")
        page.run("document.querySelector('[name=play]').click()")
        playing = frames(page)
        assert len(playing) > 10 and playing[:, 1].all()
        took = {
            name: np.median(durations[:, 0])
            for name, durations in (
                ("turning", turning),
                ("stepping", stepping[stepping[:, 1] == 1.0]),
                ("playing", playing),
            )
        }
        print(
            f"all of it {full_time:.0f} ms; "
            + ", ".join(f"{name} {ms:.0f} ms a frame" for name, ms in took.items())
        )
        assert all(ms < 0.2 * full_time for ms in took.values()), (full_time, took)
        assert page.errors == []
