# SPDX-License-Identifier: LGPL-2.1-or-later
"""Keep the robot links clear of the cell and of each other in planning, by `cell.arm_clearance`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..collision.bead_ends import LINK_GRAIN, Beads
from ..geometry.cylinders import Cylinder
from ..geometry.obstacles import Body
from ..issues import ERROR, Issue, Text, Word
from ..kinematics.cell import Cell
from ..kinematics.links.contact import BASE, NOZZLE, PART, TORCH, ArmContact, Touches
from ..toolpath import Bead, Toolpath
from ..types import Array, Index, Mask
from .points import Points
from .rapids.clearance import evenly

Place = tuple[int, int]
Cylinders = Sequence[Sequence[Cylinder]]

CODE = "ARM_CLEARANCE"
STEP, SLIDE = (
    float(np.radians(2.0)),
    10.0,
)  # maximum joint step between two checks on rapids: rad for revolute, mm for prismatic axes


@dataclass(frozen=True)
class ArmKept:
    """The link clearance check.

    before: number of points printed before each bead, by its layer and index.
    """

    contact: ArmContact
    before: Mapping[Place, int]

    def touches(self, joints: Array, points: Points, bead_ids: Sequence[Place]) -> Touches:
        """Return the link contacts at the points of beads.

        Parameters
        ----------
        joints : (T, axes) array
            Joint values at the points, rad or mm.
        points : Points
            The T points.
        bead_ids : sequence of Place
            Layer and index of each bead in `points`.

        Returns
        -------
        Touches
            Contacts, with the deposit printed before each bead.
        """
        return self.contact.touches(
            joints,
            np.array([self.moment(bead_id) for bead_id in bead_ids], dtype=np.int64)[points.bead],
        )

    def rotations_near(self, joints: Array, bead: Index, bead_ids: Sequence[Place]) -> Mask:
        """Return the rotations at which a link gets too close.

        Parameters
        ----------
        joints : (R, T, axes) array
            Joint values for R rotations at T points, rad or mm.
        bead : (T,) int array
            Bead index of each point.
        bead_ids : sequence of Place
            Layer and index of each bead.

        Returns
        -------
        (R, T) bool array
            True where a link gets too close.
        """
        when = np.array([self.moment(bead_id) for bead_id in bead_ids], dtype=np.int64)[bead]
        met = self.contact.touches(joints.reshape(-1, joints.shape[2]), np.tile(when, len(joints)))
        return met.any.reshape(joints.shape[:2])

    def moment(self, bead_id: Place) -> int:
        """Return the number of points printed before a bead.

        For a piece of a split bead, count the points printed before its layer.
        """
        return self.before.get(bead_id, self.before[bead_id[0], 0])


def build_arm_clearance(toolpath: Toolpath, cell: Cell, cylinders: Cylinders) -> ArmKept | None:
    """Return the link clearance check of a job.

    Parameters
    ----------
    toolpath : Toolpath
        Toolpath in part coordinates; its bead sizes and surroundings count as obstacles.
    cell : Cell
        The cell, including the requested `arm_clearance`, mm.
    cylinders : Cylinders
        Cylinders around each robot link.

    Returns
    -------
    ArmKept or None
        None if the job requests no clearance or the link geometry is unknown.
    """
    beads = [bead for _, _, bead in toolpath]
    contact = contact_of(
        beads,
        cell,
        cylinders,
        toolpath.surroundings,
        toolpath.bead_width or toolpath.layer_height,
        toolpath.layer_height,
    )
    if contact is None:
        return None
    counts = np.cumsum([0, *(len(bead) for bead in beads)])
    points_before = {
        (layer, index): int(count)
        for (layer, index, _), count in zip(toolpath, counts, strict=False)
    }
    return ArmKept(contact, points_before)


def contact_of(
    beads: Sequence[Bead],
    cell: Cell,
    cylinders: Cylinders,
    bodies: Sequence[Body],
    width: float,
    height: float,
) -> ArmContact | None:
    """Return the contact check of the robot links against bodies and beads.

    Parameters
    ----------
    beads : sequence of Bead
        Beads in print order, part coordinates.
    cell : Cell
        The cell, including the requested `arm_clearance`, mm.
    cylinders : Cylinders
        Cylinders around each robot link.
    bodies : sequence of Body
        Obstacles in part coordinates.
    width, height : float
        Size of beads without a size, mm.

    Returns
    -------
    ArmContact or None
        None if no clearance is requested or the link geometry is unknown.
    """
    if cell.arm_clearance is None or not cylinders:
        return None
    deposited = Beads.of(beads, width, height).solid(LINK_GRAIN)
    return ArmContact(cell, cylinders, bodies, deposited, cell.arm_clearance)


def check_moves(
    contact: ArmContact, start: Array, end: Array, deposited: Index
) -> tuple[Index, Touches]:
    """Find links that get too close on joint moves.

    Parameters
    ----------
    contact : ArmContact
        The contact check.
    start, end : (k, axes) array
        Joints at the ends of the moves, rad or mm.
    deposited : (k,) int array
        Number of points printed before each move.

    Returns
    -------
    move : (n,) int array
        Move index of each check.
    touches : Touches
        Contacts of each check. Moves with NaN joints have no contacts.
    """
    steps = np.where(contact.cell.machine.chain.sliding, SLIDE, STEP)
    step_count = np.nan_to_num(np.abs(end - start) / steps).max(axis=1, initial=0.0)
    move, share = evenly(1 + np.ceil(step_count).astype(np.intp))
    joints = start[move] + share[:, None] * (end - start)[move]
    return move, contact.touches(joints, deposited[move])


def clearance_issue(
    cell: Cell, link: str, what: str, layer: int, bead: int, on_way: bool = False
) -> Issue:
    """Return the issue for a link that gets too close to an obstacle.

    Parameters
    ----------
    cell : Cell
        The cell; its external links decide the remedy.
    link : str
        A name of `ArmContact.links`, NOZZLE, PART, TORCH or BASE.
    what : str
        Name of the obstacle.
    layer, bead : int
        The bead concerned.
    on_way : bool, optional
        Whether the contact occurs on the rapid to the bead.

    Returns
    -------
    Issue
        An error, including the remedy.
    """
    where = " on the rapid to the bead" if on_way else ""
    stands = what in [external_link.name for external_link in cell.shapes.external_links]
    if link == NOZZLE:
        moved = (
            "raise the part with cell.platform, or move the mechanism in cell.external"
            if stands
            else ("move the obstacle in cell.obstacles, the part, or cell.deposition_point")
        )
        return Issue(
            ERROR,
            CODE,
            Text("the nozzle touches {}{}; {}", what, Word(where), Word(moved)),
            layer,
            bead,
        )
    name = (
        "the part"
        if link == PART
        else "the torch"
        if link == TORCH
        else "the base"
        if link == BASE
        else Text("link {}", link)
    )
    remedy = (
        "move the external axes (cell.external) or the part"
        if stands
        else "move the part or cell.deposition_point"
    )
    return Issue(
        ERROR,
        CODE,
        Text(
            "{} comes closer than {:g} mm to {}, or touches it{}; {}, try another cell.branch, or lower "
            "cell.arm_clearance",
            Word(name),
            cell.arm_clearance,
            what,
            Word(where),
            Word(remedy),
        ),
        layer,
        bead,
    )
