# SPDX-License-Identifier: LGPL-2.1-or-later
"""A URDF in the place of a machine: what of it a machine is made of."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...geometry.located import is_there
from ...issues import InputError, Text, Word
from ...parameters.external import WHERE
from ...types import Array
from ..chain import Chain
from ..inverse import opw_recognition, recognition
from ..inverse.calibrated import CalibratedArm
from ..inverse.five_axis import is_five_axis
from ..inverse.serial_arm import SerialArm
from .collision import collision
from .read import Description, Urdf
from .reference import Reference

MECHANISM = 2  # axes of one at most
WHOLE = "urdf"  # in the place of `cell.external`: what the URDF of the machine has (`urdf_cell`)


def described(meant: Reference) -> tuple[Description, SerialArm | None]:
    """The chain of a machine, grounded, with its inverse; None of one with three sliding and two turning axes.

    Raises InputError: UNKNOWN_MACHINE without the file, BAD_URDF naming file and line, NO_CLOSED_FORM with the reason.
    """
    robot, base, tip = _ends(meant, "cell.machine")
    found = grounded(robot.between(base, tip))
    try:
        arm = closed_form(found.chain)
        return (found if arm is None else replace(found, notes=(*found.notes, *_off(arm)))), arm
    except InputError as error:
        track = opw_recognition.track_of(found.chain)
        begin = (
            ""
            if not track
            else Text(
                "; the robot begins at the link {!r}; or write `external: {}`, which takes track "
                "and positioner of the file",
                robot.moved_by(found.joints[track - 1]),
                WHOLE,
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


def _off(arm: SerialArm) -> list[str]:
    """A note about an arm whose axes are not quite at right angles."""
    if not isinstance(arm, CalibratedArm):
        return []
    return [
        Text(
            "its axes are up to {:.2g} deg off right angles: joint angles are solved for the axes as they are",
            math.degrees(recognition.off_square(arm.chain)),
        )
    ]


def chain_of(meant: Reference) -> Description:
    """The chain of a mechanism beside a robot. Raises InputError UNKNOWN_MACHINE without the file, BAD_URDF."""
    return external_chain(*_ends(meant, WHERE))


def external_chain(robot: Urdf, base: str, tip: str) -> Description:
    """The chain from a link to another, with what its links are made of. Raises InputError BAD_URDF."""
    found = robot.between(base, tip)
    notes: list[str] = []
    bodies = collision(robot, base, tip, notes)
    return replace(found, bodies=bodies, notes=(*found.notes, *notes))


def _ends(meant: Reference, where: str) -> tuple[Urdf, str, str]:
    """A file, and the links that a chain begins and ends with: those that are meant, or that the file proposes."""
    path = Path(meant.file).expanduser()
    if not is_there(path):
        raise InputError(
            "UNKNOWN_MACHINE", where, "there is no URDF {}; check the path", meant.file
        )
    robot = Urdf(path)
    base = meant.base or robot.bases()[0]
    tips = robot.tips(base) if base in robot.links else []
    for link in (base, meant.tip):
        if link is not None and link not in robot.links:
            known = ", ".join(robot.links)
            raise InputError(
                "BAD_URDF", where, "{} has no link {!r}; name one of {}", path.name, link, known
            )
    if meant.tip is None and not tips:
        raise InputError(
            "BAD_URDF",
            where,
            "no joint of {} moves anything against {!r}; name another link as base",
            path.name,
            base,
        )
    return robot, base, meant.tip or tips[0]


def closed_form(chain: Chain) -> SerialArm | None:
    """The inverse of a robot, None of a machine with three sliding and two turning axes. InputError NO_CLOSED_FORM, with
    the reason, for any other."""
    return None if is_five_axis(chain.sliding) else recognition.arm_of(chain)


def grounded(found: Description) -> Description:
    """The description with its chain, base and meshes seen from the base_link of `grounded_chain`; `base` is there."""
    chain, moved = grounded_chain(found.chain)
    shapes = tuple(
        shape if index or shape is None else replace(shape, pose=moved @ shape.pose)
        for index, shape in enumerate(found.shapes)
    )
    return replace(
        found, chain=chain, base=moved if found.base is None else moved @ found.base, shapes=shapes
    )


def grounded_chain(chain: Chain) -> tuple[Chain, Array]:
    """A chain seen from a base_link whose Z is axis 1, as `opw_recognition.rooted` has it. Machines with rotary axes begin
    at the torch, wherever that is, and mechanisms where they stand."""
    return (
        (chain, np.eye(4))
        if chain.sliding.any() or is_mechanism(chain)
        else opw_recognition.rooted(chain)
    )


def is_mechanism(chain: Chain) -> bool:
    """Whether a chain is not a machine by itself, but what stands beside a robot: a track, a turntable, a positioner."""
    return chain.axes <= MECHANISM
