# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint path in the 3D view: rapid moves, and points that something is wrong with."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.issues import ERROR
from ..objects.stage import issues_of
from .lines import DASHED, Lines, Points
from .view_base import StageView


class JointPathView(StageView):
    """Draws the rapid moves as dashed lines, and a red point wherever a finding forbids a program."""

    icon = "joint_path"

    def scene(self, root: Any) -> None:
        self.rapids = Lines(1.0, (0.72, 0.72, 0.75), DASHED)
        self.wrong = Points(7.0, (0.9, 0.1, 0.2))
        root.addChild(self.rapids.node)
        root.addChild(self.wrong.node)

    def draw(self, obj: Any, value: Any) -> None:
        motion = value.motion
        rapid = np.flatnonzero(~motion.deposit[1:]) + 1
        ends = np.stack([motion.position[rapid - 1], motion.position[rapid]], axis=1)
        self.rapids.set(ends, np.full(len(rapid), 2))
        wrong = np.zeros(len(motion), dtype=bool)
        for issue in issues_of(obj):
            if issue.level == ERROR and issue.layer is not None:
                here = motion.deposit & (motion.layer == issue.layer)
                for column, index in ((motion.bead, issue.bead), (motion.point, issue.point)):
                    here &= True if index is None else column == index
                wrong |= here
        self.wrong.set(motion.position[wrong])
