# SPDX-License-Identifier: LGPL-2.1-or-later
"""The frame of every page that we write: one file without links, light and dark."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from html import escape
from pathlib import Path
from string import Template

_FOLDER = Path(__file__).resolve().parent
NO_SCRIPTS = "default-src 'none'; style-src 'unsafe-inline'"  # policy of a static page


@lru_cache(maxsize=8)
def read_part(name: str) -> str:
    """Return the text of a file of this folder that becomes part of a page."""
    return (_FOLDER / name).read_text(encoding="utf-8")


def fill_page(
    title: str,
    sections: Iterable[str],
    policy: str = NO_SCRIPTS,
    style: str = "",
    data: str = "",
) -> str:
    """Return a page.

    Parameters
    ----------
    title : str
        Its title as plain text.
    sections : iterable of str
        Its contents as HTML.
    policy : str
        What a browser lets it do (Content-Security-Policy).
    style : str
        CSS in addition to that of all pages.
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
