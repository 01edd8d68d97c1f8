# SPDX-License-Identifier: LGPL-2.1-or-later
"""The samples hold what the code of today computes: `resources/examples/make_samples.py` renews them."""

import json
import shutil

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.objects.results import store
from freecad_am.objects.results.findings import issues_of, message_of

SAMPLES = ("hemisphere", "tube-on-pipe")
RENEW = "run resources/examples/make_samples.py"


def figure(value):
    """A figure without the last digits, in which FreeCAD's versions differ."""
    number = getattr(value, "Value", value)
    return f"{number:.9g}" if isinstance(number, float) else str(value)


def read(stages):
    """The findings, message and figures of stages, as a user reads them."""
    return {
        stage.Name: (
            [
                (issue.level, issue.code, str(issue.where), str(issue.message))
                for issue in issues_of(stage)
            ],
            str(message_of(stage)),
            [figure(getattr(stage, name)) for name, *_ in stage.Proxy.figures],
        )
        for stage in stages
    }


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_what_is_computed_today(root, tmp_path, name):
    path = shutil.copy(root / "resources" / "examples" / "samples" / f"{name}.FCStd", tmp_path)
    document = App.openDocument(str(path))
    try:
        stages = sorted(api.stages_of(document), key=lambda one: len(one.OutListRecursive))
        assert len(stages) == 5
        for stage in stages:
            assert stage.Status == "up to date", stage.Label
            assert stage.Key == stage.Proxy.key(stage), f"{stage.Label} is outdated; {RENEW}"
            _, layout = stage.ResultLayout.split(" ", 1)
            assert json.loads(layout)["format"] == store.FORMAT, RENEW
        stored = read(stages)
        files = api.result(document.Program).files
        for stage in stages:
            stage.Proxy.renew(stage, force=True)
        assert read(stages) == stored, RENEW
        assert api.result(document.Program).files == files, RENEW
    finally:
        App.closeDocument(document.Name)
