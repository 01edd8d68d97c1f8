# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damages done to files, each by a seed: bytes and digits that are others, references to others, ends cut off."""

import random
import re

KINDS = ("bytes", "digits", "references", "cut")


def damaged(whole, kind, seed):
    """The bytes of a file, damaged."""
    chance, data = random.Random(f"{kind} {seed}"), bytearray(whole)
    if kind == "bytes":
        for _ in range(chance.randint(1, 6)):
            data[chance.randrange(len(data))] = chance.randrange(256)
    elif kind == "digits":
        places = [at for at, sign in enumerate(whole) if sign in b"0123456789"]
        for _ in range(chance.randint(1, 12)):
            data[chance.choice(places)] = chance.choice(b"0123456789")
    elif kind == "references":
        found = list(re.finditer(rb"#\d+", whole)) or list(re.finditer(rb"\d+", whole))
        for _ in range(chance.randint(1, 4)):
            one = chance.choice(found)
            other = chance.choice([match for match in found if len(match[0]) == len(one[0])])
            data[one.start() : one.end()] = other[0]
    else:
        del data[chance.randrange(1, len(data)) :]
    return bytes(data)
