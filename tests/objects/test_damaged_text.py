# SPDX-License-Identifier: LGPL-2.1-or-later
"""If a text differs from the plan, no program is made, stored, exported or kept under its name."""

import re

import pytest

from freecad_am import api
from freecad_am.core.issues import InfeasibleError, InputError
from freecad_am.posts.fanuc import post as fanuc

DAMAGES = {
    "an angle": (
        rb"(J1=\s*)(-?\d+)\.",
        lambda match: match[1] + str(int(match[2]) + 1).encode() + b".",
    ),
    "a stop": (rb"FINE", lambda match: b"CNT50"),
    "an output": (rb"DO\[1\]=ON", lambda match: b"DO[1]=OFF"),
}


@pytest.fixture(params=DAMAGES)
def damaged(request, monkeypatch):
    """Make the post write one statement wrong, once, in the first file that has it."""
    write, (pattern, replacement) = fanuc.write, DAMAGES[request.param]

    def wrong(program):
        files = write(program)
        name = next(name for name in sorted(files) if re.search(pattern, files[name]))
        return {**files, name: re.sub(pattern, replacement, files[name], count=1)}

    monkeypatch.setattr(fanuc, "write", wrong)
    return request.param


def test_no_program_is_made_of_it(job, damaged):
    object_names = {obj.Name for obj in job.doc.Objects}
    with pytest.raises(InfeasibleError) as error_info:
        api.make_program(job.doc, job.joint_path, name="again")
    assert error_info.value.code == "NOT_VERIFIED"
    errors = [issue.code for issue in error_info.value.issues if issue.level == "error"]
    assert errors and all(code.startswith("VERIFY_") for code in errors)
    assert {obj.Name for obj in job.doc.Objects} == object_names


def test_an_existing_program_is_not_given_out_any_more(job, damaged, tmp_path):
    with pytest.raises(InfeasibleError):
        api.recompute(job.program, force=True)
    assert job.program.Status == "infeasible"
    with pytest.raises(InputError) as error_info:
        api.export(job.program, str(tmp_path))
    assert error_info.value.code == "NO_PROGRAM" and list(tmp_path.iterdir()) == []
