# SPDX-License-Identifier: LGPL-2.1-or-later
"""A URDF as a machine."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...geometry.job_files import is_there
from ...issues import InputError, Text, Word
from ...parameters.cell_records import EXTERNAL_KEY
from ...types import Array
from ..chain import Chain
from ..inverse import opw_recognition, recognition
from ..inverse.five_axis import is_five_axis
from ..inverse.recognition import CalibratedArm
from ..inverse.serial_arm import SerialArm
from ..links import bodies
from ..links.bodies import LinkShape, Pieces
from ..links.solids import Solid
from .elements import Element
from .read import FIXED, Description, Urdf
from .reference import Reference

# ---- Link bodies of a mechanism, from the <collision> elements of a URDF, or else <visual>

NOT_LOOKED_AT = "the link is excluded from clearance checks"


def collision(urdf: Urdf, base: str, tip: str, notes: list[str]) -> tuple[Pieces, ...]:
    """Return the bodies of the links from a base to a tip.

    Each body includes all links fixed to its link, but not the load on the tip, which has its own
    joints.

    Parameters
    ----------
    urdf : Urdf
        The file.
    base, tip : str
        First and last link.
    notes : list of str
        List to which notes on unreadable geometry are appended.

    Returns
    -------
    tuple of Pieces
        Bodies (axes + 1), base first, in the frames of the joints that move them, mm.
    """
    chain = [tip, *urdf.above(tip)]
    chain = chain[: chain.index(base) + 1][::-1]
    groups: list[list[tuple[str, Array]]] = [[(base, np.eye(4))]]
    for link in chain[1:]:
        fixed = urdf.parent[link].text("type") == FIXED
        if not fixed:
            groups.append([(link, np.eye(4))])
        elif link != tip or not _moves_others(urdf, link):
            groups[-1].append((link, groups[-1][-1][1] @ urdf.parent[link].pose()))
    for group in groups[1:]:
        for link, pose in list(group):
            group.extend(_fixed_to(urdf, link, pose, chain))
    return tuple(
        tuple(body for link, pose in group for body in _pieces(urdf, link, pose, notes))
        for group in groups
    )


def _moves_others(urdf: Urdf, link: str) -> bool:
    """Whether anything mounted on a link has moving joints."""
    return any(
        urdf.parent[child].text("type") != FIXED or _moves_others(urdf, child)
        for child in urdf.children_of(link)
    )


def _fixed_to(
    urdf: Urdf, link: str, pose: Array, but: Sequence[str]
) -> Iterator[tuple[str, Array]]:
    """Yield the links fixed to a link at a pose, with their poses."""
    for child in urdf.children_of(link):
        joint = urdf.parent[child]
        if child not in but and joint.text("type") == FIXED:
            child_pose = pose @ joint.pose()
            yield child, child_pose
            yield from _fixed_to(urdf, child, child_pose, but)


def _pieces(urdf: Urdf, link: str, pose: Array, notes: list[str]) -> Iterator[LinkShape | Solid]:
    element = urdf.links[link]
    text = list(element.all("collision")) or list(element.all("visual"))
    for geometry in text:
        solid = _solid(geometry)
        if solid is not None:
            yield solid.move(pose @ geometry.pose())
            continue
        shape = urdf.mesh_of(geometry, f"{link}: {NOT_LOOKED_AT}", notes)
        if shape is not None:
            yield LinkShape(shape.path, pose @ shape.pose, shape.scale, shape.colour, shape.where)


def _solid(element: Element) -> Solid | None:
    """Return the box, cylinder or sphere of an element, centred at its origin.

    A sphere becomes its enclosing cylinder.
    """
    geometry = element.first("geometry")
    if geometry is None:
        return None
    for child in geometry.children:
        if child.tag == "box":
            return bodies.box(1000.0 * _sizes(child, child.numbers("size", 3, "")))
        if child.tag in ("cylinder", "sphere"):
            radius = child.number("radius")
            length = child.number("length") if child.tag == "cylinder" else 2.0 * radius
            return bodies.cylinder(1000.0 * _sizes(child, np.array([2.0 * radius, length])))
    return None


def _sizes(element: Element, sizes: Array) -> Array:
    if (sizes <= 0.0).any():
        raise element.bad(
            Text("<{}> has a size that is not positive; give its sizes in m", element.tag)
        )
    return sizes


MECHANISM = 2  # maximum number of axes of a mechanism
# value of `cell.external` that takes the mechanisms from the URDF of the machine (`urdf_cell`)
WHOLE_CELL = "urdf"


def describe(machine_reference: Reference) -> tuple[Description, SerialArm | None]:
    """Return the chain of a machine and its inverse.

    Parameters
    ----------
    machine_reference : Reference
        The file with base and tip.

    Returns
    -------
    description : Description
        The chain, relative to `base_link` of `grounded_chain`.
    arm : SerialArm or None
        Inverse; None for a five-axis machine.

    Raises
    ------
    InputError
        UNKNOWN_MACHINE if the file is missing, BAD_URDF with file and line, NO_CLOSED_FORM with
        the reason.
    """
    robot, base, tip = _ends(machine_reference, "cell.machine")
    description = ground_description(robot.between(base, tip))
    try:
        arm = closed_form(description.chain)
        return (
            description
            if arm is None
            else replace(description, notes=(*description.notes, *_note_deviation(arm)))
        ), arm
    except InputError as error:
        track = opw_recognition.track_of(description.chain)
        begin = (
            ""
            if not track
            else Text(
                "; the robot begins at the link {!r}; or write `external: {}` to use the track "
                "and positioner of the file",
                robot.moved_by(description.joints[track - 1]),
                WHOLE_CELL,
            )
        )
        raise InputError(
            error.code,
            "cell.machine",
            "{} from {} to {}: {}{}",
            robot.path.name,
            base,
            tip,
            error.message,
            Word(begin),
        ) from None


def _note_deviation(arm: SerialArm) -> list[str]:
    """Return a note on an arm whose axes are not exactly perpendicular."""
    if not isinstance(arm, CalibratedArm):
        return []
    return [
        Text(
            "the axes are up to {:.2g} deg off right angles, and joint angles are solved for the "
            "actual axes",
            math.degrees(recognition.off_square(arm.chain)),
        )
    ]


def chain_of(mechanism_reference: Reference) -> Description:
    """Return the chain of an external mechanism.

    Raises InputError UNKNOWN_MACHINE if the file is missing, or BAD_URDF.
    """
    return external_chain(*_ends(mechanism_reference, EXTERNAL_KEY))


def external_chain(robot: Urdf, base: str, tip: str) -> Description:
    """Return the chain from one link to another, with its link bodies.

    Parameters
    ----------
    robot : Urdf
        The file.
    base, tip : str
        First and last link.

    Returns
    -------
    Description
        The chain, with notes on unreadable geometry.

    Raises
    ------
    InputError
        BAD_URDF for an invalid file.
    """
    description = robot.between(base, tip)
    notes: list[str] = []
    bodies = collision(robot, base, tip, notes)
    return replace(description, bodies=bodies, notes=(*description.notes, *notes))


def _ends(chain_reference: Reference, where: str) -> tuple[Urdf, str, str]:
    """Return the file, base and tip of a reference; the file proposes missing links."""
    path = Path(chain_reference.file).expanduser()
    if not is_there(path):
        raise InputError(
            "UNKNOWN_MACHINE", where, "URDF {} does not exist; check the path", chain_reference.file
        )
    robot = Urdf(path)
    base = chain_reference.base or robot.bases()[0]
    tips = robot.tips(base) if base in robot.links else []
    for link in (base, chain_reference.tip):
        if link is not None and link not in robot.links:
            link_names = ", ".join(robot.links)
            raise InputError(
                "BAD_URDF",
                where,
                "{} has no link {!r}; use one of {}",
                path.name,
                link,
                link_names,
            )
    if chain_reference.tip is None and not tips:
        raise InputError(
            "BAD_URDF",
            where,
            "no joint of {} moves relative to {!r}; choose another link as base",
            path.name,
            base,
        )
    return robot, base, chain_reference.tip or tips[0]


def closed_form(chain: Chain) -> SerialArm | None:
    """Return the inverse of a robot; None for a five-axis machine.

    Raises InputError NO_CLOSED_FORM with the reason for any other machine.
    """
    return None if is_five_axis(chain.sliding) else recognition.arm_of(chain)


def ground_description(description: Description) -> Description:
    """Return the description with chain, base and meshes relative to `base_link` of
    `grounded_chain`.
    """
    chain, moved = grounded_chain(description.chain)
    shapes = tuple(
        shape if index or shape is None else replace(shape, pose=moved @ shape.pose)
        for index, shape in enumerate(description.shapes)
    )
    return replace(
        description,
        chain=chain,
        base=moved if description.base is None else moved @ description.base,
        shapes=shapes,
    )


def grounded_chain(chain: Chain) -> tuple[Chain, Array]:
    """Return a chain relative to a base_link whose Z is axis 1.

    Five-axis machines begin at the torch, and mechanisms at their foot, so they stay unchanged.

    Parameters
    ----------
    chain : Chain
        The chain.

    Returns
    -------
    chain : Chain
        The chain, as returned by `opw_recognition.rooted`.
    base : (4, 4) array
        Previous base_link in the new base_link.
    """
    return (
        (chain, np.eye(4))
        if chain.sliding.any() or is_mechanism(chain)
        else opw_recognition.rooted(chain)
    )


def is_mechanism(chain: Chain) -> bool:
    """Whether a chain is a track, turntable or positioner, not a complete machine."""
    return chain.axes <= MECHANISM
