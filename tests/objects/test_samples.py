# SPDX-License-Identifier: LGPL-2.1-or-later
"""The samples hold results of the current code; `resources/examples/make_samples.py` renews
them."""

import json
import shutil

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.objects.results import store
from freecad_am.objects.results.findings import issues_of, message_of

pytestmark = pytest.mark.any_version

SAMPLES = ("hemisphere", "tube-on-pipe")
# on the tube, last bits of the processor's libraries decide the number of points of a bead, 1,167
# or 1,197 in total, and change the axis speeds by 0.3 and the condition by 2 %
FIGURES = {"hemisphere": 1e-8, "tube-on-pipe": 0.03}
RENEW = "run resources/examples/make_samples.py"


def figure(value, tolerance):
    """Return a figure for comparison within a tolerance."""
    number = getattr(value, "Value", value)
    if isinstance(number, (int, float)) and not isinstance(number, bool):
        return pytest.approx(number, rel=tolerance)
    return str(value)


def read(stages, tolerance):
    """Return the issues, message and figures of stages, as a user reads them."""
    return {
        stage.Name: (
            [
                (issue.level, issue.code, str(issue.where), str(issue.message))
                for issue in issues_of(stage)
            ],
            str(message_of(stage)),
            [figure(getattr(stage, name), tolerance) for name, *_ in stage.Proxy.figures],
        )
        for stage in stages
    }


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_what_is_computed_today(root, tmp_path, name):
    path = shutil.copy(root / "resources" / "examples" / "samples" / f"{name}.FCStd", tmp_path)
    document = App.openDocument(str(path))
    try:
        stages = sorted(api.stages_of(document), key=lambda stage: len(stage.OutListRecursive))
        assert len(stages) == 5
        for stage in stages:
            assert stage.Status == "up to date", stage.Label
            assert stage.Key == stage.Proxy.key(stage), f"{stage.Label} is outdated; {RENEW}"
            _, layout = stage.ResultLayout.split(" ", 1)
            assert json.loads(layout)["format"] == store.FORMAT, RENEW
        stored = read(stages, FIGURES[name])
        files = api.result(document.Program).files
        for stage in stages:
            stage.Proxy.renew(stage, force=True)
        computed = read(stages, 0.0)
        assert {stage: figures[:2] for stage, figures in computed.items()} == {
            stage: figures[:2] for stage, figures in stored.items()
        }, RENEW
        for stage, (_, _, figures) in computed.items():
            values = [getattr(value, "expected", value) for value in figures]
            assert values == stored[stage][2], RENEW
        program = api.result(document.Program).files
        if name == "hemisphere":
            assert program == files, RENEW
        assert program.keys() == files.keys(), RENEW
    finally:
        App.closeDocument(document.Name)
