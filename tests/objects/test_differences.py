# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers come back from differences to the last bit, all of them or some alone."""

import zlib

import numpy as np
import pytest

from freecad_am.objects.results import differences

PIECE = differences.PIECE


def unpacked(numbers):
    return differences.Unpacked(differences.packed(numbers), len(numbers))


def same(one, other):
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def lists():
    random = np.random.default_rng(8)
    turn = np.linspace(0.0, 40.0 * np.pi, 3 * PIECE + 5)
    yield "none", np.zeros(0)
    yield "one", np.array([-1e300])
    yield "circle", 45.0 * np.cos(turn)
    yield "noise", random.normal(size=2 * PIECE)
    yield "any bits", random.integers(0, 2**64, 2 * PIECE, dtype=np.uint64).view(np.float64)
    yield (
        "special",
        np.array(
            [0.0, -0.0, np.inf, -np.inf, np.nan, -np.nan, 5e-324, -5e-324, 1.7976931348623157e308]
        ),
    )
    yield "whole", np.arange(PIECE + 1.0) - 99.0
    yield "steps", np.repeat(random.normal(size=500), 40)
    yield "circle and noise", np.concatenate([45.0 * np.sin(turn), random.normal(size=77), -turn])


@pytest.mark.parametrize("numbers", [pytest.param(numbers, id=name) for name, numbers in lists()])
def test_all_and_any_part_come_back(numbers):
    assert same(unpacked(numbers)[:], numbers)
    random = np.random.default_rng(len(numbers))
    some = unpacked(numbers)
    for start, end in np.sort(random.integers(0, len(numbers) + 1, (40, 2)), axis=1).tolist():
        assert same(some[start:end], numbers[start:end])
    assert not some[:].flags.writeable


def test_what_is_smooth_takes_less_than_a_third():
    """Also where it passes zero, and with the rounding of what computed it. Noise takes hardly more than it is."""
    turn = np.linspace(0.0, 71 * 2.0 * np.pi, 100_000)
    for smooth in (
        45.0 * np.cos(turn),
        0.3 + 0.1 * np.sin(turn),
        np.hypot(300.0 + np.cos(turn), 40.0 * np.sin(turn)),
    ):
        assert sum(map(len, differences.packed(smooth))) < 8 * len(smooth) / 3
    noise = np.random.default_rng(1).normal(size=100_000)
    assert sum(map(len, differences.packed(noise))) < 1.01 * 8 * len(noise)


def test_a_part_reads_no_more_than_its_pieces(monkeypatch):
    numbers = np.random.default_rng(3).normal(size=10 * PIECE)
    some, read = unpacked(numbers), []
    decompress = zlib.decompress
    monkeypatch.setattr(
        zlib, "decompress", lambda data, **more: read.append(1) or decompress(data, **more)
    )
    assert (
        same(some[3 * PIECE - 1 : 4 * PIECE], numbers[3 * PIECE - 1 : 4 * PIECE]) and len(read) == 2
    )
    assert len(some[2 * PIECE : 4 * PIECE]) == 2 * PIECE and len(read) == 2
    assert len(some[PIECE:PIECE]) == 0 and len(read) == 2


def test_damaged_ones_are_told():
    numbers = np.cos(np.linspace(0.0, 9.0, PIECE + 10))
    whole = differences.packed(numbers)
    for count in (1, 3):
        with pytest.raises(ValueError, match="cut short"):
            differences.Unpacked((whole * 2)[:count], len(numbers))
    other = bytes([99]) + whole[1][1:]
    for bad in (
        [whole[0], whole[1][:-1]],
        [whole[0], b""],
        [whole[0], other],
        whole[::-1],
        [whole[0], b"1" + whole[1]],
    ):
        with pytest.raises((ValueError, zlib.error)):
            differences.Unpacked(bad, len(numbers))[:]
