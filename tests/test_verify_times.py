# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs in whole milliseconds may round moves that are shorter, but no more than that: the check
neither rejects a correct program nor passes a slow one."""

import numpy as np
import pytest

from freecad_am.core.program import Moves
from freecad_am.posts.fanuc import records as fanuc_numbers
from freecad_am.read_back import interpolation


def written_times(seconds):
    """Return times (n,) in s as a FANUC listing states them."""
    n = len(seconds)
    moves = Moves("deposit", 0, 0, np.zeros((n, 6)), np.asarray(seconds), np.ones(n))
    return np.array(
        [float(word.removesuffix("msec")) / 1000.0 for word in fanuc_numbers.time_words(moves)]
    )


def slack(seconds):
    return interpolation.MILLISECOND + 1e-9 + interpolation.owed(np.asarray(seconds))


@pytest.mark.parametrize("seed", range(20))
def test_what_is_written_is_within_what_is_owed(seed):
    random = np.random.default_rng(seed)
    seconds = random.choice([1e-8, 2e-5, 4e-4, 0.0016, 0.02], 300, p=[0.3, 0.2, 0.1, 0.1, 0.3])
    listed_times = written_times(seconds)
    assert (
        listed_times.sum() == pytest.approx(seconds.sum(), abs=5.1e-4)
        and listed_times.min() >= 0.001
    )
    assert (listed_times - seconds <= 0.001 + 1e-9).all()
    assert (seconds - listed_times <= slack(seconds)).all()
    assert (
        seconds - listed_times > 0.001 + 1e-9
    ).any()  # without the carried-over rounding some of them would be rejected


def test_nothing_is_owed_where_every_move_has_a_millisecond():
    assert (interpolation.owed(np.linspace(0.001, 3.0, 50)) == 0.0).all()


def test_a_debt_ends_with_the_next_move_that_is_long_enough():
    seconds = np.array([0.5, 0.5, 1e-6, 1e-6, 0.0015, 0.5, 0.5])
    owed = interpolation.owed(seconds)
    assert owed[[0, 6]] == pytest.approx(0.0)
    assert owed[[1, 5]] == pytest.approx([0.001998, 0.001498])
    assert owed[4] == pytest.approx(0.001998)


def test_moves_without_a_time_and_endless_ones_owe_nothing():
    assert np.isfinite(interpolation.owed(np.array([np.nan, np.inf, 0.002, 1e-6, np.inf]))).all()
