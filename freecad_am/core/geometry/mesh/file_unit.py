# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of triangle files: STL and OBJ files do not state it."""

from __future__ import annotations

import math
import os

from ...issues import InputError

UNITLESS_ENDINGS = (".stl", ".obj")
MESHES = (*UNITLESS_ENDINGS, ".3mf")


def refuse_scale(scale: float, path: str, key: str) -> None:
    """Reject `scale`, mm per unit of a file, if it is not a length or if the file states its
    unit.

    Raises InputError BAD_VALUE that names `key`.
    """
    if not (math.isfinite(scale) and scale > 0.0):
        raise InputError(
            "BAD_VALUE",
            key,
            "{:g} mm is not a unit; give the length of one unit of the file, as 25.4 mm",
            scale,
        )
    if scale != 1.0 and not path.lower().endswith(UNITLESS_ENDINGS):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} states its own unit; leave out the scale, which is for STL and OBJ",
            os.path.basename(path),
        )
