# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed access to the XML elements of a URDF, with file and line in every error."""

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
MAX_FILE_MB = 64
QUARTER = 0.5 * math.pi
FINE_DECIMALS = 5  # decimals from which the last digit of a right angle may be off by 5


@dataclass
class Element:
    """An element of the file. Getters raise InputError BAD_URDF with file and line."""

    tag: str
    attributes: dict[str, str]
    path: Path
    line: int
    children: list[Element] = field(default_factory=list)

    def bad(self, message: str) -> InputError:
        """Return the error for this element."""
        return InputError(CODE, f"{self.path.name}: line {self.line}", message)

    def all(self, tag: str) -> Iterator[Element]:
        """Return the children with this tag."""
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> Element | None:
        """Return the first child with this tag; None if there is none."""
        return next(self.all(tag), None)

    def one(self, tag: str) -> Element:
        """Return the first child with this tag, which must exist."""
        child = self.first(tag)
        if child is None:
            name = Text(" {!r}", self.attributes["name"]) if "name" in self.attributes else ""
            raise self.bad(Text("<{}>{} has no <{}>; add this element", self.tag, Word(name), tag))
        return child

    def text(self, name: str) -> str:
        """Return an attribute that must exist and must not be empty."""
        value = self.attributes.get(name, "").strip()
        if not value:
            raise self.bad(Text("<{}> has no {}; add the attribute", self.tag, name))
        return value

    def words(self, name: str, count: int, default: str) -> list[str]:
        """Return the words of an attribute.

        Parameters
        ----------
        name : str
            Attribute name.
        count : int
            Required number of words.
        default : str
            Value if the attribute is missing.

        Returns
        -------
        list of str
            The words.

        Raises
        ------
        InputError
            BAD_URDF if the number of words differs.
        """
        words = self.attributes.get(name, default).split()
        if len(words) != count:
            raise self.bad(
                Text(
                    "{}={!r} of <{}> needs {} numbers; separate the numbers with spaces",
                    name,
                    self.attributes.get(name, ""),
                    self.tag,
                    count,
                )
            )
        return words

    def number(self, name: str, default: str | None = None) -> float:
        """Return an attribute that is a finite number."""
        return self._float(
            self.text(name) if default is None else self.attributes.get(name, default), name
        )

    def numbers(self, name: str, count: int, default: str) -> Array:
        """Return the finite numbers of an attribute.

        Parameters
        ----------
        name : str
            Attribute name.
        count : int
            Required number of numbers.
        default : str
            Value if the attribute is missing.

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
        """Return an attribute that is an angle, rad; a rounded right angle becomes exact."""
        self.number(name, default)
        return unrounded(self.attributes.get(name, default or ""))

    def pose(self) -> Array:
        """Return the pose of the <origin> of an element.

        Returns
        -------
        (4, 4) array
            The pose, mm; the identity without an origin. Rounded right angles become exact.
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
                    "{}={!r} of <{}> holds {!r}, which is not a number; write a number such as "
                    "0.25",
                    name,
                    self.attributes.get(name, word),
                    self.tag,
                    word,
                )
            )
        return value


def read(path: Path) -> Element:
    """Return the top element of a file.

    Raises InputError BAD_URDF with the line for invalid XML and for entities.
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
            CODE,
            str(path),
            "the file cannot be read: {}; choose another file",
            error.strerror or error,
        ) from None
    except xml.parsers.expat.ExpatError as error:
        text = xml.parsers.expat.errors.messages[error.code]
        raise InputError(
            CODE,
            f"{path.name}: line {error.lineno}",
            "the file is not XML: {}; export the URDF again",
            text,
        ) from None
    return stack[0].children[0]


def unrounded(word: str) -> float:
    """Return the angle that a number represents, rad: 1.5708 is a right angle.

    This also applies to other multiples of a right angle with two or more decimals. A number with
    all its digits is unchanged.
    """
    return nearest(word, QUARTER)


def nearest(word: str, step: float) -> float:
    """Return the multiple of `step` that a number with two or more decimals rounds, or the number.

    Truncated numbers (1.57079, 3.14) count as rounded, and so does half or a quarter of a rounded
    number (1.570796325).
    """
    value = float(word)
    decimals = len(word.partition(".")[2]) if "e" not in word.lower() else 17
    multiple = round(value / step) * step
    units = 5.0 if decimals >= FINE_DECIMALS else 1.0
    rounded = 2 <= decimals < 15 and abs(value - multiple) < units * 10.0**-decimals
    return multiple if rounded else value
