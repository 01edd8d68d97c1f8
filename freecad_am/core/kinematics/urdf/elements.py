# SPDX-License-Identifier: LGPL-2.1-or-later
"""XML with its source lines: typed access to the elements of a URDF, every error with file
and line.
"""

from __future__ import annotations

import math
import xml.parsers.expat
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...geometry import frames
from ...geometry.job_files import read_content
from ...issues import InputError, Text, Word
from ...types import Array

CODE = "BAD_URDF"
MAX_FILE_MB = 64  # MB
QUARTER = 0.5 * math.pi
FINE_DECIMALS = 5  # number of digits from which the last digit of a right angle may be off by 5


@dataclass
class Element:
    """An element of the file. Getters raise InputError BAD_URDF with file and line."""

    tag: str
    attributes: dict[str, str]
    path: Path
    line: int
    children: list[Element] = field(default_factory=list)

    def bad(self, message: str) -> InputError:
        """The error for this element."""
        return InputError(CODE, f"{self.path.name}: line {self.line}", message)

    def all(self, tag: str) -> Iterator[Element]:
        """Return the children with this tag."""
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> Element | None:
        """Return the first child with this tag, None without one."""
        return next(self.all(tag), None)

    def one(self, tag: str) -> Element:
        """Return the first child with this tag; it must exist."""
        child = self.first(tag)
        if child is None:
            name = Text(" {!r}", self.attributes["name"]) if "name" in self.attributes else ""
            raise self.bad(Text("<{}>{} has no <{}>; add it", self.tag, Word(name), tag))
        return child

    def text(self, name: str) -> str:
        """Return an attribute that must exist and not be empty."""
        value = self.attributes.get(name, "").strip()
        if not value:
            raise self.bad(Text("<{}> has no {}; add it", self.tag, name))
        return value

    def words(self, name: str, count: int, default: str) -> list[str]:
        """Return the words of an attribute.

        Parameters
        ----------
        name : str
            Name of the attribute.
        count : int
            Required number of words.
        default : str
            Value of a missing attribute.

        Returns
        -------
        list of str
            The words.

        Raises
        ------
        InputError
            BAD_URDF for another number of words.
        """
        words = self.attributes.get(name, default).split()
        if len(words) != count:
            raise self.bad(
                Text(
                    "{}={!r} of <{}> needs {} numbers; separate them with spaces",
                    name,
                    self.attributes.get(name, ""),
                    self.tag,
                    count,
                )
            )
        return words

    def number(self, name: str, default: str | None = None) -> float:
        """An attribute that is a finite number."""
        return self._float(
            self.text(name) if default is None else self.attributes.get(name, default), name
        )

    def numbers(self, name: str, count: int, default: str) -> Array:
        """Return the finite numbers of an attribute.

        Parameters
        ----------
        name : str
            Name of the attribute.
        count : int
            Required number of numbers.
        default : str
            Value of a missing attribute.

        Returns
        -------
        (count,) array
            The numbers.

        Raises
        ------
        InputError
            BAD_URDF for any other content.
        """
        return np.array([self._float(word, name) for word in self.words(name, count, default)])

    def angle(self, name: str, default: str | None = None) -> float:
        """An attribute that is an angle, rad; a rounded right angle is a right angle."""
        self.number(name, default)
        return unrounded(self.attributes.get(name, default or ""))

    def pose(self) -> Array:
        """Return the pose of the <origin> of an element.

        Returns
        -------
        (4, 4) array
            The pose, mm; the identity without an origin. Rounded right angles are right
            angles.
        """
        origin = self.first("origin")
        if origin is None:
            return np.eye(4)
        translation = 1000.0 * origin.numbers("xyz", 3, "0 0 0")
        origin.numbers("rpy", 3, "0 0 0")
        return frames.from_rpy(
            translation, [unrounded(word) for word in origin.words("rpy", 3, "0 0 0")]
        )

    def _float(self, word: str, name: str) -> float:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.bad(
                Text(
                    "{}={!r} of <{}> holds {!r}, which is not a number; write one such as 0.25",
                    name,
                    self.attributes.get(name, word),
                    self.tag,
                    word,
                )
            )
        return value


def read(path: Path) -> Element:
    """Return the top element of a file. Raises InputError 'BAD_URDF', with the line, for invalid
    XML and for entities.
    """
    stack = [Element("", {}, path, 1)]
    parser = xml.parsers.expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, path, parser.CurrentLineNumber)
        stack[-1].children.append(element)
        stack.append(element)

    def refuse(name: str, *_: object) -> None:
        raise InputError(
            CODE,
            f"{path.name}: line {parser.CurrentLineNumber}",
            "entities such as {!r} are not supported; write out their content",
            name,
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: stack.pop()
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(read_content(path, MAX_FILE_MB, CODE, str(path)), True)
    except OSError as error:
        raise InputError(
            CODE, str(path), "cannot be read: {}; choose another file", error.strerror or error
        ) from None
    except xml.parsers.expat.ExpatError as error:
        text = xml.parsers.expat.errors.messages[error.code]
        raise InputError(
            CODE,
            f"{path.name}: line {error.lineno}",
            "this is not XML: {}; export the URDF again",
            text,
        ) from None
    return stack[0].children[0]


def unrounded(word: str) -> float:
    """Return the angle that a number represents, rad: 1.5708 is a right angle.

    Other multiples of a right angle written with two or more decimals count likewise. A
    number with all its digits is itself.
    """
    return nearest(word, QUARTER)


def nearest(word: str, step: float) -> float:
    """The multiple of `step` whose rounding a number with two or more decimals is, else the number.
    Half or a quarter of a
    rounded number counts as rounded (1.570796325), and so does one that is cut off (1.57079, 3.14)."""
    value = float(word)
    decimals = len(word.partition(".")[2]) if "e" not in word.lower() else 17
    multiple = round(value / step) * step
    units = 5.0 if decimals >= FINE_DECIMALS else 1.0
    rounded = 2 <= decimals < 15 and abs(value - multiple) < units * 10.0**-decimals
    return multiple if rounded else value
