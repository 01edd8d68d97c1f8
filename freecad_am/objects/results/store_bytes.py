# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bytes in lists of floats: seven of them in each."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array

from . import repeats

_BYTES_PER_FLOAT = 7
_HIGHEST_BYTE = 0x40  # makes any seven bytes below it an ordinary number
_OLDER_BYTES = 6  # of a whole number


def floats_of(data: bytes) -> Array:
    count, over = divmod(len(data), _BYTES_PER_FLOAT)
    whole = np.full((count + (over > 0), 8), _HIGHEST_BYTE, dtype=np.uint8)
    seven = np.frombuffer(data, dtype=np.uint8)
    whole[:count, :_BYTES_PER_FLOAT] = seven[: len(data) - over].reshape(count, _BYTES_PER_FLOAT)
    whole[count:, :over] = seven[len(data) - over :]
    return whole.view("<f8").ravel().astype(np.float64, copy=False)


def bytes_of(floats: Array, length: int) -> bytes:
    whole = (
        floats[: -(-length // _BYTES_PER_FLOAT)]
        .astype("<f8", copy=False)
        .view(np.uint8)
        .reshape(-1, 8)
    )
    return np.ascontiguousarray(whole[:, :_BYTES_PER_FLOAT]).ravel()[:length].tobytes()


def older_bytes(numbers: repeats.Unfolded, length: int, start: int) -> bytes:
    """Bytes that stand among the numbers, six to a whole number."""
    whole = (
        numbers.part(start, -(-length // _OLDER_BYTES)).astype("<u8").view(np.uint8).reshape(-1, 8)
    )
    return whole[:, :_OLDER_BYTES].tobytes()[:length]
