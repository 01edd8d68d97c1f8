# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rates along beads against polynomials of time, and volumes against the totals."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.simulation.joint_trajectory import rates
from freecad_am.core.simulation.timeline import timeline, totals, volumes
from freecad_am.core.toolpath import Checks

PATH = SimpleNamespace(
    layer_height=2.0, bead_width=None, wire_feed=None, features=(), checks=Checks()
)


def of_time(motion, step, function):
    """The motion with equal steps of time, its joints functions (axes,) of it, within every bead."""
    joints = np.stack([function(step * row) for row in range(len(motion))])
    duration = np.where(motion.deposit & (motion.point == 0), 0.0, step)
    return dataclasses.replace(motion, joints=joints, duration=duration)


def test_rates_of_polynomials_are_exact(a_motion):
    """Over equal steps the differences of a cubic are its derivatives halfway and at the points."""
    step, a = 0.3, np.arange(1.0, 7.0)
    motion = of_time(a_motion(3), step, lambda t: a * t**3 - 2.0 * a * t**2 + 0.5 * a * t)
    found = rates(motion)
    t = step * np.arange(len(motion))
    halfway, deposit = t - 0.5 * step, motion.deposit & (motion.point > 0)
    assert np.isfinite(found.speed[deposit]).all() and np.isnan(found.speed[~deposit]).all()
    # the mean over a step of 3 t^2 is that of its middle and step^2 / 4 more
    speed = 3.0 * (halfway**2 + step**2 / 12.0) - 4.0 * halfway + 0.5
    np.testing.assert_allclose(found.speed[deposit], (speed[:, None] * a)[deposit], rtol=1e-9)
    inside = (
        deposit & np.append(deposit[1:], False) & (np.append(motion.point[1:], 0) > motion.point)
    )
    np.testing.assert_allclose(
        found.acceleration[inside], ((6.0 * t - 4.0)[:, None] * a)[inside], rtol=1e-8, atol=1e-9
    )
    assert np.isnan(found.acceleration[~inside]).all()
    between = inside & np.insert(inside[:-1], 0, False)
    np.testing.assert_allclose(
        found.jerk[between], np.broadcast_to(6.0 * a, found.jerk.shape)[between], rtol=1e-7
    )
    assert np.isnan(found.jerk[~between]).all() and between.sum() > 20


@pytest.mark.parametrize("count", [0, 1, 2])
def test_motions_of_a_row_or_none(a_motion, count):
    motion = a_motion(1)
    few = type(motion)(
        **{field.name: getattr(motion, field.name)[:count] for field in dataclasses.fields(motion)}
    )
    assert all(
        np.isnan(column).all() and column.shape == (count, 6)
        for column in dataclasses.astuple(rates(few))
    )


def test_volumes_add_up_to_the_totals_and_rapids_leave_none(a_motion):
    motion, process = a_motion(5), ProcessParameters(bead_width=7.0)
    each = volumes(motion, process, PATH)
    assert each.sum() == pytest.approx(
        totals(motion, timeline(motion, process), process, PATH).volume, rel=1e-12
    )
    assert (
        not each[~motion.deposit].any()
        and not each[motion.point == 0].any()
        and (each[motion.deposit][1:7] > 0.0).all()
    )
    plain = dataclasses.replace(motion, width=np.full(len(motion), np.nan))
    length = np.linalg.norm(np.diff(motion.position, axis=0), axis=1)[
        (motion.deposit & motion.moves)[1:]
    ].sum()
    assert volumes(plain, process, PATH).sum() == pytest.approx(14.0 * length, rel=1e-12)
