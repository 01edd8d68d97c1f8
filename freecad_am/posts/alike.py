# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts that differ only in their digits, read together: a program repeats the same line thousands
of times with other numbers. A match in one text is at the same position in all.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array

_DIGITS = str.maketrans("123456789", "000000000")
_EXACT = 15  # digits of a whole number that a float always holds


def shapes(texts: Sequence[str], between: str = "\n") -> dict[str, list[int]]:
    """The shapes of texts (digits replaced by 0), and the texts of each shape; no text contains
    `between`.
    """
    by_shape: defaultdict[str, list[int]] = defaultdict(list)
    if texts:
        for number, shape in enumerate(between.join(texts).translate(_DIGITS).split(between)):
            by_shape[shape].append(number)
    return by_shape


def numbers(texts: Sequence[str], shape: str, spans: Sequence[tuple[int, int]]) -> Array:
    """(n, k) the decimal numbers at k spans (begin, end) of texts (n,) of one shape."""
    words = [shape[begin:end] for begin, end in spans]
    counts = [word.count("0") for word in words]
    if max(counts) > _EXACT:
        return np.array([[float(text[begin:end]) for begin, end in spans] for text in texts])
    table = np.frombuffer("".join(texts).encode("latin-1"), dtype=np.uint8).reshape(
        len(texts), len(shape)
    )
    digit_columns = [
        position for begin, end in spans for position in range(begin, end) if shape[position] == "0"
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
