# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration of an individual Universal Robots arm, as ROS' `ur_calibration` exports it.

The file gives the pose of each joint frame in the previous link: `kinematics: forearm: {x, y, z,
roll, pitch, yaw}` in m and rad, in YAML block style. The first pose is relative to the
manufacturer's base frame. The machine file provides everything else.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...geometry import frames
from ...geometry.job_files import is_there, read_content
from ...issues import InputError
from ...types import Array
from ..chain import Chain

MAX_FILE_MB = 1
JOINTS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
NUMBERS = ("x", "y", "z", "roll", "pitch", "yaw")
# mm and rad; a calibration that deviates more from the machine file belongs to another robot
FAR_MM, FAR_RAD = 30.0, math.radians(3.0)
_NAMED = re.compile(r"(?P<machine>.+?)\s+calibration=(?P<file>.+)")
_ENTRY = re.compile(r"(?P<indent> *)(?P<key>[^\s:#]+):(?:\s+(?P<value>.*))?")


@dataclass(frozen=True)
class Named:
    """A machine (id or file) and its calibration file: `ur-ur10e calibration=my.yaml` as text."""

    machine: str
    file: str

    def __str__(self) -> str:
        return f"{self.machine} calibration={self.file}"


def named(text: str) -> Named | None:
    """Return the machine and calibration that a text names; None without a calibration."""
    match = _NAMED.fullmatch(text.strip())
    return None if match is None else Named(match["machine"], match["file"])


def read(path: Path) -> tuple[Array, str]:
    """Read the calibration of a robot.

    Parameters
    ----------
    path : Path
        YAML file from ur_calibration.

    Returns
    -------
    poses : (6, 4, 4) array
        Poses of the joint frames in the previous links, mm.
    hash : str
        `hash` of the robot; empty if missing.

    Raises
    ------
    InputError
        UNKNOWN_MACHINE if the file is missing; BAD_CALIBRATION with the line or key.
    """
    if not is_there(path):
        raise InputError(
            "UNKNOWN_MACHINE",
            "cell.machine",
            "the calibration {} does not exist; give the path of the YAML file that "
            "ur_calibration wrote for the arm",
            path,
        )
    try:
        text = read_content(path, MAX_FILE_MB, "BAD_CALIBRATION", str(path)).decode("utf-8")
    except (OSError, ValueError) as error:
        raise InputError(
            "BAD_CALIBRATION",
            str(path),
            "the file cannot be read as a calibration: {}; use the file as ur_calibration wrote it",
            error,
        ) from None
    entries = _entries(text, path)
    poses = [_pose(entries, joint, path) for joint in JOINTS]
    return np.stack(poses), entries.get("kinematics.hash", "").strip("'\"")


def calibrated(chain: Chain, base: Array, poses: Array, path: Path) -> Chain:
    """Return the robot chain with calibrated joint frames.

    Parameters
    ----------
    chain : Chain
        Chain of the machine file.
    base : (4, 4) array
        Manufacturer's base frame in base_link.
    poses : (6, 4, 4) array
        Calibrated joint frames, mm.
    path : Path
        Calibration file, for messages.

    Returns
    -------
    Chain
        The calibrated chain.

    Raises
    ------
    InputError
        BAD_CALIBRATION if a joint is far from its position in the machine file.
    """
    origins = poses.copy()
    origins[0] = base @ poses[0]
    for joint, was, now in zip(JOINTS, chain.origins, origins, strict=True):
        off = float(np.linalg.norm(now[:3, 3] - was[:3, 3]))
        turned = math.acos(
            float(np.clip(0.5 * (np.trace(was[:3, :3].T @ now[:3, :3]) - 1.0), -1.0, 1.0))
        )
        if off > FAR_MM or turned > FAR_RAD:
            raise InputError(
                "BAD_CALIBRATION",
                f"{path}: kinematics.{joint}",
                "the calibrated joint is {:.3g} mm and {:.3g} deg from the joint in the machine "
                "file, more than a calibration corrects; choose the calibrated machine",
                off,
                math.degrees(turned),
            )
    return Chain(origins, chain.directions.copy(), chain.flange.copy())


def _entries(text: str, path: Path) -> dict[str, str]:
    """Return the values of a file of nested keys, by dotted key."""
    values: dict[str, str] = {}
    open_: list[tuple[int, str]] = []
    for number, line in enumerate(text.splitlines(), 1):
        content = line.split(" #")[0].rstrip()
        if not content or content.startswith(("#", "---", "%")):
            continue
        entry = _ENTRY.fullmatch(content)
        if entry is None:
            raise InputError(
                "BAD_CALIBRATION",
                f"{path}: line {number}",
                "{} is not `key: value`; use the file as ur_calibration wrote it",
                _short(line),
            )
        indent = len(entry["indent"])
        while open_ and open_[-1][0] >= indent:
            open_.pop()
        key = ".".join([*(name for _, name in open_), entry["key"]])
        if key in values:
            raise InputError(
                "BAD_CALIBRATION",
                f"{path}: line {number}",
                "the key {} is duplicated; use the file as ur_calibration wrote it",
                key,
            )
        values[key] = entry["value"] or ""
        open_.append((indent, entry["key"]))
    return values


def _pose(entries: dict[str, str], joint: str, path: Path) -> Array:
    numbers = []
    for name in NUMBERS:
        key = f"kinematics.{joint}.{name}"
        if key not in entries:
            raise InputError(
                "BAD_CALIBRATION",
                f"{path}: {key}",
                "the key is missing; use the file as ur_calibration wrote it",
            )
        try:
            number = float(entries[key])
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise InputError(
                "BAD_CALIBRATION",
                f"{path}: {key}",
                "{} is not a number; use the file as ur_calibration wrote it",
                _short(entries[key]),
            )
        numbers.append(number)
    return frames.from_rpy(np.array(numbers[:3]) * 1000.0, np.array(numbers[3:]))


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")
