# SPDX-License-Identifier: LGPL-2.1-or-later
"""Describe a machine at rest for the cell panel."""

from __future__ import annotations

import numpy as np

from ..nodes.cell import Rest
from ..texts.in_language import tr


def stands(rest_pose: Rest) -> str:
    """Return the text for a machine at rest: its title and the axis nearest to its limit."""
    if not rest_pose.machine.free:
        return tr("{} at rest, revolute axes at 0").format(rest_pose.machine.title)
    if not rest_pose.reached:
        text = tr("{} does not reach the part with the nozzle upright: all its axes are drawn at 0")
        return text.format(rest_pose.machine.title)
    margin, label = rest_pose.limits.smallest(rest_pose.joints)
    margin_deg, axis = float(np.degrees(margin)), rest_pose.limits.labels[int(label)]
    text = (
        tr("{} with the nozzle upright: {} is {:.0f}° from its limit")
        if margin_deg >= 0.0
        else tr("{} with the nozzle upright: {} is {:.0f}° past its limit")
    )
    return text.format(rest_pose.machine.title, axis, abs(margin_deg))
