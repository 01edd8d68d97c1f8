# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions, lead, tilt and tilt-back."""

import numpy as np
import pytest

from freecad_am.core.slicing import revolution as directions


def some_builds(count=200):
    angle = np.random.default_rng(3).uniform(0.05, np.pi - 0.05, count)
    return np.stack([np.sin(angle), np.zeros(count), np.cos(angle)], axis=1), angle


@pytest.mark.parametrize("rising", [True, False])
def test_lead_turns_forward_and_tilt_outward(rising):
    build = np.array([[0.0, 0.0, 1.0]])
    forward = np.array([[0.0, 1.0 if rising else -1.0, 0.0]])
    outward = np.array([[1.0, 0.0, 0.0]])
    lead, tilt = 0.3, 0.2
    assert directions.lean_tool(build, lead, 0.0, rising) == pytest.approx(
        np.cos(lead) * build + np.sin(lead) * forward
    )
    assert directions.lean_tool(build, 0.0, tilt, rising) == pytest.approx(
        np.cos(tilt) * build + np.sin(tilt) * outward
    )


@pytest.mark.parametrize("rising", [True, False])
def test_lead_and_tilt_keep_their_angles_on_any_wall(rising):
    build, _ = some_builds()
    tool = directions.lean_tool(build, 0.3, 0.2, rising)
    assert np.linalg.norm(tool, axis=1) == pytest.approx(np.ones(len(build)), abs=1e-14)
    assert (tool * build).sum(axis=1) == pytest.approx(
        np.full(len(build), np.cos(0.3) * np.cos(0.2))
    )
    assert tool[:, 1] == pytest.approx(
        np.full(len(build), (1 if rising else -1) * np.sin(0.3) * np.cos(0.2))
    )


def test_tilt_back_turns_towards_the_axis_and_stops_there():
    build, angle = some_builds()
    back = np.random.default_rng(4).uniform(0.0, np.pi, len(build))
    turned = directions.tilt_back(build, back)
    assert directions.from_vertical(turned) == pytest.approx(
        np.maximum(angle - back, 0.0), abs=1e-12
    )
    assert np.abs(turned[:, 1]).max() == 0.0
    assert (turned[:, 0] >= 0.0).all()


def test_no_tilt_back_changes_nothing_to_the_bit():
    build, _ = some_builds()
    assert (directions.tilt_back(build, np.zeros(len(build))) == build).all()


def test_the_least_tilt_back_is_the_first_good_one():
    build, angle = some_builds()
    wanted = angle * np.random.default_rng(5).uniform(0.0, 0.99, len(build))
    hopeless = np.arange(len(build)) % 7 == 0

    def good(rows, tilt):
        return (tilt >= wanted[rows]) & ~hopeless[rows]

    found = directions.least_tilt_back(build, np.zeros(len(build)), good)
    assert np.isnan(found[hopeless]).all()
    assert found[~hopeless] == pytest.approx(wanted[~hopeless], abs=1e-12)
    assert (found >= wanted)[~hopeless].all()


def test_one_direction_for_a_part_of_a_turn_is_the_mean_of_the_local_ones():
    tangent, start, end = np.array([-0.6, 0.8]), 0.4, 2.0
    at = np.linspace(start, end, 7)
    c, s = np.cos(at), np.sin(at)
    found = directions.layer_mean(tangent, at, start, end)
    in_space = np.stack(
        [found[:, 0] * c - found[:, 1] * s, found[:, 0] * s + found[:, 1] * c, found[:, 2]], axis=1
    )
    sine, cosine = np.sin(end) - np.sin(start), np.cos(start) - np.cos(end)
    mean = np.array([-0.6 * sine, -0.6 * cosine, 0.8 * (end - start)])
    assert in_space == pytest.approx(np.tile(mean / np.linalg.norm(mean), (7, 1)), abs=1e-9)
