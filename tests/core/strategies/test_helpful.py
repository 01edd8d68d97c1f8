# SPDX-License-Identifier: LGPL-2.1-or-later
"""A proposed remedy for a nozzle contact was tested, and a remedy that failed is not proposed."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.strategies.clearance import clear_by_tilt
from freecad_am.core.strategies.clearance.clear_by_tilt import keep_clear
from tests.core.strategies.test_wall_clearance import LOCAL, NOZZLE, bead, box, codes, toolpath

ALONG = np.linspace(-10.0, 10.0, 5)[:, None] * [1.0, 0.0, 0.0]
LAYER_REMEDY = "use other layers or another direction"


def slot(half, high=30.0):
    """Walls on either side of a bead, and a distant lid that no tilt avoids."""
    return [
        box([-150, half, 0], [150, 60, high], "left"),
        box([-150, -60, 0], [150, -half, high], "right"),
    ]


def message(path):
    (issue,) = [issue for issue in path.issues if issue.code == "CLEARANCE"]
    return str(issue.message)


@pytest.mark.parametrize(("half", "angle"), [(4.0, 5), (7.0, 10)])
def test_the_half_angle_that_is_named_clears_the_nozzle(half, angle):
    """The proposed half angle clears the nozzle."""
    path = toolpath(bead(ALONG))
    text = message(keep_clear(path, slot(half), NOZZLE, dataclasses.replace(LOCAL, max_tilt=np.pi)))
    assert f"with `cell.nozzle.half_angle: {angle} deg` the nozzle is clear (tested)" in text
    assert LAYER_REMEDY not in text and "slimmer" not in text
    slim = NozzleParameters(half_angle=np.radians(angle))
    assert codes(keep_clear(path, slot(half), slim, LOCAL)) in ([], ["TILT_BACK"])


def test_a_slimmer_nozzle_that_does_not_help_is_not_named():
    text = message(
        keep_clear(
            toolpath(bead(ALONG)),
            slot(1.2, 60.0),
            NOZZLE,
            dataclasses.replace(LOCAL, max_tilt=np.pi),
        )
    )
    assert text.endswith("; with left, right out of the way the nozzle is clear (tested)")


def test_a_larger_tilt_is_named_where_that_clears_it():
    ceiling, path = [box([-60, -4, 6], [60, 60, 30], "ceiling")], toolpath(bead(ALONG))
    text = message(
        keep_clear(path, ceiling, NOZZLE, dataclasses.replace(LOCAL, max_tilt=np.radians(20.0)))
    )
    assert "with `build_direction.max_tilt: 65 deg` the nozzle is clear" in text
    wide = dataclasses.replace(LOCAL, max_tilt=np.radians(65.0))
    assert codes(keep_clear(path, ceiling, NOZZLE, wide)) == ["TILT_BACK"]


def test_what_gives_room_at_the_points_and_not_to_the_bead_is_not_named(monkeypatch):
    """On real brackets in curved layers a slimmer nozzle was proposed and did not help: each point
    then had a clear tilt, but no tilt path joined them."""
    half_angles = []

    def fail_to_clear(path, bodies, nozzle, *arguments, **options):
        half_angles.append(nozzle.half_angle)
        return dataclasses.replace(path, issues=failed_issues)

    failed = keep_clear(
        toolpath(bead(ALONG)),
        slot(4.0),
        NOZZLE,
        dataclasses.replace(LOCAL, max_tilt=np.pi),
        remedy=False,
    )
    failed_issues = failed.issues
    monkeypatch.setattr(clear_by_tilt, "keep_clear", fail_to_clear)
    text = message(
        keep_clear(
            toolpath(bead(ALONG)), slot(4.0), NOZZLE, dataclasses.replace(LOCAL, max_tilt=np.pi)
        )
    )
    assert half_angles and "the nozzle is clear" not in text
    attempts = "`cell.nozzle.half_angle: 5 deg`, left, right out of the way"
    assert f"; the nozzle still touches with {attempts} (all tested); {LAYER_REMEDY}" in text
