# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flattened parameter dataclasses, with one row per property, panel field and macro keyword.

Outer values are in mm, deg, mm/s and s; outer poses are x y z RX RY RZ. Inner angles are in rad.
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
    """Return a list of strings. Raises InputError BAD_VALUE, naming `where`, for anything else."""
    if not isinstance(words, (list, tuple)) or not all(map(is_text, words)):
        raise InputError(
            "BAD_VALUE", where, "{} is not a text; write the text in quotes", safe_repr(words)
        )
    return list(words)


_NAME_LENGTH = 20


def proposed_name(text: str) -> str:
    """Return a program name that controllers accept: letters A to Z, digits and underscores.

    Parameters
    ----------
    text : str
        Label from which to derive the name.

    Returns
    -------
    str
        The program name.

    Raises
    ------
    InputError
        BAD_VALUE if `text` is not a string.

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
    """Return the proposed program name, shortened if the controller of a post requires short names.

    A shortened name leaves space for the numbers of part files. post: '' or 'none' for no post.
    """
    name = proposed_name(text)
    naming = catalogue.load(post).NAMING if post in catalogue.NAMES else None
    return name if naming is None or naming.fits(name) else naming.proposed(name)


def taken_name(text: str, post: str) -> str:
    """Return the proposed name if the controller accepts it, else a shortened name."""
    name = proposed_name(text)
    return name_for(text, post) if refusal(name, post) else name


def refusal(name: str, post: str) -> str:
    """Return why the controller of a post rejects a program name, '' if it accepts the name."""
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
_LABELS = {  # labels of parameters whose keys are not readable as words
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
    """One parameter.

    path: field names from the dataclass to the parameter; an int selects an end of a range. form:
    kind of the property, which is the kind of the `Spec` or one of TEXT_LIST, MIXED (a string with
    a quantity or a word, empty for None) and LENGTH_OR_POSE (a string).
    """

    path: tuple[str | int, ...]
    spec: f.Spec
    form: str
    default: Any

    @cached_property
    def key(self) -> str:
        """Return the macro keyword: seam_angle, rotation_range_low."""
        return "_".join(ENDS[step] if isinstance(step, int) else step for step in self.path)

    @cached_property
    def name(self) -> str:
        """Return the property name: SeamAngle, RotationRangeLow."""
        return property_name(self.key)

    @property
    def unit(self) -> str:
        """Return the outer unit, or ''."""
        return f.OUTER_UNIT.get(self.spec.kind, "")

    @property
    def label(self) -> str:
        """Return the panel label: 'Layer height' for layer_height, without the group name."""
        words = [("from", "to")[step] if isinstance(step, int) else step for step in self.path]
        if len(words) == 1 and words[0] in _LABELS:
            return _LABELS[words[0]]
        words = words[1:] if len(words) > 1 and words[-1] not in ("from", "to") else words
        return _headed(" ".join(words))

    def inner(self, value: Any, where: str) -> Any:
        """Convert a property value, a plain value in outer units or a string to the inner value.

        Raises InputError BAD_VALUE or BAD_UNIT, naming `where`.
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
        """Convert a value to an inner number. Raises InputError BAD_VALUE or BAD_UNIT."""
        if self.spec.kind == f.COUNT:
            return _count(self.spec, value, where)
        number = quantities.read(value, self.spec.kind, where, self.spec.words, "BAD_VALUE")
        if isinstance(value, str) and math.isinf(number):
            raise quantities.too_large(value, self.spec.kind, where)
        return number

    def _records(self, records: Records, value: Any, where: str) -> Any:
        """Parse records from text or JSON. Raises InputError BAD_VALUE at the dotted job key."""
        if records.single and (value is None or isinstance(value, records.record)):
            return value
        if not isinstance(value, str):
            if not records.single and _are(records.record, value):
                return tuple(value)
            value = " ".join(checked_words(value, where))
        return records.read(pendants.plain(value, where) if self.spec.poses else value)

    def _list(self, value: Any, where: str) -> tuple[Any, ...]:
        """Parse a list of words, or of records made of words. Raises InputError BAD_VALUE."""
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
        """Convert a value to outer units, as a Python value for panels and macros."""
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
        """Format an inner value as text with its unit, as stored in MIXED or LENGTH_OR_POSE."""
        return self.outer_text(self.outer(value))

    def outer_text(self, outer_value: Any) -> str:
        """Format a value in outer units as text with its unit."""
        if outer_value is None or isinstance(outer_value, str):
            return outer_value or ""
        if _is_list(outer_value):
            return " ".join(repr(number) for number in outer_value)
        return f"{outer_value!r} {self.unit}".strip()


def group_of(row: Row) -> str:
    """Return the panel label of a row's group: 'Seam' for seam.angle."""
    return _headed(str(row.path[0]))


def _headed(key: str) -> str:
    """Convert a key to a heading."""
    text = key.replace("_", " ")
    return _ABBREVIATED.get(text) or text[0].upper() + text[1:]


def property_name(key: str) -> str:
    """Return the property name of a key: LayerHeight for layer_height."""
    return "".join(word[0].upper() + word[1:] for word in re.split(r"[_.]", key))


@cache
def rows(cls: type) -> tuple[Row, ...]:
    """Return the rows of a parameter dataclass in field order, with groups flattened."""
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
    """Build a parameter dataclass from inner values by row key; missing rows keep their defaults.

    Raises the InputErrors of the dataclass.
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
    """Return the inner values of a parameter dataclass by row key."""
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
    """Whether a value is a list of instances of a class."""
    return _is_list(values) and all(isinstance(value, cls) for value in values)


def _is_list(value: Any) -> bool:
    return isinstance(value, (tuple, list))


def _count(spec: f.Spec, value: Any, where: str) -> float:
    """Return an integer value as a number; the dataclass rejects fractions with its range."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        also = Text(" or {}", ", ".join(spec.words)) if spec.words else ""
        raise InputError(
            "BAD_VALUE", where, "{!r} is not a number; give a number such as 2{}", value, Word(also)
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
)  # forms of rows that can follow expressions


def is_expression(value: Any) -> bool:
    """Whether a value is an expression, not a number or a word."""
    return isinstance(value, str) and value.lstrip().startswith(MARK)


def evaluated(value: str, obj: Any, where: str) -> Any:
    """Return the current result of an expression, a quantity or a number.

    Names are resolved from `obj`. Raises InputError BAD_EXPRESSION.
    """
    try:
        result = obj.evalExpression(_bare(value))
    except Exception as error:  # FreeCAD's errors have no common base class
        raise _wrong(value, where, error) from None
    if isinstance(result, bool) or not (
        isinstance(result, (int, float)) or hasattr(result, "Unit")
    ):
        raise InputError(
            "BAD_EXPRESSION",
            where,
            "{!r} gives {!r}, which is not a number; write an expression that gives a number",
            value,
            result,
        )
    return result


def follow(obj: Any, row: Row, value: str | None) -> None:
    """Make the property of a row follow an expression, or no expression if None.

    Raises InputError BAD_EXPRESSION.
    """
    if value is None:
        if row.name in dict(obj.ExpressionEngine):
            obj.setExpression(row.name, None)
        return
    try:
        obj.setExpression(row.name, _bare(value))
    except Exception as error:  # such as a cyclic expression
        raise _wrong(value, f"{obj.Label}.{row.name}", error) from None


def of(obj: Any, row: Row) -> str:
    """Return the expression that the property of a row follows, or ''."""
    text = dict(obj.ExpressionEngine).get(row.name)
    return f"{MARK}{text}" if text else ""


def broken(obj: Any) -> str:
    """Return a remedy for an expression of an object that cannot be evaluated any more, else ''.

    In this case, FreeCAD does not run the object and only writes to the report view.
    """
    for name, text in getattr(obj, "ExpressionEngine", ()):
        try:
            obj.evalExpression(text)
        except Exception:  # FreeCAD's errors have no common base class
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
        "{!r} is not understood ({}); write an expression such as {}Spreadsheet.height / 2",
        value,
        reason,
        MARK,
    )
