# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draft of a machine file, made from a URDF, a table, closed-form dimensions or another machine."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...geometry import frames
from ...issues import InputError, Text
from ...types import Array
from ..chain import Chain
from ..inverse.serial_arm import SerialArm
from ..inverse.spherical_wrist import OpwArm
from ..links.bodies import BASE, LinkShape, Pieces, Primitive
from ..urdf import machine as urdf_machine
from ..urdf.read import Description
from . import file, pendant
from . import file as machine_file
from . import machine as machines
from .machine import Machine
from .pendant import Shown

NAME = re.compile(r"[a-z0-9][a-z0-9._-]*")
# tolerances, mm and deg, to which deviations of check poses are rounded up in the machine file
_ROUNDINGS = ((0.01, 0.001), (0.05, 0.01), (0.1, 0.05), file.MOST_ROUNDING)


@dataclass(frozen=True, eq=False)
class Draft:
    """The content of a machine file.

    joints: axis names. lower, upper, max_speed, max_acceleration, max_jerk: (axes,) rad or mm, per
    s, s^2, s^3; infinite if continuous or unknown. horizontal: displayed range of axis 3 against
    the horizontal, deg; None if not used. base: (4, 4) manufacturer's base frame in base_link.
    values: (n, axes) controller joint values, deg and mm. poses: (n, 4, 4) flange poses in
    base_link for these values. notes: on the source, for the user. remarks: for the file. labels:
    axis names of the pendant; None if it numbers the axes. bodies: (axes + 1) link bodies of a
    mechanism.
    """

    id: str
    title: str
    chain: Chain
    joints: tuple[str, ...]
    lower: Array
    upper: Array
    max_speed: Array
    max_acceleration: Array
    max_jerk: Array
    base: Array
    shown: Shown
    shapes: tuple[LinkShape | None, ...]
    sources: tuple[str, ...]
    horizontal: tuple[float, float] | None = None
    posts: tuple[str, ...] | None = None
    pulses_per_degree: tuple[float, ...] = ()
    speed_unit: str = ""
    values: Array | None = None
    poses: Array | None = None
    notes: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    labels: tuple[str, ...] | None = None
    bodies: tuple[Pieces, ...] = ()

    @property
    def units(self) -> Array:
        """Return the internal value of one displayed unit, for each axis.

        Returns
        -------
        (axes,) array
            rad per degree, or 1 per mm.
        """
        return machines.unit_values(self.chain.sliding)


def draft_of_description(described: Description, source: str) -> Draft:
    """Return the draft of a URDF description, with the limits of the file."""
    description = urdf_machine.ground_description(described)
    draft = _bare(description.chain, description.joints, description.name, source)
    return replace(
        draft,
        lower=description.lower,
        upper=description.upper,
        max_speed=description.max_speed,
        base=np.eye(4) if description.base is None else description.base,
        shapes=description.shapes,
        notes=description.notes,
        bodies=description.bodies,
    )


def draft_of_chain(chain: Chain, source: str) -> Draft:
    """Return the draft of a bare chain, from a table or closed-form dimensions."""
    grounded, moved = urdf_machine.grounded_chain(chain)
    draft = _bare(
        grounded, tuple(f"joint_{number}" for number in range(1, chain.axes + 1)), "", source
    )
    return replace(draft, base=moved)


def draft_of_machine(name: str, folders: Sequence[Path | str] = ()) -> Draft:
    """Return the draft of a copy of a listed machine, with its check poses and limit set `maker`.

    Raises InputError as `machine.load` does, and BAD_MACHINE if a draft cannot express how the
    controller displays axes.
    """
    machine = machines.load(name, folders)
    checks = machine_file.read(machines.file_of(name, folders))["check_poses"].items()
    q = np.array([check["q"].numbers(len(machine.axes)) for check in checks]) * machine.unit_values
    poses = np.stack(
        [
            frames.pose(check["rotation"].matrix(3, 3), check["origin"].numbers(3))
            for check in checks
        ]
    )
    count, limits = len(machine.axes), machine.limits(machines.MAKER)
    display = _display_of(machine)
    coupled = [
        span
        for span, row in zip(
            np.degrees(np.column_stack((limits.coupled_lower, limits.coupled_upper))).tolist(),
            limits.coefficients,
            strict=True,
        )
        if display.coupling == pendant.HORIZONTAL and np.allclose(row, machine.controller_matrix[2])
    ]
    names = (
        machine.axes
        if machine.arrangements[0].named_axes
        else tuple(f"joint_{1 + number}" for number in range(count))
    )
    return Draft(
        id=f"{machine.id}-copy",
        title=machine.title,
        chain=machine.chain,
        joints=names,
        lower=limits.lower[:count],
        upper=limits.upper[:count],
        max_speed=machine.max_speed,
        max_acceleration=machine.max_acceleration,
        max_jerk=machine.max_jerk,
        base=machine.base,
        shown=display,
        shapes=machine.shapes,
        sources=(f"copy of {machine.id}", *machine.sources),
        horizontal=(coupled[0][0] + display.zeros[2], coupled[0][1] + display.zeros[2])
        if coupled
        else None,
        posts=machine.posts,
        pulses_per_degree=machine.pulses_per_degree,
        speed_unit=machine.speed_unit,
        values=machine.to_controller(q) / machine.unit_values,
        poses=poses,
        labels=None if machine.axes == machine.columns else machine.axes,
    )


def closed_form(draft: Draft) -> SerialArm | None:
    """Return the inverse of a draft, as `urdf_machine.closed_form` does; None for a mechanism."""
    return None if urdf_machine.is_mechanism(draft.chain) else urdf_machine.closed_form(draft.chain)


def text(draft: Draft) -> str:
    """Return the text of the machine file.

    Raises InputError BAD_NAME, NO_CLOSED_FORM, or BAD_MACHINE with the invalid key, such as missing
    or mismatched check poses.
    """
    if not NAME.fullmatch(draft.id):
        raise InputError(
            "BAD_NAME",
            "id",
            "{!r} cannot be the name of a machine; use a to z, digits and -",
            draft.id,
        )
    if not draft.title:
        raise InputError("BAD_NAME", "title", "the field is empty; give manufacturer and model")
    content: dict[str, Any] = {
        "id": draft.id,
        "title": draft.title,
        "sources": list(draft.sources),
        "joints": _joints(draft),
        "flange": _pose(draft.chain.flange),
        "base": _pose(draft.base),
    }
    if draft.remarks:
        content["remarks"] = list(draft.remarks)
    arm = closed_form(draft)
    if isinstance(arm, OpwArm):
        content["opw"] = {
            **{name: getattr(arm, name) for name in ("a1", "a2", "b", "c1", "c2", "c3", "c4")},
            "offsets": _figures(np.degrees(arm.offsets)),
            "signs": list(arm.signs),
        }
    content |= {"controller": _controller(draft), "limits": {machines.MAKER: _limits(draft)}}
    shapes = _shapes(draft)
    if shapes:
        content["shapes"] = shapes
    if any(draft.bodies):
        content["bodies"] = {
            "source": draft.sources[0],
            **{
                name: [_piece(body_piece) for body_piece in body_pieces]
                for name, body_pieces in zip((BASE, *draft.joints), draft.bodies, strict=True)
                if body_pieces
            },
        }
    content["check_poses"] = _check_poses(draft)
    written = _compact(json.dumps(content, indent=2, ensure_ascii=False)) + "\n"
    machines.parse(written, Path(f"{draft.id}.json"))
    return written


def _bare(chain: Chain, joints: tuple[str, ...], title: str, source: str) -> Draft:
    unlimited = np.full(chain.axes, math.inf)
    return Draft(
        id="",
        title=title,
        chain=chain,
        joints=joints,
        lower=-unlimited,
        upper=unlimited,
        max_speed=unlimited,
        max_acceleration=unlimited,
        max_jerk=unlimited,
        base=np.eye(4),
        shown=Shown((1,) * chain.axes, (0.0,) * chain.axes),
        shapes=(None,) * (chain.axes + 1),
        sources=(source,),
    )


def _display_of(machine: Machine) -> Shown:
    """Return how the controller displays axes, derived from its matrix and offset."""
    zeros = tuple(_figures(machine.controller_offset / machine.unit_values))
    signs = tuple(int(np.sign(value)) for value in np.diag(machine.controller_matrix))
    for coupling in (pendant.NONE, pendant.HORIZONTAL) if len(signs) == 6 else (pendant.NONE,):
        display = Shown(signs, zeros, coupling)
        if 0 not in signs and np.allclose(
            pendant.matrix(display, machine.chain)[0], machine.controller_matrix
        ):
            return display
    raise InputError(
        "BAD_MACHINE",
        Text("{}: controller.matrix", machine.id),
        "the matrix is not made of signs and a coupling of axes 2 and 3; copy the original file",
    )


def _joints(draft: Draft) -> list[dict[str, Any]]:
    joints = []
    for index, name in enumerate(draft.joints):
        joint: dict[str, Any] = {"name": name}
        if draft.labels is not None:
            joint["label"] = draft.labels[index]
        if draft.chain.sliding[index]:
            joint["type"] = "prismatic"
        joint |= _pose(draft.chain.origins[index])
        joint["axis"] = _figures(draft.chain.directions[index])
        joint["max_speed"] = _known(draft.max_speed[index] / draft.units[index])
        for key in ("max_acceleration", "max_jerk"):
            max_value = getattr(draft, key)[index]
            if math.isfinite(max_value):
                joint[key] = _known(max_value / draft.units[index])
        joints.append(joint)
    return joints


def _controller(draft: Draft) -> dict[str, Any]:
    matrix, offset = pendant.matrix(draft.shown, draft.chain)
    remark = "as shown in the check poses"
    if draft.shown.coupling == pendant.HORIZONTAL:
        remark += f"; J3 is shown against the horizontal, {_coupled_label(matrix[2])}"
    content: dict[str, Any] = {
        "matrix": [_figures(row) for row in matrix],
        "offset": _figures(offset),
        "remark": remark,
    }
    if draft.pulses_per_degree:
        content["pulses_per_degree"] = list(draft.pulses_per_degree)
    if draft.speed_unit:
        content["speed_unit"] = draft.speed_unit
    return content if draft.posts is None else {"posts": list(draft.posts), **content}


def _limits(draft: Draft) -> dict[str, Any]:
    spans = np.column_stack((draft.lower / draft.units, draft.upper / draft.units))
    content: dict[str, Any] = {
        "axes": [None if not np.isfinite(span).all() else _figures(span) for span in spans]
    }
    if draft.shown.coupling == pendant.HORIZONTAL and draft.horizontal is not None:
        row = pendant.matrix(draft.shown, draft.chain)[0][2]
        label = f"J3 as shown ({_coupled_label(row)})"
        span = np.array(draft.horizontal) - draft.shown.zeros[2]
        content["coupled"] = [
            {"label": label, "coefficients": _figures(row), "range": _figures(span)}
        ]
    return {**content, "source": "entered when the machine was made"}


def _coupled_label(row: Array) -> str:
    return f"{'' if row[2] > 0.0 else '-'}q3 {'+' if row[1] > 0.0 else '-'} q2"


def _shapes(draft: Draft) -> dict[str, Any]:
    named = zip((BASE, *draft.joints), draft.shapes, strict=True)
    return {name: _shape(shape) for name, shape in named if shape is not None}


def _shape(shape: LinkShape) -> dict[str, Any]:
    content: dict[str, Any] = {"file": str(shape.path), **_pose(shape.pose), "scale": shape.scale}
    if shape.colour is not None:
        content["colour"] = [round(value, 4) for value in shape.colour]
    return content


def _piece(body_piece: Any) -> dict[str, Any]:
    """Return a piece of a body in the form that `links.bodies` reads."""
    if isinstance(body_piece, LinkShape):
        return _shape(body_piece)
    assert isinstance(body_piece, Primitive) and body_piece.pose is not None
    return {body_piece.kind: _figures(body_piece.size), **_pose(body_piece.pose)}


def _check_poses(draft: Draft) -> list[dict[str, Any]]:
    if draft.values is None or draft.poses is None or not len(draft.values):
        return []
    q = pendant.serial(draft.shown, draft.chain, draft.values)
    off = pendant.deviations(draft.chain, draft.shown, draft.values, draft.poses)
    checks = []
    for angles, pose, deviation in zip(q / draft.units, draft.poses, off, strict=True):
        check = {
            "q": _figures(angles),
            "origin": _figures(pose[:3, 3]),
            "rotation": [_figures(row) for row in pose[:3, :3]],
        }
        fits = [
            entry
            for entry in _ROUNDINGS
            if deviation.position <= entry[0] and deviation.angle <= entry[1]
        ]
        if fits and (deviation.position > 0.5e-6 or deviation.angle > 1e-8):
            check["within"] = {"mm": fits[0][0], "deg": fits[0][1]}
        checks.append(check)
    return checks


def _pose(pose: Array) -> dict[str, Any]:
    # + 0.0 changes -0.0 to 0.0
    return {
        "origin": _figures(pose[:3, 3]),
        "rpy": _figures(np.degrees(-frames.to_bryant(pose[:3, :3].T))),
    }


def _figures(values: Any) -> list[float]:
    return [_figure(float(value)) for value in values]


def _figure(value: float) -> float:
    """Return a number without numerical noise; whole numbers as int."""
    rounded = round(value, 9)
    value = rounded + 0.0 if abs(rounded - value) < 1e-11 else value
    return int(value) if value == int(value) else value


def _known(value: float) -> float | None:
    return _figure(float(value)) if math.isfinite(value) else None


def _compact(text: str) -> str:
    """Return JSON with each list of numbers on one line."""
    lists = re.compile(r"\[\s+((?:-?[\d.eE+-]+|null),?\s*)+\]")
    return lists.sub(
        lambda match: re.sub(r"\s+", " ", match[0]).replace("[ ", "[").replace(" ]", "]"), text
    )


# ---- Poses as pendants display them: position in mm, and rotation in degrees by the convention of
# the manufacturer, or as a quaternion

FANUC, KUKA, STAUBLI, ZYZ, QUATERNION = "W P R", "A B C", "RX RY RZ", "O A T", "q1 q2 q3 q4"
# rotation convention -> names of its values, and the manufacturers that use it
CONVENTIONS = {
    FANUC: ("W P R", "FANUC, Yaskawa (Rx Ry Rz): about X, Y, Z of the base"),
    KUKA: ("A B C", "KUKA: about Z, Y, X, each in the rotated frame"),
    STAUBLI: ("RX RY RZ", "Stäubli: about X, Y, Z, each in the rotated frame"),
    ZYZ: ("O A T", "Kawasaki: about Z, Y, Z, each in the rotated frame"),
    QUATERNION: ("q1 q2 q3 q4", "ABB: quaternion, the scalar first"),
}


def rotation(convention: str, figures: Array) -> Array:
    """Return the rotation matrices of displayed angles.

    Parameters
    ----------
    convention : str
        Rotation convention of the controller.
    figures : (..., 3) or (..., 4) array
        Angles in degrees, or a quaternion of any length.

    Returns
    -------
    (..., 3, 3) array
        Rotation matrices.
    """
    figures = np.asarray(figures, float)
    if convention == QUATERNION:
        return _from_quaternion(figures)
    angle_a, angle_b, angle_c = np.moveaxis(np.radians(figures), -1, 0)
    if convention == FANUC:
        return np.asarray(
            frames.about_z(angle_c) @ frames.about_y(angle_b) @ frames.about_x(angle_a)
        )
    if convention == KUKA:
        return np.asarray(
            frames.about_z(angle_a) @ frames.about_y(angle_b) @ frames.about_x(angle_c)
        )
    if convention == STAUBLI:
        return np.asarray(
            frames.about_x(angle_a) @ frames.about_y(angle_b) @ frames.about_z(angle_c)
        )
    return np.asarray(frames.about_z(angle_a) @ frames.about_y(angle_b) @ frames.about_z(angle_c))


def flange_poses(convention: str, figures: Array, base: Array, tool: Array) -> Array:
    """Return the flange poses of displayed tool poses.

    Parameters
    ----------
    convention : str
        Rotation convention of the controller.
    figures : (n, 6) or (n, 7) array
        Displayed poses, mm and degrees, or mm and quaternion.
    base : (4, 4) array
        Manufacturer's base frame in base_link.
    tool : (4, 4) array
        Tool in the flange frame.

    Returns
    -------
    (n, 4, 4) array
        Flange poses in base_link, mm.
    """
    figures = np.asarray(figures, float)
    poses = frames.pose(rotation(convention, figures[:, 3:]), figures[:, :3])
    result: Array = base @ poses @ frames.inverse(tool)
    return result


def figures_of(convention: str, poses: Array) -> Array:
    """Return poses as a pendant displays them.

    Parameters
    ----------
    convention : str
        Rotation convention of the controller.
    poses : (n, 4, 4) array
        Poses, mm.

    Returns
    -------
    (n, 6) or (n, 7) array
        mm and degrees, or mm and quaternion.
    """
    turned = np.asarray(poses, float)[:, :3, :3]
    if convention == QUATERNION:
        angles = _to_quaternion(turned)
    elif convention == STAUBLI:
        angles = np.degrees(frames.to_bryant(turned))
    elif convention == ZYZ:
        angles = np.degrees(_to_zyz(turned))
    else:
        wpr = -np.degrees(frames.to_bryant(np.swapaxes(turned, -1, -2)))
        angles = wpr if convention == FANUC else wpr[:, ::-1]
    return np.column_stack((poses[:, :3, 3], angles)) + 0.0


def _from_quaternion(q: Array) -> Array:
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)),
        (2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)),
        (2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _to_quaternion(turned: Array) -> Array:
    """Return unit quaternions (n, 4), scalar first and non-negative.

    The formula divides by the largest component.
    """
    diagonal = np.diagonal(turned, axis1=1, axis2=2)
    squares = (
        np.column_stack(
            (diagonal.sum(axis=1), 2.0 * diagonal - diagonal.sum(axis=1, keepdims=True))
        )
        + 1.0
    )
    (_, b, c), (d, _, f), (g, h, _) = np.moveaxis(turned, 0, -1)
    products = np.array(
        [
            [squares[:, 0], h - f, c - g, d - b],
            [h - f, squares[:, 1], b + d, c + g],
            [c - g, b + d, squares[:, 2], f + h],
            [d - b, c + g, f + h, squares[:, 3]],
        ]
    )
    q = products[np.argmax(squares, axis=1), :, np.arange(len(turned))]
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    result: Array = q * np.where(q[:, :1] < 0.0, -1.0, 1.0)
    return result


def _to_zyz(turned: Array) -> Array:
    """Return O A T (n, 3) rad, with A from 0 to pi; O is 0 if A is 0 or pi."""
    locked = np.hypot(turned[:, 0, 2], turned[:, 1, 2]) < 1e-12
    angle_o = np.where(locked, 0.0, np.arctan2(turned[:, 1, 2], turned[:, 0, 2]))
    angle_a = np.arctan2(np.hypot(turned[:, 0, 2], turned[:, 1, 2]), turned[:, 2, 2])
    # Y of the frame after rotation by O
    across = np.column_stack((-np.sin(angle_o), np.cos(angle_o), np.zeros_like(angle_o)))
    angle_t = np.arctan2(
        np.einsum("ni,ni->n", across, turned[:, :, 0]),
        np.einsum("ni,ni->n", across, turned[:, :, 1]),
    )
    return np.column_stack((angle_o, angle_a, angle_t))
