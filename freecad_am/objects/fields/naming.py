# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of programs from labels."""

from __future__ import annotations

import re
import unicodedata

from ...core.issues import InputError
from ...posts import catalogue
from .plain_text import checked_words

_NAME_LENGTH = 20


def proposed_name(text: str) -> str:
    """A program name that controllers take, from a label: letters A to Z, digits and underscores.

    `am.proposed_name("Hémisphère n° 1")` is "HEMISPHERE_N_1". Raises InputError BAD_VALUE for other
    types.
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
