# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a stage says of its result: status, message and findings, as its properties hold them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from ...core.issues import ERROR, WARNING, Issue, Text


def issues_of(obj: Any) -> tuple[Issue, ...]:
    """The findings stored with the object."""
    texts = _texts(obj)
    entries = json.loads(obj.Issues or "[]")
    return tuple(
        Issue(**{**entry, "message": texts.get(entry["message"], entry["message"])})
        for entry in entries
    )


def message_of(obj: Any) -> str:
    """The object's message with its template and values, so that the window can translate it."""
    return _texts(obj).get(obj.Message, str(obj.Message))


def reason_of(obj: Any) -> str:
    """What the object says without its own name before it, for a sentence that has named it."""
    message = message_of(obj)
    if (
        isinstance(message, Text)
        and message.template == "{0}: {1}"
        and message.values[0] == obj.Label
    ):
        return message.values[1]
    return message.removeprefix(f"{obj.Label}: ")


def store_issues(obj: Any, issues: Sequence[Issue]) -> None:
    """Store findings with the object."""
    obj.Issues = json.dumps([issue.as_dict() for issue in issues])
    messages = [issue.message for issue in issues]
    _remember(obj, messages, {obj.Message, *messages})


def first_message(issues: Sequence[Issue]) -> str:
    """The first error, else the first warning, with its place; '' when there is neither."""
    for level in (ERROR, WARNING):
        for issue in issues:
            if issue.level == level:
                return Text("{}: {}", issue.where, issue.message) if issue.where else issue.message
    return ""


def say(obj: Any, status: str, message: str) -> None:
    """Set status and message, each only where it is another: views and panels follow every change."""
    if obj.Message != message:
        obj.Message = message
    _remember(
        obj, [message], {message, *(entry["message"] for entry in json.loads(obj.Issues or "[]"))}
    )
    if obj.Status != status:
        obj.Status = status


def _remember(obj: Any, messages: Sequence[str], current: set[str]) -> None:
    """Keep templates and values of the object's current messages next to their English texts. A
    message from a document without this property is shown in English until its stage is computed
    again.
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
    """The object's translatable texts by their English wording. An object of an older document gets
    the property on restore.
    """
    texts = [text_of(text_parts) for text_parts in json.loads(getattr(obj, "Texts", "") or "[]")]
    return {str(text): text for text in texts}


def parts_of(text: str) -> Any:
    """A text for JSON: its template and values; one without is itself."""
    return (
        [text.template, *map(parts_of, text.values)]
        if isinstance(text, Text) and text.values
        else str(text)
    )


def text_of(text_parts: Any) -> Any:
    """The inverse of `parts_of`."""
    return (
        Text(text_parts[0], *map(text_of, text_parts[1:]))
        if isinstance(text_parts, list)
        else text_parts
    )
