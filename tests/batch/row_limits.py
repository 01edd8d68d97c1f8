# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of waypoints.csv, and the joint values of a program's text, against the limits of a machine file, without the
program's own code."""

import csv
import json
import re
from pathlib import Path

import numpy as np

MACHINES = Path(__file__).parents[2] / "freecad_am" / "machines"
# what tells an axis in a text: FANUC's J1= .. deg, KRL's A1 .., VAL 3's j1="..", words of G-code
KRL = r"PTP \{{[^}}]*\bA{} (-?\d+\.\d+)"
FANUC, VAL3 = r"J{}= *(-?\d*\.\d+) deg", r"<Value [^>]*\bj{}=\"(-?\d+\.\d+)\""


def _told(machine, limits):
    told = json.loads((MACHINES / f"{machine}.json").read_text(encoding="utf-8"))
    return told, told["limits"][limits]


def most_beyond(joints, told):
    """By how much, at the most, joints (n, axes) are beyond limits as a machine file tells them; NaN is not told."""
    ranges = [
        (values, ends)
        for values, ends in zip(joints.T, told["axes"], strict=True)
        if ends is not None
    ]
    ranges += [
        (joints @ np.array(one["coefficients"], dtype=float), one["range"])
        for one in told.get("coupled", ())
    ]
    known = [(values[~np.isnan(values)], ends) for values, ends in ranges]
    return max(
        max(ends[0] - values.min(), values.max() - ends[1]) for values, ends in known if len(values)
    )


def beyond(waypoints, machine, limits):
    """By how many degrees or mm, at the most, any row of waypoints.csv, rapids included, is beyond a limit."""
    told, ranges = _told(machine, limits)
    with open(waypoints, encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    names = [
        f"{one['name']}_{'mm' if one.get('type') == 'prismatic' else 'deg'}"
        for one in told["joints"]
    ]
    names = names if names[0] in rows[0] else [f"q{axis}_deg" for axis in range(1, 7)]
    return most_beyond(np.array([[float(row[name]) for name in names] for row in rows]), ranges)


def told_joints(files, machine):
    """(n, axes) the joint values that the files {name: text} of a program tell, as the machine file counts them."""
    told = json.loads((MACHINES / f"{machine}.json").read_text(encoding="utf-8"))
    axes, text = len(told["joints"]), "\n".join(files.values())
    if axes == 6:
        ends = {Path(name).suffix for name in files}
        pattern = FANUC if ".LS" in ends else KRL if ".src" in ends else VAL3
        shown = np.array(
            [re.findall(pattern.format(axis), text) for axis in range(1, 7)], dtype=float
        ).T
    else:  # the last word of each axis holds; where positions are told these are the tip's, and rotary words alone count
        bare = not re.search(r"TRAORI|M428|[ABC]3=", text)
        words = [
            one["name"][-1].upper() if bare or one.get("type") != "prismatic" else "no word"
            for one in told["joints"]
        ]
        rows = [line for line in text.splitlines() if re.search(r"\bG1 ", line)]
        found = [
            [re.findall(rf"{word}=?(?:DC\()?(-?\d+\.\d+)", line) for word in words] for line in rows
        ]
        shown = np.array([[float(one[-1]) if one else np.nan for one in line] for line in found])
    matrix, offset = (
        np.array(told["controller"][key], dtype=float) for key in ("matrix", "offset")
    )
    return np.where(
        np.isnan(shown), np.nan, np.nan_to_num(shown - offset) @ np.linalg.inv(matrix).T
    )


def beyond_in_text(files, machine, limits):
    """By how many degrees or mm, at the most, any joint value in the files {name: text} of a program is beyond a limit."""
    return most_beyond(told_joints(files, machine), _told(machine, limits)[1])


def text_of(folder):
    """The files of a program below a folder."""
    return {
        path.name: path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def over_all(out, machine, limits):
    """The same of waypoints.csv and of the program in a folder of outputs."""
    return max(
        beyond(out / "waypoints.csv", machine, limits),
        beyond_in_text(text_of(out / "program"), machine, limits),
    )
