# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wire volume against bead volume per second, by plain figures."""

import math
from dataclasses import replace

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.bead_classes import BeadEnd, BeadStart
from freecad_am.core.parameters.process import MaterialParameters, ProcessParameters, WireParameters
from freecad_am.core.preflight import checks
from freecad_am.core.process import wire
from freecad_am.core.process.bead_model import check_speeds
from freecad_am.core.process.wire import set_wire_feed
from freecad_am.core.toolpath import Bead, BeadEnds, BeadRole, Layer, SequencedFeature, Toolpath

ENDS = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0]])
UP = np.broadcast_to([0.0, 0.0, 1.0], (2, 3))
BEAD = Bead(ENDS, UP, UP, np.array([0.0, 1.0]), np.full(2, 6.0), False)
PATH = Toolpath((Layer((BEAD,)),), np.eye(4), 1.0, 0.1, bead_width=8.0)


def process(feed, **options):
    return ProcessParameters(wire=WireParameters(feed=feed, **options))


def test_auto_feeds_what_the_bead_takes():
    """8 x 1 mm at 6 mm/s: 48 mm3/s from a wire of 1.1310 mm2."""
    assert ProcessParameters().wire.feed == "auto"
    with_feed = set_wire_feed(PATH, ProcessParameters(), None)
    assert with_feed.wire_feed * math.pi * 0.6**2 == pytest.approx(48.0)
    assert with_feed.issues == ()
    narrow = set_wire_feed(replace(PATH, bead_width=3.0), process("auto", diameter=0.8), None)
    assert narrow.wire_feed * math.pi * 0.4**2 == pytest.approx(18.0)


def test_a_feed_that_does_not_balance_is_told_with_the_one_that_would():
    """An unbalanced feed is reported with the balanced value."""
    with_feed = set_wire_feed(PATH, process(10.0), None)
    assert with_feed.wire_feed == 10.0
    (issue,) = with_feed.issues
    assert (issue.level, issue.code) == ("warning", "FEED_BALANCE")
    assert (
        "11.31 mm3/s" in issue.message
        and "48 mm3/s" in issue.message
        and "to 42.44 mm/s" in issue.message
    )


@pytest.mark.parametrize(
    "off, told", [(0.91, False), (1.09, False), (0.89, True), (1.11, True), (0.0, False)]
)
def test_a_tenth_is_tolerated_and_no_wire_is_no_fault(off, told):
    balanced = 48.0 / (math.pi * 0.6**2)
    assert bool(set_wire_feed(PATH, process(off * balanced), None).issues) == told


def test_beads_of_a_model_are_fed_as_they_were_measured():
    model = wire.load("csw")
    assert (
        set_wire_feed(PATH, process("auto"), model).wire_feed
        == model.wire_feed
        == pytest.approx(6500.0 / 60.0)
    )
    assert set_wire_feed(PATH, process(50.0), model).wire_feed == 50.0


@pytest.mark.parametrize("diameter", [0.0, 1e-308, 9e-4])
def test_a_wire_without_a_section_is_refused(diameter):
    """The square of the smallest diameter is 0 in floats, by which the feed was divided."""
    with pytest.raises(InputError, match="give at least 0"):
        WireParameters(diameter=diameter)


# classes and phases with their own speeds: 8 x 1 mm at 6 mm/s is 48 mm3/s
SPEED_OF = {"contour": 9.0, "fill": 6.0}


def path_of(phase=None, **options):
    """A bead of 100 mm of each class at its class speed, with start and end phases of 20 and 5 mm
    if requested."""
    beads = [
        replace(
            BEAD,
            role=BeadRole(bead_class=name),
            speed=np.full(2, SPEED_OF[name]),
            ends=None if phase is None else BeadEnds(*phase),
            **options,
        )
        for name in SPEED_OF
    ]
    return replace(PATH, layers=(Layer((beads[1],)), Layer(tuple(beads))))


def test_classes_at_speeds_of_their_own_are_held_against_the_wire():
    """Classes with their own speeds are compared with the wire feed."""
    parameters = replace(process("auto"), classes="contour: travel_speed 9")
    with_feed = set_wire_feed(path_of(), parameters, None)
    (issue,) = with_feed.issues
    assert (issue.level, issue.code, issue.layer, issue.bead) == ("warning", "FEED_BALANCE", 1, 0)
    assert "feeds 48 mm3/s" in issue.message and "need contour 72 mm3/s" in issue.message
    promise = checks.wire_feed(with_feed, parameters)
    assert (
        promise.ok is False
        and promise.worst == pytest.approx(100.0 / 3.0)
        and tuple(promise.place) == (1, 0, None)
    )
    with_schedule = replace(process("auto"), classes="contour: travel_speed 9, schedule 3")
    with_feed = set_wire_feed(path_of(), with_schedule, None)
    assert with_feed.issues == ()
    promise = checks.wire_feed(with_feed, with_schedule)  # the feed of that schedule is unknown
    assert (
        promise.ok is None
        and promise.how.startswith("not checked")
        and promise.how.endswith("feed of contour")
    )
    near_balance = replace(process("auto"), classes="contour: travel_speed 6.5")
    bead = replace(BEAD, role=BeadRole(bead_class="contour"), speed=np.full(2, 6.5))
    with_feed = set_wire_feed(replace(PATH, layers=(Layer((bead,)),)), near_balance, None)
    assert with_feed.issues == () and checks.wire_feed(
        with_feed, near_balance
    ).worst == pytest.approx(100.0 * (1.0 - 6.0 / 6.5))


@pytest.mark.parametrize("planned", [False, True])
def test_starts_and_ends_at_speeds_of_their_own_are_held_against_the_wire(planned):
    """Starts and ends with their own speeds are compared with the wire feed."""
    parameters = replace(
        process("auto"),
        start=BeadStart(20.0, 3.0),
        end=BeadEnd(5.0, 12.0),
        classes="contour: travel_speed 9",
    )
    with_feed = set_wire_feed(path_of((20.0, 3.0, 5.0, 12.0)), parameters, None)
    (issue,) = with_feed.issues
    expected_rates = {
        "fill.start": 24.0,
        "contour.start": 24.0,
        "contour": 72.0,
        "contour.end": 96.0,
        "fill.end": 96.0,
    }
    assert (
        all(f"{name} {rate:g}" in issue.message for name, rate in expected_rates.items())
        and " fill 48" not in issue.message
    )
    if planned:  # with the points and speeds of the phases
        stations = np.array([0.0, 20.0, 95.0, 100.0])
        points, up = stations[:, None] * [1.0, 0.0, 0.0], np.broadcast_to([0.0, 0.0, 1.0], (4, 3))
        with_feed = replace(
            with_feed,
            layers=tuple(
                replace(
                    layer,
                    beads=tuple(
                        Bead(
                            points,
                            up,
                            up,
                            stations,
                            np.array([3.0, 3.0, bead.speed[0], 12.0]),
                            False,
                            role=bead.role,
                            ends=bead.ends,
                            phase=np.array([1.0, 1.0, 0.0, 2.0]),
                        )
                        for bead in layer.beads
                    ),
                )
                for layer in with_feed.layers
            ),
        )
    rates = {share.name: share.rate for share in wire.taken_of(with_feed)}
    assert rates == pytest.approx(expected_rates | {"fill": 48.0})
    assert checks.wire_feed(with_feed, parameters).worst == pytest.approx(
        100.0
    )  # twice the wire per mm where the torch has half the speed


def test_a_schedule_of_a_start_is_not_known_and_no_wire_is_not_checked():
    classes_text = "contour: travel_speed 9, schedule 3"
    parameters = replace(
        process("auto"), schedule=2, start=BeadStart(20.0, 3.0, 4), classes=classes_text
    )
    with_feed = set_wire_feed(path_of((20.0, 3.0, 0.0, 0.0)), parameters, None)
    assert with_feed.issues == ()
    assert checks.wire_feed(with_feed, parameters).how.endswith(
        "feed of contour, contour.start, fill.start"
    )
    none = process(0.0)
    promise = checks.wire_feed(set_wire_feed(PATH, none, None), none)
    assert promise.ok is None and promise.how.startswith("not checked")


def test_beads_of_other_widths_and_heights_at_speeds_that_follow_balance():
    """Narrower and thinner beads are printed correspondingly faster, so that they balance."""
    bead = replace(BEAD, width=np.full(2, 4.0), height=np.full(2, 0.8), speed=np.full(2, 15.0))
    path = set_wire_feed(
        replace(PATH, layers=(Layer((BEAD,)), Layer((bead,)))), ProcessParameters(), None
    )
    assert checks.wire_feed(path, ProcessParameters()).worst < 1e-9
    thick_feature = replace(path, layer_height=2.0, wire_feed=2.0 * path.wire_feed)
    slow = replace(bead, speed=np.full(2, 7.5))
    features = (SequencedFeature("", thick_feature), SequencedFeature("", path))
    sequence = replace(path, layers=(Layer((BEAD,)), Layer((slow,), feature=1)), features=features)
    assert tuple(checks.wire_feed(sequence, ProcessParameters()).place) == (
        1,
        0,
        None,
    )  # half as much in the second feature


def test_starts_and_ends_count_among_the_speeds_of_a_material():
    parameters = replace(
        ProcessParameters(), material=MaterialParameters(name="clay", slowest=4.0, fastest=10.0)
    )
    assert check_speeds(PATH, parameters).issues == ()
    for ends, low, high in (((5.0, 3.0, 0.0, 0.0), "3", "6"), ((0.0, 0.0, 5.0, 11.0), "6", "11")):
        (issue,) = check_speeds(path_of(ends), parameters).issues
        assert (
            issue.code == "MATERIAL_SPEED"
            and f"is {low} to {high.replace('6', '9')} mm/s" in issue.message
        )
