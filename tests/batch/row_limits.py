# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare rows of waypoints.csv, and the joint values in a program's text, with the limits of a
machine file, without the program's own code."""

import csv
import json
import re
from pathlib import Path

import numpy as np

MACHINES = Path(__file__).parents[2] / "freecad_am" / "machines"
# how a text states an axis: FANUC's J1= .. deg, KRL's A1 .., VAL 3's j1="..", words of G-code
KRL = r"PTP \{{[^}}]*\bA{} (-?\d+\.\d+)"
FANUC, VAL3 = r"J{}= *(-?\d*\.\d+) deg", r"<Value [^>]*\bj{}=\"(-?\d+\.\d+)\""


def _read_limits(machine, limits):
    machine_data = json.loads((MACHINES / f"{machine}.json").read_text(encoding="utf-8"))
    return machine_data, machine_data["limits"][limits]


def most_beyond(joints, told):
    """Return the largest excess of joints (n, axes) over the limits of a machine file; NaN values
    are not stated."""
    ranges = [
        (values, ends)
        for values, ends in zip(joints.T, told["axes"], strict=True)
        if ends is not None
    ]
    ranges += [
        (joints @ np.array(rule["coefficients"], dtype=float), rule["range"])
        for rule in told.get("coupled", ())
    ]
    ranges_ = [(values[~np.isnan(values)], ends) for values, ends in ranges]
    return max(
        max(ends[0] - values.min(), values.max() - ends[1])
        for values, ends in ranges_
        if len(values)
    )


def waypoint_excess(waypoints, machine, limits):
    """Return the largest excess, in degrees or mm, of any row of waypoints.csv over a limit, rapids
    included."""
    machine_data, ranges = _read_limits(machine, limits)
    with open(waypoints, encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    names = [
        f"{joint['name']}_{'mm' if joint.get('type') == 'prismatic' else 'deg'}"
        for joint in machine_data["joints"]
    ]
    names = names if names[0] in rows[0] else [f"q{axis}_deg" for axis in range(1, 7)]
    return most_beyond(np.array([[float(row[name]) for name in names] for row in rows]), ranges)


def told_joints(files, machine):
    """Return the joint values (n, axes) that the files {name: text} of a program state, as the
    machine file counts them."""
    machine_data = json.loads((MACHINES / f"{machine}.json").read_text(encoding="utf-8"))
    axes, text = len(machine_data["joints"]), "\n".join(files.values())
    if axes == 6:
        ends = {Path(name).suffix for name in files}
        pattern = FANUC if ".LS" in ends else KRL if ".src" in ends else VAL3
        values = np.array(
            [re.findall(pattern.format(axis), text) for axis in range(1, 7)], dtype=float
        ).T
    # the last word of each axis counts; stated positions are those of the tip, so only rotary words
    # count
    else:
        bare = not re.search(r"TRAORI|M428|[ABC]3=", text)
        words = [
            joint["name"][-1].upper() if bare or joint.get("type") != "prismatic" else "no word"
            for joint in machine_data["joints"]
        ]
        rows = [line for line in text.splitlines() if re.search(r"\bG1 ", line)]
        matches = [
            [re.findall(rf"{word}=?(?:DC\()?(-?\d+\.\d+)", line) for word in words] for line in rows
        ]
        values = np.array(
            [[float(match[-1]) if match else np.nan for match in line] for line in matches]
        )
    matrix, offset = (
        np.array(machine_data["controller"][key], dtype=float) for key in ("matrix", "offset")
    )
    return np.where(
        np.isnan(values), np.nan, np.nan_to_num(values - offset) @ np.linalg.inv(matrix).T
    )


def beyond_in_text(files, machine, limits):
    """Return the largest excess, in degrees or mm, of any joint value in the files {name: text} of
    a program over a limit."""
    return most_beyond(told_joints(files, machine), _read_limits(machine, limits)[1])


def text_of(folder):
    """Return the files of a program below a folder."""
    return {
        path.name: path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def over_all(out, machine, limits):
    """Return the same of waypoints.csv and of the program in an output folder."""
    return max(
        waypoint_excess(out / "waypoints.csv", machine, limits),
        beyond_in_text(text_of(out / "program"), machine, limits),
    )
