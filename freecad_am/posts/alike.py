# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts that differ in their digits alone, read together: a program says the same thing many thousand times over, with other
numbers. What is found in one of them is at the same place in all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array

_DIGITS = str.maketrans("123456789", "000000000")
_EXACT = 15  # digits of a whole number that a float always holds


def shapes(texts: Sequence[str], between: str = "\n") -> dict[str, list[int]]:
    """The texts with all digits 0, and which of the texts have each of these shapes; no text holds what is put `between`."""
    by_shape: defaultdict[str, list[int]] = defaultdict(list)
    if texts:
        for number, shape in enumerate(between.join(texts).translate(_DIGITS).split(between)):
            by_shape[shape].append(number)
    return by_shape


def numbers(texts: Sequence[str], shape: str, spans: Sequence[tuple[int, int]]) -> Array:
    """(n, k) the decimal numbers that stand at k places, from and to, of texts (n,) of one shape."""
    words = [shape[begin:end] for begin, end in spans]
    counts = [word.count("0") for word in words]
    if max(counts) > _EXACT:
        return np.array([[float(text[begin:end]) for begin, end in spans] for text in texts])
    table = np.frombuffer("".join(texts).encode("latin-1"), dtype=np.uint8).reshape(
        len(texts), len(shape)
    )
    digit_columns = [
        place for begin, end in spans for place in range(begin, end) if shape[place] == "0"
    ]
    worth = [10**power for count in counts for power in range(count - 1, -1, -1)]
    digits = (table.T[digit_columns] - np.uint8(ord("0"))) * np.array(worth)[:, None]
    integers = np.add.reduceat(digits, np.cumsum([0, *counts[:-1]]))
    # one division of two whole numbers is rounded as the text itself would be
    divisor = [
        (-1.0 if "-" in word else 1.0) * 10.0 ** word.partition(".")[2].count("0") for word in words
    ]
    values: Array = integers.T / np.array(divisor)
    return values
