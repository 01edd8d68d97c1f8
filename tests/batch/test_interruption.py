# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ctrl-C at any moment gives status 130, leaves no half-written file and keeps the earlier
outputs."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest


def interrupted(workshop, words, delay, whom=os.kill):
    """Start a command, interrupt it after some seconds, and return its end."""
    process = subprocess.Popen(
        [str(workshop.launcher), *words],
        cwd=workshop.folder,
        env=workshop.environment(),
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    time.sleep(delay)
    if process.poll() is None:
        whom(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    return process.returncode, out, err


def slow_job(workshop):
    return workshop.change(
        "layer_height: 4 mm\n  chord_error: 0.1 mm", "layer_height: 0.2 mm\n  chord_error: 0.001 mm"
    )


@pytest.mark.parametrize("whom", [os.kill, os.killpg], ids=["the command", "its whole group"])
@pytest.mark.parametrize("after", [0.4, 0.8, 1.6])
def test_nothing_is_half_written(workshop, after, whom):
    slow_job(workshop)
    status, out, err = interrupted(workshop, ["plan", "cup.yaml"], after, whom)
    assert status == 130
    assert "Traceback" not in err
    assert out == ""
    assert not (workshop.folder / "out").exists()


def test_earlier_outputs_stay_whole(workshop):
    assert workshop.run("plan", "cup.yaml").status == 0
    outputs = workshop.files()
    slow_job(workshop)
    assert interrupted(workshop, ["plan", "cup.yaml"], 1.2)[0] == 130
    assert workshop.files() == outputs


def test_a_batch_stops_with_its_rows(workshop):
    slow_job(workshop)
    (workshop.folder / "rows.csv").write_text(
        "process.travel_speed\n" + "".join(f"{k} mm/s\n" for k in range(4, 10))
    )
    status, _, err = interrupted(
        workshop, ["batch", "rows.csv", "--job", "cup.yaml", "-j", "2", "-o", "rows"], 2.0
    )
    assert status == 130
    assert "Traceback" not in err
    top = workshop.folder / "rows"
    complete = {"cup.FCStd", "waypoints.csv", "report.json", "report.html"}
    assert not list(top.rglob(".unfinished*"))
    for folder in filter(Path.is_dir, top.iterdir()) if top.exists() else ():
        assert complete <= {path.name for path in folder.iterdir()}
    time.sleep(0.5)
    assert not list(top.rglob(".unfinished*"))


def test_signals_left_ignored_by_a_shell_in_the_background_are_heard(workshop):
    slow_job(workshop)
    process = subprocess.run(
        [
            "sh",
            "-c",
            f"'{workshop.launcher}' plan cup.yaml & pid=$!; sleep 1; kill -INT $pid; wait $pid; echo $?",
        ],
        cwd=workshop.folder,
        env=workshop.environment(),
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert process.stdout.strip() == "130"
    assert not (workshop.folder / "out").exists()
