# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code of a slicer as curves: what it extrudes on the way is a bead, layers are those of its comments, else of its Z.

Known are G0 to G3 in the plane XY, G21, G90 to G92, G92 of any axis, M82 and M83, as RepRap firmware and Marlin have them;
https://marlinfw.org/meta/gcode tells what each means. Words about temperature, fans and the like are passed over.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

import numpy as np

from ...issues import InputError, Text
from ...types import Array
from .bead_curves import BeadCurve

CODE = "BAD_GCODE"
WORD = re.compile(r"([A-Za-z])\s*([-+]?(?:\d+\.?\d*|\.\d+))")
START = re.compile(r"[A-Za-z]\s*[-+.\d]")
LAYER = re.compile(
    r";\s*(?:LAYER\s*:\s*-?\d+|LAYER_CHANGE|layer\s+-?\d+\b.*|BEFORE_LAYER_CHANGE)", re.IGNORECASE
)
APART = 1e-6  # mm; points no farther apart are one
MAX_MM = 1e7  # mm; farther away is a slip of the pen
ARC_END = (
    0.1  # mm by which the ends of an arc may be on different circles: slicers round to hundredths
)
ROUNDED = 1e-9
UP = np.array([0.0, 0.0, 1.0])
FORM = "give absolute or relative moves in mm, G0 to G3 with E, as a slicer for filament or pellets writes them"
REFUSED = {
    "G20": "it is in inches; let the slicer write mm (G21)",
    "G18": "arcs are in the plane of X and Z; let the slicer write arcs in the plane of X and Y, or lines only",
    "G19": "arcs are in the plane of Y and Z; let the slicer write arcs in the plane of X and Y, or lines only",
    "G5": "splines are not known; let the slicer write lines and arcs",
    "G6": "direct moves of steppers are not known; let the slicer write G1",
    "G43": "tool lengths are not known; let the slicer leave them out",
    "G68": "turned coordinates are not known; let the slicer leave them out",
}


def curves_of(text: str, where: str, chord_error: float) -> tuple[BeadCurve, ...]:
    """The beads of a program in its coordinates, arcs within the chord error (mm). InputError BAD_GCODE with the line."""
    reader = _Reader(where, chord_error)
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), 1):
        reader.take(line, number)
    return reader.done()


class _Reader:
    """Where the head is, what is understood of words so far, and the beads."""

    def __init__(self, where: str, chord_error: float) -> None:
        self.where, self.chord_error = where, chord_error
        self.at = {"X": 0.0, "Y": 0.0, "Z": 0.0, "E": 0.0}  # as the program counts
        self.shift = np.zeros(3)  # from there to where it is, after G92
        self.known: set[str] = set()  # axes told so far
        self.absolute, self.absolute_e = True, True
        self.motion = ""
        self.run: list[Array] = []
        self.beads: list[tuple[int, Array]] = []  # comments before, points
        self.comments = 0
        self.line = 0

    def take(self, line: str, number: int) -> None:
        """One line."""
        self.line = number
        code, _, comment = line.partition(";")
        if comment and LAYER.match(f";{comment}"):
            self._end()
            self.comments += 1
        code = re.sub(r"\([^)]*\)", " ", code).strip()
        if not code or code[0] in "%/:" or code[0] in "oO":
            return
        if START.match(code) is None:  # a command of words, such as a macro of Klipper
            return
        words = [(letter.upper(), float(value)) for letter, value in WORD.findall(code)]
        words = [word for word in words if word[0] != "N"]
        if not words:
            return
        letter, value = words[0]
        name = f"{letter}{value:g}"
        if letter in "XYZE" and self.motion:
            name = self.motion
        else:
            words = words[1:]
        if name in REFUSED or name.split(".")[0] in REFUSED:
            raise self._error(
                Text("{}: {}", name, REFUSED.get(name) or REFUSED[name.split(".")[0]])
            )
        if name in ("G0", "G1", "G2", "G3"):
            self.motion = name
            self._moved(name, dict(words))
        elif name in ("G90", "G91"):
            self.absolute = self.absolute_e = name == "G90"
        elif name in ("M82", "M83"):
            self.absolute_e = name == "M82"
        elif name == "G92":
            self._reset_origin(dict(words))
        elif name in ("G28", "G29"):
            self._end()
            self.known -= {letter for letter, _ in words} or {"X", "Y", "Z"}
        elif name in ("G10", "G11"):
            self._end()  # drawn back, and on again

    def _place(self) -> Array:
        return np.array([self.at[axis] for axis in "XYZ"]) + self.shift

    def _reset_origin(self, words: dict[str, float]) -> None:
        """G92: what the program counts from now on, with the head where it is."""
        here = self._place()
        for axis in ("X", "Y", "Z", "E"):
            if axis in words or not words:
                self.at[axis] = words.get(axis, 0.0)
        self.shift = here - np.array([self.at[axis] for axis in "XYZ"])

    def _moved(self, name: str, words: dict[str, float]) -> None:
        start, extruded = self._place(), 0.0
        for axis, value in words.items():
            if axis not in self.at:
                continue
            if not math.isfinite(value) or abs(value) > MAX_MM:
                raise self._error(
                    Text("{} is {:g}; give a number of at most {:g}", axis, value, MAX_MM)
                )
            absolute = self.absolute_e if axis == "E" else self.absolute
            before = self.at[axis]
            self.at[axis] = value if absolute else before + value
            if axis == "E":
                extruded = self.at[axis] - before
            else:
                self.known.add(axis)
        end = self._place()
        way = [end] if name in ("G0", "G1") else self._arc(name, start, end, words)
        if extruded <= ROUNDED or (len(way) == 1 and float(np.linalg.norm(end - start)) < APART):
            self._end()
            return
        if len(self.known) < 3:
            raise self._error(
                Text(
                    "it extrudes before the program says where: X, Y and Z have to be given first; {}",
                    FORM,
                )
            )
        if not self.run:
            self.run = [start]
        self.run += way

    def _arc(self, name: str, start: Array, end: Array, words: dict[str, float]) -> list[Array]:
        """Points (3,) of an arc but its first."""
        middle = self._middle(name, start, end, words)
        one, other = start[:2] - middle, end[:2] - middle
        radius = float(np.hypot(*one))
        if radius < APART or abs(radius - float(np.hypot(*other))) > max(ARC_END, 1e-3 * radius):
            raise self._error(
                Text(
                    "the ends of the arc are {:.4g} and {:.4g} mm from its middle; give I and J from its start to its "
                    "middle",
                    radius,
                    np.hypot(*other),
                )
            )
        turn = math.atan2(other[1], other[0]) - math.atan2(one[1], one[0])
        turn = -(-turn % (2.0 * math.pi)) if name == "G2" else turn % (2.0 * math.pi)
        if abs(turn) < 1e-9:
            turn = -2.0 * math.pi if name == "G2" else 2.0 * math.pi
        step = 2.0 * math.acos(max(1.0 - self.chord_error / radius, 0.0))
        count = max(1, math.ceil(abs(turn) / max(step, 1e-3)))
        share = np.arange(1, count + 1) / count
        angle = math.atan2(one[1], one[0]) + share * turn
        reach = radius + share * (float(np.hypot(*other)) - radius)
        rows = np.column_stack(
            [
                middle[0] + reach * np.cos(angle),
                middle[1] + reach * np.sin(angle),
                start[2] + share * (end[2] - start[2]),
            ]
        )
        rows[-1] = end
        return list(rows)

    def _middle(self, name: str, start: Array, end: Array, words: dict[str, float]) -> Array:
        if "I" in words or "J" in words:
            return np.asarray(start[:2] + np.array([words.get("I", 0.0), words.get("J", 0.0)]))
        if "R" not in words:
            raise self._error(
                Text("{} has neither I and J nor R; give the middle of the arc or its radius", name)
            )
        radius, chord = words["R"], end[:2] - start[:2]
        length = float(np.hypot(*chord))
        if length < APART or abs(2.0 * radius) < length * (1.0 - 1e-6):
            raise self._error(
                Text(
                    "a radius of {:g} mm makes no arc between points {:.4g} mm apart; give I and J",
                    radius,
                    length,
                )
            )
        away = math.sqrt(max(radius * radius - 0.25 * length * length, 0.0))
        left = np.array([-chord[1], chord[0]]) / length
        side = (1.0 if name == "G3" else -1.0) * (1.0 if radius > 0.0 else -1.0)
        middle: Array = start[:2] + 0.5 * chord + side * away * left
        return middle

    def _end(self) -> None:
        """The bead ends here."""
        if self.run:
            points = np.array(self.run)
            kept = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > APART]
            if kept.sum() > 1:
                self.beads.append((self.comments, points[kept]))
        self.run = []

    def _error(self, message: str) -> InputError:
        return InputError(CODE, f"{self.where} line {self.line}", message)

    def done(self) -> tuple[BeadCurve, ...]:
        """The beads, each with its layer."""
        self._end()
        if not self.beads:
            raise InputError(
                CODE, self.where, "no move of it extrudes, so there is no bead; {}", FORM
            )
        texts = [comments for comments, _ in self.beads]
        keys: Iterable[float] = (
            texts if self.comments else [round(float(points[0, 2]), 3) for _, points in self.beads]
        )
        layers, layer, before = [], -1, math.nan
        for key in keys:
            layer += key != before
            before = key
            layers.append(layer)
        return tuple(
            BeadCurve(points, None, number) for number, (_, points) in zip(layers, self.beads)
        )
