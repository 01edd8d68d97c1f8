# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status, message and issues of a stage, stored in properties."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from ...core.issues import ERROR, WARNING, Issue, Text


def issues_of(obj: Any) -> tuple[Issue, ...]:
    """Return the issues stored with the object."""
    texts = _texts(obj)
    entries = json.loads(obj.Issues or "[]")
    return tuple(
        Issue(**{**entry, "message": texts.get(entry["message"], entry["message"])})
        for entry in entries
    )


def message_of(obj: Any) -> str:
    """Return the object's message with its template and values, for translation in the window."""
    return _texts(obj).get(obj.Message, str(obj.Message))


def reason_of(obj: Any) -> str:
    """Return the object's message without the leading label, for sentences that name the object."""
    message = message_of(obj)
    if (
        isinstance(message, Text)
        and message.template == "{0}: {1}"
        and message.values[0] == obj.Label
    ):
        return message.values[1]
    return message.removeprefix(f"{obj.Label}: ")


def store_issues(obj: Any, issues: Sequence[Issue]) -> None:
    """Store issues with the object."""
    obj.Issues = json.dumps([issue.as_dict() for issue in issues])
    messages = [issue.message for issue in issues]
    _remember(obj, messages, {obj.Message, *messages})


def first_message(issues: Sequence[Issue]) -> str:
    """Return the first error, else the first warning, with its location; '' without either."""
    for level in (ERROR, WARNING):
        for issue in issues:
            if issue.level == level:
                return Text("{}: {}", issue.where, issue.message) if issue.where else issue.message
    return ""


def say(obj: Any, status: str, message: str) -> None:
    """Set status and message, each only if changed, because views and panels react to changes."""
    if obj.Message != message:
        obj.Message = message
    _remember(
        obj, [message], {message, *(entry["message"] for entry in json.loads(obj.Issues or "[]"))}
    )
    if obj.Status != status:
        obj.Status = status


def _remember(obj: Any, messages: Sequence[str], current: set[str]) -> None:
    """Store templates and values of the object's current messages, by English text.

    Messages from documents without this property appear in English until the stage is recomputed.
    """
    texts = {
        **_texts(obj),
        **{
            str(message): message
            for message in messages
            if isinstance(message, Text) and message.values
        },
    }
    serialized = json.dumps(
        [parts_of(text) for sentence, text in texts.items() if sentence in current]
    )
    if serialized != (obj.Texts or "[]"):
        obj.Texts = serialized


def _texts(obj: Any) -> dict[str, Text]:
    """Return the object's translatable texts by English text.

    Objects of older documents get the property on restore.
    """
    texts = [text_of(text_parts) for text_parts in json.loads(getattr(obj, "Texts", "") or "[]")]
    return {str(text): text for text in texts}


def parts_of(text: str) -> Any:
    """Convert a text to JSON data: template and values, or the string if it has no values."""
    return (
        [text.template, *map(parts_of, text.values)]
        if isinstance(text, Text) and text.values
        else str(text)
    )


def text_of(text_parts: Any) -> Any:
    """Convert JSON data from `parts_of` back to a text."""
    return (
        Text(text_parts[0], *map(text_of, text_parts[1:]))
        if isinstance(text_parts, list)
        else text_parts
    )
