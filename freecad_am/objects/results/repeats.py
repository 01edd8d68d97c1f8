# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stretches of numbers that stand in a list before are left out of it, and put back.

A result says many things twice: a motion repeats the points, directions and joints of its beads, a tool axis is mostly
the build direction. The window of a zip file is too short to notice. Columns that are the same in many rows are runs of
one number, which is kept once. Numbers are compared bit by bit. They are put back where
they are asked for only: a view needs a third of them, and new memory is what takes the time.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from freecad_am.core.types import Array, Index, Mask, NDArray

Words = NDArray[np.uint64]

SHORTEST = 64  # numbers in a stretch worth leaving out
EVERY = 32  # numbers from one place that may be found again to the next: half of SHORTEST, so that none is missed
_DOUBLED = (1, 2, 4, 8, 16)  # steps that make the least of two numbers the least of EVERY
MOST_TRIED = 300_000
PIECE = 1 << 14  # places that are looked at together: as many as stay near the processor
FACTORS = np.array(
    [0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0xD6E8FEB86659FD93],
    dtype=np.uint64,
)


def without_runs(numbers: Array) -> tuple[Array, Index]:
    """The numbers (n,) with one of each run of the same number, and of each such run (k, 2) where it is in what comes back
    and how often it stands there."""
    words = np.ascontiguousarray(numbers).view(np.uint64)
    same = np.zeros(len(words) + 1, dtype=bool)  # as the one before
    same[1:-1] = words[1:] == words[:-1]
    start, end = np.flatnonzero(same[1:] != same[:-1]).reshape(-1, 2).T
    count = end - start + 1
    start, count = start[count >= SHORTEST], count[count >= SHORTEST]
    keep = np.ones(len(words), dtype=bool)
    for first, size in zip(start.tolist(), count.tolist()):
        keep[first + 1 : first + size] = False
    place = start - np.cumsum(count - 1) + count - 1
    return (numbers[keep] if len(start) else numbers), np.column_stack([place, count]).astype(
        np.int64
    )


def folded(numbers: Array) -> tuple[Array, Index]:
    """The numbers (n,) without the stretches that stand before in them, and of each such stretch (k, 3) where it was, where
    it stands before, and how long it is. No stretch overlaps the one that it repeats."""
    words = np.ascontiguousarray(numbers).view(np.uint64)
    found: list[tuple[int, int, int]] = []
    places, sources = _candidates(words)
    end, j, tried = 0, 0, 0
    while j < len(places) and tried < MOST_TRIED:
        tried += 1
        place, source = int(places[j]), int(sources[j])
        back = _alike(
            words[max(end, place - EVERY) : place][::-1],
            words[max(0, source - EVERY) : source][::-1],
        )
        place, source = place - back, source - back
        length = _length(words, source, place)
        j += 1
        if length >= SHORTEST:
            found.append((place, source, length))
            end = place + length
            j += int(np.searchsorted(places[j:], end))
    copies = np.array(found, dtype=np.int64).reshape(-1, 3)
    return numbers[_kept(len(numbers), copies)], copies


class Unfolded:
    """The numbers again that were left out, part by part: nothing is put back that is not asked for.

    From a list `rest`, or what is sliced like one, of which `copies` were left out, which had `size` numbers before, and
    from that `runs`. ValueError where they do not belong together.
    """

    def __init__(self, rest: Any, copies: Index, size: int, runs: Index) -> None:
        place, source, length = copies.T
        sound = (length > 0).all() and (source >= 0).all() and (source + length <= place).all()
        if not sound or (place[1:] < (place + length)[:-1]).any() or (place + length > size).any():
            raise ValueError("its repetitions are damaged")
        if size - int(length.sum()) != len(rest):
            raise ValueError("it is cut short")
        at, count = runs.T
        if (at < 0).any() or (at >= size).any() or (np.diff(at) <= 0).any() or (count < 1).any():
            raise ValueError("its runs are damaged")
        self.rest = rest
        before = np.cumsum(count - 1)  # that the runs up to each add
        self.runs, self.runs_end = runs.tolist(), (at + 1 + before).tolist()
        self.added = [0, *before.tolist()]
        self.size = size + self.added[-1]
        self.copies, self.copies_end = copies.tolist(), (place + length).tolist()
        self.left_out = [0, *np.cumsum(length).tolist()]

    def part(self, start: int, size: int) -> Array:
        """The numbers (size,) from `start` on, not copied where they stand in one piece. ValueError beyond the end."""
        self._check(start, size)
        return _joined(list(self._pieces(start, start + size)), size)

    def fill(self, start: int, column: NDArray[Any]) -> None:
        """Put the numbers from `start` on into (n,), which may be a column of an array. ValueError beyond the end."""
        self._check(start, len(column))
        end = 0
        for piece, count in self._pieces(start, start + len(column)):
            column[end : end + count] = piece
            end += count

    def _check(self, start: int, size: int) -> None:
        if start < 0 or start + size > self.size:
            raise ValueError("it is cut short")

    def _pieces(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches of numbers with how long they are, and for runs (1,) with how long it is."""
        k = bisect_right(self.runs_end, start)
        while start < end:
            at, count = self.runs[k] if k < len(self.runs) else (self.size, 0)
            first = at + self.added[k]  # of the run
            if start < first:
                stop = min(first, end)
                yield from self._stretches(start - self.added[k], stop - self.added[k])
            else:
                stop = min(first + count, end)
                ((number, _),) = self._stretches(at, at + 1)
                yield number, stop - start
                k += 1
            start = stop

    def _stretches(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches, with how long they are, of numbers with one of each run. A copy may be of others before it, and these
        again: what is asked for is followed to where it stands, and nothing else of them."""
        waiting = [(start, end)]
        while waiting:
            start, end = waiting.pop()
            k = bisect_right(self.copies_end, start)
            place, source, length = self.copies[k] if k < len(self.copies) else (end, 0, 0)
            stop = min(end, place + length if start >= place else place)
            if stop < end:
                waiting.append((stop, end))
            if start < place:
                yield self.rest[start - self.left_out[k] : stop - self.left_out[k]], stop - start
            else:
                waiting.append((source + start - place, source + stop - place))


def _joined(pieces: list[tuple[Array, int]], size: int) -> Array:
    if len(pieces) == 1 and len(pieces[0][0]) == size:
        return pieces[0][0]
    numbers, end = np.empty(size), 0
    for piece, count in pieces:
        numbers[end : end + count] = piece
        end += count
    numbers.flags.writeable = False
    return numbers


def _kept(size: int, copies: Index) -> Mask:
    step = np.zeros(size + 1, dtype=np.int8)
    step[copies[:, 0]] += 1
    step[copies[:, 0] + copies[:, 2]] -= 1
    kept: Mask = np.cumsum(step[:-1], dtype=np.int8) == 0
    return kept


def _candidates(words: Words) -> tuple[Index, Index]:
    """Places (k,) in order where words stand that stand before, and the first place where they do."""
    places = _landmarks(words)
    marks = _marks([words[places + k] for k in range(len(FACTORS))])
    order = _ranked(marks)  # of the same marks the first place first
    ranked = marks[order]
    first = np.flatnonzero(np.append(True, ranked[1:] != ranked[:-1])) if len(ranked) else order
    source = np.empty_like(places)
    source[order] = np.repeat(places[order[first]], np.diff(np.append(first, len(ranked))))
    # at most EVERY of a stretch come before its candidate: as many, at least, come after, of which a few are looked at
    good = (source + SHORTEST <= places) & (places + EVERY <= len(words))
    places, source = places[good], source[good]
    for k in (*range(len(FACTORS)), EVERY // 2, EVERY - 1):
        good = words[places + k] == words[source + k]
        places, source = places[good], source[good]
    return places, source


def _ranked(marks: Words) -> Index:
    """The order (k,) of marks, those of which the upper halves are the same in theirs: by one quarter after the other, which
    numpy sorts in half the time."""
    halves = (marks >> np.uint64(32)).astype(np.uint32)
    order = np.argsort(halves.astype(np.uint16), kind="stable")
    found: Index = order[
        np.argsort((halves >> np.uint32(16)).astype(np.uint16)[order], kind="stable")
    ]
    return found


def _landmarks(words: Words) -> Index:
    """Places (k,) in order that what stands there tells, wherever it stands: of each EVERY words that follow each other the
    one that is least once it is scrambled. One in sixteen, without runs of one number, which are left out elsewhere."""
    around, found = EVERY - 1, [np.zeros(0, dtype=np.int64)]
    for start in range(0, len(words), PIECE):
        low, high = start - around, start + PIECE + around
        seen = words[max(low, 0) : high]
        scrambled = np.full(high - low, np.iinfo(np.uint32).max, dtype=np.uint32)
        scrambled[max(-low, 0) : max(-low, 0) + len(seen)] = (seen * FACTORS[0]) >> np.uint64(32)
        least = scrambled
        for k in _DOUBLED:
            least = np.minimum(least[k:], least[:-k])
        most = least
        for k in _DOUBLED:
            most = np.maximum(most[k:], most[:-k])
        found.append(start + np.flatnonzero(scrambled[around:-around] == most))
    places = np.concatenate(found)
    places = places[places <= len(words) - len(FACTORS)]
    chosen: Index = places[
        (words[places] != words[places + 1]) | (words[places + 1] != words[places + 2])
    ]
    return chosen


def _marks(words: Sequence[Words]) -> Words:
    """(n,) what tells four words that follow each other, given as four (n,)."""
    marks = words[0] * FACTORS[0]
    for word, factor in zip(words[1:], FACTORS[1:]):
        marks += word * factor
    marks ^= marks >> np.uint64(29)
    marks *= FACTORS[1]
    return marks


def _length(words: Words, source: int, place: int) -> int:
    """How many words from `source` on stand at `place` too, none of them counted from both sides."""
    most = min(place - source, len(words) - place)
    length, step = 0, 2 * SHORTEST
    while length < most:
        step = min(step, most - length)
        same = _alike(
            words[source + length : source + length + step],
            words[place + length : place + length + step],
        )
        length += same
        if same < step:
            break
        step *= 4
    return length


def _alike(one: Words, other: Words) -> int:
    """How many of the first words are the same."""
    size = min(len(one), len(other))
    if not size:
        return 0
    differ = one[:size] != other[:size]
    first = int(differ.argmax())  # 0 too where none differs
    return first if differ[first] else size
