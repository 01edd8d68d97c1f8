# SPDX-License-Identifier: LGPL-2.1-or-later
"""A YAML file as plain nested dictionaries and lists, with the line of every key.

Only the safe part of YAML is read, and only what means the same to everybody: a key given twice, an unknown tag, a
merge key or a number in base 60 are not guessed at.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from typing import Any

from ..core.geometry.job_files import read_content
from ..core.issues import InputError, Text

_INTEGER = re.compile(r"[-+]?\d{1,18}", re.ASCII)
_FLOAT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
_INFINITE = re.compile(r"[-+]?\.?inf", re.IGNORECASE)
_TAG = "tag:yaml.org,2002:"
_MOST_LEVELS = 21
_MOST_VALUES = 100_000  # aliases of aliases can stand for more values than fit in memory
_MAX_MEGABYTES = 4  # MB; a job is a page of text, so a larger file is not one


@dataclass
class Tree:
    """The values of a file and `lines`, the line (from 1) of each dotted key."""

    label: str
    values: dict[str, Any]
    lines: dict[str, int] = field(default_factory=dict)

    def where(self, key: str) -> str:
        """The place of a dotted key as messages name it."""
        return f"{self.label}: {key}" if key else self.label

    def add_line(self, key: str, message: str) -> str:
        """A message with the line of its key, where the file has that key."""
        line = self.lines.get(key)
        return message if line is None else Text("{} (line {})", message, line)

    def locate(self, error: InputError) -> InputError:
        """An error about a dotted key as one about this file."""
        return InputError(
            error.code, self.where(error.where), self.add_line(error.where, error.message)
        )


def read(path: str, example: str = "part: {file: ...}", keys: str = "part and strategy") -> Tree:
    """The file as a `Tree`; `example` (the least content) and `keys` are for messages.

    Raises InputError NO_FILE, EMPTY_FILE, BAD_FILE, DUPLICATE_KEY or BAD_VALUE.
    """
    label = os.path.basename(path) or path
    text = text_of(path, label)
    try:
        import yaml
    except ImportError:
        raise InputError(
            "BAD_FILE",
            label,
            "the Python of FreeCAD cannot read YAML; install PyYAML for this Python",
        ) from None
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(text, Loader=loader)
    except yaml.YAMLError as error:
        raise InputError(
            "BAD_FILE", label, "the file is not valid YAML: {}; correct the file", _one_line(error)
        ) from None
    except RecursionError:
        raise InputError(
            "BAD_FILE", label, "the file is nested too deeply; give keys such as {}", keys
        ) from None
    if node is None:
        raise InputError("EMPTY_FILE", label, "the file is empty; give at least {}", example)
    tree = Tree(label, {})
    if not isinstance(node, yaml.MappingNode):
        raise InputError("BAD_FILE", label, "the file is not a mapping; give keys such as {}", keys)
    tree.values = _Reader(yaml, tree).mapping(node, "")
    return tree


def scalar(text: str, where: str) -> Any:
    """The value of one cell of a table, written as in a job file; a list may be given too. Raises InputError."""
    import yaml

    tree = Tree(where, {})
    try:
        node = yaml.compose(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.YAMLError as error:
        raise InputError(
            "BAD_VALUE",
            where,
            "{!r} is not understood: {}; write the value as in a job file",
            text,
            _one_line(error),
        ) from None
    return None if node is None else _Reader(yaml, tree).value(node, "")


def text_of(path: str, label: str) -> str:
    """The text of a file in UTF-8. Raises InputError NO_FILE or BAD_FILE, named `label`."""
    try:
        return read_content(path, _MAX_MEGABYTES, "BAD_FILE", label).decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError("NO_FILE", path, "the file does not exist; check the path") from None
    except OSError as error:
        raise InputError(
            "NO_FILE", path, "the file cannot be read: {}; choose another file", error.strerror
        ) from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise InputError(
            "BAD_FILE", label, "the file is not UTF-8 (line {}); save it as UTF-8", line
        ) from None
    except ValueError as error:
        raise InputError(
            "NO_FILE", path, "no file can have the name ({}); check the path", error
        ) from None


def _one_line(error: Any) -> str:
    problem = getattr(error, "problem", None) or str(error).splitlines()[0]
    mark = getattr(error, "problem_mark", None)
    return (
        problem
        if mark is None
        else Text("{} (line {}, column {})", problem, mark.line + 1, mark.column + 1)
    )


class _Reader:
    """Turns nodes into values; remembers the nodes it stands in, so that a loop of aliases is found."""

    def __init__(self, yaml: Any, tree: Tree) -> None:
        self.yaml, self.tree = yaml, tree
        self.open: list[Any] = []
        self.count = 0

    def mapping(self, node: Any, prefix: str) -> dict[str, Any]:
        values: dict[str, Any] = {}
        self._enter(node, prefix)
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            if not isinstance(key_node, self.yaml.ScalarNode):
                raise InputError(
                    "BAD_FILE",
                    self.tree.where(prefix),
                    "a key must be a word (line {}); write a word before the colon",
                    line,
                )
            key = key_node.value
            dotted = f"{prefix}.{key}" if prefix else key
            if key in values:
                first_line = self.tree.lines[dotted]
                raise InputError(
                    "DUPLICATE_KEY",
                    self.tree.where(dotted),
                    "the key appears twice (lines {} and {}); remove one entry",
                    first_line,
                    line,
                )
            self.tree.lines[dotted] = line
            values[key] = self.value(value_node, dotted)
        self.open.pop()
        return values

    def value(self, node: Any, key: str) -> Any:
        self.count += 1
        if self.count > _MOST_VALUES:
            raise InputError(
                "BAD_FILE",
                self.tree.where(key),
                "the file has too many values; give at most {:,} values",
                _MOST_VALUES,
            )
        if isinstance(node, self.yaml.MappingNode):
            return self.mapping(node, key)
        if isinstance(node, self.yaml.SequenceNode):
            self._enter(node, key)
            values = [
                self.value(
                    item, f"{key}[{number}]" if isinstance(item, self.yaml.MappingNode) else key
                )
                for number, item in enumerate(node.value)
            ]
            self.open.pop()
            return values
        return self._scalar(node, key)

    def _enter(self, node: Any, key: str) -> None:
        if node.tag not in (_TAG + "map", _TAG + "seq"):
            raise self._foreign_tag(node, key)
        if any(node is ancestor for ancestor in self.open):
            raise InputError(
                "BAD_FILE",
                self.tree.where(key),
                "an alias refers to itself; write the value in full",
            )
        if len(self.open) >= _MOST_LEVELS:
            raise InputError(
                "BAD_FILE",
                self.tree.where(key),
                "the value is nested too deeply; give at most {} levels",
                _MOST_LEVELS,
            )
        self.open.append(node)

    def _scalar(self, node: Any, key: str) -> Any:
        tag, text = node.tag.replace(_TAG, ""), node.value
        if tag == "null":
            return (
                {} if text == "" else None
            )  # "program:" is a section with its defaults, "program: null" is none
        if tag == "bool":
            return text.lower() in ("true", "yes", "on")
        if tag == "int" and _INTEGER.fullmatch(text):
            return int(text)
        if tag == "float" and _FLOAT.fullmatch(text):
            return float(text)
        if tag == "float" and _INFINITE.fullmatch(text):
            return float(text.replace(".", ""))
        if tag in ("int", "float", "str", "timestamp", "value"):
            return text
        raise self._foreign_tag(node, key)

    def _foreign_tag(self, node: Any, key: str) -> InputError:
        message = Text("the tag {} is not allowed here; write the plain value", node.tag)
        return InputError("BAD_VALUE", self.tree.where(key), self.tree.add_line(key, message))
