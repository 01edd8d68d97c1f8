# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damage files at random from a seed: change bytes, digits and references, and cut off ends."""

import random
import re

KINDS = ("bytes", "digits", "references", "cut")


def damaged(content, kind, seed):
    """Return the bytes of a file with damage."""
    chance, data = random.Random(f"{kind} {seed}"), bytearray(content)
    if kind == "bytes":
        for _ in range(chance.randint(1, 6)):
            data[chance.randrange(len(data))] = chance.randrange(256)
    elif kind == "digits":
        digit_positions = [index for index, sign in enumerate(content) if sign in b"0123456789"]
        for _ in range(chance.randint(1, 12)):
            data[chance.choice(digit_positions)] = chance.choice(b"0123456789")
    elif kind == "references":
        references = list(re.finditer(rb"#\d+", content)) or list(re.finditer(rb"\d+", content))
        for _ in range(chance.randint(1, 4)):
            reference = chance.choice(references)
            new_reference = chance.choice(
                [match for match in references if len(match[0]) == len(reference[0])]
            )
            data[reference.start() : reference.end()] = new_reference[0]
    else:
        del data[chance.randrange(1, len(data)) :]
    return bytes(data)
