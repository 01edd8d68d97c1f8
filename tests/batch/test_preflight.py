# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures in the preflight of a report agree with the waypoints and the machine file, computed
here independently."""

import csv
import io
import json

import numpy as np
import pytest

LIMITS, SPEEDS = (
    "Every axis stays within its limits",
    "No axis exceeds its maximum speed",
)
TEXT, NOZZLE = (
    "The program moves the tool to the planned points",
    ("The nozzle stays clear of deposit, part and platform while depositing"),
)


def planned(workshop, text=None, page=False):
    """Return exit status, report and the rows of waypoints.csv of the job, or of a changed text of
    it."""
    workshop.write_job(text or workshop.text)
    command = workshop.run("plan", workshop.job, *(() if page else ("--no-page",)))
    files = workshop.files()
    report = json.loads(files["report.json"])
    rows = list(csv.DictReader(io.StringIO(files["waypoints.csv"].decode())))
    promises = {entry["promise"]: entry for entry in report["preflight"]}
    assert len(promises) == len(report["preflight"])
    keys = {"promise", "how", "worst", "unit", "bound", "at_least", "place", "ok"}
    assert all(set(entry) == keys for entry in promises.values())
    return command.status, promises, rows, files


def joints(rows):
    return np.array([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in rows])


def test_the_figures_are_those_of_the_waypoints(workshop, root):
    status, promises, rows, files = planned(workshop, page=True)
    assert status == 0
    # a solid ball is printed as a skin, and nothing else is wrong with it
    broken = [name for name, entry in promises.items() if entry["ok"] is False]
    assert broken == ["The whole part is deposited"]
    assert (
        promises[NOZZLE]["ok"] is True
        and promises[NOZZLE]["worst"] == 0.0
        and "platform" in promises[NOZZLE]["how"]
    )
    ball_volume = 2.0 / 3.0 * np.pi * 4.0**3
    assert 0.4 * ball_volume < promises["The whole part is deposited"]["worst"] < 0.6 * ball_volume
    assert promises["The deposit lies on the part"]["ok"] is True
    assert promises["Every bead is supported from below"]["worst"] == 0.0
    rapids = promises["The nozzle stays clear on rapids"]
    assert (
        rapids["ok"] is True
        and (rapids["worst"], rapids["unit"]) == (0.0, "rapids")
        and " 0.5 mm apart" in rapids["how"]
    )
    values = joints(rows)
    worst = promises[LIMITS]
    # the smallest distance of any row to any limit, rapids included
    machine = json.loads((root / "freecad_am/machines/fanuc-arcmate120ic.json").read_text())
    low, high = limits_of(machine, "paper")
    margin = np.minimum(values - low, high - values)
    assert worst["ok"] is True and worst["unit"] == "deg"
    assert worst["worst"] == pytest.approx(
        np.nanmin(np.where(np.isfinite(margin), margin, np.nan)), abs=1e-5
    )
    row = rows[int(np.nanargmin(np.where(np.isfinite(margin), margin, np.nan)) // 6)]
    assert {key: int(row[key]) for key in ("layer", "bead", "point")} == worst["place"]
    # the text deviates from the plan by no more than its rounding
    assert (
        promises[TEXT]["ok"] is True
        and 0.0 < promises[TEXT]["worst"] <= promises[TEXT]["bound"] < 0.1
    )
    assert "PyKDL" in promises[TEXT]["how"]
    # no unchecked promise is green
    unchecked = [entry for entry in promises.values() if entry["ok"] is None]
    assert any("UFRAME" in entry["promise"] for entry in unchecked)
    assert all(entry["how"].startswith("not checked") for entry in unchecked)
    page = files["report.html"].decode()
    assert page.count('<td class="good">kept') == sum(
        entry["ok"] is True for entry in promises.values()
    )
    assert page.count('<td class="unknown">not checked') == len(unchecked)
    assert page.count('<td class="error">broken') == len(broken)


def limits_of(machine, name):
    """Return the lower and upper limits (6,) of a set in deg, infinite where there is none. Coupled
    limits are left out."""
    pairs = [
        (-np.inf, np.inf) if pair is None else pair for pair in machine["limits"][name]["axes"]
    ]
    low, high = zip(*pairs, strict=True)
    return np.array(low, float), np.array(high, float)


def test_what_was_not_looked_at_is_never_green(workshop):
    text = workshop.text.replace("cell:\n", "build_direction: {clearance: none}\ncell:\n")
    _, promises, _, _ = planned(workshop, text)
    assert promises[NOZZLE]["ok"] is None and "build_direction.clearance" in promises[NOZZLE]["how"]


def test_a_job_without_a_cell_promises_nothing_of_joints(workshop):
    head, _, cell_and_more = workshop.text.partition("cell:\n")
    status, promises, _, _ = planned(
        workshop,
        head + cell_and_more[cell_and_more.index("process:") : cell_and_more.index("program:")],
    )
    assert status == 0
    assert (
        promises[LIMITS]["ok"] is None
        and promises[SPEEDS]["ok"] is None
        and promises[TEXT]["ok"] is None
    )


@pytest.mark.parametrize(
    ("change", "broken"),
    [
        pytest.param(
            "joints: {min_condition: 0.9}\n",
            {"The tool stays away from singularities while depositing"},
            marks=pytest.mark.long,
        ),
        (
            "deposition_point: [1900, -900, 653, 0, 0, 0]",
            {"The joint values reach every planned point"},
        ),
    ],
)
def test_a_job_that_cannot_be_done_says_which_promise_is_broken(workshop, change, broken):
    text = workshop.text.replace("layer_height: 4 mm", "layer_height: 20 mm")
    text = (
        text.replace("process:\n", f"{change}process:\n")
        if change.startswith("joints")
        else (text.replace("  limits: paper\n", f"  limits: paper\n  {change}\n"))
    )
    status, promises, rows, _ = planned(workshop, text)
    assert status == 3
    assert {name for name, entry in promises.items() if entry["ok"] is False} >= broken
    for name in broken:
        location = promises[name]["place"]
        assert any(all(int(row[key]) == location[key] for key in location) for row in rows)
    assert promises[TEXT]["ok"] is None
