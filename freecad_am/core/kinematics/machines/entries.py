# SPDX-License-Identifier: LGPL-2.1-or-later
"""Entries of machine files as numbers: units, limits, pulses, arms."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...issues import InputError, Text
from ...types import Array
from ..chain import Chain
from ..inverse import recognition
from ..inverse.five_axis import is_five_axis
from ..inverse.opw import OpwArm
from ..inverse.serial_arm import SerialArm
from ..limits import Limits, Payload
from .file import Node

SPEED_UNITS = ("mm/s", "cm/min", "mm/min")
# possible scopes of a warning: positions of Cartesian programs, joint values of joint programs, the limits of all sets or,
# behind a dot, of one, and the speeds of the axes
WARNED = ("base", "joint", "limits", "speeds")


class MachineWarning(NamedTuple):
    """A doubt about a machine file that may change a program: its scope, and its text."""

    applies_to: str
    text: str


def warnings_of(top: Node) -> tuple[MachineWarning, ...]:
    """Return the warnings of a machine file, empty without the key."""
    return (
        tuple(_warning(node, top) for node in top["warnings"].items())
        if top.has("warnings")
        else ()
    )


def _warning(node: Node, top: Node) -> MachineWarning:
    node.only("applies_to", "text")
    applies_to = node["applies_to"].text()
    sets = [f"limits.{name}" for name, _ in top["limits"].pairs()]
    if applies_to not in (*WARNED, *sets):
        raise node["applies_to"].bad(
            Text(
                "{!r} is not a valid target of a warning; use {}",
                applies_to,
                ", ".join([*WARNED, *sets]),
            )
        )
    return MachineWarning(applies_to, node["text"].text())


def pulses_of(controller: Node, count: int) -> tuple[float, ...]:
    """Return the pulses of each axis, empty if the file does not state them."""
    if not controller.has("pulses_per_degree"):
        return ()
    node = controller["pulses_per_degree"]
    pulses = node.numbers(count)
    if (pulses == 0.0).any():
        raise node.bad(
            Text(
                "{} contains a 0; give the pulses per degree of each axis, negative where they "
                "count down",
                node.value,
            )
        )
    return tuple(pulses.tolist())


def speed_unit_of(node: Node) -> str:
    if node.text() not in SPEED_UNITS:
        raise node.bad(
            Text("{!r} is not a unit of path speed; use {}", node.value, ", ".join(SPEED_UNITS))
        )
    return node.text()


def name_of(joint: Node, numbered: str, has_name: bool) -> str:
    """What messages and curves call an axis."""
    if joint.has("label"):
        return joint["label"].text()
    return joint["name"].text() if has_name else numbered


def unit_of(node: Node) -> Array:
    axis = node.numbers(3)
    length = float(np.linalg.norm(axis))
    if abs(length - 1.0) > 1e-6:
        raise node.bad(Text("{} is not a unit vector; give a vector of length 1", node.value))
    return axis / length


def slides(joint: Node) -> bool:
    kind = joint["type"].text() if joint.has("type") else "revolute"
    if kind not in ("revolute", "prismatic"):
        raise joint["type"].bad(Text("{!r} is not a joint type; use revolute or prismatic", kind))
    return kind == "prismatic"


def maximum_of(joint: Node, key: str, what: str) -> float:
    if not joint.has(key):
        return math.inf
    maximum = joint[key].number()
    if maximum <= 0.0:
        raise joint[key].bad(
            Text("{:g} is not {}; give more than 0, or null where not known", maximum, what)
        )
    return maximum


def payload_of(top: Node) -> Payload:
    """Return the payload of a machine, as far as its file states it."""
    if not top.has("payload"):
        return Payload()
    payload = top["payload"].only("kg", "from_axis", "source")
    return Payload(
        maximum_of(payload, "kg", "a mass"), maximum_of(payload, "from_axis", "a distance")
    )


def recognise_arm(chain: Chain) -> tuple[SerialArm | None, str]:
    """Return the inverse of a robot whose file has no `opw`, or the reason for having none;
    `five_axis` handles five-axis machines.
    """
    if is_five_axis(chain.sliding):
        return None, ""
    try:
        return recognition.arm_of(chain), ""
    except InputError as error:
        return None, error.message


def opw_arm(node: Node, count: int) -> OpwArm:
    lengths = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
    node.only(*lengths, "offsets", "signs")
    if count != 6:
        raise node.bad(
            Text("the closed form is for six joints, but the machine has {}; remove opw", count)
        )
    signs = node["signs"].numbers(6)
    if (np.abs(signs) != 1.0).any():
        raise node["signs"].bad(
            Text("{} must be 1 or -1 each; give one for each joint", node["signs"].value)
        )
    offsets = node["offsets"].numbers(6)
    if (np.abs(offsets) > 180.0).any():
        raise node["offsets"].bad(
            Text(
                "{} must be within +-180; give equivalent angles in that range",
                node["offsets"].value,
            )
        )
    for name in ("c2", "c3"):
        if node[name].number() <= 0.0:
            raise node[name].bad(
                Text("{} is not the length of an arm; give more than 0 mm", node[name].value)
            )
    return OpwArm(
        **{name: node[name].number() for name in lengths},
        offsets=tuple(np.radians(offsets).tolist()),
        signs=tuple(int(sign) for sign in signs),
    )


def limits_of(name: str, node: Node, axes: tuple[str, ...], units: Array) -> Limits:
    node.only("axes", "coupled", "source")
    count = len(axes)
    spans = np.array(
        [axis.span(unit) for axis, unit in zip(node["axes"].items(count), units, strict=True)]
    )
    coupled = (
        [c.only("label", "coefficients", "range") for c in node["coupled"].items()]
        if node.has("coupled")
        else []
    )
    ranges = np.array([row["range"].span() for row in coupled]).reshape(len(coupled), 2)
    coefficients = np.array([row["coefficients"].numbers(count) for row in coupled]).reshape(
        len(coupled), count
    )
    return Limits(
        name=name,
        lower=spans[:, 0].copy(),
        upper=spans[:, 1].copy(),
        coefficients=coefficients,
        coupled_lower=ranges[:, 0].copy(),
        coupled_upper=ranges[:, 1].copy(),
        labels=axes + tuple(row["label"].text() for row in coupled),
        source=node["source"].text(),
    )
