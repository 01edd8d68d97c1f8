# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flattened parameters dataclasses: one row per property of a document object, field of a panel,
macro keyword.

Outside, numbers are mm, deg, mm/s and s and poses are x y z RX RY RZ; inside, angles are rad.
"""

from __future__ import annotations

import dataclasses
import math
import re
import unicodedata
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from ...core.issues import InputError, Text, Word
from ...core.parameters import field as f
from ...core.parameters.records import Records, RecordTexts
from ...core.parameters.vectors import VectorText
from ...posts import catalogue
from . import pendants, quantities
from .quantities import safe_repr


def is_text(value: Any) -> bool:
    """Whether a value is text that FreeCAD can store.

    FreeCAD fails on lone surrogates and truncates text at NUL.
    """
    return (
        isinstance(value, str)
        and "\0" not in value
        and not any("\ud800" <= sign <= "\udfff" for sign in value)
    )


def checked_words(words: Any, where: str) -> list[str]:
    """A list of texts. Raises InputError BAD_VALUE naming `where` for anything else."""
    if not isinstance(words, (list, tuple)) or not all(map(is_text, words)):
        raise InputError("BAD_VALUE", where, "{} is not a text; put it in quotes", safe_repr(words))
    return list(words)


_NAME_LENGTH = 20


def proposed_name(text: str) -> str:
    """Return a program name that controllers take: letters A to Z, digits and underscores.

    Parameters
    ----------
    text : str
        A label.

    Returns
    -------
    str
        The name.

    Raises
    ------
    InputError
        BAD_VALUE for other types.

    Examples
    --------
    >>> am.proposed_name("Hémisphère n° 1")
    'HEMISPHERE_N_1'
    """
    checked_words([text], "text")
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().upper()
    name = re.sub(r"[^A-Z0-9]+", "_", plain).strip("_")[:_NAME_LENGTH].rstrip("_")
    return name if name[:1].isalpha() else f"P{name}"


def name_for(text: str, post: str) -> str:
    """The same, with room for the digits of parts where the controller of a post takes few characters; '' or 'none' for no
    post."""
    name = proposed_name(text)
    naming = catalogue.load(post).NAMING if post in catalogue.NAMES else None
    return name if naming is None or naming.fits(name) else naming.proposed(name)


def taken_name(text: str, post: str) -> str:
    """The proposed name as it is where the controller takes it, else one that it takes."""
    name = proposed_name(text)
    return name_for(text, post) if refusal(name, post) else name


def refusal(name: str, post: str) -> str:
    """Why the controller of a post refuses the name of a program, '' where it takes it."""
    if post not in catalogue.NAMES:
        return ""
    try:
        catalogue.load(post).program_name(name, "name")
    except InputError as error:
        return error.message
    return ""


TEXT_LIST, MIXED, LENGTH_OR_POSE = "text list", "mixed", "length or pose"
ENDS = ("low", "high")
_ABBREVIATED = {"rz": "RZ", "nc": "NC machines"}
_LABELS = {  # of parameters whose keys do not say it in words
    "given": "Given polynomials",
    "degree": "Degree of the polynomials",
    "parameter": "Quantity of polynomials",
    "min_condition": "Min condition",
    "lock": "Locked axis",
    "lock_at": "Locked position",
    "max_residual": "Largest direction error",
    "own_branch": "Branch of the path",
    "compare": "Compare with",
    "rx": "RX",
    "ry": "RY",
}


@dataclass(frozen=True)
class Row:
    """One parameter. `path` leads to it from the dataclass (an int picks an end of a range); `form` is the kind of
    the property that holds it: the kind of its `Spec`, or one of TEXT_LIST, MIXED (a text holding a quantity or a
    word, empty for None) and LENGTH_OR_POSE (a text)."""

    path: tuple[str | int, ...]
    spec: f.Spec
    form: str
    default: Any

    @cached_property
    def key(self) -> str:
        """Its name as a macro keyword: seam_angle, rotation_range_low."""
        return "_".join(ENDS[step] if isinstance(step, int) else step for step in self.path)

    @cached_property
    def name(self) -> str:
        """Its name as a property: SeamAngle, RotationRangeLow."""
        return property_name(self.key)

    @property
    def unit(self) -> str:
        """The outer unit, or ''."""
        return f.OUTER_UNIT.get(self.spec.kind, "")

    @property
    def label(self) -> str:
        """Its name in a panel: 'Layer height' for layer_height; the box of the group names the
        group.
        """
        words = [("from", "to")[step] if isinstance(step, int) else step for step in self.path]
        if len(words) == 1 and words[0] in _LABELS:
            return _LABELS[words[0]]
        words = words[1:] if len(words) > 1 and words[-1] not in ("from", "to") else words
        return _headed(" ".join(words))

    def inner(self, value: Any, where: str) -> Any:
        """The value as the dataclass holds it, from a property's value, a plain value in outer units or a text.

        Raises InputError 'BAD_VALUE' or 'BAD_UNIT' naming `where`.
        """
        if isinstance(value, str):
            checked_words([value], where)
        if isinstance(self.spec.records, Records):
            return self._records(self.spec.records, value, where)
        if isinstance(self.spec.records, VectorText):
            return self.spec.records.read(value)
        if self.form == f.POSE or (self.form == LENGTH_OR_POSE and quantities.is_pose(value)):
            return quantities.pose(value, where)
        if self.form == TEXT_LIST:
            return self._list(value, where)
        if self.form == MIXED and (value is None or (isinstance(value, str) and not value.strip())):
            return None
        if isinstance(value, str) and value.strip() in self.spec.words:
            return value.strip()
        if self.spec.kind == f.TEXT and not isinstance(value, str):
            return " ".join(checked_words(value, where))
        if self.spec.kind in (f.TEXT, f.CHOICE, f.FLAG):
            return value
        if self.spec.kind == f.POSE:
            return quantities.pose(value, where, self.spec.words)
        return self._number(value, where)

    def _number(self, value: Any, where: str) -> float:
        """The number of a value. Raises InputError BAD_VALUE or BAD_UNIT."""
        if self.spec.kind == f.COUNT:
            return _count(self.spec, value, where)
        number = quantities.read(value, self.spec.kind, where, self.spec.words, "BAD_VALUE")
        if isinstance(value, str) and math.isinf(number):
            raise quantities.too_large(value, self.spec.kind, where)
        return number

    def _records(self, records: Records, value: Any, where: str) -> Any:
        """Records of their text or JSON. Raises InputError BAD_VALUE, at the dotted key of a job file."""
        if records.single and (value is None or isinstance(value, records.record)):
            return value
        if not isinstance(value, str):
            if not records.single and _are(records.record, value):
                return tuple(value)
            value = " ".join(checked_words(value, where))
        return records.read(pendants.plain(value, where) if self.spec.poses else value)

    def _list(self, value: Any, where: str) -> tuple[Any, ...]:
        """Words, or records of words. Raises InputError BAD_VALUE."""
        records = self.spec.records
        if records is not None and not isinstance(value, str) and _are(records.record, value):
            return tuple(value)
        words = (
            quantities.split(value, where)
            if isinstance(value, str)
            else checked_words(value, where)
        )
        return tuple(words) if records is None else records.read(words)

    def outer(self, value: Any) -> Any:
        """The value in outer units as a Python literal, such as a panel shows and a macro passes."""
        if self.spec.records is not None:
            return self.spec.records.text(value)
        if _is_list(value) and (self.spec.kind == f.POSE or self.form == LENGTH_OR_POSE):
            return tuple(float(number) for number in value[:3]) + tuple(
                f.degrees(angle) for angle in value[3:]
            )
        if self.form == TEXT_LIST:
            return tuple(value)
        if isinstance(value, tuple):
            return " ".join(value)
        if (
            self.spec.kind in (f.ANGLE, f.TURN_RATE, f.RATIO)
            and not isinstance(value, str)
            and value is not None
        ):
            return f.percent(value) if self.spec.kind == f.RATIO else f.degrees(value)
        return value

    def text(self, value: Any) -> str:
        """The value as a text with its unit: what a MIXED or LENGTH_OR_POSE property holds."""
        return self.outer_text(self.outer(value))

    def outer_text(self, outer_value: Any) -> str:
        """The same of a value in outer units."""
        if outer_value is None or isinstance(outer_value, str):
            return outer_value or ""
        if _is_list(outer_value):
            return " ".join(repr(number) for number in outer_value)
        return f"{outer_value!r} {self.unit}".strip()


def group_of(row: Row) -> str:
    """What a panel calls the group that a row is nested in: 'Seam' for seam.angle."""
    return _headed(str(row.path[0]))


def _headed(key: str) -> str:
    """A key as a heading."""
    text = key.replace("_", " ")
    return _ABBREVIATED.get(text) or text[0].upper() + text[1:]


def property_name(key: str) -> str:
    """LayerHeight for layer_height."""
    return "".join(word[0].upper() + word[1:] for word in re.split(r"[_.]", key))


@cache
def rows(cls: type) -> tuple[Row, ...]:
    """The rows of a parameters dataclass, groups flattened, in the order of its fields."""
    result: list[Row] = []
    for field in dataclasses.fields(cls):
        spec = f.spec_of(field)
        if spec.kind == f.GROUP:
            factory: Any = field.default_factory
            result += [
                dataclasses.replace(row, path=(field.name, *row.path)) for row in rows(factory)
            ]
        elif spec.kind in f.END_OF:
            end = dataclasses.replace(spec, kind=f.END_OF[spec.kind])
            result += [Row((field.name, i), end, end.kind, field.default[i]) for i in (0, 1)]
        else:
            result.append(Row((field.name,), spec, _form(spec, str(field.type)), field.default))
    return tuple(result)


def build(cls: type, values: dict[str, Any]) -> Any:
    """Build the dataclass from inner values by row key; missing rows keep their default.

    Raises the InputError of the dataclass.
    """
    nested: dict[str, Any] = {}
    for row in rows(cls):
        value = values.get(row.key, row.default)
        group: Any = nested
        for step in row.path[:-1]:
            group = group.setdefault(step, {})
        group[row.path[-1]] = value
    return _assemble(cls, nested)


def flat(parameters: Any) -> dict[str, Any]:
    """Return the inner values of a parameters dataclass by row key."""
    values = {}
    for row in rows(type(parameters)):
        value = parameters
        for step in row.path:
            value = value[step] if isinstance(step, int) else getattr(value, step)
        values[row.key] = value
    return values


def _assemble(cls: type, nested: dict[str, Any]) -> Any:
    values = {}
    for field in dataclasses.fields(cls):
        spec, value = f.spec_of(field), nested[field.name]
        if spec.kind == f.GROUP:
            factory: Any = field.default_factory
            value = _assemble(factory, value)
        elif spec.kind in f.END_OF:
            value = (value[0], value[1])
        values[field.name] = value
    return cls(**values)


def _form(spec: f.Spec, annotation: str) -> str:
    if spec.kind == f.LENGTH and "Pose" in annotation:
        return LENGTH_OR_POSE
    if spec.records is not None:
        return TEXT_LIST if isinstance(spec.records, RecordTexts) else f.TEXT
    if spec.kind == f.TEXT and annotation.startswith("tuple"):
        return TEXT_LIST
    return MIXED if spec.words or spec.optional else spec.kind


def _are(cls: type, values: Any) -> bool:
    """Whether a value is a list of objects of one class."""
    return _is_list(values) and all(isinstance(value, cls) for value in values)


def _is_list(value: Any) -> bool:
    return isinstance(value, (tuple, list))


def _count(spec: f.Spec, value: Any, where: str) -> float:
    """A whole number where it is one; any other number is rejected with the range."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        also = Text(" or {}", ", ".join(spec.words)) if spec.words else ""
        raise InputError(
            "BAD_VALUE", where, "{!r} is not a number; give one such as 2{}", value, Word(also)
        ) from None
    return int(number) if number.is_integer() else number


MARK = "="
FOLLOW = (
    f.LENGTH,
    f.ANGLE,
    f.SPEED,
    f.TIME,
    f.RATIO,
    f.NUMBER,
    f.TURN_RATE,
    f.COUNT,
)  # forms of rows that can


def is_expression(value: Any) -> bool:
    """Whether a value is an expression rather than a number or a word."""
    return isinstance(value, str) and value.lstrip().startswith(MARK)


def evaluated(value: str, obj: Any, where: str) -> Any:
    """What an expression gives now, a quantity or a number, names in it seen from `obj`.
    Raises InputError 'BAD_EXPRESSION'."""
    try:
        result = obj.evalExpression(_bare(value))
    except Exception as error:  # FreeCAD's own errors share no base
        raise _wrong(value, where, error) from None
    if isinstance(result, bool) or not (
        isinstance(result, (int, float)) or hasattr(result, "Unit")
    ):
        raise InputError(
            "BAD_EXPRESSION",
            where,
            "{!r} gives {!r}, which is not a number; write one that gives a number",
            value,
            result,
        )
    return result


def follow(obj: Any, row: Row, value: str | None) -> None:
    """Let the property of a row follow an expression, None for none any more. Raises InputError 'BAD_EXPRESSION'."""
    if value is None:
        if row.name in dict(obj.ExpressionEngine):
            obj.setExpression(row.name, None)
        return
    try:
        obj.setExpression(row.name, _bare(value))
    except Exception as error:  # such as one that follows itself
        raise _wrong(value, f"{obj.Label}.{row.name}", error) from None


def of(obj: Any, row: Row) -> str:
    """The expression that the property of a row follows, or ''."""
    text = dict(obj.ExpressionEngine).get(row.name)
    return f"{MARK}{text}" if text else ""


def broken(obj: Any) -> str:
    """A remedy for an expression of an object that no longer gives a value, else ''. FreeCAD then
    computes nothing and writes only to the report view.
    """
    for name, text in getattr(obj, "ExpressionEngine", ()):
        try:
            obj.evalExpression(text)
        except Exception:  # FreeCAD's own errors share no base
            return Text(
                "{} follows the expression {}, which no longer gives a value; give {} a value or "
                "another expression",
                name,
                text,
                name,
            )
    return ""


def _bare(value: str) -> str:
    return value.strip().removeprefix(MARK).strip()


def _wrong(value: str, where: str, error: Exception) -> InputError:
    cause = error.args[0] if error.args else error
    reason = str(cause.get("sErrMsg", "") if isinstance(cause, dict) else cause).strip().rstrip(".")
    return InputError(
        "BAD_EXPRESSION",
        where,
        "{!r} is not understood ({}); write it as in {}Spreadsheet.height / 2",
        value,
        reason,
        MARK,
    )
