# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pictures of a simulation: the whole document moves with the part, surrounded by machine and
nozzle.

The part is drawn where it is in the document when the machine is at rest. One node before the
view's own nodes moves the whole document; the simulation hides the workbench objects that it draws
itself.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import numpy as np
from pivy import coin

from ...core.geometry import frames
from ...core.kinematics.links.own import NONE
from ...core.simulation.table_links import Placing, at_rest, heights, placing
from ...core.toolpath import Bead
from ...core.types import Array, Mask
from ...objects.stage import stage_of
from ..nodes.cell import (
    NOZZLE,
    PLATFORM,
    ExternalLinkNodes,
    MachineNodes,
    coloured,
    holder_node,
    move,
    nozzle_node,
    plain_links,
    platform_nodes,
    resting_point,
)
from ..nodes.lines import Lines, fill
from ..path.pieces import PathNodes, Rows
from .player import Run

METAL_COLOUR, SLOW_COLOUR, WRONG_COLOUR = (0.62, 0.66, 0.72), (0.96, 0.55, 0.05), (0.86, 0.1, 0.12)
TO_COME = (0.5, 0.52, 0.56)
OURS = ("toolpath", "joint path", "cell")


class Scene:
    """Nodes in one 3D view from when it is made until `remove`."""

    def __init__(self, run: Run, view: Any) -> None:
        self.run, self.view = run, view
        cell, mount = run.cell, run.cell.mount
        resting = placing(cell, at_rest(cell, resting_point(run.toolpath, mount)))
        self.to_view = frames.inverse(resting.part)
        looks = run.looks
        self.machine = MachineNodes(
            cell.robot, plain_links(cell.robot, looks.platform_diameter, looks.nozzle.length)
        )
        self.external_links = ExternalLinkNodes(cell.external_links)
        self.part, self.nozzle = coin.SoMatrixTransform(), coin.SoMatrixTransform()
        self.part_matrix, self.nozzle_matrix = self.part.matrix, self.nozzle.matrix
        self.deposit, self.to_come = PathNodes(), PathNodes()
        self.deposit.as_tubes, self.to_come.style.lineWidth = True, 1.0
        self.last, self.growing = (
            Lines(3.0, METAL_COLOUR),
            False,
        )  # the segment that is under way, and whether one is
        self.last.set(np.zeros((2, 3)), [2])
        self.last.show(False)
        self.last_points = self.last.coordinates.point
        self.root = coin.SoSeparator()
        nozzle, part_node = coin.SoSeparator(), coin.SoSeparator()
        nozzle.addChild(self.nozzle)
        for node in (nozzle_node(run.looks), holder_node(run.looks)):
            nozzle.addChild(coloured(NOZZLE, node))
        part_node.addChild(self.part)
        platform = coin.SoSeparator()
        for child in platform_nodes(run.looks, mount):
            platform.addChild(child)
        for child in (
            self.deposit.node,
            self.last.node,
            self.to_come.node,
            coloured(PLATFORM, platform),
        ):
            part_node.addChild(child)
        for child in (self.machine.node, self.external_links.node, nozzle, part_node):
            self.root.addChild(child)
        self._place(resting)  # where the machine stays as long as no point is reached
        self._fill()
        self.camera, self.camera_text = view.getCameraNode().copy(), view.getCamera()
        self.graph = view.getSceneGraph()
        self.graph.insertChild(self.root, 0)
        self.graph.insertChild(self.part, 1)
        self.hidden = _hide_ours(run.document)

    def _fill(self) -> None:
        """The deposit, one row for each deposit row of the motion: metal, orange where the speed is not kept, red where
        something is wrong."""
        motion = self.run.motion
        deposit = motion.deposit
        self.rows_before = np.concatenate([[0], np.cumsum(deposit)])
        beads = _beads(self.run)
        rows = Rows.of(
            beads, _layers(self.run), self.run.width, lambda: self.run.toolpath.layer_height
        )
        colours = np.tile(METAL_COLOUR, (len(rows), 1))
        slowed, wrong = self.run.feed.slowed[deposit], _wrong(self.run)[deposit]
        colours[slowed], colours[wrong] = SLOW_COLOUR, WRONG_COLOUR
        self.deposit.set(rows)
        self.deposit.paint(colours)
        self.deposit.show(0, 0)
        self.to_come.set(rows)
        plain = np.tile(TO_COME, (len(rows), 1))
        plain[slowed], plain[wrong] = SLOW_COLOUR, WRONG_COLOUR
        self.to_come.paint(plain)

    # ---- each frame

    def show(self, row: int, joints: Array, position: Array, running: bool, bad: Mask) -> None:
        """Everything as it is on the way to a row, or at it. joints: (axes,), NaN leaves the machine where it is."""
        if np.isfinite(joints).all():
            self._place(placing(self.run.cell, joints))
        robot_links = len(self.machine.bad)
        self.machine.paint(bad[:robot_links])
        self.external_links.paint(bad[robot_links:])
        row_count = int(self.rows_before[row if running else row + 1])
        if row_count != self.deposit.end:
            self.deposit.show(0, row_count)
            rows = self.deposit.rows
            # from the last point, unless there the bead has ended
            self.to_come.show(
                max(row_count - 1, int(rows.starts[rows.bead_of(row_count)])), len(rows)
            )
        motion = self.run.motion
        growing = running and row > 0 and bool(motion.deposit[row] and motion.deposit[row - 1])
        if growing != self.growing:
            self.growing = growing
            self.last.show(growing)
        if growing:
            fill(self.last_points, np.stack([motion.position[row - 1], position]))

    def _place(self, pose: Placing) -> None:
        self.machine.pose(self.to_view @ pose.links)
        self.external_links.pose(self.to_view @ pose.external_links)
        move(self.part_matrix, self.to_view @ pose.part)
        move(self.nozzle_matrix, self.to_view @ pose.nozzle)

    # ---- the end

    def remove(self, document_goes: bool = False) -> None:
        """Leave the view as it was. The view may be gone; nothing is to be left as it was in a document that goes."""
        with contextlib.suppress(RuntimeError, ReferenceError):
            for node in (self.root, self.part):
                if self.graph.findChild(node) >= 0:
                    self.graph.removeChild(node)
        if document_goes:
            return
        _show_again(self.run.document, self.hidden)
        with contextlib.suppress(RuntimeError, ReferenceError):
            camera = self.view.getCameraNode()
            if camera.getTypeId() == self.camera.getTypeId():
                camera.copyFieldValues(self.camera)
            else:  # from perspective to orthographic meanwhile, or the other way
                self.view.setCamera(self.camera_text)


def _wrong(run: Run) -> Mask:
    """(n,) rows that are past a limit, near a singularity or out of reach, or at which a link touches something."""
    wrong: Mask = (
        run.watch.past | run.watch.singular | (run.watch.touching != NONE) | ~run.motion.reachable
    )
    return wrong


def _beads(run: Run) -> list[Bead]:
    """The beads as they are run, a bead for every stretch of deposit rows; their points are those rows. As high as they are
    predicted to end, where that is known."""
    motion = run.motion
    height = None if run.deposit is None else heights(run.deposit, motion.position, motion.layer)
    rows = np.flatnonzero(motion.deposit)
    stretches = np.split(rows, np.flatnonzero(motion.point[rows] == 0)[1:])
    return [
        Bead(
            points=motion.position[stretch],
            build=motion.build[stretch],
            tool=motion.tool[stretch],
            parameter=np.arange(len(stretch)),
            speed=motion.speed[stretch],
            closed=False,
            width=None if np.isnan(motion.width[stretch]).any() else motion.width[stretch],
            height=None if height is None or np.isnan(height[stretch]).any() else height[stretch],
        )
        for stretch in stretches
    ]


def _layers(run: Run) -> Sequence[int]:
    motion = run.motion
    starts = motion.deposit & (motion.point == 0)
    return [int(layer) for layer in motion.layer[starts]]


def _hide_ours(document: str) -> dict[str, int]:
    """Switch off what the simulation draws itself; what each switch was, by object name. Properties stay as they are."""
    hidden = {}
    for obj in App.getDocument(document).Objects:
        stage = stage_of(obj)
        if stage is not None and stage.kind in OURS and obj.ViewObject.Visibility:
            switch = obj.ViewObject.SwitchNode
            hidden[obj.Name] = int(switch.whichChild.getValue())
            switch.whichChild = coin.SO_SWITCH_NONE
    return hidden


def _show_again(document: str, hidden: dict[str, int]) -> None:
    if document not in App.listDocuments():
        return
    for name, child in hidden.items():
        obj = App.getDocument(document).getObject(name)
        if obj is not None and obj.ViewObject.Visibility:
            obj.ViewObject.SwitchNode.whichChild = child
