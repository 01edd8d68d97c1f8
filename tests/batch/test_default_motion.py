# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program without `motion` gets one that its post can write, for every post and set-up, in job
files and macros."""

import itertools

import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.posts import catalogue

SETUPS = ("part-on-robot", "tool-on-robot", "rotary-table")
TEXT = """version: 1
part: {{file: part.step}}
strategy: {{kind: revolution}}
cell: {{machine: {machine}, setup: {setup}}}
program: {{post: {post}{motion}}}
"""


def write_program(post, setup, motion):
    try:
        catalogue.load(post).refuse_setup(motion, setup)
    except InputError:
        return False
    return True


def job_of(folder, **values):
    (folder / "part.step").write_text("ISO-10303-21;", encoding="ascii")
    (folder / "job.yaml").write_text(TEXT.format(**values), encoding="utf-8")
    return jobs.read_job(str(folder / "job.yaml"))


@pytest.mark.parametrize(("post", "setup"), itertools.product(catalogue.NAMES, SETUPS))
def test_the_default_motion_is_written(tmp_path, post, setup):
    job = job_of(tmp_path, machine="any", setup=setup, post=post, motion="")
    able = [motion for motion in ("joint", "cartesian") if write_program(post, setup, motion)]
    assert job.program.motion == (able[0] if able else "joint")


@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_a_motion_that_is_given_stays(tmp_path, motion):
    for post in ("kuka", "fanuc"):
        job = job_of(
            tmp_path, machine="any", setup="tool-on-robot", post=post, motion=f", motion: {motion}"
        )
        assert job.program.motion == motion
