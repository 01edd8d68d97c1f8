# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed access to the JSON of a machine file; every error names file, key and value.

docs/machines.md explains the keys.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...geometry import frames
from ...geometry.job_files import read_content
from ...issues import InputError, Text, Word
from ...types import Array
from ..chain import Chain
from ..inverse import recognition
from ..inverse.five_axis import is_five_axis
from ..inverse.serial_arm import SerialArm
from ..inverse.spherical_wrist import OpwArm
from ..limits import Limits, Payload

MAX_FILE_MB = 16
LARGEST_NUMBER = 1e300


class Node:
    """A part of a machine file and its location. Getters raise InputError BAD_MACHINE."""

    def __init__(self, value: Any, path: Path, key: str = "") -> None:
        self.value, self.path, self.key = value, path, key

    def bad(self, message: str) -> InputError:
        """Return the error for this part."""
        return InputError(
            "BAD_MACHINE", f"{self.path}{': ' if self.key else ''}{self.key}", message
        )

    def only(self, *allowed: str) -> Node:
        """Return this node if it is an object without unknown keys."""
        if not isinstance(self.value, dict):
            raise self.bad(
                Text(
                    "{} is not an object with the keys {}; write an object in braces",
                    _short(self.value),
                    ", ".join(allowed),
                )
            )
        for key in self.value:
            if key not in allowed:
                raise self.bad(Text("the key {!r} is not known; use {}", key, ", ".join(allowed)))
        return self

    def has(self, key: str) -> bool:
        """Whether an object has a key that is not null."""
        return isinstance(self.value, dict) and self.value.get(key) is not None

    def __getitem__(self, key: str) -> Node:
        if not isinstance(self.value, dict) or key not in self.value:
            raise self.bad(Text("the key {!r} is missing; add the key", key))
        return Node(self.value[key], self.path, f"{self.key}.{key}".lstrip("."))

    def items(self, length: int | None = None) -> list[Node]:
        """Return the items of a list, which must have `length` items if given."""
        if not isinstance(self.value, list) or (length is not None and len(self.value) != length):
            raise self.bad(
                Text(
                    "{} is not a list{}; write a list in square brackets",
                    _short(self.value),
                    Word(Text(" of {}", length) if length is not None else ""),
                )
            )
        return [
            Node(value, self.path, f"{self.key}[{index}]") for index, value in enumerate(self.value)
        ]

    def pairs(self) -> Iterator[tuple[str, Node]]:
        """Return the keys and values of an object."""
        if not isinstance(self.value, dict):
            raise self.bad(
                Text("{} is not an object; write an object in braces", _short(self.value))
            )
        return ((key, self[key]) for key in self.value)

    def text(self) -> str:
        """Return a non-empty text."""
        if not isinstance(self.value, str) or not self.value:
            raise self.bad(Text("{} is not a text; write the text in quotes", _short(self.value)))
        return self.value

    def texts(self) -> tuple[str, ...]:
        """Return a list of texts."""
        return tuple(item.text() for item in self.items())

    def number(self) -> float:
        """Return a finite number."""
        if (
            isinstance(self.value, bool)
            or not isinstance(self.value, (int, float))
            or not abs(self.value) <= LARGEST_NUMBER
        ):
            raise self.bad(
                Text("{} is not a number; write a number such as 12.5", _short(self.value))
            )
        return float(self.value)

    def numbers(self, length: int) -> Array:
        """Return a list of finite numbers.

        Parameters
        ----------
        length : int
            Required length.

        Returns
        -------
        (length,) array
            The numbers.

        Raises
        ------
        InputError
            BAD_MACHINE for any other content.
        """
        are_numbers = isinstance(self.value, list) and {type(value) for value in self.value} <= {
            int,
            float,
        }
        if (
            are_numbers
            and len(self.value) == length
            and all(abs(value) <= LARGEST_NUMBER for value in self.value)
        ):
            return np.array(self.value, float)
        # something is invalid: item by item, the error names it
        return np.array([item.number() for item in self.items(length)])

    def span(self, unit: float = math.radians(1.0)) -> tuple[float, float]:
        """Return a range of two numbers.

        Parameters
        ----------
        unit : float, optional
            Factor for both numbers; converts degrees to rad by default.

        Returns
        -------
        lower, upper : float
            The range; infinite for null.

        Raises
        ------
        InputError
            BAD_MACHINE if the first number is not the smaller one.
        """
        if self.value is None:
            return -math.inf, math.inf
        lower, upper = (item.number() for item in self.items(2))
        if not lower < upper:
            raise self.bad(
                Text(
                    "{} is not a range; give the smaller value first, or null for a continuous "
                    "axis",
                    _short(self.value),
                )
            )
        return lower * unit, upper * unit

    def matrix(self, rows: int, columns: int) -> Array:
        """Return a matrix from a list of lists of numbers.

        Parameters
        ----------
        rows, columns : int
            Required size.

        Returns
        -------
        (rows, columns) array
            The numbers.

        Raises
        ------
        InputError
            BAD_MACHINE for any other content.
        """
        return np.array([row.numbers(columns) for row in self.items(rows)]).reshape(rows, columns)

    def pose(self) -> Array:
        """Return a pose from `origin` in mm and `rpy` in degrees.

        Returns
        -------
        (4, 4) array
            The pose, mm.

        Raises
        ------
        InputError
            BAD_MACHINE for any other content.
        """
        return frames.from_rpy(self["origin"].numbers(3), np.radians(self["rpy"].numbers(3)))


def _once(pairs: list[tuple[str, Any]], path: Path) -> dict[str, Any]:
    """Return an object; reject duplicate keys."""
    entries: dict[str, Any] = {}
    for key, value in pairs:
        if key in entries:
            raise InputError(
                "BAD_MACHINE", str(path), "the key {!r} appears twice; remove one entry", key
            )
        entries[key] = value
    return entries


def read(path: Path) -> Node:
    """Read a machine file. Raises InputError BAD_MACHINE if it is not valid JSON."""
    try:
        return Node(
            json.loads(
                read_content(path, MAX_FILE_MB, "BAD_MACHINE", str(path)).decode("utf-8-sig"),
                object_pairs_hook=lambda pairs: _once(pairs, path),
            ),
            path,
        )
    except RecursionError:
        raise InputError(
            "BAD_MACHINE",
            str(path),
            "the file is nested too deeply for a machine file; choose another file",
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(
            "BAD_MACHINE",
            str(path),
            "the file cannot be read as a machine file: {}; correct the file, or choose another",
            error,
        ) from None


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


# tolerances for the rounding of check poses: mm, and rotation matrix entries
POSITION_TOLERANCE, ROTATION_TOLERANCE = 1e-6, 1e-9
MOST_ROUNDING = (0.5, 0.1)  # maximum tolerance that a check pose may state, mm and deg


def check(chain: Chain, opw: OpwArm | None, node: Node) -> None:
    """Reject a file whose check poses do not match its geometry.

    Parameters
    ----------
    chain : Chain
        The chain of the file.
    opw : OpwArm or None
        Closed form of the arm; None without a closed form.
    node : Node
        Check poses: at least three, including the zero pose.

    Raises
    ------
    InputError
        BAD_MACHINE for missing or mismatched poses.
    """
    poses = [pose.only("q", "origin", "rotation", "within") for pose in node.items()]
    if len(poses) < 3:
        raise node.bad(
            Text("the file has {}; give at least 3 joint vectors with flange poses", len(poses))
        )
    q = np.array([pose["q"].numbers(chain.axes) for pose in poses]) * np.where(
        chain.sliding, 1.0, math.radians(1.0)
    )
    if not (q == 0.0).all(axis=1).any():
        raise node.bad("the pose at all zeros is missing; add this pose")
    expected = np.stack(
        [frames.pose(pose["rotation"].matrix(3, 3), pose["origin"].numbers(3)) for pose in poses]
    )
    allowed = np.array([_tolerance_of(pose) for pose in poses])
    solvers = {"the joint frames give": chain.forward}
    if opw is not None:
        solvers["opw gives"] = opw.forward
    for solver_gives, forward in solvers.items():
        off = np.abs(forward(q) - expected)
        position, rotation = off[:, :3, 3].max(axis=1), off[:, :3, :3].max(axis=(1, 2))
        wrong = (position > allowed[:, 0]) | (rotation > allowed[:, 1])
        if wrong.any():
            index = int(np.argmax(wrong))
            raise poses[index].bad(
                Text(
                    "{} a flange pose that deviates by {:.6g} mm and {:.3g} (largest entry of "
                    "the rotation); correct the geometry or the pose",
                    solver_gives,
                    position[index],
                    rotation[index],
                )
            )


def _tolerance_of(pose: Node) -> tuple[float, float]:
    """Return the tolerance of a check pose in mm and as rotation matrix entries.

    `within` sets it for a pose read from a display.
    """
    if not pose.has("within"):
        return POSITION_TOLERANCE, ROTATION_TOLERANCE
    node = pose["within"].only("mm", "deg")
    values = []
    for key, max_value in zip(("mm", "deg"), MOST_ROUNDING, strict=True):
        value = node[key].number()
        if not 0.0 <= value <= max_value:
            raise node[key].bad(
                Text(
                    "{:g} exceeds the rounding of a display; give 0 to {:g}",
                    value,
                    max_value,
                )
            )
        values.append(value)
    return max(values[0], POSITION_TOLERANCE), max(math.radians(values[1]), ROTATION_TOLERANCE)


SPEED_UNITS = ("mm/s", "cm/min", "mm/min")
# scopes of a warning: positions of Cartesian programs, joint values of joint programs, limits of
# all sets (or of one, as limits.NAME), and axis speeds
WARNED = ("base", "joint", "limits", "speeds")


class MachineWarning(NamedTuple):
    """A doubt about a machine file that may change a program: its scope and its text."""

    applies_to: str
    text: str


def warnings_of(top: Node) -> tuple[MachineWarning, ...]:
    """Return the warnings of a machine file; empty without the key."""
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
    """Return the pulses per degree of each axis.

    Parameters
    ----------
    controller : Node
        The `controller` node of the machine file.
    count : int
        Number of axes.

    Returns
    -------
    tuple of float
        Pulses per degree, negative where pulses count down; empty if the file does not state them.

    Raises
    ------
    InputError
        BAD_MACHINE for a value of 0.
    """
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
    """Return the name of an axis in messages and curves.

    Parameters
    ----------
    joint : Node
        The joint node; its `label` takes precedence.
    numbered : str
        Name of an axis without label and name.
    has_name : bool
        Whether `name` takes precedence over `numbered`.

    Returns
    -------
    str
        Axis name.
    """
    if joint.has("label"):
        return joint["label"].text()
    return joint["name"].text() if has_name else numbered


def unit_of(node: Node) -> Array:
    """Return a unit vector.

    Parameters
    ----------
    node : Node
        Node with three numbers.

    Returns
    -------
    (3,) array
        Unit vector.

    Raises
    ------
    InputError
        BAD_MACHINE if the length is not 1.
    """
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
    """Return the maximum of a joint quantity.

    Parameters
    ----------
    joint : Node
        The joint node.
    key : str
        Key of the value.
    what : str
        Name of the quantity in messages.

    Returns
    -------
    float
        The maximum; infinite if the file does not state it.

    Raises
    ------
    InputError
        BAD_MACHINE if the value is not positive.
    """
    if not joint.has(key):
        return math.inf
    maximum = joint[key].number()
    if maximum <= 0.0:
        raise joint[key].bad(
            Text("{:g} is not {}; give more than 0, or null if unknown", maximum, what)
        )
    return maximum


def payload_of(top: Node) -> Payload:
    """Return the payload of a machine; infinite where its file does not state it."""
    if not top.has("payload"):
        return Payload()
    payload = top["payload"].only("kg", "from_axis", "source")
    return Payload(
        maximum_of(payload, "kg", "a mass"), maximum_of(payload, "from_axis", "a distance")
    )


def recognise_arm(chain: Chain) -> tuple[SerialArm | None, str]:
    """Return the inverse of an arm whose machine file has no `opw`.

    Parameters
    ----------
    chain : Chain
        The chain.

    Returns
    -------
    arm : SerialArm or None
        Inverse; None without a closed form, and for five-axis machines, which `five_axis` handles.
    reason : str
        Why there is no inverse; otherwise empty.
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
            Text(
                "{} must be 1 or -1 each; give one sign per joint",
                node["signs"].value,
            )
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
    """Return a limit set of a machine file.

    Parameters
    ----------
    name : str
        Name of the limit set.
    node : Node
        Node of the limit set.
    axes : tuple of str
        Axis names.
    units : (axes,) array
        Internal value of one displayed unit: rad per degree, or 1.

    Returns
    -------
    Limits
        The limits.

    Raises
    ------
    InputError
        BAD_MACHINE for invalid content.
    """
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
