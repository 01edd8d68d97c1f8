# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a deposit rests on a curved surface, for the choice of a family."""

from __future__ import annotations

import contextlib
from typing import Any

from ...brep.kernel import limits as kernel
from ...brep.lies_on import carrier, lies_on_bend
from ...core.issues import Text
from ..shapes.bodies import Taken


def rests_on_bend(deposit: Taken, ground: Taken) -> bool:
    """Whether a part rests on a curved face of the ground; False for meshes, and if the kernel
    fails.
    """
    with contextlib.suppress(*kernel.FAULTS):
        return (
            deposit.shape is not None
            and ground.shape is not None
            and lies_on_bend(deposit.shape, ground.shape)
        )
    return False


def bend_hint(shape: Any) -> str:
    """A hint for several solids if most rest on a curved face of another one; else ''."""
    with contextlib.suppress(*kernel.FAULTS):
        if name := carrier(shape.Solids):
            return Text(
                " (others are on the bend of {}: as the substrate it shapes their layers)",
                name,
            )
    return ""
