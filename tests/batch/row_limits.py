# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of waypoints.csv against the limits of a machine file, without the program's own code."""

import csv
import json
from pathlib import Path

import numpy as np

MACHINES = Path(__file__).parents[2] / "freecad_am" / "machines"


def beyond(waypoints, machine, limits):
    """By how many degrees, at the most, any row of a robot's waypoints.csv, rapids included, is beyond a limit."""
    told = json.loads((MACHINES / f"{machine}.json").read_text(encoding="utf-8"))["limits"][limits]
    with open(waypoints, encoding="utf-8", newline="") as stream:
        joints = np.array([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in csv.DictReader(stream)])
    ranges = [(values, ends) for values, ends in zip(joints.T, told["axes"], strict=True) if ends is not None]
    ranges += [(joints @ np.array(one["coefficients"], dtype=float), one["range"]) for one in told.get("coupled", ())]
    return max(max(ends[0] - values.min(), values.max() - ends[1]) for values, ends in ranges)
