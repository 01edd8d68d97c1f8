# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions, lead, tilt and tilt-back."""

import numpy as np
import pytest

from freecad_am.core.slicing import revolution as directions


def random_directions(count=200):
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
    build, _ = random_directions()
    tool = directions.lean_tool(build, 0.3, 0.2, rising)
    assert np.linalg.norm(tool, axis=1) == pytest.approx(np.ones(len(build)), abs=1e-14)
    assert (tool * build).sum(axis=1) == pytest.approx(
        np.full(len(build), np.cos(0.3) * np.cos(0.2))
    )
    assert tool[:, 1] == pytest.approx(
        np.full(len(build), (1 if rising else -1) * np.sin(0.3) * np.cos(0.2))
    )


def test_tilt_back_turns_towards_the_axis_and_stops_there():
    build, angle = random_directions()
    back = np.random.default_rng(4).uniform(0.0, np.pi, len(build))
    turned = directions.tilt_back(build, back)
    assert directions.from_vertical(turned) == pytest.approx(
        np.maximum(angle - back, 0.0), abs=1e-12
    )
    assert np.abs(turned[:, 1]).max() == 0.0
    assert (turned[:, 0] >= 0.0).all()


def test_zero_tilt_back_keeps_directions_bit_for_bit():
    build, _ = random_directions()
    assert (directions.tilt_back(build, np.zeros(len(build))) == build).all()


def test_smallest_tilt_back_is_the_first_feasible_one():
    build, angle = random_directions()
    required = angle * np.random.default_rng(5).uniform(0.0, 0.99, len(build))
    is_infeasible = np.arange(len(build)) % 7 == 0

    def is_feasible(rows, tilt):
        return (tilt >= required[rows]) & ~is_infeasible[rows]

    tilts = directions.least_tilt_back(build, np.zeros(len(build)), is_feasible)
    assert np.isnan(tilts[is_infeasible]).all()
    assert tilts[~is_infeasible] == pytest.approx(required[~is_infeasible], abs=1e-12)
    assert (tilts >= required)[~is_infeasible].all()


def test_layer_mean_over_part_of_a_turn_is_the_mean_of_local_directions():
    tangent, start, end = np.array([-0.6, 0.8]), 0.4, 2.0
    angles = np.linspace(start, end, 7)
    c, s = np.cos(angles), np.sin(angles)
    directions_in_frame = directions.layer_mean(tangent, angles, start, end)
    in_space = np.stack(
        [
            directions_in_frame[:, 0] * c - directions_in_frame[:, 1] * s,
            directions_in_frame[:, 0] * s + directions_in_frame[:, 1] * c,
            directions_in_frame[:, 2],
        ],
        axis=1,
    )
    sine, cosine = np.sin(end) - np.sin(start), np.cos(start) - np.cos(end)
    mean = np.array([-0.6 * sine, -0.6 * cosine, 0.8 * (end - start)])
    assert in_space == pytest.approx(np.tile(mean / np.linalg.norm(mean), (7, 1)), abs=1e-9)
