# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job reports keys that have no effect together with its other keys."""

import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.batch.job.job import unused_key_issues

HEAD = "version: 1\npart: {file: part.step}\nstrategy: {kind: revolution}\n"
ROBOT = "cell: {machine: fanuc-arcmate120ic, setup: "
POSITIONER = (
    "external: [{machine: motoman-motopos-d500, pose: [1500, 0, 0, 0, 0, 0], carries: part}]"
)


def unused_keys(folder, text):
    (folder / "part.step").write_text("ISO-10303-21;", encoding="ascii")
    (folder / "job.yaml").write_text(HEAD + text, encoding="utf-8")
    issues = unused_key_issues(jobs.read_job(str(folder / "job.yaml")))
    assert {issue.code for issue in issues} <= {"NO_EFFECT"}
    return [issue.message.split()[0].rstrip(":") for issue in issues]


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("program: {post: fanuc}", ["program"]),
        ("program: {post: none}", []),
        ("joints: {degree: 2}\nprogram: {post: fanuc}", ["program", "joints"]),
        (ROBOT + "part-on-robot}\njoints: {rz: 10 deg}", ["joints.rz"]),
        (ROBOT + "part-on-robot}\njoints: {rz: 10 deg, method: constant}", []),
        (ROBOT + "part-on-robot}\njoints: {rz: 10 deg, compare: [constant]}", []),
        (ROBOT + "part-on-robot, platform: 5 mm}\nprogram: {post: fanuc}", []),
        (ROBOT + "tool-on-robot, platform: 5 mm}", ["cell.platform"]),
        (ROBOT + f"tool-on-robot, platform: 5 mm, {POSITIONER}}}", []),
        (ROBOT + "tool-on-robot, nozzle: {tool: [0, 0, 100, 0, 0, 0]}}", []),
        (ROBOT + "part-on-robot, nozzle: {tool: [0, 0, 100, 0, 0, 0]}}", ["cell.nozzle.tool"]),
    ],
)
def test_keys_without_effect_are_told(tmp_path, text, keys):
    assert unused_keys(tmp_path, text + "\n") == keys
