# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job for a five-axis machine: programs of both controllers in both motions, and removal of an
earlier run's files."""

import pytest

JOB = """\
version: 1
name: cup
part: {file: cup.step}
strategy: {layer_height: 4 mm, chord_error: 0.1 mm}
cell: {machine: table-xyzac, setup: rotary-table, platform: 60 mm}
process: {travel_speed: 6 mm/s}
program: {post: POST, motion: MOTION, max_points: MOST, nc: {feed: FEED}}
"""


def job(post, motion, max_points=2000, feed="time"):
    return (
        JOB.replace("POST", post)
        .replace("MOTION", motion)
        .replace("MOST", str(max_points))
        .replace("FEED", feed)
    )


@pytest.mark.parametrize(("post", "motion"), [("siemens", "joint"), ("linuxcnc", "cartesian")])
def test_parts_of_an_earlier_run_are_removed_and_nothing_else(workshop, post, motion):
    main, part_name = (
        ("CUP.MPF", "CUP{:02d}.SPF") if post == "siemens" else ("cup.ngc", "cup{:02d}.ngc")
    )
    workshop.write_job(job(post, motion, 100, "path"))
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 0, command.err
    longer = {name for name in workshop.files() if name.startswith("program/")}
    part_names = [part_name.format(number) for number in range(1, len(longer))]
    assert longer == {f"program/{name}" for name in (main, *part_names)} and len(longer) > 3
    folder = workshop.folder / "out" / "cup" / "program"
    theirs = {"clean.ngc", "CLEAN.SPF", "CUPBOARD01.SPF", "other.MPF"}
    for name in theirs:
        (folder / name).write_text("mine")
    workshop.write_job(job(post, motion))
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    remaining = {name for name in workshop.files() if name.startswith("program/")}
    assert remaining == {f"program/{name}" for name in theirs | {main}}


def test_a_robot_is_told_which_controllers_it_has(workshop):
    workshop.write_job(
        job("linuxcnc", "joint").replace("table-xyzac, setup: rotary-table", "fanuc-arcmate120ic")
    )
    command = workshop.run("plan", "cup.yaml")
    assert (
        command.status == 2
        and command.err.startswith("error[WRONG_CONTROLLER]")
        and "use one of fanuc" in command.err
    )


@pytest.mark.parametrize(("keys", "code", "key"), [
    ("nc: {deposit_on: M7}", "DEPOSIT_WORD", "nc.deposit_off"),
    ("nc: {deposit_on: M7, deposit_off: M7}", "DEPOSIT_WORD", "nc.deposit_off"),
    ("nc: {deposit_on: start, deposit_off: M9}", "DEPOSIT_WORD", "nc.deposit_on"),
    ("nc: {feed: fast}", "BAD_VALUE", "nc.feed"),
    ("nc: {tolerance: 0 mm}", "BAD_VALUE", "nc.tolerance"), ("deposit_output: 100", "DEPOSIT_OUTPUT", "deposit_output"),
    ("nc: {wire_output: 0}", "BAD_VALUE", "nc.wire_output"), ("nc: {wire_gain: 0}", "BAD_VALUE", "nc.wire_gain"),
])  # fmt: skip
def test_keys_that_cannot_be(workshop, keys, code, key):
    text = (
        job("siemens", "joint").partition("program:")[0] + f"program: {{post: siemens, {keys}}}\n"
    )
    workshop.write_job(text)
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 2 and command.err.startswith(
        f"error[{code}] cup.yaml: program.{key}"
    ), command.err
