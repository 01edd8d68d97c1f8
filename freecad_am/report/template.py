# SPDX-License-Identifier: LGPL-2.1-or-later
"""Template of all pages: one self-contained file with light and dark colours."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from html import escape
from pathlib import Path
from string import Template

_FOLDER = Path(__file__).resolve().parent
NO_SCRIPTS = "default-src 'none'; style-src 'unsafe-inline'"  # policy of a page without scripts


@lru_cache(maxsize=8)
def read_part(name: str) -> str:
    """Read a page component from this folder."""
    return (_FOLDER / name).read_text(encoding="utf-8")


def fill_page(
    title: str,
    sections: Iterable[str],
    policy: str = NO_SCRIPTS,
    style: str = "",
    data: str = "",
) -> str:
    """Fill the page template.

    Parameters
    ----------
    title : str
        Page title as plain text.
    sections : iterable of str
        Page content as HTML.
    policy : str
        Content-Security-Policy of the page.
    style : str
        CSS in addition to the common style.
    data : str
        HTML for the end of the body.

    Returns
    -------
    str
        The text of the HTML file.
    """
    return Template(read_part("page.html")).substitute(
        title=escape(title),
        policy=policy,
        style=read_part("style.css") + style,
        content="".join(sections),
        data=data,
    )
