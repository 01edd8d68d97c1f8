# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters that follow other values of the document: a text that starts with `=`, such as `=Spreadsheet.height / 2`."""

from __future__ import annotations

from typing import Any

from ...core.issues import InputError, Text
from ...core.parameters import field as f
from .rows import Row

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
    """What an expression gives now, a quantity or a number, names in it seen from `obj`. InputError 'BAD_EXPRESSION'."""
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
    """Let the property of a row follow an expression, None for none any more. InputError 'BAD_EXPRESSION'."""
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
