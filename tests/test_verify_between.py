# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of a text that are not driven through both solvers are no farther off than the reported
maximum."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.read_back import points, text_path
from freecad_am.read_back.text_path import Path

CELLS = {
    "the part on the robot": {"machine": "fanuc-arcmate120ic", "limits": "paper"},
    "the torch on the robot": {"machine": "fanuc-arcmate120ic", "setup": "tool-on-robot"},
    "axes that slide": {"machine": "table-xyzac", "setup": "rotary-table"},
}


@pytest.fixture(autouse=True)
def few_at_once(monkeypatch):
    monkeypatch.setattr(text_path, "PIECE", 64)


@pytest.fixture(params=CELLS)
def cell(request):
    return cells.resolve(
        CellParameters(**CELLS[request.param]), frames.bryant((10, 20, 30, 0.1, 0.2, 0.3))
    )


def draw_axis_values(cell, seed, size):
    """Return random controller axis values of rows with steps of many sizes, up to `size` rad."""
    rng = np.random.default_rng(seed)
    step = (
        rng.normal(size=(4000, len(cell.machine.axes)))
        * 10.0 ** rng.uniform(-4, 0, (4000, 1))
        * size
    )
    step[:, cell.machine.chain.sliding] *= 100.0
    return rng, np.sin(np.cumsum(step, axis=0)) * np.where(cell.machine.chain.sliding, 150.0, 1.5)


def tip_between(cell, axis_values, ends, shares):
    """Return the tip positions (n, s, 3) at shares of the moves that end at the rows `ends`,
    computed from the frames of the chain."""
    interpolated = (
        axis_values[ends - 1, None]
        + shares[:, None] * (axis_values[ends] - axis_values[ends - 1])[:, None]
    )
    serial = cell.machine.from_controller(interpolated.reshape(-1, axis_values.shape[1]))
    return cell.tip_in_part(cell.machine.chain.forward(serial))[0].reshape(
        len(ends), len(shares), 3
    )


def off_segment(tips, start, end):
    along = end - start
    share = np.clip(
        ((tips - start[:, None]) * along[:, None]).sum(2) / (along * along).sum(1)[:, None],
        0.0,
        1.0,
    )
    return np.linalg.norm(tips - start[:, None] - share[:, :, None] * along[:, None], axis=2)


def test_the_tip_leaves_no_chord_by_more_than_its_bow(cell):
    _, axis_values = draw_axis_values(cell, 1, 0.3)
    ends, serial = np.arange(1, len(axis_values)), cell.machine.from_controller(axis_values)
    tips = tip_between(cell, axis_values, ends, np.linspace(0.0, 1.0, 21))
    straight = tips[:, :1] + np.linspace(0.0, 1.0, 21)[:, None] * (tips[:, -1:] - tips[:, :1])
    strayed, bow = (
        np.linalg.norm(tips - straight, axis=2).max(axis=1),
        points._bow(cell, serial, ends),
    )
    assert (strayed <= bow + 1e-9).all()
    assert strayed.max() > 10.0 and np.median(bow[strayed > 1e-3] / strayed[strayed > 1e-3]) < 100.0


@pytest.mark.parametrize("seed", range(4))
def test_what_is_told_is_what_all_of_them_driven_tell(cell, seed):
    """The reported maximum equals that of driving all points, for deviations and rounding of many
    sizes."""
    rng, axis_values = draw_axis_values(cell, seed, 0.01)
    ends = np.flatnonzero(rng.uniform(size=len(axis_values)) > 0.1)[1:]
    tip = tip_between(cell, axis_values, np.arange(1, len(axis_values)), np.array([0.0, 1.0]))
    tip = np.append(tip[:1, 0], tip[:, 1], axis=0)
    targets = tip + rng.normal(size=tip.shape) * 10.0 ** rng.uniform(-5, 0, (len(tip), 1))
    bound = 10.0 ** rng.uniform(-4, 1, len(tip))
    path = Path(tip, np.zeros_like(tip), bound, bound)
    largest, off = points.beads_between(
        cell, SimpleNamespace(ends=ends, position=targets), axis_values, path, 0.01
    )

    deviations = off_segment(
        tip_between(cell, axis_values, ends, np.arange(1, 6) / 6.0),
        targets[ends - 1],
        targets[ends],
    ).max(axis=1)
    allowed = 0.01 + np.maximum(bound[ends - 1], bound[ends])
    assert largest == pytest.approx(deviations.max(), abs=1e-9)
    assert 100 < np.count_nonzero(deviations > allowed) < len(ends) - 100
    assert np.array_equal(off[ends], deviations > allowed)
    assert not np.delete(off, ends).any()


def test_the_farthest_is_found_where_no_point_is_off(cell):
    _, axis_values = draw_axis_values(cell, 7, 1e-3)
    ends = np.arange(1, len(axis_values))
    tip = tip_between(cell, axis_values, ends, np.array([0.0, 1.0]))
    tip = np.append(tip[:1, 0], tip[:, 1], axis=0)
    path = Path(tip, np.zeros_like(tip), np.full(len(tip), 1e3), np.zeros(len(tip)))
    largest, off = points.beads_between(
        cell, SimpleNamespace(ends=ends, position=tip), axis_values, path, 0.0
    )
    deviations = off_segment(
        tip_between(cell, axis_values, ends, np.arange(1, 6) / 6.0), tip[ends - 1], tip[ends]
    )
    assert largest == pytest.approx(deviations.max(), abs=1e-9) and largest > 0.0
    assert not off.any()
