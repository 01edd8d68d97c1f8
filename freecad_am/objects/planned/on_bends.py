# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether what is deposited stands on something bent, as a family is chosen for it."""

from __future__ import annotations

import contextlib
from typing import Any

from ...brep.kernel import limits as kernel
from ...brep.lies_on import carrier, lies_on_bend
from ...core.issues import Text
from ..shapes.bodies import Taken


def on_bend(part: Taken, ground: Taken) -> bool:
    """Whether a part lies on a face of the ground that is not flat; False of meshes, and where the kernel cannot tell."""
    with contextlib.suppress(*kernel.FAULTS):
        return (
            part.shape is not None
            and ground.shape is not None
            and lies_on_bend(part.shape, ground.shape)
        )
    return False


def carried(shape: Any) -> str:
    """What is told of several solids where most stand on the bend of another one; '' of others."""
    with contextlib.suppress(*kernel.FAULTS):
        if name := carrier(shape.Solids):
            return Text(
                " (others stand on the bend of {}: as the substrate it gives them layers of its shape)",
                name,
            )
    return ""
