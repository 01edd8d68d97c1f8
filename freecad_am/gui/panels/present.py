# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the document has of a stage whose panel is open: undo and redo change it, and what the panel shows follows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ...core.issues import AmError
from ...objects.fields import expressions
from ...objects.fields.rows import Row, rows
from ...objects.stage import Stage
from ..picking.an_input import Input
from ..widgets.fields import Field


def values_of(obj: Any, section: Any) -> dict[str, Any]:
    """Inner values of a section of a stage by row key."""
    found = {}
    for row in rows(section.cls):
        try:
            found[row.key] = row.inner(getattr(obj, row.name), row.name)
        except AmError:  # what cannot be read is replaced by its default
            found[row.key] = row.default
    return found


def entries(obj: Any, proxy: type[Stage], inputs: dict[str, Any]) -> dict[str, Any]:
    """What the fields of a panel show of an object: parameters by place, in outer units or as the expression that they
    follow, and inputs by label."""
    found = dict(inputs)
    for section in proxy.sections:
        values = values_of(obj, section)
        for row in rows(section.cls):
            found[f"{section.prefix}_{row.key}"] = _followed(obj, row) or row.outer(values[row.key])
    return found


def show_other(
    fields: Iterable[tuple[str, Field]],
    choices: Sequence[Input],
    before: dict[str, Any],
    now: dict[str, Any],
) -> None:
    """Show what is another one now than before; what was entered elsewhere stays."""
    for place, field in fields:
        if now[place] != before[place]:
            field.show(now[place])
            field.applied()
    for choice in choices:
        if now[choice.label] != before[choice.label]:
            choice.show_stored(now[choice.label])
            choice.applied()


def _followed(obj: Any, row: Row) -> str:
    return expressions.of(obj, row) if row.form in expressions.FOLLOW else ""
