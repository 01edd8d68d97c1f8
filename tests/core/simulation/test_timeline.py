# SPDX-License-Identifier: LGPL-2.1-or-later
"""The timeline against the posted program and a walk through its blocks; totals against the
toolpath."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.program import DEPOSIT, DepositOff, DepositOn, LayerStart, Moves, Wait
from freecad_am.core.simulation.timeline import timeline, totals
from freecad_am.core.toolpath import Checks

PROCESS = ProcessParameters(
    lead_on=0.4,
    lead_off=0.7,
    bead_width=5.0,
    density=2.7,
    between_layers=BetweenLayersParameters(lift=20.0, wait=3.0),
)


def walk_program(motion, process, waits, rapids):
    """[(time, row, deposit on)] at the ends of every move and wait, from the blocks of a program of
    this motion."""
    events, time, is_on = [], 0.0, False
    groups = np.split(np.arange(len(motion)), np.flatnonzero(np.diff(motion.deposit)) + 1)
    layer = motion.layer[0]
    for group in groups:
        if motion.deposit[group[0]]:
            time += process.lead_on
            events.append((time, group[0], True))
            for row in group[1:]:
                time += motion.duration[row]
                events.append((time, row, True))
            time += process.lead_off
            events.append((time, group[-1], True))
            is_on = False
            continue
        new = motion.layer[group[0]] != layer
        layer = motion.layer[group[0]]
        for k, row in enumerate(group):
            if new and k == (1 if rapids >= 3 else 0):
                time += max(process.between_layers.wait, waits[layer])
            time += motion.duration[row]
            events.append((time, row, is_on))
    return events


@pytest.mark.parametrize("rapids", [2, 3])
@pytest.mark.parametrize("seed", [1, 2])
def test_times_are_those_of_a_walk_through_the_program(a_motion, seed, rapids):
    motion = a_motion(seed, rapids=rapids)
    waits = [0.0, 5.0, 1.0, 9.0]
    line = timeline(motion, PROCESS, waits)
    steps = walk_program(motion, PROCESS, waits, rapids)
    assert line.total == pytest.approx(steps[-1][0], abs=1e-9)
    assert line.total == pytest.approx(motion.duration.sum() + 8 * 1.1 + 5.0 + 3.0 + 9.0)
    times, rows = np.array([step[0] for step in steps]), np.array([step[1] for step in steps])
    state = line.state_at(times)
    assert np.abs(state.position - motion.position[rows]).max() < 1e-9
    assert np.abs(state.joints - motion.joints[rows]).max() < 1e-9
    just_before = line.state_at(times - 1e-9)
    assert (just_before.deposit == np.array([step[2] for step in steps]))[1:].all()


def test_between_rows_all_runs_straight_and_at_the_speed_asked_for(a_motion):
    """Between rows the motion is straight and has the programmed speed."""
    motion = a_motion(3)
    line = timeline(motion, PROCESS)
    random = np.random.default_rng(5)
    rows = np.flatnonzero(motion.duration > 0.0)
    share = random.uniform(0.01, 0.99, len(rows))
    state = line.state_at(line.arrive[rows] - (1.0 - share) * motion.duration[rows])
    assert (state.row == rows).all() and np.abs(state.share - share).max() < 1e-9
    for name in ("joints", "position"):
        column = getattr(motion, name)
        expected = column[rows - 1] + share[:, None] * (column[rows] - column[rows - 1])
        assert np.abs(getattr(state, name) - expected).max() < 1e-9
    assert (state.deposit == motion.deposit[rows]).all() and not state.standing.any()
    late = line.state_at(line.arrive[rows] - (1.0 - share - 1e-3) * motion.duration[rows])
    measured_speed = np.linalg.norm(late.position - state.position, axis=1) / (
        1e-3 * motion.duration[rows]
    )
    assert np.allclose(measured_speed, state.speed, rtol=1e-6)


def test_deposit_is_on_as_long_as_the_moves_of_beads_and_their_leads(a_motion):
    motion = a_motion(4)
    line = timeline(motion, PROCESS, [0.0, 5.0, 1.0, 9.0])
    when = np.linspace(0.0, line.total, 200_001)
    share = line.state_at(when).deposit.mean()
    on = motion.duration[motion.deposit].sum() + 8 * (PROCESS.lead_on + PROCESS.lead_off)
    assert share * line.total == pytest.approx(on, abs=2e-3 * on)


def test_outside_it_stays_at_the_ends_and_unreachable_joints_are_told(a_motion):
    """Before and after, the state stays at the ends; unreachable joints are NaN."""
    motion = a_motion(6)
    joints = motion.joints.copy()
    joints[10] = np.nan
    motion = dataclasses.replace(motion, joints=joints)
    line = timeline(motion, PROCESS)
    first_row, last_row = line.state_at([-5.0, line.total + 5.0]).row
    assert (first_row, last_row) == (0, len(motion) - 1)
    assert np.isnan(line.state_at(line.arrive[10]).joints).all()
    assert (
        np.isfinite(line.state_at(line.arrive[9]).joints).all()
        and np.isfinite(line.state_at(line.leave[12]).joints).all()
    )


def test_layers_begin_where_their_rapids_do(a_motion):
    motion = a_motion(7)
    line = timeline(motion, PROCESS)
    assert line.layers.tolist() == [0, 1, 2, 3]
    assert [int(motion.layer[row]) for row in line.layer_rows] == [0, 1, 2, 3]
    assert all(
        row == 0 or motion.layer[row - 1] == motion.layer[row] - 1 for row in line.layer_rows
    )
    assert (
        np.searchsorted(line.layer_rows, range(len(motion)), side="right") - 1
    ).tolist() == motion.layer.tolist()


def test_totals_are_sums_over_the_segments(a_motion):
    motion = a_motion(8)
    line = timeline(motion, PROCESS)
    path = SimpleNamespace(
        layer_height=2.0, bead_width=None, wire_feed=10.0, features=(), checks=Checks()
    )
    sums = totals(motion, line, PROCESS, path)
    beads = [
        np.flatnonzero(motion.deposit & (motion.layer == k) & (motion.bead == b))
        for k in range(4)
        for b in range(2)
    ]
    length = sum(
        np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1).sum() for rows in beads
    )
    assert sums.length == pytest.approx(length)
    assert sums.volume == pytest.approx(length * 5.0 * 2.0)
    assert sums.mass == pytest.approx(length * 10.0 / 1000.0 * 2.7)
    assert sums.fed == pytest.approx(sums.deposit_time * 10.0 * np.pi * 0.6**2)
    assert sums.time == pytest.approx(sums.deposit_time + sums.rapid_time + sums.wait_time)
    assert sums.wait_time == pytest.approx(8 * 1.1 + 3 * 3.0)
    total_length = np.linalg.norm(np.diff(motion.position, axis=0), axis=1).sum()
    assert sums.rapid_length == pytest.approx(total_length - length)


def test_a_width_that_varies_counts_by_the_trapezoid(a_motion):
    motion = a_motion(9, layers=1, beads=1, points=3)
    width = np.where(motion.deposit, 2.0 + motion.point, np.nan)
    motion = dataclasses.replace(motion, width=width)
    rows = np.flatnonzero(motion.deposit)
    steps = np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)
    path = SimpleNamespace(
        layer_height=1.5, bead_width=None, wire_feed=None, features=(), checks=Checks()
    )
    sums = totals(motion, timeline(motion, PROCESS), PROCESS, path)
    assert sums.fed is None
    assert sums.volume == pytest.approx(1.5 * (2.5 * steps[0] + 3.5 * steps[1]))


def test_the_time_is_that_of_the_programs_blocks(blocks_of):
    motion, program, process, waits = blocks_of
    line = timeline(motion, process, waits)
    leads = sum(
        block.lead for block in program.blocks if isinstance(block, (DepositOn, DepositOff))
    )
    stands = sum(block.seconds for block in program.blocks if isinstance(block, Wait))
    moves = sum(float(block.duration.sum()) for block in program.moves) - float(
        program.moves[0].duration[0]
    )
    assert line.total == pytest.approx(leads + stands + moves, rel=1e-12)
    # a wait comes after its preceding move, as in the program
    row, expected_waits = -1, {}
    for block in program.blocks:
        if isinstance(block, Moves):
            row += len(block) + (1 if block.kind == DEPOSIT else 0)
        elif isinstance(block, Wait):
            expected_waits[row] = block.seconds
    assert expected_waits and any(isinstance(block, LayerStart) for block in program.blocks)
    lit = line.lit
    for wait_row, seconds in expected_waits.items():
        assert line.waits[wait_row] - lit[wait_row] == pytest.approx(seconds)
    assert (line.waits - lit).sum() == pytest.approx(sum(expected_waits.values()))
