# SPDX-License-Identifier: LGPL-2.1-or-later
"""Translations as files of Qt Linguist."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path
from xml.sax.saxutils import escape

Texts = dict[str, dict[str, str]]  # by context, source: where it is found
_FIELD = re.compile(r"\{\{|\}\}|\{([^{}]*)\}")


def read(path: Path) -> dict[str, str]:
    """The translation of each source that has one, of whatever context."""
    if not path.exists():
        return {}
    found = {}
    for message in ET.parse(path).getroot().iter("message"):
        translation = message.find("translation")
        if translation is not None and translation.text and translation.get("type") is None:
            found[message.findtext("source", "")] = translation.text
    return found


def contexts(path: Path) -> dict[str, dict[str, str]]:
    """All translations by context and source; '' for those that are missing."""
    return {
        context.findtext("name", ""): {
            message.findtext("source", ""): message.findtext("translation", "")
            for message in context.iter("message")
        }
        for context in ET.parse(path).getroot().iter("context")
    }


def written(texts: Texts, translations: dict[str, str], language: str) -> str:
    """The file, contexts and sources in their order; a source without a translation is marked as unfinished."""
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        "<!DOCTYPE TS>",
        f'<TS version="2.1" language="{language}">',
    ]
    for context, sources in texts.items():
        lines += ["<context>", f"    <name>{escape(context)}</name>"]
        for source, place in sources.items():
            told = translations.get(source, "")
            lines += [
                "    <message>",
                f'        <location filename="../../{escape(place)}"/>',
                f"        <source>{_text(source)}</source>",
                f"        <translation>{_text(told)}</translation>"
                if told
                else '        <translation type="unfinished"></translation>',
                "    </message>",
            ]
        lines.append("</context>")
    return "\n".join([*lines, "</TS>", ""])


def _text(text: str) -> str:
    return escape(text, {'"': "&quot;", "'": "&apos;"})


def fields(text: str) -> list[str]:
    """The places of a text for `format`, {} by their number, in alphabetical order."""
    found, count = [], 0
    for match in _FIELD.finditer(text):
        if match.group(1) is not None:
            name, _, spec = match.group(1).partition(":")
            found.append(f"{name or count}:{spec}")
            count += not name
    return sorted(found)
