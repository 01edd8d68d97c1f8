# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of files of triangles: STL and OBJ files do not tell it."""

from __future__ import annotations

import math
import os

from ...issues import InputError

UNTOLD = (".stl", ".obj")
MESHES = (*UNTOLD, ".3mf")


def refuse_scale(scale: float, path: str, key: str) -> None:
    """InputError BAD_VALUE naming `key` where `scale`, mm a unit of a file, is not a length or the file tells its unit."""
    if not (math.isfinite(scale) and scale > 0.0):
        raise InputError(
            "BAD_VALUE",
            key,
            "{:g} mm is not a unit; give the length of one unit of the file, as 25.4 mm",
            scale,
        )
    if scale != 1.0 and not path.lower().endswith(UNTOLD):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} states its own unit; leave out the scale, which is for STL and OBJ",
            os.path.basename(path),
        )
