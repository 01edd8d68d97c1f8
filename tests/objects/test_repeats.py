# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stands in a list before is left out and comes back bit for bit."""

import numpy as np
import pytest

from freecad_am.objects.results import repeats, store

NO_RUNS, NO_COPIES = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 3), dtype=np.int64)


def same(one, other):
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def there_and_back(numbers):
    """The whole and random parts; the rest of what is without runs, and its copies."""
    once, runs = repeats.without_runs(numbers)
    rest, copies = repeats.folded(once)
    whole = repeats.Unfolded(rest, copies, len(once), runs)
    assert same(whole.part(0, len(numbers)), numbers)
    random = np.random.default_rng(len(numbers))
    for start, end in np.sort(random.integers(0, len(numbers) + 1, (50, 2)), axis=1).tolist():
        assert same(whole.part(start, end - start), numbers[start:end])
    for start, size in ((-1, 1), (0, len(numbers) + 1), (len(numbers), 1)):
        with pytest.raises(ValueError, match="cut short"):
            whole.part(start, size)
    return rest, copies


@pytest.mark.parametrize("seed", range(20))
def test_any_list_comes_back(seed):
    """Random ones with stretches repeated anywhere, also of repetitions, runs, patterns, and numbers that equal no other."""
    random = np.random.default_rng(seed)
    parts = [random.normal(size=random.integers(0, 3000))]
    for kind in random.integers(0, 5, 60):
        before = np.concatenate(parts)
        start = random.integers(0, len(before) + 1)
        run = np.full(random.integers(1, 900), random.choice([0.0, -0.0, np.nan, np.inf, 1.5]))
        parts.append(
            [
                before[start : start + random.integers(0, 3000)],
                random.normal(size=random.integers(1, 200)),
                run,
                np.tile(random.normal(size=random.integers(1, 6)), random.integers(1, 200)),
                np.arange(len(run)).astype(float),
            ][kind]
        )
    there_and_back(np.concatenate(parts))


def test_every_long_repetition_is_found_whole():
    random = np.random.default_rng(5)
    pieces = [
        random.normal(size=n) for n in random.integers(repeats.SHORTEST + repeats.EVERY, 1500, 200)
    ]
    between = [random.normal(size=n) for n in random.integers(1, 9, 200)]
    first = np.concatenate(pieces)
    again = [part for pair in zip(pieces, between, strict=True) for part in pair]
    rest, copies = there_and_back(np.concatenate([first, *again]))
    assert len(rest) == len(first) + sum(map(len, between))
    assert len(copies) == 200


def test_every_run_is_left_out():
    random = np.random.default_rng(7)
    sizes, kinds = (
        random.integers(repeats.SHORTEST, 1500, 60),
        np.resize([0.0, -0.0, np.nan, np.inf, 1.5], 60),
    )
    numbers = np.concatenate(
        [
            part
            for size, kind in zip(sizes, kinds, strict=True)
            for part in (np.full(size, kind), random.normal(size=3))
        ]
    )
    once, runs = repeats.without_runs(numbers)
    assert len(once) == 60 * 4
    assert (runs[:, 1] == sizes).all()
    for bad in (runs + [len(once), 0], runs - [1, 0], runs[::-1], runs * [1, 0]):
        with pytest.raises(ValueError, match="damaged"):
            repeats.Unfolded(once, NO_COPIES, len(once), bad)


def test_nothing_is_counted_from_both_sides():
    pattern = np.random.default_rng(1).normal(size=40)
    rest, copies = there_and_back(np.tile(pattern, 640))
    assert len(rest) < 2 * repeats.SHORTEST
    assert (copies[:, 1] + copies[:, 2] <= copies[:, 0]).all()


def test_stretches_of_stretches_of_stretches():
    """Each of 600 copies is of one before it, so that the last is as many steps from the numbers themselves."""
    count, size = 600, repeats.SHORTEST
    numbers = np.random.default_rng(4).normal(size=size)
    places = size * np.arange(1, count + 1)
    copies = np.column_stack([places, places - size, np.full(count, size)])
    whole = repeats.Unfolded(numbers, copies, size * (count + 1), NO_RUNS)
    assert same(whole.part(size * count, size), numbers)
    assert same(whole.part(0, size * (count + 1)), np.tile(numbers, count + 1))


@pytest.mark.parametrize("size", [0, 1, 3, 31, 63, 64, 65, 127, 128, 129, 300])
def test_short_lists(size):
    there_and_back(np.zeros(size))
    there_and_back(np.random.default_rng(size).normal(size=size))


def test_damaged_ones_are_told():
    numbers = np.tile(np.random.default_rng(2).normal(size=300), 3)
    rest, copies = repeats.folded(numbers)
    for bad in (
        (rest[:-1], copies, 900),
        (np.append(rest, 1.0), copies, 900),
        (rest, copies + [[0, 0, 1]], 900),
        (rest, copies + [[0, 450, 0]], 900),
        (rest, copies + [[0, -900, 0]], 900),
        (rest, copies * [[1, 1, -1]], 900),
        (rest, copies, 800),
    ):
        with pytest.raises(ValueError, match=r"damaged|cut short"):
            repeats.Unfolded(*bad, NO_RUNS)


def test_results_that_repeat_take_less_room_and_old_ones_are_read():
    random = np.random.default_rng(3)
    beads = tuple(random.normal(size=(300, 3)) for _ in range(40))
    value = (beads, np.concatenate(beads), np.repeat(random.normal(size=(500, 1, 3)), 2, axis=1))
    floats, text = store.pack(value, "k")
    assert len(floats) < 1.1 * (40 * 900 + 1500)
    for one, other in zip(store.unpack(floats, text, "k", "x")[1:], value[1:], strict=True):
        assert same(one, other)
    mark = floats[0]
    old = store.unpack(
        [mark, 1.0, 2.0, 3.0, 4.0], 'k {"t":[{"a":[0,1,2,2]},{"a":[1,2,3]}]}', "k", "x"
    )
    assert same(old[0], np.array([[1.0, 2.0], [3.0, 4.0]])) and same(old[1], np.array([2, 3, 4]))


def test_what_is_the_same_everywhere_takes_no_room():
    value = (
        np.ones((4000, 3)),
        np.zeros(9000, dtype=bool),
        np.tile([0.0, 0.6, 0.8], (5000, 1)),
        np.full(300, np.nan),
    )
    floats, text = store.pack(value, "k")
    assert len(floats) < 60
    for one, other in zip(store.unpack(floats, text, "k", "x"), value, strict=True):
        assert same(one, other)
