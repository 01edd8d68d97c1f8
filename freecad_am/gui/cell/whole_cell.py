# SPDX-License-Identifier: LGPL-2.1-or-later
"""A whole cell from one URDF in the fields of a cell: `urdf` as its external axes."""

from __future__ import annotations

from ...core.kinematics.urdf.cell import texts_of_machine
from ...core.kinematics.urdf.machine import WHOLE_CELL


def whole_cell(machine: object, external: object) -> tuple[str, str] | None:
    """What the fields of machine and external axes hold of a URDF that has them all; None where that is not asked for.

    Raises InputError BAD_URDF where robot, track and positioner cannot be told apart, BAD_VALUE for what is no URDF.
    """
    if not isinstance(external, str) or external.strip() != WHOLE_CELL:
        return None
    return texts_of_machine(machine)
