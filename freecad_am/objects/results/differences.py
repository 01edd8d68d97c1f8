# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers kept as what they differ by from what those before them foretell, to the last bit.

Along a bead, coordinates, directions and joints are smooth: differences of differences, five to eight times over, leave two
bytes of the eight. They are taken of the bits of numbers, read as whole numbers in the order of the numbers themselves, so
that nothing is rounded and sums bring all back. Packed piece by piece: a few numbers are read without the others.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array, Integers

PIECE = 8192  # numbers that have one order of differences, and are packed together
HIGHEST = 8  # order; another one would double what is left of rounding, and foretell no better
# a part in so many of a piece tells its order as the whole does, where columns are longer than pieces: in so many pieces
SHARE, MANY = 8, 100
_BUT_SIGN = np.int64(0x7FFFFFFFFFFFFFFF)
_ONE = np.uint64(1)
_MANTISSA, _BIAS = (
    52,
    1022,
)  # of a float64: bits after the exponent, and its exponent of numbers from a half to one


def packed(numbers: Array) -> list[bytes]:
    """Numbers (n,) in pieces of PIECE."""
    share = SHARE if len(numbers) > MANY * PIECE else 1
    return [
        _packed(numbers[start : start + PIECE], share) for start in range(0, len(numbers), PIECE)
    ]


class Unpacked:
    """The numbers again: as long as they were, and sliced as an array of them, of which only what is asked for is read.

    ValueError or zlib.error for pieces that are damaged, at the latest when they are read.
    """

    def __init__(self, pieces: Sequence[bytes], size: int) -> None:
        if len(pieces) != -(-size // PIECE):
            raise ValueError("it is cut short")
        self.pieces, self.missing = pieces, [True] * len(pieces)
        self.numbers = np.empty(size)

    def __len__(self) -> int:
        return len(self.numbers)

    def __getitem__(self, some: slice) -> Array:
        start, end, _ = some.indices(len(self.numbers))
        for k in range(start // PIECE, -(-end // PIECE)):
            if self.missing[k]:
                _unpack(self.pieces[k], self.numbers[k * PIECE : (k + 1) * PIECE].view(np.int64))
                self.missing[k] = False
        found = self.numbers[start:end]
        found.flags.writeable = False  # parts may share it
        return found


def _packed(numbers: Array, share: int) -> bytes:
    """The order of differences, then the bytes of what is left: first the lowest of all, the highest last. share: one part
    in so many is looked at for the order."""
    bits = _turned(np.ascontiguousarray(numbers).view(np.int64))
    order = _order_of(bits[: -(-len(bits) // share)])
    chosen = bits
    for _ in range(order):
        chosen = _once_more(chosen)
    folded = (chosen << 1) ^ (chosen >> 63)  # small ones are near 0, of either sign
    planes = np.ascontiguousarray(folded.astype("<i8", copy=False).view(np.uint8).reshape(-1, 8).T)
    return bytes([order]) + zlib.compress(planes, 1)


def _order_of(differences: Integers) -> int:
    """How many times differences are to be taken."""
    sizes = []
    for k in range(HIGHEST + 1):
        sizes.append(
            _bits_of(differences) + k * len(differences)
        )  # to sum once more takes as long as to read a bit
        differences = _once_more(differences)
    return sizes.index(min(sizes))


def _once_more(differences: Integers) -> Integers:
    """Differences of differences; the first is one to 0."""
    higher = np.empty_like(differences)
    higher[:1] = differences[:1]
    np.subtract(differences[1:], differences[:-1], out=higher[1:])
    return higher


def _unpack(piece: bytes, bits: Integers) -> None:
    """Fill the bits of the numbers of a piece."""
    planes = np.frombuffer(
        zlib.decompress(memoryview(piece)[1:], bufsize=8 * len(bits)), dtype=np.uint8
    )
    if len(planes) != 8 * len(bits) or piece[0] > HIGHEST:
        raise ValueError("it is damaged")
    planes = planes.reshape(8, -1)
    folded = np.zeros(len(bits), dtype="<u8")
    places, used = folded.view(np.uint8).reshape(-1, 8), 8
    while used and not planes[used - 1].any():  # of small differences the higher bytes are 0
        used -= 1
    for k in range(used):
        places[:, k] = planes[k]
    differences = folded.astype(np.uint64, copy=False)
    sums = np.empty((len(bits), 2), dtype=np.int64)[
        :, 0
    ]  # numpy sums up what stands apart in a fourth of the time
    np.negative((differences & _ONE).view(np.int64), out=sums)
    differences >>= _ONE
    sums ^= differences.view(np.int64)
    for _ in range(piece[0]):
        np.add.accumulate(sums, out=sums)
    sign = np.right_shift(sums, 63, out=differences.view(np.int64))
    sign &= _BUT_SIGN
    np.bitwise_xor(sums, sign, out=bits)


def _turned(bits: Integers) -> Integers:
    """Bits of numbers as whole numbers in their order, and the other way round."""
    return bits ^ (bits >> 63 & _BUT_SIGN)


def _bits_of(differences: Integers) -> int:
    """How many bits differences have in all once they are folded; near enough to choose by."""
    size = differences ^ (differences >> 63)
    exponents = size.astype(np.float64).view(np.int64)
    exponents >>= _MANTISSA
    # folding adds a bit to all but 0
    return int(exponents.sum()) - _BIAS * np.count_nonzero(size) + np.count_nonzero(differences)
