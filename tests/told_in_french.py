# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check that a message is fully in French, with a table read independently of the translation
code."""

import re
from collections import Counter
from pathlib import Path

from freecad_am.core.issues import Text
from freecad_am.gui.in_language import in_language

TABLE = Path(__file__).resolve().parent.parent / "resources" / "translations" / "RoboticAM_fr.ts"
LITERAL = re.compile(r"\{\d+\}|`[^`]*`|\b[a-z_]+(?:\.[a-z_]+)+")
FIGURE = re.compile(r"\d[\d.,e+-]*\d|\d")
SIGNS = (("&lt;", "<"), ("&gt;", ">"), ("&quot;", '"'), ("&apos;", "'"), ("&amp;", "&"))


def table():
    """Return the French translation of each text."""
    text = TABLE.read_text(encoding="utf-8")
    entries = re.findall(
        r"<source>(.*?)</source>\s*<translation>(.*?)</translation>", text, re.DOTALL
    )
    return {plain(source): plain(translation) for source, translation in entries}


def plain(text):
    for written, sign in SIGNS:
        text = text.replace(written, sign)
    return text


def missing_templates(text, table):
    """Return the templates of a text and of its nested texts that the table lacks. A plain string
    counts as one template."""
    if not isinstance(text, Text):
        key = text.strip().replace("{", "{{").replace("}", "}}")
        return (
            []
            if key in table or len(re.findall(r"[a-z]{2,}", LITERAL.sub("", key))) < 2
            else [text]
        )
    template = text.template.strip()
    words = re.findall(r"[a-z]{3,}", LITERAL.sub("", template))
    inner = [
        missing
        for value in text.values
        if isinstance(value, Text)
        for missing in missing_templates(value, table)
    ]
    return ([template] if words and template not in table else []) + inner


def check_french(text, table):
    """Assert that no part of a text is left in English and that its figures are kept."""
    missing = missing_templates(text, table)
    assert missing == [], f"{text}: not in French: {missing}"
    translation = in_language(text, lambda template: table.get(template, template))
    assert Counter(FIGURE.findall(translation)) == Counter(FIGURE.findall(text)), (
        text,
        translation,
    )
    return translation
