# SPDX-License-Identifier: LGPL-2.1-or-later
"""The thruster of Dai 2020, eighteen blades, to a program for an 840D: in few layers, and as
shipped in 180."""

import csv
import json
import math
import os
import re
import shutil
import subprocess
from itertools import groupby

import numpy as np
import pytest

# layer height and chord error (mm) of thruster.yaml, and of a job that is planned in seconds; the fewest moves that deposit
SHIPPED, COARSE = (2.5, 0.05, 100_000), (30.0, 0.2, 10_000)
WRITTEN = 1e-6  # mm, in waypoints.csv: half a digit of three numbers
# hubs by their centre and the largest circumcircle of their blades
HUBS = ((70.0, 466.5), (205.0, 399.9), (326.0, 384.3))
TAPER = math.atan2(60.0, 200.0)


class Whole:
    """The outputs of a run, read again: columns of the rows that deposit."""

    def __init__(self, out, size):
        self.height, self.chord, self.fewest = size
        self.report = json.loads((out / "report.json").read_text(encoding="utf-8"))
        with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
            lines = csv.reader(stream)
            header = next(lines)
            names = (
                "layer",
                "bead",
                "point",
                "x_mm",
                "y_mm",
                "z_mm",
                "speed_mm_s",
                "tx",
                "ty",
                "tz",
                "width_mm",
            )
            columns_ = [header.index(name) for name in names]
            kind = header.index("kind")
            rows = np.array(
                [[row[k] for k in columns_] for row in lines if row[kind] == "deposit"],
                dtype=np.float64,
            )
        self.layer, self.bead, self.point = rows[:, :3].astype(int).T
        self.places, self.speed, self.tool, self.width = (
            rows[:, 3:6],
            rows[:, 6],
            rows[:, 7:10],
            rows[:, 10],
        )
        self.page = (out / "report.html").read_text(encoding="utf-8")
        self.texts = {
            path.name: path.read_text(encoding="ascii") for path in (out / "program").iterdir()
        }

    def away(self, positions):
        """Return the distance of positions (n, 3) from the three bases: (3, n)."""
        rho, z = np.hypot(positions[:, 0], positions[:, 1]), positions[:, 2]
        cone = (rho - 60.0) * math.cos(TAPER) + (z - 280.0) * math.sin(TAPER)
        return np.stack([rho - 75.0, rho - 60.0, cone])


def check_levels(run):
    """Assert that every point is on its cone, the cones are a layer height apart, and points
    between are within the chord error."""
    moves = run.point > 0
    middle = np.roll(run.places, 1, axis=0)
    middle = 0.5 * (middle + run.places)
    hub = np.argmin(np.abs(run.places[:, 2][:, None] - [centre for centre, _ in HUBS]), axis=1)
    row = np.arange(len(hub))
    distances, between = run.away(run.places)[hub, row], run.away(middle)[hub, row]
    level = np.rint(distances / run.height)
    assert np.abs(distances - level * run.height).max() < 1e-6 + WRITTEN
    assert np.abs(between - level * run.height)[moves].max() < run.chord
    for k, (_, diameter) in enumerate(HUBS):
        on_hub = hub == k
        layers = sorted(set(zip(run.layer[on_hub].tolist(), level[on_hub].tolist(), strict=True)))
        assert [number for _, number in layers] == list(
            range(len(layers))
        )  # each once, from the hub outwards
        mean = np.array([distances[on_hub & (run.layer == layer)].mean() for layer, _ in layers])
        assert np.abs(np.diff(mean) - run.height).max() < 1e-6
        tip = np.hypot(*run.places[on_hub, :2].T).max()
        assert 0.5 * diameter - run.height < tip <= 0.5 * diameter + WRITTEN


def check_order(run):
    """Assert ring by ring around the axis that no two consecutive beads are on the same blade,
    except beads that a ring has in several sections, and that each blade has the same share of each
    layer."""
    starts = np.flatnonzero(run.point == 0)
    ends = np.append(starts[1:], len(run.point))
    blade = []
    for low, high in zip(starts, ends, strict=True):
        x, y = run.places[low:high, :2].mean(axis=0)
        blade.append(round(math.degrees(math.atan2(y, x)) / 60.0) % 6)
    blades, layers = np.array(blade), run.layer[starts]
    for layer in np.unique(layers):
        layer_blades = blades[layers == layer]
        assert (np.bincount(layer_blades, minlength=6) == len(layer_blades) / 6).all()
        turns = [blade for blade, _ in groupby(layer_blades.tolist())]
        step = np.remainder(np.diff(turns), 6)
        assert len(turns) % 6 == 0 and len(set(step.tolist())) == 1 and step[0] in (1, 5)


def check_outlines(run):
    """Assert that in the first layers of each hub the outermost contours of six blades come last,
    one blade after the other."""
    hub = np.argmin(np.abs(run.places[:, 2][:, None] - [centre for centre, _ in HUBS]), axis=1)
    for k in range(len(HUBS)):
        for layer in np.unique(run.layer[hub == k])[:2]:
            layer_rows = np.flatnonzero(run.layer == layer)
            last_bead = run.bead[layer_rows].max()
            means = [
                run.places[layer_rows[run.bead[layer_rows] == last_bead - back], :2].mean(axis=0)
                for back in range(6)
            ]
            turn = [math.atan2(y, x) for x, y in means]
            np.testing.assert_allclose(
                np.remainder(-np.diff(turn), 2.0 * math.pi), math.pi / 3.0, atol=0.1
            )


def check_program(run):
    """Assert that the deposit moves of the texts, in the order of the parts, have the positions,
    directions and speeds of waypoints.csv."""
    number = r"=?(-?\d+\.?\d*)"
    pattern = re.compile(
        " ".join(f"{word}{number}" for word in ("X", "Y", "Z", "A3", "B3", "C3"))
        + rf"(?:.* F{number})?"
    )
    stated_moves, feed = [], math.nan
    for name in sorted(run.texts):
        if name.endswith(".SPF"):
            for line in run.texts[name].splitlines():
                match = pattern.search(line)
                if match:
                    feed = float(match[7]) if match[7] else feed
                    stated_moves.append([*map(float, match.groups()[:6]), feed])
    stated_moves, moves = np.array(stated_moves), run.point > 0
    assert len(stated_moves) == moves.sum() > run.fewest
    assert np.abs(stated_moves[:, :3] - run.places[moves]).max() < 6e-6
    assert np.abs(stated_moves[:, 3:6] - run.tool[moves]).max() < 1.1e-6
    np.testing.assert_allclose(stated_moves[:, 6] / 60.0, run.speed[moves], rtol=1e-4)


@pytest.fixture(
    scope="module",
    params=[COARSE, pytest.param(SHIPPED, marks=pytest.mark.long)],
    ids=["coarse", "shipped"],
)
def whole(request, tmp_path_factory, root):
    folder = tmp_path_factory.mktemp("thruster")
    shutil.copytree(root / "resources" / "examples" / "thruster", folder / "thruster")
    job = folder / "thruster" / "thruster.yaml"
    text = job.read_text(encoding="utf-8")
    for key, shipped, command_words in zip(
        ("layer_height", "chord_error"), SHIPPED, request.param, strict=False
    ):
        assert f"  {key}: {shipped:g} mm\n" in text
        text = text.replace(f"  {key}: {shipped:g} mm\n", f"  {key}: {command_words:g} mm\n")
    job.write_text(text, encoding="utf-8")
    words = ["plan", str(job), "-o", str(folder / "out")]
    process = subprocess.run(
        [str(root / "freecad-am"), *words],
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "FREECAD_USER_HOME": str(folder), "PYTHONDONTWRITEBYTECODE": "1"},
        timeout=1800,  # a minute of work, on a possibly busy machine
    )
    assert process.returncode == 0, process.stderr
    return Whole(folder / "out", request.param)


def test_it_is_planned_whole(whole):
    report = whole.report
    assert report["status"] == "ok" and report["counts"]["layers"] == whole.layer.max() + 1
    assert report["counts"]["beads"] == (whole.point == 0).sum()
    moving = whole.speed[whole.point > 0] * 60.0
    assert 410.0 < moving.min() < 450.0 and 700.0 < moving.max() < 830.0
    assert whole.width.min() > 9.5 - 1e-6
    assert np.abs(np.linalg.norm(whole.tool, axis=1) - 1.0).max() < 2e-6
    assert report["joints"]["feasible"] is True
    assert "THRUSTER.MPF" in whole.texts and any("TRAORI" in text for text in whole.texts.values())
    assert {"BEAD_MODEL", "BEAD_HEIGHT"} <= {issue["code"] for issue in report["issues"]}
    assert whole.page.count("flattened</text>") == 6 and "Predicted width of the bead" in whole.page


def test_its_layers_lie_on_their_cones(whole):
    check_levels(whole)


def test_it_is_laid_around_the_axis(whole):
    check_order(whole)
    check_outlines(whole)


def test_its_program_reads_the_same(whole):
    check_program(whole)
