# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a message is told in French in full, by a table that is read without the code of the translations."""

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
    """The French of all texts."""
    text = TABLE.read_text(encoding="utf-8")
    found = re.findall(
        r"<source>(.*?)</source>\s*<translation>(.*?)</translation>", text, re.DOTALL
    )
    return {plain(source): plain(told) for source, told in found}


def plain(text):
    for written, sign in SIGNS:
        text = text.replace(written, sign)
    return text


def untold(text, table):
    """Templates of a text, and of the texts put into it, that the table does not have; in full for a text that has none."""
    if not isinstance(text, Text):
        key = text.strip().replace("{", "{{").replace("}", "}}")
        return (
            []
            if key in table or len(re.findall(r"[a-z]{2,}", LITERAL.sub("", key))) < 2
            else [text]
        )
    own = text.template.strip()
    words = re.findall(r"[a-z]{3,}", LITERAL.sub("", own))
    inner = [
        found for value in text.values if isinstance(value, Text) for found in untold(value, table)
    ]
    return ([own] if words and own not in table else []) + inner


def check_told(text, table):
    """A text has no English left, and its figures are kept."""
    left = untold(text, table)
    assert left == [], f"{text}: not in French: {left}"
    told = in_language(text, lambda template: table.get(template, template))
    assert Counter(FIGURE.findall(told)) == Counter(FIGURE.findall(text)), (text, told)
    return told
