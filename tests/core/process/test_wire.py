# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wire against bead: volumes per second by plain figures."""

import math
from dataclasses import replace

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.process import bead_table
from freecad_am.core.process.wire import fed
from freecad_am.core.toolpath import Bead, Layer, Toolpath

ENDS = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0]])
UP = np.broadcast_to([0.0, 0.0, 1.0], (2, 3))
BEAD = Bead(ENDS, UP, UP, np.array([0.0, 1.0]), np.full(2, 6.0), False)
PATH = Toolpath((Layer((BEAD,)),), np.eye(4), 1.0, 0.1, bead_width=8.0)


def process(feed, **more):
    return ProcessParameters(wire=WireParameters(feed=feed, **more))


def test_auto_feeds_what_the_bead_takes():
    """8 x 1 mm at 6 mm/s: 48 mm3/s, of a wire of 1.1310 mm2."""
    assert ProcessParameters().wire.feed == "auto"
    made = fed(PATH, ProcessParameters(), None)
    assert made.wire_feed * math.pi * 0.6**2 == pytest.approx(48.0)
    assert made.issues == ()
    narrow = fed(replace(PATH, bead_width=3.0), process("auto", diameter=0.8), None)
    assert narrow.wire_feed * math.pi * 0.4**2 == pytest.approx(18.0)


def test_a_feed_that_does_not_balance_is_told_with_the_one_that_would():
    made = fed(PATH, process(10.0), None)
    assert made.wire_feed == 10.0
    (issue,) = made.issues
    assert (issue.level, issue.code) == ("warning", "FEED_BALANCE")
    assert "11.31 mm3/s" in issue.message and "48 mm3/s" in issue.message and "to 42.44 mm/s" in issue.message


@pytest.mark.parametrize("off, told", [(0.91, False), (1.09, False), (0.89, True), (1.11, True), (0.0, False)])
def test_a_tenth_is_tolerated_and_no_wire_is_no_fault(off, told):
    balanced = 48.0 / (math.pi * 0.6**2)
    assert bool(fed(PATH, process(off * balanced), None).issues) == told


def test_beads_of_a_model_are_fed_as_they_were_measured():
    model = bead_table.load("csw")
    assert fed(PATH, process("auto"), model).wire_feed == model.wire_feed == pytest.approx(6500.0 / 60.0)
    assert fed(PATH, process(50.0), model).wire_feed == 50.0


@pytest.mark.parametrize("diameter", [0.0, 1e-308, 9e-4])
def test_a_wire_without_a_section_is_refused(diameter):
    """The square of the thinnest is 0 in floats, by which the feed was divided."""
    with pytest.raises(InputError, match="give at least 0"):
        WireParameters(diameter=diameter)
