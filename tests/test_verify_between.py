# SPDX-License-Identifier: LGPL-2.1-or-later
"""Between points of a text: what is not driven there is neither off nor farther away than what is told."""

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


def drawn(cell, seed, size):
    """Axis values, as a controller counts them, of rows whose steps are of many sizes, up to `size` rad."""
    rng = np.random.default_rng(seed)
    step = (
        rng.normal(size=(4000, len(cell.machine.axes)))
        * 10.0 ** rng.uniform(-4, 0, (4000, 1))
        * size
    )
    step[:, cell.machine.chain.sliding] *= 100.0
    return rng, np.sin(np.cumsum(step, axis=0)) * np.where(cell.machine.chain.sliding, 150.0, 1.5)


def on_the_way(cell, shown, ends, shares):
    """(n, s, 3) where the tip is at shares of the way to the rows `ends`, as the frames of the chain tell it."""
    way = shown[ends - 1, None] + shares[:, None] * (shown[ends] - shown[ends - 1])[:, None]
    serial = cell.machine.from_controller(way.reshape(-1, shown.shape[1]))
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
    _, shown = drawn(cell, 1, 0.3)
    ends, serial = np.arange(1, len(shown)), cell.machine.from_controller(shown)
    tips = on_the_way(cell, shown, ends, np.linspace(0.0, 1.0, 21))
    straight = tips[:, :1] + np.linspace(0.0, 1.0, 21)[:, None] * (tips[:, -1:] - tips[:, :1])
    strayed, bow = (
        np.linalg.norm(tips - straight, axis=2).max(axis=1),
        points._bow(cell, serial, ends),
    )
    assert (strayed <= bow + 1e-9).all()
    assert strayed.max() > 10.0 and np.median(bow[strayed > 1e-3] / strayed[strayed > 1e-3]) < 100.0


@pytest.mark.parametrize("seed", range(4))
def test_what_is_told_is_what_all_of_them_driven_tell(cell, seed):
    """With points that are off by many sizes, and digits that explain many sizes."""
    rng, shown = drawn(cell, seed, 0.01)
    ends = np.flatnonzero(rng.uniform(size=len(shown)) > 0.1)[1:]
    tip = on_the_way(cell, shown, np.arange(1, len(shown)), np.array([0.0, 1.0]))
    tip = np.append(tip[:1, 0], tip[:, 1], axis=0)
    wanted = tip + rng.normal(size=tip.shape) * 10.0 ** rng.uniform(-5, 0, (len(tip), 1))
    bound = 10.0 ** rng.uniform(-4, 1, len(tip))
    path = Path(tip, np.zeros_like(tip), bound, bound)
    largest, off = points.beads_between(
        cell, SimpleNamespace(ends=ends, position=wanted), shown, path, 0.01
    )

    apart = off_segment(
        on_the_way(cell, shown, ends, np.arange(1, 6) / 6.0), wanted[ends - 1], wanted[ends]
    ).max(axis=1)
    allowed = 0.01 + np.maximum(bound[ends - 1], bound[ends])
    assert largest == pytest.approx(apart.max(), abs=1e-9)
    assert 100 < np.count_nonzero(apart > allowed) < len(ends) - 100
    assert np.array_equal(off[ends], apart > allowed)
    assert not np.delete(off, ends).any()


def test_the_farthest_is_found_where_no_point_is_off(cell):
    _, shown = drawn(cell, 7, 1e-3)
    ends = np.arange(1, len(shown))
    tip = on_the_way(cell, shown, ends, np.array([0.0, 1.0]))
    tip = np.append(tip[:1, 0], tip[:, 1], axis=0)
    path = Path(tip, np.zeros_like(tip), np.full(len(tip), 1e3), np.zeros(len(tip)))
    largest, off = points.beads_between(
        cell, SimpleNamespace(ends=ends, position=tip), shown, path, 0.0
    )
    apart = off_segment(
        on_the_way(cell, shown, ends, np.arange(1, 6) / 6.0), tip[ends - 1], tip[ends]
    )
    assert largest == pytest.approx(apart.max(), abs=1e-9) and largest > 0.0
    assert not off.any()
